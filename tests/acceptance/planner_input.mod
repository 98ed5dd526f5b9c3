// run E0313
use std.crystal.ExpandingCube
lattice Row of ExpandingCube = row(9)
lattice Split of ExpandingCube = cells("""
  ##.#####
  ##......
""")
let p = squeeze(Row(), Split())
//                     ^^^^^^^ not connected: a piece of 4 cells and one of 5
