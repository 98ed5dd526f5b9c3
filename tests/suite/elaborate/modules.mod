--- `up` along `facing`
connector Face { mates Face, turns 4 }
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  port p: Face on a at [500mm, 0m, 0m] facing +X up -X
//                                            ~~ parallel to this
//                                                  ^^ E0307 lie on one line
}

--- links that hang nowhere, or twice
module M {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m)
//     ^ E0307 no joint connects the link `b`
}
module N {
  mass 1kg
  link a = box(1m, 1m, 1m)
  link b = box(1m, 1m, 1m)
  joint i: a -> b = revolute(axis: X)
//      ~ and on this one
  joint j: a -> b = revolute(axis: Y)
//      ^ E0307 hangs on two joints
}

--- no mass
module M {
//     ^ E0307 has no mass
  link a = box(1m, 1m, 1m)
}

--- a shape that is no solid
module M {
  mass 1kg
  link a = box(1m, 1m, 0m)
//         ^^^^^^^^^^^^^^^ E0314 height
}

--- connectors that mate one way only
connector Plug { mates Socket, turns 1 }
//                     ^^^^^^ E0310 Socket does not mate Plug
connector Socket { mates Socket, turns 1 }
//        ~~~~~~ declared here

--- links that overlap when the joint turns
module M {
  mass 1kg
  link a = box(40mm, 40mm, 40mm)
  link b = box(40mm, 40mm, 40mm) at [60mm, 0mm, 0mm]
  joint bend: a -> b = revolute(axis: Y, range: -90deg..90deg) at [30mm, 0mm, 0mm]
//      ^^^^ W0005 `a` and `b` overlap
}

--- a link thinner than a touch, and one that states less
module Flag {
  mass 1kg
  link cloth = box(40mm, 40mm, 0.05mm)
//     ^^^^^ W0009 `cloth` is 0.05mm thin | `touch` below 0.05mm
}
module Pennant {
  mass 1kg
  touch 0.04mm
  link cloth = box(40mm, 40mm, 0.05mm)
}

--- a lattice in two pieces, and one with a strange cell
use std.crystal.ExpandingCube
lattice Split of ExpandingCube = cells("#.#")
//      ^^^^^ E0313 a piece of 1 cell and one of 1
//                               ~~~~~~~~~~~~ hang together
lattice Odd of ExpandingCube = cells("""
  ##
  #x
//<4-4 E0313 `x` is no cell
""")

--- a truss that folds
use std.truss.PneumaticReel
truss Square of PneumaticReel {
//    ^^^^^^ E0311 rank 4 of 6 | free motion 2
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [1m, 1m, 0m]
  node d = [0m, 1m, 0m]
  strut a -- b  strut b -- c  strut c -- d  strut d -- a
}

--- struts that are too long, there twice, or cross
use std.truss.PneumaticReel
truss Long of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [9m, 0m, 0m]
  strut a -- b
//^^^^^^^^^^^^ E0312 9m long
}
truss Twice of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  strut a -- b
//~~~~~~~~~~~~ first here
  strut b -- a
//^^^^^^^^^^^^ E0312 there twice
}
