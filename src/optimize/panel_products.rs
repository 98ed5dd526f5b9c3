//! Products of the columns of a dense panel, subtracted from lower parts of columns: the inner loop of the sparse
//! decomposition. Sums go over the columns of the panel in their order, three products at a time, whatever the number of
//! rows that a processor handles at once.

/// The number of columns that are changed together.
const COLUMNS: usize = 3;
/// The number of rows that are changed together.
const ROWS: usize = 8;

/// Rows of a panel, copied in the order in which their products are summed: columns of a large panel are on pages of their own, of
/// which a processor knows few at a time.
#[derive(Default)]
pub(super) struct PackedRows {
    /// The entries of each block of as many rows as columns are changed together, with the signs of the panel's columns: one
    /// column of the panel after the other.
    factors: Vec<[f64; COLUMNS]>,
    /// The entries of a tile of rows, one column of the panel after the other.
    tile: Vec<[f64; ROWS]>,
}

impl PackedRows {
    /// Copies the rows of a panel from `row` on, as factors of so many columns; those that are not there are zeros.
    #[inline(always)]
    fn pack_factors(&mut self, panel: &[f64], (height, row): (usize, usize), columns: usize, signs: &[f64]) {
        self.factors.clear();
        self.factors.reserve(columns.div_ceil(COLUMNS) * signs.len());
        let end = row + columns;
        for first in (row..end).step_by(COLUMNS) {
            let last = end.min(first + COLUMNS);
            for (column, sign) in panel.chunks_exact(height).zip(signs) {
                let mut factors = [0.0; COLUMNS];
                match column[first..last].first_chunk::<COLUMNS>() {
                    Some(own) => (0..COLUMNS).for_each(|t| factors[t] = own[t] * sign),
                    None => factors.iter_mut().zip(&column[first..last]).for_each(|(f, own)| *f = own * sign),
                }
                self.factors.push(factors);
            }
        }
    }

    /// Copies a tile of rows of a panel, the first of them `row`; those beyond its end are zeros.
    #[inline(always)]
    fn pack_tile(&mut self, panel: &[f64], (height, row): (usize, usize)) {
        self.tile.clear();
        let columns = panel.chunks_exact(height).map(|column| &column[row..]);
        self.tile.extend(columns.map(|column| match column.first_chunk() {
            Some(rows) => *rows,
            None => std::array::from_fn(|i| column.get(i).copied().unwrap_or(0.0)),
        }));
    }
}

/// The lower half of a square matrix by columns, `stride` apart, from which products are subtracted; what is above the diagonal stays as
/// it is.
pub(super) struct Lower<'a> {
    /// The entries, from the first one on.
    pub entries: &'a mut [f64],
    pub stride: usize,
    /// True if the entries count as zeros; all of these columns are written.
    pub is_fresh: bool,
}

/// Subtracts from the first columns of the lower half of a matrix the products of the rows of a panel of this height from `row` on with
/// each other, the columns of the panel with their signs. The matrix has as many rows as the panel has from `row` on. `packed` is
/// room to work in.
#[inline(always)]
pub(super) fn subtract_products(
    target: Lower,
    columns: usize,
    panel: &[f64],
    (height, row): (usize, usize),
    signs: &[f64],
    packed: &mut PackedRows,
) {
    let Lower { entries, stride, is_fresh } = target;
    let (rows, width) = (height - row, panel.len() / height);
    if width == 0 || columns == 0 {
        return;
    }
    packed.pack_factors(panel, (height, row), columns, signs);
    for top in (0..rows).step_by(ROWS) {
        packed.pack_tile(panel, (height, row + top));
        let PackedRows { factors, tile } = &*packed;
        let bottom = rows.min(top + ROWS);
        for (first, factors) in (0..bottom).step_by(COLUMNS).zip(factors.chunks_exact(width)) {
            let mut sums = [[0.0; ROWS]; COLUMNS];
            if first + COLUMNS <= columns.min(top + 1) && top + ROWS <= rows {
                if !is_fresh {
                    for (t, sums) in sums.iter_mut().enumerate() {
                        let at = (first + t) * stride + top;
                        sums.copy_from_slice(&entries[at..at + ROWS]);
                    }
                }
                subtract_tile(&mut sums, tile, factors);
                for (t, sums) in sums.iter().enumerate() {
                    let at = (first + t) * stride + top;
                    entries[at..at + ROWS].copy_from_slice(sums);
                }
                continue;
            }
            // The tile is cut by the diagonal or the end of the matrix.
            let own = |column: usize| {
                let from = column.clamp(top, bottom);
                (from - top..bottom - top, column * stride + from..column * stride + bottom)
            };
            if !is_fresh {
                for (column, sums) in (first..columns).zip(&mut sums) {
                    let (rows, at) = own(column);
                    sums[rows].copy_from_slice(&entries[at]);
                }
            }
            subtract_tile(&mut sums, tile, factors);
            for (column, sums) in (first..columns).zip(&sums) {
                let (rows, at) = own(column);
                entries[at].copy_from_slice(&sums[rows]);
            }
        }
    }
}

/// Subtracts from the entries of a tile in some columns the products of the entries of the panel's columns in the same rows with
/// factors, one for each column of the panel and each that is changed.
#[inline(always)]
fn subtract_tile(target: &mut [[f64; ROWS]; COLUMNS], tile: &[[f64; ROWS]], factors: &[[f64; COLUMNS]]) {
    // A copy stays in registers.
    let mut sums = *target;
    let (threes, threes_factors) = (tile.chunks_exact(3), factors.chunks_exact(3));
    let tails = threes.remainder().iter().zip(threes_factors.remainder());
    for (rows, factors) in threes.zip(threes_factors) {
        for (t, sum) in sums.iter_mut().enumerate() {
            let (p, q, r) = (factors[0][t], factors[1][t], factors[2][t]);
            for i in 0..ROWS {
                sum[i] -= p * rows[0][i] + q * rows[1][i] + r * rows[2][i];
            }
        }
    }
    for (rows, factors) in tails {
        for (sum, p) in sums.iter_mut().zip(factors) {
            for i in 0..ROWS {
                sum[i] -= p * rows[i];
            }
        }
    }
    *target = sums;
}

/// Subtracts from a part of a column, which begins in row `row` of the panel, the products of the panel's columns with their
/// own entries in row `factor` and with their signs: three columns at a time, so that each entry is loaded and stored less
/// often.
#[inline(always)]
pub(super) fn subtract(
    own: &mut [f64],
    panel: &[f64],
    (height, row, factor): (usize, usize, usize),
    signs: &[f64],
) {
    let rows = row..row + own.len();
    let part = |column: &[f64], sign: f64| column[factor] * sign;
    let threes = panel.chunks_exact(3 * height);
    let tails = threes.remainder().chunks_exact(height);
    let signs_of_threes = signs.chunks_exact(3);
    let width = panel.len() / height;
    let tail_signs = &signs[width - width % 3..];
    for (columns, signs) in threes.zip(signs_of_threes) {
        let (a, rest) = columns.split_at(height);
        let (b, c) = rest.split_at(height);
        let [p, q, r] = [part(a, signs[0]), part(b, signs[1]), part(c, signs[2])];
        let (a, b, c) = (&a[rows.clone()], &b[rows.clone()], &c[rows.clone()]);
        for (((value, a), b), c) in own.iter_mut().zip(a).zip(b).zip(c) {
            *value -= p * a + q * b + r * c;
        }
    }
    for (column, sign) in tails.zip(tail_signs) {
        let p = part(column, *sign);
        own.iter_mut().zip(&column[rows.clone()]).for_each(|(value, a)| *value -= p * a);
    }
}
