//! Diagnostics as a program is typed.

use super::client::{Client, piece, uri};
use serde_json::json;

#[test]
fn mistakes_are_told_where_they_are_and_go_as_they_are_mended() {
    let mut editor = Client::new(&[]);
    let wrong = "use std.smores.Smores\nlet a = 1mm + 1s // é 🦾\nlet b = 2 + Smor\n";
    editor.open("main.mod", wrong);
    let found = editor.published("main.mod", |version, _| version == 1);
    let told: Vec<(&str, &str)> =
        found.iter().map(|d| (d["code"].as_str().expect("a code"), piece(wrong, &d["range"]))).collect();
    assert_eq!(told, [("E0201", "+"), ("E0101", "Smor")]);
    assert!(found[1]["message"].as_str().is_some_and(|words| words.contains("`Smores`?")), "{found:#?}");
    let all = json!([{ "text": "let a = 1mm + 1m\n" }]);
    let version = editor.change("main.mod", all);
    assert_eq!(editor.published("main.mod", |v, _| v == version), Vec::<serde_json::Value>::new());
    assert!(editor.end());
}

#[test]
fn what_depends_on_values_is_told_after_it() {
    let mut editor = Client::new(&[]);
    let taken = "use std.smores.Smores\nconfig C {\n  part m[3]: Smores\n  connect m[0].top -- m[1].bottom\n  \
        connect m[0].top -- m[2].bottom\n}\n";
    editor.open("main.mod", taken);
    // The types are sound, so that nothing is found at first.
    assert!(editor.published("main.mod", |_, _| true).is_empty());
    let found = editor.published("main.mod", |_, found| !found.is_empty());
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0]["code"], "E0301");
    assert_eq!(found[0]["relatedInformation"][0]["location"]["uri"], uri("main.mod"));
}

#[test]
fn open_documents_stand_for_their_files() {
    let mut editor = Client::new(&[("parts.mod", "let width = 1mm\n")]);
    editor.open("main.mod", "use \"parts.mod\".{width}\nlet twice = 2 * width + 1m\n");
    assert!(editor.published("main.mod", |_, _| true).is_empty());
    // The other document, not saved, makes it a time.
    editor.open("parts.mod", "let width = 1s\n");
    let found = editor.published("main.mod", |_, found| !found.is_empty());
    assert_eq!(found[0]["code"], "E0201");
    // A mistake in what is imported stands at the begin, with file and line.
    let version = editor.change("parts.mod", json!([{ "text": "let width = 1mm + 1s\n" }]));
    let own = editor.published("parts.mod", |v, _| v == version);
    assert_eq!(piece("let width = 1mm + 1s\n", &own[0]["range"]), "+");
    editor.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri("parts.mod") } }));
    assert!(editor.published("main.mod", |_, found| found.is_empty()).is_empty());
}

#[test]
fn codes_lead_to_their_pages() {
    let able = json!({ "textDocument": { "publishDiagnostics": { "codeDescriptionSupport": true } } });
    let mut editor = Client::with(&[], able);
    editor.open("main.mod", "let a = 1mm + 1s\n");
    let found = editor.published("main.mod", |_, _| true);
    let page = found[0]["codeDescription"]["href"].clone();
    let schemes = &editor.capabilities["workspace"]["textDocumentContent"]["schemes"];
    assert_eq!(schemes[0], page.as_str().expect("an address").split(':').next().expect("a scheme"));
    let text = editor.ask("workspace/textDocumentContent", json!({ "uri": page }))["text"].clone();
    assert_eq!(
        text.as_str(),
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/errors/E0201.md")).ok().as_deref()
    );
    assert!(
        editor.try_to("workspace/textDocumentContent", json!({ "uri": "modl:/errors/../main.rs" })).is_err()
    );
    // Others get the code alone.
    let mut plain = Client::new(&[]);
    plain.open("main.mod", "let a = 1mm + 1s\n");
    assert!(plain.published("main.mod", |_, _| true)[0].get("codeDescription").is_none());
}

#[test]
fn files_that_change_on_disk_are_read_again() {
    let mut editor = Client::new(&[("parts.mod", "let width = 1mm\n")]);
    editor.open("main.mod", "use \"parts.mod\".{width}\nlet twice = 2 * width + 1m\n");
    assert!(editor.published("main.mod", |_, _| true).is_empty());
    editor.writes("parts.mod", "let width = 1s\n");
    let changes = json!({ "changes": [{ "uri": uri("parts.mod"), "type": 2 }] });
    editor.tell("workspace/didChangeWatchedFiles", changes);
    assert_eq!(editor.published("main.mod", |_, _| true)[0]["code"], "E0201");
}
