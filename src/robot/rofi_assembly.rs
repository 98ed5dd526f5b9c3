//! The RoFI universal module as a [`ModuleType`], and a RoFI configuration as an [`Assembly`]: for callers
//! from Rust, who have no program that declares the module. `stdlib/rofi.mod` declares the same module; a
//! test compares the two.

use super::rofi::{Dock, World};
use super::{
    Assembly, Bond, Capture, Connector, Joint, JointKind, Library, Limits, Link, ModuleInstance, ModuleType,
    Port, PortRef, Servo, State, Surface,
};
use crate::geometry::pose::{shifted, turned};
use crate::geometry::{Placed, Pose, Shape, Vec3};
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};
use std::sync::Arc;

/// Mass of each of the four links, kg.
const LINK_MASS: f64 = 0.125;
/// Radius of the inner bodies, as a fraction of the pitch; the shoes have one half.
const BODY_RADIUS: f64 = 0.45;
/// Greatest joint speed, rad/s.
const JOINT_SPEED_MAX: f64 = FRAC_PI_2;
/// Greatest joint acceleration, rad/s²: an assumption, full speed after an eighth of a second.
const JOINT_ACCELERATION_MAX: f64 = 8.0 * JOINT_SPEED_MAX;
/// Greatest joint torque, N·m.
const JOINT_TORQUE_MAX: f64 = 10.0;
/// Docking tolerances: metres and radians.
const CAPTURE: Capture = Capture::at_rest(0.005, 5.0 * PI / 180.0);

/// Returns the type of the RoFI universal module with the distance `pitch` (m) between the centres of its two bodies,
/// the shoes A and B.
///
/// With its joints at alpha, beta and gamma (rad), the pose of shoe B in shoe A is, in units of the pitch, `Rx(alpha)
/// · Rz(gamma) · T(0, 0, 1) · Ry(180°) · Rx(-beta)`.
pub fn module_type(pitch: f64) -> ModuleType {
    let tilt = Some((-FRAC_PI_2, FRAC_PI_2));
    let far = shifted(Vec3::new(0.0, 0.0, pitch));
    let (shoe, body) = (pitch / 2.0, BODY_RADIUS * pitch);
    ModuleType {
        name: "Rofi".into(),
        links: vec![
            Link { shape: shoe_drawn(pitch), ..link("shoe_a", Pose::identity(), shoe) },
            link("body_a", Pose::identity(), body),
            link("body_b", far, body),
            Link { shape: shoe_drawn(pitch), ..link("shoe_b", far * turned(Vec3::y(), PI), shoe) },
        ],
        joints: vec![
            joint("alpha", (0, 1), Pose::identity(), Vec3::x(), tilt),
            joint("gamma", (1, 2), Pose::identity(), Vec3::z(), None),
            joint("beta", (2, 3), far, Vec3::x(), tilt),
        ],
        ports: [("a", 0), ("b", 3)].into_iter().flat_map(|(side, link)| ports(side, link, pitch)).collect(),
        motors: Vec::new(),
        touching: vec![(0, 3), (0, 2), (1, 3)],
        touch: ModuleType::TOUCH_DEFAULT,
        contact: ModuleType::CONTACT_DEFAULT,
    }
}

/// Returns a configuration as (assembly, start state), of modules of the given `pitch` (m): joints at the file's
/// positions (converted to rad), all bonds closed, shoe A of the first module at the origin of the world. The module
/// of id 7 is named `m[7]`.
pub fn assembly(world: &World, pitch: f64) -> (Assembly, State) {
    let dock = Connector {
        name: "Dock".into(),
        mates: vec![0],
        turns: 4,
        holds_force: None,
        holds_moment: None,
        capture: Some(CAPTURE),
        snaps: false,
        hinge: None,
    };
    let kind = module_type(pitch);
    let port = |dock: &Dock| PortRef {
        module: dock.module,
        port: kind.ports.iter().position(|p| p.name == dock.port()).expect("the module has all six docks"),
    };
    let bonds: Vec<Bond> =
        world.edges.iter().map(|e| Bond { a: port(&e.a), b: port(&e.b), turn: e.turn }).collect();
    // The joints of a module in the order of its declaration: alpha, gamma, beta.
    let joints = world.modules.iter().flat_map(|module| {
        let [alpha, beta, gamma] = module.joints.map(f64::to_radians);
        [alpha, gamma, beta]
    });
    let state = State {
        joints: joints.collect(),
        bonds: vec![true; bonds.len()],
        base: Pose::identity(),
        clusters: vec![],
        misalignments: vec![],
    };
    let modules =
        world.modules.iter().map(|module| ModuleInstance { name: format!("m[{}]", module.id), kind: 0 });
    let assembly = Assembly {
        name: "RoFI".into(),
        modules: modules.collect(),
        bonds,
        base: 0,
        closed: true,
        misalignments: vec![],
        library: Arc::new(Library { connectors: vec![dock], modules: vec![kind], ..Library::default() }),
    };
    (assembly, state)
}

/// Returns a homogeneous ball of radius `radius` (m).
fn link(name: &str, pose: Pose, radius: f64) -> Link {
    let shape = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius } }];
    let inertia = 0.4 * LINK_MASS * radius * radius;
    Link {
        name: name.into(),
        pose,
        collides: shape.clone(),
        shape,
        left_out: 0.0,
        mass: LINK_MASS,
        com: Vec3::zeros(),
        inertia: [inertia, inertia, inertia, 0.0, 0.0, 0.0],
        friction: Link::FRICTION_DEFAULT,
        surface: Surface::default(),
    }
}

/// Returns a shoe as it is drawn: a bracket from the dock +X round the body to the dock -X, as `std.rofi` declares it. The
/// ball is judged and weighed.
fn shoe_drawn(pitch: f64) -> Vec<Placed> {
    let at = |radius: f64, y: f64, degrees: f64| {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        Vec3::new(pitch * (radius * cos), pitch * y, pitch * (-radius * sin))
    };
    let half = |start: f64| {
        let around = |y: f64| {
            let radius = (0.2475 - y * y).sqrt();
            (0..13).map(move |i| at(radius, y, start + 10.0 * f64::from(i)))
        };
        let outside = [-0.26, -0.14, 0.0, 0.14, 0.26].into_iter().flat_map(around);
        let inside = [-0.24, 0.24].into_iter().flat_map(|y| [start, start + 120.0].map(|a| at(0.35, y, a)));
        let points = outside.chain(inside).collect();
        Placed { pose: Pose::identity(), shape: Shape::Hull { points } }
    };
    vec![half(-30.0), half(90.0)]
}

fn joint(
    name: &str,
    (parent, child): (usize, usize),
    pose: Pose,
    axis: Vec3,
    range: Option<(f64, f64)>,
) -> Joint {
    let limits = Limits {
        range,
        speed: Some(JOINT_SPEED_MAX),
        acceleration: Some(JOINT_ACCELERATION_MAX),
        effort: Some(JOINT_TORQUE_MAX),
    };
    let name = name.into();
    Joint {
        name,
        parent,
        child,
        kind: JointKind::Revolute,
        pose,
        axis,
        limits,
        passive: false,
        mimic: None,
        servo: Servo::default(),
    }
}

/// Returns the docks +X, -X and -Z of a shoe. A port's x axis points outward.
fn ports(side: &str, link: usize, pitch: f64) -> [Port; 3] {
    let half = pitch / 2.0;
    let port = |face: &str, origin: Vec3, quaternion: [f64; 4]| {
        let [w, x, y, z] = quaternion;
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
        Port {
            name: format!("{side}_{face}"),
            link,
            pose: Pose::from_parts(origin.into(), rotation),
            connector: 0,
        }
    };
    [
        port("plus_x", Vec3::new(half, 0.0, 0.0), [0.0, 1.0, 0.0, 0.0]),
        port("minus_x", Vec3::new(-half, 0.0, 0.0), [0.0, 0.0, 0.0, 1.0]),
        port("minus_z", Vec3::new(0.0, 0.0, -half), [FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2, 0.0]),
    ]
}
