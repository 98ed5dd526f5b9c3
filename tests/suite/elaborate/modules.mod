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

--- joints that follow each other in a circle
module M {
  mass 1kg
  link a = box(10mm, 10mm, 10mm)
  link b = box(10mm, 10mm, 10mm) at [30mm, 0mm, 0mm]
  link c = box(10mm, 10mm, 10mm) at [60mm, 0mm, 0mm]
  joint j: a -> b = revolute(axis: X)
//      ^ E0307 follows itself
  joint k: b -> c = revolute(axis: X)
  joint j = 2 * k
  joint k = -1 * j
}

--- an inertia that no body has
module M {
  link a = box(100mm, 100mm, 100mm, mass: 1kg, inertia: [1e-4kg*m^2, 1e-4kg*m^2, 4e-3kg*m^2])
//     ^ E0307 more than the other two together
}
module N {
  link a = box(100mm, 100mm, 100mm, mass: 1kg, inertia: [1kg*m^2, 1kg*m^2, 1kg*m^2])
//     ^ E0307 no body of its mass within the module
}

--- a centre of mass outside of the module
module M {
  link a = box(100mm, 100mm, 100mm, mass: 1kg, com: [0m, 0m, 1m])
//     ^ E0307 outside of the module
}

--- penetrations that are no tolerance, and joints and connectors beyond all bounds
module M {
//     ^ E0307 `touch` is 1
  mass 1kg
  touch 1m
  link a = box(100mm, 100mm, 100mm)
}
module N {
  mass 1kg
  link a = box(10mm, 10mm, 10mm)
  link b = box(10mm, 10mm, 10mm) at [30mm, 0mm, 0mm]
  joint j: a -> b = prismatic(axis: X, range: 0m..1e6m)
//      ^ E0307 its range is 1000000
}
connector Face { mates Face, turns 1, capture 1e7m 5deg }
//        ^^^^ E0310 the distance of capture

--- what is farther away than 1 km
module M {
  mass 1kg
  link a = box(100mm, 100mm, 2km)
//         ^^^^^^^^^^^^^^^^^^^^^^ E0314 at most 1 km
}
use std.truss.PneumaticReel
truss Far of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [0m, 1m, 0m]
  node d = [0m, 0m, 1e308m]
//     ^ E0312 farther than 1000m away
  strut a -- b  strut a -- c  strut b -- c  strut a -- d  strut b -- d
}

--- what a connector captures is stated once, and is no mass
connector A { mates A, turns 1, capture 4mm 5deg 6deg }
//                                               ^^^^ E0310 the angle of `capture` is stated twice
connector B { mates B, turns 1, capture 4mm 10mm/s 5deg/s, snap }
connector D { mates D, turns 1, capture 4mm 5kg }
//                                          ^^^ E0201 wants an angle

--- a speed of capture is positive
connector C { mates C, turns 1, capture 4mm 5deg 0mm/s }
//                                               ^^^^^ E0506 the speed of capture must be positive
