//! Sagging arms whose hands come to rest on the ground, whatever the weight there is.

use crate::support::desk::{run_clean, stated};
use crate::support::verdicts::failures_of;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, DynamicsModel, Ground, World};

/// An arm on a heavy base holds a hand of 500 g, 100 mm away and 2 mm above the ground. Its motor is too weak to hold it
/// there, and the ground is all that ends its fall, so that gravity makes no difference, as long as servos scale with it.
/// The weakest here presses the base into the ground by less than the size of an atom.
#[test]
fn a_hand_that_comes_down_on_the_ground_sags_by_its_height_under_any_gravity() {
    for gravity in [1e-3, 1e-9, 1e-15] {
        let program = format!(
            "module Arm {{
               link base = box(400mm, 400mm, 20mm, mass: 20kg) at [0mm, 0mm, 10mm]
               link hand = sphere(radius: 10mm, mass: 500g) at [300mm, 0mm, 12mm]
               joint wrist : base -> hand = revolute(axis: Y, max_torque: {:e}N*m, stiffness: {gravity:e}N*m/rad) at [200mm, 0mm, 12mm]
             }}
             config One {{ part arm: Arm  behavior rest = wait(500ms) }}
             emit(plan(One().rest(), world: world(ground: off, gravity: off, dynamics: statics)), \"p.json\")
",
            0.01 * gravity
        );
        let mut plan = run_clean(&program).plan("p.json");
        let world = World { gravity, ground: Ground::Settle, dynamics: DynamicsModel::Full, ..World::FREE };
        plan.worlds[0].world = world;
        let verdict = verify(&plan);
        let found = failures_of(CheckKind::Torque, &verdict);
        let [over] = found.as_slice() else { panic!("{gravity:e}: {found:#?}") };
        let sag = stated(&over.message, "with its motors at their limits, arm.wrist would sag by", "deg");
        let expected = (2e-3_f64 / 0.1).to_degrees();
        assert!((sag / expected - 1.0).abs() < 0.005, "{gravity:e}: {sag} of {expected} in {}", over.message);
    }
}
