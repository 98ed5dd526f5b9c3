//! Squares, pentagons, hexagons and mixed panels: the best flat patterns of a cube, of a dodecahedron and of a soccer ball.
use std.mori.{Mori, Polygon, Regular}
use std.shapes.{cube, cuboctahedron, dodecahedron, truncated_icosahedron, truncated_tetrahedron}

// Panels made to measure for each face, whatever convex polygon it is.
let box = fold(cube(edge: 80mm), module: Polygon)
let dodeca = fold(dodecahedron(edge: 80mm), module: Polygon)
let ball = fold(truncated_icosahedron(edge: 80mm), module: Polygon)
for folding in [box, dodeca, ball] {
  print(
    "{folding.layout.panels} panels, {folding.layouts} flat patterns; the best takes {folding.energy}, gap {folding.gap}"
  )
}
emit(ball, "ball.plan.json")
show(ball, "ball.html")        // watch it fold
show(ball.layout, "ball.svg")  // true to scale: cuts, mountains and valleys on layers, edges numbered
save(ball, "ball.fold")        // for programs that read FOLD

// Panels from a stock of a few kinds: each face takes the one that is as it is.
let mixed = fold(truncated_tetrahedron(edge: 80mm), module: [Mori, Regular(6)])
let squared = fold(cuboctahedron(edge: 80mm), module: [Mori, Regular(4)])
print(
  "{mixed.layouts} and {squared.layouts} flat patterns; with {mass(mixed.robot)} and {mass(squared.robot)} of panels"
)
emit(mixed, "truncated_tetrahedron.plan.json")
emit(squared, "cuboctahedron.plan.json")

test "the counts are those that are known" {
  // Spanning trees of the duals: 11 nets of the cube up to symmetry, 43,380 of the dodecahedron.
  expect box.layouts == 384
  expect dodeca.layouts == 5_184_000
  expect mixed.layouts == 6_000
  expect squared.layouts == 331_776
}

test "a cube folds from a cross for what its squares weigh" {
  // Four squares about their own sides, and the one across about two: m a²/3 five times, and m a² (1/3 + 1).
  let moment = mass(Polygon()) * (80mm)^2 * 3
  expect box.optimal
  expect len(box.layout.hinges) == 5
  expect verify(box).ok and verify(dodeca).ok and verify(mixed).ok and verify(squared).ok
  expect abs(
    fold(cube(edge: 80mm), module: Polygon, step: 2s).energy / (3.75 * (90deg / 1rad) * moment / (2s)^2) - 1
  ) < 1e-9
}
