//! Curves of clearance and points of collision beside closed forms: within a module, between robots, and among obstacles.

use crate::support::arms::robot_of;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{self, joint, link};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::plan::verify::articulated::{ClusterPaths, clearances, clearances_at, collision_point};
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Obstacle, Plan, Status, Tracks, World};
use modl::robot::{ClusterPose, JointKind, Limits, Link, ModuleInstance};

/// The radius of balls, m.
const BALL: f64 = 0.02;

fn ball(name: &str, at: Vec3) -> Link {
    let shape = vec![Placed { pose: shifted(at), shape: Shape::Sphere { radius: BALL } }];
    link(name, shape, 1.0, at, 0.5)
}

/// Returns a robot of three balls in a row along x, 0.2 m apart: the second, higher up, slides across, the third along on it.
fn row() -> Motion {
    let links =
        vec![ball("a", Vec3::zeros()), ball("b", Vec3::new(0.2, 0.0, 0.3)), ball("c", Vec3::x() * 0.4)];
    let range = Limits { range: Some((-2.0, 2.0)), ..Limits::default() };
    let slide =
        |name: &str, between, axis| joint(name, between, JointKind::Prismatic, Pose::identity(), axis, range);
    Motion::new(robot_of(links, vec![slide("across", (0, 1), Vec3::y()), slide("along", (1, 2), -Vec3::x())]))
}

fn tracks(plan: &mut Plan) -> &mut Tracks {
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    tracks
}

/// Joints that slide 0.5 m in 2 s: the third ball passes the first, aside by as much as the second has slid across.
fn passing(aside: f64) -> Plan {
    let mut motion = row();
    motion.tracks.start.joints[0] = aside;
    motion.segment(1, 0.0, 2.0, vec![0.0, 0.5]).plan(World::FREE)
}

/// Returns the distance of two balls, m.
fn apart(a: Vec3, b: Vec3) -> f64 {
    (a - b).norm() - 2.0 * BALL
}

#[test]
fn the_curve_of_clearance_is_that_of_two_balls() {
    let plan = passing(0.05);
    let at = |time: f64| apart(Vec3::zeros(), Vec3::new(0.4 - 0.25 * time, 0.05, 0.0));
    for (until, count) in [(2.0, 50), (2.0, 7), (1.0, 100), (2.0, 1), (0.5, 0)] {
        let curve = clearances(&plan, until, count);
        let count = count.max(1);
        assert_eq!(curve.len(), count + 1);
        for (index, (time, distance)) in curve.iter().enumerate() {
            assert!((time - until * index as f64 / count as f64).abs() < 1e-12, "{time}");
            assert!((distance - at(*time)).abs() < 1e-9, "{time}: {distance} of {}", at(*time));
        }
    }
    let times = [1.6, 0.0, 2.0];
    let found = clearances_at(&plan, &times, None).expect("a robot of modules");
    for (time, distance) in times.iter().zip(found) {
        assert!((distance.expect("two balls") - at(*time)).abs() < 1e-9);
    }
    assert!(clearances(&plan, 0.0, 10).is_empty() && clearances(&plan, -1.0, 10).is_empty());
    let mut wrong = plan.clone();
    tracks(&mut wrong).start.joints.pop();
    assert!(clearances(&wrong, 2.0, 10).is_empty() && clearances_at(&wrong, &times, None).is_none());
    assert_eq!(collision_point(&wrong, (0, 0), 1.6), None);
}

/// Balls of one module meet where they are nearer than their radii by more than 0.1 mm, and their middle is the point.
#[test]
fn the_clearance_of_one_module_with_itself_is_judged_at_every_instant() {
    for (aside, meets) in [(0.0399, false), (0.0401, false), (0.0395, true), (0.01, true)] {
        let verdict = verify(&passing(aside));
        let clearance = verdict.clearance.clone().expect("two balls");
        assert!((clearance.value - (aside - 2.0 * BALL)).abs() < 2.1e-5, "{clearance:?}");
        assert_eq!(clearance.at, ["r"]);
        let failed: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
        assert_eq!(failed, if meets { vec![CheckKind::Collision] } else { vec![] }, "{aside}");
        let point = collision_point(&passing(aside), (0, 0), 1.6);
        // The robot alone is drawn with its lowest balls on the ground.
        let middle = Vec3::new(0.0, aside / 2.0, BALL);
        match point {
            Some(point) => assert!((point - middle).norm() < 1e-6 && aside < 2.0 * BALL, "{point} {aside}"),
            None => assert!(aside > 2.0 * BALL),
        }
    }
}

/// Returns a plan of two such robots, the second placed at `pose`, and an obstacle that is a ball at a place.
fn two(pose: Pose, obstacle: Option<Vec3>, world: World) -> Plan {
    let mut motion = row();
    motion.tracks.robot.modules.push(ModuleInstance { name: "s".into(), kind: 0 });
    motion.tracks.start.joints = vec![0.05, 0.0, 0.05, 0.0];
    motion.tracks.start.clusters = vec![ClusterPose { reference: 1, pose }];
    if let Some(at) = obstacle {
        let shapes = vec![Placed { pose: shifted(at), shape: Shape::Sphere { radius: BALL } }];
        motion.tracks.obstacles = vec![Obstacle { name: "post".into(), shapes }].into();
    }
    motion.segment(1, 0.0, 2.0, vec![0.0, 0.5]).plan(world)
}

/// Returns the places of the balls of the two robots at a time, m.
fn balls(shift: Vec3, time: f64) -> [[Vec3; 3]; 2] {
    let of = |shift: Vec3, slid: f64| {
        [Vec3::zeros(), Vec3::new(0.2, 0.05, 0.3), Vec3::new(0.4 - slid, 0.05, 0.0)].map(|at| shift + at)
    };
    [of(Vec3::zeros(), 0.25 * time), of(shift, 0.0)]
}

#[test]
fn the_clearance_of_several_robots_is_the_least_of_all_or_that_of_one() {
    // Far from the origin, which makes no difference.
    for far in [Vec3::zeros(), Vec3::new(7.0, -3.0, 2.0)] {
        for (shift, post) in [
            (Vec3::new(0.1, 0.2, 0.0), None),
            (Vec3::new(0.0, 3.0, 0.0), None),
            (Vec3::new(0.1, 0.2, 0.0), Some(Vec3::new(0.45, 0.0, 0.05))),
            (Vec3::new(0.0, 0.0, 0.9), Some(Vec3::new(0.0, 0.0, 0.5))),
        ] {
            let mut plan = two(shifted(shift + far), post.map(|at| at + far), World::FREE);
            tracks(&mut plan).start.base = shifted(far);
            let times: Vec<f64> = (0..=20).map(|i| 0.1 * f64::from(i)).collect();
            let inner = |own: &[Vec3; 3]| apart(own[0], own[2]);
            let outer = |own: &[Vec3; 3], other: &[Vec3]| {
                own.iter().flat_map(|a| other.iter().map(|b| apart(*a, *b))).fold(f64::INFINITY, f64::min)
            };
            let expected = |time: f64, reference: Option<usize>| {
                let robots = balls(shift, time);
                let mut least = outer(&robots[0], &robots[1]);
                for (index, robot) in robots.iter().enumerate() {
                    if reference.is_none_or(|own| own == index) {
                        let posts: Vec<Vec3> = post.into_iter().collect();
                        least = least.min(inner(robot)).min(outer(robot, &posts));
                    }
                }
                least
            };
            for reference in [None, Some(0), Some(1)] {
                let found = clearances_at(&plan, &times, reference).expect("robots of modules");
                for (time, distance) in times.iter().zip(found) {
                    let (distance, expected) = (distance.expect("balls"), expected(*time, reference));
                    assert!(
                        (distance - expected).abs() < 1e-9,
                        "{time} {reference:?}: {distance} of {expected}"
                    );
                }
            }
            // The verdict's is the least at the samples, and collisions are those of them.
            let dense = (0..=2000).map(|i| expected(1e-3 * f64::from(i), None)).fold(f64::INFINITY, f64::min);
            let verdict = verify(&plan);
            let found = verdict.clearance.clone().expect("balls").value;
            assert!((found - dense).abs() < 5e-4, "{found} of {dense}");
            assert_eq!(verdict.ok(), dense > 0.0, "{dense} {:?}", verdict.failures);
        }
    }
}

/// Links that pass each other closely between samples are not said to be proved apart; links that are far apart are.
#[test]
fn what_is_said_to_be_proved_between_samples_is_so() {
    // The third ball passes a thin plate, in steps of 20 mm.
    for x in [0.101, 0.107, 0.111, 0.119, 0.123, 0.127, 0.133] {
        let mut plan = passing(0.1);
        let own = tracks(&mut plan);
        own.tracks[0].segments[0].end = 0.25;
        own.duration = 0.25;
        let shape = Shape::Box { size: Vec3::new(1e-3, 0.02, 1e-3) };
        let place = |y: f64| Placed { pose: Pose::translation(x, y, 0.0), shape: shape.clone() };
        own.obstacles = vec![Obstacle { name: "plate".into(), shapes: vec![place(0.128)] }].into();
        let hit = verify(&plan);
        let proved = |plan: &Plan| {
            let verdict = verify(plan);
            let check = verdict.checks.into_iter().find(|check| check.kind == CheckKind::Collision);
            check.expect("it was made").status == Status::Proved
        };
        assert!(!hit.ok() || !proved(&plan), "{x}");
        tracks(&mut plan).obstacles =
            vec![Obstacle { name: "plate".into(), shapes: vec![place(0.9)] }].into();
        assert!(verify(&plan).ok() && proved(&plan), "{x}");
    }
}

/// A chain of small modules that swings along its line is proved to keep away from what is 0.2 m off to its side.
#[test]
fn a_chain_is_proved_to_keep_away_from_what_it_does_not_reach() {
    let status = |away: f64| {
        let mut plan =
            Motion::new(robots::chain(3)).linear("m1", robots::TILT, 40.0, 0.0, 0.2).plan(World::FREE);
        let shape = Shape::Sphere { radius: 0.01 };
        let shapes = vec![Placed { pose: shifted(Vec3::new(0.0, away, 0.0)), shape }];
        tracks(&mut plan).obstacles = vec![Obstacle { name: "post".into(), shapes }].into();
        let verdict = verify(&plan);
        let check = verdict.checks.into_iter().find(|check| check.kind == CheckKind::Collision);
        check.expect("it was made").status
    };
    assert_eq!([status(0.6), status(0.2)], [Status::Proved, Status::Proved]);
    assert_eq!(status(0.05), Status::Failed);
}

/// One robot among obstacles stays one, and has no clusters to be followed; nor has a plan that is not valid.
#[test]
fn one_robot_is_no_several_clusters() {
    let mut plan = passing(0.05);
    assert!(ClusterPaths::of(&plan, 2.0).is_none());
    let shapes = vec![Placed { pose: shifted(Vec3::z()), shape: Shape::Sphere { radius: BALL } }];
    tracks(&mut plan).obstacles = vec![Obstacle { name: "post".into(), shapes }].into();
    assert!(ClusterPaths::of(&plan, 2.0).is_none());
    let mut plan = two(shifted(Vec3::z()), None, STATICS);
    let paths = ClusterPaths::of(&plan, 2.0).expect("two robots");
    // After its end the plan is as it ends.
    let [mut at_end, mut later] = [(); 2].map(|()| vec![Pose::identity(); 6]);
    paths.place(2.0, &mut at_end);
    paths.place(100.0, &mut later);
    assert_eq!(at_end, later);
    assert!(at_end[2] != Pose::identity());
    tracks(&mut plan).start.joints.pop();
    assert!(ClusterPaths::of(&plan, 2.0).is_none());
}
