//! An order of folding of little energy for layouts of any height, by descent: one face after the other is put at
//! the best place among the faces on its paths, as long as that helps.
//!
//! Only the order of faces of which one is above the other has a meaning. When a face moves from one place to
//! another, the hinges that it passes on the way carry something else, and so does its own; all others do not.

use super::carried_moments::CarriedMoments;
use super::layout::Layout;
use super::steps;
use super::tolerances::TOLERANCES;

/// The greatest number of rounds over all faces.
const ROUNDS_MAX: usize = 12;

/// Returns (ranks, energy): the place of each face in an order of a layout, from the order `rank` on, and its energy,
/// N·m for steps of one second. `steps` counts down by the faces that hinges carry in what is evaluated; at 0 the
/// descent ends.
pub(super) fn improved(
    moments: &CarriedMoments,
    layout: &Layout,
    rank: Vec<usize>,
    steps: &mut u64,
) -> (Vec<usize>, f64) {
    let children = layout.children();
    let mut visited = 0;
    let means = layout.order.iter().map(|&face| (face, face != layout.root));
    let mut by_face = vec![0.0; rank.len()];
    for (face, folds) in means {
        if folds {
            by_face[face] = moments.mean(layout, &children, face, |b| rank[b] < rank[face], &mut visited);
        }
    }
    let gain = by_face.iter().sum::<f64>() * TOLERANCES.gain;
    let mut descent = Descent { moments, layout, children, rank, means: by_face, gain };
    *steps = steps.saturating_sub(visited);
    for _ in 0..ROUNDS_MAX {
        let mut improves = false;
        for &face in &layout.order[1..] {
            if *steps == 0 {
                break;
            }
            crate::interrupt::checkpoint();
            improves |= descent.moves(face, steps);
        }
        if !improves {
            break;
        }
    }
    let energy = descent.means.iter().sum();
    (descent.rank, energy)
}

/// Returns the place of each face in an order; that of the root, which is in none, comes last.
pub(super) fn ranks(order: &[usize], faces: usize) -> Vec<usize> {
    let mut rank = vec![usize::MAX; faces];
    order.iter().enumerate().for_each(|(place, &face)| rank[face] = place);
    rank
}

/// Returns the faces but the root in the order of their places, `rank` as [`ranks`] gives it.
pub(super) fn order(layout: &Layout, rank: &[usize]) -> Vec<usize> {
    let mut order: Vec<usize> = layout.order[1..].to_vec();
    order.sort_by_key(|face| rank[*face]);
    order
}

/// Returns the places of faces that fold with the leaves first.
pub(super) fn leaves_first(layout: &Layout) -> Vec<usize> {
    ranks(&steps::leaves_first(layout).concat(), layout.parent.len())
}

/// A face that goes to another place among the faces above and below it.
struct Move {
    /// The change of the energy, N·m for steps of one second.
    change: f64,
    /// The number of these faces that fold before it then.
    place: usize,
    /// The faces whose hinges carry something else, with their new mean torques, N·m for steps of one second.
    changed: Vec<(usize, f64)>,
}

struct Descent<'d> {
    moments: &'d CarriedMoments<'d>,
    layout: &'d Layout,
    children: Vec<Vec<usize>>,
    rank: Vec<usize>,
    /// The mean torque of each face's hinge.
    means: Vec<f64>,
    /// The least gain that counts.
    gain: f64,
}

impl Descent<'_> {
    /// Returns the faces above and below a face, in the order of their places.
    fn comparable(&self, face: usize) -> Vec<usize> {
        let mut found = Vec::new();
        let mut at = self.layout.parent[face];
        while at != self.layout.root {
            found.push(at);
            at = self.layout.parent[at];
        }
        let mut waiting = self.children[face].clone();
        while let Some(below) = waiting.pop() {
            found.push(below);
            waiting.extend(&self.children[below]);
        }
        found.sort_by_key(|other| self.rank[*other]);
        found
    }

    /// Puts a face at its best place; returns true if that is another one.
    fn moves(&mut self, face: usize, steps: &mut u64) -> bool {
        let others = self.comparable(face);
        let own = others.partition_point(|other| self.rank[*other] < self.rank[face]);
        let mut best: Option<Move> = None;
        for later in [true, false] {
            // The face passes one other after the other; `changed` are the hinges passed that carry something else.
            let mut changed: Vec<(usize, f64)> = Vec::new();
            let mut change = 0.0;
            let passed: Vec<usize> =
                if later { others[own..].to_vec() } else { others[..own].iter().rev().copied().collect() };
            let mut is_past = vec![false; self.rank.len()];
            for (count, &other) in passed.iter().enumerate() {
                let mut visited = 0;
                is_past[other] = true;
                if self.layout.is_above(other, face) {
                    let folded = |b: usize| if b == face { !later } else { self.rank[b] < self.rank[other] };
                    let mean = self.moments.mean(self.layout, &self.children, other, folded, &mut visited);
                    change += mean - self.means[other];
                    changed.push((other, mean));
                }
                let folded = |b: usize| (self.rank[b] < self.rank[face]) != is_past[b];
                let mean = self.moments.mean(self.layout, &self.children, face, folded, &mut visited);
                *steps = steps.saturating_sub(visited);
                let total = change + mean - self.means[face];
                if total < -self.gain && best.as_ref().is_none_or(|best| total < best.change) {
                    let mut changed = changed.clone();
                    changed.push((face, mean));
                    let place = if later { own + count + 1 } else { own - count - 1 };
                    best = Some(Move { change: total, place, changed });
                }
            }
        }
        let Some(Move { place, changed, .. }) = best else { return false };
        changed.into_iter().for_each(|(other, mean)| self.means[other] = mean);
        // The places of all faces are counted anew, with this one between two of the others.
        let mut all: Vec<usize> = order(self.layout, &self.rank);
        all.retain(|other| *other != face);
        let at = match place {
            0 => 0,
            _ => all.iter().position(|other| *other == others[place - 1]).expect("it folds") + 1,
        };
        all.insert(at, face);
        self.rank = ranks(&all, self.rank.len());
        true
    }
}
