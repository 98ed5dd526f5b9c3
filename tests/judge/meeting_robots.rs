//! Robots that dock with each other: the verdict on each of them, loops that two dockings close, dockings soon after the start,
//! and on the move.

use crate::support::desk::{self, run_clean, stated};
use crate::support::verdicts::failures_of;
use modl::geometry::Vec3;
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Plan, Verdict};

/// A fork of two slides that reach out of a body, and a block of whose two faces each meets one, in a scene.
const FORK: &str = "
connector Face { mates Face, turns 1, capture 4mm 5deg }
module Fork {
  link body = box(100mm, 200mm, 100mm, mass: 5kg)
  link left = box(20mm, 40mm, 40mm, mass: 500g) at [70mm, 50mm, 0mm]
  link right = box(20mm, 40mm, 40mm, mass: 500g) at [70mm, -50mm, 0mm]
  joint out0 : body -> left = prismatic(axis: X, range: 0mm..150mm) at [70mm, 50mm, 0mm]
  joint out1 : body -> right = prismatic(axis: X, range: 0mm..150mm) at [70mm, -50mm, 0mm]
  port tip0: Face on left at [10mm, 0mm, 0mm] facing +X up +Z
  port tip1: Face on right at [10mm, 0mm, 0mm] facing +X up +Z
}
module Block {
  link body = box(100mm, 200mm, 100mm, mass: 1kg)
  port face0: Face on body at [-50mm, 50mm, 0mm] facing -X up +Z
  port face1: Face on body at [-50mm, -50mm, 0mm] facing -X up +Z
}
config One { part m: Fork }
config Other { part m: Block }
";

/// Returns the plan of a fork that reaches out by 50 mm in 2 s, docks after another with the block in front of it on all of
/// the `faces`, and draws it back.
fn fetch(faces: &[usize]) -> Plan {
    let all =
        |each: &dyn Fn(usize) -> String| faces.iter().map(|face| each(*face)).collect::<Vec<_>>().join(", ");
    let out = all(&|face| format!("move(a.m.out{face}, to: 50mm, in: 2s)"));
    let dock = all(&|face| format!("dock(a.m.tip{face}, b.m.face{face})"));
    let back = all(&|face| format!("move(a.m.out{face}, to: 0mm, in: 2s)"));
    let program = format!(
        "{FORK}
scene S {{
  part a: One
  part b: Other at [180mm, 0mm, 0mm]
  world(gravity: 0m/s^2, ground: off, dynamics: statics)
  behavior fetch = Sc(Pc({out}), wait(1s), Pc({dock}), wait(1s), Pc({back}))
}}
emit(S().fetch(), \"p.json\")
"
    );
    run_clean(&program).plan("p.json")
}

#[test]
fn each_of_the_robots_at_the_start_has_a_verdict_of_its_own() {
    let verdict = verify(&fetch(&[0]));
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    let [fork, block] = verdict.robots.as_slice() else { panic!("{:#?}", verdict.robots) };
    assert_eq!((fork.reference.as_str(), block.reference.as_str()), ("a.m", "b.m"));
    let travel = |verdict: &Verdict| Vec3::from(verdict.travel);
    assert!(travel(&fork.verdict).norm() < 1e-9, "{:?}", fork.verdict.travel);
    let drawn = Vec3::new(-0.050, 0.0, 0.0);
    assert!((travel(&block.verdict) - drawn).norm() < 1e-9, "{:?}", block.verdict.travel);
}

/// Ports that docked close a loop, and one slide that stays behind the other drives it apart.
#[test]
fn a_loop_that_two_dockings_close_is_judged_as_the_robot_moves_on() {
    let mut plan = fetch(&[0, 1]);
    assert!(verify(&plan).ok(), "{:#?}", verify(&plan).failures);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    let back = tracks.tracks[1].segments.last_mut().expect("it moves back");
    back.control.iter_mut().for_each(|point| *point = 0.050 - 0.4 * (0.050 - *point));
    let failures = failures_of(CheckKind::Closure, &verify(&plan));
    let [open] = failures.as_slice() else { panic!("{failures:#?}") };
    assert!(open.message.contains("driven apart"), "{open:?}");
    assert!((4.0..6.0).contains(&open.time), "{open:?}");
}

/// Three robots in a row: the first docks with the second, which then docks with the third, which nothing has happened to
/// before.
#[test]
fn a_robot_that_others_met_without_it_is_met_where_it_stands() {
    let program = "connector Face { mates Face, turns 1, capture 4mm 5deg }
module Reacher {
  link body = box(100mm, 100mm, 100mm, mass: 5kg)
  link hand = box(20mm, 40mm, 40mm, mass: 500g) at [70mm, 0mm, 0mm]
  joint out : body -> hand = prismatic(axis: X, range: 0mm..150mm) at [70mm, 0mm, 0mm]
  port tip: Face on hand at [10mm, 0mm, 0mm] facing +X up +Z
  port back: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config One { part m: Reacher }
scene S {
  part a: One
  part b: One at [180mm, 0mm, 0mm]
  part c: One at [360mm, 0mm, 0mm]
  world(gravity: 0m/s^2, ground: off, dynamics: statics)
  behavior meet = Sc(
    move(a.m.out, to: 50mm, in: 1s), dock(a.m.tip, b.m.back), wait(500ms),
    move(b.m.out, to: 50mm, in: 1s), dock(b.m.tip, c.m.back), wait(500ms),
    move(b.m.out, to: 40mm, in: 1s),
  )
}
emit(S().meet(), \"p.json\")
";
    let verdict = verify(&run_clean(program).plan("p.json"));
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    let third = verdict.robots.iter().find(|robot| robot.reference == "c.m").expect("it has a verdict");
    let travel = Vec3::from(third.verdict.travel);
    assert!((travel - Vec3::new(-0.010, 0.0, 0.0)).norm() < 1e-9, "{travel:?}");
}

/// A fork that holds a block by both tips lets go of it with the first, draws that tip back, and pushes the block on with the
/// other by 50 mm: into another block that stands 30 mm before it, and not into one that is 60 mm away.
#[test]
fn a_robot_is_seen_by_others_as_it_hangs_together_once_a_loop_has_opened() {
    let of = |gap: u32| {
        desk::messages(&format!(
            "{FORK}
config Both closed {{
  part f: Fork  part k: Block
  set f.out0 = 50mm  set f.out1 = 50mm
  connect f.tip0 -- k.face0
  connect f.tip1 -- k.face1
  base f
}}
scene S {{
  part a: Both
  part b: Other at [{}mm, 0mm, 0mm]
  world(gravity: 0m/s^2, ground: off, dynamics: statics)
  behavior push = Sc(
    wait(500ms), undock(a.f.tip0), wait(500ms), Pc(move(a.f.out0, to: 0mm, in: 2s), move(a.f.out1, to: 100mm, in: 2s)),
  )
}}
emit(S().push(), \"p.json\")
",
            180 + 100 + gap
        ))
    };
    let found = of(30);
    assert!(found.len() == 1 && found[0].contains("a.k and b.m meet"), "{found:?}");
    assert_eq!(of(60), Vec::<String>::new());
}

/// A robot that docks sooner after the start than a robot brakes has not been long enough on the ground to be seen to slide.
#[test]
fn robots_that_stand_may_dock_at_once() {
    let program = format!(
        "{FORK}
scene S {{
  part a: One
  part b: Other at [130mm, 0mm, 0mm]
  behavior meet = Sc(wait(20ms), dock(a.m.tip0, b.m.face0), wait(100ms))
}}
emit(S().meet(), \"p.json\")
"
    );
    let verdict = verify(&run_clean(&program).plan("p.json"));
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    assert!(verdict.notes.iter().any(|note| note.contains("docks at 20ms")), "{:?}", verdict.notes);
}

/// Returns a scene of a cart on wheels of 50 mm radius that turn by 1 rad in all, and a block before it. `joint`: what the
/// joints of the wheels state besides their axis; `away`: where the block is, mm; `moving`: what each wheel does, by its joint;
/// `meeting`: the behaviour of all, by those of the wheels.
fn driving(joint: &str, away: u32, world: &str, moving: &str, meeting: &str) -> String {
    let mut wheels = String::new();
    for (index, (x, y)) in [(60, 60), (60, -60), (-60, 60), (-60, -60)].iter().enumerate() {
        wheels += &format!(
            "  link w{index} = cylinder(radius: 50mm, length: 20mm, axis: Y, mass: 100g, friction: 1) at [{x}mm, {y}mm, 50mm]
  joint t{index} : body -> w{index} = revolute(axis: Y{joint}) at [{x}mm, {y}mm, 50mm]\n"
        );
    }
    let all: Vec<String> = (0..4).map(|index| moving.replace("JOINT", &format!("a.m.t{index}"))).collect();
    let meeting = meeting.replace("WHEELS", &all.join(", "));
    format!(
        "connector Face {{ mates Face, turns 1, capture 4mm 5deg }}
module Cart {{
  link body = box(100mm, 90mm, 60mm, mass: 2kg) at [0mm, 0mm, 60mm]
{wheels}  port nose: Face on body at [120mm, 0mm, 0mm] facing +X up +Z
}}
module Block {{
  link body = box(100mm, 90mm, 120mm, mass: 1kg) at [0mm, 0mm, 60mm]
  port face: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}}
config One {{ part m: Cart }}
config Other {{ part m: Block }}
scene S {{
  part a: One
  part b: Other at [{away}mm, 0mm, 0mm]
  world({world})
  behavior meet = {meeting}
}}
emit(S().meet(), \"p.json\")
"
    )
}

/// A cart that docks half-way through a turn of its wheels by 1 rad in 2 s. The turn is a quintic, which is then 15/8 as fast
/// as in the mean; the cart has gone 25 mm.
#[test]
fn a_cart_that_still_drives_docks_too_fast_also_where_every_instant_is_judged_at_rest() {
    let meeting = "Pc(WHEELS, Sc(wait(1s), dock(a.m.nose, b.m.face)))";
    let found =
        desk::messages(&driving("", 195, "dynamics: statics", "move(JOINT, by: 1rad, in: 2s)", meeting));
    let fast: Vec<_> = found.iter().filter(|message| message.contains("docks too fast")).collect();
    let [fast] = fast.as_slice() else { panic!("{found:#?}") };
    let (speed, expected) = (stated(fast, "the ports move at", "mm/s"), 50.0 * 0.5 * 15.0 / 8.0);
    assert!((speed - expected).abs() < 0.1, "{speed} of {expected} in {fast}");
}

/// A cart that brakes with 1 m/s² has 5 mm/s in the mean of its last 10 ms, and is at rest as it docks at their end.
#[test]
fn a_cart_that_has_braked_hard_is_at_rest_as_it_docks() {
    let joint = ", max_speed: 2rad/s, max_accel: 20rad/s^2";
    let meeting = "Sc(Pc(WHEELS), dock(a.m.nose, b.m.face), wait(100ms))";
    let program = driving(joint, 210, "dynamics: full", "spin(JOINT, 2rad/s, for: 500ms)", meeting);
    let verdict = verify(&run_clean(&program).plan("p.json"));
    assert!(verdict.ok(), "{:#?}", verdict.failures);
}
