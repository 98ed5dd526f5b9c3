//! Conversations of an editor with the language server: one message a line, in JSON; some of them make no sense.

use super::corpus::{CORPUS, is_quick, text};
use super::damage::damaged;
use super::dice::Dice;
use super::json::Altered;
use super::programs;
use serde_json::{Value, json};

/// The requests about a place.
const AT: &[&str] = &["hover", "definition", "references", "completion", "signatureHelp", "rename"];
/// The requests about a document.
const OF: &[&str] = &[
    "documentSymbol",
    "formatting",
    "foldingRange",
    "semanticTokens/full",
    "inlayHint",
    "codeAction",
    "codeLens",
    "nonsense",
];

/// Returns a conversation, without the greeting at its beginning and the farewell at its end.
pub fn conversation(dice: &mut Dice) -> Vec<u8> {
    let mut lines = String::new();
    let mut say = |message: Value| {
        lines.push_str(&message.to_string());
        lines.push('\n');
    };
    let names = ["main.mod", "other.mod", "hinge.mod"];
    let mut opened = 0;
    for id in 0..1 + dice.below(10) {
        let uri = format!("file:///p/{}", dice.of(&names));
        let message = match dice.below(10) {
            _ if opened == 0 => {
                opened += 1;
                open("file:///p/main.mod", dice)
            }
            0 => open(&uri, dice),
            1..4 => change(&uri, id, dice),
            4 => json!({ "method": "textDocument/didClose", "params": { "textDocument": { "uri": uri } } }),
            5 | 6 => {
                let params = json!({
                    "textDocument": { "uri": uri }, "position": place(dice), "newName": dice.of(&["a", "for", "x y", "Robot", ""]),
                });
                json!({ "id": id, "method": format!("textDocument/{}", dice.of(AT)), "params": params })
            }
            _ => {
                let params = json!({ "textDocument": { "uri": uri }, "range": range(dice), "context": { "diagnostics": [] } });
                json!({ "id": id, "method": format!("textDocument/{}", dice.of(OF)), "params": params })
            }
        };
        say(if dice.below(6) == 0 { harmed(message, dice) } else { message });
    }
    lines.into_bytes()
}

/// Returns a message of which one part is another.
fn harmed(message: Value, dice: &mut Dice) -> Value {
    let altered = Altered::new(message);
    let mut message = altered.file.clone();
    altered.alter(&mut message, dice, &["/params", "/params/position", "/params/range", ""]);
    message
}

/// Returns the text of a document, which may not mean anything; it is short, since it is checked after each change.
fn document(dice: &mut Dice) -> String {
    let whole = match dice.below(4) {
        0 => programs::program(dice),
        1 => text(dice),
        _ => CORPUS.quick[dice.below(CORPUS.quick.len())].clone(),
    };
    let whole = if dice.below(3) == 0 { damaged(dice, &whole) } else { whole };
    // The server elaborates what checks.
    if is_quick(&whole) { whole } else { "let a = 1\n".to_owned() }
}

fn open(uri: &str, dice: &mut Dice) -> Value {
    let document =
        json!({ "uri": uri, "languageId": "modl", "version": dice.below(3), "text": document(dice) });
    json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } })
}

fn place(dice: &mut Dice) -> Value {
    let odd = [u64::from(u32::MAX), 1 << 31, 1_000_000];
    let number = |dice: &mut Dice, most: usize| match dice.below(40) {
        k @ 0..3 => odd[k],
        _ => dice.below(most) as u64,
    };
    json!({ "line": number(dice, 30), "character": number(dice, 60) })
}

fn range(dice: &mut Dice) -> Value {
    json!({ "start": place(dice), "end": place(dice) })
}

fn change(uri: &str, version: usize, dice: &mut Dice) -> Value {
    let piece = |dice: &mut Dice| match dice.below(6) {
        0 => json!({ "text": document(dice) }),
        1 => json!({ "range": range(dice), "text": "" }),
        _ => json!({ "range": range(dice), "text": dice.of(super::damage::TOKENS) }),
    };
    let changes: Vec<Value> = (0..1 + dice.below(3)).map(|_| piece(dice)).collect();
    let document = json!({ "uri": uri, "version": version });
    json!({ "method": "textDocument/didChange", "params": { "textDocument": document, "contentChanges": changes } })
}
