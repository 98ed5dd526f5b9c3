//! Layouts made of strips that fold with the leaves first and without collision, where those of least energy
//! collide.
//!
//! Cheap layouts are trees of large degree at the root: rings close between groups of faces that have folded
//! already, and these collide. Nothing collides where a ring is cut into strips that roll up each in its own
//! sector, on one strip that rolls up last. Such layouts are found as maximum spanning trees by properties of
//! the hinges: trees of those that are longest, most convex, or fold the most or the least, and of nearly
//! equal trees those that cost the least. The cheap layouts themselves are a beginning where few collisions
//! occur. Faces that still overlap in the plane or collide while they fold are separated by exchanges of one
//! hinge for another between the two, as in `tabu_unfolding`; and collision-free layouts are made cheaper by
//! exchanges that keep them so. Nothing is proved, and collisions are sampled: the judge decides.

use super::edge_exchange::{self, Rules};
use super::layout::Layout;
use super::pattern::Pattern;
use super::steps;
use super::sweep_collision::{Solids, SweepCheck};
use super::tabu_unfolding::TabuExchange;
use super::target::{Hinge, Target};
use super::tolerances::TOLERANCES;
use super::weights::Weights;
use crate::interrupt;
use std::cell::RefCell;

/// The number of sampled states of each step, of panels without thickness.
const SAMPLES_THIN: usize = 8;

/// The number of sampled states of each step, of panels with thickness.
const SAMPLES_THICK: usize = 24;

/// The fraction by which thin panels are shrunk, so that neighbours do not collide.
const SHRINKAGE: f64 = 0.02;

/// The time of a check of panels with thickness, as a multiple of that of panels without.
const THICK: usize = 4;

/// The worth of a level hinge beside those that bend, which are worth 1 at most.
const LEVEL_HINGE_WORTH: f64 = 2.0;

/// The parts of the worth of a tree that may be given up for less energy.
const SLACKS: [f64; 4] = [0.002, 0.02, 0.08, 0.25];

/// The number of exchanges of hinges evaluated in one improvement of a layout's energy.
const STEPS_IMPROVING: u64 = 2_000_000;
/// The number of improvements of one tree, each from the best root.
const ROOTS_TRIED: usize = 3;

/// The number of cheap layouts among the starts.
const CHEAP_MAX: usize = 2;

/// The number of starts whose hinges are exchanged until nothing collides.
const SEPARATED_MAX: usize = 6;

/// The number of rounds of such exchanges, each with other random numbers.
const ROUNDS_MAX: u64 = 8;

/// The number of exchanges that are sampled before the best is made.
const EXCHANGES_SAMPLED: usize = 12;

/// The number of exchanges in a row that may leave no fewer conflicting pairs than ever before.
const STALLED_EXCHANGES_MAX: usize = 12;

/// The number of collision-free layouts at which the search ends.
const COLLISION_FREE_MAX: usize = 8;

/// The number of collision-free layouts that are made cheaper.
const IMPROVED_MAX: usize = 3;

/// The remaining budget divided by this is that of each improvement of such a layout, and is kept for them.
const IMPROVEMENT_SHARE: usize = 4;

/// A randomised search for layouts made of strips of faces, which lie flat and fold with the leaves first without
/// collision. Nothing is proved.
pub struct StripSearch<'t> {
    /// The surface that is folded, with its faces and hinges.
    pub target: &'t Target,
    /// The costs of the target's hinges for the faces that they carry, N·m for steps of one second; the energy of a
    /// layout is a sum of them.
    pub weights: &'t Weights,
    /// The panels as solids with their thickness.
    pub solids: &'t Solids,
    /// The faces that may be the root, indices in [`Target::faces`]; at least one.
    pub roots: &'t [usize],
    /// Layouts of little energy as further starts, the best first; two of them are used.
    pub cheap: &'t [Layout],
    /// The seed of the random exchanges of hinges.
    pub seed: u64,
    /// The number of states of pairs of panels that may still be sampled; one of panels with thickness counts as four.
    /// It goes down as [`StripSearch::layouts`] works.
    pub states_left: usize,
}

/// The conflicts of a layout: fewer is better, then less energy.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Conflicts {
    overlaps: usize,
    thin: usize,
    thick: usize,
    energy: f64,
}

impl Conflicts {
    const NONE: Conflicts = Conflicts { overlaps: 0, thin: 0, thick: 0, energy: f64::INFINITY };

    fn is_clear(&self) -> bool {
        self.overlaps + self.thin + self.thick == 0
    }
}

impl StripSearch<'_> {
    /// Returns layouts that lie flat and in which no sample shows a collision while they fold with the leaves first,
    /// that of least energy first; empty if none was found. Uses up [`StripSearch::states_left`]. Panics without roots.
    pub fn layouts(&mut self) -> Vec<Layout> {
        let mut starts: Vec<(Conflicts, Layout)> = Vec::new();
        for layout in self.trees().into_iter().chain(self.cheap.iter().take(CHEAP_MAX).cloned()) {
            if starts.iter().all(|(_, other)| *other != layout) {
                starts.push((self.conflicts(&layout, None).0, layout));
            }
        }
        starts.sort_by(|a, b| a.0.partial_cmp(&b.0).expect("energies are numbers"));
        let (clear, blocked): (Vec<_>, Vec<_>) =
            starts.into_iter().partition(|(conflicts, _)| conflicts.is_clear());
        let mut clear: Vec<Layout> = clear.into_iter().map(|(_, layout)| layout).collect();
        let kept = self.states_left / IMPROVEMENT_SHARE;
        for round in 0..ROUNDS_MAX {
            for (_, layout) in blocked.iter().take(SEPARATED_MAX) {
                if self.states_left > kept
                    && clear.len() < COLLISION_FREE_MAX
                    && (round == 0 || clear.is_empty())
                {
                    clear.extend(self.separated(layout.clone(), self.seed + round, kept));
                }
            }
        }
        let by_energy = |a: &Layout, b: &Layout| a.energy(self.weights).total_cmp(&b.energy(self.weights));
        clear.sort_by(by_energy);
        for layout in clear.clone().into_iter().take(IMPROVED_MAX) {
            let kept = self.states_left - self.states_left / IMPROVEMENT_SHARE;
            let cheaper = self.cheaper(layout, kept);
            clear.push(cheaper);
        }
        clear.sort_by(by_energy);
        clear.dedup();
        clear
    }

    /// Returns maximum spanning trees by the length and angle of hinges, made cheaper.
    fn trees(&self) -> Vec<Layout> {
        let hinges = &self.target.hinges;
        let most = hinges.iter().map(|hinge| hinge.angle.abs()).fold(f64::MIN_POSITIVE, f64::max);
        let length = |hinge: &Hinge| self.target.side_lengths(hinge.faces[0])[hinge.sides[0]];
        let longest = hinges.iter().map(length).fold(f64::MIN_POSITIVE, f64::max);
        let is_level = |hinge: &Hinge| hinge.angle.abs() < TOLERANCES.level;
        let worths: [&dyn Fn(&Hinge) -> f64; 4] = [
            &|hinge| length(hinge) / longest,
            &|hinge| if is_level(hinge) { LEVEL_HINGE_WORTH } else { (hinge.angle + most) / (2.0 * most) },
            &|hinge| if is_level(hinge) { LEVEL_HINGE_WORTH } else { hinge.angle.abs() / most },
            &|hinge| 1.0 - hinge.angle.abs() / most,
        ];
        let mut trees = Vec::new();
        for worth in worths {
            let worths: Vec<f64> = hinges
                .iter()
                .map(|hinge| (worth(hinge) / TOLERANCES.worth).round() * TOLERANCES.worth)
                .collect();
            let tree = heaviest_tree(self.target, &worths);
            let sum =
                |hinges: &mut dyn Iterator<Item = &usize>| hinges.map(|hinge| worths[*hinge]).sum::<f64>();
            let greatest = sum(&mut tree.iter());
            for slack in SLACKS {
                let needed = greatest - slack * self.target.faces.len() as f64;
                trees.push(self.cheapened(&tree, &|layout, [dropped, added]| {
                    let change = worths[added] - worths[dropped];
                    change >= 0.0 || sum(&mut layout.hinge.iter().flatten()) + change >= needed
                }));
            }
        }
        trees
    }

    /// Returns the cheapest layout that exchanges lead to, rooted at the best root.
    fn cheapened(&self, hinges: &[usize], fits: &dyn Fn(&Layout, [usize; 2]) -> bool) -> Layout {
        let of_root = |root: usize| Layout::of_hinges(self.target, hinges, root).expect("it is a tree");
        let mut layout = self.at_best_root(&of_root(self.roots[0]));
        for _ in 0..ROOTS_TRIED {
            let mut steps = STEPS_IMPROVING;
            let rules = Rules { fits, allowed: &|_| true };
            let better =
                edge_exchange::improved_by(self.target, self.weights, layout.clone(), &mut steps, &rules);
            let better = self.at_best_root(&better);
            if better == layout {
                break;
            }
            layout = better;
        }
        layout
    }

    /// Returns a layout rerooted at the root of least energy.
    fn at_best_root(&self, layout: &Layout) -> Layout {
        let hung = self.roots.iter().map(|root| layout.rerooted(self.target, *root));
        let by_energy = |a: &Layout, b: &Layout| a.energy(self.weights).total_cmp(&b.energy(self.weights));
        hung.min_by(by_energy).expect("there is a root")
    }

    /// Returns the conflicts of a layout, as far as they are no worse than `least`, with the pairs of faces.
    fn conflicts(&mut self, layout: &Layout, least: Option<&Conflicts>) -> (Conflicts, Vec<[usize; 2]>) {
        let n = self.target.faces.len();
        let energy = layout.energy(self.weights);
        let mut pairs = Pattern::of(self.target, layout).overlaps();
        let mut conflicts = Conflicts { overlaps: pairs.len(), thin: 0, thick: 0, energy };
        self.states_left = self.states_left.saturating_sub(n * n);
        if least.is_some_and(|least| conflicts.overlaps > least.overlaps) {
            return (conflicts, pairs);
        }
        let steps = steps::leaves_first(layout);
        let most = least.filter(|least| least.overlaps == conflicts.overlaps).map_or(usize::MAX, |l| l.thin);
        let states = steps.len() * n * n / 2;
        self.states_left = self.states_left.saturating_sub(states * SAMPLES_THIN);
        let thin = SweepCheck::thin(self.target, layout, SHRINKAGE).collisions(&steps, SAMPLES_THIN, most);
        conflicts.thin = thin.len();
        pairs.extend(thin);
        if pairs.is_empty() {
            self.states_left = self.states_left.saturating_sub(THICK * states * SAMPLES_THICK);
            let thick = SweepCheck::thick(self.target, layout, self.solids);
            pairs = thick.collisions(&steps, SAMPLES_THICK, n);
            conflicts.thick = pairs.len();
        }
        (conflicts, pairs)
    }

    /// Exchanges hinges between faces that overlap or collide by tabu search until none do, as long as more
    /// than `kept` of the budget is left; `None` if it ends before, or no progress is made.
    fn separated(&mut self, layout: Layout, seed: u64, kept: usize) -> Option<Layout> {
        let target = self.target;
        let mut parting = TabuExchange::new(target, seed);
        let mut now = layout;
        let (mut fewest, mut patience) = (usize::MAX, STALLED_EXCHANGES_MAX);
        for round in 1.. {
            interrupt::checkpoint();
            let (_, pairs) = self.conflicts(&now, None);
            patience -= 1;
            if pairs.len() < fewest {
                (fewest, patience) = (pairs.len(), STALLED_EXCHANGES_MAX);
            }
            if patience == 0 {
                break;
            }
            let Some([a, b]) = parting.one_of(&pairs) else { return Some(now) };
            let between = edge_exchange::path(&now, a, b);
            if between.is_empty() {
                continue;
            }
            let mut best: Option<(Conflicts, Layout, usize)> = None;
            for _ in 0..EXCHANGES_SAMPLED {
                if self.states_left <= kept {
                    return None;
                }
                let Some((next, dropped)) = parting.exchange(&now, &between, round) else { continue };
                let (conflicts, _) = self.conflicts(&next, best.as_ref().map(|best| &best.0));
                if best.as_ref().is_none_or(|(least, ..)| conflicts < *least) {
                    best = Some((conflicts, next, dropped));
                }
            }
            if let Some((_, next, dropped)) = best {
                parting.give_up(dropped, round);
                now = next;
            }
        }
        None
    }

    /// Improves a layout by exchanges that keep it collision-free, as long as more than `kept` of the budget is left.
    fn cheaper(&mut self, layout: Layout, kept: usize) -> Layout {
        let (target, weights) = (self.target, self.weights);
        let this = RefCell::new(self);
        let rules = Rules {
            fits: &|_, _| true,
            allowed: &|layout| {
                let mut this = this.borrow_mut();
                this.states_left > kept && this.conflicts(layout, Some(&Conflicts::NONE)).0.is_clear()
            },
        };
        let mut steps = STEPS_IMPROVING;
        edge_exchange::improved_by(target, weights, layout, &mut steps, &rules)
    }
}

/// Connected components of faces (union-find).
struct Components(
    /// The least face that each face is joined to.
    Vec<usize>,
);

impl Components {
    /// Makes one component of each face.
    fn new(faces: usize) -> Components {
        Components((0..faces).collect())
    }

    /// Joins the components of two faces; returns true if they were distinct.
    fn join(&mut self, faces: [usize; 2]) -> bool {
        let [a, b] = faces.map(|face| self.0[face]);
        self.0.iter_mut().filter(|piece| **piece == a.max(b)).for_each(|piece| *piece = a.min(b));
        a != b
    }
}

/// Returns the hinges of the maximum spanning tree by worth (Kruskal's algorithm); of equal ones the first.
fn heaviest_tree(target: &Target, worths: &[f64]) -> Vec<usize> {
    let mut by_worth: Vec<usize> = (0..worths.len()).collect();
    by_worth.sort_by(|a, b| worths[*b].total_cmp(&worths[*a]));
    let mut components = Components::new(target.faces.len());
    by_worth.retain(|hinge| components.join(target.hinges[*hinge].faces));
    by_worth
}
