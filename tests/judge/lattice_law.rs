//! The law of lattice motion against a second count: every pair of cells by itself, and time scalings by their differences.

use crate::support::numbers::Numbers;
use modl::plan::lattice::contacts::ContactForest;
use modl::plan::lattice::lanes::Overlap;
use modl::plan::lattice::law::{Change, TimeScaling, velocities_continue};
use modl::plan::lattice::transient::{contact_intervals, transient_contacts};
use modl::plan::lattice::{Cube, boxes, lanes};
use modl::plan::{CauseId, Law, Ratio, Stage, StageEnd};
use std::cmp::Ordering;

/// Returns a whole number from `low` to `high`.
fn whole(n: &mut Numbers, low: i64, high: i64) -> i64 {
    low + n.below((high - low + 1) as usize) as i64
}

fn three(mut of: impl FnMut() -> i64) -> [i64; 3] {
    [of(), of(), of()]
}

/// Returns a cell with these lower faces and edges.
fn cube(lo: [i64; 3], size: [i64; 3]) -> Cube {
    Cube { lo, hi: [0, 1, 2].map(|axis| lo[axis] + size[axis]) }
}

#[test]
fn changes_are_the_sums_and_extremes_over_all_cells() {
    let mut n = Numbers(1);
    for round in 0..500 {
        let count = n.below(6) + 1;
        let (reach, still) = (whole(&mut n, 0, 3), n.below(3));
        let mut before = Vec::new();
        let mut after = Vec::new();
        for _ in 0..count {
            let (lo, size) = (three(|| whole(&mut n, -9, 9)), three(|| whole(&mut n, 2, 5)));
            before.push(cube(lo, size));
            let (by, more) =
                (three(|| whole(&mut n, -reach, reach)), three(|| whole(&mut n, 0, reach.min(1))));
            let here = [0, 1, 2].map(|axis| if axis == still { lo[axis] } else { lo[axis] + by[axis] });
            after.push(cube(
                here,
                [0, 1, 2].map(|axis| if axis == still { size[axis] } else { size[axis] + more[axis] }),
            ));
        }
        let found = Change::of(&before, &after);
        // Every axis of every cell, in the order in which the first of equal ones is kept.
        let all: Vec<(u32, usize)> =
            (0..count as u32).flat_map(|cell| [0, 1, 2].map(|axis| (cell, axis))).collect();
        let moved = |cell: u32, axis: usize| {
            let (a, b) = (&before[cell as usize], &after[cell as usize]);
            b.lo[axis] + b.hi[axis] - a.lo[axis] - a.hi[axis]
        };
        let edge = |cubes: &[Cube], cell: u32, axis: usize| {
            cubes[cell as usize].hi[axis] - cubes[cell as usize].lo[axis]
        };
        let resized = |cell: u32, axis: usize| (edge(&after, cell, axis) - edge(&before, cell, axis)).abs();
        let greatest = |of: &dyn Fn(u32, usize) -> i64| {
            let most = all.iter().map(|&(cell, axis)| of(cell, axis)).max().expect("there are cells");
            (most, all.iter().find(|&&(cell, axis)| of(cell, axis) == most).expect("one of them").0)
        };
        let nothing = |(value, cell): (i64, u32)| if value == 0 { (0, 0) } else { (value, cell) };
        assert_eq!(found.farthest, nothing(greatest(&|cell, axis| moved(cell, axis).abs())), "{round}");
        assert_eq!(found.resized, nothing(greatest(&resized)), "{round}");
        assert_eq!(found.largest, greatest(&|cell, axis| edge(&after, cell, axis)), "{round}");
        let (least, smallest) = greatest(&|cell, axis| -edge(&after, cell, axis));
        assert_eq!(found.smallest, (-least, smallest), "{round}");
        for axis in 0..3 {
            let moves = |cell: u32| moved(cell, axis) != 0 || resized(cell, axis) != 0;
            assert_eq!(found.axes[axis], (0..count as u32).any(moves), "{round}");
            let drift: i64 = (0..count as u32).map(|cell| moved(cell, axis)).sum();
            assert_eq!(found.drift[axis], i128::from(drift), "{round}");
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let about = |cell: u32| {
                let at = |axis: usize| before[cell as usize].lo[axis] + before[cell as usize].hi[axis];
                at(b) * moved(cell, c) - at(c) * moved(cell, b)
            };
            let turning: i64 = (0..count as u32).map(about).sum();
            assert_eq!(found.turning[axis], i128::from(turning), "{round}");
        }
        assert_eq!(found.is_none(), before == after);
        let square = |cell: u32| (0..3).map(|axis| moved(cell, axis) * moved(cell, axis)).sum::<i64>();
        let squares: Vec<i64> = (0..count as u32).map(square).collect();
        assert_eq!(found.squares, i128::from(squares.iter().sum::<i64>()), "{round}");
        assert_eq!(found.square, i128::from(*squares.iter().max().expect("cells")), "{round}");
    }
}

fn stage(law: Law, time_squared: Ratio) -> Stage {
    Stage { name: "by hand".into(), time_squared, law, end: StageEnd::Runs(vec![]), cause: CauseId(0) }
}

/// Returns a law of each kind with ramps of twelfths.
fn laws(n: &mut Numbers) -> [Law; 4] {
    let part = |most: i64, n: &mut Numbers| Ratio(whole(n, 1, most), 12);
    [Law::BangBang, Law::Trapezoid(part(6, n)), Law::SpeedUp(part(12, n)), Law::SlowDown(part(12, n))]
}

/// Returns the greatest of the slopes of a law between two values of its progress, and the greatest of its curvature, by
/// differences over 4,800 parts of the duration, of which ramps of twelfths are whole numbers.
fn steepest(law: Law, from: f64, to: f64) -> (f64, f64) {
    const PARTS: u32 = 4800;
    let at = |k: u32| law.progress(f64::from(k) / f64::from(PARTS));
    let within = (0..PARTS).filter(|&k| at(k) >= from - 1e-12 && at(k + 1) <= to + 1e-12);
    let slope = |k: u32| (at(k + 1) - at(k)) * f64::from(PARTS);
    let bend = |k: u32| (slope(k) - slope(k - 1)).abs() * f64::from(PARTS);
    let speed = within.map(slope).fold(0.0, f64::max);
    (speed, (1..PARTS).map(bend).fold(0.0, f64::max))
}

/// A limit a hundredth below the value is exceeded, and one a hundredth above is not.
fn exceeds(value: f64, of: impl Fn(Ratio) -> Ordering) {
    let scaled = |factor: f64| Ratio((value * factor * 1e6) as i64, 1_000_000);
    assert_eq!((of(scaled(0.99)), of(scaled(1.01))), (Ordering::Greater, Ordering::Less), "{value}");
}

#[test]
fn speeds_and_accelerations_are_those_of_the_law_by_differences() {
    let mut n = Numbers(2);
    for _ in 0..8 {
        for law in laws(&mut n) {
            let time_squared = Ratio(whole(&mut n, 1, 40), whole(&mut n, 1, 5));
            let (time, scaling) =
                (libm::sqrt(time_squared.to_f64()), TimeScaling::of(&stage(law, time_squared)));
            let (speed, bend) = steepest(law, 0.0, 1.0);
            let (speed, bend) = (speed / time, bend / time / time);
            assert!((scaling.peak_speed() / speed - 1.0).abs() < 1e-3, "{law:?} {speed}");
            assert!((scaling.peak_acceleration() / bend - 1.0).abs() < 1e-3, "{law:?} {bend}");
            let (above, below) = scaling.acceleration_ratio();
            assert!((above as f64 / below as f64 / (bend * time * time) - 1.0).abs() < 1e-3, "{law:?}");
            let (distance, lines) = (whole(&mut n, 1, 30), whole(&mut n, 1, 9));
            let part = distance as f64 / lines as f64;
            exceeds(part * bend, |limit| scaling.compare_acceleration(distance.into(), lines.into(), limit));
            exceeds(part * part * speed * speed, |limit| {
                scaling.compare_speed_squared(distance, lines, limit)
            });
            // Against 1, with the square of a distance.
            let lines = |factor: f64| (1e3 * bend * factor) as i128;
            let against = |factor: f64| scaling.compare_acceleration_squared(1_000_000, lines(factor));
            if bend > 0.5 {
                assert_eq!((against(0.99), against(1.01)), (Ordering::Greater, Ordering::Less), "{law:?}");
            }
        }
    }
}

/// While the progress is in a window, ramps keep the speed down: by how much differences tell.
#[test]
fn speeds_in_a_window_are_those_of_the_law_there() {
    let mut n = Numbers(3);
    let cell = |x: i64| cube([x, 0, 0], [1, 1, 1]);
    let mut whole_window =
        transient_contacts(&[cell(0), cell(1)], &[cell(0), cell(1)]).expect("few pairs")[0].window;
    for _ in 0..40 {
        for law in laws(&mut n) {
            let time_squared = Ratio(whole(&mut n, 1, 40), whole(&mut n, 1, 5));
            let (time, scaling) =
                (libm::sqrt(time_squared.to_f64()), TimeScaling::of(&stage(law, time_squared)));
            let (a, b) = (whole(&mut n, 0, 15), whole(&mut n, 1, 16));
            (whole_window.from, whole_window.to) = ((a.min(b - 1).into(), 16), (b.max(a + 1).into(), 16));
            let window = whole_window;
            let end = |fraction: (i128, i128)| fraction.0 as f64 / fraction.1 as f64;
            let (speed, _) = steepest(law, end(window.from), end(window.to));
            let (speed, distance) = (speed / time, whole(&mut n, 1, 30));
            // Differences are a little less than what is reached at an end of the window.
            let square = libm::pow(distance as f64 / 7.0 * speed, 2.0);
            exceeds(square, |limit| scaling.compare_speed_squared_within(window, distance, 7, limit));
        }
    }
}

/// Velocities at the end of one stage and at the start of the next, from the slopes of their laws there.
#[test]
fn velocities_continue_where_the_slopes_at_both_sides_are_the_same() {
    let mut n = Numbers(4);
    let (mut same, mut other) = (0, 0);
    for _ in 0..4000 {
        let law = |n: &mut Numbers| laws(n)[n.below(4)];
        let (first, second) = (law(&mut n), law(&mut n));
        let squares = [1, 4, 9].map(|t| Ratio(t, 4));
        let (before_time, after_time) = (squares[n.below(3)], squares[n.below(3)]);
        let speed = |law: Law, from: f64, time: Ratio| {
            const STEP: f64 = 1e-9;
            (law.progress(from + STEP) - law.progress(from)) / STEP / libm::sqrt(time.to_f64())
        };
        let (out, into) = (speed(first, 1.0 - 1e-9, before_time), speed(second, 0.0, after_time));
        // Displacements that often fit the speeds, but for the sign or one of the axes.
        let cells = [0, 1].map(|i| cube([4 * i, 0, 0], [2; 3]));
        let by = |n: &mut Numbers| three(|| whole(n, -1, 1) * [1, 2, 3, 6][n.below(4)]);
        let shifts = [by(&mut n), by(&mut n)];
        let factor = if into > 1e-3 { (out / into).round() as i64 } else { 1 };
        let mut next = shifts.map(|shift| shift.map(|d| d * factor));
        if n.below(2) == 0 {
            next[n.below(2)][n.below(3)] *= whole(&mut n, -1, 2);
        }
        let between: Vec<Cube> = (0..2).map(|i| cells[i].shifted(shifts[i])).collect();
        let after: Vec<Cube> = (0..2).map(|i| between[i].shifted(next[i])).collect();
        let jumps = |i: usize| {
            (0..3).any(|axis| (shifts[i][axis] as f64 * out - next[i][axis] as f64 * into).abs() > 1e-4)
        };
        let expected = (0..2).find(|&i| jumps(i)).map_or(Ok(()), Err);
        let (first, second) = (stage(first, before_time), stage(second, after_time));
        let found = velocities_continue((&first, &cells), &between, (&second, &after));
        assert_eq!(found, expected, "{first:?} {second:?} {shifts:?}");
        let moving = out > 1e-3 || into > 1e-3;
        (same, other) = (same + usize::from(moving && found.is_ok()), other + usize::from(found.is_err()));
    }
    assert!(same > 20 && other > 500, "{same} {other}");
}

/// Two cells over a stage, each before and after it.
type Pair<'a> = [(&'a Cube, &'a Cube); 2];

/// Returns how far the upper face of the first is above the lower one of the second along an axis, when a part of the stage
/// is done, and the same with the two exchanged.
fn past([a, b]: Pair, axis: usize, part: f64) -> [f64; 2] {
    let at = |start: i64, end: i64| start as f64 + (end - start) as f64 * part;
    [(a, b), (b, a)].map(|(p, q)| at(p.0.hi[axis], p.1.hi[axis]) - at(q.0.lo[axis], q.1.lo[axis]))
}

/// Returns parts of the stage in the middle between any two at which something of a pair begins or ends.
fn middles(pair: Pair) -> Vec<f64> {
    let mut instants = vec![0.0, 1.0];
    for axis in 0..3 {
        for (start, end) in past(pair, axis, 0.0).into_iter().zip(past(pair, axis, 1.0)) {
            if (start > 0.0) != (end > 0.0) {
                instants.push(start / (start - end));
            }
        }
    }
    instants.sort_by(f64::total_cmp);
    instants.windows(2).filter(|w| w[1] - w[0] > 1e-9).map(|w| (w[0] + w[1]) / 2.0).collect()
}

fn overlap_at(pair: Pair, part: f64) -> bool {
    (0..3).all(|axis| past(pair, axis, part).iter().all(|depth| *depth > 1e-9))
}

/// Returns the axis across which two cells have a common part of a face.
fn touch_at(pair: Pair, part: f64) -> Option<usize> {
    let closed = |axis: usize| past(pair, axis, part).iter().any(|depth| depth.abs() < 1e-9);
    let across = |axis: usize| past(pair, axis, part).iter().all(|depth| *depth > 1e-9);
    (0..3).find(|axis| closed(*axis) && across((axis + 1) % 3) && across((axis + 2) % 3))
}

/// Returns true if a contact across an axis is one of more than an edge at one end of the stage at least: else it counts as one
/// that begins and ends.
fn has_face(pair: Pair, axis: usize) -> bool {
    let wide =
        |axis: usize| [0.0, 1.0].iter().any(|end| past(pair, axis, *end).iter().all(|depth| *depth > 1e-9));
    wide((axis + 1) % 3) && wide((axis + 2) % 3)
}

/// A stage by all pairs of its cells.
#[derive(Default)]
struct Counted {
    /// The pairs that overlap, and whether they do so at the start.
    overlaps: Vec<((u32, u32), bool)>,
    /// The pairs in contact all the while, with twice their relative displacement.
    lasting: Vec<((u32, u32), i64)>,
    /// The pairs in contact for a while.
    passing: Vec<(u32, u32)>,
}

fn counted(before: &[Cube], after: &[Cube]) -> Counted {
    let mut all = Counted::default();
    for j in 0..before.len() {
        for i in 0..j {
            let (pair, cells) = ([(&before[i], &after[i]), (&before[j], &after[j])], (i as u32, j as u32));
            let parts = middles(pair);
            if overlap_at(pair, 0.0) || parts.iter().any(|part| overlap_at(pair, *part)) {
                all.overlaps.push((cells, overlap_at(pair, 0.0)));
            }
            let touching: Vec<usize> = parts.iter().filter_map(|part| touch_at(pair, *part)).collect();
            let moved = |k: usize, axis: usize| after[k].middle(axis) - before[k].middle(axis);
            let relative = (0..3).map(|axis| (moved(i, axis) - moved(j, axis)).abs()).max().unwrap_or(0);
            if touching.len() == parts.len() && has_face(pair, touching[0]) {
                all.lasting.push((cells, relative));
            }
            if !touching.is_empty() {
                all.passing.push(cells);
            }
        }
    }
    all
}

/// Returns the least number among the cells that hang together with each.
fn pieces(count: usize, pairs: impl Iterator<Item = (u32, u32)>) -> Vec<u32> {
    let mut least: Vec<u32> = (0..count as u32).collect();
    for (a, b) in pairs {
        let (p, q) = (least[a as usize], least[b as usize]);
        least.iter_mut().filter(|x| **x == p.max(q)).for_each(|x| *x = p.min(q));
    }
    least
}

/// Compares what a search found with all pairs.
fn agree(
    found: Option<Result<(), Overlap>>,
    forest: &mut ContactForest,
    all: &Counted,
    count: usize,
) -> bool {
    let found = found.expect("there are few pairs");
    match found {
        Err(overlap) => {
            let (a, b) = overlap.cells;
            let cells = (a.min(b), a.max(b));
            assert!(all.overlaps.contains(&(cells, overlap.at_start)), "{overlap:?} of {:?}", all.overlaps);
        }
        Ok(()) => {
            assert_eq!(all.overlaps, [], "none was found");
            let expected = pieces(count, all.lasting.iter().map(|(cells, _)| *cells));
            assert_eq!(pieces(count, forest.links.iter().copied()), expected);
            assert_eq!(forest.relative, all.lasting.iter().map(|(_, relative)| *relative).max().unwrap_or(0));
            let mut sizes: Vec<(usize, u32)> = (0..count as u32)
                .map(|cell| (expected.iter().filter(|least| **least == cell).count(), cell))
                .filter(|(size, _)| *size > 0)
                .collect();
            assert_eq!(forest.is_connected(), sizes.len() == 1);
            sizes.sort_by_key(|&(size, cell)| (std::cmp::Reverse(size), cell));
            assert_eq!(forest.components(), sizes);
            if forest.relative > 0 {
                let (a, b) = forest.fastest;
                assert!(all.lasting.contains(&((a.min(b), a.max(b)), forest.relative)));
            }
        }
    }
    found.is_ok()
}

/// Returns columns of cells along an axis that slide and stretch along it: within a column the cells keep their order, unless
/// one of them is in the way.
fn columns(n: &mut Numbers, axis: usize) -> (Vec<Cube>, Vec<Cube>) {
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    let faulty = n.below(3) == 0;
    let from = three(|| whole(n, -9, 9));
    for _ in 0..n.below(8) + 2 {
        let place = [whole(n, 0, 3), whole(n, 0, 3)];
        let (mut start, mut end) = (whole(n, 0, 3), whole(n, 0, 3));
        for _ in 0..n.below(4) + 1 {
            let gap = |n: &mut Numbers| [0, 0, 0, 1, 4][n.below(5)] - i64::from(faulty && n.below(10) == 0);
            let (sizes, tight) = ([whole(n, 2, 4), whole(n, 2, 4)], n.below(2) == 0);
            let gaps = if tight { [0, 0] } else { [gap(n), gap(n)] };
            (start, end) = (start + gaps[0], end + gaps[1]);
            let across = [0, 1].map(|_| (whole(n, 0, 2), whole(n, 2, 4)));
            let of = |along: i64, size: i64| {
                let (mut lo, mut edges) = (from, [size; 3]);
                lo[axis] += along;
                for (k, other) in [b, c].into_iter().enumerate() {
                    // Mostly all of the column's width.
                    let (inset, width) = if across[k].1 > 2 { (0, 4) } else { (across[k].0, 2) };
                    lo[other] += 4 * place[k] + inset;
                    edges[other] = width;
                }
                cube(lo, edges)
            };
            before.push(of(start, sizes[0]));
            after.push(of(end, sizes[1]));
            (start, end) = (start + sizes[0], end + sizes[1]);
        }
    }
    (before, after)
}

#[test]
fn sweeps_along_an_axis_find_what_all_pairs_tell() {
    let mut n = Numbers(5);
    let mut sound = 0;
    for round in 0..1500 {
        let axis = round % 3;
        let (before, after) = columns(&mut n, axis);
        let all = counted(&before, &after);
        let mut forest = ContactForest::new(before.len());
        let found = lanes::examine(&before, &after, axis, 4, &mut forest);
        sound += usize::from(agree(found, &mut forest, &all, before.len()));
        let mut forest = ContactForest::new(before.len());
        let found = boxes::examine(&before, &after, &mut forest);
        agree(found, &mut forest, &all, before.len());
    }
    assert!((300..1400).contains(&sound), "{sound}");
}

/// Returns cells that move and stretch along all axes; some are fixed to one another.
fn scattered(n: &mut Numbers) -> (Vec<Cube>, Vec<Cube>) {
    let (mut before, mut after): (Vec<Cube>, Vec<Cube>) = (Vec::new(), Vec::new());
    let (few, reach) = (n.below(3) > 0, [0, 1, 2, 5][n.below(4)]);
    for _ in 0..if few { 2 + n.below(3) } else { 4 + n.below(12) } {
        let spread = if few { 6 } else { 14 };
        let (mut lo, size) = (three(|| whole(n, -spread, spread)), three(|| whole(n, 2, 5)));
        let mut to = lo;
        (0..3).for_each(|axis| to[axis] += whole(n, -reach, reach));
        let mut sizes = [size, size];
        if n.below(4) == 0 {
            sizes[1] = three(|| whole(n, 2, 5));
        }
        if n.below(2) == 0 && !before.is_empty() {
            // Beside one that is there, before and after.
            let (other, axis) = (n.below(before.len()), n.below(3));
            (lo, to) = (before[other].lo, after[other].lo);
            lo[axis] = before[other].hi[axis];
            to[axis] = after[other].hi[axis];
            let across = (axis + 1 + n.below(2)) % 3;
            (lo[across], to[across]) = (lo[across] + whole(n, -3, 3), to[across] + whole(n, -3, 3));
        }
        let (a, b) = (cube(lo, sizes[0]), cube(to, sizes[1]));
        let meets = |i: usize| overlap_at([(&before[i], &after[i]), (&a, &b)], 0.0);
        if n.below(20) > 0 && (0..before.len()).any(meets) {
            continue;
        }
        before.push(a);
        after.push(b);
    }
    (before, after)
}

#[test]
fn searches_in_all_directions_find_what_all_pairs_tell() {
    let mut n = Numbers(6);
    let mut sound = 0;
    for _ in 0..3000 {
        let (before, after) = scattered(&mut n);
        let all = counted(&before, &after);
        let mut forest = ContactForest::new(before.len());
        let found = boxes::examine(&before, &after, &mut forest);
        sound += usize::from(agree(found, &mut forest, &all, before.len()));
    }
    assert!((500..2700).contains(&sound), "{sound}");
}

/// Contacts for a while: as long as samples say, and between two of their ends the same ones hold.
#[test]
fn contacts_that_come_and_go_are_those_of_samples() {
    let mut n = Numbers(7);
    let mut passing = 0;
    for round in 0..300 {
        let (before, after) = if round % 3 == 0 { scattered(&mut n) } else { columns(&mut n, round % 3) };
        let all = counted(&before, &after);
        let found = transient_contacts(&before, &after).expect("there are few pairs");
        let length =
            |from: (i128, i128), to: (i128, i128)| to.0 as f64 / to.1 as f64 - from.0 as f64 / from.1 as f64;
        let pair_of =
            |cells: (u32, u32)| [cells.0 as usize, cells.1 as usize].map(|i| (&before[i], &after[i]));
        let mut cells: Vec<(u32, u32)> = found.iter().map(|contact| contact.cells).collect();
        cells.sort_unstable();
        let mut expected = all.passing;
        expected.sort_unstable();
        assert_eq!(cells, expected);
        for contact in &found {
            let pair = pair_of(contact.cells);
            let touching =
                (0..500).filter(|k| touch_at(pair, (f64::from(*k) + 0.5) / 500.0).is_some()).count();
            let part = touching as f64 / 500.0;
            assert!(
                (length(contact.window.from, contact.window.to) - part).abs() < 5e-3,
                "{contact:?} {part}"
            );
            let moved =
                |k: u32, axis: usize| after[k as usize].middle(axis) - before[k as usize].middle(axis);
            let (a, b) = contact.cells;
            let relative = (0..3).map(|axis| (moved(a, axis) - moved(b, axis)).abs()).max();
            assert_eq!(Some(contact.relative), relative);
        }
        let intervals = contact_intervals(&found, before.len()).expect("there are few");
        let whole: f64 = intervals.iter().map(|window| length(window.from, window.to)).sum();
        assert!((whole - 1.0).abs() < 1e-12);
        for window in intervals {
            let middle = (length((0, 1), window.from) + length((0, 1), window.to)) / 2.0;
            for contact in &found {
                let pair = pair_of(contact.cells);
                assert_eq!(
                    contact.window.contains(window),
                    touch_at(pair, middle).is_some(),
                    "{contact:?} {window:?}"
                );
                passing += usize::from(!contact.window.contains(window));
            }
        }
    }
    assert!(passing > 100, "{passing}");
}

/// Pairs are visited if their swept boxes touch or overlap, and no others.
#[test]
fn pairs_that_come_near_are_those_of_swept_boxes() {
    let mut n = Numbers(8);
    for round in 0..600 {
        let (before, after) = if round % 3 == 0 { scattered(&mut n) } else { columns(&mut n, round % 3) };
        let mut found = Vec::new();
        boxes::for_swept_pairs(&before, &after, |i, j| found.push((i, j))).expect("there are few");
        found.sort_unstable();
        let low = |i: usize, axis: usize| before[i].lo[axis].min(after[i].lo[axis]);
        let high = |i: usize, axis: usize| before[i].hi[axis].max(after[i].hi[axis]);
        let near = |&(i, j): &(usize, usize)| {
            (0..3).all(|axis| low(i, axis) <= high(j, axis) && low(j, axis) <= high(i, axis))
        };
        let mut expected: Vec<(usize, usize)> =
            (0..before.len()).flat_map(|i| (i + 1..before.len()).map(move |j| (i, j))).filter(near).collect();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
}

/// A row of many cells has few pairs that are near each other, along whatever axis it lies.
#[test]
fn long_rows_have_few_near_pairs() {
    for axis in 0..3 {
        let cell = |i: i64| {
            let mut lo = [0; 3];
            lo[axis] = 4 * i;
            cube(lo, [4; 3])
        };
        let row: Vec<Cube> = (0..3000).map(cell).collect();
        let mut found = 0;
        boxes::for_swept_pairs(&row, &row, |_, _| found += 1).expect("each cell has two neighbours");
        assert_eq!(found, 2999);
        let mut forest = ContactForest::new(row.len());
        assert_eq!(boxes::examine(&row, &row, &mut forest), Some(Ok(())));
        assert!(forest.is_connected());
    }
}
