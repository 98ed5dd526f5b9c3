//! The two ways of a reconfiguration: what both configurations have in common stays, and the shorter way is taken.

use crate::planners::tosnake::tracks;
use crate::support::desk::run_clean;
use crate::support::replay::Replay;
use modl::plan;

/// Plans, and returns what is printed: docks and undocks, the bound, the way and the duration; the plan passes the judge
/// and a second replay.
fn planned(program: &str, from: &str, to: &str) -> (usize, usize, String, f64) {
    let text = format!(
        "{program}\nlet p = reconfigure({from}, {to})\nprint(p.docks + p.undocks, p.fewest_changes, p.way, \
         p.duration / 1s)\nprint(verify(p).ok)\nemit(p, \"p.plan.json\")\n"
    );
    let desk = run_clean(&text);
    assert_eq!(desk.printed[1], "true", "{from} to {to}");
    let plan = plan::file::read(desk.text("p.plan.json")).expect("it was written to be read");
    Replay::new(tracks(&plan)).judge().unwrap_or_else(|fault| panic!("{from} to {to}: {fault}"));
    let words: Vec<&str> = desk.printed[0].split(' ').collect();
    let count = |word: usize| words[word].parse().expect("a number");
    (count(0), count(1), words[2].to_owned(), words[3].parse().expect("a number"))
}

/// A trunk with two arms, of which the second robot has one elsewhere.
const TRUNK: &str = "use std.rofi.{Rofi, Snake}
config Trunk(high: Bool = false) {
  part trunk: Snake(n: 6)
  part arm: Snake(n: 3)
  part other: Snake(n: 2)
  connect trunk.m[1].a_plus_x -- arm.head
  if high { connect trunk.m[4].b_minus_x -- other.head } else { connect trunk.m[2].a_minus_x -- other.head }
}
";

/// Eleven modules of which one connection differs. The way through the snake changes eight: each of two connections in
/// either robot that are none of a snake, for another. The bound tells connections apart by their faces and turns alone.
#[test]
fn one_arm_moves_and_the_rest_stays() {
    let (changes, fewest, way, _) = planned(TRUNK, "Trunk", "Trunk(high: true)");
    assert_eq!(fewest, 0);
    assert!(way == "direct" && changes < 8, "{way} {changes}");
}

/// The bound holds for every pair: nothing changes fewer connections. And it is reached where a loop is closed alone.
#[test]
fn no_plan_changes_fewer_connections_than_the_bound() {
    let shapes = "use std.rofi.{Snake, Ring, Spider, Crab, Chair}";
    for (from, to) in [("Spider", "Crab"), ("Chair", "Spider"), ("Snake(n: 8)", "Ring(n: 8)")] {
        let (changes, fewest, ..) = planned(shapes, from, to);
        assert!(changes >= fewest, "{from} to {to}: {changes} of {fewest}");
    }
    // A ring is the snake with its ends docked: one connection more.
    let (changes, fewest, way, _) = planned(shapes, "Snake(n: 8)", "Ring(n: 8)");
    assert_eq!((changes, fewest), (1, 1), "{way}");
}

/// The plan takes no longer than both plans to the snake, the second backwards.
#[test]
fn the_shorter_way_is_taken() {
    let uses = "use std.rofi.{Stool, Dumbbell, Spider}";
    for (from, to) in [("Stool", "Dumbbell"), ("Spider(gap: true)", "Spider")] {
        let (.., duration) = planned(uses, from, to);
        let text = format!("{uses}\nprint((tosnake({from}) ++ reverse(tosnake({to}))).duration / 1s)\n");
        let snake: f64 = run_clean(&text).printed[0].parse().expect("a number");
        assert!(
            duration <= snake * (1.0 + 1e-5),
            "{from} to {to}: {duration} s, {snake} s through the snake"
        );
    }
}

/// The same call gives the same bytes, whichever way it goes.
#[test]
fn the_same_reconfiguration_is_found_again() {
    let text = format!("{TRUNK}emit(reconfigure(Trunk, Trunk(high: true)), \"p.plan.json\")\n");
    assert_eq!(run_clean(&text).text("p.plan.json"), run_clean(&text).text("p.plan.json"));
}
