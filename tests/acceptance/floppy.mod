// check E0311
use std.truss.PneumaticReel
truss Square of PneumaticReel {
//    ^^^^^^ not rigid: rank 4 of 6; the free motions and the nodes they move
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [1m, 1m, 0m]
  node d = [0m, 1m, 0m]
  strut a -- b  strut b -- c  strut c -- d  strut d -- a
}
