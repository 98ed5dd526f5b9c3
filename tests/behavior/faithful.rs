//! A plan file's program must make the file's motion: a robot executes the one, the judge sees the
//! other.

use crate::desk::cli::Sandbox;
use serde_json::{Value, json};

const PROGRAM: &[u8] = b"
use std.smores.Smores
config C {
  part m: Smores
  behavior nod = Sc(move(m.tilt, to: 20deg), Pc(move(m.left, to: 10deg), move(m.tilt, to: 0deg)))
}
emit(C().nod(), \"nod.plan.json\")
";

/// A verified plan file, changed; what `modl verify` says of it.
fn verified(change: impl FnOnce(&mut Value)) -> (i32, String) {
    let sandbox = Sandbox::new(&[("main.mod", PROGRAM)]);
    assert_eq!(sandbox.run(&["run", "main.mod"]).code, 0);
    let path = sandbox.path("out/nod.plan.json");
    let text = std::fs::read_to_string(&path).expect("the plan was written");
    let mut plan: Value = serde_json::from_str(&text).expect("plans are JSON");
    change(&mut plan);
    std::fs::write(&path, plan.to_string()).expect("a file can be written");
    let ran = sandbox.run(&["verify", "out/nod.plan.json"]);
    (ran.code, ran.out)
}

/// The first object that has this key with a number, with that number.
fn number<'v>(value: &'v mut Value, key: &str) -> Option<&'v mut Value> {
    match value {
        Value::Object(map) => {
            if map.get(key).is_some_and(Value::is_number) {
                return map.get_mut(key);
            }
            map.values_mut().find_map(|inner| number(inner, key))
        }
        Value::Array(items) => items.iter_mut().find_map(|inner| number(inner, key)),
        _ => None,
    }
}

#[test]
fn a_file_as_it_was_written_is_believed() {
    let (code, said) = verified(|_| {});
    assert_eq!(code, 0, "{said}");
    assert!(!said.contains("believed") && !said.contains("no program"), "{said}");
}

#[test]
fn a_program_with_another_target_is_refused() {
    let (code, said) = verified(|plan| {
        *number(&mut plan["program"], "to").expect("a move has a target") = json!(1.5);
    });
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("the program"), "{said}");
}

#[test]
fn motion_that_no_program_makes_is_refused() {
    let (code, said) = verified(|plan| plan["body"]["tracks"]["tracks"] = json!([]));
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("otherwise than the motion of the file"), "{said}");
}

#[test]
fn without_a_program_that_is_said() {
    let (code, said) = verified(|plan| plan["program"] = Value::Null);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("there is no program"), "{said}");
}

#[test]
fn a_verdict_that_is_not_ours_is_not_believed() {
    let (code, said) = verified(|plan| plan["verdict"]["clearance"]["value"] = json!(5.0));
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("was not believed"), "{said}");
}

#[test]
fn more_samples_than_are_allowed_are_refused_at_once() {
    let (code, said) = verified(|plan| plan["settings"]["sample"] = json!(1e-13));
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("are allowed"), "{said}");
}
