//! Modules of the file itself, one that slides among them; ports of one kind mate only with the other.
connector Plug { mates Socket, turns 4, holds 80N }
connector Socket { mates Plug, turns 4, holds 80N }

module Hinge(size: Length = 40mm) {
  mass 150g
  link base = box(size, size, size)
  link tip = box(size, size, size) at [60mm, 0mm, 0mm]
  joint bend : base -> tip = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 4N*m) at [30mm, 0mm, 0mm]
  port back : Socket on base at [-20mm, 0mm, 0mm] facing -X up +Z
  port front : Plug on tip at [20mm, 0mm, 0mm] facing +X up +Z
}

module Slide {
  mass 200g
  link base = box(60mm, 40mm, 40mm)
  link rod = box(60mm, 20mm, 20mm) at [40mm, 0mm, 0mm]
  joint out : base -> rod = prismatic(axis: X, range: 0mm..50mm, max_speed: 20mm/s, max_force: 40N) at [0mm, 0mm, 0mm]
  port back : Socket on base at [-30mm, 0mm, 0mm] facing -X up +Z
  port front : Plug on rod at [30mm, 0mm, 0mm] facing +X up +Z
}

config Arm(n: Int = 2) {
  part h[n]: Hinge
  part s: Slide
  for i in 0..n - 1 { connect h[i].front -- h[i + 1].back turn 90deg }
  connect h[n - 1].front -- s.back
  set s.out = 10mm
  base h[0]
  behavior curl(to: Angle = 30deg) = Pc([move(x.bend, to: to) for x in h])
}
