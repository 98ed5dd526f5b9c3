//! The loads of contacts and joints under given friction: those at which yielding servos, bonds and contacts are in
//! equilibrium.

use super::super::model::RangedJoint;
use super::elastic_tree::{ElasticTree, LimitedMotor, Pushing, joined};
use super::posed::{Posed, Situation, Support};
use super::tolerances::PARAMETERS;
use crate::geometry::Vec3;
use crate::robot::dynamics::Wrench;
use crate::robot::jacobian::JointAxis;

/// A bond that closes a loop, and so joins two links that the tree does not.
pub(super) struct Loop {
    /// The links of the bond's ports `a` and `b`, by their numbers among all links.
    pub sides: [usize; 2],
    /// The position of port `a` from the centre of mass, in level axes, m.
    pub p: Vec3,
}

/// Returns the bonds of a robot that close loops, in the order of the tree's `closing`.
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
            Loop { sides, p }
        })
        .collect()
}

/// A mechanical stop at an end of a joint's range, which the joint is at or near.
pub(super) struct Stop {
    /// The joint, by [`crate::robot::JointId`].
    pub joint: usize,
    /// The sign of the effort with which the stop pushes the joint back: -1 at the upper end, 1 at the lower.
    pub sign: f64,
    /// The factor of the joint in the motion of its step: 1 or -1.
    pub factor: f64,
    /// The motion that is left to the joint up to the end of its range, rad or m; 0 beyond it.
    pub gap: f64,
    /// Its stiffness, N·m/rad or N/m.
    pub stiffness: f64,
    /// The links that the stop acts between, by their numbers: the parent of the joint, and its child.
    pub sides: [usize; 2],
    /// The axis of the joint, in level axes.
    pub axis: JointAxis,
}

impl Stop {
    /// Returns the wrench (N, N·m) that the stop exerts on the joint's child link, in level axes, its moment about
    /// the centre of mass; `effort`: that of the stop, N·m or N, not negative.
    pub(super) fn wrench(&self, effort: f64) -> Wrench {
        let effort = self.sign * self.factor * effort;
        match &self.axis {
            JointAxis::Revolute { axis, .. } => Wrench { force: Vec3::zeros(), moment: axis * effort },
            JointAxis::Prismatic { axis } => Wrench { force: axis * effort, moment: Vec3::zeros() },
        }
    }
}

/// Returns the stops of the joints that are within `stop_gap_max` of an end of their range, or beyond it.
pub(super) fn stops(posed: &Posed) -> Vec<Stop> {
    let near = |ranged: &RangedJoint| {
        let position = posed.joints[ranged.joint];
        let (low, high) = ranged.range;
        let ends = [(position - low, 1.0), (high - position, -1.0)];
        let (gap, sign) = ends.into_iter().find(|(gap, _)| *gap <= PARAMETERS.stop_gap_max)?;
        let step = &posed.model.kinematics.steps[ranged.step];
        let axis = step.joint_axis(&posed.poses)?;
        let stiffness = match axis {
            JointAxis::Revolute { .. } => PARAMETERS.stop_stiffness,
            JointAxis::Prismatic { .. } => PARAMETERS.slide_stop_stiffness,
        };
        let RangedJoint { joint, factor, .. } = *ranged;
        Some(Stop {
            joint,
            sign,
            factor,
            gap: gap.max(0.0),
            stiffness,
            sides: [step.parent, step.link],
            axis,
        })
    };
    posed.model.ranged.iter().filter_map(near).collect()
}

/// The loads of contacts, joints and links at an instant.
#[derive(Clone, Debug)]
pub(super) struct Loads {
    /// The normal force at each candidate, N; not negative.
    pub normal: Vec<f64>,
    /// The effort of the motor of each joint, by [`crate::robot::JointId`], N·m or N.
    pub efforts: Vec<f64>,
    /// The deflection of each joint from its planned position, rad or m.
    pub deflections: Vec<f64>,
    /// The wrench that each link needs of its joints and bonds, by its number, about the centre of mass in level axes,
    /// N and N·m: what its motion needs, less what contacts, stops and closing bonds give.
    pub wrenches: Vec<Wrench>,
    /// The greatest imbalance of the base, without unit: of its vertical force as a part of the weight, or of its
    /// moment in roll or pitch as a part of the weight times [`Situation::size`]; 0 unless the robot settles on the
    /// ground.
    pub imbalance: f64,
    /// The angle by which the base leans away from where it is placed until the ground balances it, rad
    /// ([`Displaced::lean`](super::elastic_tree::Displaced::lean)); 0 unless the robot settles on the ground.
    pub lean: f64,
}

/// Takes what a force (N) at `p` (m) on a link bears off its wrench.
fn carry(wrenches: &mut [Wrench], link: usize, p: &Vec3, force: &Vec3) {
    wrenches[link].force -= force;
    wrenches[link].moment -= p.cross(force);
}

/// Returns the wrench that each link needs, by its number, besides these forces of friction at the candidates (N, in
/// level axes).
fn under_friction(problem: &Situation, friction: &[Vec3]) -> Vec<Wrench> {
    let mut wrenches = problem.needed.clone();
    for (candidate, force) in problem.candidates.iter().zip(friction) {
        carry(&mut wrenches, candidate.link, &candidate.p, force);
    }
    wrenches
}

fn tree<'a>(problem: &'a Situation<'a>, wrenches: &[Wrench]) -> ElasticTree<'a> {
    ElasticTree::new(problem, wrenches.iter().map(|w| joined(&w.force, &w.moment)).collect())
}

/// Returns the deflection of each joint (rad or m), by [`crate::robot::JointId`], if the motors bear no more than
/// their limits; `None` where no equilibrium is found. `friction`: the force of friction at each candidate, N, in
/// level axes.
pub(super) fn sag(problem: &Situation, friction: &[Vec3], motors: Vec<LimitedMotor>) -> Option<Vec<f64>> {
    let tree = tree(problem, &under_friction(problem, friction)).limited(motors);
    Some(tree.settle(&mut Pushing::default())?.joints)
}

/// Returns the loads of a situation; `None` where no equilibrium is found. `friction`: the force of friction at each
/// candidate, N, in level axes; `pushing`: a guess which candidates and stops push, which becomes those that do.
pub(super) fn solve(problem: &Situation, friction: &[Vec3], pushing: &mut Pushing) -> Option<Loads> {
    let mut wrenches = under_friction(problem, friction);
    let tree = tree(problem, &wrenches);
    let displaced = tree.settle(pushing)?;
    let (normal, stops) = tree.forces(&displaced);
    let bonds = tree.bonds(&displaced);
    for (candidate, normal) in problem.candidates.iter().zip(&normal) {
        carry(&mut wrenches, candidate.link, &candidate.p, &(Vec3::z() * *normal));
    }
    for (closing, w) in problem.loops.iter().zip(&bonds) {
        let (force, moment) = (Vec3::from_column_slice(&w[..3]), Vec3::from_column_slice(&w[3..]));
        for (link, sign) in closing.sides.into_iter().zip([1.0, -1.0]) {
            carry(&mut wrenches, link, &closing.p, &(force * sign));
            wrenches[link].moment -= moment * sign;
        }
    }
    for (stop, effort) in problem.stops.iter().zip(&stops) {
        let Wrench { force, moment } = stop.wrench(*effort);
        for (link, sign) in stop.sides.into_iter().zip([1.0, -1.0]) {
            wrenches[link].force += force * sign;
            wrenches[link].moment += moment * sign;
        }
    }
    let mut sums = wrenches.clone();
    let kinematics = &problem.posed.model.kinematics;
    let poses = &problem.posed.poses;
    let efforts = problem.posed.dynamics.efforts(kinematics, poses, &mut sums, &Vec3::zeros());
    let base = kinematics.link(kinematics.root, 0);
    let left = &sums[base];
    let left = [left.force.z, left.moment.x / problem.size, left.moment.y / problem.size];
    let settles = problem.support == Support::Settles && problem.weight > 0.0;
    let (imbalance, lean) = match settles {
        true => (left.into_iter().fold(0.0, |m, x| x.abs().max(m)) / problem.weight, displaced.lean(base)),
        false => (0.0, 0.0),
    };
    Some(Loads { normal, efforts, deflections: displaced.joints, wrenches, imbalance, lean })
}
