// check E0309
use std.smores.Smores
config C { part m: Smores
  behavior b = move(m.tilt, to: 120deg)
//                              ^^^^^^ m.tilt turns from -90 to 90 degrees
}
