--- bonds that break are counted, noted at half the step, and against the verdict
connector Magnet { mates Magnet, turns 4, holds 0.6N*m }
module Arm {
  link foot = box(200mm, 200mm, 60mm, mass: 8kg)
  link rod = box(300mm, 30mm, 30mm, mass: 400g) at [150mm, 0mm, 60mm]
  joint lift : foot -> rod = revolute(
    axis: -Y,
    range: -10deg..100deg,
    max_speed: 360deg/s,
    max_accel: 3600deg/s^2,
    max_torque: 30N*m
  ) at [0mm, 0mm, 60mm]
  touching foot rod
  port tip : Magnet on rod at [150mm, 0mm, 0mm] facing +X up +Z
}
module Load {
  link cube = box(60mm, 60mm, 60mm, mass: 1kg)
  port side : Magnet on cube at [-30mm, 0mm, 0mm] facing -X up +Z
}
config Lifter {
  part arm: Arm
  part load: Load
  connect arm.tip -- load.side
  base arm
  behavior lift(t: Time) = move(arm.lift, to: 60deg, in: t)
}
fn says(text: Text, words: Text) = len(split(text, on: words)) > 1
let x = Lifter()
// As it is the load is 0.998 of what the magnet holds, so that every mass that is greater breaks it: about a half of them.
let runs = simulate(x.lift(460ms), runs: 20, mass_spread: 0.3, seed: 1)
print(runs.failures, runs.breaks > 4 and runs.breaks < 16, runs.fails == runs.breaks, runs.misses, runs.stops)
//> [] true true 0 0
print(says(runs.notes[1], "of 20 runs fail, first at mass x 1.0"), says(runs.notes[1], "with a bond that breaks"))
//> true true
// The mildest mass is one that is greater by little; those that are less break nothing.
let light = simulate(x.lift(900ms), runs: 5, mass_spread: 0.3, seed: 1)
print(light.notes[1])
//> none of 5 runs fails
// By the judge it holds, by little.
let near = simulate(x.lift(450ms))
print(verify(x.lift(450ms)).ok, len(near.failures), near.notes[1])
//> true 2 the verdict on the plan says otherwise: it does not fall, its bonds hold
// At half the step it breaks, and not at the whole one: its load differs in the fifth digit.
let edge = simulate(x.lift(459180us))
print(edge.failures, says(edge.notes[0], ", and arm.tip -- load.side breaks"))
//> [] true

--- programs that are aborted are counted
use std.smores.Chain3
let c = Chain3()
let feel = Sc(
  move(c.m[2].tilt, to: 80deg, in: 2s),
  move(c.m[2].tilt, to: 40deg, in: 1s, until: torque(c.m[2].tilt) > 100N*m, timeout: 2s) else abort("no ground"),
  move(c.m[2].tilt, by: 0deg),
)
let s = simulate(feel, runs: 3, friction_spread: 0.5)
print(s.stops, s.fails, s.falls, s.breaks)
//> 3 3 0 0
print(s.notes[2])
//> 3 of 3 runs fail, as it does as planned: 3 with a program that is stopped

--- spreads and runs that say nothing are noted
use std.smores.Driver1
let d = plan(Driver1().drive(t: 200ms))
print(simulate(d, friction_spread: 0.3).notes[1])
//> without `runs` nothing is drawn from a spread
print(simulate(d, runs: 2).notes[1])
//> without a spread all runs are alike

--- a rotor that is assumed too heavy for its motor is named
module Turret(k: Quantity<N*m/rad>) {
  link foot = box(200mm, 200mm, 40mm, mass: 5kg)
  link bar = box(300mm, 20mm, 20mm, mass: 1kg) at [0mm, 0mm, 60mm]
  joint swing : foot -> bar =
    revolute(axis: Z, max_speed: 1rad/s, max_accel: 8rad/s^2, max_torque: 5N*m, stiffness: k) at [0mm, 0mm, 40mm]
}
config Swings(k: Quantity<N*m/rad>) {
  part t: Turret(k: k)
  base t
  behavior swing = move(t.swing, to: 1rad)
}
print(len(simulate(Swings(150N*m/rad).swing()).notes))
//> 1
// 2e-3 / 150 s² of 1.5e6 N·m/rad; a quintic of 1 rad whose speed is 1 rad/s takes 1.875 s, with 10 / √3 / 1.875² rad/s².
print(simulate(Swings(1.5e6N*m/rad).swing()).notes[2])
//> the rotor that is assumed of `t.swing`, 20kg*m^2 for its stiffness, takes 32.8N*m to accelerate as planned, and the motor has 5N*m: state `armature`
