//! The library of a plan file is held to the rules of programs: each of these was "verified" once.

use crate::support::desk::run_clean;
use modl::plan::{self, Plan, verify::verify};
use serde_json::{Value, json};
use std::time::Instant;

/// A module of two links that is drawn as it is judged, in a plan that is right.
const ARM: &str = r#"
connector Face { mates Face, turns 4, holds 100N, capture 2mm 5deg }
module Arm {
  mass 500g
  link body = box(40mm, 40mm, 40mm)
  link hand = box(38mm, 30mm, 30mm) at [40mm, 0mm, 0mm]
  joint bend: body -> hand = revolute(axis: Y, range: -45deg..45deg, max_speed: 2rad/s, max_torque: 3N*m)
  touching body hand
  port back: Face on body at [-20mm, 0mm, 0mm] facing -X up +Z
  port front: Face on hand at [19mm, 0mm, 0mm] facing +X up +Z
}
config Two {
  part m[2]: Arm
  connect m[0].front -- m[1].back
  behavior bow = move(m[0].bend, to: 20deg)
}
emit(plan(Two().bow(), world: world(ground: off, gravity: off)), "arm.plan.json")
"#;

const TRUSS: &str = r#"
use std.truss.PneumaticReel
truss Tetrahedron of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [500mm, 866mm, 0m]
  node d = [500mm, 289mm, 816mm]
  strut a -- b  strut a -- c  strut b -- c  strut a -- d  strut b -- d  strut c -- d
}
emit(morph(Tetrahedron, cloud([[0m, 0m, 0m], [1.2m, 0m, 0m], [600mm, 1.04m, 0m], [600mm, 350mm, 1m]]), tolerance: 900mm), "truss.plan.json")
"#;

const LATTICE: &str = r#"
use std.crystal.ExpandingCube
lattice Row of ExpandingCube = cells("""
  ####
""")
lattice Square of ExpandingCube = cells("""
  ##
  ##
""")
emit(squeeze(Row, Square), "lattice.plan.json")
"#;

fn emitted(program: &str, name: &str) -> Value {
    serde_json::from_str(run_clean(program).text(name)).expect("plans are JSON")
}

/// The reason why an altered file is not verified.
fn refusal(mut file: Value, place: &str, value: &Value) -> String {
    let (parent, key) = place.rsplit_once('/').expect("a pointer");
    let object = file.pointer_mut(parent).unwrap_or_else(|| panic!("{parent} is there"));
    match object {
        Value::Object(map) => drop(map.insert(key.to_owned(), value.clone())),
        list => list[key.parse::<usize>().expect("an index")] = value.clone(),
    }
    let begun = Instant::now();
    let said = match plan::file::read(&file.to_string()) {
        Ok(plan) => first_failure(&plan),
        Err(error) => error.message,
    };
    assert!(begun.elapsed().as_secs_f64() < 30.0, "{place} = {value} takes {:?}", begun.elapsed());
    said
}

fn first_failure(plan: &Plan) -> String {
    verify(plan).failures.first().map_or_else(String::new, |failure| failure.message.clone())
}

#[track_caller]
fn refused(file: &Value, place: &str, value: Value, says: &str) {
    let said = refusal(file.clone(), place, &value);
    assert!(said.contains(says), "{place} = {value}: `{said}` should say `{says}`");
}

#[test]
fn a_module_of_a_file_is_as_sound_as_one_of_a_program() {
    let file = emitted(ARM, "arm.plan.json");
    let plan = plan::file::read(&file.to_string()).expect("it was written to be read");
    assert_eq!(first_failure(&plan), "");
    let body = "/library/modules/0/links/0";
    for touch in [1.0, 1e308, -1.0] {
        refused(&file, "/library/modules/0/touch", json!(touch), "`touch`");
    }
    refused(&file, "/library/modules/0/contact", json!(1.0), "`contact`");
    let tiny = json!([{ "pose": { "p": [0.0, 0.0, 0.0], "q": [1.0, 0.0, 0.0, 0.0] },
        "shape": { "box": { "size": [1e-6, 1e-6, 1e-6] } } }]);
    refused(&file, &format!("{body}/collides"), tiny, "sticks at least 0.03464");
    refused(&file, &format!("{body}/left_out"), json!(-1.0), "leaves out");
    let sound = file.pointer(&format!("{body}/inertia")).cloned().expect("it has inertia");
    let with = |at: usize, value: f64| {
        let mut inertia = sound.clone();
        inertia[at] = json!(value);
        inertia
    };
    refused(&file, &format!("{body}/inertia"), with(0, -1.0), "not positive");
    refused(&file, &format!("{body}/inertia"), with(4, 1e308), "its inertia");
    refused(&file, &format!("{body}/inertia"), with(3, 1e-2), "not positive");
    // Within the triangle inequality, and a hundred times what its mass within the module can have.
    refused(&file, &format!("{body}/inertia"), json!([0.1, 0.1, 0.1, 0.0, 0.0, 0.0]), "no body of its mass");
    refused(&file, &format!("{body}/inertia"), json!([4e-5, 4e-5, 9e-5, 0.0, 0.0, 0.0]), "together");
    refused(&file, &format!("{body}/com"), json!([0.0, 0.0, 0.3]), "outside of the module");
    refused(&file, &format!("{body}/friction"), json!(-0.1), "friction");
    let limits = "/library/modules/0/joints/0/limits";
    for (field, value) in [("speed", -2.0), ("effort", 0.0), ("acceleration", 1e300)] {
        refused(&file, &format!("{limits}/{field}"), json!(value), "its greatest");
    }
    refused(&file, &format!("{limits}/range"), json!([0.5, -0.5]), "before it begins");
    refused(&file, &format!("{limits}/range"), json!([-1e308, 1e308]), "its range");
    refused(&file, "/library/connectors/0/holds_force", json!(-1.0), "holds");
    refused(&file, "/library/connectors/0/capture", json!({ "distance": 1e4, "angle": 0.1 }), "capture");
}

#[test]
fn cells_and_struts_of_a_file_are_sound() {
    let truss = emitted(TRUSS, "truss.plan.json");
    for (field, value) in [("mass", -1.0), ("force", -200.0), ("speed", 0.0), ("clearance", -0.1)] {
        refused(&truss, &format!("/library/struts/0/{field}"), json!(value), "in strut `PneumaticReel`");
    }
    refused(&truss, "/library/struts/0/length", json!([0.3, 1e308]), "length");
    let lattice = emitted(LATTICE, "lattice.plan.json");
    for (field, value) in [("mass", 0.0), ("force", -1.0), ("shrinks_to", 0.2), ("size", 1e6)] {
        refused(&lattice, &format!("/library/cells/0/{field}"), json!(value), "in cell `ExpandingCube`");
    }
}

#[test]
fn joints_of_a_file_do_not_follow_each_other_in_a_circle() {
    let program = ARM.replace(
        "  touching body hand\n",
        "  link thumb = box(10mm, 10mm, 10mm) at [0mm, 0mm, 30mm]\n  \
           joint turn: body -> thumb = revolute(axis: Z)\n  joint turn = 2 * bend\n  touching body hand\n",
    );
    let file = emitted(&program, "arm.plan.json");
    let joint = "/library/modules/0/joints";
    refused(&file, &format!("{joint}/1/mimic"), json!([[1, 1.0]]), "follows itself");
    refused(&file, &format!("{joint}/0/mimic"), json!([[1, -1.0]]), "follows itself");
    refused(&file, &format!("{joint}/1/mimic"), json!([[7, 1.0]]), "no joint 7");
}

/// The judge of a link at 1e20 m once broke down, and of one at 1 km did not end.
#[test]
fn nothing_is_farther_away_than_the_limit_of_extents() {
    let file = emitted(ARM, "arm.plan.json");
    let link = "/library/modules/0/links/1/pose/p";
    for far in [10.1, 30.0, 300.0, 999.0] {
        refused(&file, link, json!([far, 0.0, 0.0]), "the limit is 10");
        refused(&file, "/library/modules/0/ports/0/pose/p", json!([0.0, 0.0, far]), "the limit is 10");
    }
    for far in [1e20, 1e12, 1e6, 1.001e3, -1e20] {
        refused(&file, link, json!([far, 0.0, 0.0]), "1 km");
        refused(&file, "/library/modules/0/links/0/collides/0/pose/p", json!([0.0, far, 0.0]), "1 km");
        refused(&file, "/library/modules/0/ports/0/pose/p", json!([0.0, 0.0, far]), "1 km");
        refused(&file, "/body/tracks/start/base/p", json!([far, 0.0, 0.0]), "the base");
    }
    // As far as allowed the judge comes to an end, whatever it says.
    for far in [999.0, 9.9] {
        refusal(file.clone(), link, &json!([far, 0.0, 0.0]));
        refusal(file.clone(), "/body/tracks/start/base/p", &json!([far, 0.0, 0.0]));
    }
    let settling = ARM.replace(", world: world(ground: off, gravity: off)", "").replace("20deg)", "-2deg)");
    let file = emitted(&settling, "arm.plan.json");
    for far in [1e20, 1e3, 999.0, 9.9] {
        refusal(file.clone(), link, &json!([far, 0.0, 0.0]));
        refusal(file.clone(), link, &json!([0.0, 0.0, -far]));
    }
    let truss = emitted(TRUSS, "truss.plan.json");
    for far in [1e308, -1e20, 1.1e3] {
        refused(&truss, "/body/node_paths/keyframes/0/nodes/0/0", json!(far), "the coordinate of a node");
        refused(&truss, "/body/node_paths/keyframes/0/nodes/2/2", json!(far), "the coordinate of a node");
    }
}
