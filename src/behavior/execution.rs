//! The execution of a program step by step, as a controller carries it out: conditions are evaluated on what sensors
//! report, and bonds hold as the robot finds them.

use super::condition::Sensors;
use super::joints::{self, JointFacts};
use super::motion::Motion;
use super::refusal::Refusal;
use super::run::Run;
use super::schedule::Settings;
use crate::plan::time::tick_near;
use crate::plan::{CauseId, DockingEvent, Node, Tracks};
use crate::robot::JointId;
use std::sync::Arc;

/// The end of an execution.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The program came to its end.
    Done,
    /// The program was aborted, or a command could not be carried out; all joints were brought to rest.
    Stopped(Refusal),
}

/// A program that is executed: the discrete-event run of [`schedule`](super::schedule), driven by the clock and by sensors.
/// Cycles that are shifted or stretched go as planned: they have no conditions.
pub struct Execution<'a> {
    run: Run<'a>,
    /// The number of docking events that have been handed out.
    told: usize,
    ending: Option<Ending>,
}

impl<'a> Execution<'a> {
    /// Returns the execution of a program at time 0 s. `tracks`: those of the plan of the program, whose robot has all
    /// bonds that may hold; `program`: the root node.
    pub fn new(tracks: &Tracks, program: &'a Arc<Node>) -> Execution<'a> {
        let facts: Vec<JointFacts> = joints::facts(&tracks.robot);
        let motions = tracks.start.joints.iter().map(|&position| Motion::at_rest(position)).collect();
        let robot = Arc::new(tracks.robot.clone());
        let mut run = Run::new(robot, facts, motions, tracks.start.bonds.clone(), Settings::default());
        run.executes = true;
        run.start_with(program);
        Execution { run, told: 0, ending: None }
    }

    /// Carries the program on up to a time (s, not before that of the last call), at which the sensors report. Returns the
    /// changes of bonds that it commands, in order of time.
    pub fn advance(&mut self, time: f64, sensors: &dyn Sensors) -> Vec<DockingEvent> {
        if self.ending.is_none() {
            match self.run.advance_to(tick_near(time), sensors) {
                Ok(false) => {}
                Ok(true) => self.ending = Some(Ending::Done),
                Err(refusal) => self.stop(refusal),
            }
        }
        let events = self.run.docks[self.told..].to_vec();
        self.told = self.run.docks.len();
        events
    }

    /// Brings all joints to rest, as far as their accelerations allow, and ends the execution.
    pub fn stop(&mut self, refusal: Refusal) {
        let cause = refusal.cause.unwrap_or(CauseId(0));
        (0..self.run.motions.len()).for_each(|joint| self.run.stop(JointId(joint as u32), cause));
        self.ending = Some(Ending::Stopped(refusal));
    }

    /// Says of a bond, by its index, whether it holds: it may have broken, or its ports were too far apart to dock.
    pub fn set_bond(&mut self, bond: usize, holds: bool) {
        self.run.holds[bond] = holds;
    }

    /// Returns the commanded position (rad or m) and rate of a joint, by the number in its `JointId`, at a time (s) that is
    /// not before that of the last [`advance`](Self::advance).
    pub fn command(&self, joint: usize, time: f64) -> (f64, f64) {
        let motion = &self.run.motions[joint];
        (motion.position(time), motion.rate(time))
    }

    /// Returns the end of the execution and the time (s) from which on all joints rest; `None` while it goes on. A joint
    /// that was left turning turns on.
    pub fn ending(&self) -> Option<(&Ending, f64)> {
        let rests = || self.run.motions.iter().filter_map(Motion::ends).fold(self.run.now, f64::max);
        self.ending.as_ref().map(|ending| (ending, rests()))
    }
}
