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

test "both keep the struts apart" {
  expect verify(made).ok
  expect verify(walk).ok
  expect made.rms < 20mm
  expect walk.ended == "arrived"
}
