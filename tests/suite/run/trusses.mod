--- what is in the way of a truss where it begins
use std.truss.PneumaticReel
truss P of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let inside = locomote(P, path: [[3m, 0m, 0m]], obstacles: [box(1m, 1m, 1m)])
//                                                        ^^^^^^^^^^^^^^^^^ E0506 too near to obstacle 1 where the truss begins
let hill = terrain([[0m, 0m, 0m], [0m, 1m, 0m], [0m, 0m, 0m]], spacing: 500mm, centre: [500mm, 0m, 0m])
let under = locomote(P, path: [[3m, 0m, 0m]], terrain: hill)
//                                                     ^^^^ E0506 in the ground where the truss begins

--- ground that is none
print(terrain([[0m, 1m]], spacing: 1m))
//            ^^^^^^^^^^ E0506 less than two rows
print(terrain([[0m, 1m], [0m]], spacing: 1m))
//            ^^^^^^^^^^^^^^^^ E0506 row 1 has 1 heights, the rows before have 2
print(terrain([[0m, 1m], [0m, 1m]], spacing: 0m))
//                                           ^^ E0506
print(terrain([[0m, 1m], [0m, 1m]], spacing: 1m))
//> a terrain of 2 by 2 heights
print(terrain([], spacing: 1m))
//            ^^ E0506 less than two rows

--- a truss with several faults tells them all, and nothing that follows from one
use std.truss.PneumaticReel
truss T of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [0m, 1m, 0m]
  node d = [0m, 0m, 50m]
  node twin = [1m, 0m, 0m]
//     ^^^^ E0312 the nodes b and twin are at one place
  node alone = [5m, 5m, 5m]
//     ^^^^^ E0312 no strut holds the node alone
  strut a -- b
  strut b -- c
  strut b -- a
//^^^^^^^^^^^^ E0312 the strut b -- a is there twice
  strut c -- d
//^^^^^^^^^^^^ E0312 50.01m long
  strut c -- c
//^^^^^^^^^^^^ E0312 begins and ends at one node
  strut a -- twin
}
print(nodes(T))

--- targets and paths that are farther away than 1 km
use std.truss.PneumaticReel
truss P of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let far = cloud([[0m, 0m, 0m], [1m, 0m, 0m], [0m, 1m, 0m], [0m, 0m, 1e300m]])
print(morph(P, far).rms)
//             ^^^ E0506 a target reaches to at most 1000 m
print(locomote(P, path: [[1e6m, 0m, 0m]]).distance)
//                      ^^^^^^^^^^^^^^^^ E0506 at most 1000 m away
