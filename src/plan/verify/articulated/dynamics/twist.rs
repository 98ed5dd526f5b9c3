//! The twist of the base under given loads of its contacts: the one that friction balances.
//!
//! Sliding contacts resist by Coulomb's law, and a robot that moves slowly takes the twist at which their forces carry
//! what its motion needs: the minimum of a smooth, strictly convex power (Peshkin and Sanderson 1989; Moreau's maximum
//! dissipation), by iteratively reweighted least squares.

use super::posed::Candidate;
use super::tolerances::PARAMETERS;
use crate::geometry::Vec3;
use crate::robot::dynamics::{Twist, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};

/// The planar momentum that the robot keeps where friction is low.
#[derive(Clone, Copy, Debug)]
pub(super) struct Momentum {
    /// The composite inertia in x, y and yaw about the centre of mass: kg and kg·m².
    pub inertia: Vector3<f64>,
    /// The velocity that the robot would have without friction: x, y (m/s) and yaw (rad/s).
    pub free: Vector3<f64>,
    /// The time over which friction acts, s.
    pub step: f64,
}

/// The task of friction at an instant.
pub(super) struct TwistProblem<'a> {
    /// The contacts.
    pub candidates: &'a [Candidate],
    /// The velocities of the contacts by the joints alone, m/s.
    pub by_joints: Vec<Vec3>,
    /// The loads of the contacts, N.
    pub loads: &'a [f64],
    /// The horizontal force (N) and the moment about the vertical (N·m) that friction has to supply: x, y, yaw.
    pub needed: Vector3<f64>,
    /// The momentum; `None` where friction decides at once.
    pub momentum: Option<Momentum>,
    /// The weight of the robot, N.
    pub weight: f64,
}

/// The rows of a twist that are planar: x, y and yaw.
const PLANAR: [usize; 3] = [0, 1, 5];

/// Returns the twist of the body at the centre of mass, in level axes, found from the guess `before`; that of the last
/// round if the rounds do not suffice.
pub(super) fn solve(problem: &TwistProblem, before: &Twist) -> Twist {
    let mut twist = Vector6::zeros();
    twist.fixed_rows_mut::<3>(0).copy_from(&before.linear);
    twist.fixed_rows_mut::<3>(3).copy_from(&before.angular);
    let start = twist;
    let ridge = PARAMETERS.regularization * problem.weight;
    let press = PARAMETERS.normal_weight / PARAMETERS.slip_speed;
    for _ in 0..PARAMETERS.twist_rounds_max {
        let mut matrix = Matrix6::identity() * ridge;
        let mut right = start * ridge;
        for (axis, row) in PLANAR.into_iter().enumerate() {
            right[row] -= problem.needed[axis];
        }
        if let Some(momentum) = &problem.momentum {
            let inertia = momentum.inertia / momentum.step;
            for (axis, row) in PLANAR.into_iter().enumerate() {
                right[row] += inertia[axis] * momentum.free[axis];
                matrix[(row, row)] += inertia[axis];
            }
        }
        for (i, candidate) in problem.candidates.iter().enumerate() {
            let load = problem.loads[i];
            if load <= 0.0 {
                continue;
            }
            let slip = velocity(candidate, &twist) + problem.by_joints[i];
            let speed = libm::hypot(libm::hypot(slip.x, slip.y), PARAMETERS.slip_speed);
            let weights =
                [candidate.friction * load / speed, candidate.friction * load / speed, press * load];
            for (axis, weight) in weights.into_iter().enumerate() {
                let row = row(candidate, axis);
                matrix += row * row.transpose() * weight;
                right -= row * (weight * problem.by_joints[i][axis]);
            }
        }
        let Some(next) = matrix.cholesky().map(|c| c.solve(&right)) else { break };
        let change = (next - twist).amax();
        twist = next;
        if change < PARAMETERS.twist_change {
            break;
        }
    }
    Twist { linear: twist.fixed_rows::<3>(0).into(), angular: twist.fixed_rows::<3>(3).into() }
}

/// Returns the row of the Jacobian of a point's velocity along an axis by the base's twist.
fn row(candidate: &Candidate, axis: usize) -> Vector6<f64> {
    let p = &candidate.p;
    match axis {
        0 => Vector6::new(1.0, 0.0, 0.0, 0.0, p.z, -p.y),
        1 => Vector6::new(0.0, 1.0, 0.0, -p.z, 0.0, p.x),
        _ => Vector6::new(0.0, 0.0, 1.0, p.y, -p.x, 0.0),
    }
}

fn velocity(candidate: &Candidate, twist: &Vector6<f64>) -> Vec3 {
    Vec3::new(row(candidate, 0).dot(twist), row(candidate, 1).dot(twist), row(candidate, 2).dot(twist))
}

/// Returns the slip of each contact under a twist, m/s, and the force of friction on it, N.
pub(super) fn friction(problem: &TwistProblem, twist: &Twist) -> Vec<(Vec3, Vec3)> {
    let one = |(i, candidate): (usize, &Candidate)| {
        let mut slip = candidate.by_base(twist) + problem.by_joints[i];
        slip.z = 0.0;
        let speed = libm::hypot(slip.norm(), PARAMETERS.slip_speed);
        (slip, slip * (-candidate.friction * problem.loads[i] / speed))
    };
    problem.candidates.iter().enumerate().map(one).collect()
}

/// Returns the wrench about the centre of mass of forces (N) at the contacts, one for each.
pub(super) fn wrench(candidates: &[Candidate], forces: impl Iterator<Item = Vec3>) -> Wrench {
    let mut sum = Wrench::default();
    for (candidate, force) in candidates.iter().zip(forces) {
        sum.force += force;
        sum.moment += candidate.p.cross(&force);
    }
    sum
}

/// Returns for each loaded link the length of the mean slip of its contacts, weighted by their loads (m/s), and its
/// load as a part of `weight` (N).
pub(super) fn slips_by_link(
    candidates: &[Candidate],
    loads: &[f64],
    friction: &[(Vec3, Vec3)],
    weight: f64,
) -> Vec<(usize, f64, f64)> {
    let mut found: Vec<(usize, Vec3, f64)> = Vec::new();
    for ((candidate, load), (slip, _)) in candidates.iter().zip(loads).zip(friction) {
        if *load <= 0.0 {
            continue;
        }
        match found.iter_mut().find(|(link, _, _)| *link == candidate.link) {
            Some((_, sum, whole)) => (*sum, *whole) = (*sum + slip * *load, *whole + load),
            None => found.push((candidate.link, slip * *load, *load)),
        }
    }
    found.into_iter().map(|(link, sum, load)| (link, sum.norm() / load, load / weight)).collect()
}
