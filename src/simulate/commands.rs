//! Commanded positions and velocities of joints over time, and the bonds that are commanded to change: as a plan says, or
//! as its program does that is executed.

use super::sensing::Measured;
use crate::behavior::{Ending, Execution, Reason, Refusal};
use crate::plan::forward_dynamics::{Planned, Stepper};
use crate::plan::{DockingEvent, Program, Tracks};
use crate::robot::Assembly;

/// The commanded position and velocity of every joint, by the number of its id, at ascending times.
pub(super) struct Commands<'a> {
    source: Source<'a>,
    /// The position (rad or m) and velocity (rad/s or m/s) of each joint at the time asked for last.
    pub joints: Vec<(f64, f64)>,
}

enum Source<'a> {
    Planned(Planned<'a>),
    Executed {
        execution: Box<Execution<'a>>,
        /// The time by which the program must have ended, s.
        deadline: f64,
    },
}

/// The time that an executed program may take beyond twice that of the plan, s.
const PATIENCE: f64 = 60.0;

impl<'a> Commands<'a> {
    /// Returns the commands of a plan, at its start; those of its program with sensors where there is one to be executed.
    pub(super) fn new(tracks: &'a Tracks, executed: Option<&'a Program>) -> Commands<'a> {
        let source = match executed {
            Some(program) => Source::Executed {
                execution: Box::new(Execution::new(tracks, &program.root)),
                deadline: 2.0 * tracks.duration + PATIENCE,
            },
            None => Source::Planned(Planned::new(tracks)),
        };
        let joints = tracks.start.joints.iter().map(|&position| (position, 0.0)).collect();
        Commands { source, joints }
    }

    /// Returns the changes of bonds that are commanded up to a time (s, not before that of the last call), each once. A
    /// program is executed up to that time, at which its sensors report on the robot in motion.
    pub(super) fn bonds(&mut self, time: f64, robot: &Assembly, stepper: &Stepper) -> Vec<DockingEvent> {
        if time < 0.0 {
            return Vec::new();
        }
        match &mut self.source {
            Source::Planned(planned) => planned.events(time).to_vec(),
            Source::Executed { execution, deadline } => {
                let sensors = Measured { stepper, robot, commands: &self.joints };
                let events = execution.advance(time, &sensors);
                if time > *deadline && execution.ending().is_none() {
                    let limit = *deadline as u64;
                    execution.stop(Refusal::whole(Reason::Limit { what: "seconds", limit }));
                }
                events
            }
        }
    }

    /// Finds the commands at a time (s), which must not be before that asked for last. Before the start and after the end
    /// joints are at rest.
    pub(super) fn advance(&mut self, time: f64) {
        match &mut self.source {
            Source::Planned(planned) => planned.advance(time, &mut self.joints),
            Source::Executed { execution, .. } => {
                for (number, joint) in self.joints.iter_mut().enumerate() {
                    *joint = execution.command(number, time.max(0.0));
                }
            }
        }
    }

    /// Says of a bond, by its index, whether it holds, where a program is executed that may ask.
    pub(super) fn set_bond(&mut self, bond: usize, holds: bool) {
        if let Source::Executed { execution, .. } = &mut self.source {
            execution.set_bond(bond, holds);
        }
    }

    /// Returns the time at which all is done, s; `None` while that is not known.
    pub(super) fn end(&self) -> Option<f64> {
        match &self.source {
            Source::Planned(planned) => Some(planned.duration()),
            Source::Executed { execution, .. } => execution.ending().map(|(_, time)| time),
        }
    }

    /// Returns the reason why the program was stopped before its end; `None` if it was not.
    pub(super) fn stopped(&self) -> Option<&Reason> {
        let Source::Executed { execution, .. } = &self.source else { return None };
        match execution.ending()?.0 {
            Ending::Done => None,
            Ending::Stopped(refusal) => Some(&refusal.reason),
        }
    }
}
