//! The door: a checked program, run.

use super::host::{Host, Mode, Options, Outcome};
use super::interpreter::Interpreter;
use super::routines::Routines;
use super::stage;
use super::stop::Eval;
use crate::check::Checked;
use crate::check::typed::DefKind;
use crate::interrupt;
use crate::source::{Files, Severity};

/// Runs a checked program. What `check` reported is not repeated; parts that it could not
/// understand are passed over in silence.
pub fn run(
    routines: &Routines,
    checked: &Checked,
    mode: Mode,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
) -> Outcome {
    stage::run(files, host, |stage| {
        let mut interpreter = Interpreter::new(routines, checked, mode, options, stage);
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
                if self.options.pages && !drawn { (self.routines.draw_declared)(self) } else { Ok(()) }
            }
            Mode::Test => self.run_tests(),
            Mode::Check => {
                for &def in &program.own {
                    self.check_declaration(def)?;
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
}
