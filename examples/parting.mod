//! Two docked cars drive as one robot, let go of each other, and drive apart: two robots from then on, each judged on its
//! own wheels.
use std.smores.TwoCars

config Convoy closed {
  part pair: TwoCars
  base pair.a.steer.center

  /// Drives as one, lets go at both axles at once, and drives apart.
  behavior leave = Sc(
    pair.drive(t: 2s),
    wait(500ms),
    Pc(undock(pair.a.side[1]), undock(pair.a.side[3])),
    Pc(pair.a.drive(2rad/s, 2s), pair.b.drive(-2rad/s, 2s)),
  )
}

let leave = Convoy().leave()
let report = verify(leave)
print(report)
show(leave, "parting.html")

test "the cars part, and the one with the base goes on" {
  expect report.ok
  expect report.displacement.x > 300mm or report.displacement.y > 300mm
}
