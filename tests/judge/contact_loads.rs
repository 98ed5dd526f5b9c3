//! Loads of joints beside their limits: exactly at the limit, and where no forces of the ground are found that hold the robot.

use crate::support::desk::run_clean;
use crate::support::motions::STATICS;
use crate::support::verdicts::status;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Ground, Plan, Status, World};

/// Returns the plan of a program that leaves a behaviour in `b`, in a world; it is written in one without weight.
fn plan(program: &str, world: World) -> Plan {
    let free = "world: world(gravity: 0m/s^2, ground: off, dynamics: statics)";
    let mut plan = run_clean(&format!("{program}\nemit(plan(b, {free}), \"p.json\")\n")).plan("p.json");
    plan.worlds[0].world = world;
    plan
}

/// All lengths are sums of powers of two, and so nothing is rounded: a ball of 1 kg at the end of 0.5 m under 8 m/s² weighs 4 N m.
#[test]
fn a_load_exactly_at_its_limit_is_borne_and_nothing_is_said_of_it() {
    let program = "
module Arm {
  link base = sphere(radius: 62.5mm, mass: 1kg)
  link bob = sphere(radius: 62.5mm, mass: 1kg) at [500mm, 0mm, 0mm]
  joint bend : base -> bob = revolute(axis: Y, max_torque: 4N*m)
}
config C { part m: Arm  behavior go = wait(1s) }
let b = C().go()";
    let verdict = verify(&plan(program, World { gravity: 8.0, ground: Ground::Held, ..STATICS }));
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    assert_eq!(verdict.torque_margin.as_ref().map(|worst| worst.value), Some(0.0));
    assert!(verdict.notes.iter().all(|note| !note.contains("m.bend")), "{:?}", verdict.notes);
}

/// Two plates on a hinge, the second with a weight at its far end, on a slope of 10 degrees: there are forces without a torque
/// of the hinge, as each plate stands by itself. Without enough friction there are none at all, and nothing is known of torques.
#[test]
fn loads_are_not_checked_where_no_forces_of_the_ground_hold_the_robot() {
    let program = "
module Hinged {
  link left = box(200mm, 200mm, 40mm, mass: 1kg, friction: 1)
  link right = box(200mm, 200mm, 40mm, mass: 1kg, friction: 1) at [210mm, 0mm, 0mm]
  link weight = box(20mm, 20mm, 20mm, mass: 2kg) at [280mm, 0mm, 30mm]
  joint hinge : left -> right = revolute(axis: Y, max_torque: 0.1N*m) at [105mm, 0mm, 0mm]
  joint on : right -> weight = fixed() at [280mm, 0mm, 30mm]
}
config C { part m: Hinged  behavior go = wait(100ms) }
let b = C().go()";
    let judged = |friction: f64| {
        let slope = [libm::tan(10f64.to_radians()), 0.0];
        status(&verify(&plan(program, World { slope, friction, ..STATICS })), CheckKind::Torque)
    };
    assert!(matches!(judged(0.5), Status::Sampled(_)), "{:?}", judged(0.5));
    let Status::NotChecked(why) = judged(0.1) else { panic!("{:?}", judged(0.1)) };
    assert!(why.contains("it was not decided whether contact forces exist that overload nothing"), "{why}");
}

/// A body with two arms to feet in front of it, hinged at its front edge, and a cart of 5 kg that goes out over them, and then
/// across from one to the other. With all of its weight on its front edge, the body needs the same torque of both hinges
/// together wherever the cart is across, and friction as good as none gives nothing. Half of it is best for either; evenly
/// spread forces would be more.
const TABLE: &str = "
module Table {
  link body = box(200mm, 200mm, 40mm, mass: 1kg) at [0mm, 0mm, 20mm]
  link rail = box(20mm, 20mm, 20mm, mass: 1g) at [240mm, 0mm, 200mm]
  link cart = box(20mm, 20mm, 20mm, mass: 5kg) at [240mm, 60mm, 100mm]
  link foot0 = box(40mm, 40mm, 20mm, mass: 100g) at [500mm, 200mm, 10mm]
  link foot1 = box(40mm, 40mm, 20mm, mass: 100g) at [500mm, -200mm, 10mm]
  joint out : body -> rail = prismatic(axis: X, range: -500mm..500mm) at [240mm, 0mm, 200mm]
  joint across : rail -> cart = prismatic(axis: Y, range: -500mm..500mm) at [240mm, 60mm, 100mm]
  joint hinge0 : body -> foot0 = revolute(axis: Y, max_torque: LIMIT) at [100mm, 200mm, 20mm]
  joint hinge1 : body -> foot1 = revolute(axis: Y, max_torque: LIMIT) at [100mm, -200mm, 20mm]
}
config C { part m: Table
  behavior go = Sc(move(m.out, by: 60mm, in: 14s), move(m.across, by: -120mm, in: 2s))
}
let b = C().go()";

/// After much work, forces found earlier do where they overload nothing; where they overload something, the best are sought.
#[test]
fn after_many_samples_forces_that_overload_are_not_taken_for_the_best() {
    let best = 9.80665 * (5.0 * 0.2 - 1.0 * 0.1) / 2.0;
    let program = TABLE.replace("LIMIT", &format!("{}N*m", best / 0.95));
    let verdict = verify(&plan(&program, World { friction: 0.001, ..STATICS }));
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    let margin = verdict.torque_margin.map_or(f64::NAN, |worst| worst.value);
    assert!((0.0..0.05 + 1e-4).contains(&margin), "{margin}");
}
