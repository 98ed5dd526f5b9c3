//! A hexapod of seventeen SMORES-EP modules: a spine of five, with three pairs of legs that swing one at a time.
use std.legs.{Legs, Walk, standing, walk}
use std.smores.SmoresEP

/// A leg of two modules, bent down like a knee; it stands on the disc of its shin.
config EpLeg {
  part thigh: SmoresEP
  part shin: SmoresEP
  connect thigh.top -- shin.bottom
  set thigh.tilt = -60deg
  set shin.tilt = -30deg
  base thigh
  port hip = thigh.bottom
  port toe = shin.top
}

config EpHexapod {
  part spine[5]: SmoresEP
  part leg[6]: EpLeg
  for i in 0..4 { connect spine[i].bottom -- spine[i + 1].top }
  for i in 0..3 {
    connect spine[2 * i].left -- leg[2 * i].hip
    connect spine[2 * i].right -- leg[2 * i + 1].hip
  }
  base spine[2]

  // The joints of the spine stand still: each leg moves against the module on which it hangs.
  let legs = Legs(
    body: spine[2],
    feet: [l.toe for l in leg],
    stand: [pose(l.toe).position for l in leg],
    hips: [spine[2 * div(i, 2)] for i in 0..6],
  )

  /// Walks ahead, one foot after the other: with three feet off the ground the spine would have to bear more twist than it can.
  behavior ahead(stride: Length = 8mm, cycles: Int = 1) = {
    require standing(start, by: 50mm), "it stands"
    ensure standing(end, by: 50mm)
    walk(
      legs,
      groups: [[4], [2], [0], [5], [3], [1]],
      how: Walk(stride: [stride, 0mm, 0mm], lift: 6mm, beat: 2s),
      cycles: cycles,
    )
  }
}

let robot = EpHexapod()
print(verify(robot.ahead(), reserve: 0.4))
emit(robot.ahead(), "smores_hexapod.plan.json", reserve: 0.4)

test "it gets on by most of its stride, with a reserve of 0.4" {
  let r = verify(robot.ahead(), reserve: 0.4)
  expect r.ok
  expect r.displacement.x > 6mm and r.displacement.x < 8mm
}
