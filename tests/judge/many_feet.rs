//! A light robot that stands on three of its feet, with more of them just above the ground.

use crate::simulate::fixtures::GRAVITY;
use crate::support::desk::run_clean;
use crate::support::verdicts::status;
use modl::geometry::Vec3;
use modl::plan::verify::articulated::{Detail, base_at, instants};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Status};

/// The feet: the place of each along x and y, mm, and its height above the ground, µm.
const FEET: [(f64, f64, f64); 7] = [
    (-260.0, 150.0, 0.0),
    (108.0, -15.0, 0.0),
    (11.0, -281.0, 0.0),
    (-99.0, 44.0, 6.0),
    (67.0, -265.0, 399.0),
    (-246.0, -204.0, 100.0),
    (296.0, 90.0, 60.0),
];

/// Returns the parts of the weight that three feet bear of a robot with its centre of mass over the origin: those whose
/// moments cancel.
fn shares(feet: [[f64; 2]; 3]) -> [f64; 3] {
    let [a, b, c] = feet;
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let areas = [cross(b, c), cross(c, a), cross(a, b)];
    areas.map(|area| area / areas.iter().sum::<f64>())
}

/// Three feet sink into the ground by some 3 µm at most, and so bear all of a light robot by the law of the lever. The first
/// guess, that all of the feet bear, would have the others pull it down, and takes some rounds to mend.
#[test]
fn three_feet_bear_a_light_robot_and_others_just_above_the_ground_bear_nothing() {
    let foot = |(i, (x, y, above)): (usize, &(f64, f64, f64))| {
        format!(
            "link f{i} = sphere(radius: 10mm, mass: 1mg) at [{x}mm, {y}mm, {}mm]
             joint j{i} : body -> f{i} = fixed()\n",
            10.0 + above * 1e-3
        )
    };
    let links: String = FEET.iter().enumerate().map(foot).collect();
    let plan = run_clean(&format!(
        "module Stool {{
           link body = box(40mm, 40mm, 40mm, mass: 49g) at [0mm, 0mm, 60mm]
           {links}
           link dial = cylinder(5mm, 5mm, mass: 1mg) at [0mm, 0mm, 85mm]
           joint turn : body -> dial = revolute(axis: Z)
         }}
         config One {{ part stool: Stool  behavior rest = wait(500ms) }}
         emit(plan(One().rest(), world: world(dynamics: full)), \"p.json\")
"
    ))
    .plan("p.json");
    let balance = status(&verify(&plan), CheckKind::Balance);
    assert!(matches!(balance, Status::Sampled(_)), "{balance:?}");
    let places = [0, 1, 2].map(|i| [FEET[i].0 * 1e-3, FEET[i].1 * 1e-3]);
    let expected = shares(places).map(|share| share * 49e-3 * GRAVITY);
    let found = &instants(&plan, &[0.25], Detail::Loads, None)[0];
    let base = base_at(&plan, 0.25).expect("it stands").translation.vector;
    let forces = found.forces.as_ref().expect("forces are known");
    assert_eq!(forces.len(), 3, "{forces:?}");
    for ([x, y], expected) in places.into_iter().zip(expected) {
        let at = |p: &Vec3| libm::hypot(p.x - base.x - x, p.y - base.y - y) < 1e-3;
        let force = forces.iter().find(|force| at(&force.point)).expect("this foot bears").force.z;
        assert!((force / expected - 1.0).abs() < 0.005, "{force} of {expected}");
    }
}
