//! Lattices in whole numbers: every face of every cell on one grid, so that nothing is rounded.

use crate::plan::{Ratio, Run, Stages};

/// A cell at one end of a stage, by its faces, in lines of the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cube {
    pub lo: [i64; 3],
    pub hi: [i64; 3],
}

impl Cube {
    /// Twice the centre.
    pub fn middle(&self, axis: usize) -> i64 {
        self.lo[axis] + self.hi[axis]
    }

    pub fn size(&self, axis: usize) -> i64 {
        self.hi[axis] - self.lo[axis]
    }

    /// The same cell elsewhere.
    pub fn shifted(&self, by: [i64; 3]) -> Cube {
        let shifted = |face: [i64; 3]| [0, 1, 2].map(|axis| face[axis] + by[axis]);
        Cube { lo: shifted(self.lo), hi: shifted(self.hi) }
    }
}

/// No face is further out: sums over all cells of products of two of them stay below 2¹²⁷.
const FACE_MAX: i128 = 1 << 48;
/// Finest grid, lines a cell.
const LINES_MAX: i128 = 1 << 40;

/// A grid that all faces of a plan, or of several, lie on.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Lines a cell size.
    pub lines: i64,
}

impl Grid {
    /// Of all configurations of a plan.
    pub fn of(stages: &Stages) -> Result<Grid, String> {
        Grid::over(stages.start.iter().chain(stages.stages.iter().flat_map(|stage| &stage.end)))
    }

    /// The coarsest that there is; an error where it is too fine.
    pub fn over<'a>(runs: impl Iterator<Item = &'a Run>) -> Result<Grid, String> {
        let mut lines: i128 = 2;
        for run in runs {
            let steps = run.counters.iter().flat_map(|counter| counter.step);
            for Ratio(_, denominator) in run.center.into_iter().chain(run.size).chain(steps) {
                // Faces lie half a size from the centre.
                let denominator = 2 * i128::from(denominator);
                if lines % denominator != 0 {
                    lines = lines / gcd(lines, denominator) * denominator;
                }
                if lines > LINES_MAX {
                    return Err("the places of the cells are too fine to be judged exactly".into());
                }
            }
        }
        Ok(Grid { lines: lines as i64 })
    }

    fn line(self, Ratio(numerator, denominator): Ratio) -> i128 {
        i128::from(self.lines / denominator) * i128::from(numerator)
    }

    /// Puts the cells of these runs where they say.
    pub fn place(self, runs: &[Run], cubes: &mut [Cube]) -> Result<(), String> {
        runs.iter().try_for_each(|run| self.place_run(run, cubes))
    }

    fn place_run(self, run: &Run, cubes: &mut [Cube]) -> Result<(), String> {
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
                return Err("the cells are too far apart to be judged exactly".into());
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

/// Writes the cells of the counters from here on. Each counter at least doubles their number, so there
/// are few of them.
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
