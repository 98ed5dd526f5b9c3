//! Robots that stand, drive or slide on slopes under full dynamics, and what the judge says of where they end.

use crate::support::desk::run_clean;
use modl::geometry::{Pose, Vec3};
use modl::plan::verify::articulated::ClusterPaths;
use modl::plan::verify::verify;
use modl::plan::{CauseId, CheckKind, Exemption, ExemptionKind, Failure, Plan, Verdict, World};
use modl::robot::Kinematics;

fn plan(declarations: &str, behavior: &str, world: &str) -> Plan {
    let program = format!("{declarations}\nemit(plan({behavior}, world: world({world})), \"p.json\")\n");
    run_clean(&program).plan("p.json")
}

/// A block with a dial that may turn on it.
const BLOCK: &str = "
module Block {
  link body = box(200mm, 200mm, 40mm, mass: 1kg, friction: 0.5)
  link dial = cylinder(20mm, 10mm, mass: 10g) at [0mm, 0mm, 30mm]
  joint turn : body -> dial = revolute(axis: Z) at [0mm, 0mm, 30mm]
}
config One {
  part b: Block
  behavior rest = wait(500ms)
}
";

fn slides(verdict: &Verdict) -> Vec<&Failure> {
    verdict.failures.iter().filter(|failure| failure.kind == CheckKind::Traction).collect()
}

/// Returns the verdict of a block that rests for 500 ms on a slope of 10 degrees with a friction of 0.1, where a slide is
/// allowed from the start to the time `allowed` (s).
fn on_ice(gravity: f64, allowed: Option<f64>) -> Verdict {
    let mut plan = plan(BLOCK, "One().rest()", "terrain: slope(10deg)");
    plan.worlds[0].world = World { friction: 0.2, gravity, ..plan.worlds[0].world };
    let cause = CauseId(0);
    let until = |to| Exemption { kind: ExemptionKind::Traction, from: 0.0, to, cause };
    plan.exemptions.extend(allowed.map(until));
    verify(&plan)
}

/// What `allows traction` excuses is no failure: the first that is one comes when it has ended.
#[test]
fn a_slide_that_is_allowed_fails_only_when_that_ends() {
    for (allowed, from) in [(None, 0.0), (Some(0.5), 0.5)] {
        let verdict = on_ice(9.80665, allowed);
        let found = slides(&verdict);
        let [slide] = found.as_slice() else { panic!("{allowed:?}: {found:#?}") };
        assert!((slide.time - from).abs() < 1e-9, "{allowed:?}: {slide:?}");
        assert!((slide.value - libm::tan(10_f64.to_radians())).abs() < 1e-9, "{slide:?}");
        assert!((slide.limit - 0.1).abs() < 1e-9, "{slide:?}");
        let told = verdict.notes.iter().any(|note| note.contains("is not followed"));
        assert_eq!(told, allowed.is_some(), "{:?}", verdict.notes);
    }
}

/// Loads of a block that stands on ground are found with a single answer, and none is said to be one of several.
#[test]
fn loads_that_agree_at_every_instant_are_not_noted() {
    for world in ["dynamics: full", "terrain: slope(10deg)"] {
        let verdict = verify(&plan(BLOCK, "One().rest()", world));
        assert!(verdict.ok(), "{:#?}", verdict.failures);
        assert!(verdict.notes.iter().all(|note| !note.contains("come to agree")), "{:?}", verdict.notes);
    }
}

/// Of a weight so small that its pressure vanishes among the numbers friction bears nothing; that is told in numbers, too.
#[test]
fn a_slide_without_pressure_has_no_friction() {
    let verdict = on_ice(1e-320, None);
    let found = slides(&verdict);
    let [slide] = found.as_slice() else { panic!("{found:#?}") };
    assert_eq!(slide.limit.to_bits(), 0, "{slide:?}");
    assert!(slide.message.ends_with("and has 0"), "{slide:?}");
    // A weight that is small as well, but presses, slides as any other does.
    let verdict = on_ice(1e-200, None);
    let found = slides(&verdict);
    assert!(found.len() == 1 && (found[0].limit - 0.1).abs() < 1e-9, "{found:?}");
}

/// A cart with four wheels of 40 mm radius and a mast that may turn.
const CART: &str = "
module Cart {
  link body = box(240mm, 60mm, 40mm, mass: 2kg)
  link mast = cylinder(10mm, 40mm, mass: 50g) at [0mm, 0mm, 40mm]
  link fl = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [80mm, 60mm, 0mm]
  link fr = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [80mm, -60mm, 0mm]
  link bl = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [-80mm, 60mm, 0mm]
  link br = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [-80mm, -60mm, 0mm]
  joint turn : body -> mast = revolute(axis: Z) at [0mm, 0mm, 40mm]
  joint a : body -> fl = revolute(axis: Y) at [80mm, 60mm, 0mm]
  joint b : body -> fr = revolute(axis: Y) at [80mm, -60mm, 0mm]
  joint c : body -> bl = revolute(axis: Y) at [-80mm, 60mm, 0mm]
  joint d : body -> br = revolute(axis: Y) at [-80mm, -60mm, 0mm]
}
config Car {
  part c: Cart
  behavior drive = Pc(move(c.a, by: 2rad, in: 2s), move(c.b, by: 2rad, in: 2s), move(c.c, by: 2rad, in: 2s), move(c.d, by: 2rad, in: 2s))
}
";

/// A cart drives on a slope by the roll of its wheels, though its mast stands still.
#[test]
fn a_joint_at_rest_does_not_hold_a_cart_that_drives_on_a_slope() {
    for angle in [-5.0, 5.0] {
        let verdict = verify(&plan(CART, "Car().drive()", &format!("terrain: slope({angle}deg)")));
        assert!(verdict.ok(), "{:#?}", verdict.failures);
        let [x, y, _] = verdict.travel;
        // Wheels of 40 mm that turn by 2 rad; friction creeps by parts of a millimetre per second.
        assert!((x - 0.080).abs() < 1e-3 && y.abs() < 1e-6, "{angle}: {:?}", verdict.travel);
    }
}

/// A body that pushes a block away or draws it to itself, and lets it go on the way.
const PARTING: &str = "
connector Face { mates Face, turns 4 }
module Pusher {
  link body = box(200mm, 200mm, 100mm, mass: BODY)
  link slide = box(20mm, 60mm, 60mm, mass: SLIDE, com: [-150mm, 0mm, 0mm]) at [120mm, 0mm, 0mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..150mm) at [120mm, 0mm, 0mm]
  port tip: Face on slide at [10mm, 0mm, 0mm] facing +X up +Z
}
module Block {
  link body = box(100mm, 60mm, 100mm, mass: 1kg)
  port face: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config Pushed { part a: Pusher  part b: Block  connect a.tip -- b.face  base a
  behavior part_ways = Sc(Pc(move(a.out, to: 100mm, in: 2s), Sc(wait(1s), undock(a.tip))), wait(2s))
}
config Drawn { part a: Pusher  part b: Block  connect a.tip -- b.face  base a
  set a.out = 100mm
  behavior part_ways = Sc(Pc(move(a.out, to: 0mm, in: 2s), Sc(wait(1s), undock(a.tip))), wait(10s))
}
";

/// Returns the positions of both modules at some times (s).
fn places(plan: &Plan, times: &[f64]) -> Vec<[Vec3; 2]> {
    let paths = ClusterPaths::of(plan, f64::INFINITY).expect("two parts");
    let numbers = Kinematics::new(&plan.body.tracks().expect("modules").robot, &[true], 0);
    let at = |time: &f64| {
        let mut poses = vec![Pose::identity(); numbers.link_count()];
        paths.place(*time, &mut poses);
        [0, 1].map(|module| numbers.module_pose(module, &poses).translation.vector)
    };
    times.iter().map(at).collect()
}

/// A block that comes off in motion slides on until friction holds it, and then stands where it is.
#[test]
fn what_came_off_in_motion_stands_on_a_slope_once_friction_has_stopped_it() {
    let declarations = PARTING.replace("BODY", "5kg").replace("SLIDE", "500g");
    let plan = plan(&declarations, "Drawn().part_ways()", "terrain: slope(10deg), friction: 0.5");
    let found = places(&plan, &[1.0, 3.0, 7.0, 11.9]);
    let moved = |from: usize, to: usize, part: usize| (found[to][part] - found[from][part]).norm();
    assert!(moved(0, 1, 1) > 1e-3, "it slid on: {found:?}");
    for part in [0, 1] {
        assert!(moved(1, 2, part) < 1e-9 && moved(2, 3, part) < 1e-9, "{found:?}");
    }
}

/// On ice a body whose slide is heavier than itself moves back with it, as a block comes off in motion.
#[test]
fn on_ice_a_heavy_slide_moves_its_body_as_a_block_comes_off() {
    let along_x = PARTING.replace("BODY", "500g").replace("SLIDE", "5kg");
    let turned = [
        ("[-150mm, 0mm, 0mm]", "[0mm, -150mm, 0mm]"),
        ("[120mm, 0mm, 0mm]", "[0mm, 120mm, 0mm]"),
        ("box(20mm, 60mm,", "box(60mm, 20mm,"),
        ("axis: X", "axis: Y"),
        ("[10mm, 0mm, 0mm] facing +X", "[0mm, 10mm, 0mm] facing +Y"),
    ];
    let along_y = turned.iter().fold(along_x.clone(), |text, (from, to)| text.replace(from, to));
    for (axis, declarations) in [along_x, along_y].iter().enumerate() {
        let mut plan = plan(declarations, "Pushed().part_ways()", "friction: 0");
        // The velocity with which a part begins holds for 10 ms, and so for some such samples.
        plan.settings.sample = 2e-3;
        let track = &plan.body.tracks().expect("modules").tracks[0];
        let (u, out) = (track.velocity(1.0), |time: f64| track.position(0.0, time));
        let (body, slide, block) = (0.5, 5.0, 1.0);
        // Momentum is zero before; each part keeps its own after, the block with its speed, body and slide in common.
        let before = -u * (slide + block) / (body + slide + block);
        let common = before + u * slide / (body + slide);
        let times = [1.0, 1.05, 1.5, 2.5, 4.0];
        let found = places(&plan, &times);
        for (now, time) in found.iter().zip(times) {
            let back = common * (time - 1.0) - slide / (body + slide) * (out(time) - out(1.0));
            let expected = [back, (before + u) * (time - 1.0)];
            for (part, expected) in expected.into_iter().enumerate() {
                let moved = (now[part] - found[0][part])[axis];
                assert!((moved - expected).abs() < 2e-4, "{part} at {time}: {moved} of {expected}");
            }
        }
    }
}
