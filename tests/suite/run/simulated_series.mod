--- joints, places and torques as they were measured
module Lever {
  link stand = box(100mm, 100mm, 40mm, mass: 5kg)
  link arm = box(200mm, 20mm, 20mm, mass: 900g) at [150mm, 0mm, 60mm]
  joint lift : stand -> arm =
    revolute(axis: Y, range: -30deg..30deg, max_torque: 1N*m, max_speed: 1rad/s, stiffness: 100N*m/rad) at [50mm, 0mm, 60mm]
}
config Lifts { part m: Lever  behavior lift = move(m.lift, to: -20deg, in: 1s) }
let l = Lifts()
let p = plan(l.lift(), world: world(ground: held))
let sim = simulate(p)
let angles = sim.series(angle(l.m.lift))
print(len(angles) == len(sim.times), len(angles) == len(sim.path), sim.times[0], sim.times[50])
//> true true 0ms 1s
// The servo yields by its torque over its stiffness: half a degree as the arm lies level, less at the end.
let planned = p.series(angle(l.m.lift), step: 20ms)
let lags = [abs(angles[i] - planned[i]) for i in 0..51]
print("{lags[0]:.2} {max(lags) <= sim.lag + 0.01deg} {angles[len(angles) - 1]:.1}")
//> 0.51deg true -19.5deg
// 0.9 kg at 0.1 m weigh 0.883 N·m, and 0.829 at 20 degrees.
let torques = sim.series(torque(l.m.lift))
print("{abs(torques[0]):.3} {abs(torques[len(torques) - 1]):.3}")
//> 0.883N*m 0.832N*m
print(max(sim.series(tilt(l.m))), sim.series(position(pose(l.m)))[7] == sim.path[7])
//> 0deg true
print(sim.series(speed(l.m.lift)))
//               ^^^^^^^^^^^^^^^ E0506 a simulation keeps no speeds

--- where a crate is that was pushed
module Pusher {
  link rail = box(300mm, 40mm, 40mm, mass: 5kg)
  link cart = box(60mm, 60mm, 60mm, mass: 1kg) at [200mm, 0mm, 20mm]
  joint slide : rail -> cart = prismatic(axis: X, range: 0mm..200mm, max_speed: 100mm/s, max_force: 100N)
  touching rail cart
}
module Crate { link body = box(100mm, 100mm, 100mm, mass: 300g, friction: 0.3) }
config Pushes { part p: Pusher  base p  behavior push = move(p.slide, by: 100mm, in: 2s) }
config Lies { part c: Crate }
scene Two {
  part a: Pushes
  part b: Lies at [300mm, 0mm, 0mm]
}
let t = Two()
let sim = simulate(plan(t.a.push(), world: world(ground: fixed)))
// The cart goes 100 mm, and meets the crate after 20.
let places = sim.series(position(pose(t.b.c)))
print("{places[len(places) - 1].x - places[0].x in mm:.0}", sim.fell)
//> 80mm false

--- what a module states as `std.servos` has it is what is assumed of one that does not
use std.servos.{armature, contact_stiffness, damping, friction, sliding_stiffness, stiffness, usual_stiffness}
let k = stiffness(5N*m)
let slide = sliding_stiffness(40N)
module Plain {
  link foot = box(200mm, 200mm, 40mm, mass: 5kg)
  link bar = box(300mm, 20mm, 20mm, mass: 1kg) at [0mm, 0mm, 60mm]
  link tip = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, 100mm]
  link rod = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, 140mm]
  joint swing : foot -> bar = revolute(axis: Z, max_speed: 3rad/s, max_accel: 30rad/s^2, max_torque: 5N*m) at [0mm, 0mm, 40mm]
  joint turn : bar -> tip = revolute(axis: Z, max_speed: 3rad/s, max_accel: 30rad/s^2) at [0mm, 0mm, 80mm]
  joint rise : tip -> rod = prismatic(axis: Z, range: 0mm..50mm, max_speed: 1m/s, max_accel: 9m/s^2, max_force: 40N)
}
module Stated {
  link foot =
    box(200mm, 200mm, 40mm, mass: 5kg, friction: friction, static_friction: friction, contact_stiffness: contact_stiffness)
  link bar = box(300mm, 20mm, 20mm, mass: 1kg) at [0mm, 0mm, 60mm]
  link tip = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, 100mm]
  link rod = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, 140mm]
  joint swing : foot -> bar = revolute(
    axis: Z,
    max_speed: 3rad/s,
    max_accel: 30rad/s^2,
    max_torque: 5N*m,
    stiffness: k,
    damping: damping(k),
    armature: armature(k)
  ) at [0mm, 0mm, 40mm]
  joint turn : bar -> tip = revolute(
    axis: Z,
    max_speed: 3rad/s,
    max_accel: 30rad/s^2,
    stiffness: usual_stiffness,
    damping: damping(usual_stiffness),
    armature: armature(usual_stiffness)
  ) at [0mm, 0mm, 80mm]
  joint rise : tip -> rod = prismatic(
    axis: Z,
    range: 0mm..50mm,
    max_speed: 1m/s,
    max_accel: 9m/s^2,
    max_force: 40N,
    stiffness: slide
  )
}
config One { part t: Plain  base t  behavior go = Sc(move(t.swing, to: 1rad), move(t.turn, to: 1rad), move(t.rise, to: 40mm)) }
config Other { part t: Stated  base t  behavior go = Sc(move(t.swing, to: 1rad), move(t.turn, to: 1rad), move(t.rise, to: 40mm)) }
let a = simulate(One().go(), friction: 0.02)
let b = simulate(Other().go(), friction: 0.02)
fn turns(x: List<Angle>, y: List<Angle>) -> Angle = max([abs(x[i] - y[i]) for i in 0..len(x)])
fn rises(x: List<Length>, y: List<Length>) -> Length = max([abs(x[i] - y[i]) for i in 0..len(x)])
print(turns(a.series(angle(One().t.swing)), b.series(angle(Other().t.swing))) < 1e-9deg)
//> true
print(turns(a.series(angle(One().t.turn)), b.series(angle(Other().t.turn))) < 1e-9deg)
//> true
print(rises(a.series(displacement(One().t.rise)), b.series(displacement(Other().t.rise))) < 1e-9mm)
//> true
print(a.slip > 1mm, abs(a.slip - b.slip) < 1e-6mm)
//> true true
