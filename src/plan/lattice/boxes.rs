//! Contacts and overlaps of stages in which cells move, or change their size, along several axes.
//!
//! Broad phase: separating planes that no cell crosses split the set recursively, then pairs of swept
//! bounding boxes are found in a uniform grid. Narrow phase: two cells overlap at a value of the path
//! parameter at which six linear inequalities hold.

use super::contacts::ContactForest;
use super::grid::Cube;
use super::lanes::Overlap;
use super::window::{self, Window};

/// The greatest number of pairs that are examined, for each cell: cells that move by little have a few neighbours.
const PAIRS_MAX: usize = 500;

/// Joins in `forest` the cells that are in contact during the whole stage, where cells move along several axes: broad
/// phase by separating planes and a uniform grid, narrow phase by linear inequalities. `before` and `after` are the
/// cells by number at the two ends of the stage. `None` if more pairs come near each other than are examined.
///
/// # Errors
/// The inner result is the first [`Overlap`] of two cells that is found.
pub fn examine(before: &[Cube], after: &[Cube], forest: &mut ContactForest) -> Option<Result<(), Overlap>> {
    // Contacts that last are contacts at the start, too: boxes that touch before the stage.
    let contacts = pairs_near(before, |i, j| {
        if lasts(before, after, i, j) {
            let moved = |k: usize, axis: usize| after[k].middle(axis) - before[k].middle(axis);
            let relative = (0..3).map(|axis| (moved(i, axis) - moved(j, axis)).abs()).max();
            forest.join((before, after), (i as u32, j as u32), relative.unwrap_or(0));
        }
        None
    });
    contacts?.ok();
    // Overlaps are sought within each group that no separating plane splits.
    for group in groups(before, after) {
        let hulls: Vec<Cube> =
            group.iter().map(|&cell| hull(&before[cell as usize], &after[cell as usize])).collect();
        let found = pairs_near(&hulls, |i, j| {
            let cells = (group[i].min(group[j]), group[i].max(group[j]));
            let (i, j) = (cells.0 as usize, cells.1 as usize);
            let at_start = overlap(&before[i], &before[j]);
            let found = at_start || overlaps_on_the_way((&before[i], &after[i]), (&before[j], &after[j]));
            found.then_some(Overlap { cells, at_start })
        })?;
        if found.is_err() {
            return Some(found);
        }
    }
    Some(Ok(()))
}

/// The greatest depth of the recursive splitting by separating planes.
const DEPTH_MAX: usize = 12;

/// Returns the groups of cells that are not separated by axis-aligned planes. A plane that no cell crosses at the
/// start, and one in the same order at the end, splits the set; the parts are split along the next axis. Gaps are
/// linear in the path parameter, so nothing overlaps across such a plane. Groups of one cell are left out.
fn groups(before: &[Cube], after: &[Cube]) -> Vec<Vec<u32>> {
    let mut found = Vec::new();
    let mut open = vec![((0..before.len() as u32).collect::<Vec<u32>>(), 0, DEPTH_MAX)];
    while let Some((cells, idle, depth)) = open.pop() {
        // After three axes without a plane there is none.
        if idle == 3 || depth == 0 {
            found.push(cells);
            continue;
        }
        let axis = (DEPTH_MAX - depth + idle) % 3;
        let count = cells.len();
        let parts = parts(before, after, cells, axis);
        let whole = parts.first().is_some_and(|part| part.len() == count);
        let (idle, depth) = if whole { (idle + 1, depth) } else { (0, depth - 1) };
        open.extend(parts.into_iter().map(|part| (part, idle, depth)));
    }
    found
}

/// Returns the cells between successive separating planes across an axis; parts of one cell are left out.
fn parts(before: &[Cube], after: &[Cube], mut cells: Vec<u32>, axis: usize) -> Vec<Vec<u32>> {
    let ends = |cell: u32| (&before[cell as usize], &after[cell as usize]);
    cells.sort_by_key(|&cell| (ends(cell).0.lo[axis], ends(cell).1.lo[axis]));
    // The lowest faces of all cells from one on, at both ends.
    let mut lowest = vec![(i64::MAX, i64::MAX); cells.len() + 1];
    for (i, &cell) in cells.iter().enumerate().rev() {
        let (a, b) = ends(cell);
        lowest[i] = (lowest[i + 1].0.min(a.lo[axis]), lowest[i + 1].1.min(b.lo[axis]));
    }
    let mut parts = Vec::new();
    let mut highest = (i64::MIN, i64::MIN);
    let mut first = 0;
    for i in 0..cells.len() {
        let (a, b) = ends(cells[i]);
        highest = (highest.0.max(a.hi[axis]), highest.1.max(b.hi[axis]));
        if highest.0 <= lowest[i + 1].0 && highest.1 <= lowest[i + 1].1 {
            if i > first {
                parts.push(cells[first..=i].to_vec());
            }
            first = i + 1;
        }
    }
    parts
}

/// Calls `visit` with every pair of cells, by number and the lower first, whose swept bounding boxes touch or
/// overlap. `before` and `after` are the cells by number at the two ends of the stage. `None` if there are too many
/// pairs; some were visited then.
pub fn for_swept_pairs(before: &[Cube], after: &[Cube], mut visit: impl FnMut(usize, usize)) -> Option<()> {
    let visited = pairs_near(&swept(before, after), |i, j| {
        visit(i, j);
        None
    });
    visited.map(|_| ())
}

/// Checks that no cell overlaps an obstacle at any time of the stage. `before` and `after` are the cells by number at
/// its two ends; `obstacles` rest. `None` if more pairs come near each other than are examined.
///
/// # Errors
/// The inner result is the first overlap that is found, with the numbers of the cell and of the obstacle.
pub fn examine_obstacles(before: &[Cube], after: &[Cube], obstacles: &[Cube]) -> Option<Result<(), Overlap>> {
    let mut hulls = swept(before, after);
    hulls.extend_from_slice(obstacles);
    let count = before.len();
    pairs_near(&hulls, |i, j| {
        if i >= count || j < count {
            return None;
        }
        let obstacle = &obstacles[j - count];
        let at_start = overlap(&before[i], obstacle);
        let found = at_start || overlaps_on_the_way((&before[i], &after[i]), (obstacle, obstacle));
        found.then_some(Overlap { cells: (i as u32, (j - count) as u32), at_start })
    })
}

/// Returns the bounding box of each cell's sweep.
fn swept(before: &[Cube], after: &[Cube]) -> Vec<Cube> {
    before.iter().zip(after).map(|(a, b)| hull(a, b)).collect()
}

fn hull(a: &Cube, b: &Cube) -> Cube {
    let mut hull = *a;
    for axis in 0..3 {
        hull.lo[axis] = a.lo[axis].min(b.lo[axis]);
        hull.hi[axis] = a.hi[axis].max(b.hi[axis]);
    }
    hull
}

fn overlap(a: &Cube, b: &Cube) -> bool {
    (0..3).all(|axis| a.lo[axis] < b.hi[axis] && b.lo[axis] < a.hi[axis])
}

/// Returns true if two cells share a part of a face during the whole stage: along one axis the gap is 0 at
/// both ends, along the others the overlap is negative at neither end and not 0 at both.
fn lasts(before: &[Cube], after: &[Cube], i: usize, j: usize) -> bool {
    let gap = |cubes: &[Cube], a: usize, b: usize, axis: usize| cubes[b].lo[axis] - cubes[a].hi[axis];
    let closed = |axis: usize| {
        (gap(before, i, j, axis) == 0 && gap(after, i, j, axis) == 0)
            || (gap(before, j, i, axis) == 0 && gap(after, j, i, axis) == 0)
    };
    let beside = |axis: usize| {
        let common = |c: &[Cube]| c[i].hi[axis].min(c[j].hi[axis]) - c[i].lo[axis].max(c[j].lo[axis]);
        let (start, end) = (common(before), common(after));
        start >= 0 && end >= 0 && start + end > 0
    };
    (0..3).any(|axis| closed(axis) && beside((axis + 1) % 3) && beside((axis + 2) % 3))
}

/// Returns true if two cells overlap at some value of the path parameter.
fn overlaps_on_the_way(a: (&Cube, &Cube), b: (&Cube, &Cube)) -> bool {
    let axes = (0..3).try_fold(Window::WHOLE, |open, axis| window::overlap([a, b], axis, open));
    axes.is_some()
}

/// Coordinates of a tile of the uniform grid, along z, y and x.
type Tile = (i64, i64, i64);

/// Calls `visit` with every pair of boxes, the lower index first, that touch or overlap, until it returns an
/// overlap. `None` if there are too many pairs. Broad phase on a uniform grid whose tiles are as large as the
/// largest box.
fn pairs_near(
    boxes: &[Cube],
    mut visit: impl FnMut(usize, usize) -> Option<Overlap>,
) -> Option<Result<(), Overlap>> {
    let tile = boxes.iter().flat_map(|b| (0..3).map(|axis| b.size(axis))).max().unwrap_or(1).max(1);
    let key = |b: &Cube| -> Tile {
        let [x, y, z] = [0, 1, 2].map(|axis| b.lo[axis].div_euclid(tile));
        (z, y, x)
    };
    // Boxes in the order of their tiles.
    let mut order: Vec<(Tile, u32)> = boxes.iter().enumerate().map(|(i, b)| (key(b), i as u32)).collect();
    order.sort_unstable();
    let mut left = PAIRS_MAX.saturating_mul(boxes.len()).saturating_add(1000);
    // The later half of the 27 tiles around one: the rest of its row, and four rows.
    const ROWS: [(i64, i64); 4] = [(0, 1), (1, -1), (1, 0), (1, 1)];
    let mut ahead = [0_usize; ROWS.len()];
    for (i, &((z, y, x), cell)) in order.iter().enumerate() {
        let mut near: Vec<&[(Tile, u32)]> = Vec::with_capacity(5);
        let rest = &order[i + 1..];
        near.push(&rest[..rest.iter().take_while(|(tile, _)| *tile <= (z, y, x + 1)).count()]);
        for (row, (dz, dy)) in ROWS.iter().enumerate() {
            while ahead[row] < order.len() && order[ahead[row]].0 < (z + dz, y + dy, x - 1) {
                ahead[row] += 1;
            }
            let rest = &order[ahead[row]..];
            let last = (z + dz, y + dy, x + 1);
            near.push(&rest[..rest.iter().take_while(|(tile, _)| *tile <= last).count()]);
        }
        for &(_, other) in near.into_iter().flatten() {
            left = left.checked_sub(1)?;
            let (a, b) = (&boxes[cell as usize], &boxes[other as usize]);
            if !(0..3).all(|axis| a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis]) {
                continue;
            }
            let (i, j) = (cell.min(other), cell.max(other));
            if let Some(overlap) = visit(i as usize, j as usize) {
                return Some(Err(overlap));
            }
        }
    }
    Some(Ok(()))
}
