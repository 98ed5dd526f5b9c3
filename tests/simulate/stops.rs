//! Stops at the ends of joints' ranges, beside the deflection of a spring under a weight.

use super::fixtures::{GRAVITY, HELD, at, plan, play};
use modl::simulate::Settings;

/// Loads that hang on the lower stops of joints without motors: a cart of 5 kg that slides, and an arm of 2 kg whose centre of
/// mass is 100 mm from its hinge.
const HANGS: &str = "\
module Hang {
  link post = box(40mm, 40mm, 900mm, mass: 1kg)
  link cart = box(80mm, 80mm, 60mm, mass: 5kg) at [80mm, 0mm, 100mm]
  joint z : post -> cart = prismatic(axis: Z, range: 0mm..300mm, passive: true) at [80mm, 0mm, 100mm]
  link arm = box(200mm, 20mm, 20mm, mass: 2kg) at [-120mm, 0mm, -200mm]
  joint p : post -> arm = revolute(axis: Y, range: 0deg..90deg, passive: true) at [-20mm, 0mm, -200mm]
  touching post arm
}
config Robot { part h: Hang  base h  behavior rest(t: Time) = wait(t) }
let x = Robot()
let b = x.rest(2s)
";

#[test]
fn what_hangs_on_a_stop_hangs_on_a_stiff_spring() {
    let simulation = play(&plan(HANGS, HELD), &Settings::default());
    let joints = &at(&simulation, 2.0).joints;
    // m g / k with 1e5 N/m, and m g l / k with 1e3 N·m/rad; the arm pulls towards negative angles or positive ones.
    let expected = [5.0 * GRAVITY / 1e5, 2.0 * GRAVITY * 0.1 / 1e3];
    assert!((joints[0] + expected[0]).abs() < 0.02 * expected[0], "{joints:?}, {expected:?}");
    assert!((joints[1].abs() - expected[1]).abs() < 0.02 * expected[1], "{joints:?}, {expected:?}");
}
