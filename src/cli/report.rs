//! What a command found, as text or as one JSON object (`docs/json.md`).

use super::arguments::{Color, Globals};
use super::terminal::{print, print_error};
use crate::plan::Verdict;
use crate::source::json::{JsonDiagnostic, to_json};
use crate::source::render::{Style, render_one, sorted};
use crate::source::{Diagnostic, Severity, Sources};
use serde::Serialize;
use std::collections::HashSet;
use std::io::{IsTerminal, stderr};

/// Columns where no terminal says how many there are.
const WIDTH_DEFAULT: usize = 100;

/// Diagnostics put into one JSON object at most; the rest are counted.
const JSON_DIAGNOSTICS_MAX: usize = 10_000;

/// What a command found. The fields are the JSON object.
#[derive(Debug, Default, Serialize)]
pub(super) struct Report {
    /// Whether the exit code is 0.
    pub ok: bool,
    pub diagnostics: Vec<JsonDiagnostic>,
    /// Diagnostics left out because there were too many.
    pub omitted: usize,
    pub errors: usize,
    pub warnings: usize,
    /// Lines that the program printed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub printed: Option<Vec<String>>,
    /// Files written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tests: Option<Vec<JsonTest>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plans: Option<Vec<JsonPlan>>,
    #[serde(skip)]
    seen: HashSet<String>,
}

#[derive(Debug, Serialize)]
pub(super) struct JsonTest {
    pub file: String,
    pub name: String,
    pub passed: bool,
}

#[derive(Debug, Serialize)]
pub(super) struct JsonPlan {
    pub file: String,
    pub ok: bool,
    pub verdict: Verdict,
}

impl Report {
    /// Takes diagnostics in: kept for the JSON object, or printed at once. What was reported for
    /// another file of the same call already, such as a shared import, is not repeated.
    pub(super) fn add(
        &mut self,
        sources: &Sources,
        diagnostics: &[Diagnostic],
        style: &Style,
        globals: &Globals,
    ) {
        let mut hidden = 0;
        for diagnostic in sorted(diagnostics) {
            let json = to_json(sources, std::slice::from_ref(diagnostic), style).remove(0);
            if !self.seen.insert(format!("{json:?}")) {
                continue;
            }
            match diagnostic.severity {
                Severity::Error => self.errors += 1,
                Severity::Warning => self.warnings += 1,
                Severity::Note => {}
            }
            if globals.json {
                if self.diagnostics.len() < JSON_DIAGNOSTICS_MAX {
                    self.diagnostics.push(json);
                } else {
                    self.omitted += 1;
                }
            } else if self.seen.len() <= style.shown_max {
                print_error(&format!("{}\n", render_one(sources, diagnostic, style)));
            } else {
                hidden += 1;
            }
        }
        if hidden > 0 {
            print_error(&format!("... and {hidden} more; `--json` lists them all\n\n"));
        }
    }

    /// Ends the report: prints the JSON object, or how many mistakes there are.
    pub(super) fn finish(&mut self, ok: bool, globals: &Globals) {
        self.ok = ok;
        if globals.json {
            let text = serde_json::to_string_pretty(self).expect("a report is plain data");
            print(&format!("{text}\n"));
        } else if self.errors + self.warnings > 0 {
            let parts =
                [(self.errors, "error"), (self.warnings, "warning")].map(|(n, word)| counted(n, word));
            let parts: Vec<String> = parts.into_iter().flatten().collect();
            print_error(&format!("{}\n", parts.join(", ")));
        }
    }
}

/// "2 errors"; nothing for none.
fn counted(n: usize, word: &str) -> Option<String> {
    (n > 0).then(|| format!("{n} {word}{}", if n == 1 { "" } else { "s" }))
}

/// Tells that the call is wrong.
pub(super) fn call_error(globals: &Globals, message: &str) {
    if globals.json {
        let object = serde_json::json!({ "ok": false, "call_error": message });
        print(&format!("{object:#}\n"));
    } else {
        print_error(&format!("modl: {message}\n"));
    }
}

/// How diagnostics are drawn on this terminal.
pub(super) fn style(globals: &Globals, folder: &str) -> Style {
    Style { width: width(), color: color(globals.color), folder: folder.to_owned(), ..Style::default() }
}

pub(super) fn width() -> usize {
    let columns = || std::env::var("COLUMNS").ok()?.parse().ok();
    match terminal_size::terminal_size_of(stderr()) {
        Some((terminal_size::Width(columns), _)) => columns.into(),
        None => columns().unwrap_or(WIDTH_DEFAULT),
    }
}

pub(super) fn color(wish: Color) -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    match wish {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => {
            let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
            stderr().is_terminal() && !set("NO_COLOR") && !dumb
        }
    }
}
