// run E0603
use std.smores.{Smores, Car}
config Backhoe { part car: Car  part arm[6]: Smores
  connect car.nose -- arm[0].bottom
  for i in 0..5 { connect arm[i].top -- arm[i + 1].bottom }
  set arm[0].tilt = 90deg
  behavior dig = move(arm[1].tilt, to: -90deg)
//               ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ the joint would have to hold more than its max_torque: how much, against which limit, when
}
emit(Backhoe().dig(), "dig.plan.json")
