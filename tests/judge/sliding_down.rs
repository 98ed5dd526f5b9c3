//! Robots that stand, drive or slide on slopes under full dynamics, and what the judge says of where they end.

use super::momentum::{FACE, PUSHING, bodies};
use crate::simulate::fixtures::CART;
use crate::support::desk::run_clean;
use crate::support::verdicts::failures_of;
use modl::geometry::Vec3;
use modl::plan::verify::articulated::ClusterPaths;
use modl::plan::verify::verify;
use modl::plan::{CauseId, CheckKind, Exemption, ExemptionKind, Plan, Verdict, World};

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

/// Returns the verdict of a block that rests for 500 ms on a slope of 10 degrees with a friction of 0.1, where a slide is
/// allowed from the start to the time `allowed` (s).
fn on_ice(dynamics: &str, gravity: f64, allowed: Option<f64>) -> Verdict {
    let mut plan = plan(BLOCK, "One().rest()", &format!("terrain: slope(10deg), dynamics: {dynamics}"));
    plan.worlds[0].world = World { friction: 0.2, gravity, ..plan.worlds[0].world };
    let cause = CauseId(0);
    let until = |to| Exemption { kind: ExemptionKind::Traction, from: 0.0, to, cause };
    plan.exemptions.extend(allowed.map(until));
    verify(&plan)
}

/// A slide that `allows traction` excuses is no failure: the first that is one comes when the exemption has ended.
#[test]
fn a_slide_that_is_allowed_fails_only_when_that_ends() {
    let ways = [("full", "while no joint moves is not followed"), ("statics", "is not followed")];
    for (dynamics, way) in ways {
        for (allowed, from) in [(None, 0.0), (Some(0.5), 0.5)] {
            let verdict = on_ice(dynamics, 9.80665, allowed);
            let found = failures_of(CheckKind::Traction, &verdict);
            let [slide] = found.as_slice() else { panic!("{allowed:?}: {found:#?}") };
            assert!((slide.time - from).abs() < 1e-9, "{allowed:?}: {slide:?}");
            assert!(slide.message.starts_with("the robot slides down the slope"), "{slide:?}");
            assert!((slide.value - libm::tan(10_f64.to_radians())).abs() < 1e-9, "{slide:?}");
            assert!((slide.limit - 0.1).abs() < 1e-9, "{slide:?}");
            let told = verdict.notes.contains(&format!("the way down the slope {way}"));
            assert_eq!(told, allowed.is_some(), "{dynamics}: {:?}", verdict.notes);
        }
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

/// Friction bears nothing of a weight so small that its pressure vanishes among the numbers; that is told in numbers, too.
#[test]
fn a_slide_without_pressure_has_no_friction() {
    let verdict = on_ice("full", 1e-320, None);
    let found = failures_of(CheckKind::Traction, &verdict);
    let [slide] = found.as_slice() else { panic!("{found:#?}") };
    assert_eq!(slide.limit.to_bits(), 0, "{slide:?}");
    assert!(slide.message.ends_with("and has 0"), "{slide:?}");
    // A weight that is small as well, but presses, slides as any other does.
    let verdict = on_ice("full", 1e-200, None);
    let found = failures_of(CheckKind::Traction, &verdict);
    assert!(found.len() == 1 && (found[0].limit - 0.1).abs() < 1e-9, "{found:?}");
}

/// A cart drives on a slope by the roll of its wheels, though its mast stands still.
#[test]
fn a_joint_at_rest_does_not_hold_a_cart_that_drives_on_a_slope() {
    // A mast that may turn is the joint at rest.
    let mast = "  link mast = cylinder(10mm, 40mm, mass: 50g) at [0mm, 0mm, 40mm]
  joint turn : body -> mast = revolute(axis: Z) at [0mm, 0mm, 40mm]
  joint a :";
    let cart = CART.replace("friction: 0.3", "friction: 1").replace("  joint a :", mast);
    for angle in [-5.0, 5.0] {
        let verdict = verify(&plan(&cart, "Car().roll(2rad, 2s)", &format!("terrain: slope({angle}deg)")));
        assert!(verdict.ok(), "{:#?}", verdict.failures);
        let [x, y, _] = verdict.travel;
        // Wheels of 40 mm that turn by 2 rad; friction creeps by parts of a millimetre per second.
        assert!((x - 0.080).abs() < 1e-3 && y.abs() < 1e-6, "{angle}: {:?}", verdict.travel);
    }
}

/// A body with a slide whose centre of mass lies within the body, so that the weight is borne wherever the slide is.
const PUSHER: &str = "
module Pusher {
  link body = box(200mm, 200mm, 100mm, mass: BODY)
  link slide = box(20mm, 60mm, 60mm, mass: SLIDE, com: [-150mm, 0mm, 0mm]) at [120mm, 0mm, 0mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..150mm) at [120mm, 0mm, 0mm]
  port tip: Face on slide at [10mm, 0mm, 0mm] facing +X up +Z
}
";

/// Returns the declarations of such a body that pushes a block away or draws it to itself, with these masses.
fn pushing(body: &str, slide: &str) -> String {
    format!("{FACE}{PUSHING}") + &PUSHER.replace("BODY", body).replace("SLIDE", slide)
}

/// Returns how far both modules have moved at some times (s).
fn places(plan: &Plan, times: &[f64]) -> Vec<[Vec3; 2]> {
    let paths = ClusterPaths::of(plan, f64::INFINITY).expect("two parts");
    times.iter().map(|time| bodies(plan, &paths, *time).map(|pose| pose.translation.vector)).collect()
}

/// A block that comes off in motion slides on until friction holds it, and then stands where it is.
#[test]
fn what_came_off_in_motion_stands_on_a_slope_once_friction_has_stopped_it() {
    // Time enough to stop.
    let declarations = pushing("5kg", "500g").replace("wait(2s)", "wait(10s)");
    let plan = plan(&declarations, "Drawn().part_ways()", "terrain: slope(10deg), friction: 0.5");
    let found = places(&plan, &[1.0, 3.0, 7.0, 11.9]);
    let moved = |from: usize, to: usize, part: usize| (found[to][part] - found[from][part]).norm();
    assert!(moved(0, 1, 1) > 1e-3, "it slid on: {found:?}");
    for part in [0, 1] {
        assert!(moved(1, 2, part) < 1e-9 && moved(2, 3, part) < 1e-9, "{found:?}");
    }
}

/// A body on ice whose slide is heavier than itself moves back with it, as a block comes off in motion.
#[test]
fn on_ice_a_heavy_slide_moves_its_body_as_a_block_comes_off() {
    let along_x = pushing("500g", "5kg");
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
