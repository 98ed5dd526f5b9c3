//! A robot that floats and turns at no time: stages in the plane whose angular momentum pairs of cells take up that
//! spin.

use super::Refusal;
use super::fraction::{Fraction, common_multiple};
use super::motion::{PlanLimits, distance_bound, least_time};
use super::pair::{CellPlace, Pair, STAGES_PER_MOMENT, Site};
use crate::plan::lattice::Cube;
use crate::plan::lattice::contacts::ContactForest;
use crate::plan::lattice::law::Change;
use crate::plan::lattice::measures::examine;
use crate::plan::{CellMove, Ratio};
use std::collections::BTreeMap;

/// The cells of a robot in the plane, by number, and in which sites they are.
#[derive(Clone)]
pub(super) struct Robot {
    pub(super) cells: Vec<CellPlace>,
    /// The cell in each site that holds one.
    pub(super) singles: BTreeMap<Site, usize>,
    /// The sites that hold two.
    pub(super) pairs: Vec<Pair>,
}

/// A stage of a motion of a robot that floats.
#[derive(Clone)]
pub(super) struct FloatStage {
    pub(super) name: &'static str,
    pub(super) time_squared: Ratio,
    pub(super) law: crate::plan::Law,
    pub(super) classes: Vec<CellMove>,
    pub(super) of_cell: Vec<u32>,
}

/// A robot with the stages that brought it where it is.
pub(super) struct Floating {
    pub(super) limits: PlanLimits,
    pub(super) robot: Robot,
    pub(super) stages: Vec<FloatStage>,
}

/// A change of a part of the robot: where cells that are in no pair, and the middles of pairs by index, go.
#[derive(Default)]
pub(super) struct Target {
    pub(super) cells: Vec<(usize, CellPlace)>,
    pub(super) pairs: Vec<(usize, [Fraction; 2])>,
}

/// A state that a robot can return to.
pub(super) struct Mark {
    robot: Robot,
    stages: usize,
}

/// The greatest number of lines to a cell on the grid of a stage.
const LINES_MAX: i128 = 1 << 40;

impl Robot {
    /// Returns the whole cells at these sites.
    pub(super) fn at(sites: &[Site]) -> Robot {
        let cells = sites.iter().map(|&site| CellPlace::whole(site)).collect();
        Robot { cells, singles: sites.iter().copied().zip(0..).collect(), pairs: vec![] }
    }

    /// Returns the index of the pair in a site.
    pub(super) fn pair_at(&self, site: Site) -> Option<usize> {
        self.pairs.iter().position(|pair| pair.site == site)
    }

    /// Returns the sites that hold cells, in ascending order.
    pub(super) fn sites(&self) -> Vec<Site> {
        let pairs = self.pairs.iter().map(|pair| pair.site);
        let mut sites: Vec<Site> = self.singles.keys().copied().chain(pairs).collect();
        sites.sort_unstable();
        sites
    }

    /// Returns the cells of a target, those of pairs with their middles moved, from where they are to where they go.
    fn moving(&self, target: &Target) -> Vec<(usize, CellPlace)> {
        let mut cells = target.cells.clone();
        for &(index, center) in &target.pairs {
            let pair = &self.pairs[index];
            let places = Pair::places(pair.phase, center);
            cells.extend(pair.cells.into_iter().zip(places));
        }
        cells
    }

    /// Returns the angular momentum about the centre of mass of cells that go straight to these places in one stage, but
    /// for the common law of time: Σ x × Δ.
    pub(super) fn moment(&self, moves: &[(usize, CellPlace)]) -> Fraction {
        let zero = [Fraction::ZERO; 2];
        let plus = |a: [Fraction; 2], b: [Fraction; 2]| [a[0] + b[0], a[1] + b[1]];
        let cross = |a: [Fraction; 2], b: [Fraction; 2]| a[0] * b[1] - a[1] * b[0];
        let (mut sum, mut turning) = (zero, Fraction::ZERO);
        for (cell, to) in moves {
            let from = self.cells[*cell].center;
            let by = [to.center[0] - from[0], to.center[1] - from[1]];
            sum = plus(sum, by);
            turning = turning + cross(from, by);
        }
        let all = self.cells.iter().fold(zero, |all, cell| plus(all, cell.center));
        turning - cross(all, sum) / Fraction::whole(self.cells.len() as i64)
    }
}

impl Floating {
    /// Returns a robot at rest.
    pub(super) fn new(limits: PlanLimits, robot: Robot) -> Floating {
        Floating { limits, robot, stages: vec![] }
    }

    /// Returns a mark to which [`restore`](Self::restore) returns.
    pub(super) fn mark(&self) -> Mark {
        Mark { robot: self.robot.clone(), stages: self.stages.len() }
    }

    /// Takes the robot back to a mark.
    pub(super) fn restore(&mut self, mark: &Mark) {
        self.robot = mark.robot.clone();
        self.stages.truncate(mark.stages);
    }

    /// Appends a stage in which cells go to these places; false, and nothing is done, if the robot would turn, fall apart or
    /// hit itself.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit.
    pub(super) fn stage(
        &mut self,
        name: &'static str,
        moves: &[(usize, CellPlace)],
    ) -> Result<bool, Refusal> {
        crate::interrupt::checkpoint();
        let mut after = self.robot.cells.clone();
        moves.iter().for_each(|(cell, to)| after[*cell] = *to);
        if after == self.robot.cells {
            return Ok(true);
        }
        let turning = self.robot.moment(moves);
        if !turning.fits() {
            return Err(Refusal::TooLarge);
        }
        if !turning.is_zero() {
            return Ok(false);
        }
        let Some(stage) = made(name, &self.limits, &self.robot.cells, &after).ok_or(Refusal::TooLarge)?
        else {
            return Ok(false);
        };
        self.stages.push(stage);
        self.robot.cells = after;
        Ok(true)
    }

    /// Brings a part of the robot to a target in one piece of motion while the pairs of the indices `spinning` spin against
    /// it, all corner by corner; false, and the robot is in some state between, if there are none and some are
    /// needed, or the robot would fall apart or hit itself.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit.
    pub(super) fn carry(
        &mut self,
        name: &'static str,
        target: &Target,
        spinning: &[usize],
    ) -> Result<bool, Refusal> {
        let moment = self.robot.moment(&self.robot.moving(target));
        let spin = -(moment * Fraction::whole(STAGES_PER_MOMENT));
        if !spin.fits() {
            return Err(Refusal::TooLarge);
        }
        let (sense, whole) = (spin.sign(), spin.abs());
        let from: Vec<CellPlace> = target.cells.iter().map(|(cell, _)| self.robot.cells[*cell]).collect();
        let middles: Vec<[Fraction; 2]> =
            target.pairs.iter().map(|(index, _)| self.robot.pairs[*index].center).collect();
        let mut left = whole;
        let mut spins = self.shares(spinning, sense, whole);
        if !whole.is_zero() && spins.is_empty() {
            return Ok(false);
        }
        loop {
            let turns = self.next_turns(&mut spins, sense);
            left = turns.iter().fold(left, |left, (_, by)| left - by.abs());
            let part = if whole.is_zero() { Fraction::ONE } else { Fraction::ONE - left / whole };
            let mut moves: Vec<(usize, CellPlace)> = target
                .cells
                .iter()
                .zip(&from)
                .map(|((cell, to), at)| (*cell, at.toward(*to, part)))
                .collect();
            for ((index, to), at) in target.pairs.iter().zip(&middles) {
                self.robot.pairs[*index].center = [0, 1].map(|k| at[k] + (to[k] - at[k]) * part);
            }
            turns
                .iter()
                .for_each(|&(index, by)| self.robot.pairs[index].phase = self.robot.pairs[index].phase + by);
            let moved =
                turns.iter().map(|(index, _)| *index).chain(target.pairs.iter().map(|(index, _)| *index));
            let mut moved: Vec<usize> = moved.collect();
            moved.sort_unstable();
            moved.dedup();
            for index in moved {
                let pair = &self.robot.pairs[index];
                moves.extend(pair.cells.into_iter().zip(Pair::places(pair.phase, pair.center)));
            }
            if !self.stage(name, &moves)? {
                return Ok(false);
            }
            if left.is_zero() {
                return Ok(true);
            }
        }
    }

    /// Returns by how many stages each pair spins in this sense, of `whole` in all: about equally, in whole swaps but for the
    /// first, so that no pair rests where its cells have a corner in common only.
    fn shares(&self, spinning: &[usize], sense: i64, whole: Fraction) -> Vec<(usize, Fraction)> {
        let Some(count) = i64::try_from(spinning.len()).ok().filter(|count| *count > 0) else {
            return vec![];
        };
        let swap = Fraction::whole(2);
        let swaps = (whole / swap).floor();
        let (each, more) = (swaps / i128::from(count), swaps % i128::from(count));
        let mut spins: Vec<(usize, Fraction)> = spinning
            .iter()
            .enumerate()
            .map(|(k, &index)| {
                let whole_swaps = each + i128::from(k > 0 && k as i128 <= more);
                (index, swap * Fraction::new(whole_swaps, 1))
            })
            .collect();
        spins[0].1 = spins[0].1 + whole - swap * Fraction::new(swaps, 1);
        // Half a stage goes to another pair, or comes from it, where the first would rest at a corner.
        let half = Fraction::new(1, 2);
        let is_corner = |(index, by): (usize, Fraction)| {
            let phase = self.robot.pairs[index].phase + by * Fraction::whole(sense);
            phase.denominator() == 1 && phase.floor().rem_euclid(2) == 1
        };
        if is_corner(spins[0]) {
            for k in 1..spins.len() {
                for by in [half, -half] {
                    let (first, other) = ((spins[0].0, spins[0].1 - by), (spins[k].0, spins[k].1 + by));
                    if first.1.sign() >= 0 && other.1.sign() >= 0 && !is_corner(first) && !is_corner(other) {
                        (spins[0], spins[k]) = (first, other);
                        return spins;
                    }
                }
            }
        }
        spins
    }

    /// Returns the spins of one stage, each to the next corner of the pair or to the end of its share, with their signs, and
    /// takes them from the shares.
    fn next_turns(&self, spins: &mut [(usize, Fraction)], sense: i64) -> Vec<(usize, Fraction)> {
        let mut turns = Vec::new();
        for (index, left) in spins.iter_mut().filter(|(_, left)| left.sign() > 0) {
            let by = self.robot.pairs[*index].room(sense).least(*left);
            *left = *left - by;
            turns.push((*index, by * Fraction::whole(sense)));
        }
        turns
    }

    /// Spins a pair by some stages, and another against it; false, and the robot is in some state between, if it would fall
    /// apart.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit.
    pub(super) fn spin(&mut self, index: usize, by: Fraction, other: usize) -> Result<bool, Refusal> {
        let sense = by.sign();
        let mut left = by.abs();
        while left.sign() > 0 {
            let pairs = &self.robot.pairs;
            let done = pairs[index].room(sense).least(pairs[other].room(-sense)).least(left);
            left = left - done;
            let mut moves = Vec::new();
            for (index, sense) in [(index, sense), (other, -sense)] {
                let pair = &mut self.robot.pairs[index];
                pair.phase = pair.phase + done * Fraction::whole(sense);
                moves.extend(pair.cells.into_iter().zip(Pair::places(pair.phase, pair.center)));
            }
            if !self.stage("spin", &moves)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Spins a pair until it is split along an axis, in a sense in which the robot stays in one piece, and one of the others
    /// against it; false if none does.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit.
    pub(super) fn split(&mut self, index: usize, axis: usize, others: &[usize]) -> Result<bool, Refusal> {
        let spins = self.robot.pairs[index].spins_to(axis);
        if spins[0].is_zero() {
            return Ok(true);
        }
        let mark = self.mark();
        for (by, &other) in spins.into_iter().flat_map(|by| others.iter().map(move |other| (by, other))) {
            if self.spin(index, by, other)? {
                return Ok(true);
            }
            self.restore(&mark);
        }
        Ok(false)
    }
}

/// Returns the stage between two configurations in the least time; the inner value is `None` if the robot falls apart or
/// hits itself on the way, the outer one if a number does not fit.
fn made(
    name: &'static str,
    limits: &PlanLimits,
    before: &[CellPlace],
    after: &[CellPlace],
) -> Option<Option<FloatStage>> {
    let mut lines = 2;
    for place in before.iter().chain(after) {
        for number in place.center.iter().chain(&place.size) {
            let denominator = 2 * number.denominator();
            if denominator <= 0 {
                return None;
            }
            if lines % denominator != 0 {
                lines = common_multiple(lines, denominator).filter(|lines| *lines <= LINES_MAX)?;
            }
        }
    }
    let [from, to] = [before, after].map(|places| cubes(places, lines));
    let (from, to) = (from?, to?);
    let lines = lines as i64;
    let mut forest = ContactForest::of_cells(before.len(), limits.slides);
    let free = examine(&from, &to, &Change::of(&from, &to), lines, &mut forest);
    if free != Some(Ok(())) || !forest.is_connected() {
        return Some(None);
    }
    let count = before.len() as i64;
    let mut drift = [Fraction::ZERO; 2];
    let mut numbers: BTreeMap<[Fraction; 4], u32> = BTreeMap::new();
    let mut changes = Vec::new();
    let mut of_cell = Vec::with_capacity(before.len());
    for (a, b) in before.iter().zip(after) {
        let change = [
            b.center[0] - a.center[0],
            b.center[1] - a.center[1],
            b.size[0] - a.size[0],
            b.size[1] - a.size[1],
        ];
        (0..2).for_each(|k| drift[k] = drift[k] + change[k]);
        let class = *numbers.entry(change).or_insert_with(|| {
            changes.push(change);
            changes.len() as u32 - 1
        });
        of_cell.push(class);
    }
    let mean = drift.map(|sum| sum / Fraction::whole(count));
    let (mut farthest, mut growth) = ([Fraction::ZERO; 2], Fraction::ZERO);
    let mut classes = Vec::with_capacity(changes.len());
    for [x, y, w, h] in changes {
        let [x, y] = [x - mean[0], y - mean[1]];
        for (most, value) in [(0, x), (1, y)] {
            if value.abs().order(farthest[most]).is_gt() {
                farthest[most] = value.abs();
            }
        }
        for value in [w.abs(), h.abs()] {
            if value.order(growth).is_gt() {
                growth = value;
            }
        }
        let zero = Ratio::ZERO;
        let displacement = [x.ratio()?, y.ratio()?, zero];
        classes.push(CellMove { displacement, growth: [w.ratio()?, h.ratio()?, zero] });
    }
    let whole = common_multiple(farthest[0].denominator(), farthest[1].denominator())?;
    let reach = farthest.map(|most| most.on_grid(whole));
    let distance =
        distance_bound([i128::from(reach[0]?), i128::from(reach[1]?), 0], whole, limits.euclidean)?;
    let relative = Fraction::new(forest.relative.into(), 2 * i128::from(lines));
    let relative = if growth.order(relative).is_gt() { growth } else { relative };
    let (time_squared, law) = least_time(limits, distance, relative.ratio()?)?;
    Some(Some(FloatStage { name, time_squared, law, classes, of_cell }))
}

/// Returns the cells on a grid of `lines` lines to a cell; `None` if a number does not fit.
fn cubes(places: &[CellPlace], lines: i128) -> Option<Vec<Cube>> {
    let cube = |place: &CellPlace| {
        let mut cube = Cube { lo: [0; 3], hi: [0, 0, lines as i64] };
        for axis in 0..2 {
            let (center, size) = (place.center[axis].on_grid(lines)?, place.size[axis].on_grid(lines)?);
            (cube.lo[axis], cube.hi[axis]) = (center - size / 2, center + size / 2);
        }
        Some(cube)
    };
    places.iter().map(cube).collect()
}
