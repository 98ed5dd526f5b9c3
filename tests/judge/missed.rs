//! What a fault of a bound would miss: motions of which the judge must look at the one instant, or the one link, that a bound a
//! little too small leaves out. Each has a twin that passes.

use crate::support::desk::run_clean;
use modl::plan::CheckKind;

/// A body with a slide above it and one below, and a wall whose place is told by its port, which is far from it.
const MODULES: &str = "
connector Face { mates Face, turns 4 }
module Pusher {
  link body = box(40mm, 40mm, 40mm, mass: 1kg)
  link flag = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, -60mm]
  link slide = box(20mm, 20mm, 20mm, mass: 100g) at [0mm, 0mm, 60mm]
  joint wave : body -> flag = prismatic(axis: X, range: -100mm..100mm) at [0mm, 0mm, -60mm]
  joint out : body -> slide = prismatic(axis: X, range: -600mm..0mm) at [0mm, 0mm, 60mm]
  port side: Face on body at [-20mm, 0mm, 0mm] facing -X up +Z
}
module Spacer {
  link body = box(40mm, 40mm, 40mm, mass: 1kg)
  port near: Face on body at [20mm, 0mm, 0mm] facing +X up +Z
  port far: Face on body at [-20mm, 0mm, 0mm] facing -X up +Z
}
module Wall(away: Length) {
  link body = box(40mm, 40mm, 200mm, mass: 1kg)
  port side: Face on body at [away, 0mm, 0mm] facing +X up +Z
}
let space = world(gravity: 0m/s^2, ground: off, dynamics: statics)
";

/// Returns what a program prints.
fn printed(program: &str) -> Vec<String> {
    run_clean(&format!("{MODULES}\n{program}\n")).printed
}

/// The wall's near side is at -480 mm from the middle of the pusher, the slide's at -10 mm: they meet after 470 mm.
#[test]
fn a_slide_that_goes_far_backwards_meets_what_is_far_from_its_module() {
    let passes = printed(
        "config Row {
           part a: Pusher  part s[4]: Spacer  part b: Wall(320mm)
           connect a.side -- s[0].near  connect s[3].far -- b.side
           for i in 0..3 { connect s[i].far -- s[i + 1].near }
           base a
         }
         let r = Row()
         print([verify(move(r.a.out, to: -d, in: 2s), world: space).ok for d in [460mm, 469mm, 471mm, 560mm]])",
    );
    assert_eq!(passes, ["[true, true, false, false]"]);
}

/// The slide begins within the wall and leaves it at once, then rests; only much later another joint changes its speed. Over
/// the first two seconds the slide's speed in the middle, which is none, holds to neither end.
#[test]
fn a_rate_that_jumps_before_those_of_other_joints_bounds_the_motion_before_it() {
    let failures = |begin: &str| {
        printed(&format!(
            "config Both {{ part a: Pusher  part b: Wall(480mm)  connect a.side -- b.side  base a  set a.out = {begin} }}
             let c = Both()
             let away = Sc(move(c.a.out, to: 0mm, in: 950ms, profile: linear), wait(10s))
             let wave = Sc(
               wait(2s), move(c.a.wave, to: 20mm, in: 7s),
               move(c.a.wave, to: 10mm, in: 300ms, profile: linear), move(c.a.wave, to: 0mm, in: 200ms, profile: linear),
             )
             print(verify(Pc(away, wave), world: space).ok)"
        ))
    };
    assert_eq!(failures("-469mm"), ["true"]);
    assert_eq!(failures("-472mm"), ["false"]);
}

/// Whether anything meets is not known after a few intervals, and is not passed over.
#[test]
fn collisions_that_are_not_decided_within_the_limit_refuse_the_plan() {
    use crate::support::motions::Motion;
    use crate::support::robots::{self, TILT};
    use modl::plan::World;
    use modl::plan::verify::verify;
    let curled = |samples: usize| {
        let curl =
            |m: Motion, i: usize| m.smooth(&format!("m{i}"), TILT, if i < 4 { 70.0 } else { 40.0 }, 0.0, 2.0);
        let mut plan = (1..6).fold(Motion::new(robots::chain(7)), curl).plan(World::FREE);
        // Less for the rollout than for the intervals between its samples.
        (plan.settings.sample, plan.settings.samples_max) = (0.1, samples);
        verify(&plan)
    };
    let undecided = |failure: &&modl::plan::Failure| failure.message.contains("was not decided");
    assert_eq!(curled(100_000).failures.iter().find(undecided), None);
    let verdict = curled(100);
    let failure = verdict.failures.iter().find(undecided).expect("it takes hundreds of intervals");
    assert_eq!((failure.kind, failure.value, failure.limit), (CheckKind::Form, 100.0, 100.0));
    assert!(failure.message.contains("within 100 stretches of time"), "{}", failure.message);
}

/// An arm that its motor can't hold lies against its stop, a degree lower. Its servo's spring, of 100 N·m/rad, then bears what a
/// degree is worth and little more, and the stop the rest of 3 N·m. Without the stop so near, the arm gives way.
#[test]
fn a_stop_bears_what_a_motor_can_not() {
    let program = |stop: &str| {
        printed(&format!(
            "module Arm {{
               link base = box(200mm, 200mm, 100mm, mass: 20kg) at [0mm, 0mm, 50mm]
               link arm = box(400mm, 40mm, 40mm, mass: 1kg) at [300mm, 0mm, 150mm]
               joint lift : base -> arm =
                 revolute(axis: Y, range: -60deg..{stop}, max_torque: 2N*m, stiffness: 100N*m/rad) at [0mm, 0mm, 150mm]
             }}
             config Leaning {{ part a: Arm  set a.lift = -1deg }}
             let l = Leaning()
             let v = verify(move(l.a.lift, to: -1.001deg, in: 1s), world: world())
             print(v.ok)
             print(v.torque_margin)"
        ))
    };
    let held = program("0deg");
    assert_eq!(held[0], "true");
    let margin: f64 = held[1].parse().expect("a number");
    // 100 N·m/rad over a degree, of 2 N·m.
    let least = 1.0 - 100.0 * 1_f64.to_radians() / 2.0;
    assert!((0.0..least).contains(&margin), "{margin} of {least}");
    assert_eq!(program("30deg")[0], "false");
}
