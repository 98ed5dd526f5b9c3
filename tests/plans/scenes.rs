//! Plan files of scenes: where its robots begin, what stands around them, and in which world.

use crate::desk::cli::Sandbox;
use serde_json::{Value, json};

const PROGRAM: &str = r#"
connector Face { mates Face, turns 4 }
module Block {
  mass 1kg
  link body = box(100mm, 100mm, 100mm)
  link lid = box(80mm, 80mm, 10mm) at [0mm, 0mm, 60mm]
  joint turn: body -> lid = revolute(axis: Z, range: -90deg..90deg, max_speed: 1rad/s, max_accel: 10rad/s^2)
  port a: Face on body at [50mm, 0mm, 0mm] facing +X up +Z
  port b: Face on body at [-50mm, 0mm, 0mm] facing -X up +Z
}
config Pair { part x: Block  part y: Block
  connect x.a -- y.b
  base y
  behavior nod = move(y.turn, to: 30deg, in: 2s)
}
scene Yard {
  part lone: Block at [0m, 5m, 0m]
  part twin: Pair at [1m, 0m, 0m]
  part stack[i in 0..2]: Block at [3m, i * 1m, 2m]
  obstacle wall = union(box(20mm, 1m, 200mm), placed(sphere(50mm), [0m, 0m, 1m])) at [9m, 0m, 0m] turned(Z, 90deg)
  for i in 0..2 { obstacle post[i] = sphere(10mm) at [9m, 2m + i * 1m, 0m] }
  world(ground: off, gravity: off)
  BASE
}
let yard = Yard()
emit(yard.twin.nod(), "nod.plan.json")
"#;

/// The plan file of a scene, whose base a clause may name.
fn written(base: &str) -> Value {
    let program = PROGRAM.replace("BASE", base);
    let sandbox = Sandbox::new(&[("main.mod", program.as_bytes())]);
    let ran = sandbox.run(&["run", "main.mod"]);
    assert_eq!(ran.code, 0, "{} {}", ran.out, ran.err);
    let text = std::fs::read_to_string(sandbox.path("out/nod.plan.json")).expect("the plan was written");
    serde_json::from_str(&text).expect("plans are JSON")
}

/// The value of a key, at any depth.
fn found<'v>(value: &'v Value, key: &str) -> Option<&'v Value> {
    match value {
        Value::Object(map) => map.get(key).or_else(|| map.values().find_map(|inner| found(inner, key))),
        Value::Array(items) => items.iter().find_map(|inner| found(inner, key)),
        _ => None,
    }
}

#[test]
fn robots_begin_where_they_are_placed() {
    let plan = written("");
    let start = found(&plan, "start").expect("a plan has a start");
    // The base is that of the first part; modules are counted in the order of the parts: lone 0, twin 1 and 2, stack 3, 4.
    assert_eq!(start["base"]["p"], json!([0.0, 5.0, 0.0]));
    let at: Vec<(u64, &Value)> = start["clusters"]
        .as_array()
        .expect("there are several clusters")
        .iter()
        .map(|cluster| (cluster["reference"].as_u64().expect("an index"), &cluster["pose"]["p"]))
        .collect();
    let expected = [(2, json!([1.0, 0.0, 0.0])), (3, json!([3.0, 0.0, 2.0])), (4, json!([3.0, 1.0, 2.0]))];
    assert_eq!(at, expected.iter().map(|(reference, p)| (*reference, p)).collect::<Vec<_>>());
}

#[test]
fn the_base_that_is_named_is_that_of_the_plan() {
    let plan = written("base twin.x");
    let start = found(&plan, "start").expect("a plan has a start");
    // The second block of the pair stands at the place, and the first 100 mm before it.
    let base: Vec<f64> = serde_json::from_value(start["base"]["p"].clone()).expect("a position");
    assert!((base[0] - 0.9).abs() < 1e-12 && base[1].abs() < 1e-12 && base[2].abs() < 1e-12, "{base:?}");
    let references: Vec<&Value> =
        start["clusters"].as_array().expect("clusters").iter().map(|cluster| &cluster["reference"]).collect();
    assert_eq!(references, [&json!(0), &json!(3), &json!(4)]);
}

#[test]
fn obstacles_and_the_world_are_those_of_the_scene() {
    let plan = written("");
    let obstacles = found(&plan, "obstacles").and_then(Value::as_array).expect("there are obstacles");
    let names: Vec<&Value> = obstacles.iter().map(|obstacle| &obstacle["name"]).collect();
    assert_eq!(names, ["wall", "post[0]", "post[1]"].map(|name| json!(name)).iter().collect::<Vec<_>>());
    let at = |obstacle: usize, shape: usize| obstacles[obstacle]["shapes"][shape]["pose"]["p"].clone();
    assert_eq!(at(0, 0), json!([9.0, 0.0, 0.0]));
    assert_eq!(at(0, 1), json!([9.0, 0.0, 1.0]));
    assert_eq!(at(2, 0), json!([9.0, 3.0, 0.0]));
    let world = found(&plan, "worlds").expect("a plan states its world");
    assert_eq!(world[0]["world"]["ground"], json!("off"));
    assert_eq!(world[0]["world"]["gravity"], json!(0.0));
}

#[test]
fn a_file_of_a_scene_is_read_and_judged_again() {
    let program = PROGRAM.replace("BASE", "");
    let sandbox = Sandbox::new(&[("main.mod", program.as_bytes())]);
    assert_eq!(sandbox.run(&["run", "main.mod"]).code, 0);
    let ran = sandbox.run(&["verify", "out/nod.plan.json"]);
    assert_eq!(ran.code, 0, "{} {}", ran.out, ran.err);
    let mut longer = program.clone();
    longer.push_str("print((load_plan(\"out/nod.plan.json\", yard) ++ yard.twin.nod()).duration)\n");
    let sandbox = Sandbox::new(&[
        ("main.mod", longer.as_bytes()),
        (
            "out/nod.plan.json",
            &std::fs::read(sandbox.path("out/nod.plan.json")).expect("the plan was written"),
        ),
    ]);
    let ran = sandbox.run(&["run", "main.mod"]);
    assert_eq!(ran.code, 0, "{} {}", ran.out, ran.err);
    assert!(ran.out.contains("4s"), "{}", ran.out);
}
