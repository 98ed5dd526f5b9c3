//! The refusals of `tosnake` of modules that are not RoFI's.

use crate::interpret::causes::PlanCauses;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::robot::Robot;
use crate::interpret::stop::{Stop, fault};
use crate::planners::unwind::{Refusal, Status, Unfit};
use crate::source::{Diagnostic, Span, code};

/// Returns the fault of a refusal, at the robot that is refused; `Stop::Halt` if the user cancelled.
pub(super) fn no_snake(
    interpreter: &Interpreter,
    call: &Call,
    (robot, at): (&Robot, Span),
    causes: &PlanCauses,
    refusal: &Refusal,
) -> Stop {
    let name = |module: &usize| robot.assembly.modules[*module].name.clone();
    let message = refusal.to_string();
    let ended = |status: &Status, hint: &str| {
        let reached = format!("{} postures were examined", status.work);
        Diagnostic::error(code::NO_WAY, message.clone()).label(at, reached).hint(hint).into()
    };
    match refusal {
        Refusal::Unfit(unfit) => unfitting(robot, at, unfit),
        Refusal::Links { .. } => fault(code::NOT_COVERED, at, message, "too large for this planner"),
        Refusal::Pieces(module) => {
            let message = format!("the robot is in pieces: {} hangs on nothing", name(module));
            fault(code::NO_WAY, at, message, "not in one piece")
        }
        Refusal::Overlap(_) => fault(code::NO_WAY, at, message, "starts with a collision"),
        Refusal::Unsound(unsound) => fault(code::BAD_VALUE, at, unsound.to_string(), "a shape of a module"),
        Refusal::BudgetSpent(status) => ended(status, "a greater `budget` or another `seed` may find one"),
        Refusal::Exhausted(status) => ended(status, "another `seed` may find one"),
        Refusal::Stopped(_) if interpreter.shared.host.cancelled() => Stop::Halt,
        Refusal::Stopped(status) => ended(status, "a greater `timeout` or another `seed` may find one"),
        Refusal::Bent(_) => Diagnostic::error(code::NO_WAY, message)
            .label(at, "all modules are in one chain, which stays bent")
            .hint("another `seed` may find a way")
            .into(),
        Refusal::Schedule(refusal) => interpreter.refused(refusal, &causes.ids, call.span),
    }
}

/// Returns the fault of a module that lacks what the planner needs.
fn unfitting(robot: &Robot, at: Span, unfit: &Unfit) -> Stop {
    let name = |module: &usize| robot.assembly.modules[*module].name.clone();
    let kind = |module: &usize| robot.assembly.module_type(*module).name.clone();
    let (message, hint) = match unfit {
        Unfit::Docks(module) => (
            format!("{} has no two ports that mate with each other and with their like", name(module)),
            format!("a snake joins modules by two genderless ports; `{}` has none", kind(module)),
        ),
        Unfit::Hinged(module) => (
            format!("the ports of {} are hinges", name(module)),
            "panels are folded by `fold`, and walk by `refold`".to_owned(),
        ),
        Unfit::Rigid(module) => (
            format!("no joint of {} moves one of its ports against another", name(module)),
            "two ports come together only where joints between them take commands".to_owned(),
        ),
        Unfit::Strangers([a, b]) => (
            format!("the ports at the ends of {} and {} do not mate", name(a), name(b)),
            "a snake is of modules with one kind of port".to_owned(),
        ),
    };
    Diagnostic::error(code::NOT_COVERED, message).label(at, "no snake can be made of these").hint(hint).into()
}
