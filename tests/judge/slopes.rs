//! Robots of modules on slopes: loads as under gravity that leans, and plans whose slope can't be.

use crate::support::desk::run_clean;
use modl::geometry::Pose;
use modl::plan::verify::articulated::{Detail, base_at, instants};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, DynamicsModel, Ground, Plan, Status, World, file};

/// An arm of three joints on a heavy foot, and a plan that moves it up a slope and across.
const ARM: &str = "
module Arm {
  link foot = box(400mm, 400mm, 100mm, mass: 20kg, friction: 1)
  link mast = box(50mm, 50mm, 200mm, mass: 1kg) at [0mm, 0mm, 150mm]
  link upper = box(300mm, 40mm, 40mm, mass: 1.5kg, com: [10mm, 5mm, 0mm]) at [150mm, 0mm, 290mm]
  link lower = box(200mm, 30mm, 30mm, mass: 0.7kg) at [402mm, 0mm, 290mm]
  joint yaw : foot -> mast = revolute(axis: Z, max_torque: 20N*m) at [0mm, 0mm, 50mm]
  joint lift : mast -> upper = revolute(axis: Y, max_torque: 20N*m) at [0mm, 0mm, 290mm]
  joint bend : upper -> lower = revolute(axis: X, max_torque: 20N*m) at [300mm, 0mm, 290mm]
}
config Lifter {
  part a: Arm
  set a.yaw = 40deg
  set a.lift = -25deg
  set a.bend = 15deg
  behavior reach = Pc(move(a.yaw, by: 50deg, in: 2s), move(a.lift, by: 30deg, in: 2s), move(a.bend, by: -70deg, in: 2s))
}
emit(plan(Lifter().reach(), world: world(terrain: slope(DEGREES, along: [3, -1, 0]), dynamics: DYNAMICS)), \"p.json\")
";

fn plan(degrees: &str, dynamics: &str) -> Plan {
    let program = ARM.replace("DEGREES", degrees).replace("DYNAMICS", dynamics);
    run_clean(&program).plan("p.json")
}

/// Returns the effort of each joint at some times.
fn efforts(plan: &Plan) -> Vec<Vec<f64>> {
    let times: Vec<f64> = (0..=20).map(|i| 0.1 * f64::from(i)).collect();
    let found = instants(plan, &times, Detail::Loads, None);
    found.iter().map(|i| i.efforts.iter().map(|e| e.expect("known")).collect()).collect()
}

/// A base that is held fast as the robot stands on the slope leaves the arm under the same gravity; its loads are found in
/// another way, without ground.
#[test]
fn joints_bear_on_a_slope_what_they_bear_with_the_base_held_as_it_leans() {
    // Under full dynamics a base that friction holds yields by parts of a millimetre as the arm moves.
    for (dynamics, tolerance) in [("full", 0.01), ("statics", 1e-6)] {
        let sloped = plan("17deg", dynamics);
        let mut held = sloped.clone();
        let world = held.worlds[0].world;
        held.worlds[0].world = World { ground: Ground::Held, slope: [0.0; 2], ..world };
        let tracks = held.body.tracks().expect("an arm").clone();
        let start =
            modl::robot::State { base: base_at(&sloped, 0.0).expect("it stands"), ..tracks.start.clone() };
        held.body = modl::plan::Tracks { start, ..tracks }.into();
        let (a, b) = (efforts(&sloped), efforts(&held));
        assert!(a.iter().flatten().any(|effort| effort.abs() > 2.0), "the arm bears something");
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((a - b).abs() < tolerance, "{a} on the slope, {b} with the base held: {dynamics}");
        }
    }
}

#[test]
fn a_plan_on_a_slope_is_read_as_it_was_written_and_one_on_level_ground_has_no_slope() {
    let sloped = plan("17deg", "full");
    let text = file::write(&sloped).expect("it can be written");
    assert_eq!(file::read(&text).expect("it is read").worlds, sloped.worlds);
    let [x, y] = sloped.worlds[0].world.slope;
    let rise = libm::tan(17_f64.to_radians());
    assert!((libm::hypot(x, y) - rise).abs() < 1e-12 && (x + 3.0 * y).abs() < 1e-12, "{x} {y}");
    let mut level = sloped;
    level.worlds[0].world.slope = [0.0; 2];
    let text = file::write(&level).expect("it can be written");
    assert!(!String::from_utf8_lossy(text.as_ref()).contains("\"slope\""));
}

/// The base stands in the world as the slope leans: its z axis is the normal.
#[test]
fn the_base_leans_with_the_ground_in_the_world() {
    let sloped = plan("17deg", "full");
    let base: Pose = base_at(&sloped, 2.0).expect("it stands");
    let up = base.rotation * modl::geometry::Vec3::z();
    let [x, y] = sloped.worlds[0].world.slope;
    let normal = modl::geometry::Vec3::new(-x, -y, 1.0).normalize();
    assert!((up - normal).norm() < 1e-9, "{up}");
}

#[test]
fn slopes_that_can_not_be_are_refused() {
    let sound = plan("10deg", "full");
    assert!(verify(&sound).ok());
    let refused = |change: &dyn Fn(&mut Plan), why: &str| {
        let mut plan = sound.clone();
        change(&mut plan);
        let verdict = verify(&plan);
        let form = verdict.checks.iter().find(|check| check.kind == CheckKind::Form);
        assert_eq!(form.map(|check| &check.status), Some(&Status::Failed), "{why}");
        assert!(verdict.failures[0].message.contains(why), "{}", verdict.failures[0].message);
    };
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        refused(&|plan| plan.worlds[0].world.slope[1] = bad, "slope");
    }
    for steep in [1.5, -1.5, 1e300, f64::MAX] {
        refused(&|plan| plan.worlds[0].world.slope[0] = steep, "at most");
    }
    for ground in [Ground::Held, Ground::Fixed, Ground::Off] {
        refused(&|plan| plan.worlds[0].world.ground = ground, "settles by its weight");
    }
    refused(&|plan| plan.worlds[0].world.gravity = 0.0, "settles by its weight");
    let other = |plan: &mut Plan| {
        let mut next = plan.worlds[0].clone();
        (next.from, next.world.slope) = (1.0, [0.1, 0.0]);
        plan.worlds.push(next);
    };
    refused(&other, "slopes otherwise");
}

/// Whatever stands in the numbers of a slope, the judge answers.
#[test]
fn the_steepest_slopes_are_judged() {
    for dynamics in [DynamicsModel::Full, DynamicsModel::Statics] {
        for slope in [[1.41, 0.0], [-1.0, 0.99], [1e-300, 0.0], [1e-9, -1e-9]] {
            let mut plan = plan("10deg", "full");
            plan.worlds[0].world = World { slope, dynamics, ..plan.worlds[0].world };
            let verdict = verify(&plan);
            assert_eq!(
                verdict.ok(),
                libm::hypot(slope[0], slope[1]) < 1.0,
                "{slope:?}: {:?}",
                verdict.failures
            );
        }
    }
}
