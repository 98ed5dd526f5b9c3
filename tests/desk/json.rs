//! `--json`: which commands have it, before and behind them, and that what they print is documented.

use super::cli::{Sandbox, json};
use serde_json::Value;

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
    row("run", &["a.mod"], &["report", "printed", "written"]),
    row("check", &["a.mod"], &["report"]),
    row("check", &["."], &["report", "programs"]),
    row("test", &["a.mod"], &["report", "printed", "tests"]),
    row("verify", &["p.plan.json"], &["report", "plans"]),
    row("show", &["a.mod"], &["report", "printed", "written"]),
    row("show", &["p.plan.json"], &["report", "written"]),
    row("doc", &["--only"], &["report", "written", "broken_links"]),
    row("fmt", &["--check", "a.mod"], &["report", "written"]),
    row("explain", &["E0301"], &["code", "title", "page"]),
    row("explain", &[], &["codes"]),
    row("-e", &["1mm + 2mm"], &["report", "printed", "written"]),
    wrong("watch", &["-"]),
    wrong("run", &["nothing.mod"]),
    wrong("verify", &["nothing.plan.json"]),
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
    let sandbox = Sandbox::new(&[("a.mod", PROGRAM.as_bytes()), ("plans/b.mod", PLANNED.as_bytes())]);
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
    // What is made is there, so these can't be asked twice.
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
        assert!(!rows.is_empty() || command == "new", "`{command}` is not in the table");
        let has = !["repl", "completions"].contains(&command.as_str());
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
    assert_eq!(answer["printed"], serde_json::json!(["6mm"]));
}
