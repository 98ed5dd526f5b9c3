//! Robots for which mechanics has closed forms, as programs, and their plans.

use crate::support::desk::run_clean;
use modl::plan::{Ground, Plan, World};
use modl::simulate::{Moment, Settings, Simulation, simulate};

/// The acceleration of free fall, m/s².
pub const GRAVITY: f64 = 9.80665;

/// The world in which the base is held.
pub const HELD: World = World { gravity: GRAVITY, ground: Ground::Held, ..World::FREE };

/// The world with level ground.
pub const LEVEL: World = World { gravity: GRAVITY, ground: Ground::Settle, ..World::FREE };

/// Returns the plan of a program that leaves a behaviour in `b`, for a world. It is written for a weightless world, under
/// statics, so that the judge has nothing to refuse.
pub fn plan(program: &str, world: World) -> Plan {
    let weightless = "world: world(ground: off, gravity: off, dynamics: statics)";
    let written = run_clean(&format!("{program}emit(plan(b, {weightless}), \"p.json\")\n"));
    let mut plan = written.plan("p.json");
    plan.verdict = None;
    plan.worlds[0].world = world;
    plan
}

/// Plays a plan; panics if it is refused.
pub fn play(plan: &Plan, settings: &Settings) -> Simulation {
    simulate(plan, settings).expect("the plan can be simulated")
}

/// Returns settings with a time step, s.
pub fn step(step: f64) -> Settings {
    Settings { step, ..Settings::default() }
}

/// Fails unless a value is within an error of what is expected.
#[track_caller]
pub fn close(value: f64, expected: f64, error: f64) {
    assert!(
        (value - expected).abs() <= error,
        "{value} instead of {expected}: {:e} off",
        (value - expected).abs()
    );
}

/// Returns the moment at a time, s, up to half of the time between moments.
pub fn at(simulation: &Simulation, time: f64) -> &Moment {
    let after = simulation.motion.partition_point(|moment| moment.time < time - 0.01);
    &simulation.motion[after.min(simulation.motion.len() - 1)]
}

/// Returns the derivative of samples that are `step` apart at an index, by the central difference of the eighth order;
/// the index must be four or more from both ends.
pub fn rate(step: f64, index: usize, sample: impl Fn(usize) -> f64) -> f64 {
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let term = |(k, weight): (usize, f64)| weight * (sample(index + k) - sample(index - k));
    (1..).zip(weights).map(term).sum::<f64>() / step
}

/// The time between two moments of a simulation, s.
pub const FRAME: f64 = 0.02;

/// A bob on a rod without mass, 500 mm below its hinge: 1 kg, a ball of 10 mm.
pub const PENDULUM: &str = "module Swing {
  link post = box(100mm, 100mm, 100mm, mass: 1kg)
  link bob = sphere(radius: 10mm, mass: 1kg) at [0mm, 0mm, -500mm]
  joint hinge : post -> bob = revolute(axis: Y, passive: true)
}
config Pendulum(start: Angle) {
  part p: Swing
  set p.hinge = start
  base p
  behavior rest(t: Time) = wait(t)
}
";

/// Two rods of 1 kg, 400 mm long, below each other.
pub const DOUBLE_PENDULUM: &str = "module Swings {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link upper = box(20mm, 20mm, 400mm, mass: 1kg) at [0mm, 0mm, -200mm]
  link lower = box(20mm, 20mm, 400mm, mass: 1kg) at [0mm, 0mm, -600mm]
  touching post upper
  touching upper lower
  joint shoulder : post -> upper = revolute(axis: Y, passive: true)
  joint elbow : upper -> lower = revolute(axis: Y, passive: true) at [0mm, 0mm, -400mm]
}
config DoublePendulum(a: Angle, b: Angle) {
  part p: Swings
  set p.shoulder = a
  set p.elbow = b
  base p
  behavior rest(t: Time) = wait(t)
}
";

/// A box of 2 kg on four light wheels of 40 mm, whose friction is 0.3.
pub const CART: &str = "module Cart {
  link body = box(240mm, 60mm, 40mm, mass: 2kg)
  link fl = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 0.3) at [80mm, 60mm, 0mm]
  link fr = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 0.3) at [80mm, -60mm, 0mm]
  link bl = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 0.3) at [-80mm, 60mm, 0mm]
  link br = cylinder(radius: 40mm, length: 10mm, axis: Y, mass: 20g, friction: 0.3) at [-80mm, -60mm, 0mm]
  joint a : body -> fl = revolute(axis: Y) at [80mm, 60mm, 0mm]
  joint b : body -> fr = revolute(axis: Y) at [80mm, -60mm, 0mm]
  joint c : body -> bl = revolute(axis: Y) at [-80mm, 60mm, 0mm]
  joint d : body -> br = revolute(axis: Y) at [-80mm, -60mm, 0mm]
}
config Car {
  part c: Cart
  base c
  behavior roll(a: Angle, t: Time) = Pc(move(c.a, by: a, in: t), move(c.b, by: a, in: t), move(c.c, by: a, in: t), move(c.d, by: a, in: t))
  behavior spins(w: AngularSpeed, t: Time) = Pc(spin(c.a, w, for: t), spin(c.b, w, for: t), spin(c.c, w, for: t), spin(c.d, w, for: t))
}
";

/// A weight that slides down from a post.
pub const DROP: &str = "module Drop {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link weight = box(50mm, 50mm, 50mm, mass: 3kg) at [0mm, 0mm, -100mm]
  joint slide : post -> weight = prismatic(axis: Z, passive: true)
}
config Falls { part d: Drop
  base d
  behavior rest = wait(1s)
}
let b = Falls().rest()
";

/// Returns the program of two boxes of 1.5 kg with a joint that slides between them by 200 mm: the first with a coefficient
/// of friction, the second with these facts of its surface. By symmetry each bears half of the weight.
pub fn train(friction: f64, wagon: &str) -> String {
    format!(
        "module Train {{
  link engine = box(100mm, 100mm, 40mm, mass: 1.5kg, friction: {friction})
  link wagon = box(100mm, 100mm, 40mm, mass: 1.5kg, {wagon}) at [200mm, 0mm, 0mm]
  joint bar : engine -> wagon = prismatic(axis: X, stiffness: 10000N/m)
}}
config Drags {{ part t: Train
  base t
  behavior pushes = move(t.bar, by: 200mm, in: 2s)
}}
let b = Drags().pushes()
"
    )
}
