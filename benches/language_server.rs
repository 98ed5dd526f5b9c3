//! The time for which an editor waits: `cargo bench --bench language_server`. In a program of 1,000 lines keys are typed, as the
//! protocol says it, and the time counts from the key on: to the diagnostics of its types, and to candidates that are asked for at
//! once behind a dot, for a word, and within a call. Then what is asked of a text at rest: an explanation, hints, lenses.

mod generate;
#[allow(dead_code)]
#[path = "../tests/support"]
mod support {
    pub mod suite;
}
#[allow(dead_code)]
#[path = "../tests/editor/client.rs"]
mod client;

use client::{Client, uri};
use serde_json::json;
use std::time::{Duration, Instant};

/// As in the command.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const LINES: usize = 1_000;
const KEYS: usize = 200;

/// The time between two keys of somebody who types fast.
const PAUSE: Duration = Duration::from_millis(100);

fn main() {
    let mut editor = Client::new(&[]);
    let text = format!(
        "{}\nuse std.smores.Walk4\nlet robot = Walk4()\nlet typed = robot.\n",
        generate::program(LINES)
    );
    let end = text.matches('\n').count() - 1;
    editor.open("main.mod", &text);
    let document = json!({ "uri": uri("main.mod") });
    let type_key = |editor: &mut Client, before: &str, from: usize, to: usize, typed: &str| {
        let place = |column: usize| json!({ "line": end, "character": column });
        let range = json!({ "start": place(before.len() + from), "end": place(before.len() + to) });
        editor.change("main.mod", json!([{ "range": range, "text": typed }]))
    };
    let typed = "let typed = robot.";
    let mut told = Vec::new();
    for key in 0..KEYS {
        // A letter comes, and goes again.
        let (to, letter) = if key % 2 == 0 { (0, "w") } else { (1, "") };
        let begin = Instant::now();
        let version = type_key(&mut editor, typed, 0, to, letter);
        editor.published("main.mod", |v, _| v == version);
        told.push(begin.elapsed());
    }
    report("a key to diagnostics", told);
    // Each case is a line that is typed to its end, and the candidate that has to be there then.
    for (what, line, wanted) in [
        ("a key to members", "let typed = robot.w", "walk"),
        ("a key to names", "let typed = rob", "robot"),
        ("a key to parameters", "let typed = robot.walk(", "steps:"),
        ("a key to units", "let typed = 5m", "mm"),
    ] {
        let before = &line[..line.len() - 1];
        let mut offered = Vec::new();
        for _ in 0..KEYS / 2 {
            type_line(&mut editor, end, before);
            std::thread::park_timeout(PAUSE);
            let begin = Instant::now();
            type_key(&mut editor, before, 0, 0, &line[line.len() - 1..]);
            let place = json!({ "line": end, "character": line.len() });
            let found =
                editor.ask("textDocument/completion", json!({ "textDocument": document, "position": place }));
            offered.push(begin.elapsed());
            let there = |item: &serde_json::Value| item["label"] == wanted;
            assert!(found.as_array().is_some_and(|found| found.iter().any(there)), "{wanted}: {found}");
        }
        report(what, offered);
    }
    let place = json!({ "line": end - 1, "character": "let rob".len() });
    let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": end, "character": 0 } });
    for (what, method, more) in [
        ("hover", "hover", json!({ "position": place })),
        ("semantic tokens", "semanticTokens/full", json!({})),
        ("inlay hints of all lines", "inlayHint", json!({ "range": whole })),
        ("code lenses", "codeLens", json!({})),
        ("symbols", "documentSymbol", json!({})),
    ] {
        let mut asked = Vec::new();
        let mut params = more.clone();
        params["textDocument"] = document.clone();
        for _ in 0..KEYS / 4 {
            let begin = Instant::now();
            editor.ask(&format!("textDocument/{method}"), params.clone());
            asked.push(begin.elapsed());
        }
        report(what, asked);
    }
}

/// Writes the last line anew.
fn type_line(editor: &mut Client, line: usize, text: &str) {
    let range =
        json!({ "start": { "line": line, "character": 0 }, "end": { "line": line, "character": 1_000 } });
    editor.change("main.mod", json!([{ "range": range, "text": text }]));
}

fn report(what: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize].as_secs_f64() * 1e3;
    println!("{what:<24} median {:5.1} ms, 95 % below {:5.1} ms", at(0.5), at(0.95));
}
