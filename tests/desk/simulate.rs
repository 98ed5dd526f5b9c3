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
    let two = s.run(&["simulate", "a.mod", "b.mod"]);
    assert!(two.code == 2 && two.err.contains("one program, or plan files"), "{}{}", two.code, two.err);
    // A program with errors is told by them.
    let wrong = s.run(&["simulate", "c.mod"]);
    assert!(wrong.code == 1 && wrong.err.contains("E0101"), "{}{}", wrong.code, wrong.err);
}
