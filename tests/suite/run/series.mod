--- the torque of a held arm is that of its weight: m g l cos
module Arm {
  mass 12kg
  link base = box(100mm, 100mm, 20mm, mass: 10kg)
  link arm = box(1m, 10mm, 10mm, mass: 2kg) at [500mm, 0mm, 50mm]
  joint bend : base -> arm = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 20N*m) at [0mm, 0mm, 50mm]
}
let a = Arm()
let p = plan(move(a.bend, to: -60deg, in: 2s), world: world(ground: held))
let held = p.series(torque(a.bend), step: 50ms)
let weight = [2kg * 9.80665m/s^2 * 500mm * cos(t) for t in p.series(angle(a.bend), step: 50ms)]
print(len(held), all([abs(held[i] + weight[i]) < 1e-9N*m for i in 0..len(held)]))
//> 41 true
print(abs(1 - verify(p).torque_margin + min(held) / (20N * 1m)) < 1e-9)
//> true
// The sine of a turn about +Y lifts what lies along +X down, so the motor pulls it up, in the negative direction.
print(held[0] < 0N*m, first([s.contacts() for s in p.states(step: 1s)]))
//> true []

--- times are even, no further apart than the step, and the ends belong to them
use std.smores.Chain3
let c = Chain3()
let p = plan(move(c.m[1].tilt, to: 30deg, in: 1s))
print(p.times(step: 300ms), p.times(step: 250ms), p.times(step: 2s))
//> [0ms, 250ms, 500ms, 750ms, 1s] [0ms, 250ms, 500ms, 750ms, 1s] [0ms, 1s]
print(p.series(elapsed(), step: 500ms) == p.times(step: 500ms), [s.time for s in p.states(step: 500ms)])
//> true [0ms, 500ms, 1s]
print(len(p.times()))
//> 101

--- what series say is what states say
use std.smores.Chain3
let c = Chain3()
let p = plan(move(c.m[1].tilt, to: 30deg, in: 1s))
let all_states = p.states(step: 250ms)
let j = c.m[1].tilt
print([x.angle(j) for x in all_states] == p.series(angle(j), step: 250ms), [x.speed(j) for x in all_states] == p.series(speed(j), step: 250ms))
//> true true
print([x.torque(j) for x in all_states] == p.series(torque(j), step: 250ms), [x.margin for x in all_states] == p.series(margin(), step: 250ms))
//> true true
print([x.ground_force(c.m[0]) for x in all_states] == p.series(ground_force(c.m[0]), step: 250ms), [x.clearance for x in all_states] == p.series(clearance(), step: 250ms))
//> true true
let apart = p.series(separation(c.tail, c.head), step: 250ms)
print(all([abs(norm(position(all_states[i].pose(c.tail)) - position(all_states[i].pose(c.head))) - apart[i]) < 1nm for i in 0..5]))
//> true
print([x.angle(j) for x in all_states] == [p.at(t).angle(j) for t in p.times(step: 250ms)])
//> true
// The slope of the angle, by differences.
let fine = p.series(angle(j), step: 1ms)
let rates = p.series(speed(j), step: 1ms)
print(all([abs((fine[i + 1] - fine[i - 1]) / 2ms - rates[i]) < 0.001rad/s for i in 1..1000]))
//> true

--- the forces of the ground carry the weight and balance about the centre of mass
use std.smores.{Car, Smores}
let w = Car()
let p = plan(w.drive(t: 1s))
let states = p.states(step: 400ms)
let weight = mass(w) * 9.80665m/s^2
fn on_ground(s: State) -> List<Contact> = s.contacts() else []
print([abs(sum([f.force.z for f in on_ground(s)]) - weight) < 1e-6N for s in states])
//> [true, true, true, true]
print([abs(sum([(f.point.y - s.com.y) * f.force.z for f in on_ground(s)])) < 0.001N*m for s in states])
//> [true, true, true, true]
fn feet(s: State) -> Force = sum([s.ground_force(m) else 0N for m in modules(w, Smores)])
print([abs(feet(s) - weight) < 1e-6N for s in states])
//> [true, true, true, true]
let r = verify(p)
print(abs(min(p.series(margin())) - r.margin) < 0.1mm, abs(min(p.series(clearance(), step: 100ms)) - r.clearance) < 0.1mm)
//> true true

--- what the judge does not look at is no zero
use std.smores.Chain3
let c = Chain3()
let free = plan(move(c.m[1].tilt, to: 30deg, in: 1s), world: world(ground: off, gravity: off))
print([s.margin for s in free.states(step: 1s)], [s.torque(c.m[0].tilt) for s in free.states(step: 1s)])
//> [_, _] [_, _]
print([s.ground_force(c) for s in free.states(step: 1s)], [s.contacts() for s in free.states(step: 1s)])
//> [_, _] [_, _]
print(free.series(torque(c.m[1].tilt), step: 1s))
//                ^^^^^^^^^^^^^^^^^^^ E0506 at 0ms the judge knows no load: nothing is weighed without gravity and a ground | states

--- a margin without ground
use std.smores.Chain3
let c = Chain3()
let fast = plan(move(c.m[1].tilt, to: 5deg), world: world(ground: held))
print(fast.series(margin()))
//                ^^^^^^^^ E0506 what is held fast does not stand

--- forces of the ground without gravity
use std.smores.Chain3
let c = Chain3()
let free = plan(move(c.m[1].tilt, to: 30deg, in: 1s), world: world(ground: off))
print(free.series(ground_force(c.m[0])))
//                ^^^^^^^^^^^^^^^^^^^^ E0506 nothing is weighed

--- a clearance of what can't meet itself
module Lone {
  mass 1kg
  link base = box(1m, 1m, 20mm)
  link top = box(100mm, 100mm, 100mm) at [0mm, 0mm, 70mm]
  joint turn : base -> top = revolute(axis: Z, max_speed: 1rad/s)
}
let l = Lone()
let p = plan(move(l.turn, to: 90deg))
print([s.clearance for s in p.states(step: 10s)])
//> [_, _]
print(p.series(clearance()))
//             ^^^^^^^^^^^ E0506 no two links are there that may not touch

--- a lattice has no joints
use std.crystal.ExpandingCube
lattice A of ExpandingCube = row(4)
lattice B of ExpandingCube = block(2, 2)
print(len(squeeze(A, B).times(step: 1s)) > 1)
//> true
print(squeeze(A, B).states())
//    ^^^^^^^^^^^^^ E0506 no joints

--- the joint of another robot
use std.smores.{Chain3, Car}
let p = plan(Car().drive(t: 1s))
print(p.series(angle(Chain3().m[0].tilt)))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0406

--- a step that is none, and one that is too small
use std.smores.Car
let p = plan(Car().drive(t: 1s))
print(p.times(step: 0s))
//                  ^^ E0506 must be positive

--- a step that is too small
use std.smores.Car
let p = plan(Car().drive(t: 1s))
print(p.series(elapsed(), step: 1nm / (1m/s)))
//                              ^^^^^^^^^^^^ E0505 more than 1000000 elements

--- nothing can wait for what no robot senses
use std.smores.Chain3
config Lift {
  part c: Chain3
  behavior up = move(c.m[1].tilt, to: 30deg, until: torque(c.m[1].tilt) > 0.1N*m)
//                                                  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0405 no robot senses this | conditions sense `angle`
}
print(plan(Lift().up()).duration)
//         ~~~~~~~~~~~ `up`

--- a signal of a number
use std.smores.Car
print(plan(Car().drive(t: 1s)).series(3))
//                                    ^ E0202
