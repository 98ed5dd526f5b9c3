//! Two tanks meet: the one drives round a wall to the other, docks, both drive as one robot, and they part.
use std.scenes.{drive_and_dock, tank_turn}
use std.smores.Tank7

scene Meeting {
  part a: Tank7
  part b: Tank7 at [1.6m, 0m, 0m] turned(Z, 120deg)
  obstacle wall = box(50mm, 800mm, 200mm) at [800mm, -200mm, 100mm]

  /// Drives round the wall, then straight to the other's nose. The tank reaches 220 mm from its middle.
  behavior meet = drive_and_dock(
    a.nose,
    b.nose,
    (v, t) => a.drive(v, t),
    x => tank_turn(a, x),
    closing: 150mm,
    avoiding: true,
    clearance: 240mm,
  )
  behavior leave = Sc(
    Pc(a.drive(t: 2s), b.drive(-2rad/s, t: 2s)),
    wait(200ms),
    undock(a.nose),
    a.drive(-2rad/s, 1s),
  )
}

let m = Meeting()
let whole = Sc(m.meet(), m.leave())
let report = verify(whole)
print(report)
show(whole, "rendezvous.html")

test "they meet, drive as one, and part" {
  expect report.ok
  // The first drives some 1.3 m to the second, and no wall is nearer than 20 mm.
  expect report.travel > 500mm
}
