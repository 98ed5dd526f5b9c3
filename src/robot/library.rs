//! Declarations of modules, connectors, cells and struts: Definition IV.1 of the compositional-design paper (Tosun,
//! Jing, Kress-Gazit and Yim), (D, X, A, K), with shapes, masses and limits. SI throughout.

use crate::geometry::{Placed, Pose, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The declarations that a robot or a plan refers to by index, from 0. It is complete in itself, and goes into plan
/// files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Library {
    /// The kinds of connectors; each is referred to by its index in this list.
    pub connectors: Vec<Connector>,
    /// The types of modules with links and joints; each is referred to by its index in this list.
    pub modules: Vec<ModuleType>,
    /// The types of expanding cubes; each is referred to by its index in this list.
    pub cells: Vec<Cell>,
    /// The types of linear actuators; each is referred to by its index in this list.
    pub struts: Vec<Strut>,
}

/// A kind of connector: the connectors that it mates with, the turns, and the loads that a bond of it holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Connector {
    /// The declared name of the connector.
    pub name: String,
    /// The connectors that this one mates with, as indices in [`Library::connectors`]; the relation is symmetric.
    pub mates: Vec<usize>,
    /// The number of allowed turns, at least 1: `k · 360° / turns` about the common normal, k from 0 to `turns` - 1.
    pub turns: u32,
    /// The greatest pull along the port's normal that a bond holds, N; `None`: no limit stated.
    pub holds_force: Option<f64>,
    /// The greatest moment across a bond that the bond holds, N·m; `None`: no limit stated.
    pub holds_moment: Option<f64>,
    /// The greatest error that docking tolerates; `None`: not stated.
    pub capture: Option<Capture>,
    /// True if docking draws the ports together into a perfect mate: of two robots that dock, the smaller moves by the error.
    #[serde(default, skip_serializing_if = "is_false")]
    pub snaps: bool,
    /// The joint of the bond; `None`: bonds of this connector do not turn.
    pub hinge: Option<Hinge>,
}

/// The greatest error of two ports from a perfect mate at which they dock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// The greatest distance between the origins of the two ports, m.
    pub distance: f64,
    /// The greatest angle between the orientation of the second port and that in a perfect mate, rad.
    pub angle: f64,
    /// The greatest speed of the ports of two robots against each other, m/s; `None`: they dock at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The greatest angular speed, rad/s, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
}

impl Capture {
    /// Returns the capture of ports within a distance (m) and an angle (rad) of a perfect mate, at rest against each other.
    pub const fn at_rest(distance: f64, angle: f64) -> Capture {
        Capture { distance, angle, speed: None, rate: None }
    }
}

/// A revolute joint in a bond: `X_PQ = Rot(axis, q) · Rz(180°) · Rx(θ)`, with the position q in rad, the axis in the
/// frame of the first port P, and the bond's turn θ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// The axis of the hinge, as a unit vector in the frame of the first port.
    #[schemars(with = "[f64; 3]")]
    pub axis: Vec3,
    /// The limits of the hinge: range (rad), speed (rad/s), acceleration (rad/s²) and torque (N·m).
    pub limits: Limits,
}

/// A module type: links, joints, ports and motors. Instances differ in nothing but their joint positions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModuleType {
    /// The name of the type, with the arguments where they differ from the defaults: `Hinge(length: 50mm)`.
    pub name: String,
    /// The rigid bodies; the first link is the body: its frame is the module's frame.
    pub links: Vec<Link>,
    /// The joints, which make a tree of the links.
    pub joints: Vec<Joint>,
    /// The ports at which the module docks.
    pub ports: Vec<Port>,
    /// The motors that drive several joints together.
    pub motors: Vec<Motor>,
    /// Pairs of links, by their indices in `links`, that meet by design: they are not checked for collisions with each
    /// other.
    pub touching: Vec<(usize, usize)>,
    /// The greatest depth of a penetration that counts as touching, m; a deeper one is a collision.
    pub touch: f64,
    /// The greatest distance from the ground at which a link counts as touching the ground, m.
    pub contact: f64,
}

impl ModuleType {
    /// The depth of a penetration that counts as touching unless the module says otherwise, m: 0.1 mm,
    /// far above rounding and below the thickness of any part.
    pub const TOUCH_DEFAULT: f64 = 1e-4;
    /// The distance from the ground up to which a link touches it unless the module says otherwise, m: 1 mm,
    /// since real contacts yield.
    pub const CONTACT_DEFAULT: f64 = 1e-3;
}

impl Link {
    /// The coefficient of friction of a link against the ground where its shapes state none, without unit.
    pub const FRICTION_DEFAULT: f64 = 0.5;
}

/// Returns true for false, which files leave out.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn is_false(value: &bool) -> bool {
    !*value
}

/// Returns true, for what files leave out where it holds.
fn is_stated_true() -> bool {
    true
}

/// Returns the value itself: true is left out of files.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn is_true(value: &bool) -> bool {
    *value
}

/// Returns true for 0, which files leave out.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A rigid body of a module, with its shapes and mass properties.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// The declared name of the link.
    pub name: String,
    /// The link's frame in the module's frame, all joints at zero (`X_ML`).
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// The shapes to draw, in the link's frame.
    pub shape: Vec<Placed>,
    /// The shapes to judge, in the link's frame; the same as `shape` unless declared otherwise.
    pub collides: Vec<Placed>,
    /// The distance by which `shape` sticks out of `collides`, m, as `collides` in a program states: so much of what is
    /// drawn is not judged. A file whose shapes leave out more is refused.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub left_out: f64,
    /// The mass of the link, kg.
    pub mass: f64,
    /// The centre of mass in the link's frame, m.
    #[schemars(with = "[f64; 3]")]
    pub com: Vec3,
    /// The entries xx, yy, zz, xy, xz, yz of the symmetric inertia matrix about the centre of mass, along the axes of
    /// the link's frame, kg·m².
    pub inertia: [f64; 6],
    /// The Coulomb coefficient of friction against the ground, without unit: of a surface that slides.
    pub friction: f64,
    /// The facts of the surface that only simulations know.
    #[serde(default, skip_serializing_if = "Surface::is_unstated")]
    pub surface: Surface,
}

/// The facts of a link's surface that only simulations know.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// The coefficient of friction up to which it sticks, without unit, at least that of a surface that slides; `None`: the
    /// same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_friction: Option<f64>,
    /// The stiffness of a contact, N/m; `None`: [`STIFFNESS_DEFAULT`](Surface::STIFFNESS_DEFAULT).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
}

impl Surface {
    /// The stiffness of a contact where none is stated, N/m: stiffer than servos are at a lever of 0.1 m. It is that of the
    /// judge.
    pub const STIFFNESS_DEFAULT: f64 = 1e5;

    /// Returns true if no fact of the surface is stated.
    pub fn is_unstated(&self) -> bool {
        *self == Surface::default()
    }
}

/// The kind of a joint: its degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// A revolute joint, which turns about its axis; positions in radians.
    Revolute,
    /// A prismatic joint, which slides along its axis; positions in metres.
    Prismatic,
    /// A fixed joint, which does not move.
    Fixed,
}

/// A joint, which carries the link `child` against the link `parent`. With the joint frame J placed in the module's
/// frame (`X_MJ`, all joints at zero), the child moves by `X_MJ · Rot(axis, q) · X_MJ⁻¹` (revolute) or `X_MJ ·
/// Trans(axis·q) · X_MJ⁻¹` (prismatic) in the frame of the module as drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// The declared name of the joint.
    pub name: String,
    /// Index in [`ModuleType::links`] of the link that carries.
    pub parent: usize,
    /// Index in [`ModuleType::links`] of the link that is carried.
    pub child: usize,
    /// The kind of the joint, which sets its degree of freedom.
    pub kind: JointKind,
    /// The joint's frame in the module's frame, all joints at zero (`X_MJ`).
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// The axis of the joint, as a unit vector in the joint's frame.
    #[schemars(with = "[f64; 3]")]
    pub axis: Vec3,
    /// The limits of the joint: range, speed, acceleration and effort, in rad and N·m where it turns, in m and N
    /// where it slides.
    pub limits: Limits,
    /// True if the joint has no motor, so that it can't be commanded.
    pub passive: bool,
    /// The facts of its servo.
    #[serde(default, skip_serializing_if = "Servo::is_unstated")]
    pub servo: Servo,
    /// The joints of its module, by index in [`ModuleType::joints`], that the joint follows, with factors: `q = Σ
    /// factor · q_index`. Such a joint takes no commands; `None`: it follows none.
    pub mimic: Option<Vec<(usize, f64)>>,
}

impl Joint {
    /// Returns true if the joint takes commands: it moves by a motor of its own, and follows no other.
    pub fn takes_commands(&self) -> bool {
        self.kind != JointKind::Fixed && !self.passive && self.mimic.is_none()
    }
}

/// The facts of the servo that holds a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// The stiffness with which the servo holds its position, N·m/rad or N/m; `None`: not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// The inertia of its rotor and gears as the joint feels it, kg·m² or kg; `None`: not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub armature: Option<f64>,
    /// The damping of its position, N·m·s/rad or N·s/m; of a joint without a motor that of the joint. `None`: not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
    /// The speed at which its motor has no effort left, rad/s or m/s: the greatest effort falls in proportion to the speed;
    /// `None`: it does not fall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_load_speed: Option<f64>,
}

impl Servo {
    /// The stiffness of the servo of a joint that turns, where neither it nor a greatest torque is stated, N·m/rad.
    pub const TURN_STIFFNESS_DEFAULT: f64 = 150.0;
    /// The stiffness of the servo of a joint that slides, where neither it nor a greatest force is stated, N/m: that of
    /// a joint that turns at a lever of 0.1 m.
    pub const SLIDE_STIFFNESS_DEFAULT: f64 = 1.5e4;
    /// The angle by which a servo is assumed to yield under its greatest torque where no stiffness is stated, rad: 1°.
    pub const TURN_YIELD_DEFAULT: f64 = std::f64::consts::PI / 180.0;
    /// The distance by which a servo is assumed to yield under its greatest force where no stiffness is stated, m: 1°
    /// at a lever of 0.1 m.
    pub const SLIDE_YIELD_DEFAULT: f64 = 0.1 * Servo::TURN_YIELD_DEFAULT;

    /// The damping of a servo of unit stiffness where none is stated, s: 6 N·m·s/rad for 150 N·m/rad.
    pub const DAMPING_DEFAULT: f64 = 1.0 / 25.0;
    /// The armature of a servo of unit stiffness where none is stated, s²: 2e-3 kg·m² for 150 N·m/rad, so that the
    /// shortest period of a servo is that of a step of 1 ms or more.
    pub const ARMATURE_DEFAULT: f64 = 2e-3 / 150.0;

    /// Returns the damping of a motor's servo with a stiffness (N·m/rad or N/m), N·m·s/rad or N·s/m: as stated, or
    /// [`DAMPING_DEFAULT`](Servo::DAMPING_DEFAULT) of the stiffness.
    pub fn damping_with(&self, stiffness: f64) -> f64 {
        self.damping.unwrap_or(Servo::DAMPING_DEFAULT * stiffness)
    }

    /// Returns the armature of a motor's servo with a stiffness (N·m/rad or N/m), kg·m² or kg: as stated, or
    /// [`ARMATURE_DEFAULT`](Servo::ARMATURE_DEFAULT) of the stiffness.
    pub fn armature_with(&self, stiffness: f64) -> f64 {
        self.armature.unwrap_or(Servo::ARMATURE_DEFAULT * stiffness)
    }

    /// Returns true if no fact of the servo is stated.
    pub fn is_unstated(&self) -> bool {
        *self == Servo::default()
    }

    /// Returns the stiffness, N·m/rad or N/m: as stated, or such that the servo yields by
    /// [`TURN_YIELD_DEFAULT`](Servo::TURN_YIELD_DEFAULT) or [`SLIDE_YIELD_DEFAULT`](Servo::SLIDE_YIELD_DEFAULT) under
    /// its greatest effort `effort` (N·m or N); where none is stated either,
    /// [`TURN_STIFFNESS_DEFAULT`](Servo::TURN_STIFFNESS_DEFAULT) or
    /// [`SLIDE_STIFFNESS_DEFAULT`](Servo::SLIDE_STIFFNESS_DEFAULT). `slides`: true if the joint slides.
    pub fn stiffness(&self, slides: bool, effort: Option<f64>) -> f64 {
        let (yields, unknown) = match slides {
            true => (Servo::SLIDE_YIELD_DEFAULT, Servo::SLIDE_STIFFNESS_DEFAULT),
            false => (Servo::TURN_YIELD_DEFAULT, Servo::TURN_STIFFNESS_DEFAULT),
        };
        self.stiffness.unwrap_or_else(|| effort.map_or(unknown, |effort| effort / yields))
    }
}

/// The limits of a joint or a motor. Positions are in radians or metres; `None`: no limit stated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The lowest and the highest position, rad or m; `None`: the joint has no end, as a continuous joint.
    pub range: Option<(f64, f64)>,
    /// The greatest absolute speed, rad/s or m/s; `None`: no limit stated.
    pub speed: Option<f64>,
    /// The greatest absolute acceleration, rad/s² or m/s²; `None`: no limit stated.
    pub acceleration: Option<f64>,
    /// The greatest absolute torque (N·m) or force (N); `None`: no limit stated.
    pub effort: Option<f64>,
}

/// A motor that drives several joints together, with limits on its position `Σ factor · joint position`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// The declared name of the motor.
    pub name: String,
    /// The joints that the motor drives, each as (index in [`ModuleType::joints`], factor).
    pub joints: Vec<(usize, f64)>,
    /// The limits of the motor: range, speed, acceleration and effort, in the units of `factor · joint position`.
    pub limits: Limits,
}

/// A port of a module: a face at which it docks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Port {
    /// The declared name of the port.
    pub name: String,
    /// The index in [`ModuleType::links`] of the link that carries the port.
    pub link: usize,
    /// The port's frame in the frame of its link (`X_LP`): origin on the mating face, +x outward, +z up.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// The index in [`Library::connectors`] of its kind of connector.
    pub connector: usize,
}

/// An expanding cube (`cell`), of which lattices are made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// The declared name of the cell.
    pub name: String,
    /// The edge of the cube when the cell is expanded, m.
    pub size: f64,
    /// The edge of the cube when the cell is contracted, m.
    pub shrinks_to: f64,
    /// The mass of the cell, kg.
    pub mass: f64,
    /// The greatest force with which the cell expands and contracts, N.
    pub force: f64,
    /// The greatest speed at which a face moves against the opposite one, m/s.
    pub speed: f64,
    /// True if cells hold each other over any parts of their faces, and slide along them. False if a connector in the
    /// middle of each face is all that holds: then two cells hold each other only where the middles of two faces meet,
    /// and let go to pass.
    #[serde(default = "is_stated_true", skip_serializing_if = "is_true")]
    pub slides: bool,
}

/// A linear actuator (`strut`), of which trusses are made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strut {
    /// The declared name of the strut.
    pub name: String,
    /// The least and the greatest length, m: the distance between the nodes at its ends.
    pub length: (f64, f64),
    /// The greatest speed of lengthening and shortening, m/s.
    pub speed: f64,
    /// The greatest magnitude of the acceleration of its length, m/s²; `None`: no limit stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
    /// The greatest magnitude of the force along the strut, N.
    pub force: f64,
    /// The mass of the strut, kg.
    pub mass: f64,
    /// The least distance of the strut's axis from those of struts that share no node with it, and from obstacles, m.
    pub clearance: f64,
    /// The pressure at which the strut buckles at its greatest length, N; shorter it bears more, as the inverse of the
    /// square of its length (Euler 1744); `None`: it is not stated, and the strut does not buckle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub buckling: Option<f64>,
    /// The mass of a node that struts of this kind meet at, kg; `None`: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node_mass: Option<f64>,
}

impl Strut {
    /// Returns the mass at each node of a truss of these struts, kg: half of each strut at either of its ends, and the
    /// node's own. `struts`: the two nodes of each strut, indices below `nodes`; others panic.
    pub fn node_masses(&self, nodes: usize, struts: &[(usize, usize)]) -> Vec<f64> {
        let mut masses = vec![self.node_mass.unwrap_or(0.0); nodes];
        for &(a, b) in struts {
            masses[a] += self.mass / 2.0;
            masses[b] += self.mass / 2.0;
        }
        masses
    }

    /// Returns the product of the square of the length of a strut and the pressure at which it buckles, N m²: π² times its
    /// bending stiffness; infinite for struts that do not buckle.
    pub fn euler(&self) -> f64 {
        self.buckling.map_or(f64::INFINITY, |force| force * self.length.1 * self.length.1)
    }
}
