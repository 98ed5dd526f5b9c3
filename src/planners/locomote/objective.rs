//! The cost that a step of locomotion minimises: equations (14) and (17) of the paper, and (14) damped, as
//! it has to be in order to arrive.

use crate::geometry::Vec3;
use crate::planners::truss::Structure;
use crate::planners::truss::step::QuadraticCost;

/// The damping of `LENGTHS` and `RESTORING`, without unit: with less, runs were seen to get stuck.
const DAMPING: f64 = 1.0;
/// The damping of `FEWEST`, 1/m: just enough that there is one best step.
const DAMPING_FEWEST: f64 = 1e-3;

/// The number of nodes from which on `Springs` is the usual objective.
const NODES_MANY: usize = 200;

/// The objective of locomotion, which each step minimises (Eq. 14 and 17 of [Usevitch et
/// al.](crate::planners::truss)). `damping` is the weight of the squared displacements of the nodes, relative to that
/// of the changes of length, not negative: without it, motion that hardly changes lengths costs nothing, and the
/// robot collapses to the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Objective {
    /// Eq. 17 of [Usevitch et al.](crate::planners::truss): every node moves where its struts, as springs whose rest
    /// length is the mean length at the start, pull it.
    Springs,
    /// Eq. 14 of [Usevitch et al.](crate::planners::truss): the squared rates of length are least.
    Lengths {
        /// The weight of the squared displacements of the nodes (m²), relative to that of the squared changes of
        /// length (m²), without unit.
        damping: f64,
    },
    /// Eq. 14 of [Usevitch et al.](crate::planners::truss) about rates that bring the struts back to their mean
    /// length at the start.
    Restoring {
        /// The weight of the squared displacements of the nodes (m²), relative to that of the squared changes of
        /// length (m²), without unit.
        damping: f64,
    },
    /// The least sum of the absolute rates of length, so that few struts move (a linear program but for the damping).
    Fewest {
        /// The weight of the squared displacements of the nodes (m²), relative to that of the absolute changes of
        /// length (m), 1/m.
        damping: f64,
    },
}

impl Objective {
    /// The objective [`Objective::Lengths`] with the default damping, 1, without unit.
    pub const LENGTHS: Objective = Objective::Lengths { damping: DAMPING };
    /// The objective [`Objective::Restoring`] with the default damping, 1, without unit.
    pub const RESTORING: Objective = Objective::Restoring { damping: DAMPING };
    /// The objective [`Objective::Fewest`] with the default damping, 1e-3 per metre.
    pub const FEWEST: Objective = Objective::Fewest { damping: DAMPING_FEWEST };

    /// Returns the objective for a truss of so many nodes of which nothing else is known: `RESTORING`, which under weight gets stuck
    /// the least; `Springs`, whose quadratic program is diagonal, where a decomposition more would take a third of a step's time.
    pub fn usual(nodes: usize) -> Objective {
        if nodes < NODES_MANY { Objective::RESTORING } else { Objective::Springs }
    }
}

/// Returns the cost, quadratic or with absolute values, of displacing the nodes from `x` (m, in the world's frame, by
/// index of the node) in one step. `pace`: the displacement in the step, m, for a speed of 1 m/s, by which the
/// velocities of `Springs` and the rates of `Restoring` are scaled. `objective`: the quantity; `truss`: the truss with
/// its limits.
pub fn cost(objective: Objective, truss: &Structure, x: &[Vec3], pace: f64) -> QuadraticCost {
    match objective {
        Objective::Springs => springs(truss, x, pace),
        Objective::Fewest { damping } => fewest(truss, x, damping),
        Objective::Lengths { damping } => lengths(truss, x, damping, |_| 0.0),
        Objective::Restoring { damping } => lengths(truss, x, damping, |length| (truss.unit - length) * pace),
    }
}

/// Returns `½ |u - pace v|²` with the velocities v of equation (15).
fn springs(truss: &Structure, x: &[Vec3], pace: f64) -> QuadraticCost {
    let mut pull = vec![Vec3::zeros(); truss.nodes];
    for &(a, b) in &truss.struts {
        let d = x[b] - x[a];
        let along = d * ((d.norm() - truss.unit) / d.norm());
        pull[a] += along;
        pull[b] -= along;
    }
    QuadraticCost {
        hessian: (0..3 * truss.nodes).map(|i| (i, i, 1.0)).collect(),
        linear: pull.iter().flat_map(|v| (0..3).map(move |k| -pace * v[k])).collect(),
        absolutes: Vec::new(),
    }
}

/// Returns `½ |R u - w|² + ½ damping |u|²` with the rigidity matrix R of unit rows and the wanted rate w of a
/// strut as a function of its length.
fn lengths(truss: &Structure, x: &[Vec3], damping: f64, wanted: impl Fn(f64) -> f64) -> QuadraticCost {
    let mut hessian: Vec<(usize, usize, f64)> = (0..3 * truss.nodes).map(|i| (i, i, damping)).collect();
    let mut linear = vec![0.0; 3 * truss.nodes];
    for &(a, b) in &truss.struts {
        let d = x[a] - x[b];
        let (along, length) = (d.normalize(), d.norm());
        let row = rigidity_row((a, b), along);
        for &(i, p) in &row {
            linear[i] -= p * wanted(length);
            for &(j, q) in row.iter().filter(|(j, _)| *j >= i) {
                hessian.push((i, j, p * q));
            }
        }
    }
    QuadraticCost { hessian, linear, absolutes: Vec::new() }
}

/// Returns `Σ |rate| + ½ damping |u|²`.
fn fewest(truss: &Structure, x: &[Vec3], damping: f64) -> QuadraticCost {
    let rates = truss.struts.iter().map(|&(a, b)| rigidity_row((a, b), (x[a] - x[b]).normalize()));
    QuadraticCost {
        hessian: (0..3 * truss.nodes).map(|i| (i, i, damping)).filter(|(_, _, v)| *v > 0.0).collect(),
        linear: vec![0.0; 3 * truss.nodes],
        absolutes: rates.collect(),
    }
}

/// Returns a row of the rigidity matrix, the Jacobian of a strut's length, sparse.
fn rigidity_row((a, b): (usize, usize), along: Vec3) -> Vec<(usize, f64)> {
    let end = |(node, sign): (usize, f64)| (0..3).map(move |k| (3 * node + k, sign * along[k]));
    [(a, 1.0), (b, -1.0)].into_iter().flat_map(end).collect()
}
