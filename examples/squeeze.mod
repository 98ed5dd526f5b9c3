//! Expanding cubes change shape in a time that grows with the square root of their number.
use std.crystal.ExpandingCube

lattice Row(n: Int) of ExpandingCube = row(n)
lattice Column(n: Int) of ExpandingCube = column(n)
lattice Slab of ExpandingCube = block(4, 4)
lattice Cup of ExpandingCube = cells("""
  #....#
  #....#
  ######
""")

// Four times as many cells take about twice as long.
for n in [256, 1024, 4096] {
  let p = squeeze(Row(n), Column(n))
  print("n = {n}: {p.method} in {p.duration}, at least {p.lower_bound}; contacts hold {p.peak_force}")
}

let p = squeeze(Row(16), Slab)
print(p.why)
print(join(p.stages, with: "\n"))
emit(p, "row_to_slab.plan.json")

// Held from outside, a row becomes a column in one go: no motion is faster.
let held = squeeze(Row(64), Column(64), model: paper)
print("{held.method}: {held.ratio} times the bound, angular momentum {held.angular_momentum}")

// Connections that hold 20 N, twice what a cell can do by itself.
let weak = squeeze(Row(64), Column(64), max_force: 20N)
print("with weak connections {weak.duration}")

// Any connected shape in a plane, and back.
let cup = squeeze(Row(10), Cup)
emit(cup, "row_to_cup.plan.json")
emit(reverse(cup), "cup_to_row.plan.json")

test "a free robot is not turned" {
  expect squeeze(Row(16), Column(16), model: balanced).balanced
  expect squeeze(Row(16), Column(16)).angular_momentum == 0kg*m^2/s
}

test "connections hold" {
  expect squeeze(Row(64), Column(64), max_force: 20N).peak_force <= 20.0001N
}
