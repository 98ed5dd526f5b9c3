//! The model of a text as the page shows it: the robot, the lines that its modules come from, values and free ports.

use super::edits::{after, document, joint, model, parameter};

const WALKER: &str = "\
use std.smores.Smores
use std.mori.Mori

config Leg(bend: Angle = 30deg) {
  part hip: Smores
  part foot: Smores
  connect hip.bottom -- foot.top
  set foot.tilt = bend
  port end = hip.top
}

config Walker {
  part body: Smores
  part leg[2]: Leg
  connect body.left -- leg[0].end
  connect body.right -- leg[1].end
}
";

fn line_of(text: &str) -> usize {
    1 + WALKER.lines().position(|line| line.trim() == text).expect("the line is there")
}

#[test]
fn modules_know_the_lines_that_they_come_from() {
    let model = model(&document(WALKER), "");
    assert_eq!(model.robots, ["Leg", "Walker"]);
    let robot = model.robot.expect("the program is sound");
    assert_eq!(robot.name, "Walker");
    let lines = |module: usize| robot.modules[module].parts.iter().map(|p| p.line).collect::<Vec<_>>();
    let names: Vec<&str> = robot.modules.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["body", "leg[0].hip", "leg[0].foot", "leg[1].hip", "leg[1].foot"]);
    assert_eq!(lines(0), [line_of("part body: Smores")]);
    assert_eq!(lines(4), [line_of("part leg[2]: Leg"), line_of("part foot: Smores")]);
    let mark = |line: usize| robot.marks.iter().find(|m| m.place.line == line).map(|m| m.modules.clone());
    assert_eq!(mark(line_of("connect body.right -- leg[1].end")), Some(vec![0, 3]));
    assert_eq!(mark(line_of("set foot.tilt = bend")), Some(vec![2, 4]));
    // The place of a clause is its text.
    let place = robot.modules[0].parts[0];
    assert_eq!(&WALKER[place.start..place.end], "part body: Smores");
}

#[test]
fn free_ports_offer_what_mates() {
    let robot = model(&document(WALKER), "Walker").robot.expect("the program is sound");
    let free = |name: &str| robot.ports.iter().find(|port| port.name == name);
    assert!(free("body.left").is_none(), "it has a bond");
    let top = free("body.top").expect("nothing is docked there");
    let offers: Vec<String> =
        top.offers.iter().map(|i| format!("{}.{}", robot.offers[*i].part, robot.offers[*i].port)).collect();
    // Mori has other connectors, and a walker in a walker would have no end.
    assert_eq!(offers, ["Leg.end", "Smores.top", "Smores.bottom", "Smores.left", "Smores.right"]);
    // Five modules of four ports, four bonds.
    assert_eq!(robot.ports.len(), 5 * 4 - 2 * 4);
}

#[test]
fn values_are_those_of_the_text() {
    let leg = model(&document(WALKER), "Leg").robot.expect("the program is sound");
    let bend = &leg.parameters[0];
    assert_eq!((bend.name.as_str(), bend.value, bend.unit.as_str()), ("bend", Some(30.0), "deg"));
    assert_eq!(&WALKER[bend.place.start..bend.place.end], "30deg");
    let tilt = leg.joints.iter().find(|joint| joint.name == "foot.tilt").expect("it tilts");
    assert!((tilt.value.to_degrees() - 30.0).abs() < 1e-9);
    let (low, high) = tilt.range.expect("its range is stated");
    assert!((low.to_degrees() + 90.0).abs() < 1e-9 && (high.to_degrees() - 90.0).abs() < 1e-9);
    assert_eq!(
        leg.picture["body"]["start"][tilt.index].as_f64().map(|x| (x - tilt.value).abs() < 1e-6),
        Some(true)
    );
}

#[test]
fn lattices_and_trusses_are_shown_without_parts() {
    let text = "use std.crystal.ExpandingCube\nlattice Row of ExpandingCube = row(3)\n";
    let shown = model(&document(text), "");
    assert_eq!(shown.error(), None);
    let robot = shown.robot.expect("it is sound");
    assert_eq!((robot.name.as_str(), robot.modules.len(), robot.ports.len()), ("Row", 0, 0));
    assert_eq!(robot.picture["body"]["count"], 3);
    assert!(robot.parameters.is_empty() && robot.joints.is_empty());
    let tower = "use std.truss.PneumaticReel\ntruss Tower(edge: Length = 4m) of PneumaticReel = octet(edge: edge, divisions: 2)\n";
    let robot = model(&document(tower), "").robot.expect("it is sound");
    assert_eq!((robot.parameters[0].name.as_str(), robot.parameters[0].value), ("edge", Some(4.0)));
    let found = after(tower, &parameter("Tower", None, "edge", 3.5));
    assert_eq!(found, Ok(tower.replace("4m", "3.5m")));
    let refused = after(tower, &joint("Tower", "edge", 1.0)).expect_err("a truss has no joints");
    assert!(refused.contains("no joint"), "{refused}");
    let empty = model(&document("let a = 1\n"), "");
    assert!(empty.robot.is_none() && empty.robots.is_empty() && empty.findings.is_empty());
}

#[test]
fn a_wrong_text_is_told_about_and_shows_no_robot() {
    let model = model(&document(&WALKER.replace("body.left", "body.lift")), "");
    assert!(model.robot.is_none());
    assert_eq!(model.robots, ["Leg", "Walker"]);
    let found = &model.findings[0];
    assert_eq!(found.labels[0].line, line_of("connect body.left -- leg[0].end"));
    assert!(model.error().is_some());
}
