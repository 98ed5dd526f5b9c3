//! Stages in which cells move along one axis only.
//!
//! Cells with the same cross-section make a lane. Within a lane, and between lanes whose
//! cross-sections overlap, the order along the axis may not change and gaps are never negative: gaps
//! are linear in the progress, so both ends say it for the whole stage, and neighbours say it for all.

use super::contacts::Forest;
use super::grid::Cube;
use super::tiles::{Section, Tile, Tiles};

/// Two cells that meet: at the start of the stage, or on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    pub cells: (u32, u32),
    pub at_start: bool,
}

/// A cell within its lane: its ends along the axis before and after.
#[derive(Clone, Copy)]
struct Place {
    before: (i64, i64),
    after: (i64, i64),
    cell: u32,
}

struct Lanes {
    /// By lane; in order along the axis before the stage.
    places: Vec<Place>,
    /// Where each lane begins in `places`, and the end.
    starts: Vec<usize>,
    sections: Vec<Section>,
    /// Of each lane, in order.
    tiles: Vec<Tile>,
}

/// Comparisons of lanes that a stage may take, for each cell: sound plans take a few.
const COMPARISONS_MAX: usize = 200;

/// Judges the stage and joins the cells whose contact lasts. `None`: too entangled to be judged.
pub fn judge(
    before: &[Cube],
    after: &[Cube],
    axis: usize,
    lines: i64,
    forest: &mut Forest,
) -> Option<Result<(), Meeting>> {
    let lanes = Lanes::of(before, after, axis, lines)?;
    let all = 0..lanes.sections.len();
    if let Some(meeting) = all.clone().find_map(|lane| in_line(lanes.lane(lane))) {
        return Some(Err(meeting));
    }
    let contacts = |places: &[Place], forest: &mut Forest| {
        for pair in places.windows(2) {
            if pair[0].before.1 == pair[1].before.0 && pair[0].after.1 == pair[1].after.0 {
                forest.touch(pair[0].cell, pair[1].cell, parting(&pair[0], &pair[1]));
            }
        }
    };
    all.for_each(|lane| contacts(lanes.lane(lane), forest));
    // Contacts along the axis come first: then the forces take the straight way.
    let mut beside = Vec::new();
    let mut merged = Vec::new();
    let mut left = budget(before.len());
    let mut meeting = None;
    lanes.neighbours(|a, b| {
        let (first, second) = (lanes.lane(a), lanes.lane(b));
        left = left.checked_sub(first.len() + second.len())?;
        match facing(&lanes.sections[a], &lanes.sections[b]) {
            Facing::Apart => {}
            Facing::Beside => beside.push((a as u32, b as u32)),
            Facing::InLine if meeting.is_none() => {
                merge(first, second, &mut merged);
                meeting = in_line(&merged);
                contacts(&merged, forest);
            }
            Facing::InLine => {}
        }
        Some(())
    })?;
    if let Some(meeting) = meeting {
        return Some(Err(meeting));
    }
    for (a, b) in beside {
        side_by_side(lanes.lane(a as usize), lanes.lane(b as usize), |p, q| {
            forest.touch(p.cell, q.cell, parting(p, q));
        });
    }
    Some(Ok(()))
}

/// Comparisons that a stage of so many cells may take.
fn budget(cells: usize) -> usize {
    COMPARISONS_MAX.saturating_mul(cells).saturating_add(1000)
}

impl Lanes {
    /// `None`: too many cross-sections in one place.
    fn of(before: &[Cube], after: &[Cube], axis: usize, lines: i64) -> Option<Lanes> {
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
        let empty = Place { before: (0, 0), after: (0, 0), cell: 0 };
        let mut places = vec![empty; before.len()];
        for (cell, ((old, new), lane)) in before.iter().zip(after).zip(lane_of).enumerate() {
            let at = &mut next[lane as usize];
            places[*at] = Place {
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

    fn lane(&self, lane: usize) -> &[Place] {
        &self.places[self.starts[lane]..self.starts[lane + 1]]
    }

    /// Calls with every pair of lanes that can touch: their corners are no more than a cell apart.
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

/// Twice the distance by which two cells move against each other.
fn parting(a: &Place, b: &Place) -> i64 {
    let moved = |p: &Place| p.after.0 + p.after.1 - p.before.0 - p.before.1;
    (moved(a) - moved(b)).abs()
}

/// The first two neighbours that meet.
fn in_line(places: &[Place]) -> Option<Meeting> {
    places.windows(2).find_map(|pair| {
        let at_start = pair[0].before.1 > pair[1].before.0;
        let meet = at_start || pair[0].after.1 > pair[1].after.0;
        meet.then_some(Meeting { cells: (pair[0].cell, pair[1].cell), at_start })
    })
}

fn merge(a: &[Place], b: &[Place], merged: &mut Vec<Place>) {
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

/// Finds the cells of two lanes that face each other all the while: their overlap along the axis is
/// concave in the progress, so it is positive inside where it is nowhere negative at the ends, unless
/// it is 0 at both.
fn side_by_side(a: &[Place], b: &[Place], mut touch: impl FnMut(&Place, &Place)) {
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

enum Facing {
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
