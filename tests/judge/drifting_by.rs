//! Robots that float and drift past obstacles as their joints move: what is proved between the samples of a rollout. A robot whose
//! base goes farther between two samples than the gap beside it is wide is proved nothing of; one that turns where it stays
//! reaches no farther than its farthest point.

use crate::support::desk::run_clean;
use crate::support::verdicts::status;
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Shape, Vec3};
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Obstacle, Status};

/// A light body that a heavy slide drives back by nearly as much as it goes out itself.
const SLEDGE: &str = "
module Sledge {
  link body = box(100mm, 100mm, 100mm, mass: 1kg)
  link slide = box(100mm, 100mm, 100mm, mass: 10kg) at [150mm, 0mm, 0mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..600mm) at [150mm, 0mm, 0mm]
}
let s = Sledge()
let moved = move(s.out, to: 500mm, in: 1s)
";

/// A light body that turns against a heavy disc beneath it.
const TOP: &str = "
module Top {
  link body = box(60mm, 60mm, 60mm, mass: 100g)
  link rotor = cylinder(radius: 60mm, length: 20mm, axis: Z, mass: 5kg) at [0mm, 0mm, -50mm]
  joint spin : body -> rotor = revolute(axis: Z) at [0mm, 0mm, -50mm]
}
let s = Top()
let moved = move(s.spin, to: 180deg, in: 2s)
";

/// Returns the status of the check of collisions of a robot that floats as it moves, with a ball of 10 mm at a place.
fn passing(program: &str, ball: Vec3) -> Status {
    let emitted = "emit(plan(moved, world: world(gravity: off, ground: off, dynamics: full)), \"p.json\")";
    let mut plan = run_clean(&format!("{program}\n{emitted}\n")).plan("p.json");
    let Body::Tracks(tracks) = &mut plan.body else { panic!("a robot") };
    let shapes = vec![Placed { pose: shifted(ball), shape: Shape::Sphere { radius: 0.01 } }];
    tracks.obstacles = vec![Obstacle { name: "ball".into(), shapes }].into();
    let verdict = verify(&plan);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    status(&verdict, CheckKind::Collision)
}

/// The body passes the ball in the middle of its way, at more than 0.7 m/s: between the samples before and after, at least
/// 10 ms apart each, it goes 14 mm and more.
#[test]
fn a_base_that_passes_closely_between_samples_is_not_proved_apart() {
    let middle = -0.5 / 2.0 * 10.0 / 11.0;
    for gap in [0.002, 0.01] {
        let found = passing(SLEDGE, Vec3::new(middle, 0.05 + 0.01 + gap, 0.0));
        assert!(matches!(found, Status::Sampled(_)), "{gap}: {found:?}");
    }
    assert_eq!(passing(SLEDGE, Vec3::new(middle, 0.4, 0.0)), Status::Proved);
}

/// No point of the robot leaves a ball of 110 mm.
#[test]
fn a_base_that_turns_on_the_spot_is_proved_to_stay_away_from_what_it_does_not_reach() {
    for away in [0.4, 0.5, 0.7] {
        assert_eq!(passing(TOP, Vec3::new(away, 0.0, 0.0)), Status::Proved, "{away}");
    }
}
