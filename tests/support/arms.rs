//! An arm of seven joints, and a ball on two slides, for tests and benches.

use super::robots::{boxed, joint, link};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::robot::{Assembly, Joint, JointKind, Library, Limits, Link, ModuleInstance, ModuleType};
use std::sync::Arc;

/// Returns one module as a robot.
pub fn robot_of(links: Vec<Link>, joints: Vec<Joint>) -> Assembly {
    let kind = ModuleType {
        name: "Robot".into(),
        links,
        joints,
        ports: vec![],
        motors: vec![],
        touching: vec![],
        touch: 1e-4,
        contact: 1e-3,
    };
    Assembly {
        name: "Robot".into(),
        library: Arc::new(Library { modules: vec![kind], ..Library::default() }),
        modules: vec![ModuleInstance { name: "r".into(), kind: 0 }],
        bonds: vec![],
        base: 0,
        closed: false,
        misalignments: vec![],
    }
}

/// The lengths from axis to axis of an arm of seven joints that turn about z and y by turns, m.
pub const LENGTHS: [f64; 8] = [0.17, 0.17, 0.2, 0.2, 0.2, 0.2, 0.08, 0.05];
/// The angles by which its joints turn to either side, rad.
pub const RANGES: [f64; 7] = [2.96, 2.09, 2.96, 2.09, 2.96, 2.09, 3.05];

/// Returns the axis of a joint of the arm.
pub fn axis(index: usize) -> Vec3 {
    if index.is_multiple_of(2) { Vec3::z() } else { Vec3::y() }
}

/// Returns the arm of seven joints, drawn upright.
pub fn seven_joints() -> Assembly {
    let ball = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: 0.01 } }];
    let mut height = 0.0;
    let mut links = vec![link("l0", ball.clone(), 1.0, Vec3::zeros(), 0.5)];
    let mut joints = vec![];
    for index in 0..7 {
        height += LENGTHS[index];
        let mut next = link(&format!("l{}", index + 1), ball.clone(), 1.0, Vec3::zeros(), 0.5);
        next.pose = shifted(Vec3::z() * height);
        links.push(next);
        let range = Some((-RANGES[index], RANGES[index]));
        let limits = Limits { range, speed: Some(1.0), acceleration: None, effort: None };
        let pose = shifted(Vec3::z() * height);
        joints.push(joint(
            &format!("j{index}"),
            (index, index + 1),
            JointKind::Revolute,
            pose,
            axis(index),
            limits,
        ));
    }
    robot_of(links, joints)
}

/// The radius of the ball of a gantry, m.
pub const BALL: f64 = 0.05;

/// Returns a ball that two slides carry along x and y.
pub fn gantry() -> Assembly {
    let tiny = vec![boxed(Vec3::new(-1e-3, -1e-3, 9.999), Vec3::new(1e-3, 1e-3, 10.0))];
    let ball = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: BALL } }];
    let links = vec![
        link("rail", tiny.clone(), 1.0, Vec3::zeros(), 0.5),
        link(
            "cart",
            vec![boxed(Vec3::new(-1e-3, -1e-3, 4.999), Vec3::new(1e-3, 1e-3, 5.0))],
            1.0,
            Vec3::zeros(),
            0.5,
        ),
        link("ball", ball, 1.0, Vec3::zeros(), 0.5),
    ];
    let slide = |name: &str, between, axis| {
        let limits = Limits { range: Some((-1.0, 1.0)), speed: Some(1.0), acceleration: None, effort: None };
        joint(name, between, JointKind::Prismatic, Pose::identity(), axis, limits)
    };
    robot_of(links, vec![slide("x", (0, 1), Vec3::x()), slide("y", (1, 2), Vec3::y())])
}
