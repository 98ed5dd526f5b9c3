//! The least singular values of the rigidity matrix, by subspace iteration.

use super::truss_layout::Layout;
use crate::geometry::Vec3;
use crate::optimize::cholesky::{Cholesky, PivotRule};
use crate::optimize::random::SplitMix64;
use crate::robot::truss::rigid_motions;
use nalgebra::DMatrix;

/// The number of vectors that the iteration carries beyond those asked for: clusters of values then converge.
const SPARE: usize = 4;
/// The part of the mean diagonal entry that is added to the diagonal, so that the matrix, which is singular for rigid
/// motions, has a decomposition; without unit.
const SHIFT: f64 = 1e-8;
/// The residual `|A v - θ v|` of unit vectors up to which a mode counts as converged, without unit: the error of θ is
/// its square over the distance to the next value.
const RESIDUAL: f64 = 1e-10;
/// The same for searches of steps.
const RESIDUAL_COARSE: f64 = 1e-6;
/// The greatest number of iterations: after so many a value is as good as the iteration can make it.
const ITERATIONS_MAX: usize = 200;

/// A singular value of the rigidity matrix (rows of unit vectors along the struts) that belongs to no rigid motion of
/// the whole truss, with its right singular vector.
#[derive(Clone, Debug)]
pub struct Mode {
    /// The singular value, without unit.
    pub value: f64,
    /// The displacement of each node in the right singular vector, a unit vector over all nodes together.
    pub nodes: Vec<Vec3>,
}

/// The modes found last, from which the next search begins; none at first.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// Orthonormal vectors in the order of the layout.
    vectors: Vec<Vec<f64>>,
    /// True if a coarse residual is enough.
    coarse: bool,
}

impl Modes {
    /// Returns these modes for searches of steps: values are found to 1e-9 and vectors to a thousandth of their distance
    /// from others.
    pub fn coarse(self) -> Modes {
        Modes { coarse: true, ..self }
    }

    /// Returns the modes of the `count` least singular values of the rigidity matrix, in ascending order, those of the
    /// six rigid motions of the whole left out; fewer if the truss has not so many. `x`: the positions of the nodes,
    /// m; `struts`: those of the layout. Found by subspace iteration (Bathe 1971) with the inverse of `RᵀR` beside its
    /// null space, which is known.
    pub fn weakest(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        count: usize,
    ) -> Vec<Mode> {
        let n = 3 * layout.nodes();
        let rigid: Vec<Vec<f64>> = rigid_motions(x)
            .iter()
            .map(|motion| layout.gathered(|node| motion.fixed_rows::<3>(3 * node).into()))
            .collect();
        let wanted = (count + SPARE).min(n - rigid.len().min(n));
        if wanted == 0 || struts.is_empty() {
            return Vec::new();
        }
        let along: Vec<Vec3> = struts.iter().map(|&(a, b)| (x[b] - x[a]).normalize()).collect();
        let shift = SHIFT * 2.0 * struts.len() as f64 / n as f64;
        let matrix = layout.matrix(x, struts, |_| 1.0, shift);
        let Some(factor) = matrix.cholesky(PivotRule::Raise(shift * SHIFT)) else { return Vec::new() };
        if self.vectors.len() != wanted || self.vectors[0].len() != n {
            self.vectors = begun(n, wanted);
        }
        let mut values = vec![0.0; wanted];
        for _ in 0..ITERATIONS_MAX {
            let done = self.iterate(layout, struts, &along, &rigid, &factor, &mut values);
            if done >= count.min(wanted) {
                break;
            }
        }
        let mode = |at: usize| Mode {
            value: values[at].max(0.0).sqrt(),
            nodes: (0..layout.nodes()).map(|node| layout.at(&self.vectors[at], node)).collect(),
        };
        (0..count.min(wanted)).map(mode).collect()
    }

    /// Makes one iteration; `values` become the Ritz values, ascending, and the vectors theirs. Returns the number of
    /// leading ones that have converged.
    fn iterate(
        &mut self,
        layout: &Layout,
        struts: &[(usize, usize)],
        along: &[Vec3],
        rigid: &[Vec<f64>],
        factor: &Cholesky,
        values: &mut [f64],
    ) -> usize {
        for at in 0..self.vectors.len() {
            let (done, rest) = self.vectors.split_at_mut(at);
            let vector = &mut rest[0];
            factor.solve(vector);
            // Twice is enough (Kahan; Parlett 1980, sec. 6.9).
            for _ in 0..2 {
                scale(vector);
                rigid.iter().chain(done.iter()).for_each(|other| remove(vector, other));
            }
            scale(vector);
        }
        // The matrix on the subspace, and its eigenvectors.
        let images: Vec<Vec<f64>> = self.vectors.iter().map(|v| product(layout, struts, along, v)).collect();
        let count = self.vectors.len();
        let ritz = DMatrix::from_fn(count, count, |i, j| dot(&self.vectors[i], &images[j]));
        let eigen = ((&ritz + ritz.transpose()) * 0.5).symmetric_eigen();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let turned = |of: &[Vec<f64>], k: usize| {
            let mut sum = vec![0.0; of[0].len()];
            for (j, vector) in of.iter().enumerate() {
                let part = eigen.eigenvectors[(j, order[k])];
                sum.iter_mut().zip(vector).for_each(|(s, v)| *s += part * v);
            }
            sum
        };
        let enough = if self.coarse { RESIDUAL_COARSE } else { RESIDUAL };
        let mut converged = 0;
        let mut vectors = Vec::with_capacity(count);
        for k in 0..count {
            values[k] = eigen.eigenvalues[order[k]];
            let (vector, image) = (turned(&self.vectors, k), turned(&images, k));
            let residual: f64 =
                vector.iter().zip(&image).map(|(v, a)| (a - values[k] * v) * (a - values[k] * v)).sum();
            if converged == k && residual <= enough * enough {
                converged += 1;
            }
            vectors.push(vector);
        }
        self.vectors = vectors;
        converged
    }
}

/// Returns the number of singular values of the rigidity matrix, those of rigid motions and all others that are zero
/// among them, that are below `limit` (without unit, above 0): by Sylvester's law of inertia, from the signs of the
/// pivots of `RᵀR - limit² I`. `None` where a pivot is zero within rounding, which tells nothing. `x`: the positions
/// of the nodes, m; `struts`: those of the layout.
pub fn below(layout: &Layout, x: &[Vec3], struts: &[(usize, usize)], limit: f64) -> Option<usize> {
    layout.matrix(x, struts, |_| 1.0, -limit * limit).negative_pivots()
}

/// Returns independent vectors to begin with.
fn begun(n: usize, count: usize) -> Vec<Vec<f64>> {
    let mut random = SplitMix64(1);
    (0..count).map(|_| (0..n).map(|_| random.next_signed()).collect()).collect()
}

/// Returns `Σ e (e·(v_b - v_a))` at the ends of the struts: `RᵀR v`.
fn product(layout: &Layout, struts: &[(usize, usize)], along: &[Vec3], v: &[f64]) -> Vec<f64> {
    let mut sums = vec![Vec3::zeros(); layout.nodes()];
    for (&(a, b), e) in struts.iter().zip(along) {
        let pull = e * e.dot(&(layout.at(v, b) - layout.at(v, a)));
        sums[b] += pull;
        sums[a] -= pull;
    }
    layout.gathered(|node| sums[node])
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(p, q)| p * q).sum()
}

fn scale(vector: &mut [f64]) {
    let size = dot(vector, vector).sqrt().max(f64::MIN_POSITIVE);
    vector.iter_mut().for_each(|v| *v /= size);
}

/// Takes from a vector its part along a unit vector.
fn remove(vector: &mut [f64], unit: &[f64]) {
    let part = dot(vector, unit);
    vector.iter_mut().zip(unit).for_each(|(v, u)| *v -= part * u);
}
