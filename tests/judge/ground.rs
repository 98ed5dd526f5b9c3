//! The ground: attitudes, travel, tips. The numbers are those of a prototype in another language,
//! and closed forms where there are any.

use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{self, DISC, LEFT, LEFT_WHEEL, RIGHT, RIGHT_WHEEL, TILT};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::plan::verify::articulated::{Rollout, RolloutEnd, TipOver, Tolerances, roll_out};
use modl::robot::{Library, ModuleType};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a walk through a plan showed.
#[derive(Debug, Default)]
struct Seen {
    /// Turn and fall at the start; degrees, mm.
    settling: f64,
    start_fall: f64,
    /// Greatest fall after the start, mm, and greatest bound on the motion, mm.
    fall: f64,
    motion: f64,
    tips: Vec<(f64, TipOver)>,
    /// Travel of the base's body and of the centre of mass, mm; turn of the base, degrees.
    base: Vec3,
    centre: Vec3,
    heading: f64,
    /// Margin of the centre of mass in the contacts, first and last, mm; and in what supports it.
    margins: (Option<f64>, Option<f64>),
    margin_exact: Option<f64>,
    /// Modules in contact, first and last.
    contacts: (Vec<String>, Vec<String>),
    /// Loads by link at the start.
    loads: BTreeMap<usize, f64>,
    /// Slip by link, mm; of those with at least 5 % of the load in `slips_loaded`.
    slips: BTreeMap<usize, f64>,
    slips_loaded: BTreeMap<usize, f64>,
    samples: usize,
}

fn seen(motion: &Motion, step: f64) -> Seen {
    let tolerances = Tolerances::default();
    let mut plan = motion.clone().plan(STATICS);
    plan.settings.sample = step;
    let course = Rollout::of(&plan, &motion.tracks, &tolerances);
    let mut seen = Seen::default();
    let mut first: Option<(modl::geometry::Pose, Vec3)> = None;
    let mut yaw = 0.0;
    let ended = roll_out(course, None, motion.tracks.duration, &mut |sample, _| {
        seen.samples += 1;
        let (model, stance) = (sample.model, sample.stance);
        let pose = stance.base_pose(model);
        let centre = Vec3::new(stance.planar_pose.x, stance.planar_pose.y, stance.height);
        let (start, c) = *first.get_or_insert((pose, centre));
        seen.base = (pose.translation.vector - start.translation.vector) * 1e3;
        seen.centre = (centre - c) * 1e3;
        let x = pose.rotation * start.rotation.inverse() * Vec3::x();
        let now = libm::atan2(x.y, x.x).to_degrees();
        yaw += libm::remainder(now - yaw, 360.0);
        seen.heading = yaw;
        let margin = stance.margin(model).map(|m| m.distance * 1e3);
        let mut contacts: Vec<String> = stance
            .contact_points
            .iter()
            .filter(|t| t.gap <= 4e-3)
            .map(|t| model.module_name(t.link).to_owned())
            .collect();
        contacts.sort();
        contacts.dedup();
        if let Some(angle) = sample.settling {
            seen.settling = angle.to_degrees();
            seen.start_fall = sample.fall * 1e3;
            seen.margins.0 = margin;
            seen.margin_exact = stance.margin_exact(&tolerances).map(|m| m.distance * 1e3);
            seen.contacts.0 = contacts.clone();
            seen.loads = stance.patches.iter().map(|p| (p.link, p.load)).collect();
        } else {
            seen.fall = seen.fall.max(sample.fall * 1e3);
            seen.motion = seen.motion.max(sample.motion * 1e3);
        }
        (seen.margins.1, seen.contacts.1) = (margin, contacts);
        if let Some(tip) = sample.tip {
            seen.tips.push((sample.time, tip.clone()));
        }
        for &(link, slip, load) in sample.slips {
            *seen.slips.entry(link).or_default() += slip * 1e3;
            if load >= 0.05 {
                *seen.slips_loaded.entry(link).or_default() += slip * 1e3;
            }
        }
        true
    });
    assert_eq!(ended, RolloutEnd::AtEnd);
    seen
}

fn still(motion: &Motion) -> Seen {
    seen(motion, 0.01)
}

/// `value` is `expected` within the half of its last digit given.
fn close(value: f64, expected: f64, within: f64) {
    assert!((value - expected).abs() <= within, "{value} is not {expected} ± {within}");
}

#[test]
fn a_lone_module_leans_onto_its_disc() {
    let seen = still(&Motion::new(robots::chain(1)));
    close(seen.settling, 3.97, 0.005);
    close(seen.start_fall, 0.077, 0.0005);
    close(seen.margins.0.expect("three parts touch"), 1.11, 0.005);
    close(seen.loads[&LEFT_WHEEL] + seen.loads[&RIGHT_WHEEL], 0.975, 0.0005);
    close(seen.loads[&DISC], 0.025, 0.0005);
}

fn driver(left: f64, right: f64) -> Seen {
    let motion = Motion::new(robots::chain(1));
    seen(&motion.spin("m0", LEFT, left, 0.0, 1.0).spin("m0", RIGHT, right, 0.0, 1.0), 0.01)
}

#[test]
fn wheels_roll_without_slip() {
    let seen = driver(2.0, 2.0);
    close(seen.base.x, 2.0 * 45.3, 1e-3);
    close(seen.heading, 0.0, 1e-6);
    close(seen.slips[&LEFT_WHEEL], 0.0, 1e-3);
    assert!(!seen.slips_loaded.contains_key(&DISC), "the disc carries too little to be reported");
}

#[test]
fn wheels_against_each_other_turn_the_module() {
    let seen = driver(2.0, -2.0);
    close(seen.heading, -111.99, 0.005);
    close(libm::hypot(seen.base.x, seen.base.y), 0.10, 0.02);
    close(driver(2.0, 1.0).heading, -28.02, 0.005);
}

/// The prototype's robots are based at their first module.
fn first_based(mut robot: modl::robot::Assembly) -> modl::robot::Assembly {
    robot.base = 0;
    robot
}

fn chain3(tilts: [f64; 3]) -> Motion {
    let motion = Motion::new(first_based(robots::chain(3)));
    tilts.iter().enumerate().fold(motion, |m, (i, tilt)| m.set(&format!("m{i}"), TILT, *tilt))
}

#[test]
fn chains_rest_on_their_hull() {
    let seen = still(&chain3([30.0, -30.0, 30.0]));
    close(seen.settling, 15.0, 0.005);
    close(seen.start_fall, 24.94, 0.005);
    close(seen.margins.0.expect("head and tail"), 49.1, 0.05);
    assert_eq!(seen.contacts.0, ["m0", "m2"]);
    let seen = still(&chain3([-30.0, -30.0, -30.0]));
    close(seen.settling, 15.42, 0.005);
    // The back plate's inner corners are within the contact tolerance, too: the prototype had none.
    close(seen.margin_exact.expect("head and tail"), 20.7, 0.05);
    close(seen.margins.0.expect("head and tail"), 21.1, 0.05);
    let seen = still(&chain3([-75.0, 75.0, -75.0]));
    close(seen.settling, 9.71, 0.005);
    close(seen.margins.0.expect("head and middle"), 18.3, 0.05);
}

#[test]
fn there_and_back_is_nowhere() {
    let m = Motion::new(first_based(robots::chain(3)));
    let there = [30.0, -30.0, 30.0]
        .iter()
        .enumerate()
        .fold(m, |m, (i, tilt)| m.smooth(&format!("m{i}"), TILT, *tilt, 0.0, 1.0));
    let seen = seen(&there.there_and_back(), 0.01);
    close(seen.base.norm(), 0.0, 5e-4);
    assert!(seen.tips.is_empty());
}

#[test]
fn an_arching_chain_draws_itself_together() {
    // At 40 ms the prototype had 45.04: which contact takes over when is up to the shapes there.
    for (step, expected) in [(0.04, 45.41), (0.02, 45.24), (0.01, 45.24)] {
        let m = Motion::new(first_based(robots::chain(3)));
        let arch = (0..3).fold(m, |m, i| m.smooth(&format!("m{i}"), TILT, -30.0, 0.0, 1.0));
        let seen = seen(&arch, step);
        assert!(seen.tips.is_empty(), "{:?}", seen.tips);
        close(libm::hypot(seen.centre.x, seen.centre.y), expected, 0.005);
        if step == 0.04 {
            assert!(seen.fall < 0.305, "{}", seen.fall);
            close(2.0 * seen.motion, 11.6, 0.05);
        }
    }
}

#[test]
fn a_snake_rises_without_tipping() {
    let travels = [0.04, 0.02, 0.01].map(|step| {
        let m = Motion::new(first_based(robots::snake(6)));
        let tilt = |i: usize| if i.is_multiple_of(2) { 60.0 } else { -60.0 };
        let wave = (0..6).fold(m, |m, i| m.smooth(&format!("s{i}"), TILT, tilt(i), 0.0, 1.0));
        let seen = seen(&wave, step);
        assert!(seen.tips.is_empty());
        assert_eq!(seen.contacts.1, ["s0", "s2", "s4"]);
        close(seen.margins.1.expect("three modules"), 49.1, 0.05);
        seen.centre.x
    });
    // However long the steps, it gets to the same place.
    close(travels[0], travels[2], 0.5);
    close(travels[1], travels[2], 0.1);
}

const LEGS: [&str; 4] = ["fl", "fr", "bl", "br"];

fn walk4(lifted: &[&str]) -> Motion {
    let m = Motion::new(robots::walk4());
    let m = LEGS.iter().fold(m, |m, leg| m.set(&format!("{leg}_hip"), TILT, -90.0));
    lifted.iter().fold(m, |m, leg| {
        let m = m.smooth(&format!("{leg}_knee"), TILT, 30.0, 0.0, 1.0);
        m.smooth(&format!("{leg}_ankle"), TILT, -30.0, 0.0, 1.0)
    })
}

#[test]
fn a_walker_stands_on_two_legs() {
    close(still(&walk4(&[])).margins.0.expect("four feet"), 144.0, 0.05);
    let m = walk4(&["fl", "br"]);
    let seen = seen(&m, 0.01);
    assert!(seen.tips.is_empty());
    close(seen.margins.1.expect("two feet"), 61.1, 0.05);
    close(seen.heading, 0.0, 1e-3);
    for standing in ["fr_ankle", "bl_ankle"] {
        let module = m.joint(standing, 0) / 4;
        close(seen.slips[&(5 * module)], 0.0, 2e-3);
    }
}

#[test]
fn turning_the_standing_legs_carries_the_body() {
    for both in [false, true] {
        let lifted: &[&str] = if both { &[] } else { &["fl", "br"] };
        let mut m = walk4(lifted);
        let turned: &[(&str, usize)] = match both {
            false => &[("b0", RIGHT), ("b2", LEFT)],
            true => &[("b0", RIGHT), ("b2", LEFT), ("b0", LEFT), ("b2", RIGHT)],
        };
        for (module, joint) in turned {
            m = m.smooth(module, *joint, 10.0, 1.0, 2.0);
        }
        let seen = seen(&m, 0.01);
        assert!(seen.tips.is_empty());
        close(seen.base.x, 43.9, 0.1);
        close(seen.base.z, 3.63, 0.01);
        close(seen.heading, 0.0, 0.003);
    }
}

#[test]
fn a_car_rolls_and_its_idle_wheels_slip() {
    let mut m = Motion::new(robots::car());
    for module in ["front", "back", "fl", "fr", "bl", "br"] {
        for side in [LEFT, RIGHT] {
            m = m.spin(module, side, 2.0, 0.0, 1.0);
        }
    }
    let center = m.joint("center", 0) / 4;
    let seen = seen(&m, 0.01);
    close(seen.margins.0.expect("seven modules"), 148.0, 0.05);
    close(seen.base.x, 90.598, 1e-3);
    let idle = seen.slips[&(5 * center + LEFT_WHEEL)];
    close(idle, 90.6, 0.05);
}

#[test]
fn a_backhoe_tips_when_its_arm_is_out() {
    for (step, at, fall, motion) in
        [(0.01, 0.93, 62.5, 8.6), (0.02, 0.94, 62.0, 17.3), (0.04, 0.96, 61.0, 34.6)]
    {
        let m = Motion::new(robots::backhoe(8)).set("a0", TILT, 90.0).linear("a1", TILT, -90.0, 0.0, 2.0);
        let seen = seen(&m, step);
        let (time, tip) = seen.tips.first().expect("it tips");
        close(*time, at, 1e-9);
        close(tip.time, 0.9207, 5e-4);
        close(tip.fall * 1e3, fall, 0.1);
        close(tip.motion * 2e3, motion, 0.1);
    }
}

#[test]
fn a_backhoe_reaching_out_starts_on_its_nose() {
    let m = Motion::new(robots::backhoe(8)).set("a0", TILT, 90.0).set("a1", TILT, -90.0);
    let seen = still(&m);
    close(seen.settling, 9.09, 0.005);
    close(seen.start_fall, 8.13, 0.005);
}

fn ring(amplitude: f64, step: f64) -> Seen {
    let mut m = Motion::new(robots::ring12());
    let pi = std::f64::consts::PI;
    // The wave as quintics, so finely that they are the wave itself.
    let pieces = 400;
    for i in 0..12 {
        let joint = 4 * i + TILT;
        let phase = 2.0 * (2.0 * pi * i as f64 / 12.0);
        let at = |t: f64| (30.0 + amplitude * libm::cos(phase - pi * t)).to_radians();
        let rate = |t: f64| (amplitude * pi * libm::sin(phase - pi * t)).to_radians();
        m.tracks.start.joints[joint] = at(0.0);
        for k in 0..pieces {
            let (t0, t1) = (4.0 * k as f64 / pieces as f64, 4.0 * (k + 1) as f64 / pieces as f64);
            let third = (t1 - t0) / 3.0;
            m = m.segment(
                joint,
                t0,
                t1,
                vec![at(t0), at(t0) + rate(t0) * third, at(t1) - rate(t1) * third, at(t1)],
            );
        }
    }
    seen(&m, step)
}

#[test]
fn a_ring_rolls_without_tipping_unless_it_starts_on_a_bulge() {
    let smooth = ring(10.0, 0.01);
    assert!(smooth.tips.is_empty());
    assert!(smooth.fall <= 0.1);
    let bulging = ring(20.0, 0.01);
    let (_, tip) = bulging.tips.first().expect("it tips");
    assert!((0.34..=0.361).contains(&tip.time));
    assert!((66.5..=68.5).contains(&(tip.fall * 1e3)));
}

#[test]
fn a_module_rocks_on_its_round_wheels() {
    for side in [60.0, -60.0] {
        let m = Motion::new(robots::chain(1)).smooth("m0", TILT, side, 0.0, 1.0).there_and_back();
        let seen = seen(&m, 0.01);
        assert!(seen.tips.is_empty());
        assert!(seen.fall <= 0.3, "{}", seen.fall);
        close(seen.base.norm(), 0.0, 5e-4);
    }
}

#[test]
fn a_robot_rests_on_the_last_of_a_hundred_thousand_shapes() {
    // Specks that hang 30 mm above the ground, and a sole of 200 mm, the last of all shapes, that stands on it.
    let speck = Placed { pose: shifted(Vec3::z() * 0.03), shape: Shape::Sphere { radius: 1e-3 } };
    let specks = Placed { pose: Pose::identity(), shape: Shape::Union { parts: vec![speck; 100_000] } };
    let sole = robots::boxed(Vec3::new(-0.1, -0.1, -0.01), Vec3::new(0.1, 0.1, 0.0));
    let kind = ModuleType {
        name: "Specks".into(),
        links: vec![robots::link("body", vec![specks, sole], 1.0, Vec3::zeros(), 0.5)],
        joints: vec![],
        ports: vec![],
        motors: vec![],
        touching: vec![],
        touch: 1e-4,
        contact: 1e-3,
    };
    let library = Library { modules: vec![kind], ..Library::default() };
    let mut design = robots::Design::new("Specks", Arc::new(library));
    design.add("m");
    let seen = still(&Motion::new(design.0));
    close(seen.margins.0.expect("it stands on the sole"), 100.0, 1e-6);
    close(seen.settling, 0.0, 1e-6);
}
