// check E0304
use std.smores.Smores
config Ring { part m[4]: Smores
  for i in 0..4 { connect m[i].left -- m[(i + 1) % 4].right }
//                        ^^^^^^^^^ closes a loop: m[0], m[1], m[2], m[3]; write `closed` after the name if it is meant
}
