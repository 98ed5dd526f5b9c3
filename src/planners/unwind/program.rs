//! The program of a series of steps: docks, undocks, and moves of joints at the same time.

use super::search::Step;
use super::settings::UNLIMITED_SPEED;
use crate::plan::{CauseId, Command, Node, Profile};
use crate::planners::goals::{action, least_time, moves_within};
use crate::robot::Assembly;
use std::sync::Arc;

/// Returns the program that carries out steps one after the other from some positions of all joints (rad or m); joints that
/// move in a step begin and end together, as fast as their limits and those of their motors allow. `robot`: the assembly with
/// all bonds that the steps name; `cause`: that of all actions.
pub(super) fn program(robot: &Assembly, start: &[f64], steps: &[Step], cause: CauseId) -> Arc<Node> {
    let mut at = start;
    let mut series = Vec::with_capacity(steps.len());
    for step in steps {
        series.push(match step {
            Step::Dock(bond) => {
                let bond = robot.bonds[*bond];
                action(Command::Dock { a: bond.a, b: bond.b }, cause)
            }
            Step::Undock(bond) => action(Command::Undock { port: robot.bonds[*bond].a }, cause),
            Step::Turn(to) => {
                let farthest = at.iter().zip(to).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
                let least = least_time(robot, at, to, Profile::Smooth);
                let times = (least.unwrap_or(farthest / UNLIMITED_SPEED), Profile::Smooth);
                let moved: Vec<usize> = (0..to.len()).filter(|joint| at[*joint] != to[*joint]).collect();
                at = to;
                moves_within(to, &moved, times, cause)
            }
        });
    }
    Arc::new(Node::Series(series))
}
