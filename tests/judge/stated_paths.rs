//! Ports that keep to stated paths: deviations by closed forms and by a dense look at the motion, with formulas of the
//! tests' own.
#![allow(non_snake_case)]

use crate::support::arms::robot_of;
use crate::support::motions::Motion;
use crate::support::numbers::Numbers;
use crate::support::replay::Replay;
use crate::support::robots::{self, T, boxed, face, joint, link};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Pose, Vec3};
use modl::plan::verify::verify;
use modl::plan::{CauseId, CheckKind, DockingEvent, DockingKind, Failure, Plan, StatedPath, Status, World};
use modl::robot::{Assembly, JointKind, Limits, Port, PortRef};
use nalgebra::UnitQuaternion;
use std::sync::Arc;

/// The joints of the robot of the tests: two slides, along x and y, and turns about z and x.
pub const SLIDE_X: usize = 0;
pub const SLIDE_Y: usize = 1;
pub const TURN_Z: usize = 2;
const TURN_X: usize = 3;

/// The distance of the port from the axis of the turn about z, m.
const ARM: f64 = 0.1;

/// Returns a robot whose port two slides, which reach this far to either side (m), and two turns carry; its links are far from
/// each other.
pub fn carrier(reach: f64) -> Assembly {
    let links = (0..5).map(|i| {
        let low = Vec3::z() * f64::from(i);
        link(&format!("l{i}"), vec![boxed(low, low + Vec3::repeat(1e-3))], 1.0, Vec3::zeros(), 0.5)
    });
    let moved = |name: &str, at, kind, axis| {
        let limits = Limits { range: Some((-reach, reach)), speed: None, acceleration: None, effort: None };
        joint(name, (at, at + 1), kind, Pose::identity(), axis, limits)
    };
    let joints = vec![
        moved("x", 0, JointKind::Prismatic, Vec3::x()),
        moved("y", 1, JointKind::Prismatic, Vec3::y()),
        moved("turn", 2, JointKind::Revolute, Vec3::z()),
        moved("tilt", 3, JointKind::Revolute, Vec3::x()),
    ];
    let mut robot = robot_of(links.collect(), joints);
    let library = Arc::make_mut(&mut robot.library);
    library.connectors.push(face());
    let pose = shifted(Vec3::x() * ARM);
    library.modules[0].ports.push(Port { name: "tip".into(), link: 4, pose, connector: 0 });
    robot
}

/// Returns the plan of a motion that states one path of the first port.
pub fn stating(motion: Motion, path: StatedPath) -> Plan {
    let mut plan = motion.plan(World::FREE);
    plan.paths.push(path);
    // Paths are looked at often enough without that.
    plan.settings.sample = 1.0;
    plan
}

/// Returns a straight path over an interval, at whose beginning and end no orientation is asked for.
fn line(from: f64, to: f64, start: Vec3, end: Vec3) -> StatedPath {
    let port = PortRef { module: 0, port: 0 };
    let (start, end) = (shifted(start), shifted(end));
    let cause = CauseId(0);
    StatedPath { port, module: 0, from, to, start, end, via: None, within: 1e-3, turned_within: None, cause }
}

/// Returns what the judge finds of the path of a plan that is to be kept within a distance.
pub fn judged(plan: &Plan, within: f64) -> (Status, Option<Failure>) {
    let mut plan = plan.clone();
    plan.paths[0].within = within;
    let mut verdict = verify(&plan);
    let check = verdict.checks.iter().find(|check| check.kind == CheckKind::Path);
    let status = check.unwrap_or_else(|| panic!("it is not judged: {:?}", verdict.failures)).status.clone();
    verdict.failures.retain(|failure| failure.kind == CheckKind::Path);
    (status, verdict.failures.pop())
}

/// Returns the place of the port, m, with the joints of a plan at a time (s).
fn place(plan: &Plan, time: f64) -> Vec3 {
    let replay = Replay::new(plan.body.tracks().expect("a plan of joints"));
    let [x, y, turn] = [SLIDE_X, SLIDE_Y, TURN_Z].map(|joint| replay.position(joint, time));
    Vec3::new(x + ARM * libm::cos(turn), y + ARM * libm::sin(turn), 0.0)
}

/// Returns the greatest of a quantity over the interval of a plan's path, looked at `many` times.
fn greatest(plan: &Plan, many: usize, of: &dyn Fn(f64) -> f64) -> f64 {
    let (from, to) = (plan.paths[0].from, plan.paths[0].to);
    (0..=many).map(|i| of(from + (to - from) * i as f64 / many as f64)).fold(0.0, f64::max)
}

/// Asserts that the judge finds what deviates by `worst` (m) from its path, and proves that there is no more.
fn assert_found(plan: &Plan, worst: f64, deviation: &dyn Fn(f64) -> f64) {
    for part in [0.6, 0.95, 0.99] {
        let (status, failure) = judged(plan, part * worst);
        let failure = failure.unwrap_or_else(|| panic!("{part} of {worst} m are too little"));
        assert_eq!((status, failure.limit), (Status::Failed, part * worst));
        assert!(failure.value > part * worst && failure.value < 1.005 * worst, "{} {worst}", failure.value);
        assert!((deviation(failure.time) - failure.value).abs() < 1e-9 * worst, "{} s", failure.time);
        assert_eq!(failure.at, ["r.tip"]);
    }
    for part in [1.01, 3.0] {
        assert_eq!(judged(plan, part * worst), (Status::Proved, None), "{part} of {worst} m suffice");
    }
}

/// Adds to a motion some short moves of a joint, between which it rests, within an interval.
fn moving(motion: Motion, joint: usize, n: &mut Numbers, (from, to): (f64, f64), size: f64) -> Motion {
    let (mut motion, mut time) = (motion, from + n.between(0.0, 5.0));
    let mut at = motion.tracks.start.joints[joint];
    while time < to - 4.0 {
        let end = time + n.between(0.3, 2.0);
        let mut control = vec![at];
        control.extend((0..1 + n.below(4)).map(|_| n.between(-size, size)));
        at = control[control.len() - 1];
        motion = motion.segment(joint, time, end, control);
        time = end + n.between(0.0, 20.0);
    }
    motion
}

/// Moves of less than a second lie between the 64 times that are always looked at.
#[test]
fn deviations_from_a_line_between_samples_are_found() {
    let mut n = Numbers(1);
    for round in 0..9 {
        let start = Motion::new(carrier(5.0));
        let motion = if round % 3 == 0 { moving(start, SLIDE_X, &mut n, (0.0, 90.0), 0.3) } else { start };
        let mut motion = moving(motion, SLIDE_Y, &mut n, (0.0, 90.0), 0.1);
        if round % 2 == 0 {
            motion = moving(motion, TURN_Z, &mut n, (0.0, 90.0), 1.0);
        }
        motion.tracks.duration = 90.0;
        let (a, b) =
            (Vec3::new(n.between(-0.2, 0.1), -0.02, 0.0), Vec3::new(n.between(0.12, 0.4), 0.03, 0.01));
        let plan = stating(motion, line(n.between(0.0, 20.0), n.between(70.0, 90.0), a, b));
        let deviation = |time: f64| {
            let p = place(&plan, time);
            let along = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            (p - (a * (1.0 - along) + b * along)).norm()
        };
        assert_found(&plan, greatest(&plan, 8_000, &deviation), &deviation);
    }
}

#[test]
fn deviations_from_an_arc_between_samples_are_found() {
    let mut n = Numbers(2);
    for round in 0..12 {
        let start = Motion::new(carrier(5.0));
        let mut motion = moving(start, SLIDE_X, &mut n, (0.0, 90.0), 0.1);
        motion = moving(motion, SLIDE_Y, &mut n, (0.0, 90.0), 0.1);
        if round % 2 == 0 {
            motion = moving(motion, TURN_Z, &mut n, (0.0, 90.0), 0.5);
        }
        motion.tracks.duration = 90.0;
        // A circle in any plane, by three of its points.
        let tilt = n.rotation();
        let (centre, radius) = (n.vector() * 0.2, n.between(0.05, 0.3));
        let [one, two, three] =
            [n.between(0.0, 1.0), n.between(1.5, 2.5), n.between(3.0, 4.5)].map(|angle| {
                let (s, c) = libm::sincos(angle);
                centre + tilt * Vec3::new(radius * c, radius * s, 0.0)
            });
        let path = line(n.between(0.0, 20.0), n.between(70.0, 90.0), one, three);
        let plan = stating(motion, StatedPath { via: Some(two.into()), ..path });
        let deviation = |time: f64| {
            let seen = tilt.inverse() * (place(&plan, time) - centre);
            libm::hypot(seen.z, libm::hypot(seen.x, seen.y) - radius)
        };
        let worst = greatest(&plan, 8_000, &deviation);
        assert_found(&plan, worst, &deviation);
    }
}

/// A quick move between two of the times that are always looked at: of a slide out and back, in the middle of the move or near
/// one of its ends, and of a turn that sets out and arrives on the line. Only a bound on the acceleration tells of it.
#[test]
fn one_quick_move_between_samples_is_found() {
    // A control point of Bernstein's polynomials of degree n at k adds most at k/n.
    let moves = [
        (vec![0.0, 0.02, 0.0], 0.01),
        (vec![0.0, 0.02, 0.0, 0.0, 0.0, 0.0], 0.02 * 0.4096),
        (vec![0.0, 0.0, 0.0, 0.0, 0.02, 0.0], 0.02 * 0.4096),
    ];
    for (begin, length) in [(10.05, 0.9), (20.02, 0.3)] {
        for (control, most) in &moves {
            let out = Motion::new(carrier(5.0)).segment(SLIDE_Y, begin, begin + length, control.clone());
            let along = Vec3::x() * ARM;
            let plan = stating(long(out), line(0.0, 64.0, along * 0.5, along * 1.5));
            assert_found(&plan, *most, &|time| place(&plan, time).y.abs());
        }
        // Slides that reach far make the bound a wide one.
        for reach in [0.01, 5.0] {
            let swing = Motion::new(carrier(reach));
            let mut swing = swing.segment(TURN_Z, begin, begin + length, vec![-0.5, 0.5]);
            swing.tracks.start.joints[TURN_Z] = -0.5;
            let (s, c) = libm::sincos(0.5);
            let ends = [Vec3::new(ARM * c, -ARM * s, 0.0), Vec3::new(ARM * c, ARM * s, 0.0)];
            let plan = stating(long(swing), line(0.0, 64.0, ends[0], ends[1]));
            assert_found(&plan, ARM * (1.0 - c), &|time| place(&plan, time).x - ARM * c);
        }
    }
}

/// A path that allows no deviation at all is kept by a port that rests on it.
#[test]
fn a_port_that_rests_on_its_path_is_no_distance_from_it() {
    let along = Vec3::x() * ARM;
    let still = Motion::new(carrier(5.0)).segment(TURN_X, 1.0, 2.0, vec![0.0, 0.0]);
    let plan = stating(long(still), line(0.0, 64.0, along, along * 2.0));
    assert_eq!(judged(&plan, 0.0), (Status::Proved, None));
}

/// A chord of a circle, run at an even rate in less time than lies between samples, leaves it by its sagitta.
#[test]
fn a_chord_leaves_its_arc_by_the_sagitta() {
    for radius in [0.08, 0.5] {
        let (s, c) = libm::sincos(0.4);
        let ends = [Vec3::new(-radius * s, radius * c, 0.0), Vec3::new(radius * s, radius * c, 0.0)];
        let mut motion = Motion::new(carrier(5.0));
        for (joint, control) in
            [(SLIDE_X, vec![ends[0].x - ARM, ends[1].x - ARM]), (SLIDE_Y, vec![ends[0].y, ends[1].y])]
        {
            motion = motion.segment(joint, 5.1, 5.9, control.clone());
            motion.tracks.start.joints[joint] = control[0];
        }
        let path = line(0.0, 64.0, ends[0], ends[1]);
        let plan = stating(long(motion), StatedPath { via: Some([0.0, radius, 0.0]), ..path });
        assert_found(&plan, radius * (1.0 - c), &|time| radius - place(&plan, time).norm());
    }
}

/// Returns a motion whose plan lasts 64 s.
fn long(mut motion: Motion) -> Motion {
    motion.tracks.duration = 64.0;
    motion
}

/// Returns the angle of an orientation from the nearest on the turn from one to another, rad, by a search that leaves a third at
/// a time.
fn angle_from_turn(
    rotation: &UnitQuaternion<f64>,
    axis: Vec3,
    whole: f64,
    start: &UnitQuaternion<f64>,
) -> f64 {
    let from = |by: f64| rotation.angle_to(&(turned(axis, by).rotation * start));
    let (mut low, mut high) = (0.0, whole);
    for _ in 0..50 {
        let third = (high - low) / 3.0;
        if from(low + third) < from(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    from((low + high) / 2.0)
}

/// The port turns on its way from before the first orientation to beyond the last, and tilts.
#[test]
fn angles_from_a_turn_are_those_to_the_nearest_orientation_on_it() {
    let mut n = Numbers(3);
    for round in 0..16 {
        let (from, to) = (n.between(-1.2, 0.0), n.between(0.1, 1.4));
        let (first, last) = (n.between(-1.0, 0.3), n.between(0.3, 1.0));
        let tilt = if round % 2 == 0 { n.between(-0.5, 0.5) } else { 0.0 };
        let mut motion = Motion::new(carrier(5.0))
            .segment(TURN_Z, 0.0, 8.0, vec![from, from, n.between(-1.4, 1.4), to, to])
            .segment(TURN_X, 1.0, 7.0, vec![0.0, tilt, 0.0]);
        motion.tracks.start.joints[TURN_Z] = from;
        // One of the turns is none.
        let (whole, start) = (if round % 8 == 7 { 0.0 } else { last - first }, turned(Vec3::z(), first));
        let end = turned(Vec3::z(), whole) * start;
        let path = line(0.0, 8.0, Vec3::zeros(), Vec3::x());
        let path = StatedPath { start, end, turned_within: Some(0.0), ..path };
        let plan = stating(motion, path);
        let tracks = plan.body.tracks().expect("a plan of joints");
        let deviation = |time: f64| {
            let [turn, tilt] = [TURN_Z, TURN_X].map(|joint| Replay::new(tracks).position(joint, time));
            let rotation = (turned(Vec3::z(), turn) * turned(Vec3::x(), tilt)).rotation;
            angle_from_turn(&rotation, Vec3::z(), whole, &start.rotation)
        };
        let (seen, worst) = (greatest(&plan, 64, &deviation), greatest(&plan, 320, &deviation));
        if seen < 0.01 {
            continue;
        }
        let judged_within = |angle: f64| {
            let mut plan = plan.clone();
            plan.paths[0].turned_within = Some(angle);
            judged(&plan, 10.0)
        };
        let (status, failure) = judged_within(0.98 * seen);
        let failure = failure.expect("it turns farther");
        assert_eq!((status, failure.limit), (Status::Failed, 0.98 * seen));
        assert!(failure.value > seen - 1e-5 && failure.value < worst + 1e-3, "{} {seen}", failure.value);
        assert!((deviation(failure.time) - failure.value).abs() < 1e-5);
        assert!(failure.message.contains("is turned by"), "{}", failure.message);
        // The angle is measured at samples alone: at the 65 even ones and where a segment ends.
        assert_eq!(judged_within(worst + 1e-3), (Status::Sampled(65), None));
    }
}

/// A rotation has two quaternions, and an angle as many values as there are whole turns: none of them makes a difference.
#[test]
fn orientations_are_the_same_a_whole_turn_on() {
    for (at, whole) in [(3.0, 0.5), (3.4, 0.5), (6.2, 0.5), (-3.0, 0.5), (1.0, 2.5), (-0.4, 2.5)] {
        for turns in [-1.0, 0.0, 1.0] {
            let mut motion = long(Motion::new(carrier(5.0)).segment(TURN_Z, 1.0, 2.0, vec![at, at]));
            motion.tracks.start.joints[TURN_Z] = at;
            let start = turned(Vec3::z(), at + turns * std::f64::consts::TAU);
            let end = turned(Vec3::z(), whole) * start;
            let path = line(0.0, 64.0, Vec3::zeros(), Vec3::x());
            for (start, off) in
                [(start, 0.0), (turned(Vec3::z(), 0.3) * start, 0.3), (turned(Vec3::z(), -0.3) * start, 0.0)]
            {
                let end = if off > 0.0 { turned(Vec3::z(), whole) * start } else { end };
                let path = StatedPath { start, end, turned_within: Some(off + 1e-6), ..path.clone() };
                assert_eq!(
                    judged(&stating(motion.clone(), path.clone()), 10.0).1,
                    None,
                    "{at} {whole} {turns} {off}"
                );
                if off > 0.0 {
                    let nearer = StatedPath { turned_within: Some(off - 1e-6), ..path };
                    let found = judged(&stating(motion.clone(), nearer), 10.0).1;
                    assert!(found.is_some_and(|failure| (failure.value - off).abs() < 1e-6));
                }
            }
        }
    }
}

/// A slide that moves twice as far as the one that it follows.
#[test]
fn a_slide_that_follows_another_carries_the_port_off_its_path() {
    let mut robot = carrier(5.0);
    Arc::make_mut(&mut robot.library).modules[0].joints[SLIDE_Y].mimic = Some(vec![(SLIDE_X, 2.0)]);
    let motion = Motion::new(robot).segment(SLIDE_X, 10.05, 10.95, vec![0.0, 0.01, 0.0]);
    let plan = stating(long(motion), line(0.0, 64.0, Vec3::zeros(), Vec3::x()));
    assert_found(&plan, 0.01, &|time| 2.0 * (place(&plan, time).x - ARM));
}

/// A port that has come off the module in whose frame its path is has no place there.
#[test]
fn a_port_that_nothing_connects_with_its_frame_fails() {
    for off in [false, true] {
        let mut motion = Motion::new(robots::chain(2)).smooth("m0", T, 0.1, 0.0, 1.0);
        let kind = DockingKind::Undock;
        if off {
            motion.tracks.events.push(DockingEvent { time: 1.0, kind, bond: 0, cause: CauseId(0) });
        }
        motion.tracks.duration = 3.0;
        let path = line(2.0, 3.0, Vec3::zeros(), Vec3::x());
        let plan = stating(motion, StatedPath { port: PortRef { module: 1, port: T }, ..path });
        let (status, failure) = judged(&plan, 10.0);
        assert_eq!(status == Status::Proved, !off, "{status:?}");
        let Some(failure) = failure else { continue };
        assert!(
            failure.message.contains("is not connected with the frame of its path"),
            "{}",
            failure.message
        );
        assert_eq!((failure.time, failure.value), (2.0, 0.0));
        assert_eq!(failure.at, ["m1.top"]);
    }
}
