//! Cubes that do not slide, as those of the robots Crystalline and Telecube: blocks of eight tunnel through each other.
use std.crystal.{DockedCube, ExpandingCube}

/// An arch of blocks, each two cubes wide, deep and high.
let arch = enlarged(cells("""
  #####
  #...#
  #...#
"""))

/// Stairs of as many blocks.
let stairs = enlarged(cells("""
  ....#
  ...##
  ..##.
  .##..
  ##...
"""))

lattice Arch of DockedCube = arch
lattice Stairs of DockedCube = stairs

let p = squeeze(Arch, Stairs)
print("{p.why}: {len(p.stages)} stages, {p.duration}; contacts hold {p.peak_force}")
emit(p, "arch_to_stairs.plan.json")

// Bolted down by its first block, a beam turns its end up.
lattice Beam of DockedCube = enlarged(row(4))
lattice Hook of DockedCube = enlarged(layers("###", "..#"))
let bolted = squeeze(Beam, Hook, fixed: enlarged(row(1)))
print("bolted: {len(bolted.stages)} stages, {bolted.duration}")

// Cubes that slide take other ways.
lattice SlidingArch of ExpandingCube = arch
lattice SlidingStairs of ExpandingCube = stairs
let slid = squeeze(SlidingArch, SlidingStairs)
print("{slid.method}: {len(slid.stages)} stages, {slid.duration}")

test "the judge finds nothing" {
  expect verify(p).ok
  expect verify(bolted).ok
}

test "cubes that slide are faster" {
  expect slid.duration < p.duration
}
