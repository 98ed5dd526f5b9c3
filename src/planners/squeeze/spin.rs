//! Spin: planar shapes to each other while the robot turns at no time, for pairs of cells spin against all that
//! moves.
//!
//! Leaves of both shapes slip into the sites beside them, in one stage each, in which the layers of the shape slide against
//! each other by less than half a cell to keep the angular momentum at zero; the pairs that this makes take the slide back
//! (`form`). The shapes with their pairs are laid over each other, and one cell after another goes from where it is too many
//! to where one is missing, through the robot ([`transform`]). In the end the pairs are spun to the phases of the other
//! shape's ([`turn`]).

use super::Refusal;
use super::convey::{dispensable, neighbours, reached};
use super::domain::{CellState, Domain};
use super::floating::{Budget, FloatStage, Floating, Robot, Target};
use super::fraction::Fraction;
use super::motion::{Motion, PlanLimits, Transition};
use super::pair::{CellPlace, Pair, Site};
use super::refill::{settle, transform, turn};
use super::shape::Shape;
use crate::plan::{CellMove, Moves, Ratio};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The greatest number of cells of a shape for which the method is tried.
pub(super) const SPIN_MAX: usize = 400;
/// The numbers of pairs that are tried, in parts of the number of cells.
const PAIR_PARTS: [usize; 6] = [4, 6, 8, 12, 16, usize::MAX];
/// The number of overlays of the two shapes that are tried.
const OVERLAYS: usize = 6;
/// The number of overlays whose common part is counted, those with most sites in common.
const OVERLAYS_COUNTED: usize = 2_000;
/// The budget of a search, in cells that are examined: some seconds.
const BUDGET: u64 = 20_000_000;

/// Returns a motion between two shapes in a plane, in which nothing turns; `None` if none is found.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits, [`Refusal::Budget`] if the budget is spent.
pub(super) fn spin(limits: PlanLimits, from: &Shape, to: &Shape) -> Result<Option<Motion>, Refusal> {
    let flat = |axis: &usize| from.is_flat_across(*axis) && to.is_flat_across(*axis);
    let Some(across) = (0..3).find(flat) else { return Ok(None) };
    let [a, b] = [(across + 1) % 3, (across + 2) % 3];
    let sites = |shape: &Shape| -> Vec<Site> { shape.positions.iter().map(|p| [p[a], p[b]]).collect() };
    let (start, goal) = (sites(from), sites(to));
    let search = || Search { limits, budget: Budget::new(BUDGET) };
    let way = match search().between(&start, &goal) {
        Ok(Some(way)) => Some(way),
        Ok(None) | Err(Refusal::Budget | Refusal::TooLarge) => search().over_block(&start, &goal)?,
        Err(refusal) => return Err(refusal),
    };
    let motion = way.map(|way| way.into_motion(&start)).transpose()?;
    Ok(motion.map(|motion| motion.turned([a, b, across])))
}

/// Returns the sites of a block that is about as wide as high.
fn block(count: usize) -> Vec<Site> {
    let width = libm::ceil(libm::sqrt(count as f64)) as i64;
    (0..count as i64).map(|i| [i % width, i / width]).collect()
}

/// Stages from a shape to another, and the site of each cell at the end.
struct Way {
    stages: Vec<FloatStage>,
    ends: Vec<Site>,
}

/// Leaves with the sites that they slip into.
type Slips = Vec<(Site, Site)>;

/// The search for ways under these limits.
struct Search {
    limits: PlanLimits,
    budget: Budget,
}

impl Search {
    /// Returns a way between two shapes that leads over a block, whose corners have neighbours along both axes; `None` if none is
    /// found.
    ///
    /// # Errors
    /// [`Refusal::Budget`] or [`Refusal::TooLarge`], as [`between`](Self::between).
    fn over_block(&self, start: &[Site], goal: &[Site]) -> Result<Option<Way>, Refusal> {
        let Some(first) = self.between(start, &block(start.len()))? else { return Ok(None) };
        let Some(second) = self.between(&first.ends, goal)? else { return Ok(None) };
        first.then(second, start.len()).map(Some)
    }

    /// Returns the fastest way that is found between two shapes, of which the cells of the first are numbered in this order; `None`
    /// if none is.
    ///
    /// # Errors
    /// [`Refusal::Budget`] if nothing is left of it and no way is found, [`Refusal::TooLarge`] if none is found and fractions
    /// of some do not fit.
    fn between(&self, start: &[Site], goal: &[Site]) -> Result<Option<Way>, Refusal> {
        let mut is_too_large = false;
        let ends = [self.ends(start)?, self.ends(goal)?];
        let mut wanted = PAIR_PARTS.map(|part| (start.len() / part).max(2)).to_vec();
        wanted.dedup();
        let mut best: Option<Way> = None;
        for wanted in wanted {
            match self.with_pairs((start, &ends[0]), (goal, &ends[1]), wanted) {
                Ok(Some(way)) if best.as_ref().is_none_or(|best| way.duration() < best.duration()) => {
                    best = Some(way);
                }
                Ok(_) => {}
                // The fractions of another number of pairs may be shorter.
                Err(Refusal::TooLarge) => is_too_large = true,
                Err(Refusal::Budget) if best.is_some() => break,
                Err(refusal) => return Err(refusal),
            }
        }
        if best.is_none() && is_too_large { Err(Refusal::TooLarge) } else { Ok(best) }
    }

    /// Returns the leaves of a shape that may slip, as [`slips`] does: along x, along y, and along any axis.
    ///
    /// # Errors
    /// [`Refusal::Budget`] if nothing is left of it.
    fn ends(&self, sites: &[Site]) -> Result<[Slips; 3], Refusal> {
        let robot = Robot::at(sites);
        let most = (sites.len() / PAIR_PARTS[0]).max(2);
        let found = [Some(0), Some(1), None].map(|axis| slips(&robot, most, axis));
        self.budget.spend(found.iter().map(|slips| (slips.len() + 1) * sites.len()).sum())?;
        Ok(found)
    }

    /// Returns a way of up to `wanted` pairs; `None` if none is found.
    fn with_pairs(
        &self,
        (start, from): (&[Site], &[Slips; 3]),
        (goal, to): (&[Site], &[Slips; 3]),
        wanted: usize,
    ) -> Result<Option<Way>, Refusal> {
        let Some(first) = self.form(start, from, wanted)? else { return Ok(None) };
        let Some(second) = self.form(goal, to, first.robot.pairs.len())? else { return Ok(None) };
        if second.robot.pairs.len() < first.robot.pairs.len() {
            return Ok(None);
        }
        let mut is_too_large = false;
        self.budget.spend(start.len() * goal.len())?;
        for shift in overlays(&first.robot, &second.robot) {
            match self.overlaid((start, &first), (goal, &second), shift) {
                Ok(Some(way)) => return Ok(Some(way)),
                Ok(None) => {}
                // The fractions of another overlay may be shorter.
                Err(Refusal::TooLarge) => is_too_large = true,
                Err(refusal) => return Err(refusal),
            }
        }
        if is_too_large { Err(Refusal::TooLarge) } else { Ok(None) }
    }

    /// Returns a robot whose leaves have slipped into the sites beside them: up to `wanted` pairs, at least two; `None` if there are
    /// no two.
    fn form(
        &self,
        sites: &[Site],
        ends: &[Slips; 3],
        wanted: usize,
    ) -> Result<Option<Floating<'_>>, Refusal> {
        let mut floating = Floating::new(self.limits, Robot::at(sites), &self.budget);
        // Along one axis, if enough can: then the slide has the same moment there and back, and the phases of the pairs are short
        // fractions.
        let along = ends.each_ref().map(|slips| &slips[..slips.len().min(wanted)]);
        let most = along.iter().map(|slips| slips.len()).max().unwrap_or(0);
        let slips = along.into_iter().find(|slips| slips.len() == most).filter(|slips| slips.len() >= 2);
        let Some(slips) = slips else { return Ok(None) };
        let mut moves: Vec<(usize, CellPlace)> = Vec::new();
        let mut pairs = Vec::new();
        for &(leaf, into) in slips {
            let cells = [floating.robot.singles[&leaf], floating.robot.singles[&into]];
            let center = CellPlace::whole(into).center;
            let phase = Pair::split_along([into[0] - leaf[0], into[1] - leaf[1]]);
            moves.extend(cells.into_iter().zip(Pair::places(phase, center)));
            pairs.push(Pair { site: into, center, cells, phase });
        }
        let moment = floating.robot.moment(&moves);
        if moment.is_zero() {
            if !floating.stage("slip", &moves)? {
                return Ok(None);
            }
            floating.robot.adopt(pairs, slips);
            return Ok(Some(floating));
        }
        let Some(slide) = slide(&floating.robot, slips, moment) else { return Ok(None) };
        let mut ends: BTreeMap<usize, CellPlace> = moves.into_iter().collect();
        for (&site, &cell) in &floating.robot.singles {
            // A leaf goes with the layer of the site it slips into, between which there is no cut.
            let place = ends.entry(cell).or_insert_with(|| CellPlace::whole(site));
            *place = place.moved(slide.of(site));
        }
        let moves: Vec<(usize, CellPlace)> = ends.into_iter().collect();
        if !floating.stage("slip", &moves)? {
            return Ok(None);
        }
        for pair in &mut pairs {
            let by = slide.of(pair.site);
            pair.center = [0, 1].map(|k| pair.center[k] + by[k]);
        }
        floating.robot.adopt(pairs, slips);
        // The pairs take the slide back.
        let robot = &floating.robot;
        let target = Target {
            cells: robot.singles.iter().map(|(&site, &cell)| (cell, CellPlace::whole(site))).collect(),
            pairs: (0..robot.pairs.len())
                .map(|index| (index, CellPlace::whole(robot.pairs[index].site).center))
                .collect(),
        };
        let all: Vec<usize> = (0..robot.pairs.len()).collect();
        Ok(floating.carry("slide", &target, &all)?.then_some(floating))
    }

    /// Returns the way between two shapes, each with its cells in a robot with pairs, the second of which is laid over the first
    /// by a translation; `None` if none is found.
    fn overlaid(
        &self,
        (start, first): (&[Site], &Floating),
        (goal, second): (&[Site], &Floating),
        shift: Site,
    ) -> Result<Option<Way>, Refusal> {
        let robot = |robot: Robot| Floating::new(self.limits, robot, &self.budget);
        let mut here = Floating { stages: first.stages.clone(), ..robot(first.robot.clone()) };
        let mut there = Floating { stages: second.stages.clone(), ..robot(second.robot.shifted(shift)) };
        let filled: BTreeSet<Site> = there.robot.sites().into_iter().collect();
        let both: BTreeSet<Site> =
            here.robot.sites().into_iter().filter(|site| filled.contains(site)).collect();
        let core = core(&both);
        let Some(places) = places(&core, &here.robot, &there.robot) else { return Ok(None) };
        if !settle(&mut here, &places)? || !settle(&mut there, &places)? {
            return Ok(None);
        }
        let goal_sites: BTreeSet<Site> = there.robot.sites().into_iter().collect();
        if !transform(&mut here, &goal_sites)? || !turn(&mut here, &there.robot)? {
            return Ok(None);
        }
        // The cells of the second robot take the numbers of those of the first that are where they are.
        let at: HashMap<CellPlace, usize> = here.robot.cells.iter().copied().zip(0..).collect();
        let numbers: Option<Vec<usize>> =
            there.robot.cells.iter().map(|place| at.get(place).copied()).collect();
        let Some(numbers) = numbers else {
            return Err(Refusal::Defect("pairs of cells do not meet".into()));
        };
        let mut ends = vec![[0; 2]; start.len()];
        numbers.iter().zip(goal).for_each(|(&number, &site)| ends[number] = site);
        let back = there.stages.iter().rev().map(|stage| reversed(stage, &numbers)).collect();
        let way = Way { stages: here.stages, ends: vec![] };
        way.then(Way { stages: back, ends }, start.len()).map(Some)
    }
}

impl Way {
    /// Returns the time that the stages take, in units of time.
    fn duration(&self) -> f64 {
        self.stages.iter().map(|stage| libm::sqrt(stage.time_squared.to_f64())).sum()
    }

    /// Returns this way and then another, whose cells have the same numbers.
    ///
    /// # Errors
    /// [`Refusal::TooLarge`] if no grid holds both where they meet.
    fn then(mut self, next: Way, count: usize) -> Result<Way, Refusal> {
        if next.stages.first().is_some_and(|stage| !stage.can_follow(self.stages.last(), count)) {
            return Err(Refusal::TooLarge);
        }
        self.stages.extend(next.stages);
        Ok(Way { ends: next.ends, ..self })
    }

    /// Returns the motion of the stages from the sites where the cells are at the start.
    fn into_motion(self, start: &[Site]) -> Result<Motion, Refusal> {
        let count = start.len() as u64;
        let domains: Vec<Domain> = (0..count).filter_map(|i| Domain::new(i, &[])).collect();
        let rest = |sites: &[Site]| {
            Motion::rest(count, &domains, |i| {
                let [x, y] = sites[i as usize];
                CellState::whole([x, y, 0])
            })
        };
        let (mut motion, last) = (rest(start)?, rest(&self.ends)?);
        motion.configurations.resize(self.stages.len(), None);
        motion.configurations.extend(last.configurations);
        motion.transitions = self.stages.into_iter().map(transition).collect();
        Ok(motion)
    }
}

/// Returns a stage as a transition that states moves.
fn transition(stage: FloatStage) -> Transition {
    let moves = Moves::new(&stage.classes, stage.of_cell.into_iter());
    Transition {
        name: stage.name,
        time_squared: stage.time_squared,
        law: stage.law,
        balanced: true,
        moves: Some(moves),
    }
}

/// Returns the stage backwards, of cells that have other numbers: `numbers` are those of the cells here.
fn reversed(stage: &FloatStage, numbers: &[usize]) -> FloatStage {
    let back = |ratios: [Ratio; 3]| ratios.map(|Ratio(above, below)| Ratio(-above, below));
    let class =
        |class: &CellMove| CellMove { displacement: back(class.displacement), growth: back(class.growth) };
    let mut of_cell = vec![0; numbers.len()];
    numbers.iter().zip(&stage.of_cell).for_each(|(&number, &class)| of_cell[number] = class);
    let classes = stage.classes.iter().map(class).collect();
    FloatStage { law: stage.law.reversed(), classes, of_cell, ..stage.clone() }
}

impl Robot {
    /// Takes on pairs that leaves have made which have slipped.
    fn adopt(&mut self, pairs: Vec<Pair>, slips: &[(Site, Site)]) {
        slips.iter().flat_map(|&(leaf, into)| [leaf, into]).for_each(|site| {
            self.singles.remove(&site);
        });
        self.pairs = pairs;
    }

    /// Returns the robot moved by whole sites.
    fn shifted(&self, by: Site) -> Robot {
        let along = by.map(Fraction::whole);
        let moved = |site: Site| [site[0] + by[0], site[1] + by[1]];
        let pair = |pair: &Pair| Pair {
            site: moved(pair.site),
            center: [0, 1].map(|k| pair.center[k] + along[k]),
            ..pair.clone()
        };
        Robot {
            cells: self.cells.iter().map(|cell| cell.moved(along)).collect(),
            singles: self.singles.iter().map(|(&site, &cell)| (moved(site), cell)).collect(),
            pairs: self.pairs.iter().map(pair).collect(),
        }
    }
}

/// Returns up to `wanted` leaves with the sites that they can slip into, along an axis if one is given, no two of these beside each
/// other, so that the rest stays connected; chosen one by one so that the angular momentum of all so far is least.
fn slips(robot: &Robot, wanted: usize, axis: Option<usize>) -> Slips {
    let mut sites: BTreeSet<Site> = robot.sites().into_iter().collect();
    let mut slips = Slips::new();
    let mut total = Fraction::ZERO;
    let all = robot.sum();
    while slips.len() < wanted {
        crate::interrupt::checkpoint();
        let taken = |site: Site| slips.iter().any(|&(_, into)| into == site);
        let apart = |site: Site| neighbours(site).all(|next| !taken(next)) && !taken(site);
        let mut best: Option<(Fraction, Site, Site)> = None;
        for site in dispensable(&sites).into_iter().filter(|site| !taken(*site)) {
            let is_along = |into: Site| axis.is_none_or(|axis| into[axis] != site[axis]);
            let ends =
                neighbours(site).filter(|&into| is_along(into) && sites.contains(&into) && apart(into));
            for into in ends {
                let moment = total + slip_moment(robot, all, site, into);
                if best.is_none_or(|(least, ..)| moment.abs().order(least.abs()).is_lt()) {
                    best = Some((moment, site, into));
                }
            }
        }
        let Some((moment, site, into)) = best else { break };
        total = moment;
        sites.remove(&site);
        slips.push((site, into));
    }
    slips
}

/// Returns the moment of a leaf that slips into the site beside it; `all` is the sum of the centres of all cells.
fn slip_moment(robot: &Robot, all: [Fraction; 2], leaf: Site, into: Site) -> Fraction {
    let cells = [robot.singles[&leaf], robot.singles[&into]];
    let phase = Pair::split_along([into[0] - leaf[0], into[1] - leaf[1]]);
    let places = Pair::places(phase, CellPlace::whole(into).center);
    robot.moment_about(all, &cells.into_iter().zip(places).collect::<Vec<_>>())
}

/// A slide along one axis of the layers of sites across the other: at each cut what is above it slides by the same
/// distance against what is below.
struct Slide {
    axis: usize,
    cuts: Vec<i64>,
    distance: Fraction,
}

impl Slide {
    /// Returns the displacement of a site.
    fn of(&self, site: Site) -> [Fraction; 2] {
        let level = site[1 - self.axis];
        let below = self.cuts.iter().filter(|cut| **cut <= level).count() as i64;
        let distance = self.distance * Fraction::whole(below);
        [0, 1].map(|k| if k == self.axis { distance } else { Fraction::ZERO })
    }
}

/// Returns the slide of less than half a cell at each cut whose moment is opposite to `moment`, and whose cuts no leaf that
/// slips crosses.
fn slide(robot: &Robot, slips: &[(Site, Site)], moment: Fraction) -> Option<Slide> {
    let mut best: Option<Slide> = None;
    // Along the axis of the slips, if there is one, for those cross no cut then.
    let across = |axis: usize| slips.iter().any(|(leaf, into)| leaf[axis] == into[axis]);
    let aligned: Vec<usize> = (0..2).filter(|&axis| !across(axis)).collect();
    for axis in if aligned.is_empty() { vec![0, 1] } else { aligned } {
        let level = |site: Site| site[1 - axis];
        let levels: BTreeSet<i64> = robot.singles.keys().map(|site| level(*site)).collect();
        let crossed =
            |cut: &i64| slips.iter().any(|&(leaf, into)| (level(leaf) < *cut) != (level(into) < *cut));
        let cuts: Vec<i64> = levels.into_iter().skip(1).filter(|cut| !crossed(cut)).collect();
        let unit = Slide { axis, cuts, distance: Fraction::ONE };
        let slid = |(&site, &cell): (&Site, &usize)| (cell, CellPlace::whole(site).moved(unit.of(site)));
        let moves: Vec<(usize, CellPlace)> = robot.singles.iter().map(slid).collect();
        let distance = -(moment / robot.moment(&moves));
        let least = best.as_ref().map_or(Fraction::new(1, 2), |slide| slide.distance.abs());
        if distance.fits() && distance.abs().order(least).is_lt() {
            best = Some(Slide { distance, ..unit });
        }
    }
    best
}

/// Returns the translations of the second robot in which the largest connected part of what both fill is largest, the best
/// first.
fn overlays(first: &Robot, second: &Robot) -> Vec<Site> {
    let (here, there) = (first.sites(), second.sites());
    let filled: BTreeSet<Site> = here.iter().copied().collect();
    let mut common: BTreeMap<Site, usize> = BTreeMap::new();
    for a in &here {
        there.iter().for_each(|b| *common.entry([a[0] - b[0], a[1] - b[1]]).or_default() += 1);
    }
    let mut shifts: Vec<(usize, Site)> = common.into_iter().map(|(by, count)| (count, by)).collect();
    shifts.sort_by_key(|&(count, by)| (Reverse(count), by));
    let mut found: Vec<(Reverse<usize>, Site)> = Vec::new();
    for (count, by) in shifts.into_iter().take(OVERLAYS_COUNTED) {
        crate::interrupt::checkpoint();
        // A part is no larger than all that both fill.
        if found.get(OVERLAYS - 1).is_some_and(|(least, _)| count < least.0) {
            break;
        }
        let both = there.iter().map(|b| [b[0] + by[0], b[1] + by[1]]);
        let both: BTreeSet<Site> = both.filter(|site| filled.contains(site)).collect();
        found.push((Reverse(core(&both).len()), by));
        found.sort_unstable();
        found.truncate(OVERLAYS);
    }
    found.into_iter().map(|(_, by)| by).collect()
}

/// Returns the largest connected part of a set of sites.
fn core(sites: &BTreeSet<Site>) -> BTreeSet<Site> {
    let mut left = sites.clone();
    let mut best = BTreeSet::new();
    while let Some(&site) = left.first() {
        let part = reached(site, |site| sites.contains(&site));
        left.retain(|site| !part.contains(site));
        if part.len() > best.len() {
            best = part;
        }
    }
    best
}

/// Returns sites of the common part for all pairs, no two beside each other: those of pairs first, if that leaves enough;
/// `None` if there are too few.
fn places(core: &BTreeSet<Site>, here: &Robot, there: &Robot) -> Option<BTreeSet<Site>> {
    let sites = |robot: &Robot| robot.pairs.iter().map(|pair| pair.site).collect::<Vec<Site>>();
    let both: Vec<Site> = sites(here).into_iter().filter(|site| there.pair_at(*site).is_some()).collect();
    let preferred: Vec<Site> = both.into_iter().chain(sites(here)).chain(sites(there)).collect();
    for first in [preferred, vec![]] {
        let mut places: BTreeSet<Site> = BTreeSet::new();
        for site in first.into_iter().chain(core.iter().copied()).filter(|site| core.contains(site)) {
            if places.len() < here.pairs.len() && neighbours(site).all(|next| !places.contains(&next)) {
                places.insert(site);
            }
        }
        if places.len() == here.pairs.len() {
            return Some(places);
        }
    }
    None
}
