//! The rooms of the interpreter put together: programs and entries of sessions, run.
//!
//! The evaluator ([`crate::interpret`]) is handed the rooms above it: declarations are elaborated by
//! [`crate::elaborate`], built-ins are called in [`crate::natives`], and values are printed by
//! [`crate::display`].

mod standard;

use crate::check::Checked;
use crate::check::typed::DefId;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::routines::Routines;
use crate::interpret::session::Evaluator;
use crate::interpret::stop::Eval;
use crate::interpret::study::StudyWorker;
use crate::interpret::{self, Host, Mode, Options, Outcome};
use crate::interrupt::CancelState;
use crate::source::{Diagnostic, Files};
use crate::{display, elaborate, natives};

pub use standard::{Standard, standard};

/// The rooms above the evaluator.
static ROUTINES: Routines = Routines {
    native: natives::find,
    instantiate: elaborate::instantiate,
    robot_of: elaborate::robot_of,
    hinge_of: elaborate::hinge_of,
    check_declaration: elaborate::check_declaration,
    show: display::show,
    typed: display::typed,
    display: display::display,
    describe_declaration: display::describe_declaration,
    capabilities: natives::capabilities,
    draw_declared: natives::draw_declared,
};

/// Runs a checked program on a thread of its own, with all built-ins, and returns the outcome. Faults that `check`
/// reported are not repeated; parts that it could not understand are passed over in silence. `mode`: the part of the
/// program that is evaluated; `files` and `host` serve its requests; `options`: the choices of the user.
pub fn run(
    checked: &Checked,
    mode: Mode,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
) -> Outcome {
    interpret::run(&ROUTINES, checked, mode, files, host, options)
}

/// Plans and judges a behaviour of a configuration, both with the defaults of their parameters; else as [`run`]. The outcome
/// holds the verdict and what was found. `behavior`: the declaration, and the index among its behaviours.
pub fn judge(
    checked: &Checked,
    behavior: (DefId, usize),
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
) -> Outcome {
    interpret::judge(&ROUTINES, checked, behavior, files, host, options)
}

/// Returns the result of `work`, which is called on a thread of its own with the interpreter of a checked program, of which
/// nothing was run. `None` where it met a fault or a limit, reported an error or was cancelled, or where the thread can't be
/// started. `files` and `host` serve its requests; `options`: the choices of the user.
pub fn with_interpreter<T: Send>(
    checked: &Checked,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
    work: impl FnOnce(&mut Interpreter) -> Eval<T> + Send,
) -> Option<T> {
    interpret::with_interpreter(&ROUTINES, checked, files, host, options, work)
}

/// Calls `work` with an evaluator of a study's rows, on a thread of its own, and returns its result; `None` if the user
/// cancels before. `checked`: the program; `files` and `host` serve its requests; `options`: the choices of the user;
/// `study`: the declaration.
///
/// # Errors
/// The diagnostics for which the study has no rows, or that of a system that gives no memory for the thread.
pub fn with_study<T: Send>(
    checked: &Checked,
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
    study: DefId,
    work: impl FnOnce(&mut StudyWorker) -> T + Send,
) -> Result<Option<T>, Vec<Diagnostic>> {
    interpret::study::with_study((&ROUTINES, checked), files, host, options, study, work)
}

/// Starts the evaluator thread of a session, which keeps the values of earlier entries. `cancel_state`: the state by
/// which the user can cancel it.
///
/// # Errors
/// The message of the operating system if the thread can't be started.
pub fn evaluator(cancel_state: CancelState) -> Result<Evaluator, String> {
    Evaluator::new(&ROUTINES, cancel_state)
}
