//! Three robots of three modules each find together and drive on as one robot of nine.
use std.scenes.ThreeInOne

let three = ThreeInOne()
let build = three.build()
let whole = Sc(build, three.drive())
let report = verify(whole)
print(report)
show(whole, "three_in_one.html")

test "nine modules drive as one" {
  expect report.ok
  // Before the drive and after it the first chain is where its own wheels took it: 2 s at 1 rad/s on wheels of 45.3 mm.
  let built = plan(build).end.pose(three.a.head)
  let end = plan(whole).end
  let there = end.pose(three.a.head)
  let way = norm(there.position - built.position)
  expect way > 70mm and way < 91mm, "it drives {way}"
  // Nine modules of 100 mm in line.
  let tail = end.pose(three.c.tail).position
  expect abs(norm(there.position - tail) - 900mm) < 1mm
}
