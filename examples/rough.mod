//! A truss squeezes through a gate narrower than itself, walks over hills, and morphs beside a wall.
use std.truss.PneumaticReel
use std.shapes.cube

truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)

// The truss is 4 m wide, the gate 2.5 m. With three feet held and the others free to slide it is planned ten times as fast.
let post = box(500mm, 6m, 5m)
let gate = [placed(post, at: [7m, -3m, 2500mm]), placed(post, at: [7m, 5500mm, 2500mm])]
let through = locomote(Pyramid, path: [[12m, 1m, 0m]], obstacles: gate, lookahead: 30, hold: three)
print(through.ended, through.distance, through.rolls, through.footholds)
emit(through, "through.plan.json")

let hills = terrain([[80mm * sin(x * 50deg) * cos(y * 70deg) for x in 0..20] for y in 0..20], spacing: 1m)
let over = locomote(Pyramid, path: [[5m, 1m, 0m]], terrain: hills)
print(over.ended, over.distance, over.rolls)
emit(over, "over.plan.json")

let wall = placed(box(100mm, 6m, 6m), at: [4200mm, 1m, 1m])
let beside = morph(Pyramid, cube(edge: 2m), obstacles: [wall], budget: 60, tolerance: 60mm)
print(beside.ended, beside.rms, beside.rms_back)
emit(beside, "beside.plan.json")

test "nothing is touched, and no foot sinks" {
  expect through.ended == "arrived"
  expect verify(through).ok
  expect verify(over).ok
  expect verify(beside).ok
}
