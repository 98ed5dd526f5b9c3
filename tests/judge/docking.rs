//! Docking between robots that stand by themselves: within capture, at rest, with the error kept.
#![allow(non_snake_case)]

use crate::support::desk::run_clean;
use modl::geometry::{Placed, Pose, Shape, Vec3, pose::turned};
use modl::plan::verify::articulated::{ClusterPaths, dock_turns};
use modl::plan::verify::verify;
use modl::plan::{
    Body, CheckKind, DockingEvent, DockingKind, LastingTrees, Obstacle, Plan, Status, Tracks, Verdict, file,
    reversed, sliced,
};
use modl::robot::{ClusterPose, Kinematics, PortRef};
use modl::simulate::{Settings, simulate};
use std::sync::Arc;

/// A block with a slide that carries a port, and a block with one: the ports meet when the slide is out by 50 mm, as drawn.
const PUSHER: &str = "
connector Face { mates Face, turns 4, capture 4mm 5deg }
module Pusher {
  link body = box(100mm, 100mm, 100mm, mass: 5kg)
  link slide = box(20mm, 60mm, 60mm, mass: 500g) at [70mm, 0mm, 0mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..150mm, max_force: 50N) at [70mm, 0mm, 0mm]
  port tip: Face on slide at [80mm, 0mm, 0mm] facing +X up +Z
}
module Block {
  link body = box(100mm, 60mm, 60mm, mass: 1kg)
  port face: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config Both {
  part a: Pusher
  part b: Block
  connect a.tip -- b.face
  base a
  behavior fetch(out: Length, wait_for: Time) = Sc(
    move(a.out, to: out, in: 2s), wait(wait_for), undock(a.tip), move(a.out, to: 0mm, in: 2s),
  )
}
";

/// Returns a plan of two robots without weight: the slide goes out by 50 mm, docks with the block whose face is then at `at`
/// in the frame of a perfect mate, and draws it back. `rest`: the time between coming to rest and docking, s.
fn fetch(at: Pose, rest: f64) -> Plan {
    let call = "plan(Both().fetch(50mm, 1s), world: world(gravity: 0m/s^2, ground: off, dynamics: statics))";
    let mut plan = run_clean(&format!("{PUSHER}\nemit({call}, \"p.json\")\n")).plan("p.json");
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    // Written with both docked; here the block stands by itself until the slide has come to it.
    tracks.start.bonds[0] = false;
    let event = tracks.events[0].clone();
    tracks.events = vec![DockingEvent { time: 2.0 + rest, kind: DockingKind::Dock, ..event }];
    // The slide is out by 50 mm: there the second port of a perfect mate is the first one turned round.
    let (robot, out) = (&tracks.robot, [0.050]);
    let numbers = Kinematics::new(robot, &[false], 0);
    let mut poses = vec![Pose::identity(); numbers.link_count()];
    numbers.link_poses(&out, &Pose::identity(), &mut poses);
    let X_WP = numbers.port_pose(robot, robot.bonds[0].a, &poses);
    let X_BQ = robot.module_type(1).ports[0].pose;
    let pose = X_WP * turned(Vec3::z(), std::f64::consts::PI) * at * X_BQ.inverse();
    tracks.start.clusters = vec![ClusterPose { reference: 1, pose }];
    plan
}

fn tracks(plan: &mut Plan) -> &mut Tracks {
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    tracks
}

fn failures(verdict: &Verdict) -> Vec<CheckKind> {
    verdict.failures.iter().map(|failure| failure.kind).collect()
}

/// Returns the world pose of the block's body at a time, s.
fn block(plan: &Plan, time: f64) -> Pose {
    let robot = &plan.body.tracks().expect("modules").robot;
    let numbers = Kinematics::new(robot, &[true], 0);
    let mut poses = vec![Pose::identity(); numbers.link_count()];
    ClusterPaths::of(plan, f64::INFINITY).expect("two robots").place(time, &mut poses);
    numbers.module_pose(1, &poses)
}

#[test]
fn robots_dock_within_capture_and_keep_their_error() {
    let degree = 1f64.to_radians();
    let exact = fetch(Pose::identity(), 1.0);
    assert!(verify(&exact).ok(), "{:#?}", verify(&exact).failures);
    // Sideways and turned by less than the capture of 4 mm and 5 degrees.
    let error = Pose::translation(0.0, 0.0, 0.0039) * turned(Vec3::x(), 4.9 * degree);
    let near = fetch(error, 1.0);
    let verdict = verify(&near);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    assert!(verdict.notes.iter().any(|note| note.contains("3.9mm and 4.9deg apart")), "{:?}", verdict.notes);
    // Nothing jumps as they dock, and the block follows the slide by its 50 mm with the error kept.
    let (before, after, end) = (block(&near, 2.9), block(&near, 3.0), block(&near, 5.0));
    assert!((before.inverse() * after).translation.vector.norm() < 1e-9);
    let drawn = end.translation.vector - after.translation.vector;
    assert!((drawn - Vec3::new(-0.050, 0.0, 0.0)).norm() < 1e-9, "{drawn:?}");
    assert!(after.rotation.angle_to(&end.rotation) < 1e-9);
    for beyond in [
        Pose::translation(0.0, 0.0, 0.005),
        turned(Vec3::x(), 6.0 * degree),
        Pose::translation(0.005, 0.0, 0.0),
    ] {
        let verdict = verify(&fetch(beyond, 1.0));
        assert!(failures(&verdict).contains(&CheckKind::Docking), "{beyond:?}: {:#?}", verdict.failures);
    }
    // Too near by 1.5 mm is within capture, and explains that they overlap by as much. The port's x axis is its normal.
    let pressed = verify(&fetch(Pose::translation(0.0015, 0.0, 0.0), 1.0));
    assert!(pressed.ok(), "{:#?}", pressed.failures);
}

#[test]
fn ports_that_move_against_each_other_do_not_dock() {
    // Half-way through its 2 s the slide is at its greatest speed, 50 mm in 2 s and more.
    let mut plan = fetch(Pose::translation(0.025, 0.0, 0.0), 1.0);
    tracks(&mut plan).events[0].time = 1.0;
    tracks(&mut plan).events.truncate(1);
    let verdict = verify(&plan);
    let fast: Vec<_> = verdict.failures.iter().filter(|f| f.message.contains("too fast")).collect();
    let [fast] = fast.as_slice() else { panic!("{:#?}", verdict.failures) };
    let speed = tracks(&mut plan).tracks[0].velocity(1.0);
    assert!(speed > 0.025 && (fast.value - speed).abs() < 1e-4, "{} of {speed}", fast.value);
    assert_eq!(fast.blame, [tracks(&mut plan).events[0].cause]);
    // A connector that captures at that speed takes them, and one that captures a little less does not.
    for (capture, docks) in [(speed * 1.01, true), (speed * 0.99, false)] {
        let library = Arc::make_mut(&mut plan.library);
        let stated = library.connectors[0].capture.as_mut().expect("it is stated");
        stated.speed = Some(capture);
        let library = plan.library.clone();
        tracks(&mut plan).robot.library = library;
        let failures = verify(&plan).failures;
        assert_eq!(failures.iter().all(|f| !f.message.contains("too fast")), docks, "{failures:#?}");
    }
}

#[test]
fn the_turn_is_the_allowed_one_nearest_to_how_the_robots_stand() {
    for (quarter, degrees) in [(0, 2.0), (1, 92.0), (2, 178.0), (3, 272.0), (3, 266.0)] {
        let turned_block = turned(Vec3::x(), f64::to_radians(degrees));
        let mut plan = fetch(turned_block, 1.0);
        let turns = dock_turns(&plan, &[0]);
        let [(0, turn)] = turns.as_slice() else { panic!("{turns:?}") };
        assert_eq!(*turn, quarter, "{degrees}");
        tracks(&mut plan).robot.bonds[0].turn = *turn;
        assert!(verify(&plan).ok(), "{degrees}: {:#?}", verify(&plan).failures);
    }
}

#[test]
fn obstacles_are_hit_and_the_command_is_to_blame() {
    let obstacle = |gap: f64| {
        let mut plan = fetch(Pose::translation(1.0, 0.0, 0.0), 1.0);
        let own = tracks(&mut plan);
        own.events.clear();
        // The slide ends 10 mm beyond its origin, which is 70 mm from the body's and 50 mm out; the box is 20 mm thick.
        let pose = Pose::translation(0.070 + 0.050 + 0.010 + 0.010 + gap, 0.0, 0.0);
        let shapes = vec![Placed { pose, shape: Shape::Box { size: Vec3::new(0.02, 0.1, 0.1) } }];
        own.obstacles = vec![Obstacle { name: "wall".into(), shapes }].into();
        plan
    };
    let free = verify(&obstacle(0.003));
    assert!(free.ok(), "{:#?}", free.failures);
    let clearance = free.clearance.expect("there is something near");
    assert!((clearance.value - 0.003).abs() < 1e-9 && clearance.at == ["a", "wall"], "{clearance:?}");
    let mut hit = obstacle(-0.002);
    let verdict = verify(&hit);
    assert_eq!(failures(&verdict), [CheckKind::Collision], "{:#?}", verdict.failures);
    assert!((verdict.failures[0].value - 0.002).abs() < 1e-9 && verdict.failures[0].at == ["a", "wall"]);
    assert_eq!(verdict.failures[0].blame, [tracks(&mut hit).tracks[0].segments[0].cause]);
    // Far away it is proved, between samples, too.
    let far = verify(&obstacle(1.0));
    let collision = far.checks.iter().find(|check| check.kind == CheckKind::Collision);
    assert_eq!(collision.map(|check| check.status.clone()), Some(Status::Proved), "{:?}", far.checks);
}

#[test]
fn modules_that_stand_for_no_robot_hang_on_nothing() {
    let mut plan = fetch(Pose::identity(), 1.0);
    let own = tracks(&mut plan);
    own.start.clusters.clear();
    own.events.clear();
    let verdict = verify(&plan);
    assert!(failures(&verdict).contains(&CheckKind::Connectedness), "{:#?}", verdict.failures);
}

/// A plan that begins where another ended begins with every robot where that left it, also backwards.
#[test]
fn plans_run_backwards_and_are_cut_with_robots_where_they_stand() {
    let mut plan = fetch(Pose::translation(0.0, 0.0, 0.001), 1.0);
    let undone = DockingEvent { time: 5.0, kind: DockingKind::Undock, ..tracks(&mut plan).events[0].clone() };
    tracks(&mut plan).events.push(undone);
    assert!(verify(&plan).ok(), "{:#?}", verify(&plan).failures);
    let back = reversed(&plan);
    let start = &back.body.tracks().expect("modules").start.clusters;
    let ended = block(&plan, 5.0);
    assert!(start.len() == 1 && (start[0].pose.inverse() * ended).translation.vector.norm() < 1e-9);
    // Backwards it docks at once and brings the block back to where it stood.
    assert!(verify(&back).ok(), "{:#?}", verify(&back).failures);
    let moved = block(&back, 5.0).translation.vector - block(&plan, 0.0).translation.vector;
    assert!(moved.norm() < 1e-9, "{moved:?}");
    let rest = sliced(&plan, 4.0, 5.0).expect("a part of the plan");
    assert!(rest.body.tracks().expect("modules").start.clusters.is_empty(), "they are docked then");
}

/// A plan that is cut while robots are docked begins with the error with which they docked, also from its file and backwards.
#[test]
fn a_plan_cut_while_robots_are_docked_keeps_the_error_of_their_docking() {
    let plan = fetch(Pose::translation(0.0, 0.0, 0.0039) * turned(Vec3::x(), f64::to_radians(4.9)), 1.0);
    let rest = sliced(&plan, 3.0, 5.0).expect("a part of the plan");
    let text = file::write(&rest).expect("a plan that is written");
    let rest = file::read(&text).expect("a plan that was written is read");
    let Tracks { start, robot, .. } = rest.body.tracks().expect("modules");
    assert!(start.clusters.is_empty() && start.bonds == [true], "they are docked then");
    let same = |a: Pose, b: Pose| {
        let off = a.inverse() * b;
        assert!(off.translation.vector.norm() < 1e-9 && off.rotation.angle() < 1e-9, "{a:?} {b:?}");
    };
    for time in [0.0, 0.7, 2.0] {
        same(block(&rest, time), block(&plan, 3.0 + time));
    }
    assert!(verify(&rest).ok(), "{:#?}", verify(&rest).failures);
    let back = reversed(&rest);
    assert!(verify(&back).ok(), "{:#?}", verify(&back).failures);
    for time in [0.0, 1.3, 2.0] {
        same(block(&back, time), block(&plan, 5.0 - time));
    }
    // Simulated, it begins and ends with the error, too: what is drawn is the block where its link is.
    let simulated =
        simulate(&rest, &Settings { link_contacts: false, ..Settings::default() }).expect("it is played");
    let lasting =
        LastingTrees::new(rest.body.tracks().expect("modules"), &Pose::identity(), &[], &simulated.apart);
    let mut poses = lasting.poses.clone();
    for moment in [&simulated.motion[0], simulated.motion.last().expect("it moves")] {
        lasting.trees[0].link_poses(&moment.joints, &moment.base, &mut poses);
        let port = |module: usize| lasting.start.port_pose(robot, PortRef { module, port: 0 }, &poses);
        let error = (port(0) * turned(Vec3::z(), std::f64::consts::PI)).inverse() * port(1);
        let off = (error.translation.vector.norm(), error.rotation.angle());
        assert!((off.0 - 0.0039).abs() < 1e-9 && (off.1 - 4.9f64.to_radians()).abs() < 1e-9, "{off:?}");
    }
    // A file that states more than is captured is refused, as a docking is.
    let mut far = rest.clone();
    tracks(&mut far).start.misalignments[0].pose = Pose::translation(0.0, 0.0, 0.005);
    assert!(failures(&verify(&far)).contains(&CheckKind::Docking), "{:#?}", verify(&far).failures);
    // Undone, the bond is forgotten, and with it its error.
    let mut undone = rest.clone();
    let event = tracks(&mut plan.clone()).events[0].clone();
    tracks(&mut undone).events = vec![DockingEvent { time: 2.0, kind: DockingKind::Undock, ..event }];
    assert!(verify(&undone).ok(), "{:#?}", verify(&undone).failures);
    let after = sliced(&undone, 2.0, 2.0).expect("the end of the plan");
    let start = &after.body.tracks().expect("modules").start;
    assert!(start.misalignments.is_empty() && start.clusters.len() == 1, "{start:?}");
    same(start.clusters[0].pose, block(&plan, 5.0));
}

#[test]
fn robots_placed_into_each_other_are_refused() {
    let mut plan = fetch(Pose::translation(-0.04, 0.0, 0.0), 1.0);
    let own = tracks(&mut plan);
    own.events.clear();
    own.tracks.clear();
    own.start.clusters[0].pose = Pose::translation(0.05, 0.0, 0.0);
    let verdict = verify(&plan);
    assert_eq!(failures(&verdict), [CheckKind::Collision]);
    assert!(verdict.failures[0].blames_start, "{:#?}", verdict.failures);
}
