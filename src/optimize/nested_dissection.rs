//! Nested dissection (George 1973): an order of elimination of little fill for large sparse symmetric matrices, whose graph is
//! cut by small sets of rows again and again; each set comes after the two parts between which it stands.

use super::minimum_degree::minimum_degree_in_groups;
use std::cmp::Reverse;
use std::collections::VecDeque;

/// The number of rows of a part that is not cut any more: minimum degree is as good there.
const PART_MAX: usize = 60;
/// The least fraction of the rows of a part that may be on one side of a cut.
const SIDE_MIN: f64 = 0.3;
/// The number of ends of a part.
const ENDS: usize = 4;
/// The sums of distances from the ends of a part by which it is cut: from one of them, between two, and between two pairs, which are
/// like the edges of a tetrahedron that do not meet.
const SUMS: [[isize; ENDS]; 13] = [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [0, 0, 1, 0],
    [0, 0, 0, 1],
    [1, -1, 0, 0],
    [1, 0, -1, 0],
    [1, 0, 0, -1],
    [0, 1, -1, 0],
    [0, 1, 0, -1],
    [0, 0, 1, -1],
    [1, 1, -1, -1],
    [1, -1, 1, -1],
    [1, -1, -1, 1],
];

/// Returns the rows of a symmetric matrix in an order of elimination that fills little: by nested dissection, and in order
/// of minimum degree within each part and each cut. `neighbours` lists for each row the others with which it shares an
/// entry, as [`neighbours`](super::cuthill_mckee::neighbours) does. Panics if an index is not less than the number of
/// rows.
pub fn nested_dissection(neighbours: &[Vec<usize>]) -> Vec<usize> {
    let count = neighbours.len();
    let mut dissection = Dissection {
        neighbours,
        part: vec![0; count],
        parts: 1,
        groups: Vec::new(),
        levels: vec![[0; ENDS]; count],
    };
    dissection.dissect((0..count).collect());
    minimum_degree_in_groups(neighbours, &dissection.groups)
}

struct Dissection<'a> {
    neighbours: &'a [Vec<usize>],
    /// The number of the part to which each row belongs now.
    part: Vec<usize>,
    /// The number of parts there have been.
    parts: usize,
    /// The parts that are not cut any more, and the cuts, in the order of elimination.
    groups: Vec<Vec<usize>>,
    /// The distances of each row from the ends of its part.
    levels: Vec<[usize; ENDS]>,
}

impl Dissection<'_> {
    /// Orders the rows of a part.
    fn dissect(&mut self, rows: Vec<usize>) {
        if rows.len() <= PART_MAX {
            return self.groups.push(rows);
        }
        // The ends of the part, as far from each other as a few searches find.
        let (first, _) = self.search(rows[0], 0);
        let (second, _) = self.search(first, 0);
        let (_, reached) = self.search(second, 0);
        if reached.len() < rows.len() {
            let rest = rows.iter().copied().filter(|row| reached.binary_search(row).is_err()).collect();
            let (reached, rest) = (self.renamed(reached), self.renamed(rest));
            self.dissect(reached);
            return self.dissect(rest);
        }
        // The third was as far from the first two as many others.
        for (end, others) in [(1, &[0][..]), (2, &[0, 1]), (3, &[0, 1, 2]), (2, &[0, 1, 3])] {
            let next = self.farthest(&rows, others);
            self.search(next, end);
        }
        let Some((cut, sides)) = self.cut(&rows) else { return self.groups.push(rows) };
        let cut = self.renamed(cut);
        for side in sides {
            let side = self.renamed(side);
            self.dissect(side);
        }
        self.groups.push(cut);
    }

    /// Makes rows a part of their own, and returns them.
    fn renamed(&mut self, rows: Vec<usize>) -> Vec<usize> {
        rows.iter().for_each(|row| self.part[*row] = self.parts);
        self.parts += 1;
        rows
    }

    /// Searches the part of a row from there, breadth first, and keeps the distances as those from one end. Returns the row
    /// reached last, and all in ascending order.
    fn search(&mut self, start: usize, end: usize) -> (usize, Vec<usize>) {
        let part = self.part[start];
        let mut reached = vec![false; self.neighbours.len()];
        let mut queue = VecDeque::from([start]);
        reached[start] = true;
        self.levels[start][end] = 0;
        let mut last = start;
        while let Some(row) = queue.pop_front() {
            last = row;
            for &next in &self.neighbours[row] {
                if self.part[next] == part && !std::mem::replace(&mut reached[next], true) {
                    self.levels[next][end] = self.levels[row][end] + 1;
                    queue.push_back(next);
                }
            }
        }
        (last, (0..reached.len()).filter(|row| reached[*row]).collect())
    }

    /// Returns the first of those rows of a part that are as far as any from the nearest of these ends.
    fn farthest(&self, rows: &[usize], ends: &[usize]) -> usize {
        let distance = |row: usize| ends.iter().map(|end| self.levels[row][*end]).min();
        rows.iter().copied().max_by_key(|row| (distance(*row), Reverse(*row))).expect("a part has rows")
    }

    /// Returns the smallest cut of a part by distances from its ends, with the two sides; `None` if there is none.
    fn cut(&self, rows: &[usize]) -> Option<(Vec<usize>, [Vec<usize>; 2])> {
        let mut best: Option<(f64, Vec<usize>, [Vec<usize>; 2])> = None;
        for sum in SUMS {
            let levels = |row: usize| self.levels[row].iter().map(|level| *level as isize);
            let key = |row: usize| -> isize { levels(row).zip(sum).map(|(level, sign)| level * sign).sum() };
            let mut values: Vec<isize> = rows.iter().map(|row| key(*row)).collect();
            values.sort_unstable();
            values.dedup();
            for value in values {
                let low: Vec<usize> = rows.iter().copied().filter(|row| key(*row) <= value).collect();
                let least = SIDE_MIN * rows.len() as f64;
                if (low.len() as f64) < least || ((rows.len() - low.len()) as f64) < least {
                    continue;
                }
                let part = self.part[rows[0]];
                for of_low in [true, false] {
                    let on_side = |row: usize| (key(row) <= value) == of_low;
                    let on_cut = |row: &usize| {
                        let beyond = |next: &usize| self.part[*next] == part && !on_side(*next);
                        on_side(*row) && self.neighbours[*row].iter().any(beyond)
                    };
                    let (cut, rest): (Vec<usize>, Vec<usize>) = rows.iter().partition(|row| on_cut(row));
                    let (low, high): (Vec<usize>, Vec<usize>) =
                        rest.into_iter().partition(|row| key(*row) <= value);
                    let uneven = low.len().abs_diff(high.len()) as f64 / rows.len() as f64;
                    let cost = cut.len() as f64 * (1.0 + uneven);
                    if best.as_ref().is_none_or(|(least, _, _)| cost < *least) {
                        best = Some((cost, cut, [low, high]));
                    }
                }
            }
        }
        best.map(|(_, cut, sides)| (cut, sides))
    }
}
