--- a walker holds two graspers, whose behaviours are the walker's
use std.smores.{Grasper7, Leg3, Smores, Walker14}
let w = Walker14()
let g = embed(Grasper7, in: w)
print(g, len(g))
//> [Grasper7 at spine[0], Grasper7 at spine[1]] 2
print(g[0].m, g[1].m, g[1].l, g[1].r[2].tilt)
//> spine[0] spine[1] [leg[2].thigh, leg[2].shin, leg[2].foot] leg[3].foot.tilt
print(plan(Pc(g[0].open(), w.leg[2].plant())).steps > 0, g[0].m == w.spine[0], g[0] == g[1], g[0] == embed(Grasper7, in: w)[0])
//> true true false true
print(embed(Leg3, in: w) == [l for l in w.leg if true], embed(Leg3(lean: 28deg, bend: 10deg), in: w) == w.leg)
//> false true
// A robot of one module is a module of the type.
print(embed(Smores, in: w) == modules(w, Smores), len(embed(Walker14, in: w)), embed(Walker14, in: g[0]))
//> true 1 []

--- an embedding has the ports, connections and modules of the whole
connector Face { mates Face, turns 4 }
module Hinge {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  link tip = box(10mm, 10mm, 10mm) at [20mm, 0mm, 0mm]
  joint bend: body -> tip = revolute(axis: Y, range: -90deg..90deg) at [10mm, 0mm, 0mm]
  port back: Face on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port front: Face on tip at [25mm, 0mm, 0mm] facing +X up +Z
}
config Pair {
  part one: Hinge
  part two: Hinge
  connect one.front -- two.back
  set one.bend = 20deg
  let last = two
  port nose = two.front
  behavior nod = move(two.bend, to: 10deg, in: 1s)
}
config Four {
  part h[4]: Hinge
  for i in 0..3 { connect h[i + 1].back -- h[i].front }
  base h[3]
  // Declared in the body of another configuration, too.
  behavior nods = Pc([p.nod() for p in embed(Pair, in: pair)])
  part pair: Pair
  connect pair.one.back -- h[3].front
}
let f = Four()
let pairs = embed(Pair, in: f)
print(pairs)
//> [Pair at h[0], Pair at h[1], Pair at h[2], Pair at h[3], Pair at pair.one]
print(pairs[1].last, pairs[1].nose, pairs[1].nose == f.h[2].front, connections(pairs[1]), ports(pairs[0]))
//> h[2] h[2].front true [Connection(a: h[1].front, b: h[2].back, turn: 0deg)] [h[0].back]
print(order(pairs[0]), count(pairs[0]), mass(pairs[0]), modules(pairs[2], Hinge), embed(Hinge, in: pairs[2]))
//> 1 2 2kg [h[2], h[3]] [h[2], h[3]]
print(pairs[4] == f.pair, embed(Pair, in: f.pair), pose(pairs[0].one) == pose(f.h[0]))
//> true [Pair at pair.one] true
// The robot's posture counts: what `Pair` sets does not, and its own is in effect.
let p = plan(pairs[0].nod())
print(p.start.angle(f.h[0].bend), p.end.angle(f.h[1].bend), p.start.angle(f.pair.one.bend), plan(f.nods()).end.angle(f.pair.two.bend))
//> 0deg 10deg 20deg 10deg

--- what an embedding keeps
connector Face { mates Face, turns 4 }
module Block(length: Length = 10mm) {
  mass 1kg
  link body = box(length, 10mm, 10mm)
  port back: Face on body at [-length / 2, 0mm, 0mm] facing -X up +Z
  port front: Face on body at [length / 2, 0mm, 0mm] facing +X up +Z
}
module Brick {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  port back: Face on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port front: Face on body at [5mm, 0mm, 0mm] facing +X up +Z
}
config Pair(turn: Angle = 0deg, length: Length = 10mm) {
  part a: Block(length: length)
  part b: Block
  connect a.front -- b.back turn turn
}
config Mixed {
  part a: Brick
  part b: Block
  connect a.front -- b.back
}
config Heads {
  part b[2]: Block
  connect b[0].front -- b[1].front
}
config Robot {
  part x[3]: Block
  part y: Brick
  part z: Block(length: 20mm)
  connect x[0].front -- x[1].back
  connect x[2].back -- x[1].front turn 90deg
  connect y.front -- x[0].back
  connect z.front -- x[2].front
}
let r = Robot()
print(embed(Pair, in: r), embed(Pair(turn: 90deg), in: r), embed(Pair(turn: 180deg), in: r))
//> [Pair at x[0]] [Pair(turn: 90deg) at x[1]] []
print(embed(Pair(length: 20mm), in: r), embed(Mixed, in: r), embed(Heads, in: r), embed(Brick, in: r), embed(Block(length: 20mm), in: r))
//> [] [Mixed at y] [] [y] [z]
// Either end of what is symmetrical comes first.
print(embed(Heads, in: Heads), embed(Robot, in: Pair), embed(Block, in: Block))
//> [Heads at b[0], Heads at b[1]] [] [Block]

--- a connection among matched modules that the pattern lacks
connector Face { mates Face, turns 4 }
module Tile {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  port east: Face on body at [5mm, 0mm, 0mm] facing +X up +Z
  port west: Face on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port north: Face on body at [0mm, 5mm, 0mm] facing +Y up +Z
  port south: Face on body at [0mm, -5mm, 0mm] facing -Y up +Z
}
config Grid(m: Int = 12, n: Int = 12) closed {
  part t[m * n]: Tile
  for i in 0..m { for j in 0..n {
    if i + 1 < m { connect t[n * i + j].east -- t[n * (i + 1) + j].west }
    if j + 1 < n { connect t[n * i + j].north -- t[n * i + j + 1].south }
  } }
}
// Three sides of a square.
config Hook {
  part t[4]: Tile
  connect t[0].east -- t[1].west
  connect t[1].north -- t[2].south
  connect t[2].west -- t[3].east
}
let g = Grid()
// Places of an a by b rectangle in one of m by n: (m - a + 1) (n - b + 1).
print(len(embed(Grid(3, 1), in: g)), len(embed(Grid(2, 2), in: g)), len(embed(Grid(5, 7), in: g)), len(embed(Grid, in: g)), len(embed(Grid(13, 1), in: g)))
//> 120 121 48 1 0
print(embed(Hook, in: g), len(embed(Hook, in: Hook)))
//> [] 1

--- the first port of a joint counts
connector Door { mates Door, turns 2, hinge(axis: Z, range: -90deg..90deg) }
connector Fold { mates Fold, turns 2, hinge(axis: Y, range: -90deg..90deg) }
module Plate {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  port west: Door on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port east: Door on body at [5mm, 0mm, 0mm] facing +X up +Z
  port south: Fold on body at [0mm, -5mm, 0mm] facing -Y up +Z
  port north: Fold on body at [0mm, 5mm, 0mm] facing +Y up +Z
}
config Doors { part p[2]: Plate  connect p[0].east -- p[1].west }
config Folds(turn: Angle = 0deg) { part p[2]: Plate  connect p[0].north -- p[1].south turn turn }
config Robot {
  part a[3]: Plate
  part b[3]: Plate
  connect a[0].east -- a[1].west
  connect a[2].west -- a[1].east
  connect a[0].north -- b[0].south
  connect b[1].south -- b[0].north
  connect b[2].north -- a[1].south turn 180deg
}
let r = Robot()
// About Z a door opens to the other side if its ports are written the other way round. A fold about Y is the same, unless
// one of the plates lies upside down.
print(embed(Doors, in: r), embed(Folds, in: r), embed(Folds(turn: 180deg), in: r))
//> [Doors at a[0]] [Folds at a[0], Folds at b[0]] [Folds(turn: 180deg) at b[2]]
config Turned { part p[2]: Plate  connect p[1].south -- p[0].north turn 180deg }
print(embed(Turned, in: r), embed(Turned, in: Folds(turn: 180deg)), embed(Turned, in: Turned))
//> [] [] [Turned at p[0]]

--- what is no pattern and no robot
use std.crystal.ExpandingCube
use std.smores.{Chain3, Leg3}
lattice Bar of ExpandingCube = row(3)
config Need(n: Int) { part c: Chain3 }
//     ~~~~ declared here
let c = Chain3()
print(embed(Bar, in: c))
//          ^^^ E0202 `pattern` wants a `Config`; this is a `Bar` | a `Config` is a configuration or a module; `Bar` is a lattice
print(embed(3mm, in: c))
//          ^^^ E0202 `pattern` wants a `Config`; this is a length
print(embed(c.sine, in: c), embed([c], in: c))
//          ^^^^^^ E0202 `pattern` wants a `Config`
//                                ^^^ E0202 `pattern` wants a `Config`; this is a `List<Chain3>`
print(embed(Chain3, in: Bar))
//                      ^^^ E0202 `in` wants a `Config`; `Bar` is a `Bar` | `Bar` is a lattice
print(embed(Chain3))
//    ^^^^^^^^^^^^^ E0205 `embed` also needs `in`
print(embed(Need, in: c))
//          ^^^^ E0205 `Need` needs `n` | give them: `Need(...)`
print(embed(Chain3, within: c))
//                  ^^^^^^ E0205 `embed` has no parameter `within` | it takes pattern, in
let legs: List<Leg3> = embed(Chain3, in: c)
//                     ^^^^^^^^^^^^^^^^^^^^ E0202 `legs` wants a `List<Leg3>`; `embed(Chain3, in: c)` is a `List<Chain3>`
print(embed(Chain3, in: c)[0].squeeze())
//                            ^^^^^^^ E0107

--- an empty list has no element
use std.smores.{Chain3, Grasper7}
print(embed(Grasper7, in: Chain3))
//> []
print(embed(Grasper7, in: Chain3)[0].squeeze())
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0501 index 0

--- a pattern without modules
use std.smores.Chain3
config Empty {}
print(embed(Empty, in: Chain3))
//          ^^^^^ E0316
print(embed(Chain3, in: Empty))
//                      ^^^^^ E0316

--- too many embeddings
connector Face { mates Face, turns 4 }
module Block {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
  port back: Face on body at [-5mm, 0mm, 0mm] facing -X up +Z
  port front: Face on body at [5mm, 0mm, 0mm] facing +X up +Z
}
config Row(n: Int) {
  part b[n]: Block
  for i in 0..n - 1 { connect b[i].front -- b[i + 1].back }
}
let r = Row(2000)
// 2000 - n + 1 places of n blocks each, and 1001 times 1000 is too many.
print(len(embed(Row(1000), in: r)))
//        ^^^^^^^^^^^^^^^^^^^^^^^ E0505 the embeddings of `Row(n: 1000)` in `Row(n: 2000)` have more than 1000000 modules together
print(len(embed(Row(400), in: r)))
//> 1601
