//! Gaits of the SMORES tools come in with the order, the signs and the times that their files state, or are refused.

use super::smores::{imported, row};
use crate::desk::cli::{Sandbox, json};
use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use modl::exchange::{ImportFile, import};
use std::collections::{BTreeMap, BTreeSet};

#[test]
fn commands_keep_their_signs_times_and_units() {
    let gait = "Module_0 p0.5 i i p1.5708 {a} ; // stands\nModule_1 i p3.14159265359 p-3 i [2500] {a} ;\n\
                Module_2 i i i i [700] (a) {b} ; Module_0 s0.5 s-1 i i [2000] (b) ;\n\nModule_1 s2 i i i (b) ;\n\
                $ - &Module_1 &Module_0 (b) {c} ;\n$ + &Module_0 &Module_1 #3 #0 [100] (c) ;\nModule_2 p0.0 i i i (nobody) ;\n";
    let robot = imported(&[("row.conf", &row()), ("wave 2.gait", gait)]);
    let wanted = "  behavior wave_2 = Sc(
    Pc(
      move(module_0.front, to: 0.5rad),
      move(module_0.tilt, to: 90deg),
      move(module_1.left, to: 180deg, in: 2.5s),
      move(module_1.right, to: -3rad, in: 2.5s),
    ),
    wait(0.7s),
";
    assert!(robot.text.contains(wanted), "{}", robot.text);
    for line in [
        "spin(module_0.front, 0.5rad/s, for: 2s)",
        "spin(module_0.left, -1rad/s, for: 2s)",
        "spin(module_1.front, 2rad/s, for: 10s)",
        "undock(module_0.bottom)",
        "dock(module_0.bottom, module_1.top)",
        "wait(0.1s)",
    ] {
        assert!(robot.text.contains(line), "no {line}\n{}", robot.text);
    }
    let notes = robot.notes.join("\n");
    assert!(notes.contains("no command has the label `nobody`"), "{notes}");
    assert!(notes.contains("1 commands that repeat where a joint stands"), "{notes}");
    run_clean(&format!(
        "{}\nprint(plan(Row().wave_2(), world: world(ground: off, gravity: off)).actions)",
        robot.text
    ));
}

/// A speed that lasts no time is left out, since no motion lasts none.
#[test]
fn speeds_without_time_move_nothing() {
    let gait = "Module_0 s0.5 i i i [0] ; Module_1 i s0.5 i i [100] ;";
    let robot = imported(&[("row.conf", &row()), ("g.gait", gait)]);
    assert_eq!(robot.text.matches("spin(").count(), 1, "{}", robot.text);
    assert!(robot.text.contains("spin(module_1.left, 0.5rad/s, for: 0.1s)"), "{}", robot.text);
}

/// The pairs of moves of which one runs before the other in a behaviour that the writer wrote, by the targets of moves in whole degrees.
fn before(text: &str) -> BTreeSet<(i64, i64)> {
    fn part(
        lines: &mut dyn Iterator<Item = &str>,
        series: bool,
        pairs: &mut BTreeSet<(i64, i64)>,
    ) -> Vec<i64> {
        let mut all: Vec<i64> = Vec::new();
        while let Some(line) = lines.next() {
            let line = line.trim();
            let own = match line {
                ")," | ")" => break,
                "Sc(" => part(lines, true, pairs),
                "Pc(" => part(lines, false, pairs),
                _ => {
                    let to =
                        line.split("to: ").nth(1).and_then(|rest| rest.split("deg").next()).expect("a move");
                    vec![to.parse().expect("whole degrees")]
                }
            };
            if series {
                pairs.extend(all.iter().flat_map(|a| own.iter().map(|b| (*a, *b))));
            }
            all.extend(own);
        }
        all
    }
    let mut pairs = BTreeSet::new();
    let body = text.split("behavior gait = ").nth(1).expect("the behaviour");
    let mut lines = body.lines();
    let series = lines.next() == Some("Sc(");
    part(&mut lines, series, &mut pairs);
    pairs
}

#[test]
fn commands_run_in_the_order_that_the_file_asks() {
    let (mut exact, mut layered) = (0, 0);
    for seed in 1..=60 {
        let mut numbers = Numbers(1000 + seed);
        let count = 2 + numbers.below(12);
        // Commands wait for labels that only commands before them have: nothing waits for itself.
        let mut text = String::new();
        let mut must: BTreeSet<(i64, i64)> = BTreeSet::new();
        let mut label_of = Vec::new();
        let mut last: BTreeMap<usize, usize> = BTreeMap::new();
        for index in 0..count {
            let module = numbers.below(3);
            let label = index / 3 * 10 + numbers.below(2);
            let waits = (index >= 3 && numbers.below(3) > 0).then(|| (index / 3 - 1) * 10 + numbers.below(2));
            text +=
                &format!("Module_{module} i p{} i i {{{label}}} ", f64::from(1 + index as u32).to_radians());
            if let Some(waits) = waits {
                text += &format!("({waits}) ");
                let carrying = label_of.iter().enumerate().filter(|(_, label)| **label == waits);
                must.extend(carrying.map(|(other, _)| (1 + other as i64, 1 + index as i64)));
            }
            if let Some(former) = last.insert(module, index) {
                must.insert((1 + former as i64, 1 + index as i64));
            }
            label_of.push(label);
            text += ";\n";
        }
        for middle in 1..=count as i64 {
            for a in 1..=count as i64 {
                for b in 1..=count as i64 {
                    if must.contains(&(a, middle)) && must.contains(&(middle, b)) {
                        must.insert((a, b));
                    }
                }
            }
        }
        let robot = imported(&[("row.conf", &row()), ("gait.gait", &text)]);
        let found = before(&robot.text);
        assert!(found.is_superset(&must), "seed {seed}\n{text}\n{}", robot.text);
        if robot.notes.iter().any(|note| note.contains("waits longer")) {
            layered += 1;
        } else {
            assert_eq!(found, must, "seed {seed}\n{text}\n{}", robot.text);
            exact += 1;
        }
    }
    assert!(exact > 10 && layered > 2, "{exact} exact, {layered} in layers");
}

#[test]
fn states_of_vsparc_run_one_after_another() {
    let command = |name: &str, kind: &str, value: f64| {
        format!(
            "<JointCommand name=\"{name}\"><commandType>{kind}</commandType><targetValue>{value}</targetValue><period>3</period>\
             <parametricValue>0</parametricValue></JointCommand>"
        )
    };
    let state = |commands: &str| {
        format!(
            "<RobotState name=\"x\"><period>3</period><ModuleStates><ModuleState name=\"S\"><position><x>0</x><y>5</y><z>0</z>\
             </position><rotation><x>0.7071068</x><y>0</y><z>0</z><w>-0.7071068</w></rotation><period>3</period><JointCommands>\
             {commands}</JointCommands></ModuleState></ModuleStates><Connections/></RobotState>"
        )
    };
    let at_rest =
        state("").replace("RobotState ", "RobotStateObject ").replace("</RobotState>", "</RobotStateObject>");
    let rows = [
        state(&(command("Body", "Position", 30.0) + &command("FrontWheel", "Velocity", 90.0))),
        state(&command("LeftWheel", "Position", 350.0)),
        state(""),
    ];
    let behavior = format!("<Behavior name=\"\"><RobotStates>{}</RobotStates></Behavior>", rows.concat());
    let robot = imported(&[("one.xml", &at_rest), ("nod.xml", &behavior)]);
    let wanted = "  behavior nod = Sc(
    Pc(
      move(s.tilt, to: -30deg, in: 3s),
      spin(s.front, -90deg/s, for: 3s),
    ),
    move(s.left, to: -10deg, in: 3s),
    wait(3s),
  )
";
    assert!(robot.text.replace("m_s.", "s.").contains(wanted), "{}", robot.text);
    let torque = behavior.replace("Velocity", "Torque");
    let files =
        [ImportFile { name: "one.xml", text: &at_rest }, ImportFile { name: "nod.xml", text: &torque }];
    let (file, fault) = import(&files, &mut |_| None).expect_err("a torque");
    assert!(file == 1 && fault.line == 1 && fault.message.starts_with("a torque: "), "{fault:?}");
}

/// Checks that an import is refused with a message, at a line of its last file; 0: at none.
pub fn refused(sandbox: &Sandbox, files: &[&str], wanted: &str, line: u64) {
    let arguments: Vec<&str> = [&["import"], files, &["--json"]].concat();
    let ran = sandbox.run(&arguments);
    assert_eq!(ran.code, 1, "{wanted}: {}{}", ran.out, ran.err);
    let said = &json(&ran)["diagnostics"][0];
    assert_eq!(said["code"], "E0707");
    assert!(said["message"].as_str().is_some_and(|m| m.contains(wanted)), "{wanted}: {said}");
    let at = said["labels"][0]["line"].as_u64().unwrap_or(0);
    assert_eq!(at, line, "{said}");
    assert!(!sandbox.path("out").exists());
}

#[test]
fn files_that_make_no_robot_are_refused_where_they_say_so() {
    let row = row();
    let long: String = (0..10_001).map(|k| format!("<module><name>M{k}</name></module>")).collect();
    let cases = [
        (row.replace("</connections>", ""), "it is no XML", None),
        (row[..row.len() / 2].to_owned(), "it is no XML", None),
        ("<configuration><modules/></configuration>".to_owned(), "there are no modules", Some(0)),
        ("<configuration/>".to_owned(), "`<configuration>` without `<modules>`", Some(1)),
        (row.replace("Module_2</name>", "Module_1</name>"), "`Module_1` is there twice", Some(16)),
        (row.replace("<module2>Module_2", "<module2>Module_9"), "there is no module `Module_9`", Some(25)),
        (row.replace("<node1>3", "<node1>4"), "`4` is no face of a module", Some(24)),
        (row.replace("<node1>3", "<node1>1"), "the file places them", Some(24)),
        (row.replace("<distance>0.0", "<distance>0.02"), "0.02 m apart", Some(24)),
        (row.replace("<angle>0", "<angle>30"), "a turn by 30°", Some(24)),
        (row.replace("SMORE.sdf", "SMORES_gripper.sdf"), "of the model `SMORES_gripper.sdf`", Some(8)),
        (row.replacen("<joints>0", "<joints>NaN", 1), "4 finite numbers are wanted", Some(7)),
        (row.replacen("0</joints>", "2</joints>", 1), "a tilt of 114.6°", Some(4)),
        (row.replacen("<joints>0", "<joints>1e999", 1), "4 finite numbers are wanted", Some(7)),
        (row.replacen("<position>0", "<position>0 0 0", 1), "6 or 7 finite numbers are wanted", Some(6)),
        (row.replace("<module2>Module_2", "<module2>Module_0"), "the top of `Module_0`", Some(25)),
        (
            row.replace(
                "<module1>Module_1</module1><module2>Module_2",
                "<module1>Module_1</module1><module2>Module_1",
            ),
            "are of one module",
            Some(25),
        ),
        (
            format!("<configuration><modules>{long}</modules></configuration>"),
            "10001 modules are more than 10000",
            Some(1),
        ),
        ("<Control/>".to_owned(), "`<robot>` is wanted", Some(1)),
        ("<Behavior/>".to_owned(), "moves the modules of a configuration", Some(1)),
    ];
    for (text, wanted, line) in cases {
        let sandbox = Sandbox::new(&[("r.conf", text.as_bytes())]);
        let ran = sandbox.run(&["import", "r.conf", "--json"]);
        assert_eq!(ran.code, 1, "{wanted}: {}", ran.err);
        if let Some(line) = line {
            refused(&sandbox, &["r.conf"], wanted, line);
        }
    }
}

#[test]
fn gaits_that_make_no_motion_are_refused_where_they_say_so() {
    let many = "Module_0 i i i p1 ;".repeat(10_001);
    let cases = [
        ("", "there are no commands", 0),
        ("Module_0 i i i p1 {a}", "a command ends with `;`", 1),
        ("Module_0 i i i p1 ;\n\tModule_7 i i i p1 ;", "the configuration has no module `Module_7`", 2),
        ("Module_0 i i p1 ;", "3 joints: 4 are wanted", 1),
        ("Module_0 i i i t0.5 ;", "`t0.5` commands a torque", 1),
        ("Module_0 i i i c ;", "`c` docks by the joint", 1),
        ("Module_0 i i i pnan ;", "a number is wanted behind `p`", 1),
        ("Module_0 i i i p-1.6 ;", "a tilt of -91.7°", 1),
        ("Module_0 i i i p ;", "a number is wanted behind `p`", 1),
        ("Module_0 i i i 0.5 ;", "`0.5` is no command of a joint", 1),
        ("Module_0 i i i é1 ;", "`é1` is no command of a joint", 1),
        ("Module_0 i i i p1 [-5] ;", "whole milliseconds", 1),
        ("Module_0 i i i p1 {a ;", "`{` without `}`", 1),
        ("Module_0 i i i p1 {a} {b} ;", "a second `{`", 1),
        ("Module_0 i i i p1 () ;", "a name is wanted", 1),
        ("[5] ;", "a command without a module", 1),
        (
            "Module_0 i i i p1 {a} (b) ;\n Module_1 i i i p1 {b} (a) ;",
            "waits for commands that wait for it",
            1,
        ),
        ("Module_0 i i i p1 (a) ;\nModule_0 i i i p0 {a} ;", "waits for commands that wait for it", 1),
        ("$ - &Module_0 &Module_2 ;", "`Module_0` and `Module_2` are not connected", 1),
        ("$ + &Module_0 &Module_2 #0 ;", "two faces are wanted", 1),
        ("$ + &Module_0 &Module_2 #0 #5 ;", "`#5` is no face", 1),
        ("$ &Module_0 &Module_2 ;", "`+` or `-` is wanted", 1),
        ("$ + &Module_0 &Module_0 #1 #2 ;", "both ends are of one module", 1),
        ("$ - &Module_0 ;", "two modules are wanted", 1),
        (&many, "more than 10000 commands", 1),
        ("<RobotState/>", "`<Behavior>` is wanted", 1),
    ];
    for (text, wanted, line) in cases {
        let sandbox = Sandbox::new(&[("r.conf", row().as_bytes()), ("g.gait", text.as_bytes())]);
        refused(&sandbox, &["r.conf", "g.gait"], wanted, line);
    }
    let sandbox = Sandbox::new(&[
        ("g.gait", b"Module_0 i i i p1 ;"),
        ("a.urdf", b"<robot name=\"r\"><link name=\"a\"/></robot>"),
    ]);
    refused(&sandbox, &["g.gait"], "a gait moves the modules of a configuration", 0);
    refused(&sandbox, &["a.urdf", "g.gait"], "has no behaviours beside it", 0);
}

#[test]
fn what_is_imported_is_formatted_and_checks() {
    let gait = "Module_0 i i i p0.5 {a} ; Module_1 i i i p-0.5 {a} ; Module_2 i i i p0.5 (a) ;";
    let sandbox = Sandbox::new(&[("my row.conf", row().as_bytes()), ("if.gait", gait.as_bytes())]);
    let ran = sandbox.run(&["import", "my row.conf", "if.gait"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, "wrote out/my_row.mod: config MyRow\n"));
    for command in ["check", "fmt"] {
        let more = if command == "fmt" {
            ["fmt", "--check", "out/my_row.mod"].to_vec()
        } else {
            vec!["check", "out/my_row.mod"]
        };
        let ran = sandbox.run(&more);
        assert_eq!(ran.code, 0, "{command}: {}{}", ran.out, ran.err);
    }
}
