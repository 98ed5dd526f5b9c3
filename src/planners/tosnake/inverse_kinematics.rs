//! Damped least-squares inverse kinematics (Buss 2005, section 6) that closes a loop: the joints between two
//! docks move until the docks meet, while balls that are near each other are driven apart.
//!
//! The descent itself is [`crate::robot::inverse_kinematics`]. This file poses its problem: six linear constraints
//! from the Jacobian of the second dock, softly, and, in the collision-free mode, inequality constraints that keep
//! balls apart (active set). The freedom that the constraints leave follows a secondary task, a repulsion of
//! balls, by projection into their null space. All postures of the descent are kept.

use super::motion_check::Scene;
use super::neighbour_list::{NeighbourList, Neighbours};
use super::robot::{Bond, Dock, GAMMA, mate};
use super::state::Joints;
use super::tolerances::TOLERANCES;
use super::tree::{Carried, JointRef, Tree};
use crate::geometry::rigid_transform::rotation_vector;
use crate::geometry::{RigidTransform, Vec3};
use crate::robot::inverse_kinematics::{self, Evaluation, IkProblem, Row, StopReason};
use nalgebra::Vector6;
use std::f64::consts::FRAC_PI_2;

/// The mode of the inverse kinematics that closes a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IkMode {
    /// The endpoint mode: the loop's joints alone move, and the last posture alone has to be free of overlap; before
    /// that, balls repel each other, and may pass through each other.
    Endpoint,
    /// The collision-free mode: all joints of the robot move, and constraints keep balls in contact from approaching,
    /// so that the whole descent is nearly free of overlap; its motions are to be checked.
    CollisionFree,
}

/// The settings of the descent of inverse kinematics. Lengths are in pitches, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Greatest number of iterations, before [`Settings::loop_scale`]. Default 200; most loops close in 20.
    pub iterations_max: usize,
    /// Greatest step of a joint in one iteration, rad. Default 0.2, where linearisation still holds.
    pub joint_step_max: f64,
    /// Greatest displacement of a ball in one iteration of a collision-free descent, in pitches, before
    /// [`Settings::loop_scale`]. Default 0.3, below the distance at which balls could pass through each other between
    /// iterations.
    pub ball_step_max: f64,
    /// Norm of the closure error, translation in pitches with rotation in radians, below which the loop is closed.
    /// Default 1e-11: far below what docking needs, well above rounding.
    pub tol_closed: f64,
    /// Least distance of the centres of balls that constraints keep, in pitches. Default 1.002, a little more than
    /// touching.
    pub min_distance: f64,
    /// Threshold distance of centres below which balls repel each other, in pitches. Default 1.2.
    pub repulsion_reach: f64,
    /// Gain of the repulsion in the endpoint mode, rad per squared pitch of torque. Default 0.3.
    pub endpoint_repulsion_gain: f64,
    /// Gain of the repulsion in the collision-free mode, rad per squared pitch of torque. Default 0.05: constraints do
    /// the rest.
    pub collision_free_repulsion_gain: f64,
    /// Norm of the closure error below which balls that do not overlap no longer repel each other, so that the last
    /// iterations converge quadratically. Default 1e-2.
    pub nearly_closed: f64,
    /// Relative growth, for every module of the loop, of [`Settings::iterations_max`], [`Settings::ball_step_max`] and
    /// the translation that one step is to close: long loops have a greater distance to close. Default 0.1.
    pub loop_scale: f64,
    /// Number of iterations in which the initial bias is preferred. Default 12.
    pub initial_bias_steps: usize,
    /// Number of iterations without a tenth of progress after which the descent is given up. Default 25.
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

/// The side of a loop whose joints move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovingSide {
    /// All joints between the two docks.
    Both,
    /// The joints between the first dock and its common ancestor with the second in the tree.
    First,
    /// The joints between the second dock and its common ancestor with the first in the tree.
    Second,
}

impl MovingSide {
    /// All of them.
    pub const ALL: [MovingSide; 3] = [MovingSide::Both, MovingSide::First, MovingSide::Second];
}

/// A kinematic loop that is to be closed, seen from its first dock.
pub struct Loop {
    /// Index in the tree's order ([`Tree::shoe`]) of the shoe of the first dock.
    pub from: usize,
    /// Index in the tree's order ([`Tree::shoe`]) of the shoe of the second dock.
    pub to: usize,
    /// The joints of the loop, from the first dock to the second, each with the sign (1 or -1) with which its turn
    /// moves the second dock relative to the first.
    pub joints: Vec<(JointRef, f64)>,
    /// The pose of the shoe of the second dock in the frame of that of the first where the docks meet, in pitches.
    meeting: RigidTransform,
}

impl Loop {
    /// Returns the loop that closes when the docks -Z of the shoes that carry `a` and `b` meet without a turn; `tree`:
    /// that of the robot.
    pub fn new(tree: &Tree, a: Dock, b: Dock) -> Loop {
        Loop::of_bond(tree, &Bond { a: Dock::red(a.shoe()), b: Dock::red(b.shoe()), turn: 0 })
    }

    /// Returns the loop that closes when the docks of a bond meet with its turn; `tree`: that of the robot.
    pub fn of_bond(tree: &Tree, bond: &Bond) -> Loop {
        let (from, to) = (tree.index[bond.a.shoe()], tree.index[bond.b.shoe()]);
        let meeting = mate(bond.a.face(), bond.turn, bond.b.face());
        Loop { from, to, joints: joints_between(tree, from, to), meeting }
    }

    /// Returns the same loop with the joints of the moving side alone.
    pub fn of_side(&self, side: MovingSide) -> Loop {
        let moves = |sign: f64| match side {
            MovingSide::Both => true,
            MovingSide::First => sign < 0.0,
            MovingSide::Second => sign > 0.0,
        };
        let joints = self.joints.iter().copied().filter(|(_, sign)| moves(*sign)).collect();
        Loop { joints, ..*self }
    }

    /// Returns the closure error of the second shoe: translation in pitches, then rotation vector in radians.
    fn error(&self, poses: &[RigidTransform]) -> Vector6<f64> {
        let wanted = poses[self.from].then(&self.meeting);
        let found = &poses[self.to];
        let shift = wanted.translation - found.translation;
        let turn = rotation_vector(&(wanted.rotation * found.rotation.transpose()));
        Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
    }
}

/// Returns the joints between two shoes, each with the sign with which its turn moves the second relative to the first.
fn joints_between(tree: &Tree, from: usize, to: usize) -> Vec<(JointRef, f64)> {
    let mut joints = Vec::new();
    for step in tree.path(from, to).indices.windows(2) {
        let (child, sign) = if step[1] > step[0] { (step[1], 1.0) } else { (step[0], -1.0) };
        joints.extend(tree.joints_at(child).map(|joint| (joint, sign)));
    }
    joints
}

/// The problem of closing a loop by damped least-squares inverse kinematics.
pub struct LoopClosure<'a> {
    /// The robot as checks of collisions and loads see it.
    pub scene: &'a Scene<'a>,
    /// The loop that is to be closed.
    pub lp: &'a Loop,
    /// The mode of the inverse kinematics.
    pub mode: IkMode,
    /// The settings of the descent of inverse kinematics.
    pub settings: &'a Settings,
}

impl LoopClosure<'_> {
    /// Closes the loop by inverse kinematics from the joint positions `start` (rad, by module). Returns all postures of
    /// the descent, each by module in rad, `start` first, the last of which is closed and without overlap; `None` if it
    /// does not converge. `initial_bias` holds a step of each joint (rad, at index three times the module plus the
    /// joint) that the first iterations prefer; it may be empty. `work` counts forward kinematics.
    pub fn solve(&self, start: &[[f64; 3]], initial_bias: &[f64], work: &mut u64) -> Option<Vec<Joints>> {
        let LoopClosure { scene, lp, mode, settings } = *self;
        let tree = scene.tree;
        let in_loop = |module| lp.joints.iter().any(|(joint, _)| joint.module == module);
        let turns = |module: usize| mode == IkMode::CollisionFree || in_loop(module);
        let loop_scale = 1.0 + lp.joints.len() as f64 / 3.0 * settings.loop_scale;
        let bias_steps = if initial_bias.is_empty() { 0 } else { settings.initial_bias_steps };
        // For an endpoint, overlapping and repelled balls matter; in a collision-free descent all that may
        // meet within one step.
        let reach = match mode {
            IkMode::Endpoint => settings.repulsion_reach.max(TOLERANCES.min_distance),
            IkMode::CollisionFree => 1.0 + 2.0 * settings.ball_step_max * loop_scale,
        };
        let mut poses = Vec::new();
        let carried = tree.carried(turns, start, &mut poses);
        let mut descent = Descent {
            closure: self,
            loop_scale,
            reach,
            carried,
            list: NeighbourList::new(scene, (lp.from, lp.to), tree.parts(turns)),
            initial_bias,
            bias_steps,
            work,
            postures: vec![start.to_vec()],
            poses,
            error: Vector6::zeros(),
            neighbours: Vec::new(),
            repulsion_gain: 0.0,
            biased: false,
        };
        let limits: Vec<(f64, f64)> = (0..start.len()).flat_map(|_| (0..3).map(range)).collect();
        let settings = inverse_kinematics::Settings {
            iterations_max: (settings.iterations_max as f64 * loop_scale) as usize,
            patience: settings.patience + bias_steps,
            ..inverse_kinematics::Settings::default()
        };
        let mut joints = start.as_flattened().to_vec();
        let (stop, _) = inverse_kinematics::solve(&mut descent, &mut joints, &limits, &settings);
        (stop == StopReason::Converged).then_some(descent.postures)
    }
}

/// The work of an iteration in forward kinematics, which take about as long.
const ITERATION_WORK: u64 = 10;

/// Weight of an overlap in the merit, beside the closure error.
const OVERLAP_WEIGHT: f64 = 10.0;

/// Returns the range of a joint of a module, rad: ±π/2 for tilts, any for gamma.
fn range(joint: usize) -> (f64, f64) {
    if joint == GAMMA { (f64::NEG_INFINITY, f64::INFINITY) } else { (-FRAC_PI_2, FRAC_PI_2) }
}

/// Returns the position nearest to `q` (rad) in the range of a joint: ±π/2 for the tilts alpha and beta, any for
/// gamma. `joint`: 0 to 2 as in [`Robot::joints`](super::robot::Robot::joints).
pub fn clamped(joint: usize, q: f64) -> f64 {
    let (low, high) = range(joint);
    q.clamp(low, high)
}

/// A descent, as the shared inverse kinematics sees it ([`inverse_kinematics::IkProblem`]).
struct Descent<'a> {
    closure: &'a LoopClosure<'a>,
    loop_scale: f64,
    /// The distance up to which neighbours matter.
    reach: f64,
    /// The shoes that the joints carry.
    carried: Carried,
    list: NeighbourList<'a>,
    initial_bias: &'a [f64],
    bias_steps: usize,
    work: &'a mut u64,
    postures: Vec<Joints>,
    /// The state at the last posture: poses by index, closure error, balls that are near each other, the gain
    /// of their repulsion, and true while the initial bias lasts.
    poses: Vec<RigidTransform>,
    error: Vector6<f64>,
    neighbours: Vec<Neighbours>,
    repulsion_gain: f64,
    biased: bool,
}

/// Number of rows that close the loop.
const CLOSURE_ROWS: usize = 6;
/// Greatest rotation error that one step is to make good, rad.
const ROTATION_STEP_MAX: f64 = 0.4;

impl IkProblem for Descent<'_> {
    fn evaluate(&mut self, q: &[f64], iteration: usize) -> Evaluation {
        let LoopClosure { lp, mode, settings, .. } = *self.closure;
        let (joints, _) = q.as_chunks::<3>();
        self.carried.poses(joints, &mut self.poses);
        *self.work += ITERATION_WORK;
        self.error = lp.error(&self.poses);
        let size = self.error.norm();
        self.neighbours = self.list.within(self.reach, &self.poses);
        let least = self.neighbours.iter().fold(f64::INFINITY, |least, n| least.min(n.distance));
        let overlap = (TOLERANCES.min_distance - least).max(0.0);
        self.repulsion_gain = match mode {
            _ if size < settings.nearly_closed && overlap == 0.0 => 0.0,
            IkMode::Endpoint => settings.endpoint_repulsion_gain,
            IkMode::CollisionFree => settings.collision_free_repulsion_gain,
        };
        self.biased = iteration < self.bias_steps;
        Evaluation {
            residual_squared: self.error.norm_squared(),
            merit: size + OVERLAP_WEIGHT * overlap,
            converged: size < settings.tol_closed && overlap == 0.0,
        }
    }

    /// Returns the six rows that close the loop: the Jacobian of the second shoe, with as much of the error
    /// as one step can make good.
    fn task(&self) -> Vec<Row> {
        let LoopClosure { lp, .. } = self.closure;
        let error = &self.error;
        let (shift, turn) = (error.fixed_rows::<3>(0).norm(), error.fixed_rows::<3>(3).norm());
        let scale = f64::min(
            1.0,
            f64::min(
                self.loop_scale / shift.max(TOLERANCES.divisor),
                ROTATION_STEP_MAX / turn.max(TOLERANCES.divisor),
            ),
        );
        let tip = self.poses[lp.to].translation;
        let mut rows: Vec<Row> = (0..CLOSURE_ROWS)
            .map(|i| Row { terms: Vec::with_capacity(lp.joints.len()), goal: error[i] * scale })
            .collect();
        for (joint, sign) in &lp.joints {
            let (axis, point) = self.tree().axis(*joint, &self.poses);
            let v = axis.cross(&(tip - point)) * *sign;
            let index = 3 * joint.module + joint.joint;
            for i in 0..3 {
                rows[i].terms.push((index, v[i]));
                rows[3 + i].terms.push((index, axis[i] * *sign));
            }
        }
        rows
    }

    /// Returns the secondary task: steps of the joints (rad) that are wanted as far as the constraints leave
    /// them open. The initial bias, plus the joint torques of the repulsion times a gain.
    fn preferred(&self, count: usize) -> Vec<f64> {
        let LoopClosure { lp, mode, settings, .. } = *self.closure;
        let bias = if self.biased { self.initial_bias } else { &[] };
        let mut task = if bias.is_empty() { vec![0.0; count] } else { bias.to_vec() };
        if self.repulsion_gain == 0.0 {
            return task;
        }
        let repulsion = Repulsion::new(&self.poses, &self.neighbours, settings.repulsion_reach);
        let joints = match mode {
            IkMode::Endpoint => lp.joints.iter().map(|(joint, _)| *joint).collect(),
            IkMode::CollisionFree => self.tree().all_joints(),
        };
        for joint in joints {
            let (axis, point) = self.tree().axis(joint, &self.poses);
            let torque = repulsion.torque(self.tree(), joint.child, &axis, &point);
            task[3 * joint.module + joint.joint] += self.repulsion_gain * torque;
        }
        task
    }

    /// Scales a step so that no joint turns too far, and in a collision-free descent no ball goes too far.
    fn shorten(&self, step: &mut [f64]) {
        let settings = self.closure.settings;
        let greatest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        let mut scale = f64::min(1.0, settings.joint_step_max / greatest.max(TOLERANCES.divisor));
        if self.closure.mode == IkMode::CollisionFree {
            let far = libm::sqrt(self.displacements(step).iter().map(Vec3::norm_squared).fold(0.0, f64::max));
            scale = scale.min(settings.ball_step_max * self.loop_scale / far.max(TOLERANCES.divisor));
        }
        step.iter_mut().for_each(|s| *s *= scale);
    }

    /// Returns the row that keeps two balls apart: the gradient of their distance, and its least change.
    fn inequality(&self, number: usize) -> Row {
        let pair = &self.neighbours[number];
        let at = self.poses[pair.b].translation;
        let between = joints_between(self.tree(), pair.a, pair.b);
        let term = |(joint, sign): &(JointRef, f64)| {
            let (axis, point) = self.tree().axis(*joint, &self.poses);
            // A turn of the joint carries b, or conversely a: the distance changes alike.
            let v = axis.cross(&(at - point)) * *sign;
            (3 * joint.module + joint.joint, pair.normal.dot(&v))
        };
        Row { terms: between.iter().map(term).collect(), goal: self.least_separation(pair) }
    }

    /// Returns the pairs of balls that a step brings too near in a collision-free descent, the worst first.
    fn violated(&self, step: &[f64], active: &[usize]) -> Vec<usize> {
        if self.closure.mode == IkMode::Endpoint || self.neighbours.is_empty() {
            return Vec::new();
        }
        let displacements = self.displacements(step);
        let far = displacements.iter().map(|v: &Vec3| v.norm()).fold(0.0, f64::max);
        let near = self.closure.settings.min_distance + 2.0 * far;
        let pairs = self.neighbours.iter().enumerate();
        let mut violated: Vec<(f64, usize)> = pairs
            .filter(|(number, pair)| pair.distance < near && !active.contains(number))
            .map(|(number, pair)| {
                let separation = pair.normal.dot(&(displacements[pair.b] - displacements[pair.a]));
                (separation - self.least_separation(pair), number)
            })
            .filter(|(slack, _)| *slack < -TOLERANCES.constraint)
            .collect();
        violated.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        violated.into_iter().map(|(_, number)| number).collect()
    }

    fn stepped(&mut self, q: &[f64]) {
        self.postures.push(q.as_chunks::<3>().0.to_vec());
    }
}

impl Descent<'_> {
    /// Returns the kinematic tree of the robot.
    fn tree(&self) -> &Tree {
        self.closure.scene.tree
    }

    /// Returns the least change of the distance of two balls in one step, in pitches; negative if they may
    /// approach.
    fn least_separation(&self, pair: &Neighbours) -> f64 {
        let missing = self.closure.settings.min_distance - pair.distance;
        if missing > 0.0 { (0.5 * missing).min(0.05) } else { missing }
    }

    /// Returns the displacement of each ball by a step of the joints, to first order, in pitches. Twists are
    /// summed from the root outwards, which is the product with the whole Jacobian in linear time.
    fn displacements(&self, step: &[f64]) -> Vec<Vec3> {
        let mut twist = vec![(Vec3::zeros(), Vec3::zeros()); self.poses.len()];
        let mut displacements = vec![Vec3::zeros(); self.poses.len()];
        for index in 1..self.poses.len() {
            let (mut v, mut w) = twist[self.tree().parent[index]];
            for joint in self.tree().joints_at(index) {
                let turn = step[3 * joint.module + joint.joint];
                if turn != 0.0 {
                    let (axis, point) = self.tree().axis(joint, &self.poses);
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

/// A repulsion of balls: prefix sums by index of the forces on balls and of their moments, so that those on a
/// subtree are differences.
struct Repulsion {
    force: Vec<Vec3>,
    moment: Vec<Vec3>,
}

impl Repulsion {
    /// Returns forces along the normals that grow linearly below the distance `reach`, in pitches as the distances.
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

    /// Returns the torque about an axis through `point` of the forces on the subtree of `index`.
    fn torque(&self, tree: &Tree, index: usize, axis: &Vec3, point: &Vec3) -> f64 {
        let end = tree.end[index];
        let force = self.force[end] - self.force[index];
        let moment = self.moment[end] - self.moment[index];
        axis.dot(&(moment - point.cross(&force)))
    }
}
