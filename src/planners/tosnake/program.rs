//! The program of a step sequence: series of docks, undocks and parallel moves, whose trajectories are quintic, with
//! durations from the joints' limits.

use super::conversion::{JOINTS, Translated, port_name};
use super::robot::{Bond, Dock};
use super::state::Step;
use super::tolerances::TOLERANCES;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target};
use crate::robot::{JointId, PortRef};
use std::sync::Arc;

/// Speed of a joint without a speed limit, rad/s.
const UNLIMITED_SPEED: f64 = 1.0;

/// Greatest speed of the smooth profile over its mean speed: 15/8 for the quintic.
const SMOOTH_PEAK_SPEED: f64 = 15.0 / 8.0;

impl Translated<'_> {
    /// Returns the program that executes steps one after the other from the robot's joint positions; in each step all
    /// its joints move at once, as fast as the slowest may. `bonds`: the list that the steps index; `cause`: that of
    /// all actions.
    pub(super) fn program(&self, steps: &[Step], bonds: &[Bond], cause: CauseId) -> Arc<Node> {
        let mut positions = self.robot.joints.clone();
        let action = |command| {
            let otherwise = Otherwise::Proceed;
            Arc::new(Node::Action(Action { command, until: None, timeout: None, otherwise, cause }))
        };
        let mut series = Vec::with_capacity(steps.len());
        for step in steps {
            series.push(match step {
                Step::Dock(bond) => {
                    let [a, b] = [bonds[*bond].a, bonds[*bond].b].map(|dock| self.port(dock));
                    action(Command::Dock { a, b })
                }
                Step::Undock(bond) => action(Command::Undock { port: self.port(bonds[*bond].a) }),
                Step::Turn(turns) => {
                    // The slowest joint determines the duration.
                    let duration = turns
                        .iter()
                        .map(|&(module, joint, to)| {
                            self.duration(module, joint, to - positions[module][joint])
                        })
                        .fold(0.0, f64::max);
                    let moves = turns.iter().map(|&(module, joint, to)| {
                        positions[module][joint] = to;
                        action(Command::Move {
                            joint: JointId(self.joints[module][joint] as u32),
                            target: Target::To(to),
                            duration: Some(duration),
                            profile: Profile::Smooth,
                        })
                    });
                    Arc::new(Node::Parallel(moves.collect()))
                }
            });
        }
        Arc::new(Node::Series(series))
    }

    /// Returns the least duration (s) of a smooth turn by an angle (rad) from rest to rest. The peak speed is
    /// 15/8 of the mean, the peak acceleration 10/√3 of the turn over the squared duration.
    pub(super) fn duration(&self, module: usize, joint: usize, turn: f64) -> f64 {
        let kind = self.assembly.module_type(module);
        let limits = kind.joints.iter().find(|j| j.name == JOINTS[joint]).map(|j| j.limits);
        let limits = limits.unwrap_or_default();
        let by_speed = turn.abs() / limits.speed.unwrap_or(UNLIMITED_SPEED);
        let by_acceleration =
            limits.acceleration.map_or(0.0, |a| libm::sqrt(10.0 / libm::sqrt(3.0) * turn.abs() / a));
        f64::max(SMOOTH_PEAK_SPEED * by_speed, by_acceleration) * (1.0 + TOLERANCES.duration_spare)
    }

    /// Returns the port of a dock in the assembly.
    fn port(&self, dock: Dock) -> PortRef {
        let name = port_name(dock.module, dock.dock);
        let ports = &self.assembly.module_type(dock.module).ports;
        let port = ports.iter().position(|port| port.name == name).expect("the ports were found by name");
        PortRef { module: dock.module, port }
    }
}
