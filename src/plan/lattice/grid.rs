//! The integer grid that every face of every cell lies on, so that nothing is rounded.

use super::fault::LatticeFault;
use crate::plan::stages::motion::{Run, StageEnd, Stages};
use crate::plan::stages::ratio::Ratio;
use crate::plan::stages::{CellMove, Moves};

/// An axis-aligned cell at one end of a stage: the coordinates of its lower and upper faces along x, y and z, in
/// grid lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cube {
    /// The coordinates of the lower faces along x, y and z, in grid lines.
    pub lo: [i64; 3],
    /// The coordinates of the upper faces along x, y and z, in grid lines.
    pub hi: [i64; 3],
}

impl Cube {
    /// Returns twice the coordinate of the cell's centre along an axis (0 to 2 for x, y, z), in grid lines. Panics
    /// for an axis above 2.
    pub fn middle(&self, axis: usize) -> i64 {
        self.lo[axis] + self.hi[axis]
    }

    /// Returns the edge length of the cell along an axis (0 to 2 for x, y, z), in grid lines. Panics for an axis
    /// above 2.
    pub fn size(&self, axis: usize) -> i64 {
        self.hi[axis] - self.lo[axis]
    }

    /// Returns the cell translated by the whole numbers `by` of grid lines along x, y and z.
    pub fn shifted(&self, by: [i64; 3]) -> Cube {
        let shifted = |face: [i64; 3]| [0, 1, 2].map(|axis| face[axis] + by[axis]);
        Cube { lo: shifted(self.lo), hi: shifted(self.hi) }
    }
}

/// The greatest coordinate of a face, in grid lines: sums over all cells of products of two of them stay below 2¹²⁷.
const FACE_MAX: i128 = 1 << 48;
/// The greatest number of grid lines to a cell.
const LINES_MAX: i128 = 1 << 40;

/// The integer grid that all faces of the cells of one plan, or of several, lie on.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// The number of grid lines to the edge of a full-sized cell, positive.
    pub lines: i64,
}

impl Grid {
    /// Returns the coarsest grid on which the faces of all configurations of a plan lie.
    ///
    /// # Errors
    /// [`LatticeFault::GridTooFine`], as [`Grid::over`].
    pub fn of(stages: &Stages) -> Result<Grid, LatticeFault> {
        Grid::over(stages.ratios())
    }

    /// Returns the coarsest grid of the faces of cells whose centres and sizes are sums of whole multiples of these
    /// numbers, in cell sizes: the least common multiple of their denominators, which must be positive.
    ///
    /// # Errors
    /// [`LatticeFault::GridTooFine`] if a cell would take more than `LINES_MAX` lines.
    pub fn over(ratios: impl Iterator<Item = Ratio>) -> Result<Grid, LatticeFault> {
        let mut lines: i128 = 2;
        for Ratio(_, denominator) in ratios {
            // Faces lie half a size from the centre.
            let denominator = 2 * i128::from(denominator);
            if lines % denominator != 0 {
                lines = lines / gcd(lines, denominator) * denominator;
            }
            if lines > LINES_MAX {
                return Err(LatticeFault::GridTooFine);
            }
        }
        Ok(Grid { lines: lines as i64 })
    }

    /// Returns the grid on which a plan begins: that of all configurations, or, if that is too fine, of the start and the
    /// obstacles alone, which [`refine`](Self::refine) makes finer where a stage needs it.
    ///
    /// # Errors
    /// [`LatticeFault::GridTooFine`], as [`Grid::over`].
    pub fn at_start(stages: &Stages) -> Result<Grid, LatticeFault> {
        Grid::of(stages).or_else(|_| Grid::over(stages.ratios_at_start()))
    }

    /// Makes the grid fine enough for these numbers, and restates the configurations on it. Lines that no face of a
    /// configuration needs any more are left out where there would be too many.
    ///
    /// # Errors
    /// [`LatticeFault::GridTooFine`] if a cell would take more than `LINES_MAX` lines even so, [`LatticeFault::CellsTooFar`]
    /// if a face would lie more than `FACE_MAX` lines from the origin.
    pub fn refine<I: Iterator<Item = Ratio>>(
        &mut self,
        ratios: impl Fn() -> I,
        configurations: &mut [&mut [Cube]],
    ) -> Result<(), LatticeFault> {
        if self.refined(ratios(), configurations).is_err() {
            self.coarsen(configurations);
            self.refined(ratios(), configurations)?;
        }
        Ok(())
    }

    /// Makes the grid fine enough for these numbers, and restates the configurations on it; leaves all as it is if that can't be.
    fn refined(
        &mut self,
        ratios: impl Iterator<Item = Ratio>,
        configurations: &mut [&mut [Cube]],
    ) -> Result<(), LatticeFault> {
        let finer = Grid::over(std::iter::once(Ratio(1, self.lines / 2)).chain(ratios))?;
        let factor = finer.lines / self.lines;
        if factor > 1 {
            let faces = configurations.iter().flat_map(|cubes| cubes.iter());
            let mut faces = faces.flat_map(|cube| cube.lo.into_iter().chain(cube.hi));
            if faces.any(|face| i128::from(face).abs() * i128::from(factor) > FACE_MAX) {
                return Err(LatticeFault::CellsTooFar);
            }
            let faces = configurations.iter_mut().flat_map(|cubes| cubes.iter_mut());
            faces.flat_map(|cube| cube.lo.iter_mut().chain(&mut cube.hi)).for_each(|face| *face *= factor);
        }
        *self = finer;
        Ok(())
    }

    /// Leaves out the lines that no face of these configurations lies on, as far as the rest is a grid.
    fn coarsen(&mut self, configurations: &mut [&mut [Cube]]) {
        let faces = configurations.iter().flat_map(|cubes| cubes.iter());
        let faces = faces.flat_map(|cube| cube.lo.into_iter().chain(cube.hi));
        let divisor = faces.fold(i128::from(self.lines / 2), |divisor, face| gcd(divisor, face.into()).abs());
        let divisor = divisor.max(1) as i64;
        self.lines /= divisor;
        let faces = configurations.iter_mut().flat_map(|cubes| cubes.iter_mut());
        faces.flat_map(|cube| cube.lo.iter_mut().chain(&mut cube.hi)).for_each(|face| *face /= divisor);
    }

    fn line(self, Ratio(numerator, denominator): Ratio) -> i128 {
        debug_assert_eq!(self.lines % denominator, 0, "the grid was made of other numbers");
        i128::from(self.lines / denominator) * i128::from(numerator)
    }

    /// Writes the cells that `runs` name to `cubes`, which is indexed by the number of the cell; the others stay as
    /// they are. The runs must be among those that the grid was made of. Panics if they name a cell that is not in
    /// `cubes`.
    ///
    /// # Errors
    /// [`LatticeFault::CellsTooFar`] if a face would lie more than `FACE_MAX` lines from the origin.
    pub fn place(self, runs: &[Run], cubes: &mut [Cube]) -> Result<(), LatticeFault> {
        runs.iter().try_for_each(|run| self.place_run(run, cubes))
    }

    /// Takes all cells, by number, from before a stage to its end. The numbers of the stage must be among those that the
    /// grid was made of. Panics for runs of a cell, or moves of a class, that there is not.
    ///
    /// # Errors
    /// [`LatticeFault::CellsTooFar`] if a face would lie more than `FACE_MAX` lines from the origin.
    pub fn advance(self, end: &StageEnd, cubes: &mut [Cube]) -> Result<(), LatticeFault> {
        match end {
            StageEnd::Runs(runs) => self.place(runs, cubes),
            StageEnd::Moves(moves) => self.shift(moves, cubes),
        }
    }

    fn shift(self, moves: &Moves, cubes: &mut [Cube]) -> Result<(), LatticeFault> {
        let steps = moves.classes.iter().map(|class| self.steps(class)).collect::<Result<Vec<_>, _>>()?;
        let mut cubes = cubes.iter_mut();
        for span in &*moves.cells {
            let (lo, hi) = steps[span.class as usize];
            for cube in cubes.by_ref().take(span.count as usize) {
                for axis in 0..3 {
                    cube.lo[axis] += lo[axis];
                    cube.hi[axis] += hi[axis];
                    let reach = cube.lo[axis].abs().max(cube.hi[axis].abs());
                    if i128::from(reach) > FACE_MAX {
                        return Err(LatticeFault::CellsTooFar);
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns (low, high): the displacements of a cell's lower and upper faces along x, y and z, in grid lines.
    fn steps(self, class: &CellMove) -> Result<([i64; 3], [i64; 3]), LatticeFault> {
        let (mut lo, mut hi) = ([0; 3], [0; 3]);
        for axis in 0..3 {
            let (displacement, growth) = (self.line(class.displacement[axis]), self.line(class.growth[axis]));
            if displacement.abs().saturating_add(growth.abs()) > 2 * FACE_MAX {
                return Err(LatticeFault::CellsTooFar);
            }
            lo[axis] = (displacement - growth / 2) as i64;
            hi[axis] = (displacement + growth / 2) as i64;
        }
        Ok((lo, hi))
    }

    fn place_run(self, run: &Run, cubes: &mut [Cube]) -> Result<(), LatticeFault> {
        let mut cube = Cube::default();
        let mut steps = vec![[0_i64; 3]; run.counters.len()];
        for axis in 0..3 {
            let (center, size) = (self.line(run.center[axis]), self.line(run.size[axis]));
            let mut reach = center.abs() + size.abs();
            for (counter, step) in run.counters.iter().zip(&mut steps) {
                let line = self.line(counter.step[axis]);
                reach = reach.saturating_add(line.abs().saturating_mul(i128::from(counter.count)));
                step[axis] = line as i64;
            }
            if reach > FACE_MAX {
                return Err(LatticeFault::CellsTooFar);
            }
            cube.lo[axis] = (center - size / 2) as i64;
            cube.hi[axis] = (center + size / 2) as i64;
        }
        let counters: Vec<Steps> = run
            .counters
            .iter()
            .zip(steps)
            .filter(|(counter, _)| counter.count > 1)
            .map(|(counter, step)| Steps { count: counter.count, stride: counter.stride, step })
            .collect();
        spread(cubes, run.first as i64, cube, &counters);
        Ok(())
    }
}

/// A counter in lines of the grid.
struct Steps {
    count: u64,
    stride: i64,
    step: [i64; 3],
}

/// Writes the cells of nested counters, outermost first. The recursion is as deep as there are counters;
/// each at least doubles the number of cells, so there are few of them.
fn spread(cubes: &mut [Cube], first: i64, cube: Cube, counters: &[Steps]) {
    let Some((counter, inner)) = counters.split_first() else {
        cubes[first as usize] = cube;
        return;
    };
    let (mut index, mut cube) = (first, cube);
    for _ in 0..counter.count {
        spread(cubes, index, cube, inner);
        index += counter.stride;
        for axis in 0..3 {
            cube.lo[axis] += counter.step[axis];
            cube.hi[axis] += counter.step[axis];
        }
    }
}

fn gcd(mut a: i128, mut b: i128) -> i128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
