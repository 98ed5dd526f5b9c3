//! Motors under full dynamics, and what moves without them: torque at speed, joints that have no motor, and robots that slide
//! on when their joints have come to rest.

use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, DynamicsModel, Plan, Verdict, World};

/// A mast on a hinge beside its foot, on which a knob turns; the hinge is given as the rest of its `revolute(...)`.
const MAST: &str = "\
module Mast {
  link foot = box(120mm, 120mm, 40mm, mass: 1kg)
  link knob = box(20mm, 20mm, 20mm, mass: 20g) at [-40mm, -40mm, 30mm]
  joint k : foot -> knob = revolute(axis: Z, max_speed: 1rad/s, max_accel: 5rad/s^2, max_torque: 1N*m) at [-40mm, -40mm, 20mm]
  link mast = box(20mm, 20mm, 500mm, mass: 1kg) at [5mm, 0mm, 280mm]
  joint p : foot -> mast = revolute(HINGE) at [0mm, 0mm, 20mm]
  touching foot mast  touching foot knob
}
config Robot { part a: Mast  base a }
let r = Robot()
let b = move(r.a.k, to: 90deg)
";

/// A lift of 5 kg, whose motor of 100 N has no force left at 0.5 m/s.
const LIFT: &str = "\
module Lift {
  link foot = box(300mm, 300mm, 40mm, mass: 20kg)
  link cart = box(80mm, 80mm, 60mm, mass: 5kg) at [0mm, 0mm, 150mm]
  joint z : foot -> cart = prismatic(axis: Z, range: 0mm..400mm, max_speed: 1m/s, max_accel: 50m/s^2, max_force: 100N, no_load_speed: 0.5m/s) at [0mm, 0mm, 150mm]
}
config Robot { part a: Lift  base a }
let r = Robot()
";

/// A cart of four driven wheels of 40 mm, with friction 0.1, that drives for a second.
const CART: &str = "\
module Cart {
  link body = box(160mm, 90mm, 200mm, mass: 3kg) at [0mm, 0mm, 140mm]
  link fl = cylinder(radius: 40mm, length: 15mm, axis: Y, mass: 200g, friction: 0.1) at [60mm, 60mm, 40mm]
  link fr = cylinder(radius: 40mm, length: 15mm, axis: Y, mass: 200g, friction: 0.1) at [60mm, -60mm, 40mm]
  link bl = cylinder(radius: 40mm, length: 15mm, axis: Y, mass: 200g, friction: 0.1) at [-60mm, 60mm, 40mm]
  link br = cylinder(radius: 40mm, length: 15mm, axis: Y, mass: 200g, friction: 0.1) at [-60mm, -60mm, 40mm]
  joint a : body -> fl = revolute(axis: Y, max_speed: 30rad/s, max_accel: 400rad/s^2, max_torque: 3N*m) at [60mm, 60mm, 40mm]
  joint b : body -> fr = revolute(axis: Y, max_speed: 30rad/s, max_accel: 400rad/s^2, max_torque: 3N*m) at [60mm, -60mm, 40mm]
  joint c : body -> bl = revolute(axis: Y, max_speed: 30rad/s, max_accel: 400rad/s^2, max_torque: 3N*m) at [-60mm, 60mm, 40mm]
  joint d : body -> br = revolute(axis: Y, max_speed: 30rad/s, max_accel: 400rad/s^2, max_torque: 3N*m) at [-60mm, -60mm, 40mm]
}
config Robot { part c: Cart  base c }
let r = Robot()
let drive = Pc([spin(j, 15rad/s, for: 1s) for j in [r.c.a, r.c.b, r.c.c, r.c.d]])
";

/// Returns the verdict under full dynamics on the plan of a program that leaves its behaviour in `b`.
fn judged(program: &str) -> Verdict {
    let free = "emit(plan(b, world: world(ground: off, gravity: off, dynamics: statics)), \"p.json\")\n";
    let (observed, written, _) = desk::run(&MapFiles::of(&format!("{program}{free}")), Mode::Run);
    assert!(observed.diagnostics.is_empty(), "{:?}", observed.diagnostics);
    let mut plan: Plan = written.plan("p.json");
    plan.worlds[0].world = World { dynamics: DynamicsModel::Full, ..World::default() };
    verify(&plan)
}

fn kinds(verdict: &Verdict) -> Vec<CheckKind> {
    verdict.failures.iter().map(|failure| failure.kind).collect()
}

#[test]
fn a_joint_without_a_motor_must_be_held_by_something() {
    let hinged = |hinge: &str| judged(&MAST.replace("HINGE", hinge));
    // 5 mm beside its hinge the mast falls over.
    let falls = hinged("axis: Y, passive: true");
    assert_eq!(kinds(&falls), [CheckKind::Balance], "{:?}", falls.failures);
    assert!(falls.failures[0].message.contains("a.p has no motor"), "{}", falls.failures[0].message);
    // A motor holds it, and about the vertical nothing pulls at it.
    for hinge in ["axis: Y, max_torque: 1N*m", "axis: Z, passive: true"] {
        let stands = hinged(hinge);
        assert!(stands.ok(), "{hinge}: {:?}", stands.failures);
    }
    // At the end of its range it leans on its stop.
    let leans = hinged("axis: Y, range: -30deg..0deg, passive: true");
    assert!(leans.ok(), "{:?}", leans.failures);
}

#[test]
fn a_motor_has_less_force_at_speed() {
    // A move over 0.2 m in a time t is at its fastest at 1.875 times the mean speed: 0.19 m/s in 2 s, where 62 N are left of
    // 100, and 0.31 m/s in 1.2 s, where 37 N are left; the weight is 49 N.
    let lift = |time: &str| judged(&format!("{LIFT}let b = move(r.a.z, to: 200mm, in: {time})\n"));
    let slow = lift("2s");
    assert!(slow.ok(), "{:?}", slow.failures);
    let fast = lift("1.2s");
    assert_eq!(kinds(&fast), [CheckKind::Torque], "{:?}", fast.failures);
    assert!(fast.failures[0].message.contains("at its speed"), "{}", fast.failures[0].message);
    // A motor can't go beyond its speed without load: 0.52 m/s in 0.72 s.
    let beyond = lift("750ms").failures.into_iter().chain(lift("720ms").failures);
    let speeds: Vec<String> = beyond.filter(|f| f.kind == CheckKind::Speed).map(|f| f.message).collect();
    assert!(matches!(&speeds[..], [speed] if speed.contains("500mm/s")), "{speeds:?}");
}

#[test]
fn a_robot_slides_on_when_its_joints_have_come_to_rest() {
    // Locked wheels stop the cart over v² / 2 μ g = 0.6² / (2 · 0.1 · 9.81) = 184 mm. It begins to slide as they slow down, over
    // the last 15 / 400 s of the drive: 0.6 · 0.0375 - 0.98 · 0.0375² / 2 = 22 mm of them.
    let stopped = judged(&format!("{CART}let b = drive\n"));
    assert_eq!(kinds(&stopped), [CheckKind::Rest], "{:?}", stopped.failures);
    assert!(stopped.failures[0].message.contains("still slides at"), "{}", stopped.failures[0].message);
    let rests = judged(&format!("{CART}let b = Sc(drive, wait(1s))\n"));
    assert!(rests.ok(), "{:?}", rests.failures);
    let on = 1e3 * (rests.travel[0] - stopped.travel[0]);
    assert!((on - 162.0).abs() < 8.0, "it slides on for {on} mm");
    // Spinning wheels push with μ m g up to 0.6 m/s, after 0.61 s and over as much as it takes to stop.
    let whole = 1e3 * rests.travel[0];
    let expected = 2.0 * 184.0 + 600.0 * (1.0 - 0.0375 - 0.6 / (0.1 * 9.80665));
    assert!((whole - expected).abs() < 0.03 * expected, "{whole} mm, expected {expected} mm");
}
