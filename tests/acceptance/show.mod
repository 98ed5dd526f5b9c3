// run E0508
use std.smores.Smores
config C { part m: Smores
  behavior b = move(m.tilt, to: 30deg)
}
show(C().b(), "c.html")
// `show` is not there yet, and nothing was done in its place.
