//! `--json`: which commands have it, before and behind them, and that what they print is documented.

use super::cli::{Sandbox, json};
use crate::support::fences::fences;
use serde_json::{Value, json as object};

/// A command with arguments, and the fields of its answer; those of [`REPORT`] stand for every report.
struct Row {
    command: &'static str,
    arguments: &'static [&'static str],
    code: i32,
    fields: &'static [&'static str],
}

const REPORT: &[&str] = &["diagnostics", "omitted", "errors", "warnings"];

const fn row(
    command: &'static str,
    arguments: &'static [&'static str],
    fields: &'static [&'static str],
) -> Row {
    Row { command, arguments, code: 0, fields }
}

const fn wrong(command: &'static str, arguments: &'static [&'static str]) -> Row {
    Row { command, arguments, code: 2, fields: &["call_error"] }
}

/// Every command, with what it answers.
const ANSWERS: &[Row] = &[
    row("run", &["a.mod"], &["report", "printed", "values", "written"]),
    row("check", &["a.mod"], &["report"]),
    row("check", &["."], &["report", "programs"]),
    row("test", &["a.mod"], &["report", "printed", "values", "tests"]),
    row("verify", &["p.plan.json"], &["report", "plans"]),
    row("simulate", &["p.plan.json"], &["report", "simulations"]),
    row("simulate", &["q.mod"], &["report", "printed", "values", "simulations"]),
    row("show", &["a.mod"], &["report", "printed", "values", "written"]),
    row("show", &["p.plan.json"], &["report", "written"]),
    row("export", &["p.plan.json", "--to", "csv"], &["report", "written"]),
    row("plan", &["p.plan.json"], &["report", "printed"]),
    row("study", &["s.mod"], &["report", "written", "study"]),
    row("study", &["s.mod", "--status"], &["report", "study"]),
    row("study", &["s.mod", "--row", "1"], &["report", "printed", "written", "study"]),
    row("what", &["a.mod", "Driver1"], &["report", "robot"]),
    row("doc", &["--only"], &["report", "written", "broken_links"]),
    row("fmt", &["--check", "a.mod"], &["report", "written"]),
    row("explain", &["E0301"], &["code", "title", "page"]),
    row("explain", &[], &["codes"]),
    row("-e", &["1mm + 2mm"], &["report", "printed", "values", "written"]),
    wrong("watch", &["-"]),
    wrong("run", &["nothing.mod"]),
    wrong("verify", &["nothing.plan.json"]),
    wrong("simulate", &["nothing.plan.json"]),
    wrong("export", &["nothing.plan.json", "--to", "csv"]),
    wrong("plan", &["nothing.plan.json"]),
    wrong("study", &["a.mod"]),
    wrong("import", &["nothing.urdf"]),
    wrong("new", &["a.mod"]),
    wrong("explain", &["E9999"]),
    // The command line can't be read.
    wrong("check", &[]),
    wrong("run", &["a.mod", "--sed", "7"]),
    wrong("rnu", &["a.mod"]),
    // These have no answer in JSON.
    wrong("repl", &[]),
    wrong("completions", &["bash"]),
];

const PROGRAM: &str = "use std.smores.Smores\nlet a = 3mm\nprint(a)\ntest \"t\" { expect a == 3mm }\n";
const PLANNED: &str = "use std.smores.Smores\nconfig R {\n  part m: Smores\n  behavior go = move(m.left, to: 90deg)\n}\n\
                       emit(R().go(), \"p.plan.json\")\n";

/// A project with a program and a plan file.
fn project() -> Sandbox {
    let sandbox = Sandbox::new(&[
        ("a.mod", PROGRAM.as_bytes()),
        ("s.mod", b"record Row { y: Int }\nstudy s(x in 0..3) by grid() = Row(y: x)\n"),
        ("q.mod", PLANNED.as_bytes()),
        ("plans/b.mod", PLANNED.as_bytes()),
    ]);
    let made = sandbox.run(&["run", "plans/b.mod", "--out", "."]);
    assert_eq!(made.code, 0, "{}", made.err);
    std::fs::remove_dir_all(sandbox.path("plans")).expect("a folder of the test");
    sandbox
}

/// The commands that `modl --help` lists.
fn listed(help: &str) -> Vec<String> {
    let commands = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next());
    let lines = commands.expect("the help lists commands").lines();
    lines.filter_map(|line| line.split_whitespace().next().map(str::to_owned)).collect()
}

#[test]
fn every_command_answers_in_json_wherever_the_option_stands_or_says_why_not() {
    let sandbox = project();
    let documented = include_str!("../../docs/json.md");
    for Row { command, arguments, code, fields } in ANSWERS {
        let words: Vec<&str> = std::iter::once(command).chain(*arguments).copied().collect();
        let places = [[&["--json"], &words[..]].concat(), [&words[..], &["--json"]].concat()];
        let answers = places.map(|words| {
            let ran = sandbox.run(&words);
            assert_eq!((ran.code, ran.err.as_str()), (*code, ""), "{words:?}\n{}", ran.out);
            json(&ran)
        });
        assert_eq!(answers[0], answers[1], "{words:?}: before and behind the command");
        let Value::Object(answer) = &answers[0] else { panic!("{words:?} prints no object") };
        assert_eq!(answer["ok"], *code == 0, "{words:?}");
        let mut wanted: Vec<&str> = fields.iter().filter(|field| **field != "report").copied().collect();
        wanted.extend(REPORT.iter().filter(|_| fields.contains(&"report")));
        wanted.push("ok");
        wanted.sort_unstable();
        let mut found: Vec<&str> = answer.keys().map(String::as_str).collect();
        found.sort_unstable();
        assert_eq!(found, wanted, "{words:?}");
        for field in found {
            assert!(documented.contains(&format!("`{field}`")), "docs/json.md does not tell of `{field}`");
        }
    }
    // A project that was made stays, so that these can't be asked twice.
    for words in [["--json", "new", "p"], ["new", "q", "--json"]] {
        let answer = json(&sandbox.run(&words));
        assert_eq!((&answer["ok"], answer.as_object().map(serde_json::Map::len)), (&true.into(), Some(2)));
        assert!(answer["written"][0].as_str().is_some_and(|path| path.ends_with("main.mod")), "{answer}");
    }
}

#[test]
fn help_offers_json_to_the_commands_that_have_it() {
    let sandbox = Sandbox::new(&[]);
    let help = sandbox.run(&["--help"]).out;
    assert!(help.contains("--json"));
    let commands = listed(&help);
    assert!(commands.len() > 10, "{commands:?}");
    for command in commands.iter().filter(|command| *command != "help") {
        let rows: Vec<&Row> = ANSWERS.iter().filter(|row| row.command == command).collect();
        assert!(
            !rows.is_empty() || ["new", "lsp"].contains(&command.as_str()),
            "`{command}` is not in the table"
        );
        let has = !["repl", "completions", "lsp"].contains(&command.as_str());
        let help = sandbox.run(&[command, "--help"]).out;
        assert_eq!(help.contains("--json\n"), has, "{command}\n{help}");
        // Other global options stand everywhere.
        assert!(help.contains("--max-steps"), "{command}");
    }
    let refused = json(&sandbox.run(&["repl", "--json"]));
    let why = refused["call_error"].as_str().expect("a reason");
    assert!(why.contains("modl -e EXPR --json"), "{why}");
}

#[test]
fn global_options_stand_before_a_command_too() {
    let sandbox = Sandbox::new(&[("a.mod", b"record A { x: Length }\nsave([A(x: 1m)], \"a.csv\")\n")]);
    let ran = sandbox.run(&["--out", "kept", "--json", "run", "a.mod", "--seed", "3"]);
    assert_eq!(ran.code, 0, "{}", ran.out);
    assert_eq!(
        json(&ran)["written"][0],
        std::path::Path::new("kept").join("a.csv").to_string_lossy().as_ref()
    );
    let both = sandbox.run(&["-e", "1", "run", "a.mod"]);
    assert_eq!((both.code, both.err.as_str()), (2, "modl: `-e` stands alone, without a command\n"));
}

#[test]
fn questions_tell_their_errors_and_files_in_json() {
    let sandbox = Sandbox::new(&[]);
    let answer =
        json(&sandbox.run(&["-e", "let a = 2mm", "-e", "3 * a", "-e", "1m + 1s", "-e", "4", "--json"]));
    assert_eq!((&answer["ok"], &answer["errors"]), (&false.into(), &1.into()));
    assert_eq!(answer["diagnostics"][0]["code"], "E0201");
    assert_eq!(answer["printed"], object!(["6mm"]));
}

/// The answer of `modl run --json` to a program without mistakes.
fn answer(program: &str) -> Value {
    let sandbox = Sandbox::new(&[("a.mod", program.as_bytes())]);
    let ran = sandbox.run(&["run", "--json", "a.mod"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{}", ran.out);
    json(&ran)
}

/// The values that a program prints, without text and line.
fn values(program: &str) -> Vec<Value> {
    let answer = answer(program);
    answer["values"].as_array().expect("a list").iter().map(|entry| entry["value"].clone()).collect()
}

#[test]
fn the_documented_values_are_those_that_are_printed() {
    let page = include_str!("../../docs/json.md");
    let section = page.split("## Printed values").nth(1).expect("the section");
    let all = fences(section.split("\n## ").next().unwrap_or(section), "docs/json.md");
    let [program, wanted] = all.as_slice() else { panic!("a program and its values") };
    assert_eq!((program.tag.as_str(), wanted.tag.as_str()), ("modl", "json"));
    let wanted: Value = serde_json::from_str(&wanted.code).expect("JSON");
    assert_eq!(answer(&program.code)["values"], wanted);
}

#[test]
fn printed_values_are_told_by_their_kind_in_si_units() {
    let length = |x: f64| object!({ "number": x, "unit": "m", "dimension": "Length" });
    for (written, wanted) in [
        ("3", object!({ "number": 3 })),
        ("-2.5", object!({ "number": -2.5 })),
        ("76mm", length(0.076)),
        ("180deg", object!({ "number": std::f64::consts::PI, "unit": "rad", "dimension": "Angle" })),
        ("3N*m", object!({ "number": 3.0, "unit": "kg*m^2/s^2", "dimension": "Torque" })),
        ("3J", object!({ "number": 3.0, "unit": "kg*m^2/s^2", "dimension": "Energy" })),
        ("2kg*m^2", object!({ "number": 2.0, "unit": "kg*m^2", "dimension": "Quantity<kg*m^2>" })),
        ("2rad/s * 500mm", object!({ "number": 1.0, "unit": "m/s", "dimension": "Speed" })),
        ("2^64", object!({ "number": 18446744073709551616.0, "digits": "18446744073709551616" })),
        ("1 == 1", object!({ "bool": true })),
        ("\"a\\nb\"", object!({ "text": "a\nb" })),
        ("[1m, 20mm]", object!({ "list": [length(1.0), length(0.02)] })),
        ("[[1], []]", object!({ "list": [{ "list": [{ "number": 1 }] }, { "list": [] }] })),
        ("Z", object!({ "vector": [0.0, 0.0, 1.0] })),
        ("2m * Y", object!({ "vector": [0.0, 2.0, 0.0], "unit": "m", "dimension": "Length" })),
        ("0..4", object!({ "from": { "number": 0 }, "to": { "number": 4 } })),
        ("0m..1m", object!({ "from": length(0.0), "to": length(1.0) })),
        ("first([1mm, 2mm])", length(0.001)),
        ("last([x for x in [1] if x > 1])", object!({ "missing": true })),
        ("ln", object!({ "shown": "the function ln" })),
    ] {
        assert_eq!(values(&format!("print({written})\n")), [wanted], "{written}");
    }
    let tall = values("print((10^400))\n").remove(0);
    assert_eq!((&tall["number"], tall["digits"].as_str().map(str::len)), (&Value::Null, Some(401)));
}

#[test]
fn printed_poses_and_margins_without_limit_are_told_by_their_kind() {
    let told = values(
        "use std.smores.Chain3\nlet c = Chain3()\nlet head = pose(c.head)\n\
         print(head, position(head), pose(c.m[1]))\n\
         print(verify(c, world: world(ground: off, gravity: off)).margin)\nprint(c)\n",
    );
    assert_eq!(told[0]["pose"]["p"], told[1]["vector"]);
    let q: Vec<f64> =
        told[0]["pose"]["q"].as_array().expect("a list").iter().flat_map(Value::as_f64).collect();
    assert!(q.len() == 4 && (q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12, "{q:?}");
    // The base is where the frame is.
    assert_eq!(told[2], object!({ "pose": { "p": [0.0, 0.0, 0.0], "q": [1.0, 0.0, 0.0, 0.0] } }));
    assert_eq!(told[3], object!({ "infinite": 1, "unit": "m", "dimension": "Length" }));
    assert_eq!(told[4], object!({ "shown": "Chain3" }));
}

#[test]
fn printed_values_say_which_line_shows_them() {
    let answer = answer(
        "record A { x: Length, n: Int }\nlet as = [A(x: 1m, n: 1), A(x: 2m, n: 2)]\n\
         print(\"first\")\nprint(as)\nprint(1, 2)\nprint()\nprint(as[0] with { n: 3 })\n",
    );
    let printed: Vec<&str> =
        answer["printed"].as_array().expect("lines").iter().flat_map(Value::as_str).collect();
    assert_eq!(printed, ["first", "x [m]  n", "    1  1", "    2  2", "1 2", "", "A(x: 1m, n: 3)"]);
    let entries = answer["values"].as_array().expect("values");
    let lines: Vec<u64> = entries.iter().flat_map(|entry| entry["line"].as_u64()).collect();
    assert_eq!(lines, [0, 1, 4, 4, 6]);
    assert_eq!(entries[1]["text"], "x [m]  n\n    1  1\n    2  2");
    let n = |value: &Value| value["fields"]["n"]["number"].as_u64();
    assert_eq!(
        entries[1]["value"]["list"].as_array().map(|l| l.iter().map(n).collect()),
        Some(vec![Some(1), Some(2)])
    );
    assert_eq!((&entries[4]["value"]["record"], n(&entries[4]["value"])), (&"A".into(), Some(3)));
}

#[test]
fn values_too_many_or_too_deep_are_left_out_and_counted() {
    // The list of what was printed is bounded, and what is left out is counted.
    let told = values("let many = [i for i in 0..400_000]\nprint(many)\nprint(1)\n");
    let list = told[0]["list"].as_array().expect("a list").len();
    assert_eq!(list as u64 + told[0]["omitted"].as_u64().expect("a number"), 400_000);
    assert!((200_000..300_000).contains(&list), "{list}");
    assert_eq!(told[1], object!({ "omitted": true }));
    // A reader of JSON need not nest deeper than 128 levels, which `json` holds it to.
    let chain = "record Node { n: Int, next: Node? }\n\
                 print(reduce([i for i in 0..90], (next, n) => Node(n: n, next: next), from: Node(n: 90, next: _)))\n";
    let mut value = values(chain).remove(0);
    let mut levels = 0;
    while value["fields"]["next"] != Value::Null {
        value = value["fields"]["next"].take();
        levels += 1;
    }
    assert_eq!((levels, value), (25, object!({ "omitted": true })));
}
