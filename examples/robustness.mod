//! What a verdict leaves open: does a walk still happen where friction, masses and motors are not as stated?
use std.smores.Walk4

let w = Walk4()
let walk = plan(Sc(w.stand(), w.walk(steps: 1)))
print("verdict", verify(walk).travel)

// On rigid bodies, with a motor's servo in each joint.
let nominal = simulate(walk)
print(nominal)

// Four more runs, each with other friction, masses and motors; the same ones for the same seed.
let varied = simulate(walk, runs: 4, seed: 1, friction_spread: 0.3, mass_spread: 0.1, torque_spread: 0.1)
print("falls", varied.falls, "least travel", min(varied.travels))

test "a walk on slippery ground is shorter, and does not fall" {
  let ice = simulate(walk, friction: 0.2)
  expect not ice.fell
  expect ice.displacement.x < nominal.displacement.x
}
