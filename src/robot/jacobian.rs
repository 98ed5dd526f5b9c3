//! The geometric Jacobian of a frame on a link: its velocity for unit velocities of the joints (Siciliano et al.,
//! *Robotics* 2009, sec. 3.1).

use super::assembly::{Assembly, PortRef};
use super::kinematics::Kinematics;
use super::step::{Motion, Step};
use crate::geometry::{Pose, Vec3};
use nalgebra::{DMatrix, Matrix3, Matrix6};

/// A frame that is fixed to a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkFrame {
    /// The number of the link among all links ([`Kinematics::link`]).
    pub link: usize,
    /// The pose of the frame F in the frame of its link, `X_LF`, in metres.
    pub X_LF: Pose,
}

impl LinkFrame {
    /// Returns the frame of a link itself, given by its number among all links ([`Kinematics::link`]).
    pub fn of_link(link: usize) -> LinkFrame {
        LinkFrame { link, X_LF: Pose::identity() }
    }

    /// Returns the frame of a port: origin on the mating face, +x outward, +z up. `robot`: the assembly;
    /// `kinematics`: the kinematics of the same robot. Panics if the assembly has no such port.
    pub fn of_port(robot: &Assembly, kinematics: &Kinematics, port: PortRef) -> LinkFrame {
        let X_LF = robot.module_type(port.module).ports[port.port].pose;
        LinkFrame { link: kinematics.port_link(robot, port), X_LF }
    }

    /// Returns the world pose `X_WF` of the frame; `poses`: the world poses of all links, by their numbers
    /// ([`Kinematics::link`]). Panics if that of its link is missing.
    pub fn pose(&self, poses: &[Pose]) -> Pose {
        poses[self.link] * self.X_LF
    }
}

/// The axis of a joint in the world, and the kind of motion of the joint about or along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointAxis {
    /// A turn about the line through `point` (m) along the unit vector `axis`, by the right-hand rule.
    Revolute {
        /// The unit vector along the line, in the world.
        axis: Vec3,
        /// A point on the line, in the world, m.
        point: Vec3,
    },
    /// A shift along the unit vector `axis`.
    Prismatic {
        /// The unit vector of the shift, in the world.
        axis: Vec3,
    },
}

impl JointAxis {
    /// Returns the velocity, in the world, of a carried frame with its origin at `p` (m) for a joint velocity of 1
    /// rad/s or 1 m/s, as (linear, angular): in m/s and rad/s.
    #[inline(always)]
    pub fn velocity(&self, p: &Vec3) -> (Vec3, Vec3) {
        match self {
            JointAxis::Revolute { axis, point } => (axis.cross(&(p - point)), *axis),
            JointAxis::Prismatic { axis } => (*axis, Vec3::zeros()),
        }
    }
}

impl Step {
    /// Returns the axis, in the world, about or along which this step moves its child against its parent as its
    /// position grows; `None` where the joint is fixed. `poses` are the world poses of all links, by their numbers
    /// ([`Kinematics::link`]).
    pub fn joint_axis(&self, poses: &[Pose]) -> Option<JointAxis> {
        self.axis_between(&poses[self.parent], &poses[self.link])
    }

    /// Returns the axis as [`joint_axis`](Self::joint_axis) does, from the world poses of the parent and the child.
    pub fn axis_between(&self, X_WA: &Pose, X_WB: &Pose) -> Option<JointAxis> {
        match (self.motion, self.motion.axis()) {
            (Motion::Along(direction), _) => Some(JointAxis::Prismatic { axis: X_WA.rotation * direction }),
            (_, Some(axis)) => {
                let point = X_WB.transform_point(&(-self.offset).into()).coords;
                Some(JointAxis::Revolute { axis: X_WB.rotation * axis, point })
            }
            (_, None) => None,
        }
    }

    /// Returns the axis as [`axis_between`](Self::axis_between) does; `R_WB`: the rotation of the child's pose as a matrix.
    #[inline(always)]
    pub fn axis_turned(&self, X_WA: &Pose, X_WB: &Pose, R_WB: &Matrix3<f64>) -> Option<JointAxis> {
        let axis = match self.motion {
            Motion::Along(direction) => {
                return Some(JointAxis::Prismatic { axis: X_WA.rotation * direction });
            }
            Motion::Fixed => return None,
            Motion::X(sign) => R_WB.column(0) * sign,
            Motion::Y(sign) => R_WB.column(1) * sign,
            Motion::Z(sign) => R_WB.column(2) * sign,
            Motion::Axis(axis) => R_WB * axis,
        };
        Some(JointAxis::Revolute { axis, point: X_WB.translation.vector - R_WB * self.offset })
    }
}

/// Returns the geometric Jacobian `J` (6 × n; Siciliano et al., *Robotics*, 2009, sec. 3.1) of a frame F while the
/// link of number `held` stays where it is; `None` if bonds do not connect the two, so that joints do not determine
/// their relative pose. `poses`: the world poses of all links, by their numbers. `kinematics`: the kinematics of the
/// robot.
///
/// `J · q̇` is the velocity of F: rows 0 to 2 the linear velocity of its origin (m/s), rows 3 to 5 its angular
/// velocity (rad/s), both in the frame of `poses`, the world. Columns are the joints of the assembly by the number in
/// their [`super::JointId`], q̇ in rad/s or m/s. Columns of joints off the path between the two links, of fixed joints
/// and of mimics are zero; motions of mimics are in the columns of the joints that they follow. Bonds that close loops
/// are not regarded.
pub fn geometric_jacobian(
    kinematics: &Kinematics,
    poses: &[Pose],
    frame: &LinkFrame,
    held: usize,
) -> Option<DMatrix<f64>> {
    let origin = frame.pose(poses).translation.vector;
    let mut jacobian = DMatrix::zeros(6, kinematics.joint_count());
    for pair in kinematics.path(held, frame.link)?.windows(2) {
        let (step, sign) = kinematics.step_between(pair[0], pair[1]);
        let Some(axis) = step.joint_axis(poses) else { continue };
        let (linear, angular) = axis.velocity(&origin);
        for &(joint, factor) in step.terms() {
            let mut column = jacobian.column_mut(joint);
            let mut rows = column.fixed_rows_mut::<3>(0);
            rows += linear * (sign * factor);
            let mut rows = column.fixed_rows_mut::<3>(3);
            rows += angular * (sign * factor);
        }
    }
    Some(jacobian)
}

/// Returns the six columns of the Jacobian of a frame with its origin at `p_WF` (m, in the world) that belong to a
/// floating base with its origin at `p_WB` (m, in the world), which carries it: for the base's linear velocity (three
/// columns), then its angular velocity, in the world. Rows are those of [`geometric_jacobian`].
pub fn base_jacobian(p_WF: &Vec3, p_WB: &Vec3) -> Matrix6<f64> {
    let mut jacobian = Matrix6::identity();
    jacobian.fixed_view_mut::<3, 3>(0, 3).copy_from(&-(p_WF - p_WB).cross_matrix());
    jacobian
}
