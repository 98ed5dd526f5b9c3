//! A bond that breaks: a magnet holds a load while an arm lifts it slowly, and loses it when the arm is quick.

connector Magnet { mates Magnet, turns 4, holds 0.6N*m }

/// An arm on a heavy foot, with a magnet at its end.
module Arm {
  link foot = box(200mm, 200mm, 60mm, mass: 8kg)
  link rod = box(300mm, 30mm, 30mm, mass: 400g) at [150mm, 0mm, 60mm]
  joint lift : foot -> rod = revolute(
    axis: -Y,
    range: -10deg..100deg,
    max_speed: 360deg/s,
    max_accel: 3600deg/s^2,
    max_torque: 30N*m
  ) at [0mm, 0mm, 60mm]
  touching foot rod
  port tip : Magnet on rod at [150mm, 0mm, 0mm] facing +X up +Z
}

module Load {
  link cube = box(60mm, 60mm, 60mm, mass: 1kg)
  port side : Magnet on cube at [-30mm, 0mm, 0mm] facing -X up +Z
}

config Lifter {
  part arm: Arm
  part load: Load
  connect arm.tip -- load.side
  base arm
  behavior lift(t: Time) = move(arm.lift, to: 60deg, in: t)
}

let x = Lifter()
print("slowly", simulate(x.lift(2s)).bond_load)
let quick = simulate(x.lift(350ms))
print("at once", quick.failures)

test "the moment of the load is that of its weight when it is lifted slowly" {
  // 1 kg at 30 mm from the magnet is 0.294 N*m, of 0.6 N*m.
  let slow = simulate(x.lift(4s))
  expect slow.failures == [] and abs(slow.bond_load - 0.49) < 0.05
}

test "a quick lift loses the load" {
  expect len(quick.failures) > 0
}
