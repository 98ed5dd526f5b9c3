//! The least singular values of the rigidity matrix and their gradients over the nodes. If one is zero the
//! lengths of the struts no longer determine the positions of the nodes.
//!
//! The rigidity matrix R has a row for each strut with the unit vector along it at one node and minus that
//! at the other: R times the velocities of the nodes is the rates of length. It is the Jacobian of the
//! lengths.

use super::problem::RIGIDITY_NODES_MAX;
use super::structure::Structure;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::robot::truss_statics::{self as statics, Layout, Modes};

/// The dimension of the rigid motions of the whole truss: so many singular values of R are always zero.
const RIGID: usize = 6;

/// The least singular value that planners keep where none is stated, without unit: the judge's default.
const KEPT: f64 = 0.05;
/// The part of the least singular value at the start that they keep if that is less.
const KEPT_PART: f64 = 0.125;

/// A singular value of the rigidity matrix (the Jacobian of the strut lengths) with its singular vectors: over the
/// struts (left) and over the nodes' coordinates (right).
#[derive(Clone)]
pub(super) struct Mode {
    /// The singular value of the rigidity matrix, without unit.
    pub value: f64,
    struts: Vec<f64>,
    nodes: Vec<Vec3>,
}

/// Returns the modes of the `count` least singular values of the rigidity matrix with the nodes at `x` (m), in
/// ascending order, those of the six rigid motions left out. `known`: modes of nearby positions, from which the search
/// begins, and which become these.
pub(super) fn weakest(truss: &Structure, x: &[Vec3], count: usize, known: &mut Modes) -> Vec<Mode> {
    let along = |strut: usize| {
        let (a, b) = truss.struts[strut];
        (a, b, (x[a] - x[b]).normalize())
    };
    let mode = |mode: statics::Mode| {
        let nodes = mode.nodes;
        let strut = |(a, b, e): (usize, usize, Vec3)| {
            e.dot(&(nodes[a] - nodes[b])) / mode.value.max(f64::MIN_POSITIVE)
        };
        let struts = (0..truss.struts.len()).map(along).map(strut).collect();
        Mode { value: mode.value, struts, nodes }
    };
    known.weakest(&truss.layout, x, &truss.struts, count).into_iter().map(mode).collect()
}

/// Returns the limit on the least singular value of the rigidity matrix, without unit, that the planners keep where
/// none is stated: 0.05, or an eighth of the value at the start if that is less; 0, for no limit, for a truss that is
/// not rigid at the start or has more than [`RIGIDITY_NODES_MAX`] nodes. `start`: the positions of the nodes, m;
/// `struts`: the two nodes of each, which must be apart.
pub fn kept(start: &[Vec3], struts: &[(usize, usize)]) -> f64 {
    if start.len() > RIGIDITY_NODES_MAX || struts.iter().any(|&(a, b)| start[a] == start[b]) {
        return 0.0;
    }
    let layout = Layout::new(start.len(), struts);
    let modes = Modes::default().weakest(&layout, start, struts, 1);
    let least = modes.first().map_or(0.0, |mode| mode.value);
    if least > Tolerances::DEFAULT.not_rigid { KEPT.min(KEPT_PART * least) } else { 0.0 }
}

/// Returns true if more singular values of the rigidity matrix than the six of rigid motions are below the limit of the
/// truss, or within rounding of it.
pub(super) fn is_violated(truss: &Structure, x: &[Vec3]) -> bool {
    let count = statics::below(&truss.layout, x, &truss.struts, truss.limits.rigidity);
    count.is_none_or(|count| count > RIGID)
}

/// Returns mode i (an index in `modes`) for i = j, else the normalised sum (i < j) or difference (i > j) of two modes,
/// as in [`Constraint::Rigidity`](super::constraint::Constraint). If two singular values nearly coincide, their vectors
/// are any two of the plane that they span, and a step that keeps both values may still lower one in between. Panics if
/// there is no such mode.
pub(super) fn joined(modes: &[Mode], i: usize, j: usize) -> Mode {
    if i == j {
        return modes[i].clone();
    }
    let (a, b) = (&modes[i.min(j)], &modes[i.max(j)]);
    let sign = if i < j { 1.0 } else { -1.0 };
    let part = std::f64::consts::FRAC_1_SQRT_2;
    Mode {
        value: (a.value + b.value) / 2.0,
        struts: a.struts.iter().zip(&b.struts).map(|(p, q)| (p + sign * q) * part).collect(),
        nodes: a.nodes.iter().zip(&b.nodes).map(|(p, q)| (p + q * sign) * part).collect(),
    }
}

impl Mode {
    /// Returns the amount by which the singular value is above its limit
    /// [`Limits::rigidity`](super::structure::Limits), times the unit length of the truss, m; negative if it is below.
    pub(super) fn spare(&self, truss: &Structure) -> f64 {
        (self.value - truss.limits.rigidity) * truss.unit
    }

    /// Returns the gradient of the singular value times the unit length over the positions of the nodes, `uᵀ dR v`, as
    /// (index of a node, derivative by its position), without unit. `x`: the positions, m.
    pub(super) fn gradient(&self, truss: &Structure, x: &[Vec3]) -> Vec<(usize, Vec3)> {
        let mut sums = vec![Vec3::zeros(); truss.nodes];
        for (strut, &(a, b)) in truss.struts.iter().enumerate() {
            let d = x[a] - x[b];
            let e = d.normalize();
            let turns = self.nodes[a] - self.nodes[b];
            let pushed = (turns - e * e.dot(&turns)) * (self.struts[strut] * truss.unit / d.norm());
            sums[a] += pushed;
            sums[b] -= pushed;
        }
        sums.into_iter().enumerate().collect()
    }
}
