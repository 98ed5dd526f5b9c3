//! A planning call with what follows from its problem before any layout is searched: conventions, roots, costs,
//! and hinges that every layout needs.

use super::energy_order;
use super::ground_faces::deepest_protrusion;
use super::judgement::{self, Fault, Judged, Motion};
use super::layout::Layout;
use super::load_limits::LoadLimits;
use super::objective::{Conventions, Effort, Minimise, Objective};
use super::observer::Observer;
use super::panel::Panels;
use super::pattern::has_equal_triangles;
use super::refusal::Refusal;
use super::settings::{Method, Problem, Sequence, Settings};
use super::sheet::Sheet;
use super::steps;
use super::sweep_collision;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::turns::{Stop, turns};
use super::work_order;
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Pose, Vec3};
use crate::plan::{Failure, Ground, World};
use crate::planners::Solution;

/// Standard gravity, in which the weights of panels are stated also where the problem has no gravity, m/s².
const STANDARD_GRAVITY: f64 = 9.806_65;

/// A call of the planner: the problem and the settings, with all that follows from them before any layout is searched.
pub(super) struct Task<'p> {
    /// The problem that the call states.
    pub problem: &'p Problem,
    /// The settings of the fold planner.
    pub settings: &'p Settings,
    /// The observer, which gets the reports of the search and may end it.
    pub observer: &'p Observer<'p>,
    /// The surface that is folded, with its faces and hinges.
    pub target: &'p Target,
    /// The panels of the target's faces.
    pub panels: &'p Panels,
    /// The conventions under which torques and energy are computed.
    pub conventions: Conventions,
    /// The faces that may be the root, indices in [`Target::faces`], ascending.
    pub roots: Vec<usize>,
    /// The objective with the quantity that is minimised.
    pub objective: Objective<'p>,
}

/// A layout with an order of folding that the judge lets through, and the plan.
pub(super) struct Outcome {
    /// The plan of the folding with its verdict.
    pub solution: Solution<Judged>,
    /// The layout by which the surface folds.
    pub layout: Layout,
    /// For each step, in their order, the faces (indices in [`Target::faces`]) whose hinges fold in it.
    pub steps: Vec<Vec<usize>>,
    /// The stops of hinges on their way, in the order of the steps; empty where each folds in one step.
    pub stops: Vec<Stop>,
}

impl<'p> Task<'p> {
    /// Checks a problem and its settings, and determines conventions, possible roots and the objective.
    ///
    /// # Errors
    /// A [`Refusal`]: a root that is not a face or does not lie on the ground, settings that do not go together, or
    /// panels that penetrate each other in the target.
    pub(super) fn new(
        problem: &'p Problem,
        settings: &'p Settings,
        observer: &'p Observer<'p>,
    ) -> Result<Task<'p>, Refusal> {
        let (target, panels) = (&problem.target, &problem.panels);
        let conventions = settings.conventions(problem);
        let roots = roots(problem)?;
        compatible(problem, settings, &conventions)?;
        check_interpenetration(target, panels)?;
        let objective = Objective::new(target, panels.masses.clone(), conventions, settings.minimise);
        Ok(Task { problem, settings, observer, target, panels, conventions, roots, objective })
    }

    /// Returns the weight of each face under standard gravity (9.80665 m/s²), N, in the order of [`Target::faces`].
    pub(super) fn loads(&self) -> Vec<f64> {
        self.panels.masses.iter().map(|mass| mass * STANDARD_GRAVITY).collect()
    }

    /// Returns the limits of ground and hinge torques under gravity; `None` without.
    pub(super) fn load_limits(&self) -> Option<LoadLimits> {
        let panel = &self.panels.weakest;
        (self.conventions.gravity != 0.0).then(|| LoadLimits {
            weights: self.loads(),
            torque: panel.torque.unwrap_or(f64::INFINITY),
            depth: panel.thickness / 2.0 + panel.touch,
            touch: panel.contact,
        })
    }

    /// Returns the order in which the settings let a layout fold: for each step the faces (indices in
    /// [`Target::faces`]) whose hinges fold in it.
    ///
    /// # Errors
    /// [`Refusal::SequenceTooHigh`] if the settings ask for the order of least energy and the tree is higher than
    /// [`energy_order::HEIGHT_MAX`].
    pub(super) fn steps(&self, layout: &Layout) -> Result<Vec<Vec<usize>>, Refusal> {
        self.steps_in(layout, self.settings.sequence)
    }

    /// Returns the steps of a layout in the order that `sequence` names, as [`Task::steps`]; of [`Sequence::Auto`], with
    /// the leaves first.
    ///
    /// # Errors
    /// As for [`Task::steps`].
    pub(super) fn steps_in(&self, layout: &Layout, sequence: Sequence) -> Result<Vec<Vec<usize>>, Refusal> {
        Ok(match sequence {
            Sequence::Auto | Sequence::LeavesFirst => steps::leaves_first(layout),
            Sequence::RootFirst => steps::root_first(layout),
            Sequence::LeastWork => {
                steps::of_order(layout, &work_order::least_work(self.target, layout, &self.loads()).order)
            }
            Sequence::LeastEnergy => {
                let inertia = self.conventions.inertia;
                let masses = &self.panels.masses;
                let least = energy_order::least_energy(self.target, layout, masses, inertia);
                let (order, _) = least.ok_or(Refusal::SequenceTooHigh)?;
                steps::of_order(layout, &order)
            }
        })
    }

    /// Returns the minimised quantity of a layout that folds in these steps: energy or peak torque, N·m, or the number
    /// of steps.
    pub(super) fn value(&self, layout: &Layout, steps: &[Vec<usize>]) -> f64 {
        self.value_of(&self.objective.effort(layout, steps), steps)
    }

    /// Returns the minimised quantity of a folding with this effort in these steps, as [`Task::value`].
    pub(super) fn value_of(&self, effort: &Effort, steps: &[Vec<usize>]) -> f64 {
        match self.settings.minimise {
            Minimise::Energy => effort.energy,
            Minimise::PeakTorque => effort.peak,
            Minimise::Steps => steps.len() as f64,
        }
    }

    /// Returns the world that the plan assumes: without gravity and ground, or with the problem's gravity and the root
    /// held on the ground.
    pub(super) fn world(&self) -> World {
        if self.problem.gravity == 0.0 {
            return World::FREE;
        }
        World { gravity: self.problem.gravity, ground: Ground::Fixed, ..World::FREE }
    }

    /// Returns the pose of the root's panel in the world: with its outside down on the ground, if there is one.
    fn base(&self, root: usize) -> Pose {
        if self.problem.gravity == 0.0 {
            return Pose::identity();
        }
        let thickness = self.panels.thickness[root];
        shifted(Vec3::new(0.0, 0.0, thickness / 2.0)) * turned(Vec3::x(), std::f64::consts::PI)
    }

    /// Puts a layout that folds in these steps (faces as indices in [`Target::faces`]) before the judge; the inner
    /// error is its first failure.
    ///
    /// # Errors
    /// A [`Refusal`] that holds for every layout: a connector without a hinge, steps that are too short, or a program
    /// that can't be scheduled.
    pub(super) fn judged(
        &self,
        layout: &Layout,
        order: &[Vec<usize>],
    ) -> Result<Result<Solution<Judged>, Failure>, Refusal> {
        self.judged_with_stops(layout, order, &[])
    }

    /// Puts a layout that folds in these steps with these stops before the judge, as [`Task::judged`].
    ///
    /// # Errors
    /// As for [`Task::judged`].
    pub(super) fn judged_with_stops(
        &self,
        layout: &Layout,
        order: &[Vec<usize>],
        stops: &[Stop],
    ) -> Result<Result<Solution<Judged>, Failure>, Refusal> {
        let sheet = Sheet::new(self.target, self.panels, layout).map_err(|_| Refusal::NoHinge)?;
        let turns = turns(self.target, layout, order, stops);
        let program = sheet.program(layout, &turns, self.conventions.step);
        let motion = Motion {
            robot: sheet.assembly,
            start: crate::robot::State { base: self.base(layout.root), ..sheet.flat },
            program,
            world: self.world(),
            judge: self.settings.judge,
        };
        match judgement::judged(motion) {
            Ok(solution) => Ok(Ok(solution)),
            Err(Fault::Refused(failure)) => Ok(Err(*failure)),
            Err(Fault::Schedule(refusal)) => Err(Refusal::Schedule(refusal)),
            Err(Fault::TooFast) => Err(Refusal::StepTooShort { least: self.least_step() }),
        }
    }

    /// Returns the least time of a step that every hinge of the target can keep, s.
    fn least_step(&self) -> f64 {
        let widest = self.target.hinges.iter().map(|hinge| hinge.angle.abs()).fold(0.0, f64::max);
        self.panels.weakest.step_time(widest)
    }
}

/// Returns the faces that may be the root: the given one, else all faces below whose plane the shape does not
/// reach farther than a panel is thick.
fn roots(problem: &Problem) -> Result<Vec<usize>, Refusal> {
    let target = &problem.target;
    let faces = target.faces.len();
    if problem.root.is_some_and(|root| root >= faces) {
        return Err(Refusal::NoSuchRoot { faces });
    }
    let depth = if problem.gravity == 0.0 { f64::INFINITY } else { problem.panels.weakest.thickness };
    let asked: Vec<usize> = problem.root.map_or_else(|| (0..faces).collect(), |root| vec![root]);
    let lies = |root: &usize| deepest_protrusion(target, *root, depth).is_none();
    let roots: Vec<usize> = asked.iter().copied().filter(lies).collect();
    let (true, Some(&root)) = (roots.is_empty(), asked.first()) else { return Ok(roots) };
    let Some(protrusion) = deepest_protrusion(target, root, depth) else { return Ok(roots) };
    Err(Refusal::OffGround { is_root_given: problem.root.is_some(), root, protrusion })
}

/// Refuses settings that do not go together.
fn compatible(problem: &Problem, settings: &Settings, conventions: &Conventions) -> Result<(), Refusal> {
    let separable = conventions.is_separable();
    if settings.method == Method::Heuristic {
        if !(separable && settings.minimise == Minimise::Energy) {
            return Err(Refusal::HeuristicObjective);
        }
        let masses = &problem.panels.masses;
        if masses.iter().any(|mass| (mass - masses[0]).abs() > TOLERANCES.mass * masses[0]) {
            return Err(Refusal::HeuristicMasses);
        }
        if !has_equal_triangles(&problem.target) {
            return Err(Refusal::HeuristicSides);
        }
    }
    if settings.sequence == Sequence::LeastEnergy && !separable {
        return Err(Refusal::SequenceUnderGravity);
    }
    Ok(())
}

/// Checks that panels of their thickness do not penetrate each other in the target. Those with a common edge do where
/// they close farther than their bevels leave room, whether a hinge joins them or not.
///
/// # Errors
/// The first two panels that penetrate each other.
fn check_interpenetration(target: &Target, panels: &Panels) -> Result<(), Refusal> {
    match sweep_collision::target_collisions(target, &panels.solids).first() {
        Some(&faces) => {
            let opening = target
                .hinge_between(faces[0], faces[1])
                .map(|hinge| std::f64::consts::PI - target.hinges[hinge].angle.abs());
            Err(Refusal::Interpenetrating { faces, opening })
        }
        None => Ok(()),
    }
}
