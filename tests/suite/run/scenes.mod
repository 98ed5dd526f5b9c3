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
