//! Sheets whose creases close loops: a vertex of four creases from a FOLD file, a Miura-ori, and waterbombs from a drawing. All
//! creases fold at once.
use std.mori.Polygon
use std.shapes.miura

// A flat sheet of four panels about one vertex; the file says by how many degrees each crease folds.
let vertex = fold_sheet(load_creases("vertex.fold", scale: 100mm), module: Polygon(thickness: 3mm))
print("{vertex.panels} panels, {vertex.creases} creases, {vertex.freedom} degree of freedom, {vertex.duration}")
emit(vertex, "vertex.plan.json")
show(vertex, "vertex.html")

// Sixteen parallelograms and nine vertices, which one hinge moves.
let ori = miura(rows: 4, columns: 4, along: 80mm, across: 80mm, sector: 65deg, fold: 50deg)
let sheet = fold_sheet(ori, module: Polygon(thickness: 4mm))
print("{sheet.panels} panels, {sheet.creases} creases, {sheet.loops} loops, {sheet.freedom} degree of freedom")
emit(sheet, "miura.plan.json")
emit(reverse(sheet), "miura_flat.plan.json")

// A tessellation of waterbombs, drawn in SVG: red mountains, blue valleys. How far the widest crease folds, the program says.
let bombs = fold_sheet(load_creases("waterbomb.svg", fold: 60deg), module: Polygon(thickness: 3mm))
print("{bombs.panels} panels, {bombs.creases} creases, {bombs.loops} loops, {bombs.freedom} degrees of freedom")
emit(bombs, "waterbomb.plan.json")

test "the vertex folds as its file says" {
  expect vertex.freedom == 1
  expect abs(max([abs(a) for a in vertex.angles]) - 70deg) < 0.01deg
  expect verify(vertex).ok
}

test "the loops of the Miura-ori stay closed" {
  expect sheet.loops == 9
  expect sheet.freedom == 1
  expect sheet.opening < 0.01deg
  expect verify(sheet).ok and verify(reverse(sheet)).ok
}

test "the waterbombs stay in one piece" {
  expect bombs.loops == 6
  expect bombs.opening < 0.01deg
  expect abs(max([abs(a) for a in bombs.angles]) - 60deg) < 0.001deg
  expect verify(bombs).ok and verify(reverse(bombs)).ok
}
