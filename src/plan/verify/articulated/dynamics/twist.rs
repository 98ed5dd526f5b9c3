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
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use std::collections::BTreeMap;

/// The planar momentum of the robot at an instant, which it keeps as far as friction does not change it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Momentum {
    /// The composite inertia in x, y and yaw about the centre of mass: kg and kg·m².
    pub inertia: Vector3<f64>,
    /// The velocity that the robot would have without friction: x, y (m/s) and yaw (rad/s).
    pub free: Vector3<f64>,
    /// The time over which friction acts, s.
    pub step: f64,
}

/// The problem of the twist of the base at which the friction of its contacts is in balance at an instant.
pub(super) struct TwistProblem<'a> {
    /// The points that the ground may bear.
    pub candidates: &'a [Candidate],
    /// The normal force at each candidate, N.
    pub loads: &'a [f64],
    /// The horizontal force (N) and the moment about the vertical through the centre of mass (N·m) that friction has to
    /// supply: x, y, yaw in level axes.
    pub needed: Vector3<f64>,
    /// The moments in roll and pitch about the centre of mass (N·m) that friction has to supply on a slope, as the normal
    /// forces do not: without them a robot on wheels would turn over its axle. Zero on level ground.
    pub tilting: [f64; 2],
    /// The momentum; `None` where friction decides at once.
    pub momentum: Option<Momentum>,
    /// The weight of the robot, N.
    pub weight: f64,
}

/// The rows of a twist that are planar: x, y and yaw.
const PLANAR: [usize; 3] = [0, 1, 5];

/// Returns the twist of the base at the centre of mass (m/s, rad/s), in level axes, at which the friction of the
/// contacts balances the needed force and the change of momentum, by iteratively reweighted least squares from the
/// guess `before`; the last iterate if the rounds do not suffice.
pub(super) fn solve(problem: &TwistProblem, before: &Twist) -> Twist {
    let start = joined(&before.linear, &before.angular);
    let mut twist = start;
    let ridge = PARAMETERS.regularization * problem.weight;
    let press = PARAMETERS.normal_weight / PARAMETERS.slip_speed;
    let loaded = || problem.candidates.iter().zip(problem.loads).filter(|(_, load)| **load > 0.0);
    let (mut given, mut given_right) = (Matrix6::identity() * ridge, start * ridge);
    for (axis, row) in PLANAR.into_iter().enumerate() {
        given_right[row] -= problem.needed[axis];
    }
    given_right[3] -= problem.tilting[0];
    given_right[4] -= problem.tilting[1];
    if let Some(momentum) = &problem.momentum {
        let inertia = momentum.inertia / momentum.step;
        for (axis, row) in PLANAR.into_iter().enumerate() {
            given_right[row] += inertia[axis] * momentum.free[axis];
            given[(row, row)] += inertia[axis];
        }
    }
    // Along the normal the weights do not change with the slip.
    let mut normal = Resistance::default();
    for (candidate, load) in loaded() {
        normal.add(&candidate.p, &candidate.by_joints, press * load);
    }
    normal.along_normal(&mut given, &mut given_right);
    for _ in 0..PARAMETERS.twist_rounds_max {
        let (mut matrix, mut right) = (given, given_right);
        let mut along = Resistance::default();
        for (candidate, load) in loaded() {
            let (p, v) = (&candidate.p, &candidate.by_joints);
            let x = twist[0] + twist[4] * p.z - twist[5] * p.y + v.x;
            let y = twist[1] + twist[5] * p.x - twist[3] * p.z + v.y;
            along.add(p, v, candidate.friction * load / regularized_speed(x * x + y * y));
        }
        along.along_ground(&mut matrix, &mut right);
        let Some(next) = matrix.cholesky().map(|c| c.solve(&right)) else { break };
        let change = (next - twist).amax();
        twist = next;
        if change < PARAMETERS.twist_change {
            break;
        }
    }
    moved(&twist)
}

/// Weighted sums over points that resist motion, each at p (m) with the velocity v (m/s) that it has without the twist.
#[derive(Default)]
struct Resistance {
    /// The sum of the weights.
    weight: f64,
    /// The sum of p.
    p: Vec3,
    /// The sum of the squares of p: x², y², z².
    squares: Vec3,
    /// The sum of the products of p: xy, xz, yz.
    products: Vec3,
    /// The sum of v.
    v: Vec3,
    /// The sum of `p vᵀ`.
    moments: Matrix3<f64>,
}

impl Resistance {
    fn add(&mut self, p: &Vec3, v: &Vec3, weight: f64) {
        let (weighted, pull) = (p * weight, v * weight);
        self.weight += weight;
        self.p += weighted;
        self.squares += weighted.component_mul(p);
        self.products += Vec3::new(weighted.x * p.y, weighted.x * p.z, weighted.y * p.z);
        self.v += pull;
        self.moments += p * pull.transpose();
    }

    /// Adds the points as they resist along the ground: `Jᵀ W J` with the Jacobian J of their velocities in x and y,
    /// and `-Jᵀ W v`.
    fn along_ground(&self, matrix: &mut Matrix6<f64>, right: &mut Vector6<f64>) {
        let ([x, y, z], [xx, yy, zz]) = (self.p.into(), self.squares.into());
        let [_, xz, yz]: [f64; 3] = self.products.into();
        add_symmetric(matrix, [(0, 0), (1, 1)], self.weight);
        add_symmetric(matrix, [(0, 4)], z);
        add_symmetric(matrix, [(1, 3)], -z);
        add_symmetric(matrix, [(0, 5)], -y);
        add_symmetric(matrix, [(1, 5)], x);
        add_symmetric(matrix, [(3, 3), (4, 4)], zz);
        add_symmetric(matrix, [(5, 5)], xx + yy);
        add_symmetric(matrix, [(3, 5)], -xz);
        add_symmetric(matrix, [(4, 5)], -yz);
        let m = &self.moments;
        *right -= Vector6::new(self.v.x, self.v.y, 0.0, -m[(2, 1)], m[(2, 0)], m[(0, 1)] - m[(1, 0)]);
    }

    /// Adds the points as they resist along the normal: `Jᵀ W J` with the Jacobian J of their velocities in z, and
    /// `-Jᵀ W v`.
    fn along_normal(&self, matrix: &mut Matrix6<f64>, right: &mut Vector6<f64>) {
        add_symmetric(matrix, [(2, 2)], self.weight);
        add_symmetric(matrix, [(2, 3)], self.p.y);
        add_symmetric(matrix, [(2, 4)], -self.p.x);
        add_symmetric(matrix, [(3, 3)], self.squares.y);
        add_symmetric(matrix, [(4, 4)], self.squares.x);
        add_symmetric(matrix, [(3, 4)], -self.products.x);
        let m = &self.moments;
        *right -= Vector6::new(0.0, 0.0, self.v.z, m[(1, 2)], -m[(0, 2)], 0.0);
    }
}

/// Adds a value at these places of a symmetric matrix, each (row, column) of its upper triangle.
fn add_symmetric<const N: usize>(matrix: &mut Matrix6<f64>, at: [(usize, usize); N], value: f64) {
    for (row, column) in at {
        matrix[(row, column)] += value;
        if row != column {
            matrix[(column, row)] += value;
        }
    }
}

/// Returns the twist of `[linear; angular]`.
fn moved(twist: &Vector6<f64>) -> Twist {
    Twist { linear: twist.fixed_rows::<3>(0).into(), angular: twist.fixed_rows::<3>(3).into() }
}

/// Returns the speed by which the friction on a slip is divided, `sqrt(s² + v_s²)` with the `slip_speed` v_s, m/s.
/// `squared`: the square s² of the slip, m²/s².
pub(super) fn regularized_speed(squared: f64) -> f64 {
    libm::sqrt(squared + PARAMETERS.slip_speed * PARAMETERS.slip_speed)
}

/// Returns for each candidate (slip, force): its slip under a twist of the base, m/s, and the force of friction on it,
/// N, both horizontal, in level axes. Friction is Coulomb's, and viscous below `slip_speed`.
pub(super) fn friction(problem: &TwistProblem, twist: &Twist) -> Vec<(Vec3, Vec3)> {
    let one = |(i, candidate): (usize, &Candidate)| {
        let mut slip = twist.at(&candidate.p) + candidate.by_joints;
        slip.z = 0.0;
        let speed = regularized_speed(slip.norm_squared());
        (slip, slip * (-candidate.friction * problem.loads[i] / speed))
    };
    problem.candidates.iter().enumerate().map(one).collect()
}

/// Returns for each link that bears or is about to, ascending by number, (number, speed in m/s: the length of the mean slip of
/// its contacts weighted by their loads, load as a fraction of `weight`). One without load is about to bear if it is at most
/// [`idle_gap`](super::tolerances::Parameters::idle_gap) above the lowest point; its speed is the mean of such contacts. `loads`: the normal force at each candidate, N;
/// `friction`: as [`friction`] returns it; `weight`: that of the robot, N.
pub(super) fn slips_by_link(
    candidates: &[Candidate],
    loads: &[f64],
    friction: &[(Vec3, Vec3)],
    weight: f64,
) -> Vec<(usize, f64, f64)> {
    let mut found: BTreeMap<usize, (Vec3, f64)> = BTreeMap::new();
    let mut idle: BTreeMap<usize, (Vec3, f64)> = BTreeMap::new();
    for ((candidate, load), (slip, _)) in candidates.iter().zip(loads).zip(friction) {
        let (of, share) = if *load > 0.0 {
            (&mut found, *load)
        } else if candidate.gap <= PARAMETERS.idle_gap {
            (&mut idle, 1.0)
        } else {
            continue;
        };
        let (sum, whole) = of.entry(candidate.link).or_default();
        (*sum, *whole) = (*sum + slip * share, *whole + share);
    }
    idle.retain(|link, _| !found.contains_key(link));
    let bearing = found.into_iter().map(|(link, (sum, load))| (link, sum.norm() / load, load / weight));
    let mut all: Vec<(usize, f64, f64)> = bearing.collect();
    all.extend(idle.into_iter().map(|(link, (sum, count))| (link, sum.norm() / count, 0.0)));
    all.sort_unstable_by_key(|(link, ..)| *link);
    all
}
