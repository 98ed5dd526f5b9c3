//! A car drives up a hill, turns across it and parks; how steep a hill its tyres and its motors hold.
use std.smores.Tank7

let tank = Tank7()
let hill = world(terrain: slope(6deg, along: X), friction: 0.8)
let drive = Sc(tank.drive(t: 2s), tank.turn(t: 1s), tank.drive(t: 2s))
let up = plan(drive, world: hill)
let judged = verify(up)
print("climbs {judged.displacement.z in mm:.0}, {judged.margin in mm:.0} from tipping")
print("simulated: {simulate(up).displacement.z in mm:.0}")
emit(up, "up.plan.json")

// Braked on ever steeper ground, on dry tyres and on wet ones.
fn parks(angle: Angle, friction: Number) -> Bool =
  verify(tank.drive(0rad/s, t: 500ms), world: world(terrain: slope(angle), friction: friction)).ok
print("dry: {[a for a in [5deg, 15deg, 25deg, 35deg] if parks(a, friction: 0.8)]}")
print("wet: {[a for a in [5deg, 15deg, 25deg, 35deg] if parks(a, friction: 0.3)]}")

test "it climbs, and stands on what its friction holds" {
  expect judged.ok
  expect abs(judged.displacement.z - simulate(up).displacement.z) < 2mm
  expect parks(10deg, friction: 0.8)
  expect not parks(10deg, friction: 0.1)
}
