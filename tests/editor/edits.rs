//! Changes of documents piece by piece, in both encodings of columns.

use super::client::{Client, uri};
use crate::support::numbers::Numbers;
use serde_json::json;

/// The pieces that are typed: characters of one to four bytes, and of one or two code units of UTF-16.
const TYPED: [&str; 8] = ["a", " ", "\n", "é", "→", "🦾", "// x\n", "\r\n"];

/// Returns line and column of an offset, the column in code units of UTF-8 or UTF-16.
fn place(text: &str, at: usize, utf8: bool) -> serde_json::Value {
    let line = text[..at].rsplit('\n').next().unwrap_or("");
    let column = if utf8 { line.len() } else { line.encode_utf16().count() };
    json!({ "line": text[..at].matches('\n').count(), "character": column })
}

#[test]
fn a_document_that_is_changed_piece_by_piece_is_the_text_of_the_editor() {
    for utf8 in [false, true] {
        let encodings = if utf8 { json!(["utf-8", "utf-16"]) } else { json!(["utf-16"]) };
        let mut editor = Client::with(&[], json!({ "general": { "positionEncodings": encodings } }));
        assert_eq!(editor.capabilities["positionEncoding"], if utf8 { "utf-8" } else { "utf-16" });
        let mut text = String::from("let a = 1 // 🦾é\n/* → */\n");
        editor.open("main.mod", &text);
        let mut numbers = Numbers(7);
        for _ in 0..200 {
            // Some changes at once, each in the text that those before it left.
            let mut changes = Vec::new();
            for _ in 0..1 + numbers.below(3) {
                let ends: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
                let mut ends = [0, 0].map(|_| ends[numbers.below(ends.len())]);
                ends.sort_unstable();
                // An end between the two characters of a line break is no place of the protocol.
                if ends.iter().any(|end| text[..*end].ends_with('\r')) {
                    continue;
                }
                if numbers.below(3) > 0 {
                    ends[1] = ends[0];
                }
                let typed = TYPED[numbers.below(TYPED.len())];
                let range =
                    json!({ "start": place(&text, ends[0], utf8), "end": place(&text, ends[1], utf8) });
                changes.push(json!({ "range": range, "text": typed }));
                text.replace_range(ends[0]..ends[1], typed);
            }
            editor.change("main.mod", json!(changes));
        }
        // The range of the whole text, as the formatter would replace it, and its comments tell the text that the server has.
        editor.change("main.mod", json!([{ "range": { "start": place(&text, text.len(), utf8), "end": place(&text, text.len(), utf8) }, "text": "\nlet  last=1\n" }]));
        text += "\nlet  last=1\n";
        let document = json!({ "textDocument": { "uri": uri("main.mod") } });
        let expected = modl::format::format(modl::source::FileId(0), &text).map(|formatted| formatted.text);
        let edits = editor.ask("textDocument/formatting", document);
        assert_eq!(edits[0]["newText"].as_str(), expected.as_deref());
        assert_eq!(edits[0]["range"]["end"], place(&text, text.len(), utf8));
    }
}
