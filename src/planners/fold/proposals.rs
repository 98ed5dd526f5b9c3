//! Layouts that are proposed to the judge, by the method that the objective allows.

use super::branch_and_bound::{self, NoLayout, Optimum};
use super::enumerate::{self, TooManyFaces};
use super::heuristic::{self, Measure};
use super::layout::Layout;
use super::local_search::{self, Measured};
use super::objective::Minimise;
use super::order_bounds::Orders;
use super::peak_torque;
use super::refusal::Refusal;
use super::settings::Method;
use super::tabu_unfolding;
use super::task::Task;
use super::tolerances::TOLERANCES;

/// The greatest number of layouts that are kept for the judge where every layout is measured.
const KEPT: usize = 4096;

/// The search for the next best layout gets the budget divided by this, so that something is left for other
/// methods where none of the first layouts is let through.
const NEXT_BEST: u64 = 4;

/// The layouts proposed to the judge, best first, with their values and lower bounds.
pub(super) struct Proposals {
    /// The layouts proposed, the best first; none that was passed over is better than those that follow.
    pub layouts: Vec<Layout>,
    /// The settings of a branch and bound search for the next best layout; `None` where there is no such search.
    pub next: Option<branch_and_bound::Settings>,
    /// The lower bound for all layouts that lie flat, with the leaves first: on the peak torque where that is
    /// minimised, else on the energy; N·m. If branch and bound minimises the steps, it holds for the layouts that
    /// are no higher than the first.
    pub bound: f64,
    /// The least value of any layout, also of those whose patterns overlap; N·m, or steps if these are minimised.
    pub least: f64,
    /// The values of each layout of `layouts`: the one that is minimised, and the one that decides ties; `None`
    /// unless the list is complete, so that no layout that lies flat is left out before its last.
    pub values: Option<Vec<[f64; 2]>>,
    /// The roots that are equally good, as indices in [`Target::faces`](super::Target::faces), ascending.
    pub ties: Vec<usize>,
    /// The number of pairs of a layout and a root that are known to be equally good.
    pub tied: u64,
}

impl Proposals {
    /// Returns the settings of a branch and bound for the next best layout, with a quarter of the budget; `None` if
    /// there is no such search.
    pub(super) fn next_best(&self) -> Option<branch_and_bound::Settings> {
        self.next.map(|next| branch_and_bound::Settings { budget: next.budget / NEXT_BEST, ..next })
    }

    /// Returns a lower bound on the energy (or on the peak torque, if `minimise` says so) of all layouts that lie flat
    /// except those before `index` (from 0) in the list, N·m: the least value from there on if the list is complete,
    /// else [`Proposals::bound`]. Panics if a complete list is shorter than `index`.
    pub(super) fn bound_from(&self, index: usize, minimise: Minimise) -> f64 {
        self.values.as_ref().map_or(self.bound, |values| least_from(values, index, minimise))
    }

    /// Returns true if the layouts are known to come in order of their value: none that lies flat is passed over before
    /// the last one proposed.
    pub(super) fn is_gapless(&self) -> bool {
        self.next.is_some() || self.values.is_some()
    }
}

/// Returns the least energy or peak torque in a complete list from `index` on. If the steps are minimised, it is
/// the least energy of those with as few steps as the first.
fn least_from(values: &[[f64; 2]], index: usize, minimise: Minimise) -> f64 {
    let rest = &values[index..];
    let least = match minimise {
        Minimise::Energy | Minimise::PeakTorque => {
            rest.iter().map(|value| value[0]).fold(f64::INFINITY, f64::min)
        }
        Minimise::Steps => {
            let as_few = rest.iter().filter(|value| value[0] == rest[0][0]);
            as_few.map(|value| value[1]).fold(f64::INFINITY, f64::min)
        }
    };
    // Ties are in any order, also beyond the last.
    least * (1.0 - TOLERANCES.tie)
}

impl Task<'_> {
    /// Searches layouts by the method that the settings name; a layout that the problem prescribes is the only one.
    ///
    /// # Errors
    /// A [`Refusal`] if no layout lies flat, none was found within the budget, or the target has too many faces for
    /// enumeration.
    pub(super) fn proposals(&self) -> Result<Proposals, Refusal> {
        if let Some(pairs) = &self.problem.hinges {
            return self.given(pairs);
        }
        match self.settings.method {
            Method::Enumerate => self.enumerated(),
            Method::Heuristic => self.preferred(),
            Method::Exact if self.objective.is_sum_over_faces() => self.proved(),
            Method::Exact => Ok(self.measured()?.0),
        }
    }

    /// Converts a torque or an energy (N·m) for steps of one second to one for the step time of the call: divides it by
    /// the square of that time in seconds.
    pub(super) fn scaled(&self, energy: f64) -> f64 {
        energy / (self.conventions.step * self.conventions.step)
    }

    /// Returns the layout of least energy by branch and bound; or that of the fewest steps, and then the
    /// least energy.
    fn proved(&self) -> Result<Proposals, Refusal> {
        let (root, minimise) = (self.problem.root, self.settings.minimise);
        let plain = branch_and_bound::Settings {
            root,
            flat: true,
            height: None,
            budget: self.settings.budget,
            seed: self.settings.seed,
        };
        let fewest = self.objective.fewest_steps(root);
        let mut settings = plain;
        let found = match minimise {
            Minimise::Steps => (fewest..self.target.faces.len()).find_map(|height| {
                settings = branch_and_bound::Settings { height: Some(height), ..plain };
                match self.optimum(&settings) {
                    Err(NoLayout::AllOverlap) => None,
                    found => Some(found),
                }
            }),
            Minimise::Energy | Minimise::PeakTorque => Some(self.optimum(&plain)),
        };
        let free = || self.optimum(&branch_and_bound::Settings { flat: false, ..plain }).map_err(refusal);
        let found = match found.unwrap_or(Err(NoLayout::AllOverlap)) {
            Err(NoLayout::Budget) => return self.first_flat(free()?),
            found => found.map_err(refusal)?,
        };
        let least = match minimise {
            Minimise::Steps => fewest as f64,
            Minimise::Energy | Minimise::PeakTorque => self.scaled(free()?.energy.min(found.energy)),
        };
        Ok(Proposals {
            bound: self.scaled(found.bound),
            least,
            values: None,
            next: Some(settings),
            tied: found.roots.len() as u64,
            ties: found.roots,
            layouts: vec![found.layout],
        })
    }

    /// Returns a layout that lies flat where the budget has ended without one, found from the best of those that may
    /// overlap.
    ///
    /// # Errors
    /// [`Refusal::NothingFlat`] if none is found, or the observer has ended the call.
    fn first_flat(&self, free: Optimum) -> Result<Proposals, Refusal> {
        let (seed, weights) = (self.settings.seed, &self.objective.weights);
        let least = self.objective.value(&free.layout)[0];
        let sought = self.observer.should_continue();
        let flat = sought.then(|| tabu_unfolding::first_flat(self.target, weights, free.layout, seed));
        let flat = flat.flatten().ok_or(Refusal::NothingFlat)?;
        let ties = vec![flat.root];
        Ok(self.unproved(vec![flat], least, ties, 1))
    }

    fn optimum(&self, settings: &branch_and_bound::Settings) -> Result<Optimum, NoLayout> {
        branch_and_bound::search(self.target, &self.objective.weights, settings, None, self.observer)
    }

    /// Returns the best layouts by enumeration of every layout with every root.
    fn enumerated(&self) -> Result<Proposals, Refusal> {
        if !self.objective.is_sum_over_faces() || self.settings.minimise == Minimise::Steps {
            let (found, limit) = self.measured()?;
            let first = self.objective.value(&found.layouts[0]);
            let by_parts = self.objective.is_greatest_sum() && TOLERANCES.prove(first[0], found.bound);
            return if by_parts || found.values.is_some() {
                Ok(found)
            } else {
                Err(Refusal::TooManyLayouts { limit })
            };
        }
        let asked =
            enumerate::Settings { root: self.problem.root, spectrum: false, budget: self.settings.budget };
        let weights = &self.objective.weights;
        let all =
            enumerate::enumerate_energies(self.target, weights, &asked, self.observer).map_err(too_many)?;
        let tie = all.least * (1.0 + TOLERANCES.tie);
        let ties = (0..all.by_root.len()).filter(|root| all.by_root[*root] <= tie).collect();
        let least = self.scaled(all.least);
        if !all.complete {
            return Ok(self.unproved(vec![all.best], least, ties, all.ties));
        }
        // The best of all may overlap: the best that lies flat costs no less.
        let flat = self.proved()?;
        let bound = flat.bound.max(least * (1.0 - TOLERANCES.bound));
        Ok(Proposals { bound, least, ties, tied: all.ties, ..flat })
    }

    /// Returns the layout that the problem gives as pairs of faces, with its best roots.
    fn given(&self, pairs: &[[usize; 2]]) -> Result<Proposals, Refusal> {
        let faces = self.target.faces.len();
        let hinge = |pair: &[usize; 2]| {
            let [a, b] = *pair;
            let known = a.max(b) < faces;
            let hinge = known.then(|| self.target.hinge_between(a, b)).flatten();
            hinge.ok_or(Refusal::NoSuchHinge { faces: *pair })
        };
        let hinges = pairs.iter().map(hinge).collect::<Result<Vec<usize>, _>>()?;
        let of_root = |root: usize| Layout::of_hinges(self.target, &hinges, root);
        let layouts: Option<Vec<Layout>> = self.roots.iter().copied().map(of_root).collect();
        let layouts = layouts.ok_or(Refusal::NotSpanning { hinges: hinges.len(), faces })?;
        let values: Vec<f64> = layouts.iter().map(|layout| self.objective.value(layout)[0]).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let reaches = |(layout, value): (&Layout, &f64)| {
            (*value <= least * (1.0 + TOLERANCES.tie)).then_some(layout.root)
        };
        let ties: Vec<usize> = layouts.iter().zip(&values).filter_map(reaches).collect();
        let best = layouts.into_iter().filter(|layout| ties.contains(&layout.root)).collect();
        let tied = ties.len() as u64;
        Ok(self.unproved(best, least, ties, tied))
    }

    /// Returns the best layouts: every layout measured where they are few, else by local search; with the
    /// number of pairs of a layout and a root up to which all are measured.
    fn measured(&self) -> Result<(Proposals, u64), Refusal> {
        let budget = self.settings.budget.min(self.objective.measures_max());
        let prefilter = self.objective.prefilter(self.settings.budget);
        let settings =
            local_search::Settings { roots: self.roots.clone(), flat: true, budget, keep: KEPT, prefilter };
        let budget = prefilter.map_or(budget, |prefilter| prefilter.budget);
        let weights = &self.objective.weights;
        let mut value = |layout: &Layout| self.objective.value(layout);
        let found = local_search::search(self.target, weights, &settings, &mut value, self.observer);
        let Measured { best, ties, roots, least, complete } = found;
        let Some((_, [first, _])) = best.first() else {
            return Err(if complete { Refusal::AllOverlap } else { Refusal::NothingFlat });
        };
        let first = *first;
        let (layouts, values): (Vec<Layout>, Vec<[f64; 2]>) = best.into_iter().unzip();
        let bound = if complete {
            least_from(&values, 0, self.settings.minimise)
        } else {
            self.objective.lower_bound(&self.roots, Orders::LeavesFirst)
        };
        let values = complete.then_some(values);
        let found = Proposals { layouts, next: None, bound, least, values, ties: roots, tied: ties };
        let by_parts = self.objective.is_greatest_sum();
        Ok((if by_parts && !complete { self.of_least_peak(found, first) } else { found }, budget))
    }

    /// Adds a proof of the least peak torque, as far as the budget reaches: `first` is that of the first
    /// layout.
    fn of_least_peak(&self, mut found: Proposals, first: f64) -> Proposals {
        let scale = self.objective.peak_by_mean();
        let (target, weights) = (self.target, &self.objective.weights);
        let (mut budget_left, mut best, mut bound) = (self.settings.budget, first / scale, f64::INFINITY);
        for &root in &self.roots {
            let least = peak_torque::least(target, weights, root, best, &mut budget_left);
            bound = bound.min(least.bound);
            if let Some((layout, reached)) = least.layout.filter(|(_, reached)| *reached < best) {
                best = reached;
                found.ties = vec![root];
                found.tied = 1;
                found.layouts.insert(0, layout);
            }
        }
        found.least = found.least.min(best * scale);
        found.bound = (bound * scale).max(found.bound);
        found
    }

    /// Returns the layout that the paper's measure prefers.
    fn preferred(&self) -> Result<Proposals, Refusal> {
        let panel = &self.panels.weakest;
        let measure = Measure::of_panels(panel.mass, panel.sides[0]);
        let found = heuristic::preferred(self.target, &measure, self.problem.root, self.settings.budget)
            .map_err(too_many)?;
        let least = self.objective.value(&found.layout)[0];
        let ties = vec![found.layout.root];
        Ok(self.unproved(vec![found.layout], least, ties, found.ties))
    }

    /// Layouts of which nothing is known but the lower bound for all.
    fn unproved(&self, layouts: Vec<Layout>, least: f64, ties: Vec<usize>, tied: u64) -> Proposals {
        let bound = self.objective.lower_bound(&self.roots, Orders::LeavesFirst);
        Proposals { layouts, next: None, bound, least, values: None, ties, tied }
    }
}

fn refusal(why: NoLayout) -> Refusal {
    match why {
        NoLayout::AllOverlap => Refusal::AllOverlap,
        NoLayout::Budget => Refusal::NothingFlat,
    }
}

fn too_many(TooManyFaces: TooManyFaces) -> Refusal {
    Refusal::TooManyFaces { limit: enumerate::FACES_MAX }
}
