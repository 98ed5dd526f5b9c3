//! Assistance between the lines of a document: names of parameters, commands for a program and its declarations, and mends of
//! what diagnostics hint at.

use super::analysis::Analysis;
use super::verdicts::{Judged, Target, VERIFY};
use crate::check::summary::{params_of, type_params, with_default};
use crate::check::typed::{DefId, DefKind};
use crate::check::{self, Meaning, Program, Type};
use crate::source::{Diagnostic, Span, Symbol};
use crate::syntax::{DECLARING, Outline, Token, TokenKind};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The most calls whose arguments are named at once: those of several screens.
const CALLS_MAX: usize = 400;
/// The most parameters that are left out whose defaults are shown: more would hide the call.
const DEFAULTS_MAX: usize = 3;

/// A hint that is shown in the text.
pub(super) struct Hint {
    /// The offset at which it is shown, bytes.
    pub at: usize,
    /// The text that is shown.
    pub label: String,
    /// The text that is shown about it: a parameter as it is declared, `n: Int = 1`. Empty for none.
    pub about: String,
    /// The kind of the hint.
    pub kind: HintKind,
}

/// The kinds of hints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HintKind {
    /// The name of a parameter, before its argument.
    Parameter,
    /// The default of a parameter that is left out, behind the arguments.
    Default,
    /// The type of a `let` with a unit, behind its name.
    Type,
    /// The value of a `let`, behind its expression.
    Value,
}

/// Returns the hints in a range of the document (bytes), in the order of the text. `constants`: the values of `let`s, by the
/// places of their expressions.
pub(super) fn hints(analysis: &Analysis, constants: &[(Span, String)], range: &Range<usize>) -> Vec<Hint> {
    let text = analysis.text(analysis.file);
    let Some(outline) = Outline::of(text) else { return Vec::new() };
    let tokens: Vec<&Token> = outline.tokens.iter().filter(|token| is_code(token)).collect();
    let mut found = argument_hints(analysis, &tokens, range);
    found.extend(type_hints(analysis, &tokens, range));
    found.extend(value_hints(analysis, constants, range));
    found.sort_by_key(|hint| hint.at);
    found
}

/// Returns the names of the parameters of arguments that are given without them, and the defaults of those that are left out (but
/// not by built-ins): of functions, planners and instances, but not of behaviours and others that are called by a dot. Names that the argument says
/// itself are left out, and those of calls with one argument.
fn argument_hints(analysis: &Analysis, tokens: &[&Token], range: &Range<usize>) -> Vec<Hint> {
    let text = analysis.text(analysis.file);
    let word = |i: usize| &text[tokens[i].start..tokens[i].end];
    let checked = &analysis.checked;
    let declared = |(name, meaning): &(Symbol, Meaning)| match meaning {
        Meaning::Def(id) => Some((*name, *id)),
        Meaning::File(_) => None,
    };
    let meant: BTreeMap<Symbol, DefId> = checked.names.iter().filter_map(declared).collect();
    let calls = (1..tokens.len()).filter(|i| {
        let [callee, open] = [tokens[i - 1], tokens[*i]];
        let plain = callee.kind == TokenKind::Word && callee.end == open.start && word(*i) == "(";
        let declares = *i > 1 && (word(*i - 2) == "." || DECLARING.contains(&word(*i - 2)));
        plain && !declares && range.contains(&open.start)
    });
    let mut found = Vec::new();
    for open in calls.take(CALLS_MAX) {
        let Some(Call { given, close }) = call(text, tokens, open) else { continue };
        let Some(id) = meant.get(&Symbol::new(word(open - 1))) else { continue };
        let kind = &checked.program.def(*id).kind;
        let params = params_of(&checked.program, *id).iter();
        let parameters: Vec<String> =
            params.map(|param| with_default(checked, type_params(kind), param)).collect();
        let several = given.len() > 1 && given.iter().any(|argument| argument.name.is_none());
        let mut left_out: Vec<&str> = parameters.iter().map(String::as_str).collect();
        let mut variadic = false;
        for (argument, declared) in given.iter().zip(&parameters) {
            let (name, rest) = declared.split_once(':').unwrap_or((declared, ""));
            // All arguments from here on are of this parameter.
            variadic = rest.contains("...");
            if variadic {
                break;
            }
            if argument.name.is_some() {
                continue;
            }
            left_out.retain(|other| other != declared);
            if several && text[argument.range.clone()].trim_end() != name {
                let (label, about) = (format!("{name}:"), declared.clone());
                found.push(Hint { at: argument.range.start, label, about, kind: HintKind::Parameter });
            }
        }
        let named = |declared: &str| {
            given.iter().any(|a| a.name.is_some_and(|name| declared.split(':').next() == Some(name)))
        };
        left_out.retain(|declared| !named(declared));
        let defaults: Vec<String> = left_out.iter().filter_map(|declared| default_of(declared)).collect();
        // The defaults of built-ins are known, and would stand behind each motion.
        let shows = !variadic && !matches!(kind, DefKind::Native(_));
        if shows && (1..=DEFAULTS_MAX).contains(&defaults.len()) {
            let comma = if given.is_empty() { "" } else { ", " };
            let (label, about) = (format!("{comma}{}", defaults.join(", ")), String::new());
            found.push(Hint { at: tokens[close].start, label, about, kind: HintKind::Default });
        }
    }
    found
}

/// Returns a parameter with its default, as a call would give it: `height: 2m`; `None` without a default, and where that is
/// nothing.
fn default_of(declared: &str) -> Option<String> {
    let (head, default) = declared.split_once(" = ")?;
    let name = head.split(':').next()?;
    (default != "_").then(|| format!("{name}: {default}"))
}

/// Returns the types of `let`s that state none, where these have a unit that the text does not show: not those of a plain number.
fn type_hints(analysis: &Analysis, tokens: &[&Token], range: &Range<usize>) -> Vec<Hint> {
    let program = &analysis.checked.program;
    let here = |(span, ty): &&(Span, Type)| {
        span.file == analysis.file && range.contains(&span.range().start) && has_unit(program, ty)
    };
    let mut found: Vec<Hint> = Vec::new();
    for (span, ty) in analysis.checked.lets.iter().filter(here) {
        let at = span.range().end;
        // Behind the name stands `=`, and behind that the expression.
        let first = tokens.partition_point(|token| token.start < at) + 1;
        if is_plain(tokens, first, analysis.text(analysis.file)) || found.iter().any(|hint| hint.at == at) {
            continue;
        }
        let label = format!(": {}", program.type_name(ty));
        found.push(Hint { at, label, about: String::new(), kind: HintKind::Type });
    }
    found
}

/// Returns true where an expression is nothing but a number, with or without a sign. `first`: the index of its first token.
fn is_plain(tokens: &[&Token], first: usize, text: &str) -> bool {
    let sign = tokens.get(first).is_some_and(|token| &text[token.start..token.end] == "-");
    let number = first + usize::from(sign);
    let Some(token) = tokens.get(number).filter(|token| token.kind == TokenKind::Number) else {
        return false;
    };
    let next = tokens.get(number + 1).map_or(text.len(), |next| next.start);
    text[token.end..next].contains('\n') || next == text.len()
}

/// Returns true for a quantity with a unit, and for lists, vectors and ranges of such.
fn has_unit(program: &Program, ty: &Type) -> bool {
    match ty {
        Type::Quantity(_) => program.type_name(ty) != "Number",
        Type::List(of) | Type::Vec3(of) | Type::Range(of) | Type::Optional(of) => has_unit(program, of),
        _ => false,
    }
}

/// Returns the values of `let`s behind their expressions.
fn value_hints(analysis: &Analysis, constants: &[(Span, String)], range: &Range<usize>) -> Vec<Hint> {
    let text = analysis.text(analysis.file);
    let here =
        |(span, _): &&(Span, String)| span.file == analysis.file && range.contains(&span.range().start);
    let hint = |(span, value): &(Span, String)| {
        // A bracket around an expression is no part of it.
        let end = span.range().end;
        let at = end + text[end..].len() - text[end..].trim_start_matches(')').len();
        Hint { at, label: format!("= {value}"), about: String::new(), kind: HintKind::Value }
    };
    constants.iter().filter(here).map(hint).collect()
}

/// Returns true for tokens that are neither comments nor line breaks.
fn is_code(token: &Token) -> bool {
    !matches!(token.kind, TokenKind::LineBreak | TokenKind::LineComment | TokenKind::BlockComment { .. })
}

/// A call in the text.
struct Call<'t> {
    given: Vec<Argument<'t>>,
    /// The index of the token that is its closing bracket.
    close: usize,
}

/// An argument of a call.
struct Argument<'t> {
    /// The range of the argument, its name included, bytes.
    range: Range<usize>,
    /// The name that it is given by; `None` without one.
    name: Option<&'t str>,
}

/// Returns the call whose opening bracket is the token `open`; `None` where the bracket is not closed.
fn call<'t>(text: &'t str, tokens: &[&Token], open: usize) -> Option<Call<'t>> {
    let word = |i: usize| tokens.get(i).map_or("", |token| &text[token.start..token.end]);
    let (mut depth, mut given, mut first) = (0, Vec::new(), open + 1);
    for i in open..tokens.len() {
        let ends = depth == 1 && (word(i) == "," || word(i) == ")");
        if ends && first < i {
            let named = tokens[first].kind == TokenKind::Word && matches!(word(first + 1), ":" | "=");
            let range = tokens[first].start..tokens[i - 1].end;
            given.push(Argument { range, name: named.then(|| word(first)) });
        }
        match tokens[i].kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(Call { given, close: i });
        }
        if ends {
            first = i + 1;
        }
    }
    None
}

/// A command that is offered at a place of a document.
pub(super) struct Lens {
    /// The place, bytes.
    pub range: Range<usize>,
    /// The words to click on.
    pub title: String,
    /// The command, which gets the URI of the document.
    pub command: &'static str,
    /// The second thing that the command gets; `None` for nothing.
    pub argument: Option<String>,
}

impl Lens {
    /// Returns a lens with a command that gets nothing but the document.
    fn new(range: Range<usize>, title: &str, command: &'static str) -> Lens {
        Lens { range, title: title.to_owned(), command, argument: None }
    }

    /// Returns the lens that verifies `target`, or says what is known of it. `span`: the call or the name of the behaviour.
    fn verify(target: &Target, span: Span, verdicts: &BTreeMap<Target, Option<Judged>>) -> Lens {
        let title = match verdicts.get(target) {
            None => "Verify".to_owned(),
            Some(None) => "verifying …".to_owned(),
            Some(Some(judged)) => judged.words_at(span),
        };
        Lens { range: span.range(), title, command: VERIFY, argument: target.argument() }
    }
}

/// Returns the commands that are offered in a document, in order: to run and to show the program at its first item, to show a
/// robot at its declaration, to run the tests at each of them, to verify where a plan is made into a file, and behaviours that need
/// no arguments. `verdicts`: what was verified already, or is being verified (`None`).
pub(super) fn lenses(analysis: &Analysis, verdicts: &BTreeMap<Target, Option<Judged>>) -> Vec<Lens> {
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
        found.push(Lens::new(range.clone(), "Run", "modl.run"));
        found.push(Lens::new(range, "Show", "modl.show"));
    }
    let program = &analysis.checked.program;
    for def in program.own.iter().map(|id| program.def(*id)).filter(|def| def.span.file == analysis.file) {
        let shown = matches!(def.kind, DefKind::Config(_) | DefKind::Lattice(_) | DefKind::Truss(_));
        if shown {
            found.push(Lens::new(def.span.range(), "Show the robot", "modl.show"));
        }
    }
    let sound = !analysis.checked.has_errors();
    if sound {
        let lens = |(target, span): &(Target, Span)| Lens::verify(target, *span, verdicts);
        found.extend(analysis.verifiable().iter().map(lens));
    }
    let mut emits = BTreeSet::new();
    for token in begins {
        let range = token.start..token.end;
        match &text[range.clone()] {
            "test" => found.push(Lens::new(range, "Run the tests", "modl.test")),
            "emit" => {
                emits.insert(token.start);
                found.push(Lens::new(range, "Verify and write", "modl.run"));
                if sound {
                    let span = Span::new(analysis.file, token.start, token.end);
                    found.push(Lens::verify(&Target::Program, span, verdicts));
                }
            }
            _ => {}
        }
    }
    // Verdicts that the program asked for elsewhere.
    if let Some(Some(judged)) = verdicts.get(&Target::Program) {
        let elsewhere =
            |(span, _): &&(Span, _)| span.file == analysis.file && !emits.contains(&span.range().start);
        let known = judged.verdicts.iter().filter(elsewhere);
        found.extend(known.map(|(span, _)| Lens::verify(&Target::Program, *span, verdicts)));
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
