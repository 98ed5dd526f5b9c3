//! Reconfiguration as behaviour: a ring lets go of one connection, waits, and closes again.
use std.smores.Ring12

let ring = Ring12()
let open = Sc(undock(ring.m[11].bottom), wait(1s), dock(ring.m[11].bottom, ring.m[0].top))
print("actions", plan(open).actions)

test "the ring is closed, opens and closes again" {
  let p = plan(open)
  expect p.actions == 3
  expect p.end.time == 1s
}
