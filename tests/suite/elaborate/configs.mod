--- a port is free or taken
use std.smores.Smores
config C { part m[3]: Smores
  connect m[0].top -- m[1].bottom
//        ~~~~~~~~ connected to m[1].bottom
  connect m[0].top -- m[2].bottom
//        ^^^^^^^^ E0301 m[0].top is taken | free ports of m[0]
}

--- parts that nothing connects
use std.smores.Smores
config C { part a: Smores  part b: Smores }
//                              ^ E0305 nothing connects b with a

--- a loop that is meant and one that isn't
use std.smores.Smores
config Ring { part m[4]: Smores
  for i in 0..4 { connect m[i].left -- m[(i + 1) % 4].right }
//                        ^^^^^^^^^ E0304 m[0], m[1], m[2], m[3] | `closed`
//                                     ~~~~~~~~~~~~~~~~~~~~ the other end
}

--- a loop that does not meet
use std.smores.Smores
config Ring closed { part m[4]: Smores
//          ~~~~~~ declared closed
  for i in 0..4 { connect m[i].top -- m[(i + 1) % 4].bottom }
//                ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0306 does not meet
}

--- initial positions within the range
use std.smores.Smores
config C { part m: Smores
  set m.tilt = 120deg
//             ^^^^^^ E0309 its range is -90deg to 90deg
}

--- requirements
use std.smores.Body3
config Narrow { part b: Body3
  require distance(b.side[0], b.side[1]) > 500mm, "the legs would meet"
//        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0308 the legs would meet
}

--- a configuration in itself
config A { part b: A }
//     ~ declared here
//                 ^ E0108 a part of itself

--- commands that contradict each other, and that repeat each other
use std.smores.Smores
config C { part m: Smores
  behavior wrong = Pc(move(m.tilt, to: 30deg), spin(m.left, 1rad/s, for: 1s), move(m.tilt, to: 20deg))
//                    ^^^^^^^^^^^^^^^^^^^^^^^ E0401 two commands to m.tilt
//                                                                            ~~~~~~~~~~~~~~~~~~~~~~~ in parallel
  behavior twice = Pc(move(m.tilt, to: 30deg), move(m.tilt, to: 30deg))
//                    ^^^^^^^^^^^^^^^^^^^^^^^ W0003 the same command
//                                             ~~~~~~~~~~~~~~~~~~~~~~~ in parallel
}

--- joints of connections
use std.mori.Mori
use std.smores.Smores
config Strip { part m[3]: Mori
  for i in 0..2 { connect m[i].edge[1] -- m[i + 1].edge[0] }
  set m[1].edge[0].joint = 20deg
  set m[2].edge[0].joint = 200deg
//                         ^^^^^^ E0309 its range is -120deg to 120deg
  set m[2].edge[1].joint = 10deg
//    ^^^^^^^^^^^^^^^^^^ E0315 no joint at m[2].edge[1] | nothing is connected
}
config Stiff { part m[2]: Smores
  connect m[0].top -- m[1].bottom
  behavior a() = move(m[0].top.joint, to: 10deg)
//                    ^^^^^^^^^^^^^^ E0315 connections of MagnetFace do not turn
}

--- the character of a lattice that is no cell
use std.crystal.ExpandingCube
lattice A of ExpandingCube = cells("##\n#x#")
//                                       ^ E0313 `x` is no cell

--- what mates with a connector, and which ports have one
connector Plug { mates Socket, turns 1 }
connector Socket { mates Plug, turns 1 }
module Block {
  mass 100g
  link body = box(40mm, 40mm, 40mm)
  port a: Plug on body at [20mm, 0mm, 0mm] facing +X up +Z
  port b: Socket on body at [-20mm, 0mm, 0mm] facing -X up +Z
}
module End {
  mass 100g
  link body = box(40mm, 40mm, 40mm)
  port only: Plug on body at [20mm, 0mm, 0mm] facing +X up +Z
}
config Two { part x: Block  part y: End
  connect x.a -- y.only
//        ^^^ E0302 a Plug does not mate with a Plug | a Plug mates with a Socket; free ports of x that have one: b | y has no free port with one
//               ~~~~~~ a Plug
}
