//! Links that are in each other's walls, links that press on each other as servos yield, links that slip, and modules that hang
//! on nothing.

use crate::support::arms::robot_of;
use crate::support::desk::{messages, run_clean};
use crate::support::hollow_meshes::hollow_cube;
use crate::support::motions::{Motion, STATICS};
use crate::support::robots::{self, boxed, joint, link};
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3};
use modl::plan::verify::articulated::collision_point;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, DynamicsModel, Obstacle, World};
use modl::robot::{Assembly, JointKind, Limits};

/// The places of a ball of 2 mm along x that are in the wall of a hollow cube of 60 and 30 mm, in its hollow, and outside.
const PLACES: [(f64, bool); 6] =
    [(0.0, false), (0.02, false), (0.036, true), (0.045, true), (0.055, true), (0.07, false)];

fn small() -> Vec<Placed> {
    vec![Placed { pose: Pose::identity(), shape: Shape::Sphere { radius: 0.002 } }]
}

#[test]
fn what_is_in_the_wall_of_an_obstacle_touches_nothing_and_meets_it() {
    for (x, inside) in PLACES {
        let ball = link("ball", small(), 1.0, Vec3::zeros(), 0.5);
        let mut motion = Motion::new(robot_of(vec![ball], vec![]));
        motion.tracks.start.base = shifted(Vec3::x() * x);
        motion.tracks.obstacles =
            vec![Obstacle { name: "case".into(), shapes: vec![hollow_cube(0.06, 0.03)] }].into();
        let verdict = verify(&motion.plan(World::FREE));
        let failed: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
        assert_eq!(failed, if inside { vec![CheckKind::Collision] } else { vec![] }, "{x}");
    }
}

#[test]
fn what_is_in_the_wall_of_its_own_module_meets_it() {
    for (x, inside) in PLACES {
        let mut ball = link("ball", small(), 1.0, Vec3::zeros(), 0.5);
        ball.pose = shifted(Vec3::x() * x);
        let links = vec![
            link("case", vec![hollow_cube(0.06, 0.03)], 1.0, Vec3::zeros(), 0.5),
            robots::link(
                "hub",
                vec![boxed(Vec3::repeat(0.2), Vec3::repeat(0.21))],
                1.0,
                Vec3::repeat(0.205),
                0.5,
            ),
            ball,
        ];
        let range = Limits { range: Some((-1.0, 1.0)), ..Limits::default() };
        let slide = |name: &str, between| {
            joint(name, between, JointKind::Prismatic, Pose::identity(), Vec3::z(), range)
        };
        let plan = Motion::new(robot_of(links, vec![slide("a", (0, 1)), slide("b", (1, 2))]))
            .segment(0, 0.0, 1.0, vec![0.0, 1e-3, 0.0])
            .plan(World::FREE);
        let verdict = verify(&plan);
        let failed: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
        assert_eq!(failed, if inside { vec![CheckKind::Collision] } else { vec![] }, "{x}");
        let point = collision_point(&plan, (0, 0), 0.0);
        assert_eq!(point.is_some(), inside, "{x}: {point:?}");
        if let Some(point) = point {
            // The robot alone is drawn on the ground, by half of the case.
            let off = point - Vec3::new(x, 0.0, 0.06);
            assert!(off.amax() <= 2.1e-3, "{point:?}");
        }
    }
}

/// A light block and a heavy one on a slide.
fn two_blocks() -> Assembly {
    let block = |x: f64| vec![boxed(Vec3::new(x - 0.05, -0.05, 0.0), Vec3::new(x + 0.05, 0.05, 0.05))];
    let (heavy, light) = (Vec3::new(0.0, 0.0, 0.025), Vec3::new(0.2, 0.0, 0.025));
    let links = vec![link("heavy", block(0.0), 3.0, heavy, 0.5), link("light", block(0.2), 1.0, light, 0.5)];
    let range = Limits { range: Some((-1.0, 1.0)), ..Limits::default() };
    let slide = joint("slide", (0, 1), JointKind::Prismatic, Pose::identity(), Vec3::x(), range);
    robot_of(links, vec![slide])
}

/// The light one slips, all the way, where the slide draws them apart.
#[test]
fn slip_beyond_what_is_stated_fails_when_it_comes_to_be_more() {
    let plan = Motion::new(two_blocks()).segment(0, 0.0, 1.0, vec![0.0, 0.1]).plan(STATICS);
    for (most, fails) in
        [(None, false), (Some(0.11), false), (Some(0.101), false), (Some(0.09), true), (Some(0.03), true)]
    {
        let mut plan = plan.clone();
        plan.settings.slip_max = most;
        let verdict = verify(&plan);
        let slip = verdict.slip.clone().expect("it slips");
        assert!((slip.value - 0.1).abs() < 1e-5 && slip.at == ["r.light"], "{slip:?}");
        let found: Vec<_> = verdict.failures.iter().filter(|f| f.kind == CheckKind::Slip).collect();
        assert_eq!(
            (found.len(), verdict.failures.len()),
            (usize::from(fails), usize::from(fails)),
            "{most:?}"
        );
        if let ([failure], Some(most)) = (found.as_slice(), most) {
            assert!(failure.value == slip.value && failure.limit == most && failure.at == ["r.light"]);
            assert!((failure.time - most / 0.1).abs() <= 0.011, "{failure:?}");
        }
    }
}

/// Full dynamics let the heavy one creep, as friction is viscous below 1 mm/s: where it bears a third of what it can, by
/// 0.35 mm a second.
#[test]
fn of_a_light_block_and_a_heavy_one_the_light_one_slips_under_full_dynamics() {
    let world = World { dynamics: DynamicsModel::Full, ..STATICS };
    let apart = vec![0.0, 0.0, 0.0, 0.1, 0.1, 0.1];
    let verdict = verify(&Motion::new(two_blocks()).segment(0, 0.0, 1.0, apart).plan(world));
    let slip = verdict.slip.expect("it slips");
    assert!((slip.value - 0.1).abs() < 1e-3 && slip.at == ["r.light"], "{slip:?}");
}

/// Two cubes that dock face to face, and turn about the middle of the faces by another way: as their connectors capture at any
/// angle the loop holds, but the edge of one goes into the other by half a side times the sine of the angle.
#[test]
fn ports_that_capture_at_any_angle_excuse_no_edges() {
    let found = messages(
        "connector Face { mates Face, turns 4, capture 2mm }
         module Left {
           link body = box(100mm, 100mm, 100mm, mass: 1kg)
           link arm = sphere(radius: 5mm, mass: 100g) at [50mm, 0mm, 200mm]
           joint bend : body -> arm = revolute(axis: Y, range: -90deg..90deg) at [50mm, 0mm, 0mm]
           port face: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
           port end: Face on arm at [0mm, 0mm, 5mm] facing +Z up +X
         }
         module Right {
           link body = box(100mm, 100mm, 100mm, mass: 1kg)
           port face: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
           port hung: Face on body at [-50mm, 0mm, 205mm] facing -Z up +X
         }
         config Both closed { part l: Left  part r: Right  connect l.end -- r.hung  connect l.face -- r.face  base l }
         let b = Both()
         emit(plan(move(b.l.bend, to: 10deg, in: 2s), world: world(gravity: off, ground: off)), \"p.json\")
",
    );
    let depth = 50.0 * libm::sin(10_f64.to_radians());
    let wanted = format!("l and r meet, up to {depth:.5}mm deep (body and body)");
    assert!(found.len() == 1 && found[0].contains(&wanted), "{found:?}, not {wanted}");
}

#[test]
fn modules_that_hang_on_nothing_are_counted() {
    let mut motion = Motion::new(robots::chain(3));
    motion.tracks.start.bonds = vec![true, false];
    let verdict = verify(&motion.plan(World::FREE));
    let found = verdict.failures.iter().find(|failure| failure.kind == CheckKind::Connectedness);
    let found = found.expect("one of three is loose");
    assert_eq!(
        (found.time, found.value, found.limit, found.at.as_slice()),
        (0.0, 1.0, 0.0, &["m2".to_owned()][..])
    );
}

/// An arm with a soft servo whose tip is over a pad.
const SOFT: &str = "
connector Face { mates Face, turns 4, capture 4mm 5deg }
module Frame {
  link body = box(1100mm, 40mm, 40mm, mass: 5kg) at [0mm, 0mm, -200mm]
  port left: Face on body at [-500mm, 0mm, 200mm] facing +X up +Z
  port pad: Face on body at [-40mm, 0mm, 20mm] facing +Z up +X
}
module Arm {
  link root = box(20mm, 20mm, 20mm, mass: 100g)
  link bar = box(440mm, 20mm, 20mm, mass: 1kg) at [250mm, 0mm, 0mm]
  joint lift : root -> bar =
    revolute(axis: Y, range: -90deg..90deg, max_torque: 5N*m, stiffness: 100N*m/rad) at [15mm, 0mm, 0mm]
  port back: Face on root at [-10mm, 0mm, 0mm] facing -X up +Z
  port tip: Face on bar at [200mm, 0mm, -10mm] facing -Z up +X
}
module Pad(high: Length) {
  link body = box(40mm, 40mm, high, mass: 100g)
  port foot: Face on body at [0mm, 0mm, -high / 2] facing -Z up +X
  port top: Face on body at [0mm, 0mm, high / 2] facing +Z up +X
}
config Soft(gap: Length) closed {
  part frame: Frame
  part arm: Arm
  part pad: Pad(170mm - gap)
  connect frame.left -- arm.back
  connect frame.pad -- pad.foot
  base frame
}
let held = world(ground: held)
for gap in [3.5mm, 40mm] {
  let s = Soft(gap)
  print(verify(move(s.arm.lift, to: 0deg, in: 500ms), world: held).failures)
}
let near = Soft(3.5mm)
print(verify(Sc(move(near.arm.lift, to: 0deg, in: 500ms), dock(near.arm.tip, near.pad.top), wait(100ms)), world: held).failures)
";

/// The arm sags by its torque over 0.4 of the stiffness, at the end of the bar, 455 mm from its joint.
#[test]
fn ports_about_to_dock_may_press_on_each_other_as_servos_yield() {
    let printed = run_clean(SOFT).printed;
    let [pressed, free, docking] = printed.as_slice() else { panic!("{printed:#?}") };
    assert!(pressed.contains("arm and pad meet") && pressed.contains("yield"), "{pressed}");
    let depth = pressed.split("up to ").nth(1).and_then(|rest| rest.split("mm deep").next());
    let depth: f64 = depth.and_then(|depth| depth.parse().ok()).expect("a depth in mm");
    let sagged = 455.0 * (9.80665 * 0.235 / (0.4 * 100.0)) - 3.5;
    assert!((depth / sagged - 1.0).abs() < 0.02, "{depth} of {sagged}");
    assert_eq!([free.as_str(), docking.as_str()], ["[]", "[]"]);
}
