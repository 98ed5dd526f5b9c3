//! Concatenated stages of two lattices: where the first ends in the shape in which the second starts,
//! exactly, up to a translation. Cells are alike, so those of the second take the numbers of the cells at
//! whose positions they begin.

use super::configurations::gathered;
use super::motion::{Model, Run, Stage, StageEnd, Stages};
use super::moves::Moves;
use super::ratio::Ratio;
use crate::plan::cause::CauseId;
use crate::plan::lattice::LatticeFault;
use crate::plan::lattice::grid::{Cube, Grid};
use crate::plan::operation_error::OperationError;

/// Returns the stages of `a` followed by those of `b`, whose causes are numbered from `causes` on.
///
/// # Errors
/// [`OperationError`] for lattices of other cells, of another number of cells, of another shape where they meet, or on another anchor,
/// and for numbers that 64 bits do not hold.
pub(in crate::plan) fn joined(a: &Stages, b: &Stages, causes: u32) -> Result<Stages, OperationError> {
    if a.count != b.count {
        return Err(OperationError::CellCounts { first: a.count, second: b.count });
    }
    if a.time_unit != b.time_unit {
        return Err(OperationError::Cells);
    }
    // The last cells of the first and the first cells of the second, on one grid of whole numbers, which is made finer where
    // a stage needs it if that of all stages is too fine.
    let inexact = |_: LatticeFault| OperationError::Inexact;
    let end = a.before(a.stages.len()).map_err(inexact)?;
    let last_ratios = || end.iter().flat_map(Run::ratios);
    let mut grid = Grid::over(last_ratios().chain(b.ratios()))
        .or_else(|_| Grid::over(last_ratios().chain(b.ratios_at_start())))
        .map_err(inexact)?;
    let mut cubes = vec![Cube::default(); b.count as usize];
    let mut last = cubes.clone();
    grid.place(&end, &mut last).map_err(inexact)?;
    grid.place(&b.start, &mut cubes).map_err(inexact)?;
    // The bijection of the cells and the translation that take the second shape to the first.
    let (numbers, shift) = matched(&last, &cubes).ok_or(OperationError::Shapes)?;
    let same_numbers = numbers.iter().enumerate().all(|(i, &number)| i == number as usize);
    if (a.anchor.is_some() || b.anchor.is_some()) && !same_anchor(a, b, &numbers, shift) {
        return Err(OperationError::Surroundings);
    }
    // The stages of the second, renumbered and translated; of the same numbering they stay as they are.
    let mut new = a.clone();
    let mut shift = [Cube { lo: shift, hi: shift }];
    for stage in &b.stages {
        grid.refine(|| stage.ratios(), &mut [&mut cubes, &mut shift]).map_err(inexact)?;
        let shift = shift[0].lo;
        grid.advance(&stage.end, &mut cubes).map_err(inexact)?;
        let end = match &stage.end {
            StageEnd::Moves(moves) if same_numbers => StageEnd::Moves(moves.clone()),
            StageEnd::Moves(moves) => StageEnd::Moves(renumbered(moves, &numbers)),
            StageEnd::Runs(runs) if same_numbers && shift == [0; 3] => runs.clone().into(),
            StageEnd::Runs(_) => {
                let mut moved = vec![Cube::default(); cubes.len()];
                for (cube, &number) in cubes.iter().zip(&numbers) {
                    moved[number as usize] = cube.shifted(shift);
                }
                gathered(&moved, grid).ok_or(OperationError::Inexact)?.into()
            }
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

/// Returns true if the same cells of two lattices stand fast, at the same places among the same obstacles: `numbers` and
/// `shift` take the cells of the second to those of the first.
fn same_anchor(a: &Stages, b: &Stages, numbers: &[u32], shift: [i64; 3]) -> bool {
    let (Some(a), Some(b)) = (&a.anchor, &b.anchor) else { return false };
    let mut cells: Vec<u64> = b.cells.iter().map(|&cell| u64::from(numbers[cell as usize])).collect();
    cells.sort_unstable();
    shift == [0; 3] && a.cells == cells && a.obstacles == b.obstacles
}

/// Returns moves with cell `i` as number `numbers[i]`, which must be a permutation of all cells.
fn renumbered(moves: &Moves, numbers: &[u32]) -> Moves {
    let mut classes = vec![0; numbers.len()];
    moves.of_cells().zip(numbers).for_each(|(class, &number)| classes[number as usize] = class);
    Moves::new(&moves.classes, classes.into_iter())
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
