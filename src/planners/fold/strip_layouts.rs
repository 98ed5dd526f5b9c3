//! Layouts that fold with the leaves first and nothing in the way, where those of least energy do not.
//!
//! Cheap layouts are stars of many arms: rings close between lumps that have folded already, and these
//! meet. Nothing meets where a ring is cut into strips that curl up each in its own sector, on one strip
//! that curls up last. Such layouts are found by what hinges are: trees of those that are longest, most
//! convex, or fold the most or the least, and of nearly equal trees those that cost the least. Where little is
//! in the way, the cheap layouts themselves are a beginning.
//! What still overlaps in the plane or meets on the way is parted by exchanges of one hinge for another
//! between the two, as in [`flatten`](super::tabu_unfolding); and what is clear is made cheaper by exchanges that
//! keep it so. Nothing is proved, and what is looked at are samples: the judge decides.

use super::edge_exchange::{self, Rules};
use super::layout::Layout;
use super::pattern::Pattern;
use super::steps;
use super::sweep_collision::{Solids, SweepCheck};
use super::tabu_unfolding::TabuExchange;
use super::target::{Hinge, Target};
use super::weights::Weights;
use crate::interrupt;
use std::cell::RefCell;

/// States of each step that are looked at, of panels without and with thickness.
const SAMPLES_THIN: usize = 8;
const SAMPLES_THICK: usize = 24;

/// Panels without thickness are made smaller by this part, so that those do not meet which share an edge.
const SHRUNK: f64 = 0.02;

/// A look at panels with thickness takes as long as so many without.
const THICK: usize = 4;

/// A hinge that folds less is level, rad.
const TOL_LEVEL: f64 = 1e-6;

/// What a hinge that is level is worth beside those that bend, which are worth 1 at most.
const LEVEL: f64 = 2.0;

/// Worths that differ by less are equal: rounding does not choose.
const TOL_WORTH: f64 = 1e-6;

/// The part of the worth of a tree that may be given up for less energy.
const SLACKS: [f64; 4] = [0.002, 0.02, 0.08, 0.25];

/// Steps of one improvement of a layout's energy; roots are changed so often.
const STEPS_IMPROVING: u64 = 2_000_000;
const ROOTS_TRIED: usize = 3;

/// Cheap layouts that are exchanged as well.
const CHEAP_MAX: usize = 2;

/// Layouts that are exchanged until nothing meets, and how often, with other dice.
const PARTED_MAX: usize = 6;
const TURNS: u64 = 8;

/// Exchanges that are looked at before one is made.
const LOOKS: usize = 12;

/// So many exchanges may be made that do not leave fewer pairs of faces than ever before.
const PATIENCE: usize = 12;

/// With so many layouts that are clear no more are sought.
const CLEAR_ENOUGH: usize = 8;

/// Layouts that are made cheaper, and the part of what is left that goes into each: one by this.
const CHEAPENED_MAX: usize = 3;
const CHEAPENING: usize = 4;

/// A search for layouts that fold with the leaves first.
pub struct StripSearch<'t> {
    pub target: &'t Target,
    pub weights: &'t Weights,
    pub solids: &'t Solids,
    /// Hinges without which panels meet in the target; no cycle.
    pub must: &'t [usize],
    /// Faces that may be the root.
    pub roots: &'t [usize],
    /// Cheap layouts, in which little may be in the way.
    pub cheap: &'t [Layout],
    pub seed: u64,
    /// States of pairs of panels that may be looked at.
    pub left: usize,
}

/// What stands against a layout: fewer is better, then less energy.
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
    /// Layouts in which nothing is seen to meet, the cheapest first.
    pub fn layouts(&mut self) -> Vec<Layout> {
        let mut starts: Vec<(Conflicts, Layout)> = Vec::new();
        for layout in self.trees().into_iter().chain(self.cheap.iter().take(CHEAP_MAX).cloned()) {
            if starts.iter().all(|(_, other)| *other != layout) {
                starts.push((self.trouble(&layout, None).0, layout));
            }
        }
        starts.sort_by(|a, b| a.0.partial_cmp(&b.0).expect("energies are numbers"));
        let (clear, blocked): (Vec<_>, Vec<_>) =
            starts.into_iter().partition(|(trouble, _)| trouble.is_clear());
        let mut clear: Vec<Layout> = clear.into_iter().map(|(_, layout)| layout).collect();
        let kept = self.left / CHEAPENING;
        for turn in 0..TURNS {
            for (_, layout) in blocked.iter().take(PARTED_MAX) {
                if self.left > kept && clear.len() < CLEAR_ENOUGH && (turn == 0 || clear.is_empty()) {
                    clear.extend(self.parted(layout.clone(), self.seed + turn, kept));
                }
            }
        }
        let by_energy = |a: &Layout, b: &Layout| a.energy(self.weights).total_cmp(&b.energy(self.weights));
        clear.sort_by(by_energy);
        for layout in clear.clone().into_iter().take(CHEAPENED_MAX) {
            let kept = self.left - self.left / CHEAPENING;
            let cheaper = self.cheaper(layout, kept);
            clear.push(cheaper);
        }
        clear.sort_by(by_energy);
        clear.dedup();
        clear
    }

    /// Trees by where the shape bends.
    fn trees(&self) -> Vec<Layout> {
        let hinges = &self.target.hinges;
        let most = hinges.iter().map(|hinge| hinge.angle.abs()).fold(f64::MIN_POSITIVE, f64::max);
        let length = |hinge: &Hinge| self.target.side_lengths(hinge.faces[0])[hinge.sides[0]];
        let longest = hinges.iter().map(length).fold(f64::MIN_POSITIVE, f64::max);
        let is_level = |hinge: &Hinge| hinge.angle.abs() < TOL_LEVEL;
        let worths: [&dyn Fn(&Hinge) -> f64; 4] = [
            &|hinge| length(hinge) / longest,
            &|hinge| if is_level(hinge) { LEVEL } else { (hinge.angle + most) / (2.0 * most) },
            &|hinge| if is_level(hinge) { LEVEL } else { hinge.angle.abs() / most },
            &|hinge| 1.0 - hinge.angle.abs() / most,
        ];
        let mut trees = Vec::new();
        for worth in worths {
            let worth = |(index, hinge): (usize, &Hinge)| match self.must.contains(&index) {
                true => LEVEL * self.target.faces.len() as f64,
                false => worth(hinge),
            };
            let worths: Vec<f64> = hinges
                .iter()
                .enumerate()
                .map(|hinge| (worth(hinge) / TOL_WORTH).round() * TOL_WORTH)
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

    /// The cheapest layout that exchanges lead to, hung up at the best root.
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

    fn at_best_root(&self, layout: &Layout) -> Layout {
        let hung = self.roots.iter().map(|root| layout.rerooted(self.target, *root));
        let by_energy = |a: &Layout, b: &Layout| a.energy(self.weights).total_cmp(&b.energy(self.weights));
        hung.min_by(by_energy).expect("there is a root")
    }

    /// What stands against a layout, as far as it is no worse than `least`, with the pairs of faces.
    fn trouble(&mut self, layout: &Layout, least: Option<&Conflicts>) -> (Conflicts, Vec<[usize; 2]>) {
        let n = self.target.faces.len();
        let energy = layout.energy(self.weights);
        let mut pairs = Pattern::of(self.target, layout).overlaps();
        let mut trouble = Conflicts { overlaps: pairs.len(), thin: 0, thick: 0, energy };
        self.left = self.left.saturating_sub(n * n);
        if least.is_some_and(|least| trouble.overlaps > least.overlaps) {
            return (trouble, pairs);
        }
        let steps = steps::leaves_first(layout);
        let most = least.filter(|least| least.overlaps == trouble.overlaps).map_or(usize::MAX, |l| l.thin);
        let states = steps.len() * n * n / 2;
        self.left = self.left.saturating_sub(states * SAMPLES_THIN);
        let thin = SweepCheck::thin(self.target, layout, SHRUNK).meetings(&steps, SAMPLES_THIN, most);
        trouble.thin = thin.len();
        pairs.extend(thin);
        if pairs.is_empty() {
            self.left = self.left.saturating_sub(THICK * states * SAMPLES_THICK);
            let thick = SweepCheck::thick(self.target, layout, self.solids);
            pairs = thick.meetings(&steps, SAMPLES_THICK, n);
            trouble.thick = pairs.len();
        }
        (trouble, pairs)
    }

    /// Exchanges hinges between faces that overlap or meet until none do, as long as more than `kept` is left.
    fn parted(&mut self, layout: Layout, seed: u64, kept: usize) -> Option<Layout> {
        let target = self.target;
        let mut parting = TabuExchange::new(target, seed);
        let mut now = layout;
        let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
        for round in 1.. {
            interrupt::checkpoint();
            let (_, pairs) = self.trouble(&now, None);
            patience -= 1;
            if pairs.len() < fewest {
                (fewest, patience) = (pairs.len(), PATIENCE);
            }
            if patience == 0 {
                break;
            }
            let Some([a, b]) = parting.one_of(&pairs) else { return Some(now) };
            let between: Vec<usize> = edge_exchange::path(&now, a, b)
                .into_iter()
                .filter(|hinge| !self.must.contains(hinge))
                .collect();
            if between.is_empty() {
                continue;
            }
            let mut best: Option<(Conflicts, Layout, usize)> = None;
            for _ in 0..LOOKS {
                if self.left <= kept {
                    return None;
                }
                let Some((next, dropped)) = parting.exchange(&now, &between, round) else { continue };
                let (trouble, _) = self.trouble(&next, best.as_ref().map(|best| &best.0));
                if best.as_ref().is_none_or(|(least, ..)| trouble < *least) {
                    best = Some((trouble, next, dropped));
                }
            }
            if let Some((_, next, dropped)) = best {
                parting.give_up(dropped, round);
                now = next;
            }
        }
        None
    }

    /// Exchanges that cost less and keep a layout clear, as long as more than `kept` is left.
    fn cheaper(&mut self, layout: Layout, kept: usize) -> Layout {
        let (target, weights, must) = (self.target, self.weights, self.must);
        let this = RefCell::new(self);
        let rules = Rules {
            fits: &|_, [dropped, _]| !must.contains(&dropped),
            allowed: &|layout| {
                let mut this = this.borrow_mut();
                this.left > kept && this.trouble(layout, Some(&Conflicts::NONE)).0.is_clear()
            },
        };
        let mut steps = STEPS_IMPROVING;
        edge_exchange::improved_by(target, weights, layout, &mut steps, &rules)
    }
}

/// Faces that hang together.
pub struct Pieces(
    /// By face: the least face that it is joined to.
    Vec<usize>,
);

impl Pieces {
    /// None do.
    pub fn new(faces: usize) -> Pieces {
        Pieces((0..faces).collect())
    }

    /// Joins two faces, and tells whether they did not hang together before.
    pub fn join(&mut self, faces: [usize; 2]) -> bool {
        let [a, b] = faces.map(|face| self.0[face]);
        self.0.iter_mut().filter(|piece| **piece == a.max(b)).for_each(|piece| *piece = a.min(b));
        a != b
    }
}

/// The hinges of the spanning tree whose worths come to the most; of equal ones the first.
fn heaviest_tree(target: &Target, worths: &[f64]) -> Vec<usize> {
    let mut by_worth: Vec<usize> = (0..worths.len()).collect();
    by_worth.sort_by(|a, b| worths[*b].total_cmp(&worths[*a]));
    let mut pieces = Pieces::new(target.faces.len());
    by_worth.retain(|hinge| pieces.join(target.hinges[*hinge].faces));
    by_worth
}
