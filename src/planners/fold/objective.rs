//! What a folding is judged by: the paper's energy under stated conventions, its peak torque, or its
//! steps.
//!
//! With the leaves first, no gravity, and only the joints that move counted, energy and peak have the
//! closed form of [`weights`](super::weights). Under any other convention they are simulated.

use super::energy_order;
use super::gravity_bounds::GravityBounds;
use super::inertia::{Body, Inertia};
use super::layout::Layout;
use super::local_search::BoundPrefilter;
use super::peak_torque;
use super::shortest_paths::ShortestPaths;
use super::simulation::{Circumstances, Count, simulate};
use super::target::Target;
use super::weights::{QUINTIC, Weights};
use crate::geometry::Vec3;

/// Greatest slope of the quintic law, and greatest acceleration over one unit in one second.
const QUINTIC_SPEED: f64 = QUINTIC / 2.0;
const QUINTIC_ACCELERATION: f64 = 5.773_502_691_896_258;

/// Faces of layouts that are measured, by sums over sets of faces, by the closed form, and by simulation: some
/// seconds.
const SUMMED_MAX: u64 = 400_000_000;
const CLOSED_MAX: u64 = 10_000_000;
const SIMULATED_MAX: u64 = 40_000;

/// What is to be small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Minimise {
    Energy,
    PeakTorque,
    /// The steps, then the energy.
    Steps,
}

/// What the paper leaves open, or leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conventions {
    pub inertia: Inertia,
    pub count: Count,
    /// m/s² towards the ground on which the root lies with its outside down; 0 without.
    pub gravity: f64,
    /// Time of a step, s.
    pub step: f64,
}

impl Conventions {
    /// Whether a hinge's torque in its own step is all there is, and grows with what it carries only.
    pub fn separate(&self) -> bool {
        self.gravity == 0.0 && self.count == Count::Moving
    }
}

/// What a folding takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Eq. 5, N·m.
    pub energy: f64,
    /// N·m
    pub peak: f64,
}

/// A target with what its panels weigh, and what is asked of its foldings.
pub struct Objective<'t> {
    target: &'t Target,
    /// By face, kg.
    masses: Vec<f64>,
    pub conventions: Conventions,
    pub minimise: Minimise,
    bodies: Vec<Body>,
    /// Of the closed form, for steps of one second.
    pub weights: Weights,
}

impl<'t> Objective<'t> {
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

    /// Whether proof needs no look at every layout: energies add up over faces.
    pub fn adds_up(&self) -> bool {
        self.conventions.separate() && self.minimise != Minimise::PeakTorque
    }

    /// Whether what is to be small is the greatest of sums over sets of faces.
    pub fn peaks_add_up(&self) -> bool {
        self.conventions.separate() && self.minimise == Minimise::PeakTorque
    }

    /// How many layouts with roots may be looked at where it is.
    pub fn prefilter(&self, budget: u64) -> Option<BoundPrefilter> {
        let most = budget.min(SUMMED_MAX / self.masses.len() as u64);
        self.peaks_add_up().then(|| BoundPrefilter { scale: self.peak_by_mean(), budget: most })
    }

    /// What folding in these steps takes.
    pub fn effort(&self, layout: &Layout, steps: &[Vec<usize>]) -> Effort {
        let Conventions { inertia, count, gravity, step } = self.conventions;
        if self.conventions.separate() {
            let order = steps.concat();
            let means = energy_order::means(self.target, layout, &self.masses, inertia, &order);
            return closed(means.into_iter(), step);
        }
        let torques = simulate(self.target, layout, &self.bodies, steps, &Circumstances { step, gravity });
        Effort { energy: torques.energy(count, steps), peak: torques.peak(count, steps) }
    }

    /// The same with the leaves first.
    pub fn leaves_first(&self, layout: &Layout) -> Effort {
        if self.conventions.separate() {
            return closed(peak_torque::carried(layout, &self.weights).into_iter(), self.conventions.step);
        }
        self.effort(layout, &super::steps::leaves_first(layout))
    }

    /// What is to be small of a layout, the first first; with the leaves first.
    pub fn value(&self, layout: &Layout) -> [f64; 2] {
        let steps = layout.heights()[layout.root] as f64;
        let Effort { energy, peak } = self.leaves_first(layout);
        match self.minimise {
            Minimise::Energy => [energy, steps],
            Minimise::PeakTorque => [peak, energy],
            Minimise::Steps => [steps, energy],
        }
    }

    /// How many layouts with roots may be measured: fewer where each is simulated.
    pub fn measures_max(&self) -> u64 {
        let faces = self.masses.len() as u64;
        if self.conventions.separate() { CLOSED_MAX / faces } else { SIMULATED_MAX / faces }
    }

    /// What no layout with one of these roots undercuts with the leaves first: peak torque where that is to
    /// be small, else energy; N·m.
    pub fn lower_bound(&self, roots: &[usize]) -> f64 {
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
        let bounds = roots.iter().zip(lifted).map(|(root, lifted)| self.bound(&routes, *root).max(lifted));
        bounds.fold(f64::INFINITY, f64::min)
    }

    /// Peaks of the closed form by mean torques for steps of one second.
    pub fn peak_by_mean(&self) -> f64 {
        QUINTIC_ACCELERATION / QUINTIC / (self.conventions.step * self.conventions.step)
    }

    /// The same for one root, without what gravity asks of each hinge.
    fn bound(&self, routes: &ShortestPaths, root: usize) -> f64 {
        let by_square = 1.0 / (self.conventions.step * self.conventions.step);
        let lifted = self.lifted(root);
        let angles = || self.target.hinges.iter().map(|hinge| hinge.angle.abs());
        match (self.minimise, self.conventions.gravity == 0.0) {
            (Minimise::PeakTorque, true) => self.heaviest(root) * self.peak_by_mean(),
            // Work is torque by angle, so no more than the peak by all angles.
            (Minimise::PeakTorque, false) => {
                let mut angles: Vec<f64> = angles().collect();
                angles.sort_by(|a, b| b.total_cmp(a));
                quotient(lifted, angles.iter().take(self.masses.len() - 1).sum())
            }
            // Counting the locked joints adds to what the moving ones spend.
            (_, true) => routes.bound(root) * by_square,
            // Work is torque by speed, so no more than the mean torque by the time by the greatest speed.
            (_, false) => quotient(lifted, QUINTIC_SPEED * angles().fold(0.0, f64::max)),
        }
    }

    /// No layout folds in fewer steps.
    pub fn fewest_steps(&self, root: Option<usize>) -> usize {
        let roots = root.map_or(0..self.masses.len(), |root| root..root + 1);
        roots.map(|root| self.radius(root)).min().unwrap_or(0)
    }

    /// How many hinges lie between the root and the face farthest from it.
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

    /// The work that no folding undercuts: what all panels gain over the ground, J.
    fn lifted(&self, root: usize) -> f64 {
        let (up, ground) = (-self.target.normal(root), self.target.centroid(root));
        let height = |face: usize| -> f64 { up.dot(&Vec3::from(self.target.centroid(face) - ground)) };
        let moment: f64 = self.masses.iter().enumerate().map(|(face, mass)| mass * height(face)).sum();
        (moment * self.conventions.gravity).abs()
    }

    /// A mean torque that some hinge reaches in every layout, N·m for steps of one second: every face
    /// is carried by its own hinge, and all faces by the root's ([`peak`]).
    fn heaviest(&self, root: usize) -> f64 {
        let faces = 0..self.masses.len();
        let least = |face: usize, hinges: &mut dyn Iterator<Item = usize>| {
            hinges.map(|hinge| self.weights.at(hinge, face)).fold(f64::INFINITY, f64::min)
        };
        let others = || faces.clone().filter(|face| *face != root);
        let own = others().map(|face| least(face, &mut self.target.around(face).map(|(hinge, _)| hinge)));
        own.fold(peak_torque::relaxed(self.target, &self.weights, root), f64::max)
    }
}

fn quotient(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// From mean torques for steps of one second.
fn closed(means: impl Iterator<Item = f64> + Clone, step: f64) -> Effort {
    let by_square = 1.0 / (step * step);
    Effort {
        energy: means.clone().sum::<f64>() * by_square,
        peak: means.fold(0.0, f64::max) * by_square * QUINTIC_ACCELERATION / QUINTIC,
    }
}
