//! Rolling without slip, whatever the direction of the axles: a robot on wheels goes as far as they turn, across their axles.

use crate::support::desk::run_clean;
use modl::plan::Plan;
use modl::plan::verify::articulated::base_at;

/// A body on two pairs of wheels of 50 mm radius, whose axles point along (cos, sin) of an angle.
fn cart(degrees: f64) -> Plan {
    let (s, c) = libm::sincos(degrees.to_radians());
    // The places of wheels: ahead and astern across the axle, to both sides along it.
    let wheel = |name: &str, across: f64, along: f64| {
        let (x, y) = (-s * across + c * along, c * across + s * along);
        format!(
            "link {name} = cylinder(radius: 50mm, length: 20mm, axis: {c} * X + {s} * Y, mass: 200g, friction: 1)
               at [{x}mm, {y}mm, 50mm]
             joint {name}_turn : body -> {name} = revolute(axis: {c} * X + {s} * Y) at [{x}mm, {y}mm, 50mm]\n"
        )
    };
    let wheels: String = [("a", 100.0, 80.0), ("b", 100.0, -80.0), ("c", -100.0, 80.0), ("d", -100.0, -80.0)]
        .iter()
        .map(|(name, across, along)| wheel(name, *across, *along))
        .collect();
    let turns = ["a", "b", "c", "d"].map(|name| format!("move(k.{name}_turn, to: 4rad, in: 4s)")).join(", ");
    let program = format!(
        "module Cart {{ link body = box(100mm, 100mm, 40mm, mass: 2kg) at [0mm, 0mm, 80mm]\n{wheels} }}
         let k = Cart()
         emit(plan(Pc({turns}), world: world(dynamics: statics)), \"p.json\")\n"
    );
    run_clean(&program).plan("p.json")
}

#[test]
fn wheels_roll_across_their_axles() {
    for degrees in [0.0, 90.0, 30.0, -75.0] {
        let plan = cart(degrees);
        let [first, last] = [0.0, plan.body.duration()].map(|t| base_at(&plan, t).expect("it stands"));
        let way = (last.translation.vector - first.translation.vector).xy();
        // Turned about +z × axle, the lowest point of a wheel goes against the way.
        let (s, c) = libm::sincos(degrees.to_radians());
        let expected = [s * 0.2, -c * 0.2];
        let off = libm::hypot(way.x - expected[0], way.y - expected[1]);
        assert!(off < 1e-6, "axles at {degrees}°: {way} is not {expected:?}");
        assert!(first.rotation.angle_to(&last.rotation) < 1e-6);
    }
}
