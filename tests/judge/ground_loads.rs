//! The forces of the ground under statics: how they are spread over many feet, beside a search through all sets of feet, and
//! the best that friction allows, beside closed forms.
#![allow(non_snake_case)]

use crate::support::arms::robot_of;
use crate::support::desk::run_clean;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{joint, link};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Shape, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::verify::articulated::{Rollout, Tolerances, roll_out};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Ground, Plan, World};
use modl::robot::{Joint, JointKind, Limits, Link};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};

const FIXED: World = World { ground: Ground::Fixed, ..STATICS };
const GRAVITY: f64 = 9.80665;
/// The radius of a foot, m.
const FOOT: f64 = 0.005;

/// Returns a ball with its lowest point at a place, m.
fn foot(at: Vec3) -> Placed {
    Placed { pose: shifted(at + Vec3::z() * FOOT), shape: Shape::Sphere { radius: FOOT } }
}

fn part(name: &str, shape: Vec<Placed>, mass: f64, centre: Vec3, friction: f64) -> Link {
    link(name, shape, mass, centre, friction)
}

fn hinge(name: &str, between: (usize, usize), at: Vec3, limit: f64) -> Joint {
    let limits = Limits { range: Some((-1.0, 1.0)), speed: None, acceleration: None, effort: Some(limit) };
    joint(name, between, JointKind::Revolute, shifted(at), Vec3::y(), limits)
}

/// Returns a robot of one link with feet at places over the ground, and its centre of mass there, m.
fn table(feet: &[Vec3], centre: Vec3) -> Plan {
    let shape = feet.iter().map(|at| foot(*at)).collect();
    Motion::new(robot_of(vec![part("table", shape, 2.0, centre, 0.5)], vec![])).plan(FIXED)
}

/// Returns the loads of the feet of a table, in parts of its weight.
fn loads(plan: &Plan, feet: &[Vec3]) -> Vec<f64> {
    let tracks = plan.body.tracks().expect("a robot of modules");
    let tolerances = Tolerances::default();
    let mut found = vec![0.0; feet.len()];
    roll_out(Rollout::of(plan, tracks, &tolerances), None, 0.0, &mut |sample, _| {
        for point in &sample.stance.contact_points {
            let at = sample.stance.world_point(&point.p);
            let own = feet.iter().position(|foot| (foot - at).xy().norm() < 1e-6);
            found[own.expect("it is one of the feet")] += point.load;
        }
        true
    });
    found
}

/// Returns the loads of springs that only push, of least energy among those that carry a weight at `centre`: by trying every
/// set of springs that may be pressed. A foot is as stiff as its gap leaves of 1 mm, a thousandth at least, and the square of
/// that counts.
fn least_energy(feet: &[Vec3], centre: Vec3) -> Vec<f64> {
    let stiffness = |foot: &Vec3| {
        let part = (1.0 - foot.z / 1e-3).max(1e-3);
        if foot.z <= 1e-3 { part * part } else { 0.0 }
    };
    let place = |foot: &Vec3| Vector3::new(1.0, foot.x - centre.x, foot.y - centre.y);
    let pressed = |multipliers: &Vector3<f64>, foot: &Vec3| multipliers.dot(&place(foot));
    for set in 1..1_usize << feet.len() {
        let own: Vec<bool> = (0..feet.len()).map(|index| set >> index & 1 == 1).collect();
        let mut normal = Matrix3::zeros();
        for (foot, _) in feet.iter().zip(&own).filter(|(_, own)| **own) {
            normal += place(foot) * place(foot).transpose() * stiffness(foot);
        }
        let Some(multipliers) = normal.lu().solve(&Vector3::x()) else { continue };
        let fits = feet
            .iter()
            .zip(&own)
            .all(|(foot, own)| stiffness(foot) == 0.0 || (pressed(&multipliers, foot) > 0.0) == *own);
        let all = feet.iter().zip(&own);
        let found: Vec<f64> = all
            .map(|(foot, own)| if *own { stiffness(foot) * pressed(&multipliers, foot) } else { 0.0 })
            .collect();
        if fits && (found.iter().sum::<f64>() - 1.0).abs() < 1e-6 {
            return found;
        }
    }
    panic!("no feet carry it")
}

#[test]
fn feet_carry_as_springs_of_least_energy_do() {
    let mut random = SplitMix64(3);
    let mut compared = 0;
    for count in [3, 4, 5, 6, 7, 7, 8, 8] {
        for _ in 0..4 {
            let mut feet: Vec<Vec3> = (0..count)
                .map(|_| Vec3::new(random.next_signed(), random.next_signed(), 1.2e-3 * random.next_f64()))
                .collect();
            let lowest = feet.iter().map(|foot| foot.z).fold(f64::INFINITY, f64::min);
            feet.iter_mut().for_each(|foot| foot.z -= lowest);
            // The weight is among the feet that bear some of it, often near one of them.
            let near: Vec<Vec3> = feet.iter().copied().filter(|foot| foot.z < 0.9e-3).collect();
            let parts: Vec<f64> = near.iter().map(|_| libm::pow(random.next_f64(), 4.0)).collect();
            let sum: Vec3 = near.iter().zip(&parts).map(|(foot, part)| foot * *part).sum();
            let mut centre = sum / parts.iter().sum::<f64>();
            centre.z = FOOT;
            if near.len() < 3 {
                continue;
            }
            let (found, expected) = (loads(&table(&feet, centre), &feet), least_energy(&feet, centre));
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-6, "{feet:?} {centre:?}: {found} of {expected}");
            }
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}

/// Two halves lean against each other at a hinge on top, each of 1 kg above it and with two feet.
fn frame(heading: f64, friction: f64, limit: f64) -> Plan {
    let (apart, height, deep) = (0.2, 0.3, 0.1);
    let half = |name: &str, side: f64| {
        let feet = [-deep, deep].map(|y| foot(Vec3::new(side * apart, y, 0.0)));
        let top = Placed { pose: shifted(Vec3::z() * height), shape: Shape::Sphere { radius: FOOT } };
        let shape = feet.into_iter().chain([top]).collect();
        // The left feet hold on better.
        let friction = if side < 0.0 { 6.0 * friction } else { 2.0 * friction };
        part(name, shape, 1.0, Vec3::z() * height, friction)
    };
    let top = hinge("top", (0, 1), Vec3::z() * height, limit);
    let mut robot = robot_of(vec![half("left", -1.0), half("right", 1.0)], vec![top]);
    let kinds = &mut std::sync::Arc::make_mut(&mut robot.library).modules;
    kinds[0].touching = vec![(0, 1)];
    let mut motion = Motion::new(robot);
    motion.tracks.start.base = turned(Vec3::z(), heading);
    // The ground takes half of each link's friction.
    motion.plan(World { friction: 0.5, ..STATICS })
}

/// Feet that spread are held together by friction, as far as it goes, and the hinge holds the rest. Friction is that of
/// pyramids whose edges are on the cones, at 45 degrees to the axes of the world.
#[test]
fn friction_relieves_a_hinge_as_far_as_it_goes() {
    let (weight, apart, height, limit, friction) = (GRAVITY, 0.2, 0.3, 1.2, 0.4);
    for eighth in 0..8 {
        let part = if eighth % 2 == 0 { FRAC_1_SQRT_2 } else { 1.0 };
        let torque = weight * (apart - part * friction * height);
        let verdict = verify(&frame(f64::from(eighth) * FRAC_PI_4, friction, limit));
        assert!(verdict.ok(), "{:#?}", verdict.failures);
        let margin = verdict.torque_margin.expect("the hinge has a limit").value;
        assert!((margin - (1.0 - torque / limit)).abs() < 1e-5, "{eighth}: {margin} {torque}");
        let fails = verify(&frame(f64::from(eighth) * FRAC_PI_4, friction, 0.999 * torque));
        assert_eq!(fails.failures.iter().map(|f| f.kind).collect::<Vec<_>>(), [CheckKind::Torque]);
        // That no forces do is proved by the multipliers.
        assert!(fails.notes.iter().all(|note| !note.contains("not proved")), "{:?}", fails.notes);
    }
    // Between the axes and the edges it is no more than the cone gives, and no less than along the axes.
    for degrees in [10.0, 33.0, 71.0, 100.0] {
        let verdict = verify(&frame(f64::to_radians(degrees), friction, limit));
        let torque = limit * (1.0 - verdict.torque_margin.expect("the hinge has a limit").value);
        let [least, most] = [1.0, FRAC_1_SQRT_2].map(|part| weight * (apart - part * friction * height));
        assert!((least - 1e-6..most + 1e-6).contains(&torque), "{degrees}: {torque}");
    }
}

/// A beam on three pairs of feet, at -0.2, 0 and 0.2 m, with a hinge at 0.1 m that bears `limit`, and a weight of 10 kg that
/// slides along it from place to place, a second each. Before, an arm turns upwards that uses all that its joint holds.
fn beam(places: [f64; 3], limit: f64) -> Plan {
    let pair = |x: f64| [-0.1, 0.1].map(|y| foot(Vec3::new(x, y, 0.0)));
    let left = pair(-0.2).into_iter().chain(pair(0.0)).collect();
    let light = 1e-3;
    let links = vec![
        part("left", left, light, Vec3::z() * FOOT, 0.5),
        part("right", pair(0.2).to_vec(), 0.3, Vec3::new(0.2, 0.0, FOOT), 0.5),
        part("weight", vec![foot(Vec3::z() * 0.1)], 10.0, Vec3::z() * (0.1 + FOOT), 0.5),
        part("arm", vec![foot(Vec3::new(0.0, 0.1, 0.3))], light, Vec3::new(0.0, 0.1, 0.3 + FOOT), 0.5),
    ];
    let range = Limits { range: Some((-2.0, 2.0)), ..Limits::default() };
    let up = joint("up", (0, 3), JointKind::Revolute, shifted(Vec3::z() * 0.3), Vec3::x(), range);
    let effort = Some(light * GRAVITY * 0.1 * 1.001);
    let joints = vec![
        hinge("fold", (0, 1), Vec3::x() * 0.1, limit),
        joint("slide", (0, 2), JointKind::Prismatic, shifted(Vec3::zeros()), Vec3::x(), range),
        Joint { limits: Limits { effort, ..range }, ..up },
    ];
    let mut motion = Motion::new(robot_of(links, joints));
    motion.tracks.start.joints[1] = places[0];
    let motion = motion.segment(2, 0.0, 1.0, vec![0.0, FRAC_PI_2]);
    let motion = motion.segment(1, 1.0, 2.0, vec![places[0], places[1]]);
    let motion = motion.segment(1, 2.0, 3.0, vec![places[1], places[2]]);
    let mut plan = motion.plan(World { friction: 0.0, ..FIXED });
    plan.settings.sample = 1.0;
    plan
}

/// With the weight beyond the middle the last feet carry at least its lever's part of it, since none can pull: that is what the
/// hinge holds. Nearer to the first feet they need not carry anything.
#[test]
fn feet_push_and_do_not_pull() {
    let needed = |x: f64| 10.0 * GRAVITY * f64::max(x, 0.0) / 0.2 * 0.1;
    let limit = needed(0.017);
    for (end, holds) in [(0.016, true), (0.018, false)] {
        for middle in [-0.01, 0.0, 0.01] {
            let verdict = verify(&beam([-0.19, middle, end], limit));
            let failed: Vec<_> = verdict.failures.iter().map(|failure| failure.at.clone()).collect();
            let expected: &[Vec<String>] = if holds { &[] } else { &[vec!["r.fold".to_owned()]] };
            assert_eq!(failed, expected, "{middle} {end} {:#?}", verdict.failures);
        }
    }
}

/// Two arms of 1 kg between a held frame's posts, docked at their tips.
const BRIDGE: &str = "
connector Face { mates Face, turns 4 }
module Frame {
  link body = box(1100mm, 40mm, 40mm, mass: 5kg) at [0mm, 0mm, -200mm]
  port left: Face on body at [-500mm, 0mm, 200mm] facing +X up +Z
  port right: Face on body at [500mm, 0mm, 200mm] facing -X up +Z
}
module Arm {
  link root = box(20mm, 20mm, 20mm, mass: 100g)
  link bar = box(440mm, 20mm, 20mm, mass: 1kg) at [250mm, 0mm, 0mm]
  joint lift : root -> bar = revolute(axis: Y, range: -90deg..90deg, max_torque: 1N*m) at [15mm, 0mm, 0mm]
  port back: Face on root at [-10mm, 0mm, 0mm] facing -X up +Z
  port tip: Face on bar at [240mm, 0mm, 0mm] facing +X up +Z
}
config Bridge(docked: Bool) closed {
  part frame: Frame
  part arm[2]: Arm
  connect frame.left -- arm[0].back
  connect frame.right -- arm[1].back
  if docked { connect arm[0].tip -- arm[1].tip }
  base frame
}
for docked in [true, false] {
  let b = Bridge(docked)
  let v = verify(Pc(wait(100ms), move(b.arm[0].lift, to: 0deg, in: 100ms)), world: world(ground: held, dynamics: statics))
  print(len(v.failures))
  print(v.torque_margin)
  print(v)
}
";

/// Docked at their tips the arms are one beam, and the torque at its ends is none; else each joint holds its arm out.
#[test]
fn arms_that_hold_each_other_need_no_torque() {
    let printed = run_clean(BRIDGE).printed;
    assert_eq!(printed[..2], ["0", "1"], "{printed:#?}");
    assert!(printed.iter().any(|line| line == "  torque: sampled(2)"), "{printed:#?}");
    let closures = printed.iter().filter(|line| line.starts_with("  closure: ")).collect::<Vec<_>>();
    assert_eq!(closures, ["  closure: sampled(2)", "  closure: proved"]);
    let alone = printed.iter().position(|line| line == "2").expect("neither holds its own");
    let margin: f64 = printed[alone + 1].parse().expect("a number");
    assert!((margin - (1.0 - GRAVITY * 0.235)).abs() < 1e-9, "{margin}");
}
