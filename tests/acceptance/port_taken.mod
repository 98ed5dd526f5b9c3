// check E0301
use std.smores.Smores
config C { part m[3]: Smores
  connect m[0].top -- m[1].bottom
//        ^^^^^^^^ taken here
  connect m[0].top -- m[2].bottom
//        ^^^^^^^^ this port is taken
}
