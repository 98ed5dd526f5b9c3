//! Gaits: phases that run together, mirror images checked by forward kinematics.

use crate::support::programs::*;
use crate::support::robots::{TILT, at_rest, car, chain, walk4};
use modl::behavior::gait::cycle;
use modl::behavior::mirror::{MirrorError, Plane, images, mirrored};
use modl::geometry::{Pose, Vec3};
use modl::plan::{CauseId, Command, Compare, Condition, Node, Signal, Target};
use modl::robot::{Assembly, JointId, JointOwner, Kinematics, PortRef};
use std::sync::Arc;

const T: u32 = TILT as u32;

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-8, "{a} should be {b}");
}

#[test]
fn a_cycle_begins_together_and_keeps_its_phases() {
    let wave = |joint| series(vec![go_in(joint, 0.5, 1.0, 0), go_in(joint, -0.5, 1.0, 1)]);
    let bodies = [(wave(T), 0.0), (wave(4 + T), 0.5), (wave(8 + T), 0.25)];
    let s = plan(chain(3), Arc::new(cycle(&bodies, 4.0, 3, CauseId(2)))).expect("it can be scheduled");
    // The furthest way to a beginning is half a radian, in least time.
    let lead = 15.0 / 8.0 * 0.5 / 2.4086;
    near(s.tracks.duration, lead + 12.0);
    for i in 0..60 {
        let t = lead + f64::from(i) / 5.0;
        let [first, half, quarter] = [T, 4 + T, 8 + T].map(|j| s.tracks.state(t).joints[j as usize]);
        near(first, -half);
        let later = s.tracks.state((t + 1.0).min(lead + 12.0)).joints[T as usize];
        if t + 1.0 < lead + 12.0 {
            near(quarter, later);
        }
    }
}

/// Centre of mass of the link that each joint of a module moves, in the frame of the base.
fn centres(robot: &Assembly, joints: &[f64]) -> Vec<Vec3> {
    let kinematics = Kinematics::new(robot, &vec![true; robot.bonds.len()], robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(joints, &Pose::identity(), &mut poses);
    let centre = |owner| {
        let JointOwner::Module { module, joint } = owner else {
            panic!("these robots have no hinges in bonds")
        };
        let child = robot.module_type(module).joints[joint].child;
        let com = robot.module_type(module).links[child].com;
        poses[kinematics.link(module, child)].transform_point(&com.into()).coords
    };
    robot.joints().map(centre).collect()
}

#[test]
fn in_the_mirror_every_link_is_where_the_mirror_shows_it() {
    for robot in [walk4(), car()] {
        let holds = vec![true; robot.bonds.len()];
        let images = images(&robot, &holds, Plane::XZ);
        let mut joints = at_rest(&robot).joints;
        let mut mirror = joints.clone();
        for (index, image) in images.iter().enumerate() {
            let (other, sign) = image.expect("the robot is symmetric");
            assert_eq!(images[other.0 as usize], Some((JointId(index as u32), sign)), "twice is back");
            // Any positions will do, as long as they have no symmetry of their own.
            joints[index] = libm::sin(1.0 + 7.3 * index as f64);
            mirror[other.0 as usize] = sign * joints[index];
        }
        let (seen, shown) = (centres(&robot, &joints), centres(&robot, &mirror));
        for (index, image) in images.iter().enumerate() {
            let (p, q) = (seen[index], shown[image.expect("checked above").0.0 as usize]);
            assert!((q - Vec3::new(p.x, -p.y, p.z)).norm() < 1e-9, "{} of {}", index, robot.name);
        }
    }
}

#[test]
fn a_mirrored_behaviour_moves_the_other_side() {
    let robot = walk4();
    let holds = vec![true; robot.bonds.len()];
    let module = |name: &str| robot.modules.iter().position(|m| m.name == name).expect("it is there") as u32;
    let (left, right) = (4 * module("fl_hip") + T, 4 * module("fr_hip") + T);
    let lifted = until(
        moving(left, Target::To(0.5), None, modl::plan::Profile::Smooth),
        angle(left, Compare::Greater, 0.2),
        0,
    );
    let image = mirrored(&robot, &holds, &node(lifted), Plane::XZ).expect("the robot is symmetric");
    let Node::Action(action) = &*image else { panic!("an action stays one") };
    let sign = images(&robot, &holds, Plane::XZ)[left as usize].expect("it has an image").1;
    let Command::Move { joint, target, .. } = action.command else { panic!("a move stays one") };
    assert_eq!((joint, target), (JointId(right), Target::To(0.5 * sign)));
    let compare = if sign > 0.0 { Compare::Greater } else { Compare::Less };
    let signal = Signal::Angle(JointId(right));
    assert_eq!(action.until, Some(Condition::Compare { signal, compare, value: 0.2 * sign }));
}

#[test]
fn what_has_no_mirror_image_is_named() {
    // A chain is no mirror image of itself from front to back: its tilts are not in the middle.
    let robot = chain(2);
    let error = mirrored(&robot, &[true], &go(T, 0.5, 0), Plane::YZ).expect_err("there is no image");
    assert_eq!(error, MirrorError::Joint("m0.tilt".into()));
    let undock = act(Command::Undock { port: PortRef { module: 0, port: 3 } }, 0);
    assert_eq!(mirrored(&robot, &[true], &undock, Plane::XZ), Err(MirrorError::Docking));
}
