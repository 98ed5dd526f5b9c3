// check E0201
use std.smores.Smores
config C { part m: Smores
  behavior b = spin(m.left, 30deg, for: 5s)
//                          ^^^^^ an angular speed is wanted, this is an angle; 30deg/s?
}
