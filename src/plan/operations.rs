//! The operations on whole plans: run backwards, cut, and put one after the other. All are exact on
//! control points; what belongs to one family of bodies is in that family's folder, through [`Body`](super::Body).

use super::body::{Appended, Body};
use super::cause::CauseId;
use super::motion_plan::Plan;
use super::operation_error::OperationError;
use super::program::{Node, Program};
use super::provenance::Change;
use super::time::{DURATION_MAX, tick_near};
use super::tracks::Tracks;
use super::verify::articulated::{standing, tipped_base};
use super::world::{Exemption, Settings, Stability, WorldFrom};
use std::sync::Arc;

/// Returns the plan from its end to its start, exactly: of a plan on whole ticks of time, reversed
/// twice, the motion of the joints is the same again. A robot that has tipped begins as it lies.
///
/// The program is derived again from the tracks, or dropped with the reason in the history. The verdict is dropped,
/// as gravity does not run backwards, and so is the bound.
pub fn reversed(plan: &Plan) -> Plan {
    let duration = plan.body.duration();
    let exemption = |e: &Exemption| {
        let (from, to) = (duration - e.to, duration - e.from);
        Exemption { from, to, ..e.clone() }
    };
    let mut new = Plan {
        body: plan.body.reversed(),
        exemptions: plan.exemptions.iter().rev().map(exemption).collect(),
        paths: plan.paths.iter().rev().map(|path| path.reversed(duration)).collect(),
        worlds: reversed_worlds(&plan.worlds, duration),
        ..plan.clone()
    };
    stand(&mut new, plan, duration);
    new.provenance.shapes = new.provenance.shapes.map(|(from, to)| (to, from));
    record(&mut new, Change::Reversed);
    derive_program(&mut new);
    new
}

/// Returns the plan between two times in seconds, each rounded to the nearest tick, clipped to the plan. Both ends
/// are kept: a slice may last no time.
///
/// The program is derived again from the tracks, or dropped with the reason in the history; verdict and bound are
/// dropped.
///
/// # Errors
/// [`OperationError::Times`] if the slice ends before it begins (NaN counts as the end of the plan that it stands for),
/// and [`OperationError::InsideStage`] if a lattice's plan would be cut within a stage.
pub fn sliced(plan: &Plan, from: f64, to: f64) -> Result<Plan, OperationError> {
    let duration = plan.body.duration();
    let (from, to) = (tick_near(from).max(0.0), tick_near(to).min(duration));
    if from > to || !from.is_finite() || !to.is_finite() {
        return Err(OperationError::Times { from, to });
    }
    let exemption = |e: &Exemption| {
        let (start, end) = (e.from.max(from), e.to.min(to));
        (start <= end).then(|| Exemption { from: start - from, to: end - from, ..e.clone() })
    };
    let holds = plan.worlds.iter().rposition(|w| w.from <= from).unwrap_or(0);
    let worlds = plan.worlds.iter().skip(holds).filter(|w| w.from <= from || w.from < to);
    let mut new = Plan {
        body: plan.body.sliced(from, to)?,
        exemptions: plan.exemptions.iter().filter_map(exemption).collect(),
        paths: plan.paths.iter().filter_map(|path| path.between(from, to)).collect(),
        worlds: worlds.map(|w| WorldFrom { from: (w.from - from).max(0.0), world: w.world }).collect(),
        ..plan.clone()
    };
    stand(&mut new, plan, from);
    record(&mut new, Change::Sliced { from, to });
    derive_program(&mut new);
    Ok(new)
}

/// Returns `p ++ q`: the one plan, then the other, which must start as the first ends: with the same robot up to the
/// names of its modules and a rigid motion.
///
/// Names, base and library are those of `p`; each part keeps its world; the judge is as strict as the stricter part
/// asks. The renaming is recorded in the history; verdict and bound are dropped, and the program unless both have one.
///
/// # Errors
/// The [`OperationError`] that keeps the plans from following each other, [`OperationError::TooLong`] if together they
/// last longer than [`DURATION_MAX`].
pub fn joined(p: &Plan, q: &Plan) -> Result<Plan, OperationError> {
    let at = p.body.duration();
    let duration = at + q.body.duration();
    if duration > DURATION_MAX {
        return Err(OperationError::TooLong { duration });
    }
    // A robot does not get from one slope onto another at once.
    let slope = |plan: &Plan| plan.worlds.first().map(|first| first.world.slope);
    if slope(p) != slope(q) {
        return Err(OperationError::Surroundings);
    }
    let causes = p.causes.len() as u32;
    let Appended { body, remap } = p.body.joined(&p.library, &q.body, &q.library, causes)?;
    let renamed = match (&remap, q.body.tracks()) {
        (Some(remap), Some(tracks)) => remap.renamed(&tracks.robot),
        _ => vec![],
    };
    let mut new = concatenated(p, q, at, renamed);
    new.exemptions.extend(q.exemptions.iter().map(|e| match &remap {
        Some(remap) => remap.exemption(e, at),
        None => {
            Exemption { from: e.from + at, to: e.to + at, cause: CauseId(e.cause.0 + causes), ..e.clone() }
        }
    }));
    new.paths.extend(q.paths.iter().filter_map(|path| remap.as_ref()?.path(path, at)));
    new.program = match (&p.program, &q.program, &remap) {
        (Some(first), Some(second), Some(remap)) => {
            let second = remap.program(&second.root);
            Some(Program { root: Arc::new(Node::Series(vec![first.root.clone(), second])) })
        }
        (Some(_), None, Some(_)) | (None, Some(_), Some(_)) => {
            let reason = "one of the two plans that were joined has none".to_string();
            new.provenance.history.push(Change::ProgramDropped(reason));
            None
        }
        (_, _, _) => new.program,
    };
    new.body = body;
    Ok(new)
}

/// Returns the plan with `tracks`, which go along the same path with another time law. `clock` gives the new time (s)
/// of each time of the plan (s), never decreasing; `reserve` is the fraction of the limits of torque that was to be
/// left, as the history records it.
///
/// Worlds and exemptions hold for the same parts of the path. The program is derived again from the tracks, by the
/// clock and without sensors, or dropped with the reason in the history; verdict and bound are dropped.
pub fn retimed(plan: &Plan, tracks: Tracks, clock: &dyn Fn(f64) -> f64, reserve: f64) -> Plan {
    let exemption = |e: &Exemption| Exemption { from: clock(e.from), to: clock(e.to), ..e.clone() };
    let mut new = Plan {
        body: tracks.into(),
        exemptions: plan.exemptions.iter().map(exemption).collect(),
        paths: plan.paths.iter().map(|path| path.retimed(clock)).collect(),
        worlds: plan.worlds.iter().map(|w| WorldFrom { from: clock(w.from), world: w.world }).collect(),
        nominal: false,
        ..plan.clone()
    };
    record(&mut new, Change::Retimed { before: plan.body.duration(), reserve });
    derive_program(&mut new);
    new
}

/// Sets the start of a plan to where its robots stand at a time (s) of the plan that it is a part of, if there are several
/// then, that plan began with several, or its one robot has tipped.
fn stand(new: &mut Plan, whole: &Plan, time: f64) {
    let Body::Tracks(tracks) = &mut new.body else { return };
    let start = &mut tracks.start;
    match standing(whole, time) {
        Some(then)
            if !then.clusters.is_empty() || !start.clusters.is_empty() || !then.misalignments.is_empty() =>
        {
            (start.base, start.clusters, start.misalignments) =
                (then.base, then.clusters, then.misalignments);
        }
        _ => start.base = tipped_base(whole, time).unwrap_or(start.base),
    }
}

/// Writes a change into the history; what was proved or judged of the plan before holds no more.
fn record(plan: &mut Plan, change: Change) {
    plan.verdict = None;
    (plan.provenance.bound, plan.provenance.reached) = (None, None);
    plan.provenance.history.push(change);
}

/// Replaces the program, if there was one, by that of the tracks.
fn derive_program(plan: &mut Plan) {
    if plan.program.take().is_none() {
        return;
    }
    match plan.body.timeline() {
        Ok(root) => plan.program = Some(Program { root }),
        Err(reason) => plan.provenance.history.push(Change::ProgramDropped(reason.to_string())),
    }
}

/// Returns the worlds in reverse: each holds up to where the next began.
fn reversed_worlds(worlds: &[WorldFrom], duration: f64) -> Vec<WorldFrom> {
    let ends = worlds.iter().skip(1).map(|w| w.from).chain([duration]);
    let mut new: Vec<WorldFrom> =
        worlds.iter().zip(ends).map(|(w, end)| WorldFrom { from: duration - end, world: w.world }).collect();
    new.reverse();
    new
}

/// Returns the first plan with all of the second that does not name its robot, appended at a time.
fn concatenated(p: &Plan, q: &Plan, at: f64, renamed: Vec<(String, String)>) -> Plan {
    let mut new = p.clone();
    new.worlds.extend(q.worlds.iter().map(|w| WorldFrom { from: w.from + at, world: w.world }));
    // A world that no time is left for, after an empty plan, is replaced by the next.
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
    record(&mut new, Change::Joined { at, renamed, appended });
    new
}

/// Returns settings that are as strict as both.
fn stricter(a: &Settings, b: &Settings) -> Settings {
    let stability = if a.stability == b.stability { a.stability } else { Stability::Footprint };
    Settings {
        sample: a.sample.min(b.sample),
        unstable_for: a.unstable_for.min(b.unstable_for),
        stability,
        reserve: a.reserve.max(b.reserve),
        slip_max: [a.slip_max, b.slip_max].into_iter().flatten().reduce(f64::min),
        slip: a.slip.max(b.slip),
        samples_max: a.samples_max.max(b.samples_max),
    }
}
