//! Inverse kinematics by damped least squares (Buss 2005, *Introduction to inverse kinematics with Jacobian transpose,
//! pseudoinverse and damped least squares methods*), with joint limits, a secondary task and inequality rows.
//!
//! [`solve`] is the descent that all share. The task is given by an [`IkProblem`]: residual, rows of the
//! Jacobian, and, if there is a secondary task, a preferred change and linear inequalities. [`reach`] poses
//! the usual problem: a frame of an assembly that is to be at a pose. The planner `tosnake` poses another:
//! two docks that are to meet while balls keep apart.
//!
//! One step solves
//!
//!   minimise over Δq: |Δq − Δq₀|² + |J Δq − e|² / λ   subject to Δq within the limits, A Δq ≥ b
//!
//! where Δq₀ is the preferred change (the part of it that leaves the task alone is kept: it acts in the null space
//! of J), in the dual form `Δq = Δq₀ + Jᵀ y`, `(J Jᵀ + λ) y = e − J Δq₀`: a system of the size of the task,
//! decomposed by Cholesky ([`crate::optimize::cholesky`]). The inequalities are rows beside those of J by an
//! active-set method: violated ones are taken in, and those that would pull are dropped. A joint at its limit is
//! fixed for the rest of the step.

use super::assembly::{Assembly, JointOwner};
use super::jacobian::{LinkFrame, geometric_jacobian};
use super::kinematics::Kinematics;
use super::library::JointKind;
use super::step::{Motion, Step};
use crate::geometry::rigid_transform::rotation_vector;
use crate::geometry::{Pose, RigidTransform, Vec3};
use crate::interrupt;
use crate::optimize::cholesky::{PivotRule, SymmetricMatrix};
use nalgebra::{DMatrix, Vector6};

/// A linear condition on the changes Δq of joint positions: `Σ factor · Δq[joint] = goal` in a task, `≥ goal` in an
/// inequality.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// The terms of the sum as (index of the joint, from 0; factor). A joint may stand more than once, and its
    /// factors are then summed.
    pub terms: Vec<(usize, f64)>,
    /// The value on the right, in the unit of the factors times that of the joints.
    pub goal: f64,
}

/// The value of a problem of inverse kinematics at some joint positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// The squared norm of the residual of the task, in the squared unit of its rows: it sets the damping.
    pub residual_squared: f64,
    /// The figure that is to become less from iteration to iteration, not negative: residual and violations of
    /// inequalities together.
    pub merit: f64,
    /// True where the task is fulfilled to the problem's tolerance.
    pub converged: bool,
}

/// The problem that [`solve`] solves. Joints are numbered from 0 as the problem chooses, positions are in rad or m;
/// every method after [`evaluate`](IkProblem::evaluate) is about the positions given there last.
pub trait IkProblem {
    /// Evaluates the problem at the joint positions `q` (rad or m, one for every joint), for its own result and for
    /// the other methods; `iteration` counts from 0.
    fn evaluate(&mut self, q: &[f64], iteration: usize) -> Evaluation;

    /// Returns the rows of the task, `J Δq = e` with one row for each component of the residual e (wanted less
    /// found), cut to an amount that one step can correct.
    fn task(&self) -> Vec<Row>;

    /// Returns the preferred change Δq₀ (rad or m) of every joint, the secondary task, for `count` joints; none (all
    /// 0) by default.
    fn preferred(&self, count: usize) -> Vec<f64> {
        vec![0.0; count]
    }

    /// Shortens a change of the joint positions (rad or m, one entry for every joint) in place to a length for which
    /// the linear model holds.
    fn shorten(&self, change: &mut [f64]);

    /// Returns the inequality of a number, one of those that [`violated`](IkProblem::violated) returns: `Σ factor ·
    /// Δq ≥ goal`.
    fn inequality(&self, number: usize) -> Row;

    /// Returns the numbers of the inequalities that a change (rad or m, one entry for every joint) violates by more
    /// than a tolerance and that are not among the `active` ones, the worst first.
    fn violated(&self, change: &[f64], active: &[usize]) -> Vec<usize>;

    /// Receives the joint positions (rad or m) after a step; does nothing by default.
    fn stepped(&mut self, _q: &[f64]) {}
}

/// The limits and weights of a descent of inverse kinematics. The defaults are for one frame of a chain ([`reach`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The greatest number of iterations of the descent. Default 200.
    pub iterations_max: usize,
    /// The greatest number of iterations in a row without [`progress`](Settings::progress); after one more the descent
    /// counts as stalled. Default 25.
    pub patience: usize,
    /// The fraction of the best merit so far below which a merit counts as progress, 0 to 1. Default 0.9.
    pub progress: f64,
    /// The factor of the damping λ that is added to `J Jᵀ`: λ is this times the squared residual of the task, at most
    /// this itself (Levenberg–Marquardt damping after Sugihara 2011): strong far away, where the linear model is poor,
    /// and gone near the solution. Default 1e-4.
    pub damping: f64,
    /// The least damping λ, in the unit of `J Jᵀ`. Default 1e-12.
    pub damping_min: f64,
    /// The fraction, without unit, of the trace of `J Jᵀ` that is added to λ, against rounding where J is singular.
    /// Default 1e-10.
    pub damping_of_trace: f64,
    /// The damping of inequality rows, in the unit of `A Aᵀ`. Default 1e-6.
    pub damping_inequality: f64,
    /// The greatest number of rounds of the active-set method in one step. Default 12.
    pub rounds_max: usize,
    /// The greatest number of inequality rows that are active at once. Default 100.
    pub active_max: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            iterations_max: 200,
            patience: 25,
            progress: 0.9,
            damping: 1e-4,
            damping_min: 1e-12,
            damping_of_trace: 1e-10,
            damping_inequality: 1e-6,
            rounds_max: 12,
            active_max: 100,
        }
    }
}

/// The reason that a descent ended; only [`StopReason::Converged`] means that the goal is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// The descent converged: the task is fulfilled.
    Converged,
    /// The descent stalled: the merit made no progress for as long as the settings allow, at a local minimum, a
    /// singular posture, or limits.
    Stalled,
    /// The descent used all iterations that the settings allow.
    IterationLimit,
    /// The goal is out of reach: farther from the held link than the links between reach. Nothing was tried.
    OutOfReach,
    /// Bonds do not connect the frame with the held link; nothing was tried.
    NotConnected,
}

/// Threshold: the least pivot of the decomposition of `J Jᵀ + λ`, in the unit of the matrix; lesser ones, which are
/// nothing but rounding, are raised to it.
const TOL_PIVOT: f64 = 1e-12;

/// Solves a problem of inverse kinematics: changes `q` by damped least squares (Buss 2005), a local search, until the
/// problem is solved, or not. Returns (reason, steps): the reason that it ended, and the number of steps taken; `q`
/// holds the last positions in any case. `limits` are the (least, greatest) position of every joint, rad or m, of
/// which infinite ones are allowed; every step clamps `q` to them, but a start outside of them that already solves the
/// problem is returned as it is. `settings`: the limits and weights of the descent. Panics if `q` and `limits` differ
/// in length, or a least position is above the greatest.
pub fn solve(
    problem: &mut dyn IkProblem,
    q: &mut [f64],
    limits: &[(f64, f64)],
    settings: &Settings,
) -> (StopReason, usize) {
    assert_eq!(q.len(), limits.len(), "limits for every joint");
    let (mut best, mut since) = (f64::INFINITY, 0);
    for iteration in 0..settings.iterations_max {
        interrupt::checkpoint();
        let state = problem.evaluate(q, iteration);
        if state.converged {
            return (StopReason::Converged, iteration);
        }
        if state.merit < settings.progress * best {
            (best, since) = (state.merit, 0);
        } else {
            since += 1;
            if since > settings.patience {
                return (StopReason::Stalled, iteration);
            }
        }
        let change = step(problem, q, limits, state.residual_squared, settings);
        for ((q, change), limits) in q.iter_mut().zip(&change).zip(limits) {
            *q = (*q + change).clamp(limits.0, limits.1);
        }
        problem.stepped(q);
    }
    (StopReason::IterationLimit, settings.iterations_max)
}

/// Returns one step: damped least squares under the limits and the inequalities, by the active-set method.
fn step(
    problem: &dyn IkProblem,
    q: &[f64],
    limits: &[(f64, f64)],
    residual_squared: f64,
    settings: &Settings,
) -> Vec<f64> {
    let mut rows = problem.task();
    let task = rows.len();
    let preferred = problem.preferred(q.len());
    let damping = settings.damping * residual_squared.min(1.0) + settings.damping_min;
    let mut fixed = vec![false; q.len()];
    let mut active: Vec<usize> = Vec::new();
    let mut change = vec![0.0; q.len()];
    for round in 0..settings.rounds_max {
        // The step for the rows that are active now.
        rows.truncate(task);
        rows.extend(active.iter().map(|&number| problem.inequality(number)));
        let (solved, multipliers) = damped_least_squares(&rows, task, &preferred, &fixed, damping, settings);
        change = solved;
        problem.shorten(&mut change);
        if round + 1 == settings.rounds_max {
            break;
        }
        // Inequalities with a negative multiplier would be kept by pulling: they are dropped.
        let mut pushing = multipliers[task..].iter().map(|multiplier| *multiplier >= 0.0);
        let before = active.len();
        active.retain(|_| pushing.next().unwrap_or(true));
        let mut changed = active.len() != before;
        // Violated ones are taken in, the worst first.
        let room = settings.active_max.saturating_sub(active.len());
        for number in problem.violated(&change, &active).into_iter().take(room) {
            active.push(number);
            changed = true;
        }
        // Joints that the step would take beyond a limit are fixed where they are.
        for (index, fixed) in fixed.iter_mut().enumerate() {
            let wanted = q[index] + change[index];
            if !*fixed && wanted.clamp(limits[index].0, limits[index].1) != wanted {
                *fixed = true;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    change
}

/// Returns the change nearest to the preferred one that meets the rows, the first `task` of them damped, by joints that
/// are not fixed; with the multipliers of the rows.
fn damped_least_squares(
    rows: &[Row],
    task: usize,
    preferred: &[f64],
    fixed: &[bool],
    damping: f64,
    settings: &Settings,
) -> (Vec<f64>, Vec<f64>) {
    let count = preferred.len();
    let mut dense = vec![0.0; rows.len() * count];
    for (row, out) in rows.iter().zip(dense.chunks_mut(count.max(1))) {
        for &(joint, factor) in row.terms.iter().filter(|(joint, _)| !fixed[*joint]) {
            out[joint] += factor;
        }
    }
    // J Jᵀ, and what the preferred change leaves to do.
    let mut gram = SymmetricMatrix::dense(rows.len());
    let mut right = vec![0.0; rows.len()];
    for (i, row) in rows.iter().enumerate() {
        let sums = gram.row_mut(i);
        for &(joint, _) in &row.terms {
            let factor = dense[i * count + joint];
            if factor == 0.0 {
                continue;
            }
            for (j, sum) in sums.iter_mut().enumerate() {
                *sum += factor * dense[j * count + joint];
            }
        }
        let done = row.terms.iter().map(|&(joint, _)| dense[i * count + joint] * preferred[joint]);
        right[i] = row.goal - done.sum::<f64>();
    }
    let trace = gram.trace().max(TOL_TRACE);
    for i in 0..rows.len() {
        let damped = damping + settings.damping_of_trace * trace;
        gram.add(i, i, if i < task { damped } else { settings.damping_inequality });
    }
    if let Some(factor) = gram.cholesky(PivotRule::Raise(TOL_PIVOT)) {
        factor.solve(&mut right);
    }
    let mut change: Vec<f64> =
        preferred.iter().zip(fixed).map(|(p, fixed)| if *fixed { 0.0 } else { *p }).collect();
    for (i, row) in rows.iter().enumerate() {
        for &(joint, _) in &row.terms {
            change[joint] += dense[i * count + joint] * right[i];
        }
    }
    (change, right)
}

/// Threshold: the least trace of `J Jᵀ` that damping is computed from, in the unit of the matrix, so that a task that
/// no joint moves is damped, too.
const TOL_TRACE: f64 = 1e-9;

/// The part of a pose that is to be reached: the pose, or the position of its origin alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TaskSpace {
    /// The whole pose, origin and orientation: six rows.
    Pose,
    /// The position of the origin alone: three rows.
    Position,
}

/// The task of [`reach`]: a frame of an assembly that is to be at a pose.
pub struct Reach<'a> {
    /// The robot that the frame is part of.
    pub robot: &'a Assembly,
    /// The kinematics of the robot, compiled for the bonds that hold.
    pub kinematics: &'a Kinematics,
    /// The frame F that is to be moved, fixed to a link.
    pub frame: LinkFrame,
    /// The index in [`Assembly::modules`] of the module whose body stays where it is, and the world pose of that
    /// body.
    pub base: (usize, Pose),
    /// The pose in the world at which the frame is to be, `X_WF`.
    pub goal: Pose,
    /// The part of the goal that is to be reached: the whole pose, or the position alone.
    pub task_space: TaskSpace,
    /// Positions that joints are drawn to as far as the goal allows (secondary task), rad or m, one for every joint of
    /// the assembly, by the number in its `JointId`; `None`: joints stay near where they are.
    pub rest: Option<&'a [f64]>,
    /// The errors up to which the goal counts as reached: of the origin, m, and of the orientation, rad.
    pub tolerance: (f64, f64),
}

/// The result of [`reach`]: the last joint positions, whether or not they reach the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// The positions of all joints, by the number in their [`super::JointId`], rad or m; every step keeps them within
    /// the joints' limits.
    pub joints: Vec<f64>,
    /// The reason that the descent ended; only [`StopReason::Converged`] means that the goal is reached.
    pub stop: StopReason,
    /// The number of steps taken by the descent; 0 if nothing was tried.
    pub iterations: usize,
    /// The distance of the frame's origin from that of the goal at the end, m; without meaning for
    /// [`StopReason::NotConnected`].
    pub distance: f64,
    /// The angle between the orientations of frame and goal at the end, rad, 0 to π, also if only the position is to
    /// be reached; without meaning for [`StopReason::NotConnected`].
    pub angle: f64,
}

/// The greatest change of a joint in one iteration: rad, or m for a slide.
const CHANGE_MAX: f64 = 0.2;

/// The fraction of the displacement to the rest positions that is preferred in one step.
const REST_GAIN: f64 = 0.1;

/// The greatest angle that one step corrects, rad.
const ANGLE_STEP_MAX: f64 = 0.4;

/// Searches for joint positions (rad or m) that bring a frame of an assembly to a pose, by damped least squares (Buss
/// 2005) from those of `start`, one for every joint of the assembly, by the number in its `JointId`. Being local, the
/// search may miss a solution. Fixed, passive and mimicking joints are not commanded; the limits of mimicking joints
/// are not regarded, nor collisions, nor bonds that close loops. `task`: the robot, the frame and its goal;
/// `settings`: the limits and weights of the descent. Panics if `start` has too few positions.
pub fn reach(task: &Reach, start: &[f64], settings: &Settings) -> Reached {
    let mut joints = start.to_vec();
    let held = task.kinematics.link(task.base.0, 0);
    let path = task.kinematics.path(held, task.frame.link);
    let limits = limits(task.robot, start);
    let length = path.as_deref().map_or(0.0, |path| chain_length(task, path, &limits));
    let mut problem = FrameProblem {
        task,
        held,
        limits: &limits,
        scale: if length.is_finite() && length > 0.0 { length } else { 1.0 },
        q: start.to_vec(),
        poses: vec![Pose::identity(); task.kinematics.link_count()],
        jacobian: DMatrix::zeros(6, joints.len()),
        error: Vector6::zeros(),
    };
    let (stop, iterations) = if path.is_none() {
        (StopReason::NotConnected, 0)
    } else if (task.goal.translation.vector - task.base.1.translation.vector).norm()
        > length + task.tolerance.0
    {
        (StopReason::OutOfReach, 0)
    } else {
        solve(&mut problem, &mut joints, &limits, settings)
    };
    problem.update(&joints);
    let (distance, angle) =
        (problem.error.fixed_rows::<3>(0).norm(), problem.error.fixed_rows::<3>(3).norm());
    Reached { joints, stop, iterations, distance, angle }
}

/// Returns the range of every joint that takes commands (rad or m); the others stay where they are.
fn limits(robot: &Assembly, start: &[f64]) -> Vec<(f64, f64)> {
    let of = |(owner, q): (JointOwner, &f64)| {
        let range = match owner {
            JointOwner::Bond(bond) => robot.hinge(bond).and_then(|hinge| hinge.limits.range),
            JointOwner::Module { module, joint } => {
                let joint = &robot.module_type(module).joints[joint];
                if joint.kind == JointKind::Fixed || joint.passive || joint.mimic.is_some() {
                    return (*q, *q);
                }
                joint.limits.range
            }
        };
        range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY))
    };
    robot.joints().zip(start).map(of).collect()
}

/// Returns a bound on the distance from the held link's origin to the frame's for all joint positions, m: the sum of
/// the distances from axis to axis within each link, and of the travels of slides.
fn chain_length(task: &Reach, path: &[usize], limits: &[(f64, f64)]) -> f64 {
    let (mut length, mut last) = (0.0, Vec3::zeros());
    for pair in path.windows(2) {
        let (step, sign) = task.kinematics.step_between(pair[0], pair[1]);
        // The point of the axis that both links carry, in the frame of the one and of the other.
        let (in_parent, in_child) = (step.shift, -step.offset);
        let (here, there) = if sign > 0.0 { (in_parent, in_child) } else { (in_child, in_parent) };
        length += (here - last).norm() + travel(step, limits);
        last = there;
    }
    length + (task.frame.X_LF.translation.vector - last).norm()
}

/// Returns the greatest distance by which a slide can be off its zero, m; 0 for other joints.
fn travel(step: &Step, limits: &[(f64, f64)]) -> f64 {
    let Motion::Along(_) = step.motion else { return 0.0 };
    let most = |&(joint, factor): &(usize, f64)| {
        let (low, high) = limits[joint];
        factor.abs() * low.abs().max(high.abs())
    };
    step.terms().iter().map(most).sum()
}

struct FrameProblem<'a> {
    task: &'a Reach<'a>,
    held: usize,
    limits: &'a [(f64, f64)],
    /// The length, m, by which translations are divided, so that they weigh as angles do.
    scale: f64,
    q: Vec<f64>,
    poses: Vec<Pose>,
    jacobian: DMatrix<f64>,
    /// Wanted less found: translation (m), rotation vector (rad), in the world.
    error: Vector6<f64>,
}

impl FrameProblem<'_> {
    fn update(&mut self, q: &[f64]) {
        let (base, X_WB) = self.task.base;
        self.q.copy_from_slice(q);
        if let Some(jacobian) = self.moved(base, &X_WB) {
            self.jacobian = jacobian;
        }
        let found = self.task.frame.pose(&self.poses);
        let apart = self.task.goal.translation.vector - found.translation.vector;
        let turn = RigidTransform::from(&Pose::from_parts(
            Vec3::zeros().into(),
            self.task.goal.rotation * found.rotation.inverse(),
        ));
        let turn = rotation_vector(&turn.rotation);
        self.error = Vector6::new(apart.x, apart.y, apart.z, turn.x, turn.y, turn.z);
    }

    fn moved(&mut self, base: usize, X_WB: &Pose) -> Option<DMatrix<f64>> {
        self.task.kinematics.link_poses_from(base, &self.q, X_WB, &mut self.poses);
        geometric_jacobian(self.task.kinematics, &self.poses, &self.task.frame, self.held)
    }

    fn rows(&self) -> usize {
        match self.task.task_space {
            TaskSpace::Pose => 6,
            TaskSpace::Position => 3,
        }
    }
}

impl IkProblem for FrameProblem<'_> {
    fn evaluate(&mut self, q: &[f64], _iteration: usize) -> Evaluation {
        self.update(q);
        let (distance, turn) = (self.error.fixed_rows::<3>(0).norm(), self.error.fixed_rows::<3>(3).norm());
        let turn = if self.task.task_space == TaskSpace::Pose { turn } else { 0.0 };
        let residual_squared = (distance / self.scale) * (distance / self.scale) + turn * turn;
        let converged = distance <= self.task.tolerance.0 && turn <= self.task.tolerance.1;
        Evaluation { residual_squared, merit: libm::sqrt(residual_squared), converged }
    }

    fn task(&self) -> Vec<Row> {
        let (distance, turn) = (self.error.fixed_rows::<3>(0).norm(), self.error.fixed_rows::<3>(3).norm());
        let cut =
            [self.scale / distance.max(f64::MIN_POSITIVE), ANGLE_STEP_MAX / turn.max(f64::MIN_POSITIVE)];
        let row = |i: usize| {
            let unit = if i < 3 { 1.0 / self.scale } else { 1.0 };
            let free = |joint: &usize| self.limits[*joint].0 < self.limits[*joint].1;
            let moving = (0..self.q.len()).filter(free);
            let terms = moving.map(|joint| (joint, unit * self.jacobian[(i, joint)]));
            Row {
                terms: terms.filter(|(_, factor)| *factor != 0.0).collect(),
                goal: unit * self.error[i] * cut[i / 3].min(1.0),
            }
        };
        (0..self.rows()).map(row).collect()
    }

    fn preferred(&self, count: usize) -> Vec<f64> {
        let Some(rest) = self.task.rest else { return vec![0.0; count] };
        let free = |joint: usize| self.limits[joint].0 < self.limits[joint].1;
        let toward = |joint: usize| if free(joint) { REST_GAIN * (rest[joint] - self.q[joint]) } else { 0.0 };
        (0..count).map(toward).collect()
    }

    fn shorten(&self, change: &mut [f64]) {
        let greatest = change.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let part = (CHANGE_MAX / greatest.max(f64::MIN_POSITIVE)).min(1.0);
        change.iter_mut().for_each(|c| *c *= part);
    }

    fn inequality(&self, _number: usize) -> Row {
        Row::default()
    }

    fn violated(&self, _change: &[f64], _active: &[usize]) -> Vec<usize> {
        Vec::new()
    }
}
