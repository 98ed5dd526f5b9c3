//! Verdicts beside the text.

use super::client::{Client, piece, uri};
use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// A program with a behaviour that is sound, one that makes the chain meet itself, one that needs an argument, and a plan.
const PROGRAM: &str = "use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior lift(a: Angle = 20deg) = c.half_wave(a)
  behavior curl = Pc([move(x.tilt, to: 90deg) for x in c.m])
  behavior bend(a: Angle) = c.half_wave(a)
}
let worm = Worm()
emit(worm.lift(10deg), \"worm.plan.json\")
";

/// The lenses that verify, as (what they stand at, their argument, their words).
fn lenses(editor: &mut Client, text: &str) -> Vec<(String, String, String)> {
    let found = editor.ask("textDocument/codeLens", json!({ "textDocument": { "uri": uri("main.mod") } }));
    let verifies = |lens: &&Value| lens["command"]["command"] == "modl.verify";
    let one = |lens: &Value| {
        let command = &lens["command"];
        let argument = command["arguments"][1].as_str().unwrap_or_default().to_owned();
        let title = command["title"].as_str().expect("words").to_owned();
        (piece(text, &lens["range"]).to_owned(), argument, title)
    };
    found.as_array().expect("a list").iter().filter(verifies).map(one).collect()
}

fn of(at: &str, argument: &str, title: &str) -> (String, String, String) {
    (at.to_owned(), argument.to_owned(), title.to_owned())
}

fn verify(target: Option<&str>) -> Value {
    let arguments: Vec<String> =
        [Some(uri("main.mod")), target.map(str::to_owned)].into_iter().flatten().collect();
    json!({ "command": "modl.verify", "arguments": arguments })
}

fn able() -> Value {
    json!({ "workspace": { "codeLens": { "refreshSupport": true } } })
}

/// The least margin of loads of a plan, in percent with one decimal, as the program itself prints it.
fn margin(plan: &str) -> String {
    let lines = PROGRAM.lines().filter(|line| !line.starts_with("emit")).collect::<Vec<_>>().join("\n");
    let text = format!("{lines}\nlet r = verify({plan})\nprint(r.torque_margin)\nprint(r.bond_margin)\n");
    let (observed, ..) = desk::run(&MapFiles::of(&text), Mode::Run);
    let number = |line: &String| if line == "infinite" { Ok(f64::INFINITY) } else { line.parse::<f64>() };
    let numbers = observed.printed.iter().map(|line| number(line).expect("a number"));
    let [torque, bond] = numbers.collect::<Vec<_>>()[..] else { panic!("{:?}", observed.diagnostics) };
    let (least, name) = if torque < bond { (torque, "torque") } else { (bond, "bond") };
    format!("least margin {} % ({name})", (1000.0 * least).round() / 10.0)
}

#[test]
fn a_behaviour_is_verified_and_its_margin_stands_beside_it() {
    let mut editor = Client::with(&[], able());
    editor.open("main.mod", PROGRAM);
    // `bend` needs an argument.
    let wanted =
        [of("lift", "Worm.lift", "Verify"), of("curl", "Worm.curl", "Verify"), of("emit", "", "Verify")];
    assert_eq!(lenses(&mut editor, PROGRAM), wanted);
    let said = editor.ask("workspace/executeCommand", verify(Some("Worm.lift")));
    editor.awaits("workspace/codeLens/refresh");
    let lift = format!("✓ verified under full dynamics, {}", margin("plan(worm.lift())"));
    assert_eq!(said, lift);
    let wanted =
        [of("lift", "Worm.lift", &lift), of("curl", "Worm.curl", "Verify"), of("emit", "", "Verify")];
    assert_eq!(lenses(&mut editor, PROGRAM), wanted);
    // The program: its plan.
    let emitted = format!("✓ verified under full dynamics, {}", margin("plan(worm.lift(10deg))"));
    assert_eq!(editor.ask("workspace/executeCommand", verify(None)), emitted);
    let wanted =
        [of("lift", "Worm.lift", &lift), of("curl", "Worm.curl", "Verify"), of("emit", "", &emitted)];
    assert_eq!(lenses(&mut editor, PROGRAM), wanted);
    // Another text has no verdict yet.
    editor.change("main.mod", json!([{ "text": PROGRAM.replace("20deg", "25deg") }]));
    assert!(lenses(&mut editor, PROGRAM).iter().all(|(_, _, title)| title == "Verify"));
    // A save verifies again what was verified.
    editor.tell("textDocument/didSave", json!({ "textDocument": { "uri": uri("main.mod") } }));
    let known = |editor: &mut Client| {
        let found = lenses(editor, PROGRAM);
        found.iter().filter(|(_, _, title)| title.starts_with('✓')).count() == 2
    };
    let begin = Instant::now();
    while !known(&mut editor) {
        assert!(begin.elapsed() < Duration::from_secs(60), "{:?}", lenses(&mut editor, PROGRAM));
        editor.awaits("workspace/codeLens/refresh");
    }
    assert!(editor.end());
}

#[test]
fn a_failure_is_told_beside_the_text_and_as_a_diagnostic() {
    let mut editor = Client::with(&[], able());
    editor.open("main.mod", PROGRAM);
    let said = editor.ask("workspace/executeCommand", verify(Some("Worm.curl")));
    let words = said.as_str().expect("words");
    assert!(words.starts_with("✗ not verified: at "), "{words}");
    assert!(lenses(&mut editor, PROGRAM).contains(&of("curl", "Worm.curl", words)));
    editor.change("main.mod", json!([{ "text": PROGRAM.replace("90deg", "89deg") }]));
    let asked = editor.begin("workspace/executeCommand", verify(Some("Worm.curl")));
    let found = editor.published("main.mod", |version, found| version == 2 && !found.is_empty());
    assert!(editor.answer(asked).is_ok_and(|said| said.as_str().is_some_and(|said| said.starts_with('✗'))));
    assert!(found[0]["code"].as_str().is_some_and(|code| code.starts_with("E06")), "{found:#?}");
    assert!(piece(PROGRAM, &found[0]["range"]).contains("move("), "{found:#?}");
    // The next change takes it away.
    let version = editor.change("main.mod", json!([{ "text": PROGRAM }]));
    assert!(editor.published("main.mod", |v, _| v == version).is_empty());
}

#[test]
fn a_change_cancels_what_is_verified() {
    let mut editor = Client::with(&[], able());
    // A million samples, which take minutes.
    let slow = PROGRAM.replace("\"worm.plan.json\"", "\"worm.plan.json\", sample: 0.000001s");
    editor.open("main.mod", &slow);
    let asked = editor.begin("workspace/executeCommand", verify(None));
    editor.awaits("workspace/codeLens/refresh");
    assert!(lenses(&mut editor, &slow).contains(&of("emit", "", "verifying …")));
    // A second question does not verify twice.
    assert_eq!(editor.ask("workspace/executeCommand", verify(None)), Value::Null);
    // Other questions are answered meanwhile.
    editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri("main.mod") } }));
    let begin = Instant::now();
    editor.change("main.mod", json!([{ "text": format!("{slow}// more\n") }]));
    assert_eq!(editor.answer(asked), Ok(Value::Null));
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
    assert!(lenses(&mut editor, &slow).contains(&of("emit", "", "Verify")));
    // The editor itself may cancel, too.
    let asked = editor.begin("workspace/executeCommand", verify(None));
    editor.tell("$/cancelRequest", json!({ "id": asked }));
    assert_eq!(editor.answer(asked), Ok(Value::Null));
    assert!(editor.end());
}

#[test]
fn what_can_not_be_verified_is_refused() {
    let mut editor = Client::new(&[]);
    editor.open("main.mod", &format!("{PROGRAM}let wrong = 1mm + 1s\n"));
    let refused = editor.try_to("workspace/executeCommand", verify(None));
    assert!(refused.as_ref().is_err_and(|said| said.contains("errors")), "{refused:?}");
    assert_eq!(lenses(&mut editor, PROGRAM), []);
    editor.change("main.mod", json!([{ "text": PROGRAM }]));
    for (arguments, words) in [
        (json!({ "command": "modl.fly" }), "no command"),
        (json!({ "command": "modl.verify", "arguments": [uri("other.mod")] }), "not open"),
        (json!({ "command": "modl.verify", "arguments": [uri("main.mod"), "lift"] }), "Walker.walk"),
    ] {
        let refused = editor.try_to("workspace/executeCommand", arguments);
        assert!(refused.as_ref().is_err_and(|said| said.contains(words)), "{words}: {refused:?}");
    }
    // A behaviour that is not there has no verdict.
    assert_eq!(editor.ask("workspace/executeCommand", verify(Some("Worm.fly"))), Value::Null);
}
