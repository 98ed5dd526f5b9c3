//! Motions by goals: inverse kinematics against kinematics written another way, free ways against closed forms of distances.

use crate::support::arms::{LENGTHS, RANGES, axis, robot_of, seven_joints};
use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use crate::support::robots::{at_rest, boxed, joint, link};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::optimize::random::SplitMix64;
use modl::plan::{Body, Obstacle, file};
use modl::planners::NoProgress;
use modl::planners::goals::avoid::{Path, Problem, Refusal, Settings, plan};
use modl::planners::goals::{FreeSpace, Surroundings};
use modl::robot::chain::{Chain, DescentSettings, Orientation, Target};
use modl::robot::jacobian::LinkFrame;
use modl::robot::{Assembly, JointKind, Kinematics, Limits, PortRef, State};

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

/// The radius of the ball of a gantry, m.
const BALL: f64 = 0.05;

/// A ball that two slides carry along x and y.
fn gantry() -> Assembly {
    let tiny = vec![boxed(Vec3::new(-1e-3, -1e-3, 9.999), Vec3::new(1e-3, 1e-3, 10.0))];
    let ball = vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: BALL } }];
    let links = vec![
        link("rail", tiny.clone(), 1.0, Vec3::zeros(), 0.5),
        link(
            "cart",
            vec![boxed(Vec3::new(-1e-3, -1e-3, 4.999), Vec3::new(1e-3, 1e-3, 5.0))],
            1.0,
            Vec3::zeros(),
            0.5,
        ),
        link("ball", ball, 1.0, Vec3::zeros(), 0.5),
    ];
    let slide = |name: &str, between, axis| {
        let limits = Limits { range: Some((-1.0, 1.0)), speed: Some(1.0), acceleration: None, effort: None };
        joint(name, between, JointKind::Prismatic, Pose::identity(), axis, limits)
    };
    robot_of(links, vec![slide("x", (0, 1), Vec3::x()), slide("y", (1, 2), Vec3::y())])
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
