//! The checks of one stage: sizes, accelerations, speeds, momentum, contact forces, overlaps and
//! connectedness.

use super::judgement::{Judgement, Step, names};
use crate::plan::lattice::contacts::ContactForest;
use crate::plan::lattice::lanes::Overlap;
use crate::plan::lattice::law::Change;
use crate::plan::lattice::{Cube, boxes};
use crate::plan::verify::ledger::{Ledger, keep_least};
use crate::plan::{CheckKind, Dynamics, Ratio, Stage};
use crate::units::{Dimension, quantity};

impl Judgement<'_> {
    /// Checks that no edge of a cell is shorter or longer than allowed at the end of a stage (K1), and records the
    /// failure. Returns false if one is. `lines`: the number of grid lines to the edge of a full-sized cell; `time`:
    /// that of the end of the stage, s; `stage`: the one to blame, `None` at the start of the plan.
    pub(super) fn sizes(
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

    /// Checks the greatest acceleration of a cell in a stage, along each axis or in the Euclidean norm (K4), and the
    /// greatest rate of an edge's length (K6); records failures and the least speed margin.
    pub(super) fn laws(&self, step: &Step, ledger: &mut Ledger) {
        let (change, scaling) = (&step.change, &step.scaling);
        let lines = 2 * i128::from(step.lines);
        // K4: acceleration, along each axis or in the Euclidean norm.
        let too_quick = if self.stages.model.euclidean {
            scaling.compare_acceleration_squared(change.square, lines)
        } else {
            scaling.compare_acceleration(change.farthest.0.into(), lines, Ratio::ONE)
        };
        if too_quick.is_gt() {
            let (mut distance, cell) = (change.farthest.0 as f64, change.farthest.1);
            if self.stages.model.euclidean {
                distance = libm::sqrt(change.square as f64);
            }
            let unit = self.cell.size / self.stages.time_unit / self.stages.time_unit;
            let value = distance / lines as f64 * scaling.peak_acceleration() * unit;
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
        // K6: rate of sizes.
        self.note_speed(step, change.resized.0, step.lines, &[change.resized.1], ledger);
        let limit = self.stages.limits.speed_squared;
        if scaling.compare_speed_squared(change.resized.0, step.lines, limit).is_gt() {
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

    /// Checks the greatest relative speed of two cells whose contact lasts the whole stage (K5); records a failure
    /// and the least speed margin.
    pub(super) fn contact_speed(&self, step: &Step, forest: &ContactForest, ledger: &mut Ledger) {
        let (a, b) = forest.fastest;
        self.note_speed(step, forest.relative, 2 * step.lines, &[a, b], ledger);
        let limit = self.stages.limits.speed_squared;
        if step.scaling.compare_speed_squared(forest.relative, 2 * step.lines, limit).is_gt() {
            self.contact_too_fast(step, forest.relative, (a, b), ledger);
        }
    }

    /// Records that two cells in contact move too fast relative to each other (K5); `(a, b)`: their numbers;
    /// `relative`: their relative displacement in the stage, in lines of the half-line grid, of which `2 *
    /// step.lines` are a full-sized cell.
    pub(super) fn contact_too_fast(
        &self,
        step: &Step,
        relative: i64,
        (a, b): (u32, u32),
        ledger: &mut Ledger,
    ) {
        let value = self.speed(step, relative, 2 * step.lines);
        let message = format!(
            "cells {a} and {b}, in contact, move past or from each other at {}; their greatest speed is {}",
            speed(value),
            speed(self.cell.speed)
        );
        let found = (message, value, self.cell.speed);
        self.fail_at(CheckKind::Speed, step.from, Some(step.stage), found, &[a, b], ledger);
    }

    /// Returns the peak speed, in m/s, of a thing that moves by `distance / lines` cells in the stage.
    fn speed(&self, step: &Step, distance: i64, lines: i64) -> f64 {
        distance as f64 / lines as f64 * step.scaling.peak_speed() * self.cell.size / self.stages.time_unit
    }

    /// Keeps the least speed margin.
    fn note_speed(&self, step: &Step, distance: i64, lines: i64, cells: &[u32], ledger: &mut Ledger) {
        let margin = 1.0 - self.speed(step, distance, lines) / self.cell.speed;
        keep_least(&mut ledger.verdict.speed_margin, margin, step.from, || names(cells));
    }

    /// Checks that the cells that stand fast neither move nor change their size, and that the centre of mass stays if
    /// there are none (F1).
    fn held(&self, step: &Step, ledger: &mut Ledger) {
        let message = match &self.stages.anchor {
            Some(anchor) => {
                let moves = |cell: &&u64| step.before[**cell as usize] != step.after[**cell as usize];
                let Some(cell) = anchor.cells.iter().find(moves) else { return };
                format!("cell {cell} is fixed, and moves in stage `{}`", step.stage.name)
            }
            None => {
                let Some(axis) = (0..3).find(|&axis| step.change.drift[axis] != 0) else { return };
                let axis = ["x", "y", "z"][axis];
                format!("the centre of mass moves along {axis}: something outside would have to push")
            }
        };
        self.fail(CheckKind::Momentum, step.from, Some(step.stage), message, ledger);
    }

    /// Checks that no cell overlaps an obstacle (K2) while cells get from the first to the second configuration,
    /// between two times (s), and records the failure; `stage`: `None` at the start of the plan. `None` if too many
    /// pairs come near each other.
    pub(super) fn clear_of_obstacles(
        &self,
        (before, after): (&[Cube], &[Cube]),
        (from, to): (f64, f64),
        stage: Option<&Stage>,
        ledger: &mut Ledger,
    ) -> Option<()> {
        if self.obstacles.is_empty() {
            return Some(());
        }
        if let Err(overlap) = boxes::examine_obstacles(before, after, &self.obstacles)? {
            let (cell, obstacle) = overlap.cells;
            let name = stage.map_or(String::new(), |stage| format!(" in stage `{}`", stage.name));
            let message = format!("cell {cell} runs into obstacle {obstacle}{name}");
            let time = if overlap.at_start { from } else { to };
            self.fail_at(CheckKind::Collision, time, stage, (message, 0.0, 0.0), &[cell], ledger);
        }
        Some(())
    }

    /// Checks that the centre of mass or the fixed cells stay (F1) and, for balanced plans, that angular momentum is zero
    /// (F3). Takes the stage's energy (J), angular momentum and greatest speed (m/s) into `dynamics` and the verdict.
    pub(super) fn momentum(&self, step: &Step, dynamics: &mut Dynamics, ledger: &mut Ledger) {
        let (change, scaling) = (&step.change, &step.scaling);
        self.held(step, ledger);
        let lines = 2.0 * step.lines as f64;
        let unit_speed = self.cell.size / self.stages.time_unit;
        let rate = scaling.peak_speed() * unit_speed;
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
        // A robot that is held has no angular momentum of its own.
        if self.stages.anchor.is_none() {
            dynamics.angular_momentum = dynamics.angular_momentum.max(turning);
        }
        dynamics.peak_energy = dynamics.peak_energy.max(energy);
        dynamics.peak_speed = dynamics.peak_speed.max(libm::sqrt(change.square as f64) / lines * rate);
    }

    /// Checks that contact forces exist that explain the motion of the cells (F2), and that they stay within the
    /// limit, if there is one (F4). Does nothing if the centre of mass moves, which has failed already. `forest`: the
    /// contacts that carry the forces.
    pub(super) fn forces(
        &self,
        step: &Step,
        forest: &ContactForest,
        dynamics: &mut Dynamics,
        ledger: &mut Ledger,
    ) {
        if step.change.drift != [0; 3] && self.stages.anchor.is_none() {
            return;
        }
        let lines = 2 * i128::from(step.lines);
        for axis in (0..3).filter(|&axis| step.change.axes[axis]) {
            let (force, (a, b)) = match forest.forces_from(self.stages.root(), step.before, step.after, axis)
            {
                Ok(worst) => worst,
                Err(_) => {
                    let message = "the forces between the cells do not add up".to_string();
                    self.fail(CheckKind::Momentum, step.from, Some(step.stage), message, ledger);
                    continue;
                }
            };
            let unit = self.cell.mass * self.cell.size / self.stages.time_unit / self.stages.time_unit;
            let value = force as f64 / lines as f64 * step.scaling.peak_acceleration() * unit;
            dynamics.peak_force = dynamics.peak_force.max(value);
            let Some(limit) = self.stages.model.contact_force else { continue };
            let bound = limit.to_f64() * unit;
            keep_least(&mut ledger.verdict.bond_margin, 1.0 - value / bound, step.from, || names(&[a, b]));
            if step.scaling.compare_acceleration(force, lines, limit).is_gt() {
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

    /// Records that two cells overlap (K2) in a stage that lasts from `from` to `to` (s): at `from` if they overlap
    /// already at the stage's start, else at `to`. `stage`: `None` at the start of the plan.
    pub(super) fn overlapping(
        &self,
        overlap: &Overlap,
        from: f64,
        to: f64,
        stage: Option<&Stage>,
        ledger: &mut Ledger,
    ) {
        let (a, b) = overlap.cells;
        let name = stage.map_or(String::new(), |stage| format!(" in stage `{}`", stage.name));
        let message = format!("cells {a} and {b} meet{name}");
        let time = if overlap.at_start { from } else { to };
        self.fail_at(CheckKind::Collision, time, stage, (message, 0.0, 0.0), &[a, b], ledger);
    }

    /// Checks at `time` (s) that the contacts in `forest` connect all cells (K3), and records the failure otherwise;
    /// `stage` is `None` at the start of the plan.
    pub(super) fn connected(
        &self,
        forest: &mut ContactForest,
        time: f64,
        stage: Option<&Stage>,
        ledger: &mut Ledger,
    ) {
        if forest.is_connected() {
            return;
        }
        let pieces = forest.components();
        let name = stage.map_or(String::new(), |stage| format!(" in stage `{}`", stage.name));
        let holds =
            "; such cells do not slide: they hold each other only where the middles of their faces meet";
        let message = format!(
            "the robot falls into {} pieces{name}: one of {} cells, one of {} with cell {}{}",
            pieces.len(),
            pieces[0].0,
            pieces[1].0,
            pieces[1].1,
            if self.cell.slides { "" } else { holds }
        );
        let found = (message, pieces.len() as f64, 1.0);
        self.fail_at(CheckKind::Connectedness, time, stage, found, &[pieces[1].1], ledger);
    }
}

fn length(value: f64) -> String {
    quantity(value, Dimension::LENGTH)
}

fn speed(value: f64) -> String {
    quantity(value, Dimension::SPEED)
}
