//! The trajectory of a truss: a sequence of linear steps and rolls, timed by the speed of the struts.

use super::margins::{Nearby, margins_near};
use super::problem::TrussProblem;
use super::roll::{Roll, rolled};
use super::structure::Structure;
use super::threads;
use super::timing::Timing;
use crate::geometry::Vec3;
use crate::plan::{
    CauseId, Interpolation, Keyframe, LengthSum, Margins, NodePaths, Ramps, Surroundings, TrussLimits,
};
use crate::robot::truss_statics::Weights;
use std::borrow::Cow;

/// A move: one piece of a motion of all nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum Move {
    /// A linear move: every node moves at constant velocity to its position here, m, in the world's frame, in the
    /// order of the nodes. The findings are those of the search for it.
    Linear(Vec<Vec3>, Findings),
    /// A roll: the whole truss topples over an edge as a rigid body.
    Roll(Roll),
}

/// The findings of the search for a linear move beside its end, by which its timing and its margins take less time; the default where
/// there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Findings {
    /// True if the forces of struts and contacts are known to bear all of its acceleration at the start.
    pub rises: bool,
    /// True if they are known to bear that at its end.
    pub brakes: bool,
    /// The least singular value of the rigidity matrix at the end of the move, those of rigid motions left out, without unit.
    pub least: Option<f64>,
    /// The least distance there of two struts without a common node, m; infinite where all are at least twice the clearance apart.
    pub distance: Option<f64>,
}

/// The time law of a truss's motion: the limits of the duration of its moves besides the speed of the struts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeLaw {
    /// The shortest duration of a step, s. Default 1 ms: no two keyframes at the same time.
    pub step_duration_min: f64,
    /// The angular speed of rolls, rad/s. Default 1: the robot topples by itself, and nothing depends on it.
    pub roll_speed: f64,
}

impl Default for TimeLaw {
    fn default() -> TimeLaw {
        TimeLaw { step_duration_min: 1e-3, roll_speed: 1.0 }
    }
}

impl TimeLaw {
    /// Returns the least duration (s) of a move from positions `x` of the nodes (m), as [`timing`](TimeLaw::timing) has it.
    /// `truss`: the truss with its limits; `step`: the move.
    pub fn duration(&self, truss: &Structure, x: &[Vec3], step: &Move) -> f64 {
        self.timing(truss, x, step).duration
    }
}

/// Returns the positions of the nodes after a move from `x`, both in m and in the order of the nodes. `step`: the
/// move.
pub fn moved<'a>(x: &[Vec3], step: &'a Move) -> Cow<'a, [Vec3]> {
    match step {
        Move::Linear(y, _) => Cow::Borrowed(y),
        Move::Roll(roll) => Cow::Owned(rolled(x, *roll)),
    }
}

/// Returns the length of the path of the centre of mass over the ground, m: the sum of the straight lines between its
/// positions at the ends of the moves, seen from above. `start`: the positions of the nodes before the first move, m.
/// `truss`: the truss with its masses.
pub fn travelled_distance(truss: &Structure, start: &[Vec3], moves: &[Move]) -> f64 {
    let at = visited(start, moves);
    let centres: Vec<Vec3> = at.iter().map(|x| truss.centre_of_mass(x)).collect();
    let way = |pair: &[Vec3]| libm::hypot(pair[1].x - pair[0].x, pair[1].y - pair[0].y);
    centres.windows(2).map(way).sum()
}

/// Returns the moves from `start` as node paths: a keyframe for the start at time 0 s, then one for the end of each
/// move, in the order of `moves`. Each step goes from rest to rest in the least time that the struts' speed and acceleration
/// allow, and the forces that they bear, but no less than the law's shortest. Every keyframe has the margins of its
/// positions, with `stands` as for [`margins`](super::margins::margins). `truss`: the structure made of the problem.
///
/// `start`: the position of each node in the order of the problem's, m, in the world's frame. The strut's kind is
/// taken to be at index 0 of the plan's library, and the cause of all keyframes is 0.
pub fn node_paths(
    problem: &TrussProblem,
    truss: &Structure,
    start: &[Vec3],
    moves: &[Move],
    law: TimeLaw,
    stands: bool,
) -> NodePaths {
    let mut nearby = Nearby::default();
    let keyframes =
        timed(truss, start, moves, law, |x, findings| margins_near(truss, x, stands, findings, &mut nearby));
    NodePaths {
        strut: 0,
        node_names: problem.node_names.clone(),
        struts: truss.struts.clone(),
        merged: Vec::new(),
        keyframes,
        events: Vec::new(),
        limits: limits(truss),
        surroundings: Surroundings { obstacles: problem.obstacles.clone(), terrain: problem.terrain.clone() },
    }
}

/// Returns the keyframes of the moves of a truss from `start` (m), each step from rest to rest as [`node_paths`] has it, with
/// the margins that `margins` returns for the positions of the nodes, m, and what is known of them.
pub(super) fn timed(
    truss: &Structure,
    start: &[Vec3],
    moves: &[Move],
    law: TimeLaw,
    mut margins: impl FnMut(&[Vec3], Findings) -> Margins,
) -> Vec<Keyframe> {
    let places = |x: &[Vec3]| x.iter().map(|p| (*p).into()).collect::<Vec<[f64; 3]>>();
    let cause = CauseId(0);
    let mut keyframe =
        |time: f64, (interpolation, ramps): (Interpolation, Ramps), (x, findings): (&[Vec3], Findings)| {
            let (nodes, margins) = (places(x), margins(x, findings));
            Keyframe { time, interpolation, ramps, nodes, cause, margins }
        };
    let (mut time, mut known) = (0.0, Findings::default());
    let mut keyframes = vec![keyframe(time, (Interpolation::Linear, Ramps::NONE), (start, known))];
    let at = visited(start, moves);
    let timings = threads::by_turns(truss, moves.len(), |some| {
        let mut weights = Weights::restless();
        let mut timing = |index: usize| {
            law.borne(truss, at[index].as_ref(), (&moves[index], moves.get(index + 1)), &mut weights)
        };
        some.map(&mut timing).collect()
    });
    for ((step, x), Timing { duration, ramps }) in moves.iter().zip(&at[1..]).zip(timings) {
        time += duration;
        let interpolation = match step {
            Move::Linear(_, findings) => {
                known = *findings;
                Interpolation::Linear
            }
            // It changes no singular value and no distance between struts.
            Move::Roll(roll) => Interpolation::RigidRoll { edge: roll.edge, angle: roll.angle },
        };
        keyframes.push(keyframe(time, (interpolation, ramps), (x, known)));
    }
    keyframes
}

/// Returns the positions of the nodes at the start, m, and after each move.
fn visited<'a>(start: &'a [Vec3], moves: &'a [Move]) -> Vec<Cow<'a, [Vec3]>> {
    let mut at = vec![Cow::Borrowed(start)];
    for (index, step) in moves.iter().enumerate() {
        at.push(moved(&at[index], step));
    }
    at
}

/// Returns the limits of the shape as the plan states them: a locked strut is a sum of one length.
fn limits(truss: &Structure) -> TrussLimits {
    let locked = truss.limits.locked.iter().map(|&strut| (vec![strut], truss.lengths[strut]));
    let loops = truss.limits.loops.iter().cloned().zip(truss.loop_ranges.iter().copied());
    TrussLimits {
        angle: truss.limits.angle,
        rigidity: truss.limits.rigidity,
        slip: 0.0,
        sums: locked.chain(loops).map(|(struts, range)| LengthSum { struts, range }).collect(),
    }
}
