//! Melt: any connected set of cells, in space too, to a row, through itself; reversed it grows a row to any
//! other set. After the idea of Rus and Vona's planner for Crystalline robots, for single cells.
//!
//! The cells fill the boxes of a tree. Two cells of half a size fill a box as well as one: so a leaf can slip
//! into the box of its parent, and the cell that is then too many can pass from box to box down to the root,
//! and out to the row that grows from there, where the path is free. On a straight line of boxes it passes
//! all in one stage; around a corner the pair swaps first. All boxes stay full meanwhile, so nothing falls
//! apart and nothing meets. The time is proportional to the number of cells (and no less: one box lets one
//! cell pass at a time).

use super::Refusal;
use super::domain::{CellState, WHOLE};
use super::listed::Listed;
use super::motion::{Motion, PlanLimits};
use std::collections::{BTreeMap, BTreeSet};

const HALF: i64 = WHOLE / 2;
const QUARTER: i64 = WHOLE / 4;
const X: usize = 0;
/// Stage names by axis: of a pair that swaps to be split along it, and of passes.
const CONTRACT: [&str; 3] = ["swap x-contract", "swap y-contract", "swap z-contract"];
const PASS: [&str; 3] = ["x-pass", "y-pass", "z-pass"];

/// Returns the motion from a connected set of cells at these lattice sites, all different and at least one, to a row
/// along x, in which the cell at site `i` (from 0) has the number `name(i)`, which must be a permutation. Cells must be
/// able to shrink to half their size. After the melt-grow planner for Crystalline robots (Rus and Vona 2001), for
/// single cells. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits, [`Refusal::Defect`] if cells do not melt.
pub fn melt(
    limits: PlanLimits,
    positions: &[[i64; 3]],
    name: impl Fn(u64) -> u64,
) -> Result<Motion, Refusal> {
    let start = positions.iter().map(|place| CellState::whole(*place)).collect();
    let mut motion = Listed::new(start);
    let mut tree = Tree::of(positions);
    let mut idle = 0;
    // Each round is for one axis; all three without a move are the end.
    for axis in (0..3).cycle() {
        let moves = tree.round(&mut motion, axis);
        idle = if moves { 0 } else { idle + 1 };
        if idle == 3 {
            break;
        }
    }
    if tree.boxes.len() > 1 {
        return Err(Refusal::Defect("cells are left that do not melt".into()));
    }
    let mut number = vec![0; positions.len()];
    let row = tree.boxes[&tree.root].cells.iter().chain(&tree.row);
    row.enumerate().for_each(|(i, &cell)| number[cell] = name(i as u64));
    motion.into_motion(limits, &number)
}

type Place = [i64; 3];

/// One box of the tree, full of one cell, or of two halves.
struct Node {
    place: Place,
    /// The next box towards the root, and the direction to it; the root leads to the row.
    next: Place,
    axis: usize,
    step: i64,
    children: usize,
    /// One, or two, the lower first.
    cells: Vec<usize>,
    /// The axis along which two cells are split.
    split: usize,
}

/// The tree of boxes, with the row that has grown from it.
struct Tree {
    boxes: BTreeMap<Place, Node>,
    /// The boxes in the order in which they pass cells on, the root first, then those nearer to it.
    order: Vec<Place>,
    root: Place,
    /// The cells of the row outside the tree, that next to the root first.
    row: Vec<usize>,
}

/// Returns a position moved by a step along an axis.
fn moved(place: Place, axis: usize, step: i64) -> Place {
    let mut place = place;
    place[axis] += step;
    place
}

impl Tree {
    /// Returns a spanning tree of all positions, rooted at the one farthest along x, whose paths to the root
    /// have the fewest corners (Dijkstra).
    fn of(positions: &[Place]) -> Tree {
        let index: BTreeMap<Place, usize> = positions.iter().enumerate().map(|(i, p)| (*p, i)).collect();
        let root = positions.iter().copied().max_by_key(|p| p[X]).unwrap_or_default();
        let mut boxes: BTreeMap<Place, Node> = BTreeMap::new();
        let mut order = Vec::new();
        // Corners and boxes on the path to the root, the position, and the step from there.
        let mut frontier = BTreeSet::from([((0_u64, 0_u64), root, X, 1_i64)]);
        while let Some(((corners, length), place, axis, step)) = frontier.pop_first() {
            if boxes.contains_key(&place) {
                continue;
            }
            let next = moved(place, axis, step);
            if let Some(parent) = boxes.get_mut(&next) {
                parent.children += 1;
            }
            let cells = vec![index[&place]];
            boxes.insert(place, Node { place, next, axis, step, children: 0, cells, split: axis });
            order.push(place);
            for (other, back) in (0..3).flat_map(|k| [(k, -1), (k, 1)]) {
                let from = moved(place, other, -back);
                if index.contains_key(&from) && !boxes.contains_key(&from) {
                    let turns = u64::from((other, back) != (axis, step));
                    frontier.insert(((corners + turns, length + 1), from, other, back));
                }
            }
        }
        Tree { boxes, order, root, row: vec![] }
    }

    /// Appends swaps and passes along one axis; returns true if anything moved.
    fn round(&mut self, motion: &mut Listed, axis: usize) -> bool {
        crate::interrupt::progress_checkpoint(|| format!("{} cells are left to melt", self.boxes.len()));
        let swapped = self.swap(motion, axis);
        let passed = self.pass(motion, axis);
        swapped || passed
    }

    /// Appends a swap (Lemma 3) of the pairs that have to go on along an axis, so that they are split along it; returns
    /// true if there were any.
    fn swap(&mut self, motion: &mut Listed, axis: usize) -> bool {
        let turning: Vec<Place> = self
            .boxes
            .values()
            .filter(|b| b.cells.len() == 2 && b.axis == axis && b.split != axis)
            .map(|b| b.place)
            .collect();
        if turning.is_empty() {
            return false;
        }
        // Boxes beside each other swap in opposite senses, so that they keep a face in common.
        let mut halves: BTreeMap<usize, (Place, bool)> = BTreeMap::new();
        for place in &turning {
            let upward = place.iter().sum::<i64>().rem_euclid(2) == 1;
            let Some(pair) = self.boxes.get(place).map(|b| b.cells.clone()) else { continue };
            halves.insert(pair[0], (*place, upward));
            halves.insert(pair[1], (*place, !upward));
        }
        motion.stage(CONTRACT[axis], |cell, state| {
            if let Some((_, high)) = halves.get(&cell) {
                state.center[axis] += if *high { QUARTER } else { -QUARTER };
                state.size[axis] = HALF;
            }
        });
        // All at once: between the two stages the cells of a pair touch along an edge only.
        let boxes = &self.boxes;
        motion.stage("swap expand", |cell, state| {
            if let Some((place, _)) = halves.get(&cell) {
                let split = boxes[place].split;
                state.center[split] = WHOLE * place[split] + HALF;
                state.size[split] = WHOLE;
            }
        });
        for place in turning {
            let Some(b) = self.boxes.get_mut(&place) else { continue };
            b.cells.sort_by_key(|cell| halves[cell].1);
            b.split = axis;
        }
        true
    }

    /// Appends a pass of leaves and halves along an axis, each as far as boxes in line have room; returns true if any
    /// moved.
    fn pass(&mut self, motion: &mut Listed, axis: usize) -> bool {
        let mut used: BTreeSet<Place> = BTreeSet::new();
        let mut goals: BTreeMap<usize, CellState> = BTreeMap::new();
        for place in self.order.clone() {
            let Some(line) = self.line(place, axis, &used) else { continue };
            used.extend(line.iter().copied());
            self.advance(&line, &mut goals);
        }
        if goals.is_empty() {
            return false;
        }
        let boxes = &self.boxes;
        self.order.retain(|place| boxes.contains_key(place));
        motion.stage(PASS[axis], |cell, state| {
            if let Some(goal) = goals.get(&cell) {
                *state = *goal;
            }
        });
        true
    }

    /// Returns the line of boxes that the surplus of a box (or a leaf) can pass through along an axis, itself first,
    /// up to the last, which takes it in; `None` if it can't move.
    fn line(&self, place: Place, axis: usize, used: &BTreeSet<Place>) -> Option<Vec<Place>> {
        let from = self.boxes.get(&place)?;
        let leaf = from.children == 0 && from.cells.len() == 1 && place != self.root;
        let half = from.cells.len() == 2 && from.split == axis;
        if from.axis != axis || !(leaf || half) || used.contains(&place) {
            return None;
        }
        let mut line = vec![place];
        let mut at = from;
        while let Some(next) = self.boxes.get(&at.next) {
            if next.cells.len() > 1 || used.contains(&next.place) {
                break;
            }
            line.push(next.place);
            if (next.axis, next.step) != (from.axis, from.step) {
                break;
            }
            at = next;
        }
        (line.len() > 1 || place == self.root).then_some(line)
    }

    /// Moves the cells of a line of boxes on by one cell, out to the row if it leads there.
    fn advance(&mut self, line: &[Place], goals: &mut BTreeMap<usize, CellState>) {
        let (first, last) = (line[0], line[line.len() - 1]);
        let Some((axis, step, leaf)) = self.boxes.get(&first).map(|b| (b.axis, b.step, b.cells.len() == 1))
        else {
            return;
        };
        // From the back to the front.
        let mut cells: Vec<usize> = Vec::new();
        for place in line {
            let own = &self.boxes[place].cells;
            if step > 0 { cells.extend(own) } else { cells.extend(own.iter().rev()) }
        }
        // Each box but the last takes one cell of full size; the last takes two halves, unless the line leads out.
        let out = last == self.root && (axis, step) == (X, 1);
        let full = if leaf { &line[1..] } else { line };
        let mut cells = cells.into_iter();
        for place in full {
            let Some(b) = self.boxes.get_mut(place) else { continue };
            let whole = out || *place != last;
            b.cells = cells.by_ref().take(if whole { 1 } else { 2 }).collect();
            if let [cell] = b.cells[..] {
                goals.insert(cell, CellState::whole(*place));
                continue;
            }
            if step < 0 {
                b.cells.reverse();
            }
            b.split = axis;
            for (cell, side) in b.cells.iter().zip([-QUARTER, QUARTER]) {
                let mut state = CellState::whole(*place);
                state.center[axis] += side;
                state.size[axis] = HALF;
                goals.insert(*cell, state);
            }
        }
        // A cell that is left goes out to the row, which moves on by one.
        if out {
            self.row.splice(0..0, cells);
            for (i, &cell) in self.row.iter().enumerate() {
                goals.insert(cell, CellState::whole(moved(self.root, X, i as i64 + 1)));
            }
        }
        // The box of a leaf is empty now.
        if leaf {
            if let Some(next) = self.boxes.get(&first).map(|b| b.next)
                && let Some(parent) = self.boxes.get_mut(&next)
            {
                parent.children -= 1;
            }
            self.boxes.remove(&first);
        }
    }
}
