// check E0401
use std.smores.Smores
config C { part m: Smores
  behavior b = Pc(
    Sc(wait(1s), move(m.tilt, to: 30deg)),
//               ^^^^^^^^^^^^^^^^^^^^^^^ commands m.tilt
    move(m.tilt, to: -30deg),
//  ^^^^^^^^^^^^^^^^^^^^^^^^ and so does this, in parallel
  )
}
