//! Best-first search for a short series of strokes from one sheet to another in the plane.
//!
//! Panels are alike, so a state is the cells that are covered and the pairs of them that are joined.
//! Every stroke makes one connection, so as many are needed as the state lacks of those that are
//! wanted. To this is added how far the panels that lie elsewhere are from the cells that are still
//! free, and the state that is best by both is expanded next: the series that is found need not be the shortest.

use super::lattice_sheet::{LatticeSheet, Point, Side, Stroke, cell};
use crate::planners::fold::sweep_collision::Solids;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// The weight of a panel's distance to its cell (steps of the lattice): with more the search is greedier.
const DISTANCE_WEIGHT: i64 = 2;

/// The goal of a rearrangement: the sheet to be reached, on the lattice of the start.
#[derive(Clone, Debug)]
pub struct Goal {
    /// The lattice cells that the sheet covers, each named by the sum of its corners ([`cell`]).
    pub cells: BTreeSet<Point>,
    /// The pairs of cells whose panels are joined, as by [`pair`], which make a tree.
    pub bonds: BTreeSet<[Point; 2]>,
}

/// The panels of a sheet as solids, for samples of collisions.
#[derive(Clone, Copy)]
pub struct PanelSolids<'p> {
    /// The collision parts of each panel, by its index.
    pub solids: &'p Solids,
    /// The length of the panels' sides, m.
    pub side: f64,
}

/// Returns two cells, given by their names ([`cell`]), as an unordered pair: the lesser name first.
pub fn pair(a: Point, b: Point) -> [Point; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// A state that was reached.
struct Node {
    plane: LatticeSheet,
    /// The index of the state before, and the stroke from there; `None` for the start.
    from: Option<(usize, Stroke)>,
    strokes: i64,
}

/// Searches for fewer than `most` strokes, free of collisions in their samples, that change the sheet `start` into
/// `goal`, by best-first search over at most `steps` states taken from the queue. Returns (strokes, sheet): the
/// strokes in order and the sheet after them, without any strokes if `start` is the goal; `None` if none were found.
/// `panels`: the panels as solids, for samples of collisions.
pub fn rearranged(
    start: &LatticeSheet,
    goal: &Goal,
    panels: PanelSolids,
    most: usize,
    steps: usize,
) -> Option<(Vec<Stroke>, LatticeSheet)> {
    let mut nodes = vec![Node { plane: start.clone(), from: None, strokes: 0 }];
    let mut queue = BinaryHeap::from([Reverse((0, 0))]);
    let mut known = BTreeSet::from([state(start)]);
    for _ in 0..steps {
        crate::interrupt::checkpoint();
        let Reverse((_, at)) = queue.pop()?;
        // Lazy evaluation: most states are never expanded.
        if !is_free(&mut nodes, at, panels) {
            continue;
        }
        let Node { plane, strokes, .. } = &nodes[at];
        if lacking(plane, goal) == 0 {
            return Some(series(nodes, at));
        }
        let (plane, strokes) = (plane.clone(), *strokes);
        for stroke in strokes_of(&plane, goal) {
            let mut next = plane.clone();
            next.apply(&stroke);
            let lacking = lacking(&next, goal);
            if strokes as usize + 1 + lacking >= most || !known.insert(state(&next)) {
                continue;
            }
            let value = strokes + 1 + lacking as i64 + DISTANCE_WEIGHT * distance(&next, goal);
            queue.push(Reverse((value, nodes.len())));
            nodes.push(Node { plane: next, from: Some((at, stroke)), strokes: strokes + 1 });
        }
    }
    None
}

/// Returns true if the stroke into a state is collision-free, if need be folded to the other side.
fn is_free(nodes: &mut [Node], at: usize, PanelSolids { solids, side }: PanelSolids) -> bool {
    let Some((before, stroke)) = nodes[at].from.clone() else { return true };
    let other = Stroke { angle: -stroke.angle, ..stroke.clone() };
    let free = [stroke, other].into_iter().find(|s| nodes[before].plane.is_free(s, solids, side));
    let is_free = free.is_some();
    nodes[at].from = free.map(|stroke| (before, stroke));
    is_free
}

/// Returns the strokes that lead to a state, and its sheet.
fn series(mut nodes: Vec<Node>, end: usize) -> (Vec<Stroke>, LatticeSheet) {
    let mut strokes = Vec::new();
    let mut at = end;
    while let Some((before, stroke)) = nodes[at].from.take() {
        strokes.push(stroke);
        at = before;
    }
    strokes.reverse();
    (strokes, nodes.swap_remove(end).plane)
}

/// Returns the pair of cells that a connection joins.
fn joined(plane: &LatticeSheet, bond: &[Side; 2]) -> [Point; 2] {
    let [a, b] = bond.map(|side| cell(&plane.corners[side.0]));
    pair(a, b)
}

/// Returns the identity of a state: its pairs of joined cells, in order.
fn state(plane: &LatticeSheet) -> Vec<[Point; 2]> {
    let mut bonds: Vec<[Point; 2]> = plane.bonds.iter().map(|bond| joined(plane, bond)).collect();
    bonds.sort_unstable();
    bonds
}

/// Returns the number of connections that are still to be made.
fn lacking(plane: &LatticeSheet, goal: &Goal) -> usize {
    let has = plane.bonds.iter().filter(|bond| goal.bonds.contains(&joined(plane, bond))).count();
    goal.bonds.len() - has
}

/// Returns the distance of panels on cells that are not wanted from wanted cells that are free, and
/// conversely: the greater sum, in steps from a cell to the next but one.
fn distance(plane: &LatticeSheet, goal: &Goal) -> i64 {
    let stray: Vec<Point> = plane.cells.keys().filter(|cell| !goal.cells.contains(*cell)).copied().collect();
    let free: Vec<Point> =
        goal.cells.iter().filter(|cell| !plane.cells.contains_key(*cell)).copied().collect();
    let sum = |from: &[Point], to: &[Point]| -> i64 {
        from.iter().map(|a| to.iter().map(|b| steps(*a, *b)).min().unwrap_or(0)).sum()
    };
    sum(&stray, &free).max(sum(&free, &stray))
}

/// Returns the number of lattice steps between two cells, rounded up; cells are named by the sums of their
/// corners.
fn steps(a: Point, b: Point) -> i64 {
    let [i, j] = [b[0] - a[0], b[1] - a[1]];
    let thirds = i.abs().max(j.abs()).max((i + j).abs());
    (thirds + 2) / 3
}

/// Returns the strokes of a state: a wanted connection alone, where there is one that needs no folding.
fn strokes_of(plane: &LatticeSheet, goal: &Goal) -> Vec<Stroke> {
    let worth = |bond: &[Side; 2]| usize::from(goal.bonds.contains(&joined(plane, bond)));
    let open = plane.open();
    if let Some(make) = open.iter().find(|make| worth(make) > 0) {
        return vec![plane.change(*make, worth)];
    }
    let changes = open.into_iter().map(|make| plane.change(make, worth));
    changes.chain(plane.pivots()).collect()
}
