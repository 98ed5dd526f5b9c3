//! A hexapod of one's own walks ahead, aside and round: its feet are put to where a gait has them, and joints follow.
use std.legs.{Legs, Walk, ripple, standing, tripod}

connector Clip { mates Clip, turns 1, holds 300N, holds 30N*m }

/// Six ports for legs: 0, 2 and 4 to the left, 1, 3 and 5 to the right, from front to back.
module Body {
  link shell = box(320mm, 160mm, 40mm, mass: 2kg)
  for i in 0..6 {
    port side[i] : Clip on shell
      at [120mm - 120mm * div(i, 2), if i % 2 == 0 { 80mm } else { -80mm }, 0mm]
      facing if i % 2 == 0 { Y } else { -Y } up +Z
  }
}

/// A leg of three joints, drawn with its shin upright.
module Leg {
  link hip = box(40mm, 30mm, 30mm, mass: 100g) at [20mm, 0mm, 0mm]
  link coxa = sphere(radius: 18mm, mass: 100g) at [60mm, 0mm, 0mm]
  link thigh = capsule(radius: 12mm, length: 70mm, axis: X, mass: 200g) at [120mm, 0mm, 0mm]
  link shin = capsule(radius: 12mm, length: 126mm, axis: Z, mass: 150g, friction: 0.8) at [180mm, 0mm, -75mm]
  joint yaw : hip -> coxa = revolute(
    axis: Z,
    range: -60deg..60deg,
    max_speed: 4rad/s,
    max_accel: 60rad/s^2,
    max_torque: 12N*m
  ) at [60mm, 0mm, 0mm]
  joint lift : coxa -> thigh = revolute(
    axis: Y,
    range: -70deg..70deg,
    max_speed: 4rad/s,
    max_accel: 60rad/s^2,
    max_torque: 12N*m
  ) at [60mm, 0mm, 0mm]
  joint knee : thigh -> shin = revolute(
    axis: Y,
    range: -60deg..90deg,
    max_speed: 4rad/s,
    max_accel: 60rad/s^2,
    max_torque: 12N*m
  ) at [180mm, 0mm, 0mm]
  touching hip thigh
  touching thigh shin
  port root : Clip on hip at [-20mm, 0mm, 0mm] facing -X up +Z
  port toe : Clip on shin at [0mm, 0mm, -75mm] facing -Z up +X
}

config Hexapod {
  part body: Body
  part leg[6]: Leg
  for i in 0..6 { connect body.side[i] -- leg[i].root }
  base body

  let legs = Legs(body: body, feet: [l.toe for l in leg], stand: [pose(l.toe).position for l in leg])

  /// Walks by the tripod gait: in each cycle ahead by a stride and round to the left.
  behavior walk(stride: Length = 60mm, turn: Angle = 0deg, cycles: Int = 3) = {
    require standing(start, by: 20mm), "it stands"
    ensure standing(end, by: 20mm)
    ensure abs(report.heading - cycles * turn) < 2deg
    tripod(legs, Walk(stride: [stride, 0mm, 0mm], turn: turn, beat: 1s), cycles)
  }

  /// Walks to the left by the ripple gait.
  behavior aside(stride: Length = 45mm, cycles: Int = 2) = {
    require standing(start, by: 20mm), "it stands"
    ensure abs(report.displacement.y - cycles * stride) < 5mm
    ripple(legs, Walk(stride: [0mm, stride, 0mm], beat: 1s), cycles)
  }
}

let robot = Hexapod()
let report = verify(robot.walk(), reserve: 0.2)
print(report)
print(simulate(robot.walk()))
show(robot.walk(), "hexapod.html")

test "it walks a stride in each cycle, with a reserve of 0.2, as its feet say" {
  expect report.ok
  expect abs(report.travel - 3 * 60mm) < 5mm
  expect abs(simulate(robot.walk()).travel - report.travel) < 5mm
}

test "it goes round, and aside, as it ensures" {
  let round = verify(robot.walk(turn: 12deg, cycles: 1), reserve: 0.2)
  expect round.ok
  expect abs(round.heading - 12deg) < 2deg
  expect verify(robot.aside(cycles: 1), reserve: 0.2).ok
}
