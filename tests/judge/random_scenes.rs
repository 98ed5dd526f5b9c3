//! Random scenes of sliding rods, judged and sampled ten times as densely by arithmetic of the test's own: where the
//! rods are follows from their slides alone, and boxes that share their axes meet where their intervals do. Rods dock and part
//! again. Blocks fall over where the common centre of mass leaves the edge that they stand on.

use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use modl::geometry::{Placed, Pose, Shape, Vec3, pose::turned};
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, DockingEvent, DockingKind, Obstacle, Plan, Status};
use modl::robot::ClusterPose;

/// Four rods that move along x in a world without weight: a carrier of 50 mm and a rod of 80 x 20 x 20 mm each. They are written
/// docked with each other; in the scenes nothing docks them.
const RODS: &str = "
connector Face { mates Face, turns 4, capture 4mm 5deg }
module Rod {
  link body = box(50mm, 20mm, 20mm, mass: 5kg)
  link slide = box(80mm, 20mm, 20mm, mass: 50g) at [0mm, 0mm, 30mm]
  joint out : body -> slide = prismatic(axis: X, range: -400mm..400mm, max_force: 50N) at [0mm, 0mm, 30mm]
  port front: Face on slide at [40mm, 0mm, 0mm] facing +X up +Z
  port back: Face on slide at [-40mm, 0mm, 0mm] facing -X up +Z
}
config Four {
  part m[4]: Rod
  for i in 0..3 { connect m[i].front -- m[i + 1].back }
  base m[0]
  behavior go = Sc(
    Pc([move(m[i].out, to: (i + 1) * 10mm, in: 2s) for i in 0..4]),
    Pc([move(m[i].out, to: 0mm, in: 2s) for i in 0..4]),
  )
}
emit(plan(Four().go(), world: world(gravity: 0m/s^2, ground: off, dynamics: statics)), \"p.json\")
";

/// Half the lengths of a box, m.
type Half = [f64; 3];

const BODY: Half = [0.025, 0.010, 0.010];
const SLIDE: Half = [0.040, 0.010, 0.010];
const HEIGHT: f64 = 0.030;

/// Overlaps that are this near to what is allowed may be judged either way, m: samples of the judge are 10 ms apart.
const TOL: f64 = 2e-4;

/// The number of the first obstacle, beyond those of robots; what obstacles do to each other is nobody's affair.
const POSTS: usize = 10;

/// The depth that counts as touching, m.
const TOUCH: f64 = 1e-4;

/// A box that stands fast or moves along x.
#[derive(Clone)]
struct Block {
    robot: usize,
    half: Half,
    centre: Vec3,
    /// The way along x in 2 s, and in 2 s back again, m; `None` for one that stands fast.
    reach: Option<f64>,
}

impl Block {
    /// Returns the box at a time, s.
    fn at(&self, time: f64) -> (Vec3, Half) {
        let out = self
            .reach
            .map_or(0.0, |reach| reach * smooth(if time < 2.0 { time / 2.0 } else { 2.0 - time / 2.0 }));
        (self.centre + Vec3::new(out, 0.0, 0.0), self.half)
    }

    /// Returns the box about all places where it comes.
    fn swept(&self) -> (Vec3, Half) {
        let way = self.reach.unwrap_or(0.0) / 2.0;
        let [x, y, z] = self.half;
        (self.centre + Vec3::new(way, 0.0, 0.0), [x + way.abs(), y, z])
    }
}

/// Returns the part of the way after a part of the time, both from 0 to 1: the polynomial of the fifth degree that begins and
/// ends at rest and without acceleration.
fn smooth(part: f64) -> f64 {
    part * part * part * (10.0 - part * (15.0 - part * 6.0))
}

/// Returns the least distance of boxes of different robots, or of a robot and an obstacle, over 4 s, sampled each millisecond.
fn least_distance(blocks: &[Block]) -> f64 {
    let mut pairs = Vec::new();
    for (i, a) in blocks.iter().enumerate() {
        let others = blocks[i + 1..].iter().filter(|b| b.robot != a.robot && a.robot < POSTS);
        pairs.extend(others.map(|b| (apart(&a.swept(), &b.swept()), a, b)));
    }
    // Pairs that are never as near as the nearest so far need no look.
    pairs.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut least = f64::INFINITY;
    for (bound, a, b) in pairs {
        if bound >= least {
            break;
        }
        let distances =
            (0..=4000).map(|step| f64::from(step) * 1e-3).map(|time| apart(&a.at(time), &b.at(time)));
        least = distances.fold(least, f64::min);
    }
    least
}

/// Returns the signed distance of two boxes along their common axes, exact where they overlap.
fn apart(a: &(Vec3, Half), b: &(Vec3, Half)) -> f64 {
    let gaps: Vec<f64> = (0..3).map(|i| (a.0[i] - b.0[i]).abs() - a.1[i] - b.1[i]).collect();
    let outside = gaps.iter().map(|gap| gap.max(0.0) * gap.max(0.0)).sum::<f64>().sqrt();
    if outside > 0.0 { outside } else { gaps.iter().copied().fold(f64::NEG_INFINITY, f64::max) }
}

/// Returns the scene of a seed: a plan, and the boxes in it. Rods stand in four lanes, so that some meet, some pass by a
/// fraction of a millimetre, and some stay far.
fn scene(bare: &Plan, seed: u32) -> (Plan, Vec<Block>) {
    let mut n = Numbers(seed as u64);
    let mut plan = bare.clone();
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    tracks.start.bonds.fill(false);
    tracks.events.clear();
    let mut blocks = Vec::new();
    let place = |n: &mut Numbers| {
        let lane = [0.0, 0.0205, 0.041, 0.0615][n.below(4)];
        Vec3::new(n.between(-0.4, 0.4), lane, [0.0, 0.0605][n.below(2)])
    };
    let poses: Vec<Vec3> = (0..4).map(|_| place(&mut n)).collect();
    tracks.start.base = Pose::translation(poses[0].x, poses[0].y, poses[0].z);
    let cluster = |m: usize| {
        let p = poses[m];
        ClusterPose { reference: m, pose: Pose::translation(p.x, p.y, p.z) }
    };
    tracks.start.clusters = (1..4).map(cluster).collect();
    for (m, p) in poses.iter().enumerate() {
        blocks.push(Block { robot: m, half: BODY, centre: *p, reach: None });
        blocks.push(Block { robot: m, half: SLIDE, centre: p + Vec3::new(0.0, 0.0, HEIGHT), reach: None });
    }
    for track in &mut tracks.tracks {
        let reach = n.between(-0.25, 0.25);
        blocks[2 * track.joint.0 as usize + 1].reach = Some(reach);
        for (segment, ends) in track.segments.iter_mut().zip([(0.0, reach), (reach, 0.0)]) {
            let (count, (from, to)) = (segment.control.len(), ends);
            assert_eq!(count, 6, "a move is of the fifth degree");
            for (i, point) in segment.control.iter_mut().enumerate() {
                *point = if 2 * i < count { from } else { to };
            }
        }
    }
    let around: Vec<Vec3> = (0..n.below(3)).map(|_| place(&mut n) + Vec3::new(0.0, 0.0, HEIGHT)).collect();
    let obstacle = |(i, p): (usize, &Vec3)| {
        let pose = Pose::translation(p.x, p.y, p.z);
        let shape = Shape::Box { size: Vec3::new(0.04, 0.02, 0.02) };
        Obstacle { name: format!("post[{i}]"), shapes: vec![Placed { pose, shape }] }
    };
    tracks.obstacles = around.iter().enumerate().map(obstacle).collect();
    let post = |(i, p): (usize, &Vec3)| Block {
        robot: POSTS + i,
        half: [0.02, 0.01, 0.01],
        centre: *p,
        reach: None,
    };
    blocks.extend(around.iter().enumerate().map(post));
    (plan, blocks)
}

#[test]
fn a_thousand_random_scenes_are_judged_as_dense_sampling_judges_them() {
    let bare = run_clean(RODS).plan("p.json");
    let (mut hits, mut close, mut proved) = (0, 0, 0);
    for seed in 0..1000 {
        let (plan, blocks) = scene(&bare, seed);
        let verdict = verify(&plan);
        let least = least_distance(&blocks);
        let kinds: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
        assert!(kinds.iter().all(|kind| *kind == CheckKind::Collision), "{seed}: {:#?}", verdict.failures);
        if least < -TOUCH - TOL {
            assert!(!kinds.is_empty(), "{seed}: they meet {least} m deep");
            hits += 1;
        } else if least > -TOUCH + TOL {
            assert!(kinds.is_empty(), "{seed}: they stay {least} m apart: {:#?}", verdict.failures);
            close += usize::from(least < 0.002);
        }
        if let (Some(clearance), true) = (&verdict.clearance, least > 0.0) {
            // Between its samples the judge may miss by what a rod moves in half of one.
            assert!((clearance.value - least).abs() < 2.5e-3, "{seed}: {} of {least}", clearance.value);
        }
        let status = verdict.checks.iter().find(|check| check.kind == CheckKind::Collision);
        proved += usize::from(status.is_some_and(|check| check.status == Status::Proved));
    }
    assert!(hits >= 200 && close >= 100 && proved >= 5, "{hits} {close} {proved}");
}

/// Rods that dock where they meet, at random errors about what is captured, and part again.
#[test]
fn random_dockings_hold_within_capture_and_fail_beyond() {
    let bare = run_clean(RODS).plan("p.json");
    let (mut docked, mut missed) = (0, 0);
    for seed in 0..240 {
        let mut n = Numbers(seed as u64);
        let (mut plan, _) = scene(&bare, seed);
        let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
        tracks.obstacles = [].into();
        // Rod 1 comes with its back to the front of rod 0, the others are far away.
        let (error, offset) = (n.between(0.0, 0.008), n.between(-0.2, 0.2));
        let ends: Vec<f64> = tracks.tracks.iter().map(|track| track.segments[0].last()).collect();
        let gap = 0.080 + ends[0] - ends[1];
        tracks.start.base = Pose::translation(offset, 0.0, 0.0);
        for (i, cluster) in tracks.start.clusters.iter_mut().enumerate() {
            cluster.pose = Pose::translation(offset + gap, if i == 0 { error } else { 1.0 + i as f64 }, 0.0);
        }
        let cause = tracks.tracks[0].segments[0].cause;
        let event = |time, kind| DockingEvent { time, kind, bond: 0, cause };
        tracks.events = vec![event(2.0, DockingKind::Dock), event(2.0 + 1e-6, DockingKind::Undock)];
        let verdict = verify(&plan);
        let refused = verdict.failures.iter().any(|failure| failure.kind == CheckKind::Docking);
        if (error - 0.004).abs() > 1e-6 {
            assert_eq!(refused, error > 0.004, "{seed}: {error}: {:#?}", verdict.failures);
        }
        if refused { missed += 1 } else { docked += 1 }
    }
    assert!(docked >= 100 && missed >= 80, "{docked} {missed}");
}

/// Three blocks of 2 kg and 100 mm square, each with a rod of 1 kg that slides out above it. They are written docked with
/// each other; in the scenes they stand by themselves.
const BLOCKS: &str = "
connector Face { mates Face, turns 4 }
module Toppler {
  link body = box(100mm, 100mm, 200mm, mass: 2kg)
  link slide = box(60mm, 40mm, 40mm, mass: 1kg) at [0mm, 0mm, 130mm]
  joint out : body -> slide = prismatic(axis: X, range: -400mm..400mm, max_force: 50N) at [0mm, 0mm, 130mm]
  port front: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
  port back: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config Three {
  part m[3]: Toppler
  for i in 0..2 { connect m[i].front -- m[i + 1].back }
  base m[0]
  behavior go = Pc([move(m[i].out, to: (i + 1) * 10mm, in: 1s) for i in 0..3])
}
emit(plan(Three().go(), world: world(dynamics: statics)), \"p.json\")
";

/// The way of a rod, m, at which the common centre of mass, which moves by a third of it, is over the edge of 50 mm.
const OVER: f64 = 0.150;

/// Blocks whose rods slide out fall over, each when its own centre of mass leaves its edge, and no other.
#[test]
fn random_blocks_fall_over_when_their_centre_of_mass_leaves_their_edge() {
    let bare = run_clean(BLOCKS).plan("p.json");
    let (mut tipping, mut standing, mut near) = (0, 0, 0);
    for seed in 0..240 {
        let mut n = Numbers(seed as u64);
        let mut plan = bare.clone();
        let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
        tracks.start.bonds.fill(false);
        tracks.events.clear();
        // Farther from each other than any reaches.
        let place = |n: &mut Numbers, m: usize| {
            Pose::translation(2.0 * m as f64, n.between(-1.0, 1.0), 0.0)
                * turned(Vec3::z(), n.between(-3.0, 3.0))
        };
        tracks.start.base = place(&mut n, 0);
        tracks.start.clusters =
            (1..3).map(|m| ClusterPose { reference: m, pose: place(&mut n, m) }).collect();
        let mut falls: Vec<(String, f64)> = Vec::new();
        for track in &mut tracks.tracks {
            // Every third stops within some millimetres of the edge.
            let least = if n.below(3) == 0 { 0.145 } else { 0.05 };
            let reach = n.between(least, 0.155);
            let side = if n.below(2) == 0 { 1.0 } else { -1.0 };
            for (i, point) in track.segments[0].control.iter_mut().enumerate() {
                *point = if i < 3 { 0.0 } else { side * reach };
            }
            near += usize::from((reach - OVER).abs() < 0.002);
            if reach > OVER {
                falls.push((format!("m[{}]", track.joint.0), reach));
            }
        }
        let verdict = verify(&plan);
        let mut found: Vec<(String, f64)> = verdict
            .failures
            .iter()
            .map(|failure| {
                assert_eq!(failure.kind, CheckKind::Stability, "{seed}: {:#?}", verdict.failures);
                (failure.at[0].clone(), failure.time)
            })
            .collect();
        found.sort_by(|a, b| a.0.cmp(&b.0));
        let names = |falls: &[(String, f64)]| falls.iter().map(|fall| fall.0.clone()).collect::<Vec<_>>();
        assert_eq!(names(&found), names(&falls), "{seed}: {:#?}", verdict.failures);
        for ((_, found), (_, reach)) in found.iter().zip(&falls) {
            // It falls before the rod is half a millimetre farther than the edge allows.
            let beyond = reach * smooth(*found) - OVER;
            assert!((-1e-5..5e-4).contains(&beyond), "{seed}: it falls {beyond} m beyond the edge");
        }
        if falls.is_empty() { standing += 1 } else { tipping += 1 }
    }
    assert!(tipping >= 100 && standing >= 20 && near >= 50, "{tipping} {standing} {near}");
}
