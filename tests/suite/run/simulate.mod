--- a motor that is too weak lets its arm down to the end of its range
module Lever(weight: Mass) {
  link stand = box(100mm, 100mm, 40mm, mass: 5kg)
  link arm = box(200mm, 20mm, 20mm, mass: weight) at [150mm, 0mm, 60mm]
  joint lift : stand -> arm =
    revolute(axis: Y, range: -30deg..30deg, max_torque: 1N*m, stiffness: 100N*m/rad) at [50mm, 0mm, 60mm]
}
config Holding(weight: Mass) { part m: Lever(weight: weight)  behavior hold = wait(1s) }
let light = simulate(plan(Holding(weight: 900g).hold(), world: world(ground: held)))
let heavy = simulate(plan(Holding(weight: 1.2kg).hold(), world: world(ground: held)))
// The torque is m g l: 0.9 kg at 0.1 m need 0.883 N·m, and the servo yields by 0.883/100 rad, 0.51 degrees.
print("{light.torque:.3} {light.lag:.2} {light.saturated}", len(light.notes))
//> 0.883 0.51deg 0ms 1
print("{heavy.torque:.3} {heavy.lag:.0}", heavy.saturated > 1s)
//> 1.000 30deg true
print(heavy.notes[1])
//> the verdict on the plan is that it fails

--- a bond breaks under more than it holds
connector Hook { mates Hook, turns 4, holds 15N }
module Block(weight: Mass) {
  link body = box(50mm, 50mm, 50mm, mass: weight)
  port top : Hook on body at [0mm, 0mm, 25mm] facing +Z up +X
  port bottom : Hook on body at [0mm, 0mm, -25mm] facing -Z up +X
}
config Hanging(weight: Mass) {
  part a: Block(weight: 1kg)
  part b: Block(weight: weight)
  connect a.bottom -- b.top
  base a
  behavior hang = wait(1s)
}
let held = world(ground: held)
// 15 N carry 1.5296 kg.
let below = simulate(plan(Hanging(weight: 1.52kg).hang(), world: held))
let above = simulate(plan(Hanging(weight: 1.54kg).hang(), world: held))
print("{below.bond_load:.4}", len(below.failures), below.fell)
//> 0.9937 0 false
print(above.failures[0], above.fell)
//> at 0ms: a.bottom -- b.top breaks, at 1.01 of what it holds true
// What came off falls freely, and so reaches 0.5 m/s after 51 ms; that is looked for every 2 ms.
let at = above.fell_at else 0s
print(at > 51ms and at < 56ms)
//> true

--- a bond carries what hangs on the port that will undock below it
connector Hook { mates Hook, turns 4, holds 15N }
module Block {
  link body = box(50mm, 50mm, 50mm, mass: 500g)
  port top : Hook on body at [0mm, 0mm, 25mm] facing +Z up +X
  port bottom : Hook on body at [0mm, 0mm, -25mm] facing -Z up +X
}
config Hanging {
  part m[3]: Block
  for i in 0..2 { connect m[i].bottom -- m[i + 1].top }
  base m[0]
  behavior drop = Sc(wait(500ms), undock(m[1].bottom))
}
let s = simulate(plan(Hanging().drop(), world: world(ground: held)))
// Two blocks of 0.5 kg weigh 9.807 N, 0.6538 of 15 N.
print("{s.bond_load:.3}")
//> 0.654

--- a bond holds what the weaker of its connectors does
connector Hook { mates Eye, turns 4, holds 30N }
connector Eye { mates Hook, turns 4, holds 15N }
module Block {
  link body = box(50mm, 50mm, 50mm, mass: 1kg)
  port top : Eye on body at [0mm, 0mm, 25mm] facing +Z up +X
  port bottom : Hook on body at [0mm, 0mm, -25mm] facing -Z up +X
}
config Hanging {
  part m[2]: Block
  connect m[0].bottom -- m[1].top
  base m[0]
  behavior hang = wait(500ms)
}
let s = simulate(plan(Hanging().hang(), world: world(ground: held)))
// A block of 1 kg weighs 9.807 N, 0.6538 of 15 N.
print("{s.bond_load:.3}")
//> 0.654

--- ports dock as far from a perfect mate as the arm sags
connector Hook { mates Hook, turns 4, capture 5mm 5deg }
module Crane {
  link post = box(40mm, 40mm, 40mm, mass: 2kg)
  link lift = box(40mm, 40mm, 40mm, mass: 500g) at [0mm, 0mm, -300mm]
  joint slide : post -> lift = prismatic(axis: Z, stiffness: 1225.83N/m)
  port hook : Hook on lift at [0mm, 0mm, -20mm] facing -Z up +X
  port holder : Hook on post at [500mm, 0mm, 0mm] facing +X up +Z
}
module Load {
  link body = box(40mm, 40mm, 40mm, mass: 1kg) at [300mm, 0mm, 0mm]
  port held : Hook on body at [-100mm, 0mm, 0mm] facing -X up +Z
  port eye : Hook on body at [-600mm, 0mm, -320mm] facing +Z up +X
}
config Lifts closed {
  part c: Crane
  part l: Load
  connect c.holder -- l.held
  connect c.hook -- l.eye
  base c
  behavior docks = Sc(undock(c.hook), move(c.slide, by: 50mm, in: 500ms), move(c.slide, by: -50mm, in: 500ms), wait(1s), dock(c.hook, l.eye), wait(1s))
}
let s = simulate(plan(Lifts().docks(), world: world(ground: held)))
// 0.5 kg at 1225.83 N/m sag by 4.00 mm.
print(s.dock_error > 3.95mm and s.dock_error < 4.05mm, s.dock_angle < 0.01deg, s.misses, s.failures)
//> true true 0 []

--- arguments out of range
use std.smores.Driver1
let d = plan(Driver1().drive(t: 100ms))
print(simulate(d, step: 0s))
//                      ^^ E0506 must be positive
print(simulate(d, step: 1s))
//                      ^^ E0506 from 1us to 5ms
print(simulate(d, friction: -1))
//                          ^^ E0506 must not be negative
print(simulate(d, runs: -1))
//                      ^^ E0506 must not be negative
print(simulate(d, runs: 1000000))
//                      ^^^^^^^ E0506 at most 100000 runs
print(simulate(d, runs: 1, mass_spread: 1))
//                                      ^ E0506 from 0 to below 1
print(simulate(d, stiffness: 0N*m/rad))
//                           ^^^^^^^^ E0506 must be positive

--- lattices are refused by name
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(8)
lattice Pole of ExpandingCube = column(8)
print(simulate(squeeze(Bar, Pole)))
//             ^^^^^^^^^^^^^^^^^^ E0506 only robots with joints are simulated

--- the same runs for the same seed, and others for another
use std.smores.Driver1
let d = plan(Driver1().drive(t: 300ms))
let a = simulate(d, runs: 3, seed: 5, friction_spread: 0.5, stiffness_spread: 0.5)
let b = simulate(d, runs: 3, seed: 5, friction_spread: 0.5, stiffness_spread: 0.5)
let c = simulate(d, runs: 3, seed: 6, friction_spread: 0.5, stiffness_spread: 0.5)
print(a.travels == b.travels, a.travels == c.travels, len(a.travels), a.falls)
//> true false 3 0

--- a program with sensors goes on when the cube touches, and its plan when the time is out
connector Hook { mates Hook, turns 4 }
module Arm {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link rod = box(160mm, 10mm, 10mm, mass: 200g) at [120mm, 0mm, 0mm]
  joint lift : post -> rod = revolute(axis: -Y, stiffness: 2000N*m/rad)
  port end : Hook on rod at [80mm, 0mm, 0mm] facing +X up +Z
}
module Tip {
  link cube = box(20mm, 20mm, 20mm, mass: 500g)
  port back : Hook on cube at [-10mm, 0mm, 0mm] facing -X up +Z
}
config Reach {
  part a: Arm
  part t: Tip
  set a.lift = 20deg
  connect a.end -- t.back
  base a
  behavior feels = Sc(
    move(a.lift, to: -20deg, in: 4s, profile: linear, until: touching(t), timeout: 5s) else abort("nothing there"),
    move(a.lift, by: 0deg),
  )
  behavior counts = repeat(move(a.lift, by: 5deg, in: 100ms), until: angle(a.lift) > 34deg, max: 9)
}
let p = plan(Reach().feels(), world: world(ground: fixed))
print(p.duration)
//> 5s
let s = simulate(p)
// The cube touches at -3.9 degrees, 24 of 40 on the way.
print(s.failures, s.duration > 2.3s and s.duration < 2.5s)
//> [] true
print(plan(Reach().counts()).duration)
//> 300ms

--- numbers and conditions of a repetition
use std.smores.Driver1
let d = Driver1()
let drive = d.drive(t: 100ms)
print(repeat(drive))
//    ^^^^^^^^^^^^^ E0405 wants a number of times
print(repeat(drive, 2, max: 3))
//    ^^^^^^^^^^^^^^^^^^^^^^^^ E0405 wants a number of times
print(repeat(drive, until: elapsed() > 1s))
//    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0405 wants a number of times
print(repeat(drive, until: elapsed() > 1s, max: -2))
//                                              ^^ E0506 must not be negative
print(wait(1s, until: margin() > 10mm))
//                    ^^^^^^^^^^^^^^^ E0405 no robot senses this
print(plan(move(d.m.tilt, to: 10deg, until: touching(d.m))))
//         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0405 the condition never holds

--- facts of surfaces and motors that make no sense
module Block {
  link body = box(50mm, 50mm, 50mm, mass: 1kg, friction: 0.5, static_friction: 0.4)
//                                                                             ^^^ E0506 must not be below `friction`
  link lid = box(50mm, 50mm, 5mm, mass: 1kg, contact_stiffness: 0N/m) at [0mm, 0mm, 40mm]
//                                                              ^^^^ E0506 must be positive
  joint hinge : body -> lid = revolute(axis: Y, no_load_speed: 0rad/s)
//                                                             ^^^^^^ E0506 must be positive
}
config C { part b: Block }
print(C())

--- ground that is not level
module Block { link body = box(100mm, 60mm, 40mm, mass: 1kg, friction: 0.3) }
config One { part b: Block  behavior rest = wait(500ms) }
let o = One()
// Friction of 0.3 holds it up to 16.7 degrees.
let stays = simulate(o.rest(), terrain: slope(15deg, along: [0, 2, 0]))
let slides = simulate(o.rest(), terrain: slope(-20deg))
print("{stays.travel:.3}", slides.displacement.x > 100mm, slides.displacement.z < -36mm, slides.slip > 110mm)
//> 0.000mm true true true
print(stays.notes[1])
//> the plan is made for level ground, and no verdict is on this one
// In a trough whose sides rise by 45 degrees it does not slide out.
let trough = terrain([[if x == 1 { 0m } else { 100mm } for x in 0..3] for y in 0..2], spacing: 100mm)
print(simulate(o.rest(), terrain: trough).travel < 20mm)
//> true
print(simulate(o.rest(), joint_spread: 200deg).travel)
//                                     ^^^^^^ E0506 at most 180deg
print(slope(60deg))
//          ^^^^^ E0506 at most 50deg
print(slope(5deg, along: Z))
//                       ^ E0506 not vertical
print(simulate(plan(o.rest(), world: world(ground: held)), terrain: slope(5deg)).travel)
//                                                                  ^^^^^^^^^^^ E0506 no ground that could be uneven

--- obstacles
use std.smores.Driver1
let d = Driver1()
let wall = placed(box(20mm, 300mm, 100mm), at: [150mm, 0mm, 50mm])
let free = simulate(d.drive(t: 2s))
let stopped = simulate(d.drive(t: 2s), obstacles: [wall])
print(free.travel > 150mm, stopped.travel < 120mm, stopped.notes[1])
//> true true the plan knows no obstacles, and no verdict is about them
print(simulate(d.drive(t: 2s), obstacles: [placed(box(1m, 1m, 1m), at: [3m, 0m, 0m]), box(1m, 1m, 1m)]).travel)
//                                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 obstacle 2 stands where the robot is
