//! The loads of contacts and joints under given friction: those at which yielding servos, bonds and contacts are in
//! equilibrium.

use super::posed::{Posed, Situation};
use super::tolerances::PARAMETERS;
use super::twist;
use crate::geometry::Vec3;
use crate::optimize::solve_non_negative;
use crate::robot::dynamics::Wrench;
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

/// The loads of contacts, joints and closing bonds at an instant.
#[derive(Clone, Debug)]
pub(super) struct Loads {
    /// The normal force at each candidate, N.
    pub normal: Vec<f64>,
    /// The effort of each joint, N·m or N.
    pub efforts: Vec<f64>,
    /// The wrench in each bond that closes a loop, on the link of its first port at the bond, in level axes: force (N)
    /// and moment (N·m).
    pub bonds: Vec<[f64; 6]>,
    /// The greatest imbalance of the base: of its force in height as a part of the weight, or of its moment in roll or
    /// pitch as a part of the weight times [`Situation::size`]; 0 without gravity, or if a fixture holds the base.
    pub imbalance: f64,
}

/// Returns the loads under these forces of friction at the candidates (N, in level axes), with `passive` as the guess
/// of the contacts that bear; `None` where the method gives up.
pub(super) fn solve(problem: &Situation, friction: &[Vec3], passive: &mut Vec<bool>) -> Option<Loads> {
    let (contacts, loops) = (problem.candidates.len(), problem.loops.len());
    let n = contacts + 6 * loops;
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
    let rows = if problem.free { 3 } else { 0 };
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
    for i in contacts..n {
        let shift = (i - contacts) % 6 < 3;
        hessian[(i, i)] +=
            1.0 / if shift { PARAMETERS.bond_stiffness } else { PARAMETERS.bond_turn_stiffness };
    }
    let free: Vec<bool> = (0..n).map(|i| i >= contacts).collect();
    let x = solve_non_negative(&hessian, &linear, &free, passive)?;
    let efforts = DVector::from_column_slice(&carried) - &dense * &x;
    let residual = if problem.free { (&balance * &x - wanted).amax() } else { 0.0 };
    Some(Loads {
        normal: x.as_slice()[..contacts].to_vec(),
        efforts: efforts.as_slice().to_vec(),
        bonds: x.as_slice()[contacts..].chunks(6).map(|w| std::array::from_fn(|i| w[i])).collect(),
        imbalance: if problem.weight > 0.0 { residual / problem.weight } else { 0.0 },
    })
}
