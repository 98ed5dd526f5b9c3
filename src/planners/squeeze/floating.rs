//! A robot that floats and turns at no time: stages in the plane whose angular momentum pairs of cells take up that
//! spin.

use super::Refusal;
use super::fraction::{Fraction, common_multiple};
use super::motion::{PlanLimits, distance_bound, least_time};
use super::pair::{CellPlace, Pair, STAGES_PER_MOMENT, Site};
use super::rectangles::{Rectangle, greatest_slide};
use crate::plan::{CellMove, Law, Ratio};
use std::cell::Cell;
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
    pub(super) law: Law,
    pub(super) classes: Vec<CellMove>,
    pub(super) of_cell: Vec<u32>,
    /// The number of lines to a cell of the grid on which all cells are at both ends.
    pub(super) lines: i128,
}

/// The work that is left to a search: cells that are examined, whether a stage or a way comes of it or not.
pub(super) struct Budget {
    left: Cell<u64>,
}

/// A robot with the stages that brought it where it is.
pub(super) struct Floating<'a> {
    pub(super) limits: PlanLimits,
    pub(super) robot: Robot,
    pub(super) stages: Vec<FloatStage>,
    pub(super) budget: &'a Budget,
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

/// The greatest number of lines to a cell of a grid on which the cells of two successive stages are, about the centre of
/// mass: plans have no finer ones, and the faces of 400 cells in a row stay within their range.
const LINES_MAX: i128 = 1 << 39;
/// The number of cells whose examination a budget counts for each class of a stage, which takes as much memory as the numbers
/// of more than twenty cells.
const CELLS_PER_CLASS: usize = 24;

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
        self.moment_about(self.sum(), moves)
    }

    /// Returns the sum of the centres of all cells.
    pub(super) fn sum(&self) -> [Fraction; 2] {
        let zero = [Fraction::ZERO; 2];
        self.cells.iter().fold(zero, |all, cell| [all[0] + cell.center[0], all[1] + cell.center[1]])
    }

    /// Returns [`moment`](Self::moment) where the sum of the centres of all cells is known.
    pub(super) fn moment_about(&self, all: [Fraction; 2], moves: &[(usize, CellPlace)]) -> Fraction {
        let cross = |a: [Fraction; 2], b: [Fraction; 2]| a[0] * b[1] - a[1] * b[0];
        let (mut sum, mut turning) = ([Fraction::ZERO; 2], Fraction::ZERO);
        for (cell, to) in moves {
            let from = self.cells[*cell].center;
            let by = [to.center[0] - from[0], to.center[1] - from[1]];
            sum = [sum[0] + by[0], sum[1] + by[1]];
            turning = turning + cross(from, by);
        }
        turning - cross(all, sum) / Fraction::whole(self.cells.len() as i64)
    }
}

impl Budget {
    /// Returns the budget of this many cells.
    pub(super) fn new(cells: u64) -> Budget {
        Budget { left: Cell::new(cells) }
    }

    /// Takes the work on so many cells from the budget.
    ///
    /// # Errors
    /// [`Refusal::Budget`] if that is not left.
    pub(super) fn spend(&self, cells: usize) -> Result<(), Refusal> {
        let left = self.left.get().checked_sub(cells as u64).ok_or(Refusal::Budget)?;
        self.left.set(left);
        Ok(())
    }
}

impl FloatStage {
    /// Returns true if a grid that plans have holds this stage of `count` cells and the one before it.
    pub(super) fn can_follow(&self, last: Option<&FloatStage>, count: usize) -> bool {
        let both = last.map_or(Some(self.lines), |last| common_multiple(last.lines, self.lines));
        both.and_then(|lines| lines.checked_mul(count as i128)).is_some_and(|lines| lines <= LINES_MAX)
    }
}

impl<'a> Floating<'a> {
    /// Returns a robot at rest.
    pub(super) fn new(limits: PlanLimits, robot: Robot, budget: &'a Budget) -> Floating<'a> {
        Floating { limits, robot, stages: vec![], budget }
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
    /// [`Refusal::TooLarge`] if a number does not fit, [`Refusal::Budget`] if nothing is left of it.
    pub(super) fn stage(
        &mut self,
        name: &'static str,
        moves: &[(usize, CellPlace)],
    ) -> Result<bool, Refusal> {
        crate::interrupt::checkpoint();
        self.budget.spend(self.robot.cells.len())?;
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
        let Some(stage) = made(name, &self.limits, &self.robot.cells, &after)? else { return Ok(false) };
        if !stage.can_follow(self.stages.last(), after.len()) {
            return Err(Refusal::TooLarge);
        }
        // Memory is bounded as well.
        self.budget.spend(CELLS_PER_CLASS * stage.classes.len())?;
        self.stages.push(stage);
        self.robot.cells = after;
        Ok(true)
    }

    /// Brings a part of the robot to a target in one straight motion while the pairs of the indices `spinning` spin against
    /// it, all corner by corner; false, and the robot is in some state between, if there are none and some are
    /// needed, or the robot would fall apart or hit itself.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit, [`Refusal::Budget`] if nothing is left of it.
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
        if !whole.is_zero() && spinning.is_empty() {
            return Ok(false);
        }
        let from: Vec<CellPlace> = target.cells.iter().map(|(cell, _)| self.robot.cells[*cell]).collect();
        let middles: Vec<[Fraction; 2]> =
            target.pairs.iter().map(|(index, _)| self.robot.pairs[*index].center).collect();
        let steps = short_steps(whole);
        let mut part = Fraction::ZERO;
        while part != Fraction::ONE {
            let left = whole * (Fraction::ONE - part);
            let rooms = spinning.iter().map(|&index| self.robot.pairs[index].room(sense));
            let most = rooms.fold(Fraction::ZERO, |most, room| most + room);
            let turns = if left.order(most).is_le() {
                part = Fraction::ONE;
                self.last_turns(spinning, sense, left)
            } else {
                // All pairs but one get to corners; that one spins by as much less as makes the part a short fraction.
                let short = Fraction::new((most / whole * steps).floor(), 1) / steps;
                let by = if spinning.len() > 1 && short.sign() > 0 { short } else { most / whole };
                part = part + by;
                self.turns(spinning, sense, whole * by)
            };
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
        }
        self.leave_corners(spinning)
    }

    /// Returns by how many stages each of these pairs spins in this sense, with signs, of `amount` in all, which is less than they
    /// can to the next corners of their paths: those to these corners first that are nearest to them.
    fn turns(&self, spinning: &[usize], sense: i64, amount: Fraction) -> Vec<(usize, Fraction)> {
        let mut rooms: Vec<(Fraction, usize)> =
            spinning.iter().map(|&index| (self.robot.pairs[index].room(sense), index)).collect();
        rooms.sort_by(|a, b| a.0.order(b.0).then(a.1.cmp(&b.1)));
        let mut left = amount;
        let mut turns = Vec::new();
        for (room, index) in rooms {
            let by = room.least(left);
            left = left - by;
            if by.sign() > 0 {
                turns.push((index, by * Fraction::whole(sense)));
            }
        }
        turns
    }

    /// Returns [`turns`](Self::turns) after which these pairs rest, so that few do so at a corner.
    fn last_turns(&self, spinning: &[usize], sense: i64, amount: Fraction) -> Vec<(usize, Fraction)> {
        let quarter = Fraction::new(1, 4);
        let limit = |pass: usize, index: usize| {
            let pair = &self.robot.pairs[index];
            let room = pair.room(sense);
            let to_corner = Pair::is_corner(pair.phase + room * Fraction::whole(sense));
            match pass {
                0 if Pair::is_corner(pair.phase) => quarter,
                0 => Fraction::ZERO,
                1 if to_corner => Fraction::ZERO,
                // The last quarter of a stage before the corner.
                2 if to_corner => Fraction::new(-(-(room / quarter)).floor() - 1, 4),
                _ => room,
            }
        };
        let mut left = amount;
        let mut turns: Vec<(usize, Fraction)> =
            spinning.iter().map(|&index| (index, Fraction::ZERO)).collect();
        for pass in 0..4 {
            for (index, by) in &mut turns {
                let more = (limit(pass, *index) - *by).least(left);
                if more.sign() > 0 {
                    (*by, left) = (*by + more, left - more);
                }
            }
        }
        turns.retain(|(_, by)| by.sign() > 0);
        turns.iter_mut().for_each(|(_, by)| *by = *by * Fraction::whole(sense));
        turns
    }

    /// Spins those of these pairs that rest at a corner on from there, against each other or another one; if that can't
    /// be, they stay. Always true, so that a motion ends with it.
    fn leave_corners(&mut self, spinning: &[usize]) -> Result<bool, Refusal> {
        let pairs = &self.robot.pairs;
        let resting: Vec<usize> =
            spinning.iter().copied().filter(|&index| Pair::is_corner(pairs[index].phase)).collect();
        if resting.is_empty() {
            return Ok(true);
        }
        let (one, half) = (Fraction::ONE, Fraction::new(1, 2));
        let single = if resting.len().is_multiple_of(2) { 0 } else { resting.len().min(3) };
        let (two_by_two, rest) = resting.split_at(resting.len() - single);
        let mut turns: Vec<(usize, Fraction)> =
            two_by_two.chunks_exact(2).flat_map(|two| [(two[0], one), (two[1], -one)]).collect();
        match *rest {
            [a, b, c] => turns.extend([(a, one), (b, -half), (c, -half)]),
            [a] => {
                let can = |other: &usize| {
                    let pair = &pairs[*other];
                    *other != a && half.order(pair.room(-1)).is_le() && !Pair::is_corner(pair.phase - half)
                };
                let Some(other) = spinning.iter().copied().find(can) else { return Ok(true) };
                turns.extend([(a, half), (other, -half)]);
            }
            _ => {}
        }
        let mut moves = Vec::new();
        for &(index, by) in &turns {
            let pair = &pairs[index];
            moves.extend(pair.cells.into_iter().zip(Pair::places(pair.phase + by, pair.center)));
        }
        if self.stage("spin", &moves)? {
            for (index, by) in turns {
                self.robot.pairs[index].phase = self.robot.pairs[index].phase + by;
            }
        }
        Ok(true)
    }

    /// Spins a pair by some stages, and another against it; false, and the robot is in some state between, if it would fall
    /// apart.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if a number does not fit, [`Refusal::Budget`] if nothing is left of it.
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
    /// [`Refusal::TooLarge`] if a number does not fit, [`Refusal::Budget`] if nothing is left of it.
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

/// Returns the number of steps, a power of two, into which a motion is divided against which pairs spin by `whole` stages, so that
/// each takes a quarter of a stage at most.
fn short_steps(whole: Fraction) -> Fraction {
    let mut steps = 1;
    while steps < LINES_MAX && (whole * Fraction::whole(4)).order(Fraction::new(steps, 1)).is_gt() {
        steps *= 2;
    }
    Fraction::new(steps, 1)
}

/// Returns the stage between two configurations in the least time; `None` if the robot falls apart or hits itself on the way.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit.
fn made(
    name: &'static str,
    limits: &PlanLimits,
    before: &[CellPlace],
    after: &[CellPlace],
) -> Result<Option<FloatStage>, Refusal> {
    let lines = common_lines(before.iter().chain(after)).ok_or(Refusal::TooLarge)?;
    let on_grid = |places: &[CellPlace]| rectangles(places, lines).ok_or(Refusal::TooLarge);
    let (from, to) = (on_grid(before)?, on_grid(after)?);
    let Some(slide) = greatest_slide(&from, &to) else { return Ok(None) };
    let stage = timed(name, limits, (&from, &to), (lines, slide));
    stage.map(Some).ok_or(Refusal::TooLarge)
}

/// Returns the stage between two configurations on a grid of `lines` lines to a cell in the least time, in which cells in
/// contact move against each other by half of `slide` lines at most; `None` if a number does not fit.
fn timed(
    name: &'static str,
    limits: &PlanLimits,
    (from, to): (&[Rectangle], &[Rectangle]),
    (lines, slide): (i128, i64),
) -> Option<FloatStage> {
    let mut numbers: BTreeMap<[i64; 4], u32> = BTreeMap::new();
    // Twice the displacement of the centre of each class along x and y, and its growth.
    let mut changes: Vec<[i128; 4]> = Vec::new();
    let mut of_cell = Vec::with_capacity(from.len());
    let mut drift = [0_i128; 2];
    for (a, b) in from.iter().zip(to) {
        let (lo, hi) = ([0, 1].map(|k| b.lo[k] - a.lo[k]), [0, 1].map(|k| b.hi[k] - a.hi[k]));
        let class = *numbers.entry([lo[0], lo[1], hi[0], hi[1]]).or_insert_with(|| {
            let change = [lo[0] + hi[0], lo[1] + hi[1], hi[0] - lo[0], hi[1] - lo[1]];
            changes.push(change.map(i128::from));
            changes.len() as u32 - 1
        });
        of_cell.push(class);
        (0..2).for_each(|k| drift[k] += changes[class as usize][k]);
    }
    let count = from.len() as i128;
    // Displacements about the centre of mass, in parts of `whole` cells.
    let whole = lines.checked_mul(2 * count)?;
    let (mut farthest, mut growth) = ([0_i128; 3], 0_i128);
    let mut classes = Vec::with_capacity(changes.len());
    for change in changes {
        let about = [0, 1].map(|k| change[k] * count - drift[k]);
        (0..2).for_each(|k| farthest[k] = farthest[k].max(about[k].abs()));
        growth = growth.max(change[2].abs()).max(change[3].abs());
        classes.push(CellMove {
            displacement: [Ratio::new(about[0], whole)?, Ratio::new(about[1], whole)?, Ratio::ZERO],
            growth: [Ratio::new(change[2], lines)?, Ratio::new(change[3], lines)?, Ratio::ZERO],
        });
    }
    let distance = distance_bound(farthest, whole, limits.euclidean)?;
    let relative = Ratio::new(i128::from(slide).max(2 * growth), 2 * lines)?;
    let (time_squared, law) = least_time(limits, distance, relative)?;
    Some(FloatStage { name, time_squared, law, classes, of_cell, lines })
}

/// Returns the number of lines to a cell of the coarsest grid on which the sides of all cells lie; `None` if that is finer than
/// plans have.
fn common_lines<'a>(places: impl Iterator<Item = &'a CellPlace>) -> Option<i128> {
    let mut lines = 2;
    let mut last = 1;
    for number in places.flat_map(|place| place.center.iter().chain(&place.size)) {
        let denominator = number.denominator();
        // Many numbers have the same.
        if denominator == last {
            continue;
        }
        if !(1..=LINES_MAX).contains(&denominator) {
            return None;
        }
        // Sides lie half a size from the centre.
        lines = common_multiple(lines, 2 * denominator).filter(|lines| *lines <= LINES_MAX)?;
        last = denominator;
    }
    Some(lines)
}

/// Returns the cells on a grid of `lines` lines to a cell; `None` if a number does not fit.
fn rectangles(places: &[CellPlace], lines: i128) -> Option<Vec<Rectangle>> {
    let rectangle = |place: &CellPlace| {
        let mut rectangle = Rectangle { lo: [0; 2], hi: [0; 2] };
        for axis in 0..2 {
            let (center, size) = (place.center[axis].on_grid(lines)?, place.size[axis].on_grid(lines)?);
            (rectangle.lo[axis], rectangle.hi[axis]) = (center - size / 2, center + size / 2);
        }
        Some(rectangle)
    };
    places.iter().map(rectangle).collect()
}
