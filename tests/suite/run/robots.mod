--- what a robot can be asked
use std.smores.{Smores, Chain3, Walk4}
print(order(Smores), order(Chain3), order(Walk4))
//> 0 1 2
print(count(Chain3), len(modules(Walk4, Smores)), len(ports(Smores)))
//> 3 15 4

--- parts are views of the whole
connector Face { mates Face, turns 4 }
module Block {
  mass 1kg
  link body = box(100mm, 100mm, 100mm)
  port a: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
  port b: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config Pair { part x: Block  part y: Block
  connect x.a -- y.b
  port head = y.a
  base x
}
config Four { part p[2]: Pair
  connect p[0].head -- p[1].x.b
  base p[0]
}
let f = Four()
print(f.p[1].y, pose(f.p[1].head), distance(f.p[0].x, f.p[1].y), mass(f))
//> p[1].y at [350mm, 0mm, 0mm] 300mm 4kg
print(com(f), Pair() == Pair(), len(ports(f)))
//> [150mm, 0mm, 0mm] true 2

--- rigidity of a truss
use std.truss.PneumaticReel
truss Tetra of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [0m, 1m, 0m]
  node d = [0m, 0m, 1m]
  strut a -- b  strut b -- c  strut c -- a  strut a -- d  strut b -- d  strut c -- d
}
truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)
print(rigidity(Tetra).rank, rigidity(Tetra).rigid, rigidity(Tetra).self_stresses)
//> 6 true 0
print(nodes(Pyramid), struts(Pyramid), rigidity(Pyramid).rank)
//> 34 108 96

--- lattices
use std.crystal.ExpandingCube
lattice Bar(n: Int) of ExpandingCube = row(n)
lattice Ell of ExpandingCube = cells("""
  #....
  #....
  #####
""")
print(count(Bar(64)), count(Ell), mass(Ell))
//> 64 7 7kg

--- a joint that follows another moves its link
// Two arms of 100 mm; the second turns back by what the first turns, so that the tip stays level.
connector Face { mates Face, turns 4 }
module Level {
  mass 1kg
  link base = box(20mm, 20mm, 20mm)
  link arm  = box(80mm, 10mm, 10mm) at [50mm, 0mm, 0mm]
  link tip  = box(10mm, 10mm, 10mm) at [150mm, 0mm, 0mm]
  joint a : base -> arm = revolute(axis: Y, range: -90deg..90deg)
  joint b : arm -> tip  = revolute(axis: Y) at [100mm, 0mm, 0mm]
  joint b = -a
  port end : Face on tip at [0mm, 0mm, 0mm] facing +X up +Z
}
config C(a: Angle) {
  part l: Level
  set l.a = a
}
print(pose(C(0deg).l.end))
//> at [150mm, 0mm, 0mm]
// 100 mm turned down by 60 degrees, then 50 mm level.
print(pose(C(60deg).l.end))
//> at [100mm, 0mm, -86.6025mm]

--- joints of connections
use std.mori.Mori
config Strip { part m[3]: Mori
  for i in 0..2 { connect m[i].edge[1] -- m[i + 1].edge[0] }
  set m[0].edge[1].joint = 90deg
  port tail = m[2].edge[1]
  base m[0]
  behavior fold(by: Angle) = move(m[1].edge[1].joint, to: by)
}
config Long { part s[2]: Strip
  connect s[0].tail -- s[1].m[0].edge[0]
  set s[0].tail.joint = -20deg
}
// Two centres turn about the edge between them: 2 r cos(q / 2), with the apothem r.
let r = 80mm / (2 * sqrt(3))
let short = Strip()
print(abs(distance(short.m[0], short.m[1]) - 2 * r * cos(45deg)) < 1e-9mm)
//> true
let l = Long()
let apart = [distance(l.s[0].m[0], l.s[0].m[1]), distance(l.s[0].m[2], l.s[1].m[0])]
let wanted = [2 * r * cos(45deg), 2 * r * cos(10deg)]
print([abs(apart[i] - wanted[i]) < 1e-9mm for i in 0..2])
//> [true, true]
let p = plan(l.s[1].fold(60deg), world: world(gravity: 0m/s^2, ground: off))
print(verify(p).ok, p.end.angle(l.s[1].m[2].edge[0].joint), p.end.angle(l.s[1].m[0].edge[1].joint))
//> true 60deg 90deg
print(l.s[0].tail.joint)
//> s[0].m[2].edge[1] -- s[1].m[0].edge[0]

--- coordinates have the dimension of the joints that they follow
module Slide {
  mass 1kg
  link rail = box(200mm, 50mm, 50mm)
  link cart = box(50mm, 50mm, 50mm, friction: 0.5) at [0mm, 0mm, 60mm]
  joint x : rail -> cart = prismatic(axis: X, range: -80mm..80mm, max_speed: 50mm/s, max_force: 100N)
  joint back = -1 * twice
  joint twice = 2 * x
}
config Slides { part s: Slide
  behavior go() = move(s.back, to: 20mm)
//                     ^^^^^^ E0403 s.back follows other joints
}
print(plan(Slides().go()).duration)

--- a configuration without modules is no robot
use std.smores.Smores
config Empty {}
//     ~~~~~ declared without modules
config Still { behavior rest = wait(1s) }
config Row(n: Int) {
  part m[n]: Smores
  for i in 0..n - 1 { connect m[i].top -- m[i + 1].bottom }
}
print(verify(Empty()))
//           ^^^^^^^ E0316 `Empty` has no modules
show(Empty(), "empty.html")
//   ^^^^^^^ E0316 a robot is wanted here
emit(Still().rest(), "still.plan.json")
//   ^^^^^^^^^^^^^^ E0316 `Still` has no modules
print(com(Row(0)))
//        ^^^^^^ E0316 `Row(n: 0)` has no modules
print(count(Empty()), verify(Row(1)).ok)
//> 0 true

--- equal robots under two names are one, and no behaviour reaches both
use std.smores.Smores
config Nod {
  part m: Smores
  behavior nod = Sc(move(m.tilt, to: 30deg), move(m.tilt, to: 0deg))
}
let a = Nod()
//      ~~~~~ one name is bound here
let b = Nod()
//      ~~~~~ and the other here
print(Sc(a.nod(), b.nod()).duration > 0s)
//    ^^^^^^^^^^^^^^^^^^^^ E0406 one behaviour reaches Nod under two names
print(Sc(move(a.m.tilt, to: 3deg), move(b.m.tilt, to: 5deg)).duration > 0s)
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0406
print(move(a.m.tilt, to: 3deg, until: angle(b.m.tilt) > 2deg).duration > 0s)
//                                    ^^^^^^^^^^^^^^^^^^^^^^ E0406
let row = [Nod(), Nod()]
print(Pc([n.nod() for n in row]).duration > 0s)
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^ E0406 the other is element 1 of the same list
fn both(x: Nod, y: Nod) = Sc(x.nod(), y.nod())
//                        ^^^^^^^^^^^^^^^^^^^^ E0406
print(both(Nod(), Nod()).duration > 0s)
//    ~~~~~~~~~~~~~~~~~~ called from here
fn made() -> Nod = {
  let n = Nod()
  n
}
let c = made()
let d = made()
print(Sc(c.nod(), d.nod()).duration > 0s)
//    ^^^^^^^^^^^^^^^^^^^^ E0406

--- one robot may have many names, and a call may bind its own
use std.smores.Smores
config Nod {
  part m: Smores
  behavior nod = Sc(move(m.tilt, to: 30deg), move(m.tilt, to: 0deg))
}
let a = Nod()
let same = a
fn both(x: Nod, y: Nod) = Sc(x.nod(), y.nod())
fn often(n: Int) -> Behavior = {
  let own = Nod()
  repeat(own.nod(), n)
}
let times = Sc(a.nod(), same.nod()).duration / a.nod().duration
expect Sc(a.nod(), same.nod()).duration == both(a, same).duration
expect both(a, same).duration == Sc([n.nod() for n in [a, same]]).duration
expect both(a, same).duration == Sc(Nod().nod(), Nod().nod()).duration
expect both(a, same).duration == Sc(a.nod(), Nod().nod()).duration
expect both(a, same).duration == Sc([Nod().nod() for i in 0..2]).duration
expect both(a, same).duration == Sc(often(1), often(1)).duration
expect both(a, same).duration == (plan(a.nod()) ++ Nod().nod()).duration
print(times > 1.9)
//> true
