//! Motions by goals: inverse kinematics against kinematics written another way, free ways against closed forms of distances.

use crate::support::arms::{BALL, LENGTHS, RANGES, axis, gantry, seven_joints};
use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use crate::support::robots::{at_rest, boxed};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Pose, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Obstacle, Plan, Status, Verdict, file, reversed, sliced};
use modl::planners::NoProgress;
use modl::planners::goals::avoid::{Path, Problem, Refusal, Settings, plan};
use modl::planners::goals::{FreeSpace, Surroundings, reach};
use modl::robot::chain::{Chain, DescentSettings, Orientation, Target};
use modl::robot::jacobian::LinkFrame;
use modl::robot::{Assembly, Kinematics, PortRef, State};

/// Returns the pose of the tool of [`seven_joints`], written as a product of turns and shifts.
fn tool(q: &[f64]) -> Pose {
    let start = shifted(Vec3::z() * LENGTHS[0]);
    (0..7).fold(start, |pose, index| {
        pose * turned(axis(index), q[index]) * shifted(Vec3::z() * LENGTHS[index + 1])
    })
}

/// Returns the distance and the angle between two poses.
fn apart(a: &Pose, b: &Pose) -> (f64, f64) {
    let turn = a.rotation.inverse() * b.rotation;
    let sine = turn.imag().norm();
    ((a.translation.vector - b.translation.vector).norm(), 2.0 * libm::atan2(sine, turn.w.abs()))
}

#[test]
fn an_arm_of_seven_joints_reaches_what_is_within_its_reach() {
    let robot = seven_joints();
    let kinematics = Kinematics::new(&robot, &[], 0);
    let frame = LinkFrame { link: 7, X_LF: shifted(Vec3::z() * LENGTHS[7]) };
    let chain = Chain::new(&robot, &kinematics, 0, &frame).expect("the links are connected");
    let mut numbers = Numbers(7);
    let (mut reached, count) = (0, 500);
    for trial in 0..count {
        let q: Vec<f64> = RANGES.iter().map(|range| numbers.between(-range, *range)).collect();
        let goal = tool(&q);
        assert!(apart(&goal, &chain.pose(&q)).0 < 1e-12, "the two kinematics differ");
        let target =
            Target { position: goal.translation.vector, orientation: Orientation::Full(goal.rotation) };
        let mut found = vec![0.0; 7];
        let mut rng = SplitMix64(trial);
        chain.reach(&target, &mut found, (20, &mut rng), &DescentSettings::default());
        assert!(found.iter().zip(RANGES).all(|(q, range)| q.abs() <= range), "{found:?} is out of range");
        let (distance, angle) = apart(&tool(&found), &goal);
        reached += usize::from(distance < 1e-6 && angle < 1e-6);
    }
    assert!(reached * 100 >= 99 * count as usize, "{reached} of {count}");
}

#[test]
fn positions_and_axes_are_reached_alone() {
    let robot = seven_joints();
    let kinematics = Kinematics::new(&robot, &[], 0);
    let frame = LinkFrame { link: 7, X_LF: shifted(Vec3::z() * LENGTHS[7]) };
    let chain = Chain::new(&robot, &kinematics, 0, &frame).expect("the links are connected");
    let mut numbers = Numbers(8);
    for trial in 0..100 {
        let q: Vec<f64> = RANGES.iter().map(|range| numbers.between(-range, *range)).collect();
        let goal = tool(&q);
        let position = goal.translation.vector;
        let ahead = goal.rotation * Vec3::x();
        for orientation in [Orientation::Free, Orientation::Along(ahead)] {
            let mut found = vec![0.0; 7];
            let mut rng = SplitMix64(trial);
            let target = Target { position, orientation };
            chain.reach(&target, &mut found, (50, &mut rng), &DescentSettings::default());
            let pose = tool(&found);
            assert!((pose.translation.vector - position).norm() < 1e-6);
            let off = (pose.rotation * Vec3::x()).cross(&ahead).norm();
            assert!(orientation == Orientation::Free || off < 1e-6, "{off}");
        }
    }
    // A place twice as far away as the arm is long is not reached, and the nearest posture points there.
    let target = Target { position: Vec3::new(2.2, 0.0, 0.17), orientation: Orientation::Free };
    let mut found = vec![0.0; 7];
    let (error, starts) =
        chain.reach(&target, &mut found, (20, &mut SplitMix64(1)), &DescentSettings::default());
    assert_eq!(starts, 20);
    // The shoulder is above the first two lengths, and the rest is stretched out from there.
    let nearest = libm::hypot(2.2, LENGTHS[1]) - LENGTHS[2..].iter().sum::<f64>();
    assert!(error.distance > nearest - 1e-9 && error.distance < nearest + 1e-4, "{error:?}, not {nearest}");
}

/// Returns the robot of a library's configuration, with the state it begins in.
fn of_library(make: &str) -> (Assembly, State) {
    let text = format!(
        "use std.smores.{{Arm, MobManip8, Puma4, Smores}}\nconfig C {{ part r: {make} }}\nlet c = C()\n\
         emit(plan(move(modules(c, Smores)[0].left, by: 0deg), world: world(ground: held, gravity: off)), \"p.json\")\n"
    );
    let desk = run_clean(&text);
    let plan = file::read(desk.text("p.json")).expect("the plan can be read");
    let Body::Tracks(tracks) = plan.body else { panic!("a plan of joints") };
    (tracks.robot, tracks.start)
}

#[test]
fn arms_of_the_library_reach_what_their_joints_reach() {
    for (make, tip, port) in
        [("Puma4", "r.hand", "top"), ("Arm(n: 6)", "r.m[5]", "top"), ("MobManip8", "r.arm[3]", "bottom")]
    {
        let (robot, start) = of_library(make);
        let kinematics = Kinematics::new(&robot, &start.bonds, robot.base);
        let module = robot.modules.iter().position(|m| m.name == tip).expect("the tip is there");
        let port =
            robot.module_type(module).ports.iter().position(|p| p.name == port).expect("so is the port");
        let port = PortRef { module, port };
        let held = kinematics.link(robot.base, 0);
        let chain = Chain::new(&robot, &kinematics, held, &LinkFrame::of_port(&robot, &kinematics, port))
            .expect("it is connected");
        let mut numbers = Numbers(9);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        let mut pose_at = |joints: &[f64]| {
            kinematics.link_poses_from(robot.base, joints, &Pose::identity(), &mut poses);
            kinematics.port_pose(&robot, port, &poses)
        };
        let (mut reached, count) = (0, 200);
        for trial in 0..count {
            let mut joints = start.joints.clone();
            for j in chain.joints() {
                let (low, high) = (j.limits.0.max(-3.0), j.limits.1.min(3.0));
                joints[j.joint] = numbers.between(low, high);
            }
            let goal = pose_at(&joints);
            let target =
                Target { position: goal.translation.vector, orientation: Orientation::Full(goal.rotation) };
            let mut found = start.joints.clone();
            let mut rng = SplitMix64(trial);
            chain.reach(&target, &mut found, (20, &mut rng), &DescentSettings::default());
            let within = |j: &modl::robot::chain::ChainJoint| {
                found[j.joint] >= j.limits.0 && found[j.joint] <= j.limits.1
            };
            assert!(chain.joints().iter().all(within), "{make} is out of range");
            let (distance, angle) = apart(&pose_at(&found), &goal);
            reached += u64::from(distance < 1e-6 && angle < 1e-6);
        }
        assert!(reached * 100 >= 99 * count, "{make}: {reached} of {count}");
    }
}

/// A wall: its least and greatest x and y, m.
type Wall = (&'static str, [f64; 4]);

/// Searches for a way of the ball among walls.
fn way(walls: &[Wall], from: [f64; 2], to: [f64; 2], clearance: f64, seed: u64) -> Result<Path, Refusal> {
    let robot = gantry();
    let state = State { joints: from.to_vec(), ..at_rest(&robot) };
    let kinematics = Kinematics::new(&robot, &[], 0);
    let mut poses = vec![Pose::identity(); 3];
    kinematics.link_poses(&state.joints, &Pose::identity(), &mut poses);
    let obstacles: Vec<Obstacle> = walls
        .iter()
        .map(|(name, [a, b, c, d])| Obstacle {
            name: (*name).into(),
            shapes: vec![boxed(Vec3::new(*a, *c, -0.5), Vec3::new(*b, *d, 0.5))],
        })
        .collect();
    let around =
        Surroundings { robot: &robot, state: &state, poses: &poses, obstacles: &obstacles, floor: false };
    let mut space = FreeSpace::new(around, 0, &[0, 1], clearance).expect("the shapes are sound");
    let problem = Problem { from: &from, to: &to, limits: &[(-1.0, 1.0); 2] };
    let settings = Settings { seed, budget: 20_000, ..Settings::default() };
    plan(&problem, &mut space, &settings, &mut NoProgress)
}

/// Returns the distance of a point in the plane from a wall, m; 0 inside.
fn distance([x, y]: [f64; 2], [a, b, c, d]: [f64; 4]) -> f64 {
    let (dx, dy) = ((a - x).max(x - b).max(0.0), (c - y).max(y - d).max(0.0));
    libm::hypot(dx, dy)
}

#[test]
fn ways_lead_through_gaps_and_keep_their_clearance() {
    // A wall with a gap of 0.14 m, and the ball of 0.1 m.
    let walls: [Wall; 2] = [("left", [-0.1, 0.1, -1.5, 0.23]), ("right", [-0.1, 0.1, 0.37, 1.5])];
    for seed in 0..10 {
        let path = way(&walls, [-0.8, -0.8], [0.8, -0.6], 5e-3, seed).expect("there is a way");
        let postures = &path.postures;
        assert_eq!((&postures[0], &postures[postures.len() - 1]), (&vec![-0.8, -0.8], &vec![0.8, -0.6]));
        let mut length = 0.0;
        for pair in postures.windows(2) {
            length += libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
            for i in 0..=1000 {
                let s = f64::from(i) / 1000.0;
                let p = [0, 1].map(|k| pair[0][k] + s * (pair[1][k] - pair[0][k]));
                let least = walls.iter().map(|(_, wall)| distance(p, *wall) - BALL).fold(1.0, f64::min);
                assert!(least > 5e-3 / 2.0, "{least} at {p:?} with seed {seed}");
            }
        }
        // Not shorter than straight to the gap and on, and not much longer after shortcuts.
        let shortest = libm::hypot(0.7, 1.08) + 0.2 + libm::hypot(0.7, 0.88);
        assert!(length > shortest - 0.1 && length < 1.25 * shortest, "{length} instead of {shortest}");
    }
}

#[test]
fn what_is_in_the_way_of_a_ball_is_named() {
    let room: [Wall; 4] = [
        ("north", [-0.5, 0.5, 0.3, 0.4]),
        ("south", [-0.5, 0.5, -0.4, -0.3]),
        ("east", [0.4, 0.5, -0.4, 0.4]),
        ("west", [-0.5, -0.4, -0.4, 0.4]),
    ];
    match way(&room, [0.0, 0.0], [0.9, 0.0], 1e-3, 0) {
        Err(Refusal::Budget { work, between: Some(meeting), .. }) => {
            assert!((20_000..20_100).contains(&work), "{work}");
            assert_eq!(meeting.bodies[0], "r.ball");
            assert!(room.iter().any(|(name, _)| *name == meeting.bodies[1]), "{meeting:?}");
        }
        other => panic!("{other:?}"),
    }
    match way(&room, [0.0, 0.0], [0.38, 0.0], 1e-3, 0) {
        Err(Refusal::Goal(meeting)) => {
            assert_eq!(meeting.bodies, ["r.ball".to_string(), "east".to_string()]);
            assert!((meeting.distance + 0.03).abs() < 1e-6, "{meeting:?}");
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(way(&room, [0.0, 0.27], [0.0, 0.0], 1e-3, 0), Err(Refusal::Start(_))));
    // Nearer to a wall than the clearance it may end, and begin.
    assert!(way(&room, [0.0, 0.2499], [0.3499, 0.0], 1e-2, 0).is_ok());
    // The same seed gives the same way.
    let walls: [Wall; 1] = [("wall", [-0.1, 0.1, -0.9, 0.9])];
    let ends = ([-0.8, 0.0], [0.8, 0.0]);
    assert_eq!(way(&walls, ends.0, ends.1, 1e-3, 5), way(&walls, ends.0, ends.1, 1e-3, 5));
}

/// Returns the posture by which [`seven_joints`] brings its tool to a position, with and without the task of balance, and the
/// distance of the centre of mass from where it was, along the ground, m.
fn balanced(position: Vec3, orientation: Orientation, balance: bool) -> (reach::Posture, f64) {
    let robot = seven_joints();
    let kinematics = Kinematics::new(&robot, &[], 0);
    let frame = LinkFrame { link: 7, X_LF: shifted(Vec3::z() * LENGTHS[7]) };
    let chain = Chain::new(&robot, &kinematics, 0, &frame).expect("the links are connected");
    let state = State { joints: vec![0.1, 0.4, -0.2, 0.7, 0.3, -0.5, 0.2], ..at_rest(&robot) };
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&state.joints, &Pose::identity(), &mut poses);
    let centre = |joints: &[f64], poses: &mut [Pose]| {
        kinematics.link_poses(joints, &Pose::identity(), poses);
        kinematics.centre_of_mass(&robot, poses).0
    };
    let stood = centre(&state.joints, &mut poses);
    let around =
        Surroundings { robot: &robot, state: &state, poses: &poses.clone(), obstacles: &[], floor: false };
    let moved: Vec<usize> = (0..7).collect();
    let mut space = FreeSpace::new(around, 0, &moved, 0.0).expect("the shapes are sound");
    let names: Vec<String> = (0..7).map(|joint| format!("j{joint}")).collect();
    let target = Target { position, orientation };
    let problem = reach::Problem { chain: &chain, target, joints: &state.joints, names: &names };
    let settings = reach::Settings { clearance: 0.0, balance, solutions: 1, ..reach::Settings::default() };
    let found = reach::plan(&problem, &mut space, &settings, &mut NoProgress).expect("it is within reach");
    let off = centre(&found.joints, &mut poses) - stood;
    let way = libm::hypot(off.x, off.y);
    (found, way)
}

#[test]
fn what_freedom_is_left_keeps_the_centre_of_mass_above_where_it_was() {
    let begins = tool(&[0.1, 0.4, -0.2, 0.7, 0.3, -0.5, 0.2]);
    for by in [Vec3::new(0.0, 0.15, 0.0), Vec3::new(-0.1, 0.0, 0.1), Vec3::new(0.05, -0.1, -0.1)] {
        let position = begins.translation.vector + by;
        let (free, far) = balanced(position, Orientation::Free, false);
        let (kept, near) = balanced(position, Orientation::Free, true);
        for found in [&free, &kept] {
            assert!((tool(&found.joints).translation.vector - position).norm() < 1e-6, "{found:?}");
            assert!(found.joints.iter().zip(RANGES).all(|(q, range)| q.abs() <= range));
        }
        assert!(near < 0.9 * far, "{near} m instead of {far} m");
        // With the whole pose asked for one freedom is left, and with balance it is used no worse.
        let goal = tool(&kept.joints);
        let (_, whole) = balanced(position, Orientation::Full(goal.rotation), false);
        let (_, balanced) = balanced(position, Orientation::Full(goal.rotation), true);
        assert!(balanced <= whole + 1e-9, "{balanced} m instead of {whole} m");
    }
}

/// The plan of an arm that moves its hand along a line, with the position alone or the pose kept.
fn line_plan(orientation: &str) -> Plan {
    let text = format!(
        "use std.smores.Smores\nconfig Reacher {{\n  part m[7]: Smores\n\
         \x20 for i in 0..6 {{ connect m[i].top -- m[i + 1].bottom turn if i % 2 == 0 {{ 90deg }} else {{ 0deg }} }}\n\
         \x20 for i in 1..6 {{ set m[i].tilt = 25deg }}\n  base m[0]\n}}\nlet r = Reacher()\n\
         let b = line(r.m[6].top, by: [10mm, -20mm, 40mm], for: 2s, orientation: {orientation})\n\
         emit(plan(Sc(wait(500ms), b, wait(500ms)), world: world(ground: held, gravity: off)), \"p.json\")\n"
    );
    file::read(run_clean(&text).text("p.json")).expect("the plan can be read")
}

/// Returns the greatest distance of the port of a plan's first path from its line, m, by the kinematics of the whole robot.
fn off_line(plan: &Plan) -> f64 {
    let Body::Tracks(tracks) = &plan.body else { panic!("a plan of joints") };
    let stated = &plan.paths[0];
    let kinematics = Kinematics::new(&tracks.robot, &tracks.start.bonds, stated.module);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    let (a, b) = (stated.start.translation.vector, stated.end.translation.vector);
    let (along, length) = ((b - a).normalize(), (b - a).norm());
    let mut most: f64 = 0.0;
    for i in 0..=20_000 {
        let time = stated.from + (stated.to - stated.from) * f64::from(i) / 20_000.0;
        kinematics.link_poses(&tracks.state(time).joints, &Pose::identity(), &mut poses);
        let p = kinematics.port_pose(&tracks.robot, stated.port, &poses).translation.vector - a;
        most = most.max((p - along * p.dot(&along).clamp(0.0, length)).norm());
    }
    most
}

fn path_check(verdict: &Verdict) -> Option<&Status> {
    verdict.checks.iter().find(|check| check.kind == CheckKind::Path).map(|check| &check.status)
}

#[test]
fn the_judge_proves_that_a_port_keeps_to_its_line() {
    let free = line_plan("free");
    assert_eq!(free.paths.len(), 1);
    assert!((free.paths[0].from - 0.5).abs() < 1e-9 && (free.paths[0].to - 2.5).abs() < 1e-9);
    assert!(off_line(&free) <= 1e-4, "{} m", off_line(&free));
    assert_eq!(path_check(&verify(&free)), Some(&Status::Proved));
    let kept = line_plan("kept");
    assert!(matches!(path_check(&verify(&kept)), Some(Status::Sampled(n)) if *n >= 64));
    // The line is stated of any part of the plan, and of the plan run backwards.
    for part in
        [reversed(&kept), sliced(&free, 1.0, 2.0).expect("a part"), sliced(&free, 0.0, 0.4).expect("a part")]
    {
        let verdict = verify(&part);
        assert_eq!(part.paths.len(), usize::from(part.body.duration() > 0.5));
        assert_eq!(path_check(&verdict).is_some(), !part.paths.is_empty());
        assert!(verdict.failures.iter().all(|failure| failure.kind != CheckKind::Path));
    }
}

#[test]
fn a_plan_that_was_bent_is_off_its_line() {
    for (bend, fails) in [(1e-5, false), (2e-3, true), (2e-2, true)] {
        let mut plan = line_plan("free");
        let Body::Tracks(tracks) = &mut plan.body else { panic!("a plan of joints") };
        let track = &mut tracks.tracks[2];
        let middle = track.segments.len() / 2;
        // Both inner control points: the curve leaves its place by three quarters of that, between two keyframes.
        track.segments[middle].control[1..3].iter_mut().for_each(|c| *c += bend);
        let (verdict, off) = (verify(&plan), off_line(&plan));
        let failure = verdict.failures.iter().find(|failure| failure.kind == CheckKind::Path);
        assert_eq!(failure.is_some(), fails, "{off} m with {bend} rad");
        if let Some(failure) = failure {
            assert!((failure.value - off).abs() < 1e-2 * off, "{} m, and {off} m", failure.value);
            assert_eq!(failure.limit, 1e-4);
            assert!(failure.message.contains("off its path"), "{}", failure.message);
        }
    }
    // A tighter statement than the motion keeps is refused, too.
    let mut plan = line_plan("free");
    let off = off_line(&plan);
    for part in [0.5, 0.9, 0.99, 0.999] {
        plan.paths[0].within = part * off;
        assert!(verify(&plan).failures.iter().any(|failure| failure.kind == CheckKind::Path), "{part}");
    }
    plan.paths[0].within = 1.01 * off;
    assert!(matches!(path_check(&verify(&plan)), Some(Status::Proved)));
}

#[test]
fn paths_in_files_name_what_they_are_of() {
    let plan = line_plan("kept");
    let text = file::write(&plan).expect("it can be written");
    assert_eq!(file::read(&text).expect("it can be read").paths, plan.paths);
    let (before, paths) = text.split_at(text.find("\"paths\"").expect("the paths are written"));
    assert!(paths.contains("m[6].top"), "the port is named");
    let renamed = format!("{before}{}", paths.replacen("m[6].top", "m[5].top", 1));
    assert!(file::read(&renamed).is_err(), "the name is that of another port");
    let mut other = plan.clone();
    other.paths[0].within = -1.0;
    assert_eq!(verify(&other).failures.len(), 1);
    other = plan.clone();
    other.paths[0].port.module = 99;
    assert_eq!(verify(&other).checks[0].status, Status::Failed);
}
