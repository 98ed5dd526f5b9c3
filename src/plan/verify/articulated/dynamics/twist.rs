//! The twist of the base under given loads of its contacts: the one that friction balances.
//!
//! Sliding contacts resist by Coulomb's law, and a robot that moves slowly takes the twist at which their forces carry
//! what its motion needs: the minimum of a smooth, strictly convex power (Peshkin and Sanderson 1989; Moreau's maximum
//! dissipation), by iteratively reweighted least squares.

use super::elastic_tree::joined;
use super::posed::Candidate;
use super::tolerances::PARAMETERS;
use crate::geometry::Vec3;
use crate::robot::dynamics::Twist;
use nalgebra::{Matrix6, Vector3, Vector6};
use std::collections::BTreeMap;

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

/// The problem of the twist that friction balances at an instant.
pub(super) struct TwistProblem<'a> {
    /// The points that the ground may bear.
    pub candidates: &'a [Candidate],
    /// The normal force at each candidate, N.
    pub loads: &'a [f64],
    /// The horizontal force (N) and the moment about the vertical through the centre of mass (N·m) that friction has to
    /// supply: x, y, yaw in level axes.
    pub needed: Vector3<f64>,
    /// The momentum; `None` where friction decides at once.
    pub momentum: Option<Momentum>,
    /// The weight of the robot, N.
    pub weight: f64,
}

/// The rows of a twist that are planar: x, y and yaw.
const PLANAR: [usize; 3] = [0, 1, 5];

/// Returns the twist of the base at the centre of mass (m/s, rad/s), in level axes, found from the guess `before`; that
/// of the last round if the rounds do not suffice.
pub(super) fn solve(problem: &TwistProblem, before: &Twist) -> Twist {
    let start = joined(&before.linear, &before.angular);
    let mut twist = start;
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
            let slip = moved(&twist).at(&candidate.p) + candidate.by_joints;
            let speed = libm::hypot(libm::hypot(slip.x, slip.y), PARAMETERS.slip_speed);
            let (along, normal) = (candidate.friction * load / speed, press * load);
            add_contact(&mut matrix, &candidate.p, along, normal);
            let v = &candidate.by_joints;
            let force = Vec3::new(along * v.x, along * v.y, normal * v.z);
            right -= joined(&force, &candidate.p.cross(&force));
        }
        let Some(next) = matrix.cholesky().map(|c| c.solve(&right)) else { break };
        let change = (next - twist).amax();
        twist = next;
        if change < PARAMETERS.twist_change {
            break;
        }
    }
    moved(&twist)
}

/// Adds a point at `p` that resists a twist with these weights of its velocities, along the ground and along the
/// normal: `Jᵀ W J` with the Jacobian J of the point's velocity, upper and lower triangle.
fn add_contact(matrix: &mut Matrix6<f64>, p: &Vec3, along: f64, normal: f64) {
    let mut add = |row: usize, column: usize, value: f64| {
        matrix[(row, column)] += value;
        if row != column {
            matrix[(column, row)] += value;
        }
    };
    add(0, 0, along);
    add(1, 1, along);
    add(2, 2, normal);
    add(0, 4, along * p.z);
    add(0, 5, -along * p.y);
    add(1, 3, -along * p.z);
    add(1, 5, along * p.x);
    add(2, 3, normal * p.y);
    add(2, 4, -normal * p.x);
    add(3, 3, along * p.z * p.z + normal * p.y * p.y);
    add(4, 4, along * p.z * p.z + normal * p.x * p.x);
    add(5, 5, along * (p.x * p.x + p.y * p.y));
    add(3, 4, -normal * p.x * p.y);
    add(3, 5, -along * p.z * p.x);
    add(4, 5, -along * p.z * p.y);
}

/// Returns the twist of `[linear; angular]`.
fn moved(twist: &Vector6<f64>) -> Twist {
    Twist { linear: twist.fixed_rows::<3>(0).into(), angular: twist.fixed_rows::<3>(3).into() }
}

/// Returns the slip of each candidate under a twist (m/s), and the force of friction on it (N), both horizontal in
/// level axes. Friction is Coulomb's, and viscous below `slip_speed`.
pub(super) fn friction(problem: &TwistProblem, twist: &Twist) -> Vec<(Vec3, Vec3)> {
    let one = |(i, candidate): (usize, &Candidate)| {
        let mut slip = twist.at(&candidate.p) + candidate.by_joints;
        slip.z = 0.0;
        let speed = libm::hypot(slip.norm(), PARAMETERS.slip_speed);
        (slip, slip * (-candidate.friction * problem.loads[i] / speed))
    };
    problem.candidates.iter().enumerate().map(one).collect()
}

/// Returns for each loaded link, ascending, its number, the length of the mean slip of its contacts, weighted by their
/// loads (m/s), and its load as a part of `weight` (N).
pub(super) fn slips_by_link(
    candidates: &[Candidate],
    loads: &[f64],
    friction: &[(Vec3, Vec3)],
    weight: f64,
) -> Vec<(usize, f64, f64)> {
    let mut found: BTreeMap<usize, (Vec3, f64)> = BTreeMap::new();
    for ((candidate, load), (slip, _)) in candidates.iter().zip(loads).zip(friction) {
        if *load <= 0.0 {
            continue;
        }
        let (sum, whole) = found.entry(candidate.link).or_default();
        (*sum, *whole) = (*sum + slip * *load, *whole + load);
    }
    found.into_iter().map(|(link, (sum, load))| (link, sum.norm() / load, load / weight)).collect()
}
