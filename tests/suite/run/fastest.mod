--- least time keeps pauses, and says what the judge says
module Hinge {
  link stand = box(40mm, 40mm, 40mm, mass: 1kg)
  link arm = box(10mm, 10mm, 100mm, mass: 100g) at [0mm, 0mm, 80mm]
  joint turn : stand -> arm = revolute(axis: Z, max_speed: 2rad/s, max_accel: 4rad/s^2)
}
config Turner { part hinge: Hinge }
let t = Turner()
let go = Sc(move(t.hinge.turn, to: 3rad, in: 10s), wait(1s), move(t.hinge.turn, to: 2rad, in: 10s))
let p = plan(go, world: world(ground: held, dynamics: statics))
let q = fastest(p)
print("{p.duration} {q.duration:.3} {(q ++ reverse(q)).duration:.3}", verify(q).ok, q.end.angle(t.hinge.turn) == 2rad)
//> 21s 4.000s 8.000s true true
// A straight way may be timed again.
print("{fastest(q).duration:.3}")
//> 4.000s
print(fastest(p, reserve: 1).duration)
//                        ^ E0506 from 0 to below 1

--- a joint without a greatest acceleration has no least time
module Hinge {
  link stand = box(40mm, 40mm, 40mm, mass: 1kg)
  link arm = box(10mm, 10mm, 100mm, mass: 100g) at [0mm, 0mm, 80mm]
  joint turn : stand -> arm = revolute(axis: Z, max_speed: 2rad/s)
}
config Turner { part hinge: Hinge }
let t = Turner()
let p = plan(move(t.hinge.turn, to: 1rad, in: 3s), world: world(ground: held, dynamics: statics))
print(fastest(p).duration)
//            ^ E0506 hinge.turn moves from 0ms on | state `max_accel`

--- a curve is timed once
module Wrist {
  link stand = box(40mm, 40mm, 40mm, mass: 1kg)
  link fore = box(10mm, 10mm, 100mm, mass: 100g) at [0mm, 0mm, 80mm]
  link hand = box(10mm, 10mm, 100mm, mass: 100g) at [0mm, 0mm, 190mm]
  joint a : stand -> fore = revolute(axis: Z, max_speed: 2rad/s, max_accel: 4rad/s^2)
  joint b : fore -> hand = revolute(axis: Z, max_speed: 2rad/s, max_accel: 4rad/s^2)
}
config Arm { part w: Wrist }
let w = Arm().w
let held = world(ground: held, dynamics: statics)
let p = fastest(plan(Pc(move(w.a, to: 1rad, in: 3s), move(w.b, to: 1rad, in: 5s)), world: held))
print(fastest(p).duration)
//            ^ E0506 a polynomial of degree 10 | retime the plan that it was made of

--- plans of lattices have no joints
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(8)
lattice Pole of ExpandingCube = column(8)
print(fastest(squeeze(Bar, Pole)).duration)
//            ^^^^^^^^^^^^^^^^^^ E0506 only plans of robots with joints
