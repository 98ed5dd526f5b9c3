//! Plans of lattices: the kinodynamic model, judged exactly.
//!
//! In a stage all cells move on straight lines by one time law, so its two ends say everything. They
//! are put on a grid of whole numbers, and no comparison is rounded. What is judged, by the names of
//! `docs/planners/squeeze.md`: K1 sizes, K2 no two cells overlap, K3 one piece, over faces, at all but
//! finitely many instants, K4 accelerations, K5 speeds in contact, K6 speeds of sizes, K7 rest at both
//! ends, F1 the centre of mass stays, F2 forces between the cells that do it, F3 no angular momentum
//! (balanced plans), F4 a bound on the forces.

use super::bound::lower_bound;
use super::contacts::Forest;
pub use super::grid::{Cube, Grid};
use super::lanes::Meeting;
use super::law::{Change, Pace, carries_on};
use super::moments::{passing, stretches};
use super::{boxes, lanes};
use crate::plan::verify::ledger::{Ledger, lower};
use crate::plan::{CheckKind, Dynamics, Failure, Ground, Plan, Ratio, Stage, Stages, Status, Verdict};
use crate::robot::Cell;
use crate::units::{Dimension, quantity};

/// Cells times stages that are judged: some minutes of work.
const WORK_MAX: u64 = 1_000_000_000;
/// How far the units of a plan may be from the cell's facts, relative: they are rounded numbers.
const TOL_UNITS: f64 = 1e-9;

pub fn judge(plan: &Plan, stages: &Stages) -> Verdict {
    let mut ledger = Ledger::new(&plan.exemptions, stages.duration());
    let judgement = Judgement { stages, cell: &plan.library.cells[stages.cell] };
    if let Err(message) = judgement.assumptions(plan).and_then(|()| judgement.stages(&mut ledger)) {
        ledger.fail(Failure { message, ..judgement.failure(CheckKind::Form, 0.0, None) });
        ledger.check(CheckKind::Form, Status::Proved);
        return ledger.finish();
    }
    let proved = [
        CheckKind::Form,
        CheckKind::Collision,
        CheckKind::JointRange,
        CheckKind::Speed,
        CheckKind::Acceleration,
        CheckKind::Connectedness,
        CheckKind::Momentum,
        CheckKind::Rest,
    ];
    proved.into_iter().for_each(|kind| ledger.check(kind, Status::Proved));
    let bounded = stages.model.contact_force.is_some();
    ledger.check(CheckKind::BondLoad, if bounded { Status::Proved } else { Status::NoLimit });
    ledger.finish()
}

/// The greatest distance, in half lines, by which two cells move against each other along an axis that
/// are in contact all the while. `None`: too entangled to be judged.
pub fn parting(before: &[Cube], after: &[Cube], lines: i64) -> Option<i64> {
    let mut forest = Forest::new(before.len());
    // Cells that meet are found when the plan is judged.
    let _ = joined(before, after, &Change::of(before, after), lines, &mut forest)?;
    Some(forest.parting)
}

/// Of each stage, the greatest contact force times the square of its duration, in units: as a
/// fraction, numerator and denominator.
pub fn peak_forces(stages: &Stages) -> Result<Vec<(i128, i128)>, String> {
    let grid = Grid::of(stages)?;
    let mut before = vec![Cube::default(); stages.count as usize];
    grid.place(&stages.start, &mut before)?;
    let mut peaks = Vec::with_capacity(stages.stages.len());
    for stage in &stages.stages {
        let mut after = before.clone();
        grid.place(&stage.end, &mut after)?;
        let change = Change::of(&before, &after);
        let mut forest = Forest::new(before.len());
        let _ = joined(&before, &after, &change, grid.lines, &mut forest).ok_or("too entangled")?;
        let mut peak = 0;
        for axis in 0..3 {
            let along = forest.forces(&before, &after, axis).map_err(|_| "the centre of mass moves")?;
            peak = peak.max(along.0);
        }
        let (times, over) = Pace::of(stage).strain();
        peaks.push((peak * i128::from(times), 2 * i128::from(grid.lines) * i128::from(over)));
        before = after;
    }
    Ok(peaks)
}

/// Seconds below which no motion does what the plan does, under the same limits.
pub fn least_time(stages: &Stages) -> Result<f64, String> {
    let grid = Grid::of(stages)?;
    let mut cubes = vec![Cube::default(); stages.count as usize];
    grid.place(&stages.start, &mut cubes)?;
    let start = cubes.clone();
    stages.stages.iter().try_for_each(|stage| grid.place(&stage.end, &mut cubes))?;
    Ok(between(stages, &start, &cubes, grid))
}

fn between(stages: &Stages, start: &[Cube], end: &[Cube], grid: Grid) -> f64 {
    let middles = |cubes: &[Cube], axis: usize| cubes.iter().map(|cube| cube.middle(axis)).collect();
    let (before, after) = (|axis| middles(start, axis), |axis| middles(end, axis));
    lower_bound(before, after, grid.lines, stages.model.contact_force) * stages.time_unit
}

/// Places of a lattice.
pub type Places = Vec<[i64; 3]>;

/// Places of the lattice that the cells take up at the start and at the end, the lowest along each axis
/// 0, in order. An error if they take up none.
pub fn ends(stages: &Stages) -> Result<(Places, Places), String> {
    let grid = Grid::of(stages)?;
    let mut cubes = vec![Cube::default(); stages.count as usize];
    grid.place(&stages.start, &mut cubes)?;
    let start = places(&cubes, grid.lines)?;
    stages.stages.iter().try_for_each(|stage| grid.place(&stage.end, &mut cubes))?;
    Ok((start, places(&cubes, grid.lines)?))
}

fn places(cubes: &[Cube], lines: i64) -> Result<Places, String> {
    let low = [0, 1, 2].map(|axis| cubes.iter().map(|c| c.lo[axis]).min().unwrap_or(0));
    let place = |cube: &Cube| {
        let whole = (0..3).all(|axis| cube.size(axis) == lines && (cube.lo[axis] - low[axis]) % lines == 0);
        let at = [0, 1, 2].map(|axis| (cube.lo[axis] - low[axis]) / lines);
        if whole { Ok(at) } else { Err("cells are not at places of the lattice".to_string()) }
    };
    let mut places = cubes.iter().map(place).collect::<Result<Vec<_>, _>>()?;
    places.sort_unstable();
    Ok(places)
}

/// Joins the cells whose contact lasts the stage, and finds cells that meet. `None`: too entangled.
fn joined(
    before: &[Cube],
    after: &[Cube],
    change: &Change,
    lines: i64,
    forest: &mut Forest,
) -> Option<Result<(), Meeting>> {
    let moving: Vec<usize> = (0..3).filter(|&axis| change.axes[axis]).collect();
    match moving[..] {
        [axis] => lanes::judge(before, after, axis, lines, forest),
        _ => boxes::judge(before, after, forest),
    }
}

struct Judgement<'a> {
    stages: &'a Stages,
    cell: &'a Cell,
}

/// One stage between its two ends.
struct Step<'a> {
    stage: &'a Stage,
    /// Seconds.
    from: f64,
    to: f64,
    before: &'a [Cube],
    after: &'a [Cube],
    change: Change,
    pace: Pace,
    lines: i64,
}

impl Judgement<'_> {
    /// What the model takes for granted: no gravity, and units that fit the cell.
    fn assumptions(&self, plan: &Plan) -> Result<(), String> {
        let floats = |world: &crate::plan::World| world.gravity == 0.0 && world.ground == Ground::Off;
        if !plan.worlds.iter().all(|w| floats(&w.world)) {
            return Err("plans of lattices are judged without gravity and without a ground only".into());
        }
        let (cell, stages) = (self.cell, self.stages);
        let at_most = |a: f64, b: f64| a <= b * (1.0 + TOL_UNITS);
        let unit_speed = cell.size / stages.time_unit;
        let sound = at_most(unit_speed / stages.time_unit, cell.force / cell.mass)
            && at_most(cell.shrinks_to, stages.limits.smallest.to_f64() * cell.size)
            && at_most(libm::sqrt(stages.limits.speed_squared.to_f64()) * unit_speed, cell.speed);
        if !sound {
            return Err(format!("the plan asks more of its cells than a `{}` can do", cell.name));
        }
        let named = |runs: &[crate::plan::Run]| runs.iter().map(crate::plan::Run::count).sum::<u64>();
        let work = stages.stages.iter().map(|s| stages.count + named(&s.end)).fold(0, u64::saturating_add);
        if work > 2 * WORK_MAX {
            return Err(format!("more than {WORK_MAX} cells times stages are not judged"));
        }
        Ok(())
    }

    fn stages(&self, ledger: &mut Ledger) -> Result<(), String> {
        let grid = Grid::of(self.stages)?;
        // A cell that no run names has no size.
        let mut before = vec![Cube::default(); self.stages.count as usize];
        grid.place(&self.stages.start, &mut before)?;
        if let Some(cell) = before.iter().position(|cube| (0..3).any(|axis| cube.size(axis) <= 0)) {
            return Err(format!("cell {cell} has no place or no size at the start"));
        }
        if self.stages.count == 0 {
            return Ok(());
        }
        let mut dynamics = Dynamics::default();
        let instants = self.stages.instants();
        self.start(&before, grid, ledger);
        let mut earlier: Vec<Cube> = Vec::new();
        let mut after = before.clone();
        for (index, stage) in self.stages.stages.iter().enumerate() {
            let stages = self.stages.stages.len();
            crate::interrupt::progress_checkpoint(|| format!("stage {} of {stages}", index + 1));
            after.clone_from(&before);
            grid.place(&stage.end, &mut after)?;
            if let Some(last) = index.checked_sub(1).map(|i| &self.stages.stages[i]) {
                self.seam((last, &earlier), &before, (stage, &after), instants[index], ledger);
            }
            let step = Step {
                stage,
                from: instants[index],
                to: instants[index + 1],
                change: Change::of(&before, &after),
                before: &before,
                after: &after,
                pace: Pace::of(stage),
                lines: grid.lines,
            };
            self.step(&step, &mut dynamics, ledger)?;
            std::mem::swap(&mut earlier, &mut before);
            std::mem::swap(&mut before, &mut after);
        }
        // The start once more, where it needs no more memory.
        after.clone_from(&before);
        grid.place(&self.stages.start, &mut after)?;
        dynamics.lower_bound = between(self.stages, &after, &before, grid);
        ledger.verdict.samples = self.stages.stages.len() + 1;
        ledger.verdict.dynamics = Some(dynamics);
        Ok(())
    }

    /// The start by itself, for plans that do not move at first.
    fn start(&self, cubes: &[Cube], grid: Grid, ledger: &mut Ledger) {
        let change = Change::of(cubes, cubes);
        self.sizes(&change, grid.lines, 0.0, None, ledger);
        let first = self.stages.stages.first();
        if first.is_none_or(|stage| stage.time_squared.0 == 0) && change.smallest.0 > 0 {
            self.still(cubes, ledger);
        }
        let moving = |stage: &Stage, ramp: Ratio| ramp.0 == 0 && stage.time_squared.0 > 0;
        if let Some(stage) = first.filter(|s| moving(s, s.law.ramps().0)) {
            self.fail(CheckKind::Rest, 0.0, Some(stage), "the plan begins in motion".into(), ledger);
        }
        if let Some(stage) = self.stages.stages.last().filter(|s| moving(s, s.law.ramps().1)) {
            let end = self.stages.duration();
            self.fail(CheckKind::Rest, end, Some(stage), "the plan ends in motion".into(), ledger);
        }
    }

    /// K2 and K3 of cells that do not move.
    fn still(&self, cubes: &[Cube], ledger: &mut Ledger) {
        let mut forest = Forest::new(cubes.len());
        match boxes::judge(cubes, cubes, &mut forest) {
            Some(Err(meeting)) => self.meet(&meeting, 0.0, 0.0, None, ledger),
            _ => self.connected(&mut forest, 0.0, None, ledger),
        }
    }

    /// Between two stages velocities may not jump.
    fn seam(
        &self,
        last: (&Stage, &[Cube]),
        between: &[Cube],
        next: (&Stage, &[Cube]),
        time: f64,
        ledger: &mut Ledger,
    ) {
        if last.0.time_squared.0 == 0 || next.0.time_squared.0 == 0 {
            return;
        }
        if let Err(cell) = carries_on(last, between, next) {
            let message = format!("the velocity of cell {cell} jumps before stage `{}`", next.0.name);
            self.fail(CheckKind::Acceleration, time, Some(next.0), message, ledger);
        }
    }

    fn step(&self, step: &Step, dynamics: &mut Dynamics, ledger: &mut Ledger) -> Result<(), String> {
        let (stage, change) = (step.stage, &step.change);
        if change.is_none() {
            // What does not move later is judged with the stage before.
            if step.from == 0.0 && change.smallest.0 > 0 {
                self.still(step.before, ledger);
            }
            return Ok(());
        }
        if stage.time_squared.0 == 0 {
            let message = format!("stage `{}` moves cells in no time", stage.name);
            self.fail(CheckKind::Speed, step.from, Some(stage), message, ledger);
            return Ok(());
        }
        let sound = self.sizes(change, step.lines, step.to, Some(stage), ledger);
        self.laws(step, ledger);
        self.momentum(step, dynamics, ledger);
        if !sound {
            return Ok(());
        }
        let mut forest = Forest::new(step.before.len());
        let judged = joined(step.before, step.after, change, step.lines, &mut forest);
        match judged {
            None => return Err(format!("stage `{}` is too entangled to be judged", stage.name)),
            Some(Err(meeting)) => self.meet(&meeting, step.from, step.to, Some(stage), ledger),
            Some(Ok(())) => {}
        }
        self.contact_speed(step, &forest, ledger);
        if forest.is_whole() {
            self.forces(step, &forest, dynamics, ledger);
        } else if judged == Some(Ok(())) {
            self.coming_and_going(step, &forest, dynamics, ledger);
        }
        Ok(())
    }

    /// K3, K5 and F2 where contacts that last the stage do not join all cells: on each stretch on which
    /// no contact begins or ends.
    fn coming_and_going(&self, step: &Step, lasting: &Forest, dynamics: &mut Dynamics, ledger: &mut Ledger) {
        let found = passing(step.before, step.after)
            .and_then(|passing| Some((stretches(&passing, step.before.len())?, passing)));
        let Some((stretches, passing)) = found else {
            let name = &step.stage.name;
            let message = format!(
                "in stage `{name}` the robot hangs together, if at all, by contacts that come and go, and these are too many to be judged"
            );
            self.fail(CheckKind::Connectedness, step.from, Some(step.stage), message, ledger);
            return;
        };
        let limit = self.stages.limits.speed_squared;
        for contact in &passing {
            let speed = step.pace.speed_squared_in(contact.window, contact.parting, 2 * step.lines, limit);
            if speed.is_gt() {
                self.rubs(step, contact.parting, contact.cells, ledger);
                break;
            }
        }
        for window in stretches {
            let mut forest = lasting.clone();
            for contact in passing.iter().filter(|contact| contact.window.holds(window)) {
                forest.touch(contact.cells.0, contact.cells.1, 0);
            }
            if !forest.is_whole() {
                let progress = window.from.0 as f64 / window.from.1 as f64;
                let time = step.from + (step.to - step.from) * step.stage.law.part(progress);
                self.connected(&mut forest, time, Some(step.stage), ledger);
                return;
            }
            self.forces(step, &forest, dynamics, ledger);
        }
    }

    /// K1.
    fn sizes(
        &self,
        change: &Change,
        lines: i64,
        time: f64,
        stage: Option<&Stage>,
        ledger: &mut Ledger,
    ) -> bool {
        let smallest = self.stages.limits.smallest;
        let least = i128::from(smallest.0) * i128::from(lines);
        let too_small = i128::from(change.smallest.0) * i128::from(smallest.1) < least;
        for (wrong, (size, cell), limit) in
            [(too_small, change.smallest, smallest.to_f64()), (change.largest.0 > lines, change.largest, 1.0)]
        {
            if wrong {
                let (size, limit) = (size as f64 / lines as f64 * self.cell.size, limit * self.cell.size);
                let words = if too_small { "shrinks to" } else { "grows to" };
                let message =
                    format!("cell {cell} {words} {}, and its limit is {}", length(size), length(limit));
                self.fail_at(CheckKind::JointRange, time, stage, (message, size, limit), &[cell], ledger);
                return false;
            }
        }
        true
    }

    /// K4 and K6.
    fn laws(&self, step: &Step, ledger: &mut Ledger) {
        let (change, pace) = (&step.change, &step.pace);
        let lines = 2 * i128::from(step.lines);
        let too_quick = if self.stages.model.euclidean {
            pace.acceleration_squared(change.square, lines)
        } else {
            pace.acceleration(change.farthest.0.into(), lines, Ratio::ONE)
        };
        if too_quick.is_gt() {
            let (mut distance, cell) = (change.farthest.0 as f64, change.farthest.1);
            if self.stages.model.euclidean {
                distance = libm::sqrt(change.square as f64);
            }
            let unit = self.cell.size / self.stages.time_unit / self.stages.time_unit;
            let value = distance / lines as f64 * pace.bend() * unit;
            let message = format!(
                "cell {cell} would need an acceleration of {}; its force gives {}",
                quantity(value, Dimension::ACCELERATION),
                quantity(unit, Dimension::ACCELERATION)
            );
            self.fail_at(
                CheckKind::Acceleration,
                step.from,
                Some(step.stage),
                (message, value, unit),
                &[cell],
                ledger,
            );
        }
        self.note_speed(step, change.resized.0, step.lines, &[change.resized.1], ledger);
        let limit = self.stages.limits.speed_squared;
        if pace.speed_squared(change.resized.0, step.lines, limit).is_gt() {
            let cell = change.resized.1;
            let value = self.speed(step, change.resized.0, step.lines);
            let message = format!(
                "cell {cell} changes its size at {}; its greatest speed is {}",
                speed(value),
                speed(self.cell.speed)
            );
            let found = (message, value, self.cell.speed);
            self.fail_at(CheckKind::Speed, step.from, Some(step.stage), found, &[cell], ledger);
        }
    }

    /// K5.
    fn contact_speed(&self, step: &Step, forest: &Forest, ledger: &mut Ledger) {
        let (a, b) = forest.parted;
        self.note_speed(step, forest.parting, 2 * step.lines, &[a, b], ledger);
        let limit = self.stages.limits.speed_squared;
        if step.pace.speed_squared(forest.parting, 2 * step.lines, limit).is_gt() {
            self.rubs(step, forest.parting, (a, b), ledger);
        }
    }

    fn rubs(&self, step: &Step, parting: i64, (a, b): (u32, u32), ledger: &mut Ledger) {
        let value = self.speed(step, parting, 2 * step.lines);
        let message = format!(
            "cells {a} and {b}, in contact, move past or from each other at {}; their greatest speed is {}",
            speed(value),
            speed(self.cell.speed)
        );
        let found = (message, value, self.cell.speed);
        self.fail_at(CheckKind::Speed, step.from, Some(step.stage), found, &[a, b], ledger);
    }

    fn speed(&self, step: &Step, distance: i64, lines: i64) -> f64 {
        distance as f64 / lines as f64 * step.pace.rate() * self.cell.size / self.stages.time_unit
    }

    fn note_speed(&self, step: &Step, distance: i64, lines: i64, cells: &[u32], ledger: &mut Ledger) {
        let margin = 1.0 - self.speed(step, distance, lines) / self.cell.speed;
        lower(&mut ledger.verdict.speed_margin, margin, step.from, || names(cells));
    }

    /// F1 and F3, and what goes with speeds.
    fn momentum(&self, step: &Step, dynamics: &mut Dynamics, ledger: &mut Ledger) {
        let (change, pace) = (&step.change, &step.pace);
        if let Some(axis) = (0..3).find(|&axis| change.drift[axis] != 0) {
            let axis = ["x", "y", "z"][axis];
            let message =
                format!("the centre of mass moves along {axis}: something outside would have to push");
            self.fail(CheckKind::Momentum, step.from, Some(step.stage), message, ledger);
        }
        let lines = 2.0 * step.lines as f64;
        let unit_speed = self.cell.size / self.stages.time_unit;
        let rate = pace.rate() * unit_speed;
        let turning =
            change.turning.map(|l| l as f64 / lines / lines * rate * self.cell.size * self.cell.mass);
        let turning = libm::sqrt(turning.iter().map(|l| l * l).sum());
        if change.turning != [0; 3] && self.stages.model.balanced {
            let message = format!(
                "the plan is to be balanced, and its angular momentum gets to {}",
                quantity(turning, Dimension::ANGULAR_MOMENTUM)
            );
            let found = (message, turning, 0.0);
            self.fail_at(CheckKind::Momentum, step.from, Some(step.stage), found, &[], ledger);
        }
        let energy = 0.5 * self.cell.mass * (change.squares as f64) / lines / lines * rate * rate;
        ledger.verdict.energy += energy;
        dynamics.angular_momentum = dynamics.angular_momentum.max(turning);
        dynamics.peak_energy = dynamics.peak_energy.max(energy);
        dynamics.peak_speed = dynamics.peak_speed.max(libm::sqrt(change.square as f64) / lines * rate);
    }

    /// F2 and F4.
    fn forces(&self, step: &Step, forest: &Forest, dynamics: &mut Dynamics, ledger: &mut Ledger) {
        if step.change.drift != [0; 3] {
            return;
        }
        let lines = 2 * i128::from(step.lines);
        for axis in (0..3).filter(|&axis| step.change.axes[axis]) {
            let (force, (a, b)) = match forest.forces(step.before, step.after, axis) {
                Ok(worst) => worst,
                Err(_) => {
                    let message = "the forces between the cells do not add up".to_string();
                    self.fail(CheckKind::Momentum, step.from, Some(step.stage), message, ledger);
                    continue;
                }
            };
            let unit = self.cell.mass * self.cell.size / self.stages.time_unit / self.stages.time_unit;
            let value = force as f64 / lines as f64 * step.pace.bend() * unit;
            dynamics.peak_force = dynamics.peak_force.max(value);
            let Some(limit) = self.stages.model.contact_force else { continue };
            let bound = limit.to_f64() * unit;
            lower(&mut ledger.verdict.bond_margin, 1.0 - value / bound, step.from, || names(&[a, b]));
            if step.pace.acceleration(force, lines, limit).is_gt() {
                let message = format!(
                    "between cells {a} and {b} a force of {} is needed; {} is allowed",
                    quantity(value, Dimension::FORCE),
                    quantity(bound, Dimension::FORCE)
                );
                let found = (message, value, bound);
                self.fail_at(CheckKind::BondLoad, step.from, Some(step.stage), found, &[a, b], ledger);
            }
        }
    }

    /// K2.
    fn meet(&self, meeting: &Meeting, from: f64, to: f64, stage: Option<&Stage>, ledger: &mut Ledger) {
        let (a, b) = meeting.cells;
        let name = stage.map_or(String::new(), |stage| format!(" in stage `{}`", stage.name));
        let message = format!("cells {a} and {b} meet{name}");
        let time = if meeting.at_start { from } else { to };
        self.fail_at(CheckKind::Collision, time, stage, (message, 0.0, 0.0), &[a, b], ledger);
    }

    /// K3.
    fn connected(&self, forest: &mut Forest, time: f64, stage: Option<&Stage>, ledger: &mut Ledger) {
        if forest.is_whole() {
            return;
        }
        let pieces = forest.pieces();
        let name = stage.map_or(String::new(), |stage| format!(" in stage `{}`", stage.name));
        let message = format!(
            "the robot falls into {} pieces{name}: one of {} cells, one of {} with cell {}",
            pieces.len(),
            pieces[0].0,
            pieces[1].0,
            pieces[1].1
        );
        let found = (message, pieces.len() as f64, 1.0);
        self.fail_at(CheckKind::Connectedness, time, stage, found, &[pieces[1].1], ledger);
    }

    fn fail(&self, kind: CheckKind, time: f64, stage: Option<&Stage>, message: String, ledger: &mut Ledger) {
        self.fail_at(kind, time, stage, (message, 0.0, 0.0), &[], ledger);
    }

    fn fail_at(
        &self,
        kind: CheckKind,
        time: f64,
        stage: Option<&Stage>,
        (message, value, limit): (String, f64, f64),
        cells: &[u32],
        ledger: &mut Ledger,
    ) {
        ledger.fail(Failure { message, value, limit, at: names(cells), ..self.failure(kind, time, stage) });
    }

    fn failure(&self, kind: CheckKind, time: f64, stage: Option<&Stage>) -> Failure {
        Failure {
            kind,
            time,
            until: None,
            at: vec![],
            message: String::new(),
            value: 0.0,
            limit: 0.0,
            blame: stage.map(|stage| stage.cause).into_iter().collect(),
            blames_start: false,
        }
    }
}

fn names(cells: &[u32]) -> Vec<String> {
    cells.iter().map(|cell| format!("cell {cell}")).collect()
}

fn length(value: f64) -> String {
    quantity(value, Dimension::LENGTH)
}

fn speed(value: f64) -> String {
    quantity(value, Dimension::SPEED)
}
