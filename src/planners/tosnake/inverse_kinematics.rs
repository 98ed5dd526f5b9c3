//! Damped least-squares inverse kinematics (Buss 2005, section 6) that closes a loop: the joints between two
//! docks -Z move until the docks meet, while balls that are near each other are driven apart.
//!
//! Each iteration solves for joint steps that satisfy six linear constraints from the Jacobian of the second
//! dock, softly, and, in the collision-free mode, inequality constraints that keep balls apart (active set).
//! What the constraints leave open follows a secondary task, a repulsion of balls, by projection into their
//! null space. All postures of the descent are kept.

use super::cholesky::NormalMatrix;
use super::motion_check::{MIN_DISTANCE, Scene};
use super::neighbour_list::{NeighbourList, Neighbours};
use super::robot::{Dock, GAMMA, RED, mate};
use super::state::Joints;
use super::tree::{JointRef, Tree};
use crate::geometry::rigid_transform::rotation_vector;
use crate::geometry::{RigidTransform, Vec3};
use nalgebra::Vector6;
use std::f64::consts::FRAC_PI_2;

/// The mode of the inverse kinematics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IkMode {
    /// Only the loop's joints move, and only the endpoint has to be free of overlap: on the way balls are
    /// repelled, and may pass through each other.
    Endpoint,
    /// All joints of the robot move, and balls in contact do not approach: the descent itself is free.
    CollisionFree,
}

/// Settings of the descent. Lengths are in pitches, angles in radians.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Greatest number of iterations for a short loop. Default 200; most loops close in 20.
    pub iterations_max: usize,
    /// Greatest step of a joint in one iteration, rad. Default 0.2, where linearisation still holds.
    pub joint_step_max: f64,
    /// Greatest displacement of a ball in one iteration of a collision-free descent. Default 0.3, below the
    /// distance at which balls could change places unseen.
    pub ball_step_max: f64,
    /// Norm of translation and rotation error below which the loop is closed. Default 1e-11: far below what
    /// docking needs, well above rounding.
    pub tol_closed: f64,
    /// Least distance of balls that constraints keep. Default 1.002, a little more than touching.
    pub min_distance: f64,
    /// Distance below which balls repel each other. Default 1.2.
    pub repulsion_reach: f64,
    /// Gain of the repulsion in the endpoint mode. Default 0.3.
    pub endpoint_repulsion_gain: f64,
    /// Gain of the repulsion in the collision-free mode. Default 0.05: constraints do the rest.
    pub collision_free_repulsion_gain: f64,
    /// Error below which balls that do not overlap no longer repel each other, so that the last iterations
    /// converge quadratically. Default 1e-2.
    pub nearly_closed: f64,
    /// Relative growth of [`Settings::iterations_max`] and of the steps for every module of the loop: long
    /// loops have a long way to go. Default 0.1.
    pub loop_scale: f64,
    /// Iterations that the initial bias lasts. Default 12.
    pub initial_bias_steps: usize,
    /// Iterations without a tenth of progress after which the descent is given up. Default 25.
    pub patience: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            iterations_max: 200,
            joint_step_max: 0.2,
            ball_step_max: 0.3,
            tol_closed: 1e-11,
            min_distance: 1.002,
            repulsion_reach: 1.2,
            endpoint_repulsion_gain: 0.3,
            collision_free_repulsion_gain: 0.05,
            nearly_closed: 1e-2,
            loop_scale: 0.1,
            initial_bias_steps: 12,
            patience: 25,
        }
    }
}

/// A kinematic loop that is to be closed, seen from its first dock.
pub struct Loop {
    /// Index of the shoe of the first dock.
    pub from: usize,
    /// Index of the shoe of the second dock.
    pub to: usize,
    /// The joints between them, each with the sign with which its turn carries the second dock against the
    /// first.
    pub joints: Vec<(JointRef, f64)>,
}

impl Loop {
    /// Returns the loop that closes when two docks -Z meet.
    pub fn new(tree: &Tree, a: Dock, b: Dock) -> Loop {
        let (from, to) = (tree.index[a.shoe()], tree.index[b.shoe()]);
        Loop { from, to, joints: joints_between(tree, from, to) }
    }

    /// The closure error of the second shoe: translation in pitches, then rotation vector in radians.
    fn error(&self, poses: &[RigidTransform]) -> Vector6<f64> {
        let wanted = poses[self.from].then(&mate(RED, 0, RED));
        let found = &poses[self.to];
        let shift = wanted.translation - found.translation;
        let turn = rotation_vector(&(wanted.rotation * found.rotation.transpose()));
        Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
    }
}

/// The joints between two shoes, each with the sign with which its turn carries the second.
fn joints_between(tree: &Tree, from: usize, to: usize) -> Vec<(JointRef, f64)> {
    let mut joints = Vec::new();
    for step in tree.path(from, to).indices.windows(2) {
        let (child, sign) = if step[1] > step[0] { (step[1], 1.0) } else { (step[0], -1.0) };
        joints.extend(tree.joints_at(child).map(|joint| (joint, sign)));
    }
    joints
}

/// The closure of a loop by inverse kinematics.
pub struct LoopClosure<'a> {
    /// The robot.
    pub scene: &'a Scene<'a>,
    /// The loop.
    pub lp: &'a Loop,
    /// The mode.
    pub mode: IkMode,
    /// Settings of the descent.
    pub settings: &'a Settings,
}

impl LoopClosure<'_> {
    /// Closes the loop from given joint positions. Returns all postures of the descent, the last of which is
    /// closed and without overlap; `None` if it does not converge. `initial_bias` holds a step of each joint
    /// (rad, indexed by three times the module plus the joint) that the first iterations prefer; it may be
    /// empty. `work` counts forward kinematics.
    pub fn solve(&self, start: &[[f64; 3]], initial_bias: &[f64], work: &mut u64) -> Option<Vec<Joints>> {
        let LoopClosure { scene, lp, mode, settings } = *self;
        let tree = scene.tree;
        let mut descent = vec![start.to_vec()];
        let mut joints = start.to_vec();
        let mut poses = Vec::new();
        tree.poses(&joints, &mut poses);
        let in_loop = |module| lp.joints.iter().any(|(joint, _)| joint.module == module);
        let turns = |module: usize| mode == IkMode::CollisionFree || in_loop(module);
        let carried = tree.carried(turns);
        let loop_scale = 1.0 + lp.joints.len() as f64 / 3.0 * settings.loop_scale;
        let bias_steps = if initial_bias.is_empty() { 0 } else { settings.initial_bias_steps };
        // For an endpoint, overlapping and repelled balls matter; in a collision-free descent all that may
        // meet within one step.
        let reach = match mode {
            IkMode::Endpoint => settings.repulsion_reach.max(MIN_DISTANCE),
            IkMode::CollisionFree => 1.0 + 2.0 * settings.ball_step_max * loop_scale,
        };
        let mut list = NeighbourList::new(scene, (lp.from, lp.to), tree.parts(turns));
        let (mut best, mut since) = (f64::INFINITY, 0);
        for iteration in 0..(settings.iterations_max as f64 * loop_scale) as usize {
            crate::interrupt::checkpoint();
            // Errors of the present posture.
            tree.poses_of(&carried, &joints, &mut poses);
            *work += ITERATION_WORK;
            let error = lp.error(&poses);
            let size = error.norm();
            let neighbours = list.within(reach, &poses);
            let least = neighbours.iter().fold(f64::INFINITY, |least, n| least.min(n.distance));
            let overlap = (MIN_DISTANCE - least).max(0.0);
            if size < settings.tol_closed && overlap == 0.0 {
                return Some(descent);
            }
            // Stagnation ends the descent.
            let merit = size + OVERLAP_WEIGHT * overlap;
            if merit < 0.9 * best {
                (best, since) = (merit, 0);
            } else {
                since += 1;
                if since > settings.patience + bias_steps {
                    return None;
                }
            }
            // One damped least-squares step, within the joints' ranges.
            let repulsion_gain = match mode {
                _ if size < settings.nearly_closed && overlap == 0.0 => 0.0,
                IkMode::Endpoint => settings.endpoint_repulsion_gain,
                IkMode::CollisionFree => settings.collision_free_repulsion_gain,
            };
            let initial_bias = if iteration < bias_steps { initial_bias } else { &[] };
            let iteration = Iteration {
                mode,
                loop_scale,
                tree,
                poses: &poses,
                joints: &joints,
                neighbours: &neighbours,
                settings,
                repulsion_gain,
                initial_bias,
            };
            let step = iteration.joint_step(lp, &error);
            for joint in tree.all_joints() {
                let q = &mut joints[joint.module][joint.joint];
                *q = clamped(joint.joint, *q + step[3 * joint.module + joint.joint]);
            }
            descent.push(joints.clone());
        }
        None
    }
}

/// The work of an iteration in forward kinematics, which take about as long.
const ITERATION_WORK: u64 = 10;

/// Weight of an overlap in the merit, beside the closure error.
const OVERLAP_WEIGHT: f64 = 10.0;

/// Returns a joint position within its range: ±π/2 for tilts (rad), any for gamma.
pub fn clamped(joint: usize, q: f64) -> f64 {
    if joint == GAMMA { q } else { q.clamp(-FRAC_PI_2, FRAC_PI_2) }
}

/// One iteration of the descent.
struct Iteration<'a> {
    mode: IkMode,
    loop_scale: f64,
    tree: &'a Tree,
    poses: &'a [RigidTransform],
    joints: &'a [[f64; 3]],
    neighbours: &'a [Neighbours],
    settings: &'a Settings,
    repulsion_gain: f64,
    initial_bias: &'a [f64],
}

/// A linear constraint on joint steps: `Σ factor · step = goal`, or at least the goal. The factors are a
/// sparse row of a Jacobian.
struct Row {
    terms: Vec<(usize, f64)>,
    goal: f64,
}

/// Number of rows that close the loop.
const CLOSURE_ROWS: usize = 6;
/// Greatest number of distance constraints in the active set.
const ACTIVE_MAX: usize = 100;
/// Greatest number of changes of the active set.
const ACTIVE_SET_ROUNDS_MAX: usize = 12;
/// Violation of a distance constraint, in pitches, below which it stays out of the active set.
const TOL_CONSTRAINT: f64 = 1e-3;
/// Greatest rotation error that one step is to make good, rad.
const ROTATION_STEP_MAX: f64 = 0.4;
/// Damping relative to the squared closure error, as in Buss 2005 eq. (11) with λ² decreasing towards the
/// solution.
const DAMPING: f64 = 1e-4;
/// Damping that remains at the solution.
const DAMPING_MIN: f64 = 1e-12;
/// Damping relative to the trace of the normal matrix, against singular configurations.
const DAMPING_TRACE: f64 = 1e-10;
/// Damping of distance constraints: two that are nearly the same leave the matrix regular.
const DAMPING_CONSTRAINT: f64 = 1e-6;

impl Iteration<'_> {
    /// The step of all joints (rad): a damped least-squares step under the constraints of an active set that
    /// is updated until it does not change (primal active-set method).
    fn joint_step(&self, lp: &Loop, error: &Vector6<f64>) -> Vec<f64> {
        let count = 3 * self.joints.len();
        let mut rows = self.closure_rows(lp, error);
        let secondary_task = self.secondary_task(lp, count);
        let candidates = match self.mode {
            IkMode::Endpoint => &[],
            IkMode::CollisionFree => self.neighbours,
        };
        let damping = DAMPING * error.norm_squared().min(1.0) + DAMPING_MIN;
        let mut fixed = vec![false; count];
        let mut active: Vec<usize> = Vec::new();
        let mut step = vec![0.0; count];
        for round in 0..ACTIVE_SET_ROUNDS_MAX {
            // Solve with the constraints of the active set as equations.
            rows.truncate(CLOSURE_ROWS);
            rows.extend(active.iter().map(|&c| self.distance_row(&candidates[c])));
            let (solved, multipliers) = solve(&rows, &secondary_task, &fixed, damping);
            step = solved;
            self.limit_step(&mut step);
            if round + 1 == ACTIVE_SET_ROUNDS_MAX {
                break;
            }
            // Drop constraints with negative multipliers: they would hold the balls together.
            let mut kept = Vec::new();
            for (i, &c) in active.iter().enumerate() {
                if multipliers[CLOSURE_ROWS + i] >= 0.0 {
                    kept.push(c);
                }
            }
            let mut changed = kept.len() != active.len();
            active = kept;
            // Add violated constraints, the worst first.
            let displacements = if candidates.is_empty() { Vec::new() } else { self.displacements(&step) };
            let far = displacements.iter().map(|v: &Vec3| v.norm()).fold(0.0, f64::max);
            let mut violated: Vec<(f64, usize)> = candidates
                .iter()
                .enumerate()
                .filter(|(c, pair)| {
                    pair.distance < self.settings.min_distance + 2.0 * far && !active.contains(c)
                })
                .map(|(c, pair)| {
                    let separation = pair.normal.dot(&(displacements[pair.b] - displacements[pair.a]));
                    (separation - self.least_separation(pair), c)
                })
                .filter(|(slack, _)| *slack < -TOL_CONSTRAINT)
                .collect();
            violated.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            for (_, c) in violated.into_iter().take(ACTIVE_MAX.saturating_sub(active.len())) {
                active.push(c);
                changed = true;
            }
            // Fix joints that would leave their ranges.
            for (index, fixed) in fixed.iter_mut().enumerate() {
                let (module, joint) = (index / 3, index % 3);
                let q = self.joints[module][joint] + step[index];
                if !*fixed && clamped(joint, q) != q {
                    *fixed = true;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        step
    }

    /// The six rows that close the loop: the Jacobian of the second shoe, with as much of the error as one
    /// step can make good.
    fn closure_rows(&self, lp: &Loop, error: &Vector6<f64>) -> Vec<Row> {
        let (shift, turn) = (error.fixed_rows::<3>(0).norm(), error.fixed_rows::<3>(3).norm());
        let scale =
            f64::min(1.0, f64::min(self.loop_scale / shift.max(1e-30), ROTATION_STEP_MAX / turn.max(1e-30)));
        let tip = self.poses[lp.to].translation;
        let mut rows: Vec<Row> = (0..CLOSURE_ROWS)
            .map(|i| Row { terms: Vec::with_capacity(lp.joints.len()), goal: error[i] * scale })
            .collect();
        for (joint, sign) in &lp.joints {
            let (axis, point) = self.tree.axis(*joint, self.poses);
            let v = axis.cross(&(tip - point)) * *sign;
            let index = 3 * joint.module + joint.joint;
            for i in 0..3 {
                rows[i].terms.push((index, v[i]));
                rows[3 + i].terms.push((index, axis[i] * *sign));
            }
        }
        rows
    }

    /// The row that keeps two balls apart: the gradient of their distance, and its least change.
    fn distance_row(&self, pair: &Neighbours) -> Row {
        let at = self.poses[pair.b].translation;
        let between = joints_between(self.tree, pair.a, pair.b);
        let term = |(joint, sign): &(JointRef, f64)| {
            let (axis, point) = self.tree.axis(*joint, self.poses);
            // A turn of the joint carries b, or the other way round a: the distance changes alike.
            let v = axis.cross(&(at - point)) * *sign;
            (3 * joint.module + joint.joint, pair.normal.dot(&v))
        };
        Row { terms: between.iter().map(term).collect(), goal: self.least_separation(pair) }
    }

    /// The least change of the distance of two balls in one step, in pitches; negative if they may approach.
    fn least_separation(&self, pair: &Neighbours) -> f64 {
        let missing = self.settings.min_distance - pair.distance;
        if missing > 0.0 { (0.5 * missing).min(0.05) } else { missing }
    }

    /// The secondary task: steps of the joints (rad) that are wanted as far as the constraints leave them
    /// open. The initial bias, plus the joint torques of the repulsion times a gain.
    fn secondary_task(&self, lp: &Loop, count: usize) -> Vec<f64> {
        let mut task =
            if self.initial_bias.is_empty() { vec![0.0; count] } else { self.initial_bias.to_vec() };
        if self.repulsion_gain == 0.0 {
            return task;
        }
        let repulsion = Repulsion::new(self.poses, self.neighbours, self.settings.repulsion_reach);
        let joints = match self.mode {
            IkMode::Endpoint => lp.joints.iter().map(|(joint, _)| *joint).collect(),
            IkMode::CollisionFree => self.tree.all_joints(),
        };
        for joint in joints {
            let (axis, point) = self.tree.axis(joint, self.poses);
            let torque = repulsion.torque(self.tree, joint.child, &axis, &point);
            task[3 * joint.module + joint.joint] += self.repulsion_gain * torque;
        }
        task
    }

    /// Scales a step so that no joint turns too far, and in a collision-free descent no ball goes too far.
    fn limit_step(&self, step: &mut [f64]) {
        let greatest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        let mut scale = f64::min(1.0, self.settings.joint_step_max / greatest.max(1e-30));
        if self.mode == IkMode::CollisionFree {
            let far = libm::sqrt(self.displacements(step).iter().map(Vec3::norm_squared).fold(0.0, f64::max));
            scale = scale.min(self.settings.ball_step_max * self.loop_scale / far.max(1e-30));
        }
        step.iter_mut().for_each(|s| *s *= scale);
    }

    /// By index: the displacement of each ball by a step of the joints, to first order, in pitches. Twists
    /// are summed from the root outwards, which is the product with the whole Jacobian in linear time.
    fn displacements(&self, step: &[f64]) -> Vec<Vec3> {
        let mut twist = vec![(Vec3::zeros(), Vec3::zeros()); self.poses.len()];
        let mut displacements = vec![Vec3::zeros(); self.poses.len()];
        for index in 1..self.poses.len() {
            let (mut v, mut w) = twist[self.tree.parent[index]];
            for joint in self.tree.joints_at(index) {
                let turn = step[3 * joint.module + joint.joint];
                if turn != 0.0 {
                    let (axis, point) = self.tree.axis(joint, self.poses);
                    v -= axis.cross(&point) * turn;
                    w += axis * turn;
                }
            }
            twist[index] = (v, w);
            displacements[index] = v + w.cross(&self.poses[index].translation);
        }
        displacements
    }
}

/// The step nearest to the secondary task that satisfies the rows, the first six of them damped:
/// `x = t + Jᵀ (J Jᵀ + D)⁻¹ (goal - J t)`. Returns it with the multipliers of the rows. Fixed joints stay.
fn solve(rows: &[Row], secondary_task: &[f64], fixed: &[bool], damping: f64) -> (Vec<f64>, Vec<f64>) {
    // J as a dense matrix, without the columns of fixed joints.
    let count = secondary_task.len();
    let mut dense = vec![0.0; rows.len() * count];
    for (row, out) in rows.iter().zip(dense.chunks_mut(count)) {
        for &(joint, factor) in row.terms.iter().filter(|(joint, _)| !fixed[*joint]) {
            out[joint] += factor;
        }
    }
    // The normal matrix J Jᵀ and the right side.
    let mut normal = NormalMatrix::zeros(rows.len());
    let mut right = vec![0.0; rows.len()];
    for i in 0..rows.len() {
        for &(joint, _) in &rows[i].terms {
            let factor = dense[i * count + joint];
            if factor == 0.0 {
                continue;
            }
            for j in 0..=i {
                normal.add(i, j, factor * dense[j * count + joint]);
            }
        }
        right[i] = rows[i].goal
            - rows[i]
                .terms
                .iter()
                .map(|&(joint, _)| dense[i * count + joint] * secondary_task[joint])
                .sum::<f64>();
    }
    // Damping, and the multipliers.
    let trace = normal.trace().max(1e-9);
    for i in 0..rows.len() {
        normal.add(i, i, if i < CLOSURE_ROWS { damping + DAMPING_TRACE * trace } else { DAMPING_CONSTRAINT });
    }
    normal.solve(&mut right);
    let mut step: Vec<f64> =
        secondary_task.iter().zip(fixed).map(|(t, fixed)| if *fixed { 0.0 } else { *t }).collect();
    for (i, row) in rows.iter().enumerate() {
        for &(joint, _) in &row.terms {
            step[joint] += dense[i * count + joint] * right[i];
        }
    }
    (step, right)
}

/// A repulsion of balls: prefix sums by index of the forces on balls and of their moments, so that those on a
/// subtree are differences.
struct Repulsion {
    force: Vec<Vec3>,
    moment: Vec<Vec3>,
}

impl Repulsion {
    /// Forces along the normals that grow linearly below the distance `reach`.
    fn new(poses: &[RigidTransform], neighbours: &[Neighbours], reach: f64) -> Repulsion {
        let mut force = vec![Vec3::zeros(); poses.len()];
        for pair in neighbours.iter().filter(|n| n.distance < reach) {
            let push = pair.normal * (reach - pair.distance);
            force[pair.b] += push;
            force[pair.a] -= push;
        }
        let (mut f, mut m) = (Vec3::zeros(), Vec3::zeros());
        let (mut forces, mut moments) = (vec![f], vec![m]);
        for (force, pose) in force.iter().zip(poses) {
            f += force;
            m += pose.translation.cross(force);
            forces.push(f);
            moments.push(m);
        }
        Repulsion { force: forces, moment: moments }
    }

    /// The torque about an axis through `point` of the forces on the subtree of `index`.
    fn torque(&self, tree: &Tree, index: usize, axis: &Vec3, point: &Vec3) -> f64 {
        let end = tree.end[index];
        let force = self.force[end] - self.force[index];
        let moment = self.moment[end] - self.moment[index];
        axis.dot(&(moment - point.cross(&force)))
    }
}
