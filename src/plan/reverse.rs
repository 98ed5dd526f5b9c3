//! Plans run backwards: exact. Run backwards twice, a plan on whole ticks of time is the same again.

use super::timeline::timeline;
use super::{
    Body, Change, Dock, DockKind, Exemption, Interpolation, Keyframe, NodePaths, Plan, Program, Segment,
    Stage, Stages, Track, Tracks, WorldFrom,
};

/// The plan from its end to its start. The program is told anew from the tracks, or dropped with the
/// reason in the history; the verdict is dropped: gravity does not run backwards.
pub fn reversed(plan: &Plan) -> Plan {
    let duration = plan.body.duration();
    let mut new = plan.clone();
    new.body = match &plan.body {
        Body::Tracks(tracks) => Body::Tracks(tracks.reversed()),
        Body::Stages(stages) => Body::Stages(stages.reversed()),
        Body::NodePaths(paths) => Body::NodePaths(paths.reversed()),
    };
    new.exemptions = plan.exemptions.iter().rev().map(|e| turned(e, duration)).collect();
    new.worlds = worlds(&plan.worlds, duration);
    new.verdict = None;
    new.provenance.bound = None;
    new.provenance.history.push(Change::Reversed);
    retell(&mut new, plan.program.is_some());
    new
}

/// Replaces the program by what the tracks say.
pub(super) fn retell(plan: &mut Plan, had_program: bool) {
    plan.program = None;
    if !had_program {
        return;
    }
    let told = match &plan.body {
        Body::Tracks(tracks) => timeline(tracks),
        Body::Stages(_) | Body::NodePaths(_) => Err("only joints have a program".into()),
    };
    match told {
        Ok(root) => plan.program = Some(Program { root }),
        Err(reason) => plan.provenance.history.push(Change::ProgramDropped(reason)),
    }
}

fn turned(exemption: &Exemption, duration: f64) -> Exemption {
    let (from, to) = (duration - exemption.to, duration - exemption.from);
    Exemption { from, to, ..exemption.clone() }
}

/// Each world holds up to where the next began.
fn worlds(worlds: &[WorldFrom], duration: f64) -> Vec<WorldFrom> {
    let ends = worlds.iter().skip(1).map(|w| w.from).chain([duration]);
    let mut new: Vec<WorldFrom> =
        worlds.iter().zip(ends).map(|(w, end)| WorldFrom { from: duration - end, world: w.world }).collect();
    new.reverse();
    new
}

impl Segment {
    fn reversed(&self, duration: f64) -> Segment {
        let control = self.control.iter().rev().copied().collect();
        Segment { start: duration - self.end, end: duration - self.start, control, cause: self.cause }
    }
}

impl Tracks {
    /// From end to start: what was docked is undocked. The base stays where it was at the start.
    pub fn reversed(&self) -> Tracks {
        let d = self.duration;
        let track = |t: &Track| Track {
            joint: t.joint,
            segments: t.segments.iter().rev().map(|s| s.reversed(d)).collect(),
        };
        let dock = |k: &Dock| {
            let kind = match k.kind {
                DockKind::Dock => DockKind::Undock,
                DockKind::Undock => DockKind::Dock,
            };
            Dock { time: d - k.time, kind, ..k.clone() }
        };
        Tracks {
            start: self.end(),
            tracks: self.tracks.iter().map(track).collect(),
            docks: self.docks.iter().rev().map(dock).collect(),
            ..self.clone()
        }
    }
}

impl Stages {
    /// From end to start: each stage ends where it began.
    pub fn reversed(&self) -> Stages {
        let stage =
            |(i, s): (usize, &Stage)| Stage { end: self.before(i), law: s.law.reversed(), ..s.clone() };
        Stages {
            start: self.before(self.stages.len()),
            stages: self.stages.iter().enumerate().rev().map(stage).collect(),
            ..self.clone()
        }
    }
}

impl NodePaths {
    /// From end to start: rolls turn the other way.
    pub fn reversed(&self) -> NodePaths {
        let d = self.duration();
        let keyframes = &self.keyframes;
        let keyframe = |i: usize| {
            // The interpolation into the new keyframe is that out of the old one.
            let out = keyframes.get(i + 1).unwrap_or(&keyframes[0]);
            let interpolation = match out.interpolation {
                Interpolation::RigidRoll { edge, angle } => Interpolation::RigidRoll { edge, angle: -angle },
                Interpolation::Linear => Interpolation::Linear,
            };
            Keyframe {
                time: d - keyframes[i].time,
                interpolation,
                nodes: keyframes[i].nodes.clone(),
                cause: out.cause,
                margins: keyframes[i].margins,
            }
        };
        NodePaths { keyframes: (0..keyframes.len()).rev().map(keyframe).collect(), ..self.clone() }
    }
}
