//! Cholesky's decomposition of sparse symmetric matrices in an order of little fill, by supernodes: the columns of each are
//! decomposed together as a dense matrix, and what they change in later ones is subtracted at once (Duff and Reid 1983).
//!
//! Every sum is over columns in their order, element by element, so that it does not depend on how many elements a
//! processor adds at a time.

use super::cholesky::{PivotRule, four_lanes};
use super::panel_products::{PackedRows, subtract, subtract_products};
use super::supernodes::{Slot, Supernode, SymbolicFactor};
use super::wide::{WideWork, run_widest};
use nalgebra::Matrix3;
use std::sync::Arc;

/// Threshold: the part of its diagonal entry, without unit, below which the sign of a pivot is not trusted.
const INERTIA_PIVOT: f64 = 1e-12;

/// The number of columns that are decomposed before the later ones of their supernode are changed.
const PANEL: usize = 48;
/// The number of columns whose products are summed together, by which [`PANEL`] is divisible.
const BLOCK: usize = 3;

/// A sparse symmetric matrix, with room for its factor. Of the diagonal blocks the lower half counts.
#[derive(Clone, Debug)]
pub struct SparseMatrix {
    symbolic: Arc<SymbolicFactor>,
    values: Vec<f64>,
}

/// The factor `L` of the decomposition `L Lᵀ = P A Pᵀ` of a sparse symmetric positive definite matrix A; P is the
/// permutation of the symbolic decomposition.
#[derive(Clone, Debug)]
pub struct SparseCholesky {
    symbolic: Arc<SymbolicFactor>,
    values: Vec<f64>,
}

/// The decomposition `L D Lᵀ = P A Pᵀ` of a sparse symmetric matrix A, D of ones and minus ones; P is the permutation of the
/// symbolic decomposition.
#[derive(Clone, Debug)]
pub struct SparseIndefinite {
    factor: SparseCholesky,
    signs: Vec<f64>,
}

impl SparseIndefinite {
    /// Returns the number of negative eigenvalues (Sylvester's law of inertia).
    pub fn negative_pivots(&self) -> usize {
        self.signs.iter().filter(|sign| **sign < 0.0).count()
    }

    /// Replaces the columns of `y`, whose rows are in the order of the factor, by the solutions of `P A Pᵀ x = y`.
    pub fn solve_columns<const N: usize>(&self, y: &mut [[f64; N]]) {
        run_widest(Solution { factor: &self.factor, signs: Some(&self.signs), y });
    }
}

impl SparseMatrix {
    /// Returns the zero matrix with the entries of this symbolic decomposition.
    pub fn new(symbolic: &Arc<SymbolicFactor>) -> SparseMatrix {
        SparseMatrix { values: vec![0.0; symbolic.entries], symbolic: symbolic.clone() }
    }

    /// Adds `value` to the entry at a row and a column, in either order. Panics if the symbolic decomposition has no such
    /// entry.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let size = self.symbolic.size;
        let Slot { index, stride, transposed } = self.symbolic.slot(row / size, column / size);
        let (mut i, mut j) = (row % size, column % size);
        if transposed || (row / size == column / size && i < j) {
            (i, j) = (j, i);
        }
        self.values[index + j * stride + i] += value;
    }

    /// Adds a symmetric block of three rows at a place that [`SymbolicFactor::slot`] tells.
    pub fn add_block(&mut self, slot: Slot, block: &Matrix3<f64>) {
        for (j, column) in block.column_iter().enumerate() {
            let from = slot.index + j * slot.stride;
            self.values[from..from + 3].iter_mut().zip(column.iter()).for_each(|(value, b)| *value += b);
        }
    }

    /// Returns the Cholesky decomposition. `None` where the rule refuses a pivot; [`PivotRule::Raise`] refuses none.
    pub fn cholesky(mut self, rule: PivotRule) -> Option<SparseCholesky> {
        let accepted = |pivot: f64, diagonal: f64| match rule {
            PivotRule::Refuse(part) => (pivot > part * diagonal).then_some((pivot, 1.0)),
            PivotRule::Raise(least) => Some((pivot.max(least), 1.0)),
        };
        run_widest(Decomposition { symbolic: &self.symbolic, values: &mut self.values, accepted })?;
        Some(SparseCholesky { symbolic: self.symbolic, values: self.values })
    }

    /// Returns the decomposition `L D Lᵀ` of a matrix that need not be positive definite, without pivoting. `None` if a pivot
    /// is so small beside its diagonal entry that rounding decides its sign.
    pub fn indefinite(mut self) -> Option<SparseIndefinite> {
        let accepted = |pivot: f64, diagonal: f64| {
            (pivot.abs() > INERTIA_PIVOT * diagonal.abs()).then(|| (pivot.abs(), pivot.signum()))
        };
        let work = Decomposition { symbolic: &self.symbolic, values: &mut self.values, accepted };
        let signs = run_widest(work)?;
        Some(SparseIndefinite {
            factor: SparseCholesky { symbolic: self.symbolic, values: self.values },
            signs,
        })
    }
}

/// The decomposition of a matrix in place as `L D Lᵀ` with D of ones and minus ones, which it returns.
struct Decomposition<'a, F> {
    symbolic: &'a SymbolicFactor,
    values: &'a mut [f64],
    /// Gives from a pivot and the diagonal entry that it comes from the size of the pivot and its sign, or `None` to refuse it.
    accepted: F,
}

impl<F: Fn(f64, f64) -> Option<(f64, f64)>> WideWork for Decomposition<'_, F> {
    type Output = Option<Vec<f64>>;

    #[inline(always)]
    fn run(self) -> Option<Vec<f64>> {
        let Decomposition { symbolic, values, accepted } = self;
        decompose(symbolic, values, accepted)
    }
}

/// Decomposes as [`Decomposition`] says, with the instructions that its caller is compiled for.
#[inline(always)]
fn decompose(
    symbolic: &SymbolicFactor,
    values: &mut [f64],
    accepted: impl Fn(f64, f64) -> Option<(f64, f64)>,
) -> Option<Vec<f64>> {
    let size = symbolic.size;
    let diagonal = diagonal(symbolic, values);
    let mut signs = vec![1.0; diagonal.len()];
    let mut update = Vec::new();
    let mut packed = PackedRows::default();
    for supernode in &symbolic.supernodes {
        let (width, height) = (size * supernode.count, size * supernode.height());
        let columns = size * supernode.first..size * supernode.first + width;
        let signs = &mut signs[columns.clone()];
        let diagonal = &diagonal[columns];
        let (before, after) = values.split_at_mut(supernode.start + width * height);
        let panel = &mut before[supernode.start..];
        for first in (0..width).step_by(PANEL) {
            let end = width.min(first + PANEL);
            for block in (first..end).step_by(BLOCK) {
                // Three products are summed at a time, but for those of columns of the same block.
                for column in block..end.min(block + BLOCK) {
                    let (done, rest) = panel.split_at_mut(column * height);
                    let own = &mut rest[column..height];
                    let (before, beside) = done[first * height..].split_at((block - first) * height);
                    subtract(own, before, (height, column, column), &signs[first..]);
                    subtract(own, beside, (height, column, column), &signs[block..]);
                    let (pivot, sign) = accepted(own[0], diagonal[column])?;
                    let root = pivot.sqrt();
                    signs[column] = sign;
                    own[0] = root;
                    let part = sign / root;
                    own[1..].iter_mut().for_each(|value| *value *= part);
                }
            }
            let (done, rest) = panel.split_at_mut(end * height);
            if end < width {
                let (target, done) = (&mut rest[end..], &done[first * height..]);
                let signs = &signs[first..end];
                subtract_products((target, height), width - end, done, (height, end), signs, &mut packed);
            }
        }
        // Its products change the columns of its rows.
        let below = height - width;
        update.clear();
        update.resize(below * below, 0.0);
        subtract_products((&mut update, below), below, panel, (height, width), signs, &mut packed);
        let end = supernode.start + width * height;
        scatter(symbolic, supernode, &update, after, end);
    }
    Some(signs)
}

/// Returns the diagonal of the matrix, by places.
fn diagonal(symbolic: &SymbolicFactor, values: &[f64]) -> Vec<f64> {
    let of = |supernode: &Supernode| {
        let height = symbolic.size * supernode.height();
        let start = supernode.start;
        (0..symbolic.size * supernode.count).map(move |column| start + column * (height + 1))
    };
    symbolic.supernodes.iter().flat_map(of).map(|index| values[index]).collect()
}

/// Adds the lower half of a matrix over the rows of a supernode to the columns of those rows, in the supernodes after it,
/// whose values are `after`, from the index `offset`.
#[inline(always)]
fn scatter(
    symbolic: &SymbolicFactor,
    supernode: &Supernode,
    update: &[f64],
    after: &mut [f64],
    offset: usize,
) {
    let (size, rows) = (symbolic.size, &supernode.rows);
    let below = size * rows.len();
    // Runs of rows that stand together in the target: (row in the update, row in the target, rows).
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    let mut at = 0;
    while at < rows.len() {
        let target = &symbolic.supernodes[symbolic.owner[rows[at]]];
        let stride = size * target.height();
        runs.clear();
        let mut to: usize = 0;
        for (from, &place) in rows.iter().enumerate().skip(at) {
            // Rows ascend, and so do those of the target.
            if place < target.first + target.count {
                to = place - target.first;
            } else {
                let below = &target.rows[to.saturating_sub(target.count)..];
                to = to.max(target.count) + below.iter().position(|row| *row == place).unwrap_or(0);
            }
            match runs.last_mut() {
                Some((_, last, count)) if *last + *count == size * to => *count += size,
                _ => runs.push((size * from, size * to, size)),
            }
        }
        let mine = rows[at..].iter().take_while(|row| **row < target.first + target.count).count();
        for column in at..at + mine {
            let to = (rows[column] - target.first) * size;
            for k in 0..size {
                let source = &update[(size * column + k) * below..(size * column + k + 1) * below];
                let index = target.start - offset + (to + k) * stride;
                let goal = &mut after[index..index + stride];
                for &(from, to, count) in &runs {
                    // The upper half of the update is zero.
                    let (source, goal) = (&source[from..from + count], &mut goal[to..to + count]);
                    goal.iter_mut().zip(source).for_each(|(value, change)| *value += change);
                }
            }
        }
        at += mine;
    }
}

impl SparseCholesky {
    /// Returns the number of rows.
    pub fn size(&self) -> usize {
        self.symbolic.size * self.symbolic.blocks()
    }

    /// Returns the values of a supernode, the number of its columns and that of its rows.
    fn panel(&self, supernode: &Supernode) -> (&[f64], usize, usize) {
        let size = self.symbolic.size;
        let (width, height) = (size * supernode.count, size * supernode.height());
        (&self.values[supernode.start..supernode.start + width * height], width, height)
    }

    /// Returns `P x`: the entries of a vector in the order of the factor.
    pub fn permuted(&self, x: &[f64]) -> Vec<f64> {
        let size = self.symbolic.size;
        self.symbolic.order.iter().flat_map(|block| &x[size * block..size * (block + 1)]).copied().collect()
    }

    /// Returns `Pᵀ y`: the entries of a vector in the order of the matrix.
    pub fn restored(&self, y: &[f64]) -> Vec<f64> {
        let size = self.symbolic.size;
        self.symbolic.place.iter().flat_map(|at| &y[size * at..size * (at + 1)]).copied().collect()
    }

    /// Replaces `y`, in the order of the factor, by `L⁻¹ y` (forward substitution). Supernodes where y is zero cost
    /// nothing.
    pub fn solve_lower(&self, y: &mut [f64]) {
        let size = self.symbolic.size;
        let mut below = Vec::new();
        for supernode in &self.symbolic.supernodes {
            let (panel, width, height) = self.panel(supernode);
            let first = size * supernode.first;
            if y[first..first + width].iter().all(|value| *value == 0.0) {
                continue;
            }
            below.clear();
            below.resize(height - width, 0.0);
            for (k, column) in panel.chunks_exact(height).enumerate() {
                let value = y[first + k] / column[k];
                y[first + k] = value;
                if value != 0.0 {
                    let own = &mut y[first + k + 1..first + width];
                    own.iter_mut().zip(&column[k + 1..]).for_each(|(y, l)| *y -= l * value);
                    below.iter_mut().zip(&column[width..]).for_each(|(y, l)| *y -= l * value);
                }
            }
            for (row, change) in supernode.rows.iter().zip(below.chunks_exact(size)) {
                y[size * row..size * (row + 1)].iter_mut().zip(change).for_each(|(y, c)| *y += c);
            }
        }
    }

    /// Replaces `y`, in the order of the factor, by `L⁻ᵀ y` (backward substitution).
    pub fn solve_upper(&self, y: &mut [f64]) {
        let size = self.symbolic.size;
        let mut below = Vec::new();
        for supernode in self.symbolic.supernodes.iter().rev() {
            let (panel, width, height) = self.panel(supernode);
            let first = size * supernode.first;
            below.clear();
            below.extend(supernode.rows.iter().flat_map(|row| &y[size * row..size * (row + 1)]));
            for (k, column) in panel.chunks_exact(height).enumerate().rev() {
                let own = four_lanes(&column[k + 1..width], &y[first + k + 1..first + width]);
                let rest = four_lanes(&column[width..], &below);
                y[first + k] = (y[first + k] - own - rest) / column[k];
            }
        }
    }

    /// Replaces `y`, in the order of the factor, by the solution of `P A Pᵀ x = y`.
    pub fn solve_permuted(&self, y: &mut [f64]) {
        self.solve_lower(y);
        self.solve_upper(y);
    }

    /// Replaces the columns of `y`, whose rows are in the order of the factor, by the solutions of `P A Pᵀ x = y`.
    pub fn solve_columns<const N: usize>(&self, y: &mut [[f64; N]]) {
        run_widest(Solution { factor: self, signs: None, y });
    }

    /// Replaces the columns of `y`, whose rows are in the order of the factor, by those of `L⁻¹ y`. Supernodes where all are zero
    /// cost nothing.
    pub fn solve_lower_columns<const N: usize>(&self, y: &mut [[f64; N]]) {
        run_widest(LowerSolution { factor: self, y });
    }

    /// Replaces the right side `b` by the solution x of `A x = b`.
    pub fn solve(&self, b: &mut [f64]) {
        let mut y = self.permuted(b);
        self.solve_permuted(&mut y);
        b.copy_from_slice(&self.restored(&y));
    }
}

/// The columns of `L⁻¹ y`, which replace those of `y`.
struct LowerSolution<'a, const N: usize> {
    factor: &'a SparseCholesky,
    y: &'a mut [[f64; N]],
}

impl<const N: usize> WideWork for LowerSolution<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let LowerSolution { factor, y } = self;
        lower_columns(factor, y);
    }
}

/// Replaces the columns of `y` by those of `L⁻¹ y`, with the instructions that its caller is compiled for.
#[inline(always)]
fn lower_columns<const N: usize>(factor: &SparseCholesky, y: &mut [[f64; N]]) {
    let size = factor.symbolic.size;
    let mut below: Vec<[f64; N]> = Vec::new();
    for supernode in &factor.symbolic.supernodes {
        let (panel, width, height) = factor.panel(supernode);
        let first = size * supernode.first;
        if y[first..first + width].iter().flatten().all(|value| *value == 0.0) {
            continue;
        }
        below.clear();
        below.resize(height - width, [0.0; N]);
        for (k, column) in panel.chunks_exact(height).enumerate() {
            let value = y[first + k].map(|value| value / column[k]);
            y[first + k] = value;
            let own = &mut y[first + k + 1..first + width];
            let rows = own.iter_mut().chain(&mut below);
            rows.zip(&column[k + 1..]).for_each(|(y, l)| {
                y.iter_mut().zip(&value).for_each(|(y, value)| *y -= l * value);
            });
        }
        for (row, change) in supernode.rows.iter().zip(below.chunks_exact(size)) {
            for (y, change) in y[size * row..size * (row + 1)].iter_mut().zip(change) {
                y.iter_mut().zip(change).for_each(|(y, change)| *y += change);
            }
        }
    }
}

/// The solution of systems with the same factor, for the columns of `y`, which they replace.
struct Solution<'a, const N: usize> {
    factor: &'a SparseCholesky,
    /// The entries of D; `None` for ones.
    signs: Option<&'a [f64]>,
    y: &'a mut [[f64; N]],
}

impl<const N: usize> WideWork for Solution<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Solution { factor, signs, y } = self;
        let size = factor.symbolic.size;
        lower_columns(factor, y);
        if let Some(signs) = signs {
            y.iter_mut().zip(signs).for_each(|(row, sign)| row.iter_mut().for_each(|value| *value *= sign));
        }
        let mut below: Vec<[f64; N]> = Vec::new();
        for supernode in factor.symbolic.supernodes.iter().rev() {
            let (panel, width, height) = factor.panel(supernode);
            let first = size * supernode.first;
            below.clear();
            below.extend(supernode.rows.iter().flat_map(|row| &y[size * row..size * (row + 1)]));
            for (k, column) in panel.chunks_exact(height).enumerate().rev() {
                let mut sums = y[first + k];
                let rows = y[first + k + 1..first + width].iter().chain(&below);
                rows.zip(&column[k + 1..]).for_each(|(y, l)| {
                    sums.iter_mut().zip(y).for_each(|(sum, y)| *sum -= l * y);
                });
                y[first + k] = sums.map(|sum| sum / column[k]);
            }
        }
    }
}
