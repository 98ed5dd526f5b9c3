//! Parts that are let go: how their fall is told, how one that tips over is held, and how those that float move on.

use super::momentum::{FACE, PUSHER, PUSHING, bodies};
use crate::support::desk::run_clean;
use crate::support::motions::STATICS;
use crate::support::verdicts::failures_of;
use modl::geometry::{Placed, Pose, Shape, Vec3, pose::turned};
use modl::plan::verify::articulated::ClusterPaths;
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, DynamicsModel, Ground, Obstacle, Plan, World, WorldFrom};

const WEIGHTLESS: World = World { dynamics: DynamicsModel::Full, ..World::FREE };

/// Returns the plan of a behaviour in a world; it is written in one without weight, in which nothing falls.
fn plan(declarations: &str, behavior: &str, world: World) -> Plan {
    let free = "world: world(gravity: 0m/s^2, ground: off, dynamics: statics)";
    let program = format!("{FACE}{declarations}\nemit(plan({behavior}, {free}), \"p.json\")\n");
    let mut plan = run_clean(&program).plan("p.json");
    plan.worlds[0].world = world;
    plan
}

const TOWER: &str = "
module Block {
  link body = box(100mm, 100mm, 100mm, mass: 1kg)
  port top: Face on body at [0mm, 0mm, 50mm] facing +Z up +X
  port bottom: Face on body at [0mm, 0mm, -50mm] facing -Z up +X
}
config Tower {
  part m[2]: Block
  connect m[0].top -- m[1].bottom
  base m[0]
  behavior let_go = Sc(wait(300ms), undock(m[0].top), wait(700ms))
}";

#[test]
fn what_falls_in_the_air_falls_over_nothing() {
    let found = failures_of(CheckKind::Stability, &verify(&plan(TOWER, "Tower().let_go()", STATICS)));
    let [fall] = found.as_slice() else { panic!("{found:#?}") };
    assert!(fall.message.contains("m[1]") && fall.message.ends_with(" falls at 300ms, by 100mm"), "{fall:?}");
}

/// A lever that a heavy block holds: by itself its foot is too small for its arm, whose mass is most of its own.
const LEVER: &str = "
module Anchor {
  link body = box(200mm, 200mm, 100mm, mass: 20kg) at [0mm, 0mm, 50mm]
  port side: Face on body at [100mm, 0mm, 0mm] facing +X up +Z
}
module Lever {
  link foot = box(60mm, 60mm, 100mm, mass: 200g) at [0mm, 0mm, 50mm]
  link arm = box(300mm, 40mm, 20mm, mass: 1kg) at [190mm, 0mm, 120mm]
  joint lift : foot -> arm = revolute(axis: Y) at [0mm, 0mm, 120mm]
  port side: Face on foot at [-30mm, 0mm, 0mm] facing -X up +Z
}
config Held {
  part anchor: Anchor
  part lever: Lever
  connect anchor.side -- lever.side
  base anchor
  behavior let_go = Sc(wait(300ms), undock(anchor.side), move(lever.lift, to: -40deg, in: 2s))
}";

/// A part that is held where it tips over keeps its foot on the ground, whatever its arm does.
#[test]
fn a_part_that_is_held_as_it_tips_over_keeps_its_foot_on_the_ground() {
    let mut plan = plan(LEVER, "Held().let_go()", STATICS);
    plan.settings.unstable_for = 10.0;
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    for step in 4..23 {
        let [_, lever] = bodies(&plan, &paths, 0.1 * f64::from(step));
        let (moved, angle) = (lever.translation.vector.z, lever.rotation.angle());
        assert!(moved.abs() < 1e-6 && angle < 1e-5, "{step}: {moved} m, {angle} rad");
    }
}

/// Returns the declarations of a body that lets a block go before its slide moves, and of one alone.
fn early() -> String {
    let early = "
config Early { part a: Pusher  part b: Block  connect a.tip -- b.face  base a
  set a.out = 100mm
  behavior part_ways = Sc(wait(1s), undock(a.tip), move(a.out, to: 0mm, in: 2s))
}
config Alone { part a: Pusher
  behavior push = Sc(wait(1s), move(a.out, to: 100mm, in: 2s))
}";
    format!("{PUSHING}{PUSHER}{early}")
}

/// A block that is let go at the instant at which the slide begins to move, even with a jerk, was at rest, and stays.
#[test]
fn what_is_let_go_before_a_joint_moves_stays() {
    let mut plan = plan(&early(), "Early().part_ways()", WEIGHTLESS);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    let [back] = tracks.tracks[0].segments.as_mut_slice() else { panic!("{:?}", tracks.tracks) };
    assert_eq!(back.start, 1.0);
    back.control = vec![0.1, 0.0];
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    let [body, block] = bodies(&plan, &paths, 3.0).map(|pose| pose.translation.vector);
    assert!(block.norm() < 1e-9, "{block:?}");
    // The slide goes back by 100 mm, and the common centre of mass of both stays.
    assert!((body - Vec3::new(0.1 * 0.5 / 5.5, 0.0, 0.0)).norm() < 1e-9, "{body:?}");
}

/// A robot among obstacles that loses the ground floats from then on, from rest: its body goes back as its slide goes out.
#[test]
fn a_robot_that_loses_its_ground_floats() {
    for ground in [Ground::Settle, Ground::Held, Ground::Off] {
        let gravity = if ground == Ground::Settle { 9.80665 } else { 0.0 };
        let mut plan = plan(&early(), "Alone().push()", World { ground, gravity, ..WEIGHTLESS });
        plan.worlds.push(WorldFrom { from: 0.5, world: WEIGHTLESS });
        let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
        let wall =
            Placed { pose: Pose::translation(5.0, 0.0, 0.0), shape: Shape::Box { size: Vec3::repeat(0.1) } };
        tracks.obstacles = vec![Obstacle { name: "wall".into(), shapes: vec![wall] }].into();
        let verdict = verify(&plan);
        assert!(verdict.ok(), "{ground:?}: {:#?}", verdict.failures);
        let expected = -0.1 * 0.5 / 5.5;
        assert!(
            (verdict.travel[0] - expected).abs() < 1e-6,
            "{ground:?}: {:?} of {expected}",
            verdict.travel
        );
    }
}

/// A plate on a rotor whose axis leans by 45 degrees from the plate's normal, through its centre.
const TOP: &str = "
module Holder {
  link body = box(100mm, 100mm, 100mm, mass: 5kg) at [0mm, 0mm, -500mm]
  link rotor = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, -30mm]
  joint spin : body -> rotor = revolute(axis: X + Z, range: -360deg..360deg)
  port top: Face on rotor at [0mm, 0mm, 10mm] facing +Z up +X
}
module Plate {
  link body = box(200mm, 200mm, 40mm, mass: 2kg)
  port under: Face on body at [0mm, 0mm, -20mm] facing -Z up +X
}
config Top { part a: Holder  part b: Plate  connect a.top -- b.under  base a
  behavior part_ways allows collision = Sc(Pc(move(a.spin, to: 90deg, in: 2s), Sc(wait(1s), undock(a.top))), move(a.spin, to: 45deg, in: 2s))
}";

/// A symmetric top on which no torque acts precesses about its angular momentum L at the rate L / I, with I about a diameter,
/// as it turns about its own axis.
#[test]
fn a_plate_that_is_let_go_as_it_turns_precesses() {
    let held = World { ground: Ground::Held, ..WEIGHTLESS };
    let plan = plan(TOP, "Top().part_ways()", held);
    let rate = plan.body.tracks().expect("modules").tracks[0].velocity(1.0);
    assert!(rate > 1.0, "{rate}");
    let axis = Vec3::new(1.0, 0.0, 1.0).normalize();
    let begun = turned(axis, 45f64.to_radians()).rotation;
    // Of a plate a x a x c, without the mass over 12.
    let (about_diameter, about_normal) = (0.2 * 0.2 + 0.04 * 0.04, 2.0 * 0.2 * 0.2);
    let normal = begun * Vec3::z();
    let along = rate * axis.dot(&normal);
    let spin = axis * rate * about_diameter + normal * along * (about_normal - about_diameter);
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    for time in [0.5, 1.0, 2.0, 3.0] {
        let turn = |by: Vec3| turned(by, by.norm() * time).rotation;
        let own = along * (1.0 - about_normal / about_diameter);
        let expected = turn(spin / about_diameter) * begun * turned(Vec3::z(), own * time).rotation;
        let [_, plate] = bodies(&plan, &paths, 1.0 + time);
        let off = plate.rotation.angle_to(&expected);
        assert!(plate.translation.vector.norm() < 1e-6, "{plate:?}");
        assert!(off < 1e-4, "{time}: {off}");
    }
}
