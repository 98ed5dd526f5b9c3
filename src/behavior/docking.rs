//! Docking and undocking: the bond that a command makes or breaks, and its turn.

use super::refusal::Reason;
use crate::geometry::Pose;
use crate::robot::{Assembly, Bond, Kinematics, PortRef, nearest_turn};

/// Returns the index of the bond that holds at a port; `None` if the port is free. `holds`: for every bond of the
/// robot, by index, true if it holds.
pub(super) fn bond_at(robot: &Assembly, holds: &[bool], port: PortRef) -> Option<usize> {
    (0..robot.bonds.len()).find(|&b| holds[b] && (robot.bonds[b].a == port || robot.bonds[b].b == port))
}

/// A docking as a command asks for it.
pub(super) struct Docked {
    /// The new bond of the second port to the first.
    pub(super) bond: Bond,
    /// The position of its hinge, rad; `None` if the connector has none.
    pub(super) hinge: Option<f64>,
    /// True if no bonds connect the two ports: the turn of the bond is 0, until it is known how the two robots stand.
    pub(super) apart: bool,
}

/// Returns the docking of port `b` to port `a`, with the allowed turn nearest to their present pose where bonds connect them.
/// `holds`: for every bond of the robot, by index, true if it holds; `joints`: positions of all joints, by the number in
/// their `JointId`, rad or m.
///
/// # Errors
/// A [`Reason`] for ports that are taken, that do not mate, or that no bonds connect though their connector has a hinge.
pub(super) fn docked(
    robot: &Assembly,
    holds: &[bool],
    joints: &[f64],
    a: PortRef,
    b: PortRef,
) -> Result<Docked, Reason> {
    free(robot, holds, a, b)?;
    let name = |port| robot.port_name(port);
    if !mate(robot, a, b) {
        return Err(Reason::NoMate { a: name(a), b: name(b) });
    }
    match between(robot, holds, joints, a, b) {
        Some(X_PQ) => {
            let (turn, hinge) = nearest_turn(robot.connector(a), &X_PQ);
            Ok(Docked { bond: Bond { a, b, turn }, hinge, apart: false })
        }
        None if robot.connector(a).hinge.is_none() => {
            Ok(Docked { bond: Bond { a, b, turn: 0 }, hinge: None, apart: true })
        }
        None => Err(Reason::Apart { a: name(a), b: name(b) }),
    }
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
