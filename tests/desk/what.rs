//! `modl what` and `:what`: what the library can do with a robot.

use super::cli::{Sandbox, json};

const ROBOTS: &str = "\
use std.smores.{Chain3, Smores, Walker14, Ring12}
use std.crystal.ExpandingCube
let walker = Walker14()
let bent = Walker14(bend: 5deg)
config Pair(turn: Angle = 0deg) {
  part m[2]: Smores
  connect m[0].top -- m[1].bottom turn turn
  behavior nod(a: Angle = 30deg) = move(m[1].tilt, to: a)
  behavior _rest = move(m[1].tilt, to: 0deg)
}
config Need(n: Int) { part m: Smores }
module Hinge {
  mass 1kg
  link body = box(10mm, 10mm, 10mm)
}
lattice Bar of ExpandingCube = row(3)
print(\"not run\")
";

fn sandbox() -> Sandbox {
    Sandbox::new(&[
        ("robots.mod", ROBOTS.as_bytes()),
        ("empty.mod", b"use std.smores.Walk4\n"),
        ("broken.mod", b"use std.smores.Smores\nconfig B { part m: Smores  connect m.top -- m.bottom }\n"),
    ])
}

/// Returns the configurations that the JSON object lists: (name, number of embeddings, behaviours).
fn listed(sandbox: &Sandbox, robot: &str) -> Vec<(String, u64, Vec<String>)> {
    let ran = sandbox.run(&["what", "robots.mod", robot, "--json"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{robot}: {}", ran.out);
    let answer = json(&ran);
    let configurations = answer["robot"]["configurations"].as_array().expect("a list").clone();
    let text = |value: &serde_json::Value| value.as_str().expect("a text").to_owned();
    let behaviors = |value: &serde_json::Value| -> Vec<String> {
        value.as_array().expect("a list").iter().map(text).collect()
    };
    let of = |c: &serde_json::Value| {
        (text(&c["name"]), c["embeddings"].as_u64().expect("a number"), behaviors(&c["behaviors"]))
    };
    configurations.iter().map(of).collect()
}

#[test]
fn a_walker_is_told_what_its_halves_and_legs_can_do() {
    let sandbox = sandbox();
    let found = listed(&sandbox, "walker");
    let of = |name: &str| {
        found.iter().find(|(own, ..)| own == name).map(|(_, count, does)| (*count, does.clone()))
    };
    assert_eq!(found[0].0, "std.smores.Walker14", "its own configuration comes first");
    assert_eq!(found.iter().filter(|(name, ..)| name.ends_with("Walker14")).count(), 1);
    let squeezes = ["neutral()", "squeeze()", "open()"].map(str::to_owned).to_vec();
    assert_eq!(of("std.smores.Grasper7"), Some((2, squeezes)));
    assert_eq!(of("std.smores.Leg3").map(|(count, _)| count), Some(4));
    assert_eq!(of("std.smores.Driver1").map(|(count, _)| count), Some(14));
    // A spine of three, a ring, and robots of other modules are not in it.
    for absent in ["Climber4", "Walk4", "Ring12"] {
        assert_eq!(of(&format!("std.smores.{absent}")), None);
    }
    assert!(found.iter().all(|(name, ..)| !name.starts_with("std.rofi") && !name.contains("._")));
    // The robot's own comes with its arguments, the others with their defaults.
    assert_eq!(listed(&sandbox, "bent")[0].0, "std.smores.Walker14(bend: 5deg)");
}

#[test]
fn the_text_names_configurations_with_their_behaviors() {
    let sandbox = sandbox();
    let ran = sandbox.run(&["what", "robots.mod", "Pair(turn: 90deg)"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let wanted = "\
Pair(turn: 90deg): 2 modules

Pair(turn: 90deg): 1 embedding
  nod(a: Angle = 30deg)

std.smores.Driver1: 2 embeddings
  drive(v: AngularSpeed = 2rad/s, t: Time = 5s)
  turn(a: Angle = 90deg)
";
    assert_eq!(ran.out, wanted);
    let ran = sandbox.run(&["what", "robots.mod", "Hinge"]);
    assert_eq!(
        (ran.code, ran.out.as_str()),
        (0, "Hinge: 1 module\nno configuration of the library embeds in it\n")
    );
    // A part is asked by itself, and the configurations of the library are known without an import.
    assert_eq!(listed(&sandbox, "walker.leg[0]"), listed(&sandbox, "walker.leg[3]"));
    assert_eq!(listed(&sandbox, "Tank7")[0].0, "std.smores.Tank7");
    // Every module of a ring is the first one of an embedding of the ring.
    assert_eq!(listed(&sandbox, "Ring12")[0].1, 12);
}

#[test]
fn what_is_no_robot_is_refused_where_it_stands() {
    let sandbox = sandbox();
    let refused = [
        ("3mm", "E0202", "a robot of modules is wanted"),
        ("Bar", "E0202", "a robot of modules is wanted"),
        ("let x = 3mm", "E0202", "is no expression that gives a robot"),
        ("", "E0202", "is no expression that gives a robot"),
        ("Nobody", "E0101", "`Nobody` is not known here"),
        ("Need", "E0205", "`Need` needs `n`"),
        ("walker.leg[9]", "E0501", "index 9"),
        ("Pair(", "E0004", "never closed"),
        ("walker walker", "E0001", ""),
    ];
    for (robot, code, words) in refused {
        let ran = sandbox.run(&["what", "robots.mod", robot]);
        assert_eq!((ran.code, ran.out.as_str()), (1, ""), "{robot}\n{}", ran.err);
        assert!(ran.err.contains(code) && ran.err.contains(words), "{robot}\n{}", ran.err);
        assert!(!ran.err.contains("_Of_"), "{robot}: only the expression is shown\n{}", ran.err);
        let answer = json(&sandbox.run(&["what", "robots.mod", robot, "--json"]));
        assert_eq!((&answer["ok"], &answer["robot"]), (&false.into(), &serde_json::Value::Null), "{robot}");
    }
    for (file, words) in
        [("empty.mod", "declares nothing"), ("nothing.mod", "nothing.mod"), ("broken.mod", "E0304")]
    {
        let ran = sandbox.run(&["what", file, "Walk4"]);
        assert!(ran.code > 0 && ran.err.contains(words), "{}", ran.err);
    }
    // Comparing modules counts as evaluation.
    let ran = sandbox.run(&["what", "robots.mod", "walker", "--max-steps", "200"]);
    assert!(ran.code == 1 && ran.err.contains("E0504"), "{}", ran.err);
}

#[test]
fn a_session_answers_and_stays_as_it_was() {
    let sandbox = Sandbox::new(&[]);
    let session = "let smores = 3mm\nuse std.smores.Climber4\nlet Leg3 = 4\n:what Climber4()\nsmores\n:what smores\n:vars\n:what";
    let ran = sandbox.run_with_input(&["repl"], session.as_bytes());
    assert_eq!(ran.code, 1, "the question about a length is wrong");
    assert!(
        ran.out.contains("std.smores.Climber4: 1 embedding\n  stand()\n  flat()\n  step("),
        "{}",
        ran.out
    );
    assert!(ran.out.contains("std.smores.Chain3: 2 embeddings"), "{}", ran.out);
    // A name of the session hides none of the library's robots from the question.
    assert!(ran.out.contains("std.smores.Leg3: 2 embeddings"), "{}", ran.out);
    assert!(
        ran.out.ends_with("3mm: Length\nClimber4  config\nLeg3      Int\nsmores    Length\n"),
        "{}",
        ran.out
    );
    assert!(
        ran.err.contains("this is Length") && ran.err.contains("`:what` is written `:what EXPR`"),
        "{}",
        ran.err
    );
}
