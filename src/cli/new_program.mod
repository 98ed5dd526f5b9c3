//! A first robot: one SMORES module that drives on its two side wheels.
use std.smores.Smores

config Rover {
  part m: Smores

  /// Straight on.
  behavior drive(speed: AngularSpeed = 2rad/s, time: Time = 3s) = Pc(
    spin(m.left, speed, for: time),
    spin(m.right, speed, for: time),
  )
}

let rover = Rover()
print("mass", mass(rover), "travel", verify(rover.drive()).travel)
emit(rover.drive(), "drive.plan.json")

test "the rover drives without falling" {
  let r = verify(Rover().drive(time: 2s))
  expect r.ok
  expect r.duration >= 2s
}
