--- the torque of a held arm is that of its weight: m g l cos
module Arm {
  mass 12kg
  link base = box(100mm, 100mm, 20mm, mass: 10kg)
  link arm = box(1m, 10mm, 10mm, mass: 2kg) at [500mm, 0mm, 50mm]
  joint bend : base -> arm = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 20N*m) at [0mm, 0mm, 50mm]
}
let a = Arm()
let p = plan(move(a.bend, to: -60deg, in: 2s), world: world(ground: held, dynamics: statics))
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
let p = plan(w.drive(t: 1s), world: world(dynamics: statics))
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
let free = plan(move(c.m[1].tilt, to: 30deg, in: 1s), world: world(ground: off, gravity: off, dynamics: statics))
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
let free = plan(move(c.m[1].tilt, to: 30deg, in: 1s), world: world(ground: off, dynamics: statics))
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
  behavior up = move(c.m[1].tilt, to: 30deg, until: clearance() > 1mm)
//                                                  ^^^^^^^^^^^^^^^^^ E0405 no robot senses this | conditions sense `angle`
}
print(plan(Lift().up()).duration)
//         ~~~~~~~~~~~ `up`

--- a signal of a number
use std.smores.Car
print(plan(Car().drive(t: 1s)).series(3))
//                                    ^ E0202

--- poses over time are those of the arm's closed form
connector Flange {}
module Arm {
  mass 12kg
  link base = box(100mm, 100mm, 20mm, mass: 10kg)
  link arm = box(1m, 10mm, 10mm, mass: 2kg) at [500mm, 0mm, 50mm]
  joint bend : base -> arm = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 20N*m) at [0mm, 0mm, 50mm]
  port tip : Flange on arm at [500mm, 0mm, 0mm] facing X
}
let a = Arm()
let p = plan(move(a.bend, to: -60deg, in: 2s), world: world(ground: held))
let angles = p.series(angle(a.bend), step: 50ms)
let tips = p.series(position(pose(a.tip)), step: 50ms)
let bodies = p.series(position(pose(a)), step: 50ms)
// A turn about +Y takes the tip down, so the negative one lifts it.
fn off(i: Int) -> Length = norm(tips[i] - bodies[i] - [1m * cos(angles[i]), 0m, 50mm - 1m * sin(angles[i])])
print(len(tips), max([off(i) for i in 0..41]) < 0.001nm)
//> 41 true
print(p.series(pose(a.tip), step: 50ms) == [x.pose(a.tip) for x in p.states(step: 50ms)])
//> true
print([position(at) for at in p.series(pose(a.tip), step: 50ms)] == tips)
//> true
let over_time: Signal<Pose> = pose(a.tip)
let at_start = pose
print(p.series(over_time, step: 50ms) == p.series(pose(a.tip), step: 50ms), at_start(a.tip) == pose(a.tip))
//> true true

--- the pose of what drives away is where the judge sees it
use std.smores.Tank7
let car = Tank7()
let p = plan(car.drive(t: 2s))
let way = p.series(position(pose(car.nose)), step: 500ms)
print(norm(way[len(way) - 1] - way[0] - verify(p).displacement) < 1um, norm(verify(p).displacement) > 50mm)
//> true true

--- what slides has a displacement, a speed and a force
module Lift {
  mass 3kg
  link base = box(300mm, 300mm, 40mm, mass: 2kg)
  link table = box(100mm, 100mm, 20mm, mass: 1kg) at [0mm, 0mm, 60mm]
  joint up : base -> table = prismatic(axis: Z, range: 0mm..80mm, max_speed: 1m/s, max_force: 20N)
}
let lift = Lift()
let p = plan(move(lift.up, to: 80mm, in: 1s, profile: linear), world: world(dynamics: statics))
print(p.series(displacement(lift.up), step: 250ms), p.series(speed(lift.up), step: 500ms)[1])
//> [0mm, 20mm, 40mm, 60mm, 80mm] 80mm/s
print(all([abs(f - 1kg * 9.80665m/s^2) < 1e-9N for f in p.series(force(lift.up), step: 100ms)]))
//> true
print([x.displacement(lift.up) for x in p.states(step: 500ms)], p.at(500ms).speed(lift.up))
//> [0mm, 40mm, 80mm] 80mm/s
print([x.force(lift.up) for x in p.states(step: 100ms)] == p.series(force(lift.up), step: 100ms))
//> true
// A condition waits for it, too: half of the way takes half of the time.
let there = move(lift.up, to: 80mm, in: 1s, profile: linear, until: displacement(lift.up) > 40mm)
print(abs(plan(Sc(there, move(lift.up, to: 0mm, in: 1s))).duration - 1.5s) < 1ms)
//> true

--- a signal of the wrong kind of joint names the right one
module Both {
  mass 2kg
  link rail = box(300mm, 40mm, 40mm)
  link cart = box(60mm, 60mm, 20mm) at [0mm, 0mm, 30mm]
  link arm = box(20mm, 20mm, 100mm) at [0mm, 0mm, 100mm]
  joint slide : rail -> cart = prismatic(axis: X, range: -80mm..80mm, max_speed: 50mm/s)
  joint turn : cart -> arm = revolute(axis: Z, max_speed: 1rad/s)
}
let b = Both()
let p = plan(move(b.slide, to: 50mm))
print(p.series(angle(b.slide)))
//                   ^^^^^^^ E0202 wants a `Joint<Angle>` | this joint slides: `displacement`
print(p.series(torque(b.slide)))
//                    ^^^^^^^ E0202 wants a `Joint<Angle>` | this joint slides: `force`
print(p.series(displacement(b.turn)))
//                          ^^^^^^ E0202 wants a `Joint<Length>` | this joint turns: `angle`
print(p.end.force(b.turn))
//                ^^^^^^ E0202 wants a `Joint<Length>` | this joint turns: `torque`
print(spin(b.slide, 1rad/s))
//         ^^^^^^^ E0202 wants a `Joint<Angle>` | this joint slides: `move`
print(wait(1s, until: speed(b.slide) > 3rad/s))
//                                   ^ E0207

--- a pose that is known already is no signal
use std.smores.Chain3
let c = Chain3()
let p = plan(move(c.m[1].tilt, to: 30deg, in: 1s))
let head = pose(c.head)
print(p.series(head))
//             ^^^^ E0202 this is a `Pose` | `series(pose(port))`
print(p.series(position(head)))
//                      ^^^^ E0202 `pose` wants a `Signal<Pose>`
print(wait(1s, until: pose(c.head) > 3mm))
//                                 ^ E0207

--- the pose of another robot
use std.smores.{Chain3, Car}
let p = plan(Car().drive(t: 1s))
print(p.series(pose(Chain3().head)))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0406
