//! Two plans one after the other, where the first ends as the second starts: the same robot up to the
//! names of its modules and a rigid motion.

use super::carry::Carrier;
use super::seam::join_stages;
use super::time::{DURATION_MAX, tick_after};
use super::{
    Body, Change, Keyframe, Margins, Node, NodePaths, OperationError, Plan, Program, Settings, Stability,
    Tracks, TrussLimits, WorldFrom,
};
use crate::robot::matching;
use std::sync::Arc;

/// How far joints may be apart at the seam, rad or m: what rounding explains and no eye sees.
pub const TOL_SEAM_JOINT: f64 = 1e-6;
/// How far nodes of a truss may be apart at the seam, m.
pub const TOL_SEAM_NODE: f64 = 1e-6;

/// `p ++ q`. Names, base and library are those of `p`; each part keeps its world; the judge is as
/// strict as the stricter part asks. The renaming is recorded in the history.
pub fn joined(p: &Plan, q: &Plan) -> Result<Plan, OperationError> {
    let seam = p.body.duration();
    let duration = seam + q.body.duration();
    if duration > DURATION_MAX {
        return Err(OperationError::TooLong { duration });
    }
    match (&p.body, &q.body) {
        (Body::Tracks(a), Body::Tracks(b)) => join_tracks(p, q, a, b),
        (Body::NodePaths(a), Body::NodePaths(b)) => {
            let mut new = framed(p, q, seam, vec![]);
            new.body = Body::NodePaths(join_paths(a, b, p.causes.len() as u32)?);
            new.exemptions.extend(q.exemptions.iter().map(|e| {
                let cause = super::CauseId(e.cause.0 + p.causes.len() as u32);
                super::Exemption { from: e.from + seam, to: e.to + seam, cause, ..e.clone() }
            }));
            Ok(new)
        }
        (Body::Stages(a), Body::Stages(b)) => {
            if p.library.cells.get(a.cell) != q.library.cells.get(b.cell) {
                return Err(OperationError::Cells);
            }
            let mut new = framed(p, q, seam, vec![]);
            new.body = Body::Stages(join_stages(a, b, p.causes.len() as u32)?);
            Ok(new)
        }
        _ => Err(OperationError::Families),
    }
}

fn join_tracks(p: &Plan, q: &Plan, a: &Tracks, b: &Tracks) -> Result<Plan, OperationError> {
    let seam = a.duration;
    let end = a.end();
    let found =
        matching((&a.robot, &end), (&b.robot, &b.start), TOL_SEAM_JOINT).map_err(OperationError::Robots)?;
    let carrier = Carrier::new(a, b, &found, p.causes.len() as u32);
    let renamed = carrier.renamed(&b.robot);
    let mut new = framed(p, q, seam, renamed);
    new.exemptions.extend(q.exemptions.iter().map(|e| carrier.exemption(e, seam)));
    new.program = match (&p.program, &q.program) {
        (Some(first), Some(second)) => {
            let second = carrier.program(&second.root);
            Some(Program { root: Arc::new(Node::Series(vec![first.root.clone(), second])) })
        }
        (None, None) => None,
        _ => {
            let reason = "one of the two plans that were joined has none".to_string();
            new.provenance.history.push(Change::ProgramDropped(reason));
            None
        }
    };
    new.body = Body::Tracks(carrier.tracks(a, b));
    Ok(new)
}

/// The first plan with all of the second that does not name its robot.
fn framed(p: &Plan, q: &Plan, seam: f64, renamed: Vec<(String, String)>) -> Plan {
    let mut new = p.clone();
    new.worlds.extend(q.worlds.iter().map(|w| WorldFrom { from: w.from + seam, world: w.world }));
    // A world that no time is left for, at the seam of an empty plan, gives way to the next.
    let empty =
        |i: usize, worlds: &[WorldFrom]| worlds.get(i + 1).is_some_and(|next| next.from <= worlds[i].from);
    let kept: Vec<WorldFrom> =
        (0..new.worlds.len()).filter(|&i| !empty(i, &new.worlds)).map(|i| new.worlds[i].clone()).collect();
    new.worlds = kept;
    new.worlds.dedup_by(|next, before| next.world == before.world);
    new.settings = stricter(&p.settings, &q.settings);
    new.nominal = p.nominal || q.nominal;
    new.causes.extend(q.causes.iter().cloned());
    new.provenance.sources.extend(q.provenance.sources.iter().cloned());
    new.provenance.sources.sort();
    new.provenance.sources.dedup();
    if new.provenance.planner != q.provenance.planner {
        new.provenance.planner = format!("{}, {}", new.provenance.planner, q.provenance.planner);
    }
    let appended = q.provenance.history.clone();
    new.provenance.bound = None;
    new.provenance.history.push(Change::Joined { at: seam, renamed, appended });
    new.verdict = None;
    new
}

fn stricter(a: &Settings, b: &Settings) -> Settings {
    let stability = if a.stability == b.stability { a.stability } else { Stability::Footprint };
    Settings {
        sample: a.sample.min(b.sample),
        unstable_for: a.unstable_for.min(b.unstable_for),
        stability,
        samples_max: a.samples_max.max(b.samples_max),
    }
}

fn join_paths(a: &NodePaths, b: &NodePaths, causes: u32) -> Result<NodePaths, OperationError> {
    if a.struts != b.struts || a.node_names.len() != b.node_names.len() {
        return Err(OperationError::Trusses { node: None });
    }
    let seam = tick_after(a.duration());
    let (end, start) = (a.state(seam), b.state(0.0));
    let apart =
        end.iter().zip(&start).position(|(p, q)| p.iter().zip(q).any(|(x, y)| (x - y).abs() > TOL_SEAM_NODE));
    if let Some(node) = apart {
        return Err(OperationError::Trusses { node: Some(a.node_names[node].clone()) });
    }
    if a.surroundings != b.surroundings {
        return Err(OperationError::Surroundings);
    }
    let mut new = a.clone();
    // Each part keeps its own; the whole keeps what both do.
    if a.limits != b.limits {
        new.limits = TrussLimits::default();
    }
    let margins = |margins: Margins| if a.limits == b.limits { margins } else { Margins::default() };
    new.keyframes.iter_mut().for_each(|keyframe| keyframe.margins = margins(keyframe.margins));
    new.keyframes.extend(b.keyframes.iter().skip(1).map(|k| Keyframe {
        time: k.time + seam,
        cause: super::CauseId(k.cause.0 + causes),
        margins: margins(k.margins),
        ..k.clone()
    }));
    Ok(new)
}
