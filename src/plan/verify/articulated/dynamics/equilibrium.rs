//! The equilibrium of an instant: loads and friction that belong together, as the fixed point of the two.

use super::elastic_tree::Pushing;
use super::loads::{self, Loads};
use super::posed::{Candidate, Situation, Support};
use super::tolerances::PARAMETERS;
use super::twist::{self, Momentum, TwistProblem};
use crate::geometry::Vec3;
use crate::robot::dynamics::Twist;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// The loads, the friction and the twist of the base at an instant, which belong together.
#[derive(Clone, Debug)]
pub(super) struct Equilibrium {
    /// The twist of the base at the centre of mass, m/s and rad/s, in level axes; zero unless friction moves the base.
    pub twist: Twist,
    /// The loads of contacts, joints and closing bonds.
    pub loads: Loads,
    /// The slip at each candidate, m/s, and the friction on it, N, in level axes; empty if the robot does not rest on
    /// the ground.
    pub friction: Vec<(Vec3, Vec3)>,
    /// True if the rounds ended before the loads of two rounds agreed.
    pub open: bool,
    /// True if the planar force that the motion needs is more than friction can carry; false with momentum.
    pub slides: bool,
}

/// The warm start of [`solve`]: the result at the instant before.
#[derive(Clone, Debug, Default)]
pub(super) struct Warm {
    /// The twist of the base at the centre of mass, m/s and rad/s, in level axes.
    pub twist: Twist,
    /// The load of each point of a feature ([`Candidate::feature`]), N.
    pub loads: BTreeMap<(usize, u8), f64>,
}

/// Returns the equilibrium of loads and friction, found by fixed-point iteration with relaxation; `None` where the
/// loads can't be found. With `momentum`, the planar momentum, the twist follows from friction over time; without it
/// friction must carry the planar force that the situation needs. `warm` is the first guess, and becomes that of the
/// next instant.
pub(super) fn solve(
    situation: &Situation,
    momentum: Option<Momentum>,
    warm: &mut Warm,
) -> Option<Equilibrium> {
    let candidates = &situation.candidates;
    let known = |c: &Candidate| warm.loads.get(&c.feature).copied().unwrap_or(0.0);
    let mut loads: Vec<f64> = candidates.iter().map(known).collect();
    let mut pushing =
        Pushing { contacts: loads.iter().map(|load| *load > 0.0).collect(), ..Pushing::default() };
    let none = vec![Vec3::zeros(); candidates.len()];
    if loads.iter().sum::<f64>() < PARAMETERS.load_guess_min * situation.weight {
        loads = loads::solve(situation, &none, &mut pushing)?.normal;
    }
    if !situation.support.rests() {
        let loads = loads::solve(situation, &none, &mut pushing)?;
        let twist = Twist::default();
        return Some(Equilibrium { twist, loads, friction: vec![], open: false, slides: false });
    }
    let mut relaxation = 1.0;
    let mut found = None;
    for _ in 0..PARAMETERS.rounds_max {
        let capacity: f64 = candidates.iter().zip(&loads).map(|(c, load)| c.friction * load).sum();
        let (needed, slides) = match momentum {
            Some(_) => (downhill(situation), false),
            None => carried(situation, capacity),
        };
        let tilting = tilting(situation, &loads);
        let problem = problem(situation, &loads, (needed, tilting), momentum);
        let twist = match situation.support {
            Support::Settles => twist::solve(&problem, &warm.twist),
            Support::Stays | Support::Held | Support::Floats => Twist::default(),
        };
        warm.twist = twist;
        let friction = twist::friction(&problem, &twist);
        let forces: Vec<Vec3> = friction.iter().map(|(_, force)| *force).collect();
        let next = loads::solve(situation, &forces, &mut pushing)?;
        let change: f64 = next.normal.iter().zip(&loads).map(|(a, b)| (a - b).abs()).sum();
        let open = change > PARAMETERS.load_change * situation.weight;
        for (load, next) in loads.iter_mut().zip(&next.normal) {
            *load += relaxation * (next - *load);
        }
        relaxation = (relaxation * PARAMETERS.relaxation).max(PARAMETERS.relaxation_min);
        found = Some(Equilibrium { twist, loads: next, friction, open, slides });
        if !open {
            break;
        }
    }
    warm.loads = candidates.iter().zip(&loads).map(|(c, load)| (c.feature, *load)).collect();
    found
}

/// Returns the twist of the base at the centre of mass, in level axes, at which friction is in balance under the
/// normal forces `loads` (N, one for each candidate) with `factors` on its coefficients, found from the guess `before`.
pub(super) fn twist_under(
    situation: &Situation,
    (loads, factors): (&[f64], &[f64]),
    momentum: Option<Momentum>,
    before: &Twist,
) -> Twist {
    let varied: Vec<f64> = loads.iter().zip(factors).map(|(load, factor)| load * factor).collect();
    let needed = (downhill(situation), tilting(situation, loads));
    twist::solve(&problem(situation, &varied, needed, momentum), before)
}

fn problem<'a>(
    situation: &'a Situation,
    loads: &'a [f64],
    (needed, tilting): (Vector3<f64>, [f64; 2]),
    momentum: Option<Momentum>,
) -> TwistProblem<'a> {
    let (candidates, weight) = (&situation.candidates, situation.weight);
    TwistProblem { candidates, loads, needed, tilting, momentum, weight }
}

/// Returns the moments in roll and pitch about the centre of mass (N·m) that a situation on a slope needs beyond those of
/// the normal forces `loads` (N): those of friction, which acts at the ground. Zero on level ground.
fn tilting(situation: &Situation, loads: &[f64]) -> [f64; 2] {
    if !situation.sloped {
        return [0.0; 2];
    }
    let of = |moment: Vec3, (c, load): (&Candidate, &f64)| moment - c.p.cross(&(Vec3::z() * *load));
    let left = situation.candidates.iter().zip(loads).fold(situation.base.moment, of);
    [left.x, left.y]
}

/// Returns the force in x and y (N) and the moment in yaw (N·m) of friction that bear the weight of a robot at rest on a
/// slope; zero on level ground. Momentum takes what they are more than friction gives.
fn downhill(situation: &Situation) -> Vector3<f64> {
    if situation.sloped { planar(situation) } else { Vector3::zeros() }
}

/// Returns the force in x and y (N) and the moment in yaw (N·m) that the situation needs.
fn planar(situation: &Situation) -> Vector3<f64> {
    Vector3::new(situation.base.force.x, situation.base.force.y, situation.base.moment.z)
}

/// Returns the force in x and y (N) and the moment in yaw (N·m) that friction has to supply, scaled down to what it
/// can, and true if they were. `capacity`: the sum of friction times normal force, N.
fn carried(situation: &Situation, capacity: f64) -> (Vector3<f64>, bool) {
    let needed = planar(situation);
    // A moment counts by the force at the robot's size.
    let size = libm::hypot(libm::hypot(needed.x, needed.y), needed.z / situation.size);
    let most = PARAMETERS.traction_max * capacity;
    if size > most { (needed * (most / size), true) } else { (needed, false) }
}
