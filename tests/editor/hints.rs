//! Hints that an editor shows between the words of a text.

use super::client::{Client, uri};
use serde_json::{Value, json};

/// The hints of a text, as (name, what stands behind it).
fn inlays(editor: &mut Client, text: &str) -> Vec<(String, String)> {
    editor.open("main.mod", text);
    hints_in(editor, text).into_iter().filter(|(label, _)| !label.starts_with("= ")).collect()
}

/// The hints of a text that is open.
fn hints_in(editor: &mut Client, text: &str) -> Vec<(String, String)> {
    let end = json!({ "line": text.lines().count(), "character": 0 });
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": end });
    let found = editor
        .ask("textDocument/inlayHint", json!({ "textDocument": { "uri": uri("main.mod") }, "range": range }));
    let one = |hint: &Value| {
        let place = &hint["position"];
        let line = text.lines().nth(place["line"].as_u64().expect("a number") as usize).expect("a line");
        let rest: String =
            line.chars().skip(place["character"].as_u64().expect("a number") as usize).collect();
        (hint["label"].as_str().expect("a name").to_owned(), rest)
    };
    found.as_array().expect("a list").iter().map(one).collect()
}

#[test]
fn arguments_without_a_name_are_told_their_parameters() {
    let mut editor = Client::new(&[]);
    let text = "fn area(width: Length, height: Length = 2m, parts: Length...) = width * height
let height = 3m
print(area(1m, 4m))
print(area(1m, height), area(width: 1m, 5m), area(6m))
print(area(1m, 2m, 3m, 4m))
";
    let wanted = [
        ("width:", "1m, 4m))"),
        ("height:", "4m))"),
        // `height` says so itself, names that are given are there, and one argument alone is plain, but for what it leaves out.
        ("width:", "1m, height), area(width: 1m, 5m), area(6m))"),
        ("height:", "5m), area(6m))"),
        (", height: 2m", "))"),
        ("width:", "1m, 2m, 3m, 4m))"),
        ("height:", "2m, 3m, 4m))"),
    ];
    let wanted: Vec<(String, String)> =
        wanted.map(|(name, rest)| (name.to_owned(), rest.to_owned())).to_vec();
    assert_eq!(inlays(&mut editor, text), wanted);
    // Texts that can't be read have none.
    assert_eq!(inlays(&mut editor, "print(area(1m, "), []);
}

#[test]
fn defaults_stand_where_arguments_are_left_out() {
    let mut editor = Client::new(&[]);
    let text = "use std.smores.Chain3
config Pair(gap: Angle = 10deg, n: Int = 2) {
  part a: Chain3
}
let one = Pair()
let two = Pair(20deg)
let all = Pair(20deg, n: 3)
";
    let wanted = [("gap: 10deg, n: 2", ")"), (", n: 2", ")"), ("gap:", "20deg, n: 3)")];
    let wanted: Vec<(String, String)> =
        wanted.map(|(label, rest)| (label.to_owned(), rest.to_owned())).to_vec();
    assert_eq!(inlays(&mut editor, text), wanted);
}

#[test]
fn values_have_their_units_and_types_behind_them() {
    let mut editor = Client::with(&[], json!({ "workspace": { "inlayHint": { "refreshSupport": true } } }));
    let text = "let side = 40mm
let reach = 3 * side
let speed = (reach / 2s)
let count = 3 + 4
let spans = [side, reach]
fn twice(a: Length) = {
  let b = a + a
  b
}
let bend = -30deg
let told: Length = side + reach
";
    editor.open("main.mod", text);
    // The values are there when the server says so.
    editor.awaits("workspace/inlayHint/refresh");
    let found = hints_in(&mut editor, text);
    let wanted = [
        (": Length", " = 3 * side"),
        ("= 120mm", ""),
        (": Speed", " = (reach / 2s)"),
        ("= 60mm/s", ""),
        ("= 7", ""),
        (": List<Length>", " = [side, reach]"),
        (": Length", " = a + a"),
        ("= 160mm", ""),
    ];
    let wanted: Vec<(String, String)> =
        wanted.map(|(label, rest)| (label.to_owned(), rest.to_owned())).to_vec();
    assert_eq!(found, wanted);
}
