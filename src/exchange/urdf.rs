//! Robots as URDF, one for each piece of a robot between two changes of its bonds.
//!
//! URDF puts the frame of a link on the axis of the joint that carries it, and so links are framed anew (frame U): with
//! the orientation of the link's own frame L, and the origin at the foot of L's origin on the axis, whichever link
//! carries the others. Masses, shapes and joints are stated in U.

use super::export::{Export, ExportFile};
use super::motion::{JointMotion, joints, owner};
use super::names::Names;
use super::pieces::{Piece, pieces};
use super::refusal::Refusal;
use super::urdf_shapes::Shapes;
use crate::formats::masses::{MASS_MIN, sound_inertia};
use crate::formats::xml::{Attribute, Xml, number, numbers, vector};
use crate::geometry::pose::shifted;
use crate::geometry::{Pose, Vec3};
use crate::plan::{Plan, Tracks};
use crate::robot::{JointKind, JointOwner, Kinematics, Limits, Link, Motion};

/// The number in a description for an effort, speed or extent that the plan does not limit, in SI units: URDF wants
/// a number.
const UNLIMITED: f64 = 1e6;

/// A description of one piece of a robot.
pub(super) struct Description {
    /// The end of the stem of its file names.
    pub(super) suffix: String,
    /// The time from which on it holds, s.
    pub(super) from: f64,
    /// Its text.
    pub(super) text: String,
}

/// Returns the descriptions of a plan's robot as files, with the meshes that they name in the folder `STEM.meshes`.
///
/// # Errors
/// [`Refusal::NoJoints`] for lattices and trusses, [`Refusal::Loop`] for a robot with a closed loop.
pub(super) fn write(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let mut shapes = Shapes::new(export.stem);
    let described = descriptions(export.plan, export.title, &mut shapes)?;
    let file = |one: Description| ExportFile::text(format!("{}{}.urdf", export.stem, one.suffix), one.text);
    let mut files = shapes.into_files();
    files.extend(described.into_iter().map(file));
    Ok(files)
}

/// Returns the descriptions of a plan's robot, in order of time; meshes are added to `shapes`. `title`: its name.
///
/// # Errors
/// As for [`write`].
pub(super) fn descriptions(
    plan: &Plan,
    title: &str,
    shapes: &mut Shapes,
) -> Result<Vec<Description>, Refusal> {
    let tracks = plan.body.tracks().ok_or(Refusal::NoJoints { format: "a robot description" })?;
    let pieces = pieces(tracks);
    for piece in &pieces {
        if let Some(&bond) = piece.kinematics.tree.closing.first() {
            let bond = tracks.robot.bond_name(bond);
            return Err(Refusal::Loop { bond, time: piece.from });
        }
    }
    let names = Names::of(&tracks.robot);
    let describe = |piece: Piece| {
        let writer = Writer { tracks, names: &names, piece: &piece };
        let text = writer.text(title, shapes);
        Description { suffix: piece.suffix, from: piece.from, text }
    };
    Ok(pieces.into_iter().map(describe).collect())
}

/// Returns the pose of a link's own frame in its frame on the axis of its joint, `X_UL`; the identity for a root.
/// `link`: its number.
pub(super) fn link_in_description(kinematics: &Kinematics, link: usize) -> Pose {
    kinematics.step(link).map_or(Pose::identity(), |step| shifted(step.offset))
}

/// The writer of one description.
struct Writer<'a> {
    tracks: &'a Tracks,
    names: &'a Names,
    piece: &'a Piece,
}

impl Writer<'_> {
    fn text(&self, title: &str, shapes: &mut Shapes) -> String {
        let mut xml = Xml::new();
        xml.open("robot", &[("name", title.to_owned())]);
        xml.comment(&format!(
            "From modl: the robot from {} s of its plan on. SI units; links and joints have the plan's names.",
            number(self.piece.from)
        ));
        xml.open("mujoco", &[]);
        let own = [("strippath", "false"), ("fusestatic", "false"), ("discardvisual", "true")];
        xml.leaf("compiler", &own.map(|(key, value)| (key, value.to_owned())));
        xml.close("mujoco");
        let kinematics = &self.piece.kinematics;
        for &(module, _) in &kinematics.tree.order {
            let kind = self.tracks.robot.modules[module].kind;
            for (index, link) in self.tracks.robot.module_type(module).links.iter().enumerate() {
                self.link(&mut xml, kinematics.link(module, index), link, &mut shapes.of(kind, index));
            }
        }
        let moving = joints(self.tracks, self.piece);
        let mut joint_of: Vec<Option<&JointMotion>> = vec![None; kinematics.link_count()];
        moving.iter().for_each(|joint| joint_of[joint.link] = Some(joint));
        for step in &kinematics.steps {
            self.joint(&mut xml, step.link, joint_of[step.link]);
        }
        xml.close("robot");
        xml.into_text()
    }

    fn link(&self, xml: &mut Xml, number_of: usize, link: &Link, shapes: &mut super::urdf_shapes::OfLink) {
        let X_UL = link_in_description(&self.piece.kinematics, number_of);
        xml.open("link", &[("name", self.names.links[number_of].clone())]);
        if link.mass < MASS_MIN {
            xml.comment("This link has no mass; simulators want some.");
        }
        xml.open("inertial", &[]);
        xml.leaf("origin", &[("xyz", vector(&(X_UL * nalgebra::Point3::from(link.com)).coords))]);
        xml.leaf("mass", &[("value", number(link.mass.max(MASS_MIN)))]);
        let entries = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
        let inertia = entries.into_iter().zip(sound_inertia(link).map(number));
        xml.leaf("inertia", &inertia.collect::<Vec<Attribute>>());
        xml.close("inertial");
        shapes.write(xml, "visual", &link.shape, &X_UL);
        shapes.write(xml, "collision", &link.collides, &X_UL);
        xml.close("link");
    }

    /// Adds the joint that carries a link: `joint` if something moves it.
    fn joint(&self, xml: &mut Xml, link: usize, joint: Option<&JointMotion>) {
        let kinematics = &self.piece.kinematics;
        let Some(step) = kinematics.step(link) else { return };
        let at_zero = Pose::from_parts(step.shift.into(), step.turn);
        let X = link_in_description(kinematics, step.parent) * at_zero;
        let limits = joint.map_or(Limits::default(), |joint| self.limits(joint.joint));
        let axis = match (step.motion, step.motion.axis()) {
            (_, Some(axis)) => Some(axis),
            (Motion::Along(direction), _) => Some(step.turn.inverse() * direction),
            _ => None,
        };
        let (joint, axis) = (joint.filter(|_| axis.is_some()), axis.unwrap_or(Vec3::x()));
        let kind = match joint {
            None => "fixed",
            Some(joint) if joint.slides => "prismatic",
            Some(_) if limits.range.is_some() => "revolute",
            Some(_) => "continuous",
        };
        let name = match joint {
            Some(joint) => self.names.joints[joint.joint].clone(),
            None => format!("{}: fixed", self.names.links[link]),
        };
        xml.open("joint", &[("name", name), ("type", kind.to_owned())]);
        xml.leaf("parent", &[("link", self.names.links[step.parent].clone())]);
        xml.leaf("child", &[("link", self.names.links[link].clone())]);
        xml.leaf("origin", &origin(&X));
        if let Some(joint) = joint {
            xml.leaf("axis", &[("xyz", vector(&axis))]);
            let (low, high) = limits.range.unwrap_or((-UNLIMITED, UNLIMITED));
            let mut limit: Vec<Attribute> = Vec::new();
            if kind != "continuous" {
                limit.extend([("lower", number(low)), ("upper", number(high))]);
            }
            limit.push(("effort", number(limits.effort.unwrap_or(UNLIMITED))));
            limit.push(("velocity", number(limits.speed.unwrap_or(UNLIMITED))));
            xml.leaf("limit", &limit);
            match joint.follows() {
                Some((followed, factor)) => xml.leaf(
                    "mimic",
                    &[("joint", self.names.joints[followed].clone()), ("multiplier", number(factor))],
                ),
                None if joint.terms.len() > 1 => xml.comment(
                    "This joint follows several others, which URDF can't state: its trajectory commands it.",
                ),
                None => {}
            }
        }
        xml.close("joint");
    }

    fn limits(&self, joint: usize) -> Limits {
        match owner(self.tracks, joint) {
            JointOwner::Module { module, joint } => {
                let declared = &self.tracks.robot.module_type(module).joints[joint];
                debug_assert!(declared.kind != JointKind::Fixed);
                declared.limits
            }
            JointOwner::Bond(bond) => {
                self.tracks.robot.hinge(bond).map_or(Limits::default(), |hinge| hinge.limits)
            }
        }
    }
}

/// Returns the attributes of an element `origin`: position, and roll, pitch and yaw.
pub(super) fn origin(X: &Pose) -> Vec<Attribute<'static>> {
    let mut attributes = vec![("xyz", vector(&X.translation.vector))];
    let angles = roll_pitch_yaw(X);
    if angles != [0.0; 3] {
        attributes.push(("rpy", numbers(angles)));
    }
    attributes
}

/// Returns the angles of `R = Rz(yaw) · Ry(pitch) · Rx(roll)`, rad, in the order of URDF. They are exact to rounding
/// also where the pitch is a right angle: roll and pitch are those of what the yaw, whatever it is, leaves over.
fn roll_pitch_yaw(X: &Pose) -> [f64; 3] {
    let R = *X.rotation.to_rotation_matrix().matrix();
    let yaw = libm::atan2(R[(1, 0)], R[(0, 0)]);
    let (s, c) = libm::sincos(yaw);
    let roll = libm::atan2(s * R[(0, 2)] - c * R[(1, 2)], c * R[(1, 1)] - s * R[(0, 1)]);
    let pitch = libm::atan2(-R[(2, 0)], c * R[(0, 0)] + s * R[(1, 0)]);
    [roll, pitch, yaw]
}
