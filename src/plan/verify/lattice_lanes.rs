//! Stages in which cells move along one axis only.
//!
//! Cells with the same cross-section make a lane. Within a lane, and between lanes whose
//! cross-sections overlap, the order along the axis may not change and gaps are never negative: gaps
//! are linear in the progress, so both ends say it for the whole stage, and neighbours say it for all.

use super::lattice_contacts::Forest;
use super::lattice_grid::Cube;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

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

/// Cross-section: low and high along the two axes that do not change.
type Section = [(i64, i64); 2];

struct Lanes {
    /// By lane; in order along the axis before the stage.
    places: Vec<Place>,
    /// Where each lane begins in `places`, and the end.
    starts: Vec<usize>,
    sections: Vec<Section>,
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
    let lanes = Lanes::of(before, after, axis);
    for lane in 0..lanes.sections.len() {
        if let Some(meeting) = in_line(lanes.lane(lane)) {
            return Some(Err(meeting));
        }
    }
    let contacts = |places: &[Place], forest: &mut Forest| {
        for pair in places.windows(2) {
            if pair[0].before.1 == pair[1].before.0 && pair[0].after.1 == pair[1].after.0 {
                forest.touch(pair[0].cell, pair[1].cell, parting(&pair[0], &pair[1]));
            }
        }
    };
    (0..lanes.sections.len()).for_each(|lane| contacts(lanes.lane(lane), forest));
    // Contacts along the axis come first: then the forces take the straight way.
    let mut beside = Vec::new();
    let mut merged = Vec::new();
    let mut left = COMPARISONS_MAX.saturating_mul(before.len()).saturating_add(1000);
    for (a, b) in neighbours(&lanes.sections, lines, left)? {
        let (first, second) = (lanes.lane(a), lanes.lane(b));
        left = left.checked_sub(first.len() + second.len())?;
        match facing(&lanes.sections[a], &lanes.sections[b]) {
            Facing::Apart => {}
            Facing::Beside => beside.push((a, b)),
            Facing::InLine => {
                merge(first, second, &mut merged);
                if let Some(meeting) = in_line(&merged) {
                    return Some(Err(meeting));
                }
                contacts(&merged, forest);
            }
        }
    }
    for (a, b) in beside {
        side_by_side(lanes.lane(a), lanes.lane(b), |p, q| forest.touch(p.cell, q.cell, parting(p, q)));
    }
    Some(Ok(()))
}

impl Lanes {
    fn of(before: &[Cube], after: &[Cube], axis: usize) -> Lanes {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut known: HashMap<Section, u32, BuildHasherDefault<Mixer>> = HashMap::default();
        let mut sections: Vec<Section> = Vec::new();
        let mut lane_of: Vec<u32> = Vec::with_capacity(before.len());
        let mut sizes: Vec<usize> = Vec::new();
        for cube in before {
            let section = [(cube.lo[b], cube.hi[b]), (cube.lo[c], cube.hi[c])];
            let lane = match lane_of.last() {
                Some(&last) if sections[last as usize] == section => last,
                _ => *known.entry(section).or_insert_with(|| {
                    sections.push(section);
                    sizes.push(0);
                    sections.len() as u32 - 1
                }),
            };
            lane_of.push(lane);
            sizes[lane as usize] += 1;
        }
        let mut starts = Vec::with_capacity(sizes.len() + 1);
        let mut end = 0;
        for size in &sizes {
            starts.push(end);
            end += size;
        }
        starts.push(end);
        let mut next = starts.clone();
        let empty = Place { before: (0, 0), after: (0, 0), cell: 0 };
        let mut places = vec![empty; before.len()];
        for (cell, (old, new)) in before.iter().zip(after).enumerate() {
            let at = &mut next[lane_of[cell] as usize];
            places[*at] = Place {
                before: (old.lo[axis], old.hi[axis]),
                after: (new.lo[axis], new.hi[axis]),
                cell: cell as u32,
            };
            *at += 1;
        }
        for lane in starts.windows(2) {
            places[lane[0]..lane[1]].sort_by_key(|place| place.before);
        }
        Lanes { places, starts, sections }
    }

    fn lane(&self, lane: usize) -> &[Place] {
        &self.places[self.starts[lane]..self.starts[lane + 1]]
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

/// Pairs of lanes that can touch: their corners are no more than a cell apart. `None`: more than `most`.
fn neighbours(sections: &[Section], lines: i64, most: usize) -> Option<Vec<(usize, usize)>> {
    let origin = |k: usize| sections.iter().map(|s| s[k].0).min().unwrap_or(0);
    let (first, second) = (origin(0), origin(1));
    let tile = |s: &Section| ((s[1].0 - second).div_euclid(lines), (s[0].0 - first).div_euclid(lines));
    let mut order: Vec<((i64, i64), u32)> =
        sections.iter().enumerate().map(|(lane, s)| (tile(s), lane as u32)).collect();
    order.sort_unstable();
    let mut pairs = Vec::new();
    // In the same tile and the next of the row, and in three tiles of the next row: the other halves
    // of the pairs were met before.
    let mut next_row = 0;
    for (i, &((row, column), lane)) in order.iter().enumerate() {
        let same = order[i + 1..].iter().take_while(|(tile, _)| *tile <= (row, column + 1));
        pairs.extend(same.map(|(_, other)| (lane as usize, *other as usize)));
        while next_row < order.len() && order[next_row].0 < (row + 1, column - 1) {
            next_row += 1;
        }
        let above = order[next_row..].iter().take_while(|(tile, _)| *tile <= (row + 1, column + 1));
        pairs.extend(above.map(|(_, other)| (lane as usize, *other as usize)));
        if pairs.len() > most {
            return None;
        }
    }
    Some(pairs)
}

/// A quick hash for keys that come from a grid; no order depends on it.
#[derive(Default)]
pub struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u64(&mut self, n: u64) {
        self.0 = (self.0.rotate_left(5) ^ n).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }

    fn write_i64(&mut self, n: i64) {
        self.write_u64(n as u64);
    }

    fn write_usize(&mut self, n: usize) {
        self.write_u64(n as u64);
    }
}
