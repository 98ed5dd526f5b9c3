// check E0107
use std.smores.Smores
config C { part m: Smores
  behavior b = move(m.titl, to: 30deg)
//                    ^^^^ no joint, port or part `titl` in Smores; `tilt`?
}
