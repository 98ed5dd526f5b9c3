//! Measures of whole stages: relative displacements, contact forces, shapes at the ends, and the lower bound
//! on the duration.

use super::contacts::ContactForest;
use super::fault::LatticeFault;
use super::grid::{Cube, Grid};
use super::lanes::Overlap;
use super::law::{Change, TimeScaling};
use super::lower_bound::{anchored_lower_bound, greatest_force_sum, lower_bound};
use super::{boxes, lanes};
use crate::plan::stages::motion::Stages;

/// Returns twice the greatest relative displacement along an axis, in grid lines, of two cells that are in contact
/// during the whole stage, over any parts of faces if cells `slide`, else docked; `before` and `after` are the cells by
/// number at its ends, `lines` is the number of grid lines to a cell. Overlaps are not reported. `None` if more pairs of
/// cells come near each other than are examined.
pub fn greatest_relative_displacement(
    before: &[Cube],
    after: &[Cube],
    lines: i64,
    slide: bool,
) -> Option<i64> {
    let mut forest = ContactForest::of_cells(before.len(), slide);
    // Overlaps are found when the plan is judged.
    let _ = examine(before, after, &Change::of(before, after), lines, &mut forest)?;
    Some(forest.relative)
}

/// Returns for each stage, in order, the greatest contact force times the square of its duration, as (numerator,
/// denominator): the force in units of a cell's own, the duration in units of time; of contacts over any parts of faces if
/// cells `slide`, else of docked ones.
///
/// # Errors
/// Every [`LatticeFault`] but [`LatticeFault::OffLattice`]. Overlaps are not reported.
pub fn peak_forces(stages: &Stages, slide: bool) -> Result<Vec<(i128, i128)>, LatticeFault> {
    let mut grid = Grid::at_start(stages)?;
    let mut before = vec![Cube::default(); stages.count as usize];
    grid.place(&stages.start, &mut before)?;
    let mut peaks = Vec::with_capacity(stages.stages.len());
    for stage in &stages.stages {
        grid.refine(|| stage.ratios(), &mut [&mut before])?;
        let mut after = before.clone();
        grid.advance(&stage.end, &mut after)?;
        let change = Change::of(&before, &after);
        let mut forest = ContactForest::of_cells(before.len(), slide);
        let _ = examine(&before, &after, &change, grid.lines, &mut forest).ok_or(LatticeFault::Entangled)?;
        let mut peak = 0;
        for axis in 0..3 {
            let along = forest
                .forces_from(stages.root(), &before, &after, axis)
                .map_err(|_| LatticeFault::CentreMoves)?;
            peak = peak.max(along.0);
        }
        let (times, over) = TimeScaling::of(stage).acceleration_ratio();
        peaks.push((peak * i128::from(times), 2 * i128::from(grid.lines) * i128::from(over)));
        before = after;
    }
    Ok(peaks)
}

/// Returns the duration, in seconds, below which no motion takes the plan's first shape to its last under the same
/// limits ([`lower_bound`]), for cells that `slide` or do not.
///
/// # Errors
///
/// [`LatticeFault::GridTooFine`] or [`LatticeFault::CellsTooFar`].
pub fn time_lower_bound(stages: &Stages, slide: bool) -> Result<f64, LatticeFault> {
    let mut grid = Grid::at_start(stages)?;
    let mut cubes = vec![Cube::default(); stages.count as usize];
    grid.place(&stages.start, &mut cubes)?;
    for stage in &stages.stages {
        grid.refine(|| stage.ratios(), &mut [&mut cubes])?;
        grid.advance(&stage.end, &mut cubes)?;
    }
    grid.refine(|| stages.ratios_at_start(), &mut [&mut cubes])?;
    let mut start = cubes.clone();
    grid.place(&stages.start, &mut start)?;
    Ok(time_between(stages, (&start, &cubes), grid, slide))
}

/// Returns the lower bound on the duration between two configurations, in seconds: those of `start` and `end`, on
/// `grid`, under the unit of time and the limits of speed and force of `stages`, of cells that `slide` or do not.
pub fn time_between(stages: &Stages, (start, end): (&[Cube], &[Cube]), grid: Grid, slide: bool) -> f64 {
    // Cells that stand fast are matched with themselves.
    let fixed: &[u64] = stages.anchor.as_ref().map_or(&[], |anchor| &anchor.cells);
    let middles = |cubes: &[Cube], axis: usize| {
        let moving = cubes.iter().zip(0..).filter(|(_, number)| fixed.binary_search(number).is_err());
        moving.map(|(cube, _)| cube.middle(axis)).collect()
    };
    let (before, after) = (|axis| middles(start, axis), |axis| middles(end, axis));
    let speed_squared = stages.limits.speed_squared;
    if stages.anchor.is_some() {
        let contacts = stages.count.saturating_sub(1);
        return anchored_lower_bound(before, after, grid.lines, (speed_squared, contacts)) * stages.time_unit;
    }
    let forces = stages.model.contact_force.map(|force| greatest_force_sum(start.len(), force, slide));
    lower_bound(before, after, grid.lines, speed_squared, forces) * stages.time_unit
}

/// A list of lattice sites by their integer coordinates x, y, z, in cells.
pub type Places = Vec<[i64; 3]>;

/// Returns (start, end): the lattice sites that the cells fill at the start and at the end of a plan, each sorted by
/// x, then y, then z, and translated so that the lowest along each axis is 0.
///
/// # Errors
/// [`LatticeFault::OffLattice`] if a cell does not fill a site; [`LatticeFault::GridTooFine`] or
/// [`LatticeFault::CellsTooFar`].
pub fn end_shapes(stages: &Stages) -> Result<(Places, Places), LatticeFault> {
    let mut grid = Grid::at_start(stages)?;
    let mut cubes = vec![Cube::default(); stages.count as usize];
    grid.place(&stages.start, &mut cubes)?;
    let start = places(&cubes, grid.lines)?;
    for stage in &stages.stages {
        grid.refine(|| stage.ratios(), &mut [&mut cubes])?;
        grid.advance(&stage.end, &mut cubes)?;
    }
    Ok((start, places(&cubes, grid.lines)?))
}

fn places(cubes: &[Cube], lines: i64) -> Result<Places, LatticeFault> {
    let low = [0, 1, 2].map(|axis| cubes.iter().map(|c| c.lo[axis]).min().unwrap_or(0));
    let place = |cube: &Cube| {
        let whole = (0..3).all(|axis| cube.size(axis) == lines && (cube.lo[axis] - low[axis]) % lines == 0);
        let at = [0, 1, 2].map(|axis| (cube.lo[axis] - low[axis]) / lines);
        if whole { Ok(at) } else { Err(LatticeFault::OffLattice) }
    };
    let mut places = cubes.iter().map(place).collect::<Result<Vec<_>, _>>()?;
    places.sort_unstable();
    Ok(places)
}

/// Joins in `forest` the cells that are in contact during the whole stage: by a sweep if cells move along one axis
/// only, else by a search of near pairs. `before` and `after` are the cells by number at the ends of the stage, and
/// `change` must be theirs; `lines` is the number of grid lines to a cell. `None` if more pairs of cells come near
/// each other than are examined.
///
/// # Errors
/// The inner result is the first [`Overlap`] of two cells that is found.
pub fn examine(
    before: &[Cube],
    after: &[Cube],
    change: &Change,
    lines: i64,
    forest: &mut ContactForest,
) -> Option<Result<(), Overlap>> {
    let moving: Vec<usize> = (0..3).filter(|&axis| change.axes[axis]).collect();
    match moving[..] {
        [axis] => lanes::examine(before, after, axis, lines, forest),
        _ => boxes::examine(before, after, forest),
    }
}
