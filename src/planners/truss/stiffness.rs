//! The least singular values of the rigidity matrix, and how they change with the nodes: where one is
//! zero the struts no longer decide where the nodes are.

use super::structure::Structure;
use crate::geometry::Vec3;
use nalgebra::{DMatrix, DVector};

/// Motions of the whole.
const RIGID: usize = 6;

/// A singular value with its vectors: of the struts and of the nodes' coordinates.
#[derive(Clone)]
pub struct Mode {
    pub value: f64,
    struts: Vec<f64>,
    nodes: DVector<f64>,
}

/// The least ones but those of rigid motions, in order. The matrix has a row of unit vectors a strut.
pub fn weakest(truss: &Structure, x: &[Vec3], count: usize) -> Vec<Mode> {
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

/// The mode i for i = j, else the sum or the difference of two ([`Bound::Rigid`](super::bound::Bound)). Where two values
/// are nearly the same their vectors are any two of the plane that they span, and a step that keeps both may
/// still bring down one between them.
pub fn joined(modes: &[Mode], i: usize, j: usize) -> Mode {
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
    /// By how much it is above the floor, in units.
    pub fn spare(&self, truss: &Structure) -> f64 {
        (self.value - truss.limits.rigidity) * truss.unit
    }

    /// Of the value times the unit, by node: `uᵀ dR v`.
    pub fn gradient(&self, truss: &Structure, x: &[Vec3]) -> Vec<(usize, Vec3)> {
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
