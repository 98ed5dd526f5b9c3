//! The best layouts under an objective that has to be computed for each: enumeration where they are few, else
//! local search by edge exchange from several starts. A bound prefilter skips layouts that can't be among the
//! best.

use super::edge_exchange;
use super::enumerate::{self, Peaks};
use super::layout::Layout;
use super::observer::Observer;
use super::pattern::Pattern;
use super::progress_text;
use super::shortest_paths::ShortestPaths;
use super::spanning_trees;
use super::symmetry;
use super::tabu_unfolding;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::Weights;
use crate::interrupt;
use crate::units::number;
use num_traits::ToPrimitive;
use std::cmp::Ordering;

/// The greatest number of roots from which local search starts.
const STARTS: usize = 8;

/// The number of exchanges that are evaluated by energy alone for each start.
const EXCHANGES: u64 = 1_000_000;

/// The seed of the search for a layout that lies flat where all others overlap.
const SEED: u64 = 0;

/// The options of [`search`]: which layouts count, how many are measured, and how many are kept.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The faces that may be the root, indices in [`Target::faces`]; at least one.
    pub roots: Vec<usize>,
    /// True leaves out layouts whose flat patterns overlap in the plane.
    pub flat: bool,
    /// The greatest number of pairs of a layout and a root that are measured; if there are no more of them, all are
    /// enumerated. The starts of the local search, eight at most, are measured in any case.
    pub budget: u64,
    /// The greatest number of layouts that are kept, the best first; 0 counts as 1.
    pub keep: usize,
    /// The prefilter by bounds; `None` if the objective has none.
    pub prefilter: Option<BoundPrefilter>,
}

/// A prefilter for objectives whose first value is the greatest mean torque of the closed form times a constant: sums
/// over sets of faces give it, so that layouts that can't be among the best need not be made.
#[derive(Clone, Copy, Debug)]
pub struct BoundPrefilter {
    /// The ratio of the first value to the greatest mean torque for steps of one second, without unit.
    pub scale: f64,
    /// The greatest number of pairs of a layout and a root up to which all are enumerated.
    pub budget: u64,
}

/// The result of [`search`]: the best layouts found.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The best layouts, each with its two values (the one that is minimised and the one that decides ties, in the
    /// units of the objective), the best first; empty if none was found that may be kept.
    pub best: Vec<(Layout, [f64; 2])>,
    /// The number of pairs of a layout and a root whose first value is that of the best, up to ties. A local search
    /// counts a pair each time that it meets it.
    pub ties: u64,
    /// The roots (indices in [`Target::faces`]) with which that value is reached, in the order of [`Settings::roots`].
    pub roots: Vec<usize>,
    /// The least first value of all layouts measured, also of those that overlap, in the unit of the objective;
    /// infinite if none was measured.
    pub least: f64,
    /// True if every pair of a layout and a root was visited, or one that is equal to it by symmetry.
    pub complete: bool,
}

/// Searches for the layouts of least value; `value` returns the two values of a layout, which are compared by the
/// first, then by the second. If more than one root is asked for, only one of those that are equal by a symmetry of
/// the target and of `weights` is tried, so `value` must have the same symmetry. Enumerates the pairs of a layout and
/// a root that is tried if they are no more than the budget (or that of the prefilter, if it is greater), in targets
/// of at most [`enumerate::FACES_MAX`] faces; else improves greedy trees by edge exchange. `weights`: the costs that
/// symmetry, greedy trees and the prefilter are computed from. Panics if a root is not a face of the target.
pub fn search(
    target: &Target,
    weights: &Weights,
    settings: &Settings,
    value: &mut dyn FnMut(&Layout) -> [f64; 2],
    observer: &Observer,
) -> Measured {
    let n = target.faces.len();
    // A result for one root holds for those that are equal to it by symmetry.
    let equals = if settings.roots.len() == 1 { (0..n).collect() } else { symmetry::orbits(target, weights) };
    let mut roots: Vec<usize> = settings.roots.iter().map(|root| equals[*root]).collect();
    roots.sort_unstable();
    roots.dedup();
    // Enumeration where the budget reaches all pairs, else local search.
    let pairs = spanning_trees::layouts(target) * roots.len();
    let mut kept = BestLayouts { target, settings, best: Vec::new(), ties: vec![0; n], least: f64::INFINITY };
    let most = settings.prefilter.map_or(settings.budget, |prefilter| prefilter.budget.max(settings.budget));
    let complete = n <= enumerate::FACES_MAX && pairs.to_u64().is_some_and(|pairs| pairs <= most);
    if complete {
        let mut prefilter =
            settings.prefilter.and_then(|prefilter| Some((prefilter.scale, Peaks::new(target, weights)?)));
        let (mut visited, all) = (0u64, spanning_trees::layouts(target));
        let walked = enumerate::each(target, u64::MAX, |hinges| {
            visited += 1;
            observer.report(|| progress_text::counted(visited, &all, "layouts", None));
            if let Some((_, peaks)) = &mut prefilter {
                peaks.set_layout(hinges);
            }
            // The prefilter skips pairs that are worse than all that are kept.
            for &root in &roots {
                if let Some((scale, peaks)) = &prefilter
                    && kept.is_full_of_less_than(peaks.greatest(root) * scale)
                {
                    continue;
                }
                let layout = Layout::of_hinges(target, hinges, root).expect("only trees are enumerated");
                let value = value(&layout);
                kept.offer(layout, value);
            }
        });
        assert!(walked.is_ok(), "there are no more faces than may be");
    } else {
        improve(&mut kept, weights, &roots, value);
    }
    let BestLayouts { best, ties, least, .. } = kept;
    // A result for a root holds for those equal to it by symmetry.
    let asked = settings.roots.iter().copied();
    let roots = asked.clone().filter(|root| ties[equals[*root]] > 0).collect();
    let ties = asked.map(|root| ties[equals[root]]).sum();
    Measured { best, ties, roots, least, complete }
}

/// Improves greedy trees at the roots of least bound, the best tree first, by exchanges as long as they help
/// (local search).
fn improve(
    kept: &mut BestLayouts,
    weights: &Weights,
    roots: &[usize],
    value: &mut dyn FnMut(&Layout) -> [f64; 2],
) {
    let (target, mut left) = (kept.target, kept.settings.budget);
    let bounds = ShortestPaths::new(target, weights);
    let mut roots = roots.to_vec();
    roots.sort_by(|a, b| bounds.bound(*a).total_cmp(&bounds.bound(*b)).then(a.cmp(b)));
    let mut starts: Vec<(Layout, [f64; 2])> = Vec::new();
    for &root in roots.iter().take(STARTS) {
        let mut free = EXCHANGES;
        let grown =
            edge_exchange::improved(target, weights, edge_exchange::grown(target, weights, root), &mut free);
        let value = value(&grown);
        kept.offer(grown.clone(), value);
        starts.push((grown, value));
        left = left.saturating_sub(1);
    }
    starts.sort_by(|a, b| order(&a.1, &b.1));
    for (layout, best) in &starts {
        let (mut layout, mut best) = (layout.clone(), *best);
        while let Some((better, value)) = exchanged(target, &layout, best, &mut left, kept, value) {
            (layout, best) = (better, value);
        }
        if left == 0 {
            break;
        }
    }
    // At least one layout that lies flat is sought, whatever the budget.
    let first = starts.into_iter().next().filter(|_| kept.best.is_empty());
    if let Some(flat) = first.and_then(|(first, _)| tabu_unfolding::first_flat(target, weights, first, SEED))
    {
        let value = value(&flat);
        kept.offer(flat, value);
    }
}

/// Returns the layout of the first exchange that helps, with its value; `None` if none does or the budget ends.
fn exchanged(
    target: &Target,
    layout: &Layout,
    best: [f64; 2],
    left: &mut u64,
    kept: &mut BestLayouts,
    value: &mut dyn FnMut(&Layout) -> [f64; 2],
) -> Option<(Layout, [f64; 2])> {
    let folding = layout.hinges();
    for added in (0..target.hinges.len()).filter(|h| folding.binary_search(h).is_err()) {
        let [a, b] = target.hinges[added].faces;
        for dropped in edge_exchange::path(layout, a, b) {
            *left = left.checked_sub(1)?;
            // An energy, a torque or a number of steps.
            let least = kept.least;
            interrupt::progress_checkpoint(|| {
                format!("{left} layouts may still be measured, {} at best", number(least))
            });
            let other = layout.exchanged(target, dropped, added);
            let found = value(&other);
            kept.offer(other.clone(), found);
            if order(&found, &best).is_lt() {
                return Some((other, found));
            }
        }
    }
    None
}

/// The best layouts so far.
struct BestLayouts<'s> {
    target: &'s Target,
    settings: &'s Settings,
    best: Vec<(Layout, [f64; 2])>,
    /// The number of equally good layouts, by root.
    ties: Vec<u64>,
    least: f64,
}

impl BestLayouts<'_> {
    /// Returns true if a layout with this first value changes nothing: enough better ones are kept.
    fn is_full_of_less_than(&self, value: f64) -> bool {
        let last = self.best.last().filter(|_| self.best.len() >= self.settings.keep.max(1));
        last.is_some_and(|(_, last)| compare(value, last[0]).is_gt())
    }

    /// Keeps a layout if it is among the best and may overlap or lies flat, and counts it if it ties with the best.
    fn offer(&mut self, layout: Layout, value: [f64; 2]) {
        self.least = self.least.min(value[0]);
        let against = self.best.first().map_or(Ordering::Less, |best| compare(value[0], best.1[0]));
        let last = self.best.last().filter(|_| self.best.len() >= self.settings.keep.max(1));
        let is_kept = last.is_none_or(|last| order(&value, &last.1).is_le());
        if !is_kept && against.is_gt() {
            return;
        }
        if self.settings.flat && !Pattern::of(self.target, &layout).overlaps().is_empty() {
            return;
        }
        if against.is_lt() {
            self.ties.fill(0);
        }
        if against.is_le() {
            self.ties[layout.root] += 1;
        }
        if !is_kept {
            return;
        }
        let place = self.best.partition_point(|other| order(&other.1, &value).is_le());
        self.best.insert(place, (layout, value));
        self.best.truncate(self.settings.keep.max(1));
    }
}

/// Compares values; numbers within the tolerance are equal.
fn order(a: &[f64; 2], b: &[f64; 2]) -> Ordering {
    compare(a[0], b[0]).then(compare(a[1], b[1]))
}

fn compare(a: f64, b: f64) -> Ordering {
    if (a - b).abs() <= TOLERANCES.tie * a.abs().max(b.abs()) { Ordering::Equal } else { a.total_cmp(&b) }
}
