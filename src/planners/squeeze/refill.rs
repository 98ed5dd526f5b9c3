//! A robot with spinning pairs that fills other sites: its cells go one after another from where they are too many to where
//! they lack, and its pairs get to the phases of another robot's.

use super::Refusal;
use super::convey::{dispensable, neighbours, paths, reached};
use super::floating::{Floating, Robot, Target};
use super::fraction::Fraction;
use super::pair::{CellPlace, HALF_TURN, Pair, STAGES_PER_MOMENT, Site, remainder};
use std::collections::BTreeSet;

/// The number of ways of one cell that are tried before a transformation is given up.
const WAYS: usize = 40;
/// The number of leaves, those nearest to where a cell lacks, from which ways are looked for.
const LEAVES: usize = 32;
/// The number of states of each site, entered in one of four directions, that the search for paths examines.
const PATH_STATES: usize = 4;

/// Conveys the pairs to these sites; false if there is no way.
pub(super) fn settle(floating: &mut Floating, places: &BTreeSet<Site>) -> Result<bool, Refusal> {
    loop {
        let robot = &floating.robot;
        let free: BTreeSet<Site> =
            places.iter().copied().filter(|&site| robot.pair_at(site).is_none()).collect();
        if free.is_empty() {
            return Ok(true);
        }
        let mut ways: Vec<Vec<Site>> = Vec::new();
        for pair in robot.pairs.iter().filter(|pair| !places.contains(&pair.site)) {
            floating.budget.spend(PATH_STATES * robot.cells.len())?;
            ways.extend(paths(robot, pair.site, &free).into_values());
        }
        if !first_way(floating, ways)? {
            return Ok(false);
        }
    }
}

/// Conveys a cell along the cheapest of these ways that can be gone; false if there is none.
fn first_way(floating: &mut Floating, ways: Vec<Vec<Site>>) -> Result<bool, Refusal> {
    let robot = &floating.robot;
    let count = robot.cells.len() as f64;
    let sum = |k: usize| -> f64 {
        let singles: i64 = robot.singles.keys().map(|site| site[k]).sum();
        (singles + 2 * robot.pairs.iter().map(|pair| pair.site[k]).sum::<i64>()) as f64
    };
    let middle = [sum(0) / count, sum(1) / count];
    let mut ways: Vec<(f64, Vec<Site>)> =
        ways.into_iter().map(|way| (cost(&way, middle, robot.pairs.len()), way)).collect();
    ways.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    let mark = floating.mark();
    for (_, way) in ways.into_iter().take(WAYS) {
        match floating.convey(&way) {
            Ok(true) => return Ok(true),
            // The fractions of another way may be shorter.
            Ok(false) | Err(Refusal::TooLarge) => floating.restore(&mark),
            Err(refusal) => return Err(refusal),
        }
    }
    Ok(false)
}

/// The time of a straight part of a way, and of the bend after it, in units of time.
const BEND_TIME: f64 = 4.0;

/// Returns about the time that a cell takes along a way, in units of time: that of its straight parts, each as long as the
/// pairs have to spin for it.
fn cost(way: &[Site], middle: [f64; 2], pairs: usize) -> f64 {
    let mut time = 0.0;
    let mut moment = 0.0;
    let mut last = [0; 2];
    for step in way.windows(2) {
        let by = [step[1][0] - step[0][0], step[1][1] - step[0][1]];
        if by != last {
            time += BEND_TIME + libm::fabs(moment);
            (moment, last) = (0.0, by);
        }
        let arm = |k: usize| step[0][k] as f64 - middle[k];
        let per_pair = STAGES_PER_MOMENT as f64 / pairs as f64;
        moment += per_pair * (arm(0) * by[1] as f64 - arm(1) * by[0] as f64);
    }
    time + libm::fabs(moment)
}

/// Brings the cells of a robot to these sites, one after another: from leaves outside the common part to sites that lack
/// one. The common part around the pairs stays and grows, so that it ends. False if no cell finds a way.
pub(super) fn transform(floating: &mut Floating, goal: &BTreeSet<Site>) -> Result<bool, Refusal> {
    loop {
        let robot = &floating.robot;
        let filled: BTreeSet<Site> = robot.sites().into_iter().collect();
        if filled == *goal {
            return Ok(true);
        }
        let left = goal.difference(&filled).count();
        crate::interrupt::progress_checkpoint(|| format!("{left} sites are left to fill"));
        let Some(pair) = robot.pairs.first() else { return Ok(false) };
        let core = reached(pair.site, |site| filled.contains(&site) && goal.contains(&site));
        let mut leaves = dispensable(&filled);
        leaves.retain(|site| robot.singles.contains_key(site) && !core.contains(site));
        let lacking: BTreeSet<Site> = goal.difference(&filled).copied().collect();
        let (mut outside, mut inside): (Vec<Site>, Vec<Site>) =
            leaves.into_iter().partition(|site| !goal.contains(site));
        for leaves in [&mut outside, &mut inside] {
            let far = |leaf: &Site| {
                lacking.iter().map(|site| (site[0] - leaf[0]).abs() + (site[1] - leaf[1]).abs()).min()
            };
            leaves.sort_by_key(|leaf| (far(leaf), *leaf));
            leaves.truncate(LEAVES);
        }
        let beside =
            |site: &Site, leaf: Site| neighbours(*site).any(|next| next != leaf && filled.contains(&next));
        let mut ways = Vec::new();
        for &leaf in if outside.is_empty() { &inside } else { &outside } {
            let ends: BTreeSet<Site> = lacking
                .iter()
                .copied()
                .filter(|site| beside(site, leaf))
                .filter(|site| !outside.is_empty() || neighbours(*site).any(|next| core.contains(&next)))
                .collect();
            floating.budget.spend(PATH_STATES * filled.len())?;
            ways.extend(paths(robot, leaf, &ends).into_values());
        }
        if !first_way(floating, ways)? {
            return Ok(false);
        }
    }
}

/// Spins the pairs to the phases of those of another robot at the same sites; false if it would fall apart.
pub(super) fn turn(floating: &mut Floating, other: &Robot) -> Result<bool, Refusal> {
    let lacking = |robot: &Robot| -> Vec<Fraction> {
        let lack = |pair: &Pair| {
            let goal = other.pair_at(pair.site).map_or(pair.phase, |index| other.pairs[index].phase);
            let up = remainder(goal - pair.phase);
            if up.order(Fraction::whole(HALF_TURN / 2)).is_gt() {
                up - Fraction::whole(HALF_TURN)
            } else {
                up
            }
        };
        robot.pairs.iter().map(lack).collect()
    };
    let total = lacking(&floating.robot).into_iter().fold(Fraction::ZERO, |sum, lack| sum + lack);
    let up = remainder(total);
    let least =
        if up.order(Fraction::whole(HALF_TURN / 2)).is_gt() { up - Fraction::whole(HALF_TURN) } else { up };
    if !least.is_zero() && !wobble(floating, least)? {
        return Ok(false);
    }
    for (index, by) in lacking(&floating.robot).into_iter().enumerate().skip(1) {
        if !by.is_zero() && !floating.spin(index, by, 0)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Spins the pairs by some stages in all, at most half a half turn, while a cell goes round in its own site: it shrinks along one axis
/// towards a neighbour, then along the other, and grows again in the same order. False if no cell can.
fn wobble(floating: &mut Floating, stages: Fraction) -> Result<bool, Refusal> {
    let robot = &floating.robot;
    let ends = dispensable(&robot.sites().into_iter().collect());
    let mark = floating.mark();
    let mut tried: Vec<(usize, Site, Site)> = Vec::new();
    for (&site, &cell) in &robot.singles {
        if ends.contains(&site) {
            let sides = neighbours(site).filter(|next| robot.singles.contains_key(next));
            tried.extend(sides.map(|next| (cell, site, [next[0] - site[0], next[1] - site[1]])));
        }
    }
    let count = Fraction::whole(robot.cells.len() as i64);
    // A round about an area A spins the pairs by 2 A (1 - 1/n) in moment. Sides of a quarter are the longest.
    let quarter = Fraction::new(1, 4);
    let share = Fraction::ONE - Fraction::ONE / count;
    let per_side = Fraction::whole(2 * STAGES_PER_MOMENT) * quarter * share;
    let rounds = -(-(stages.abs() / (per_side * quarter))).floor();
    let side = stages.abs() / per_side / Fraction::new(rounds, 1);
    for (cell, site, toward) in tried {
        let axis = usize::from(toward[0] == 0);
        // The sense: x, then y, both in the positive sense, is counterclockwise; the pairs spin the other way.
        let order = if axis == 0 { 1 } else { -1 };
        let along = toward[axis];
        let across = -stages.sign() * order * along;
        let whole = CellPlace::whole(site);
        let shrunk = |place: CellPlace, axis: usize, by: Fraction, sense: i64| {
            let mut place = place;
            place.size[axis] = place.size[axis] - by - by;
            place.center[axis] = place.center[axis] + by * Fraction::whole(sense);
            place
        };
        let first = shrunk(whole, axis, side, along);
        let both = shrunk(first, 1 - axis, quarter, across);
        let second = shrunk(whole, 1 - axis, quarter, across);
        let all: Vec<usize> = (0..floating.robot.pairs.len()).collect();
        let mut going = true;
        for place in (0..rounds).flat_map(|_| [first, both, second, whole]) {
            let target = Target { cells: vec![(cell, place)], pairs: vec![] };
            if !floating.carry("wobble", &target, &all)? {
                going = false;
                break;
            }
        }
        if going {
            return Ok(true);
        }
        floating.restore(&mark);
    }
    Ok(false)
}
