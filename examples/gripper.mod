//! A gripper of one's own on a library's arm: parts of the project and of the library in one robot.
use std.smores.{Smores, MagnetFace, Driver5}

/// Two fingers that close on rails. It has no motor for turning: the arm's last module does that.
module Gripper(reach: Length = 60mm) {
  link palm = box(20mm, 90mm, 60mm, mass: 120g)
  link upper = box(reach, 10mm, 30mm, mass: 30g, friction: 0.9) at [reach / 2 + 10mm, 30mm, 0mm]
  link lower = box(reach, 10mm, 30mm, mass: 30g, friction: 0.9) at [reach / 2 + 10mm, -30mm, 0mm]
  joint slide : palm -> upper = prismatic(axis: -Y, range: 0mm..24mm, max_speed: 40mm/s, max_force: 30N)
  joint follow : palm -> lower = prismatic(axis: Y, range: 0mm..24mm, max_speed: 40mm/s, max_force: 30N)
  port wrist : MagnetFace on palm at [-10.5mm, 0mm, 0mm] facing -X up +Z
}

/// A small car that carries the gripper on an arm of two modules.
config Picker {
  part car: Driver5
  part arm[2]: Smores
  part hand: Gripper
  connect car.nose -- arm[0].bottom
  connect arm[0].top -- arm[1].bottom
  connect arm[1].top -- hand.wrist

  behavior grip = Pc(move(hand.slide, to: 20mm), move(hand.follow, to: 20mm))
  behavior release = Pc(move(hand.slide, to: 0mm), move(hand.follow, to: 0mm))
  behavior lift(a: Angle = 40deg) = move(arm[1].tilt, to: a)
  behavior pick = Sc(grip(), lift(), wait(1s), lift(0deg), release())
}

let p = Picker()
print("order", order(p), "mass", mass(p))
emit(p.pick(), "pick.plan.json")

test "the fingers close without meeting" {
  let r = verify(p.grip())
  expect r.ok
  expect plan(p.grip()).duration < 2s
}
