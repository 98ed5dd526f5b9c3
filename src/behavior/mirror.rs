//! Mirror images of behaviours: for every joint the one on the other side of the robot, and the sign of
//! its positions there.
//!
//! They are found from geometry alone, with every joint at zero: the plane goes through the mean of the centres of mass
//! of the links that joints move, parallel to two axes of the base's frame; the image of a joint is the joint of its
//! type whose child link and axis are at the mirrored positions.

use super::tolerances::TOLERANCES;
use crate::geometry::{Pose, Vec3};
use crate::plan::visit::{Graph, has_contracts, rewritten};
use crate::plan::{Action, Command, Condition, Node, Signal, Target};
use crate::robot::{Assembly, JointId, JointKind, JointOwner, Kinematics};
use std::sync::Arc;

/// A mirror plane through the middle of the robot, along two axes of the base's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// The plane along the x and y axes: left stays left, up becomes down.
    XY,
    /// The plane along the y and z axes: front becomes back.
    YZ,
    /// The plane along the x and z axes: left becomes right.
    XZ,
}

/// The reason why a behaviour has no mirror image.
#[derive(Clone, Debug, PartialEq)]
pub enum MirrorError {
    /// A joint, given by its path name, of which no joint is the mirror image.
    Joint(String),
    /// A command or condition about docking, which has no mirror image.
    Docking,
    /// A motion that is stated by its goal, given by the name of the built-in that makes it.
    Goal(&'static str),
    /// A contract, whose condition is about the robot as it stands.
    Contract,
    /// A condition on the distance of ports or on modules, of which no image is known.
    Sensing,
}

impl std::fmt::Display for MirrorError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            MirrorError::Joint(name) => write!(f, "no joint is the mirror image of `{name}`"),
            MirrorError::Docking => write!(f, "docking has no mirror image"),
            MirrorError::Goal(name) => {
                write!(f, "`{name}` has no mirror image: what joints do is not known here")
            }
            MirrorError::Contract => {
                write!(f, "a behaviour with a contract has no mirror image: the contract is about this side")
            }
            MirrorError::Sensing => {
                write!(f, "conditions on modules and ports have no mirror image, only those on joints have")
            }
        }
    }
}

/// Returns the mirror image of a behaviour in a plane of the base's frame: every command and condition for the image
/// of its joint, with the sign of its positions there. `holds`: for every bond of the robot, by index, true if it is
/// closed. `program`: the behaviour; `plane`: the mirror plane.
///
/// # Errors
/// [`MirrorError`] for a joint without an image, for behaviours that dock, undock or test for bonds, and for conditions on
/// modules and ports.
pub fn mirrored(
    robot: &Assembly,
    holds: &[bool],
    program: &Arc<Node>,
    plane: Plane,
) -> Result<Arc<Node>, MirrorError> {
    if has_contracts(program) {
        return Err(MirrorError::Contract);
    }
    if let Some(name) = goal_in(program) {
        return Err(MirrorError::Goal(name));
    }
    let images = images(robot, holds, plane);
    let names: Vec<String> = robot.joints().map(|owner| robot.joint_name(owner)).collect();
    let image = |joint: JointId| {
        let index = joint.0 as usize;
        images[index].ok_or_else(|| MirrorError::Joint(names[index].clone()))
    };
    rewritten(program, |action| mirrored_action(action, &image), |until| mirrored_condition(until, &image))
}

/// Returns the name of the built-in of a goal in a program; `None` if there is none.
fn goal_in(program: &Arc<Node>) -> Option<&'static str> {
    Graph::of(program).nodes.iter().find_map(|node| match &***node {
        Node::Goal(goal) => Some(goal.name()),
        _ => None,
    })
}

/// Returns the mirror image of every joint in a plane of the base's frame, by the number in its `JointId`, as (image,
/// sign), where the sign, 1 or -1, multiplies its positions; `None` for a joint without an image, which hinges of
/// bonds and fixed joints never have. A joint may be its own image. `holds`: for every bond of the robot, by index,
/// true if it is closed.
pub fn images(robot: &Assembly, holds: &[bool], plane: Plane) -> Vec<Option<(JointId, f64)>> {
    let marks = marks(robot, holds);
    let centre =
        marks.iter().flatten().map(|m| m.centre).sum::<Vec3>() / marks.iter().flatten().count().max(1) as f64;
    let normal = match plane {
        Plane::XY => Vec3::z(),
        Plane::YZ => Vec3::x(),
        Plane::XZ => Vec3::y(),
    };
    let mirror = Mirror { centre, normal };
    marks.iter().map(|mark| mark.as_ref().and_then(|m| mirror.image(m, &marks))).collect()
}

/// The features by which a joint differs from others, in the frame of the base, all joints at zero.
struct Mark {
    kind: usize,
    prismatic: bool,
    /// The centre of mass of the link that it moves, m.
    centre: Vec3,
    /// The point of the axis nearest to that, m.
    foot: Vec3,
    axis: Vec3,
}

/// Returns the mark of every joint, by joint; `None` for hinges of bonds and fixed joints.
fn marks(robot: &Assembly, holds: &[bool]) -> Vec<Option<Mark>> {
    let kinematics = Kinematics::new(robot, holds, robot.base);
    let count = robot.joints().count();
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&vec![0.0; count], &Pose::identity(), &mut poses);
    let mark = |owner| {
        // The hinge of a bond belongs to no module, and has no image.
        let JointOwner::Module { module, joint } = owner else { return None };
        let declared = &robot.module_type(module).joints[joint];
        let link = &robot.module_type(module).links[declared.child];
        let X_BM = kinematics.module_pose(module, &poses);
        let X_BL = poses[kinematics.link(module, declared.child)];
        let centre = X_BL.transform_point(&link.com.into()).coords;
        let axis = (X_BM * declared.pose).rotation * declared.axis;
        let origin = (X_BM * declared.pose).translation.vector;
        let foot = origin + axis * (centre - origin).dot(&axis);
        let prismatic = declared.kind == JointKind::Prismatic;
        (declared.kind != JointKind::Fixed).then_some(Mark {
            kind: robot.modules[module].kind,
            prismatic,
            centre,
            foot,
            axis,
        })
    };
    robot.joints().map(mark).collect()
}

/// A mirror: a plane by a point and its unit normal, in the frame of the base.
struct Mirror {
    centre: Vec3,
    normal: Vec3,
}

impl Mirror {
    /// Returns the mirror image of a point, m.
    fn point(&self, p: Vec3) -> Vec3 {
        self.centre + self.direction(p - self.centre)
    }

    /// Returns the mirror image of a direction.
    fn direction(&self, v: Vec3) -> Vec3 {
        v - self.normal * (2.0 * v.dot(&self.normal))
    }

    /// Returns the nearest joint of the same type at the mirrored position of this one, with the sign of its
    /// motion; `None` if none is near enough.
    fn image(&self, mark: &Mark, marks: &[Option<Mark>]) -> Option<(JointId, f64)> {
        let (centre, foot) = (self.point(mark.centre), self.point(mark.foot));
        // A right-handed turn about an axis is a left-handed turn about the axis in the mirror.
        let axis = if mark.prismatic { self.direction(mark.axis) } else { -self.direction(mark.axis) };
        let candidates = marks.iter().enumerate().filter_map(|(index, other)| {
            let other = other.as_ref()?;
            let off = (other.centre - centre).norm().max((other.foot - foot).norm());
            let fits =
                other.kind == mark.kind && other.prismatic == mark.prismatic && off <= TOLERANCES.image_place;
            (fits && other.axis.cross(&axis).norm() <= TOLERANCES.image_direction)
                .then_some((off, index, other))
        });
        let (_, index, other) = candidates.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        Some((JointId(index as u32), other.axis.dot(&axis).signum()))
    }
}

type Image<'a> = &'a dyn Fn(JointId) -> Result<(JointId, f64), MirrorError>;

/// Returns the mirror image of an action.
fn mirrored_action(action: &Action, image: Image) -> Result<Action, MirrorError> {
    let mut new = action.clone();
    match &mut new.command {
        Command::Move { joint, target, .. } => {
            let (other, sign) = image(*joint)?;
            *joint = other;
            match target {
                Target::To(value) | Target::By(value) => *value *= sign,
            }
        }
        Command::Spin { joint, speed, .. } => {
            let (other, sign) = image(*joint)?;
            *joint = other;
            *speed *= sign;
        }
        Command::Follow { joint, keyframes } => {
            let (other, sign) = image(*joint)?;
            *joint = other;
            keyframes
                .iter_mut()
                .for_each(|keyframe| (keyframe[1], keyframe[2]) = (keyframe[1] * sign, keyframe[2] * sign));
        }
        Command::Wait { .. } => {}
        Command::Dock { .. } | Command::Undock { .. } => return Err(MirrorError::Docking),
    }
    if let Some(until) = &action.until {
        new.until = Some(mirrored_condition(until, image)?);
    }
    Ok(new)
}

/// Returns the mirror image of a condition.
fn mirrored_condition(condition: &Condition, image: Image) -> Result<Condition, MirrorError> {
    let boxed = |c: &Condition| mirrored_condition(c, image).map(Box::new);
    Ok(match condition {
        Condition::Compare { signal, compare, value } => {
            let (signal, sign) = match *signal {
                Signal::Angle(joint) => image(joint).map(|(other, sign)| (Signal::Angle(other), sign))?,
                Signal::Speed(joint) => image(joint).map(|(other, sign)| (Signal::Speed(other), sign))?,
                Signal::Elapsed => (Signal::Elapsed, 1.0),
                Signal::Effort(joint) => image(joint).map(|(other, sign)| (Signal::Effort(other), sign))?,
                Signal::Separation(..) | Signal::Tilt(_) => return Err(MirrorError::Sensing),
            };
            let compare = if sign < 0.0 { compare.turned() } else { *compare };
            Condition::Compare { signal, compare, value: value * sign }
        }
        Condition::Docked(_) | Condition::Mated(..) => return Err(MirrorError::Docking),
        Condition::Touching(_) | Condition::TouchingEachOther(..) => return Err(MirrorError::Sensing),
        Condition::And(a, b) => Condition::And(boxed(a)?, boxed(b)?),
        Condition::Or(a, b) => Condition::Or(boxed(a)?, boxed(b)?),
        Condition::Not(a) => Condition::Not(boxed(a)?),
    })
}
