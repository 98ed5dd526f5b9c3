//! Drawings of all kinds: pages that play, pictures from a side, graphs, patterns to cut and fold.
use std.smores.{Smores, Chain3, Leg3, Body3}
use std.mori.Mori
use std.crystal.ExpandingCube
use std.truss.PneumaticReel

/// The walker of `walkbot.mod`, standing up.
config Walkbot(bend: Angle = 30deg) {
  part body: Body3
  part leg[4]: Leg3(bend: bend)
  for i in 0..4 { connect body.side[i] -- leg[i].hip }
  base body.core
  behavior stand = Pc([l.plant() for l in leg])
  behavior step = Sc(
    Pc(leg[0].lift(), leg[3].lift()),
    Pc(leg[0].reach(), leg[3].reach()),
    Pc(leg[0].plant(), leg[3].plant()),
  )
}

/// Six panels in a strip, flat as they are cut.
config Strip {
  part m[6]: Mori
  for i in 0..5 { connect m[i].edge[if i % 2 == 0 { 1 } else { 2 }] -- m[i + 1].edge[0] }
  base m[0]
}

lattice Ell of ExpandingCube = cells("""
  #....
  #....
  #####
""")

truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)

let w = Walkbot()
show(Sc(w.stand(), w.step()), "walkbot.png", at: 3s)  // a picture at a time
show(w.step(), "step.svg")                            // its behaviour: a series-parallel graph
show(w, "walkbot.svg")                                // its modules and bonds
show(Strip(), "strip.svg")                            // true to scale, for scissors
show(Ell(), "ell.svg")                                // cells
show(Pyramid(), "pyramid.png")                        // nodes and struts
