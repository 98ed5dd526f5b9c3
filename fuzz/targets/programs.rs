//! Programs checked, and run with little fuel.

use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::project::{Desk, Project};
use crate::fuzz::inputs::{corpus, damage, programs};
use modl::check::Checked;
use modl::interpret::{Mode, Options, Outcome};
use modl::plan::verify::verify;
use modl::source::{Diagnostic, Sources};

/// Returns a program to check: most mean something, or nearly.
pub fn to_check(dice: &mut Dice) -> Vec<u8> {
    let text = match dice.below(4) {
        0 => corpus::text(dice),
        1 => {
            let case = corpus::case(dice);
            damage::damaged(dice, &case)
        }
        _ => corpus::quick(dice),
    };
    text.into_bytes()
}

/// Returns a program to run.
pub fn to_run(dice: &mut Dice) -> Vec<u8> {
    let text = if dice.below(6) == 0 { programs::program(dice) } else { corpus::quick(dice) };
    text.into_bytes()
}

/// Returns the bounds within which programs run here.
pub fn options() -> Options {
    let mut options = Options::default();
    options.limits.steps = 100_000;
    options.limits.samples = 500;
    options.limits.list = 10_000;
    options.limits.text = 1 << 16;
    options.limits.digits = 500;
    options.limits.modules = 200;
    options.limits.robots = 16;
    options
}

/// Checks that each place that is told lies in its text.
pub fn placed(diagnostics: &[Diagnostic], sources: &Sources) {
    for diagnostic in diagnostics {
        assert!(!diagnostic.message.is_empty());
        for label in &diagnostic.labels {
            let (_, file) =
                sources.files().nth(label.span.file.0 as usize).expect("the file of a place is known");
            assert!(
                file.text.get(label.span.range()).is_some(),
                "{:?} is no place: {}",
                label.span,
                diagnostic.message
            );
        }
    }
}

/// Checks a program, some twice.
pub fn check(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let files = Project::of(&text);
    let checked = modl::check::check(&files, "main.mod");
    placed(&checked.diagnostics, &checked.sources);
    if text.len().is_multiple_of(8) {
        let again = modl::check::check(&files, "main.mod");
        assert_eq!(checked.diagnostics, again.diagnostics, "the second time finds other things");
    }
}

/// Runs or elaborates a program within narrow bounds, some twice. A program that plans is checked only, since no number of
/// evaluation steps is a bound for planners.
pub fn run(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let files = Project::of(&text);
    let checked = modl::check::check(&files, "main.mod");
    if checked.has_errors() || !corpus::is_quick(&text) {
        return;
    }
    let mode = [Mode::Run, Mode::Run, Mode::Check, Mode::Test][text.len() % 4];
    let (desk, outcome) = ran(&checked, mode, &files);
    placed(&outcome.diagnostics, &checked.sources);
    if text.len().is_multiple_of(8) {
        let (again, other) = ran(&checked, mode, &files);
        assert_eq!(desk.printed, again.printed, "the second time prints something else");
        assert_eq!(outcome.diagnostics, other.diagnostics, "the second time finds other things");
        assert!(desk.written == again.written, "the second time writes something else");
    }
    plans_hold(&desk);
}

/// Runs a checked program with little fuel.
pub fn ran(checked: &Checked, mode: Mode, files: &Project) -> (Desk, Outcome) {
    let mut desk = Desk::default();
    let outcome = modl::execute::run(checked, mode, files, &mut desk, &options());
    (desk, outcome)
}

/// Checks that every plan that was written is read, and that the judge accepts it again.
pub fn plans_hold(desk: &Desk) {
    for (name, bytes) in &desk.written {
        let text = String::from_utf8_lossy(bytes);
        if name.ends_with(".json") && text.contains("\"format\": \"modl plan\"") {
            let plan = modl::plan::file::read(&text).expect("a plan that was written is read");
            let verdict = verify(&plan);
            assert!(verdict.ok(), "a plan that was written is verified: {:?}", verdict.failures.first());
        }
    }
}
