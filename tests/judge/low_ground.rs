//! The judge's words on robots on the ground: how they settle, what a slope needs, how far stability is proved, and at how many
//! samples.
#![allow(non_snake_case)]

use crate::support::arms::robot_of;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{self, LEFT, RIGHT, TILT, boxed, joint, link};
use crate::support::verdicts::status;
use modl::geometry::{Pose, Vec3};
use modl::plan::verify::articulated::{Detail, Rollout, Tolerances, base_at, instants, roll_out};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Ground, Plan, Status, World, WorldFrom};
use modl::robot::{Assembly, JointKind, Limits};

/// Returns the plan of a motion, which is kept, in a world.
fn planned(motion: &Motion, world: World) -> Plan {
    Motion { tracks: motion.tracks.clone() }.plan(world)
}

/// Returns a body on the ground with a mass on a slide along an axis, of which neither reaches the ground.
fn slider(size: Vec3, body: f64, mass: f64, axis: Vec3) -> Assembly {
    let low = Vec3::new(-size.x / 2.0, -size.y / 2.0, 0.0);
    let body = link("body", vec![boxed(low, low + size)], body, Vec3::z() * (size.z / 2.0), 1.0);
    let at = Vec3::z() * (size.z + 0.05);
    let cube = vec![boxed(at - Vec3::repeat(0.02), at + Vec3::repeat(0.02))];
    let limits = Limits { range: None, speed: None, acceleration: None, effort: None };
    let slide = joint("slide", (0, 1), JointKind::Prismatic, Pose::identity(), axis, limits);
    robot_of(vec![body, link("mass", cube, mass, at, 1.0)], vec![slide])
}

#[test]
fn how_far_a_robot_settles_at_its_start_is_told_if_it_falls() {
    let bent = [30.0, -30.0, 30.0].into_iter().enumerate();
    let bent = bent.fold(Motion::new(robots::chain(3)), |m, (i, tilt)| m.set(&format!("m{i}"), TILT, tilt));
    let told = |motion: &Motion| -> Vec<String> {
        let notes = verify(&planned(motion, STATICS)).notes;
        notes.into_iter().filter(|note| note.contains("settles")).collect()
    };
    // By half the angle of its tail, as the prototype did.
    let [note] = told(&bent).try_into().expect("it falls by 25 mm");
    assert!(note.starts_with("the start settles by 15"), "{note}");
    // A lone module leans by 4° and falls by less than 0.1 mm; a block does not move at all.
    assert_eq!(told(&Motion::new(robots::chain(1))), Vec::<String>::new());
    assert_eq!(told(&Motion::new(slider(Vec3::repeat(0.2), 1.0, 1.0, Vec3::x()))), Vec::<String>::new());
}

/// The friction that a slope needs is its tangent; what bears the robot has that of its body times that of the world.
#[test]
fn a_slope_tells_the_friction_that_it_needs_and_has() {
    for (friction, holds) in [(0.5, true), (0.2, false)] {
        let motion =
            Motion::new(slider(Vec3::repeat(0.2), 1.0, 0.1, Vec3::x())).segment(0, 0.0, 1.0, vec![0.0, 0.01]);
        let rise = libm::tan(17_f64.to_radians());
        let verdict = verify(&motion.plan(World { slope: [rise, 0.0], friction, ..STATICS }));
        let note = verdict.notes.iter().find(|note| note.contains("slopes")).expect("it is told");
        assert!(note.contains("by 17deg") && note.contains("friction of 0.306"), "{note}");
        assert!(note.ends_with(&format!("is {friction}")), "{note}");
        let found = status(&verdict, CheckKind::Traction);
        assert_eq!(matches!(found, Status::Sampled(n) if n > 100), holds, "{found:?}");
        assert_eq!(found == Status::Failed, !holds, "{found:?}");
    }
}

/// An upright brick, 100 mm by 300 mm and 500 mm high, falls over on a slope along its narrow side, whose line of gravity leaves
/// it, and stands on one along its wide side.
#[test]
fn a_brick_stands_on_a_slope_across_its_narrow_side() {
    let size = Vec3::new(0.1, 0.3, 0.5);
    let brick =
        robot_of(vec![link("brick", vec![boxed(-size / 2.0, size / 2.0)], 1.0, Vec3::zeros(), 2.0)], vec![]);
    let stands = |slope: [f64; 2]| {
        let plan = Motion::new(brick.clone()).plan(World { slope, ..STATICS });
        let up = base_at(&plan, 0.0).expect("it is placed").rotation * Vec3::z();
        up.dot(&Vec3::new(-slope[0], -slope[1], 1.0).normalize()) > 0.99
    };
    // Its centre is 250 mm high, and 50 mm from its narrow, 150 mm from its wide edges.
    for sign in [-1.0, 1.0] {
        assert!(stands([0.19 * sign, 0.0]));
        assert!(!stands([0.21 * sign, 0.0]));
        assert!(!stands([0.26 * sign, 0.0]));
        assert!(stands([0.0, 0.55 * sign]));
        assert!(!stands([0.0, 0.65 * sign]));
        assert!(stands([0.15 * sign, 0.4]));
    }
}

/// Steps are proved where the robot can't come near its edge in them; on fixed ground, where nothing moves the base, it is only
/// looked at.
#[test]
fn stability_is_proved_far_from_the_edge_alone() {
    let judged = |size: Vec3, by: f64, sample: f64, ground: Ground| {
        let motion = Motion::new(slider(size, 1.0, 1.0, Vec3::y())).segment(0, 0.0, 1.0, vec![0.0, by]);
        let mut plan = motion.plan(World { ground, ..STATICS });
        plan.settings.sample = sample;
        let verdict = verify(&plan);
        assert!(verdict.ok(), "{:?}", verdict.failures);
        status(&verdict, CheckKind::Stability)
    };
    let wide = Vec3::new(0.4, 0.4, 0.1);
    assert_eq!(judged(wide, 0.01, 0.01, Ground::Settle), Status::Proved);
    // A foot of 4 mm, and steps by more than that.
    let narrow = Vec3::new(0.004, 0.4, 0.1);
    assert_eq!(judged(narrow, 0.1, 0.1, Ground::Settle), Status::Sampled(11));
    assert_eq!(judged(wide, 0.01, 0.01, Ground::Fixed), Status::Sampled(101));
}

/// How a robot rests and rolls does not depend on its weight.
#[test]
fn robots_move_under_little_weight_as_under_much() {
    let lone = Motion::new(robots::chain(1)).spin("m0", LEFT, 2.0, 0.0, 1.0).spin("m0", RIGHT, 1.0, 0.0, 1.0);
    let bases = |gravity: f64| {
        let plan = planned(&lone, World { gravity, ..STATICS });
        [0.0, 1.0].map(|time| base_at(&plan, time).expect("it is placed"))
    };
    let light = bases(0.5);
    for (a, b) in bases(9.80665).iter().zip(&light) {
        assert!(
            (a.translation.vector - b.translation.vector).norm() < 1e-9
                && a.rotation.angle_to(&b.rotation) < 1e-9
        );
    }
    assert!((light[0].translation.vector - light[1].translation.vector).norm() > 0.05, "it drives");
}

/// Loads are not known without weight, and none act where nothing is stood on.
#[test]
fn nothing_is_weighed_without_weight_or_ground() {
    let still = Motion::new(robots::chain(1)).segment(LEFT, 0.0, 1.0, vec![0.0, 0.1]);
    for (gravity, ground, known) in [
        (0.0, Ground::Settle, false),
        (9.8, Ground::Off, false),
        (0.0, Ground::Off, false),
        (9.8, Ground::Settle, true),
    ] {
        let plan = planned(&still, World { gravity, ground, ..STATICS });
        let found = &instants(&plan, &[0.5], Detail::Loads, None)[0];
        assert!(
            found.efforts.iter().all(|effort| effort.is_some() == known),
            "{gravity} {ground:?}: {found:?}"
        );
        assert_eq!(found.forces.is_some(), known, "{gravity} {ground:?}: {found:?}");
    }
}

/// Ground that comes to be under a robot which has moved before is touched as soon as it is there.
#[test]
fn ground_that_comes_later_is_touched_at_once() {
    let motion = Motion::new(slider(Vec3::new(0.4, 0.2, 0.1), 1.0, 1e-3, Vec3::z()));
    let mut motion = motion.segment(0, 0.0, 0.5, vec![0.0, 0.1]);
    motion.tracks.duration = 2.0;
    let mut plan = motion.plan(World { ground: Ground::Off, ..STATICS });
    plan.worlds.push(WorldFrom { from: 1.0, world: World { ground: Ground::Fixed, ..STATICS } });
    let margins = instants(&plan, &[0.25, 0.75, 1.0, 1.5, 2.0], Detail::Stance, None);
    let margins: Vec<_> = margins.iter().map(|instant| instant.margin).collect();
    assert_eq!(margins[..2], [None, None]);
    for margin in &margins[2..] {
        let margin = margin.expect("it stands");
        assert!((margin - 0.1).abs() < 1e-6, "{margin}");
    }
}

/// No joint turns by more than 5° from one sample to the next, nor does more time pass than is stated; what rests is looked at
/// once.
#[test]
fn samples_are_as_many_as_turns_and_times_ask_for() {
    let samples = |motion: &Motion, sample: f64| {
        let mut plan = planned(motion, World::FREE);
        plan.settings.sample = sample;
        let (tolerances, mut samples) = (Tolerances::default(), 0);
        roll_out(Rollout::of(&plan, &motion.tracks, &tolerances), None, 100.0, &mut |_, _| {
            samples += 1;
            true
        });
        samples
    };
    let quarter = || Motion::new(robots::chain(1)).linear("m0", LEFT, 90.0, 0.0, 9.0);
    // One at the start, and one for each 5°.
    assert_eq!(samples(&quarter(), 100.0), 1 + 18);
    // Another joint's segments, in which it rests, divide the time into parts of 4.5°.
    let divided = (0..20).fold(quarter(), |m, i| {
        let right = m.joint("m0", RIGHT);
        m.segment(right, 0.45 * f64::from(i), 0.45 * f64::from(i + 1), vec![0.0, 0.0])
    });
    assert_eq!(samples(&divided, 100.0), 1 + 20);
    assert_eq!(samples(&quarter(), 0.1), 1 + 90);
    let mut still = Motion::new(robots::chain(1));
    still.tracks.duration = 3.0;
    assert_eq!(samples(&still, 0.1), 1 + 1);
}

/// As much as the line of gravity moves over the ground from one sample to the next, so much the bound on motion is at least: a
/// heavy mass that rises on a slope moves it downhill.
#[test]
fn a_bound_on_motion_holds_for_the_line_of_gravity_on_a_slope() {
    let rise = 0.5;
    let motion = Motion::new(slider(Vec3::new(0.6, 0.6, 0.02), 0.1, 20.0, Vec3::z()));
    let motion = motion.segment(0, 0.0, 1.0, vec![0.0, 0.1]);
    let plan = planned(&motion, World { slope: [rise, 0.0], friction: 2.0, ..STATICS });
    let tolerances = Tolerances::default();
    let rollout = Rollout::of(&plan, &motion.tracks, &tolerances);
    let (mut before, mut seen) = (None, 0);
    roll_out(rollout, None, 1.0, &mut |sample, _| {
        let margin = sample.stance.margin(sample.model).expect("it stands").distance;
        if let Some(before) = before.replace(margin) {
            let moved: f64 = margin - before;
            assert!(sample.motion >= moved.abs(), "{} of {moved}", sample.motion);
            assert!(moved.abs() > 1e-5, "the line moves by half of 1 mm");
            seen += 1;
        }
        true
    });
    assert!(seen > 50);
}
