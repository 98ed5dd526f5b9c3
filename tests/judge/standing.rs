//! What stands: on slopes as on level ground where they must agree, whatever the samples are, and on the area that closed forms
//! give.
#![allow(non_snake_case)]

use crate::support::arms::robot_of;
use crate::support::desk::run_clean;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{self, DISC, LEFT, RIGHT, TILT, boxed, joint, link};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Pose, Vec3};
use modl::plan::verify::articulated::{Detail, Rollout, RolloutEnd, Tolerances, area, instants, roll_out};
use modl::plan::{Settings, Stability, World};
use modl::robot::{Assembly, JointKind, Limits};

/// What is seen of a robot at a sample.
#[derive(Debug)]
struct Seen {
    time: f64,
    base: Pose,
    fall: f64,
    /// The angle by which it settles, rad; 0 where it does not.
    settling: f64,
    margin: f64,
    /// The time and the fall of a loss of support.
    tip: Option<(f64, f64)>,
    /// Loads by link.
    loads: Vec<(usize, f64)>,
    slips: f64,
}

/// Returns what is seen of a motion in a world under statics, sample by sample.
fn seen(motion: &Motion, world: World, settings: &Settings) -> Vec<Seen> {
    let tolerances = Tolerances::default();
    let mut plan = motion.clone().plan(world);
    plan.settings = *settings;
    let rollout = Rollout::of(&plan, &motion.tracks, &tolerances);
    let mut seen = vec![];
    let ended = roll_out(rollout, None, motion.tracks.duration, &mut |sample, _| {
        let stance = sample.stance;
        seen.push(Seen {
            time: sample.time,
            base: stance.base_pose(sample.model),
            fall: sample.fall,
            settling: sample.settling.unwrap_or(0.0),
            margin: stance.margin(sample.model).map_or(0.0, |margin| margin.distance),
            tip: sample.tip.map(|tip| (tip.time, tip.fall)),
            loads: stance.patches.iter().map(|patch| (patch.link, patch.load)).collect(),
            slips: sample.slips.iter().map(|(_, slip, load)| slip * load).sum(),
        });
        true
    });
    assert_eq!(ended, RolloutEnd::AtEnd);
    seen
}

/// Asserts that two motions show the same, but for the poses of the second, which `back` takes to those of the first.
fn assert_same(first: &[Seen], second: &[Seen], back: &Pose, within: f64, of: &str) {
    assert_eq!(first.len(), second.len(), "samples of {of}");
    let close = |a: f64, b: f64| (a - b).abs() < within;
    for (a, b) in first.iter().zip(second) {
        let base = back * b.base;
        let apart = (base.translation.vector - a.base.translation.vector).norm();
        assert!(close(a.time, b.time), "{of}: {a:?} {b:?}");
        assert!(apart < within && base.rotation.angle_to(&a.base.rotation) < within, "{of}: {a:#?} {b:#?}");
        assert!(close(a.fall, b.fall) && close(a.settling, b.settling), "{of}: {a:#?} {b:#?}");
        assert!(close(a.margin, b.margin) && close(a.slips, b.slips), "{of}: {a:#?} {b:#?}");
        assert_eq!(a.tip.is_some(), b.tip.is_some(), "{of} at {} s", a.time);
        if let (Some(a), Some(b)) = (a.tip, b.tip) {
            assert!(close(a.0, b.0) && close(a.1, b.1), "{of}: {a:?} {b:?}");
        }
        for (link, load) in &a.loads {
            let other = b.loads.iter().find(|other| other.0 == *link).map_or(0.0, |other| other.1);
            assert!(close(*load, other), "{of}: {a:#?} {b:#?}");
        }
    }
}

/// Robots that settle as they start, drive, walk, arch and tip over.
fn motions() -> Vec<(&'static str, Motion)> {
    let first_based = |mut robot: Assembly| {
        robot.base = 0;
        robot
    };
    let legs = ["fl", "fr", "bl", "br"];
    let walker =
        legs.iter().fold(Motion::new(robots::walk4()), |m, leg| m.set(&format!("{leg}_hip"), TILT, -90.0));
    let bent = |tilts: [f64; 3]| {
        let motion = Motion::new(first_based(robots::chain(3)));
        let named = |m: Motion, (i, tilt): (usize, f64)| m.set(&format!("m{i}"), TILT, tilt);
        tilts.into_iter().enumerate().fold(motion, named).spin("m1", DISC, 0.1, 0.0, 0.5)
    };
    let lone = || Motion::new(robots::chain(1));
    vec![
        ("a chain that is bent", bent([30.0, -30.0, 30.0])),
        ("a chain that is curled", bent([-75.0, 75.0, -75.0])),
        ("a car that turns", lone().spin("m0", LEFT, 2.0, 0.0, 1.0).spin("m0", RIGHT, 1.0, 0.0, 1.0)),
        ("a module that rocks", lone().smooth("m0", TILT, 60.0, 0.0, 1.0)),
        (
            "a walker that lifts a leg",
            walker.smooth("fl_knee", TILT, 30.0, 0.0, 1.0).smooth("fl_ankle", TILT, -30.0, 0.0, 1.0),
        ),
        (
            "a backhoe that tips",
            Motion::new(robots::backhoe(8)).set("a0", TILT, 90.0).linear("a1", TILT, -90.0, 0.0, 1.5),
        ),
    ]
}

fn coarse() -> Settings {
    Settings { sample: 0.05, ..Settings::default() }
}

#[test]
fn a_slope_of_next_to_nothing_is_level_ground() {
    for (of, motion) in motions() {
        let level = seen(&motion, STATICS, &coarse());
        let sloped = seen(&motion, World { slope: [1e-8, -2e-8], ..STATICS }, &coarse());
        assert_same(&level, &sloped, &Pose::identity(), 3e-5, of);
    }
}

/// A robot that is drawn turned about the vertical, on a slope that is turned as far, does all the same but elsewhere.
#[test]
fn a_slope_that_is_turned_with_its_robot_changes_nothing() {
    let rise = libm::tan(6_f64.to_radians());
    let world = |degrees: f64| {
        let (s, c) = libm::sincos(degrees.to_radians());
        World { slope: [rise * c, rise * s], ..STATICS }
    };
    for (of, motion) in motions() {
        let first = seen(&motion, world(20.0), &coarse());
        for turn in [90.0, -140.0_f64] {
            let mut turned_motion = Motion { tracks: motion.tracks.clone() };
            let about = turned(Vec3::z(), turn.to_radians());
            turned_motion.tracks.start.base = about * motion.tracks.start.base;
            let second = seen(&turned_motion, world(20.0 + turn), &coarse());
            assert_same(&first, &second, &about.inverse(), 3e-5, of);
        }
    }
}

/// A table of four legs, of which one can be longer: with its weight off the middle, so that it rests on one side of the diagonal.
fn table() -> Assembly {
    let mut links = vec![link(
        "top",
        vec![boxed(Vec3::new(-0.12, -0.12, 0.28), Vec3::new(0.12, 0.12, 0.32))],
        5.0,
        Vec3::new(0.02, 0.0, 0.3),
        1.0,
    )];
    let mut joints = vec![];
    for (i, (x, y)) in [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)].into_iter().enumerate() {
        let foot = Vec3::new(0.1 * x, 0.1 * y, 0.0);
        let shape = vec![boxed(foot + Vec3::new(-0.002, -0.002, 0.0), foot + Vec3::new(0.002, 0.002, 0.27))];
        links.push(link(&format!("leg{i}"), shape, 0.01, foot + Vec3::z() * 0.1, 1.0));
        let limits = Limits { range: Some((-0.1, 0.1)), speed: None, acceleration: None, effort: None };
        let pose = Pose::identity();
        joints.push(joint(&format!("out{i}"), (0, i + 1), JointKind::Prismatic, pose, -Vec3::z(), limits));
    }
    robot_of(links, joints)
}

/// With a leg that grows by nearly 20 mm from one sample to the next the table drops by millimetres onto its third foot: shorter
/// steps show that it only follows the leg.
#[test]
fn a_table_that_leans_as_a_leg_grows_does_not_tip_over() {
    for step in [0.018, 0.009, 0.003] {
        let grow = |leg: usize| Motion::new(table()).segment(leg, 0.0, 1.0, vec![0.0, 0.036]);
        for leg in 0..4 {
            let settings = Settings { sample: step / 0.036, ..Settings::default() };
            let seen = seen(&grow(leg), STATICS, &settings);
            assert!(seen.iter().all(|sample| sample.tip.is_none()), "{leg} by {step}: {seen:#?}");
            let (first, last) = (&seen[0], &seen[seen.len() - 1]);
            let leans = first.base.rotation.angle_to(&last.base.rotation);
            // Two opposite feet bear it, and one of the others: it leans about the diagonal by 36 mm at its feet, or so.
            assert!(leans > 0.1 && leans < 0.2, "{leans}");
        }
    }
}

/// Returns the margin of a point in the convex hull of others, m, by all lines through two of them that have all others on one
/// side.
fn margin_in(points: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let side = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        (dx * (p[1] - a[1]) - dy * (p[0] - a[0])) / libm::hypot(dx, dy)
    };
    let mut least = f64::INFINITY;
    for a in points {
        for b in points.iter().filter(|b| *b != a) {
            if points.iter().all(|p| side(*a, *b, *p) > -1e-9) {
                least = least.min(side(*a, *b, at));
            }
        }
    }
    least
}

/// Blocks of 100 mm at whole places, the first the base.
fn blocks(places: &[[i32; 3]]) -> Assembly {
    let faces = [
        ("px", "X", "Z"),
        ("nx", "-X", "Z"),
        ("py", "Y", "Z"),
        ("ny", "-Y", "Z"),
        ("pz", "Z", "X"),
        ("nz", "-Z", "X"),
    ];
    let ports = faces.map(|(name, out, up)| {
        let sign = if out.starts_with('-') { -50 } else { 50 };
        let at =
            ["X", "Y", "Z"].map(|axis| if out.ends_with(axis) { format!("{sign}mm") } else { "0mm".into() });
        let out = if sign > 0 { format!("+{out}") } else { out.into() };
        format!("port {name}: Face on body at [{}] facing {out} up +{up}\n", at.join(", "))
    });
    let mut connected = String::new();
    for (j, b) in places.iter().enumerate().skip(1) {
        let beside = |a: &[i32; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).sum::<i32>() == 1;
        let i = places[..j].iter().position(beside).expect("blocks hang together");
        let axis = (0..3).find(|k| places[i][*k] != b[*k]).expect("they differ");
        let grows = b[axis] > places[i][axis];
        let (near, far) = if grows { ("p", "n") } else { ("n", "p") };
        let name = ["x", "y", "z"][axis];
        connected += &format!("connect m[{i}].{near}{name} -- m[{j}].{far}{name}\n");
    }
    let program = format!(
        "connector Face {{ mates Face, turns 4 }}
         module Block {{
           link body = box(100mm, 100mm, 100mm, mass: 1kg, friction: 2)
           {}
         }}
         config Blocks {{ part m[{}]: Block\n{connected} base m[0]  behavior rest = wait(1s) }}
         emit(plan(Blocks().rest()), \"p.json\")",
        ports.concat(),
        places.len()
    );
    let desk = run_clean(&program);
    let plan = desk.plan("p.json");
    plan.body.tracks().expect("modules").robot.clone()
}

/// The centres of all modules count alike; those that are lowest span the area; on a slope the line of gravity through the mean
/// meets the ground downhill of it.
#[test]
fn the_rule_of_centres_takes_the_mean_of_centres_in_the_lowest_of_them() {
    let layouts: [&[[i32; 3]]; 3] = [
        &[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 0, 1]],
        &[[0, 0, 0], [0, -1, 0], [0, -2, 0], [-1, 0, 0], [-1, -2, 0], [-1, -2, 1], [0, -2, 1]],
        &[[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 1, 1], [1, 2, 0]],
    ];
    for layout in layouts {
        let robot = blocks(layout);
        for slope in [[0.0, 0.0], [0.15, 0.0], [0.0, -0.1], [-0.08, 0.12]] {
            let mut plan = Motion::new(robot.clone()).plan(World { slope, ..STATICS });
            plan.settings.stability = Stability::Centres;
            let places = layout.iter().map(|p| p.map(|k| 0.1 * f64::from(k)));
            let count = layout.len() as f64;
            let mean = places.clone().fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p[k] / count));
            let low: Vec<[f64; 2]> = places.filter(|p| p[2] == 0.0).map(|p| [p[0], p[1]]).collect();
            // The lowest centres are 50 mm above the ground.
            let height = mean[2] + 0.05;
            let expected = margin_in(&low, [mean[0] - slope[0] * height, mean[1] - slope[1] * height]);
            let found = instants(&plan, &[0.0], Detail::Stance, None)[0].margin.expect("it stands");
            assert!((found - expected).abs() < 1e-9, "{layout:?} {slope:?}: {found} is not {expected}");
        }
    }
}

/// A stool of three feet at uneven places, drawn somewhere and turned about the vertical: it stands on the outer corners of its
/// feet. A brick that is drawn on an edge lies down on the nearer of its faces.
#[test]
fn the_footprint_is_the_hull_of_what_touches_the_ground_in_the_frame_of_the_base() {
    let feet = [[0.2, 0.05], [-0.1, 0.17], [-0.04, -0.12]];
    let top = boxed(Vec3::new(-0.1, -0.1, 0.2), Vec3::new(0.1, 0.1, 0.25));
    let leg =
        |[x, y]: [f64; 2]| boxed(Vec3::new(x - 0.01, y - 0.01, 0.0), Vec3::new(x + 0.01, y + 0.01, 0.2));
    let shapes = [vec![top], feet.map(leg).to_vec()].concat();
    let stool = robot_of(vec![link("stool", shapes, 1.0, Vec3::zeros(), 0.5)], vec![]);
    // Counter-clockwise: of each foot the corners that are on the hull.
    let stool_corners = [
        [-0.05, -0.13],
        [-0.03, -0.13],
        [0.21, 0.04],
        [0.21, 0.06],
        [-0.09, 0.18],
        [-0.11, 0.18],
        [-0.11, 0.16],
    ]
    .map(|[x, y]: [f64; 2]| Vec3::new(x, y, 0.0));
    let brick = boxed(Vec3::new(-0.15, -0.1, -0.05), Vec3::new(0.15, 0.1, 0.05));
    let brick = robot_of(vec![link("brick", vec![brick], 1.0, Vec3::zeros(), 0.5)], vec![]);
    let bottom = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let bottom = bottom.map(|[x, y]| Vec3::new(0.15 * x, 0.1 * y, -0.05));
    // The face at +x, as it lies below: z points where x did.
    let side = bottom.map(|corner| Vec3::new(0.15, corner.y, corner.x / 3.0));
    let y = |degrees: f64| turned(Vec3::y(), degrees.to_radians());
    let placed = shifted(Vec3::new(0.4, -0.7, 0.3)) * turned(Vec3::z(), 0.6);
    let cases = [
        (&stool, placed, &stool_corners[..]),
        (&brick, Pose::identity(), &bottom[..]),
        (&brick, placed * y(20.0), &bottom[..]),
        (&brick, y(85.0), &side[..]),
    ];
    for (robot, base, expected) in cases {
        let mut state = robots::at_rest(robot);
        state.base = base;
        let found = area(robot, &state);
        assert_eq!(found.len(), expected.len(), "{found:?}");
        let same = |(a, b): (&Vec3, &Vec3)| (a - b).norm() < 1e-6;
        let begins = |from: usize| found.iter().zip(expected.iter().cycle().skip(from)).all(same);
        assert!((0..expected.len()).any(begins), "{found:?} is not {expected:?}");
    }
}

/// The loads at a time are found of that sample alone, whatever other times are asked for.
#[test]
fn loads_do_not_depend_on_the_times_that_are_asked_for() {
    let mut robot = robots::walk4();
    let library = std::sync::Arc::make_mut(&mut robot.library);
    (library.connectors[0].holds_force, library.connectors[0].holds_moment) = (None, None);
    let legs = ["fl", "fr", "bl", "br"];
    let stands = legs.iter().fold(Motion::new(robot), |m, leg| m.set(&format!("{leg}_hip"), TILT, -90.0));
    let motion = ["fl", "br"].iter().fold(stands, |m, leg| {
        let m = m.smooth(&format!("{leg}_knee"), TILT, 30.0, 0.0, 1.0);
        m.smooth(&format!("{leg}_ankle"), TILT, -30.0, 0.0, 1.0)
    });
    let turns = ["b0", "b2"].iter().fold(motion, |m, module| m.smooth(module, RIGHT, 5.0, 1.0, 2.0));
    let plan = turns.plan(STATICS);
    let times = [0.5, 1.0, 1.3, 1.6, 2.0];
    let all = instants(&plan, &times, Detail::Loads, None);
    for (instant, time) in all.iter().zip(times) {
        let alone = instants(&plan, &[time], Detail::Loads, None);
        assert_eq!(instant, &alone[0], "at {time} s");
    }
}

/// Weight without ground: nothing is touched.
#[test]
fn what_floats_touches_nothing() {
    for motion in [Motion::new(table()).segment(0, 0.0, 1.0, vec![0.0, 0.05]), Motion::new(robots::chain(1))]
    {
        let plan = motion.plan(World { ground: modl::plan::Ground::Off, ..STATICS });
        for moment in modl::plan::verify::articulated::history(&plan, 1.0) {
            assert!(moment.contacts.is_empty() && moment.support.is_empty(), "{moment:?}");
            assert_eq!(moment.margin, None);
        }
        assert!(instants(&plan, &[0.0], Detail::Loads, None).iter().all(|instant| instant.margin.is_none()));
    }
}
