//! The program of a series of steps: docks, undocks, and moves of joints at the same time.

use super::search::Step;
use super::settings::UNLIMITED_SPEED;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target};
use crate::planners::goals::least_time;
use crate::robot::{Assembly, JointId};
use std::sync::Arc;

/// Returns the program that carries out steps one after the other from some positions of all joints (rad or m); joints that
/// move in a step begin and end together, as fast as their limits and those of their motors allow. `robot`: the assembly with
/// all bonds that the steps name; `cause`: that of all actions.
pub(super) fn program(robot: &Assembly, start: &[f64], steps: &[Step], cause: CauseId) -> Arc<Node> {
    let action = |command| {
        let otherwise = Otherwise::Proceed;
        Arc::new(Node::Action(Action { command, until: None, timeout: None, otherwise, cause }))
    };
    let mut at = start;
    let mut series = Vec::with_capacity(steps.len());
    for step in steps {
        series.push(match step {
            Step::Dock(bond) => {
                let bond = robot.bonds[*bond];
                action(Command::Dock { a: bond.a, b: bond.b })
            }
            Step::Undock(bond) => action(Command::Undock { port: robot.bonds[*bond].a }),
            Step::Turn(to) => {
                let farthest = at.iter().zip(to).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
                let duration =
                    least_time(robot, at, to, Profile::Smooth).unwrap_or(farthest / UNLIMITED_SPEED);
                let moved = (0..to.len()).filter(|joint| at[*joint] != to[*joint]);
                let moves = moved.map(|joint| {
                    action(Command::Move {
                        joint: JointId(u32::try_from(joint).expect("joints are counted in 32 bits")),
                        target: Target::To(to[joint]),
                        duration: Some(duration),
                        profile: Profile::Smooth,
                    })
                });
                let moves = Arc::new(Node::Parallel(moves.collect()));
                at = to;
                moves
            }
        });
    }
    Arc::new(Node::Series(series))
}
