--- what a fixture holds does not fall, whatever its arms do
module Arm {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link rod = box(600mm, 20mm, 20mm, mass: 2kg) at [300mm, 100mm, 0mm]
  joint p : post -> rod =
    revolute(axis: Y, range: -100deg..100deg, max_speed: 4rad/s, max_accel: 20rad/s^2, max_torque: 60N*m) at [0mm, 100mm, 0mm]
}
module Pendulum {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link bob = sphere(20mm, mass: 1kg) at [1m, 100mm, 0mm]
  joint p : post -> bob = revolute(axis: Y, passive: true) at [0mm, 100mm, 0mm]
}
config Swings { part a: Arm  base a  behavior swing = Sc(move(a.p, to: -60deg), move(a.p, to: 60deg)) }
config Hangs { part a: Pendulum  base a  behavior rest = wait(1s) }
let held = world(ground: held)
let swings = simulate(plan(Swings().swing(), world: held))
print(swings.fell, swings.failures, len(swings.notes))
//> false [] 1
print(simulate(plan(Hangs().rest(), world: held)).fell)
//> false

--- a lift that lowers its load does not fall
module Lift {
  link foot = box(160mm, 160mm, 40mm, mass: 1kg)
  link body = box(80mm, 80mm, 80mm, mass: 4kg) at [0mm, 0mm, 100mm]
  joint z : foot -> body =
    prismatic(axis: Z, range: 0mm..200mm, max_speed: 3m/s, max_accel: 60m/s^2, max_force: 600N) at [0mm, 0mm, 60mm]
}
config Lifts { part j: Lift  base j  behavior lower = Sc(move(j.z, to: 200mm, in: 1s), move(j.z, to: 0mm, in: 500ms), wait(500ms)) }
let lowers = simulate(Lifts().lower())
print(lowers.fell, len(lowers.notes))
//> false 1

--- an arm that swings quickly tips its stand over, a slower one or a shorter one does not
module Crane(h: Length) {
  link foot = box(160mm, 160mm, 40mm, mass: 3kg)
  link rod = box(20mm, 20mm, h, mass: 600g) at [0mm, 0mm, h / 2 + 20mm]
  joint p : foot -> rod =
    revolute(axis: Y, range: -90deg..90deg, max_speed: 6rad/s, max_accel: 100rad/s^2, max_torque: 30N*m) at [0mm, 0mm, 20mm]
  touching foot rod
}
config Stands(h: Length) {
  part c: Crane(h: h)
  base c
  behavior swing(a: Angle) = Sc(move(c.p, to: a), wait(500ms), move(c.p, to: 0deg), wait(500ms))
  behavior lean(a: Angle) = Sc(move(c.p, to: a, in: 1s), wait(500ms))
}
let quick = simulate(Stands(h: 700mm).swing(a: 30deg))
let slow = simulate(Stands(h: 700mm).lean(a: 30deg))
let short = simulate(Stands(h: 200mm).swing(a: 30deg))
print(quick.fell, quick.lean > 80deg, slow.fell, slow.lean < 1deg, short.fell)
//> true true false true false

--- robots that lean out beyond their feet fall, of any size
module Post(k: Number) {
  link foot = box(12mm * k, 30mm * k, 6mm * k, mass: 20g * k ^ 3)
  link rod = box(12mm * k, 12mm * k, 50mm * k, mass: 40g * k ^ 3) at [0mm, 0mm, 28mm * k]
  joint p : foot -> rod =
    revolute(axis: Y, range: -60deg..60deg, max_speed: 4rad/s, max_accel: 20rad/s^2, max_torque: 6N*m * k ^ 4) at [0mm, 0mm, 3mm * k]
  touching foot rod
}
config Leans(k: Number) { part a: Post(k: k)  base a  behavior lean(to: Angle) = Sc(move(a.p, to: to, in: 1s), wait(2s)) }
for k in [0.5, 1.0, 2.0, 5.0, 10.0] {
  // The centre of mass is above the edge of the foot at 21 degrees: two thirds of 25 mm lean out by 6 mm.
  print(k, simulate(Leans(k: k).lean(to: 40deg)).fell, simulate(Leans(k: k).lean(to: 10deg)).fell)
}
//> 0.5 true false
//> 1 true false
//> 2 true false
//> 5 true false
//> 10 true false

--- one of several robots falls
module Post {
  link foot = box(60mm, 60mm, 20mm, mass: 500g)
  link rod = box(20mm, 20mm, 400mm, mass: 400g) at [0mm, 0mm, 210mm]
  joint p : foot -> rod =
    revolute(axis: Y, range: -60deg..60deg, max_speed: 4rad/s, max_accel: 20rad/s^2, max_torque: 6N*m) at [0mm, 0mm, 10mm]
  touching foot rod
}
module Block { link body = box(200mm, 200mm, 100mm, mass: 50kg) }
config Leans { part a: Post  base a  behavior lean = Sc(move(a.p, to: 40deg, in: 1s), wait(1s)) }
config Heavy { part b: Block }
fn says(text: Text, words: Text) = len(split(text, on: words)) > 1
scene Several {
  part t: Heavy
  part u: Heavy at [0m, 1m, 0m]
  part x: Leans at [0m, 2m, 0m]
}
let scene = simulate(Several().x.lean())
let words = scene.failures[0]
print(scene.fell, len(scene.failures), says(words, "the robot with `x.a` falls"))
//> true 1 true

--- a robot whose motors are too weak for it collapses
module Frame {
  link body = box(200mm, 200mm, 20mm, mass: 4kg) at [0mm, 0mm, 100mm]
  link left = box(2mm, 200mm, 100mm, mass: 100g, friction: 0.05) at [-110mm, 0mm, 50mm]
  link right = box(2mm, 200mm, 100mm, mass: 100g, friction: 0.05) at [110mm, 0mm, 50mm]
  joint l : body -> left = revolute(axis: Y, range: -90deg..90deg, max_torque: 0.2N*m) at [-110mm, 0mm, 100mm]
  joint r : body -> right = revolute(axis: Y, range: -90deg..90deg, max_torque: 0.2N*m) at [110mm, 0mm, 100mm]
  touching body left
  touching body right
}
config Table { part f: Frame  base f  behavior spread(a: Angle) = Pc(move(f.l, to: a, in: 1s), move(f.r, to: -a, in: 1s)) }
let t = Table()
let s = simulate(t.spread(a: 40deg))
print(s.fell, s.lag > 30deg, s.lean < 5deg)
//> true true true

--- a turn counts whole turns, in a verdict and in a simulation
use std.smores.Driver1
let b = Driver1().turn(a: 450deg)
let s = simulate(b)
print(abs(verify(b).heading - 450deg) < 10deg, abs(s.heading - 450deg) < 10deg, len(s.notes))
//> true true 1
