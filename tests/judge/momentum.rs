//! Robots that come apart in motion: each part keeps its momentum. Without weight by closed forms and by what is conserved;
//! on ice and on ground with little friction by closed forms.
#![allow(non_snake_case)]

use crate::support::desk::run_clean;
use crate::support::verdicts::status;
use modl::geometry::{Mat3, Pose, Vec3};
use modl::plan::verify::articulated::ClusterPaths;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Plan, Status};
use modl::robot::Kinematics;
use nalgebra::Vector6;

/// The connector of all these modules.
pub const FACE: &str = "connector Face { mates Face, turns 4 }\n";

/// A block that a `Pusher` pushes away, or draws to itself, and that lets go half-way as its slide moves; the pusher is for its
/// users to declare.
pub const PUSHING: &str = "
module Block {
  link body = box(100mm, 60mm, 100mm, mass: 1kg)
  port face: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config Pushed { part a: Pusher  part b: Block  connect a.tip -- b.face  base a
  behavior part_ways = Sc(Pc(move(a.out, to: 100mm, in: 2s), Sc(wait(1s), undock(a.tip))), wait(2s))
}
config Drawn { part a: Pusher  part b: Block  connect a.tip -- b.face  base a
  set a.out = 100mm
  behavior part_ways = Sc(Pc(move(a.out, to: 0mm, in: 2s), Sc(wait(1s), undock(a.tip))), wait(2s))
}
";

/// A body of 5 kg with a slide of 0.5 kg.
pub const PUSHER: &str = "
module Pusher {
  link body = box(100mm, 100mm, 100mm, mass: 5kg)
  link slide = box(20mm, 60mm, 60mm, mass: 500g) at [70mm, 0mm, 0mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..150mm) at [70mm, 0mm, 0mm]
  port tip: Face on slide at [10mm, 0mm, 0mm] facing +X up +Z
}
";

/// A disc that turns about its centre of mass, with another on it, and an arm with a block at its end. Each lets go half-way, as
/// the joint moves.
const PARTING: &str = "
module Turner {
  link body = box(200mm, 200mm, 50mm, mass: 4kg)
  link rotor = box(100mm, 100mm, 50mm, mass: 1kg) at [0mm, 0mm, 50mm]
  joint spin : body -> rotor = revolute(axis: Z, range: -180deg..180deg) at [0mm, 0mm, 50mm]
  port top: Face on rotor at [0mm, 0mm, 25mm] facing +Z up +X
}
module Disc {
  link body = box(100mm, 100mm, 50mm, mass: 2kg)
  port under: Face on body at [0mm, 0mm, -25mm] facing -Z up +X
}
module Arm {
  link body = box(100mm, 100mm, 100mm, mass: 3kg)
  link arm = box(300mm, 30mm, 30mm, mass: 600g) at [250mm, 0mm, 30mm]
  joint swing : body -> arm = revolute(axis: Z - 0.2 * Y, range: -180deg..180deg) at [100mm, 0mm, 30mm]
  port end: Face on arm at [150mm, 0mm, 0mm] facing +X up +Z
}
config Turned { part a: Turner  part b: Disc  connect a.top -- b.under  base a
  behavior part_ways = Sc(Pc(move(a.spin, to: 90deg, in: 2s), Sc(wait(1s), undock(a.top))), wait(1s))
}
config Swung { part a: Arm  part b: Block  connect a.end -- b.face  base a
  behavior part_ways = Sc(Pc(move(a.swing, to: 60deg, in: 2s), Sc(wait(1s), undock(a.end))), wait(1s))
}
";

fn plan(robot: &str, world: &str) -> Plan {
    let program = format!(
        "{FACE}{PUSHING}{PUSHER}{PARTING}\nemit(plan({robot}().part_ways(), world: world({world})), \"p.json\")\n"
    );
    run_clean(&program).plan("p.json")
}

const FREE: &str = "gravity: off, ground: off";

/// Returns the world poses of the bodies of both modules at a time (s), as seen from where they began.
pub fn bodies(plan: &Plan, paths: &ClusterPaths, time: f64) -> [Pose; 2] {
    let numbers = Kinematics::new(&plan.body.tracks().expect("modules").robot, &[true], 0);
    let at = |time: f64| {
        let mut poses = vec![Pose::identity(); numbers.link_count()];
        paths.place(time, &mut poses);
        [0, 1].map(|module| numbers.module_pose(module, &poses))
    };
    let (begun, now) = (at(0.0), at(time));
    [0, 1].map(|i| {
        let moved = now[i].translation.vector - begun[i].translation.vector;
        Pose::from_parts(moved.into(), now[i].rotation * begun[i].rotation.inverse())
    })
}

/// Returns the rate of the only joint at a time, rad/s or m/s.
fn rate(plan: &Plan, time: f64) -> f64 {
    plan.body.tracks().expect("modules").tracks[0].velocity(time)
}

#[test]
fn a_block_that_a_slide_pushes_off_flies_on_and_the_slide_recoils() {
    let plan = plan("Pushed", FREE);
    let verdict = verify(&plan);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    assert!(verdict.notes.iter().any(|note| note.contains("drifts on at the end")), "{:?}", verdict.notes);
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    let u = rate(&plan, 1.0);
    assert!(u > 0.09, "the slide moves as it lets go: {u}");
    // Before, of 6.5 kg 1.5 move out: the body goes back by 1.5 parts of 6.5, and the block forth by the other 5.
    let [a, b] = bodies(&plan, &paths, 1.0).map(|pose| pose.translation.vector);
    assert!((a - Vec3::new(-0.050 * 1.5 / 6.5, 0.0, 0.0)).norm() < 1e-9, "{a:?}");
    assert!((b - Vec3::new(0.050 * 5.0 / 6.5, 0.0, 0.0)).norm() < 1e-9, "{b:?}");
    // After, the block keeps its speed; so does the common centre of mass of the others, as the slide goes on to 100 mm.
    let [c, d] = bodies(&plan, &paths, 4.0).map(|pose| pose.translation.vector);
    let speed = u * 5.0 / 6.5;
    assert!((d - b - Vec3::new(3.0 * speed, 0.0, 0.0)).norm() < 1e-6, "{d:?}");
    let back = 3.0 * speed / 5.5 + 0.050 * 0.5 / 5.5;
    assert!((c - a + Vec3::new(back, 0.0, 0.0)).norm() < 1e-6, "{c:?} after {a:?}: {back}");
}

#[test]
fn a_disc_that_a_rotor_lets_go_turns_on_and_the_rotor_turns_against_it() {
    let plan = plan("Turned", FREE);
    let verdict = verify(&plan);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    // Moments of inertia of plates about their normal through the middle, m (a² + b²) / 12.
    let [body, rotor, disc] = [(4.0, 0.2), (1.0, 0.1), (2.0, 0.1)].map(|(m, a)| m * 2.0 * a * a / 12.0);
    let quarter = 0.25 * std::f64::consts::PI;
    let w = rate(&plan, 1.0);
    let yaw = |pose: &Pose| pose.rotation.euler_angles().2;
    let [a, b] = bodies(&plan, &paths, 1.0).map(|pose| yaw(&pose));
    let all = body + rotor + disc;
    assert!((a + quarter * (rotor + disc) / all).abs() < 1e-9, "{a}");
    assert!((b - quarter * body / all).abs() < 1e-9, "{b}");
    let [c, d] = bodies(&plan, &paths, 2.5).map(|pose| yaw(&pose));
    let spin = w * body / all;
    assert!((d - b - 1.5 * spin).abs() < 1e-6, "{d}");
    let back = (1.5 * spin * disc + quarter * rotor) / (body + rotor);
    assert!((c - a + back).abs() < 1e-6, "{c} after {a}: {back}");
}

/// Returns the momentum and the angular momentum about the origin of each module of a plan at a time (s), by differences of
/// the poses of its links over a short time.
fn momenta(plan: &Plan, paths: &ClusterPaths, time: f64) -> [Vector6<f64>; 2] {
    const STEP: f64 = 2e-3;
    let robot = &plan.body.tracks().expect("modules").robot;
    let numbers = Kinematics::new(robot, &[true], 0);
    let poses_at = |time: f64| {
        let mut poses = vec![Pose::identity(); numbers.link_count()];
        paths.place(time, &mut poses);
        poses
    };
    let (before, after) = (poses_at(time - STEP / 2.0), poses_at(time + STEP / 2.0));
    [0, 1].map(|module| {
        let links = numbers.links_of(module).zip(&robot.module_type(module).links);
        let of = |(number, link): (usize, &modl::robot::Link)| {
            let centre = |poses: &[Pose]| poses[number].transform_point(&link.com.into()).coords;
            let (from, to) = (centre(&before), centre(&after));
            let force = (to - from) / STEP * link.mass;
            let turn = after[number].rotation * before[number].rotation.inverse();
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            let R = *before[number].rotation.to_rotation_matrix().matrix();
            let inertia = R * Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * R.transpose();
            let spin = inertia * turn.scaled_axis() / STEP;
            let moment = ((from + to) / 2.0).cross(&force) + spin;
            Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
        };
        links.map(of).sum()
    })
}

/// An arm swings about a slanted axis and lets a block go. Nothing acts from outside: all momenta together stay zero, and
/// after the parting each part keeps its own, of which none is small.
#[test]
fn momentum_is_conserved_and_each_part_keeps_its_own() {
    let plan = plan("Swung", FREE);
    let verdict = verify(&plan);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    for step in 1..30 {
        let [a, b] = momenta(&plan, &paths, f64::from(step) * 0.1 + 0.005);
        assert!((a + b).norm() < 2e-5, "{step}: {:?}", a + b);
    }
    let [a, b] = momenta(&plan, &paths, 1.105);
    assert!(b.fixed_rows::<3>(0).norm() > 0.02 && b.fixed_rows::<3>(3).norm() > 0.005, "{b:?}");
    for step in 11..30 {
        let now = momenta(&plan, &paths, f64::from(step) * 0.1 + 0.005);
        let lost = [(now[0] - a).norm(), (now[1] - b).norm()];
        assert!(lost.iter().all(|lost| *lost < 2e-5), "{step}: {lost:?}");
    }
}

/// Under statics everything is at rest at every instant, and stays where it came off.
#[test]
fn under_statics_parts_stay_where_they_came_off() {
    let plan = plan("Drawn", "gravity: off, ground: off, dynamics: statics");
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    let [a, b] = bodies(&plan, &paths, 1.0);
    let [c, d] = bodies(&plan, &paths, 4.0);
    assert!(a.translation.vector.norm() < 1e-12 && c.translation.vector.norm() < 1e-12);
    assert!((d.inverse() * b).translation.vector.norm() < 1e-12);
}

/// A fixture holds the base, and so its part of the momentum; what comes off floats.
#[test]
fn what_comes_off_a_held_robot_without_weight_flies_on() {
    let plan = plan("Pushed", "gravity: off, ground: held");
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    let [a, b] = bodies(&plan, &paths, 4.0).map(|pose| pose.translation.vector);
    let flown = Vec3::new(0.050 + 3.0 * rate(&plan, 1.0), 0.0, 0.0);
    assert!(a.norm() < 1e-12 && (b - flown).norm() < 1e-6, "{a:?} {b:?} of {flown:?}");
}

/// Without friction the same closed form holds on the ground.
#[test]
fn on_ice_parts_keep_their_momentum_along_the_ground() {
    let plan = plan("Pushed", "friction: 0");
    let verdict = verify(&plan);
    assert!(verdict.ok(), "{:#?}", verdict.failures);
    assert!(matches!(status(&verdict, CheckKind::Traction), Status::Sampled(_)), "{:?}", verdict.checks);
    let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
    let u = rate(&plan, 1.0);
    let [a, b] = bodies(&plan, &paths, 1.0).map(|pose| pose.translation.vector);
    let [c, d] = bodies(&plan, &paths, 4.0).map(|pose| pose.translation.vector);
    let speed = u * 5.0 / 6.5;
    assert!(((d - b).x - 3.0 * speed).abs() < 2e-3 * 3.0 * speed, "{d:?} after {b:?}: {}", 3.0 * speed);
    let back = 3.0 * speed / 5.5 + 0.050 * 0.5 / 5.5;
    assert!(((c - a).x + back).abs() < 5e-3 * back, "{c:?} after {a:?}: {back}");
}

/// Velocities of joints are means over a window; the momentum with which a part comes off is that of the instant, also where the
/// slide is at its fastest for less than the window.
#[test]
fn what_comes_off_in_a_fast_motion_keeps_its_momentum() {
    let pushing = PUSHING.replace("in: 2s", "in: 160ms").replace("wait(1s)", "wait(80ms)");
    for (axis, [x, y]) in [("X", [1, 0]), ("Y", [0, 1])] {
        let program = format!(
            "{FACE}{pushing}
module Pusher {{
  link body = box(400mm, 400mm, 100mm, mass: 1kg)
  link slide = box(60mm, 60mm, 60mm, mass: 4kg)
  joint out : body -> slide = prismatic(axis: {axis}, range: 0mm..150mm)
  port tip: Face on slide at [{}mm, {}mm, 0mm] facing +{axis} up +Z
}}
emit(plan(Pushed().part_ways(), world: world(friction: 0)), \"p.json\")
",
            250 * x,
            250 * y
        );
        let plan = run_clean(&program).plan("p.json");
        let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
        let way = Vec3::new(f64::from(x), f64::from(y), 0.0);
        let along = |time: f64| bodies(&plan, &paths, time).map(|pose| pose.translation.vector.dot(&way));
        let ([a, b], [c, d]) = (along(0.08), along(1.16));
        // Of 6 kg, 5 move out before; after, the block keeps its speed, and the slide goes on by 50 mm in 5 kg.
        let speed = rate(&plan, 0.08) / 6.0;
        let back = 1.08 * speed / 5.0 + 0.050 * 4.0 / 5.0;
        // The body's own speed before, 5/6 of 1.17 m/s, is known from its last samples, within some 10 mm/s.
        assert!((d - b - 1.08 * speed).abs() < 0.012, "{axis}: {} of {}", d - b, 1.08 * speed);
        assert!((c - a + back).abs() < 0.012, "{axis}: {} of {back}", a - c);
    }
}

/// With some friction the body stands, and the block that it draws slides on by v² / 2 μ g.
#[test]
fn on_the_ground_friction_stops_what_comes_off_in_motion() {
    for friction in [0.05, 0.1] {
        let plan = plan("Drawn", &format!("friction: {friction}"));
        let verdict = verify(&plan);
        assert!(verdict.ok(), "{:#?}", verdict.failures);
        let tracks = plan.body.tracks().expect("modules");
        let mu = friction * tracks.robot.module_type(1).links[0].friction;
        let paths = ClusterPaths::of(&plan, f64::INFINITY).expect("two parts");
        let [_, b] = bodies(&plan, &paths, 1.0).map(|pose| pose.translation.vector);
        let [_, d] = bodies(&plan, &paths, 4.0).map(|pose| pose.translation.vector);
        let u = rate(&plan, 1.0).abs();
        let slid = u * u / (2.0 * mu * 9.80665);
        // The judge's instants are 10 ms apart, and friction is viscous at last.
        assert!(((b - d).x - slid).abs() < 0.008 * u, "{} of {slid} at {mu}", (b - d).x);
    }
}
