//! Ranges, speeds and accelerations of joints and motors beside a dense recount of random motions.

use crate::support::arms::robot_of;
use crate::support::motions::{Motion, cause};
use crate::support::robots::{joint, link};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::verify::verify;
use modl::plan::{CauseId, CheckKind, DynamicsModel, Exemption, ExemptionKind, Failure, Ground, Plan, World};
use modl::robot::{Assembly, JointKind, Limits, Motor};
use std::sync::Arc;

/// A segment of a random motion: from (s), to (s), and its control points.
type Piece = (f64, f64, Vec<f64>);

/// Returns a robot of three links in a row, of which the first two joints turn and the last slides, with two motors: the first
/// joint and half of the second, and the first less the second.
fn machine(joints: [Limits; 3], motors: [Limits; 2]) -> Assembly {
    let ball = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: 0.001 } }];
    let mut links = vec![link("base", ball.clone(), 1.0, Vec3::zeros(), 0.5)];
    let mut all = vec![];
    for (index, limits) in joints.into_iter().enumerate() {
        let at = Vec3::z() * (index as f64 + 1.0);
        let mut next = link(&format!("l{index}"), ball.clone(), 1.0, Vec3::zeros(), 0.5);
        next.pose = shifted(at);
        links.push(next);
        let kind = if index < 2 { JointKind::Revolute } else { JointKind::Prismatic };
        all.push(joint(&format!("j{index}"), (index, index + 1), kind, shifted(at), Vec3::z(), limits));
    }
    let mut robot = robot_of(links, all);
    let kinds = &mut Arc::make_mut(&mut robot.library).modules;
    let terms = [vec![(0, 1.0), (1, 0.5)], vec![(0, 1.0), (1, -1.0)]];
    let named = ["m0", "m1"].into_iter().zip(terms).zip(motors);
    kinds[0].motors =
        named.map(|((name, joints), limits)| Motor { name: name.into(), joints, limits }).collect();
    robot
}

/// The factors of the joints in the positions of the drives: the joints, then the motors.
const DRIVES: [(&str, [f64; 3]); 5] = [
    ("r.j0", [1.0, 0.0, 0.0]),
    ("r.j1", [0.0, 1.0, 0.0]),
    ("r.j2", [0.0, 0.0, 1.0]),
    ("r.m0", [1.0, 0.5, 0.0]),
    ("r.m1", [1.0, -1.0, 0.0]),
];

/// Returns the value and the rate of a Bernstein polynomial by de Casteljau's algorithm, at a part of its way.
fn bernstein(control: &[f64], u: f64) -> (f64, f64) {
    let mut points = control.to_vec();
    let mut rate = 0.0;
    while points.len() > 1 {
        if points.len() == 2 {
            rate = (points[1] - points[0]) * (control.len() - 1) as f64;
        }
        points = points.windows(2).map(|pair| pair[0] + u * (pair[1] - pair[0])).collect();
    }
    (points[0], rate)
}

/// Returns the position and the velocity of a joint at a time (s), from 0 at the start; within or at the end of a segment.
fn state(pieces: &[Piece], t: f64) -> (f64, f64) {
    let begun = pieces.iter().rfind(|piece| piece.0 < t);
    match begun {
        None => (0.0, 0.0),
        Some((_, to, control)) if t > *to => (control[control.len() - 1], 0.0),
        Some((from, to, control)) => {
            let (position, rate) = bernstein(control, (t - from) / (to - from));
            (position, rate / (to - from))
        }
    }
}

/// Returns a random motion of a joint over about 4 s: segments of degrees 1 to 5, some after a pause, each from where the last
/// ended.
fn wander(random: &mut SplitMix64) -> Vec<Piece> {
    let (mut t, mut at, mut pieces) = (0.0, 0.0, vec![]);
    while t < 3.5 {
        t += if random.below(2) == 0 { 0.0 } else { 0.1 + 0.3 * random.next_f64() };
        let end = t + 0.2 + 0.7 * random.next_f64();
        let mut control = vec![at];
        control.extend((0..1 + random.below(5)).map(|_| random.next_signed()));
        at = control[control.len() - 1];
        pieces.push((t, end, control));
        t = end;
    }
    pieces
}

fn plan(robot: Assembly, motions: &[Vec<Piece>]) -> Plan {
    let mut motion = Motion::new(robot);
    for (joint, pieces) in motions.iter().enumerate() {
        for (from, to, control) in pieces {
            motion = motion.segment(joint, *from, *to, control.clone());
        }
    }
    motion.plan(World::FREE)
}

/// Returns the position and the velocity of a drive at a time (s).
fn drive(factors: &[f64; 3], motions: &[Vec<Piece>], t: f64) -> (f64, f64) {
    let joints = motions.iter().map(|pieces| state(pieces, t)).zip(factors);
    joints.fold((0.0, 0.0), |(p, v), (joint, factor)| (p + factor * joint.0, v + factor * joint.1))
}

/// Returns the lowest and the highest position of each drive, and its greatest speed, at very many times.
fn extremes(motions: &[Vec<Piece>]) -> Vec<(f64, f64, f64)> {
    let mut cuts: Vec<f64> = motions.iter().flatten().flat_map(|piece| [piece.0, piece.1]).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let inside = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        // Just after the begin, where a segment that begins there counts, up to the end.
        (0..=300).map(move |i| from + (to - from) * (1e-9 + f64::from(i) / 300.0).min(1.0))
    };
    let times: Vec<f64> = cuts.windows(2).flat_map(inside).collect();
    let of = |(_, factors): &(&str, [f64; 3])| {
        times.iter().fold((0.0_f64, 0.0_f64, 0.0_f64), |(low, high, fast), t| {
            let (p, v) = drive(factors, motions, *t);
            (low.min(p), high.max(p), fast.max(v.abs()))
        })
    };
    DRIVES.iter().map(of).collect()
}

fn of_kind(plan: &Plan, kind: CheckKind) -> Vec<Failure> {
    verify(plan).failures.into_iter().filter(|failure| failure.kind == kind).collect()
}

/// Returns a robot of which one drive has a limit.
fn one_limit(own: usize, limits: Limits) -> Assembly {
    let of = |index: usize| if index == own { limits } else { Limits::default() };
    machine([of(0), of(1), of(2)], [of(3), of(4)])
}

#[test]
fn the_least_margin_of_speed_is_that_of_the_fastest_drive() {
    let mut random = SplitMix64(5);
    for _ in 0..10 {
        let motions = [wander(&mut random), wander(&mut random), wander(&mut random)];
        let most = extremes(&motions);
        let limits: Vec<f64> = most.iter().map(|(.., fast)| fast * (1.1 + 0.5 * random.next_f64())).collect();
        let of = |index: usize| Limits { speed: Some(limits[index]), ..Limits::default() };
        let plan = plan(machine([of(0), of(1), of(2)], [of(3), of(4)]), &motions);
        let ratios = most.iter().zip(&limits).map(|((.., fast), limit)| fast / limit);
        let (own, ratio) = ratios.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).expect("there are drives");
        let found = verify(&plan).speed_margin.expect("speeds have limits");
        assert!((found.value - (1.0 - ratio)).abs() < 1e-3, "{found:?}: {ratio}");
        assert_eq!(found.at, [DRIVES[own].0]);
        let there = drive(&DRIVES[own].1, &motions, found.time).1.abs().max(
            // A rate that is greatest as a segment begins.
            drive(&DRIVES[own].1, &motions, found.time + 1e-9).1.abs(),
        );
        assert!((there / limits[own] - (1.0 - found.value)).abs() < 1e-5, "{found:?}: {there}");
    }
}

#[test]
fn each_drive_keeps_to_its_range_and_its_speed() {
    let mut random = SplitMix64(6);
    for round in 0..10 {
        let motions = [wander(&mut random), wander(&mut random), wander(&mut random)];
        let own = round % DRIVES.len();
        let (low, high, fast) = extremes(&motions)[own];
        let (name, factors) = DRIVES[own];
        for (by, keeps) in [(1e-3, true), (-1e-3, false)] {
            let ends = [(low - by, high + 1.0), (low - 1.0, high + by)];
            for (end, range) in ends.into_iter().enumerate() {
                let robot = one_limit(own, Limits { range: Some(range), ..Limits::default() });
                let found = of_kind(&plan(robot, &motions), CheckKind::JointRange);
                assert_eq!(found.is_empty(), keeps, "{round} {range:?} {found:?}");
                if let [failure] = found.as_slice() {
                    let (position, limit) = [(low, range.0), (high, range.1)][end];
                    assert!((failure.value - position).abs() < 1e-4, "{failure:?}: {position}");
                    assert!((drive(&factors, &motions, failure.time).0 - failure.value).abs() < 1e-6);
                    assert_eq!((failure.limit, failure.at.as_slice()), (limit, &[name.to_owned()][..]));
                }
            }
            let robot = one_limit(own, Limits { speed: Some(fast * (1.0 + by)), ..Limits::default() });
            let found = of_kind(&plan(robot, &motions), CheckKind::Speed);
            assert_eq!(found.is_empty(), keeps, "{round} {fast} {found:?}");
            if let [failure] = found.as_slice() {
                assert!((failure.value / fast - 1.0).abs() < 1e-3 && failure.at == [name]);
                // A joint that turns has an angle, and one that slides a length.
                let turns = own != 2;
                let words = |unit: &str| failure.message.contains(unit);
                assert_eq!((words("rad/s"), words("m/s")), (turns, !turns), "{}", failure.message);
            }
        }
    }
}

/// A way of `by` (rad) in 1 s that begins or ends at rest, and at a speed of twice that at its other end.
fn half(from: f64, by: f64, begins_at_rest: bool) -> Vec<f64> {
    let middle = if begins_at_rest { from } else { from + by };
    vec![from, middle, from + by]
}

/// Returns the failures of acceleration, with their times, of a joint that moves so; excused from `free` on for as long.
fn jumps(pieces: Vec<Piece>, acceleration: Option<f64>, free: (f64, f64), world: World) -> Vec<Failure> {
    let limits = Limits { acceleration, ..Limits::default() };
    let mut plan = plan(one_limit(0, limits), &[pieces]);
    plan.worlds[0].world = world;
    plan.causes.push(cause(0));
    let (kind, cause) = (ExemptionKind::Acceleration, CauseId(0));
    plan.exemptions.push(Exemption { from: free.0, to: free.1, kind, cause });
    of_kind(&plan, CheckKind::Acceleration)
}

/// Without a pause two halves of a motion are one, and its speed goes on; after a pause a joint begins from rest.
#[test]
fn a_joint_jumps_from_rest_after_a_pause() {
    let full = World { dynamics: DynamicsModel::Full, ..World::FREE };
    assert_eq!(full.ground, Ground::Off);
    let two = |pause: f64| {
        vec![(0.0, 1.0, half(0.0, 0.3, true)), (1.0 + pause, 2.0 + pause, half(0.3, 0.3, false))]
    };
    for (limit, world) in [(Some(1.0), World::FREE), (Some(1.0), full), (None, full)] {
        let times = |pause: f64, free: (f64, f64)| {
            let found = jumps(two(pause), limit, free, world);
            found.iter().map(|failure| failure.time).collect::<Vec<_>>()
        };
        assert!(times(0.0, (5.0, 6.0)).is_empty());
        assert_eq!(times(1.0, (5.0, 6.0)), [1.0]);
        assert_eq!(times(1.0, (0.5, 1.5)), [2.0]);
        assert!(times(1.0, (0.5, 2.5)).is_empty());
    }
    // The change is told beside a limit of nothing if none is stated.
    let found = jumps(two(1.0), None, (0.5, 1.5), full);
    assert!((found[0].value - 0.6).abs() < 1e-12 && found[0].limit == 0.0, "{found:?}");
}

/// A quintic between rests accelerates by 10/√3 of its way over the square of its time.
#[test]
fn accelerations_are_those_of_the_motion() {
    let quintic = |by: f64, time: f64| vec![(0.0, time, vec![0.0, 0.0, 0.0, by, by, by])];
    for (by, time) in [(0.5, 2.0), (-1.5, 0.7)] {
        let greatest = 10.0 / libm::sqrt(3.0) * f64::abs(by) / (time * time);
        for (factor, keeps) in [(1.0 + 1e-6, true), (1.0 - 1e-6, false)] {
            let limit = Some(factor * greatest);
            let found = jumps(quintic(by, time), limit, (5.0, 6.0), World::FREE);
            assert_eq!(found.is_empty(), keeps, "{found:?}");
            if let [failure] = found.as_slice() {
                assert!((failure.value / greatest - 1.0).abs() < 1e-9, "{failure:?}");
                let part = failure.time / time;
                // At (3 ± √3)/6 of its time.
                let off = ((part - 0.5).abs() - libm::sqrt(3.0) / 6.0).abs();
                assert!(off < 1e-5, "{part}");
            }
        }
    }
}
