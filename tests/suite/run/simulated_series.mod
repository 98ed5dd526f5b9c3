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
