//! The body of plans of lattices of expanding cubes: stages, trajectories of all cells in closed form, exact.
//!
//! In a stage every cell moves on a straight line, and its size changes linearly, by one time law that all share; so
//! the two end configurations determine it. Configurations are given by runs of cells whose positions are affine in
//! the run's indices, with rational numbers: a million cells take a few lines, and nothing is rounded. Stages of
//! irregular shapes state the moves of cells in classes instead.

use super::moves::{CellMove, Moves};
use super::ratio::Ratio;
use crate::plan::cause::CauseId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The trajectory of a lattice of cells, in stages. Lengths are in cell sizes; times in [`Stages::time_unit`].
#[derive(Clone, Debug, PartialEq)]
pub struct Stages {
    /// The index of the cell type in [`Library::cells`](crate::robot::Library).
    pub cell: usize,
    /// The number of cells, which are numbered from 0.
    pub count: u64,
    /// The unit of time, s: in it the greatest force brings a cell from rest to a speed of one cell size per unit of
    /// time.
    pub time_unit: f64,
    /// The least size and the greatest speed of a cell.
    pub limits: CellLimits,
    /// The conditions on the forces of the cells and their contacts.
    pub model: Model,
    /// The cells that stand fast, and the obstacles around them; `None` for a lattice that floats by itself.
    pub anchor: Option<Anchor>,
    /// The position of every cell at the start. If two runs name a cell, the later holds.
    pub start: Vec<Run>,
    /// The stages of the motion, in order of time; they follow each other without pause.
    pub stages: Vec<Stage>,
}

/// The cells of a lattice that stand fast, so that the others push off from them and the centre of mass moves, and
/// the obstacles, which stand fast too.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Anchor {
    /// The numbers of the cells that neither move nor change their size, ascending; at least one.
    pub cells: Vec<u64>,
    /// The boxes that no cell overlaps at any time, numbered from 0 by themselves.
    pub obstacles: Vec<Run>,
}

/// The limits of a cell, in units of its size and of [`Stages::time_unit`]; its greatest force gives it
/// an acceleration of 1 along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellLimits {
    /// The least size of a cell, in (0, 1].
    pub smallest: Ratio,
    /// The square of the greatest speed of a cell: that of its size, and that between two cells in contact.
    pub speed_squared: Ratio,
}

/// The limits of the squeeze move's paper: half the size, and a speed of 1.
impl Default for CellLimits {
    fn default() -> CellLimits {
        CellLimits { smallest: Ratio(1, 2), speed_squared: Ratio::ONE }
    }
}

/// The model of forces that a plan chooses: conditions on its forces besides those of every lattice plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// True if there is no outer torque: the angular momentum about the centre of mass stays 0.
    pub balanced: bool,
    /// The greatest force over one contact, in units of a cell's own; `None`: no bound.
    pub contact_force: Option<Ratio>,
    /// True if a cell's force bounds the length of its acceleration, not only the part along each axis.
    pub euclidean: bool,
}

/// One stage: from the configuration in which the one before ended to the one that `end` states.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// The name of the motion, in the planner's words, such as `x-squeeze`.
    pub name: String,
    /// The square of the duration in squared units of time: a rational number, where the duration is its root.
    pub time_squared: Ratio,
    /// The time law that all cells share.
    pub law: Law,
    /// The configuration at the end of the stage.
    pub end: StageEnd,
    /// The index in the plan's causes of the source command that this stage comes from.
    pub cause: CauseId,
}

/// The configuration at the end of a stage, by positions or by moves from the configuration before.
#[derive(Clone, Debug, PartialEq)]
pub enum StageEnd {
    /// The positions of cells. Cells that no run names stay; if two runs name a cell, the later holds.
    Runs(Vec<Run>),
    /// The moves of all cells.
    Moves(Moves),
}

impl From<Vec<Run>> for StageEnd {
    fn from(runs: Vec<Run>) -> StageEnd {
        StageEnd::Runs(runs)
    }
}

/// The time law of a stage: its progress between its ends, `σ(u)` for `u` in 0..1 of its duration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Speeding up at a constant rate for half the time, slowing down for the other: `σ = 2u²`, then
    /// `1 - 2(1-u)²`.
    BangBang,
    /// A trapezoid of speed, as the bang-bang law with an interval of constant speed between; each ramp takes this
    /// fraction of the duration, at most 1/2.
    Trapezoid(Ratio),
    /// The motion from rest to full speed: a ramp takes this fraction of the duration, at most all of it;
    /// then the speed is kept, and the next stage continues with it.
    SpeedUp(Ratio),
    /// The motion from full speed to rest, the reverse of [`Law::SpeedUp`]: the speed is kept, then a ramp takes this
    /// fraction of the duration, at most all of it.
    SlowDown(Ratio),
}

/// A run of cells in a regular arrangement, by nested counters `k`: the number of a cell is `first + Σ stride·k`, its
/// centre `center + Σ step·k`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The number of the cell, from 0, for which all counters are 0.
    pub first: u64,
    /// The counters, outermost first; none for a single cell.
    pub counters: Vec<Counter>,
    /// The centre along x, y, z of the cell with all counters at 0, in cell sizes.
    pub center: [Ratio; 3],
    /// The size along x, y, z of every cell of the run, in cell sizes.
    pub size: [Ratio; 3],
}

/// One of the nested counters of a run, with the change of the cell's number and centre for each of its steps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Counter {
    /// The number of values of `k`, which runs through 0..count; at least 1.
    pub count: u64,
    /// The change of the cell's number for one step of `k`.
    pub stride: i64,
    /// The change of the centre along x, y, z for one step of `k`, in cell sizes.
    pub step: [Ratio; 3],
}

/// The box that a cell fills at an instant; lengths in cell sizes, along the axes of the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellBox {
    /// The centre of the cell along x, y, z, in cell sizes.
    pub center: [f64; 3],
    /// The edge lengths of the cell along x, y, z, in cell sizes.
    pub size: [f64; 3],
}

impl Law {
    /// Returns (start, end): the fractions of the duration, 0 to 1, that the ramp at the start takes, and that at the
    /// end.
    pub fn ramps(self) -> (Ratio, Ratio) {
        match self {
            Law::BangBang => (Ratio(1, 2), Ratio(1, 2)),
            Law::Trapezoid(part) => (part, part),
            Law::SpeedUp(part) => (part, Ratio::ZERO),
            Law::SlowDown(part) => (Ratio::ZERO, part),
        }
    }

    /// Returns the time-reversed law: `σ` becomes `1 - σ(1 - u)`.
    pub fn reversed(self) -> Law {
        match self {
            Law::BangBang | Law::Trapezoid(_) => self,
            Law::SpeedUp(part) => Law::SlowDown(part),
            Law::SlowDown(part) => Law::SpeedUp(part),
        }
    }

    /// Returns the progress `σ(u)` of the stage, 0 to 1, at the fraction `u` of its duration; `u` is clamped to
    /// 0..1.
    pub fn progress(self, u: f64) -> f64 {
        let u = u.clamp(0.0, 1.0);
        let (first, last) = self.ramps();
        let (first, last) = (first.to_f64(), last.to_f64());
        let speed = 2.0 / (2.0 - first - last);
        if u < first {
            speed * u * u / (2.0 * first)
        } else if u <= 1.0 - last {
            speed * (u - first / 2.0)
        } else {
            1.0 - speed * (1.0 - u) * (1.0 - u) / (2.0 * last)
        }
    }

    /// Returns the fraction of the duration, 0 to 1, at which a progress is reached: the inverse of
    /// [`progress`](Law::progress). The progress is clamped to 0..1.
    pub fn part(self, progress: f64) -> f64 {
        let progress = progress.clamp(0.0, 1.0);
        let (first, last) = self.ramps();
        let (first, last) = (first.to_f64(), last.to_f64());
        let speed = 2.0 / (2.0 - first - last);
        if progress < speed * first / 2.0 {
            libm::sqrt(2.0 * first * progress / speed)
        } else if progress <= 1.0 - speed * last / 2.0 {
            progress / speed + first / 2.0
        } else {
            1.0 - libm::sqrt(2.0 * last * (1.0 - progress) / speed)
        }
    }
}

impl Stage {
    /// Returns the duration of the stage in units of time ([`Stages::time_unit`]): the root of `time_squared`.
    pub fn duration(&self) -> f64 {
        libm::sqrt(self.time_squared.to_f64())
    }

    /// Returns the number of cells whose positions or moves the stage states, with repetition.
    pub fn count(&self) -> u64 {
        match &self.end {
            StageEnd::Runs(runs) => runs.iter().map(Run::count).fold(0, u64::saturating_add),
            StageEnd::Moves(moves) => moves.count(),
        }
    }
}

impl Run {
    /// Returns the number of cells that the run names, with repetition: the product of the counts of its counters, 1
    /// without any.
    pub fn count(&self) -> u64 {
        self.counters.iter().map(|c| c.count).product()
    }

    /// Returns every cell of the run, as its number with its centre and size, in the order of the nested counters.
    pub fn cells(&self) -> impl Iterator<Item = (usize, CellBox)> + '_ {
        (0..self.count()).map(|n| self.cell(n))
    }

    /// Returns all numbers of the run: the centre, the size and the steps of the counters.
    pub(in crate::plan) fn ratios(&self) -> impl Iterator<Item = Ratio> + '_ {
        let steps = self.counters.iter().flat_map(|counter| counter.step);
        self.center.into_iter().chain(self.size).chain(steps)
    }

    fn cell(&self, mut n: u64) -> (usize, CellBox) {
        let mut index = self.first as i64;
        let mut center = self.center.map(Ratio::to_f64);
        for counter in self.counters.iter().rev() {
            let k = n % counter.count;
            n /= counter.count;
            index += counter.stride * k as i64;
            for (c, step) in center.iter_mut().zip(counter.step) {
                *c += step.to_f64() * k as f64;
            }
        }
        (index as usize, CellBox { center, size: self.size.map(Ratio::to_f64) })
    }
}

impl Stages {
    /// Returns the boxes of all obstacles, by number.
    pub fn obstacles(&self) -> Vec<CellBox> {
        let runs = self.anchor.iter().flat_map(|anchor| &anchor.obstacles);
        let mut named: Vec<(usize, CellBox)> = runs.flat_map(Run::cells).collect();
        named.sort_by_key(|(number, _)| *number);
        named.into_iter().map(|(_, obstacle)| obstacle).collect()
    }

    /// Returns the duration of all stages, s.
    pub fn duration(&self) -> f64 {
        self.stages.iter().fold(0.0, |time, stage| time + stage.duration()) * self.time_unit
    }

    /// Returns the time at which each stage begins, and the end, s, ascending from 0: one more than there are stages.
    pub fn instants(&self) -> Vec<f64> {
        let mut now = 0.0;
        let ends = self.stages.iter().map(|s| {
            now += s.duration();
            now * self.time_unit
        });
        std::iter::once(0.0).chain(ends).collect()
    }

    /// Returns the number of the first of the cells that stand fast, on which the others hang; `None` if none does.
    pub(in crate::plan) fn root(&self) -> Option<u32> {
        self.anchor.as_ref().and_then(|anchor| anchor.cells.first()).map(|&cell| cell as u32)
    }

    /// Returns the box of every cell, by its number, at the time `t` (s); before the start and after the end, as at
    /// the nearer end.
    pub fn state(&self, t: f64) -> Vec<CellBox> {
        let mut cells = vec![CellBox { center: [0.0; 3], size: [1.0; 3] }; self.count as usize];
        place(&mut cells, &self.start);
        let mut now = t / self.time_unit;
        for stage in &self.stages {
            let duration = stage.duration();
            if now < duration {
                let before = cells.clone();
                advance(&mut cells, &stage.end);
                blend(&before, &mut cells, stage.law.progress(now / duration));
                break;
            }
            advance(&mut cells, &stage.end);
            now -= duration;
        }
        cells
    }
}

fn place(cells: &mut [CellBox], runs: &[Run]) {
    for (index, cell) in runs.iter().flat_map(Run::cells) {
        cells[index] = cell;
    }
}

/// Takes the boxes of all cells from before a stage to its end.
fn advance(cells: &mut [CellBox], end: &StageEnd) {
    let moves = match end {
        StageEnd::Runs(runs) => return place(cells, runs),
        StageEnd::Moves(moves) => moves,
    };
    let changes = |class: &CellMove| (class.displacement.map(Ratio::to_f64), class.growth.map(Ratio::to_f64));
    let changes: Vec<_> = moves.classes.iter().map(changes).collect();
    for (cell, class) in cells.iter_mut().zip(moves.of_cells()) {
        let (displacement, growth) = &changes[class as usize];
        for axis in 0..3 {
            cell.center[axis] += displacement[axis];
            cell.size[axis] += growth[axis];
        }
    }
}

fn blend(before: &[CellBox], after: &mut [CellBox], progress: f64) {
    for (a, b) in before.iter().zip(after) {
        for axis in 0..3 {
            b.center[axis] = a.center[axis] + (b.center[axis] - a.center[axis]) * progress;
            b.size[axis] = a.size[axis] + (b.size[axis] - a.size[axis]) * progress;
        }
    }
}
