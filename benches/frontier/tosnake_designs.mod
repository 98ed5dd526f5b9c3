//! The designs of the library of SMORES modules, of which none was planned when the aim was set.
use std.smores.{
  Driver1, Chain3, Steer3, Leg3, Body3, Arm, Puma4, Grasper7, Climber4, Ring12, Walk4, FourLeg17, Walker14, Walkbot17,
  Snake18, Car, Driver5, Tank7, RcCar8, Proboscis7, Scorpion6, Cross9, MobManip8, Backhoe, Driver5Puma4, TwoCars,
}
let designs = [
  Driver1(), Chain3(), Steer3(), Leg3(), Body3(), Arm(), Puma4(), Grasper7(), Climber4(), Ring12(), Walk4(), FourLeg17(),
  Walker14(), Walkbot17(), Snake18(), Car(), Driver5(), Tank7(), RcCar8(), Proboscis7(), Scorpion6(), Cross9(),
  MobManip8(), Backhoe(), Driver5Puma4(), TwoCars(),
]
let plans = [tosnake(design) for design in designs]
print("| designs of std.smores that unwind, of {len(designs)} | 0 | all | {len(plans)} | any genderless docks |")
print("| steps of these together | | | {sum([p.steps for p in plans])} | |")
