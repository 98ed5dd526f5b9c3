//! A tank takes up a crate, which has a port but no joints, carries it off, puts it down and leaves.
use std.scenes.Carrier

let haul = Carrier()
let take = haul.take()
let whole = Sc(take, haul.carry(), haul.put())
let report = verify(whole)
print(report)
show(whole, "carrier.html")

test "the crate is lifted, carried, and put down" {
  expect report.ok
  let taken = plan(take)
  let before = taken.start.pose(haul.crate.front).position
  let lifted = taken.end.pose(haul.crate.front).position
  let after = plan(whole).end.pose(haul.crate.front).position
  // The front module's tilt of 15 degrees, 50 mm behind its face, lifts that by 12.9 mm; less by what the wheels do.
  expect lifted.z - before.z > 10mm and lifted.z - before.z < 16mm
  expect abs(after.z - before.z) < 0.1mm
  expect norm(after - before) > 100mm, "it was hardly carried"
}
