--- a shape is folded from the best of its flat patterns
use std.mori.Mori
use std.shapes.{tetrahedron, octahedron}
let tetra = fold(tetrahedron(edge: 80mm), module: Mori, method: enumerate)
print(tetra.layouts, tetra.steps, tetra.duration, tetra.optimal, tetra.ties, verify(tetra).ok)
//> 16 1 2.29s true [0, 1, 2, 3] true
let octa = fold(octahedron(edge: 80mm), module: Mori, step: 2s)
print(octa.layouts, octa.steps, octa.duration, octa.optimal, octa.layout.panels, octa.layout.overlaps)
//> 384 3 6s true 8 []
// The panels of the folded robot lie round its middle; flat, the root and its neighbours are level.
print(count(octa.robot), mass(octa.robot), [norm(octa.end.com)], verify(octa.plan).ok, verify(reverse(octa)).ok)
//> 8 208g [32.6599mm] true true

--- a heuristic and other roots are no better than what is proved
use std.mori.Mori
use std.shapes.{octahedron, quadruped18}
let best = fold(octahedron(edge: 80mm), module: Mori)
let fast = fold(octahedron(edge: 80mm), module: Mori, method: heuristic)
print(abs(fast.energy / best.energy - 1) < 1e-6, fast.optimal, best.energy >= best.bound)
//> true false true
let quad = fold(quadruped18(edge: 80mm), module: Mori, root: 4)
print(quad.layouts, quad.root, verify(quad).ok, fold(quadruped18(edge: 80mm), module: Mori).ties)
//> 108 4 true [0]

--- a mesh that does not fold is refused, with the faces
use std.mori.Mori
use std.shapes.{cube, octahedron}
print(fold(cube(edge: 80mm), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^ E0803 does not fold

--- a face that there isn't
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, root: 8).layouts)
//                                                     ^ E0506 there are 8

--- a module that is no panel
use std.smores.Smores
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Smores).layouts)
//                                         ^^^^^^ E0506 no triangular panel

--- a step that the hinges can't keep
use std.mori.Mori
use std.shapes.octahedron
print(fold(octahedron(edge: 80mm), module: Mori, step: 1s).layouts)
//                                                     ^^ E0506 can't fold as fast
