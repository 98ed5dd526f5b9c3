//! Connectors that snap: of two robots that dock the smaller moves by the error, and its way is judged.

use crate::support::desk::{run, run_clean};
use crate::support::suite::MapFiles;
use modl::geometry::{Placed, Pose, Shape, Vec3, pose::turned};
use modl::interpret::Mode;
use modl::plan::verify::articulated::ClusterPaths;
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Obstacle, Plan};
use modl::robot::Kinematics;
use std::f64::consts::PI;

/// A pusher of 100 mm whose slide reaches out by up to 150 mm, and blocks of 100 x 60 x 60 mm with faces at both ends, in a
/// scene in which a block or a row of two stands in front of the slide, with an error that the connector captures.
fn scene(capture: &str, first: &str, second: &str, error: &str, world: &str) -> String {
    format!(
        "connector Face {{ mates Face, turns 1, {capture} }}
module Pusher {{
  link body = box(100mm, 100mm, 100mm, mass: 5kg)
  link slide = box(20mm, 40mm, 40mm, mass: 500g) at [70mm, 0mm, 0mm]
  joint out : body -> slide = prismatic(axis: X, range: 0mm..150mm, max_force: 50N) at [70mm, 0mm, 0mm]
  port tip: Face on slide at [10mm, 0mm, 0mm] facing +X up +Z
}}
module Block {{
  link body = box(100mm, 60mm, 60mm, mass: 1kg)
  port face: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
  port rear: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
}}
config One {{ part m: Block }}
config Two {{ part m: Block  part n: Block  connect m.rear -- n.face  base m }}
config Alone {{ part p: Pusher }}
scene S {{
  part a: {first}
  part b: {second} at [180mm, 0mm, {error}
  world({world})
  behavior fetch = Sc(
    move(a.p.out, to: 50mm, in: 2s), wait(1s), dock(a.p.tip, b.m.face), wait(1s), move(a.p.out, to: 0mm, in: 2s),
  )
}}
emit(S().fetch(), \"p.json\")
"
    )
}

const AFLOAT: &str = "gravity: 0m/s^2, ground: off, dynamics: statics";

/// Returns the plan of such a scene.
fn plan(capture: &str, second: &str, error: &str) -> Plan {
    let program = scene(capture, "Alone", second, error, AFLOAT);
    run_clean(&program).plan("p.json")
}

/// Returns the world pose of a module's body at a time, s.
fn body(plan: &Plan, module: &str, time: f64) -> Pose {
    let tracks = plan.body.tracks().expect("modules");
    let numbers = Kinematics::new(&tracks.robot, &tracks.start.bonds, 0);
    let mut poses = vec![Pose::identity(); numbers.link_count()];
    ClusterPaths::of(plan, f64::INFINITY).expect("two robots").place(time, &mut poses);
    let index = tracks.robot.modules.iter().position(|m| m.name == module).expect("a module of that name");
    numbers.module_pose(index, &poses)
}

fn apart(a: &Pose, b: &Pose) -> (f64, f64) {
    ((a.translation.vector - b.translation.vector).norm(), a.rotation.angle_to(&b.rotation))
}

#[test]
fn the_second_of_two_equal_robots_moves_by_the_error() {
    // The block stands too high by 3 mm and turned by 4 degrees; a perfect mate has it at 180 mm, level.
    let error = "3mm] turned(X, 4deg)";
    let snapping = plan("capture 4mm 5deg, snap", "One", error);
    let keeping = plan("capture 4mm 5deg", "One", error);
    let perfect = Pose::translation(0.180, 0.0, 0.0);
    let placed = Pose::translation(0.180, 0.0, 0.003) * turned(Vec3::x(), 4f64.to_radians());
    for (plan, after) in [(&snapping, perfect), (&keeping, placed)] {
        assert!(apart(&body(plan, "b.m", 2.9), &placed) < (1e-12, 1e-12));
        let (distance, angle) = apart(&body(plan, "b.m", 3.1), &after);
        assert!(distance < 1e-9 && angle < 1e-9, "{distance} m, {angle} rad");
        // And the slide draws it back by its 50 mm.
        let (distance, angle) =
            apart(&body(plan, "b.m", 6.0), &(Pose::translation(-0.050, 0.0, 0.0) * after));
        assert!(distance < 1e-9 && angle < 1e-9, "{distance} m, {angle} rad");
        assert!(apart(&body(plan, "a.p", 6.0), &Pose::identity()).0 < 1e-12);
    }
    let notes = verify(&snapping).notes;
    assert!(notes.iter().any(|note| note.contains("snaps") && note.contains("3mm and 4deg")), "{notes:?}");
    assert!(verify(&keeping).notes.iter().all(|note| !note.contains("snaps")));
}

#[test]
fn the_smaller_of_two_robots_moves() {
    // A row of two blocks stands where it is, and the pusher, one module, comes to it.
    let plan = plan("capture 4mm 5deg, snap", "Two", "3mm]");
    let (distance, _) = apart(&body(&plan, "a.p", 3.1), &Pose::translation(0.0, 0.0, 0.003));
    assert!(distance < 1e-9, "{distance} m");
    assert!(apart(&body(&plan, "b.n", 3.1), &body(&plan, "b.n", 2.9)).0 < 1e-12);
}

#[test]
fn a_robot_that_is_held_does_not_snap() {
    let program = scene("capture 4mm 5deg, snap", "Alone", "One", "3mm]", "ground: held");
    let (observed, _, _) = run(&MapFiles::of(&program), Mode::Run);
    let said: Vec<String> =
        observed.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect();
    assert!(said.iter().any(|d| d.contains("E0606") && d.contains("free to move")), "{said:?}");
    // Without an error there is nothing to move, and without `snap` nothing has to.
    for (capture, error) in [("capture 4mm 5deg, snap", "0mm]"), ("capture 4mm 5deg", "3mm]")] {
        run_clean(&scene(capture, "Alone", "One", error, "ground: held"));
    }
}

#[test]
fn a_robot_is_hit_by_what_snaps_to_it() {
    // Only the two robots are there: a board of the pusher's own hangs over the block, which turns by 80 degrees.
    for (gap, hits) in [(43.0, false), (41.0, true)] {
        let board = format!(
            "port tip: Face on slide at [10mm, 0mm, 0mm] facing +X up +Z
  link board = box(100mm, 100mm, 10mm, mass: 100g) at [180mm, 0mm, {}mm]
  joint held : body -> board = fixed() at [180mm, 0mm, 0mm]",
            gap + 5.0
        );
        let program = scene("capture 4mm 85deg, snap", "Alone", "One", "0mm] turned(X, 80deg)", AFLOAT)
            .replace("port tip: Face on slide at [10mm, 0mm, 0mm] facing +X up +Z", &board)
            // The block turns under the board before the slide draws it back under it.
            .replace("wait(1s), move(a.p.out, to: 0mm, in: 2s)", "wait(1s)");
        let (observed, desk, _) = run(&MapFiles::of(&program), Mode::Run);
        let said: Vec<String> =
            observed.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect();
        assert_eq!(desk.written.is_empty(), hits, "{gap} mm: {said:?}");
        let collides =
            |words: &String| words.contains("E0601") && words.contains("a.p") && words.contains("b.m");
        assert_eq!(said.iter().any(collides), hits, "{gap} mm: {said:?}");
    }
}

#[test]
fn what_is_in_the_way_of_a_snap_is_hit() {
    // Turned by 80 degrees about its long axis the block reaches 34.8 mm above its middle, level 30 mm; half-way 42.3 mm.
    let mut turning = plan("capture 4mm 85deg, snap", "One", "0mm] turned(X, 80deg)");
    let half = 0.030;
    let reach = |angle: f64| half * (libm::cos(angle) + libm::sin(angle));
    assert!(verify(&turning).ok(), "{:#?}", verify(&turning).failures);
    for (gap, hits) in [(reach(PI / 4.0) + 3e-4, false), (reach(PI / 4.0) - 1.5e-3, true)] {
        assert!(gap > reach(80f64.to_radians()) + 1e-3);
        let board = Shape::Box { size: Vec3::new(0.1, 0.4, 0.010) };
        let shapes = vec![Placed { shape: board, pose: Pose::translation(0.200, 0.0, gap + 0.005) }];
        let Body::Tracks(tracks) = &mut turning.body else { unreachable!("a plan of modules") };
        tracks.obstacles = vec![Obstacle { name: "board".into(), shapes }].into();
        let verdict = verify(&turning);
        assert_eq!(!verdict.ok(), hits, "{gap}: {:#?}", verdict.failures);
        if let Some(failure) = verdict.failures.first() {
            assert_eq!((failure.kind, failure.time), (CheckKind::Collision, 3.0));
            assert_eq!(failure.blame, [turning.body.tracks().expect("modules").events[0].cause]);
        }
    }
}
