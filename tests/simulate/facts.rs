//! Facts of modules that simulations alone know: damping, the torque-speed line of a motor, static friction, and the
//! stiffness of contacts.

use super::fixtures::{GRAVITY, HELD, LEVEL, PENDULUM, at, close, plan, play, train};
use modl::formats::mjcf;
use modl::simulate::Settings;

#[test]
fn a_bearing_with_damping_lets_a_pendulum_die_away() {
    let damped = PENDULUM.replace("passive: true", "passive: true, damping: 0.02N*m*s/rad");
    let program = format!("{damped}let x = Pendulum(5deg)\nlet b = x.rest(12s)\n");
    let simulation = play(&plan(&program, HELD), &Settings::default());
    let late = simulation.motion.iter().filter(|moment| moment.time > 11.2);
    let peak = late.max_by(|a, b| a.joints[0].abs().total_cmp(&b.joints[0].abs())).expect("it swings");
    // The amplitude falls as exp(-c t / 2 I), from 0.3 s before the plan begins.
    let inertia = 0.5 * 0.5 + 0.4 * 0.01 * 0.01;
    let expected = 5_f64.to_radians() * libm::exp(-0.02 * (peak.time + 0.3) / (2.0 * inertia));
    close(peak.joints[0].abs(), expected, 0.01 * expected);
}

#[test]
fn a_motor_comes_to_its_no_load_speed_by_its_time_constant() {
    let program = "module Flywheel {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link wheel = cylinder(radius: 100mm, length: 10mm, mass: 1kg) at [0mm, 0mm, 50mm]
  joint motor : post -> wheel = revolute(axis: Z, max_torque: 1N*m, stiffness: 500N*m/rad, armature: 0.000000001kg*m^2,
    no_load_speed: 5rad/s)
}
config Turns { part f: Flywheel
  base f
  behavior turns = Sc(spin(f.motor, 20rad/s, for: 2s), wait(1s))
}
let b = Turns().turns()
";
    let simulation = play(&plan(program, HELD), &Settings::default());
    // T = I ω₀ / τ, and the angle is ω₀ (t - T (1 - exp(-t/T))): the command runs far ahead of it.
    let constant = 0.5 * 0.1 * 0.1 * 5.0;
    for time in [0.1, 0.5, 1.0] {
        let expected = 5.0 * (time - constant * (1.0 - libm::exp(-time / constant)));
        close(at(&simulation, time).joints[0], expected, 0.01);
    }
}

#[test]
fn what_sticks_better_than_it_slides_stays_where_it_is() {
    let travel = |wagon: &str| play(&plan(&train(0.5, wagon), LEVEL), &Settings::default()).travel.x;
    // The wagon slides at 0.4, below the engine's 0.5; if it sticks up to 0.6, the engine slides.
    close(travel("friction: 0.4"), 0.0, 1e-3);
    close(travel("friction: 0.4, static_friction: 0.6"), -0.2, 2e-3);
    // Static friction below the engine's changes nothing but the first moment.
    close(travel("friction: 0.4, static_friction: 0.45"), 0.0, 2e-3);
}

#[test]
fn a_soft_foot_sinks_in_by_its_stiffness() {
    let sinks = |facts: &str| {
        let program = format!(
            "module Block {{ link body = box(50mm, 50mm, 50mm, mass: 1kg{facts}) }}
config Rests {{ part b: Block
  base b
  behavior rests = wait(1s)
}}
let b = Rests().rests()
"
        );
        let simulation = play(&plan(&program, LEVEL), &Settings::default());
        0.025 - simulation.motion.last().expect("it rests").base.translation.vector.z
    };
    // Four corners bear 9.81 N.
    close(sinks(""), GRAVITY / 4e5, 1e-7);
    close(sinks(", contact_stiffness: 20000N/m"), GRAVITY / 8e4, 1e-7);
}

#[test]
fn an_exported_servo_has_the_stated_damping() {
    let program = "module Arm {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link rod = box(200mm, 20mm, 20mm, mass: 1kg) at [125mm, 0mm, 0mm]
  touching post rod
  joint hinge : post -> rod = revolute(axis: Y, stiffness: 150N*m/rad, damping: 2.5N*m*s/rad)
}
config Held { part a: Arm
  base a
  behavior moves = move(a.hinge, to: 10deg, in: 1s)
}
let b = Held().moves()
";
    let model = mjcf::write(&plan(program, HELD)).expect("it has a joint");
    assert!(model.contains("kv=\"2.5\""), "{model}");
}

#[test]
fn a_speed_without_load_means_nothing_for_a_motor_without_limits() {
    let arm = "module Wheel {
  link post = box(40mm, 40mm, 40mm, mass: 1kg)
  link disc = box(100mm, 100mm, 10mm, mass: 100g) at [0mm, 0mm, 50mm]
  joint turn : post -> disc = revolute(axis: Z, no_load_speed: 1rad/s)
}
config One { part w: Wheel
  base w
  behavior turns = move(w.turn, by: 180deg, in: 1s)
}
let b = One().turns()
";
    let simulation = play(&plan(arm, HELD), &Settings::default());
    close(simulation.motion.last().expect("it moves").joints[0], std::f64::consts::PI, 1e-3);
}

#[test]
fn a_strong_motor_on_a_light_link_keeps_to_its_line() {
    // 2.6 N·m on 1e-4 kg·m²: in one step it could go far beyond its speed without load, were its torque not that at the
    // end of the step.
    let finger = "module Finger {
  link post = box(40mm, 40mm, 40mm, mass: 1kg)
  link tip = box(20mm, 20mm, 20mm, mass: 100g, inertia: [0.0001kg*m^2, 0.0001kg*m^2, 0.0001kg*m^2]) at [0mm, 0mm, 50mm]
  joint turn : post -> tip = revolute(axis: Z, max_torque: 2.6N*m, no_load_speed: 5rad/s)
}
config One { part f: Finger
  base f
  behavior turns = spin(f.turn, 20rad/s, for: 1s)
}
let b = One().turns()
";
    let simulation = play(&plan(finger, HELD), &Settings::default());
    let turned = |time: f64| at(&simulation, time).joints[0];
    close(turned(0.8) - turned(0.4), 5.0 * 0.4, 0.01);
}
