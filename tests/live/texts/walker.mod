//! A walker of two legs and a body.
use std.smores.Smores

/// A leg of two modules.
config Leg(bend: Angle = 30deg) {
  part hip: Smores
  part foot: Smores
  connect hip.bottom -- foot.top
  set foot.tilt = bend
  port end = hip.top
}

/// The whole, with what is set in place of what the legs set.
config Walker(lift: Angle = -5deg, fast: Bool = false) {
  part body: Smores  // in the middle
  part left: Leg
  part right: Leg(20deg)
  connect body.left -- left.end
  connect body.right -- right.end turn 90deg  // the other way round
  set left.foot.tilt = 12.5deg
  set body.tilt = lift

  behavior step(by: Angle = 10deg, time: Time = 1.5s) = move(left.hip.tilt, to: by, in: time)
}
