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
print(terrain([[0, 1], [0, 1]], spacing: 1m))
//              ^ E0204
print(terrain([], spacing: 1m))
//            ^^ E0506 less than two rows
