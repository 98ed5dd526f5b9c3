//! Three flaps, each tucked under the next: no order folds it hinge by hinge, so one of them stops on its way.
use std.mori.regular

connector Crease {
  mates Crease
  turns 1
  hinge(axis: Y, range: -172deg..172deg, max_speed: 90deg/s, max_accel: 720deg/s^2, max_torque: 0.1N*m)
}

// A card of any form, thin towards its creases, so that it folds over almost all the way.
module Card(
  corners: List<Vec3<Length>> = regular(4, side: 80mm),
  thickness: Length = 1mm,
  weight: Quantity<kg/m^2> = 1kg/m^2,
) {
  let n = len(corners)
  let area = sum([corners[k][0] * corners[(k + 1) % n][1] - corners[k][1] * corners[(k + 1) % n][0] for k in 0..n]) / 2
  mass weight * area
  link card = hull(
    [c * 0.99 for c in corners] ++ [c * 0.85 + [0mm, 0mm, z] for c in corners for z in [-thickness / 2, thickness / 2]]
  )
  for i in 0..n {
    let along = (corners[(i + 1) % n] - corners[i]) / norm(corners[(i + 1) % n] - corners[i])
    port edge[i] : Crease on card
      at (corners[i] + corners[(i + 1) % n]) / 2
      facing [along[1], -along[0], 0] up +Z
  }
}

// A point of flap k: how far along a side of a triangle of 300 mm, how far from it, and how steeply it rises from the base.
fn at(k: Int, along: Length, away: Length, rise: Angle) -> Vec3<Length> = {
  let x = along - 150mm
  let y = away * cos(rise) - 300mm / (2 * sqrt(3))
  [x * cos(120deg * k) - y * sin(120deg * k), x * sin(120deg * k) + y * cos(120deg * k), away * sin(rise)]
}

// Flap 0 is over flap 2 and under flap 1, which is under flap 2. Flap 1 is the steepest.
let rise = [10deg, 27deg, 18deg]
let flaps: List<List<List<Length>>> = [
  [[190mm, 0mm], [270mm, 0mm], [245mm, 35mm], [80mm, 225mm]],
  [[180mm, 0mm], [260mm, 0mm], [105mm, 120mm], [-60mm, 240mm]],
  [[40mm, 0mm], [175mm, 0mm], [160mm, 10mm], [25mm, 65mm]],
]
let tucked = polyhedron(
  [at(k, p[0], p[1], rise[k]) for k in 0..3 for p in flaps[k]],
  [[9, 8, 5, 4, 1, 0], [0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]],
)

let folding = fold(tucked, module: Card)
print("folds in {len(folding.order)} steps:", folding.order)
for stop in folding.stops {
  print("after step {stop.step + 1} the hinge of panel {stop.face} stops at {stop.angle}")
}
print(folding.why)
emit(folding, "tucked.plan.json")
show(folding, "tucked.html")

// From the flat cards: the hinges of each group together, each to its whole angle or a part of it.
let flat = reverse(folding).end
fn hinge(flap: Int) -> Joint<Angle> =
  [folding.hinges[i] for i in 0..3 if folding.layout.hinges[i] == [0, flap + 1]][0]
fn turn(flap: Int, part: Number) -> Behavior =
  move(hinge(flap), to: part * folding.end.angle(hinge(flap)), in: 4s)
fn passes(groups: List<Behavior>) -> Bool =
  verify(plan(Sc(groups), from: flat, world: world(ground: off, gravity: off))).ok
fn folds_whole(order: List<List<Int>>) -> Bool = passes([Pc([turn(flap, 1) for flap in group]) for group in order])

test "no order of whole hinges folds it, one after the other or together" {
  let orders: List<List<List<Int>>> = [
    [[0], [1], [2]], [[0], [2], [1]], [[1], [0], [2]], [[1], [2], [0]], [[2], [0], [1]], [[2], [1], [0]],
    [[0, 1], [2]], [[0, 2], [1]], [[1, 2], [0]], [[0], [1, 2]], [[1], [0, 2]], [[2], [0, 1]],
    [[0, 1, 2]],
  ]
  for order in orders {
    expect not folds_whole(order)
  }
}

test "one stop does" {
  expect verify(folding).ok
  expect len(folding.order) == 4
  expect len(folding.stops) == 1
  expect passes([turn(2, 7 / 8), turn(0, 1), turn(1, 1), turn(2, 1)])
}
