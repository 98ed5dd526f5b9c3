// run E0602
use std.smores.{Smores, Car}
config Backhoe { part car: Car  part arm[8]: Smores
  connect car.nose -- arm[0].bottom
  for i in 0..7 { connect arm[i].top -- arm[i + 1].bottom }
  set arm[0].tilt = 90deg
  behavior dig allows overload = move(arm[1].tilt, to: -90deg)
//                               ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ during this motion the centre of mass leaves the support polygon: when, by how much, over which edge
}
emit(Backhoe().dig(), "dig.plan.json")
