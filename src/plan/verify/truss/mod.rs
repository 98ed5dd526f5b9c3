//! The judgement of trusses, whose plans are paths of nodes: in closed form, and by bounds on the rates of distances
//! (conservative advancement).
//!
//! Between two keyframes all nodes move on straight lines at one rate, or the truss rolls over an edge as one
//! rigid body. Of each step the checks are made in this order: lengths of struts and their rates, distances
//! between struts, distances to obstacles, shape (angles, sums of lengths), rigidity, the ground, static
//! stability, and the forces that hold the truss; last the margins that the plan states at its keyframes. Struts are line segments without thickness
//! that keep a clearance from each other; half of a strut's mass is at each of its ends.

mod checks;
mod judgement;
mod lengths;
mod loads;
mod rigidity;
mod sample_budget;
mod shape;
mod stated_margins;
mod strut_distance;
mod support;
mod surroundings;
mod tolerances;

use super::ledger::Ledger;
use crate::geometry::{HeightField, Vec3};
use crate::interrupt;
use crate::plan::{CheckKind, Interpolation, NodePaths, Plan, Verdict};
use crate::robot::truss_statics::{Layout, Modes};
use judgement::{Judgement, Step};
use loads::LoadMonitor;
use rigidity::RigidityMonitor;
use sample_budget::SampleBudget;
use support::StabilityMonitor;
use tolerances::Tolerances;

/// Returns the verdict on a truss plan, whose body is `paths`. The plan must pass
/// [`validation::check`](crate::plan::validation::check), which is not done here: for one that does not, the verdict
/// may be wrong, or this panics.
pub(super) fn judge(plan: &Plan, paths: &NodePaths) -> Verdict {
    let mut ledger = Ledger::new(&plan.exemptions, paths.duration());
    let corners = if paths.limits.angle > 0.0 { shape::corners(paths) } else { Vec::new() };
    let strut = &plan.library.struts[paths.strut];
    let steepest = paths.surroundings.terrain.as_ref().map_or(0.0, HeightField::steepest);
    let mut judged = Judgement {
        paths,
        tolerances: Tolerances::default(),
        samples: SampleBudget::new(),
        corners,
        strut,
        obstacles: Vec::new(),
        layout: Layout::new(paths.node_names.len(), &paths.struts),
        rigidity: paths.limits.rigidity,
        steepest,
    };
    // Checks that do not depend on time: obstacles, corners, node positions at the keyframes.
    match surroundings::obstacles(paths) {
        Ok(obstacles) => judged.obstacles = obstacles,
        Err(why) => ledger.fail(judged.failure(CheckKind::Form, 0.0, vec![], format!("an obstacle: {why}"))),
    }
    let places: Vec<Vec<Vec3>> = paths
        .keyframes
        .iter()
        .map(|keyframe| keyframe.nodes.iter().map(|p| Vec3::from(*p)).collect())
        .collect();
    let world_at = |t: f64| {
        let last = plan.worlds.partition_point(|w| w.from <= t).max(1) - 1;
        plan.worlds[last].world
    };
    if judged.rigidity == 0.0 {
        let (start, _) = rigidity::weakest(paths, &judged.layout, &places[0], &mut Modes::default());
        let Tolerances { rigidity_limit, rigidity_part, .. } = judged.tolerances;
        judged.rigidity = if start > judged.tolerances.stated_margin {
            rigidity_limit.min(rigidity_part * start)
        } else {
            0.0
        };
    }
    let mut standing = StabilityMonitor::new(&judged);
    let mut stiff = RigidityMonitor::new(&judged);
    let mut loads = LoadMonitor::new(&judged, &plan.exemptions);
    // The start.
    judged.enclosed(&places[0], &mut ledger);
    judged.at_rest(&places[0], world_at(0.0), &mut standing, &mut ledger);
    let mut rates = Vec::new();
    // Every step: lengths, accelerations, distances, obstacles, shape, ground, static stability.
    for (i, keyframe) in paths.keyframes.iter().enumerate().skip(1) {
        interrupt::progress_checkpoint(|| format!("step {i} of {}", paths.keyframes.len() - 1));
        let begins = paths.keyframes[i - 1].time;
        let step = Step {
            from: places[i - 1].clone(),
            to: places[i].clone(),
            interpolation: keyframe.interpolation,
            ramps: keyframe.ramps,
            start: begins,
            duration: keyframe.time - begins,
        };
        let world = world_at(begins);
        let [starts, ends] = judged.lengths(&step, &mut ledger);
        judged.jumps((&rates, &starts), begins, &mut ledger);
        rates = ends;
        judged.distances(&step, &mut ledger);
        judged.obstacles(&step, &mut ledger);
        judged.shape(&step, &mut ledger);
        stiff.step(&step, i, &mut ledger);
        if world.has_floor() {
            judged.ground(&step, &mut ledger);
            if world.gravity > 0.0 {
                let stood = ledger.verdict.failures.len();
                standing.step(&step, &mut ledger);
                // Forces are of no interest where it topples.
                if ledger.verdict.failures.len() == stood {
                    let next = paths.keyframes.get(i + 1).map(|keyframe| keyframe.interpolation);
                    let tips = matches!(next, Some(Interpolation::RigidRoll { .. }));
                    loads.step((&step, tips), i, world, &standing, &mut ledger);
                }
            }
        }
        // Only gravity on a ground makes a truss roll.
        if let Interpolation::RigidRoll { .. } = keyframe.interpolation
            && (world.gravity == 0.0 || !world.has_floor())
        {
            let message = "without gravity and a ground nothing makes it roll".to_string();
            ledger.fail(judged.failure(CheckKind::Ground, begins, vec![], message));
        }
    }
    judged.jumps((&rates, &[]), paths.duration(), &mut ledger);
    // The margins that the plan states at its keyframes.
    for (keyframe, x) in
        paths.keyframes.iter().zip(&places).filter(|(keyframe, _)| !keyframe.margins.is_none())
    {
        if let Some(failure) = judged.margins(&keyframe.margins, x, keyframe.time, &standing) {
            ledger.fail(failure);
        }
    }
    judged.summary(&places, &standing, plan, &mut ledger);
    ledger.check(CheckKind::Rigidity, stiff.status());
    loads.conclude(&mut ledger);
    ledger.finish()
}
