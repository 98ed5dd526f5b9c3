--- the way round a wall turns at its corners, at the height where it begins
use std.smores.Driver1
scene Yard {
  part d: Driver1
  part e: Driver1 at [0m, 5m, 0m]
  obstacle wall = box(2m, 2m, 1m) at [3m, 0m, 500mm]
}
let y = Yard()
print(waypoints(y, from: [0m, 0m, 50mm], to: [6m, 100mm, 1m], clearance: 0m))
//> [[0mm, 0mm, 50mm], [2m, 1m, 50mm], [4m, 1m, 50mm], [6m, 100mm, 50mm]]
print(waypoints(y.e, from: [0m, 2m, 0m], to: [6m, 2m, 0m], clearance: 1m))
//> [[0mm, 2m, 0mm], [6m, 2m, 0mm]]
print(len(waypoints(y.d.top, from: [0m, 2m, 0m], to: [6m, 2m, 0m], clearance: 1001mm)) > 2)
//> true
print(waypoints(Driver1, from: [0m, 0m, 0m], to: [6m, 0m, 0m], clearance: 1m))
//> [[0mm, 0mm, 0mm], [6m, 0mm, 0mm]]

--- what is in the way is named
use std.smores.Driver1
scene Yard {
  part d: Driver1
  for i in 0..2 { obstacle wall[i] = box(2m, 100mm, 1m) at [0m, (2 * i - 1) * 1m, 500mm] }
  for i in 0..2 { obstacle gate[i] = box(100mm, 2m, 1m) at [(2 * i - 1) * 1m, 0m, 500mm] }
}
let y = Yard()
print(waypoints(y, from: [1m, 0m, 0m], to: [3m, 0m, 0m], clearance: 100mm))
//                       ^^^^^^^^^^^^ E0506 the way begins too close to `gate[1]`
print(waypoints(y, from: [3m, 0m, 0m], to: [0m, 0.9m, 0m], clearance: 100mm))
//                                         ^^^^^^^^^^^^^^ E0506 the way ends too close to `wall[1]`
print(waypoints(y, from: [0m, 0m, 0m], to: [3m, 0m, 0m], clearance: 100mm))
//                                         ^^^^^^^^^^^^ E0506 `gate[1]` is in the way
print(waypoints(y, from: [0m, 0m, 0m], to: [3m, 0m, 0m], clearance: -1mm))
//                                                                  ^^^^ E0506 the clearance must not be negative

--- no plan begins where ports are docked that were not connected
use std.smores.Smores
scene Near {
  part a: Smores
  part b: Smores at [100mm, 0m, 0m]
  world(ground: off, gravity: off)
}
let n = Near()
let p = plan(Sc(dock(n.a.top, n.b.bottom), move(n.a.pan, by: 10deg)))
print(plan(move(n.a.pan, by: 5deg), from: p.end))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 ports are docked that were not connected | plan(Sc(before, behavior))
