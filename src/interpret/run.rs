//! The entry point: runs a checked program.

use super::evaluator_thread;
use super::host::{Host, Mode, Options, Outcome};
use super::interpreter::Interpreter;
use super::memory_errors::no_memory;
use super::routines::Routines;
use super::stop::Eval;
use crate::check::Checked;
use crate::check::typed::{DefId, DefKind};
use crate::interrupt;
use crate::source::{Diagnostic, Files, Severity};

/// Runs a checked program on a thread of its own and returns the outcome. Faults that `check` reported are not
/// repeated; parts that it could not understand are passed over in silence. If the thread can't be started, that is the
/// only diagnostic. `routines`: the functions of the higher-level modules; `mode`: the part of the program that is
/// evaluated; `files` and `host` serve its requests; `options`: the choices of the user. Panics if the evaluator does.
pub fn run(
    routines: &Routines,
    checked: &Checked,
    mode: Mode,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
) -> Outcome {
    run_by(routines, checked, mode, files, host, options, |interpreter| interpreter.drive())
}

/// Plans and judges a behaviour of a configuration, both with the defaults of their parameters, as [`run`] runs a program; the
/// outcome holds the verdict and what was found. `config`: the declaration; `behavior`: the index among its behaviours.
pub fn judge(
    routines: &Routines,
    checked: &Checked,
    (config, behavior): (DefId, usize),
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
) -> Outcome {
    let judge = |interpreter: &mut Interpreter| interpreter.judge_behavior(config, behavior);
    run_by(routines, checked, Mode::Run, files, host, options, judge)
}

/// Runs what `drive` does with the interpreter of a checked program, as [`run`] says.
fn run_by(
    routines: &Routines,
    checked: &Checked,
    mode: Mode,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
    drive: impl FnOnce(&mut Interpreter) -> Eval<()> + Send,
) -> Outcome {
    let ran = evaluator_thread::run(files, host, |host| {
        let mut interpreter = Interpreter::new(routines, checked, mode, options, host);
        let cancel_state = interpreter.shared.host.cancel_state.clone();
        let progress_sink = interpreter.shared.host.progress_sink();
        let ended = interrupt::catch(&cancel_state, progress_sink, || drive(&mut interpreter));
        interpreter.report_end(ended);
        interpreter.report_lost();
        interpreter.report_unneeded();
        Outcome {
            diagnostics: in_order(std::mem::take(&mut interpreter.reported.reports)),
            tests: std::mem::take(&mut interpreter.reported.tests),
            written: std::mem::take(&mut interpreter.reported.written),
            plans: std::mem::take(&mut interpreter.reported.plans),
            judgements: std::mem::take(&mut interpreter.reported.judgements)
                .into_iter()
                .map(|(span, (_, judgement))| (span, judgement))
                .collect(),
            constants: if options.constants { interpreter.constants() } else { Vec::new() },
            cancelled: interpreter.shared.host.cancelled(),
        }
    });
    ran.unwrap_or_else(|why| Outcome { diagnostics: vec![no_memory(&why)], ..Outcome::default() })
}

/// Returns the result of `work`, which is called on a thread of its own with the interpreter of a checked program, of
/// which nothing was run. `None` where it met a fault or a limit, reported an error or was cancelled, or where the
/// thread can't be started. `routines`: the functions of the higher-level modules; `files` and `host` serve its
/// requests; `options`: the choices of the user.
pub fn with_interpreter<T: Send>(
    routines: &Routines,
    checked: &Checked,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
    work: impl FnOnce(&mut Interpreter) -> Eval<T> + Send,
) -> Option<T> {
    let done = evaluator_thread::run(files, host, |host| {
        let mut interpreter = Interpreter::new(routines, checked, Mode::Check, options, host);
        let cancel_state = interpreter.shared.host.cancel_state.clone();
        let progress_sink = interpreter.shared.host.progress_sink();
        let done = interrupt::catch(&cancel_state, progress_sink, || work(&mut interpreter));
        done.ok().and_then(Result::ok).filter(|_| interpreter.reported.errors == 0)
    });
    done.ok().flatten()
}

/// Sorts findings: errors before warnings before notes; else as they were found.
fn in_order(mut reports: Vec<Diagnostic>) -> Vec<Diagnostic> {
    reports.sort_by_key(|d| match d.severity {
        Severity::Error => 0,
        Severity::Warning => 1,
        Severity::Note => 2,
    });
    reports
}

impl Interpreter<'_> {
    /// Runs the part of the program that the mode names.
    fn drive(&mut self) -> Eval<()> {
        let program = self.shared.program;
        match self.shared.mode {
            Mode::Run => {
                self.execute_body(&program.statements)?;
                self.force_lets()?;
                let drawn = self.reported.written.iter().any(|path| path.ends_with(".html"));
                if self.shared.options.pages && !drawn {
                    (self.shared.routines.draw_declared)(self)
                } else {
                    Ok(())
                }
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

    /// Evaluates the lets that no statement needed, since their faults are faults of the program.
    fn force_lets(&mut self) -> Eval<()> {
        let program = self.shared.program;
        for &def in &program.own {
            if matches!(program.def(def).kind, DefKind::Let(_)) {
                let value = self.global(def, program.def(def).span);
                self.recover(value)?;
            }
        }
        Ok(())
    }
}
