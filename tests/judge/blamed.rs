//! The actions to blame for a failure: those which, held still, would have prevented it.

use crate::support::arms::robot_of;
use crate::support::motions::{Motion, STATICS, cause};
use crate::support::robots::{self, boxed, joint, link};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Shape, Vec3};
use modl::plan::verify::verify;
use modl::plan::{Body, CauseId, CheckKind, Failure, Ground, Plan, World};
use modl::robot::{Joint, JointId, JointKind, Limits, Link};
use std::sync::Arc;

const HELD: World = World { ground: Ground::Held, ..STATICS };

/// Returns a link that is a small ball, at a place in its frame (m), with a mass (kg).
fn ball(name: &str, mass: f64, at: Vec3) -> Link {
    let shape = vec![Placed { pose: shifted(at), shape: Shape::Sphere { radius: 0.01 } }];
    link(name, shape, mass, at, 0.5)
}

fn moving(name: &str, between: (usize, usize), kind: JointKind, at: Vec3, axis: Vec3) -> Joint {
    let limits = Limits { range: Some((-3.0, 3.0)), ..Limits::default() };
    joint(name, between, kind, shifted(at), axis, limits)
}

fn causes(failure: &Failure) -> Vec<u32> {
    failure.blame.iter().map(|cause| cause.0).collect()
}

fn slide(name: &str, between: (usize, usize), axis: Vec3) -> Joint {
    moving(name, between, JointKind::Prismatic, Vec3::zeros(), axis)
}

/// A ball on three slides, `gap` from a wall of the link that carries them; the wall is 0.2 m wide.
fn before_a_wall(gap: f64) -> Motion {
    let wall = boxed(Vec3::new(0.01, -0.1, -1.0), Vec3::new(0.1, 0.1, 1.0));
    let far = |name: &str, z: f64| ball(name, 1.0, Vec3::z() * z);
    let links = vec![
        link("wall", vec![wall], 1.0, Vec3::x() * 0.05, 0.5),
        far("a", 2.0),
        far("b", 2.1),
        ball("ball", 1.0, Vec3::zeros()),
    ];
    let mut joints = vec![slide("x", (0, 1), Vec3::x()), slide("y", (1, 2), Vec3::y())];
    joints.push(slide("z", (2, 3), Vec3::z()));
    let mut motion = Motion::new(robot_of(links, joints));
    motion.tracks.start.joints[0] = -gap;
    motion
}

/// Moves a joint evenly by a distance from where it is at the start, from 0 to 1 s.
fn moved(motion: Motion, joint: usize, by: f64) -> Motion {
    let from = motion.tracks.start.joints[joint];
    motion.segment(joint, 0.0, 1.0, vec![from, from + by])
}

#[test]
fn who_brings_links_together_is_to_blame_and_no_one_else() {
    for gap in [0.05e-3, 0.0, -0.05e-3, 0.01] {
        // Along the wall and up it the ball goes where it likes.
        let plan = [(0, gap + 0.02), (1, 0.05), (2, 0.2)]
            .into_iter()
            .fold(before_a_wall(gap), |motion, (joint, by)| moved(motion, joint, by))
            .plan(World::FREE);
        let verdict = verify(&plan);
        let [failure] = verdict.failures.as_slice() else { panic!("{:#?}", verdict.failures) };
        assert_eq!(failure.kind, CheckKind::Collision);
        assert!((failure.value - 0.02).abs() < 5e-5, "{failure:?}");
        assert_eq!(causes(failure), [0], "{gap}");
        assert!(!failure.blames_start);
    }
}

/// Beside the wall at first, the ball meets it because of two motions, each of which would have done no harm alone.
#[test]
fn each_of_two_that_bring_links_together_is_to_blame() {
    let mut beside = before_a_wall(0.03);
    beside.tracks.start.joints[1] = 0.15;
    let plan = [(0, 0.05), (1, -0.1), (2, 0.2)]
        .into_iter()
        .fold(beside, |motion, (joint, by)| moved(motion, joint, by))
        .plan(World::FREE);
    let verdict = verify(&plan);
    let [failure] = verdict.failures.as_slice() else { panic!("{:#?}", verdict.failures) };
    assert_eq!(causes(failure), [0, 1]);
}

/// The line that connects two modules is to blame if they are then in each other, and not the lines that set their joints.
#[test]
fn a_connection_is_to_blame_for_what_meets_in_it() {
    let mut robot = robots::chain(2);
    let library = Arc::make_mut(&mut robot.library);
    // The lower port is 10 mm within a block.
    let own = &mut library.modules[0];
    own.links[robots::CHASSIS].collides = vec![boxed(Vec3::repeat(-0.05), Vec3::repeat(0.05))];
    own.ports[robots::B].pose.translation.vector = Vec3::x() * -0.04;
    let mut plan = Motion::new(robot).plan(World::FREE);
    plan.causes = (0..2).map(cause).collect();
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    tracks.start_causes = vec![(JointId(0), CauseId(0)), (JointId(4), CauseId(0))];
    tracks.bond_causes = vec![(0, CauseId(1))];
    let verdict = verify(&plan);
    let meets = verdict.failures.iter().find(|failure| failure.message.contains("docks them"));
    let meets = meets.unwrap_or_else(|| panic!("{:#?}", verdict.failures));
    assert_eq!(meets.kind, CheckKind::Collision);
    let lies = "m0.bottom lies 10mm beneath the surface of its link";
    assert!(meets.message.contains(lies) && !meets.message.contains("m1.top lies"), "{}", meets.message);
    assert!(meets.blames_start);
    assert_eq!(causes(meets), [1]);
}

/// An arm along x whose joints turn about y, links of 0.5 m with their masses of 1 kg in the middle; the first joint bears
/// `limit`. The last joint turns its link about itself.
fn arm(count: usize, limit: f64) -> Motion {
    let mut links = vec![ball("base", 1.0, Vec3::zeros())];
    let mut joints = vec![];
    for index in 0..count {
        let at = Vec3::x() * (index as f64 * 0.5);
        let mut next = ball(&format!("l{index}"), 1.0, Vec3::x() * 0.25);
        next.pose = shifted(at);
        links.push(next);
        let axis = if index + 1 == count { Vec3::x() } else { Vec3::y() };
        let mut own = moving(&format!("j{index}"), (index, index + 1), JointKind::Revolute, at, axis);
        own.limits.effort = (index == 0).then_some(limit);
        joints.push(own);
    }
    Motion::new(robot_of(links, joints))
}

const GRAVITY: f64 = 9.80665;

fn torque(plan: &Plan) -> Failure {
    let verdict = verify(plan);
    let over = verdict.failures.iter().find(|failure| failure.kind == CheckKind::Torque);
    over.unwrap_or_else(|| panic!("{:#?}", verdict.failures)).clone()
}

/// The arm is too heavy at one sample, as it passes the level, and lighter before and after. What turns about itself then has
/// nothing to do with it.
#[test]
fn what_moves_as_a_load_is_too_great_for_a_moment_is_not_to_blame_for_that() {
    let level = GRAVITY * (0.25 + 0.75);
    for idle in [0.0, 0.4] {
        let mut motion = arm(2, 0.9995 * level);
        let [from, to] = [-15.0f64, 15.0].map(f64::to_radians);
        motion.tracks.start.joints[0] = from;
        // Samples at every 5 degrees.
        let motion = motion.segment(0, 0.0, 1.0, vec![from, to]).segment(1, idle, 1.0, vec![0.0, 0.3]);
        let mut plan = motion.plan(HELD);
        plan.settings.sample = 10.0;
        let failure = torque(&plan);
        assert!(failure.until == Some(failure.time), "{failure:?}");
        assert_eq!(causes(&failure), [0]);
    }
}

/// Each of five joints raises the arm a little; without any one of them it would be light enough.
#[test]
fn at_most_three_actions_are_named() {
    let hanging = f64::to_radians(80.0);
    let count = 6;
    let weight = |turned: &[f64]| {
        let (mut x, mut turn, mut sum) = (0.0, 0.0, 0.0);
        for angle in turned {
            turn += angle;
            sum += GRAVITY * (x + 0.25 * libm::cos(turn));
            x += 0.5 * libm::cos(turn);
        }
        sum
    };
    let posture = |raised: &[bool]| {
        let of = |(index, raised): (usize, &bool)| {
            let begun = if index == 0 { hanging } else { 0.0 };
            if *raised { begun - 0.1 } else { begun }
        };
        raised.iter().enumerate().map(of).chain([0.0]).collect::<Vec<f64>>()
    };
    let all = weight(&posture(&[true; 5]));
    let without = (0..5).map(|held| weight(&posture(&[0, 1, 2, 3, 4].map(|j| j != held))));
    let most = without.fold(0.0, f64::max);
    assert!(most < 0.999 * all);
    let raised = |limit: f64| {
        let mut motion = arm(count, limit);
        motion.tracks.start.joints[0] = hanging;
        (0..5).fold(motion, |motion, joint| moved(motion, joint, -0.1)).plan(HELD)
    };
    let failure = torque(&raised((most + all) / 2.0));
    assert_eq!(failure.blame.len(), 3, "{failure:?}");
    // With a limit that any four of them are too much for, no one alone is to blame: those that move are.
    let failure = torque(&raised(0.9 * most));
    assert_eq!(failure.blame.len(), 3, "{failure:?}");
}

/// Two joints raise an arm that hangs, and what either of them raises within 5 degrees is too much already.
#[test]
fn those_who_move_are_to_blame_together_if_no_one_is_alone() {
    let mut motion = arm(4, 0.5);
    motion.tracks.start.joints[0] = std::f64::consts::FRAC_PI_2;
    let raised = vec![0.0, -1.2];
    // The last turns about itself, and has come to rest before.
    let motion = motion.segment(3, 0.0, 0.2, vec![0.0, 0.3]);
    let motion = motion.segment(1, 0.2, 1.0, raised.clone()).segment(2, 0.2, 1.0, raised);
    let mut plan = motion.plan(HELD);
    plan.settings.sample = 10.0;
    let failure = torque(&plan);
    let alone = |joint: usize| {
        let mut plan = plan.clone();
        let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
        tracks.tracks.retain(|track| track.joint.0 as usize != joint);
        torque(&plan).time
    };
    assert_eq!([alone(1), alone(2)], [failure.time; 2]);
    assert_eq!(causes(&failure), [1, 2]);
    assert!(!failure.blames_start);
}

/// A table of 0.4 m with three slides of 5 kg each: along x, along y, and up. The first passes the edge, and so does the second
/// much later.
#[test]
fn a_fall_is_blamed_on_what_caused_it_and_not_on_what_falls_later() {
    let top = boxed(Vec3::new(-0.2, -0.2, 0.0), Vec3::new(0.2, 0.2, 0.02));
    let weight = |name: &str, z: f64| ball(name, 5.0, Vec3::z() * z);
    let links = vec![
        link("table", vec![top], 1.0, Vec3::z() * 0.01, 0.5),
        weight("a", 0.1),
        weight("b", 0.2),
        weight("c", 0.3),
    ];
    let joints =
        vec![slide("x", (0, 1), Vec3::x()), slide("y", (0, 2), Vec3::y()), slide("up", (0, 3), Vec3::z())];
    let motion = Motion::new(robot_of(links, joints));
    let motion = motion.segment(0, 0.0, 1.0, vec![0.0, 0.8]).segment(2, 0.0, 1.0, vec![0.0, 0.1]).segment(
        1,
        3.0,
        4.0,
        vec![0.0, 1.0],
    );
    let verdict = verify(&motion.plan(STATICS));
    let fall =
        verdict.failures.iter().find(|failure| failure.kind == CheckKind::Stability).expect("it falls");
    // 5 of 16 kg at 0.64 m are beyond the edge.
    assert!((fall.time - 0.8).abs() < 1e-3, "{fall:?}");
    assert_eq!(causes(fall), [0]);
}
