//! Lagrangian relaxation of the choice of one tree for all faces: a stronger lower bound than that of
//! [`shortest_paths`], raised by subgradient ascent (Held and Karp 1971; Fisher 1981, *The Lagrangian relaxation method
//! for solving integer programming problems*).
//!
//! Let y_a be 1 if a layout enters a face across arc a, and x_a^j be 1 if the path to face j uses it. A
//! layout is a choice of one arc into each face with x_a^j ≤ y_a. These inequalities are dualised with
//! multipliers λ_a^j ≥ 0: a path that uses an arc pays its multiplier, and the face that chooses the arc is
//! paid the multipliers of all its users. For all multipliers
//!
//! ```text
//! L(λ) = Σ_v min over arcs a into v of ( cost of v's cheapest path that ends with a, multipliers included
//!                                         - Σ_j λ_a^j )
//! ```
//!
//! is a lower bound, since payments cancel at a layout. (Face v's own last arc needs no multiplier: it is its
//! choice.) A subgradient of L is 1 where a path uses an arc that was not chosen and -1 where a chosen arc is
//! not used; steps have Polyak's length (Polyak 1969, *Minimization of unsmooth
//! functionals*). The greatest L is the bound of the linear program of multicommodity
//! flows.

use super::frontier::Frontier;
use super::shortest_paths::{self, Allowed, bits};
use super::target::{Arc, Target};
use super::tolerances::TOLERANCES;
use super::weights::Weights;

/// The number of rounds without progress after which steps are shortened.
const STALLED_ROUNDS_MAX: usize = 30;

/// The factor by which steps are shortened.
const SHORTER: f64 = 0.7;

/// The number of sums over the table of multipliers that take about as long as settling a face on a path.
const SUMS: usize = 64;

/// The multipliers λ that are not zero, each with its index in the table by goal face j and [`Arc`] a,
/// `arcs * j + a`; N·m for steps of one second.
pub type Multipliers = [(u32, f64)];

/// The result of a subgradient ascent ([`Lagrangian::ascend`]).
pub struct Ascent {
    /// The lower bound on the energy of all layouts over the arcs allowed, N·m for steps of one second; infinite if
    /// there is no such layout.
    pub bound: f64,
    /// The multipliers of that bound, as [`Multipliers`]; those given if no layout is left.
    pub multipliers: Vec<(u32, f64)>,
    /// The number of paths of the last round that use each arc; all 0 if no layout is left.
    pub uses: Vec<u32>,
    /// The length of the last step, without unit: the factor of Polyak's step, which is made of the gap between bound
    /// and estimated optimum.
    pub length: f64,
}

/// The limits of a subgradient ascent ([`Lagrangian::ascend`]).
#[derive(Clone, Copy, Debug)]
pub struct AscentLimits {
    /// The bound at which the ascent ends, N·m for steps of one second; arcs that only costlier layouts use are
    /// removed.
    pub cutoff: f64,
    /// An estimate of the optimum for Polyak's step, N·m for steps of one second.
    pub optimum_estimate: f64,
    /// The greatest number of rounds of the ascent; with 0 the bound is minus infinity.
    pub rounds: usize,
    /// The length of the first step, without unit: the factor of Polyak's step, which is made of the gap between bound
    /// and estimated optimum.
    pub length: f64,
}

/// An arc out of a face: where it leads.
#[derive(Clone, Copy, Debug, Default)]
struct Exit {
    /// The face that it enters.
    into: u32,
    arc: Arc,
    /// The bit of its side in [`Allowed`]; 0 of a side without a hinge, which is never allowed.
    bit: u32,
}

/// The Lagrangian relaxation of one target under its weights, with its working memory.
pub struct Lagrangian<'t> {
    target: &'t Target,
    faces: usize,
    arcs: usize,
    /// The arcs that leave the faces, face after face, as many places for each as it has sides.
    out: Vec<Exit>,
    /// The face from which each arc comes.
    tail: Vec<usize>,
    /// The cost with the multiplier, by face, then by arc.
    costs: Vec<f64>,
    multipliers: Vec<f64>,
    /// The cost of the cheapest path by each arc to the face that it enters, multipliers included.
    reached: Vec<f64>,
    /// The arc by which a goal's path enters a face, by goal, then by face.
    entered: Vec<Arc>,
    distance: Vec<f64>,
    queue: Frontier,
    /// The arc into each face that was chosen.
    chosen: Vec<usize>,
}

impl<'t> Lagrangian<'t> {
    /// Returns the relaxation of a target under its weights, with all multipliers zero.
    pub fn new(target: &'t Target, weights: &Weights) -> Lagrangian<'t> {
        let faces = target.faces.len();
        let arcs = target.arc_count();
        let mut out = vec![Exit::default(); arcs];
        let mut tail = vec![usize::MAX; arcs];
        let mut costs = vec![f64::INFINITY; faces * arcs];
        for (index, hinge) in target.hinges.iter().enumerate() {
            for end in 0..2 {
                let (into, from) = (hinge.faces[end], hinge.faces[1 - end]);
                let arc = target.arc(into, hinge.sides[end]);
                let free = out[target.arcs(from)].iter_mut().find(|exit: &&mut Exit| exit.bit == 0);
                *free.expect("a face has a place for each side") =
                    Exit { into: into as u32, arc, bit: 1 << hinge.sides[end] };
                let arc = arc as usize;
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
            multipliers: vec![0.0; faces * arcs],
            reached: vec![f64::INFINITY; arcs],
            entered: vec![Arc::MAX; faces * faces],
            distance: vec![0.0; faces],
            queue: Frontier::default(),
            chosen: vec![usize::MAX; faces],
        }
    }

    /// Raises the lower bound on the layouts with this root (an index in [`Target::faces`]) over the arcs allowed by
    /// subgradient ascent from given multipliers (Held and Karp 1971), with Polyak's steps. Arcs that no layout below
    /// the cutoff uses are removed from `allowed` (fixing by reduced costs). `steps` counts down the faces settled on
    /// paths and the sums over multipliers; at zero the ascent ends. `limits`: the limits at which the ascent ends.
    ///
    /// In the first round and in every `LAYOUTS_EVERY`-th one `layouts` is called with the arc chosen
    /// into each face, by face, and with `steps`. These arcs are nearly a layout; the entry of the root has no
    /// meaning. If it returns an energy below the cutoff, that is the cutoff from then on.
    pub fn ascend(
        &mut self,
        root: usize,
        allowed: &mut Allowed,
        multipliers: &Multipliers,
        limits: AscentLimits,
        steps: &mut u64,
        mut layouts: impl FnMut(&[usize], &mut u64) -> f64,
    ) -> Ascent {
        self.multipliers.fill(0.0);
        multipliers.iter().for_each(|&(at, multiplier)| self.multipliers[at as usize] = multiplier);
        let AscentLimits { mut cutoff, mut optimum_estimate, rounds, mut length } = limits;
        let mut best = f64::NEG_INFINITY;
        let mut best_multipliers: Vec<(u32, f64)> = multipliers.to_vec();
        let mut stale = 0;
        let mut moved = vec![true; self.faces];
        for round in 0..rounds {
            crate::interrupt::checkpoint();
            // Shortest paths to the faces whose multipliers changed.
            for goal in (0..self.faces).filter(|goal| *goal != root) {
                if std::mem::replace(&mut moved[goal], false) {
                    self.reach(root, goal, allowed, steps);
                }
            }
            // The bound: each face chooses the arc into it.
            let paid = self.paid();
            *steps = steps.saturating_sub((self.multipliers.len() / SUMS) as u64);
            let Some(bound) = self.choose(root, allowed, &paid) else {
                best = f64::INFINITY;
                break;
            };
            stale = if bound > best + TOLERANCES.ascent_progress * (optimum_estimate - best).abs() {
                0
            } else {
                stale + 1
            };
            if bound > best {
                best = bound;
                best_multipliers.clear();
                best_multipliers.extend(self.nonzero());
            }
            // Lagrangian heuristic: a layout near the choices.
            if round % LAYOUTS_EVERY == LAYOUTS_EVERY - 1 || round == 0 {
                let found = layouts(&self.chosen, steps);
                (cutoff, optimum_estimate) = (cutoff.min(found), optimum_estimate.min(found));
            }
            if best >= cutoff || *steps == 0 {
                break;
            }
            // Fixing by reduced costs, then a step along the subgradient.
            if self.remove_arcs(root, allowed, &paid, bound, cutoff) {
                moved.fill(true);
            }
            if stale > STALLED_ROUNDS_MAX {
                (length, stale) = (length * SHORTER, 0);
            }
            if length < TOLERANCES.ascent_step
                || !self.step(root, length * (optimum_estimate - bound).abs(), &mut moved)
            {
                break;
            }
        }
        let uses = self.uses(root);
        Ascent { bound: best, multipliers: best_multipliers, uses, length }
    }

    /// Returns the multipliers that are not zero.
    fn nonzero(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let paid = self.multipliers.iter().enumerate().filter(|(_, multiplier)| **multiplier > 0.0);
        paid.map(|(at, multiplier)| (u32::try_from(at).expect("targets have few faces"), *multiplier))
    }

    /// Computes the paths from the root to the sides of a face by Dijkstra's algorithm, multipliers included.
    fn reach(&mut self, root: usize, goal: usize, allowed: &[u32], steps: &mut u64) {
        let costs = &self.costs[goal * self.arcs..][..self.arcs];
        let multipliers = &self.multipliers[goal * self.arcs..][..self.arcs];
        let entered = &mut self.entered[goal * self.faces..][..self.faces];
        let distance = &mut self.distance[..self.faces];
        self.reached[self.target.arcs(goal)].fill(f64::INFINITY);
        let mut sides_left = allowed[goal].count_ones();
        let mut settled = 0;
        distance.fill(f64::INFINITY);
        distance[root] = 0.0;
        self.queue.begin(root);
        while let Some((cost, face)) = self.queue.pop() {
            if cost > distance[face] {
                continue;
            }
            settled += 1;
            for &Exit { into, arc, bit } in &self.out[self.target.arcs(face)] {
                let (into, arc) = (into as usize, arc as usize);
                if allowed[into] & bit == 0 {
                    continue;
                }
                if into == goal {
                    self.reached[arc] = cost + costs[arc];
                    sides_left -= 1;
                    continue;
                }
                let further = cost + costs[arc] + multipliers[arc];
                if further < distance[into] {
                    distance[into] = further;
                    entered[into] = arc as Arc;
                    self.queue.push(further, into);
                }
            }
            if sides_left == 0 {
                break;
            }
        }
        *steps = steps.saturating_sub(settled);
    }

    /// Returns the sum of its users' multipliers by arc.
    fn paid(&self) -> Vec<f64> {
        let mut paid = vec![0.0; self.arcs];
        for row in self.multipliers.chunks_exact(self.arcs) {
            paid.iter_mut().zip(row).for_each(|(sum, multiplier)| *sum += multiplier);
        }
        paid
    }

    /// Returns the reduced cost of entering a face across an arc.
    #[inline]
    fn value(&self, arc: usize, paid: &[f64]) -> f64 {
        self.reached[arc] - paid[arc]
    }

    /// Lets every face choose the arc of least reduced cost. Returns the bound, or `None` where a face can't be
    /// entered.
    fn choose(&mut self, root: usize, allowed: &[u32], paid: &[f64]) -> Option<f64> {
        let mut sum = 0.0;
        for face in (0..self.faces).filter(|face| *face != root) {
            let first = self.target.arcs(face).start;
            let arcs = bits(allowed[face]).map(|side| first + side);
            let chosen = arcs.min_by(|a, b| self.value(*a, paid).total_cmp(&self.value(*b, paid)))?;
            self.chosen[face] = chosen;
            sum += self.value(chosen, paid);
        }
        sum.is_finite().then_some(sum)
    }

    /// Removes arcs that only layouts at or above the cutoff use (fixing by reduced costs), and the arc back
    /// across one that is the only one left into a face. Returns true if there were any.
    fn remove_arcs(&self, root: usize, allowed: &mut Allowed, paid: &[f64], bound: f64, cutoff: f64) -> bool {
        let limit = cutoff * (1.0 + TOLERANCES.fixing);
        let mut any = false;
        for face in (0..self.faces).filter(|face| *face != root) {
            let least = self.value(self.chosen[face], paid);
            let first = self.target.arcs(face).start;
            for side in bits(allowed[face]) {
                if bound - least + self.value(first + side, paid) > limit {
                    allowed[face] &= !(1 << side);
                    any = true;
                }
            }
            if allowed[face].count_ones() == 1 {
                let only = self.target.arc(face, allowed[face].trailing_zeros() as usize);
                let (from, side) = self.target.head(shortest_paths::reversed(self.target, only));
                if from != root && allowed[from] & (1 << side) != 0 {
                    allowed[from] &= !(1 << side);
                    any = true;
                }
            }
        }
        any
    }

    /// Visits the arcs of a goal's path but its last.
    #[inline]
    fn along(&self, root: usize, goal: usize, mut visit: impl FnMut(usize)) {
        let mut at = self.tail[self.chosen[goal]];
        while at != root {
            let arc = self.entered[goal * self.faces + at] as usize;
            visit(arc);
            at = self.tail[arc];
        }
    }

    /// Takes a step along the subgradient by which the bound would rise by `rise` if it were linear. Marks the
    /// faces whose multipliers changed; returns false where the subgradient is zero.
    fn step(&mut self, root: usize, rise: f64, moved: &mut [bool]) -> bool {
        let (mut up, mut down) = (Vec::new(), Vec::new());
        let mut used = vec![usize::MAX; self.arcs];
        for goal in (0..self.faces).filter(|goal| *goal != root) {
            let row = goal * self.arcs;
            self.along(root, goal, |arc| {
                used[arc] = goal;
                if self.chosen[self.target.entered(arc as Arc)] != arc {
                    up.push((goal, row + arc));
                }
            });
            let multipliers = &self.multipliers[row..][..self.arcs];
            for (face, &arc) in self.chosen.iter().enumerate() {
                // Few multipliers are not zero.
                if face != root && multipliers[arc] > 0.0 && face != goal && used[arc] != goal {
                    down.push((goal, row + arc));
                }
            }
        }
        let count = up.len() + down.len();
        let by = rise / count as f64;
        for &(goal, at) in &up {
            self.multipliers[at] += by;
            moved[goal] = true;
        }
        for &(goal, at) in &down {
            self.multipliers[at] = (self.multipliers[at] - by).max(0.0);
            moved[goal] = true;
        }
        count > 0 && by > 0.0
    }

    /// Returns the number of paths that use each arc.
    fn uses(&self, root: usize) -> Vec<u32> {
        let mut uses = vec![0; self.arcs];
        if self.chosen.iter().enumerate().any(|(face, arc)| face != root && *arc == usize::MAX) {
            return uses;
        }
        for goal in (0..self.faces).filter(|goal| *goal != root) {
            uses[self.chosen[goal]] += 1;
            self.along(root, goal, |arc| uses[arc] += 1);
        }
        uses
    }
}

/// The number of rounds between two calls of the Lagrangian heuristic.
const LAYOUTS_EVERY: usize = 20;

/// Returns the hinges (indices in [`Target::hinges`], in no certain order) of a layout made of one arc into each face
/// (Lagrangian heuristic). `root`: an index in [`Target::faces`]. `chosen`: for each face in their order, the arc by
/// which it is entered; the root's entry is not read.
///
/// Faces whose arcs lead back to the root keep them. Arcs that form a cycle do not: the faces of the cycle and those
/// that follow it are joined to the rest across the hinge of least index that leads there, and the arc back into the
/// cycle's first face is given up. Panics if a chosen side has no hinge or the target is not connected.
pub fn repaired(target: &Target, root: usize, chosen: &[usize]) -> Vec<usize> {
    let n = target.faces.len();
    let hinge_of = |arc: usize| target.hinge_at(arc as Arc).expect("arcs lead across hinges");
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
