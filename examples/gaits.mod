//! Gaits from the library on a robot of one's own: functions of joints and behaviours.
use std.gaits
use std.smores.Chain3

config Worm(n: Int = 2) {
  part seg[n]: Chain3
  for i in 0..n - 1 { connect seg[i].tail -- seg[i + 1].head }

  behavior crawl(cycles: Int = 2) =
    gaits.wave([m.tilt for s in seg for m in s.m], amplitude: 15deg, waves: 2, cycles: cycles)
}

let w = Worm()
let r = verify(w.crawl())
print("in", r.duration, "it gets", r.travel, "and slips", r.slip)
emit(w.crawl(), "crawl.plan.json")

test "a gait of more cycles lasts longer" {
  expect plan(w.crawl(4)).duration == 2 * plan(w.crawl(2)).duration
}
