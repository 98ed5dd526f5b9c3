--- a block stands on a slope until the line of gravity leaves its base
module Tall { link body = box(100mm, 100mm, 300mm, mass: 1kg, friction: 0.5) }
config One { part b: Tall  behavior rest = wait(500ms) }
let o = One()
fn on(angle: Angle, along: Vec3<Number> = X) -> World = world(terrain: slope(angle, along: along), friction: 10)
// In the plane of the ground the margin is the half base less the height of the centre of mass times the tangent.
fn margin(angle: Angle) -> Length = 50mm - 150mm * tan(angle)
fn agrees(angle: Angle, along: Vec3<Number>) -> Bool = abs(verify(o.rest(), world: on(angle, along: along)).margin - margin(angle)) < 1nm
print(all([agrees(angle, along) for angle in [1deg, 5deg, 10deg, 18deg] for along in [X, Y, -X, -Y]]))
//> true
// atan(50 / 150) is 18.435 degrees: above, it falls on its side as it is set down.
print(verify(o.rest(), world: on(18.42deg)).ok, verify(o.rest(), world: on(18.45deg)).notes[0])
//> true the start settles by 90deg
// Along a diagonal its half base is longer.
print(abs(verify(o.rest(), world: on(18.45deg, along: [1, 1, 0])).margin - (50mm - 150mm * tan(18.45deg) / sqrt(2))) < 1nm)
//> true
let p = plan(o.rest(), world: on(10deg))
print(norm(position(p.end.base) - [-150mm * sin(10deg), 0mm, 150mm * cos(10deg)]) < 1nm, p.assumes.slope)
//> true 10deg
print(p.assumes)
//> ground settle, slope 10deg, gravity 9.80665m/s^2, friction 10
// Put down again as it stands, it stays as it is.
let q = plan(o.rest(), from: p.end, world: on(10deg))
print(norm(position(q.end.base) - position(p.end.base)) < 1nm, verify(p ++ q).ok)
//> true true
print(verify(p ++ plan(o.rest())).ok)
//           ^^^^^^^^^^^^^^^^^^^ E0410 on different ground

--- a block slides where the slope is steeper than its friction
module Block { link body = box(200mm, 200mm, 40mm, mass: 1kg, friction: 0.5) }
config One {
  part b: Block
  behavior rest = wait(500ms)
  behavior go allows traction = wait(500ms)
}
let o = One()
fn stands(angle: Angle) -> Bool = verify(o.rest(), world: world(terrain: slope(angle))).ok
fn stands_at_rest(angle: Angle) -> Bool = verify(o.rest(), world: world(terrain: slope(angle), dynamics: statics)).ok
// tan(26.565deg) is 0.5; under full dynamics 0.97 of the friction counts, up to 25.87 degrees.
print([stands(a) for a in [10deg, 25.8deg, 25.95deg, 40deg]], [stands_at_rest(a) for a in [10deg, 26.5deg, 26.6deg, 40deg]])
//> [true, true, false, false] [true, true, false, false]
let icy = world(terrain: slope(10deg), friction: 0.2)
print(verify(o.rest(), world: icy).failures[0])
//> at 0ms: the robot slides down the slope at 0ms: its weight needs a friction of 0.176, and has 0.1
// A slide may be allowed, but not to the end.
print(verify(o.go(), world: icy).failures[0])
//> at 500ms: the robot slides down the slope at 500ms: its weight needs a friction of 0.176, and has 0.1
// The same slope is that of a simulation.
print(simulate(plan(o.rest(), world: icy)).travel > 100mm, simulate(plan(o.rest(), world: world(terrain: slope(10deg)))).travel < 1um)
//> true true
print(simulate(plan(o.rest(), world: icy), terrain: slope(3deg)).travel)
//                                                  ^^^^^^^^^^^ E0506 a slope of its own

--- a tower tips as it bends over the edge of its support
module Tower {
  link base = box(200mm, 200mm, 60mm, mass: 2kg, friction: 1)
  link mast = box(40mm, 40mm, 300mm, mass: 3kg) at [0mm, 0mm, 240mm]
  joint bend : base -> mast = revolute(axis: Y, max_torque: 20N*m, range: -90deg..90deg, max_speed: 90deg/s) at [0mm, 0mm, 90mm]
}
config Leaning { part t: Tower  behavior bend(a: Angle) = move(t.bend, to: a, in: 4s) }
let leaning = Leaning()
// Seen from the middle of the base the centre of mass is at 90 mm (sin, cos) of the bend above 84 mm, and the line of gravity
// meets the ground 100 mm away at last.
fn last(slope: Angle) -> Angle = asin((100 - 84 * tan(slope)) / 90 * cos(slope)) - slope
fn stands(a: Angle, angle: Angle) -> Bool = verify(leaning.bend(a), world: world(terrain: slope(angle, along: -X), dynamics: statics)).ok
// A tenth of a degree before that it stands, and after it falls.
print([stands(last(x) - 0.1deg, angle: x) for x in [10deg, 15deg, 20deg]], [stands(last(x) + 0.1deg, angle: x) for x in [10deg, 15deg, 20deg]])
//> [true, true, true] [false, false, false]
// It bends up the slope as far as it will.
print(stands(-90deg, angle: 15deg))
//> true

--- torques under a gravity that leans
module Arm {
  link post = box(400mm, 400mm, 100mm, mass: 20kg, friction: 1)
  link rod = box(500mm, 20mm, 20mm, mass: 2kg) at [250mm, 0mm, 100mm]
  joint hinge : post -> rod = revolute(axis: -Y, max_torque: 20N*m, range: -90deg..90deg) at [0mm, 0mm, 100mm]
}
config Lifter { part a: Arm  set a.hinge = 30deg  behavior rest = wait(500ms) }
let r = Lifter()
let steep = [world(terrain: slope(20deg)), world(terrain: slope(20deg), dynamics: statics)]
let up = [plan(r.rest(), world: w) for w in steep]
// The rod rises by 30 degrees over the ground, and by 50 over the horizon; the ground bears the weight's normal part.
print([abs(p.series(torque(r.a.hinge), step: 250ms)[1] - 2kg * 9.80665m/s^2 * 0.25m * cos(50deg)) < 1e-6N*m for p in up])
//> [true, true]
print([abs(p.series(ground_force(r.a), step: 250ms)[1] - 22kg * 9.80665m/s^2 * cos(20deg)) < 0.001N for p in up])
//> [true, true]
let down = plan(r.rest(), world: world(terrain: slope(-20deg)))
print(abs(down.series(torque(r.a.hinge), step: 250ms)[1] - 2kg * 9.80665m/s^2 * 0.25m * cos(10deg)) < 1e-6N*m)
//> true
print(verify(down).ok, verify(r.rest(), world: world(terrain: slope(20deg), friction: 0.3)).ok)
//> true false

--- wheels hold a car on a slope by their motors, and roll down without them
module Cart(free: Bool) {
  link body = box(240mm, 60mm, 40mm, mass: 2kg)
  link fl = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [80mm, 60mm, 0mm]
  link fr = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [80mm, -60mm, 0mm]
  link bl = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [-80mm, 60mm, 0mm]
  link br = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 1) at [-80mm, -60mm, 0mm]
  joint a : body -> fl = revolute(axis: Y, passive: free) at [80mm, 60mm, 0mm]
  joint b : body -> fr = revolute(axis: Y, passive: free) at [80mm, -60mm, 0mm]
  joint c : body -> bl = revolute(axis: Y, passive: free) at [-80mm, 60mm, 0mm]
  joint d : body -> br = revolute(axis: Y, passive: free) at [-80mm, -60mm, 0mm]
}
config Car(free: Bool) {
  part c: Cart(free: free)
  behavior rest = wait(500ms)
}
let hill = world(terrain: slope(10deg))
let car = Car(free: false)
let p = plan(car.rest(), world: hill)
// What friction holds along the slope at the radius of the wheels: m g r sin.
let held = sum([p.series(torque(wheel), step: 250ms)[1] for wheel in [car.c.a, car.c.b, car.c.c, car.c.d]])
print(abs(abs(held) - 2.08kg * 9.80665m/s^2 * 40mm * sin(10deg)) < 1e-5N*m, simulate(plan(car.rest(), world: hill)).travel < 10um)
//> true true
let rolls = verify(Car(free: true).rest(), world: hill)
print([c for c in rolls.checks if c == "traction: not checked: c.a has no motor, and the robot may roll down the slope on it"] != [])
//> true
print(simulate(plan(Car(free: true).rest(), world: hill)).travel > 100mm)
//> true

--- cars drive up, across and down as simulations do
use std.smores.{Driver1, RcCar8, Tank7}
let worlds = [world(terrain: slope(5deg), friction: 0.8), world(terrain: slope(10deg, along: [1, 1, 0])), world(terrain: slope(8deg, along: -X))]
fn agrees(b: Behavior, w: World) -> Bool = norm(verify(b, world: w).displacement - simulate(plan(b, world: w)).displacement) < 2mm and verify(b, world: w).ok
print([agrees(Tank7().drive(t: 2s), w) for w in worlds], [agrees(RcCar8().drive(t: 1s), w) for w in worlds], agrees(Driver1().drive(t: 2s), worlds[0]))
//> [true, true, true] [true, true, true] true
// Braked it stays; too smooth, it does not.
print(verify(Tank7().drive(0rad/s, t: 2s), world: world(terrain: slope(10deg), friction: 0.8)).travel)
//> 0mm
print(verify(Tank7().drive(0rad/s, t: 2s), world: world(terrain: slope(10deg), friction: 0.1)).ok)
//> false

--- worlds that are none
print(world(terrain: slope(90deg)))
//                         ^^^^^ E0506 at most 50deg
print(world(terrain: slope(5deg, along: Z)))
//                                      ^ E0506 not vertical
print(world(terrain: slope(5deg), ground: held))
//                   ^^^^^^^^^^^ E0506 a slope is ground to settle on
print(world(terrain: slope(5deg), gravity: off))
//                                         ^^^ E0506 without gravity nothing rests
print(world(terrain: terrain([[0m, 0m], [0m, 100mm]], spacing: 1m)))
//                   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0506 only a `slope` is ground for the judge

--- level ground is no slope
use std.smores.Tank7
let level = world(terrain: slope(0deg))
print(level, level.slope == 0deg)
//> ground settle, gravity 9.80665m/s^2, friction 1 true
print(verify(Tank7().drive(t: 1s), world: level).displacement == verify(Tank7().drive(t: 1s)).displacement)
//> true
