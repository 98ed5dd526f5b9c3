// check E0303
use std.smores.Smores
config C { part m[2]: Smores
  connect m[0].top -- m[1].bottom turn 45deg
//                                     ^^^^^ this connector allows 0, 90, 180 and 270 degrees
}
