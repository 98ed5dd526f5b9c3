// check E0402
use std.smores.Smores
config C { part m: Smores
  behavior b = spin(m.left, 6rad/s, for: 5s)
//                          ^^^^^^ faster than m.left can turn (its max_speed)
}
