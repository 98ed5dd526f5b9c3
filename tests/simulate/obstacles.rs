//! Simulations among obstacles, beside closed forms.

use super::fixtures::{CART, GRAVITY, LEVEL, at, close, plan, play};
use modl::geometry::{Placed, Shape, Vec3, pose::shifted};
use modl::simulate::{Refusal, Settings, simulate};
use std::sync::Arc;

/// Returns settings with one box as an obstacle; its size and its centre, m.
fn beside(size: [f64; 3], centre: [f64; 3]) -> Settings {
    let wall = Placed { pose: shifted(Vec3::from(centre)), shape: Shape::Box { size: Vec3::from(size) } };
    Settings { obstacles: Arc::new([vec![wall]]), ..Settings::default() }
}

#[test]
fn a_cart_stops_at_a_wall_and_pushes_as_hard_as_its_wheels_can() {
    let plan = plan(&format!("{CART}let b = Car().roll(720deg, 3s)\n"), LEVEL);
    // The front of the cart is at 120 mm; the wall is at the height of its body, and as low as that its wheels bend back.
    let simulation = play(&plan, &beside([0.02, 0.4, 0.01], [0.21, 0.0, 0.05]));
    close(simulation.travel.x, 0.08, 2e-4);
    close(simulation.heading, 0.0, 1e-3);
    // The wheels slip with a friction of 0.3 under 2.08 kg, and the wall takes it all.
    let moment = at(&simulation, 2.0);
    let on_wall = moment.contacts.iter().filter(|contact| (contact.point.x - 0.2).abs() < 1e-3);
    let pushed: f64 = on_wall.map(|contact| contact.force.x).sum();
    close(pushed, -0.3 * 2.08 * GRAVITY, 0.02 * 0.3 * 2.08 * GRAVITY);
    assert!(moment.contacts.iter().all(|contact| contact.other.is_none()));
}

#[test]
fn what_is_out_of_reach_changes_nothing() {
    let plan = plan(&format!("{CART}let b = Car().roll(360deg, 2s)\n"), LEVEL);
    let alone = play(&plan, &Settings::default());
    let beside = play(&plan, &beside([0.2, 0.2, 0.2], [0.0, 3.0, 0.1]));
    assert_eq!(alone.motion, beside.motion);
    assert_eq!(alone.lag, beside.lag);
}

#[test]
fn an_obstacle_in_the_robot_is_refused() {
    let plan = plan(&format!("{CART}let b = Car().roll(360deg, 2s)\n"), LEVEL);
    let swallowed = simulate(&plan, &beside([1.0, 1.0, 1.0], [0.0, 0.0, 0.3]));
    assert!(matches!(swallowed, Err(Refusal::Obstacle(1, _))), "{swallowed:?}");
    let empty = simulate(&plan, &beside([1.0, 1.0, f64::NAN], [0.0, 0.0, 3.0]));
    assert!(matches!(empty, Err(Refusal::Obstacle(1, _))), "{empty:?}");
}
