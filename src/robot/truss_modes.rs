//! The least singular values of the rigidity matrix, by subspace iteration.

use super::truss_layout::{Layout, directions};
use crate::geometry::Vec3;
use crate::optimize::cholesky::PivotRule;
use crate::optimize::random::SplitMix64;
use crate::optimize::sparse_cholesky::{SparseCholesky, SparseIndefinite};
use crate::optimize::wide::{WideWork, run_widest};
use crate::robot::truss::rigid_motions;
use nalgebra::DMatrix;

/// The number of vectors that the iteration carries, more than are asked for: clusters of values then converge.
const VECTORS: usize = 8;
/// The part of the mean diagonal entry that is added to the diagonal, so that the matrix, which is singular for rigid
/// motions, has a decomposition; without unit.
const SHIFT: f64 = 1e-8;
/// The residual `|A v - θ v|` of unit vectors up to which a mode counts as converged, without unit: the error of θ is
/// its square over the distance to the next value.
const RESIDUAL: f64 = 1e-10;
/// The same for searches of steps.
const RESIDUAL_COARSE: f64 = 1e-6;
/// The greatest number of independent rigid motions.
const RIGID_MAX: usize = 6;
/// The part of the least singular value by which it is supposed to fall at most from one position to the next.
const LEAST_FALL: f64 = 0.05;
/// The part of the least singular value that was found by which there may be a lesser one, where that is not known otherwise.
const LEAST_UNPROVED: f64 = 0.1;
/// The value, without unit, above which the least singular value is looked for near that of positions nearby.
const LEAST_TINY: f64 = 1e-4;
/// The greatest number of iterations there.
const ITERATIONS_NEAR: usize = 30;
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
    /// Orthonormal vectors, the columns, in the order of the layout.
    vectors: Vec<[f64; VECTORS]>,
    /// The number of columns that are not zero.
    wanted: usize,
    /// The singular value above which none is of interest, if a coarse residual is enough.
    coarse: Option<f64>,
    /// The least singular value that [`least`](Modes::least) found last.
    least: Option<f64>,
}

/// A lower bound on the singular values of the rigidity matrix that belong to no rigid motion, with the decomposition that proves it
/// (Sylvester's law of inertia).
#[derive(Clone, Debug)]
pub struct LowerBound {
    /// The bound, without unit.
    pub value: f64,
    factor: SparseIndefinite,
}

impl LowerBound {
    /// Returns the bound `value` (without unit, above 0) with the nodes at `x`, m; `None` where it is not proved. `struts`: those of
    /// the layout.
    pub fn new(layout: &Layout, x: &[Vec3], struts: &[(usize, usize)], value: f64) -> Option<LowerBound> {
        let factor = layout.matrix(&directions(x, struts), struts, |_| 1.0, -value * value).indefinite()?;
        (factor.negative_pivots() <= RIGID_MAX).then_some(LowerBound { value, factor })
    }

    /// Returns the bound that [`Modes::least_above`] leads from to the least singular value, where it falls by no more than a part of
    /// the last, as it does from one step to the next; `None` where it falls by more, and where the last is next to nothing.
    pub fn near(layout: &Layout, x: &[Vec3], struts: &[(usize, usize)], last: f64) -> Option<LowerBound> {
        if last <= LEAST_TINY {
            return None;
        }
        LowerBound::new(layout, x, struts, last * (1.0 - LEAST_FALL))
    }
}

/// The decomposition by which an iteration solves systems.
enum Factor<'a> {
    /// The decomposition of a matrix whose small eigenvalues are those of rigid motions, which therefore grow very much.
    Definite(&'a SparseCholesky),
    /// The decomposition of a matrix that is nearly singular for the modes looked for.
    Near(&'a SparseIndefinite),
}

/// One iteration for modes.
struct Iteration<'a> {
    modes: &'a mut Modes,
    matrix: &'a Matrix<'a>,
    rigid: &'a [[f64; RIGID_MAX]],
    factor: Factor<'a>,
    values: &'a mut [f64; VECTORS],
}

impl WideWork for Iteration<'_> {
    type Output = usize;

    #[inline(always)]
    fn run(self) -> usize {
        self.modes.iterate(self.matrix, self.rigid, &self.factor, self.values)
    }
}

/// The rigidity matrix of a truss: a row for each strut with a vector along it at one node, and minus that at the other.
struct Matrix<'a> {
    layout: &'a Layout,
    struts: &'a [(usize, usize)],
    rows: &'a [Vec3],
}

impl Modes {
    /// Returns these modes for searches of steps: values are found to 1e-9 and vectors to a thousandth of their distance
    /// from others, and those of values above `within` as they come.
    pub fn coarse(self, within: f64) -> Modes {
        Modes { coarse: Some(within), ..self }
    }

    /// Returns the modes of the `count` least singular values of the rigidity matrix of unit rows, in ascending order,
    /// those of the six rigid motions of the whole left out; fewer if the truss has not so many. `x`: the positions of
    /// the nodes, m; `struts`: those of the layout. Found by subspace iteration (Bathe 1971) with the inverse of `RᵀR`
    /// beside its null space, which is known.
    pub fn weakest(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        count: usize,
    ) -> Vec<Mode> {
        self.weakest_of(layout, x, (struts, &directions(x, struts)), count)
    }

    /// Returns the modes of [`weakest`](Self::weakest) for the matrix whose rows are these vectors along the struts.
    pub(super) fn weakest_of(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        (struts, rows): (&[(usize, usize)], &[Vec3]),
        count: usize,
    ) -> Vec<Mode> {
        let Some((wanted, rigid)) = self.prepared(layout, x, struts) else { return Vec::new() };
        let n = 3 * layout.nodes();
        let matrix = Matrix { layout, struts, rows };
        let trace: f64 = rows.iter().map(|row| 2.0 * row.norm_squared()).sum();
        let shift = SHIFT * trace / n as f64;
        let shifted = layout.matrix(rows, struts, |_| 1.0, shift);
        let Some(factor) = shifted.cholesky(PivotRule::Raise(shift * SHIFT)) else { return Vec::new() };
        let mut values = [0.0; VECTORS];
        let count = count.min(wanted);
        for _ in 0..ITERATIONS_MAX {
            let (rigid, factor, values) = (&rigid, Factor::Definite(&factor), &mut values);
            if run_widest(Iteration { modes: self, matrix: &matrix, rigid, factor, values }) >= count {
                break;
            }
        }
        let mode = |at: usize| {
            let column: Vec<f64> = self.vectors.iter().map(|row| row[at]).collect();
            let nodes = (0..layout.nodes()).map(|node| layout.at(&column, node)).collect();
            Mode { value: values[at].max(0.0).sqrt(), nodes }
        };
        (0..count).map(mode).collect()
    }

    /// Returns the least singular value of the rigidity matrix of unit rows, those of rigid motions left out, to about 1e-9;
    /// `None` of a truss that has no other. It is proved by Sylvester's law of inertia that no other is less by more than a
    /// part of it. The search goes on from positions nearby, if these modes are known there: near the value there a
    /// decomposition leads to it soon, and proves as much at once. `x`: the positions of the nodes, m; `struts`: those of the
    /// layout.
    pub fn least(&mut self, layout: &Layout, x: &[Vec3], struts: &[(usize, usize)]) -> Option<f64> {
        let bound = self.least.take().and_then(|last| LowerBound::near(layout, x, struts, last));
        let near = bound.and_then(|bound| self.least_above(layout, x, struts, &bound));
        near.or_else(|| self.least_anew(layout, x, struts))
    }

    /// Returns the least singular value, as [`least`](Self::least) does, whatever it was nearby.
    pub fn least_anew(&mut self, layout: &Layout, x: &[Vec3], struts: &[(usize, usize)]) -> Option<f64> {
        self.coarse = Some(f64::INFINITY);
        // The value alone counts, however far it is above the limit.
        let value = |modes: &mut Modes| Some(modes.weakest(layout, x, struts, 1).first()?.value);
        let mut found = value(self)?;
        // Modes of nearby positions may not lead to the least.
        if LowerBound::new(layout, x, struts, found * (1.0 - LEAST_UNPROVED)).is_none() {
            *self = Modes::default();
            found = value(self)?;
        }
        self.least = Some(found);
        Some(found)
    }

    /// Returns the least singular value, as [`least`](Self::least) does, by inverse iteration from a lower bound at the same
    /// positions; `None` where that is so far below it that it does not lead there.
    pub fn least_above(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        bound: &LowerBound,
    ) -> Option<f64> {
        self.coarse = Some(f64::INFINITY);
        let rows = &directions(x, struts);
        let (wanted, rigid) = self.prepared(layout, x, struts)?;
        // A random vector has a part of every mode, whichever has become the least in the meantime.
        let mut random = SplitMix64(1);
        self.vectors.iter_mut().for_each(|row| row[wanted - 1] = random.next_signed());
        let matrix = Matrix { layout, struts, rows };
        let mut values = [0.0; VECTORS];
        for _ in 0..ITERATIONS_NEAR {
            let (rigid, factor, values) = (&rigid, Factor::Near(&bound.factor), &mut values);
            let converged = run_widest(Iteration { modes: self, matrix: &matrix, rigid, factor, values });
            if converged > 0 {
                let found = values[0].max(0.0).sqrt();
                let proved = bound.value >= found * (1.0 - LEAST_UNPROVED);
                self.least = proved.then_some(found);
                return self.least;
            }
        }
        None
    }

    /// Prepares the vectors for a search; returns how many there are, and the rigid motions in the order of the layout. `None`
    /// where there is nothing to look for.
    fn prepared(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
    ) -> Option<(usize, Vec<[f64; RIGID_MAX]>)> {
        let n = 3 * layout.nodes();
        let motions = rigid_motions(x);
        let wanted = VECTORS.min(n - motions.len().min(n));
        if wanted == 0 || struts.is_empty() {
            return None;
        }
        let mut rigid = vec![[0.0; RIGID_MAX]; n];
        for (k, motion) in motions.iter().enumerate() {
            let gathered = layout.gathered(|node| motion.fixed_rows::<3>(3 * node).into());
            rigid.iter_mut().zip(gathered).for_each(|(row, value)| row[k] = value);
        }
        if self.vectors.len() != n || self.wanted != wanted {
            (self.vectors, self.wanted) = (begun(n, wanted), wanted);
        }
        Some((wanted, rigid))
    }

    /// Makes one iteration; `values` become the Ritz values, ascending, and the vectors theirs. Returns the number of
    /// leading ones that have converged; all, if the next is of no interest.
    #[inline(always)]
    fn iterate(
        &mut self,
        matrix: &Matrix,
        rigid: &[[f64; RIGID_MAX]],
        factor: &Factor,
        values: &mut [f64; VECTORS],
    ) -> usize {
        // Twice is enough (Kahan; Parlett 1980, sec. 6.9).
        let removals = match factor {
            Factor::Definite(factor) => {
                factor.solve_columns(&mut self.vectors);
                2
            }
            Factor::Near(factor) => {
                factor.solve_columns(&mut self.vectors);
                1
            }
        };
        for _ in 0..removals {
            normalise(&mut self.vectors);
            remove(&mut self.vectors, rigid);
        }
        orthonormalise(&mut self.vectors);
        // The matrix on the subspace, and its eigenvectors.
        let images = matrix.squared_times(&self.vectors);
        let ritz = products(&self.vectors, &images);
        let ritz = DMatrix::from_fn(self.wanted, self.wanted, |i, j| (ritz[i][j] + ritz[j][i]) / 2.0);
        let eigen = ritz.symmetric_eigen();
        let mut order: Vec<usize> = (0..self.wanted).collect();
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let mut turn = [[0.0; VECTORS]; VECTORS];
        for (k, &from) in order.iter().enumerate() {
            values[k] = eigen.eigenvalues[from];
            (0..self.wanted).for_each(|j| turn[j][k] = eigen.eigenvectors[(j, from)]);
        }
        let mut residuals = [0.0; VECTORS];
        for (vector, image) in self.vectors.iter_mut().zip(&images) {
            let turned = combined(image, &turn);
            *vector = combined(vector, &turn);
            for k in 0..VECTORS {
                let rest = turned[k] - values[k] * vector[k];
                residuals[k] += rest * rest;
            }
        }
        let enough = if self.coarse.is_some() { RESIDUAL_COARSE } else { RESIDUAL };
        let converged =
            residuals[..self.wanted].iter().take_while(|square| **square <= enough * enough).count();
        // An eigenvalue is no farther from a Ritz value than the residual.
        let beyond = |within: f64| {
            (1..self.wanted).contains(&converged)
                && values[converged] - residuals[converged].sqrt() > within * within
        };
        if self.coarse.is_some_and(beyond) { self.wanted } else { converged }
    }
}

/// Returns independent vectors to begin with.
fn begun(n: usize, count: usize) -> Vec<[f64; VECTORS]> {
    let mut random = SplitMix64(1);
    let mut vectors = vec![[0.0; VECTORS]; n];
    for k in 0..count {
        vectors.iter_mut().for_each(|row| row[k] = random.next_signed());
    }
    vectors
}

impl Matrix<'_> {
    /// Returns `RᵀR V`, for each column v `Σ r (r·(v_b - v_a))` at the ends of the struts.
    #[inline(always)]
    fn squared_times(&self, v: &[[f64; VECTORS]]) -> Vec<[f64; VECTORS]> {
        let Matrix { layout, struts, rows } = *self;
        let mut sums = vec![[0.0; VECTORS]; v.len()];
        for (&(a, b), r) in struts.iter().zip(rows) {
            let (a, b) = (layout.row(a), layout.row(b));
            let mut pulls = [0.0; VECTORS];
            for k in 0..3 {
                let (from, to) = (&v[a + k], &v[b + k]);
                (0..VECTORS).for_each(|column| pulls[column] += r[k] * (to[column] - from[column]));
            }
            for k in 0..3 {
                (0..VECTORS).for_each(|column| sums[a + k][column] -= r[k] * pulls[column]);
                (0..VECTORS).for_each(|column| sums[b + k][column] += r[k] * pulls[column]);
            }
        }
        sums
    }
}

/// Returns the dot products of the columns of two matrices, `AᵀB`.
#[inline(always)]
fn products<const N: usize>(a: &[[f64; N]], b: &[[f64; VECTORS]]) -> [[f64; VECTORS]; N] {
    let mut sums = [[0.0; VECTORS]; N];
    for (row, other) in a.iter().zip(b) {
        for (sums, value) in sums.iter_mut().zip(row) {
            (0..VECTORS).for_each(|column| sums[column] += value * other[column]);
        }
    }
    sums
}

/// Returns a row times a matrix.
#[inline(always)]
fn combined<const N: usize>(row: &[f64; N], matrix: &[[f64; VECTORS]; N]) -> [f64; VECTORS] {
    let mut sums = [0.0; VECTORS];
    for (value, other) in row.iter().zip(matrix) {
        (0..VECTORS).for_each(|column| sums[column] += value * other[column]);
    }
    sums
}

/// Scales columns to length 1; those of zeros stay.
#[inline(always)]
fn normalise(vectors: &mut [[f64; VECTORS]]) {
    let mut squares = [0.0; VECTORS];
    for row in &*vectors {
        (0..VECTORS).for_each(|column| squares[column] += row[column] * row[column]);
    }
    let sizes = squares.map(|square: f64| square.sqrt().max(f64::MIN_POSITIVE));
    for row in vectors {
        (0..VECTORS).for_each(|column| row[column] /= sizes[column]);
    }
}

/// Takes from each column its part in the span of orthonormal ones.
#[inline(always)]
fn remove<const N: usize>(vectors: &mut [[f64; VECTORS]], units: &[[f64; N]]) {
    let parts = products(units, vectors);
    for (row, unit) in vectors.iter_mut().zip(units) {
        let along = combined(unit, &parts);
        (0..VECTORS).for_each(|column| row[column] -= along[column]);
    }
}

/// Makes columns orthonormal, each after those before it, by the method of Gram and Schmidt, twice for accuracy.
#[inline(always)]
fn orthonormalise(vectors: &mut [[f64; VECTORS]]) {
    for own in 0..VECTORS {
        for _ in 0..2 {
            let mut parts = [0.0; VECTORS];
            for row in &*vectors {
                (0..VECTORS).for_each(|column| parts[column] += row[column] * row[own]);
            }
            parts[own..].fill(0.0);
            let mut square = 0.0;
            for row in &mut *vectors {
                let mut along = 0.0;
                (0..VECTORS).for_each(|column| along += parts[column] * row[column]);
                row[own] -= along;
                square += row[own] * row[own];
            }
            let size = square.sqrt().max(f64::MIN_POSITIVE);
            vectors.iter_mut().for_each(|row| row[own] /= size);
        }
    }
}
