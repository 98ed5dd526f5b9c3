//! Simulations on ground that is not level, beside closed forms.

use super::fixtures::{CART, FRAME, GRAVITY, HELD, LEVEL, at, close, plan, play, rate};
use modl::geometry::HeightField;
use modl::plan::Plan;
use modl::simulate::{Refusal, Settings, Simulation, simulate};
use std::sync::Arc;

/// The time for which a robot stands before its plan begins, s.
const STANDS: f64 = 0.3;

/// A block of 1 kg with a coefficient of friction of 0.3.
const BLOCK: &str = "module Block { link body = box(100mm, 60mm, 40mm, mass: 1kg, friction: 0.3) }
config One {
  part b: Block
  behavior rest(t: Time) = wait(t)
}
let b = One().rest(1s)
";

/// Returns settings with a height field under the robot.
fn on(field: HeightField) -> Settings {
    Settings { terrain: Some(Arc::new(field)), ..Settings::default() }
}

/// Returns a height field of squares with a height for each place (m), `count` along x and y, the middle one at the origin.
fn field(spacing: f64, count: usize, height: impl Fn(f64, f64) -> f64) -> HeightField {
    let first = -spacing * (count - 1) as f64 / 2.0;
    let at = |i: usize| first + spacing * i as f64;
    let heights = (0..count * count).map(|i| height(at(i % count), at(i / count))).collect();
    HeightField { corner: [first; 2], spacing, columns: count, heights }
}

/// Plays a plan on a plane that rises along a direction by an angle, rad.
fn on_slope(plan: &Plan, along: [f64; 2], angle: f64) -> Simulation {
    play(plan, &on(HeightField::plane(along, libm::tan(angle))))
}

/// Returns how far a robot has gone down a plane since the start of its plan at a time, m.
fn way_down(simulation: &Simulation, time: f64) -> f64 {
    let place = |time| at(simulation, time).base.translation.vector;
    (place(time) - place(0.0)).norm()
}

#[test]
fn a_block_slides_down_a_slope_as_friction_lets_it_and_stays_on_a_gentle_one() {
    let plan = plan(BLOCK, LEVEL);
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    for along in [[1.0, 0.0], [0.0, -1.0], [diagonal, diagonal]] {
        let steep = 25_f64.to_radians();
        let acceleration = GRAVITY * (libm::sin(steep) - 0.3 * libm::cos(steep));
        let simulation = on_slope(&plan, along, steep);
        // It slides while it stands before the plan begins, too.
        for time in [0.2, 0.6, 1.0] {
            let way = acceleration * (STANDS * time + 0.5 * time * time);
            // The contacts take up to 3 ms until they bear the block.
            close(way_down(&simulation, time), way, 3e-3 * acceleration * (STANDS + time));
        }
        // It slides on for 0.3 s after the plan has ended.
        close(simulation.slip, simulation.travel.norm(), 1e-3);
        let [x, y] = along;
        let across = simulation.travel.x * y - simulation.travel.y * x;
        close(across, 0.0, 1e-6);
        // The friction of 0.3 holds up to 16.7 degrees.
        let gentle = on_slope(&plan, along, 16_f64.to_radians());
        assert!(gentle.travel.norm() < 1e-6, "{:?}", gentle.travel);
        close(gentle.slip, 0.0, 1e-9);
        assert!(gentle.fall.is_none() && gentle.lean_max < 1e-3);
    }
}

/// The cart with wheels that turn freely, which stands for a time.
fn coaster() -> String {
    let free = CART.replace("revolute(axis: Y)", "revolute(axis: Y, passive: true)");
    let body = "base c\n  behavior rest(t: Time) = wait(t)";
    format!("{}let b = Car().rest(1s)\n", free.replacen("base c", body, 1))
}

#[test]
fn free_wheels_roll_down_a_slope_without_slip() {
    let plan = plan(&coaster(), LEVEL);
    let angle = 8_f64.to_radians();
    // Four wheels of 20 g besides the body of 2 kg; each resists as half its mass more.
    let (mass, turning) = (2.08, 4.0 * 0.02 / 2.0);
    let acceleration = GRAVITY * libm::sin(angle) * mass / (mass + turning);
    let simulation = on_slope(&plan, [1.0, 0.0], -angle);
    for time in [0.4, 1.0] {
        let way = acceleration * (STANDS * time + 0.5 * time * time);
        close(way_down(&simulation, time), way, 3e-3 * way);
    }
}

#[test]
fn a_plane_of_many_squares_is_as_one_of_a_single_square() {
    let plan = plan(&coaster(), LEVEL);
    let rise = libm::tan(8_f64.to_radians());
    let one = on_slope(&plan, [-1.0, 0.0], 8_f64.to_radians());
    let many = play(&plan, &on(field(0.037, 201, |x, _| -rise * x)));
    close(many.travel.x, one.travel.x, 1e-6);
    assert!(one.travel.x > 0.8, "{:?}", one.travel);
}

#[test]
fn a_ball_without_friction_keeps_its_energy_in_a_valley() {
    let program = "module Ball { link body = sphere(radius: 5mm, mass: 100g, friction: 0) }
config One {
  part b: Ball
  behavior rest(t: Time) = wait(t)
}
let b = One().rest(900ms)
";
    // The ball begins 400 mm beside the bottom of a parabola, 80 mm above it.
    let valley = field(0.01, 181, |x, _| (x - 0.4) * (x - 0.4) / 2.0);
    let simulation = play(&plan(program, LEVEL), &on(valley));
    let place = |i: usize| simulation.motion[i].base.translation.vector;
    let mut fastest: f64 = 0.0;
    for i in 4..simulation.motion.len() - 4 {
        let speed = libm::hypot(rate(FRAME, i, |i| place(i).x), rate(FRAME, i, |i| place(i).z));
        let energy = speed * speed / (2.0 * GRAVITY) + place(i).z - 0.005;
        fastest = fastest.max(speed);
        // Each crease takes what the ball has across it: in all less than 3 % on the way over 80 of them.
        close(energy, 0.08, 0.003);
    }
    close(fastest, libm::sqrt(2.0 * GRAVITY * 0.08), 0.03);
}

#[test]
fn a_walker_stands_on_rough_ground() {
    let program = "use std.smores.Walk4\nlet w = Walk4()\nlet b = Sc(w.stand(), wait(500ms))\n";
    let plan = plan(program, LEVEL);
    let rough = field(0.08, 41, |x, y| 0.012 * libm::sin(23.0 * x) * libm::cos(17.0 * y));
    let simulation = play(&plan, &on(rough.clone()));
    assert!(simulation.fall.is_none() && simulation.lean_max < 0.3, "{simulation:?}");
    let last = simulation.motion.last().expect("it stands");
    let weight = GRAVITY
        * plan.body.tracks().map_or(0.0, |tracks| {
            let links = (0..tracks.robot.modules.len()).flat_map(|m| &tracks.robot.module_type(m).links);
            links.map(|link| link.mass).sum::<f64>()
        });
    let ground = || last.contacts.iter().filter(|contact| contact.other.is_none());
    close(ground().map(|contact| contact.force.z).sum(), weight, 0.01 * weight);
    for contact in ground() {
        // It stands on the surface, where it leans less than the friction of 0.8 would let it.
        close(rough.above(contact.point), 0.0, 1e-3);
        let normal = rough.normal(contact.point.x, contact.point.y);
        let pressing = contact.force.dot(&normal);
        assert!((contact.force - normal * pressing).norm() <= 0.8 * pressing + 1e-9);
    }
}

#[test]
fn ground_that_can_not_be_is_refused() {
    let held = simulate(&plan(BLOCK, HELD), &on(HeightField::plane([1.0, 0.0], 0.1)));
    assert!(matches!(held, Err(Refusal::Terrain(_))), "{held:?}");
    let nan = simulate(&plan(BLOCK, LEVEL), &on(HeightField::plane([1.0, 0.0], f64::NAN)));
    assert!(matches!(nan, Err(Refusal::Terrain(_))), "{nan:?}");
}
