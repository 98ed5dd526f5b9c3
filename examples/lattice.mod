//! The other two families of modular robots: lattices of cubes and trusses of struts.
use std.crystal.ExpandingCube
use std.truss.PneumaticReel

lattice Tee of ExpandingCube = cells("""
  #######
  ...#...
  ...#...
""")

truss Pyramid(edge: Length = 4m) of PneumaticReel = octet(edge: edge, divisions: 4, interior: false)

/// A tower: a triangle on the ground, and a node above it.
truss Tripod(height: Length = 1m) of PneumaticReel {
  node foot[0] = [0m, 0m, 0m]
  node foot[1] = [1m, 0m, 0m]
  node foot[2] = [0.5m, 0.866m, 0m]
  node top = [0.5m, 0.289m, height]
  for i in 0..3 {
    strut foot[i] -- foot[(i + 1) % 3]
    strut foot[i] -- top
  }
}

print("cells", count(Tee), "of", mass(Tee))
print("nodes", nodes(Pyramid), "struts", struts(Pyramid), "rank", rigidity(Pyramid).rank)

test "a tripod is rigid, and needs every strut" {
  let r = rigidity(Tripod())
  expect r.rigid
  expect r.self_stresses == 0
  expect len(r.redundant) == 0
}
