//! Cholesky's factors of symmetric positive definite matrices, kept within the envelope of the rows.

/// A pivot below this part of the diagonal's entry means that the matrix is not positive definite.
const PIVOT_MIN: f64 = 1e-14;

/// `L Lᵀ = P H Pᵀ`. Each row of L from its first entry on; the order P keeps the rows short.
pub struct Factor {
    /// The row of L for each of H, and back.
    place: Vec<usize>,
    from: Vec<usize>,
    first: Vec<usize>,
    rows: Vec<Vec<f64>>,
}

impl Factor {
    /// Of H what is on and above the diagonal, or below; entries at one place are summed. `None` if it is
    /// not positive definite, or takes more multiplications than allowed.
    pub fn new(n: usize, entries: &[(usize, usize, f64)], work_max: usize) -> Option<Factor> {
        let from = order(n, entries);
        let mut place = vec![0; n];
        from.iter().enumerate().for_each(|(at, i)| place[*i] = at);
        let mut first: Vec<usize> = (0..n).collect();
        let lower = |&(i, j, v): &(usize, usize, f64)| {
            let (a, b) = (place[i], place[j]);
            (a.max(b), a.min(b), v)
        };
        for (row, column, _) in entries.iter().map(lower) {
            first[row] = first[row].min(column);
        }
        let work: usize = first.iter().enumerate().map(|(i, first)| (i - first) * (i - first)).sum();
        if work / 2 > work_max {
            return None;
        }
        let mut rows: Vec<Vec<f64>> =
            first.iter().enumerate().map(|(i, first)| vec![0.0; i + 1 - first]).collect();
        for (row, column, value) in entries.iter().map(lower) {
            rows[row][column - first[row]] += value;
        }
        for i in 0..n {
            let (done, rest) = rows.split_at_mut(i);
            let row = &mut rest[0];
            let from = first[i];
            for j in from..i {
                let other = &done[j];
                let common = from.max(first[j]);
                let sum = dot(&row[common - from..j - from], &other[common - first[j]..j - first[j]]);
                row[j - from] = (row[j - from] - sum) / other[j - first[j]];
            }
            let (last, before) = row.split_last_mut()?;
            let pivot = *last - dot(before, before);
            if pivot.is_nan() || pivot <= PIVOT_MIN * *last {
                return None;
            }
            *last = pivot.sqrt();
        }
        Some(Factor { place, from, first, rows })
    }

    /// `y = L⁻¹ P x`, in place.
    pub fn forward(&self, x: &mut [f64]) {
        let mut y: Vec<f64> = self.from.iter().map(|i| x[*i]).collect();
        let begin = y.iter().position(|value| *value != 0.0).unwrap_or(y.len());
        for i in begin..y.len() {
            let first = self.first[i].max(begin);
            let row = &self.rows[i][first - self.first[i]..];
            let Some((pivot, row)) = row.split_last() else { continue };
            y[i] = (y[i] - dot(row, &y[first..i])) / pivot;
        }
        x.copy_from_slice(&y);
    }

    /// `x = Pᵀ L⁻ᵀ y`, in place.
    pub fn back(&self, y: &mut [f64]) {
        for i in (0..y.len()).rev() {
            let Some((pivot, row)) = self.rows[i].split_last() else { continue };
            let value = y[i] / pivot;
            y[i] = value;
            y[self.first[i]..i].iter_mut().zip(row).for_each(|(x, l)| *x -= l * value);
        }
        let x: Vec<f64> = self.place.iter().map(|at| y[*at]).collect();
        y.copy_from_slice(&x);
    }
}

/// Four sums side by side, which a processor adds at once.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    sums[0] + sums[1] + (sums[2] + sums[3]) + rest
}

/// Reverse Cuthill and McKee: from a row of few neighbours outwards, so that neighbours stay near.
fn order(n: usize, entries: &[(usize, usize, f64)]) -> Vec<usize> {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); n];
    for &(i, j, _) in entries.iter().filter(|(i, j, _)| i != j) {
        neighbours[i].push(j);
        neighbours[j].push(i);
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    let mut found = Vec::with_capacity(n);
    let mut known = vec![false; n];
    let mut by_degree: Vec<usize> = (0..n).collect();
    by_degree.sort_by_key(|i| (neighbours[*i].len(), *i));
    for start in by_degree {
        if known[start] {
            continue;
        }
        known[start] = true;
        let mut at = found.len();
        found.push(start);
        while at < found.len() {
            let mut next: Vec<usize> = neighbours[found[at]].iter().copied().filter(|j| !known[*j]).collect();
            next.sort_by_key(|j| (neighbours[*j].len(), *j));
            next.iter().for_each(|j| known[*j] = true);
            found.extend(next);
            at += 1;
        }
    }
    found.reverse();
    found
}
