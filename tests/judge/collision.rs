//! Self-collision at every instant, against closed forms and against dense sampling.

use crate::support::hollow_meshes::hollow_cube;
use crate::support::motions::Motion;
use crate::support::numbers::Numbers;
use crate::support::properties::seeds;
use crate::support::robots::{self, boxed};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Pose, Vec3};
use modl::plan::verify::articulated::collision::judge;
use modl::plan::verify::articulated::{Bodies, Findings, Precision, collision_point};
use modl::plan::{
    CauseId, DockingEvent, DockingKind, Exemption, ExemptionKind, Ground, Segment, Settings, Status, Track,
    Tracks, World,
};
use modl::robot::{
    Assembly, Capture, JointId, JointKind, Kinematics, Library, Limits, ModuleInstance, ModuleType, Port,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

pub const CAUSE: CauseId = CauseId(0);

pub fn segment(start: f64, end: f64, control: &[f64]) -> Segment {
    Segment { start, end, control: control.to_vec(), cause: CAUSE }
}

/// At rest at both ends.
pub fn smooth(start: f64, end: f64, from: f64, to: f64) -> Segment {
    segment(start, end, &[from, from, from, to, to, to])
}

pub fn plan(robot: Assembly, tracks: Vec<(usize, Vec<Segment>)>, duration: f64) -> Tracks {
    let mut start = robots::at_rest(&robot);
    for (joint, segments) in &tracks {
        start.joints[*joint] = segments[0].control[0];
    }
    let track = |(joint, segments)| Track { joint: JointId(joint as u32), segments };
    let tracks = tracks.into_iter().map(track).collect();
    Tracks { tracks, duration, ..Tracks::at_rest(robot, start) }
}

pub fn judged(tracks: &Tracks) -> Findings {
    judge(tracks, &Settings::default(), &[], &Precision::default()).expect("sound shapes")
}

fn cube(half: f64) -> Vec<Placed> {
    vec![boxed(Vec3::repeat(-half), Vec3::repeat(half))]
}

/// A rail with a cube at its end, on which a carriage slides that bears another cube. With the slide
/// at q the two cubes, of 20 mm, are q apart.
pub fn rail() -> Assembly {
    rail_between(cube(0.01), cube(0.01))
}

/// The same with another shape at the end of the rail and on the carriage, both about the middles of the cubes.
fn rail_between(end: Vec<Placed>, borne: Vec<Placed>) -> Assembly {
    let carriage = vec![boxed(Vec3::new(0.02, 0.0, 0.1), Vec3::new(0.03, 0.01, 0.11))];
    let limits = Limits { range: Some((-0.01, 1.0)), ..Limits::default() };
    let slide = robots::joint("slide", (0, 1), JointKind::Prismatic, Pose::identity(), Vec3::x(), limits);
    let port = |link: usize, pose: Pose| Port { name: "p".into(), link, pose, connector: 0 };
    let kind = |name: &str, links, joints, ports| ModuleType {
        name: name.into(),
        links,
        joints,
        ports,
        motors: vec![],
        touching: vec![],
        touch: 1e-4,
        contact: 1e-3,
    };
    let link = |name: &str, shape| robots::link(name, shape, 1.0, Vec3::zeros(), 0.5);
    let frame = kind(
        "Rail",
        vec![link("end", end), link("carriage", carriage)],
        vec![slide],
        vec![port(1, shifted(Vec3::new(0.02, 0.0, 0.0)))],
    );
    // The half turn of the mate is undone, so that the block is drawn as it is.
    let block = kind("Block", vec![link("cube", borne)], vec![], vec![port(0, turned(Vec3::z(), PI))]);
    let connectors = robots::smores_library().connectors.clone();
    let library = Arc::new(Library { connectors, modules: vec![frame, block], ..Library::default() });
    let modules = [("rail", 0), ("block", 1)].map(|(name, kind)| ModuleInstance { name: name.into(), kind });
    let mut design = robots::Design::new("Rail", library);
    design.0.modules = modules.to_vec();
    design.connect((0, 0), (1, 0), 0);
    design.0
}

#[test]
fn a_link_wholly_inside_another_has_a_point_of_collision_within_it() {
    let small = 0.002;
    let robot = || rail_between(vec![hollow_cube(0.06, 0.03)], cube(small));
    let point = |q: f64| {
        let mut motion = Motion::new(robot());
        motion.tracks.start.joints[0] = q;
        let plan = motion.plan(World { ground: Ground::Held, ..World::default() });
        collision_point(&plan, (0, 1), 0.0)
    };
    // With the slide at q the small cube's middle is at 20 mm + q: in the wall, which is 30 mm thick, in the hollow,
    // and outside.
    for q in [0.015, 0.025, 0.035] {
        let found = point(q).expect("the cube is inside the wall");
        let off = found - Vec3::new(0.02 + q, 0.0, 0.0);
        assert!(off.amax() <= small, "{found} with the slide at {q}");
    }
    assert_eq!((point(-0.009), point(0.05)), (None, None));
}

#[test]
fn two_boxes_meet_when_and_as_deep_as_they_must() {
    // From 10 mm apart to 5 mm deep at 10 mm/s, and back.
    let there = segment(0.0, 1.5, &[0.01, -0.005]);
    let back = segment(1.5, 3.0, &[-0.005, 0.01]);
    let found = judged(&plan(rail(), vec![(0, vec![there, back])], 3.0));
    assert_eq!(found.status, Status::Failed);
    let [collision] = &found.collisions[..] else { panic!("one collision: {found:?}") };
    // Deeper than 0.1 mm from 1.01 s on; the last micrometre is left to the judge's precision.
    assert!(collision.time > 1.01 && collision.time < 1.010102, "{collision:?}");
    assert!(
        (collision.depth - 0.005).abs() < 2.1e-5 && (collision.deepest - 1.5).abs() < 3e-3,
        "{collision:?}"
    );
    assert_eq!((collision.modules, collision.links), ((0, 1), (0, 0)));
    let clearance = found.clearance.expect("two links that may not touch");
    assert!((clearance.value + collision.depth).abs() < 2.1e-5);
    let words = collision.failure(&rail());
    assert!(words.message.starts_with("rail and block meet, up to 4.99"), "{}", words.message);
    assert!(words.message.ends_with(" deep (end and cube)"), "{}", words.message);
}

#[test]
fn a_touch_is_no_collision() {
    let found = judged(&plan(rail(), vec![(0, vec![smooth(0.0, 1.0, 0.01, 1e-6)])], 2.0));
    assert_eq!((found.status, found.collisions.len()), (Status::Proved, 0));
    let found = judged(&plan(rail(), vec![(0, vec![smooth(0.0, 1.0, 0.01, -0.9e-4)])], 2.0));
    assert_eq!((found.status, found.collisions.len()), (Status::WithinTolerance, 0));
    let found = judged(&plan(rail(), vec![(0, vec![smooth(0.0, 1.0, 0.01, -1.1e-4)])], 2.0));
    assert_eq!((found.status, found.collisions.len()), (Status::Failed, 1));
}

/// In 3 ms from 1 mm apart to `least` and back, between the samples at 0.50 and 0.51 s.
fn bump(least: f64) -> Tracks {
    let q = 0.001;
    let there = smooth(0.503, 0.5045, q, least);
    let back = smooth(0.5045, 0.506, least, q);
    plan(rail(), vec![(0, vec![there, back])], 1.0)
}

#[test]
fn a_collision_between_two_samples_is_caught() {
    let found = judged(&bump(-0.5e-3));
    let [collision] = &found.collisions[..] else { panic!("one collision: {found:?}") };
    assert!(collision.time > 0.503 && collision.time < 0.5045);
    assert!((collision.depth - 0.5e-3).abs() < 2.1e-5);
}

#[test]
fn a_grazing_pass_is_not_reported() {
    let found = judged(&bump(0.05e-3));
    assert_eq!((found.status, found.collisions.len()), (Status::Proved, 0));
    let clearance = found.clearance.expect("two links that may not touch");
    assert!((clearance.value - 0.05e-3).abs() < 2.1e-5 && (clearance.time - 0.5045).abs() < 1e-3);
}

#[test]
fn an_exemption_excuses_its_interval_and_no_more() {
    let in_and_out = vec![smooth(0.0, 1.0, 0.01, -0.005), smooth(2.0, 3.0, -0.005, 0.01)];
    let tracks = plan(rail(), vec![(0, in_and_out)], 4.0);
    let until =
        |to: f64, pair| Exemption { kind: ExemptionKind::Collision(pair), from: 0.0, to, cause: CAUSE };
    let judged = |exemption| {
        judge(&tracks, &Settings::default(), &[exemption], &Precision::default()).expect("sound shapes")
    };
    let all = judged(until(4.0, Some((1, 0))));
    assert_eq!((all.status, all.used), (Status::Exempt, vec![0]));
    let half = judged(until(1.5, None));
    assert_eq!(half.status, Status::Failed);
    let failing: Vec<f64> = half.collisions.iter().filter(|c| !c.exempt).map(|c| c.time).collect();
    assert!(failing.len() == 1 && (failing[0] - 1.5).abs() < 1e-5, "{half:?}");
    let other = judged(until(4.0, Some((1, 1))));
    assert_eq!((other.status, other.used), (Status::Failed, vec![]));
}

#[test]
fn the_end_of_a_plan_is_never_exempt() {
    let tracks = plan(rail(), vec![(0, vec![smooth(0.0, 1.0, 0.01, -0.005)])], 1.0);
    let always = Exemption { kind: ExemptionKind::Collision(None), from: 0.0, to: 1.0, cause: CAUSE };
    let found = judge(&tracks, &Settings::default(), &[always], &Precision::default()).expect("sound shapes");
    assert_eq!(found.status, Status::Failed);
}

/// Links that carry mated ports may meet, but only as long as the bond holds.
#[test]
fn a_bond_excuses_only_while_it_holds() {
    let mut robot = robots::chain(3);
    // The middle module's chassis is in the last one's disc: 2 mm deep.
    let mut library = (*robot.library).clone();
    library.modules[0].links[robots::CHASSIS]
        .collides
        .push(boxed(robots::millimetres(-52.0, -5.0, -5.0), robots::millimetres(-45.0, 5.0, 5.0)));
    robot.library = Arc::new(library);
    let mut tracks = plan(robot, vec![], 1.0);
    let held = judged(&tracks);
    assert_eq!(held.status, Status::Proved, "{held:?}");
    // Undocked the rest of the robot is elsewhere; how it lies is not judged.
    tracks.events.push(DockingEvent { time: 0.5, kind: DockingKind::Undock, bond: 1, cause: CAUSE });
    assert_eq!(judged(&tracks).status, Status::Proved);
    // In a ring the two ends stay in place when their bond opens.
    let mut ring = robots::ring12_closed();
    ring.library = tracks.robot.library.clone();
    let mut tracks = plan(ring, vec![], 1.0);
    (0..12).for_each(|m| tracks.start.joints[4 * m + robots::TILT] = PI / 6.0);
    assert_eq!(judged(&tracks).status, Status::Proved);
    tracks.events.push(DockingEvent { time: 0.5, kind: DockingKind::Undock, bond: 11, cause: CAUSE });
    let found = judged(&tracks);
    assert_eq!(found.collisions.len(), 1, "{found:?}");
    assert!((found.collisions[0].time - 0.5).abs() < 1e-5 && found.collisions[0].modules == (0, 11));
}

/// The links of the bond that closes a ring penetrate each other where the joints turn too far. The error that the
/// connector states allows as much, and no more.
#[test]
fn the_bond_that_closes_a_loop_holds_its_links_by_the_error_of_its_connector() {
    let ring = robots::ring12_closed();
    let kinematics = Kinematics::new(&ring, &[true; 12], 0);
    let [closing] = kinematics.tree.closing[..] else { panic!("one bond closes the ring") };
    let bodies = Bodies::new(&ring, &kinematics).expect("sound shapes");
    let bond = ring.bonds[closing];
    let [a, b] = [bond.a, bond.b]
        .map(|at| kinematics.link(at.module, ring.module_type(at.module).ports[at.port].link));
    let too_far = |by: f64| {
        let mut tracks = plan(ring.clone(), vec![], 1.0);
        (0..12).for_each(|m| tracks.start.joints[4 * m + robots::TILT] = PI / 6.0 + by);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&tracks.start.joints, &Pose::identity(), &mut poses);
        (tracks, -bodies.distance(a, b, &poses, f64::INFINITY))
    };
    let with_error = |tracks: &Tracks, distance: f64| {
        let mut tracks = tracks.clone();
        let mut library = (*tracks.robot.library).clone();
        library.connectors.iter_mut().for_each(|c| c.capture = Some(Capture::at_rest(distance, 0.0)));
        tracks.robot.library = Arc::new(library);
        judged(&tracks)
    };
    let (tracks, depth) = too_far(1e-3);
    assert!(depth > 0.5e-3, "{depth}");
    // A hundredth of a millimetre more than enough, and less; `touch` is 0.1 mm.
    let found = with_error(&tracks, depth - 0.1e-3 + 1e-5);
    assert_eq!(found.collisions, [], "{depth}");
    let found = with_error(&tracks, depth - 0.1e-3 - 1e-5);
    let [collision] = &found.collisions[..] else { panic!("{depth}: {found:?}") };
    // The ring is regular: all its bonds are as far apart, whichever of them the judge takes as the closing one.
    assert!((collision.depth - depth).abs() < 1e-6, "{depth}: {collision:?}");
}

/// The least distance in a SMORES module, m: from the T disc's rim, 45.9 ahead and 42.0 aside, to a
/// wheel's, 45.3 and 43.1.
const DISC_TO_WHEEL: f64 = 1.252_996_408_614_165e-3;

/// Wheels that spin and discs that turn change nothing.
#[test]
fn a_car_that_drives_is_told_apart_at_a_glance() {
    // The outer wheels, on modules fl, fr, bl and br, and the discs in front.
    let outer = [(3, robots::LEFT), (4, robots::RIGHT), (5, robots::LEFT), (6, robots::RIGHT)];
    let front = [1, 3, 4, 5, 6].map(|m| (m, robots::FRONT));
    let mut spun: Vec<usize> = outer.iter().chain(&front).map(|(m, joint)| 4 * m + joint).collect();
    spun.sort_unstable();
    let tracks = spun.iter().map(|j| (*j, vec![segment(0.0, 10.0, &[0.0, 20.0])])).collect();
    let found = judged(&plan(robots::car(), tracks, 10.0));
    assert_eq!(found.status, Status::Proved);
    assert!(found.samples <= 4, "{found:?}");
    let clearance = found.clearance.expect("many pairs").value;
    assert!((clearance - DISC_TO_WHEEL).abs() < 1e-9, "{clearance}");
}

#[test]
fn tilting_by_its_whole_range_a_module_does_not_meet_itself_or_its_neighbours() {
    let tilt = |m: usize| 4 * m + robots::TILT;
    let tracks = [0, 1, 2].map(|m| {
        let sign = if m == 1 { -1.0 } else { 1.0 };
        let swing = [(0.0, -1.0), (-1.0, 1.0)].map(|(a, b)| (a * FRAC_PI_2 * sign, b * FRAC_PI_2 * sign));
        (tilt(m), vec![smooth(0.0, 2.0, swing[0].0, swing[0].1), smooth(2.0, 5.0, swing[1].0, swing[1].1)])
    });
    let found = judged(&plan(robots::chain(3), tracks.to_vec(), 5.0));
    assert_eq!(found.status, Status::Proved, "{found:?}");
    assert!((found.clearance.expect("many pairs").value - DISC_TO_WHEEL).abs() < 2.1e-5);
}

/// A random tree of modules; ports are used once.
fn random_tree(numbers: &mut Numbers) -> Assembly {
    let mut design = robots::Design::new("Tree", robots::smores_library());
    let count = 3 + numbers.below(6);
    let mut free: Vec<(usize, usize)> = Vec::new();
    for m in 0..count {
        design.add(&format!("m{m}"));
        let mut ports = vec![robots::L, robots::R, robots::T, robots::B];
        if m > 0 {
            let at = free.swap_remove(numbers.below(free.len()));
            let port = ports.swap_remove(numbers.below(4));
            design.connect(at, (m, port), numbers.below(4) as u32);
        }
        free.extend(ports.iter().map(|p| (m, *p)));
    }
    design.0
}

/// Four of the judge's longest samples, in which some joints turn by half a turn.
pub const DURATION: f64 = 0.04;

/// Some joints in some segments of some kinds, with gaps, jumps of speed and pauses.
pub fn random_tracks(numbers: &mut Numbers) -> Tracks {
    let robot = random_tree(numbers);
    let duration = DURATION;
    let mut tracks = Vec::new();
    for joint in 0..robot.joints().count() {
        let wide = if joint % 4 == robots::TILT { FRAC_PI_2 } else { PI };
        if numbers.below(3) == 0 {
            continue;
        }
        let (mut t, mut q) = (numbers.between(0.0, 0.3 * duration), numbers.between(-wide, wide));
        let mut segments = Vec::new();
        while t < 0.8 * duration {
            let end = f64::min(duration, t + duration * numbers.between(0.05, 0.6));
            let to = numbers.between(-wide, wide);
            let mid = numbers.between(-wide, wide);
            segments.push(match numbers.below(3) {
                0 => smooth(t, end, q, to),
                1 => segment(t, end, &[q, to]),
                _ => segment(t, end, &[q, mid, to]),
            });
            (t, q) = (end + if numbers.below(2) == 0 { 0.0 } else { 0.05 * duration }, to);
        }
        if !segments.is_empty() {
            tracks.push((joint, segments));
        }
    }
    plan(robot, tracks, duration)
}

/// Distances at many instants, by nothing but forward kinematics and the distance of solids: what
/// `judge` proves must agree with it.
struct Sampled {
    /// Least distance of links that may not touch.
    clearance: f64,
    /// Greatest penetration, with its first sample, of each pair of modules that is deeper than allowed.
    collisions: Vec<((usize, usize), f64, f64)>,
}

/// The radius of a ball around the origin of a link that holds it, m.
const REACH: f64 = 0.0787;

fn sampled(tracks: &Tracks, samples: usize) -> Sampled {
    let robot = &tracks.robot;
    let kinematics = Kinematics::new(robot, &tracks.start.bonds, 0);
    let bodies = Bodies::new(robot, &kinematics).expect("sound shapes");
    let links = kinematics.link_count();
    let mated = |a: usize, b: usize| {
        robot.bonds.iter().any(|bond| {
            let of = |p: modl::robot::PortRef| {
                kinematics.link(p.module, robot.module_type(p.module).ports[p.port].link)
            };
            let pair = (of(bond.a), of(bond.b));
            pair == (a, b) || pair == (b, a)
        })
    };
    let joined = |a: usize, b: usize| {
        let m = kinematics.module_of(a);
        let first = kinematics.link(m, 0);
        m == kinematics.module_of(b)
            && robot.module_type(m).joints.iter().any(|j| {
                (j.parent + first, j.child + first) == (a, b) || (j.parent + first, j.child + first) == (b, a)
            })
    };
    let pairs: Vec<(usize, usize)> = (0..links)
        .flat_map(|a| (a + 1..links).map(move |b| (a, b)))
        .filter(|&(a, b)| !mated(a, b) && !joined(a, b))
        .collect();
    let mut found = Sampled { clearance: f64::INFINITY, collisions: vec![] };
    let mut poses = vec![Pose::identity(); links];
    // For each pair its distance when that was last worked out, and how the second link stood to the first then: no point
    // of it has got nearer since than by its shift and the chord of its turn.
    let mut last: Vec<Option<(f64, Pose)>> = vec![None; pairs.len()];
    for i in 0..=samples {
        let t = tracks.duration * i as f64 / samples as f64;
        kinematics.link_poses(&tracks.state(t).joints, &Pose::identity(), &mut poses);
        for (&(a, b), last) in pairs.iter().zip(&mut last) {
            // A distance that is no less than the least, and no depth of the same modules beyond the known one, is no news.
            let modules = (kinematics.module_of(a), kinematics.module_of(b));
            let known = found.collisions.iter().position(|c| c.0 == modules);
            let news = known.map_or(-1e-4, |known| found.collisions[known].2).max(found.clearance);
            let stands = poses[a].inverse() * poses[b];
            let gap = stands.translation.vector.norm() - 2.0 * REACH;
            let still_far = |(distance, before): (f64, Pose)| {
                let turn = (before.rotation.inverse() * stands.rotation).imag().norm();
                let shift = (stands.translation.vector - before.translation.vector).norm();
                distance - shift - 2.0 * turn * REACH - 1e-12 > news
            };
            if gap > news || last.is_some_and(still_far) {
                continue;
            }
            // More than what is asked for, so that it serves a while.
            let distance = bodies.distance(a, b, &poses, news + 0.02);
            *last = Some((distance, stands));
            found.clearance = found.clearance.min(distance);
            match known {
                Some(known) => found.collisions[known].2 = found.collisions[known].2.min(distance),
                None if distance < -1e-4 => found.collisions.push((modules, t, distance)),
                None => {}
            }
        }
    }
    found
}

/// Whatever dense sampling sees, the proof saw, no later and no less deep; and what it reports, it
/// reports rightly: every failure is there at the instant that it names.
fn agrees(seed: u64, samples: usize) -> bool {
    agree(&random_tracks(&mut Numbers(seed)), seed, samples)
}

pub fn agree(tracks: &Tracks, seed: u64, samples: usize) -> bool {
    let found = judged(tracks);
    let dense = sampled(tracks, samples);
    let clearance = found.clearance.as_ref().expect("several modules").value;
    assert!(
        clearance <= dense.clearance + 2.1e-5,
        "seed {seed}: {clearance} but sampled {}",
        dense.clearance
    );
    let touch = -1e-4;
    for (modules, time, distance) in &dense.collisions {
        let known = found.collisions.iter().find(|c| c.modules == *modules);
        let Some(known) = known else {
            assert!(
                *distance > touch - 1e-5,
                "seed {seed}: {modules:?} at {time}, {distance}, not found: {found:?}"
            );
            continue;
        };
        assert!(known.time <= time + 1e-5, "seed {seed}: {known:?} but sampled at {time}");
        assert!(-known.depth <= distance + 3e-5, "seed {seed}: {known:?} but sampled {distance}");
    }
    let kinematics = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
    let bodies = Bodies::new(&tracks.robot, &kinematics).expect("sound shapes");
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    for c in &found.collisions {
        let links = (kinematics.link(c.modules.0, c.links.0), kinematics.link(c.modules.1, c.links.1));
        kinematics.link_poses(&tracks.state(c.time).joints, &Pose::identity(), &mut poses);
        let distance = bodies.distance(links.0, links.1, &poses, f64::INFINITY);
        assert!(distance < touch, "seed {seed}: {c:?} but {distance}");
        kinematics.link_poses(&tracks.state(c.time - 2e-6).joints, &Pose::identity(), &mut poses);
        let before = bodies.distance(links.0, links.1, &poses, f64::INFINITY);
        assert!(c.time < 2e-6 || before > touch - 2e-6, "seed {seed}: {c:?} but before it {before}");
    }
    found.collisions.is_empty()
}

#[test]
fn random_behaviours_are_judged_as_sampling_a_hundred_times_as_dense_judges_them() {
    let behaviours = seeds(1000);
    const THREADS: u64 = 2;
    let samples = (100.0 * DURATION / Settings::default().sample) as usize;
    let share = |thread: u64| (thread..behaviours.end).step_by(THREADS as usize);
    let free: usize = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS)
            .map(|thread| scope.spawn(move || share(thread).filter(|seed| agrees(*seed, samples)).count()))
            .collect();
        threads.into_iter().map(|thread| thread.join().expect("all agree")).sum()
    });
    let (few, most) = (behaviours.end as usize / 10, behaviours.end as usize * 9 / 10);
    assert!((few..most).contains(&free), "both outcomes occur: {free}");
}

/// A chain that curls up from straight while each joint wobbles: far modules of one end and the other meet, or nearly
/// so, and all others stay apart.
fn curling(numbers: &mut Numbers, modules: usize) -> Tracks {
    let turn = 2.0 * PI / modules as f64 * numbers.between(0.8, 1.25);
    let motions = (0..modules).map(|module| {
        let at = |part: f64| turn * part + numbers.between(-0.04, 0.04);
        let [a, b, c] = [0.0, 0.5, 1.0].map(at);
        let half = DURATION / 2.0;
        (4 * module + robots::TILT, vec![smooth(0.0, half, a, b), smooth(half, DURATION, b, c)])
    });
    let motions = motions.collect();
    plan(robots::snake(modules), motions, DURATION)
}

#[test]
fn modules_far_apart_along_a_chain_are_judged_as_dense_sampling_judges_them() {
    let samples = (20.0 * DURATION / Settings::default().sample) as usize;
    let free = (0..6).filter(|seed| {
        let tracks = curling(&mut Numbers(*seed), 24 + *seed as usize);
        agree(&tracks, *seed, samples)
    });
    assert!((1..6).contains(&free.count()), "both outcomes occur");
}

#[test]
fn a_chain_of_thousands_that_moves_is_refused_within_a_limit_of_work() {
    let moving = |modules: usize, samples_max: usize| {
        let motions = (0..modules).map(|m| (4 * m + robots::TILT, vec![smooth(0.0, 1.0, 0.0, 0.02)]));
        let tracks = plan(robots::snake(modules), motions.collect(), 1.0);
        let settings = Settings { samples_max, ..Settings::default() };
        judge(&tracks, &settings, &[], &Precision::default()).expect("sound shapes")
    };
    // The same limit for each sample refuses the large robot after few of the intervals that the limit of samples
    // allows, and not the small one.
    let (small, large) = (moving(30, 1_000), moving(1_000, 1_000));
    assert_eq!(small.status, Status::Proved, "{small:?}");
    assert_eq!(large.status, Status::Sampled(large.samples), "{large:?}");
    assert!(large.samples < 100, "{large:?}");
}
