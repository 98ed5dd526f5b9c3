//! An arm of six modules of one's own picks up a crate, carries it round a post, and puts it down.
connector Grip { mates Grip, turns 4, holds 400N, holds 60N*m, capture 5mm 3deg }

/// A link that bends in its middle, or turns about its length.
module Link(turns: Bool = false) {
  link base = capsule(radius: 25mm, length: 45mm, axis: X, mass: 400g) at [-22.5mm, 0mm, 0mm]
  link tip = capsule(radius: 25mm, length: 45mm, axis: X, mass: 400g) at [22.5mm, 0mm, 0mm]
  joint turn : base -> tip = revolute(
    axis: if turns { X } else { Y },
    range: -150deg..150deg,
    max_speed: 90deg/s,
    max_accel: 180deg/s^2,
    max_torque: 60N*m
  )
  port back : Grip on base at [-70mm, 0mm, 0mm] facing -X up +Z
  port front : Grip on tip at [70mm, 0mm, 0mm] facing +X up +Z
}

module Foot {
  link plate = cylinder(radius: 200mm, length: 40mm, mass: 30kg, friction: 0.8)
  port top : Grip on plate at [0mm, 0mm, 20mm] facing +Z
}

module Crate {
  link body = box(80mm, 80mm, 80mm, mass: 500g)
  port lid : Grip on body at [0mm, 0mm, 40mm] facing +Z
}

/// Waist, shoulder, elbow, and a wrist of three joints.
config Arm {
  part foot: Foot
  part m[i in 0..6]: Link(turns: i == 0 or i == 3 or i == 5)
  connect foot.top -- m[0].back
  for i in 0..5 { connect m[i].front -- m[i + 1].back }
  set m[1].turn = 40deg
  set m[2].turn = 80deg
  set m[4].turn = 60deg
  base foot
  port hand = m[5].front
}

scene Cell {
  part arm: Arm
  part crate: Crate at [300mm, -150mm, 40mm]
  obstacle post = box(60mm, 60mm, 600mm) at [300mm, 0mm, 300mm]
}

let c = Cell()
let hand = c.arm.hand
// Over the ground at a place beside the post, looking down.
fn over(y: Length, height: Length) -> Pose = pose_at([300mm, y, height], facing: -Z, up: -X)
let pick = Sc(
  avoid(reach(hand, to: over(-150mm, 160mm))),
  line(hand, by: [0mm, 0mm, -80mm], for: 1s),
  wait(200ms),
  dock(hand, c.crate.lid),
)
let carry = Sc(line(hand, by: [0mm, 0mm, 100mm], for: 1s), avoid(reach(hand, to: over(150mm, 180mm))))
let place = Sc(
  line(hand, by: [0mm, 0mm, -100mm], for: 1s),
  wait(200ms),
  undock(hand),
  line(hand, by: [0mm, 0mm, 80mm], for: 1s),
)
let whole = Sc(pick, carry, place)
print(verify(whole))
show(whole, "pick_and_place.html")

test "the crate is on the other side of the post, and nothing met" {
  expect verify(whole).ok
  let p = plan(whole)
  let moved = p.end.pose(c.crate.lid).position - p.start.pose(c.crate.lid).position
  expect norm(moved - [0mm, 300mm, 0mm]) < 0.5mm
}
