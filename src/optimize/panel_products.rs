//! Products of the columns of a dense panel, subtracted from lower parts of columns: the inner loop of the sparse
//! decomposition. Sums go over the columns of the panel in their order, three products at a time, whatever the number of
//! rows that a processor handles at once.

/// The number of columns that are changed together, so that each entry of the panel is loaded once for all of them.
pub(super) const BLOCK: usize = 3;
/// The number of rows that are changed together.
const ROWS: usize = 8;

/// Subtracts from the lower parts of at most [`BLOCK`] columns next to each other, the first of them from row `row` of the
/// panel on and each later one from a row further down, the products of the columns of a panel of this height with their
/// own entries in the first row of each part and with their signs. `block` begins with the first entry of the first part and
/// ends with the last entry of the last one; its columns stand `stride` apart. `factors` is room to work in.
#[inline(always)]
pub(super) fn subtract_block(
    (block, stride): (&mut [f64], usize),
    panel: &[f64],
    (height, row): (usize, usize),
    signs: &[f64],
    factors: &mut Vec<[f64; BLOCK]>,
) {
    let count = block.len().div_ceil(stride);
    let rows = block.len() - (count - 1) * stride;
    if panel.is_empty() {
        return;
    }
    if count < BLOCK || rows < BLOCK + ROWS {
        for (t, column) in block.chunks_mut(stride).enumerate() {
            subtract(&mut column[t..rows], panel, (height, row + t, row + t), signs);
        }
        return;
    }
    let (first, rest) = block.split_at_mut(stride);
    let (second, third) = rest.split_at_mut(stride);
    let mut columns = [&mut first[..rows], &mut second[..rows], &mut third[..rows]];
    for (t, column) in columns.iter_mut().enumerate() {
        subtract(&mut column[t..BLOCK], panel, (height, row + t, row + t), signs);
    }
    factors.clear();
    let own = panel.chunks_exact(height).zip(signs);
    factors.extend(own.map(|(column, sign)| std::array::from_fn(|t| column[row + t] * sign)));
    let mut at = BLOCK;
    while at + ROWS <= rows {
        let own: [&mut [f64; ROWS]; BLOCK] =
            columns.each_mut().map(|column| column[at..].first_chunk_mut().expect("there are as many rows"));
        subtract_tile(own, panel, (height, row + at), factors);
        at += ROWS;
    }
    for (t, column) in columns.iter_mut().enumerate() {
        subtract(&mut column[at..], panel, (height, row + at, row + t), signs);
    }
}

/// Subtracts from some rows of columns, the first of them row `row` of the panel, the products of the panel's columns with
/// these factors, one for each column of the panel and each that is changed.
#[inline(always)]
fn subtract_tile(
    own: [&mut [f64; ROWS]; BLOCK],
    panel: &[f64],
    (height, row): (usize, usize),
    factors: &[[f64; BLOCK]],
) {
    let mut sums = own.each_ref().map(|column| **column);
    let rows_of =
        |column: &[f64]| -> [f64; ROWS] { *column[row..].first_chunk().expect("the panel has as many rows") };
    let (threes, threes_factors) = (panel.chunks_exact(3 * height), factors.chunks_exact(3));
    let tails = threes.remainder().chunks_exact(height).zip(threes_factors.remainder());
    for (columns, factors) in threes.zip(threes_factors) {
        let a = rows_of(&columns[..height]);
        let b = rows_of(&columns[height..2 * height]);
        let c = rows_of(&columns[2 * height..]);
        for (t, sum) in sums.iter_mut().enumerate() {
            let (p, q, r) = (factors[0][t], factors[1][t], factors[2][t]);
            for i in 0..ROWS {
                sum[i] -= p * a[i] + q * b[i] + r * c[i];
            }
        }
    }
    for (column, factors) in tails {
        let a = rows_of(column);
        for (sum, p) in sums.iter_mut().zip(factors) {
            for i in 0..ROWS {
                sum[i] -= p * a[i];
            }
        }
    }
    own.into_iter().zip(sums).for_each(|(own, sum)| *own = sum);
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
