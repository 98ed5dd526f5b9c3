//! One step of forward kinematics: the pose of a link from that of its parent, across a joint or a bond.
//!
//! The pose of the child is `X_WB = X_WA · Trans(shift) · Turn · Rot(axis, q) · Trans(offset)`: the
//! axis passes the child's frame at `-offset`, which is zero for most modules and then costs nothing.

use super::library::{JointKind, ModuleType};
use crate::geometry::{Pose, Vec3, sin_cos};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion};

/// Threshold: a component of a unit axis (without unit) or of an offset (m), or an angle (rad), counts as zero if its
/// absolute value is below this, because it is then the rounding of a declared zero.
const TOL_ZERO: f64 = 1e-15;

/// The greatest number of steps over which joints follow joints that follow others.
pub(super) const MIMIC_DEPTH_MAX: usize = 16;

/// The placement of a link B against its parent A across a joint or a bond: for a revolute joint at the position q it
/// is `X_AB = Trans(shift) · turn · Rot(axis, q) · Trans(offset)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The number of the parent A among all links ([`Kinematics::link`](super::Kinematics::link)).
    pub parent: usize,
    /// The number of the link B among all links ([`Kinematics::link`](super::Kinematics::link)).
    pub link: usize,
    /// The position of the joint's axis in the parent's frame, m.
    pub shift: Vec3,
    /// The orientation `R_AB` of the child in the parent's frame with the joint at zero.
    pub turn: UnitQuaternion<f64>,
    /// The motion that the joint's position adds to the placement at zero.
    pub motion: Motion,
    /// The position of the child's origin from the axis, in the child's frame, m; zero for prismatic and fixed
    /// joints.
    pub offset: Vec3,
    drive: Drive,
    turned: bool,
    offset_from_axis: bool,
}

/// The joints and factors that give a step its position. Stored inline for the single one that nearly all
/// have, so that the steps are contiguous in memory.
#[derive(Clone, Debug, PartialEq)]
enum Drive {
    One((usize, f64)),
    /// A joint that mimics others; or, empty, one that nothing moves.
    Sum(Box<[(usize, f64)]>),
}

/// The motion of a step for a joint position in radians or metres. Turns about an axis of the frame cost half as
/// much as others, and nearly all joints have such an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// No motion: the joint is fixed.
    Fixed,
    /// A turn about +x of the child's frame, by the joint's position times this sign, 1 or -1.
    X(f64),
    /// A turn about +y of the child's frame, by the joint's position times this sign, 1 or -1.
    Y(f64),
    /// A turn about +z of the child's frame, by the joint's position times this sign, 1 or -1.
    Z(f64),
    /// A turn about this unit vector of the child's frame, by the joint's position in rad.
    Axis(Vec3),
    /// A shift along this unit vector of the parent's frame, by the joint's position in m.
    Along(Vec3),
}

impl Motion {
    /// Returns the motion of a joint about or along a unit vector, in the frame in which the vector is given. `kind`:
    /// its degree of freedom; `axis`: the vector.
    pub fn new(kind: JointKind, axis: Vec3) -> Motion {
        match kind {
            JointKind::Revolute => Motion::revolute(axis),
            JointKind::Prismatic => Motion::Along(axis),
            JointKind::Fixed => Motion::Fixed,
        }
    }

    /// Returns the rotation about `axis`, in the frame in which `axis` is given. The axis need not be of unit length
    /// but must not be zero; components below the fraction `TOL_ZERO` of its length count as zero.
    pub fn revolute(axis: Vec3) -> Motion {
        let axis = axis.normalize().map(|c| if c.abs() < TOL_ZERO { 0.0 } else { c });
        match (axis.x != 0.0, axis.y != 0.0, axis.z != 0.0) {
            (true, false, false) => Motion::X(axis.x.signum()),
            (false, true, false) => Motion::Y(axis.y.signum()),
            (false, false, true) => Motion::Z(axis.z.signum()),
            _ => Motion::Axis(axis),
        }
    }

    /// Returns the unit axis of a turn in the child's frame; `None` for slides and fixed joints.
    pub fn axis(&self) -> Option<Vec3> {
        match *self {
            Motion::X(sign) => Some(Vec3::x() * sign),
            Motion::Y(sign) => Some(Vec3::y() * sign),
            Motion::Z(sign) => Some(Vec3::z() * sign),
            Motion::Axis(axis) => Some(axis),
            Motion::Fixed | Motion::Along(_) => None,
        }
    }
}

impl Step {
    /// Returns the step from the link `parent` (A) to the link `link` (B), given by their numbers among all links and
    /// their poses with the joint at zero, in the frame J of the joint, in which `motion` has its axis. `terms` are
    /// the joints, by the number in their `JointId`, and factors whose sum is the position. `X_JA` and `X_JB`: the
    /// two poses.
    pub fn new(
        parent: usize,
        link: usize,
        X_JA: &Pose,
        X_JB: &Pose,
        motion: Motion,
        terms: Vec<(usize, f64)>,
    ) -> Step {
        let X_AJ = X_JA.inverse();
        let turn = X_AJ.rotation * X_JB.rotation;
        let X_AB = X_AJ * X_JB;
        let (motion, offset) = match (motion, motion.axis()) {
            (Motion::Along(direction), _) => (Motion::Along(X_AJ.rotation * direction), Vec3::zeros()),
            (_, Some(axis)) => {
                let R_BJ = X_JB.rotation.inverse();
                let (axis, p) = (R_BJ * axis, R_BJ * X_JB.translation.vector);
                (Motion::revolute(axis), p - axis * axis.dot(&p))
            }
            (motion, None) => (motion, Vec3::zeros()),
        };
        let offset = offset.map(|c| if c.abs() < TOL_ZERO { 0.0 } else { c });
        Step {
            parent,
            link,
            shift: X_AB.translation.vector - turn * offset,
            turn,
            motion,
            offset,
            drive: match terms[..] {
                [one] => Drive::One(one),
                _ => Drive::Sum(terms.into_boxed_slice()),
            },
            turned: turn.angle() > TOL_ZERO,
            offset_from_axis: offset != Vec3::zeros(),
        }
    }

    /// Returns the step's position, rad or m, from the positions of all joints of the assembly, by the number in their
    /// `JointId`; 0 if no joint moves it.
    #[inline]
    pub fn position(&self, joints: &[f64]) -> f64 {
        match &self.drive {
            &Drive::One((joint, factor)) => factor * joints[joint],
            Drive::Sum(terms) => terms.iter().map(|&(joint, factor)| factor * joints[joint]).sum(),
        }
    }

    /// Returns the joints, by the number in their [`JointId`](super::JointId), and factors whose sum is the step's
    /// position: one joint, unless it mimics others; none for fixed joints.
    pub fn terms(&self) -> &[(usize, f64)] {
        match &self.drive {
            Drive::One(one) => std::slice::from_ref(one),
            Drive::Sum(terms) => terms,
        }
    }

    /// Returns the world pose `X_WB` of the child from that of the parent, `X_WA`, and the positions (rad or m) of
    /// all joints of the assembly, by the number in their `JointId`. Panics if `joints` is too short.
    #[inline]
    pub fn child_pose(&self, X_WA: &Pose, joints: &[f64]) -> Pose {
        let position = if self.motion == Motion::Fixed { 0.0 } else { self.position(joints) };
        self.child_pose_at(X_WA, position)
    }

    /// Returns the world pose `X_WB` of the child from that of the parent, `X_WA`, with the step at a position (rad or
    /// m) of its own, whatever its joints are at.
    #[inline(always)]
    pub fn child_pose_at(&self, X_WA: &Pose, position: f64) -> Pose {
        let (shift, rotation) = self.displacement(X_WA.rotation, position, || sin_cos(0.5 * position));
        let mut p = X_WA.translation.vector;
        if shift != Vec3::zeros() {
            p += X_WA.rotation * shift;
        }
        if self.offset_from_axis {
            p += rotation * self.offset;
        }
        Pose::from_parts(p.into(), rotation)
    }

    /// Returns the world pose of the child as [`child_pose_at`](Self::child_pose_at) does, with its rotation as a matrix as
    /// well; `R_WA`: that of the parent's; `half`: sine and cosine of half the position of a joint that turns.
    #[inline(always)]
    pub fn child_pose_turned(
        &self,
        X_WA: &Pose,
        R_WA: &Matrix3<f64>,
        position: f64,
        half: (f64, f64),
    ) -> (Pose, Matrix3<f64>) {
        let (shift, rotation) = self.displacement(X_WA.rotation, position, || half);
        let R_WB = *rotation.to_rotation_matrix().matrix();
        let mut p = X_WA.translation.vector + R_WA * shift;
        if self.offset_from_axis {
            p += R_WB * self.offset;
        }
        (Pose::from_parts(p.into(), rotation), R_WB)
    }

    /// Returns the position of the joint's axis in the parent's frame (m) with the step at a position, rad or m, and the
    /// rotation of the child in the world; `R_WA`: that of the parent; `half`: sine and cosine of half the position of a joint
    /// that turns.
    #[inline(always)]
    fn displacement(
        &self,
        R_WA: UnitQuaternion<f64>,
        position: f64,
        half: impl FnOnce() -> (f64, f64),
    ) -> (Vec3, UnitQuaternion<f64>) {
        let rotation = if self.turned { R_WA * self.turn } else { R_WA };
        match self.motion {
            Motion::Fixed => (self.shift, rotation),
            Motion::Along(direction) => (self.shift + direction * position, rotation),
            _ => (self.shift, self.rotated(rotation, half())),
        }
    }

    /// Returns `R · Rot(axis, angle)` for sine and cosine of half the angle; an axis of the frame costs half the products.
    #[inline(always)]
    fn rotated(&self, R: UnitQuaternion<f64>, (s, c): (f64, f64)) -> UnitQuaternion<f64> {
        let (w, x, y, z) = (R.w, R.i, R.j, R.k);
        let product = match self.motion {
            Motion::X(sign) => {
                let s = sign * s;
                Quaternion::new(w * c - x * s, x * c + w * s, y * c + z * s, z * c - y * s)
            }
            Motion::Y(sign) => {
                let s = sign * s;
                Quaternion::new(w * c - y * s, x * c - z * s, y * c + w * s, z * c + x * s)
            }
            Motion::Z(sign) => {
                let s = sign * s;
                Quaternion::new(w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s)
            }
            Motion::Axis(axis) => {
                let v = axis * s;
                R.into_inner() * Quaternion::new(c, v.x, v.y, v.z)
            }
            Motion::Fixed | Motion::Along(_) => R.into_inner(),
        };
        UnitQuaternion::new_unchecked(product)
    }
}

/// Returns the terms (joint, factor) that drive a joint of a module, given by its index in its type: the joint itself,
/// or those it mimics, each once; none for a fixed joint. `first` is the number in the [`JointId`](super::JointId) of
/// the module's first joint, and the joints returned are such numbers. `kind`: the type of the module. Panics if there
/// is no such joint.
pub fn driven(kind: &ModuleType, joint: usize, first: usize) -> Vec<(usize, f64)> {
    if kind.joints[joint].kind == JointKind::Fixed {
        return vec![];
    }
    let mut terms = vec![(joint, 1.0)];
    for _ in 0..MIMIC_DEPTH_MAX {
        let mimics = terms.iter().any(|&(j, _)| kind.joints[j].mimic.is_some());
        if !mimics {
            break;
        }
        let followed = terms.iter().flat_map(|&(j, factor)| match &kind.joints[j].mimic {
            Some(followed) => followed.iter().map(|&(k, f)| (k, factor * f)).collect(),
            None => vec![(j, factor)],
        });
        // Each joint once, or the terms of joints that follow sums would multiply.
        let mut sum: Vec<(usize, f64)> = Vec::new();
        for (j, factor) in followed {
            match sum.iter_mut().find(|(known, _)| *known == j) {
                Some((_, known)) => *known += factor,
                None => sum.push((j, factor)),
            }
        }
        terms = sum;
    }
    terms.iter().map(|&(j, factor)| (first + j, factor)).collect()
}
