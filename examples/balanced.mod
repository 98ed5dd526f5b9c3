//! A robot that floats becomes another shape and turns at no time: pairs of its cells spin as reaction wheels do.
use std.crystal.ExpandingCube

lattice Ring of ExpandingCube = cells("""
  ####
  #..#
  #..#
  ####
""")

lattice Stairs of ExpandingCube = cells("""
  ##.....
  .##....
  ..##...
  ...##..
  ....##.
  .....##
""")

let held = squeeze(Ring, Stairs)
print("{held.method}: {held.duration}, with an angular momentum of up to {held.angular_momentum}")

let free = squeeze(Ring, Stairs, model: balanced)
print("{free.method}: {free.duration} in {len(free.stages)} stages, with {free.angular_momentum}")
emit(free, "ring_to_stairs.plan.json")

test "nothing outside has to hold it" {
  expect free.balanced and not held.balanced
  expect verify(free).ok
}
