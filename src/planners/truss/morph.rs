//! `morph`: a truss takes on a shape, step by step (section V of the paper), each step by Algorithm 1
//! mended ([`step`](super::step)).

use super::fit::{Distance, Weights, fit};
use super::goal::Goal;
use super::step::{CUSHION, Memory, Stuck, Task, step};
use super::structure::Structure;
use super::surface;
use crate::geometry::Vec3;
use crate::planners::random::SplitMix64;
use nalgebra::UnitQuaternion;
use std::f64::consts::TAU;

/// Springs fall from the first to the last of these over the steps wished for.
const SPRINGS: (f64, f64) = (3e-2, 1e-6);
const STILL: f64 = 1e-3;
const ACROSS: f64 = 0.9;
/// The farthest that a node goes in a step, in units.
const CAP: f64 = 0.05;
/// Steps shortened one after another until it counts as stuck.
const TRIES: usize = 4;

/// Steps for which an orientation is tried.
const SCREEN: usize = 60;

#[derive(Clone, Debug)]
pub struct Wish {
    pub steps_max: usize,
    /// Done when the goal's and the surface's distances (root mean squares) are both below, m.
    pub tolerance: f64,
    /// Random orientations of the goal that are tried beside its own.
    pub orientations: usize,
    pub seed: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The tolerance is kept.
    Done,
    /// The steps allowed were made.
    Steps,
    Stuck(Stuck),
    Cancelled,
}

#[derive(Clone, Debug)]
pub struct Morph {
    /// Where the nodes are after every step, up to the one that fits best.
    pub steps: Vec<Vec<Vec3>>,
    pub start: Distance,
    pub distance: Distance,
    pub end: End,
}

/// Morphs a truss; the goal is moved so that its middle is the middle of the nodes. An error if the truss
/// has no outer surface. `going` is asked before every step, with the distance so far.
pub fn morph(
    truss: &Structure,
    start: &[Vec3],
    goal: &Goal,
    wish: &Wish,
    going: &dyn Fn(usize, &Distance) -> bool,
) -> Result<Morph, surface::Open> {
    let truss = &truss.cautious(CUSHION);
    let faces = surface::outer(truss, start)?;
    let middle = start.iter().sum::<Vec3>() / start.len() as f64;
    let centre = goal.centre();
    let placed = |turn: &UnitQuaternion<f64>| goal.moved(|p| turn * (p - centre) + middle);
    let mut best = (f64::INFINITY, UnitQuaternion::identity());
    if wish.orientations > 0 {
        let short = Wish { steps_max: SCREEN.min(wish.steps_max), ..wish.clone() };
        let mut rng = SplitMix64(wish.seed);
        for i in 0..=wish.orientations {
            let turn = if i == 0 { UnitQuaternion::identity() } else { turn(&mut rng) };
            let tried = towards(truss, start, &faces, &placed(&turn), &short, going);
            if tried.distance.both() < best.0 {
                best = (tried.distance.both(), turn);
            }
            if tried.end == End::Cancelled {
                return Ok(tried);
            }
        }
    }
    Ok(towards(truss, start, &faces, &placed(&best.1), wish, going))
}

fn towards(
    truss: &Structure,
    start: &[Vec3],
    faces: &[[usize; 3]],
    goal: &Goal,
    wish: &Wish,
    going: &dyn Fn(usize, &Distance) -> bool,
) -> Morph {
    let mut guesses = Vec::new();
    let mut x = start.to_vec();
    let mut memory = Memory::default();
    let mut found = fit(faces, &x, goal, &mut guesses);
    let first = found.distance;
    let mut steps: Vec<Vec<Vec3>> = Vec::new();
    let mut best = (0, found.distance);
    let mut end = End::Steps;
    while steps.len() < wish.steps_max {
        if found.distance.there <= wish.tolerance && found.distance.back <= wish.tolerance {
            end = End::Done;
            break;
        }
        if !going(steps.len(), &found.distance) {
            end = End::Cancelled;
            break;
        }
        let part = (steps.len() as f64 / (0.8 * wish.steps_max as f64)).min(1.0);
        let springs = SPRINGS.0 * libm::pow(SPRINGS.1 / SPRINGS.0, part);
        let weights = Weights { back: 1.0, across: ACROSS, springs, still: STILL };
        let objective = found.objective(truss, &x, &weights);
        let shorter = |cap: f64, memory: &mut Memory| {
            let task =
                Task { truss, x: &x, objective: &objective, held: &[], centre: &[], ground: false, cap };
            step(&task, memory)
        };
        let caps = (0..TRIES).map(|i| CAP * truss.unit / (1 << (2 * i)) as f64);
        let mut stuck = None;
        let next = caps.into_iter().find_map(|cap| match shorter(cap, &mut memory) {
            Ok(y) => Some(y),
            Err(why) => {
                memory.near.clear();
                stuck.get_or_insert(why);
                None
            }
        });
        let Some(next) = next else {
            end = End::Stuck(stuck.expect("a try was made"));
            break;
        };
        x = next;
        steps.push(x.clone());
        found = fit(faces, &x, goal, &mut guesses);
        if found.distance.both() < best.1.both() {
            best = (steps.len(), found.distance);
        }
    }
    steps.truncate(best.0);
    Morph { steps, start: first, distance: best.1, end }
}

/// Every orientation alike (Shoemake).
fn turn(rng: &mut SplitMix64) -> UnitQuaternion<f64> {
    let (u, v, w) = (rng.next_f64(), TAU * rng.next_f64(), TAU * rng.next_f64());
    let ((sv, cv), (sw, cw)) = (libm::sincos(v), libm::sincos(w));
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    UnitQuaternion::new_normalize(nalgebra::Quaternion::new(b * cw, a * sv, a * cv, b * sw))
}
