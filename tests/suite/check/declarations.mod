--- joints and ports have name spaces of their own
connector Face { mates Face, turns 4 }
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m) at [2m, 0m, 0m]
  joint left: a -> b = revolute(axis: X)
  port left: Face on b at [500mm, 0m, 0m] facing +X up +Z
  port back: Face on a at [-500mm, 0m, 0m] facing -X up +Z
  alias pan = left
}
config C {
  part m[2]: M
  connect m[0].left -- m[1].back
  set m[0].left = 10deg
  behavior go = spin(m[0].pan, 2rad/s, for: 1s)
  behavior both = move(m[0].left.joint, to: 10deg)
}
let c = C()
print(c.m[0].left)
//           ^^^^ E0208 both a joint and a port | `.left.joint` or `.left.port`
print(pose(c.m[0].left), pose(c.m[0].left.port))

--- links and joints by name
module M {
  mass 1kg
  link base = box(1m, 1m, 1m)
  joint j: bsae -> tip = revolute(axis: X)
//         ^^^^ E0107 no link `bsae` | `base`?
//                 ^^^ E0107 no link `tip`
  motor p = j + k (max_speed: 1rad/s, max_torque: 1N*m)
//              ^ E0107 no joint `k`
}

--- clauses and their units
connector Face { mates Fase, turns 1.5, holds 3m, capture 4deg 5mm }
//                     ^^^^ E0101 `Face`?
//                                 ^^^ E0202 `turns` wants
//                                            ^^ E0201 `holds` wants a force
//                                                        ^^^^ E0201 `capture` wants a length
//                                                             ^^^ E0201
module M {
  mass 1m
//     ^^ E0201 `mass` wants a mass
  link base = box(1m, 1m, 1s) at [1m, 0m]
//                        ^^ E0201
//                               ^^^^^^^^ E0202 `at` wants
}

--- facts of cells and struts
cell C { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_spede 0.1m/s }
//   ^ E0307 does not state max_speed
//                                                             ^^^^^^^^^ E0107 `max_speed`?
strut S { length 300mm..3m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 100mm }
strut T { length 3m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 100mm }
//               ^^ E0202 `length` wants
strut U { length 300mm..3m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 100mm  buckling 90N  node_mass 200g }
strut V { length 300mm..3m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 100mm  buckling 90mm }
//                                                                                                ^^^^ E0201 `buckling` wants a force

--- parts are modules or configurations
cell Cube { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 0.1m/s }
config C {
  part a: Cube
//        ^^^^ E0209 a cell: it goes into a `lattice`
  part b: Nope
//        ^^^^ E0209 not known here
}

--- lattices are of cells, trusses of struts
cell Cube { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 0.1m/s }
lattice Row(n: Int) of Cube = row(n)
lattice Bad of Nope = row(3)
//             ^^^^ E0209
truss Tri of Cube {
//           ^^^^ E0209 is no strut
  node a = [0m, 0m, 0m]
}
let r = Row(3)
let t = Row
//      ^^^ E0205 `Row` needs `n`

--- nodes by name
strut S { length 300mm..3m  max_speed 50mm/s  max_force 200N  mass 1kg  clearance 100mm }
truss T of S {
  node ab = [0m, 0m, 0m]
  for i in 0..2 { node ring[i] = [1m * i, 1m, 0m] }
  strut ab -- ba
//            ^^ E0107 no node `ba` | `ab`?
  strut ab -- ring
//            ^^^^ E0202 joins two nodes
  strut ab -- ring[1]
}

--- exemptions
config C {
  part m: M
  behavior b allows unstabel = move(m.j, to: 1deg)
//                  ^^^^^^^^ E0206 `unstable`?
  behavior c allows overload(m.j), collision(m, m) = move(m.j, to: 1deg)
  behavior d allows slip(m) = move(m.j, to: 1deg)
//                  ^^^^^^^ E0205
}
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m) at [2m, 0m, 0m]
  joint j: a -> b = revolute(axis: X)
}

--- members of configurations
config C(n: Int = 2) {
  part m[n]: M
  let twice = 2 * n
  port tip = m[0].front
  behavior go(k: Int) = repeat(move(m[0].j, to: 1deg), k * twice)
}
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m) at [2m, 0m, 0m]
  joint j: a -> b = revolute(axis: X)
  port front: Face on b at [500mm, 0m, 0m] facing +X up +Z
}
connector Face { mates Face, turns 1 }
let c = C(3)
print(c.n, c.twice, len(c.m), pose(c.tip))
emit(c.go(2), "x.plan.json")
emit(c.go, "y.plan.json")
//   ^^^^ E0202 call it: `c.go()`
print(c.gone)
//      ^^^^ E0107 no part, port or behavior `gone` in C

--- a behaviour is planned when its plan is asked for
config C {
  part m: M
  behavior go = move(m.j, to: 1deg)
}
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m) at [2m, 0m, 0m]
  joint j: a -> b = revolute(axis: X)
}
let d: Time = C().go().duration
let n: Int = C().go().actions
let s: State = C().go().at(1s)
print(C().go().durration)
//             ^^^^^^^^^ E0107 a Plan has no `durration` | `duration`?

--- instances of several declarations in one list
module A { mass 1kg  link a = box(1m, 1m, 1m) }
module B { mass 1kg  link a = box(1m, 1m, 1m) }
let xs = [A(), B()]
let total = [mass(x) for x in xs]
let m: Mass = total[0]

--- names of what could not be read are not missed
use std.smores.Smores
connector Face { mates Face, turns 4 }
module M {
  mass 1kg
  link base = box(20mm, 20mm, 20mm)
  link tip := box(1mm, 1mm, 1mm)
//         ^ E0001 `:` cannot stand here | the value stands behind `=`
  joint a base -> tip = revolute(axis: Z)
//        ^^^^ E0001 is missing before `base` | it is written `joint name : parent -> child = revolute(axis: Y) at [0mm, 0mm, 0mm]`
  joint b = -a
  alias c = a
  port p : Face on tip at [0mm, 0mm, 0mm] facing +X up +Z
}
config Broken(a: Angle = ) {
//                       ^ E0001 an expression is missing
  part m: Smores
}
config C {
  part m[2 : Smores
//      ^ E0004 this `[` is never closed
  part n: Smores
  connect m[0].top -- n.bottom
}
print(C().m[0], Broken().m)
test "t" {
  let z 3
//      ^ E0001 is missing before `3` | it is written `let name = value`
  expect z == 3
}

--- a cell that slides says so by a truth value, once
cell Cube { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 0.1m/s  slides 1 }
//                                                                                         ^ E0202 `slides` wants true or false
cell Other { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 0.1m/s  slides false  slides true }
//                                                                                                 ^^^^^^ E0102 `slides` is given twice
