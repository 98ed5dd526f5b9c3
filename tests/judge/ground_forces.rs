//! Forces of the ground on robots that hardly move, in closed form.

use crate::support::desk::run_clean;
use modl::geometry::Vec3;
use modl::plan::Plan;
use modl::plan::verify::articulated::{Detail, base_at, instants};

fn plan(program: &str) -> Plan {
    run_clean(program).plan("p.json")
}

/// Returns the forces of the ground at a time, as (place, force) in the world.
fn forces(plan: &Plan, t: f64) -> Vec<(Vec3, Vec3)> {
    let found = instants(plan, &[t], Detail::Loads, None);
    let forces = found[0].forces.as_ref().expect("forces are known");
    forces.iter().map(|force| (force.point, force.force)).collect()
}

#[test]
fn forces_of_the_ground_add_up_to_the_weight_however_small() {
    // 80 g on four balls of a spider, each of which bears less than 1 N; on the ground, and on a base that keeps its place
    // under little gravity, which rests on the ground, too.
    for (ground, gravity) in [("settle", 9.80665), ("fixed", 0.5), ("fixed", 9.80665), ("settle", 0.3)] {
        let feet: String = [(40, 30), (40, -30), (-40, 30), (-40, -30)]
            .iter()
            .enumerate()
            .map(|(i, (x, y))| {
                format!(
                    "link f{i} = sphere(5mm, mass: 5g) at [{x}mm, {y}mm, 5mm]
                     joint k{i} : body -> f{i} = fixed()\n"
                )
            })
            .collect();
        let plan = plan(&format!(
            "module Spider {{
               link body = box(80mm, 60mm, 10mm, mass: 50g) at [0mm, 0mm, 20mm]
               {feet}
               link arm = box(10mm, 10mm, 30mm, mass: 10g) at [0mm, 0mm, 40mm]
               joint turn : body -> arm = revolute(axis: Z)
             }}
             let spider = Spider()
             emit(plan(move(spider.turn, by: 0.1rad, in: 4s),
               world: world(ground: {ground}, gravity: {gravity}m/s^2, dynamics: full)), \"p.json\")
"
        ));
        let found = forces(&plan, 2.0);
        assert_eq!(found.len(), 4, "{ground} {gravity}: {found:?}");
        let sum: Vec3 = found.iter().map(|(_, force)| force).sum();
        assert!((sum.z / (0.08 * gravity) - 1.0).abs() < 1e-3, "{ground} {gravity}: {sum}");
        assert!(found.iter().all(|(_, force)| (force.z / (0.02 * gravity) - 1.0).abs() < 0.01), "{found:?}");
    }
}

#[test]
fn wheels_share_the_weight_as_a_plane() {
    // All contacts have one stiffness, so that a rigid cart bears on each wheel what a plane through its centre of mass says:
    // W (1/4 + x x_c / Σx² + y y_c / Σy²).
    let (a, b) = (0.12, 0.1);
    let places = [(a, b), (a, -b), (-a, b), (-a, -b)];
    let wheels: String = places
        .iter()
        .enumerate()
        .map(|(i, (x, y))| {
            format!(
                "link w{i} = cylinder(radius: 50mm, length: 30mm, axis: Y, mass: 250g) at [{x}m, {y}m, 50mm]
                 joint t{i} : body -> w{i} = revolute(axis: Y) at [{x}m, {y}m, 50mm]\n"
            )
        })
        .collect();
    let plan = plan(&format!(
        "module Cart {{
           link body = box(100mm, 100mm, 40mm, mass: 3kg, com: [20mm, -10mm, 0mm]) at [0mm, 0mm, 80mm]
           {wheels}
         }}
         let cart = Cart()
         emit(plan(Pc(move(cart.t0, by: 1rad, in: 8s), move(cart.t1, by: 1rad, in: 8s), move(cart.t2, by: 1rad, in: 8s),
           move(cart.t3, by: 1rad, in: 8s)), world: world(dynamics: full)), \"p.json\")
"
    ));
    let (weight, x_c, y_c) = (4.0 * 9.80665, 0.02 * 3.0 / 4.0, -0.01 * 3.0 / 4.0);
    for t in [0.0, 3.3, 5.7] {
        let base = base_at(&plan, t).expect("it stands").translation.vector;
        let found = forces(&plan, t);
        for (x, y) in places {
            let (wheel, expected) = (
                Vec3::new(base.x + x, base.y + y, 0.0),
                weight * (0.25 + x * x_c / (4.0 * a * a) + y * y_c / (4.0 * b * b)),
            );
            // On the tread: below the axle, within the width.
            let near =
                found.iter().filter(|(p, _)| (p.x - wheel.x).abs() < 6e-3 && (p.y - wheel.y).abs() < 0.016);
            let bears: f64 = near.map(|(_, force)| force.z).sum();
            assert!((bears / expected - 1.0).abs() < 5e-3, "{t} s, wheel at {x}, {y}: {bears} of {expected}");
        }
    }
}

#[test]
fn a_robot_that_holds_still_on_a_slope_does_not_creep() {
    // Friction is viscous at low speed, yet a robot whose joints rest stays where it is.
    let plan = plan(
        "module Box {
           link body = box(200mm, 200mm, 60mm, mass: 2kg, friction: 1)
           link arm = box(100mm, 20mm, 20mm, mass: 200g) at [40mm, 0mm, 45mm]
           joint turn : body -> arm = revolute(axis: Z) at [0mm, 0mm, 45mm]
         }
         let box_ = Box()
         emit(plan(Sc(move(box_.turn, by: 1rad, in: 1s), wait(2s), move(box_.turn, by: 1rad, in: 1s)),
           world: world(terrain: slope(20deg, along: [1, 2, 0]), dynamics: full)), \"p.json\")
",
    );
    let at = |t: f64| base_at(&plan, t).expect("it stands").translation.vector;
    assert!((at(1.1) - at(2.9)).norm() < 1e-9, "{} and {}", at(1.1), at(2.9));
    // As the arm moves, it may creep by what viscous friction lets through: less than a millimetre a second.
    assert!((at(4.0) - at(0.0)).norm() < 2e-3);
}
