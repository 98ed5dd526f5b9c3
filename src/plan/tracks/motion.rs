//! The body of plans of articulated robots: joint trajectories, piecewise polynomial, with docking and undocking.

use super::obstacle::Obstacle;
use crate::plan::cause::CauseId;
use crate::plan::polynomial;
use crate::robot::{Assembly, JointId, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The trajectory of an articulated robot: the position of each joint over time, as piecewise polynomials in Bernstein
/// form, and the bonds that hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracks {
    /// The robot, with every bond that exists at some time.
    pub robot: Assembly,
    /// The joint positions and bonds before the first motion, and the pose of the base.
    pub start: State,
    /// The joint trajectories, at most one a joint, ascending by joint. A joint without a track keeps its start
    /// position.
    pub tracks: Vec<Track>,
    /// The changes of bonds, in order of time.
    pub events: Vec<DockingEvent>,
    /// The duration of the motion, s.
    pub duration: f64,
    /// The obstacles that the robots must not touch.
    pub obstacles: Arc<[Obstacle]>,
    /// The causes of the start pose, each as (joint, cause).
    pub start_causes: Vec<(JointId, CauseId)>,
    /// The causes of bonds, each as (index of the bond in the robot, cause); a bond may have none.
    pub bond_causes: Vec<(usize, CauseId)>,
}

/// The trajectory of one joint: segments in order of time that do not overlap. Between two segments and after
/// the last, the joint holds the end position of the segment before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// The joint of which the trajectory is.
    pub joint: JointId,
    /// The segments, in order of time.
    pub segments: Vec<Segment>,
}

/// A polynomial piece in Bernstein form over the interval of time `start..end`: the control points bound it, the
/// first and last are its end positions exactly, reversing them reverses the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// The start of the segment from the start of the plan, s.
    pub start: f64,
    /// The end of the segment from the start of the plan, s; after `start`.
    pub end: f64,
    /// The Bernstein control points over the segment's interval of time, rad or m: one more than the degree, 2 to 16
    /// of them.
    pub control: Vec<f64>,
    /// The index in the plan's causes of the source command that this segment comes from.
    pub cause: CauseId,
}

/// A change of a bond between two ports: it begins to hold, or ceases to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DockingKind {
    /// The bond begins to hold.
    Dock,
    /// The bond ceases to hold.
    Undock,
}

/// An instant at which a bond begins or ceases to hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DockingEvent {
    /// The time of the event from the start of the plan, s.
    pub time: f64,
    /// The change of the bond: it begins or ceases to hold.
    pub kind: DockingKind,
    /// The index of the bond in [`Assembly::bonds`].
    pub bond: usize,
    /// The index in the plan's causes of the source command that this event comes from.
    pub cause: CauseId,
}

impl Segment {
    /// Returns the argument of the polynomial at the time `t` (s), 0 to 1; that of the nearer end outside.
    pub fn argument(&self, t: f64) -> f64 {
        ((t - self.start) / (self.end - self.start)).clamp(0.0, 1.0)
    }

    /// Returns the position at the time `t` (s), rad or m; the end positions outside the segment.
    pub fn position(&self, t: f64) -> f64 {
        if t >= self.end { self.last() } else { polynomial::value(&self.control, self.argument(t)) }
    }

    /// Returns the velocity at the time `t` (s) within the segment, rad/s or m/s; outside that at the nearer end.
    pub fn velocity(&self, t: f64) -> f64 {
        let rates = polynomial::derivative(&self.control);
        polynomial::value(&rates, self.argument(t)) / (self.end - self.start)
    }

    /// Returns the position of the joint at the end of the segment, rad or m. Panics without control points.
    pub fn last(&self) -> f64 {
        self.control[self.control.len() - 1]
    }

    /// Returns the piece of the segment between two times (s), which are clipped to the segment; `None` if no time is
    /// left. `t0` and `t1`: the two times, the lesser first.
    pub fn between(&self, t0: f64, t1: f64) -> Option<Segment> {
        let (start, end) = (t0.max(self.start), t1.min(self.end));
        if start >= end {
            return None;
        }
        let control = if start == self.start && end == self.end {
            self.control.clone()
        } else {
            polynomial::part(&self.control, self.argument(start), self.argument(end))
        };
        Some(Segment { start, end, control, cause: self.cause })
    }
}

impl Track {
    /// Returns the index of the last segment that has begun at the time `t` (s); `None` before the first.
    pub(in crate::plan) fn begun(&self, t: f64) -> Option<usize> {
        self.segments.partition_point(|s| s.start <= t).checked_sub(1)
    }

    /// Returns the position at the time `t` (s), rad or m; `start` is the joint's position at the start of
    /// the plan.
    pub fn position(&self, start: f64, t: f64) -> f64 {
        self.begun(t).map_or(start, |i| self.segments[i].position(t))
    }

    /// Returns the velocity just after the time `t` (s), rad/s or m/s: 0 between segments, before the first and from
    /// the end of the last on.
    pub fn velocity(&self, t: f64) -> f64 {
        let segment = self.begun(t).map(|i| &self.segments[i]).filter(|s| t < s.end);
        segment.map_or(0.0, |s| s.velocity(t))
    }

    /// Returns (lower, upper) bounds on the position (rad or m) over the interval of time `t0..t1` (s), from the
    /// control points of the pieces; they may be a little wider than its range. `start` is the joint's position at the
    /// start of the plan.
    pub fn bounds(&self, start: f64, t0: f64, t1: f64) -> (f64, f64) {
        let at = self.position(start, t0);
        let first = self.begun(t0).unwrap_or(0);
        let within = self.segments[first..].iter().take_while(|s| s.start < t1);
        within.filter_map(|s| s.between(t0, t1)).fold((at, at), |(low, high), piece| {
            let (l, h) = polynomial::hull(&piece.control);
            (low.min(l), high.max(h))
        })
    }
}

impl Tracks {
    /// Returns the motion of a robot that stays in a state: it lasts no time, and nothing has a cause. `start`: the
    /// state.
    pub fn at_rest(robot: Assembly, start: State) -> Tracks {
        Tracks {
            robot,
            start,
            tracks: Vec::new(),
            events: Vec::new(),
            duration: 0.0,
            obstacles: Arc::default(),
            start_causes: Vec::new(),
            bond_causes: Vec::new(),
        }
    }

    /// Returns the track of a joint; `None` if it never moves.
    pub fn track(&self, joint: JointId) -> Option<&Track> {
        let at = self.tracks.binary_search_by_key(&joint, |t| t.joint).ok()?;
        Some(&self.tracks[at])
    }

    /// Returns joint positions and bonds at the time `t` (s), events at that very instant included; before the start as
    /// the plan begins, without events, and after the end as at the end. The base keeps its pose: the judge computes
    /// its motion.
    pub fn state(&self, t: f64) -> State {
        let mut state = self.start.clone();
        for track in &self.tracks {
            let joint = &mut state.joints[track.joint.0 as usize];
            *joint = track.position(*joint, t);
        }
        state.bonds = self.bonds(t);
        state.misalignments.retain(|error| state.bonds[error.bond]);
        state
    }

    /// Returns for each bond of the robot, by its index, true if it holds just after the time `t` (s).
    pub fn bonds(&self, t: f64) -> Vec<bool> {
        let mut bonds = self.start.bonds.clone();
        for dock in self.events.iter().take_while(|d| d.time <= t) {
            bonds[dock.bond] = dock.kind == DockingKind::Dock;
        }
        bonds
    }

    /// Returns the state in which the plan ends: joint positions, bonds, and the base at its start pose.
    pub fn end(&self) -> State {
        self.state(self.duration)
    }

    /// Returns (lower, upper) bounds on the position of a joint (rad or m) over the interval of time `t0..t1` (s); see
    /// [`Track::bounds`]. Panics if the robot has no such joint.
    pub fn bounds(&self, joint: JointId, t0: f64, t1: f64) -> (f64, f64) {
        let start = self.start.joints[joint.0 as usize];
        self.track(joint).map_or((start, start), |track| track.bounds(start, t0, t1))
    }

    /// Returns every instant (s) at which a segment begins or ends or a bond changes, with 0 and the end, ascending
    /// and each once.
    pub fn instants(&self) -> Vec<f64> {
        let segments = self.tracks.iter().flat_map(|t| t.segments.iter().flat_map(|s| [s.start, s.end]));
        let mut all: Vec<f64> =
            segments.chain(self.events.iter().map(|d| d.time)).chain([0.0, self.duration]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
