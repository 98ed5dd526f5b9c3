//! Eighteen flat panels fold into a robot with four legs, which then walks: one plan.
use std.gaits
use std.mori.Mori
use std.shapes.quadruped18

let quad = fold(quadruped18(edge: 80mm), module: Mori)
print("{quad.layouts} patterns; the best is proved: {quad.optimal}, and folds in", quad.steps)

// The hinge of two faces: of a leg's upper panel on the shell, and of the lower on the upper.
fn hinge(pair: List<Int>) -> Joint<Angle> =
  [quad.hinges[i] for i in 0..len(quad.hinges) if quad.layout.hinges[i] == pair][0]
let hip = [hinge(p) for p in [[4, 10], [6, 12], [8, 14], [9, 16]]]
let knee = [hinge(p) for p in [[10, 11], [12, 13], [14, 15], [16, 17]]]

// A leg away from where it is when the robot has folded; it swings in and out, and nowhere else.
fn swing(leg: Int, hips: Angle, knees: Angle) -> Behavior = Pc(
  move(hip[leg], to: quad.end.angle(hip[leg]) + hips, in: 2s),
  move(knee[leg], to: quad.end.angle(knee[leg]) + knees, in: 2s),
)

// One leg after the other goes where the walk goes, and slides, while the other three hold; then all go
// back together, and the body with them.
fn stride(front: List<Int>, rear: List<Int>) -> Behavior = Sc(
  Sc([swing(leg, -25deg, 20deg) for leg in front]),
  Sc([swing(leg, 5deg, -10deg) for leg in rear]),
  Pc([swing(leg, 0deg, 0deg) for leg in 0..4]),
)

// It folds without gravity, and then stands on its feet: each part keeps its own world. The walk is judged at rest at
// every instant: under full dynamics feet that drag load the hinges with 0.2 N*m, and Mori's hold 0.1 N*m.
let still = world(dynamics: statics)
let walk = plan(
  gaits.alternating(stride([2, 3], [0, 1]), stride([3, 2], [1, 0]), times: 2),
  from: quad.end,
  world: still
)
print(verify(walk))
emit(quad ++ walk, "quadruped.plan.json")
show(quad ++ walk, "quadruped.html")

test "folded, it walks in the same plan" {
  let r = verify(quad ++ walk)
  expect r.ok
  expect r.duration == quad.duration + walk.duration
  expect r.travel > 20mm
}
