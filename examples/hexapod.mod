//! A hexapod of one's own walks: its feet are told where to be against its body, and joints follow.
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

  // Brings toes to where they stand at the start, shifted in the frame of the body.
  behavior put(legs: List<Int>, by: Vec3<Length>, t: Time) = Pc([
    reach(leg[i].toe, position: pose(leg[i].toe).position + by, seen_from: body, in: t) for i in legs
  ])

  // Three feet lift and swing while the other three push the body ahead by a stride.
  behavior step(swing: List<Int>, push: List<Int>, stride: Length, t: Time) = Sc(
    put(swing, by: [-stride / 2, 0mm, 30mm], t: t / 2),
    Pc(put(swing, by: [stride / 2, 0mm, 30mm], t: t), put(push, by: [-stride / 2, 0mm, 0mm], t: t)),
    put(swing, by: [stride / 2, 0mm, 0mm], t: t / 2),
  )

  /// The tripod gait: the front and the back foot of one side and the middle one of the other, in turns.
  behavior tripod(stride: Length = 60mm, steps: Int = 2, t: Time = 600ms) =
    repeat(Sc(step([0, 3, 4], [1, 2, 5], stride, t), step([1, 2, 5], [0, 3, 4], stride, t)), steps)
}

let walk = Hexapod().tripod()
let report = verify(walk, reserve: 0.2)
print(report)
print(simulate(walk))
show(walk, "hexapod.html")

test "it walks half a stride, and a stride for each further step, with a reserve of 0.2" {
  expect report.ok
  expect abs(report.travel - (30mm + 3 * 60mm)) < 5mm
  expect abs(simulate(walk).travel - report.travel) < 5mm
}
