//! Declarations of modules, connectors, cells and struts: Definition IV.1 of the
//! compositional-design paper, (D, X, A, K), with shapes, masses and limits. SI throughout.

use crate::geometry::{Placed, Pose, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Everything that a robot or a plan refers to by index. Self-contained: it goes into plan files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Library {
    pub connectors: Vec<Connector>,
    pub modules: Vec<ModuleType>,
    pub cells: Vec<Cell>,
    pub struts: Vec<Strut>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Connector {
    pub name: String,
    /// Indices of the connectors it mates with; the relation is symmetric.
    pub mates: Vec<usize>,
    /// Allowed turns: `k * 360° / turns`, k = 0..turns. At least 1.
    pub turns: u32,
    /// Pull along the normal that a bond holds, N.
    pub holds_force: Option<f64>,
    /// Moment across the bond that it holds, N·m.
    pub holds_moment: Option<f64>,
    pub capture: Option<Capture>,
    /// The joint that lives in the bond, if bonds of this connector turn.
    pub hinge: Option<Hinge>,
}

/// How far two ports may be from a perfect mate when they dock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// Metres between the port origins.
    pub distance: f64,
    /// Radians between the orientations.
    pub angle: f64,
}

/// A joint in a bond: `X_PQ = Rot(axis, q) · Rz(180°) · Rx(θ)`, axis in the frame of port P.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    #[schemars(with = "[f64; 3]")]
    pub axis: Vec3,
    pub limits: Limits,
}

/// A module type; instances differ in nothing but their joint positions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModuleType {
    /// With its arguments where they differ from the defaults: `Hinge(length: 50mm)`.
    pub name: String,
    /// The first link is the body: its frame is the module's frame.
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    pub ports: Vec<Port>,
    pub motors: Vec<Motor>,
    /// Pairs of links that meet by design.
    pub touching: Vec<(usize, usize)>,
    /// Penetration deeper than this is a collision, m.
    pub touch: f64,
    /// Links within this of the ground touch it, m.
    pub contact: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Link {
    pub name: String,
    /// The link's frame in the module's frame, all joints at zero (`X_ML`).
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// To draw, in the link's frame.
    pub shape: Vec<Placed>,
    /// To judge, in the link's frame; the same as `shape` unless declared otherwise.
    pub collides: Vec<Placed>,
    pub mass: f64,
    /// Centre of mass in the link's frame.
    #[schemars(with = "[f64; 3]")]
    pub com: Vec3,
    /// About the centre of mass in the link's frame, symmetric, kg·m²: xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
    /// Coulomb coefficient against the ground.
    pub friction: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    Revolute,
    Prismatic,
    Fixed,
}

/// A joint carries `child` against `parent`. With the joint frame J placed in the module's frame
/// (`X_MJ`, all joints at zero), the child moves by `X_MJ · Rot(axis, q) · X_MJ⁻¹` (revolute) or
/// `X_MJ · Trans(axis·q) · X_MJ⁻¹` (prismatic) in the frame of the module as drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    pub name: String,
    pub parent: usize,
    pub child: usize,
    pub kind: JointKind,
    /// `X_MJ`
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// Unit vector in the joint's frame.
    #[schemars(with = "[f64; 3]")]
    pub axis: Vec3,
    pub limits: Limits,
    /// No motor: it can't be commanded.
    pub passive: bool,
    /// The joint follows others of its module: `q = Σ factor · q_index`. It takes no commands.
    pub mimic: Option<Vec<(usize, f64)>>,
}

/// What a joint or a motor can do. Radians or metres; `None`: no limit stated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Lowest and highest position; `None` is a continuous joint.
    pub range: Option<(f64, f64)>,
    pub speed: Option<f64>,
    pub acceleration: Option<f64>,
    /// Torque (N·m) or force (N).
    pub effort: Option<f64>,
}

/// Limits at a motor that drives several joints: `motor = Σ factor · joint`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    pub name: String,
    pub joints: Vec<(usize, f64)>,
    pub limits: Limits,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Port {
    pub name: String,
    pub link: usize,
    /// Origin on the mating face, +x outward, +z up, in the frame of its link (`X_LP`).
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub pose: Pose,
    /// Index in [`Library::connectors`].
    pub connector: usize,
}

/// An expanding cube (`cell`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    pub name: String,
    pub size: f64,
    pub shrinks_to: f64,
    pub mass: f64,
    pub force: f64,
    pub speed: f64,
}

/// A linear actuator (`strut`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strut {
    pub name: String,
    pub length: (f64, f64),
    pub speed: f64,
    pub force: f64,
    pub mass: f64,
    /// Least distance to other struts, m.
    pub clearance: f64,
}
