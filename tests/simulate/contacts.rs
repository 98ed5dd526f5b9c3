//! Simulations beside closed forms: of what rolls, slides and is dragged on the ground, and of links that meet.

use super::fixtures::{CART, GRAVITY, LEVEL, at, close, plan, play, step, train};
use modl::plan::World;
use modl::simulate::{ServoGains, Settings, Simulation};
use std::f64::consts::TAU;

/// The radius of the cart's wheels, m, and their coefficient of friction.
const RADIUS: f64 = 0.04;
const WHEELS: f64 = 0.3;

#[test]
fn wheels_that_do_not_slip_carry_their_cart_by_their_circumference() {
    let program = format!("{CART}let b = Car().roll(720deg, 3s)\n");
    let simulation = play(&plan(&program, LEVEL), &Settings::default());
    let way = 2.0 * TAU * RADIUS;
    close(simulation.travel.x, way, 1e-3 * way);
    close(simulation.travel.y, 0.0, 1e-5);
    close(simulation.heading, 0.0, 1e-5);
}

#[test]
fn four_discs_that_scrub_turn_as_friction_has_it() {
    // Each of four discs, at (x, y) and its mirror images, presses the ground at one point as the others do, and slides:
    // forward at y ω less its rim's speed v, sideways at x ω. Friction is as great at all of them and against the way, so
    // that the moment of all vanishes at y (y ω - v) + x² ω = 0, whatever friction and weight are. By a twentieth of x
    // and y it changes by a thousandth, as ω = v y / (x² + y²) is greatest at y = x.
    let (speed, time, acceleration, rim) = (2.0, 2.0, 12.0, 0.042);
    let way = rim * (speed * time - speed * speed / acceleration);
    let (x, y): (f64, f64) = (0.1, 0.105);
    let expected = (way * y / (x * x + y * y)).to_degrees();
    let plan = plan("use std.smores.Tank7\nlet x = Tank7()\nlet b = x.turn(2rad/s, 2s)\n", LEVEL);
    for (stiffness, friction) in [(60.0, 1.0), (150.0, 1.0), (500.0, 1.0), (150.0, 0.5)] {
        let servo = ServoGains { stiffness: Some(stiffness), ..ServoGains::default() };
        let simulation = play(&plan, &Settings { servo, friction, ..Settings::default() });
        close(simulation.heading.to_degrees(), expected, 0.01 * expected);
    }
}

#[test]
fn wheels_that_start_and_stop_at_once_slide_as_friction_allows() {
    // Wheels turn at 25 rad/s from the first instant on, 1 m/s, and lock after 1.5 s.
    let program = format!("{CART}let b = Sc(Car().spins(25rad/s, 1500ms), wait(600ms))\n")
        .replace("let b = Sc(Car().spins", "let x = Car()\nlet b = Sc(x.spins");
    for scale in [1.0, 0.5] {
        let settings = Settings { friction: scale, ..Settings::default() };
        let simulation = play(&plan(&program, LEVEL), &settings);
        let (speed, deceleration) = (25.0 * RADIUS, scale * WHEELS * GRAVITY);
        let start = at(&simulation, 0.0).base.translation.vector.x;
        let x = |time: f64| at(&simulation, time).base.translation.vector.x - start;
        let slides = speed * speed / (2.0 * deceleration);
        // While the wheels slip, friction accelerates the cart evenly.
        let time = 0.28;
        close(x(time), 0.5 * deceleration * time * time, 0.02 * slides);
        // In all it is behind by as much as it then slides on.
        close(x(1.5), 1.5 * speed - slides, 0.02 * slides);
        if scale == 1.0 {
            close(simulation.travel.x - x(1.5), slides, 0.02 * slides);
        }
        let halfway = 0.2;
        let way = speed * halfway - 0.5 * deceleration * halfway * halfway;
        close(x(1.5 + halfway) - x(1.5), way, 0.02 * slides);
    }
}

/// A sled of two rails with a carriage between them at the height of their centre of mass, 1 kg each.
fn sled(friction: f64) -> String {
    format!(
        "module Sled {{
  link rails = union(placed(box(1m, 40mm, 40mm), at: [0mm, 100mm, 0mm]), placed(box(1m, 40mm, 40mm), at: [0mm, -100mm, 0mm]),
    mass: 1kg, friction: {friction})
  link carriage = box(40mm, 40mm, 20mm, mass: 1kg) at [-300mm, 0mm, 0mm]
  joint slide : rails -> carriage = prismatic(axis: X, stiffness: 100000N/m)
}}
config Thrower {{ part s: Sled
  base s
}}
let x = Thrower()
let b = Sc(move(x.s.slide, by: 600mm, in: 600ms, profile: linear), wait(500ms))
"
    )
}

#[test]
fn a_robot_that_accelerates_beyond_friction_slides_back_and_forth() {
    for friction in [0.3, 0.8] {
        let simulation = play(&plan(&sled(friction), LEVEL), &step(1e-4));
        let x = |time: f64| {
            at(&simulation, time).base.translation.vector.x - at(&simulation, 0.0).base.translation.vector.x
        };
        // The carriage is thrown at 1 m/s against the rails: they start with half of it, and slide v²/(2 μ g).
        let slides = 0.5 * 0.5 / (2.0 * friction * GRAVITY);
        close(x(0.5), -slides, 0.02 * slides);
        // It is caught, and takes them along as far.
        close(x(0.9), 0.0, 0.02 * slides);
    }
}

#[test]
fn of_two_boxes_that_push_each_other_the_one_with_less_friction_slides() {
    // 1.5 kg at 0.5 hold against as much at 0.4, which the joint drags by 200 mm: 0.4 · 1.5 · 9.81 N · 0.2 m.
    let simulation = play(&plan(&train(0.5, "friction: 0.4"), LEVEL), &Settings::default());
    close(simulation.travel.norm(), 0.0, 2e-4);
    let work = 0.4 * 1.5 * GRAVITY * 0.2;
    close(simulation.work, work, 0.02 * work);
    let simulation = play(&plan(&train(0.4, "friction: 0.5"), LEVEL), &Settings::default());
    close(simulation.travel.x, -0.2, 1e-3);
    close(simulation.work, work, 0.02 * work);
}

#[test]
fn what_slides_without_friction_keeps_its_centre_of_mass() {
    let world = World { friction: 0.0, ..LEVEL };
    let simulation = play(&plan(&train(0.4, "friction: 0.5"), world), &Settings::default());
    // Engine and wagon weigh as much, and go the same way.
    close(simulation.travel.x, -0.1, 1e-5);
}

/// An arm about the vertical that meets a ball which stands in its way.
const BLOCKED: &str = "module Blocked {
  link post = box(20mm, 20mm, 20mm, mass: 1kg)
  link arm = box(400mm, 20mm, 20mm, mass: 1kg) at [200mm, 0mm, 0mm]
  link ball = sphere(radius: 20mm, mass: 1kg) at [300mm, 100mm, 0mm]
  touching post arm
  joint hinge : post -> arm = revolute(axis: Z, stiffness: 150N*m/rad)
  joint holds : post -> ball = fixed()
}
config Stuck { part m: Blocked
  base m
  behavior pushes allows collision = Sc(move(m.hinge, to: 30deg, in: 2s), wait(1s), move(m.hinge, to: 0deg, in: 1s))
}
let b = Stuck().pushes()
";

#[test]
fn an_arm_presses_on_a_link_in_its_way() {
    let plan = plan(BLOCKED, World::FREE);
    let settings = Settings { friction: 0.0, ..Settings::default() };
    let held = |simulation: &Simulation| at(simulation, 2.98).joints[0];
    // The ball is at (300, 100) mm; its surface is 20 mm and that of the arm 10 mm from the line of the arm's middle, less
    // the depth of the contact: the 0.1 mm that count as touching, and its force by 1e5 N/m.
    let (distance, direction) = (libm::hypot(0.3, 0.1), libm::atan2(0.1, 0.3));
    let (mut depth, mut angle) = (0.0, 0.0);
    for _ in 0..50 {
        let off = 0.03 - 1e-4 - depth;
        angle = direction - libm::asin(off / distance);
        let lever = (distance * distance - off * off).sqrt();
        depth = 150.0 * (30_f64.to_radians() - angle) / lever / 1e5;
    }
    // The force acts at some point of the overlap, which is as wide as a lens of this depth: so sure is its lever.
    let lens = (2.0 * 0.02 * (depth + 1e-4)).sqrt();
    close(held(&play(&plan, &settings)), angle, 1.1 * depth * lens / (distance * distance));
    // It is free again afterwards.
    let back = play(&plan, &settings).motion.last().expect("it moves").joints[0];
    close(back, 0.0, 1e-6);
    let through = Settings { link_contacts: false, ..settings };
    close(held(&play(&plan, &through)), 30_f64.to_radians(), 1e-6);
}
