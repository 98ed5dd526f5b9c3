//! `modl simulate`: programs and plan files at the command line.

use super::cli::{Sandbox, json};

/// A block hangs at another that is held; a magnet of 8 N holds it no longer than a moment.
const BREAKS: &str = "connector Magnet { mates Magnet, turns 4, holds 8N }
module Block {
  link body = box(50mm, 50mm, 50mm, mass: 1kg)
  port top : Magnet on body at [0mm, 0mm, 25mm] facing +Z up +X
  port bottom : Magnet on body at [0mm, 0mm, -25mm] facing -Z up +X
}
config Hanging {
  part m[2]: Block
  connect m[0].bottom -- m[1].top
  base m[0]
  behavior hang = wait(1s)
}
print(\"hangs\")
emit(plan(Hanging().hang(), world: world(ground: held)), \"hang.plan.json\")
emit(plan(Hanging().hang(), world: world(gravity: off, ground: off)), \"float.plan.json\")
";

#[test]
fn the_plans_of_a_program_are_played_and_no_file_is_written() {
    let s = Sandbox::new(&[("hang.mod", BREAKS.as_bytes())]);
    let ran = s.run(&["simulate", "hang.mod"]);
    // The judge would refuse the first plan, which is played all the same; the second is fine.
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.out.starts_with("hangs\n"), "{}", ran.out);
    assert!(ran.out.contains("hang.plan.json: simulated in steps of 0.5ms"), "{}", ran.out);
    assert!(ran.out.contains("m[0].bottom -- m[1].top breaks"), "{}", ran.out);
    assert!(ran.out.contains("float.plan.json: simulated"), "{}", ran.out);
    assert!(!s.path("out").exists());
    let told = json(&s.run(&["simulate", "hang.mod", "--json"]));
    assert_eq!(told["printed"], serde_json::json!(["hangs"]));
    let plans = told["simulations"].as_array().expect("a list");
    assert_eq!(plans.iter().map(|p| p["ok"] == true).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn a_program_that_emits_no_plan_or_stands_among_files_is_a_wrong_call() {
    let s = Sandbox::new(&[("a.mod", b"print(1)\n"), ("b.mod", b"print(2)\n"), ("c.mod", b"print(x)\n")]);
    let none = s.run(&["simulate", "a.mod"]);
    assert!(none.code == 2 && none.err.contains("`a.mod` emits no plan"), "{}{}", none.code, none.err);
    assert!(none.err.contains("add `emit(BEHAVIOR, \"NAME.plan.json\")`"), "{}", none.err);
    let two = s.run(&["simulate", "a.mod", "b.mod"]);
    assert!(two.code == 2 && two.err.contains("one program, or plan files"), "{}{}", two.code, two.err);
    // A program with errors is told by them.
    let wrong = s.run(&["simulate", "c.mod"]);
    assert!(wrong.code == 1 && wrong.err.contains("E0101"), "{}{}", wrong.code, wrong.err);
}

#[test]
fn notes_say_what_the_verdict_says_and_runs_are_counted() {
    let s = Sandbox::new(&[("hang.mod", BREAKS.as_bytes())]);
    let ran = s.run(&["simulate", "hang.mod", "--runs", "3", "--mass-spread", "0.1", "--seed", "7"]);
    assert!(ran.out.contains("note: the verdict on the plan is that it fails"), "{}", ran.out);
    assert!(
        ran.out.contains(
            "note: 3 of 3 runs fail, as it does as planned: 3 with a fall, 3 with a bond that breaks"
        ),
        "{}",
        ran.out
    );
    assert!(ran.out.contains("note: none of 3 runs fails"), "{}", ran.out);
    let told = json(&s.run(&["simulate", "hang.mod", "--runs", "3", "--mass-spread", "0.1", "--json"]));
    let runs = &told["simulations"][0]["runs"];
    assert_eq!((&runs["count"], &runs["fails"], &runs["breaks"]), (&3.into(), &3.into(), &3.into()));
    assert_eq!(runs["travels"].as_array().map(Vec::len), Some(3));
    // Without runs there is nothing to count.
    assert!(json(&s.run(&["simulate", "hang.mod", "--json"]))["simulations"][1]["runs"].is_null());
}

#[test]
fn settings_out_of_range_are_wrong_calls() {
    let s = Sandbox::new(&[("hang.mod", BREAKS.as_bytes())]);
    for (arguments, why) in [
        (["--friction", "-1"], "`--friction` must not be negative"),
        (["--step", "-1"], "`--step`: a time step must be from"),
        (["--mass-spread", "1"], "`--mass-spread` is a part of what is stated, from 0 to below 1"),
        (["--torque-spread", "-0.5"], "`--torque-spread` is a part of what is stated"),
        (["--joint-spread", "-3"], "`--joint-spread` is an angle from 0 to 180 degrees"),
        (["--runs", "200000"], "`--runs`: at most 100000 runs"),
    ] {
        let ran = s.run(&["simulate", "hang.mod", arguments[0], arguments[1]]);
        assert!(ran.code == 2 && ran.err.contains(why), "{arguments:?}: {}{}", ran.code, ran.err);
    }
}

#[test]
fn a_plan_of_a_lattice_is_refused_as_a_sound_plan() {
    let program = "use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(4)
lattice Pole of ExpandingCube = column(4)
emit(squeeze(Bar, Pole), \"t.plan.json\")
";
    let s = Sandbox::new(&[("t.mod", program.as_bytes())]);
    let ran = s.run(&["simulate", "t.mod"]);
    assert!(
        ran.code == 1
            && ran.err.contains("E0506")
            && ran.err.contains("only robots with joints are simulated"),
        "{}",
        ran.err
    );
}

#[test]
fn verify_says_in_json_under_which_dynamics() {
    for (world, model) in [("", "full"), (", world: world(dynamics: statics)", "statics")] {
        let program =
            format!("use std.smores.Driver1\nemit(plan(Driver1().drive(t: 1s){world}), \"p.plan.json\")\n");
        let s = Sandbox::new(&[("p.mod", program.as_bytes())]);
        assert_eq!(s.run(&["run", "p.mod"]).code, 0);
        assert_eq!(json(&s.run(&["verify", "--json", "out/p.plan.json"]))["plans"][0]["dynamics"], model);
    }
}
