//! A sphere of triangles of two shapes, from one sheet of panels that are made to measure.
use std.mori.Panel
use std.shapes.geodesic

// Each face of the shape becomes a panel with its sides; the other arguments hold for all. The face that
// stays where it is is given: with all roots the proof takes longer. So is the order, for which there is a proof.
let ball = fold(geodesic(radius: 200mm, parts: 2), module: Panel(thickness: 4mm), root: 0, sequence: leaves_first)
print("{ball.layouts} flat patterns, proved: {ball.optimal}, folds in {len(ball.order)} steps")

emit(ball, "sphere.plan.json")
show(ball.layout, "sphere.svg")  // true to scale
save(ball, "sphere.fold")

test "the sphere folds, and nothing is better with the leaves first" {
  expect ball.layout.panels == 80
  expect ball.layout.overlaps == []
  expect ball.optimal
  expect verify(ball).ok
  expect mass(ball.robot) > 80 * 18g
}
