//! Robots that tip, which a behaviour allows: how fast the judge says that a link comes down, against the simulation, and how far
//! the robot travels, against MuJoCo.

use super::mjcf::{Case, number, played, turned_apart};
use crate::support::desk;
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use modl::plan::verify::verify;
use serde_json::Value;
use std::io::Write as _;

/// A post on a small foot leans over until it falls on its side.
const POST: &str = "\
module Post {
  link foot = box(60mm, 60mm, 20mm, mass: 100g, friction: 1)
  link arm = box(20mm, 20mm, HEIGHT, mass: 400g) at [0mm, 0mm, 20mm + HEIGHT / 2]
  joint hip : foot -> arm = revolute(
    axis: Y,
    range: -90deg..90deg,
    max_speed: 3rad/s,
    max_torque: 20N*m,
    max_accel: 40rad/s^2
  ) at [0mm, 0mm, 20mm]
  touching foot arm
}
config Falls {
  part post: Post
  base post
  behavior lean allows unstable, balance = move(post.hip, 50deg, in: 3s)
}
";

/// The lines that print how fast the post comes down, as judged and as simulated, m/s.
const IMPACTS: &str = "\
print(verify(Falls().lean()).impact / 1m/s)
print(simulate(Falls().lean()).impact / 1m/s)
";

/// Four legs of three joints on a body, with feet that are points: in a trot two of them carry it, so that it tips from pair to pair.
const TROT: &str = "\
use std.legs.{Legs, Walk, trot}
connector Clip { mates Clip, turns 1, holds 300N, holds 200N*m }
module Body {
  link shell = box(320mm, 160mm, 40mm, mass: 4kg)
  for i in 0..4 {
    port side[i] : Clip on shell
      at [120mm - 240mm * div(i, 2), if i % 2 == 0 { 80mm } else { -80mm }, 0mm]
      facing if i % 2 == 0 { Y } else { -Y } up +Z
  }
}
module Leg {
  link hip = box(40mm, 30mm, 30mm, mass: 100g) at [20mm, 0mm, 0mm]
  link coxa = sphere(radius: 18mm, mass: 100g) at [60mm, 0mm, 0mm]
  link thigh = capsule(radius: 12mm, length: 70mm, axis: X, mass: 200g) at [120mm, 0mm, 0mm]
  link shin = capsule(radius: 12mm, length: 126mm, axis: Z, mass: 150g, friction: 0.8) at [180mm, 0mm, -75mm]
  joint yaw : hip -> coxa = revolute(axis: Z, range: -60deg..60deg, max_speed: 12rad/s, max_accel: 600rad/s^2,
    max_torque: 90N*m) at [60mm, 0mm, 0mm]
  joint lift : coxa -> thigh = revolute(axis: Y, range: -70deg..70deg, max_speed: 12rad/s, max_accel: 600rad/s^2,
    max_torque: 90N*m) at [60mm, 0mm, 0mm]
  joint knee : thigh -> shin = revolute(axis: Y, range: -60deg..90deg, max_speed: 12rad/s, max_accel: 600rad/s^2,
    max_torque: 90N*m) at [180mm, 0mm, 0mm]
  touching hip thigh
  touching thigh shin
  port root : Clip on hip at [-20mm, 0mm, 0mm] facing -X up +Z
  port toe : Clip on shin at [0mm, 0mm, -75mm] facing -Z up +X
}
config Quadruped {
  part body: Body
  part leg[4]: Leg
  for i in 0..4 { connect body.side[i] -- leg[i].root }
  base body
  let legs = Legs(body: body, feet: [l.toe for l in leg], stand: [pose(l.toe).position for l in leg])
  behavior walk allows unstable, balance = trot(legs, Walk(stride: [STRIDE, 0mm, 0mm], beat: BEAT), cycles: 2)
}
";

/// A chain of hinges bends sideways and up at once, and rolls over its edges.
const CURL: &str = "\
connector Clip { mates Clip, turns 4 }
module Hinge {
  link tail = box(40mm, 40mm, 40mm, mass: 75g)
  link tip = box(40mm, 40mm, 40mm, mass: 75g) at [60mm, 0mm, 0mm]
  joint bend : tail -> tip = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 4N*m,
    max_accel: 20rad/s^2) at [30mm, 0mm, 0mm]
  port back : Clip on tail at [-20mm, 0mm, 0mm] facing -X up +Z
  port front : Clip on tip at [20mm, 0mm, 0mm] facing +X up +Z
}
config Chain {
  part h[6]: Hinge
  for i in 0..5 { connect h[i].front -- h[i + 1].back turn if i % 2 == 0 { 90deg } else { 0deg } }
  base h[0]
  behavior curl(to: Angle) allows unstable = Pc([move(x.bend, to: to) for x in h])
}
";

/// The stiffness of the servos, N·m/rad.
const STIFFNESSES: [f64; 3] = [60.0, 150.0, 500.0];

#[test]
fn a_post_that_falls_comes_down_about_as_fast_as_simulated() {
    for height in [120, 200, 400] {
        let program = format!("{POST}{IMPACTS}").replace("HEIGHT", &format!("{height}mm"));
        let (observed, _, _) = desk::run(&MapFiles::of(&program), Mode::Run);
        assert!(observed.diagnostics.is_empty(), "{:?}", observed.diagnostics);
        let printed: Vec<f64> = observed.printed.iter().map(|line| line.parse().expect("a number")).collect();
        let [judged, simulated] = printed[..] else { panic!("{printed:?}") };
        // A uniform rod ends at √(3gh). The foot of 0.1 kg at its lower end takes part of that, the more the shorter the rod.
        assert!((1.0..1.45).contains(&(judged / simulated)), "{height} mm: {judged} and {simulated} m/s");
    }
}

/// Returns programs that leave the plan of a robot that tips, and is allowed to, in `p`; with `MODL_WHOLE=1` more.
fn tipping() -> Vec<String> {
    let whole = whole();
    let heights: &[i32] = if whole { &[120, 160, 200, 300, 400] } else { &[200] };
    let trots: &[[i32; 2]] =
        if whole { &[[30, 300], [20, 500], [40, 500], [30, 600], [50, 400]] } else { &[[30, 400]] };
    let curls: &[i32] = if whole { &[-25, -30, -35, -40, -43] } else { &[-40] };
    let post = |height: &i32| {
        let post = POST.replace("HEIGHT", &format!("{height}mm"));
        format!("{post}let p = plan(Falls().lean())")
    };
    let trot = |[stride, beat]: &[i32; 2]| {
        let trot = TROT.replace("STRIDE", &format!("{stride}mm")).replace("BEAT", &format!("{beat}ms"));
        format!("{trot}let p = plan(Quadruped().walk())")
    };
    let curl = |to: &i32| format!("{CURL}let p = plan(Chain().curl({to}deg))");
    heights.iter().map(post).chain(trots.iter().map(trot)).chain(curls.iter().map(curl)).collect()
}

#[test]
fn a_robot_that_tips_and_may_travels_as_in_mujoco() {
    let cases: Vec<Case> = tipping().iter().map(|program| Case::of(program)).collect();
    let tasks: Vec<Value> = cases.iter().map(Case::task).collect();
    let mut wrong = vec![];
    for stiffness in STIFFNESSES {
        let Some(simulated) = played(&tasks, stiffness, "both", "") else { return };
        for (case, simulated) in cases.iter().zip(&simulated) {
            let verdict = verify(&case.plan);
            assert!(verdict.ok(), "{:?}", verdict.failures);
            assert!(!verdict.events.is_empty(), "it tips");
            let [x, y, _] = verdict.travel;
            let theirs = [0, 1].map(|axis| number(&simulated["travel"][axis]));
            let off = libm::hypot(theirs[0] - x, theirs[1] - y);
            let known = verdict.travel_within.expect("the robot stands on the ground");
            let row = format!(
                "| {stiffness} | {:.0}, {:.0} within {:.0} mm, {:.0}° | {:.0}, {:.0} mm, {:.0}° | {:.0} |",
                1e3 * x,
                1e3 * y,
                1e3 * known,
                verdict.heading.to_degrees(),
                1e3 * theirs[0],
                1e3 * theirs[1],
                number(&simulated["yaw"]).to_degrees(),
                1e3 * off
            );
            writeln!(std::io::stderr(), "{row}").expect("stderr is open");
            // A base that rolls over has no heading that simulations measure alike.
            let turned = stays_upright(simulated)
                && turned_apart(number(&simulated["yaw"]), verdict.heading)
                    > verdict.heading_within.expect("the robot stands on the ground");
            if off > known || turned {
                wrong.push(row);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Returns true if the base of a robot never leaned by more than 45 degrees in a simulation that began upright.
fn stays_upright(simulated: &Value) -> bool {
    let ups = simulated["ups"].as_array().expect("a list");
    ups.iter().all(|up| number(&up[2]) > std::f64::consts::FRAC_1_SQRT_2)
}
