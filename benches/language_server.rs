//! The time for which an editor waits: `cargo bench --bench language_server`. In a program of 1,000 lines a key is typed, as the
//! protocol says it; then the diagnostics of its types have come, candidates after a dot are asked for, and an explanation.

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

fn main() {
    let mut editor = Client::new(&[]);
    let text = format!(
        "{}\nuse std.smores.Walk4\nlet robot = Walk4()\nlet typed = robot.\n",
        generate::program(LINES)
    );
    let end = text.matches('\n').count() - 1;
    editor.open("main.mod", &text);
    let (mut told, mut offered, mut explained) = (Vec::new(), Vec::new(), Vec::new());
    for key in 0..KEYS {
        let column = "let typed = robot.".len();
        let place = |column: usize| json!({ "line": end, "character": column });
        // A letter comes, and goes again.
        let (from, to, typed) = if key % 2 == 0 { (column, column, "w") } else { (column, column + 1, "") };
        let range = json!({ "start": place(from), "end": place(to) });
        let begin = Instant::now();
        let version = editor.change("main.mod", json!([{ "range": range, "text": typed }]));
        editor.published("main.mod", |v, _| v == version);
        told.push(begin.elapsed());
        let at =
            json!({ "textDocument": { "uri": uri("main.mod") }, "position": place(column + typed.len()) });
        let begin = Instant::now();
        let found = editor.ask("textDocument/completion", at);
        offered.push(begin.elapsed());
        assert!(
            found.as_array().is_some_and(|found| found.iter().any(|item| item["label"] == "walk")),
            "{found}"
        );
        let at =
            json!({ "textDocument": { "uri": uri("main.mod") }, "position": place("let typed = rob".len()) });
        let begin = Instant::now();
        editor.ask("textDocument/hover", at);
        explained.push(begin.elapsed());
    }
    report("a key to diagnostics", told);
    report("candidates after a dot", offered);
    report("hover", explained);
}

fn report(what: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize].as_secs_f64() * 1e3;
    println!("{what:<24} median {:5.1} ms, 95 % below {:5.1} ms", at(0.5), at(0.95));
}
