//! The door: a checked program, run.

use super::host::{Host, Mode, Options, Outcome};
use super::interpreter::Interpreter;
use super::stage;
use super::stop::{Eval, Stop};
use super::value::Value;
use crate::check::Checked;
use crate::check::typed::{DefId, DefKind, MemberKind};
use crate::interrupt;
use crate::source::{Files, Severity};
use std::rc::Rc;

/// Runs a checked program. What `check` reported is not repeated; parts that it could not
/// understand are passed over in silence.
pub fn run(
    checked: &Checked,
    mode: Mode,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
) -> Outcome {
    stage::run(files, host, |stage| {
        let mut interpreter = Interpreter::new(checked, mode, options, stage);
        // What halts a run has been reported, and nothing needs to be said of what the user halts.
        let cancel_state = interpreter.stage.cancel_state.clone();
        let progress_sink = interpreter.stage.progress_sink();
        let _ = interrupt::catch(&cancel_state, progress_sink, || interpreter.drive());
        interpreter.report_unneeded();
        Outcome {
            diagnostics: in_order(std::mem::take(&mut interpreter.reports)),
            tests: std::mem::take(&mut interpreter.tests),
            written: std::mem::take(&mut interpreter.written),
            cancelled: interpreter.stage.cancelled(),
        }
    })
}

/// Errors before warnings before notes; else as they were found.
fn in_order(mut reports: Vec<crate::source::Diagnostic>) -> Vec<crate::source::Diagnostic> {
    reports.sort_by_key(|d| match d.severity {
        Severity::Error => 0,
        Severity::Warning => 1,
        Severity::Note => 2,
    });
    reports
}

impl Interpreter<'_> {
    fn drive(&mut self) -> Eval<()> {
        let program = self.program;
        match self.mode {
            Mode::Run => {
                self.execute_body(&program.statements)?;
                self.force_lets()?;
                let drawn = self.written.iter().any(|path| path.ends_with(".html"));
                if self.options.pages && !drawn { self.draw_declared() } else { Ok(()) }
            }
            Mode::Test => self.run_tests(),
            Mode::Check => {
                for &def in &program.own {
                    self.check_def(def)?;
                }
                self.execute_body(&program.statements)?;
                for test in &program.tests {
                    self.execute_body(&test.body)?;
                }
                Ok(())
            }
        }
    }

    /// Lets that no statement needed: what is wrong with them is wrong with the program.
    fn force_lets(&mut self) -> Eval<()> {
        let program = self.program;
        for &def in &program.own {
            if matches!(program.def(def).kind, DefKind::Let(_)) {
                let value = self.global(def, program.def(def).span);
                self.settle(value)?;
            }
        }
        Ok(())
    }

    /// Elaborates a declaration with its defaults, and looks at all that its body declares.
    pub fn check_def(&mut self, def: DefId) -> Eval<()> {
        let program = self.program;
        let declared = program.def(def);
        match &declared.kind {
            DefKind::Let(_) => {
                let value = self.global(def, declared.span);
                self.settle(value)?;
            }
            DefKind::Connector(_) => {
                self.connector(def)?;
            }
            _ => {
                if let Some(design) = self.attempt(|this| this.default_design(def))?.flatten() {
                    self.check_members(&design)?;
                    self.check_sweep(def, &design)?;
                }
            }
        }
        Ok(())
    }

    /// Evaluates the lets, ports and behaviours of a body that nothing may have needed yet.
    fn check_members(&mut self, design: &Rc<super::design::Design>) -> Eval<()> {
        let program = self.program;
        let Some((members, _)) = super::eval::members_of(&program.def(design.def).kind) else {
            return Ok(());
        };
        let whole = self.whole(design);
        for (index, member) in members.iter().enumerate() {
            if matches!(member.kind, MemberKind::Let(_) | MemberKind::Port { .. }) {
                let id = crate::check::typed::MemberId(index as u32);
                let value = self.member(&whole, id, member.span);
                self.settle(value)?;
            }
        }
        let DefKind::Config(config) = &program.def(design.def).kind else { return Ok(()) };
        for behavior in &config.behaviors {
            match self.default_behavior(&whole, behavior) {
                Ok(Some(Value::Behavior(behavior))) => drop(self.check_behavior(&behavior)?),
                Ok(_) => {}
                Err(Stop::Fault(diagnostic)) => self.report(*diagnostic),
                Err(Stop::Halt) => return Err(Stop::Halt),
            }
        }
        Ok(())
    }
}
