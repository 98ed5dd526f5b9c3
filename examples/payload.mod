//! A quadruped of one's own carries a payload: it leans over three feet, and sets the fourth ahead.
connector Clip { mates Clip, turns 1, holds 300N, holds 30N*m }

/// Four ports for legs, 0 and 2 to the left, 1 and 3 to the right, from front to back, and one on top.
module Body {
  link shell = box(320mm, 160mm, 40mm, mass: 2kg)
  for i in 0..4 {
    port side[i] : Clip on shell
      at [120mm - 240mm * div(i, 2), if i % 2 == 0 { 80mm } else { -80mm }, 0mm]
      facing if i % 2 == 0 { Y } else { -Y } up +Z
  }
  port top : Clip on shell at [0mm, 0mm, 20mm] facing +Z
}

module Payload {
  link box = box(160mm, 120mm, 80mm, mass: 3kg)
  port under : Clip on box at [0mm, 0mm, -40mm] facing -Z
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
    max_torque: 20N*m
  ) at [60mm, 0mm, 0mm]
  joint lift : coxa -> thigh = revolute(
    axis: Y,
    range: -70deg..70deg,
    max_speed: 4rad/s,
    max_torque: 20N*m
  ) at [60mm, 0mm, 0mm]
  joint knee : thigh -> shin = revolute(
    axis: Y,
    range: -60deg..90deg,
    max_speed: 4rad/s,
    max_torque: 20N*m
  ) at [180mm, 0mm, 0mm]
  touching hip thigh
  touching thigh shin
  port root : Clip on hip at [-20mm, 0mm, 0mm] facing -X up +Z
  port toe : Clip on shin at [0mm, 0mm, -75mm] facing -Z up +X
}

config Quadruped {
  part body: Body
  part load: Payload
  part leg[4]: Leg
  for i in 0..4 { connect body.side[i] -- leg[i].root }
  connect body.top -- load.under
  base body

  // Brings toes to where they stand at the start, shifted in the frame of the body.
  behavior put(legs: List<Int>, by: fn(Int) -> Vec3<Length>, t: Time) = Pc([
    reach(leg[i].toe, position: pose(leg[i].toe).position + by(i), seen_from: body, in: t) for i in legs
  ])
}

// The order in which feet step, and the place of each foot in it.
let order = [2, 0, 3, 1]
let turn = [1, 3, 0, 2]
let stride = 40mm

// Where foot `i` stands against the body before step `n`, once the body has gone on for it, aside by `lean`.
fn stands(i: Int, n: Int, lean: Length) -> Vec3<Length> = {
  let steps = div(n, 4) + (if turn[i] < n % 4 { 1 } else { 0 })
  [stride * steps - stride * (n + 1) / 4, lean, 0mm]
}

let q = Quadruped()
fn step(n: Int) -> Behavior = {
  let i = order[n % 4]
  // Away from the side on which the foot is lifted.
  let lean = if i % 2 == 0 { 60mm } else { -60mm }
  let up: Vec3<Length> = [stride / 2, 0mm, 30mm]
  let ahead: Vec3<Length> = [stride, 0mm, 0mm]
  Sc(
    q.put([0, 1, 2, 3], by: j => stands(j, n, lean), t: 700ms),
    q.put([i], by: j => stands(j, n, lean) + up, t: 300ms),
    q.put([i], by: j => stands(j, n, lean) + ahead, t: 300ms),
  )
}
// At last the body comes back from its lean.
let walk = Sc([step(n) for n in 0..8] ++ [q.put([0, 1, 2, 3], by: j => stands(j, 8, 0mm), t: 700ms)])
let report = verify(walk, reserve: 0.2)
print(report)
print(simulate(walk))
show(walk, "payload.html")

test "it carries 3 kg by a quarter of a stride for each step and one more, with a reserve of 0.2" {
  expect report.ok
  expect abs(report.travel - 9 * stride / 4) < 4mm
  expect abs(simulate(walk).travel - report.travel) < 4mm
}
