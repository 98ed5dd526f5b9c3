--- a sheet folds along all creases at once, without a cut
use std.mori.{Polygon, Regular}
use std.shapes.{cube, miura}
let sheet = fold_sheet(miura(rows: 3, columns: 3, along: 80mm, across: 80mm, sector: 60deg, fold: 45deg), module: Polygon)
print(sheet.panels, sheet.creases, sheet.loops, sheet.freedom, sheet.opening < 0.001deg, verify(sheet).ok, verify(reverse(sheet)).ok)
//> 9 12 4 1 true true true
print(count(sheet.robot), len(sheet.angles), sheet.duration > 500ms)
//> 9 12 true
// Twice as long is twice as slow; faster than the hinges is refused.
print(fold_sheet(miura(rows: 2, columns: 2, along: 80mm, across: 80mm, sector: 60deg, fold: 45deg), module: Polygon, time: 9s).duration)
//> 9s

--- what has no loops folds, too, and what is flat stays so
use std.mori.Mori
let s = 80mm
let h = s * sqrt(0.75)
let two = polyhedron([[0m, 0m, 0m], [s, 0m, 0m], [s / 2, h, 0m], [s / 2, -h * cos(50deg), -h * sin(50deg)]], [[0, 1, 2], [1, 0, 3]])
let sheet = fold_sheet(two, module: Mori)
print(sheet.loops, sheet.freedom, abs(sheet.angles[0] - 50deg) < 1e-6deg, verify(sheet).ok)
//> 0 1 true true
print(sheet.why)
//> no loop ties its creases together: all fold at once
let flat = fold_sheet(polyhedron([[0m, 0m, 0m], [s, 0m, 0m], [s / 2, h, 0m], [s / 2, -h, 0m]], [[0, 1, 2], [1, 0, 3]]), module: Mori)
print(flat.angles, verify(flat).ok)
//> [0deg] true

--- what is no sheet, or can't go so fast, is refused
use std.mori.{Mori, Polygon, Regular}
use std.shapes.{cube, miura, octahedron}
print(fold_sheet(cube(edge: 80mm), module: Regular).panels)
//               ^^^^^^^^^^^^^^^^ E0803 the faces at vertex 0 enclose 270.0000 degrees | `fold` cuts
let ori = miura(rows: 2, columns: 2, along: 80mm, across: 80mm, sector: 60deg, fold: 45deg)
print(fold_sheet(ori, module: Polygon, time: 10ms).panels)
//                                           ^^^^ E0506 can't fold as fast | is long enough
print(fold_sheet(ori, module: Polygon, root: 4).panels)
//                                           ^ E0506 there are 4
print(fold_sheet(ori, module: Regular).panels)
//               ^^^ E0803 a diagonal of
print(fold_sheet(miura(rows: 2, columns: 2, along: 80mm, across: 80mm, sector: 60deg, fold: 85deg), module: Polygon).panels)
//               ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0801 the judge refuses the motion | smaller angles
