//! The choice of a layout and an order together: candidates from the search over both and from layouts that are good
//! with the leaves first are put before the judge in order of their energy. The answers of the other orders that the
//! settings know are candidates as well, so that none of them spends less than the answer.

use super::carried_moments::CarriedMoments;
use super::evaluation::{Candidates, Chosen};
use super::heuristic::{self, Measure};
use super::joint_search::{JointSearch, OrderedLayout};
use super::layout::Layout;
use super::objective::Minimise;
use super::order_bounds::{self, Orders};
use super::order_descent;
use super::pattern::has_equal_triangles;
use super::proposals::Proposals;
use super::refusal::{Refusal, Rejection};
use super::settings::Sequence;
use super::spanning_trees;
use super::steps;
use super::sweep_collision::{Collision, first_collision};
use super::symmetry;
use super::task::{Outcome, Task};
use super::tolerances::TOLERANCES;
use num_traits::ToPrimitive;

/// The budget divided by this is that of the search over layouts and orders.
const SEARCH_SHARE: u64 = 4;

/// The number of layouts that are good with the leaves first from which the search begins.
const STARTS_MAX: usize = 8;

/// The number of layouts of a target up to which that of the paper's heuristic is a beginning as well.
const HEURISTIC_LAYOUTS_MAX: u64 = 5_000;

/// The number of panels that are put before the judge, summed over candidates; but at least [`JUDGED_MIN`] candidates.
const JUDGED_PANELS_MAX: usize = 1_600;
/// The least number of candidates that may be put before the judge.
const JUDGED_MIN: usize = 8;

/// Thin panels are shrunk by this fraction in collision samples.
const SHRINKAGE: f64 = 0.02;

/// The orders that the settings name, which are candidates for the layouts that are good with the leaves first.
const NAMED: [Sequence; 4] =
    [Sequence::LeavesFirst, Sequence::RootFirst, Sequence::LeastWork, Sequence::LeastEnergy];

/// A folding that may be the answer, with its energy, N·m for steps of one second.
struct Candidate {
    layout: Layout,
    steps: Vec<Vec<usize>>,
    energy: f64,
}

impl Task<'_> {
    /// Returns true if the layout and the order of folding are sought together.
    pub(super) fn is_joint(&self) -> bool {
        self.settings.sequence == Sequence::Auto
            && self.objective.is_sum_over_faces()
            && self.settings.minimise == Minimise::Energy
    }

    /// Returns the folding of least energy found over layouts and orders that the judge lets through; `None` if it lets
    /// none through. `found` has the layouts that are good with the leaves first, and gets the roots that tie;
    /// `candidates` gets the first refusal.
    ///
    /// # Errors
    /// A [`Refusal`] that holds for every layout, as [`Task::judged`] says.
    pub(super) fn best_of_all_orders(
        &self,
        candidates: &mut Candidates,
        found: &mut Proposals,
    ) -> Result<Option<Chosen>, Refusal> {
        let inertia = self.conventions.inertia;
        let moments = CarriedMoments::new(self.target, &self.panels.masses, inertia);
        let mut search = self.joint_search(&moments, found);
        let pool = self.pool(&mut search, found);
        let mut best = self.first_accepted(pool, &mut candidates.first)?;
        // The orders with a name come next, for the judge may refuse their first layouts.
        for sequence in NAMED.into_iter().filter(|_| self.problem.hinges.is_none()) {
            let cutoff = best.as_ref().map_or(f64::INFINITY, |best| self.value(&best.layout, &best.steps));
            if sequence == Sequence::LeavesFirst && found.bound >= cutoff * (1.0 - TOLERANCES.proof) {
                continue;
            }
            let mut of_sequence = Candidates::new(sequence, cutoff);
            match self.best_accepted(&mut of_sequence, found) {
                Ok(Some(chosen)) => best = self.lesser(best, Some(chosen.outcome)),
                Ok(None) => {
                    candidates.is_barred |= sequence == Sequence::LeavesFirst && !of_sequence.is_cut_off;
                }
                Err(Refusal::SequenceTooHigh) => {}
                Err(refusal) => return Err(refusal),
            }
        }
        let Some(outcome) = best else { return Ok(None) };
        self.set_ties(&search, &outcome, found);
        let least = search.bounds.iter().copied().fold(f64::INFINITY, f64::min);
        let bound = self.scaled(least) * (1.0 - TOLERANCES.bound);
        Ok(Some(Chosen { outcome, bound, orders: Orders::Any, is_fewest: false }))
    }

    /// Returns the search over layouts and orders after its run; where the problem gives a layout, with that alone.
    fn joint_search<'s>(&'s self, moments: &'s CarriedMoments<'s>, found: &Proposals) -> JointSearch<'s> {
        let (masses, weights) = (&self.panels.masses, &self.objective.weights);
        let inertia = self.conventions.inertia;
        let by_root = order_bounds::energies(self.target, weights, masses, inertia, Orders::Any);
        // One root of each orbit stands for all of them.
        let orbits = symmetry::orbits(self.target, weights);
        let is_first = |root: usize| self.problem.root.is_some() || orbits[root] == root;
        let mut bounds = vec![f64::INFINITY; masses.len()];
        self.roots.iter().filter(|root| is_first(**root)).for_each(|&root| bounds[root] = by_root[root]);
        let mut search = JointSearch {
            moments,
            weights,
            masses,
            inertia,
            bounds,
            budget_left: self.settings.budget / SEARCH_SHARE,
            seed: self.settings.seed,
            kept: Vec::new(),
        };
        if self.is_of_one_layout() {
            for layout in &found.layouts {
                let ordered = search.ordered(layout.clone(), order_descent::leaves_first(layout));
                search.keep(&ordered);
            }
            return search;
        }
        let mut starts: Vec<Layout> = found.layouts.iter().take(STARTS_MAX).cloned().collect();
        starts.extend(self.of_heuristic());
        search.run(&starts);
        search
    }

    /// Returns true if the call names the layout, or the paper's heuristic does.
    fn is_of_one_layout(&self) -> bool {
        self.problem.hinges.is_some() || self.settings.method == super::settings::Method::Heuristic
    }

    /// Returns the layout that the paper's measure prefers, where that is soon known.
    fn of_heuristic(&self) -> Option<Layout> {
        let masses = &self.panels.masses;
        let are_few =
            spanning_trees::layouts(self.target).to_u64().is_some_and(|n| n <= HEURISTIC_LAYOUTS_MAX);
        let are_equal = masses.iter().all(|mass| (mass - masses[0]).abs() <= TOLERANCES.mass * masses[0]);
        if !(are_few && are_equal && has_equal_triangles(self.target)) {
            return None;
        }
        let panel = &self.panels.weakest;
        let measure = Measure::of_panels(panel.mass, panel.sides[0]);
        let found = heuristic::preferred(self.target, &measure, self.problem.root, self.settings.budget);
        found.ok().map(|found| found.layout)
    }

    /// Returns the candidates in order of their energy; of equal ones, first those of the fewest steps, and then those
    /// that are good with the leaves first.
    fn pool(&self, search: &mut JointSearch, found: &Proposals) -> Vec<Candidate> {
        let mut pool = Vec::new();
        let by_square = self.conventions.step * self.conventions.step;
        for layout in found.layouts.iter().take(STARTS_MAX) {
            for sequence in NAMED {
                if let Ok(steps) = self.steps_in(layout, sequence) {
                    let energy = self.value(layout, &steps) * by_square;
                    pool.push(Candidate { layout: layout.clone(), steps, energy });
                }
            }
        }
        pool.extend(search.kept.iter().map(|OrderedLayout { layout, order, energy }| Candidate {
            layout: layout.clone(),
            steps: steps::of_order(layout, order),
            energy: *energy,
        }));
        let least = pool.iter().map(|candidate| candidate.energy).fold(f64::INFINITY, f64::min);
        let rank = |candidate: &Candidate| {
            let is_tied = candidate.energy <= least * (1.0 + TOLERANCES.tie);
            (if is_tied { least } else { candidate.energy }, candidate.steps.len())
        };
        pool.sort_by(|a, b| {
            let ((a, fewer), (b, more)) = (rank(a), rank(b));
            a.total_cmp(&b).then(fewer.cmp(&more))
        });
        pool
    }

    /// Returns the first candidate that the judge lets through; `first` gets the first refusal.
    fn first_accepted(
        &self,
        pool: Vec<Candidate>,
        first: &mut Option<Rejection>,
    ) -> Result<Option<Outcome>, Refusal> {
        let mut judged = 0;
        let judged_max = (JUDGED_PANELS_MAX / self.target.faces.len()).max(JUDGED_MIN);
        for Candidate { layout, steps, .. } in pool {
            if judged == judged_max || judged > 0 && !self.observer.should_continue() {
                break;
            }
            // A given layout is refused in the judge's words.
            let samples = self.problem.hinges.is_none();
            let collision =
                samples.then(|| first_collision(self.target, &layout, &steps, SHRINKAGE)).flatten();
            if let Some(Collision { step, faces }) = collision {
                first.get_or_insert(Rejection::Meet { faces, step });
                continue;
            }
            judged += 1;
            match self.judged(&layout, &steps)? {
                Ok(solution) => return Ok(Some(Outcome { solution, layout, steps, stops: Vec::new() })),
                Err(failure) => {
                    first.get_or_insert(Rejection::Judged(failure));
                }
            }
        }
        Ok(None)
    }

    /// Notes the roots that are known to be as good as that of the answer.
    fn set_ties(&self, search: &JointSearch, outcome: &Outcome, found: &mut Proposals) {
        let orbits = symmetry::orbits(self.target, &self.objective.weights);
        let by_square = self.conventions.step * self.conventions.step;
        let energy = self.value(&outcome.layout, &outcome.steps) * by_square;
        let mut tied: Vec<usize> = vec![orbits[outcome.layout.root]];
        let as_good = |kept: &&OrderedLayout| kept.energy <= energy * (1.0 + TOLERANCES.tie);
        tied.extend(search.kept.iter().filter(as_good).map(|kept| orbits[kept.layout.root]));
        found.ties = self.roots.iter().copied().filter(|root| tied.contains(&orbits[*root])).collect();
        found.tied = found.ties.len() as u64;
    }
}
