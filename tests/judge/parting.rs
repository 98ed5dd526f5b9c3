//! Robots that come apart: each part is judged by itself, where and when it comes off.

use crate::support::desk::run_clean;
use crate::support::verdicts::status;
use modl::geometry::Pose;
use modl::plan::verify::articulated::ClusterPaths;
use modl::plan::verify::verify;
use modl::plan::{
    Body, CauseId, CheckKind, DockingEvent, DockingKind, Exemption, ExemptionKind, Ground, Plan, Status,
    Verdict, World,
};

const CARS: &str = "use std.smores.TwoCars
config Convoy closed {
  part pair: TwoCars
  base pair.a.steer.center
  behavior leave(v: AngularSpeed) = Sc(
    pair.drive(t: 1s),
    wait(500ms),
    Pc(undock(pair.a.side[1]), undock(pair.a.side[3])),
    Pc(pair.a.drive(v, 2s), pair.b.drive(-2rad/s, 2s)),
  )
  behavior together = pair.drive(t: 1s)
}
";

/// A tower of blocks of 100 mm: the upper one stands on two below it.
const TOWER: &str = "
connector Face { mates Face, turns 4 }
module Block {
  link body = box(100mm, 100mm, 100mm, mass: 1kg, friction: 0.8)
  port top: Face on body at [0mm, 0mm, 50mm] facing +Z up +X
  port bottom: Face on body at [0mm, 0mm, -50mm] facing -Z up +X
}
config Tower(n: Int) {
  part m[n]: Block
  for i in 0..n - 1 { connect m[i].top -- m[i + 1].bottom }
  base m[0]
  behavior let_go(i: Int) = Sc(wait(300ms), undock(m[i].top), wait(700ms))
}
";

/// A block with a rod on its top, beside a wall that it comes off: the rod's tip is 10 mm from the wall.
const RAM: &str = "
connector Face { mates Face, turns 4 }
module Ram {
  link body = box(100mm, 100mm, 100mm, mass: 5kg, friction: 0.8)
  link rod = box(80mm, 10mm, 10mm, mass: 50g) at [0mm, 0mm, 70mm]
  joint out : body -> rod = prismatic(axis: X, range: 0mm..60mm, max_force: 50N) at [0mm, 0mm, 70mm]
  port side: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
}
module Wall {
  link body = box(100mm, 100mm, 200mm, mass: 5kg, friction: 0.8) at [0mm, 0mm, 50mm]
  port side: Face on body at [-50mm, 0mm, -50mm] facing -X up +Z
}
config Pair {
  part ram: Ram
  part wall: Wall
  connect ram.side -- wall.side
  base ram
  behavior strike allows collision = Sc(
    undock(ram.side), wait(500ms), move(ram.out, to: 40mm, in: 1s), move(ram.out, to: 0mm, in: 1s),
  )
}
";

fn plan(declarations: &str, behavior: &str) -> Plan {
    let program = format!("{declarations}\nemit(plan({behavior}), \"p.json\")\n");
    run_clean(&program).plan("p.json")
}

/// Returns the plan of a tower that lets go of what is above a block, in the world of the default. Without weight, in
/// which it is written, nothing falls.
fn tower(blocks: usize, below: usize) -> Plan {
    let program =
        format!("Tower({blocks}).let_go({}), world: world(gravity: 0m/s^2, ground: off)", below - 1);
    let mut plan = plan(TOWER, &program);
    plan.worlds[0].world = World::default();
    plan
}

fn failures(verdict: &Verdict) -> Vec<CheckKind> {
    verdict.failures.iter().map(|failure| failure.kind).collect()
}

/// Returns the motion of the last clusters' bases from the split to the end, in the frame where each began.
fn shifts(plan: &Plan) -> Vec<Pose> {
    let paths = ClusterPaths::of(plan, f64::INFINITY).expect("the robot comes apart");
    let moved = |poses: &[(f64, Pose)]| poses[0].1.inverse() * poses[poses.len() - 1].1;
    paths
        .clusters
        .iter()
        .filter(|cluster| cluster.poses()[0].0 > 0.0)
        .map(|cluster| moved(cluster.poses()))
        .collect()
}

/// A car that has come off another drives as a car does that never was docked.
#[test]
fn cars_that_part_drive_as_cars_do_alone() {
    let parting = plan(CARS, "Convoy().leave(2rad/s)");
    let verdict = verify(&parting);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    assert!(
        matches!(status(&verdict, CheckKind::Collision), Status::Sampled(_)),
        "the bases' way is sampled"
    );
    assert_eq!(status(&verdict, CheckKind::Connectedness), Status::Proved);
    let travel = |verdict: &Verdict| libm::hypot(verdict.travel[0], verdict.travel[1]);
    let car = |v: &str| verify(&plan("use std.smores.Car", &format!("Car().drive({v}, 2s)")));
    let (forth, back) = (travel(&car("2rad/s")), travel(&car("-2rad/s")));
    let [a, b] = shifts(&parting).try_into().expect("two parts");
    for (shift, alone) in [(a, forth), (b, back)] {
        let moved = shift.translation.vector;
        assert!((moved.xy().norm() - alone).abs() < 1e-3, "{moved:?} beside {alone} alone");
        assert!(shift.rotation.angle() < 1e-3, "it drives straight");
    }
    let together = travel(&verify(&plan(CARS, "Convoy().together()")));
    assert!((travel(&verdict) - together - forth).abs() < 1e-3, "{} {together} {forth}", travel(&verdict));
}

/// The upper block of two hangs on nothing once it is let go: clusters do not carry each other. It falls by the height of
/// the block below.
#[test]
fn what_is_let_go_in_the_air_falls_to_the_ground() {
    for (below, height) in [(1, 0.1), (2, 0.2)] {
        let plan = tower(below + 1, below);
        let verdict = verify(&plan);
        assert_eq!(failures(&verdict), [CheckKind::Stability], "{:#?}", verdict.failures);
        let [fall] = verdict.failures.as_slice() else { unreachable!("one failure") };
        assert!((fall.time - 0.3).abs() < 1e-9 && (fall.value + height).abs() < 1e-6, "{fall:#?}");
        let undone: Vec<_> = plan.body.tracks().expect("modules").events.iter().map(|e| e.cause).collect();
        assert_eq!(fall.blame, undone, "the undocking is to blame");
        assert!(fall.message.contains(&format!("m[{below}]")), "{}", fall.message);
    }
    // The lower part of the same tower stands as before.
    let verdict = verify(&tower(3, 2));
    assert!(
        verdict.failures.iter().all(|failure| !failure.message.contains("m[0]")),
        "{:#?}",
        verdict.failures
    );
}

#[test]
fn a_fall_of_a_part_is_excused_by_name_but_not_at_the_end() {
    let mut tower = tower(2, 1);
    tower.exemptions =
        vec![Exemption { kind: ExemptionKind::Unstable, from: 0.0, to: 1.0, cause: CauseId(0) }];
    let verdict = verify(&tower);
    assert!(!failures(&verdict).contains(&CheckKind::Stability), "{:#?}", verdict.failures);
    // The block lands in the one that it stood on, and that is seen.
    assert_eq!(failures(&verdict), [CheckKind::Collision]);
}

#[test]
fn nothing_holds_what_comes_off_a_robot_that_a_fixture_holds() {
    let mut tower = tower(2, 1);
    tower.worlds[0].world.ground = Ground::Held;
    assert_eq!(failures(&verify(&tower)), [CheckKind::Stability]);
    tower.worlds[0].world.gravity = 0.0;
    assert!(verify(&tower).ok(), "without weight it stays where it is");
}

#[test]
fn a_part_that_strikes_another_is_seen_and_its_command_is_to_blame() {
    let excused = plan(RAM, "Pair().strike()");
    assert_eq!(status(&verify(&excused), CheckKind::Collision), Status::Exempt);
    let strike = Plan { exemptions: vec![], ..excused };
    let verdict = verify(&strike);
    assert_eq!(failures(&verdict), [CheckKind::Collision], "{:#?}", verdict.failures);
    let met = &verdict.failures[0];
    assert_eq!(met.at, ["ram", "wall"]);
    let tracks = strike.body.tracks().expect("modules");
    // The tip is at the wall once it has moved by 10 mm, and in it by 30 mm when it turns back.
    let moved = tracks.tracks[0].position(0.0, met.time);
    assert!((0.010..0.015).contains(&moved), "{moved}");
    assert!((met.value - 0.030).abs() < 1e-6, "{}", met.value);
    assert_eq!(met.blame, [tracks.tracks[0].segments[0].cause]);
    // Short of the wall it passes, and the least distance is what is left.
    let mut short = strike.clone();
    let Body::Tracks(tracks) = &mut short.body else { unreachable!("a plan of modules") };
    let points = tracks.tracks[0].segments.iter_mut().flat_map(|segment| &mut segment.control);
    points.for_each(|point| *point *= 7.0 / 40.0);
    let verdict = verify(&short);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    let clearance = verdict.clearance.expect("the parts have a distance").value;
    // The rod, a hundredth of the weight, pushes the block back by less than the judge calls travel.
    assert!(clearance.abs() < 1e-5, "the faces that were docked touch: {clearance}");
}

/// A part that stayed where it came off docks there again, as if the bond had never let go.
#[test]
fn parts_that_stay_dock_again() {
    let mut tower = tower(2, 1);
    tower.worlds[0].world.ground = Ground::Off;
    tower.worlds[0].world.gravity = 0.0;
    let Body::Tracks(tracks) = &mut tower.body else { unreachable!("a plan of modules") };
    let cause = tracks.events[0].cause;
    tracks.events.push(DockingEvent { time: 0.6, kind: DockingKind::Dock, bond: 0, cause });
    assert!(verify(&tower).ok());
    // Undone and docked at one instant, the bond never lets go.
    let Body::Tracks(tracks) = &mut tower.body else { unreachable!("a plan of modules") };
    tracks.events[1].time = tracks.events[0].time;
    assert!(verify(&tower).ok());
}

/// Two feet, docked back to back, with the same upright arm each, which is too heavy for its motor as it leans.
const ARMS: &str = "
connector Face { mates Face, turns 4 }
module Arm {
  link foot = box(400mm, 400mm, 100mm, mass: 20kg, friction: 0.8)
  link arm = box(300mm, 40mm, 40mm, mass: 2kg) at [0mm, 0mm, 80mm]
  joint lift : foot -> arm = revolute(axis: Y, max_torque: 1N*m) at [-150mm, 0mm, 80mm]
  port back : Face on foot at [200mm, 0mm, 0mm] facing +X up +Z
}
config Pair {
  part m[2]: Arm
  connect m[0].back -- m[1].back
  base m[0]
  for i in 0..2 { set m[i].lift = -90deg }
  behavior part_ways allows overload(m[0].lift), overload(m[1].lift) = Sc(
    undock(m[0].back), wait(500ms),
    Pc([move(m[i].lift, to: -30deg, in: 2s) for i in 0..2]),
    Pc([move(m[i].lift, to: -90deg, in: 2s) for i in 0..2]),
  )
}
";

/// The joints of a part have numbers of their own: an exemption is about the joint that it names, and no other.
#[test]
fn an_exemption_for_a_joint_of_one_part_excuses_none_of_another() {
    let overloaded = |verdict: &Verdict| -> Vec<String> {
        let torque = verdict.failures.iter().filter(|failure| failure.kind == CheckKind::Torque);
        torque.flat_map(|failure| failure.at.clone()).collect()
    };
    let excused = plan(ARMS, "Pair().part_ways(), world: world(dynamics: statics)");
    assert!(verify(&excused).ok(), "{:#?}", verify(&excused).failures);
    for (joint, kept, other) in [(0, "m[0].lift", "m[1].lift"), (1, "m[1].lift", "m[0].lift")] {
        let of = |e: &&Exemption| e.kind == ExemptionKind::Overload(Some(joint));
        let exemptions: Vec<_> = excused.exemptions.iter().filter(of).cloned().collect();
        assert_eq!(exemptions.len(), 1, "{:?}", excused.exemptions);
        let verdict = verify(&Plan { exemptions, ..excused.clone() });
        assert_eq!(overloaded(&verdict), [other], "with {kept} excused: {:#?}", verdict.failures);
    }
}
