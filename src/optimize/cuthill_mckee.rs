//! The order of Cuthill and McKee (1969): rows of a sparse symmetric matrix numbered so that entries keep near the
//! diagonal, in a narrow band or a small envelope.

/// Numbers the rows that are connected with row `start`, in the order of Cuthill and McKee (1969): breadth first; of
/// the neighbours of a row those with fewer neighbours come first, and of these those of smaller index. Appends their
/// indices, from 0, to `order` and marks them in `known`, which has a flag for every row, and where `start` must not
/// be marked yet. `neighbours` lists for each row the others with which it shares an entry, as [`neighbours()`] does.
/// Panics if an index is not less than the number of rows.
pub fn number_from(start: usize, neighbours: &[Vec<usize>], known: &mut [bool], order: &mut Vec<usize>) {
    known[start] = true;
    let mut at = order.len();
    order.push(start);
    while at < order.len() {
        let mut next: Vec<usize> = neighbours[order[at]].iter().copied().filter(|j| !known[*j]).collect();
        next.sort_by_key(|j| (neighbours[*j].len(), *j));
        next.iter().for_each(|j| known[*j] = true);
        order.extend(next);
        at += 1;
    }
}

/// Returns for each of n rows the others with which it shares an entry, ascending; `entries` are (row, column) on
/// either side of the diagonal, in any order and number. Panics if an index is not less than `n`.
pub fn neighbours(n: usize, entries: impl Iterator<Item = (usize, usize)>) -> Vec<Vec<usize>> {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); n];
    for (i, j) in entries.filter(|(i, j)| i != j) {
        neighbours[i].push(j);
        neighbours[j].push(i);
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    neighbours
}

/// Returns the rows of a symmetric matrix in the reverse order of Cuthill and McKee (George 1971): the entry at k is
/// the row that comes k-th. `n`: the number of rows; `entries`: as for [`neighbours`]. The band is that of the order
/// of Cuthill and McKee, and the envelope never larger. Every connected component ends at a row of fewest
/// neighbours. Panics if an index is not less than `n`.
pub fn reverse_order(n: usize, entries: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let neighbours = neighbours(n, entries);
    let mut order = Vec::with_capacity(n);
    let mut known = vec![false; n];
    let mut by_degree: Vec<usize> = (0..n).collect();
    by_degree.sort_by_key(|i| (neighbours[*i].len(), *i));
    for start in by_degree {
        if !known[start] {
            number_from(start, &neighbours, &mut known, &mut order);
        }
    }
    order.reverse();
    order
}
