//! Rectangles that go straight from one place to another in the plane: whether they hit each other, and whether contacts
//! that last hold them all together.
//!
//! This is a sufficient condition in the planner's own arithmetic; the judge of plans knows more motions and has its
//! own. Both ends of all faces are whole numbers of grid lines, so nothing is rounded.

use crate::planners::disjoint_sets::DisjointSets;

/// A rectangle: the coordinates of its lower and upper sides along x and y, in lines of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub(super) lo: [i64; 2],
    pub(super) hi: [i64; 2],
}

/// The way of a rectangle: where it is before and after.
type Way = (Rectangle, Rectangle);

/// Returns twice the greatest displacement along an axis, in lines, by which two rectangles that stay in contact move against
/// each other; `before` and `after` hold the same rectangles by number. `None` if two are not kept apart by the same axis
/// all the time, or contacts over sides that last all the time do not hold all together.
pub(super) fn greatest_slide(before: &[Rectangle], after: &[Rectangle]) -> Option<i64> {
    let ways: Vec<Way> = before.iter().copied().zip(after.iter().copied()).collect();
    // Swept along the axis along which they are spread farthest, so that few are near each other.
    let spread = |axis: usize| {
        let low = before.iter().map(|r| r.lo[axis]).min().unwrap_or(0);
        before.iter().map(|r| r.hi[axis]).max().unwrap_or(0) - low
    };
    let axis = usize::from(spread(1) > spread(0));
    let first = |(a, b): &Way| a.lo[axis].min(b.lo[axis]);
    let mut order: Vec<usize> = (0..ways.len()).collect();
    order.sort_unstable_by_key(|&i| first(&ways[i]));
    let mut joined = DisjointSets::new(ways.len());
    let mut greatest = 0;
    for (k, &i) in order.iter().enumerate() {
        let last = ways[i].0.hi[axis].max(ways[i].1.hi[axis]);
        for &j in order[k + 1..].iter().take_while(|&&j| first(&ways[j]) <= last) {
            match meeting(&ways[i], &ways[j])? {
                Meeting::Apart => {}
                Meeting::Passing(slide) => greatest = greatest.max(slide),
                Meeting::Contact(slide) => {
                    greatest = greatest.max(slide);
                    joined.join(i, j);
                }
            }
        }
    }
    (joined.count() <= 1).then_some(greatest)
}

/// The relation of two rectangles on their ways, which are apart all the time.
enum Meeting {
    /// They do not touch all the time.
    Apart,
    /// They touch all the time, but perhaps only at corners; with twice their relative displacement.
    Passing(i64),
    /// They touch over a part of a side at all times but perhaps the first or last; with twice their relative
    /// displacement.
    Contact(i64),
}

/// Returns the relation of two rectangles; `None` if no axis keeps them apart all the time.
fn meeting(first: &Way, second: &Way) -> Option<Meeting> {
    let mut found = None;
    for axis in 0..2 {
        let gaps = |p: &Way, q: &Way| [q.0.lo[axis] - p.0.hi[axis], q.1.lo[axis] - p.1.hi[axis]];
        for gaps in [gaps(first, second), gaps(second, first)] {
            // Gaps change evenly, so that they are not negative between either.
            if gaps.iter().any(|gap| *gap < 0) {
                continue;
            }
            let touching = if gaps == [0; 2] { touching(first, second, 1 - axis) } else { Meeting::Apart };
            match touching {
                Meeting::Apart => found = found.or(Some(Meeting::Apart)),
                touching => return Some(touching),
            }
        }
    }
    found
}

/// Returns the relation of two rectangles one of whose sides lie on one line all the time, by what they have in common along the
/// axis of that line.
fn touching(first: &Way, second: &Way, along: usize) -> Meeting {
    let common = |p: &Rectangle, q: &Rectangle| p.hi[along].min(q.hi[along]) - p.lo[along].max(q.lo[along]);
    let common = [common(&first.0, &second.0), common(&first.1, &second.1)];
    if common.iter().any(|length| *length < 0) {
        return Meeting::Apart;
    }
    let moved = |way: &Way, k: usize| way.1.lo[k] + way.1.hi[k] - way.0.lo[k] - way.0.hi[k];
    let slide = (0..2).map(|k| (moved(first, k) - moved(second, k)).abs()).max().unwrap_or(0);
    // The common length is concave in time: above 0 at one end, it is so all the time between.
    if common == [0; 2] { Meeting::Passing(slide) } else { Meeting::Contact(slide) }
}
