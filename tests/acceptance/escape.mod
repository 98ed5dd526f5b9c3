// run E0701
use std.smores.Smores
config C { part m: Smores
  behavior b = move(m.tilt, to: 30deg)
}
emit(C().b(), "../../outside.plan.json")
//            ^^^^^^^^^^^^^^^^^^^^^^^^^ output stays in the output folder
