//! Bodies that settle on the ground from where they are drawn: where they come to rest, the ground bears them.

use crate::support::arms::robot_of;
use crate::support::desk::run_clean;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::link;
use crate::support::verdicts::status;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Shape, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Status};

/// Returns the margin with which a random body stands after it has settled, m: the hull of balls in a box whose sides are from
/// 8 mm to 4 m, or on the ellipsoid in it, with a centre of mass that is off the middle. `None` if the centre is out of it.
fn margin(random: &mut SplitMix64) -> Option<f64> {
    let mut number = |low: f64, high: f64| low + (high - low) * random.next_f64();
    let count = 4 + (number(0.0, 1.0) * number(0.0, 150.0)) as usize;
    let mut side = || libm::exp(number(-5.5, 0.7));
    let half = Vec3::new(side(), side(), side());
    let radius = if number(0.0, 1.0) < 0.5 { 1e-3 } else { number(1e-3, 0.02) };
    let round = number(0.0, 1.0) < 0.5;
    let mut vector = |most: f64| Vec3::new(number(-most, most), number(-most, most), number(-most, most));
    let mut balls = Vec::with_capacity(count);
    for _ in 0..count {
        let within = vector(1.0);
        let at = if round { within / within.norm().max(1e-3) } else { within };
        let shape = Shape::Sphere { radius };
        balls.push(Placed { pose: shifted(at.component_mul(&half)), shape });
    }
    let middle = balls.iter().map(|ball| ball.pose.translation.vector).sum::<Vec3>() / count as f64;
    let mut body = link("body", balls, 1.0, middle, 0.5);
    body.com = middle + vector(0.01);
    let axis = vector(1.0);
    let mut motion = Motion::new(robot_of(vec![body], vec![]));
    motion.tracks.start.base = turned(axis, number(0.0, 3.0));
    motion.tracks.duration = 0.01;
    verify(&motion.plan(STATICS)).margin.map(|margin| margin.value)
}

/// At rest the centre of mass is over what the body stands on, up to the precision with which it is turned.
#[test]
fn a_body_at_rest_has_its_centre_of_mass_over_its_support() {
    let mut random = SplitMix64(99);
    let margins: Vec<f64> = (0..400).filter_map(|_| margin(&mut random)).collect();
    assert!(margins.len() > 300, "{}", margins.len());
    let least = margins.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(least > -1e-5, "{least}");
}

/// A dial on a heavy plate turns, or the plate under the dial, as the one or the other is the base. The plate stays where it is
/// for its mass, and so no step moves the centre of mass, 10 mm from an edge of the plate, over it: that is proved for both.
#[test]
fn a_plate_that_a_light_base_turns_on_stands_as_surely_as_one_that_is_the_base() {
    let plate = "link plate = box(400mm, 400mm, 40mm, mass: 10kg, com: [190mm, 0mm, 0mm])";
    let dial = "link dial = cylinder(radius: 5mm, length: 10mm, axis: Z, mass: 1g) at [0mm, 0mm, 30mm]";
    for (first, second, joint) in [(plate, dial, "plate -> dial"), (dial, plate, "dial -> plate")] {
        let program = format!(
            "module M {{
  {first}
  {second}
  joint turn : {joint} = revolute(axis: Z) at [0mm, 0mm, 30mm]
}}
config C {{ part m: M  behavior go = move(m.turn, by: 90deg, in: 2s) }}
emit(plan(C().go(), world: world(dynamics: statics)), \"p.json\")
"
        );
        let verdict = verify(&run_clean(&program).plan("p.json"));
        assert_eq!(status(&verdict, CheckKind::Stability), Status::Proved, "{joint}");
    }
}
