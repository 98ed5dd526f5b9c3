//! Random scenes of sliding rods, judged and sampled ten times as densely by arithmetic of the test's own: where the
//! rods are follows from their slides alone, and boxes that share their axes meet where their intervals do.

use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, DockingEvent, DockingKind, Obstacle, Plan, Status, file};
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
    /// The joint that moves it along x; `None` for one that stands fast.
    joint: Option<usize>,
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
        blocks.push(Block { robot: m, half: BODY, centre: *p, joint: None });
        blocks.push(Block { robot: m, half: SLIDE, centre: p + Vec3::new(0.0, 0.0, HEIGHT), joint: Some(m) });
    }
    for track in &mut tracks.tracks {
        let reach = n.between(-0.25, 0.25);
        for (segment, ends) in track.segments.iter_mut().zip([(0.0, reach), (reach, 0.0)]) {
            let (count, (from, to)) = (segment.control.len(), ends);
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
        joint: None,
    };
    blocks.extend(around.iter().enumerate().map(post));
    (plan, blocks)
}

#[test]
fn a_thousand_random_scenes_are_judged_as_dense_sampling_judges_them() {
    let bare = file::read(run_clean(RODS).text("p.json")).expect("a plan that was written is read");
    let (mut hits, mut close, mut proved) = (0, 0, 0);
    for seed in 0..1000 {
        let (plan, blocks) = scene(&bare, seed);
        let tracks = plan.body.tracks().expect("modules");
        let verdict = verify(&plan);
        let mut least = f64::INFINITY;
        let steps = (tracks.duration / 1e-3) as usize;
        for step in 0..=steps {
            let joints = tracks.state(tracks.duration * step as f64 / steps as f64).joints;
            let at = |block: &Block| {
                let out = block.joint.map_or(0.0, |joint| joints[joint]);
                (block.centre + Vec3::new(out, 0.0, 0.0), block.half)
            };
            for (i, a) in blocks.iter().enumerate() {
                for b in blocks[i + 1..].iter().filter(|b| b.robot != a.robot && a.robot < POSTS) {
                    least = least.min(apart(&at(a), &at(b)));
                }
            }
            // What does not move need not be sampled again.
            if step == 0 && least < -TOUCH - TOL {
                break;
            }
        }
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
    let bare = file::read(run_clean(RODS).text("p.json")).expect("a plan that was written is read");
    let (mut docked, mut missed) = (0, 0);
    for seed in 0..200 {
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
    assert!(docked >= 80 && missed >= 80, "{docked} {missed}");
}
