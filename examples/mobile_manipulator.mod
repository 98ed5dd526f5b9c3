//! A rover with an arm drives to a crate, picks it up where it stands in the world, and drives back.
use "pick_and_place.mod".{Crate, Grip, Link}

/// Two wheels that are driven, and two smooth knobs, before and behind them.
module Rover {
  link chassis = box(500mm, 300mm, 80mm, mass: 25kg)
  link left = cylinder(radius: 80mm, length: 30mm, axis: Y, mass: 1kg, friction: 1) at [0mm, 180mm, -20mm]
  link right = cylinder(radius: 80mm, length: 30mm, axis: Y, mass: 1kg, friction: 1) at [0mm, -180mm, -20mm]
  link front = sphere(radius: 30mm, mass: 200g, friction: 0.01) at [220mm, 0mm, -70mm]
  link back = sphere(radius: 30mm, mass: 200g, friction: 0.01) at [-220mm, 0mm, -70mm]
  joint roll_left : chassis -> left = revolute(
    axis: Y,
    max_speed: 6rad/s,
    max_accel: 3rad/s^2,
    max_torque: 20N*m
  ) at [0mm, 180mm, -20mm]
  joint roll_right : chassis -> right = revolute(
    axis: Y,
    max_speed: 6rad/s,
    max_accel: 3rad/s^2,
    max_torque: 20N*m
  ) at [0mm, -180mm, -20mm]
  joint glue_front : chassis -> front = fixed()
  joint glue_back : chassis -> back = fixed()
  port top : Grip on chassis at [100mm, 0mm, 40mm] facing +Z
}

config Mobile {
  part rover: Rover
  part m[i in 0..6]: Link(turns: i == 0 or i == 3 or i == 5)
  connect rover.top -- m[0].back
  for i in 0..5 { connect m[i].front -- m[i + 1].back }
  set m[1].turn = 20deg
  set m[2].turn = 100deg
  set m[4].turn = 60deg
  base rover
  port hand = m[5].front

  behavior drive(v: AngularSpeed, t: Time) = Pc(spin(rover.roll_left, v, for: t), spin(rover.roll_right, v, for: t))
}

scene Yard {
  part robot: Mobile at [0mm, 0mm, 100mm]
  part crate: Crate at [1.08m, 0mm, 40mm]
}

let y = Yard()
let hand = y.robot.hand
// Where the crate is in the world does not depend on how far the rover has got.
let above = pose_at([1.08m, 0mm, 140mm], facing: -Z, up: -X)
let fetch = Sc(
  y.robot.drive(2rad/s, 5s),
  wait(300ms),
  avoid(reach(hand, to: above)),
  line(hand, to: pose_at([1.08m, 0mm, 80mm], facing: -Z, up: -X)),
  wait(200ms),
  dock(hand, y.crate.lid),
  line(hand, by: [0mm, 0mm, 150mm]),
  y.robot.drive(-2rad/s, 5s),
)
print(verify(fetch))
print(simulate(fetch))
show(fetch, "mobile_manipulator.html")

test "the crate is taken back with the rover" {
  expect verify(fetch).ok
  let p = plan(fetch)
  let met = p.at(5.3s).pose(y.robot.rover).position.x
  // Wheels of 80 mm turn at 2 rad/s for 5 s, less what is lost by speeding up and slowing down by 3 rad/s^2.
  expect abs(met - 80mm * 2 * (5 - 2 / 3)) < 1mm
  expect abs(p.end.pose(y.robot.rover).position.x) < 1mm
  expect abs(p.end.pose(y.crate.lid).position.x - (1.08m - met)) < 1mm
  expect abs(p.end.pose(y.crate.lid).position.z - 230mm) < 1mm
}
