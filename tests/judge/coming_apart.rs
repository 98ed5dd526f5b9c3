//! Parts that come off a robot: how that is told, which of them stand by themselves, and what is said of those that come off
//! in motion.

use crate::support::desk::run_clean;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{self, TILT};
use modl::geometry::Vec3;
use modl::plan::verify::articulated::history;
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Failure, Obstacle, Plan, Status, Verdict, World};

/// Returns the plan of a behaviour in a world; it is written in one without weight, in which nothing falls.
fn plan(declarations: &str, behavior: &str, world: World) -> Plan {
    let free = "world: world(gravity: 0m/s^2, ground: off, dynamics: statics)";
    let program = format!("{declarations}\nemit(plan({behavior}, {free}), \"p.json\")\n");
    let mut plan = run_clean(&program).plan("p.json");
    plan.worlds[0].world = world;
    plan
}

fn stability(verdict: &Verdict) -> Option<&Failure> {
    verdict.failures.iter().find(|failure| failure.kind == CheckKind::Stability)
}

const BLOCKS: &str = "
connector Face { mates Face, turns 4 }
module Block {
  link body = box(100mm, 100mm, 100mm, mass: 1kg, friction: 0.8)
  port left: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
  port right: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
}
config Row {
  part m[5]: Block
  for i in 0..4 { connect m[i].right -- m[i + 1].left }
  base m[0]
  behavior part_ways = Sc(wait(300ms), undock(m[1].right), wait(700ms))
  behavior stay = wait(1s)
}
";

#[test]
fn parts_are_told_with_their_modules_and_times() {
    let parting = verify(&plan(BLOCKS, "Row().part_ways()", STATICS));
    assert!(parting.ok(), "{:#?}", parting.failures);
    let told: Vec<_> = parting.notes.iter().filter(|note| note.contains("comes apart")).collect();
    let [note] = told.as_slice() else { panic!("{:?}", parting.notes) };
    for part in ["(2 modules) from 300ms", "(3 modules) from 300ms"] {
        assert!(note.contains(part), "{note}");
    }
    let whole = verify(&plan(BLOCKS, "Row().stay()", STATICS));
    assert!(whole.notes.iter().all(|note| !note.contains("comes apart")), "{:?}", whole.notes);
}

/// A lever that a heavy block holds: by itself its foot is too small for its arm. Its dial moves all the time.
const LEVER: &str = "
connector Face { mates Face, turns 4 }
module Anchor {
  link body = box(200mm, 200mm, 100mm, mass: 20kg, friction: 0.8) at [0mm, 0mm, 50mm]
  port side: Face on body at [100mm, 0mm, 0mm] facing +X up +Z
}
module Lever {
  link foot = box(60mm, 60mm, 100mm, mass: 200g, friction: 0.8) at [0mm, 0mm, 50mm]
  link arm = box(300mm, 40mm, 20mm, mass: 1kg) at [180mm, 0mm, 90mm]
  link dial = cylinder(20mm, 10mm, mass: 10g) at [0mm, 0mm, 110mm]
  joint stiff : foot -> arm = fixed() at [0mm, 0mm, 0mm]
  joint turn : foot -> dial = revolute(axis: Z) at [0mm, 0mm, 110mm]
  port side: Face on foot at [-30mm, 0mm, 0mm] facing -X up +Z
}
config Held {
  part anchor: Anchor
  part lever: Lever
  connect anchor.side -- lever.side
  base anchor
  behavior let_go = Pc(move(lever.turn, by: 90deg, in: 2s), Sc(wait(500ms), undock(anchor.side)))
}
";

/// A part that tips over as it comes off is held for the time that is allowed without support, and then falls.
#[test]
fn a_part_that_tips_over_is_held_for_the_time_that_is_allowed() {
    let held = plan(LEVER, "Held().let_go()", STATICS);
    for (allowed, until) in [(0.0, 0.51), (0.3, 0.81), (1.0, 1.51), (5.0, 2.0)] {
        let mut plan = held.clone();
        plan.settings.unstable_for = allowed;
        let verdict = verify(&plan);
        let failure = stability(&verdict).expect("it falls");
        let ended = failure.until.expect("it ends");
        assert!((failure.time - 0.5).abs() < 1e-9, "{failure:?}");
        assert!((ended - until).abs() < 0.011, "{allowed} s are allowed: {failure:?}");
    }
}

/// A jack that lifts a block, and lets it go on its way.
const JACK: &str = "
connector Face { mates Face, turns 4 }
module Jack {
  link foot = box(200mm, 200mm, 100mm, mass: 5kg, friction: 0.8) at [0mm, 0mm, 50mm]
  link head = box(100mm, 100mm, 20mm, mass: 100g) at [0mm, 0mm, 112mm]
  joint up : foot -> head = prismatic(axis: Z, range: 0mm..200mm, max_force: 100N) at [0mm, 0mm, 112mm]
  port top: Face on head at [0mm, 0mm, 10mm] facing +Z up +X
}
module Load {
  link body = box(100mm, 100mm, 100mm, mass: 1kg, friction: 0.8)
  port bottom: Face on body at [0mm, 0mm, -50mm] facing -Z up +X
}
config Lift {
  part jack: Jack
  part load: Load
  connect jack.top -- load.bottom
  base jack
  behavior toss allows collision = Sc(
    Pc(move(jack.up, to: 100mm, in: 1s), Sc(wait(500ms), undock(jack.top))), move(jack.up, to: 0mm, in: 1s),
  )
  behavior set_off = Sc(move(jack.up, to: 100mm, in: 1s), wait(1s), undock(jack.top), wait(500ms))
}
";

/// The block that is let go at rest, at the top of the lift, has no momentum to lose.
#[test]
fn travel_and_balance_of_what_comes_off_as_it_lifts_are_not_checked() {
    for (behavior, lifts) in [("toss", true), ("set_off", false)] {
        for gravity in [9.80665, 0.5] {
            let world = World { gravity, ..World::default() };
            let verdict = verify(&plan(JACK, &format!("Lift().{behavior}()"), world));
            for kind in [CheckKind::Balance, CheckKind::Traction] {
                let check = verdict.checks.iter().find(|check| check.kind == kind).expect("it is judged");
                let lost = matches!(&check.status, Status::NotChecked(why) if why.contains("lifts or tilts"));
                assert_eq!(lost, lifts, "{behavior} under {gravity} m/s²: {check:?}");
            }
            // The other checks are as they were.
            let torque = verdict.checks.iter().find(|check| check.kind == CheckKind::Torque);
            assert!(matches!(torque.expect("it is judged").status, Status::Sampled(_)), "{torque:?}");
        }
    }
}

/// A robot beside an obstacle that is far away is one robot as before: its history is the same, with the loads of its joints.
#[test]
fn a_far_obstacle_changes_no_history() {
    let motion = Motion::new(robots::chain(3)).smooth("m0", TILT, 30.0, 0.0, 1.0);
    let alone = motion.plan(STATICS);
    let mut among = alone.clone();
    let Body::Tracks(tracks) = &mut among.body else { unreachable!("a plan of modules") };
    let shapes = vec![robots::boxed(Vec3::repeat(5.0), Vec3::repeat(5.1))];
    tracks.obstacles = vec![Obstacle { name: "wall".into(), shapes }].into();
    let (alone, among) = (history(&alone, 1.0), history(&among, 1.0));
    assert!(alone.iter().any(|moment| !moment.loads.is_empty()), "smores joints have limits");
    assert_eq!(alone, among);
}
