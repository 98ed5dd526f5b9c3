--- a cube folds from the best of its 384 flat patterns
use std.mori.{Polygon, Regular}
use std.shapes.cube
let box = fold(cube(edge: 80mm), module: Polygon, step: 2s)
print(box.layouts, box.optimal, box.gap, box.steps, box.layout.panels, box.layout.overlaps, verify(box).ok)
//> 384 true 0 2 6 [] true
// A cross: four squares about their own sides, and the one across about two, m a²/3 five times, and m a² (1/3 + 1).
let moment = mass(Polygon()) * (80mm)^2 * 3
print(abs(box.energy / (3.75 * (90deg / 1rad) * moment / (2s)^2) - 1) < 1e-9, abs(mass(box.robot) / mass(Polygon()) - 6) < 1e-9)
//> true true
// Every face is as good a root, and a stock of squares is as good as squares made to measure.
print(box.ties, fold(cube(edge: 80mm), module: Regular, step: 2s).energy - box.energy < 1e-12J)
//> [0, 1, 2, 3, 4, 5] true
// Folded, the middles of the panels lie round that of the cube.
print(abs(norm(box.end.com) - 40mm) < 1um)
//> true

--- pentagons, and triangles with hexagons or squares, from a stock of a few kinds
use std.mori.{Mori, Polygon, Regular}
use std.shapes.{cuboctahedron, dodecahedron, truncated_tetrahedron}
let dodeca = fold(dodecahedron(edge: 80mm), module: Regular(5), sequence: leaves_first)
print(dodeca.layouts, dodeca.optimal, dodeca.layout.overlaps, verify(dodeca).ok)
//> 5184000 true [] true
let mixed = fold(truncated_tetrahedron(edge: 80mm), module: [Mori, Regular(6)], sequence: leaves_first)
print(mixed.layouts, mixed.optimal, mixed.layout.overlaps, verify(mixed).ok, abs(mass(mixed.robot) / (4 * mass(Mori()) + 4 * mass(Regular(6))) - 1) < 1e-9)
//> 6000 true [] true true
let squared = fold(cuboctahedron(edge: 80mm), module: [Mori, Polygon], sequence: leaves_first)
print(squared.layouts, squared.optimal, verify(squared).ok, abs(mass(squared.robot) / (8 * mass(Mori()) + 6 * mass(Polygon())) - 1) < 1e-9)
//> 331776 true true true

--- what has no proof of its own is simulated or listed, for any faces
use std.mori.{Mori, Polygon, Regular}
use std.shapes.{cube, truncated_tetrahedron}
let best = fold(cube(edge: 80mm), module: Polygon, step: 2s, sequence: leaves_first)
let listed = fold(cube(edge: 80mm), module: Polygon, step: 2s, method: enumerate, sequence: leaves_first)
print(abs(listed.energy / best.energy - 1) < 1e-9, listed.optimal, compare_layouts(listed).layouts, compare_layouts(listed).rank)
//> true true 384 1
let steps = fold(cube(edge: 80mm), module: Polygon, minimise: steps)
print(steps.fewest_steps, steps.optimal, verify(steps).ok)
//> 2 true true
let peak = fold(truncated_tetrahedron(edge: 80mm), module: [Mori, Regular(6)], minimise: peak_torque)
print(peak.optimal, peak.peak_torque < mixed_peak(), verify(peak).ok)
fn mixed_peak() -> Torque = fold(truncated_tetrahedron(edge: 80mm), module: [Mori, Regular(6)]).peak_torque * 1.000001
//> true true true
let passive = fold(cube(edge: 80mm), module: Polygon, passive: [0], passive_module: Polygon(motor: 0g))
print(passive.layouts, passive.optimal, verify(passive).ok)
//> 384 true true

--- an open box and a roof of any quadrangles and triangles
use std.mori.Polygon
let s = 100mm
let roof = polyhedron(
  [[0m, 0m, 0m], [2 * s, 0m, 0m], [2 * s, s, 0m], [0m, s, 0m], [s / 2, s / 2, s / 2], [3 * s / 2, s / 2, s / 2]],
  [[0, 1, 5, 4], [1, 2, 5], [2, 3, 4, 5], [3, 0, 4]],
)
let folding = fold(roof, module: Polygon(thickness: 3mm))
print(folding.layouts, folding.optimal, folding.layout.overlaps, verify(folding).ok)
//> 8 true [] true

--- faces that no panel can be are refused
use std.mori.Polygon
let s = 80mm
print(fold(polyhedron([[0m, 0m, 0m], [s, 0m, 0m], [s, s, s / 10], [0m, s, 0m]], [[0, 1, 2, 3]]), module: Polygon).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0 is not flat | cut the face into triangles
print(fold(polyhedron([[0m, 0m, 0m], [s, 0m, 0m], [s / 3, s / 3, 0m], [0m, s, 0m]], [[0, 1, 2, 3]]), module: Polygon).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0 is not convex at its corner 2 | cut the face into convex ones
let round: List<Vec3<Length>> = [[1m * cos(k * 10deg), 1m * sin(k * 10deg), 0m] for k in 0..36]
print(fold(polyhedron(round, [[k for k in 0..36]]), module: Polygon).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0 has 36 corners; 3 to 32 can be planned | into several

--- panels that are not as the faces are refused
use std.mori.{Mori, Panel, Polygon, Regular, regular}
use std.shapes.{cube, octahedron, truncated_tetrahedron}
print(fold(cube(edge: 80mm), module: Mori).layouts)
//         ^^^^^^^^^^^^^^^^ E0803 face 0 has 4 sides; the panels have 3 | `Polygon` for any face
print(fold(cube(edge: 80mm), module: Panel).layouts)
//         ^^^^^^^^^^^^^^^^ E0803 face 0 has 4 sides | `Polygon` of `std.mori`
print(fold(cube(edge: 70mm), module: Regular).layouts)
//         ^^^^^^^^^^^^^^^^ E0803 70.0000 mm; the panels' sides are 80.0000 mm | the same side
print(fold(octahedron(edge: 80mm), module: Regular).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0 has 3 sides; the panels have 4
print(fold(truncated_tetrahedron(edge: 80mm), module: [Mori, Regular]).layouts)
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0803 face 0, with sides of 80.0000 mm, 80.0000 mm, 80.0000 mm, 80.0000 mm, 80.0000 mm and 80.0000 mm, is as none of the panels
print(fold(cube(edge: 80mm), module: []).layouts)
//                                   ^^ E0506 at least one module
print(fold(cube(edge: 80mm), module: Polygon(corners: regular(4, side: 80mm))).layouts, fold(cube(edge: 80mm), module: Polygon(corners: regular(5, side: 80mm))).layouts)
//                                                                                                                     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 `corners` can't be stated
print(fold(cube(edge: 10mm), module: Polygon).layouts)
//         ^^^^^^^^^^^^^^^^ E0803 the bevels meet | thinner panels

--- a rhombus has the sides of a square, and other angles
use std.mori.{Polygon, Regular}
let s = 80mm
let corners: List<Vec3<Length>> = [[0m, 0m, 0m], [s, 0m, 0m], [s * 1.5, s * sqrt(0.75), 0m], [s / 2, s * sqrt(0.75), 0m]]
let rhombus = polyhedron(corners, [[0, 1, 2, 3]])
print(fold(rhombus, module: Polygon).layouts)
//> 1
print(fold(rhombus, module: Regular).layouts)
//         ^^^^^^^ E0803 a diagonal of 138.5641 mm; that of the panels is 113.1371 mm | congruent

--- the paper's measure and the lattice of triangles are for triangles
use std.mori.{Polygon, Regular}
use std.shapes.{cube, dodecahedron}
print(fold(cube(edge: 80mm), module: Polygon, method: heuristic).layouts)
//                                                    ^^^^^^^^^ E0506 equal
print(refold(cube(edge: 80mm), cube(edge: 80mm), module: Regular).changes)
//                                                       ^^^^^^^ E0506 on a lattice of triangles

--- a panel says what is wrong with its corners
use std.mori.{Polygon, Regular}
let s = 80mm
print(mass(Polygon(corners: [[0m, 0m, 0m], [0m, s, 0m], [s, s, 0m], [s, 0m, 0m]])))
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0308 counterclockwise from above
print(mass(Polygon(corners: [[0m, 0m, 0m], [s, 0m, 0m], [s, s, 1mm], [0m, s, 0m]])))
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0308 in the plane z = 0
print(mass(Regular(4, side: 10mm)))
//         ^^^^^^^^^^^^^^^^^^^^^^ E0308 the bevels meet
