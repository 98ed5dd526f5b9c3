//! A truss of linear actuators takes on the shape of a cube, and another rolls along a square.
use std.truss.PneumaticReel
use std.shapes.cube

truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)

let made = morph(Pyramid, cube(edge: 2m))
print(made.ended, made.rms, made.rms_back, made.steps, made.clearance)
emit(made, "cube.plan.json")

let walk = locomote(Pyramid, path: [[4m, 1m, 0m], [4m, 4m, 0m]])
print(walk.ended, walk.distance, walk.rolls, walk.slip)
emit(walk, "walk.plan.json")

// The same, and no two struts at a node come nearer to each other than 8 degrees.
let careful = morph(Pyramid, cube(edge: 2m), angle: 8deg)
print(careful.ended, careful.steps, verify(careful).angle)

// Without falling: a node is put down before the centre of mass crosses an edge.
let soft = locomote(Pyramid, path: [[4m, 1m, 0m], [4m, 4m, 0m]], impact: false)
print(soft.ended, soft.rolls, soft.footholds)

test "both keep the struts apart" {
  expect verify(made).ok
  expect verify(walk).ok
  expect made.rms < 20mm
  expect walk.ended == "arrived"
}

test "limits and soft steps hold as well" {
  expect verify(careful).ok
  expect verify(careful).angle >= 8deg
  expect verify(soft).ok
  expect soft.rolls == 0
}
