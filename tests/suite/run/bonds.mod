--- plates on a hinge fold up to one another and not through
connector Edge { mates Edge, turns 1, hinge(axis: Y, max_speed: 720deg/s) }
module Plate {
  mass 100g
  link body = box(100mm, 80mm, 6mm)
  port left : Edge on body at [-51mm, 0mm, 0mm] facing -X up +Z
  port right : Edge on body at [51mm, 0mm, 0mm] facing +X up +Z
}
config Book {
  part p[2]: Plate
  connect p[0].right -- p[1].left
  behavior fold(a: Angle) = move(p[0].right.joint, to: a, in: 4s)
}
fn judged(a: Angle) -> Report = verify(Book().fold(a), world: world(ground: off, gravity: off))
// The corners of the edges, 1 mm beside the axis and 3 mm above it, meet there.
let room = 2 * atan(1 / 3)
print([judged(a).ok for a in [room, -room, room + 10deg, -room - 10deg, 179deg, 720deg]])
//> [true, true, false, false, false, false]

--- the panels of Mori fold as far as their bevels let them
use std.mori.{Mori, Panel}
config Pair(thick: Length = 6mm) {
  part p[2]: Panel(thickness: thick)
  connect p[0].edge[0] -- p[1].edge[1]
  behavior fold(a: Angle) = move(p[0].edge[0].joint, to: a)
}
config Moris {
  part p[2]: Mori
  connect p[0].edge[0] -- p[1].edge[0]
  behavior fold(a: Angle) = move(p[0].edge[0].joint, to: a)
//                                                       ^ E0309 its range is -120deg to 120deg
}
let free = world(ground: off, gravity: off)
print([verify(Moris().fold(a), world: free).ok for a in [60deg, 120deg, -120deg]])
print([verify(Pair(thick: 2mm).fold(a), world: free).ok for a in [120deg, -120deg]])
//> [true, true, true]
//> [true, true]
print(verify(Moris().fold(121deg), world: free).ok)

--- bevels stop panels whose hinge states no range
connector Free { mates Free, turns 1, hinge(axis: Y) }
module Wedge {
  mass 10g
  link body = hull([[x, y, z] for x in [-50mm, 46.3mm] for y in [-40mm, 40mm] for z in [-3mm, 3mm]] ++ [[49.9mm, y, 0mm] for y in [-40mm, 40mm]])
  port edge : Free on body at [50mm, 0mm, 0mm] facing +X up +Z
}
config Pair {
  part p[2]: Wedge
  connect p[0].edge -- p[1].edge
  behavior fold(a: Angle) = move(p[0].edge.joint, to: a, in: 2s)
}
let free = world(ground: off, gravity: off)
// Slopes of 3 mm by 3.6 mm leave 2 * atan(3.6 / 3) to fold.
let room = 2 * atan(3.6 / 3)
print([verify(Pair().fold(a), world: free).ok for a in [room, -room, room + 5deg]])
//> [true, true, false]

--- cubes docked deep inside each other
connector Face { mates Face, turns 4 }
connector Guided { mates Guided, turns 4, capture 8mm 2deg }
module Cube(depth: Length) {
  mass 1kg
  link body = box(100mm, 100mm, 100mm)
  port left : Face on body at [-50mm + depth, 0mm, 0mm] facing -X up +Z
  port right : Face on body at [50mm - depth, 0mm, 0mm] facing +X up +Z
  port front : Guided on body at [0mm, -50mm + depth, 0mm] facing -Y up +Z
  port back : Guided on body at [0mm, 50mm - depth, 0mm] facing +Y up +Z
}
config Row(depth: Length) {
  part c[2]: Cube(depth: depth)
  connect c[0].right -- c[1].left
}
config File(depth: Length) {
  part c[2]: Cube(depth: depth)
  connect c[0].back -- c[1].front
}
// 1 mm where the connector states no capture, and touch.
expect verify(Row(0mm)).ok and verify(Row(0.5mm)).ok and not verify(Row(0.6mm)).ok
expect verify(File(4mm)).ok and not verify(File(4.1mm)).ok
print(verify(Row(25mm)).failures[0])
//> at 0ms: c[0] and c[1] meet, 50mm deep (body and body), as c[0].right -- c[1].left docks them; c[0].right lies 25mm beneath the surface of its link, c[1].left lies 25mm beneath the surface of its link

--- pins that reach deeper into the other link than the connector explains
connector Bolt { mates Bolt, turns 4, capture 2mm 3deg }
module Pinned(pin: Length, aside: Length = 0mm) {
  mass 1kg
  link body = union(box(100mm, 100mm, 100mm), placed(box(2 * pin, 10mm, 10mm), at: [50mm, aside, 0mm]))
  port left : Bolt on body at [-50mm, 0mm, 0mm] facing -X up +Z
  port right : Bolt on body at [50mm, 0mm, 0mm] facing +X up +Z
}
// As the hint says: a pin that is drawn only, and a pin whose depth is stated.
module Drawn {
  mass 1kg
  link body = union(box(100mm, 100mm, 100mm), placed(box(10mm, 10mm, 10mm), at: [50mm, 0mm, 0mm]))
    collides box(100mm, 100mm, 100mm)
  port left : Bolt on body at [-50mm, 0mm, 0mm] facing -X up +Z
  port right : Bolt on body at [50mm, 0mm, 0mm] facing +X up +Z
}
module Stated {
  mass 1kg
  touch 5mm
  link body = union(box(100mm, 100mm, 100mm), placed(box(10mm, 10mm, 10mm), at: [50mm, 0mm, 0mm]))
  port left : Bolt on body at [-50mm, 0mm, 0mm] facing -X up +Z
  port right : Bolt on body at [50mm, 0mm, 0mm] facing +X up +Z
}
config Row(pin: Length, aside: Length = 0mm) {
  part c[2]: Pinned(pin: pin, aside: aside)
  connect c[0].right -- c[1].left
}
config RowDrawn { part c[2]: Drawn  connect c[0].right -- c[1].left }
config RowStated { part c[2]: Stated  connect c[0].right -- c[1].left }
expect verify(Row(2mm)).ok and verify(RowDrawn()).ok and verify(RowStated()).ok
// A pin through the port, and one beside it.
print(verify(Row(5mm)).failures[0])
print(verify(Row(5mm, aside: 20mm)).failures[0])
//> at 0ms: c[0] and c[1] meet, 5mm deep (body and body), as c[0].right -- c[1].left docks them; the connector explains 2mm of that (`capture`): leave a pin that reaches in out of `collides`, or state `touch` as deep as it is
//> at 0ms: c[0] and c[1] meet, 5mm deep (body and body), as c[0].right -- c[1].left docks them; the connector explains 2mm of that (`capture`): leave a pin that reaches in out of `collides`, or state `touch` as deep as it is

--- a joint that stops at once is not at rest
module Wheel {
  link frame = box(100mm, 80mm, 100mm, mass: 1kg)
  link rim = cylinder(radius: 50mm, length: 10mm, axis: Y, mass: 100g) at [0mm, 60mm, 0mm]
  joint left : frame -> rim = revolute(axis: Y)
}
config One {
  part m: Wheel
  behavior dead = spin(m.left, 2.3rad/s, for: 2s)
  behavior soft = move(m.left, by: 2rad, in: 2s)
}
fn rest(b: Behavior) -> Text = [c for c in verify(b).checks if split(c, on: ": ")[0] == "rest"][0]
print(rest(One().soft()))
print(rest(One().dead()))
//> rest: proved
//> rest: not checked: m.left stops at once from 2.3rad/s at the end, and no greatest acceleration is stated

--- less than touch is within tolerance
module Slide(gap: Length) {
  mass 100g
  link rail = box(40mm, 20mm, 20mm)
  link sled = box(40mm, 20mm, 20mm) at [0mm, 0mm, 40mm]
  link cart = box(40mm, 20mm, 20mm) at [40mm + gap, 0mm, 0mm]
  joint up : rail -> sled = prismatic(axis: Z, range: -100mm..100mm)
  joint over : sled -> cart = prismatic(axis: X, range: -100mm..100mm)
}
config Train(gap: Length) {
  part s: Slide(gap: gap)
  behavior close(by: Length) = move(s.over, to: by, in: 1s)
}
fn collision(b: Behavior) -> Text = [c for c in verify(b).checks if split(c, on: ": ")[0] == "collision"][0]
print(collision(Train(1mm).close(-0.9mm)))
print(collision(Train(1mm).close(-1.09mm)))
print(collision(Train(1mm).close(-1.2mm)))
//> collision: proved
//> collision: within tolerance
//> collision: failed
