//! Concatenated stages of two lattices: where the first ends in the shape in which the second starts,
//! exactly, up to a translation. Cells are alike, so those of the second take the numbers of the cells at
//! whose positions they begin.

use super::arithmetic_runs::{ArithmeticRun, arithmetic_runs};
use super::motion::{Counter, Model, Run, Stage, Stages};
use super::ratio::Ratio;
use crate::plan::cause::CauseId;
use crate::plan::lattice::grid::{Cube, Grid};
use crate::plan::operation_error::OperationError;

/// Returns the stages of `a` followed by those of `b`, whose causes are numbered from `causes` on.
///
/// # Errors
/// [`OperationError`] for lattices of other cells, of another number of cells or of another shape where they meet,
/// and for numbers that 64 bits do not hold.
pub(in crate::plan) fn joined(a: &Stages, b: &Stages, causes: u32) -> Result<Stages, OperationError> {
    if a.count != b.count {
        return Err(OperationError::CellCounts { first: a.count, second: b.count });
    }
    if a.time_unit != b.time_unit {
        return Err(OperationError::Cells);
    }
    // The last cells of the first and the first cells of the second, on one grid of whole numbers.
    let end = a.before(a.stages.len());
    let others = b.start.iter().chain(b.stages.iter().flat_map(|stage| &stage.end));
    let grid = Grid::over(end.iter().chain(others)).map_err(|_| OperationError::Inexact)?;
    let mut cubes = vec![Cube::default(); b.count as usize];
    let placed =
        |runs: &[Run], cubes: &mut Vec<Cube>| grid.place(runs, cubes).map_err(|_| OperationError::Inexact);
    let mut last = cubes.clone();
    placed(&end, &mut last)?;
    placed(&b.start, &mut cubes)?;
    // The bijection of the cells and the translation that take the second shape to the first.
    let (numbers, shift) = matched(&last, &cubes).ok_or(OperationError::Shapes)?;
    let same = numbers.iter().enumerate().all(|(i, &number)| i == number as usize) && shift == [0; 3];
    // The stages of the second, renumbered and translated; of the same numbering they stay as they are.
    let mut new = a.clone();
    for stage in &b.stages {
        let end = if same {
            stage.end.clone()
        } else {
            placed(&stage.end, &mut cubes)?;
            let mut renumbered = last.clone();
            for (cube, &number) in cubes.iter().zip(&numbers) {
                renumbered[number as usize] = cube.shifted(shift);
            }
            gathered(&renumbered, grid).ok_or(OperationError::Inexact)?
        };
        new.stages.push(Stage { end, cause: CauseId(stage.cause.0 + causes), ..stage.clone() });
    }
    // The whole may ask of the cells all that each part may.
    let looser = |first: Ratio, second: Ratio, larger: bool| {
        if first.order(second).is_gt() == larger { first } else { second }
    };
    new.limits.smallest = looser(a.limits.smallest, b.limits.smallest, false);
    new.limits.speed_squared = looser(a.limits.speed_squared, b.limits.speed_squared, true);
    new.model = Model {
        balanced: a.model.balanced && b.model.balanced,
        euclidean: a.model.euclidean && b.model.euclidean,
        contact_force: a.model.contact_force.zip(b.model.contact_force).map(|(f, g)| looser(f, g, true)),
    };
    Ok(new)
}

/// Returns for each of the second cubes the number of the first at its position, and the translation of the
/// second to the first, in lines of the grid. `None` where the shapes differ.
fn matched(first: &[Cube], second: &[Cube]) -> Option<(Vec<u32>, [i64; 3])> {
    let low = |cubes: &[Cube]| [0, 1, 2].map(|axis| cubes.iter().map(|c| c.lo[axis]).min().unwrap_or(0));
    let (a, b) = (low(first), low(second));
    let shift = [0, 1, 2].map(|axis| a[axis] - b[axis]);
    if first.iter().zip(second).all(|(p, q)| *p == q.shifted(shift)) {
        return Some(((0..first.len() as u32).collect(), shift));
    }
    let order = |cubes: &[Cube]| {
        let mut order: Vec<u32> = (0..cubes.len() as u32).collect();
        order.sort_unstable_by_key(|&i| cubes[i as usize].lo);
        order
    };
    let mut numbers = vec![0; second.len()];
    for (i, j) in order(first).into_iter().zip(order(second)) {
        if first[i as usize] != second[j as usize].shifted(shift) {
            return None;
        }
        numbers[j as usize] = i;
    }
    Some((numbers, shift))
}

/// Returns runs that state the positions and sizes of all cells; `None` if 64 bits do not hold a number.
fn gathered(cubes: &[Cube], grid: Grid) -> Option<Vec<Run>> {
    let sizes = |i: usize| [0, 1, 2].map(|axis| cubes[i].size(axis));
    let apart = |i: usize, j: usize| [0, 1, 2].map(|axis| cubes[j].middle(axis) - cubes[i].middle(axis));
    let found = arithmetic_runs(cubes.len(), |i, j| (sizes(i) == sizes(j)).then(|| apart(i, j)));
    let lines = i128::from(grid.lines);
    let three = |values: [i64; 3], over: i128| {
        let [x, y, z] = values.map(|value| Ratio::new(value.into(), over));
        Some([x?, y?, z?])
    };
    let run = |s: ArithmeticRun| {
        let counter = |count: usize, stride: usize| {
            let step = three(apart(s.first, s.first + stride), 2 * lines)?;
            Some(Counter { count: count as u64, stride: stride as i64, step })
        };
        let mut counters = Vec::new();
        for (count, stride) in [(s.times, s.length), (s.length, 1)] {
            if count > 1 {
                counters.push(counter(count, stride)?);
            }
        }
        let middle = [0, 1, 2].map(|axis| cubes[s.first].middle(axis));
        Some(Run {
            first: s.first as u64,
            counters,
            center: three(middle, 2 * lines)?,
            size: three(sizes(s.first), lines)?,
        })
    };
    found.into_iter().map(run).collect()
}
