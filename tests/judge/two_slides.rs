//! Two slides that carry a ball past a post, with rates that jump, vanish and change sign at times of their own: what meets is
//! known by closed forms of the tests' own.

use crate::support::arms::robot_of;
use crate::support::motions::Motion;
use crate::support::numbers::Numbers;
use crate::support::replay::Replay;
use crate::support::robots::{boxed, face, joint, link};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Failure, Plan, World};
use modl::robot::{Assembly, Bond, JointKind, Limits, ModuleInstance, Port, PortRef};
use std::sync::Arc;

/// The radii of the ball and of the post, which is a ball, too, m.
const BALL: f64 = 0.05;
const POST: f64 = 0.02;
/// The depth that counts as touch, m.
const TOUCH: f64 = 1e-4;

fn ball(at: Vec3, radius: f64) -> Vec<Placed> {
    vec![Placed { pose: shifted(at), shape: Shape::Sphere { radius } }]
}

/// Returns a ball on two slides, and a post in the plane of the ball: a link of the same module, or of one that is docked with
/// it.
fn robot(post: [f64; 2], docked: bool) -> Assembly {
    let at = Vec3::new(post[0], post[1], 0.0);
    let far = |height: f64| boxed(Vec3::new(-1e-3, -1e-3, height), Vec3::new(1e-3, 1e-3, height + 1e-3));
    let own = if docked { vec![far(9.0)] } else { [vec![far(9.0)], ball(at, POST)].concat() };
    let links = vec![
        link("rail", own, 1.0, Vec3::zeros(), 0.5),
        link("cart", vec![far(5.0)], 1.0, Vec3::zeros(), 0.5),
        link("ball", ball(Vec3::zeros(), BALL), 1.0, Vec3::zeros(), 0.5),
    ];
    let slide = |name: &str, between, axis| {
        let limits = Limits { range: None, speed: None, acceleration: None, effort: None };
        joint(name, between, JointKind::Prismatic, Pose::identity(), axis, limits)
    };
    let slides = vec![slide("x", (0, 1), Vec3::x()), slide("y", (1, 2), Vec3::y())];
    let mut robot = robot_of(links, slides);
    if docked {
        // Of two ports that mate, one looks against the other: the post's frame is turned by half a turn about z.
        let library = Arc::make_mut(&mut robot.library);
        let mut other = library.modules[0].clone();
        other.name = "Post".into();
        let place = Vec3::new(-at.x, -at.y, 0.0);
        other.links = vec![link("post", ball(place, POST), 1.0, place, 0.5)];
        other.joints.clear();
        library.modules.push(other);
        let port = Port { name: "side".into(), link: 0, pose: Pose::identity(), connector: 0 };
        library.modules.iter_mut().for_each(|kind| kind.ports.push(port.clone()));
        library.connectors.push(face());
        robot.modules.push(ModuleInstance { name: "p".into(), kind: 1 });
        let port = |module| PortRef { module, port: 0 };
        robot.bonds.push(Bond { a: port(0), b: port(1), turn: 0 });
    }
    robot
}

/// Returns what the judge finds of collisions, and the least distance that it tells.
fn judged(plan: &Plan) -> (Option<Failure>, Option<f64>) {
    let verdict = verify(plan);
    let form = verdict.failures.iter().find(|failure| failure.kind == CheckKind::Form);
    assert_eq!(form, None);
    let met = verdict.failures.iter().find(|failure| failure.kind == CheckKind::Collision).cloned();
    (met, verdict.clearance.map(|worst| worst.value))
}

/// Returns the least distance between ball and post over a plan, m, and asserts that the judge finds what it must.
fn assert_judged(plan: &Plan, post: [f64; 2], of: &str) {
    let replay = Replay::new(plan.body.tracks().expect("a plan of joints"));
    let distance = |time: f64| {
        let [x, y] = [0, 1].map(|joint| replay.position(joint, time) - post[joint]);
        libm::hypot(x, y) - BALL - POST
    };
    let nearest = |from: f64, to: f64| {
        let times = (0..=4000).map(|i| from + (to - from) * f64::from(i) / 4000.0);
        times
            .map(|time| (distance(time), time))
            .fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a })
    };
    let duration = plan.body.duration();
    let (_, time) = nearest(0.0, duration);
    let (least, _) = nearest((time - 2e-3).max(0.0), (time + 2e-3).min(duration));
    let (met, clearance) = judged(plan);
    if least < -TOUCH - 1e-5 {
        let met = met.unwrap_or_else(|| panic!("{of}: they meet, {least} m deep: {plan:?}"));
        assert!((met.value + least).abs() < 3e-5, "{of}: {} of {least}", met.value);
    } else if least > -TOUCH + 1e-5 {
        assert_eq!(met, None, "{of}: {least} m");
        let clearance = clearance.expect("there are two");
        assert!((clearance - least).abs() < 3e-5, "{of}: {clearance} of {least}");
    }
}

/// One slide goes on evenly; the other changes its rate at once, from one direction to the other or from rest. All the while up
/// to the end the way leads past the post; seen from the middle, on as then, far from it.
#[test]
fn a_rate_that_jumps_as_another_joint_goes_on_is_found() {
    for docked in [false, true] {
        for before in [1.0, 0.0] {
            // Up to 2.1 s, and from there downwards until 4 s.
            let top = 2.1 * before;
            let mut motion = Motion::new(robot([0.0; 2], docked)).segment(0, 0.0, 4.0, vec![0.0, 4.0]);
            if before > 0.0 {
                motion = motion.segment(1, 0.0, 2.1, vec![0.0, top]);
            }
            let motion = motion.segment(1, 2.1, 4.0, vec![top, top - 1.9]);
            for gap in [-0.01, 0.01] {
                let post = [4.0 + BALL + POST + gap, top - 1.9];
                let mut motion = Motion { tracks: motion.tracks.clone() };
                motion.tracks.robot = robot(post, docked);
                assert_judged(&motion.plan(World::FREE), post, &format!("{docked} {before} {gap}"));
            }
        }
    }
}

/// Even rates that change now and then, by jumps, with rests; or polynomials of all degrees, with rests. The post is near some
/// place of the way.
#[test]
fn random_ways_past_a_post_are_judged_by_their_least_distance() {
    let mut n = Numbers(5);
    for round in 0..160 {
        let even = round % 2 == 0;
        let mut motion = Motion::new(robot([0.0; 2], round % 4 < 2));
        for joint in 0..2 {
            let (mut time, mut at) = (n.between(0.0, 1.0), 0.0);
            for _ in 0..3 {
                let length = n.between(0.3, 2.0);
                let mut control = vec![at];
                if even {
                    let rate = [-1.0, 1.0, n.between(-1.0, 1.0)][n.below(3)];
                    control.push(at + rate * length);
                } else {
                    control.extend((0..2 + n.below(4)).map(|_| at + n.between(-0.5, 0.5)));
                }
                at = control[control.len() - 1];
                motion = motion.segment(joint, time, time + length, control);
                time += length + if n.below(2) == 0 { 0.0 } else { n.between(0.0, 1.0) };
            }
        }
        let replay = Replay::new(&motion.tracks);
        let time = motion.tracks.duration * n.next();
        let away = n.direction().xy().normalize() * (BALL + POST + n.between(-0.002, 0.002));
        let post = [0, 1].map(|joint| replay.position(joint, time) + away[joint]);
        motion.tracks.robot = robot(post, round % 4 < 2);
        assert_judged(&motion.plan(World::FREE), post, &format!("round {round}"));
    }
}
