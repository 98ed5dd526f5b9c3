//! The least singular values of the rigidity matrix, by subspace iteration.

use super::truss_layout::{Layout, directions};
use crate::geometry::Vec3;
use crate::optimize::cholesky::PivotRule;
use crate::optimize::random::SplitMix64;
use crate::optimize::sparse_cholesky::{SparseCholesky, SparseIndefinite};
use crate::optimize::wide::{WideWork, run_widest};
use crate::robot::truss::rigid_motions;
use nalgebra::DMatrix;
use std::sync::Arc;

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
/// The part of a vector across those before it, of its length, below which it counts as dependent on them.
const DEPENDENT: f64 = 1e-3;
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
    /// The Ritz values of the vectors.
    values: [f64; VECTORS],
    /// The least singular value that [`least`](Modes::least) found last.
    least: Option<f64>,
}

/// A lower bound on the singular values of the rigidity matrix that belong to no rigid motion, with the decomposition that proves it
/// (Sylvester's law of inertia).
#[derive(Clone, Debug)]
pub struct LowerBound {
    /// The bound, without unit.
    pub value: f64,
    factor: ShiftedFactor,
}

/// The decomposition of `RᵀR - s²` for a rigidity matrix R and a value s near the singular values that are looked for.
#[derive(Clone, Debug)]
pub struct ShiftedFactor(Arc<SparseIndefinite>);

impl ShiftedFactor {
    /// Returns the decomposition for a value (without unit) with the nodes at `x`, m; `None` where rounding decides the sign of a
    /// pivot. `struts`: those of the layout.
    pub fn new(layout: &Layout, x: &[Vec3], struts: &[(usize, usize)], value: f64) -> Option<ShiftedFactor> {
        let matrix = layout.matrix(&directions(x, struts), struts, |_| 1.0, -value * value);
        Some(ShiftedFactor(Arc::new(matrix.indefinite()?)))
    }
}

impl LowerBound {
    /// Returns the bound `value` (without unit, above 0) with the nodes at `x`, m; `None` where it is not proved. `struts`: those of
    /// the layout.
    pub fn new(layout: &Layout, x: &[Vec3], struts: &[(usize, usize)], value: f64) -> Option<LowerBound> {
        let factor = ShiftedFactor::new(layout, x, struts, value)?;
        (factor.0.negative_pivots() <= RIGID_MAX).then_some(LowerBound { value, factor })
    }

    /// Returns the bound that [`Modes::least_above`] leads from to the least singular value, where it falls by no more than a part of
    /// the last, as it does from one step to the next; `None` where it falls by more, and where the last is next to nothing.
    pub fn near(layout: &Layout, x: &[Vec3], struts: &[(usize, usize)], last: f64) -> Option<LowerBound> {
        if last <= LEAST_TINY {
            return None;
        }
        LowerBound::new(layout, x, struts, last * (1.0 - LEAST_FALL))
    }

    /// Returns the decomposition that proves the bound.
    pub fn factor(&self) -> &ShiftedFactor {
        &self.factor
    }
}

/// The decomposition by which an iteration solves systems.
enum Factor<'a> {
    /// The decomposition of a matrix whose small eigenvalues are those of rigid motions, which therefore grow very much.
    Definite(&'a SparseCholesky),
    /// The decomposition of a matrix that is nearly singular for the modes looked for, at these positions or near them, by which what
    /// is left corrects the vectors.
    Near(&'a SparseIndefinite),
}

/// The values that a search looks for.
#[derive(Clone, Copy)]
struct Wanted {
    /// The number of the least.
    count: usize,
    /// The singular value above which none is of interest, if a coarse residual is enough.
    coarse: Option<f64>,
}

/// One iteration for modes.
struct Iteration<'a> {
    modes: &'a mut Modes,
    matrix: &'a Matrix<'a>,
    rigid: &'a [[f64; RIGID_MAX]],
    factor: Factor<'a>,
    /// The residuals `A v - θ v` of the vectors, which become those of the next.
    rests: &'a mut [[f64; VECTORS]],
    coarse: Option<f64>,
}

impl WideWork for Iteration<'_> {
    type Output = usize;

    #[inline(always)]
    fn run(self) -> usize {
        self.modes.iterate(self.matrix, (self.rigid, &self.factor), self.rests, self.coarse)
    }
}

/// The rigidity matrix of a truss: a row for each strut with a vector along it at one node, and minus that at the other.
struct Matrix<'a> {
    layout: &'a Layout,
    struts: &'a [(usize, usize)],
    rows: &'a [Vec3],
}

impl Modes {
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
        self.weakest_of(layout, x, (struts, &directions(x, struts)), Wanted { count, coarse: None })
    }

    /// Returns the modes of [`weakest`](Self::weakest) for searches of steps: values are found to 1e-9 and vectors to a thousandth
    /// of their distance from others, and those of values above `within` (without unit) as they come. `near`: a decomposition at
    /// these positions or near them for a value near those looked for, which leads to them sooner, if there is one.
    pub fn weakest_coarse(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        (count, within): (usize, f64),
        near: Option<&ShiftedFactor>,
    ) -> Vec<Mode> {
        let wanted = Wanted { count, coarse: Some(within) };
        if let Some(near) = near {
            if let Some(found) = self.corrected(layout, x, struts, near, wanted) {
                return (0..found).map(|at| self.mode(layout, at)).collect();
            }
            *self = Modes::default();
        }
        self.weakest_of(layout, x, (struts, &directions(x, struts)), wanted)
    }

    /// Returns the least singular value of the matrix whose rows are these vectors along the struts, to about 1e-9, those of rigid
    /// motions left out; `None` of a truss that has no other.
    pub(super) fn least_of(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: (&[(usize, usize)], &[Vec3]),
    ) -> Option<f64> {
        // The value alone counts, however great it is.
        let wanted = Wanted { count: 1, coarse: Some(f64::INFINITY) };
        Some(self.weakest_of(layout, x, struts, wanted).first()?.value)
    }

    /// Returns the modes wanted for the matrix whose rows are these vectors along the struts.
    fn weakest_of(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        (struts, rows): (&[(usize, usize)], &[Vec3]),
        Wanted { count, coarse }: Wanted,
    ) -> Vec<Mode> {
        let Some((wanted, rigid)) = self.prepared(layout, x, struts) else { return Vec::new() };
        let n = 3 * layout.nodes();
        let matrix = Matrix { layout, struts, rows };
        let trace: f64 = rows.iter().map(|row| 2.0 * row.norm_squared()).sum();
        let shift = SHIFT * trace / n as f64;
        let shifted = layout.matrix(rows, struts, |_| 1.0, shift);
        let Some(factor) = shifted.cholesky(PivotRule::Raise(shift * SHIFT)) else { return Vec::new() };
        let count = count.min(wanted);
        let mut rests = vec![[0.0; VECTORS]; n];
        for _ in 0..ITERATIONS_MAX {
            let (rigid, factor, rests) = (&rigid, Factor::Definite(&factor), &mut rests);
            if run_widest(Iteration { modes: self, matrix: &matrix, rigid, factor, rests, coarse }) >= count {
                break;
            }
        }
        (0..count).map(|at| self.mode(layout, at)).collect()
    }

    /// Returns the mode in a column of the vectors.
    fn mode(&self, layout: &Layout, at: usize) -> Mode {
        let column: Vec<f64> = self.vectors.iter().map(|row| row[at]).collect();
        let nodes = (0..layout.nodes()).map(|node| layout.at(&column, node)).collect();
        Mode { value: self.values[at].max(0.0).sqrt(), nodes }
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
        let rows = &directions(x, struts)[..];
        let mut found = self.least_of(layout, x, (struts, rows))?;
        // Modes of nearby positions may not lead to the least.
        if LowerBound::new(layout, x, struts, found * (1.0 - LEAST_UNPROVED)).is_none() {
            *self = Modes::default();
            found = self.least_of(layout, x, (struts, rows))?;
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
        let wanted = Wanted { count: 1, coarse: Some(f64::INFINITY) };
        self.corrected(layout, x, struts, &bound.factor, wanted)?;
        let found = self.values[0].max(0.0).sqrt();
        self.least = (bound.value >= found * (1.0 - LEAST_UNPROVED)).then_some(found);
        self.least
    }

    /// Looks for the values wanted by inverse iteration without the inverse: what a decomposition nearby corrects the vectors by is
    /// nearly what the inverse would (Knyazev and Neymeyr 2003), and just that where it is of the same positions. Returns the number
    /// of those found; `None` where it does not lead there.
    fn corrected(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        near: &ShiftedFactor,
        Wanted { count, coarse }: Wanted,
    ) -> Option<usize> {
        let rows = &directions(x, struts);
        let (wanted, rigid) = self.prepared(layout, x, struts)?;
        let count = count.min(wanted);
        // A random vector has a part of every mode, whichever has become the least in the meantime.
        let mut random = SplitMix64(1);
        self.vectors.iter_mut().for_each(|row| row[wanted - 1] = random.next_signed());
        self.values[wanted - 1] = 0.0;
        let matrix = Matrix { layout, struts, rows };
        let mut rests = matrix.squared_times(&self.vectors);
        for (rest, vector) in rests.iter_mut().zip(&self.vectors) {
            for ((rest, vector), value) in rest.iter_mut().zip(vector).zip(&self.values) {
                *rest -= value * vector;
            }
        }
        let converged = |_: &usize| {
            let (rigid, factor, rests) = (&rigid, Factor::Near(&near.0), &mut rests);
            run_widest(Iteration { modes: self, matrix: &matrix, rigid, factor, rests, coarse }) >= count
        };
        (0..ITERATIONS_NEAR).find(converged).map(|_| count)
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
            (self.vectors, self.wanted, self.values) = (begun(n, wanted), wanted, [0.0; VECTORS]);
        }
        Some((wanted, rigid))
    }

    /// Makes one iteration; the values become the Ritz values, ascending, and the vectors and `rests` theirs. Returns the number
    /// of leading ones that have converged; all, if the next is of no interest.
    #[inline(always)]
    fn iterate(
        &mut self,
        matrix: &Matrix,
        (rigid, factor): (&[[f64; RIGID_MAX]], &Factor),
        rests: &mut [[f64; VECTORS]],
        coarse: Option<f64>,
    ) -> usize {
        // Twice is enough (Kahan; Parlett 1980, sec. 6.9).
        let removals = match factor {
            Factor::Definite(factor) => {
                factor.solve_columns(&mut self.vectors);
                2
            }
            Factor::Near(factor) => {
                factor.solve_columns(rests);
                for (vector, rest) in self.vectors.iter_mut().zip(&*rests) {
                    add(vector, -1.0, rest);
                }
                1
            }
        };
        for _ in 0..removals {
            normalise(&mut self.vectors);
            remove(&mut self.vectors, rigid);
        }
        // The lower factor L of the products of the vectors, by which V L⁻ᵀ is orthonormal.
        let size = self.wanted;
        let lower = |vectors: &[[f64; VECTORS]]| {
            let gram = products(vectors, vectors);
            let lower = DMatrix::from_fn(size, size, |i, j| gram[i][j]).cholesky()?.unpack();
            (lower.diagonal().min() > DEPENDENT).then_some(lower)
        };
        let lower = lower(&self.vectors).unwrap_or_else(|| {
            orthonormalise(&mut self.vectors);
            DMatrix::identity(size, size)
        });
        // The matrix on the subspace, and its eigenvectors.
        let images = matrix.squared_times(&self.vectors);
        let ritz = products(&self.vectors, &images);
        let mut ritz = DMatrix::from_fn(size, size, |i, j| (ritz[i][j] + ritz[j][i]) / 2.0);
        lower.solve_lower_triangular_unchecked_mut(&mut ritz);
        ritz.transpose_mut();
        lower.solve_lower_triangular_unchecked_mut(&mut ritz);
        let mut eigen = ritz.symmetric_eigen();
        lower.tr_solve_lower_triangular_unchecked_mut(&mut eigen.eigenvectors);
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let mut turn = [[0.0; VECTORS]; VECTORS];
        for (k, &from) in order.iter().enumerate() {
            self.values[k] = eigen.eigenvalues[from];
            (0..size).for_each(|j| turn[j][k] = eigen.eigenvectors[(j, from)]);
        }
        let mut residuals = [0.0; VECTORS];
        for ((vector, image), rest) in self.vectors.iter_mut().zip(&images).zip(rests) {
            *rest = combined(image, &turn);
            *vector = combined(vector, &turn);
            for k in 0..VECTORS {
                rest[k] -= self.values[k] * vector[k];
                residuals[k] += rest[k] * rest[k];
            }
        }
        let enough = if coarse.is_some() { RESIDUAL_COARSE } else { RESIDUAL };
        let converged =
            residuals[..self.wanted].iter().take_while(|square| **square <= enough * enough).count();
        // An eigenvalue is no farther from a Ritz value than the residual.
        let beyond = |within: f64| {
            (1..self.wanted).contains(&converged)
                && self.values[converged] - residuals[converged].sqrt() > within * within
        };
        if coarse.is_some_and(beyond) {
            return self.wanted;
        }
        // The next, while it is not known well, may belong before these.
        let unsure = (1..self.wanted).contains(&converged)
            && self.values[converged] - residuals[converged].sqrt() < self.values[converged - 1];
        if coarse.is_some() && unsure { 0 } else { converged }
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
                add(&mut pulls, r[k], to);
                add(&mut pulls, -r[k], from);
            }
            for k in 0..3 {
                add(&mut sums[a + k], -r[k], &pulls);
                add(&mut sums[b + k], r[k], &pulls);
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
            add(sums, *value, other);
        }
    }
    sums
}

/// Adds a multiple of a row to another.
#[inline(always)]
fn add(row: &mut [f64; VECTORS], factor: f64, other: &[f64; VECTORS]) {
    for (value, other) in row.iter_mut().zip(other) {
        *value += factor * other;
    }
}

/// Returns a row times a matrix.
#[inline(always)]
fn combined<const N: usize>(row: &[f64; N], matrix: &[[f64; VECTORS]; N]) -> [f64; VECTORS] {
    let mut sums = [0.0; VECTORS];
    for (value, other) in row.iter().zip(matrix) {
        add(&mut sums, *value, other);
    }
    sums
}

/// Scales columns to length 1; those of zeros stay.
#[inline(always)]
fn normalise(vectors: &mut [[f64; VECTORS]]) {
    let mut squares = [0.0; VECTORS];
    for row in &*vectors {
        squares.iter_mut().zip(row).for_each(|(square, value)| *square += value * value);
    }
    let sizes = squares.map(|square: f64| square.sqrt().max(f64::MIN_POSITIVE));
    for row in vectors {
        row.iter_mut().zip(&sizes).for_each(|(value, size)| *value /= size);
    }
}

/// Takes from each column its part in the span of orthonormal ones.
#[inline(always)]
fn remove<const N: usize>(vectors: &mut [[f64; VECTORS]], units: &[[f64; N]]) {
    let parts = products(units, vectors);
    for (row, unit) in vectors.iter_mut().zip(units) {
        let along = combined(unit, &parts);
        add(row, -1.0, &along);
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
