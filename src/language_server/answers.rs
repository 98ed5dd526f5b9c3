//! The answers to an editor's questions about a document, in the words of the language and in offsets of bytes.

use super::analysis::Analysis;
use super::names::Named;
use crate::check::summary::{self, Group};
use crate::format;
use crate::source::{Diagnostic, FileId, Severity, Span};
use crate::syntax::{Outline, TokenKind};
use std::ops::Range;

/// Returns the text that explains what stands at a place, as Markdown; `None` where nothing is named.
pub(super) fn hover(analysis: &Analysis, at: usize) -> Option<String> {
    let Named { def, member } = analysis.named_at(at)?;
    let (head, doc) = match member {
        None => {
            let doc = analysis.checked.program.def(def).doc.clone();
            (summary::signature(&analysis.checked, def), doc)
        }
        Some(name) => {
            let about = analysis.about_member(def, &name)?;
            let head = match about.group {
                Group::Field | Group::Method | Group::Parameter => about.head,
                group => format!("{} {}", group.word(), about.head),
            };
            let of = analysis.checked.program.def(def).name;
            let contracts: String = about.contracts.iter().map(|clause| format!("\n  {clause}")).collect();
            (format!("{head}{contracts}\n// of {of}"), about.doc)
        }
    };
    let doc = doc.map_or_else(String::new, |doc| format!("\n\n{}", doc.trim()));
    Some(format!("```modl\n{head}\n```{doc}"))
}

/// Returns the place at which what stands at an offset is declared; `None` for what is declared in the library or nowhere.
pub(super) fn definition(analysis: &Analysis, at: usize) -> Option<Span> {
    let Named { def, member } = analysis.named_at(at)?;
    match member {
        None => Some(analysis.checked.program.def(def).span),
        Some(name) => analysis.member_span(def, &name),
    }
}

/// A declaration of a document, with the members that it declares.
pub(super) struct Symbol {
    /// The name that is declared.
    pub name: String,
    /// The keyword that declares it: `config`, `part`, `behavior`.
    pub word: &'static str,
    /// The signature, or the type, as it is shown beside the name.
    pub detail: String,
    /// The range of the whole declaration, bytes.
    pub whole: Range<usize>,
    /// The range of the name, bytes.
    pub named: Range<usize>,
    /// The members.
    pub inside: Vec<Symbol>,
}

/// Returns the declarations of a document, in the order of the text.
pub(super) fn symbols(analysis: &Analysis) -> Vec<Symbol> {
    let (checked, program) = (&analysis.checked, &analysis.checked.program);
    let here = program.own.iter().filter(|id| program.def(**id).file == analysis.file);
    let mut found: Vec<Symbol> = here
        .map(|id| {
            let def = program.def(*id);
            let whole = def.whole.range();
            let member = |inside: summary::Inside| {
                let name = inside.name.as_str();
                let span = analysis.member_span(*id, name)?;
                let named = (span.file == analysis.file && whole.contains(&span.range().start))
                    .then(|| span.range())?;
                Some(Symbol {
                    name: name.to_owned(),
                    word: inside.group.word(),
                    detail: inside.head.clone(),
                    whole: named.clone(),
                    named,
                    inside: vec![],
                })
            };
            let mut inside: Vec<Symbol> =
                summary::inside(checked, def).into_iter().filter_map(member).collect();
            inside.sort_by_key(|symbol| symbol.named.start);
            Symbol {
                name: def.name.to_string(),
                word: summary::word(&def.kind),
                detail: summary::signature(checked, *id),
                named: def.span.range(),
                whole,
                inside,
            }
        })
        .filter(|symbol| symbol.whole.start <= symbol.named.start && symbol.named.end <= symbol.whole.end)
        .collect();
    found.sort_by_key(|symbol| symbol.whole.start);
    found
}

/// Returns the formatted text of a document; `None` where it is formatted already, or can't be.
pub(super) fn formatted(text: &str) -> Option<String> {
    let formatted = format::format(FileId(0), text)?;
    (formatted.text != text).then_some(formatted.text)
}

/// Returns the ranges of a text (bytes) that may be folded: what stands between brackets on several lines, and comments.
pub(super) fn folds(text: &str) -> Vec<Range<usize>> {
    let Some(outline) = Outline::of(text) else { return Vec::new() };
    let mut open = Vec::new();
    let mut found = Vec::new();
    for token in &outline.tokens {
        match token.kind {
            TokenKind::Open => open.push(token.start),
            TokenKind::Close => found.extend(open.pop().map(|start| start..token.start)),
            TokenKind::BlockComment { .. } => found.push(token.start..token.end),
            _ => {}
        }
    }
    found.retain(|range| text[range.clone()].contains('\n'));
    found.sort_by_key(|range| range.start);
    found
}

/// A diagnostic as an editor shows it.
pub(super) struct Shown {
    /// The place in the document, bytes.
    pub range: Range<usize>,
    /// The severity.
    pub severity: Severity,
    /// The code: `E0201`.
    pub code: &'static str,
    /// The message, the words at the place, and the hints.
    pub message: String,
    /// Other places with words about them.
    pub related: Vec<(Span, String)>,
}

/// Returns diagnostics as they are shown in a document: those of files that it imports stand at its begin, with
/// file and line.
pub(super) fn shown(analysis: &Analysis, diagnostics: &[&Diagnostic]) -> Vec<Shown> {
    let one = |diagnostic: &&Diagnostic| {
        let first = diagnostic.labels.first();
        let own = first.filter(|label| label.span.file == analysis.file);
        let mut message = diagnostic.message.clone();
        if let Some(label) = first.filter(|label| !label.text.is_empty()) {
            message += &format!("\n{}", label.text);
        }
        for hint in &diagnostic.hints {
            message += &format!("\nhelp: {hint}");
        }
        if let Some(label) = first.filter(|_| own.is_none()) {
            let name = &analysis.checked.sources.file(label.span.file).name;
            let line = analysis.checked.sources.line_column(label.span).line;
            message = format!("in {name}, line {line}: {message}");
        }
        Shown {
            range: own.map_or(0..0, |label| label.span.range()),
            severity: diagnostic.severity,
            code: diagnostic.code.0,
            message,
            related: diagnostic.labels.iter().skip(1).map(|label| (label.span, label.text.clone())).collect(),
        }
    };
    diagnostics.iter().map(one).collect()
}
