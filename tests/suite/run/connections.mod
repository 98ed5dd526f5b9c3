--- connections are the ports that were joined, and the turns
connector Face { mates Face, turns 3 }
module Block {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  port back: Face on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port front: Face on body at [5mm, 0mm, 0mm] facing +X up +Z
}
config Row {
  part b[2]: Block
  connect b[0].front -- b[1].back turn 120deg
}
config Rows {
  part one: Row
  part two: Row
  connect two.b[0].back -- one.b[1].front
}
let rows = Rows()
for c in connections(rows) { print(c) }
//> Connection(a: one.b[0].front, b: one.b[1].back, turn: 120deg)
//> Connection(a: two.b[0].front, b: two.b[1].back, turn: 120deg)
//> Connection(a: two.b[0].back, b: one.b[1].front, turn: 0deg)
// Those of a part have its ports in the whole.
print(connections(rows.two), connections(rows.one)[0].a == rows.one.b[0].front, connections(rows.one.b[0]))
//> [Connection(a: two.b[0].front, b: two.b[1].back, turn: 120deg)] true []
print([c.a for c in connections(rows) if c.turn > 0deg], len(connections(Block)))
//> [one.b[0].front, two.b[0].front] 0

--- robots are the same but for names
connector Face { mates Face, turns 4 }
module Hinge {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  link tip = box(10mm, 10mm, 10mm) at [20mm, 0mm, 0mm]
  joint bend: body -> tip = revolute(axis: Y, range: -90deg..90deg) at [10mm, 0mm, 0mm]
  port back: Face on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port front: Face on tip at [25mm, 0mm, 0mm] facing +X up +Z
}
config Row(bend: Angle = 0deg, turn: Angle = 0deg) {
  part h[3]: Hinge
  connect h[0].front -- h[1].back turn turn
  connect h[1].front -- h[2].back
  set h[0].bend = bend
}
// The same robot under other names, in another order, its connections written the other way round.
config Other(bend: Angle = 0deg) {
  part last: Hinge
  part first: Hinge
  part middle: Hinge
  connect last.back -- middle.front
  connect middle.back -- first.front
  set first.bend = bend
  base last
}
// The hinge that is bent is another one.
config Backwards(bend: Angle = 0deg) {
  part h[3]: Hinge
  connect h[0].front -- h[1].back
  connect h[1].front -- h[2].back
  set h[2].bend = bend
}
config Folded {
  part h[3]: Hinge
  connect h[0].front -- h[1].front
  connect h[1].back -- h[2].back
}
print(same(Row, Other), same(Row(bend: 5deg), Other(bend: 5deg)), same(Row(bend: 5deg), Other))
//> true true false
print(same(Row, Backwards), same(Row(bend: 5deg), Backwards(bend: 5deg)), same(Row, Folded))
//> true false false
print(same(Row(turn: 90deg), Row(turn: 90deg)), same(Row(turn: 90deg), Row), same(Row, Hinge), same(Hinge, Hinge))
//> true false false true

--- what has no connections, and what is no robot
config Empty {}
connector Face { mates Face, turns 4 }
module M {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
}
print(same(Empty, M))
//         ^^^^^ E0316
print(connections(Empty))
//                ^^^^^ E0316

--- what can't be asked
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(3)
print(connections(Bar), same(Bar, Bar), connections([]), same(1, 2))
//                ^^^ E0202 `of` wants a `Config`
//                           ^^^ E0202 `a` wants a `Config`
//                                ^^^ E0202 `b` wants a `Config`
//                                                  ^^ E0202 `of` wants
//                                                            ^ E0202 `a` wants
//                                                               ^ E0202 `b` wants
