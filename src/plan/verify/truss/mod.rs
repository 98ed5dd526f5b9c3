//! The judgement of trusses, whose plans are paths of nodes: in closed form, and by bounds on the rates of distances
//! (conservative advancement).
//!
//! Between two keyframes all nodes move on straight lines at one rate, or the truss rolls over an edge as one
//! rigid body. Of each step the checks are made in this order: lengths of struts and their rates, distances
//! between struts, distances to obstacles, shape (angles, sums of lengths), rigidity, the ground, static
//! stability, the forces that hold the truss, and the margins that the plan states at its keyframes. At an event, where nodes
//! merge or split, the truss is at rest, and judged with the ends that struts have before and after (`events`). Struts are line segments without thickness
//! that keep a clearance from each other; half of a strut's mass is at each of its ends.

mod checks;
mod events;
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
use crate::geometry::HeightField;
use crate::interrupt;
use crate::plan::{CheckKind, Interpolation, NodePaths, Plan, Status, Topology, Verdict, World};
use crate::robot::truss_statics::{Layout, Modes};
use events::{Monitors, Stretch};
use judgement::{Judgement, Step};
use loads::{LoadMonitor, looked_at};
use rigidity::RigidityMonitor;
use sample_budget::SampleBudget;
use support::StabilityMonitor;
use tolerances::Tolerances;

/// Returns the verdict on a truss plan, whose body is `paths`. The plan must pass
/// [`validation::check`](crate::plan::validation::check), which is not done here: for one that does not, the verdict
/// may be wrong, or this panics.
pub(super) fn judge(plan: &Plan, paths: &NodePaths) -> Verdict {
    let mut ledger = Ledger::new(&plan.exemptions, paths.duration());
    let strut = &plan.library.struts[paths.strut];
    let steepest = paths.surroundings.terrain.as_ref().map_or(0.0, HeightField::steepest);
    let mut judged = Judgement {
        paths,
        nodes: Vec::new(),
        carried: Vec::new(),
        struts: Vec::new(),
        stretch: Stretch::default(),
        event: None,
        tolerances: Tolerances::default(),
        samples: SampleBudget::new(),
        corners: Vec::new(),
        strut,
        obstacles: Vec::new(),
        layout: Layout::new(0, &[]),
        rigidity: paths.limits.rigidity,
        steepest,
    };
    let mut topology = paths.topology_at_start();
    judged.enter(&topology, 0, None);
    // Checks that do not depend on time: obstacles, positions of the nodes at the start.
    match surroundings::obstacles(paths) {
        Ok(obstacles) => judged.obstacles = obstacles,
        Err(why) => ledger.fail(judged.failure(CheckKind::Form, 0.0, vec![], format!("an obstacle: {why}"))),
    }
    let world_at = |t: f64| {
        let last = plan.worlds.partition_point(|w| w.from <= t).max(1) - 1;
        plan.worlds[last].world
    };
    let start = judged.places(0);
    if judged.rigidity == 0.0 {
        let (least, _) = rigidity::weakest(&judged, &start, &mut Modes::default());
        let Tolerances { rigidity_limit, rigidity_part, .. } = judged.tolerances;
        judged.rigidity = if least > judged.tolerances.stated_margin {
            rigidity_limit.min(rigidity_part * least)
        } else {
            0.0
        };
    }
    let mut monitors = Monitors {
        standing: StabilityMonitor::new(&judged),
        stiff: RigidityMonitor::default(),
        loads: LoadMonitor::new(&plan.exemptions),
    };
    // The start.
    judged.enclosed(&start, &mut ledger);
    let centre = judged.centre(&start);
    if paths.keyframes.len() == 1 && paths.events.is_empty() {
        judged.at_rest(0, world_at(0.0), &mut monitors, &mut ledger);
    }
    let mut rates = Vec::new();
    let mut events = paths.events.iter().peekable();
    for (i, keyframe) in paths.keyframes.iter().enumerate() {
        // The step: lengths, accelerations, distances, obstacles, shape, ground, static stability.
        if i > 0 {
            interrupt::progress_checkpoint(|| format!("step {i} of {}", paths.keyframes.len() - 1));
            let step = judged.step(&topology, i);
            let world = world_at(step.start);
            let [starts, ends] = judged.lengths(&step, &mut ledger);
            judged.jumps((&rates, &starts), step.start, &mut ledger);
            rates = ends;
            judged.moves(&step, i, world, (&mut monitors, &mut ledger));
        }
        judged.compare_margins(i, &monitors.standing, &mut ledger);
        // The events at its end.
        let Some(first) = events.next_if(|event| event.time <= keyframe.time) else { continue };
        let world = world_at(keyframe.time);
        judged.event = Some(first.cause);
        judged.rests_beside(i, &mut ledger);
        // The end of a step is a moment of it.
        if i == 0 || !looked_at(&judged, i) {
            judged.at_rest(i, world, &mut monitors, &mut ledger);
        }
        let before = topology.clone();
        let mut event = Some(first);
        while let Some(now) = event {
            interrupt::checkpoint();
            judged.event = Some(now.cause);
            let words = paths.event_words(&topology, &now.change);
            ledger.verdict.events.push((now.time, words));
            topology.apply(&now.change);
            judged.enter(&topology, i, Some(&before));
            monitors.stiff.begin();
            monitors.loads.begin();
            judged.at_rest(i, world, &mut monitors, &mut ledger);
            event = events.next_if(|event| event.time <= keyframe.time);
        }
        judged.event = None;
    }
    judged.jumps((&rates, &[]), paths.duration(), &mut ledger);
    let end = judged.places(paths.keyframes.len() - 1);
    let travel = judged.centre(&end) - centre;
    judged.summary((travel, paths.keyframes.len()), &monitors.standing, plan, &mut ledger);
    if !paths.events.is_empty() {
        ledger.check(CheckKind::Rest, Status::Proved);
        judged.note_assumptions(&mut ledger);
    }
    ledger.check(CheckKind::Rigidity, monitors.stiff.status(&judged));
    monitors.loads.conclude(&judged, &mut ledger);
    ledger.finish()
}

impl Judgement<'_> {
    /// Returns the step to the keyframe of an index, which is not the first, with a topology.
    fn step(&self, topology: &Topology, keyframe: usize) -> Step {
        let (before, after) = (&self.paths.keyframes[keyframe - 1], &self.paths.keyframes[keyframe]);
        let interpolation = match after.interpolation {
            Interpolation::Linear => Interpolation::Linear,
            Interpolation::RigidRoll { edge: (a, b), angle } => Interpolation::RigidRoll {
                edge: (self.own_node(topology, a), self.own_node(topology, b)),
                angle,
            },
        };
        Step {
            from: self.places(keyframe - 1),
            to: self.places(keyframe),
            interpolation,
            ramps: after.ramps,
            start: before.time,
            duration: after.time - before.time,
            keyframe: Some(keyframe),
        }
    }

    /// Makes all checks of a step to the keyframe of an index beside those of lengths.
    fn moves(
        &self,
        step: &Step,
        keyframe: usize,
        world: World,
        (monitors, ledger): (&mut Monitors, &mut Ledger),
    ) {
        self.distances(step, ledger);
        self.obstacles(step, ledger);
        self.shape(step, ledger);
        monitors.stiff.step(self, step, keyframe, ledger);
        if world.has_floor() {
            self.ground(step, ledger);
            if world.gravity > 0.0 {
                let stood = ledger.verdict.failures.len();
                monitors.standing.step(self, step, ledger);
                // Forces are of no interest where it topples.
                if ledger.verdict.failures.len() == stood {
                    let next = self.paths.keyframes.get(keyframe + 1).map(|keyframe| keyframe.interpolation);
                    let tips = matches!(next, Some(Interpolation::RigidRoll { .. }));
                    monitors.loads.step(self, (step, tips), keyframe, world, &monitors.standing, ledger);
                }
            }
        }
        // Only gravity on a ground makes a truss roll.
        if let Interpolation::RigidRoll { .. } = step.interpolation
            && (world.gravity == 0.0 || !world.has_floor())
        {
            let message = "without gravity and a ground nothing makes it roll".to_string();
            ledger.fail(self.failure(CheckKind::Ground, step.start, vec![], message));
        }
    }

    /// Compares the margins that the plan states at the keyframe of an index with those found there, before its events.
    fn compare_margins(&self, keyframe: usize, standing: &StabilityMonitor, ledger: &mut Ledger) {
        let stated = &self.paths.keyframes[keyframe];
        if !stated.margins.is_none()
            && let Some(failure) =
                self.margins(&stated.margins, &self.places(keyframe), stated.time, standing)
        {
            ledger.fail(failure);
        }
    }
}
