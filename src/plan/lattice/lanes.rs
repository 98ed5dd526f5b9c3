//! Contacts and overlaps of stages in which cells move along one axis only, by a sweep along that axis.
//!
//! Cells with the same cross-section form a lane. Within a lane, and between lanes whose cross-sections overlap, the
//! order along the axis may not change and gaps are never negative: gaps are linear in the path parameter, so both
//! ends of the stage decide it for all of it, and neighbours decide it for all pairs.

use super::contacts::ContactForest;
use super::grid::Cube;
use super::tiles::{Section, Tile, Tiles};

/// Two cells that overlap during a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlap {
    /// The numbers of the two cells, from 0.
    pub cells: (u32, u32),
    /// True if the cells overlap at the start of the stage, false if only later.
    pub at_start: bool,
}

/// A cell within its lane: its lower and upper face along the axis before and after the stage, in grid lines.
#[derive(Clone, Copy)]
struct LaneCell {
    before: (i64, i64),
    after: (i64, i64),
    cell: u32,
}

struct Lanes {
    /// The cells by lane; in order along the axis before the stage.
    places: Vec<LaneCell>,
    /// The index in `places` of the first of each lane, and the end.
    starts: Vec<usize>,
    sections: Vec<Section>,
    /// The tiles of each lane, in order.
    tiles: Vec<Tile>,
}

/// The number of comparisons of lanes that a stage may take, for each cell: sound plans take a few.
const COMPARISONS_MAX: usize = 200;

/// Joins in `forest` the cells that are in contact during the whole stage, where all cells move along one axis: by a
/// sweep along it over lanes, the rows of cells of one cross-section. `before` and `after` are the cells by number at
/// the two ends of the stage; `axis` (0 to 2 for x, y, z) is that of the motion; `lines` is the number of grid lines
/// to a cell. `None` if more lanes lie side by side than are compared.
///
/// # Errors
/// The inner result is the first [`Overlap`] of two cells that is found.
pub fn examine(
    before: &[Cube],
    after: &[Cube],
    axis: usize,
    lines: i64,
    forest: &mut ContactForest,
) -> Option<Result<(), Overlap>> {
    // Order within each lane.
    let lanes = Lanes::of(before, after, axis, lines)?;
    let all = 0..lanes.sections.len();
    if let Some(overlap) = all.clone().find_map(|lane| in_line(lanes.lane(lane))) {
        return Some(Err(overlap));
    }
    let contacts = |places: &[LaneCell], forest: &mut ContactForest| {
        for pair in places.windows(2) {
            if pair[0].before.1 == pair[1].before.0 && pair[0].after.1 == pair[1].after.0 {
                let relative = relative_displacement(&pair[0], &pair[1]);
                forest.join((before, after), (pair[0].cell, pair[1].cell), relative);
            }
        }
    };
    all.for_each(|lane| contacts(lanes.lane(lane), forest));
    // Order between lanes whose cross-sections overlap. Contacts along the axis come first: then the forces
    // of the spanning forest run along it.
    let mut beside = Vec::new();
    let mut merged = Vec::new();
    let mut left = budget(before.len());
    let mut overlap = None;
    lanes.neighbours(|a, b| {
        let (first, second) = (lanes.lane(a), lanes.lane(b));
        left = left.checked_sub(first.len() + second.len())?;
        match facing(&lanes.sections[a], &lanes.sections[b]) {
            Facing::Apart => {}
            Facing::Beside => beside.push((a as u32, b as u32)),
            Facing::InLine if overlap.is_none() => {
                merge(first, second, &mut merged);
                overlap = in_line(&merged);
                contacts(&merged, forest);
            }
            Facing::InLine => {}
        }
        Some(())
    })?;
    if let Some(overlap) = overlap {
        return Some(Err(overlap));
    }
    // Contacts between lanes whose cross-sections share an edge.
    for (a, b) in beside {
        side_by_side(lanes.lane(a as usize), lanes.lane(b as usize), |p, q| {
            forest.join((before, after), (p.cell, q.cell), relative_displacement(p, q));
        });
    }
    Some(Ok(()))
}

/// Returns the number of comparisons that a stage of so many cells may take.
fn budget(cells: usize) -> usize {
    COMPARISONS_MAX.saturating_mul(cells).saturating_add(1000)
}

impl Lanes {
    /// Sorts the cells into lanes. `None` if too many cross-sections share a tile.
    fn of(before: &[Cube], after: &[Cube], axis: usize, lines: i64) -> Option<Lanes> {
        // The lane of each cell; neighbours in the list of cells mostly share one.
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let section = |cube: &Cube| [(cube.lo[b], cube.hi[b]), (cube.lo[c], cube.hi[c])];
        let (mut lane_of, mut sizes) = (Vec::with_capacity(before.len()), Vec::new());
        let mut tiles = Tiles::over(before, (b, c), lines);
        let mut left = budget(before.len());
        for cube in before {
            let section = section(cube);
            let lane = match lane_of.last() {
                Some(&last) if tiles.sections[last as usize] == section => last,
                _ => tiles.lane(section, &mut left)?,
            };
            if lane as usize == sizes.len() {
                sizes.push(0_usize);
            }
            sizes[lane as usize] += 1;
            lane_of.push(lane);
        }
        // In order of tiles, neighbours are near each other in memory, too.
        let order = tiles.order();
        let mut next = vec![0; sizes.len()];
        let mut starts = Vec::with_capacity(sizes.len() + 1);
        let mut end = 0;
        for &(_, lane) in &order {
            starts.push(end);
            next[lane as usize] = end;
            end += sizes[lane as usize];
        }
        starts.push(end);
        // Counting sort of the cells into their lanes, then by position within each.
        let empty = LaneCell { before: (0, 0), after: (0, 0), cell: 0 };
        let mut places = vec![empty; before.len()];
        for (cell, ((old, new), lane)) in before.iter().zip(after).zip(lane_of).enumerate() {
            let at = &mut next[lane as usize];
            places[*at] = LaneCell {
                before: (old.lo[axis], old.hi[axis]),
                after: (new.lo[axis], new.hi[axis]),
                cell: cell as u32,
            };
            *at += 1;
        }
        for lane in starts.windows(2).filter(|lane| lane[1] - lane[0] > 1) {
            places[lane[0]..lane[1]].sort_by_key(|place| place.before);
        }
        let sections = order.iter().map(|&(_, lane)| tiles.sections[lane as usize]).collect();
        Some(Lanes { places, starts, sections, tiles: order.into_iter().map(|(tile, _)| tile).collect() })
    }

    fn lane(&self, lane: usize) -> &[LaneCell] {
        &self.places[self.starts[lane]..self.starts[lane + 1]]
    }

    /// Calls `call` with every pair of lanes that can touch: those with corners no more than a cell apart.
    /// Ends with `None` as soon as `call` does.
    fn neighbours(&self, mut call: impl FnMut(usize, usize) -> Option<()>) -> Option<()> {
        // In the same tile and the next of the row, and in three tiles of the next row: the other
        // halves of the pairs were met before.
        let tiles = &self.tiles;
        let mut next_row = 0;
        for (i, &(row, column)) in tiles.iter().enumerate() {
            crate::interrupt::checkpoint();
            let same = (i + 1..tiles.len()).take_while(|&k| tiles[k] <= (row, column + 1));
            same.into_iter().try_for_each(|k| call(i, k))?;
            while next_row < tiles.len() && tiles[next_row] < (row + 1, column - 1) {
                next_row += 1;
            }
            let above = (next_row..tiles.len()).take_while(|&k| tiles[k] <= (row + 1, column + 1));
            above.into_iter().try_for_each(|k| call(i, k))?;
        }
        Some(())
    }
}

/// Returns twice the absolute relative displacement of two cells, in grid lines.
fn relative_displacement(a: &LaneCell, b: &LaneCell) -> i64 {
    let moved = |p: &LaneCell| p.after.0 + p.after.1 - p.before.0 - p.before.1;
    (moved(a) - moved(b)).abs()
}

/// Returns the first two neighbours in a lane that overlap; `None` if none do.
fn in_line(places: &[LaneCell]) -> Option<Overlap> {
    places.windows(2).find_map(|pair| {
        let at_start = pair[0].before.1 > pair[1].before.0;
        let found = at_start || pair[0].after.1 > pair[1].after.0;
        found.then_some(Overlap { cells: (pair[0].cell, pair[1].cell), at_start })
    })
}

/// Merges two lanes in order along the axis.
fn merge(a: &[LaneCell], b: &[LaneCell], merged: &mut Vec<LaneCell>) {
    merged.clear();
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        if a[i].before <= b[j].before {
            merged.push(a[i]);
            i += 1;
        } else {
            merged.push(b[j]);
            j += 1;
        }
    }
    merged.extend_from_slice(&a[i..]);
    merged.extend_from_slice(&b[j..]);
}

/// Calls `touch` with the cells of two lanes that face each other during the whole stage. Their overlap
/// along the axis is a concave function of the path parameter, so it is positive inside where it is negative
/// at neither end, unless it is 0 at both.
fn side_by_side(a: &[LaneCell], b: &[LaneCell], mut touch: impl FnMut(&LaneCell, &LaneCell)) {
    let overlap = |p: (i64, i64), q: (i64, i64)| p.1.min(q.1) - p.0.max(q.0);
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        let mut ahead = j;
        // Cells of a lane do not overlap, so few lie beside one cell.
        while ahead < b.len() && b[ahead].before.0 <= a[i].before.1 {
            let (start, end) = (overlap(a[i].before, b[ahead].before), overlap(a[i].after, b[ahead].after));
            if start >= 0 && end >= 0 && start + end > 0 {
                touch(&a[i], &b[ahead]);
            }
            ahead += 1;
        }
        i += 1;
        while i < a.len() && j < b.len() && b[j].before.1 < a[i].before.0 {
            j += 1;
        }
    }
}

/// The relation of the cross-sections of two lanes.
enum Facing {
    /// They share at most a corner.
    Apart,
    /// The cross-sections touch along an edge.
    Beside,
    /// They overlap.
    InLine,
}

fn facing(a: &Section, b: &Section) -> Facing {
    let overlap = |k: usize| a[k].1.min(b[k].1) - a[k].0.max(b[k].0);
    match (overlap(0), overlap(1)) {
        (x, y) if x > 0 && y > 0 => Facing::InLine,
        (x, y) if (x == 0 && y > 0) || (x > 0 && y == 0) => Facing::Beside,
        _ => Facing::Apart,
    }
}
