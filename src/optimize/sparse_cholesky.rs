//! Cholesky's decomposition of sparse symmetric matrices in an order of little fill, by supernodes: the columns of each are
//! decomposed together as a dense matrix, and what they change in later ones is subtracted at once (Duff and Reid 1983).
//!
//! Every sum is over columns in their order, element by element, so that it does not depend on how many elements a
//! processor adds at a time.

use super::cholesky::{PivotRule, four_lanes};
use super::panel_products::{Lower, PackedRows, subtract, subtract_products};
use super::supernodes::{Slot, Supernode, SymbolicFactor};
use super::wide::{WideWork, run_widest};
use crate::interrupt::second_thread;
use nalgebra::Matrix3;
use std::ops::Range;
use std::sync::Arc;

/// Threshold: the part of its diagonal entry, without unit, below which the sign of a pivot is not trusted.
const INERTIA_PIVOT: f64 = 1e-12;

/// The number of columns that are decomposed before the later ones of their supernode are changed.
const PANEL: usize = 48;
/// The number of columns of a panel that are decomposed before its later ones are changed, by which [`PANEL`] is divisible.
const STRIP: usize = 12;
/// The number of columns whose products are summed together, by which [`STRIP`] is divisible.
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
        decompose(&self.symbolic, &mut self.values, accepted)?;
        Some(SparseCholesky { symbolic: self.symbolic, values: self.values })
    }

    /// Returns the decomposition `L D Lᵀ` of a matrix that need not be positive definite, without pivoting. `None` if a pivot
    /// is so small beside its diagonal entry that rounding decides its sign.
    pub fn indefinite(mut self) -> Option<SparseIndefinite> {
        let accepted = |pivot: f64, diagonal: f64| {
            (pivot.abs() > INERTIA_PIVOT * diagonal.abs()).then(|| (pivot.abs(), pivot.signum()))
        };
        let signs = decompose(&self.symbolic, &mut self.values, accepted)?;
        let factor = SparseCholesky { symbolic: self.symbolic, values: self.values };
        Some(SparseIndefinite { factor, signs })
    }
}

/// Decomposes the values of a matrix in place as `L D Lᵀ` with D of ones and minus ones, which it returns. `accepted` gives from a
/// pivot and the diagonal entry that it comes from the size of the pivot and its sign, or `None` to refuse it.
fn decompose(
    symbolic: &SymbolicFactor,
    values: &mut [f64],
    accepted: impl Fn(f64, f64) -> Option<(f64, f64)> + Sync,
) -> Option<Vec<f64>> {
    let diagonal = &diagonal(symbolic, values)[..];
    let mut signs = vec![1.0; diagonal.len()];
    let accepted = &accepted;
    let all = symbolic.supernodes.len();
    let Some([one, other]) = symbolic.halves.clone() else {
        let (supernodes, later) = (0..all, &mut [][..]);
        run_widest(Stretch { symbolic, supernodes, values, later, diagonal, signs: &mut signs, accepted })?;
        return Some(signs);
    };
    let rest = other.end..all;
    let (values, values_of_rest) = values.split_at_mut(symbolic.first_value(rest.start));
    let (values_of_one, values_of_other) = values.split_at_mut(symbolic.first_value(other.start));
    let (signs_of_halves, signs_of_rest) = signs.split_at_mut(symbolic.first_column(rest.start));
    let (signs_of_one, signs_of_other) = signs_of_halves.split_at_mut(symbolic.first_column(other.start));
    // The sums of what the second half subtracts from the rest stand by themselves, on any number of threads.
    let mut subtracted = vec![0.0; values_of_rest.len()];
    let of_one = Stretch {
        symbolic,
        supernodes: one,
        values: values_of_one,
        later: values_of_rest,
        diagonal,
        signs: signs_of_one,
        accepted,
    };
    let of_other = Stretch {
        symbolic,
        supernodes: other,
        values: values_of_other,
        later: &mut subtracted,
        diagonal,
        signs: signs_of_other,
        accepted,
    };
    let (done, also_done) = second_thread::both(|| run_widest(of_one), || run_widest(of_other));
    done.and(also_done)?;
    values_of_rest.iter_mut().zip(&subtracted).for_each(|(value, change)| *value += change);
    run_widest(Stretch {
        symbolic,
        supernodes: rest,
        values: values_of_rest,
        later: &mut [],
        diagonal,
        signs: signs_of_rest,
        accepted,
    })?;
    Some(signs)
}

/// Consecutive supernodes of a matrix that is being decomposed. Of those before them none changes them any more.
struct Stretch<'a, F> {
    symbolic: &'a SymbolicFactor,
    /// The indices of the supernodes.
    supernodes: Range<usize>,
    /// Their values.
    values: &'a mut [f64],
    /// The values of the supernodes after both halves, or sums of changes that are added to these later.
    later: &'a mut [f64],
    /// The diagonal of the whole matrix, by columns.
    diagonal: &'a [f64],
    /// The entries of D in their columns.
    signs: &'a mut [f64],
    /// The rule for pivots, as [`decompose`] has it.
    accepted: &'a F,
}

impl<F: Fn(f64, f64) -> Option<(f64, f64)>> WideWork for Stretch<'_, F> {
    type Output = Option<()>;

    /// Decomposes the supernodes; `None` if a pivot is refused.
    #[inline(always)]
    fn run(self) -> Option<()> {
        let Stretch { symbolic, supernodes: range, values, later, diagonal, signs, accepted } = self;
        let size = symbolic.size;
        let (first_column, first_value) =
            (symbolic.first_column(range.start), symbolic.first_value(range.start));
        let supernodes = &symbolic.supernodes[range.clone()];
        let below = |supernode: &Supernode| size * supernode.rows.len();
        let most = supernodes.iter().map(below).max().unwrap_or(0);
        // Its upper half is never read.
        let mut update = vec![0.0; most * most];
        let mut packed = PackedRows::default();
        let later_begin = symbolic.entries - later.len();
        for supernode in supernodes {
            let (width, height) = (size * supernode.count, size * supernode.height());
            let first = size * supernode.first;
            let signs = &mut signs[first - first_column..first - first_column + width];
            let diagonal = &diagonal[first..first + width];
            let start = supernode.start - first_value;
            let (before, after) = values.split_at_mut(start + width * height);
            let panel = &mut before[start..];
            for first in (0..width).step_by(PANEL) {
                let end = width.min(first + PANEL);
                for strip in (first..end).step_by(STRIP) {
                    let strip_end = end.min(strip + STRIP);
                    decompose_strip(panel, height, strip..strip_end, (signs, diagonal), accepted)?;
                    subtract_columns(panel, height, strip..strip_end, end, signs, &mut packed);
                }
                subtract_columns(panel, height, first..end, width, signs, &mut packed);
            }
            // Its products change the columns of its rows.
            let below = height - width;
            let entries = &mut update[..below * below];
            let target = Lower { entries, stride: below, is_fresh: true };
            subtract_products(target, below, panel, (height, width), signs, &mut packed);
            let mut targets = Targets {
                after,
                begin: supernode.start + width * height,
                later: &mut *later,
                later_begin,
                end: range.end,
            };
            scatter(symbolic, supernode, &update[..below * below], &mut targets);
        }
        Some(())
    }
}

/// Decomposes some columns of a panel of a height, from which the products of those before them are subtracted already; `signs` become
/// theirs. `None` if a pivot is refused.
#[inline(always)]
fn decompose_strip(
    panel: &mut [f64],
    height: usize,
    strip: Range<usize>,
    (signs, diagonal): (&mut [f64], &[f64]),
    accepted: &impl Fn(f64, f64) -> Option<(f64, f64)>,
) -> Option<()> {
    for block in strip.clone().step_by(BLOCK) {
        // Three products are summed at a time, but for those of columns of the same block.
        for column in block..strip.end.min(block + BLOCK) {
            let (done, rest) = panel.split_at_mut(column * height);
            let own = &mut rest[column..height];
            let (before, beside) = done[strip.start * height..].split_at((block - strip.start) * height);
            subtract(own, before, (height, column, column), &signs[strip.start..]);
            subtract(own, beside, (height, column, column), &signs[block..]);
            let (pivot, sign) = accepted(own[0], diagonal[column])?;
            let root = pivot.sqrt();
            signs[column] = sign;
            own[0] = root;
            let part = sign / root;
            own[1..].iter_mut().for_each(|value| *value *= part);
        }
    }
    Some(())
}

/// Subtracts the products of the columns `of` of a panel of a height from those between them and the column `end`.
#[inline(always)]
fn subtract_columns(
    panel: &mut [f64],
    height: usize,
    of: Range<usize>,
    end: usize,
    signs: &[f64],
    packed: &mut PackedRows,
) {
    let (done, rest) = panel.split_at_mut(of.end * height);
    if of.end < end {
        let target = Lower { entries: &mut rest[of.end..], stride: height, is_fresh: false };
        let (done, signs) = (&done[of.start * height..], &signs[of.clone()]);
        subtract_products(target, end - of.end, done, (height, of.end), signs, packed);
    }
}

/// The values of the supernodes that one changes.
struct Targets<'a> {
    /// The values of the supernodes after it in its stretch, and the index of the first of them.
    after: &'a mut [f64],
    begin: usize,
    /// Those of supernodes after the stretch, and the index of the first of them.
    later: &'a mut [f64],
    later_begin: usize,
    /// The index of the first supernode after the stretch.
    end: usize,
}

/// Returns the diagonal of the matrix, by columns.
fn diagonal(symbolic: &SymbolicFactor, values: &[f64]) -> Vec<f64> {
    let of = |supernode: &Supernode| {
        let height = symbolic.size * supernode.height();
        let start = supernode.start;
        (0..symbolic.size * supernode.count).map(move |column| start + column * (height + 1))
    };
    symbolic.supernodes.iter().flat_map(of).map(|index| values[index]).collect()
}

/// Adds the lower half of a matrix over the rows of a supernode to the columns of those rows, in the supernodes after it.
#[inline(always)]
fn scatter(symbolic: &SymbolicFactor, supernode: &Supernode, update: &[f64], targets: &mut Targets) {
    let (size, rows) = (symbolic.size, &supernode.rows);
    let below = size * rows.len();
    // Runs of rows that stand together in the target: (row in the update, row in the target, rows).
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    let mut at = 0;
    while at < rows.len() {
        let owner = symbolic.owner[rows[at]];
        let target = &symbolic.supernodes[owner];
        let stride = size * target.height();
        let (values, begin) = match owner < targets.end {
            true => (&mut *targets.after, targets.begin),
            false => (&mut *targets.later, targets.later_begin),
        };
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
        for (column, place) in rows.iter().enumerate().skip(at).take(mine) {
            let to = (place - target.first) * size;
            for k in 0..size {
                let row = size * column + k;
                let source = &update[row * below..(row + 1) * below];
                let index = target.start - begin + (to + k) * stride;
                let goal = &mut values[index..index + stride];
                for &(from, to, count) in &runs {
                    let above = row.saturating_sub(from).min(count);
                    let (source, goal) =
                        (&source[from + above..from + count], &mut goal[to + above..to + count]);
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
