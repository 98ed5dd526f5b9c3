//! Simulations beside closed forms: of bonds that break and dock, and of joints that follow others or share motors.

use super::fixtures::{GRAVITY, HELD, close, plan, play, step};
use modl::plan::{Body, Plan};
use modl::robot::Capture;
use modl::simulate::{BondEvent, BondEventKind, ServoGains, Settings, Spread, study};
use std::sync::Arc;

/// A module of 2 kg below one that is held, by a bond of which `holds` is stated; with `aside` it sticks out by 100 mm.
fn hanging(holds: &str, aside: bool) -> String {
    let (facing, up) = if aside { ("+X", "+Z") } else { ("-Z", "+X") };
    format!(
        "connector Face {{ mates Face, turns 1, holds {holds} }}
module Top {{ link body = box(50mm, 50mm, 50mm, mass: 1kg)
  link lift = box(50mm, 50mm, 50mm, mass: 100g) at [100mm, 0mm, -100mm]
  joint slide : body -> lift = prismatic(axis: Z, stiffness: 100000N/m)
  port low : Face on lift at [0mm, 0mm, 0mm] facing {facing} up {up} }}
module Low {{ link body = box(50mm, 50mm, 50mm, mass: 2kg) at [100mm, 0mm, 0mm]
  port high : Face on body at [-100mm, 0mm, 0mm] facing -X up +Z }}
config Hangs {{ part t: Top part l: Low connect t.low -- l.high
  base t
  behavior rest = wait(500ms)
  behavior lifts = move(t.slide, by: 100mm, in: 500ms)
}}
let x = Hangs()
"
    )
}

/// Returns the times at which bonds break, s, and under which part of what they hold.
fn breaks(events: &[BondEvent]) -> Vec<(f64, f64)> {
    let of = |event: &BondEvent| match event.kind {
        BondEventKind::Breaks(load) => Some((event.time, load)),
        _ => None,
    };
    events.iter().filter_map(of).collect()
}

#[test]
fn a_bond_holds_what_is_just_below_its_strength_and_no_more() {
    let weight = 2.0 * GRAVITY;
    for part in [0.99, 1.01] {
        // Of a weight that pulls, and of one at a lever of 100 mm.
        for (holds, aside) in
            [(format!("{}N", weight / part), false), (format!("{}N*m", 0.1 * weight / part), true)]
        {
            let program = format!("{}let b = x.rest()\n", hanging(&holds, aside));
            let simulation = play(&plan(&program, HELD), &Settings::default());
            let broken = breaks(&simulation.bonds);
            assert_eq!(broken.len(), usize::from(part > 1.0), "{part} of {holds}: {broken:?}");
            close(simulation.bond_load.expect("its strength is stated").value, part, 0.005);
            assert_eq!(simulation.fall.is_some(), part > 1.0, "{part} of {holds}");
        }
    }
    // A weight across the bond does not pull.
    let simulation =
        play(&plan(&format!("{}let b = x.rest()\n", hanging("1N", true)), HELD), &Settings::default());
    assert_eq!(simulation.bonds, []);
}

#[test]
fn a_bond_breaks_when_its_load_is_accelerated() {
    // A quintic over s in T accelerates by 10/√3 s/T² at most, at 0.2113 T: here by 2.309 m/s².
    let greatest = 10.0 / 3_f64.sqrt() * 0.1 / 0.25;
    let load = |holds: f64| {
        let program = format!("{}let b = x.lifts()\n", hanging(&format!("{holds}N"), false));
        play(&plan(&program, HELD), &Settings::default())
    };
    let needed = 2.0 * (GRAVITY + greatest);
    let held = load(needed * 1.02);
    assert_eq!(held.bonds, []);
    close(held.bond_load.expect("its strength is stated").value, 1.0 / 1.02, 0.01);
    let broken = breaks(&load(2.0 * (GRAVITY + 0.9 * greatest)).bonds);
    let [(time, _)] = broken[..] else { panic!("it does not break once: {broken:?}") };
    assert!(time > 0.03 && time < 0.2113 * 0.5, "{time}");
}

#[test]
fn modules_that_hang_together_move_as_one_body() {
    // A bond whose strength is stated is a joint that does not move; without one, both modules are one body. They turn about
    // skew axes, with products of inertia.
    let swung = |holds: &str| {
        let program = format!(
            "connector Face {{ mates Face, turns 4{holds} }}
module Post {{ link foot = box(60mm, 60mm, 60mm, mass: 2kg)
  link arm = box(200mm, 20mm, 20mm, mass: 500g) at [100mm, 0mm, 0mm]
  touching foot arm
  joint turn : foot -> arm = revolute(axis: [1, 2, 2], passive: true)
  port end : Face on arm at [100mm, 0mm, 0mm] facing +X up +Z }}
module Club {{ link head = box(40mm, 90mm, 20mm, mass: 700g)
  link side = box(30mm, 30mm, 80mm, mass: 300g) at [0mm, 40mm, 50mm]
  link tip = box(20mm, 20mm, 60mm, mass: 200g) at [0mm, 0mm, 80mm]
  touching head tip
  touching side tip
  joint glue : head -> side = fixed()
  joint swing : head -> tip = revolute(axis: [2, 1, 0], passive: true)
  port grip : Face on head at [-20mm, 0mm, 0mm] facing -X up +Z }}
config Swings {{ part p: Post part c: Club connect p.end -- c.grip
  base p
  behavior rest = wait(1s) }}
let b = Swings().rest()
"
        );
        play(&plan(&program, HELD), &Settings { link_contacts: false, ..Settings::default() })
    };
    let (one, two) = (swung(""), swung(", holds 1000000N"));
    assert!(one.bond_load.is_none() && two.bond_load.is_some());
    for (a, b) in one.motion.iter().zip(&two.motion) {
        for (x, y) in a.joints.iter().zip(&b.joints) {
            close(*x, *y, 1e-9);
        }
    }
    let turned =
        one.motion.last().expect("it moves").joints.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
    assert!(turned > 0.5, "{turned}");
}

/// A module that is held, with a port to which the end of an arm docks that is 300 mm long and weighs 500 g.
const CRANE: &str = "connector Hook { mates Hook, turns 4, capture 5mm 5deg }
module Crane {
  link post = box(40mm, 40mm, 40mm, mass: 2kg)
  link lift = box(40mm, 40mm, 40mm, mass: 500g) at [0mm, 0mm, -300mm]
  joint slide : post -> lift = prismatic(axis: Z, stiffness: STIFFNESS)
  port hook : Hook on lift at [0mm, 0mm, -20mm] facing -Z up +X
  port holder : Hook on post at [500mm, 0mm, 0mm] facing +X up +Z
}
module Load {
  link body = box(40mm, 40mm, 40mm, mass: 1kg) at [300mm, 0mm, 0mm]
  port held : Hook on body at [-100mm, 0mm, 0mm] facing -X up +Z
  port eye : Hook on body at [-600mm, 0mm, -320mm] facing +Z up +X
}
config Lifts closed { part c: Crane part l: Load
  connect c.holder -- l.held
  connect c.hook -- l.eye
  base c
  behavior docks = Sc(undock(c.hook), move(c.slide, by: 50mm, in: 500ms), move(c.slide, by: -50mm, in: 500ms), wait(1s), dock(c.hook, l.eye), wait(1s))
}
let b = Lifts().docks()
";

#[test]
fn ports_dock_within_what_their_connectors_capture() {
    // The arm of 500 g sags by m g / k: 4.0 mm below where its port should be.
    let stiffness = 0.5 * GRAVITY / 4e-3;
    let program = CRANE.replace("STIFFNESS", &format!("{stiffness}N/m"));
    let mut plan = plan(&program, HELD);
    for (capture, docks, snaps) in [(4.2e-3, true, true), (4.2e-3, true, false), (3.8e-3, false, true)] {
        set_capture(&mut plan, Capture::at_rest(capture, 0.05));
        set_snaps(&mut plan, snaps);
        let simulation = play(&plan, &Settings::default());
        let [undocking, event] = simulation.bonds[..] else {
            panic!("it undocks and docks: {:?}", simulation.bonds)
        };
        assert_eq!((undocking.time, undocking.kind), (0.0, BondEventKind::Undocks));
        let (happens, distance, angle) = match event.kind {
            BondEventKind::Docks(distance, angle) => (true, distance, angle),
            BondEventKind::Misses(distance, angle) => (false, distance, angle),
            BondEventKind::Breaks(_) | BondEventKind::Undocks => panic!("nothing breaks"),
        };
        assert_eq!(happens, docks);
        close(distance, 4e-3, 2e-5);
        let farthest = simulation.dock_error().expect("ports are to dock");
        assert_eq!((farthest.value, simulation.misses()), (distance, !docks));
        close(angle, 0.0, 1e-6);
        // Docked ports are drawn in if their connector snaps; else they hold where they are.
        let slide = simulation.motion.last().expect("it moves").joints[0];
        close(slide, if docks && snaps { 0.0 } else { -4e-3 }, 1e-4);
    }
}

#[test]
fn heavier_arms_miss_their_ports() {
    let program = CRANE.replace("STIFFNESS", &format!("{}N/m", 0.5 * GRAVITY / 4e-3));
    let plan = plan(&program, HELD);
    let spread = Spread { mass: 0.4, ..Spread::default() };
    let runs = study(&plan, &Settings::default(), &spread, 12, 0).expect("it is played");
    // Masses sag as they weigh, 4.0 mm as stated, and the connector captures 5 mm.
    for run in &runs {
        assert_eq!(run.outcome.misses(), run.factors.mass * 4e-3 > 5e-3, "{:?}", run.factors);
    }
    let missing = runs.iter().filter(|run| run.outcome.misses()).count();
    assert!((1..runs.len()).contains(&missing), "some dock, some miss: {missing}");
}

#[test]
fn a_program_knows_at_once_that_ports_missed_each_other() {
    let asks = "dock(c.hook, l.eye), move(c.slide, by: 0mm, in: 1s, until: docked(c.hook), timeout: 2s) else abort(\"missed\"))";
    let program = CRANE
        .replace("STIFFNESS", &format!("{}N/m", 0.5 * GRAVITY / 4e-3))
        .replace("dock(c.hook, l.eye), wait(1s))", asks);
    let mut plan = plan(&program, HELD);
    assert!(plan.nominal);
    for (capture, docks) in [(4.2e-3, true), (3.8e-3, false)] {
        set_capture(&mut plan, Capture::at_rest(capture, 0.05));
        let simulation = play(&plan, &Settings::default());
        assert_eq!(simulation.stop.is_none(), docks, "{:?}", simulation.stop);
    }
}

fn set_capture(plan: &mut Plan, capture: Capture) {
    let mut library = (*plan.library).clone();
    library.connectors.iter_mut().for_each(|connector| connector.capture = Some(capture));
    plan.library = Arc::new(library);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    tracks.robot.library = plan.library.clone();
}

fn set_snaps(plan: &mut Plan, snaps: bool) {
    let mut library = (*plan.library).clone();
    library.connectors.iter_mut().for_each(|connector| connector.snaps = snaps);
    plan.library = Arc::new(library);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    tracks.robot.library = plan.library.clone();
}

/// A module whose second arm follows the first by -1/2, and a third the sum of both by 1 and 2; each carries a weight.
const FOLLOWERS: &str = "module Linked {
  link post = box(40mm, 200mm, 40mm, mass: 2kg)
  link a = box(200mm, 20mm, 20mm, mass: 500g) at [100mm, 0mm, 0mm]
  link b = box(200mm, 20mm, 20mm, mass: 500g) at [100mm, 60mm, 0mm]
  link c = box(200mm, 20mm, 20mm, mass: 500g) at [100mm, -60mm, 0mm]
  touching post a
  touching post b
  touching post c
  joint first : post -> a = revolute(axis: -Y, max_torque: 20N*m, stiffness: 300N*m/rad)
  joint second : post -> b = revolute(axis: -Y)
  joint second = -0.5 * first
  joint free : post -> c = revolute(axis: -Y)
  joint free = first + 2 * second
}
config Follows { part m: Linked
  base m
  behavior swings = Sc(move(m.first, to: 60deg, in: 700ms), move(m.first, to: -60deg, in: 1s), wait(500ms))
}
let b = Follows().swings()
";

#[test]
fn joints_that_follow_others_keep_their_relation() {
    let simulation = play(&plan(FOLLOWERS, HELD), &Settings::default());
    for moment in &simulation.motion {
        let q = &moment.joints;
        close(q[1], -0.5 * q[0], 1e-3);
        close(q[2], q[0] + 2.0 * q[1], 1e-3);
    }
    // At rest the servo carries all: what the followers need counts by their factors, the third by 1 - 2/2 = 0.
    let q = &simulation.motion.last().expect("it moves").joints;
    let weigh = |angle: f64| 0.5 * GRAVITY * 0.1 * libm::cos(angle);
    let torque = 300.0 * (-60_f64.to_radians() - q[0]);
    close(torque, weigh(q[0]) - 0.5 * weigh(q[1]), 1e-3);
}

/// Two arms whose motors drive their sum and their difference, 1 N·m each; both weigh 0.9807 N·m where `factor` is 1.
fn coupled(second: f64) -> String {
    format!(
        "module Differential {{
  link post = box(40mm, 200mm, 40mm, mass: 2kg)
  link a = box(200mm, 20mm, 20mm, mass: 1kg) at [100mm, 60mm, 0mm]
  link b = box(200mm, 20mm, 20mm, mass: {second}kg) at [100mm, -60mm, 0mm]
  touching post a
  touching post b
  joint left : post -> a = revolute(axis: -Y, stiffness: 150N*m/rad)
  joint right : post -> b = revolute(axis: -Y, stiffness: 150N*m/rad)
  motor sum = left + right (max_torque: 1N*m)
  motor difference = left - right (max_torque: 1N*m)
}}
config Arms {{ part d: Differential
  base d
  behavior rest = wait(1s)
}}
let b = Arms().rest()
"
    )
}

#[test]
fn motors_that_drive_joints_together_bear_their_sum_and_difference() {
    // The motors bear half of the sum and of the difference of the joints' torques, for their speeds are sum and
    // difference of the joints': two equal torques t need t of one motor, and one alone needs t/2 of both.
    let one = GRAVITY * 0.1;
    for (second, needed) in [(1.0, one), (0.001, 0.5 * 1.001 * one)] {
        let plan = plan(&coupled(second), HELD);
        for (part, held) in [(1.03, true), (0.97, false)] {
            let servo = ServoGains { effort: part * needed, ..ServoGains::default() };
            let played = play(&plan, &Settings { servo, ..step(1e-3) });
            let lag = played.lag.expect("it is driven").value;
            assert_eq!(lag < 0.02, held, "{part} of {needed} N·m for {second} kg: {lag}");
            // Limits are times the same factor: a motor that holds bears 1/1.03 of its own.
            let effort = played.effort.expect("its motors have limits").value;
            if held {
                close(effort, 1.0 / part, 5e-3);
            } else {
                close(effort, 1.0, 1e-9);
                assert!(played.saturated.expect("its motors have limits").value > 0.5);
            }
        }
    }
}
