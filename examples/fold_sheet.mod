//! Sheets whose creases close loops: a vertex of four creases from a FOLD file, and a Miura-ori. All creases fold at once.
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
