//! The least singular values of the rigidity matrix and their gradients over the nodes. If one is zero the
//! lengths of the struts no longer determine the positions of the nodes.
//!
//! The rigidity matrix R has a row for each strut with the unit vector along it at one node and minus that
//! at the other: R times the velocities of the nodes is the rates of length. It is the Jacobian of the
//! lengths.

use super::structure::Structure;
use crate::geometry::Vec3;
use nalgebra::{DMatrix, DVector};

/// The dimension of the rigid motions of the whole truss: so many singular values of R are always zero.
const RIGID: usize = 6;

/// A singular value of the rigidity matrix (the Jacobian of the strut lengths) with its singular vectors: over the
/// struts (left) and over the nodes' coordinates (right).
#[derive(Clone)]
pub(super) struct Mode {
    /// The singular value of the rigidity matrix, without unit.
    pub value: f64,
    struts: Vec<f64>,
    nodes: DVector<f64>,
}

/// Returns the modes of the `count` least singular values of the rigidity matrix with the nodes at `x` (m), in
/// ascending order, those of the six rigid motions left out. Found as square roots of the eigenvalues of RᵀR, so values
/// below about 1e-8 are noise.
pub(super) fn weakest(truss: &Structure, x: &[Vec3], count: usize) -> Vec<Mode> {
    let n = 3 * truss.nodes;
    let along = |strut: usize| {
        let (a, b) = truss.struts[strut];
        (a, b, (x[a] - x[b]).normalize())
    };
    let mut square = DMatrix::zeros(n, n);
    for (a, b, e) in (0..truss.struts.len()).map(along) {
        let block = e * e.transpose();
        for (p, q, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            let mut at = square.fixed_view_mut::<3, 3>(3 * p, 3 * q);
            at += block * sign;
        }
    }
    let eigen = square.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let mode = |&at: &usize| {
        let nodes = eigen.eigenvectors.column(at).into_owned();
        let value = eigen.eigenvalues[at].max(0.0).sqrt();
        let apart =
            |a: usize, b: usize| -> Vec3 { nodes.fixed_rows::<3>(3 * a) - nodes.fixed_rows::<3>(3 * b) };
        let strut = |(a, b, e): (usize, usize, Vec3)| e.dot(&apart(a, b)) / value.max(f64::MIN_POSITIVE);
        Mode { value, struts: (0..truss.struts.len()).map(along).map(strut).collect(), nodes }
    };
    order.iter().skip(RIGID).take(count).map(mode).collect()
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
        nodes: (&a.nodes + &b.nodes * sign) * part,
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
            let turns: Vec3 = self.nodes.fixed_rows::<3>(3 * a) - self.nodes.fixed_rows::<3>(3 * b);
            let pushed = (turns - e * e.dot(&turns)) * (self.struts[strut] * truss.unit / d.norm());
            sums[a] += pushed;
            sums[b] -= pushed;
        }
        sums.into_iter().enumerate().collect()
    }
}
