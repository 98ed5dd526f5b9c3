//! The loads of contacts and joints under given friction: those at which yielding servos, bonds and contacts are in
//! equilibrium.

use super::super::model::RangedJoint;
use super::posed::{Posed, Situation, Support};
use super::tolerances::PARAMETERS;
use super::twist;
use crate::geometry::Vec3;
use crate::optimize::solve_non_negative;
use crate::robot::dynamics::Wrench;
use crate::robot::jacobian::JointAxis;
use nalgebra::{DMatrix, DVector};

/// A bond that closes a loop: the efforts of joints by a unit force or moment along each axis, between its two sides.
pub(super) struct Loop {
    /// The efforts by a unit of each of three forces (N) and three moments (N·m), along the level axes.
    columns: [Vec<(usize, f64)>; 6],
    /// The links of its two ports, by their numbers among all links.
    pub sides: [usize; 2],
    /// The place of the bond from the centre of mass, m.
    pub p: Vec3,
}

/// Returns the loops of a robot: one for each bond that closes one.
pub(super) fn loops(posed: &Posed) -> Vec<Loop> {
    let kinematics = &posed.model.kinematics;
    let robot = posed.model.robot;
    kinematics
        .tree
        .closing
        .iter()
        .map(|&bond| {
            let declared = robot.bonds[bond];
            let sides = [declared.a, declared.b].map(|port| kinematics.port_link(robot, port));
            let p = kinematics.port_pose(robot, declared.a, &posed.poses).translation.vector;
            let columns = std::array::from_fn(|axis| {
                let unit = Vec3::ith(axis % 3, 1.0);
                let (force, moment) = if axis < 3 { (unit, Vec3::zeros()) } else { (Vec3::zeros(), unit) };
                let wrench = Wrench { force, moment };
                let back = Wrench { force: -force, moment: -moment };
                let mut efforts = posed.efforts_of(sides[0], &p, &wrench);
                efforts.extend(posed.efforts_of(sides[1], &p, &back));
                efforts
            });
            Loop { columns, sides, p }
        })
        .collect()
}

/// The stop at an end of a joint's range, near which the joint is.
pub(super) struct Stop {
    /// The joint, by [`crate::robot::JointId`].
    pub joint: usize,
    /// The sign of the effort with which it pushes the joint back: -1 at the upper end, 1 at the lower.
    pub sign: f64,
    /// The factor of the joint in the motion about its axis: 1 or -1.
    pub factor: f64,
    /// The motion that is left to it, rad or m.
    pub gap: f64,
    /// The links that it acts between, by their numbers: the one that carries, and the one that is carried.
    pub sides: [usize; 2],
    /// The axis of the joint, in level axes.
    pub axis: JointAxis,
}

impl Stop {
    /// Returns the wrench (N, N·m) of an effort of the stop on the link that is carried, with its moment about the
    /// centre of mass.
    pub(super) fn wrench(&self, effort: f64) -> Wrench {
        let effort = self.sign * self.factor * effort;
        match &self.axis {
            JointAxis::Revolute { axis, .. } => Wrench { force: Vec3::zeros(), moment: axis * effort },
            JointAxis::Prismatic { axis } => Wrench { force: axis * effort, moment: Vec3::zeros() },
        }
    }
}

/// Returns the stops that joints are at, or so near that a servo's yielding may bring them there.
pub(super) fn stops(posed: &Posed) -> Vec<Stop> {
    let near = |ranged: &RangedJoint| {
        let position = posed.joints[ranged.joint];
        let (low, high) = ranged.range;
        let ends = [(position - low, 1.0), (high - position, -1.0)];
        let (gap, sign) = ends.into_iter().find(|(gap, _)| *gap <= PARAMETERS.stop_gap_max)?;
        let step = &posed.model.kinematics.steps[ranged.step];
        let axis = step.joint_axis(&posed.poses)?;
        let RangedJoint { joint, factor, .. } = *ranged;
        Some(Stop { joint, sign, factor, gap: gap.max(0.0), sides: [step.parent, step.link], axis })
    };
    posed.model.ranged.iter().filter_map(near).collect()
}

/// The loads of contacts, joints, stops and closing bonds at an instant.
#[derive(Clone, Debug)]
pub(super) struct Loads {
    /// The normal force at each candidate, N.
    pub normal: Vec<f64>,
    /// The effort of the motor of each joint, N·m or N.
    pub efforts: Vec<f64>,
    /// The effort of each stop of [`Situation::stops`], N·m or N; not negative.
    pub stops: Vec<f64>,
    /// The wrench in each bond that closes a loop, on the link of its first port at the bond, in level axes: force (N)
    /// and moment (N·m).
    pub bonds: Vec<[f64; 6]>,
    /// The greatest imbalance of the base: of its force in height as a part of the weight, or of its moment in roll or
    /// pitch as a part of the weight times [`Situation::size`]; 0 unless the robot settles on the ground.
    pub imbalance: f64,
}

/// Returns the loads under these forces of friction at the candidates (N, in level axes); `None` where the method gives
/// up. `passive`: a flag for each candidate, each stop and six for each loop, true for what is guessed to bear; replaced by
/// the flags of what does.
pub(super) fn solve(problem: &Situation, friction: &[Vec3], passive: &mut Vec<bool>) -> Option<Loads> {
    let (contacts, stops) = (problem.candidates.len(), problem.stops.len());
    let one_sided = contacts + stops;
    let n = one_sided + 6 * problem.loops.len();
    let by_friction = twist::wrench(&problem.candidates, friction.iter().copied());
    let force = problem.base.force - by_friction.force;
    let moment = problem.base.moment - by_friction.moment;
    let mut carried = problem.efforts.clone();
    for (candidate, force) in problem.candidates.iter().zip(friction) {
        candidate.columns.iter().for_each(|(joint, column)| carried[*joint] -= column.dot(force));
    }
    let joints = carried.len();
    // Efforts of the joints by a unit of each unknown, scaled by the softness of the servos.
    let mut columns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(n);
    columns.extend(problem.candidates.iter().map(|c| c.columns.iter().map(|(j, v)| (*j, v.z)).collect()));
    columns.extend(problem.stops.iter().map(|stop| vec![(stop.joint, stop.sign)]));
    for closing in &problem.loops {
        columns.extend(closing.columns.iter().cloned());
    }
    let mut dense = DMatrix::<f64>::zeros(joints, n);
    for (column, entries) in columns.iter().enumerate() {
        for &(joint, value) in entries {
            dense[(joint, column)] += value;
        }
    }
    let soft = DVector::from_iterator(joints, problem.stiffness.iter().map(|k| 1.0 / libm::sqrt(*k)));
    let mut scaled = dense.clone();
    for joint in 0..joints {
        scaled.row_mut(joint).scale_mut(soft[joint]);
    }
    let target = DVector::from_iterator(joints, carried.iter().zip(soft.iter()).map(|(t, s)| t * s));
    let mut hessian = scaled.tr_mul(&scaled);
    let mut linear = -scaled.tr_mul(&target);
    // The balance of the base, as a penalty.
    let stiff = PARAMETERS.balance_weight / PARAMETERS.contact_stiffness;
    let size = problem.size;
    let rows = if problem.support.rests() { 3 } else { 0 };
    let balance = DMatrix::from_fn(rows, n, |row, i| match problem.candidates.get(i) {
        None => 0.0,
        Some(c) => [1.0, c.p.y / size, -c.p.x / size][row],
    });
    let wanted = [force.z, moment.x / size, moment.y / size];
    let wanted = DVector::from_column_slice(&wanted[..rows]);
    hessian += balance.tr_mul(&balance) * stiff;
    linear -= balance.tr_mul(&wanted) * stiff;
    for (i, candidate) in problem.candidates.iter().enumerate() {
        hessian[(i, i)] += 1.0 / PARAMETERS.contact_stiffness;
        linear[i] += candidate.gap;
    }
    for (i, stop) in problem.stops.iter().enumerate() {
        hessian[(contacts + i, contacts + i)] += 1.0 / PARAMETERS.stop_stiffness;
        linear[contacts + i] += stop.gap;
    }
    for i in one_sided..n {
        let shift = (i - one_sided) % 6 < 3;
        hessian[(i, i)] +=
            1.0 / if shift { PARAMETERS.bond_stiffness } else { PARAMETERS.bond_turn_stiffness };
    }
    let free: Vec<bool> = (0..n).map(|i| i >= one_sided).collect();
    let x = solve_non_negative(&hessian, &linear, &free, passive)?;
    let efforts = DVector::from_column_slice(&carried) - &dense * &x;
    let residual = if problem.support == Support::Settles { (&balance * &x - wanted).amax() } else { 0.0 };
    Some(Loads {
        normal: x.as_slice()[..contacts].to_vec(),
        efforts: efforts.as_slice().to_vec(),
        stops: x.as_slice()[contacts..one_sided].to_vec(),
        bonds: x.as_slice()[one_sided..].chunks(6).map(|w| std::array::from_fn(|i| w[i])).collect(),
        imbalance: if problem.weight > 0.0 { residual / problem.weight } else { 0.0 },
    })
}
