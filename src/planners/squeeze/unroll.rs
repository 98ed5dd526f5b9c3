//! Unroll: a box of any sides to a row, with cells that keep their size; the second half of the
//! accordion, first with rods for cells, then with cells.

use super::Refusal;
use super::domain::{CellState, Domain, WHOLE};
use super::listed::Listed;
use super::motion::{Builder, Motion, PlanLimits};

/// Returns the motion from a box with `sides` along x, y, z, in cells, all at least 1, to a row along y, in which cell
/// `i` (from 0) is at site `i`. In the box the cells are numbered back and forth, in a serpentine: along x, then along
/// z, then along y. They keep their size. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub fn unroll(limits: PlanLimits, sides: [u64; 3]) -> Result<Motion, Refusal> {
    let [a, b, c] = sides;
    let (count, domains) = (a * b * c, domains(sides));
    // The row in turn, to and fro: along x within each rod, along z within each layer.
    let rod = move |i: u64| i / a;
    let x = move |i: u64| turned(i % a, rod(i), a);
    let y = move |i: u64| rod(i) / c;
    let z = move |i: u64| turned(rod(i) % c, y(i), c);
    let state = |x: u64, y: u64, z: u64| CellState::whole([x as i64, y as i64, z as i64]);
    let mut builder = Builder::new(limits, count, &domains, move |i| state(x(i), y(i), z(i)))?;
    builder.stage("y-unfold", WHOLE, &domains, move |i| state(x(i), rod(i), z(i)))?;
    builder.stage("z-slide", WHOLE, &domains, move |i| state(x(i), rod(i), 0))?;
    builder.stage("y-unfold", WHOLE, &domains, move |i| state(x(i), i, 0))?;
    builder.stage("x-slide", WHOLE, &domains, move |i| state(0, i, 0))?;
    Ok(builder.motion())
}

/// Returns the place in a line of this length of what goes to and fro through such lines, backwards in every second one.
fn turned(place: u64, line: u64, length: u64) -> u64 {
    if line.is_multiple_of(2) { place } else { length - 1 - place }
}

/// Returns the domains by the parities of the layer and of the rod within it, which determine the direction
/// of motion.
fn domains([a, b, c]: [u64; 3]) -> Vec<Domain> {
    let parities = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter();
    let domain = |(layer, rod): (u64, u64)| {
        let halved = |whole: u64, first: u64| whole.saturating_sub(first).div_ceil(2);
        let (layers, rods) = (halved(b, layer), halved(c, rod));
        let counters = [(layers, (2 * c * a) as i64), (rods, 2 * a as i64), (a, 1)];
        Domain::new((layer * c + rod) * a, &counters)
    };
    parities.filter_map(domain).collect()
}

/// Returns the sites of a pile of `count` cells: of the box of the sides `[a, _, c]` along x and z as many cells as
/// there are, in the order in which [`unroll_pile`] numbers them.
pub(super) fn pile(count: u64, [a, c]: [u64; 2]) -> Vec<[i64; 3]> {
    let site = |i: u64| {
        let (rod, layer) = (i / a, i / (a * c));
        [turned(i % a, rod, a) as i64, layer as i64, turned(rod % c, layer, c) as i64]
    };
    (0..count).map(site).collect()
}

/// Returns the motion of [`unroll`] for a pile, whose last layer need not be full: to a row along y in which cell `i`
/// is at site `i`. `limits`: the limits of the cells.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn unroll_pile(limits: PlanLimits, count: u64, sides: [u64; 2]) -> Result<Motion, Refusal> {
    let rod = |cell: usize| (cell as u64 / sides[0]) as i64;
    let mut motion = Listed::new(pile(count, sides).into_iter().map(CellState::whole).collect());
    let half = WHOLE / 2;
    motion.stage("y-unfold", |cell, state| state.center[1] = WHOLE * rod(cell) + half);
    motion.stage("z-slide", |_, state| state.center[2] = half);
    motion.stage("y-unfold", |cell, state| state.center[1] = WHOLE * cell as i64 + half);
    motion.stage("x-slide", |_, state| state.center[0] = half);
    motion.into_motion(limits, &(0..count).collect::<Vec<u64>>())
}
