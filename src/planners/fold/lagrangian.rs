//! A stronger bound than that of [`routes`](super::shortest_paths): paths pay for entering a face otherwise
//! than the others do.
//!
//! Let y_a say whether a layout enters a face across arc a, and x_a^j whether the path to face j uses
//! it. A layout is a choice of one arc into each face with x_a^j ≤ y_a. These inequalities are given up
//! for prices λ_a^j ≥ 0: whoever uses an arc pays, and a face that chooses an arc is paid what its
//! users pay. For every set of prices
//!
//! ```text
//! L(λ) = Σ_v min over arcs a into v of ( cost of v's cheapest path that ends with a, prices included
//!                                         - Σ_j λ_a^j )
//! ```
//!
//! is a bound: at a layout, payments cancel. (Face v's own last arc needs no price: it is its choice.)
//! Multipliers are raised where a path uses an arc that was not chosen and lowered where a chosen arc is
//! not used: a subgradient of L, with Polyak's step. The greatest L is the bound of the linear
//! programme of flows.

use super::shortest_paths::{self, Allowed, Arc, Waiting};
use super::target::Target;
use super::weights::Weights;
use std::collections::BinaryHeap;

/// Rounds without progress after which steps get shorter.
const PATIENCE: usize = 30;

/// How much shorter, and from where on it is not worth going on.
const SHORTER: f64 = 0.7;
const STEP_MIN: f64 = 1e-3;

/// Progress by less than this part of the gap is none.
const PROGRESS: f64 = 1e-4;

/// An arc is given up when it would cost this much more than what is asked for, as a part of it: what
/// rounding may add up to.
const TOL_GIVEN_UP: f64 = 1e-11;

/// So many sums over the table of prices take about as long as settling a face on a path.
const SUMS: usize = 64;

/// Multipliers that are not zero: place in the table and price.
pub type Multipliers = [(u32, f64)];

/// The bound of one node of a search, and what was learnt.
pub struct Ascent {
    /// No layout over the arcs allowed costs less; infinite where there is none.
    pub bound: f64,
    /// The prices of that bound.
    pub prices: Vec<(u32, f64)>,
    /// How often paths entered each face across each of its sides, in the last round.
    pub uses: Vec<[u32; 3]>,
    /// Of the last step, as a part of the gap.
    pub length: f64,
}

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// A bound of at least this is enough, and arcs that only dearer layouts use are given up.
    pub cutoff: f64,
    /// About what the best layout costs.
    pub aim: f64,
    pub rounds: usize,
    /// Of the first step, as a part of the gap.
    pub length: f64,
}

/// Room for computing bounds of one target under its weights.
pub struct Lagrangian<'t> {
    target: &'t Target,
    faces: usize,
    arcs: usize,
    /// By face: the faces around it and the arcs that lead there.
    out: Vec<Vec<(usize, usize)>>,
    /// By arc: the face from which it comes.
    tail: Vec<usize>,
    /// By face, then by arc: cost, and price.
    costs: Vec<f64>,
    prices: Vec<f64>,
    /// By face: cost of its cheapest path across each of its sides, prices included.
    reached: Vec<[f64; 3]>,
    /// By goal, then by face: the arc by which the goal's path enters.
    entered: Vec<Arc>,
    distance: Vec<f64>,
    queue: BinaryHeap<Waiting>,
    /// By face: the arc that was chosen.
    chosen: Vec<usize>,
}

impl<'t> Lagrangian<'t> {
    pub fn new(target: &'t Target, weights: &Weights) -> Lagrangian<'t> {
        let faces = target.faces.len();
        let arcs = 3 * faces;
        let mut out = vec![Vec::new(); faces];
        let mut tail = vec![usize::MAX; arcs];
        let mut costs = vec![f64::INFINITY; faces * arcs];
        for (index, hinge) in target.hinges.iter().enumerate() {
            for end in 0..2 {
                let (into, from) = (hinge.faces[end], hinge.faces[1 - end]);
                let arc = shortest_paths::arc(into, hinge.sides[end]) as usize;
                out[from].push((into, arc));
                tail[arc] = from;
                for face in 0..faces {
                    costs[face * arcs + arc] = weights.at(index, face);
                }
            }
        }
        Lagrangian {
            target,
            faces,
            arcs,
            out,
            tail,
            costs,
            prices: vec![0.0; faces * arcs],
            reached: vec![[f64::INFINITY; 3]; faces],
            entered: vec![Arc::MAX; faces * faces],
            distance: vec![0.0; faces],
            queue: BinaryHeap::new(),
            chosen: vec![usize::MAX; faces],
        }
    }

    /// Raises the bound of the layouts with this root over the arcs allowed, beginning with given
    /// prices. Arcs that no layout below the cutoff uses are taken from `allowed`. `steps` counts down the
    /// faces settled on the way, and sums over prices; at zero the ascent ends. `layouts` is handed the arcs chosen into
    /// each face, now and then, which may nearly be a layout.
    pub fn ascend(
        &mut self,
        root: usize,
        allowed: &mut Allowed,
        prices: &Multipliers,
        effort: Effort,
        steps: &mut u64,
        mut layouts: impl FnMut(&[usize], &mut u64) -> f64,
    ) -> Ascent {
        self.prices.fill(0.0);
        prices.iter().for_each(|&(at, price)| self.prices[at as usize] = price);
        let Effort { mut cutoff, mut aim, rounds, mut length } = effort;
        let mut best = f64::NEG_INFINITY;
        let mut best_prices: Vec<(u32, f64)> = prices.to_vec();
        let mut stale = 0;
        let mut moved = vec![true; self.faces];
        for round in 0..rounds {
            crate::interrupt::checkpoint();
            for goal in (0..self.faces).filter(|goal| *goal != root) {
                if std::mem::replace(&mut moved[goal], false) {
                    self.reach(root, goal, allowed, steps);
                }
            }
            let paid = self.paid();
            *steps = steps.saturating_sub((self.prices.len() / SUMS) as u64);
            let Some(bound) = self.choose(root, allowed, &paid) else {
                best = f64::INFINITY;
                break;
            };
            stale = if bound > best + PROGRESS * (aim - best).abs() { 0 } else { stale + 1 };
            if bound > best {
                best = bound;
                best_prices.clear();
                best_prices.extend(self.prices_now());
            }
            if round % LAYOUTS_EVERY == LAYOUTS_EVERY - 1 || round == 0 {
                let found = layouts(&self.chosen, steps);
                (cutoff, aim) = (cutoff.min(found), aim.min(found));
            }
            if best >= cutoff || *steps == 0 {
                break;
            }
            if self.give_up(root, allowed, &paid, bound, cutoff) {
                moved.fill(true);
            }
            if stale > PATIENCE {
                (length, stale) = (length * SHORTER, 0);
            }
            if length < STEP_MIN || !self.step(root, length * (aim - bound).abs(), &mut moved) {
                break;
            }
        }
        let uses = self.uses(root);
        Ascent { bound: best, prices: best_prices, uses, length }
    }

    fn prices_now(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let paid = self.prices.iter().enumerate().filter(|(_, price)| **price > 0.0);
        paid.map(|(at, price)| (u32::try_from(at).expect("targets have few faces"), *price))
    }

    /// The cheapest paths from the root to the sides of a face.
    fn reach(&mut self, root: usize, goal: usize, allowed: &[u8], steps: &mut u64) {
        let costs = &self.costs[goal * self.arcs..][..self.arcs];
        let prices = &self.prices[goal * self.arcs..][..self.arcs];
        let entered = &mut self.entered[goal * self.faces..][..self.faces];
        let mut found = [f64::INFINITY; 3];
        let mut sides_left = allowed[goal].count_ones();
        self.distance.fill(f64::INFINITY);
        self.distance[root] = 0.0;
        self.queue.clear();
        self.queue.push(Waiting { cost: 0.0, face: root });
        while let Some(Waiting { cost, face }) = self.queue.pop() {
            if cost > self.distance[face] {
                continue;
            }
            *steps = steps.saturating_sub(1);
            for &(other, arc) in &self.out[face] {
                if allowed[other] & (1 << (arc % 3)) == 0 {
                    continue;
                }
                if other == goal {
                    found[arc % 3] = cost + costs[arc];
                    sides_left -= 1;
                    continue;
                }
                let further = cost + costs[arc] + prices[arc];
                if further < self.distance[other] {
                    self.distance[other] = further;
                    entered[other] = arc as Arc;
                    self.queue.push(Waiting { cost: further, face: other });
                }
            }
            if sides_left == 0 {
                break;
            }
        }
        self.reached[goal] = found;
    }

    /// By arc: what its users pay.
    fn paid(&self) -> Vec<f64> {
        let mut paid = vec![0.0; self.arcs];
        for row in self.prices.chunks_exact(self.arcs) {
            paid.iter_mut().zip(row).for_each(|(sum, price)| *sum += price);
        }
        paid
    }

    /// What entering a face across an arc costs in all.
    fn value(&self, arc: usize, paid: &[f64]) -> f64 {
        self.reached[arc / 3][arc % 3] - paid[arc]
    }

    /// Every face chooses; the bound, or `None` where a face can't be entered.
    fn choose(&mut self, root: usize, allowed: &[u8], paid: &[f64]) -> Option<f64> {
        let mut sum = 0.0;
        for face in (0..self.faces).filter(|face| *face != root) {
            let arcs = (0..3).filter(|side| allowed[face] & (1 << side) != 0).map(|side| 3 * face + side);
            let chosen = arcs.min_by(|a, b| self.value(*a, paid).total_cmp(&self.value(*b, paid)))?;
            self.chosen[face] = chosen;
            sum += self.value(chosen, paid);
        }
        sum.is_finite().then_some(sum)
    }

    /// Takes away arcs that only layouts at or above the cutoff use, and the way back across an arc
    /// that is the only one left into a face. Whether there were any.
    fn give_up(&self, root: usize, allowed: &mut Allowed, paid: &[f64], bound: f64, cutoff: f64) -> bool {
        let limit = cutoff * (1.0 + TOL_GIVEN_UP);
        let mut any = false;
        for face in (0..self.faces).filter(|face| *face != root) {
            let least = self.value(self.chosen[face], paid);
            for side in (0..3).filter(|side| allowed[face] & (1 << side) != 0).collect::<Vec<_>>() {
                if bound - least + self.value(3 * face + side, paid) > limit {
                    allowed[face] &= !(1 << side);
                    any = true;
                }
            }
            if allowed[face].count_ones() == 1 {
                let only = shortest_paths::arc(face, allowed[face].trailing_zeros() as usize);
                let (from, side) = shortest_paths::head(shortest_paths::reversed(self.target, only));
                if from != root && allowed[from] & (1 << side) != 0 {
                    allowed[from] &= !(1 << side);
                    any = true;
                }
            }
        }
        any
    }

    /// Hands the arcs of a goal's path to `visit`, without its last.
    fn along(&self, root: usize, goal: usize, mut visit: impl FnMut(usize)) {
        let mut at = self.tail[self.chosen[goal]];
        while at != root {
            let arc = self.entered[goal * self.faces + at] as usize;
            visit(arc);
            at = self.tail[arc];
        }
    }

    /// A step along the subgradient by which the bound would rise by `rise` if it were linear. Notes
    /// whose prices changed; `false` where the subgradient is zero.
    fn step(&mut self, root: usize, rise: f64, moved: &mut [bool]) -> bool {
        let (mut up, mut down) = (Vec::new(), Vec::new());
        let mut used = vec![usize::MAX; self.arcs];
        for goal in (0..self.faces).filter(|goal| *goal != root) {
            let row = goal * self.arcs;
            self.along(root, goal, |arc| {
                used[arc] = goal;
                if self.chosen[arc / 3] != arc {
                    up.push((goal, row + arc));
                }
            });
            for face in (0..self.faces).filter(|face| *face != root && *face != goal) {
                let arc = self.chosen[face];
                if used[arc] != goal && self.prices[row + arc] > 0.0 {
                    down.push((goal, row + arc));
                }
            }
        }
        let count = up.len() + down.len();
        let by = rise / count as f64;
        for &(goal, at) in &up {
            self.prices[at] += by;
            moved[goal] = true;
        }
        for &(goal, at) in &down {
            self.prices[at] = (self.prices[at] - by).max(0.0);
            moved[goal] = true;
        }
        count > 0 && by > 0.0
    }

    fn uses(&self, root: usize) -> Vec<[u32; 3]> {
        let mut uses = vec![[0; 3]; self.faces];
        if self.chosen.iter().enumerate().any(|(face, arc)| face != root && *arc == usize::MAX) {
            return uses;
        }
        for goal in (0..self.faces).filter(|goal| *goal != root) {
            let last = self.chosen[goal];
            uses[goal][last % 3] += 1;
            self.along(root, goal, |arc| uses[arc / 3][arc % 3] += 1);
        }
        uses
    }
}

/// Rounds between two layouts that are tried.
const LAYOUTS_EVERY: usize = 20;

/// A layout from one arc into each face: what hangs together with the root stays as it is, what runs
/// in circles is joined to it across the first hinge that does.
pub fn mended(target: &Target, root: usize, chosen: &[usize]) -> Vec<usize> {
    let n = target.faces.len();
    let hinge_of = |arc: usize| target.sides[arc / 3][arc % 3].expect("arcs lead across hinges");
    let mut followers: Vec<Vec<usize>> = vec![Vec::new(); n];
    for face in (0..n).filter(|face| *face != root) {
        followers[target.hinges[hinge_of(chosen[face])].other(face)].push(face);
    }
    let mut joined = vec![false; n];
    let mut hinges = Vec::with_capacity(n - 1);
    let join = |from: usize, joined: &mut Vec<bool>, hinges: &mut Vec<usize>| {
        joined[from] = true;
        let mut waiting = vec![from];
        while let Some(face) = waiting.pop() {
            for &next in &followers[face] {
                if !std::mem::replace(&mut joined[next], true) {
                    hinges.push(hinge_of(chosen[next]));
                    waiting.push(next);
                }
            }
        }
    };
    join(root, &mut joined, &mut hinges);
    while hinges.len() + 1 < n {
        let bridge = |hinge: &super::target::Hinge| joined[hinge.faces[0]] != joined[hinge.faces[1]];
        let index = target.hinges.iter().position(bridge).expect("the target is connected");
        let [a, b] = target.hinges[index].faces;
        hinges.push(index);
        join(if joined[a] { b } else { a }, &mut joined, &mut hinges);
    }
    hinges
}
