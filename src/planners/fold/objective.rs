//! The objective of a folding: the paper's energy under stated conventions, its peak torque, or its steps.
//!
//! With the leaves first, no gravity, and only the joints that move counted, energy and peak have the
//! closed form of [`weights`](super::weights). Under any other convention they are simulated.

use super::energy_order;
use super::gravity_bounds::GravityBounds;
use super::inertia::{Body, Inertia};
use super::layout::Layout;
use super::local_search::BoundPrefilter;
use super::order_bounds::{self, Orders};
use super::peak_torque;
use super::shortest_paths::ShortestPaths;
use super::simulation::{Circumstances, Count, simulate, simulate_turns};
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::turns::{Stop, turns};
use super::weights::{QUINTIC, Weights};
use crate::geometry::Vec3;
use crate::units::Dimension;

/// The peak speed of the quintic law over one unit in one second.
const QUINTIC_SPEED: f64 = QUINTIC / 2.0;

/// The peak acceleration of the quintic law over one unit in one second: 10/√3.
const QUINTIC_ACCELERATION: f64 = 5.773_502_691_896_258;

/// The greatest number of faces, summed over layouts, that are measured by sums over sets of faces: some seconds.
const SUMMED_MAX: u64 = 400_000_000;

/// The greatest number of faces, summed over layouts, that are measured by the closed form.
const CLOSED_MAX: u64 = 10_000_000;

/// The greatest number of faces, summed over layouts, that are measured by simulation.
const SIMULATED_MAX: u64 = 40_000;

/// The quantity that a folding is to minimise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Minimise {
    /// The sum of the hinges' mean torques over all steps (Eq. 5 of [Yao et al.](super)), N·m; of equal ones the
    /// fewest steps.
    #[default]
    Energy,
    /// The greatest torque of a hinge, N·m; of equal ones the least energy.
    PeakTorque,
    /// The number of steps; of equal ones the least energy.
    Steps,
}

impl Minimise {
    /// Returns the dimension of the quantity that lower bounds are about, as [`Effort::minimised`] gives it.
    pub fn dimension(self) -> Dimension {
        match self {
            Minimise::PeakTorque => Dimension::TORQUE,
            Minimise::Energy | Minimise::Steps => Dimension::ENERGY,
        }
    }
}

/// The conventions under which torques and energy are computed, as far as [Yao et al.](super) leaves them open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conventions {
    /// The model of how the mass of a panel is spread.
    pub inertia: Inertia,
    /// The joints whose torques count: those that move, or all.
    pub count: Count,
    /// The gravity, m/s², towards the ground on which the root lies with its outside down; 0 for no gravity.
    pub gravity: f64,
    /// The duration of a step, s.
    pub step: f64,
}

impl Conventions {
    /// Returns true if there is no gravity and only moving joints count: then a hinge's torque counts in its own step
    /// only, depends on nothing but the faces that it carries, and energy and peak torque have a closed form.
    pub fn is_separable(&self) -> bool {
        self.gravity == 0.0 && self.count == Count::Moving
    }
}

/// The effort of a folding: its energy and its peak torque, N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The energy (Eq. 5 of [Yao et al.](super)): the sum of the mean absolute torques of the joints that count, over
    /// all steps, N·m.
    pub energy: f64,
    /// The greatest absolute torque of a joint that counts, N·m.
    pub peak: f64,
}

impl Effort {
    /// Returns the quantity that lower bounds are about, N·m: the peak torque if that is minimised, else the energy,
    /// also if the steps are minimised.
    pub fn minimised(&self, minimise: Minimise) -> f64 {
        match minimise {
            Minimise::PeakTorque => self.peak,
            Minimise::Energy | Minimise::Steps => self.energy,
        }
    }
}

/// The objective function of a target: it measures energy and peak torque of layouts and orders of folding under fixed
/// conventions.
pub struct Objective<'t> {
    target: &'t Target,
    /// The mass of each face, kg.
    masses: Vec<f64>,
    /// The conventions under which torques and energy are computed.
    pub conventions: Conventions,
    /// The quantity that is minimised: energy, peak torque, or steps.
    pub minimise: Minimise,
    bodies: Vec<Body>,
    /// The weights of the closed form, N·m for steps of one second.
    pub weights: Weights,
}

impl<'t> Objective<'t> {
    /// Returns the objective of a target; `masses`: one for each face in the order of [`Target::faces`], kg.
    /// `conventions`: the conventions under which torques and energy are computed; `minimise`: the quantity to
    /// minimise. Panics if there are more masses than faces.
    pub fn new(
        target: &'t Target,
        masses: Vec<f64>,
        conventions: Conventions,
        minimise: Minimise,
    ) -> Objective<'t> {
        let bodies = Body::of_target(target, &masses, conventions.inertia);
        let weights = Weights::new(target, &masses, conventions.inertia);
        Objective { target, masses, conventions, minimise, bodies, weights }
    }

    /// Returns true if the conventions are separable and energy is minimised, alone or after the steps: the energy is
    /// then a sum over faces of the costs of their own paths, as branch and bound needs.
    pub fn is_sum_over_faces(&self) -> bool {
        self.conventions.is_separable() && self.minimise != Minimise::PeakTorque
    }

    /// Returns true if the conventions are separable and the peak torque is minimised: it is then the greatest of
    /// sums, for each hinge over the faces that it carries.
    pub fn is_greatest_sum(&self) -> bool {
        self.conventions.is_separable() && self.minimise == Minimise::PeakTorque
    }

    /// Returns the prefilter by bounds for an objective that is a greatest sum ([`Objective::is_greatest_sum`]), with
    /// a budget of at most `budget` pairs of a layout and a root; `None` for other objectives.
    pub fn prefilter(&self, budget: u64) -> Option<BoundPrefilter> {
        let most = budget.min(SUMMED_MAX / self.masses.len() as u64);
        self.is_greatest_sum().then(|| BoundPrefilter { scale: self.peak_by_mean(), budget: most })
    }

    /// Returns the energy and peak torque (N·m) of a layout that folds in these steps: each a list of the faces
    /// (indices in [`Target::faces`]) whose hinges fold at the same time, no two of them on one path from the root.
    pub fn effort(&self, layout: &Layout, steps: &[Vec<usize>]) -> Effort {
        let Conventions { inertia, count, gravity, step } = self.conventions;
        if self.conventions.is_separable() {
            let order = steps.concat();
            let means = energy_order::means(self.target, layout, &self.masses, inertia, &order);
            return closed(means.into_iter(), step);
        }
        let torques = simulate(self.target, layout, &self.bodies, steps, &Circumstances { step, gravity });
        Effort { energy: torques.energy(count, steps), peak: torques.peak(count, steps) }
    }

    /// Returns the energy and peak torque (N·m) of a layout that folds in these steps with hinges that stop on their way
    /// ([`turns`](super::turns::turns())), simulated where there are stops; else as [`Objective::effort`].
    pub fn effort_with_stops(&self, layout: &Layout, steps: &[Vec<usize>], stops: &[Stop]) -> Effort {
        if stops.is_empty() {
            return self.effort(layout, steps);
        }
        let Conventions { count, gravity, step, .. } = self.conventions;
        let turns = turns(self.target, layout, steps, stops);
        let torques =
            simulate_turns(self.target, layout, &self.bodies, &turns, &Circumstances { step, gravity });
        Effort { energy: torques.energy(count, steps), peak: torques.peak(count, steps) }
    }

    /// Returns the energy and peak torque (N·m) of a layout that folds with the leaves first
    /// ([`leaves_first`](super::steps::leaves_first)).
    pub fn leaves_first(&self, layout: &Layout) -> Effort {
        if self.conventions.is_separable() {
            return closed(peak_torque::carried(layout, &self.weights).into_iter(), self.conventions.step);
        }
        self.effort(layout, &super::steps::leaves_first(layout))
    }

    /// Returns the value to minimise of a layout that folds with the leaves first, and the value that decides ties, by
    /// [`Minimise`]: energy (N·m) and steps, peak torque (N·m) and energy (N·m), or steps and energy (N·m).
    pub fn value(&self, layout: &Layout) -> [f64; 2] {
        let steps = layout.heights()[layout.root] as f64;
        let Effort { energy, peak } = self.leaves_first(layout);
        match self.minimise {
            Minimise::Energy => [energy, steps],
            Minimise::PeakTorque => [peak, energy],
            Minimise::Steps => [steps, energy],
        }
    }

    /// Returns the greatest number of pairs of a layout and a root whose energy and peak torque are computed:
    /// `CLOSED_MAX` divided by the number of faces in closed form, `SIMULATED_MAX` divided by it where each takes a
    /// simulation.
    pub fn measures_max(&self) -> u64 {
        let faces = self.masses.len() as u64;
        if self.conventions.is_separable() { CLOSED_MAX / faces } else { SIMULATED_MAX / faces }
    }

    /// Returns a lower bound for all layouts with these roots (indices in [`Target::faces`]) that fold in one of the
    /// orders `orders`: on the peak torque where that is minimised, else on the energy; N·m; infinite without roots.
    pub fn lower_bound(&self, roots: &[usize], orders: Orders) -> f64 {
        let bounds = match orders {
            Orders::LeavesFirst => self.leaves_first_bounds(roots),
            Orders::RootFirst | Orders::Any | Orders::WithStops => self.order_bounds(roots, orders),
        };
        bounds.into_iter().fold(f64::INFINITY, f64::min) * (1.0 - TOLERANCES.bound)
    }

    /// Returns the bounds with the leaves first, by root.
    fn leaves_first_bounds(&self, roots: &[usize]) -> Vec<f64> {
        let routes = ShortestPaths::new(self.target, &self.weights);
        let gravity = self.conventions.gravity;
        let lift = (gravity != 0.0).then(|| GravityBounds::new(self.target, &self.masses, gravity));
        let lifted = match (&lift, self.minimise) {
            (Some(lift), Minimise::PeakTorque) => roots.iter().map(|root| lift.peak(*root)).collect(),
            (Some(lift), _) => {
                let energies = lift.energies();
                roots.iter().map(|root| energies[*root]).collect()
            }
            (None, _) => vec![0.0; roots.len()],
        };
        roots.iter().zip(lifted).map(|(root, lifted)| self.bound(&routes, *root).max(lifted)).collect()
    }

    /// Returns the bounds for orders other than leaves first, by root. A hinge that stops often enough needs as little
    /// torque as one likes without gravity.
    fn order_bounds(&self, roots: &[usize], orders: Orders) -> Vec<f64> {
        if self.conventions.gravity != 0.0 {
            return roots.iter().map(|root| self.by_work(*root)).collect();
        }
        if orders == Orders::WithStops && self.minimise == Minimise::PeakTorque {
            return vec![0.0; roots.len()];
        }
        let inertia = self.conventions.inertia;
        let energies = order_bounds::energies(self.target, &self.weights, &self.masses, inertia, orders);
        let by_square = 1.0 / (self.conventions.step * self.conventions.step);
        let hinges = (self.masses.len() - 1).max(1) as f64;
        let bound = |&root: &usize| match self.minimise {
            // The greatest mean torque is no less than the mean of all.
            Minimise::PeakTorque => (energies[root] / hinges).max(self.by_itself(root)) * self.peak_by_mean(),
            Minimise::Energy | Minimise::Steps => energies[root] * by_square,
        };
        roots.iter().map(bound).collect()
    }

    /// Returns the ratio of a hinge's peak torque for steps of the conventions' time to its mean torque for steps of
    /// one second, without unit, which is the same for all hinges in the closed form.
    pub fn peak_by_mean(&self) -> f64 {
        QUINTIC_ACCELERATION / QUINTIC / (self.conventions.step * self.conventions.step)
    }

    /// Returns the bound for one root with the leaves first, without the torque that each hinge needs against gravity.
    fn bound(&self, routes: &ShortestPaths, root: usize) -> f64 {
        let by_square = 1.0 / (self.conventions.step * self.conventions.step);
        match (self.minimise, self.conventions.gravity == 0.0) {
            (_, false) => self.by_work(root),
            (Minimise::PeakTorque, true) => self.heaviest(root) * self.peak_by_mean(),
            // Counting the locked joints adds to the energy of the moving ones.
            (_, true) => routes.bound(root) * by_square,
        }
    }

    /// Returns the bound for one root under gravity that follows from the work of lifting all panels, which every
    /// order does.
    fn by_work(&self, root: usize) -> f64 {
        let mut angles: Vec<f64> = self.target.hinges.iter().map(|hinge| hinge.angle.abs()).collect();
        angles.sort_by(|a, b| b.total_cmp(a));
        match self.minimise {
            // Work is torque by angle, so no more than the peak by all angles.
            Minimise::PeakTorque => {
                quotient(self.lifted(root), angles.iter().take(self.masses.len() - 1).sum())
            }
            // Work is torque by speed, so no more than the mean torque by the time by the greatest speed.
            Minimise::Energy | Minimise::Steps => {
                quotient(self.lifted(root), QUINTIC_SPEED * angles.first().copied().unwrap_or(0.0))
            }
        }
    }

    /// Returns the least number of steps of any layout with this root (an index in [`Target::faces`]), or with any
    /// root if `None`: the number of hinges between the root and the farthest face. Layouts that overlap or collide
    /// count, too.
    pub fn fewest_steps(&self, root: Option<usize>) -> usize {
        let roots = root.map_or(0..self.masses.len(), |root| root..root + 1);
        roots.map(|root| self.radius(root)).min().unwrap_or(0)
    }

    /// Returns the number of hinges between the root and the face farthest from it, by breadth-first search.
    fn radius(&self, root: usize) -> usize {
        let mut depths = vec![usize::MAX; self.masses.len()];
        depths[root] = 0;
        let mut queue = std::collections::VecDeque::from([root]);
        let mut last = 0;
        while let Some(face) = queue.pop_front() {
            last = depths[face];
            for (_, other) in self.target.around(face) {
                if depths[other] == usize::MAX {
                    depths[other] = last + 1;
                    queue.push_back(other);
                }
            }
        }
        last
    }

    /// Returns the least work of any folding, J: the potential energy that the panels gain or lose in all.
    fn lifted(&self, root: usize) -> f64 {
        let (up, ground) = (-self.target.normal(root), self.target.centroid(root));
        let height = |face: usize| -> f64 { up.dot(&Vec3::from(self.target.centroid(face) - ground)) };
        let moment: f64 = self.masses.iter().enumerate().map(|(face, mass)| mass * height(face)).sum();
        (moment * self.conventions.gravity).abs()
    }

    /// Returns a mean torque that some hinge reaches in every layout with the leaves first, N·m for steps of one
    /// second: every face is carried by its own hinge, and all faces by the root's ([`peak_torque`]).
    fn heaviest(&self, root: usize) -> f64 {
        self.by_itself(root).max(peak_torque::relaxed(self.target, &self.weights, root))
    }

    /// Returns a mean torque that some hinge reaches in every layout and order, N·m for steps of one second: that
    /// of a face about its own hinge, which carries it whatever has folded before.
    fn by_itself(&self, root: usize) -> f64 {
        let own = |face: usize| {
            let hinges = self.target.around(face).map(|(hinge, _)| self.weights.at(hinge, face));
            hinges.fold(f64::INFINITY, f64::min)
        };
        (0..self.masses.len()).filter(|face| *face != root).map(own).fold(0.0, f64::max)
    }
}

/// Returns `a / b`, or 0 if `b` is not positive.
fn quotient(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// Returns the effort of the closed form from mean torques for steps of one second.
fn closed(means: impl Iterator<Item = f64> + Clone, step: f64) -> Effort {
    let by_square = 1.0 / (step * step);
    Effort {
        energy: means.clone().sum::<f64>() * by_square,
        peak: means.fold(0.0, f64::max) * by_square * QUINTIC_ACCELERATION / QUINTIC,
    }
}
