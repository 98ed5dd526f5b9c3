--- what only a scene has
use std.smores.Smores
config Pair {
//     ~~~~ a configuration is one robot
  part a: Smores
  part b: Smores at [100mm, 0m, 0m]
//               ^^^^^^^^^^^^^^^^^^ E0317 `at` places the robots of a `scene` | `scene Pair { ... }`
  connect a.top -- b.bottom
  obstacle wall = box(20mm, 1m, 200mm)
//^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0317 only a `scene` has obstacles
  world(friction: 0.3)
//^^^^^^^^^^^^^^^^^^^^ E0317 only a `scene` has a `world`
}

--- a scene is no part
use std.smores.Smores
scene Meadow { part a: Smores }
scene Farm { part meadow: Meadow }
//                        ^^^^^^ E0318 the scene `Meadow` is no part
config Barn { part meadow: Meadow }
//                         ^^^^^^ E0318

--- robots at one place
use std.smores.Smores
scene Two {
  part a: Smores
//     ^ E0319 a, b begin at one place | place one with `at`
  part b: Smores
//     ~ and this robot, too
}
scene Listed { part c[3]: Smores }
//                  ^ E0319 c[0], c[1], c[2] begin at one place
scene Placed {
  part a: Smores at [1m, 0m, 0m]
//     ^ E0319 a, b begin at one place
  part b: Smores at [1m, 0m, 0m] turned(Z, 90deg)
}
scene Apart { part a: Smores  part b: Smores at [0m, 0m, 500mm] }

--- robots that connections make
use std.smores.Smores
scene Twice {
  part a: Smores at [0m, 0m, 0m]
//               ^^^^^^^^^^^^^^^ E0320 a, b are one robot, which is placed twice
  part b: Smores at [300mm, 0m, 0m]
//               ~~~~~~~~~~~~~~~~~~ and this b
  connect a.top -- b.bottom
}
scene Once {
  part a: Smores
  part b: Smores at [300mm, 0m, 0m]
  connect a.top -- b.bottom
}

--- obstacles are solids with names of their own
use std.smores.Smores
scene Odd {
  part a: Smores
//     ~ first declared here
  obstacle x = 5mm
//             ^^^ E0202 an obstacle wants a `Shape`
  obstacle a = box(1m, 1m, 1m)
//         ^ E0102 `a` is declared twice
}

--- obstacles are sound, and each stands once
use std.smores.Smores
scene Flat {
  part a: Smores
  obstacle y = box(0mm, 1m, 1m)
//             ^^^^^^^^^^^^^^^^ E0314
}
scene Loop {
  part a: Smores
  for i in 0..2 { obstacle z = box(1m, 1m, 1m) at [i * 2m, 0m, 0m] }
//                         ^ E0102 the obstacle `z` stands already | each has an index
  obstacle post[0] = box(1m, 1m, 1m) at [9m, 0m, 0m]
//         ~~~~ declared here first
  obstacle post[0] = box(1m, 1m, 1m) at [9m, 0m, 0m]
//         ^^^^ E0102 the obstacle `post[0]` stands already
  obstacle far = box(1m, 1m, 1m) at [2000m, 0m, 0m]
//                                  ^^^^^^^^^^^^^^^ E0506 nothing is placed farther away
}

--- the world of a scene is one, and stands at the top
use std.smores.Smores
scene World {
  part a: Smores
  world(friction: 1)
  world(friction: 0.5)
//^^^^^^^^^^^^^^^^^^^^ E0102 a scene has one `world`
  if true { world(friction: 2) }
//          ^^^^^^^^^^^^^^^^^^ E0001 `world` stands at the top
}

--- the world of a scene is one that the built-in makes
use std.smores.Smores
scene Heavy {
  part a: Smores
  world(gravity: -1m/s^2)
//               ^^^^^^^ E0506 gravity acts downwards
}

--- too many robots
use std.smores.Smores
scene Many { part m[i in 0..1000]: Smores at [i * 1m, 0m, 0m] }
//                ^ E0505 a scene of more than 256 robots is not allowed

--- several robots are a scene
use std.smores.Smores
config C { part a: Smores  part b: Smores }
//                              ^ E0305 nothing connects b with a | several are a `scene`

--- obstacles are shapes once they stand
use std.smores.Smores
scene Late(high: Bool = false) {
  part a: Smores
  obstacle copy = placed(wall, at: [0m, 3m, 0m])
//                       ^^^^ E0108 the obstacle `wall` is needed before it stands
  obstacle wall = box(1m, 1m, 1m) at [5m, 0m, 0m]
}
scene Low(high: Bool = false) {
  part a: Smores
  if high { obstacle roof = box(1m, 1m, 10mm) at [0m, 0m, 1m] }
  let top = roof
//          ^^^^ E0506 `roof` does not stand in `Low`
}

--- a scene stands in no configuration
use std.smores.Smores
config Outer {
  part a: Smores
  scene Inner { part b: Smores }
//^^^^^ E0001 `scene` begins an item of a file, not a clause of a configuration
}
config Line { part a: Smores  scene Inner { part b: Smores } }
//                            ^^^^^ E0001 `scene` cannot stand here | a `scene` stands by itself in the file
