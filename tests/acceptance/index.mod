// check E0501
use std.smores.Smores
config C { part m[3]: Smores
  for i in 0..4 { set m[i].tilt = 10deg }
//                    ^^^^ index 3, and m has 3 elements
}
