//! The broad phase of collision detection: finds the pairs of many things that may be near each other, by a uniform
//! grid.
//!
//! One structure for balls of one size ([`near_points`]) and for boxes of many sizes ([`near_boxes`]). A
//! grid, because modules and struts of a robot are of about the same size, so that a cell holds few of them
//! and the work is in proportion to their number; it is made anew for every posture, which takes less than
//! keeping a tree balanced. Pairs are reported in an order that depends on nothing but the positions.

use super::pose::Vec3;

/// The greatest number of cells of the grid of boxes, for each box.
const CELLS_PER_BOX: f64 = 8.0;

/// The number of cells of the sorted grid along each axis: coordinates reach from -2²⁰ to 2²⁰ cells, farther than
/// robots do.
const CELLS_ALONG: u64 = 1 << 21;
const CELLS_HALF: i64 = 1 << 20;

/// The index of no box; also the end of a list of boxes in a cell.
const NONE: u32 = u32::MAX;

/// An axis-aligned box, in metres, in a frame of the caller's choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner of least coordinates, m, in the frame of the box.
    pub low: Vec3,
    /// The corner of greatest coordinates, m, in the frame of the box.
    pub high: Vec3,
}

impl Aabb {
    /// Returns the least box around some points (m), in their frame; for no points, the empty box (`low` at +∞,
    /// `high` at -∞), which a union with another box leaves as the other.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Aabb {
        let none = Aabb { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) };
        points.into_iter().fold(none, |all, p| Aabb { low: all.low.inf(&p), high: all.high.sup(&p) })
    }

    /// Returns the height of the lowest point of the box along the unit vector `up`, from the origin of its frame, m.
    #[inline]
    pub fn lowest(&self, up: &Vec3) -> f64 {
        // A comparison, and not `min`, which looks for numbers that are none.
        let least = |a: f64, b: f64| if a < b { a } else { b };
        let (low, high) = (self.low.component_mul(up), self.high.component_mul(up));
        least(low.x, high.x) + least(low.y, high.y) + least(low.z, high.z)
    }

    /// Returns the gap to another box of the same frame along each axis, m; 0 along axes on which they overlap. The
    /// length of this vector is the distance of the boxes.
    #[inline]
    pub fn gap(&self, other: &Aabb) -> Vec3 {
        (self.low - other.high).sup(&(other.low - self.high)).sup(&Vec3::zeros())
    }
}

/// Calls `found(i, j, d²)` once for every pair `i < j` of `count` points (indices from 0; `point(i)` is the position
/// of point i) at a distance less than `reach` (> 0), with the square of that distance, both in the unit of the
/// points. The method is the fixed-radius search on a uniform grid (Bentley, Stanat and Williams 1977). Coordinates
/// must lie within 2²⁰ times `reach`. A pair at just this distance may be missed by rounding.
///
/// Points are sorted into cubes of that size, cubes into columns, and columns by their coordinates: the three cubes
/// of a column that may hold a point's neighbours are then contiguous in the list, and for each of the columns
/// around, this range advances with the points. There is no hash table and no memory for empty cubes.
pub fn near_points(
    count: usize,
    point: impl Fn(usize) -> Vec3,
    reach: f64,
    found: &mut dyn FnMut(usize, usize, f64),
) {
    all_near_points(count, point, reach, &mut |i, j, squared| {
        found(i, j, squared);
        true
    });
}

/// Returns true if `holds(i, j, d²)` does of every pair of points as [`near_points`] finds them; after the first of which it does
/// not, it is asked of no more.
pub fn all_near_points(
    count: usize,
    point: impl Fn(usize) -> Vec3,
    reach: f64,
    holds: &mut dyn FnMut(usize, usize, f64) -> bool,
) -> bool {
    const COLUMN: u64 = CELLS_ALONG;
    let cube = |x: f64| (floor(x / reach) + CELLS_HALF) as u64;
    let key = |p: &Vec3| cube(p.x) * COLUMN * COLUMN + cube(p.y) * COLUMN + cube(p.z);
    // Cubes in order of their columns, and in a column from below; within a cube by index.
    let mut order: Vec<(u64, u32)> = (0..count).map(|index| (key(&point(index)), index as u32)).collect();
    order.sort_unstable();
    let sorted: Vec<Vec3> = order.iter().map(|(_, index)| point(*index as usize)).collect();
    let mut holds = |i: usize, j: usize| {
        let squared = (sorted[j] - sorted[i]).norm_squared();
        if squared < reach * reach {
            let (a, b) = (order[i].1 as usize, order[j].1 as usize);
            return holds(a.min(b), a.max(b), squared);
        }
        true
    };
    // Of the 26 neighbouring cubes the 13 that come later: one in the same column, three in each of four others.
    let columns = [COLUMN, COLUMN * COLUMN - COLUMN, COLUMN * COLUMN, COLUMN * COLUMN + COLUMN];
    let mut first = [0; 4];
    for (i, (here, _)) in order.iter().enumerate() {
        for (j, (there, _)) in order.iter().enumerate().skip(i + 1) {
            if *there > here + 1 {
                break;
            }
            if !holds(i, j) {
                return false;
            }
        }
        for (first, column) in first.iter_mut().zip(columns) {
            while *first < order.len() && order[*first].0 < here + column - 1 {
                *first += 1;
            }
            for (j, (there, _)) in order.iter().enumerate().skip(*first) {
                if *there > here + column + 1 {
                    break;
                }
                if !holds(i, j) {
                    return false;
                }
            }
        }
    }
    true
}

/// Returns the greatest whole number that is at most `x`; a cast, and not `floor` of the library, which is a call.
fn floor(x: f64) -> i64 {
    let whole = x as i64;
    whole - i64::from(x < whole as f64)
}

/// Calls `found(i, j)` once for every pair `i < j` of boxes (by index in `boxes`, from 0) that come within `reach` (≥
/// 0, m) of each other along every axis, up to rounding: a superset of those that are nearer than `reach`. The method
/// is a uniform grid (compare Ericson, *Real-Time Collision Detection*, 2005, sec. 7.1). The calls are ordered by j,
/// then by cell and i. `cell` (> 0, m) is the least size of a cell, best about that of a box; grids of more than
/// `CELLS_PER_BOX` cells for each box are made coarser.
pub fn near_boxes(boxes: &[Aabb], reach: f64, cell: f64, mut found: impl FnMut(usize, usize)) {
    let margin = Vec3::repeat(reach / 2.0);
    let low = boxes.iter().fold(Vec3::repeat(f64::INFINITY), |low, b| low.inf(&b.low)) - margin;
    let high = boxes.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, b| high.sup(&b.high)) + margin;
    let mut size = cell.max(reach);
    let counts = |size: f64| (high - low).map(|length| libm::floor(length / size) + 1.0);
    while counts(size).product() > CELLS_PER_BOX * boxes.len() as f64 + 1.0 {
        size *= 2.0;
    }
    let counts = counts(size).map(|count| (count as usize).max(1));
    let index = |p: Vec3| ((p - low) / size).map(|v| v.max(0.0) as usize);
    // The boxes in each cell, in order, as linked lists of (box, next entry); of each cell the first and last entry.
    let mut cells = vec![(NONE, NONE); counts.product()];
    let mut entries: Vec<(u32, u32)> = Vec::with_capacity(8 * boxes.len());
    // The last box that each was tested against: two boxes may share many cells.
    let mut tested = vec![NONE; boxes.len()];
    for (j, box_j) in boxes.iter().enumerate() {
        let (from, to) = (index(box_j.low - margin), index(box_j.high + margin));
        for a in from.x..=to.x.min(counts.x - 1) {
            for b in from.y..=to.y.min(counts.y - 1) {
                for c in from.z..=to.z.min(counts.z - 1) {
                    let (first, last) = &mut cells[(a * counts.y + b) * counts.z + c];
                    let mut at = *first;
                    while at != NONE {
                        let (i, next) = entries[at as usize];
                        at = next;
                        let i = i as usize;
                        if std::mem::replace(&mut tested[i], j as u32) == j as u32 {
                            continue;
                        }
                        let gap = boxes[i].gap(box_j);
                        if gap.x <= reach && gap.y <= reach && gap.z <= reach {
                            found(i, j);
                        }
                    }
                    let entry = entries.len() as u32;
                    entries.push((j as u32, NONE));
                    if *last == NONE {
                        *first = entry;
                    } else {
                        entries[*last as usize].1 = entry;
                    }
                    *last = entry;
                }
            }
        }
    }
}
