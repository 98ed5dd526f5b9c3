//! The status of a check of a robot that comes apart: the weakest of those of its parts, in whatever order they begin.

use crate::support::desk::run_clean;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Status, World};

/// A cart on a sled closes a gap of 1 mm to the rail, docked to a block or alone; links may be 0.1 mm deep in each other.
const SLIDE: &str = "
connector Face { mates Face, turns 4 }
module Slide {
  mass 100g
  link rail = box(40mm, 20mm, 20mm)
  link sled = box(40mm, 20mm, 20mm) at [0mm, 0mm, 40mm]
  link cart = box(40mm, 20mm, 20mm) at [41mm, 0mm, 0mm]
  joint up : rail -> sled = prismatic(axis: Z, range: -100mm..100mm)
  joint over : sled -> cart = prismatic(axis: X, range: -100mm..100mm)
  port side: Face on rail at [-30mm, 0mm, 0mm] facing -X up +Z
}
module Block {
  link body = box(40mm, 20mm, 20mm, mass: 100g)
  port side: Face on body at [30mm, 0mm, 0mm] facing +X up +Z
}
config Pair {
  part s: Slide
  part b: Block
  connect s.side -- b.side
  base s
  behavior close(docked: Length, alone: Length) = Sc(
    move(s.over, to: docked, in: 1s), move(s.over, to: 0mm, in: 1s),
    undock(s.side),
    move(s.over, to: alone, in: 1s), move(s.over, to: 0mm, in: 1s),
  )
}
";

#[test]
fn the_status_of_a_robot_that_parts_is_the_weakest_of_its_parts() {
    let collision = |docked: &str, alone: &str| {
        let program = format!(
            "{SLIDE}\nemit(plan(Pair().close({docked}, {alone}), world: world(gravity: 0m/s^2, ground: off)), \
             \"p.json\")\n"
        );
        let mut plan = run_clean(&program).plan("p.json");
        plan.worlds[0].world = World::FREE;
        let verdict = verify(&plan);
        let check = verdict.checks.into_iter().find(|check| check.kind == CheckKind::Collision);
        check.expect("checked").status
    };
    let (apart, touches) = ("-0.9mm", "-1.05mm");
    assert_eq!(collision(apart, apart), Status::Proved);
    assert_eq!(collision(touches, apart), Status::WithinTolerance);
    assert_eq!(collision(apart, touches), Status::WithinTolerance);
    assert_eq!(collision(touches, touches), Status::WithinTolerance);
}
