--- robots stand where they are placed
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
scene Three(gap: Length = 300mm) {
  part p: Block
  part q: Pair at [gap, 0m, 0m] turned(Z, 90deg)
  part r[i in 0..2]: Block at [0m, (i + 1) * 1m, 500mm]
  obstacle wall = box(20mm, 1m, 200mm) at [1m, 0m, 100mm]
  for i in 0..3 { obstacle post[i] = sphere(10mm) at [i * 100mm, -1m, 0m] }
}
let s = Three()
print(count(s), mass(s), pose(s.p.a), pose(s.q.y).position, pose(s.q.head).position, pose(s.r[1]))
//> 5 5kg at [50mm, 0mm, 0mm] [300mm, 100mm, 0mm] [300mm, 150mm, 0mm] at [0mm, 2m, 500mm]
// The blocks are at x = 0, 300, 300, 0, 0 and y = 0, 0, 100, 1000, 2000 and z = 0, 0, 0, 500, 500.
print(com(s), distance(s.p.a, Three().p.b))
//> [120mm, 620mm, 200mm] 100mm
print(len(s.post), len(connections(s)), same(s, Three()), Three() == s)
//> 3 1 true true

--- connections place the other parts of a robot, and `base` names one
connector Face { mates Face, turns 4 }
module Block {
  mass 1kg
  link body = box(100mm, 100mm, 100mm)
  port a: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
  port b: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
scene Docked {
  part lone: Block at [0m, 5m, 0m]
  part x: Block
  part y: Block at [1m, 0m, 0m]
  connect x.a -- y.b
  base y
}
let d = Docked()
print(pose(d.x), pose(d.y), pose(d.lone))
//> at [900mm, 0mm, 0mm] at [1m, 0mm, 0mm] at [0mm, 5m, 0mm]

--- plans know the world of their scene, unless another is stated
use std.smores.Tank7
scene Hill {
  part a: Tank7
  part b: Tank7 at [1m, 0m, 0m]
  world(terrain: slope(5deg, along: X), friction: 0.8)
  behavior both(t: Time = 1s) = Pc(a.drive(t: t), b.drive(t: t))
}
let h = Hill()
print(plan(h.a.drive(t: 1s)).assumes)
//> ground settle, slope 5deg, gravity 9.80665m/s^2, friction 0.8
print(plan(h.both(), world: world(friction: 0.5)).assumes)
//> ground settle, gravity 9.80665m/s^2, friction 0.5
print(plan(h.both()).duration, (plan(h.both()) ++ h.both(t: 2s)).duration)
//> 1s 3s

--- two equal robots in one behaviour have their identity by their names
use std.smores.Tank7
scene Both {
  part a: Tank7
  part b: Tank7 at [1m, 0m, 0m]
}
let t = Both()
print(plan(Pc(t.a.drive(t: 1s), t.b.turn(t: 1s))).duration)
//> 1s
let lone = Tank7()
let other = Tank7()
print(Pc(lone.drive(), other.drive()))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0406 for two robots, make them parts of one `scene`

--- formats that know one robot
use std.smores.Tank7
use std.rofi.Rofi
scene Two { part a: Rofi  part b: Rofi at [1m, 0m, 0m] }
save(Two(), "two.rofi.json")
//   ^^^^^ E0506 `Two` is a scene: a file of RoFI's has one robot
save(Two(), "two.mjcf.xml")
print(footprint(Two()))
//              ^^^^^ E0506 a scene has several robots

--- the state of one robot of a scene is that of its own joints, centre of mass, support and surroundings
module Slider {
  link body = box(100mm, 100mm, 100mm, mass: 3kg)
  link rod = box(20mm, 20mm, 20mm, mass: 1kg) at [80mm, 0mm, 0mm]
  joint out : body -> rod = prismatic(axis: X, range: 0mm..100mm, max_speed: 1m/s, max_accel: 1m/s^2) at [80mm, 0mm, 0mm]
}
scene Three {
  part a: Slider
  part b: Slider at [300mm, 0mm, 0mm]
  part c: Slider at [300mm, 500mm, 0mm]
  obstacle ball = sphere(10mm) at [300mm, 600mm, 50mm]
  world(dynamics: statics)
}
let yard = Three()
let p = plan(move(yard.a.out, to: 40mm, in: 1s))
// The rod, a quarter of the mass, moves the centre of mass by a quarter of its way, from 20mm to 30mm of the 50mm to the edge.
for at in [p.start, p.end] {
  print("{at.of(yard.a).com.x in mm:.3}", "{at.of(yard.b).com.x in mm:.3}", "{at.of(yard.b).base.position.x in mm:.3}")
  print("{at.of(yard.a).margin in mm:.3}", "{at.of(yard.b).margin in mm:.3}", at.of(yard.a).displacement(yard.a.out))
  print("{at.of(yard.a).clearance in mm:.3}", "{at.of(yard.b).clearance in mm:.3}", "{at.of(yard.c).clearance in mm:.3}", "{at.clearance in mm:.3}")
}
//> 20.000mm 320.000mm 300.000mm
//> 30.000mm 30.000mm 0mm
//> 160.000mm 160.000mm 40.000mm 40.000mm
//> 30.000mm 320.000mm 300.000mm
//> 20.000mm 30.000mm 40mm
//> 120.000mm 120.000mm 40.000mm 40.000mm
let force = p.end.of(yard.c).ground_force(yard.c) else 0N
print(p.end.of(yard.a), abs(force - 4 * 9.80665N) < 1e-6N)
//> a state of a in Three true
print([f.module for f in p.end.of(yard.c).contacts() else [] if f.point.x > 300mm])
//> [c, c]
let lone = Slider()
let back = plan(move(lone.out, to: 0mm, in: 1s), from: p.end.of(yard.a))
print(back.start.displacement(lone.out), plan(move(yard.b.out, to: 10mm), from: p.end).start.displacement(yard.a.out))
//> 40mm 40mm

--- a state is of one of the robots with which its scene begins
module Slider {
  link body = box(100mm, 100mm, 100mm, mass: 3kg)
  link rod = box(20mm, 20mm, 20mm, mass: 1kg) at [80mm, 0mm, 0mm]
  joint out : body -> rod = prismatic(axis: X, range: 0mm..100mm, max_speed: 1m/s, max_accel: 1m/s^2) at [80mm, 0mm, 0mm]
}
scene Two { part a: Slider  part b: Slider at [300mm, 0mm, 0mm] }
let yard = Two()
let lone = Slider()
let p = plan(move(yard.a.out, to: 40mm, in: 1s))
let q = plan(move(lone.out, to: 40mm, in: 1s))
print(p.end.of(yard))
//             ^^^^ E0506 `Two` is 2 robots: a state `of` is of one
print(p.end.of(lone))
//             ^^^^ E0506 `Slider` is no robot with which the scene of this state begins
print(q.end.of(lone))
//             ^^^^ E0506 `Slider` is no robot with which the scene of this state begins
print(p.end.of(yard.a).of(yard.b))
//                        ^^^^^^ E0506 `b` is no robot with which the scene of this state begins
print(p.end.of(yard.a).displacement(yard.b.out))
//                                  ^^^^^^^^^^ E0506 `b` is not of `a`, whose state this is
print(p.end.of(yard.a).pose(yard.b))
//                          ^^^^^^ E0506 `b` is not of `a`, whose state this is
print(plan(move(yard.b.out, to: 40mm, in: 1s), from: p.end.of(yard.a)))
//                                                   ^^^^^^^^^^^^^^^^ E0406 this is the state of `a` alone, and the behaviour is not one of `a` alone
print(verify(p).of(yard))
//                 ^^^^ E0506 `Two` is 2 robots: a report `of` is of one

--- robots that begin in each other, or in an obstacle, are shown where they are placed
use std.smores.Tank7
scene Near { part a: Tank7  part b: Tank7 at [100mm, 0m, 0m] }
//                                        ^^^^^^^^^^^^^^^^^^ E0601 a.steer.front and b.steer.center meet | place one of them
let near = Near()
emit(near.a.drive(t: 1s), "near.plan.json")
scene Buried { part a: Tank7  obstacle rock = box(3m, 3m, 1m) at [0m, 0m, 500mm] }
//                                     ^^^^ E0601 a.steer.front and rock meet | place one of them
let buried = Buried()
emit(buried.a.drive(t: 1s), "buried.plan.json")

--- robots dock where their ports are, and at rest
use std.smores.Tank7
scene Apart(gap: Length) {
  part a: Tank7
  part b: Tank7 at [gap, 0m, 0m] turned(Z, 180deg)
  behavior far = Sc(a.drive(t: 1s), wait(200ms), dock(a.nose, b.nose))
//                                               ^^^^^^^^^^^^^^^^^^^^ E0606 does not dock: the ports are 630.0
  behavior fast = Pc(a.drive(t: 5s), Sc(wait(3.67s), dock(a.nose, b.nose)))
//                                                   ^^^^^^^^^^^^^^^^^^^^ E0606 docks too fast: the ports move at
}
emit(Apart(1m).far(), "far.plan.json")
emit(Apart(600mm).fast(), "fast.plan.json")

--- a part that is let go above the ground falls, and the command is to blame
connector Face { mates Face, turns 4 }
module Block {
  link body = box(100mm, 100mm, 100mm, mass: 1kg)
  port top: Face on body at [0mm, 0mm, 50mm] facing +Z up +X
  port bottom: Face on body at [0mm, 0mm, -50mm] facing -Z up +X
}
config Tower {
  part m[2]: Block
  connect m[0].top -- m[1].bottom
  base m[0]
  behavior drop = Sc(wait(300ms), undock(m[0].top), wait(700ms))
//                                ^^^^^^^^^^^^^^^^ E0602 the part with `m[1]` falls at 300ms, by 100mm
}
emit(Tower().drop(), "drop.plan.json")
