//! Branch and bound for the least peak torque: with the leaves first, no gravity, and moving joints counted, every
//! hinge's torque grows with what it carries, so the hinges at the root carry the most.
//!
//! They carry all other faces among them. The partition of the faces is searched by branch and bound, with the
//! bound of a Lagrangian relaxation: faces in order of their distance from the root, each to one of the root's hinges.
//! For any shares `λ_r ≥ 0` that sum to 1 the greatest load is at least
//!
//! ```text
//! Σ_r λ_r load_r + Σ over faces not yet assigned of min over r of λ_r K(r, j)
//! ```
//!
//! and the shares are those that make this greatest at the beginning. A tree is grown in each part once every
//! face is assigned. If none of its hinges carries more than the root's, its peak is that of the division;
//! else the division is kept as a lower bound.

use super::layout::Layout;
use super::pattern::Pattern;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::Weights;
use crate::interrupt;

/// Rounds of the multiplicative-weights ascent over shares.
const ROUNDS: usize = 400;

/// The result of [`least`] for one root: the layout found and a lower bound.
pub(super) struct Least {
    /// The best layout found that lies flat, with its greatest mean torque, N·m for steps of one second; `None` if none
    /// better than the known one was found.
    pub layout: Option<(Layout, f64)>,
    /// The lower bound on the greatest mean torque of layouts with this root, N·m for steps of one second.
    pub bound: f64,
}

/// Searches for the layout with the root `root` (an index in [`Target::faces`]) whose greatest mean hinge torque is
/// least, among those below `known`, N·m for steps of one second. `steps` counts down the faces assigned to parents,
/// and at 0 the search ends.
pub(super) fn least(target: &Target, weights: &Weights, root: usize, known: f64, steps: &mut u64) -> Least {
    let around: Vec<(usize, usize)> = target.around(root).collect();
    let faces = by_distance(target, root);
    let share = shares(weights, &around, &faces);
    // For each face: the least sum that it and those after it add to the bound.
    let mut rest = vec![0.0; faces.len() + 1];
    for (at, face) in faces.iter().enumerate().rev() {
        rest[at] = rest[at + 1] + cheapest(weights, &around, &share, *face);
    }
    let mut deal = PartitionSearch {
        target,
        weights,
        root,
        around,
        share,
        faces,
        rest,
        assigned: Vec::new(),
        loads: Vec::new(),
        best: None,
        cutoff: known,
        ended: false,
    };
    deal.loads = vec![0.0; deal.around.len()];
    let relaxed = deal.rest[0];
    deal.next(steps);
    // The divisions passed over are no better than the cutoff; an end before all was seen leaves the first
    // bound.
    let bound = if deal.ended { relaxed.min(deal.cutoff) } else { deal.cutoff } * (1.0 - TOLERANCES.tie);
    Least { layout: deal.best, bound }
}

/// Returns the lower bound on the greatest mean torque of a hinge of layouts with the root `root` (an index in
/// [`Target::faces`]) that the Lagrangian relaxation gives without a search, N·m for steps of one second.
pub(super) fn relaxed(target: &Target, weights: &Weights, root: usize) -> f64 {
    let around: Vec<(usize, usize)> = target.around(root).collect();
    let faces = by_distance(target, root);
    if around.is_empty() {
        return 0.0;
    }
    let share = shares(weights, &around, &faces);
    faces.iter().map(|face| cheapest(weights, &around, &share, *face)).sum::<f64>() * (1.0 - TOLERANCES.tie)
}

/// Returns the least contribution of a face to the bound, over all hinges of the root, N·m for steps of one second.
fn cheapest(weights: &Weights, around: &[(usize, usize)], share: &[f64], face: usize) -> f64 {
    let of = |((hinge, _), share): (&(usize, usize), &f64)| share * weights.at(*hinge, face);
    around.iter().zip(share).map(of).fold(f64::INFINITY, f64::min)
}

/// Returns the other faces, the nearest to the root first.
fn by_distance(target: &Target, root: usize) -> Vec<usize> {
    let mut order = vec![root];
    let mut seen = vec![false; target.faces.len()];
    seen[root] = true;
    let mut next = 0;
    while let Some(&face) = order.get(next) {
        next += 1;
        for (_, other) in target.around(face) {
            if !std::mem::replace(&mut seen[other], true) {
                order.push(other);
            }
        }
    }
    order.split_off(1)
}

/// Returns shares of the root's hinges for which the bound is great, by multiplicative weights: shares grow with
/// the load that a hinge has where every face goes to the cheapest.
fn shares(weights: &Weights, around: &[(usize, usize)], faces: &[usize]) -> Vec<f64> {
    let count = around.len();
    let mut share = vec![1.0 / count as f64; count];
    let (mut best, mut kept) = (0.0, share.clone());
    for round in 1..=ROUNDS {
        let mut loads = vec![0.0; count];
        let mut bound = 0.0;
        for &face in faces {
            let of = |r: usize| share[r] * weights.at(around[r].0, face);
            let r = (0..count).min_by(|a, b| of(*a).total_cmp(&of(*b))).expect("a root has hinges");
            loads[r] += weights.at(around[r].0, face);
            bound += of(r);
        }
        if bound > best {
            (best, kept) = (bound, share.clone());
        }
        let whole: f64 = loads.iter().sum();
        if whole <= 0.0 {
            break;
        }
        let length = 1.0 / round as f64;
        share
            .iter_mut()
            .zip(&loads)
            .for_each(|(s, load)| *s *= libm::exp(length * (load / whole - 1.0 / count as f64)));
        let sum: f64 = share.iter().sum();
        share.iter_mut().for_each(|s| *s /= sum);
    }
    kept
}

/// The state of the search over partitions of the faces among the root's hinges.
struct PartitionSearch<'t> {
    target: &'t Target,
    weights: &'t Weights,
    root: usize,
    /// The root's hinges, with the faces across them.
    around: Vec<(usize, usize)>,
    share: Vec<f64>,
    faces: Vec<usize>,
    rest: Vec<f64>,
    /// The root's hinge to which each face is assigned, in their order.
    assigned: Vec<usize>,
    loads: Vec<f64>,
    best: Option<(Layout, f64)>,
    /// The least peak of the partitions met, also of those whose layouts do not lie flat, N·m for steps of one second.
    cutoff: f64,
    ended: bool,
}

impl PartitionSearch<'_> {
    /// Assigns the next face to each of the root's hinges; as deep as there are faces.
    fn next(&mut self, steps: &mut u64) {
        interrupt::checkpoint();
        let at = self.assigned.len();
        let Some(&face) = self.faces.get(at) else { return self.settle() };
        let own = self.around.iter().position(|(_, other)| *other == face);
        for r in 0..self.around.len() {
            // Its own hinge may still lead to a face beside the root from elsewhere.
            if own.is_some_and(|own| own != r) && !self.is_reached(at, face, r) {
                continue;
            }
            let Some(left) = steps.checked_sub(1) else {
                self.ended = true;
                return;
            };
            *steps = left;
            let load = self.loads[r];
            self.loads[r] += self.weights.at(self.around[r].0, face);
            let assigned: f64 = self.loads.iter().zip(&self.share).map(|(load, share)| load * share).sum();
            let limit = self.cutoff * (1.0 - TOLERANCES.tie);
            if self.loads[r] < limit && assigned + self.rest[at + 1] < limit {
                self.assigned.push(r);
                self.next(steps);
                self.assigned.pop();
            }
            self.loads[r] = load;
            if self.ended {
                return;
            }
        }
    }

    /// Returns true if a neighbour of a face goes to a hinge, or may still go.
    fn is_reached(&self, at: usize, face: usize, r: usize) -> bool {
        self.target.around(face).any(|(_, other)| {
            other != self.root
                && self.faces[..at].iter().position(|f| *f == other).is_none_or(|i| self.assigned[i] == r)
        })
    }

    /// Builds a tree in each part, if it is connected.
    fn settle(&mut self) {
        let greatest = self.loads.iter().copied().fold(0.0, f64::max);
        let mut part = vec![usize::MAX; self.target.faces.len()];
        for (face, r) in self.faces.iter().zip(&self.assigned) {
            part[*face] = *r;
        }
        let Some(layout) = self.grown(&part) else { return };
        self.cutoff = self.cutoff.min(greatest);
        let peak = carried(&layout, self.weights).into_iter().fold(0.0, f64::max);
        let is_better = self.best.as_ref().is_none_or(|(_, best)| peak < *best);
        if is_better && Pattern::of(self.target, &layout).overlaps().is_empty() {
            self.best = Some((layout, peak));
        }
    }

    /// Returns a greedy tree in each part, from the root's hinges on; `None` where a part is not in
    /// one piece with its hinge.
    fn grown(&self, part: &[usize]) -> Option<Layout> {
        let n = part.len();
        let mut paths: Vec<Option<Vec<usize>>> = vec![None; n];
        paths[self.root] = Some(Vec::new());
        for _ in 1..n {
            let mut best: Option<(f64, usize, usize, usize)> = None;
            for (a, path) in paths.iter().enumerate() {
                let Some(path) = path else { continue };
                for (hinge, b) in self.target.around(a) {
                    let leads = if a == self.root {
                        self.around.get(part[b]).is_some_and(|(own, _)| *own == hinge)
                    } else {
                        part[a] == part[b]
                    };
                    if paths[b].is_some() || !leads {
                        continue;
                    }
                    let cost = path.iter().chain([&hinge]).map(|h| self.weights.at(*h, b)).sum();
                    if best.is_none_or(|(least, ..)| cost < least) {
                        best = Some((cost, a, b, hinge));
                    }
                }
            }
            let (_, a, b, hinge) = best?;
            let mut path = paths[a].clone().expect("it belongs to the tree");
            path.push(hinge);
            paths[b] = Some(path);
        }
        let hinges: Vec<usize> = paths.iter().flatten().filter_map(|path| path.last().copied()).collect();
        Layout::of_hinges(self.target, &hinges, self.root)
    }
}

/// Returns the mean torque of the hinge of every face with the leaves first, by face, N·m for steps of one second; 0
/// for the root.
pub(super) fn carried(layout: &Layout, weights: &Weights) -> Vec<f64> {
    let mut sums = vec![0.0; layout.parent.len()];
    for &face in &layout.order {
        let mut at = face;
        while let Some(hinge) = layout.hinge[at] {
            sums[at] += weights.at(hinge, face);
            at = layout.parent[at];
        }
    }
    sums
}
