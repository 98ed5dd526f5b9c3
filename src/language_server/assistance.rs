//! Assistance between the lines of a document: names of parameters, commands for a program and its declarations, and mends of
//! what diagnostics hint at.

use super::analysis::Analysis;
use crate::check;
use crate::check::typed::DefKind;
use crate::session::complete::signature;
use crate::source::Diagnostic;
use crate::syntax::{Outline, Token, TokenKind};
use std::ops::Range;

/// The most calls whose arguments are named at once: those of several screens.
const CALLS_MAX: usize = 400;

/// The name of a parameter, to be shown before its argument.
pub(super) struct ParameterHint {
    /// The offset of the argument, bytes.
    pub at: usize,
    /// The name of the parameter.
    pub name: String,
    /// The parameter as it is declared: `n: Int = 1`.
    pub declared: String,
}

/// Returns the names of the parameters of arguments that are given without them, in a range of the document (bytes): of
/// functions and planners, but not of those that are called by a dot. Names that the argument says itself are left out, and
/// those of calls with one argument.
pub(super) fn parameter_hints(analysis: &Analysis, range: &Range<usize>) -> Vec<ParameterHint> {
    let text = analysis.text(analysis.file);
    let Some(outline) = Outline::of(text) else { return Vec::new() };
    let tokens: Vec<&Token> = outline.tokens.iter().filter(|token| is_code(token)).collect();
    let knowledge = analysis.knowledge();
    let calls = (1..tokens.len()).filter(|i| {
        let [callee, open] = [tokens[i - 1], tokens[*i]];
        let plain =
            callee.kind == TokenKind::Word && callee.end == open.start && &text[open.start..open.end] == "(";
        let dotted = *i > 1 && &text[tokens[i - 2].start..tokens[i - 2].end] == ".";
        let declares =
            *i > 1 && matches!(&text[tokens[i - 2].start..tokens[i - 2].end], "fn" | "module" | "config");
        plain && !dotted && !declares && range.contains(&open.start)
    });
    let mut found = Vec::new();
    for open in calls.take(CALLS_MAX) {
        let given = arguments(text, &tokens, open);
        if given.len() < 2 || given.iter().all(|argument| argument.is_none()) {
            continue;
        }
        let Some(called) = signature(&knowledge, &text[..tokens[open].end]) else { continue };
        for (argument, declared) in given.iter().zip(&called.parameters) {
            let (name, rest) = declared.split_once(':').unwrap_or((declared, ""));
            // All arguments from here on are of this parameter.
            if rest.contains("...") {
                break;
            }
            let Some(argument) = argument else { continue };
            if text[argument.clone()].trim_end() != name {
                found.push(ParameterHint {
                    at: argument.start,
                    name: name.to_owned(),
                    declared: declared.clone(),
                });
            }
        }
    }
    found
}

/// Returns true for tokens that are neither comments nor line breaks.
fn is_code(token: &Token) -> bool {
    !matches!(token.kind, TokenKind::LineBreak | TokenKind::LineComment | TokenKind::BlockComment { .. })
}

/// Returns the ranges of the arguments of the call whose bracket is the token `open`, `None` for those with a name. Empty where
/// the bracket is not closed.
fn arguments(text: &str, tokens: &[&Token], open: usize) -> Vec<Option<Range<usize>>> {
    let word = |i: usize| tokens.get(i).map_or("", |token| &text[token.start..token.end]);
    let (mut depth, mut found, mut first) = (0, Vec::new(), open + 1);
    for i in open..tokens.len() {
        let ends = depth == 1 && (word(i) == "," || word(i) == ")");
        if ends && first < i {
            let named = tokens[first].kind == TokenKind::Word && matches!(word(first + 1), ":" | "=");
            found.push((!named).then(|| tokens[first].start..tokens[i - 1].end));
        }
        match tokens[i].kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return found;
        }
        if ends {
            first = i + 1;
        }
    }
    Vec::new()
}

/// A command that is offered at a place of a document.
pub(super) struct Lens {
    /// The place, bytes.
    pub range: Range<usize>,
    /// The words to click on.
    pub title: &'static str,
    /// The command of the editor, which gets the URI of the document.
    pub command: &'static str,
}

/// Returns the commands that are offered in a document, in order: to run and to show the program at its first item, to show a
/// robot at its declaration, to run the tests at each of them, to verify where a plan is made into a file.
pub(super) fn lenses(analysis: &Analysis) -> Vec<Lens> {
    let text = analysis.text(analysis.file);
    let Some(outline) = Outline::of(text) else { return Vec::new() };
    let mut found = Vec::new();
    let begins: Vec<&Token> = outline
        .tokens
        .iter()
        .filter(|token| is_code(token) && outline.begins.contains(&token.start))
        .collect();
    if let Some(first) = begins.first() {
        let range = first.start..first.end;
        found.push(Lens { range: range.clone(), title: "Run", command: "modl.run" });
        found.push(Lens { range, title: "Show", command: "modl.show" });
    }
    let program = &analysis.checked.program;
    for def in program.own.iter().map(|id| program.def(*id)).filter(|def| def.span.file == analysis.file) {
        let shown = matches!(def.kind, DefKind::Config(_) | DefKind::Lattice(_) | DefKind::Truss(_));
        if shown {
            found.push(Lens { range: def.span.range(), title: "Show the robot", command: "modl.show" });
        }
    }
    for token in begins {
        let range = token.start..token.end;
        match &text[range.clone()] {
            "test" => found.push(Lens { range, title: "Run the tests", command: "modl.test" }),
            "emit" => found.push(Lens { range, title: "Verify and write", command: "modl.run" }),
            _ => {}
        }
    }
    found.sort_by_key(|lens| lens.range.start);
    found
}

/// A change that mends what a diagnostic is about.
pub(super) struct Mend {
    /// The words to choose it by.
    pub title: String,
    /// The place of what is replaced, bytes; empty for what is added.
    pub range: Range<usize>,
    /// The text that comes there.
    pub new: String,
}

/// Returns the mends that the hints of diagnostics at a place of the document (bytes) offer: another name, another number, or
/// the `use` that is missing. Only those after which the program has fewer errors.
pub(super) fn mends(analysis: &Analysis, range: &Range<usize>) -> Vec<Mend> {
    let mut found: Vec<Mend> = Vec::new();
    for diagnostic in &analysis.checked.diagnostics {
        let Some(label) = diagnostic.labels.first().filter(|label| label.span.file == analysis.file) else {
            continue;
        };
        let place = label.span.range();
        if place.end < range.start || range.end < place.start {
            continue;
        }
        let offered = diagnostic.hints.iter().flat_map(|hint| mends_of(analysis, hint, &place));
        for mend in offered {
            let known = found.iter().any(|other| other.new == mend.new && other.range == mend.range);
            if !known && helps(analysis, &mend) {
                found.push(mend);
            }
        }
    }
    found
}

/// Returns the changes that a hint speaks of; `place`: that of its diagnostic, bytes.
fn mends_of(analysis: &Analysis, hint: &str, place: &Range<usize>) -> Vec<Mend> {
    let quoted: Vec<&str> = hint.split('`').skip(1).step_by(2).collect();
    let text = analysis.text(analysis.file);
    if let Some(import) = quoted.iter().find(|words| words.starts_with("use ")) {
        let at = place_of_import(text);
        let title = format!("Add `{import}`");
        return vec![Mend { title, range: at..at, new: format!("{import}\n") }];
    }
    // "`near`?", "in degrees? `30deg`": a question that what is quoted answers, in place of one word or number.
    let written = &text[place.clone()];
    if !hint.contains('?') || written.contains(char::is_whitespace) {
        return Vec::new();
    }
    let change = |new: &&str| Mend {
        title: format!("Write `{new}` for `{written}`"),
        range: place.clone(),
        new: (*new).to_owned(),
    };
    quoted.iter().map(change).collect()
}

/// Returns the offset at which a `use` is added: before the first, or before the first item, behind what the file says of itself.
fn place_of_import(text: &str) -> usize {
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let head = line.starts_with("//!") || (at > 0 && line.trim().is_empty());
        if !head {
            break;
        }
        at += line.len();
    }
    at
}

/// Returns true if the program has fewer errors after a change.
fn helps(analysis: &Analysis, mend: &Mend) -> bool {
    let mut text = analysis.text(analysis.file).to_owned();
    text.replace_range(mend.range.clone(), &mend.new);
    let changed = analysis.with_texts([(analysis.name.clone(), text)].into());
    let errors = |found: &[Diagnostic]| found.iter().filter(|diagnostic| diagnostic.is_error()).count();
    errors(&check::check(&changed, &analysis.name).diagnostics) < errors(&analysis.checked.diagnostics)
}
