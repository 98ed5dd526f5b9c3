//! A change that is made in the picture, as a change of the text: which bytes it touches, and where it is refused.

use crate::support::suite::MapFiles;
use modl::interrupt::CancelState;
use modl::live::{Document, Edit, Model, Refusal, Setting};
use std::f64::consts::PI;
use std::sync::Arc;

/// A document of one file.
pub fn document(text: &str) -> Document {
    Document::new(Arc::new(MapFiles::default()), "main.mod", text)
}

/// The model of a document; the robot is the one of this name, if it is not empty.
pub fn model(document: &Document, robot: &str) -> Model {
    document.model(Some(robot).filter(|robot| !robot.is_empty()), &CancelState::default())
}

/// The text after a change, or the reason why there is none.
pub fn after(text: &str, edit: &Edit) -> Result<String, String> {
    let document = document(text);
    let before = model(&document, edit.robot());
    match document.edited(document.version(), edit, &before, &CancelState::default()) {
        Ok((text, _)) => Ok(text),
        Err(Refusal::Refused(why)) => Err(why),
        Err(Refusal::Outdated) => panic!("nothing else changes the text"),
    }
}

pub fn parameter(robot: &str, behavior: Option<&str>, name: &str, value: f64) -> Edit {
    let (robot, behavior) = (robot.to_owned(), behavior.map(str::to_owned));
    Edit::Parameter { robot, behavior, name: name.to_owned(), value: Setting::Number(value) }
}

pub fn joint(robot: &str, joint: &str, degrees: f64) -> Edit {
    Edit::Joint { robot: robot.to_owned(), joint: joint.to_owned(), value: degrees * PI / 180.0 }
}

pub fn dock(robot: &str, port: &str, part: &str, at: &str, turn: u32) -> Edit {
    let [robot, port, part, at] = [robot, port, part, at].map(str::to_owned);
    Edit::Dock { robot, port, part, at, turn }
}

const PAIR: &str = "\
use std.smores.Smores

/// Two of them.
config Pair(bend: Angle = 30deg, n: Int = 2, twice: Angle = 2 * 15deg, up: Bool = true) {
  part a: Smores  // the first
  part b: Smores
  connect a.bottom -- b.top
  set a.tilt = bend
  set b.tilt = -10deg  // a little

  behavior nod(to: Angle = 20deg, time: Time = 2s) = move(a.tilt, to: to, in: time)
}
";

#[test]
fn a_default_is_replaced_in_the_unit_that_it_is_written_in() {
    let found = after(PAIR, &parameter("Pair", None, "bend", -12.5));
    assert_eq!(found, Ok(PAIR.replace("Angle = 30deg", "Angle = -12.5deg")));
    let found = after(PAIR, &parameter("Pair", None, "n", 7.0));
    assert_eq!(found, Ok(PAIR.replace("Int = 2", "Int = 7")));
    let found = after(PAIR, &parameter("Pair", Some("nod"), "time", 0.25));
    assert_eq!(found, Ok(PAIR.replace("Time = 2s", "Time = 0.25s")));
    let up = |value| Edit::Parameter { robot: "Pair".into(), behavior: None, name: "up".into(), value };
    assert_eq!(after(PAIR, &up(Setting::Bool(false))), Ok(PAIR.replace("= true", "= false")));
    let refused = after(PAIR, &up(Setting::Number(1.0))).expect_err("a number is no truth value");
    assert!(refused.contains("no value of `up`"), "{refused}");
}

#[test]
fn what_is_worked_out_is_changed_in_the_text() {
    let refused = after(PAIR, &parameter("Pair", None, "twice", 40.0)).expect_err("a formula");
    assert!(refused.contains("worked out by `2 * 15deg`"), "{refused}");
    let refused = after(PAIR, &joint("Pair", "a.tilt", 5.0)).expect_err("a name");
    assert!(refused.contains("`a.tilt` is set to `bend`"), "{refused}");
    let refused = after(PAIR, &parameter("Pair", None, "n", 2.5)).expect_err("half a part");
    assert!(refused.contains("whole number"), "{refused}");
}

#[test]
fn a_joint_is_set_where_the_text_sets_it_or_in_a_line_more() {
    let found = after(PAIR, &joint("Pair", "b.tilt", 42.0));
    assert_eq!(found, Ok(PAIR.replace("-10deg", "42deg")));
    let found = after(PAIR, &joint("Pair", "b.left", 5.5));
    let line = "-10deg  // a little\n";
    assert_eq!(found, Ok(PAIR.replace(line, &format!("{line}  set b.left = 5.5deg\n"))));
    // SMORES tilts by 90 degrees at most.
    let refused = after(PAIR, &joint("Pair", "b.tilt", 170.0)).expect_err("out of its range");
    assert!(refused.contains("b.tilt"), "{refused}");
}

#[test]
fn rounding_leads_no_joint_out_of_its_range() {
    let text = include_str!("texts/arm.mod").replace("-90deg..90deg", "-1.2345rad..1.2345rad");
    for limit in [1.2345, -1.2345_f64] {
        let found = after(&text, &joint("Arm", "h[0].bend", limit.to_degrees())).expect("it is in its range");
        let line = found.lines().find(|line| line.contains("set h[0].bend")).expect("it is set");
        // 1.2345 rad are 70.7316398... degrees, which six decimals round to more.
        let wanted = if limit > 0.0 { "= 70.731639deg" } else { "= -70.731639deg" };
        assert!(line.ends_with(wanted), "{line}");
    }
}

#[test]
fn a_part_is_docked_by_two_lines() {
    let found = after(PAIR, &dock("Pair", "b.bottom", "Smores", "top", 1));
    let with_part = PAIR.replace("  part b: Smores\n", "  part b: Smores\n  part smores1: Smores\n");
    let bond = "  connect a.bottom -- b.top\n";
    let more = format!("{bond}  connect b.bottom -- smores1.top turn 90deg\n");
    assert_eq!(found, Ok(with_part.replace(bond, &more)));
    let taken = after(PAIR, &dock("Pair", "b.top", "Smores", "top", 0)).expect_err("it has a bond");
    assert!(taken.contains("no free port"), "{taken}");
    let foreign = after(PAIR, &dock("Pair", "b.bottom", "Mori", "edge", 0)).expect_err("not imported");
    assert!(foreign.contains("does not mate"), "{foreign}");
    let turned = after(PAIR, &dock("Pair", "b.bottom", "Smores", "top", 4)).expect_err("four turns");
    assert!(turned.contains("4 turns"), "{turned}");
}

#[test]
fn a_new_part_has_a_name_that_nothing_has() {
    let text = "use std.smores.Smores\nlet smores1 = 3\nconfig One { part smores2: Smores }\n";
    let found = after(text, &dock("One", "smores2.top", "Smores", "bottom", 0)).expect("it is free");
    let wanted = "config One { part smores2: Smores\n  part smores3: Smores\n\n  connect smores2.top -- smores3.bottom\n }\n";
    assert_eq!(found.split_once("= 3\n").expect("it is there").1, wanted);
}

#[test]
fn line_ends_stay_those_of_the_file() {
    let text = PAIR.replace('\n', "\r\n");
    let found = after(&text, &joint("Pair", "b.left", 5.0)).expect("it can be set");
    assert_eq!(found.replace("\r\n", "").find('\n'), None);
    assert!(found.contains("// a little\r\n  set b.left = 5deg\r\n"), "{found}");
}

#[test]
fn loops_and_branches_are_left_alone() {
    let text = "use std.smores.Smores\nconfig Row(n: Int = 3) {\n  part m[n]: Smores\n  for i in 0..n - 1 { connect \
                m[i].bottom -- m[i + 1].top }\n  for i in 0..n { set m[i].tilt = 10deg }\n}\n";
    let refused = after(text, &joint("Row", "m[1].tilt", 20.0)).expect_err("a loop sets it");
    assert!(refused.contains("in a loop or a branch"), "{refused}");
    // A joint that no loop sets is set after all of them.
    let found = after(text, &joint("Row", "m[1].left", 20.0)).expect("nothing sets it");
    assert_eq!(found, text.replace("10deg }\n", "10deg }\n  set m[1].left = 20deg\n"));
}

#[test]
fn what_a_part_sets_is_set_again_outside() {
    let text = "use std.smores.Smores\nconfig In { part m: Smores  set m.tilt = 10deg }\nconfig Out { part k: In }\n";
    let found = after(text, &joint("Out", "k.m.tilt", 30.0)).expect("the outer one decides");
    assert_eq!(found, text.replace("part k: In ", "part k: In\n  set k.m.tilt = 30deg\n "));
    assert_eq!(model(&document(&found), "Out").robot.expect("sound").joints.len(), 4);
}

#[test]
fn a_wrong_program_is_mended_in_the_text_first() {
    let text = PAIR.replace("b.top", "b.nothing");
    let refused = after(&text, &joint("Pair", "b.tilt", 1.0)).expect_err("the program is wrong");
    assert!(refused.contains("has errors"), "{refused}");
    let refused = after(PAIR, &joint("Nobody", "b.tilt", 1.0)).expect_err("no such configuration");
    assert!(refused.contains("no `Nobody`"), "{refused}");
    // The change itself must leave the program sound: two modules of one place are.
    let strict = PAIR.replace("  part a", "  require n < 5, \"too many\"\n  part a");
    let refused = after(&strict, &parameter("Pair", None, "n", 9.0)).expect_err("it is required");
    assert!(refused.contains("too many"), "{refused}");
}

#[test]
fn numbers_that_are_none_write_nothing() {
    for value in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        assert!(after(PAIR, &joint("Pair", "b.tilt", value)).is_err());
        assert!(after(PAIR, &parameter("Pair", None, "bend", value)).is_err());
    }
    let tiny = after(PAIR, &parameter("Pair", None, "bend", -1e-12));
    assert_eq!(tiny, Ok(PAIR.replace("Angle = 30deg", "Angle = 0deg")));
}

#[test]
fn a_change_is_for_the_version_that_was_looked_at() {
    let mut document = document(PAIR);
    let (before, old) = (model(&document, "Pair"), document.version());
    document.replace(&PAIR.replace("30deg", "31deg"));
    let edit = joint("Pair", "b.tilt", 1.0);
    let found = document.edited(old, &edit, &before, &CancelState::default()).map(|(text, _)| text);
    assert_eq!(found, Err(Refusal::Outdated));
    assert_eq!(document.moved(old, false), Err(Refusal::Outdated));
}

#[test]
fn what_was_typed_since_is_not_undone() {
    let mut document = document(PAIR);
    let edit = joint("Pair", "b.tilt", 1.0);
    let before = model(&document, "Pair");
    let (text, _) = document.edited(1, &edit, &before, &CancelState::default()).expect("it can be set");
    document.accept(text.clone());
    assert_eq!(document.can(), (true, false));
    document.replace(&format!("{text}\n// typed\n"));
    assert_eq!(document.can(), (false, false));
    assert!(matches!(document.moved(document.version(), false), Err(Refusal::Refused(_))));
    // Typed back, it is the text after the change again.
    document.replace(&text);
    assert_eq!(document.moved(document.version(), false).as_deref(), Ok(PAIR));
}
