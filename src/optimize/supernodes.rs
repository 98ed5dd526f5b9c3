//! The symbolic decomposition of sparse symmetric matrices: where the factor of Cholesky's decomposition has entries, by
//! supernodes, columns with entries in the same rows (Ng and Peyton 1993).

use super::nested_dissection::nested_dissection;
use std::ops::Range;

/// The part of a supernode's entries, without unit, that may be zeros where it is merged with its parent: longer columns
/// are worth more than that.
const ZEROS_MAX: f64 = 0.08;
/// The number of block columns up to which a supernode is merged with its parent whatever the zeros.
const COLUMNS_SMALL: usize = 4;

/// The number of multiplications of a decomposition that take as long as those of one entry of the factor in the solution of a
/// system, where entries are loaded from memory and used twice (`cargo bench --bench truss`).
const SOLUTION: f64 = 10.0;

/// The number of multiplications of a decomposition from which on two threads share it.
const WORK_MANY: usize = 2_000_000;
/// The least part of all multiplications that this must save.
const SAVED_MIN: f64 = 0.1;

/// The places of entries in the factor `L` of a sparse symmetric matrix, whose rows and columns come in blocks of equal
/// size, such as the coordinates of a node. Blocks are numbered from 0, and *places* are their numbers in the order in
/// which they are eliminated.
#[derive(Clone, Debug)]
pub struct SymbolicFactor {
    /// The number of rows of a block.
    pub(super) size: usize,
    /// The place of each block.
    pub(super) place: Vec<usize>,
    /// The block at each place.
    pub(super) order: Vec<usize>,
    pub(super) supernodes: Vec<Supernode>,
    /// The supernode of each place.
    pub(super) owner: Vec<usize>,
    /// The number of entries of the factor, with zeros.
    pub(super) entries: usize,
    /// The supernodes that two threads decompose at once, if there are many; none in the one half depends on one in the other.
    pub(super) halves: Option<[Range<usize>; 2]>,
}

/// The entries of a block in the values of a matrix: those of the block in the lower half of the permuted matrix.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    /// The index of the first entry.
    pub(super) index: usize,
    /// The distance of the columns.
    pub(super) stride: usize,
    /// True if rows and columns are exchanged.
    pub(super) transposed: bool,
}

/// Consecutive columns of blocks with entries in the same rows: a dense matrix by columns, its diagonal block first.
#[derive(Clone, Debug)]
pub(super) struct Supernode {
    /// The place of the first column.
    pub first: usize,
    /// The number of columns of blocks.
    pub count: usize,
    /// The places of the rows below the diagonal block, ascending.
    pub rows: Vec<usize>,
    /// The index of its first entry.
    pub start: usize,
}

impl Supernode {
    /// Returns the number of blocks in a column.
    pub(super) fn height(&self) -> usize {
        self.count + self.rows.len()
    }

    /// Returns the number of multiplications of its decomposition, to the leading order; `size`: the number of rows of a block.
    fn work(&self, size: usize) -> usize {
        let (width, height) = (size * self.count, size * self.height());
        (height + 1 - width..=height).map(|h| h * h).sum::<usize>() / 2
    }

    /// Returns the number of the row, in blocks from the top of the supernode, at a place that it has.
    pub(super) fn row(&self, place: usize) -> usize {
        if place < self.first + self.count {
            place - self.first
        } else {
            self.count + self.rows.partition_point(|row| *row < place)
        }
    }
}

impl SymbolicFactor {
    /// Returns the symbolic decomposition of a matrix with blocks of `size` rows in an order of little fill, that of
    /// nested dissection. `neighbours` lists for each block the others with which it shares entries.
    pub fn new(size: usize, neighbours: &[Vec<usize>]) -> SymbolicFactor {
        SymbolicFactor::in_order(size, neighbours, &nested_dissection(neighbours))
    }

    /// Returns the symbolic decomposition for an elimination of the blocks in this order, but for changes that fill
    /// nothing more. `neighbours`: as for [`new`](Self::new). Panics unless `order` has every block once.
    pub fn in_order(size: usize, neighbours: &[Vec<usize>], order: &[usize]) -> SymbolicFactor {
        let count = neighbours.len();
        let place = inverse(order);
        // The elimination tree (Liu 1990), in an order in which the descendants of each column come just before it.
        let parents = elimination_tree(neighbours, order, &place);
        let after = postorder(&parents);
        let order: Vec<usize> = after.iter().map(|old| order[*old]).collect();
        let place = inverse(&order);
        let moved = inverse(&after);
        let parent: Vec<usize> = after
            .iter()
            .map(|old| if parents[*old] < count { moved[parents[*old]] } else { count })
            .collect();
        let columns = columns(neighbours, &order, &place, &parent);
        let supernodes = merged(size, columns, &parent);
        let mut owner = vec![0; count];
        for (index, supernode) in supernodes.iter().enumerate() {
            owner[supernode.first..supernode.first + supernode.count].fill(index);
        }
        let entries = supernodes.iter().map(|s| size * size * s.count * s.height()).sum();
        let halves = halves(size, &supernodes, &owner);
        SymbolicFactor { size, place, order, supernodes, owner, entries, halves }
    }

    /// Returns the first column of a supernode, by its index; the number of columns for that after the last.
    pub(super) fn first_column(&self, supernode: usize) -> usize {
        self.size * self.supernodes.get(supernode).map_or(self.blocks(), |supernode| supernode.first)
    }

    /// Returns the index of the first value of a supernode, by its own index; the number of values for that after the last.
    pub(super) fn first_value(&self, supernode: usize) -> usize {
        self.supernodes.get(supernode).map_or(self.entries, |supernode| supernode.start)
    }

    /// Returns the number of blocks.
    pub fn blocks(&self) -> usize {
        self.order.len()
    }

    /// Returns the number of entries of the factor, with zeros.
    pub fn entries(&self) -> usize {
        self.entries
    }

    /// Returns the blocks in the order in which they are eliminated.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Returns true if two threads share a decomposition.
    pub fn is_shared(&self) -> bool {
        self.halves.is_some()
    }

    /// Returns the number of systems with the same decomposition whose solution takes as long as another decomposition.
    pub fn solutions(&self) -> f64 {
        self.work() as f64 / (SOLUTION * self.entries as f64)
    }

    /// Returns the number of multiplications of a decomposition, to the leading order.
    pub fn work(&self) -> usize {
        self.supernodes.iter().map(|supernode| supernode.work(self.size)).sum()
    }

    /// Returns the place of a block in the order in which blocks are eliminated.
    pub fn place(&self, block: usize) -> usize {
        self.place[block]
    }

    /// Returns the slot of the block at a row and a column, in either order. Panics if the matrix has no such block.
    pub fn slot(&self, row: usize, column: usize) -> Slot {
        let (i, j) = (self.place[row], self.place[column]);
        let (low, high) = (i.min(j), i.max(j));
        let supernode = &self.supernodes[self.owner[low]];
        let stride = self.size * supernode.height();
        let right = self.size * (low - supernode.first);
        let index = supernode.start + stride * right + self.size * supernode.row(high);
        Slot { index, stride, transposed: i < j }
    }
}

/// Returns the inverse of a permutation.
fn inverse(order: &[usize]) -> Vec<usize> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, block)| place[*block] = at);
    place
}

/// Returns the parent of each place in the elimination tree; the number of blocks for a root.
fn elimination_tree(neighbours: &[Vec<usize>], order: &[usize], place: &[usize]) -> Vec<usize> {
    let count = order.len();
    let (mut parents, mut ancestors) = (vec![count; count], vec![count; count]);
    for at in 0..count {
        for other in &neighbours[order[at]] {
            let mut below = place[*other];
            // Climb from below, and shorten the way for the next time.
            while below < at {
                let next = std::mem::replace(&mut ancestors[below], at);
                if next == count {
                    parents[below] = at;
                }
                if next >= at {
                    break;
                }
                below = next;
            }
        }
    }
    parents
}

/// Returns the places of a forest so that the descendants of each come just before it.
fn postorder(parents: &[usize]) -> Vec<usize> {
    let count = parents.len();
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); count + 1];
    (0..count).for_each(|at| children[parents[at]].push(at));
    let mut order = Vec::with_capacity(count);
    // Each with true once its children are on the stack above it.
    let mut stack: Vec<(usize, bool)> = children[count].iter().rev().map(|root| (*root, false)).collect();
    while let Some((at, open)) = stack.pop() {
        if open {
            order.push(at);
        } else {
            stack.push((at, true));
            stack.extend(children[at].iter().rev().map(|child| (*child, false)));
        }
    }
    order
}

/// Returns for each place the places of the blocks of its column below the diagonal, ascending.
fn columns(
    neighbours: &[Vec<usize>],
    order: &[usize],
    place: &[usize],
    parents: &[usize],
) -> Vec<Vec<usize>> {
    let count = order.len();
    let mut columns: Vec<Vec<usize>> = vec![Vec::new(); count];
    let mut marks = vec![usize::MAX; count];
    for at in 0..count {
        // The rows come from the children, and from the matrix itself.
        let mut column = std::mem::take(&mut columns[at]);
        column.extend(neighbours[order[at]].iter().map(|other| place[*other]));
        column.retain(|row| *row > at && std::mem::replace(&mut marks[*row], at) != at);
        column.sort_unstable();
        if parents[at] < count {
            let parent = &mut columns[parents[at]];
            parent.extend(column.iter().filter(|row| **row != parents[at]));
        }
        columns[at] = column;
    }
    columns
}

/// Returns the supernodes: columns with the same rows as their parent just after them, and those that few zeros make
/// so.
fn merged(size: usize, columns: Vec<Vec<usize>>, parents: &[usize]) -> Vec<Supernode> {
    let mut found: Vec<Supernode> = Vec::new();
    // The zeros of each.
    let mut zeros: Vec<usize> = Vec::new();
    for (at, rows) in columns.into_iter().enumerate() {
        let (mut first, mut count, mut empty) = (at, 1, 0);
        // A child just before it, then one just before that, which is a child of any of the merged columns.
        while let Some(child) = found.last() {
            let parent = parents[child.first + child.count - 1];
            let more = (count + rows.len()).saturating_sub(child.rows.len());
            let all = empty + zeros[found.len() - 1] + more * child.count;
            let (width, height) = (child.count + count, child.count + count + rows.len());
            let whole = width * height - width * (width - 1) / 2;
            let few = more == 0 || width <= COLUMNS_SMALL || all as f64 <= ZEROS_MAX * whole as f64;
            if !(first..=at).contains(&parent) || !few {
                break;
            }
            (first, count, empty) = (child.first, width, all);
            found.pop();
            zeros.pop();
        }
        found.push(Supernode { first, count, rows, start: 0 });
        zeros.push(empty);
    }
    let mut start = 0;
    for supernode in &mut found {
        supernode.start = start;
        start += size * size * supernode.count * supernode.height();
    }
    found
}

/// Returns the supernodes that two threads decompose at once: two groups of consecutive subtrees of the elimination tree, so that the
/// multiplications of the greater and of all supernodes after both are least; `None` where there is little to do, or that saves
/// little.
fn halves(size: usize, supernodes: &[Supernode], owner: &[usize]) -> Option<[Range<usize>; 2]> {
    // The multiplications of the supernodes before each.
    let mut before = vec![0];
    supernodes.iter().for_each(|supernode| before.push(before[before.len() - 1] + supernode.work(size)));
    let all = before[supernodes.len()];
    if all < WORK_MANY {
        return None;
    }
    // The first supernode of the subtree of each: descendants come just before it.
    let mut starts: Vec<usize> = (0..supernodes.len()).collect();
    for (index, supernode) in supernodes.iter().enumerate() {
        if let Some(row) = supernode.rows.first() {
            starts[owner[*row]] = starts[owner[*row]].min(starts[index]);
        }
    }
    let mut best = None;
    let mut least = ((1.0 - SAVED_MIN) * all as f64) as usize;
    // All supernodes before one are whole subtrees: a cut stands between two of them.
    for end in (1..=supernodes.len()).rev() {
        let after = all - before[end];
        if after >= least {
            break;
        }
        let mut cut = starts[end - 1];
        while cut > 0 {
            let whole = after + before[cut].max(before[end] - before[cut]);
            if whole < least {
                (least, best) = (whole, Some([0..cut, cut..end]));
            }
            cut = starts[cut - 1];
        }
    }
    best
}
