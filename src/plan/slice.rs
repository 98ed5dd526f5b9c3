//! A stretch of a plan as a plan of its own.

use super::reverse::retell;
use super::time::tick_near;
use super::{
    Body, Change, Exemption, Interpolation, Keyframe, Margins, NodePaths, OperationError, Plan, Stages,
    Track, Tracks, WorldFrom,
};

/// The plan between two times in seconds, each rounded to the nearest tick, clipped to the plan. The
/// program is told anew from the tracks, or dropped with the reason in the history.
pub fn sliced(plan: &Plan, from: f64, to: f64) -> Result<Plan, OperationError> {
    let duration = plan.body.duration();
    let (from, to) = (tick_near(from).max(0.0), tick_near(to).min(duration));
    if from > to || !from.is_finite() || !to.is_finite() {
        return Err(OperationError::Times { from, to });
    }
    let mut new = plan.clone();
    new.body = match &plan.body {
        Body::Tracks(tracks) => Body::Tracks(tracks.sliced(from, to)),
        Body::Stages(stages) => Body::Stages(stages.sliced(from, to)?),
        Body::NodePaths(paths) => Body::NodePaths(paths.sliced(from, to)),
    };
    new.exemptions = plan.exemptions.iter().filter_map(|e| clipped(e, from, to)).collect();
    let holds = plan.worlds.iter().rposition(|w| w.from <= from).unwrap_or(0);
    let worlds = plan.worlds.iter().skip(holds).filter(|w| w.from <= from || w.from < to);
    new.worlds = worlds.map(|w| WorldFrom { from: (w.from - from).max(0.0), world: w.world }).collect();
    new.verdict = None;
    new.provenance.bound = None;
    new.provenance.history.push(Change::Sliced { from, to });
    retell(&mut new, plan.program.is_some());
    Ok(new)
}

fn clipped(exemption: &Exemption, from: f64, to: f64) -> Option<Exemption> {
    let (start, end) = (exemption.from.max(from), exemption.to.min(to));
    (start <= end).then(|| Exemption { from: start - from, to: end - from, ..exemption.clone() })
}

impl Tracks {
    /// Between two times. Docks at the first instant have happened, those at the last happen.
    pub fn sliced(&self, from: f64, to: f64) -> Tracks {
        let track = |t: &Track| {
            let pieces = t.segments.iter().filter_map(|s| s.between(from, to)).map(|mut s| {
                (s.start, s.end) = (s.start - from, s.end - from);
                s
            });
            Track { joint: t.joint, segments: pieces.collect() }
        };
        let docks = self.docks.iter().filter(|d| from < d.time && d.time <= to).cloned().map(|mut d| {
            d.time -= from;
            d
        });
        Tracks {
            start: self.state(from),
            tracks: self.tracks.iter().map(track).filter(|t| !t.segments.is_empty()).collect(),
            docks: docks.collect(),
            duration: to - from,
            ..self.clone()
        }
    }
}

/// How far from the border of a stage a cut may be, s: what rounding explains.
const TOL_STAGE_BORDER: f64 = 1e-9;

impl Stages {
    /// Between two borders of stages: within a stage the cells move.
    fn sliced(&self, from: f64, to: f64) -> Result<Stages, OperationError> {
        let instants = self.instants();
        let border = |t: f64| {
            let found = instants.iter().position(|i| (i - t).abs() <= TOL_STAGE_BORDER * (1.0 + t));
            found.ok_or(OperationError::InsideStage { time: t })
        };
        let (first, last) = (border(from)?, border(to)?);
        let start = self.before(first);
        Ok(Stages { start, stages: self.stages[first..last].to_vec(), ..self.clone() })
    }
}

impl NodePaths {
    fn sliced(&self, from: f64, to: f64) -> NodePaths {
        let inside = self.keyframes.iter().filter(|k| from < k.time && k.time < to).map(|k| k.time);
        let mut times: Vec<f64> = std::iter::once(from).chain(inside).collect();
        if to > from {
            times.push(to);
        }
        let mut before = from;
        let keyframe = |time: f64| {
            let after = self.keyframes.partition_point(|k| k.time < time).min(self.keyframes.len() - 1);
            let keyframe = &self.keyframes[after];
            let whole = keyframe.time - self.keyframes[after.saturating_sub(1)].time;
            let interpolation = match keyframe.interpolation {
                Interpolation::RigidRoll { edge, angle } if whole > 0.0 => {
                    Interpolation::RigidRoll { edge, angle: angle * ((time - before) / whole) }
                }
                other => other,
            };
            before = time;
            // Where it is cut the margins are others.
            let margins = if keyframe.time == time { keyframe.margins } else { Margins::default() };
            Keyframe {
                time: time - from,
                interpolation,
                nodes: self.state(time),
                cause: keyframe.cause,
                margins,
            }
        };
        NodePaths { keyframes: times.into_iter().map(keyframe).collect(), ..self.clone() }
    }
}
