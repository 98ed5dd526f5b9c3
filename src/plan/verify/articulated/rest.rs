//! Rest at the start and at the end, from the rates of the tracks' polynomials there.
//!
//! Before the start and after the end all joints stand still. A joint that begins or ends with a rate changes it at
//! once: that is a failure where its acceleration is limited, and else it can't be judged. The base is carried by
//! the joints; that it does not fall at the end is a matter of stability.

use super::tolerances::Tolerances;
use crate::plan::polynomial::derivative;
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CauseId, CheckKind, Failure, Segment, Status, Tracks};
use crate::robot::{Assembly, JointKind, JointOwner};
use crate::units::{Dimension, quantity};

/// A joint that does not begin or end at rest.
struct Jump {
    /// The path name of the joint.
    joint: String,
    /// The rate, rad/s or m/s, in words.
    words: String,
    /// The magnitude of the rate, rad/s or m/s.
    rate: f64,
    /// The time of the jump, s.
    time: f64,
    /// True at the end of the plan, false at the start.
    at_end: bool,
    /// True if the acceleration of the joint, or of a motor that drives it, is limited.
    limited: bool,
    /// The cause of the segment that begins or ends there.
    cause: CauseId,
}

/// Judges that all joints are at rest at the start and at the end of the plan. A joint that is not fails where an
/// acceleration limit is stated for it or its motor; without one the status says that it was not checked.
pub(super) fn judge(tracks: &Tracks, tolerances: &Tolerances, ledger: &mut Ledger) {
    let jumps = jumps(tracks, tolerances);
    for jump in jumps.iter().filter(|jump| jump.limited) {
        ledger.fail(jump.failure(tolerances));
    }
    // The last words are for the greatest rate; that of the end counts more.
    let worst = jumps
        .iter()
        .max_by(|x, y| (x.at_end, x.rate).partial_cmp(&(y.at_end, y.rate)).expect("rates are finite"));
    let status = worst.map_or(Status::Proved, |worst| {
        let others =
            jumps.iter().filter(|jump| jump.joint != worst.joint && jump.at_end == worst.at_end).count();
        let more = if others > 0 { format!(" (and {others} more)") } else { String::new() };
        Status::NotChecked(format!("{}{more}, and no greatest acceleration is stated", worst.in_words()))
    });
    ledger.check(CheckKind::Rest, status);
}

impl Jump {
    fn in_words(&self) -> String {
        let Jump { joint, words, .. } = self;
        match self.at_end {
            true => format!("{joint} stops at once from {words} at the end"),
            false => format!("{joint} begins at once with {words}"),
        }
    }

    fn failure(&self, tolerances: &Tolerances) -> Failure {
        Failure {
            kind: CheckKind::Rest,
            time: self.time,
            until: None,
            at: vec![self.joint.clone()],
            message: format!("{}, and its acceleration is limited", self.in_words()),
            value: self.rate,
            limit: tolerances.speed_jump,
            blame: vec![self.cause],
            blames_start: false,
        }
    }
}

/// Returns the joints that do not begin or end at rest, in order of track.
fn jumps(tracks: &Tracks, tolerances: &Tolerances) -> Vec<Jump> {
    let owners: Vec<JointOwner> = tracks.robot.joints().collect();
    let mut found = vec![];
    for track in &tracks.tracks {
        let owner = owners[track.joint.0 as usize];
        let first = track.segments.first().filter(|segment| segment.start <= 0.0);
        let last = track.segments.last().filter(|segment| segment.end >= tracks.duration);
        let ends = [first.map(|s| (s, s.start, false)), last.map(|s| (s, s.end, true))];
        for (segment, time, at_end) in ends.into_iter().flatten() {
            let rate = rate(segment, at_end);
            if rate.abs() > tolerances.speed_jump {
                let (dimension, limited) = kind(&tracks.robot, owner);
                found.push(Jump {
                    joint: tracks.robot.joint_name(owner),
                    words: quantity(rate.abs(), dimension),
                    rate: rate.abs(),
                    time,
                    at_end,
                    limited,
                    cause: segment.cause,
                });
            }
        }
    }
    found
}

/// Returns the rate of a joint at one of the ends of a segment, rad/s or m/s.
fn rate(segment: &Segment, at_end: bool) -> f64 {
    let rates = derivative(&segment.control);
    let rate = if at_end { rates.last() } else { rates.first() };
    rate.map_or(0.0, |rate| rate / (segment.end - segment.start))
}

/// Returns the dimension of a joint's rate, and true if a limit of acceleration is stated for it.
fn kind(robot: &Assembly, owner: JointOwner) -> (Dimension, bool) {
    match owner {
        JointOwner::Bond(bond) => {
            let limited = robot.hinge(bond).is_some_and(|hinge| hinge.limits.acceleration.is_some());
            (Dimension::ANGULAR_SPEED, limited)
        }
        JointOwner::Module { module, joint } => {
            let kind = robot.module_type(module);
            let drives =
                kind.motors.iter().filter(|motor| motor.joints.iter().any(|(index, _)| *index == joint));
            let mut limits = drives.map(|motor| &motor.limits).chain([&kind.joints[joint].limits]);
            let turns = kind.joints[joint].kind == JointKind::Revolute;
            let dimension = if turns { Dimension::ANGULAR_SPEED } else { Dimension::SPEED };
            (dimension, limits.any(|limits| limits.acceleration.is_some()))
        }
    }
}
