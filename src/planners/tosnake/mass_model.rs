//! The gravity model of an assembly: weights of its shoes and torque limits of its joints.

use super::conversion::{JOINTS, port_name};
use super::gravity::GravityModel;
use super::refusal::NotRofi;
use super::robot::DOCKS;
use crate::geometry::{Pose, Vec3};
use crate::robot::{Assembly, ModuleType};
use nalgebra::{Matrix3, UnitQuaternion};
use std::f64::consts::PI;

/// Returns the gravity model of a robot that is held by the body of its base module, whose pose in the world is `X_WB`.
/// `gravity` is in m/s², downwards. Every link counts as a point mass at the centre of its ball, which is exact for the
/// library's module.
///
/// # Errors
/// [`NotRofi`] for the first module that has other joints or ports than a RoFI module.
#[allow(non_snake_case)]
pub(super) fn gravity_model(assembly: &Assembly, X_WB: &Pose, gravity: f64) -> Result<GravityModel, NotRofi> {
    let mut shoes = Vec::with_capacity(2 * assembly.modules.len());
    let mut limits = Vec::with_capacity(assembly.modules.len());
    // Weights by shoe (N), and torque limits by joint (N times the pitch).
    for module in 0..assembly.modules.len() {
        let kind = assembly.module_type(module);
        let beyond = beyond_gamma(kind).ok_or(NotRofi::Kind(module))?;
        let weight = |far: bool| -> f64 {
            let own = kind.links.iter().zip(&beyond).filter(|(_, beyond)| **beyond == far);
            own.map(|(link, _)| link.mass * gravity).sum()
        };
        let b_is_beyond = beyond[link_of(kind, module, DOCKS - 1).ok_or(NotRofi::Kind(module))?];
        shoes.extend([weight(!b_is_beyond), weight(b_is_beyond)]);
        let pitch = 2.0 * kind.ports[0].pose.translation.vector.norm();
        limits.push(JOINTS.map(|name| {
            let joint = kind.joints.iter().find(|joint| joint.name == name);
            joint.and_then(|joint| joint.limits.effort).unwrap_or(f64::INFINITY) / pitch
        }));
    }
    let (side, shoe) = base_shoe(assembly).ok_or(NotRofi::Kind(assembly.base))?;
    let down = shoe.transpose() * (X_WB.rotation.inverse() * -Vec3::z());
    Ok(GravityModel { held: 2 * assembly.base + side, root: assembly.base, down, shoes, limits })
}

/// Returns the shoe that the base's body carries, 0 for A and 1 for B, and the rotation of its frame against the body, from
/// the positions of its docks; `None` if the base is no RoFI module.
fn base_shoe(assembly: &Assembly) -> Option<(usize, Matrix3<f64>)> {
    let base = assembly.base;
    let kind = assembly.module_type(base);
    let holds_body = |side: &usize| link_of(kind, base, side * DOCKS / 2) == Some(0);
    let side = (0..2).find(holds_body)?;
    let at = |face: usize| {
        let name = port_name(base, side * DOCKS / 2 + face);
        kind.ports.iter().find(|port| port.name == name).map(|port| port.pose.translation.vector)
    };
    let (plus_x, minus_x, minus_z) = (at(0)?, at(1)?, at(2)?);
    let x: Vec3 = (plus_x - minus_x).normalize();
    let z: Vec3 = ((plus_x + minus_x) / 2.0 - minus_z).normalize();
    Some((side, Matrix3::from_columns(&[x, z.cross(&x), z])))
}

/// Returns the pose of the base body in the world, `X_WB`, turned by the least angle so that gravity acts along the unit vector
/// `down` in the frame of the shoe that the body carries. `None` if the base is no RoFI module.
#[allow(non_snake_case)]
pub(super) fn turned_down(assembly: &Assembly, X_WB: &Pose, down: Vec3) -> Option<Pose> {
    let (_, shoe) = base_shoe(assembly)?;
    let down = X_WB.rotation * (shoe * down);
    // A half turn has no axis of its own.
    let turn = UnitQuaternion::rotation_between(&down, &-Vec3::z())
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vec3::x_axis(), PI));
    Some(Pose::from_parts(X_WB.translation, turn * X_WB.rotation))
}

/// Returns the link that carries a dock; `None` if the module type has no such port.
fn link_of(kind: &ModuleType, module: usize, dock: usize) -> Option<usize> {
    kind.ports.iter().find(|port| port.name == port_name(module, dock)).map(|port| port.link)
}

/// Returns for each link true if it is beyond the joint gamma, seen from the body; `None` if there is no such joint.
fn beyond_gamma(kind: &ModuleType) -> Option<Vec<bool>> {
    let gamma = kind.joints.iter().position(|joint| joint.name == JOINTS[2])?;
    let mut beyond = vec![false; kind.links.len()];
    beyond[kind.joints[gamma].child] = true;
    // Transitive closure over the joints, in as many passes as there are links.
    for _ in 0..kind.links.len() {
        for joint in &kind.joints {
            beyond[joint.child] |= beyond[joint.parent];
        }
    }
    Some(beyond)
}
