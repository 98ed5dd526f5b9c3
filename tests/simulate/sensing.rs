//! Programs that are executed with sensors: an arm whose measurements have closed forms.

use super::fixtures::{GRAVITY, HELD, LEVEL, close, plan, play, step};
use crate::support::desk::run_clean;
use modl::geometry::{Placed, Shape, Vec3, pose::shifted};
use modl::plan::{Body, Ground, World};
use modl::simulate::{Refusal, Settings, Simulation, simulate};
use std::sync::Arc;

/// The world in which the base stands on level ground, and is fixed to it.
const FIXED: World = World { ground: Ground::Fixed, ..LEVEL };

/// An arm with a cube at its end: the joint is 25 mm above the ground, the cube's far face 220 mm from it.
const ARM: &str = "connector Hook { mates Hook, turns 4 }
module Arm {
  link post = box(50mm, 50mm, 50mm, mass: 1kg)
  link rod = box(160mm, 10mm, 10mm, mass: 200g) at [120mm, 0mm, 0mm]
  joint lift : post -> rod = revolute(axis: -Y, stiffness: 2000N*m/rad)
  port end : Hook on rod at [80mm, 0mm, 0mm] facing +X up +Z
}
module Tip {
  link cube = box(20mm, 20mm, 20mm, mass: 500g)
  port back : Hook on cube at [-10mm, 0mm, 0mm] facing -X up +Z
  port front : Hook on cube at [10mm, 0mm, 0mm] facing +X up +Z
}
config Reach(start: Angle) {
  part a: Arm
  part t: Tip
  set a.lift = start
  connect a.end -- t.back
  base a
  behavior stop = move(a.lift, by: 0deg)
}
";

/// Plays a behaviour of the arm `x` that begins at an angle (degrees).
fn played(start: f64, behavior: &str, world: World) -> Simulation {
    let program = format!("{ARM}let x = Reach({start}deg)\nlet b = {behavior}\n");
    play(&plan(&program, world), &Settings::default())
}

/// Returns the angle of the joint at the end, degrees.
fn end(simulation: &Simulation) -> f64 {
    simulation.motion.last().expect("it has moved").joints[0].to_degrees()
}

#[test]
fn an_action_ends_as_soon_as_a_module_leans() {
    let lifts = "Sc(move(x.a.lift, to: 60deg, in: 3s, until: tilt(x.t) > 30deg, timeout: 4s), x.stop())";
    let simulation = played(0.0, lifts, HELD);
    assert!(simulation.stop.is_none());
    close(end(&simulation), 30.0, 0.2);
    // The undisturbed run goes all the way.
    assert!(simulation.duration < 3.0, "{} s", simulation.duration);
}

#[test]
fn an_action_ends_at_a_torque() {
    // Rod and cube weigh on the joint with 0.2 kg at 120 mm and 0.5 kg at 210 mm, times the cosine.
    let most = GRAVITY * (0.2 * 0.12 + 0.5 * 0.21);
    let lowers = format!(
        "Sc(move(x.a.lift, to: 0deg, in: 8s, until: torque(x.a.lift) > {}N*m, timeout: 9s), x.stop())",
        most / 2.0
    );
    close(end(&played(85.0, &lowers, HELD)), 60.0, 0.5);
}

#[test]
fn an_action_ends_at_a_distance_of_ports() {
    // The front port is 220 mm from the joint, the arm's end 200 mm, whatever the angle: only time passes.
    let waits = "Sc(move(x.a.lift, to: 30deg, in: 1s, until: separation(x.a.end, x.t.front) > 21mm, timeout: 2s), \
        move(x.a.lift, to: 40deg, in: 1s, until: separation(x.a.end, x.t.front) > 19mm, timeout: 2s), x.stop())";
    let simulation = played(0.0, waits, HELD);
    close(end(&simulation), 30.0, 0.2);
    close(simulation.duration, 2.0, 0.01);
}

#[test]
fn an_arm_stops_where_it_touches_the_ground() {
    let lowers = "Sc(move(x.a.lift, to: -20deg, in: 4s, until: touching(x.t), timeout: 5s), x.stop())";
    // The lower far edge of the cube is 220 mm along and 10 mm below: 220 sin + 10 cos = 25.
    let expected = libm::asin(25.0 / libm::hypot(220.0, 10.0)) - libm::atan(10.0 / 220.0);
    close(end(&played(20.0, lowers, FIXED)), -expected.to_degrees(), 0.1);
}

#[test]
fn an_arm_stops_where_it_touches_an_obstacle() {
    let lowers = "Sc(move(x.a.lift, to: -20deg, in: 4s, until: touching(x.t), timeout: 5s), x.stop())";
    let program = format!("{ARM}let x = Reach(20deg)\nlet b = {lowers}\n");
    let size = Vec3::new(0.1, 0.1, 0.02);
    let step = Placed { pose: shifted(Vec3::new(0.2, 0.0, 0.01)), shape: Shape::Box { size } };
    let settings = Settings { obstacles: Arc::new([vec![step]]), ..Settings::default() };
    // The lower near edge of the cube is 200 mm along and 10 mm below, the step 5 mm below the joint: 200 sin - 10 cos = -5.
    let expected = libm::atan(10.0 / 200.0) - libm::asin(5.0 / libm::hypot(200.0, 10.0));
    close(end(&play(&plan(&program, FIXED), &settings)), expected.to_degrees(), 0.1);
}

#[test]
fn an_arm_stops_where_it_touches_another_robot_and_no_other() {
    // As the step above, a plate of 100 x 100 x 20 mm stands before the arm; the second one stands apart.
    let expected = libm::atan(10.0 / 200.0) - libm::asin(5.0 / libm::hypot(200.0, 10.0));
    for (plate, stopped) in [("near", true), ("far", false)] {
        let program = format!(
            "{ARM}module Plate {{ link body = box(100mm, 100mm, 20mm, mass: 1kg) }}
scene Around {{
  part r: Reach(20deg) at [0mm, 0mm, 25mm]
  part near: Plate at [200mm, 0mm, 10mm]
  part far: Plate at [500mm, 0mm, 10mm]
}}
let x = Around()
let until = touching(x.r.t, x.{plate})
let lowers = move(x.r.a.lift, to: 0deg, in: 4s, profile: linear, until: until, timeout: 5s)
print(simulate(plan(Sc(lowers, x.r.stop()), world: world(ground: fixed))).duration / 1s)
"
        );
        let printed = run_clean(&program).printed;
        let duration: f64 = printed[0].parse().expect("a number");
        // What it is not to touch ends nothing: it goes on until its time is out.
        let reached = 4.0 * (20.0 - expected.to_degrees()) / 20.0;
        close(duration, if stopped { reached } else { 5.0 }, 5e-3);
    }
}

#[test]
fn what_touches_nothing_goes_on_as_its_else_says() {
    let waits = "Sc(move(x.a.lift, to: 10deg, in: 1s, until: touching(x.t), timeout: 2s) \
        else move(x.a.lift, to: 50deg, in: 1s), wait(500ms))";
    let simulation = played(20.0, waits, FIXED);
    close(end(&simulation), 50.0, 0.2);
    close(simulation.duration, 3.5, 1e-3);
}

#[test]
fn an_abort_is_a_failure_and_stops_the_robot() {
    let waits = "Sc(move(x.a.lift, to: 60deg, in: 4s, until: touching(x.t), timeout: 2s) else abort(\"nothing there\"), \
        move(x.a.lift, to: 0deg, in: 1s))";
    let simulation = played(20.0, waits, FIXED);
    let (time, reason) = simulation.stop.clone().expect("it is aborted");
    close(time, 2.0, 1e-3);
    assert_eq!(reason, "the program is aborted: nothing there");
    // It is half of the way by then, and rests.
    close(end(&simulation), 40.0, 0.2);
}

#[test]
fn a_repetition_ends_after_the_round_in_which_its_condition_holds() {
    let steps = "repeat(move(x.a.lift, by: 10deg, in: 500ms), until: tilt(x.t) > 25deg, max: 7)";
    let simulation = played(0.0, steps, HELD);
    close(end(&simulation), 30.0, 0.2);
    close(simulation.duration, 1.5, 1e-3);
}

#[test]
fn a_program_that_waits_for_ever_is_stopped() {
    // It lags behind by its weight, and never gets there.
    let waits = "Sc(move(x.a.lift, to: 30deg, in: 1s, until: angle(x.a.lift) >= 30deg), wait(1s))";
    let program = format!("{ARM}let x = Reach(0deg)\nlet b = {waits}\n");
    let simulation = play(&plan(&program, HELD), &step(5e-3));
    let (time, reason) = simulation.stop.expect("it is stopped");
    // Twice the plan's 2 s, and a minute.
    close(time, 64.0, 0.1);
    assert_eq!(reason, "the program stops: more than 64 seconds");
}

#[test]
fn a_branch_may_undock_what_the_plan_does_not() {
    let drops = "Sc(move(x.a.lift, to: -10deg, in: 1s, until: touching(x.t), timeout: 1s) else undock(x.a.end), wait(1s))";
    let simulation = played(0.0, drops, HELD);
    // It falls freely, away from the face that it hung on, and sinks at 0.5 m/s after 51 ms.
    let fall = simulation.fall.expect("the cube falls");
    close(fall, 1.0 + 0.5 / GRAVITY, 0.01);
}

#[test]
fn a_branch_of_executed_programs_is_the_same_at_half_the_step() {
    let lowers = "Sc(move(x.a.lift, to: -20deg, in: 4s, until: touching(x.t), timeout: 5s), x.stop())";
    let program = format!("{ARM}let x = Reach(20deg)\nlet b = {lowers}\n");
    let plan = plan(&program, FIXED);
    let [coarse, fine] = [5e-4, 2.5e-4].map(|h| end(&play(&plan, &step(h))));
    close(coarse, fine, 0.01);
}

#[test]
fn a_plan_whose_program_makes_another_motion_is_refused() {
    let lifts = "Sc(move(x.a.lift, to: 60deg, in: 3s, until: tilt(x.t) > 30deg, timeout: 4s), x.stop())";
    let program = format!("{ARM}let x = Reach(0deg)\nlet b = {lifts}\n");
    let mut plan = plan(&program, HELD);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("it is a robot's plan") };
    tracks.tracks[0].segments[0].control[2] += 0.01;
    let refusal = simulate(&plan, &Settings::default()).expect_err("its program lifts otherwise");
    assert!(matches!(&refusal, Refusal::Unfaithful(words) if words.contains("a.lift")), "{refusal}");
}
