//! The figures of a folding beside its motion.

use super::layout::Layout;
use super::objective::{Conventions, Effort, Minimise, Objective};
use super::observer::Observer;
use super::order_bounds::Orders;
use super::random_orders::{self, Sample};
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::turns::{self, Stop};
use crate::plan::{Verdict, World};
use crate::planners::Progress;
use num_bigint::BigInt;

/// The figures of a folding and of the search for it: layout and order, effort with its lower bound, and the verdict.
#[derive(Clone, Debug)]
pub struct Report {
    /// The surface that is folded, as the problem states it.
    pub target: Target,
    /// The layout by which the surface folds, with its root.
    pub layout: Layout,
    /// The number of layouts of the target, without regard to roots (Kirchhoff's theorem).
    pub layouts: BigInt,
    /// The order of folding: for each step, in their order, the faces (indices in [`Target::faces`]) whose hinges fold
    /// at the same time.
    pub steps: Vec<Vec<usize>>,
    /// The stops of hinges that end a step of `steps` short of their fold angle, and go on in a later one, in the order of
    /// the steps; empty where each hinge folds in one step.
    pub stops: Vec<Stop>,
    /// The energy and the peak torque of the folding, N·m.
    pub effort: Effort,
    /// The lower bound on what was minimised, never above it, for all foldings that the answer was chosen from: the
    /// peak torque, the energy, or the energy of as few steps, N·m; 0 where none is known. The answer was chosen from
    /// all layouts with the roots allowed that lie flat and pass the judge, in the order that the settings ask for,
    /// or in any order where none passed in that one, or with stops of hinges where none passed in any.
    pub bound: f64,
    /// The orders of folding for which the bound holds.
    pub orders: Orders,
    /// The least number of steps of any layout with the root that the problem names, or with any root if it names none;
    /// layouts that overlap or collide count, too.
    pub fewest_steps: usize,
    /// True if it is proved that no folding that the answer was chosen from is better: the bound is below what was
    /// minimised by less than `TOLERANCES.proof` of it, and where the steps are minimised, none takes fewer.
    pub optimal: bool,
    /// The minimised quantity divided by the least value found for any layout with the leaves first: 1 if nothing was
    /// given up, less if another order is better.
    pub price: f64,
    /// The roots with which the best layouts proposed to the judge reach the least value, as indices in
    /// [`Target::faces`], ascending.
    pub ties: Vec<usize>,
    /// The number of pairs of a layout and a root that are known to reach the least value; after a local search, a
    /// pair counts each time that it was met.
    pub tied: u64,
    /// The work against standard gravity (Eq. 17 of [Yao et al.](super)) in the order of the folding, also where the
    /// problem has no gravity, J.
    pub lifting: f64,
    /// The lower bound on the work against standard gravity for all orders of the layout, at most `lifting`, J.
    pub lifting_bound: f64,
    /// The faces whose hinges to their parents do not close (Eq. 1 of [Yao et al.](super)), as indices in
    /// [`Target::faces`], ascending; empty if no hinge radius was given.
    pub too_thick: Vec<usize>,
    /// The mass of each face, in the order of [`Target::faces`], kg.
    pub masses: Vec<f64>,
    /// The conventions under which the folding was measured.
    pub conventions: Conventions,
    /// The quantity that was minimised: energy, peak torque, or steps.
    pub minimise: Minimise,
    /// The world that the plan assumes: weightless, or the root held on the ground.
    pub world: World,
    /// The number of actions of the program.
    pub actions: u64,
    /// The verdict of the judge, which let the plan pass.
    pub verdict: Verdict,
}

impl Report {
    /// Returns the gap between the bound and the value reached, as a fraction of that value, 0 to 1; 0 where it is less
    /// than `TOLERANCES.proof`. If the steps are minimised, both are energies.
    pub fn gap(&self) -> f64 {
        gap(self.effort.minimised(self.minimise), self.bound)
    }

    /// Returns in words how good the folding is known to be: what is proved, or how much less another may take, and what
    /// its order gains or costs.
    pub fn why(&self) -> String {
        let orders = match self.orders {
            Orders::LeavesFirst => "with the leaves first",
            Orders::RootFirst => "with the root first",
            Orders::Any => "in any order",
            Orders::WithStops => "with hinges that may stop on their way",
        };
        let (steps, what) = match self.minimise {
            Minimise::Energy => (false, "energy"),
            Minimise::PeakTorque => (false, "torque"),
            Minimise::Steps => (true, "steps"),
        };
        let value = self.effort.minimised(self.minimise);
        let proof = match (self.optimal, steps) {
            (true, false) => format!("proved: {orders} no folding takes less {what}"),
            (true, true) => {
                format!("proved: {orders} no folding takes fewer steps, nor in as few less energy")
            }
            (false, false) if self.bound > 0.0 => {
                let least = percent(self.bound / value);
                format!("not proved: {orders} no folding takes less than {least} of its {what}")
            }
            (false, false) => format!("not proved: nothing is known of the least {what}"),
            (false, true) => format!("not proved: no layout takes fewer than {} steps", self.fewest_steps),
        };
        let less = |part: f64| format!("{} {}", percent(part), if steps { "fewer" } else { "less" });
        let least = format!("{what} than the least found with the leaves first");
        if self.price < 1.0 - TOLERANCES.tie {
            format!("{proof}; {} {least}", less(1.0 - self.price))
        } else if self.price > 1.0 + TOLERANCES.tie {
            let more = percent(self.price - 1.0);
            format!("{proof}; {more} more {least}, where panels may overlap and meet")
        } else {
            proof
        }
    }

    /// Returns the angle of every hinge after the first `done` of the steps, by face of the target, rad; that of the root is
    /// 0. Panics if there are fewer steps.
    pub fn angles_after(&self, done: usize) -> Vec<f64> {
        let turns = turns::turns(&self.target, &self.layout, &self.steps, &self.stops);
        turns::angles_after(&turns, done, self.target.faces.len())
    }

    /// Compares the energy of the folding with the energies (N·m) of `orders` random orders of the same layout, under
    /// the same conventions (Sec. 5.3.2 of [Yao et al.](super)). The same `seed` gives the same orders; `progress`
    /// receives reports, but can't end it.
    pub fn random_orders(&self, orders: u64, seed: u64, progress: &mut dyn Progress) -> Sample {
        let objective = Objective::new(&self.target, self.masses.clone(), self.conventions, self.minimise);
        let energy = |steps: &[Vec<usize>]| objective.effort(&self.layout, steps).energy;
        let observer = Observer::new(progress);
        random_orders::sample(&self.layout, orders, seed, self.effort.energy, energy, &observer)
    }
}

/// Returns a fraction in percent, rounded down to a tenth.
fn percent(part: f64) -> String {
    format!("{:.1} %", libm::floor(part * 1000.0) / 10.0)
}

/// Returns the gap between a value and its lower bound, as a fraction of the value; 0 where the bound proves the value.
pub(super) fn gap(value: f64, bound: f64) -> f64 {
    if TOLERANCES.prove(value, bound) { 0.0 } else { 1.0 - bound / value }
}
