//! Inverse kinematics of an arm of seven joints at random poses: how often it reaches them to a micrometre and a microradian,
//! and how long that takes.
//!
//! `cargo bench --bench goals`.

use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::optimize::random::SplitMix64;
use modl::robot::chain::{Chain, DescentSettings, Orientation, Target};
use modl::robot::jacobian::LinkFrame;
use modl::robot::{
    Assembly, Joint, JointKind, Kinematics, Library, Limits, Link, ModuleInstance, ModuleType, Servo, Surface,
};
use std::sync::Arc;
use std::time::Instant;

/// The lengths from axis to axis, m.
const LENGTHS: [f64; 8] = [0.17, 0.17, 0.2, 0.2, 0.2, 0.2, 0.08, 0.05];
/// How far the joints turn to either side, rad.
const RANGES: [f64; 7] = [2.96, 2.09, 2.96, 2.09, 2.96, 2.09, 3.05];
/// The number of poses.
const POSES: u64 = 10_000;

fn arm() -> Assembly {
    let link = |name: String, height: f64| {
        let shape = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: 0.01 } }];
        Link {
            name,
            pose: shifted(Vec3::z() * height),
            collides: shape.clone(),
            left_out: 0.0,
            shape,
            mass: 1.0,
            com: Vec3::zeros(),
            inertia: [1e-4, 1e-4, 1e-4, 0.0, 0.0, 0.0],
            friction: 0.5,
            surface: Surface::default(),
        }
    };
    let mut height = 0.0;
    let (mut links, mut joints) = (vec![link("l0".into(), 0.0)], vec![]);
    for index in 0..7 {
        height += LENGTHS[index];
        links.push(link(format!("l{}", index + 1), height));
        let range = Some((-RANGES[index], RANGES[index]));
        joints.push(Joint {
            name: format!("j{index}"),
            parent: index,
            child: index + 1,
            kind: JointKind::Revolute,
            pose: shifted(Vec3::z() * height),
            axis: if index % 2 == 0 { Vec3::z() } else { Vec3::y() },
            limits: Limits { range, speed: Some(1.0), acceleration: None, effort: None },
            passive: false,
            mimic: None,
            servo: Servo::default(),
        });
    }
    let kind = ModuleType {
        name: "Arm".into(),
        links,
        joints,
        ports: vec![],
        motors: vec![],
        touching: vec![],
        touch: 1e-4,
        contact: 1e-3,
    };
    Assembly {
        name: "Arm".into(),
        library: Arc::new(Library { modules: vec![kind], ..Library::default() }),
        modules: vec![ModuleInstance { name: "a".into(), kind: 0 }],
        bonds: vec![],
        base: 0,
        closed: false,
        misalignments: vec![],
    }
}

fn main() {
    let robot = arm();
    let kinematics = Kinematics::new(&robot, &[], 0);
    let frame = LinkFrame { link: 7, X_LF: shifted(Vec3::z() * LENGTHS[7]) };
    let chain = Chain::new(&robot, &kinematics, 0, &frame).expect("the links are connected");
    let mut numbers = SplitMix64(1);
    let (mut times, mut starts, mut reached) = (Vec::new(), 0, 0);
    for pose in 0..POSES {
        let q: Vec<f64> = RANGES.iter().map(|range| range * numbers.next_signed()).collect();
        let goal = chain.pose(&q);
        let target =
            Target { position: goal.translation.vector, orientation: Orientation::Full(goal.rotation) };
        let mut found = vec![0.0; 7];
        let begin = Instant::now();
        let (error, used) =
            chain.reach(&target, &mut found, (20, &mut SplitMix64(pose)), &DescentSettings::default());
        times.push(begin.elapsed().as_secs_f64());
        starts += used;
        reached += u64::from(error.distance < 1e-6 && error.angle < 1e-6);
    }
    times.sort_by(f64::total_cmp);
    let [median, high] = [POSES / 2, POSES * 99 / 100].map(|i| times[i as usize] * 1e6);
    println!("{reached} of {POSES} poses reached, {:.2} starts each", starts as f64 / POSES as f64);
    println!("median {median:.1} us, 99 % below {high:.1} us");
}
