//! The order in which the stages of a lattice plan are judged, from the start to the end.

use super::judgement::{Judgement, Step};
use super::tolerances::Tolerances;
use crate::plan::lattice::contacts::ContactForest;
use crate::plan::lattice::law::{Change, TimeScaling, rests_between, velocities_continue};
use crate::plan::lattice::measures::{examine, time_between};
use crate::plan::lattice::transient::{contact_intervals, transient_contacts};
use crate::plan::lattice::{Cube, Grid, LatticeFault, boxes};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Dynamics, Ground, Plan, Ratio, Run, Stage, World};
use std::fmt;

/// The greatest number of cells times stages that is judged: some minutes of work.
const WORK_MAX: u64 = 1_000_000_000;

/// The reason for which a lattice plan is not judged.
pub(super) enum NotJudged {
    /// There are no exact integers for it.
    Lattice(LatticeFault),
    /// Its world has gravity or a ground.
    World,
    /// Its units ask more of the cells than the library states: the name of the cell.
    Units(String),
    /// It has too many cells and stages.
    Work,
    /// A cell is not placed at the start: its number.
    Unplaced(usize),
    /// More pairs of cells come near each other in a stage than are examined: the name of the stage.
    Entangled(String),
    /// More pairs of cells are near each other at the start than are examined.
    EntangledStart,
}

impl From<LatticeFault> for NotJudged {
    fn from(fault: LatticeFault) -> NotJudged {
        NotJudged::Lattice(fault)
    }
}

impl fmt::Display for NotJudged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotJudged::Lattice(fault) => fault.fmt(f),
            NotJudged::World => {
                f.write_str("plans of lattices are judged without gravity and without a ground only")
            }
            NotJudged::Units(cell) => write!(f, "the plan asks more of its cells than a `{cell}` can do"),
            NotJudged::Work => write!(f, "more than {WORK_MAX} cells times stages are not judged"),
            NotJudged::Unplaced(cell) => write!(f, "cell {cell} has no place or no size at the start"),
            NotJudged::Entangled(stage) => write!(f, "stage `{stage}` is too entangled to be judged"),
            NotJudged::EntangledStart => f.write_str("the start is too entangled to be judged"),
        }
    }
}

impl Judgement<'_> {
    /// Checks the assumptions of the judge: no gravity, no ground, units of length, time and mass that ask no more of
    /// the cell than its type states, and a limited number of cells times stages.
    ///
    /// # Errors
    /// [`NotJudged::World`], [`NotJudged::Units`] or [`NotJudged::Work`].
    pub(super) fn assumptions(&self, plan: &Plan) -> Result<(), NotJudged> {
        let floats = |world: &World| world.gravity == 0.0 && world.ground == Ground::Off;
        if !plan.worlds.iter().all(|w| floats(&w.world)) {
            return Err(NotJudged::World);
        }
        let tolerances = Tolerances::default();
        let (cell, stages) = (self.cell, self.stages);
        let at_most = |a: f64, b: f64| a <= b * (1.0 + tolerances.units);
        let unit_speed = cell.size / stages.time_unit;
        let sound = at_most(unit_speed / stages.time_unit, cell.force / cell.mass)
            && at_most(cell.shrinks_to, stages.limits.smallest.to_f64() * cell.size)
            && at_most(libm::sqrt(stages.limits.speed_squared.to_f64()) * unit_speed, cell.speed);
        if !sound {
            return Err(NotJudged::Units(cell.name.clone()));
        }
        let work = stages.stages.iter().map(|s| stages.count + s.count()).fold(0, u64::saturating_add);
        if work > 2 * WORK_MAX {
            return Err(NotJudged::Work);
        }
        Ok(())
    }

    /// Judges the start of the plan and then stage after stage; failures and worst values go to `ledger`.
    ///
    /// # Errors
    /// [`NotJudged`] if there are no exact integers for the plan, a cell has no place at the start, or too many pairs
    /// of cells come near each other.
    pub(super) fn stages(&mut self, ledger: &mut Ledger) -> Result<(), NotJudged> {
        let mut grid = Grid::at_start(self.stages)?;
        // A cell that no run names has no size.
        let mut before = vec![Cube::default(); self.stages.count as usize];
        grid.place(&self.stages.start, &mut before)?;
        if let Some(cell) = before.iter().position(|cube| (0..3).any(|axis| cube.size(axis) <= 0)) {
            return Err(NotJudged::Unplaced(cell));
        }
        if self.stages.count == 0 {
            return Ok(());
        }
        self.obstacles = self.placed_obstacles(grid)?;
        let mut dynamics = Dynamics::default();
        let instants = self.stages.instants();
        self.start(&before, grid, ledger)?;
        let mut earlier: Vec<Cube> = Vec::new();
        let mut after = before.clone();
        for (index, stage) in self.stages.stages.iter().enumerate() {
            let stages = self.stages.stages.len();
            crate::interrupt::progress_checkpoint(|| format!("stage {} of {stages}", index + 1));
            let last = index.checked_sub(1).map(|i| &self.stages.stages[i]);
            // Velocities are compared where the robot moves on only: else the cells before are on no grid with these.
            let moving = last.filter(|last| !rests_between(last, stage));
            if moving.is_none() {
                earlier.clear();
            }
            grid.refine(|| stage.ratios(), &mut [&mut before, &mut earlier, &mut self.obstacles])?;
            after.clone_from(&before);
            grid.advance(&stage.end, &mut after)?;
            if let Some(last) = moving {
                self.velocities_continuous(
                    (last, &earlier),
                    &before,
                    (stage, &after),
                    instants[index],
                    ledger,
                );
            }
            let step = Step {
                stage,
                from: instants[index],
                to: instants[index + 1],
                change: Change::of(&before, &after),
                before: &before,
                after: &after,
                scaling: TimeScaling::of(stage),
                lines: grid.lines,
            };
            self.step(&step, &mut dynamics, ledger)?;
            std::mem::swap(&mut earlier, &mut before);
            std::mem::swap(&mut before, &mut after);
        }
        // The lower bound on the duration compares with the start, placed again to save memory; no bound is known where no
        // grid holds both.
        if grid.refine(|| self.stages.ratios_at_start(), &mut [&mut before]).is_ok() {
            after.clone_from(&before);
            grid.place(&self.stages.start, &mut after)?;
            dynamics.lower_bound = time_between(self.stages, (&after, &before), grid, self.cell.slides);
        }
        ledger.verdict.samples = self.stages.stages.len() + 1;
        ledger.verdict.dynamics = Some(dynamics);
        Ok(())
    }

    /// Returns the obstacles in grid lines.
    fn placed_obstacles(&self, grid: Grid) -> Result<Vec<Cube>, NotJudged> {
        let runs = self.stages.anchor.as_ref().map_or(&[][..], |anchor| &anchor.obstacles[..]);
        let count = runs.iter().map(Run::count).sum::<u64>();
        let mut obstacles = vec![Cube::default(); count as usize];
        grid.place(runs, &mut obstacles)?;
        // Obstacles that no run names, because others are named twice, have no size.
        obstacles.retain(|obstacle| obstacle.size(0) > 0);
        Ok(obstacles)
    }

    /// Checks K7, and the start by itself for plans that do not move at first.
    fn start(&self, cubes: &[Cube], grid: Grid, ledger: &mut Ledger) -> Result<(), NotJudged> {
        let change = Change::of(cubes, cubes);
        self.sizes(&change, grid.lines, 0.0, None, ledger);
        let first = self.stages.stages.first();
        if first.is_none_or(|stage| stage.time_squared.0 == 0) && change.smallest.0 > 0 {
            self.still(cubes, ledger)?;
        }
        let moving = |stage: &Stage, ramp: Ratio| ramp.0 == 0 && stage.time_squared.0 > 0;
        if let Some(stage) = first.filter(|s| moving(s, s.law.ramps().0)) {
            self.fail(CheckKind::Rest, 0.0, Some(stage), "the plan begins in motion".into(), ledger);
        }
        if let Some(stage) = self.stages.stages.last().filter(|s| moving(s, s.law.ramps().1)) {
            let end = self.stages.duration();
            self.fail(CheckKind::Rest, end, Some(stage), "the plan ends in motion".into(), ledger);
        }
        Ok(())
    }

    /// Checks K2 and K3 of cells that do not move.
    fn still(&self, cubes: &[Cube], ledger: &mut Ledger) -> Result<(), NotJudged> {
        let mut forest = ContactForest::of_cells(cubes.len(), self.cell.slides);
        match boxes::examine(cubes, cubes, &mut forest) {
            None => return Err(NotJudged::EntangledStart),
            Some(Err(overlap)) => self.overlapping(&overlap, 0.0, 0.0, None, ledger),
            Some(Ok(())) => self.connected(&mut forest, 0.0, None, ledger),
        }
        self.clear_of_obstacles((cubes, cubes), (0.0, 0.0), None, ledger).ok_or(NotJudged::EntangledStart)
    }

    /// Checks that velocities are continuous between two stages.
    fn velocities_continuous(
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
        if let Err(cell) = velocities_continue(last, between, next) {
            let message = format!("the velocity of cell {cell} jumps before stage `{}`", next.0.name);
            self.fail(CheckKind::Acceleration, time, Some(next.0), message, ledger);
        }
    }

    /// Judges one stage.
    fn step(&self, step: &Step, dynamics: &mut Dynamics, ledger: &mut Ledger) -> Result<(), NotJudged> {
        let (stage, change) = (step.stage, &step.change);
        if change.is_none() {
            // A later stage without motion is judged with the stage before.
            if step.from == 0.0 && change.smallest.0 > 0 {
                self.still(step.before, ledger)?;
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
        let mut forest = ContactForest::of_cells(step.before.len(), self.cell.slides);
        let judged = examine(step.before, step.after, change, step.lines, &mut forest);
        match judged {
            None => return Err(NotJudged::Entangled(stage.name.clone())),
            Some(Err(overlap)) => self.overlapping(&overlap, step.from, step.to, Some(stage), ledger),
            Some(Ok(())) => {}
        }
        let times = (step.from, step.to);
        self.clear_of_obstacles((step.before, step.after), times, Some(stage), ledger)
            .ok_or_else(|| NotJudged::Entangled(stage.name.clone()))?;
        self.contact_speed(step, &forest, ledger);
        if forest.is_connected() {
            self.forces(step, &forest, dynamics, ledger);
        } else if judged == Some(Ok(())) && self.cell.slides {
            self.transient(step, &forest, dynamics, ledger);
        } else if judged == Some(Ok(())) {
            // The middles of two faces meet for the whole stage, or at one instant of it.
            self.connected(&mut forest, step.from, Some(stage), ledger);
        }
        Ok(())
    }

    /// Checks K3, K5 and F2 where contacts that last the stage do not connect all cells: on each interval on
    /// which no contact begins or ends.
    fn transient(&self, step: &Step, lasting: &ContactForest, dynamics: &mut Dynamics, ledger: &mut Ledger) {
        let found = transient_contacts(step.before, step.after)
            .and_then(|passing| Some((contact_intervals(&passing, step.before.len())?, passing)));
        let Some((intervals, passing)) = found else {
            let name = &step.stage.name;
            let message = format!(
                "in stage `{name}` the robot hangs together, if at all, by contacts that come and go, and these are too many to be judged"
            );
            self.fail(CheckKind::Connectedness, step.from, Some(step.stage), message, ledger);
            return;
        };
        let limit = self.stages.limits.speed_squared;
        for contact in &passing {
            let speed = step.scaling.compare_speed_squared_within(
                contact.window,
                contact.relative,
                2 * step.lines,
                limit,
            );
            if speed.is_gt() {
                self.contact_too_fast(step, contact.relative, contact.cells, ledger);
                break;
            }
        }
        for window in intervals {
            let mut forest = lasting.clone();
            for contact in passing.iter().filter(|contact| contact.window.contains(window)) {
                forest.touch(contact.cells.0, contact.cells.1, 0);
            }
            if !forest.is_connected() {
                let progress = window.from.0 as f64 / window.from.1 as f64;
                let time = step.from + (step.to - step.from) * step.stage.law.part(progress);
                self.connected(&mut forest, time, Some(step.stage), ledger);
                return;
            }
            self.forces(step, &forest, dynamics, ledger);
        }
    }
}
