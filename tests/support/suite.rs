//! Runs sectioned files of programs with the expected diagnostics in place.
//!
//! A file under `tests/suite/` holds cases, each behind a line `--- what it shows`. In a case a
//! comment under a line says what is expected of that line, by columns:
//!
//! ```text
//! let a = 1mm + 1s
//! //      ^^^^^^^^ E0201 words of the message, a label or a hint
//! //      ~~~      words of another label of any diagnostic
//! //<1-3 E0001 the same for columns 1 to 3, which carets can't reach
//! //! E0703 a diagnostic without a place
//! //> a line that the program prints (all of them, in order)
//! ```
//!
//! Every diagnostic must be expected, and everything expected must come. `E0201 a | b` wants both
//! pieces of text. A span of several lines is compared up to the end of its first.

use modl::source::{Diagnostic, FileId, Files, ReadError, Sources, Span};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

/// What became of a case.
pub struct Observed {
    pub sources: Sources,
    pub file: Option<FileId>,
    pub diagnostics: Vec<Diagnostic>,
    pub printed: Vec<String>,
}

/// The project of a case: the case itself as `main.mod` and what else it is given.
#[derive(Default)]
pub struct MapFiles(pub BTreeMap<String, Vec<u8>>);

impl MapFiles {
    pub fn of(main: &str) -> MapFiles {
        MapFiles(BTreeMap::from([("main.mod".to_string(), main.as_bytes().to_vec())]))
    }
}

impl Files for MapFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.0.get(path).cloned().ok_or(ReadError::NotFound)
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        modl::source::library::text(path).map(Cow::Borrowed)
    }
}

/// Runs every case of every file in `tests/suite/FOLDER` and fails with all differences.
pub fn run(folder: &str, observe: impl Fn(&str) -> Observed) {
    let mut report = String::new();
    let mut cases = 0;
    for (file, text) in files(folder) {
        for (name, line, case) in sections(&text) {
            cases += 1;
            compare(&format!("{file}:{line} {name}"), &case, &observe(&case), &mut report);
        }
    }
    assert!(cases > 0, "no cases in {folder}");
    assert!(report.is_empty(), "\n{report}");
}

/// The programs of all cases in `tests/suite/FOLDER`, for tests that change them.
pub fn programs(folder: &str) -> Vec<String> {
    let cases = files(folder).into_iter().flat_map(|(_, text)| sections(&text));
    cases.map(|(_, _, case)| case).collect()
}

/// The files of `tests/suite/FOLDER` with their names, in order.
fn files(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite").join(folder);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<_> = entries.map(|e| e.expect("a readable folder").path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "mod"));
    paths.sort();
    let read = |path: std::path::PathBuf| {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(&path).expect("a suite is UTF-8"))
    };
    paths.into_iter().map(read).collect()
}

/// Cases with their names and the lines where they begin.
fn sections(text: &str) -> Vec<(String, usize, String)> {
    let mut out: Vec<(String, usize, String)> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        if let Some(name) = line.strip_prefix("--- ") {
            out.push((name.trim().to_string(), i + 1, String::new()));
        } else if let Some((_, _, case)) = out.last_mut() {
            case.push_str(line);
            case.push('\n');
        }
    }
    out
}

#[derive(Debug)]
struct Expected {
    /// Line and columns from 1, the last included; `None`: without a place.
    at: Option<(usize, usize, usize)>,
    /// `None`: a label of any diagnostic.
    code: Option<String>,
    words: Vec<String>,
}

fn expectations(case: &str) -> (Vec<Expected>, Vec<String>) {
    let (mut out, mut printed, mut subject) = (Vec::new(), Vec::new(), 0);
    for (i, line) in case.lines().enumerate() {
        if let Some(rest) = line.strip_prefix("//>") {
            printed.push(rest.strip_prefix(' ').unwrap_or(rest).to_string());
        } else if let Some(rest) = line.strip_prefix("//! ").filter(|r| is_code(r)) {
            out.push(expected(None, rest));
        } else if let Some(rest) = line.strip_prefix("//<") {
            let (columns, rest) = rest.split_once(' ').expect("columns, then a code");
            let (from, to) = columns.split_once('-').expect("columns are written 1-3");
            let number = |s: &str| s.parse().expect("a column is a number");
            out.push(expected(Some((subject, number(from), number(to))), rest));
        } else if let Some((at, rest)) = carets(line) {
            out.push(expected(Some((subject, at.0, at.1)), rest));
        } else {
            subject = i + 1;
        }
    }
    (out, printed)
}

/// Columns of the marks in `//   ^^^^ text`, and the text.
fn carets(line: &str) -> Option<((usize, usize), &str)> {
    let rest = line.trim_start().strip_prefix("//")?;
    let marks = rest.trim_start();
    let mark = marks.chars().next().filter(|c| ['^', '~'].contains(c))?;
    let start = line.chars().count() - marks.chars().count();
    let length = marks.chars().take_while(|c| *c == mark).count();
    Some(((start + 1, start + length), marks[length..].trim_start()))
}

fn is_code(text: &str) -> bool {
    let mut chars = text.chars();
    chars.next().is_some_and(|c| "EWN".contains(c)) && chars.take(4).filter(char::is_ascii_digit).count() == 4
}

fn expected(at: Option<(usize, usize, usize)>, rest: &str) -> Expected {
    let (code, words) = match rest.split_once(' ') {
        Some((code, words)) if is_code(code) => (Some(code.to_string()), words),
        None if is_code(rest) => (Some(rest.to_string()), ""),
        _ => (None, rest),
    };
    let words = words.split(" | ").map(|w| w.trim().to_string()).filter(|w| !w.is_empty()).collect();
    Expected { at, code, words }
}

fn compare(place: &str, case: &str, observed: &Observed, report: &mut String) {
    let (expected, printed) = expectations(case);
    let mut left: Vec<&Diagnostic> = observed.diagnostics.iter().collect();
    for e in &expected {
        let found = match &e.code {
            Some(_) => left.iter().position(|d| is_met(e, d, observed)).map(|i| left.remove(i)).is_some(),
            None => observed.diagnostics.iter().any(|d| is_met(e, d, observed)),
        };
        if !found {
            report.push_str(&format!("{place}\n  expected, and did not come: {e:?}\n"));
        }
    }
    for d in left {
        let at = d.span().and_then(|s| columns(s, observed));
        report.push_str(&format!("{place}\n  came, and was not expected: {at:?} {} {}\n", d.code, d.message));
        for label in &d.labels {
            report.push_str(&format!("    {:?} {}\n", columns(label.span, observed), label.text));
        }
        for hint in &d.hints {
            report.push_str(&format!("    hint: {hint}\n"));
        }
    }
    if (!printed.is_empty() || !observed.printed.is_empty()) && printed != observed.printed {
        report.push_str(&format!("{place}\n  printed {:#?}\n  expected {printed:#?}\n", observed.printed));
    }
}

fn is_met(e: &Expected, d: &Diagnostic, observed: &Observed) -> bool {
    let place = |span: Span| columns(span, observed);
    match (&e.code, e.at) {
        (Some(code), at) => {
            let said = std::iter::once(&d.message).chain(d.labels.iter().map(|l| &l.text)).chain(&d.hints);
            let said: Vec<&String> = said.collect();
            d.code.0 == code
                && d.span().and_then(place) == at
                && e.words.iter().all(|w| said.iter().any(|s| s.contains(w.as_str())))
        }
        (None, Some(at)) => d
            .labels
            .iter()
            .any(|l| place(l.span) == Some(at) && e.words.iter().all(|w| l.text.contains(w.as_str()))),
        (None, None) => false,
    }
}

/// Line, first and last column of a span in the case; `None` in another file.
fn columns(span: Span, observed: &Observed) -> Option<(usize, usize, usize)> {
    if Some(span.file) != observed.file {
        return None;
    }
    let at = observed.sources.line_column(span);
    let text = observed.sources.text(span);
    let first = text.lines().next().unwrap_or("");
    Some((at.line, at.column, at.column + first.chars().count().max(1) - 1))
}
