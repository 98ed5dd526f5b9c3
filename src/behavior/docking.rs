//! Docking and undocking: the bond that a command makes or breaks, and its turn.

use super::refusal::Reason;
use super::tolerances::TOLERANCES;
use crate::geometry::Pose;
use crate::geometry::pose::turned;
use crate::robot::{Assembly, Bond, Kinematics, PortRef};
use std::f64::consts::{PI, TAU};

/// Returns the index of the bond that holds at a port; `None` if the port is free. `holds`: for every bond of the
/// robot, by index, true if it holds.
pub(super) fn bond_at(robot: &Assembly, holds: &[bool], port: PortRef) -> Option<usize> {
    (0..robot.bonds.len()).find(|&b| holds[b] && (robot.bonds[b].a == port || robot.bonds[b].b == port))
}

/// Returns (bond, position): a new bond of port `b` to port `a`, with the allowed turn nearest to their present pose,
/// and the position of its hinge in rad, `None` if the connector has no hinge. `holds`: for every bond of the robot,
/// by index, true if it holds; `joints`: positions of all joints, by the number in their `JointId`, rad or m.
///
/// # Errors
/// A [`Reason`] for ports that are taken, that do not mate, or whose parts of the robot no bonds connect.
pub(super) fn docked(
    robot: &Assembly,
    holds: &[bool],
    joints: &[f64],
    a: PortRef,
    b: PortRef,
) -> Result<(Bond, Option<f64>), Reason> {
    free(robot, holds, a, b)?;
    let name = |port| robot.port_name(port);
    if !mate(robot, a, b) {
        return Err(Reason::NoMate { a: name(a), b: name(b) });
    }
    let X_PQ = between(robot, holds, joints, a, b).ok_or(Reason::Apart { a: name(a), b: name(b) })?;
    Ok(nearest(robot, a, b, &X_PQ))
}

/// Checks that nothing is docked at two ports.
///
/// # Errors
/// [`Reason::PortTaken`] for the first at which something is.
pub(super) fn free(robot: &Assembly, holds: &[bool], a: PortRef, b: PortRef) -> Result<(), Reason> {
    for port in [a, b] {
        if let Some(bond) = bond_at(robot, holds, port).map(|i| robot.bonds[i]) {
            let other = if bond.a == port { bond.b } else { bond.a };
            return Err(Reason::PortTaken { port: robot.port_name(port), by: robot.port_name(other) });
        }
    }
    Ok(())
}

/// Returns true if two ports belong to different modules and the connector of `a` states that of `b` among those that
/// it mates with.
pub(super) fn mate(robot: &Assembly, a: PortRef, b: PortRef) -> bool {
    let own = robot.module_type(b.module).ports[b.port].connector;
    a.module != b.module && robot.connector(a).mates.contains(&own)
}

/// Returns the pose of port `b` in the frame of port `a`, `X_PQ`; `None` where no bonds connect them.
fn between(robot: &Assembly, holds: &[bool], joints: &[f64], a: PortRef, b: PortRef) -> Option<Pose> {
    let kinematics = Kinematics::new(robot, holds, a.module);
    if kinematics.tree.loose.contains(&b.module) {
        return None;
    }
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(joints, &Pose::identity(), &mut poses);
    let X_RP = kinematics.port_pose(robot, a, &poses);
    Some(X_RP.inverse() * kinematics.port_pose(robot, b, &poses))
}

/// Returns the bond with the allowed turn that is nearest to the pose of the ports, and its hinge's position,
/// rad.
fn nearest(robot: &Assembly, a: PortRef, b: PortRef, X_PQ: &Pose) -> (Bond, Option<f64>) {
    let connector = robot.connector(a);
    // The least angle wins; of equals the smallest turn.
    let mut best = (f64::INFINITY, 0, None);
    for turn in 0..connector.turns {
        let angle = f64::from(turn) * TAU / f64::from(connector.turns);
        let mated = turned(nalgebra::Vector3::z(), PI) * turned(nalgebra::Vector3::x(), angle);
        let left = X_PQ * mated.inverse();
        let hinge = connector.hinge.as_ref().map(|h| twist(&left, &h.axis));
        let rest = match (&connector.hinge, hinge) {
            (Some(h), Some(q)) => turned(h.axis, q).inverse() * left,
            _ => left,
        };
        let off = rest.rotation.angle();
        if off < best.0 - TOLERANCES.turn_tie {
            best = (off, turn, hinge);
        }
    }
    (Bond { a, b, turn: best.1 }, best.2)
}

/// Returns the angle of the turn about an axis that comes nearest to a rotation, rad.
fn twist(pose: &Pose, axis: &crate::geometry::Vec3) -> f64 {
    let along = pose.rotation.imag().dot(axis) / axis.norm();
    let angle = 2.0 * libm::atan2(along, pose.rotation.w);
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}
