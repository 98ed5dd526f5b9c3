//! Cycles: behaviours shifted round their cycle, and stretched to a duration.
//!
//! The body is run by itself, beginning at the positions of the joints. For a phase it is run twice: the second
//! round begins where the first ended, as every further round of a cycle will. That round, begun at the shift and
//! wrapped round its end, is the phase.

use super::law::{self, MotionLimits, Piece};
use super::motion::Motion;
use super::played::Played;
use super::refusal::{Reason, Refusal, limit};
use super::run::Run;
use crate::plan::time::{tick_after, tick_near};
use crate::plan::visit::{Graph, has_contracts};
use crate::plan::{Action, CauseId, Command, Node, Profile, Segment, Target, Track};
use crate::robot::JointId;
use std::collections::BTreeSet;
use std::sync::Arc;

impl Run<'_> {
    /// Begins a node that shifts or scales a cycle: [`Node::Phase`], [`Node::Approach`] or [`Node::Stretch`]. Returns
    /// the time at which it ends, s. Panics for other nodes.
    ///
    /// # Errors
    /// A [`Refusal`] if the body is not cyclic, a number is out of range, or a limit is exceeded.
    pub(super) fn begin_cycle(&mut self, node: &Node) -> Result<f64, Refusal> {
        match node {
            Node::Stretch { body, duration, cause } => self.begin_stretch(body, *duration, *cause),
            Node::Phase { body, shift, cause } => {
                let (round, led) = self.approach(body, *shift, *cause)?;
                self.begin_round(&round, led, *cause)
            }
            Node::Approach { body, shift, cause } => Ok(self.approach(body, *shift, *cause)?.1),
            _ => unreachable!("only cycles are begun here"),
        }
    }

    /// Begins a stretch: the body's own run, scaled in time to the duration; returns the time at which it ends.
    fn begin_stretch(&mut self, body: &Arc<Node>, duration: f64, cause: CauseId) -> Result<f64, Refusal> {
        if !(duration >= 0.0 && duration.is_finite()) {
            return Err(Refusal::at(cause, Reason::BadNumber { what: "a duration", value: duration }));
        }
        let positions = self.positions();
        let played = self.run_body(body, positions, cause)?;
        let duration = tick_after(duration);
        let scale = if played.duration > 0.0 { duration / played.duration } else { 1.0 };
        let at = |t: f64| if t == played.duration { duration } else { tick_near(t * scale).min(duration) };
        for mut track in played.tracks {
            self.motions[track.joint.0 as usize].cut(self.now);
            for segment in &mut track.segments {
                (segment.start, segment.end) = (at(segment.start), at(segment.end));
            }
            self.splice(&track, self.now, cause)?;
        }
        for mut exemption in played.exemptions {
            (exemption.from, exemption.to) = (self.now + at(exemption.from), self.now + at(exemption.to));
            self.exemptions.push(exemption);
        }
        for mut contract in played.contracts {
            (contract.from, contract.to) = (self.now + at(contract.from), self.now + at(contract.to));
            self.contracts.push(contract);
        }
        self.actions += played.actions;
        Ok(self.now + duration)
    }

    /// Moves the joints to the beginning of the phase. Returns the round and the time at which they arrive.
    fn approach(&mut self, body: &Arc<Node>, shift: f64, cause: CauseId) -> Result<(Round, f64), Refusal> {
        let round = self.round(body, shift, cause)?;
        let mut lead: f64 = 0.0;
        for moved in round.tracks.iter().filter(|t| t.absolute) {
            lead = lead.max(self.lead(moved, cause)?);
        }
        let lead = tick_after(lead);
        for moved in &round.tracks {
            let motion = &mut self.motions[moved.joint.0 as usize];
            let at = motion.cut(self.now).0;
            if !moved.absolute {
                continue;
            }
            let pieces = law::rest_to_rest(Profile::Smooth, at, moved.begins, lead, MotionLimits::default());
            motion.append(self.now, pieces, cause);
        }
        Ok((round, self.now + lead))
    }

    /// Returns the least time for a joint to move to the beginning of the round; 0 if it is there.
    fn lead(&self, moved: &Moved, cause: CauseId) -> Result<f64, Refusal> {
        let at = self.motions[moved.joint.0 as usize].position(self.now);
        if (at - moved.begins).abs() <= self.settings.tol_begin {
            return Ok(0.0);
        }
        let facts = &self.facts[moved.joint.0 as usize];
        let able = MotionLimits { speed: facts.speed, acceleration: facts.acceleration };
        law::least_duration(Profile::Smooth, at - moved.begins, able)
            .ok_or_else(|| Refusal::at(cause, Reason::NoSpeed { joint: facts.name.clone() }))
    }

    /// Begins one round at the time `start`; returns the time at which it ends.
    fn begin_round(&mut self, round: &Round, start: f64, cause: CauseId) -> Result<f64, Refusal> {
        for moved in &round.tracks {
            let motion = &self.motions[moved.joint.0 as usize];
            let offset = if moved.absolute { 0.0 } else { motion.position(start) - moved.begins };
            let mut track = Track { joint: moved.joint, segments: moved.segments.clone() };
            track.segments.iter_mut().flat_map(|s| &mut s.control).for_each(|c| *c += offset);
            self.splice(&track, start, cause)?;
        }
        let end = start + round.duration;
        for exemption in &round.exemptions {
            let mut exemption = exemption.clone();
            (exemption.from, exemption.to) = (start, end);
            self.exemptions.push(exemption);
        }
        self.actions += round.actions;
        Ok(end)
    }

    /// Returns one round of the body's cycle, begun at `shift`.
    fn round(&mut self, body: &Arc<Node>, shift: f64, cause: CauseId) -> Result<Round, Refusal> {
        if !(0.0..=1.0).contains(&shift) {
            return Err(Refusal::at(cause, Reason::BadNumber { what: "a phase", value: shift }));
        }
        if has_contracts(body) {
            return Err(Refusal::at(cause, Reason::NotCyclic { what: "a behaviour with a contract" }));
        }
        let positions = self.positions();
        let first = self.run_body(body, positions, cause)?;
        let goes = moves(&first);
        let second = self.run_body(body, first.end, cause)?;
        let duration = second.duration;
        if goes && !moves(&second) {
            return Err(Refusal::at(
                cause,
                Reason::NotCyclic { what: "a behaviour that does not come back" },
            ));
        }
        let cut = tick_near(shift * duration);
        let absolute = absolute_joints(body);
        let tracks = second.tracks.iter().map(|track| {
            let start = second.joints[track.joint.0 as usize];
            let mut moved = wrapped(track, start, cut, duration);
            moved.absolute = absolute.contains(&track.joint);
            moved
        });
        Ok(Round {
            tracks: tracks.collect(),
            duration,
            exemptions: second.exemptions,
            actions: second.actions,
        })
    }

    /// Runs a body by itself from given positions.
    fn run_body(&mut self, body: &Arc<Node>, positions: Vec<f64>, cause: CauseId) -> Result<Played, Refusal> {
        limit(self.cycles + 1, self.settings.cycles_max, "cycles in cycles")?;
        if let Some(what) = not_cyclic(body) {
            return Err(Refusal::at(cause, Reason::NotCyclic { what }));
        }
        let motions = positions.into_iter().map(Motion::at_rest).collect();
        let (robot, facts, holds) = (self.robot.clone(), self.facts.clone(), self.holds.clone());
        let mut run = Run::new(robot, facts, motions, holds, self.settings);
        (run.cycles, run.steps, run.segments) = (self.cycles + 1, self.steps, self.segments);
        let played = run.play(body)?;
        self.steps = played.steps;
        for issue in &played.issues {
            if !self.issues.contains(issue) {
                self.issues.push(issue.clone());
            }
        }
        Ok(played)
    }

    /// Appends the segments of a track, which begins at `start`, to the joint's motion.
    fn splice(&mut self, track: &Track, start: f64, cause: CauseId) -> Result<(), Refusal> {
        self.count_segments(track.segments.len())?;
        let motion = &mut self.motions[track.joint.0 as usize];
        let mut end = start;
        for segment in &track.segments {
            let (from, to) = (start + segment.start, start + segment.end);
            if to <= from {
                return Err(Refusal::at(cause, Reason::TooShort));
            }
            let rest = Piece { duration: from - end, control: vec![segment.control[0]; 2] };
            motion.append(end, vec![rest], segment.cause);
            let piece = Piece { duration: to - from, control: segment.control.clone() };
            end = motion.append(from, vec![piece], segment.cause);
        }
        Ok(())
    }

    /// Returns the present positions of all joints, rad or m.
    fn positions(&self) -> Vec<f64> {
        self.motions.iter().map(|m| m.position(self.now)).collect()
    }
}

/// One round of a cycle, in its own time.
struct Round {
    tracks: Vec<Moved>,
    duration: f64,
    exemptions: Vec<crate::plan::Exemption>,
    actions: u64,
}

/// A joint's part in a round.
struct Moved {
    joint: JointId,
    /// The position at which the round begins, rad or m.
    begins: f64,
    segments: Vec<Segment>,
    /// `true` where the joint must begin there, `false` where it may do the same from elsewhere.
    absolute: bool,
}

/// Returns a track over one round, begun at `cut` and wrapped round the end of the round. The part after the
/// end continues from the joint's position then.
fn wrapped(track: &Track, start: f64, cut: f64, duration: f64) -> Moved {
    let gain = track.position(start, duration) - start;
    let mut segments = Vec::new();
    for segment in &track.segments {
        if let Some(mut late) = segment.between(cut, duration) {
            (late.start, late.end) = (late.start - cut, late.end - cut);
            segments.push(late);
        }
    }
    for segment in &track.segments {
        if let Some(mut early) = segment.between(0.0, cut) {
            (early.start, early.end) = (early.start + (duration - cut), early.end + (duration - cut));
            early.control.iter_mut().for_each(|c| *c += gain);
            segments.push(early);
        }
    }
    Moved { joint: track.joint, begins: track.position(start, cut), segments, absolute: false }
}

/// Returns the joints that a body moves to positions, and not only by displacements.
fn absolute_joints(body: &Arc<Node>) -> BTreeSet<JointId> {
    let places = Graph::of(body);
    let absolute = places.actions().filter_map(|action| match action.command {
        Command::Move { joint, target: Target::To(_), .. } | Command::Follow { joint, .. } => Some(joint),
        _ => None,
    });
    absolute.collect()
}

/// Returns the part of a behaviour that cannot be shifted or scaled, in words; `None` if there is none.
fn not_cyclic(body: &Arc<Node>) -> Option<&'static str> {
    let graph = Graph::of(body);
    if graph.nodes.iter().any(|node| matches!(***node, Node::Repeat { until: Some(_), .. })) {
        return Some("a condition");
    }
    let goal = graph.nodes.iter().find_map(|node| match &***node {
        Node::Goal(goal) => Some(goal.name()),
        _ => None,
    });
    if goal.is_some() {
        return goal;
    }
    graph.actions().find_map(|Action { command, until, timeout, .. }| match command {
        _ if until.is_some() => Some("a condition"),
        _ if timeout.is_some() => Some("a timeout"),
        Command::Dock { .. } => Some("docking"),
        Command::Undock { .. } => Some("undocking"),
        _ => None,
    })
}

/// Returns `true` where any joint moves.
fn moves(played: &Played) -> bool {
    let segments = played.tracks.iter().flat_map(|track| &track.segments);
    segments.into_iter().any(|s| s.control.iter().any(|q| *q != s.control[0]))
}
