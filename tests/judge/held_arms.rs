//! Arms whose base is held: the torques of weight at every instant beside their closed form, also between samples, and the
//! work that lifts them.

use crate::support::arms::robot_of;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{joint, link};
use crate::support::verdicts::status;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Shape, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Ground, Plan, Status, World};
use modl::robot::{Joint, JointKind, Limits, Link};

const HELD: World = World { ground: Ground::Held, ..STATICS };
const GRAVITY: f64 = 9.80665;
/// The length of a link, m.
const LENGTH: f64 = 0.5;

/// Returns a link that is a small ball, at a place in its frame (m), with a mass (kg).
fn ball(name: &str, mass: f64, at: Vec3) -> Link {
    let shape = vec![Placed { pose: shifted(at), shape: Shape::Sphere { radius: 0.001 } }];
    link(name, shape, mass, at, 0.5)
}

fn limited(name: &str, between: (usize, usize), kind: JointKind, at: Vec3, axis: Vec3, limit: f64) -> Joint {
    let effort = limit.is_finite().then_some(limit);
    let limits = Limits { range: Some((-3.0, 3.0)), speed: None, acceleration: None, effort };
    joint(name, between, kind, shifted(at), axis, limits)
}

/// Returns an arm along x at rest whose joints turn about y: a link for each mass (kg), which is in its middle, and a limit of
/// torque (N·m) for each joint.
fn arm(masses: &[f64], limits: &[f64]) -> Motion {
    let mut links = vec![ball("base", 1.0, Vec3::zeros())];
    let mut joints = vec![];
    for (index, (mass, limit)) in masses.iter().zip(limits).enumerate() {
        let at = Vec3::x() * (index as f64 * LENGTH);
        let mut next = ball(&format!("l{index}"), *mass, Vec3::x() * (LENGTH / 2.0));
        next.pose = shifted(at);
        links.push(next);
        let between = (index, index + 1);
        joints.push(limited(&format!("j{index}"), between, JointKind::Revolute, at, Vec3::y(), *limit));
    }
    Motion::new(robot_of(links, joints))
}

/// Returns the torque of weight at each joint of an arm, N·m. `lean`: the turn of the base about y, rad.
fn torques(masses: &[f64], angles: &[f64], lean: f64) -> Vec<f64> {
    let mut turn = lean;
    let (mut x, mut starts, mut middles) = (0.0, vec![], vec![]);
    for angle in angles {
        turn += angle;
        starts.push(x);
        middles.push(x + LENGTH / 2.0 * libm::cos(turn));
        x += LENGTH * libm::cos(turn);
    }
    let of = |joint: usize| {
        (joint..masses.len()).map(|k| masses[k] * GRAVITY * (middles[k] - starts[joint])).sum::<f64>().abs()
    };
    (0..masses.len()).map(of).collect()
}

/// Returns a plan with few samples: they are no farther apart than 5 degrees of a joint's turn.
fn coarse(motion: Motion) -> Plan {
    let mut plan = motion.plan(HELD);
    plan.settings.sample = 10.0;
    plan
}

/// Turns the first joint evenly through 60 degrees in a second, 2.5 degrees past the level at the samples around it.
fn swung(motion: Motion) -> Motion {
    let [from, to] = [-17.5f64, 42.5].map(f64::to_radians);
    let mut motion = motion;
    motion.tracks.start.joints[0] = from;
    motion.segment(0, 0.0, 1.0, vec![from, to])
}

/// At the samples next to the peak the load is cos 2.5° of it, 0.99905.
#[test]
fn a_peak_of_torque_between_samples_is_found() {
    let (masses, peak) = ([1.0, 2.0], 2.0 * GRAVITY * LENGTH / 2.0);
    let judged = |limit: f64| verify(&coarse(swung(arm(&masses, &[f64::INFINITY, limit]))));
    let passes = judged(1.0002 * peak);
    assert!(passes.ok(), "{:#?}", passes.failures);
    assert_eq!(status(&passes, CheckKind::Torque), Status::Proved);
    let fails = judged(0.9995 * peak);
    let [over] = fails.failures.as_slice() else { panic!("{:#?}", fails.failures) };
    assert_eq!((over.kind, over.at.as_slice()), (CheckKind::Torque, &["r.j1".to_owned()][..]));
    let angle = f64::to_radians(-17.5 + 60.0 * over.time);
    assert!((over.value - peak * libm::cos(angle)).abs() < 1e-9, "{over:?}");
    assert!(over.value > over.limit);
}

#[test]
fn of_loads_that_are_over_their_limits_between_samples_the_greater_is_told() {
    let masses = [1.0, 2.0, 1.0];
    let peaks = torques(&masses, &[0.0; 3], 0.0);
    for (excess, told) in [([1.0009, 1.0005], "r.j1"), ([1.0005, 1.0009], "r.j2")] {
        let limits = [f64::INFINITY, peaks[1] / excess[0], peaks[2] / excess[1]];
        let verdict = verify(&coarse(swung(arm(&masses, &limits))));
        let [over] = verdict.failures.as_slice() else { panic!("{:#?}", verdict.failures) };
        assert_eq!(over.at, [told]);
    }
}

/// Random arms on a leaning base: a limit a little above the greatest load is proved, and one a little below it is refused.
#[test]
fn random_arms_hold_what_they_have_to_hold_and_no_more() {
    let mut random = SplitMix64(11);
    let mut number = |low: f64, high: f64| low + (high - low) * random.next_f64();
    for round in 0..12 {
        let masses = [number(0.2, 2.0), number(0.2, 2.0), number(0.2, 2.0), number(0.2, 2.0)];
        let lean = number(-1.0, 1.0);
        let ends: Vec<[f64; 2]> = (0..4).map(|_| [number(-1.5, 1.5), number(-1.5, 1.5)]).collect();
        // At rest at both ends: the part of the way at a part of the time is a quintic.
        let at = |u: f64| {
            let part = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
            ends.iter().map(|[a, b]| a + (b - a) * part).collect::<Vec<f64>>()
        };
        let own = round % 4;
        let steps = 4000;
        let load = |step: i32| torques(&masses, &at(f64::from(step) / f64::from(steps)), lean)[own];
        let greatest = (0..=steps).map(load).fold(0.0, f64::max);
        for (factor, holds) in [(1.0 + 1e-4, true), (1.0 - 1e-4, false)] {
            let mut limits = [f64::INFINITY; 4];
            limits[own] = factor * greatest;
            let mut motion = arm(&masses, &limits);
            motion.tracks.start.base = turned(Vec3::y(), lean);
            for (joint, [a, b]) in ends.iter().enumerate() {
                motion.tracks.start.joints[joint] = *a;
                motion = motion.segment(joint, 0.0, 3.0, vec![*a, *a, *a, *b, *b, *b]);
            }
            let plan = coarse(motion);
            let verdict = verify(&plan);
            let over = verdict.failures.iter().find(|failure| failure.kind == CheckKind::Torque);
            assert_eq!(over.is_none(), holds, "{round}: {factor} of {greatest}: {over:?}");
            if holds {
                assert_eq!(status(&verdict, CheckKind::Torque), Status::Proved, "{round}");
            }
        }
    }
}

/// Returns a slide, along an axis, with an arm that turns about x on it, whose mass of 1 kg is 2 m to its side.
fn sliding(axis: Vec3, force: f64, torque: f64) -> Motion {
    let mut slide = ball("slide", 1.0, Vec3::zeros());
    let at = Vec3::x() * 0.1;
    slide.pose = shifted(at);
    let mut bar = ball("bar", 1.0, Vec3::y() * 2.0);
    bar.pose = shifted(2.0 * at);
    let links = vec![ball("base", 1.0, Vec3::zeros()), slide, bar];
    let joints = vec![
        limited("out", (0, 1), JointKind::Prismatic, at, axis, force),
        limited("turn", (1, 2), JointKind::Revolute, 2.0 * at, Vec3::x(), torque),
    ];
    Motion::new(robot_of(links, joints)).segment(0, 0.0, 1.0, vec![0.0, 0.2])
}

/// A slide that runs level bears no weight, whatever hangs to its side; one that rises bears all of it.
#[test]
fn slides_bear_the_weight_along_them() {
    let failures = |axis: Vec3, force: f64, torque: f64| {
        let verdict = verify(&coarse(sliding(axis, force, torque)));
        let status = status(&verdict, CheckKind::Torque);
        let at: Vec<String> = verdict.failures.iter().flat_map(|failure| failure.at.clone()).collect();
        (at, matches!(status, Status::Sampled(_)))
    };
    let (weight, moment) = (2.0 * GRAVITY, 2.0 * GRAVITY);
    assert_eq!(failures(Vec3::x(), 1.0, 1.001 * moment), (vec![], true));
    assert_eq!(failures(Vec3::x(), 1.0, 0.999 * moment).0, ["r.turn"]);
    assert_eq!(failures(Vec3::z(), 1.001 * weight, 1.001 * moment), (vec![], true));
    assert_eq!(failures(Vec3::z(), 0.999 * weight, 1.001 * moment).0, ["r.out"]);
}

/// Motors do the work that lifts a weight, and get nothing back as it sinks.
#[test]
fn the_energy_is_that_of_the_weight_lifted() {
    let masses = [1.0, 2.0];
    let hanging = std::f64::consts::FRAC_PI_2;
    let energy = |way: &[f64]| {
        let mut motion = arm(&masses, &[f64::INFINITY; 2]);
        motion.tracks.start.joints[0] = way[0];
        for (index, pair) in way.windows(2).enumerate() {
            let (begin, [a, b]) = (2.0 * index as f64, [pair[0], pair[1]]);
            motion = motion.segment(0, begin, begin + 2.0, vec![a, a, a, b, b, b]);
        }
        verify(&motion.plan(HELD)).energy
    };
    let lifted = GRAVITY * (masses[0] * LENGTH / 2.0 + masses[1] * LENGTH * 1.5);
    for (way, times) in
        [(vec![hanging, 0.0], 1.0), (vec![hanging, 0.0, hanging], 1.0), (vec![0.0, hanging], 0.0)]
    {
        let done = energy(&way);
        assert!((done - times * lifted).abs() < 1e-3 * lifted, "{way:?}: {done} of {lifted}");
    }
    // There, back and there again is twice the work.
    let twice = energy(&[hanging, 0.0, hanging, 0.0]);
    assert!((twice / lifted - 2.0).abs() < 2e-3, "{twice} of {lifted}");
}
