//! The types of the protocol, and what the server's answers are in them.

use super::answers::{Shown, Symbol};
use super::assistance::{Hint, HintKind, Lens, Mend};
use super::places::{Encoding, Place, offset, place, places, uri_of};
use super::symbols::Found;
use super::verdicts::VERIFY;
use crate::session::complete::{Completion, Signature};
use crate::source::Severity;
use crate::syntax::Class;
use gen_lsp_types as lsp;
use std::ops::Range;

/// The classes of semantic tokens, in the order of their numbers on the wire.
const TOKEN_TYPES: [&str; 5] = ["keyword", "type", "number", "string", "comment"];

/// The scheme of the URIs of pages that the server has.
const SCHEME: &str = "modl";

/// Returns the URI of the page that explains a diagnostic's code.
fn page_of(code: &str) -> String {
    format!("{SCHEME}:/errors/{code}.md")
}

/// Returns the code that a page explains, by its URI; `None` for another URI.
pub(super) fn code_of_page(uri: &str) -> Option<&str> {
    uri.strip_prefix(SCHEME)?.strip_prefix(":/errors/")?.strip_suffix(".md")
}

/// Returns the capabilities of the server, whose columns count in `encoding`.
pub(super) fn capabilities(encoding: Encoding) -> lsp::ServerCapabilities {
    let words = |words: &[&str]| Some(words.iter().map(|word| (*word).to_owned()).collect());
    lsp::ServerCapabilities {
        position_encoding: Some(match encoding {
            Encoding::Utf8 => lsp::PositionEncodingKind::UTF8,
            Encoding::Utf16 => lsp::PositionEncodingKind::UTF16,
        }),
        text_document_sync: Some(lsp::TextDocumentSync::Kind(lsp::TextDocumentSyncKind::Incremental)),
        completion_provider: Some(lsp::CompletionOptions {
            trigger_characters: words(&[".", "(", " ", "\""]),
            ..Default::default()
        }),
        signature_help_provider: Some(lsp::SignatureHelpOptions {
            trigger_characters: words(&["(", ","]),
            ..Default::default()
        }),
        hover_provider: Some(true.into()),
        definition_provider: Some(true.into()),
        references_provider: Some(true.into()),
        rename_provider: Some(true.into()),
        document_symbol_provider: Some(true.into()),
        document_formatting_provider: Some(true.into()),
        folding_range_provider: Some(true.into()),
        inlay_hint_provider: Some(true.into()),
        code_action_provider: Some(true.into()),
        code_lens_provider: Some(lsp::CodeLensOptions::default()),
        workspace_symbol_provider: Some(true.into()),
        execute_command_provider: Some(lsp::ExecuteCommandOptions {
            commands: vec![VERIFY.to_owned()],
            ..Default::default()
        }),
        workspace: Some(lsp::WorkspaceOptions {
            text_document_content: Some(
                lsp::TextDocumentContentOptions { schemes: vec![SCHEME.to_owned()] }.into(),
            ),
            ..Default::default()
        }),
        semantic_tokens_provider: Some(
            lsp::SemanticTokensOptions {
                legend: lsp::SemanticTokensLegend {
                    token_types: TOKEN_TYPES.map(str::to_owned).to_vec(),
                    token_modifiers: vec![],
                },
                full: Some(true.into()),
                ..Default::default()
            }
            .into(),
        ),
        ..Default::default()
    }
}

/// Returns a position as a place.
pub(super) fn place_of(position: lsp::Position) -> Place {
    Place { line: position.line, column: position.character }
}

fn position(place: Place) -> lsp::Position {
    lsp::Position { line: place.line, character: place.column }
}

/// Returns a range of a text, in bytes, as one of positions.
pub(super) fn range(text: &str, bytes: &Range<usize>, encoding: Encoding) -> lsp::Range {
    let (start, end) = places(text, bytes, encoding);
    lsp::Range { start: position(start), end: position(end) }
}

/// Returns a text after changes of an editor, one after the other.
pub(super) fn changed(
    text: &str,
    changes: &[lsp::TextDocumentContentChangeEvent],
    encoding: Encoding,
) -> String {
    use lsp::TextDocumentContentChangeEvent as Event;
    changes.iter().fold(text.to_owned(), |text, change| match change {
        Event::TextDocumentContentChangeWholeDocument(whole) => whole.text.clone(),
        Event::TextDocumentContentChangePartial(part) => {
            let [start, end] =
                [part.range.start, part.range.end].map(|at| offset(&text, place_of(at), encoding));
            format!("{}{}{}", &text[..start], part.text, &text[end.max(start)..])
        }
    })
}

/// Returns a diagnostic of a document. `pages`: true if it says where its code is explained; `location` gives that of another
/// place, `None` where it has none.
pub(super) fn diagnostic(
    text: &str,
    shown: &Shown,
    encoding: Encoding,
    pages: bool,
    location: impl Fn(crate::source::Span) -> Option<lsp::Location>,
) -> lsp::Diagnostic {
    let related = shown.related.iter().filter_map(|(span, message)| {
        Some(lsp::DiagnosticRelatedInformation { location: location(*span)?, message: message.clone() })
    });
    let related: Vec<_> = related.collect();
    lsp::Diagnostic {
        range: range(text, &shown.range, encoding),
        severity: Some(match shown.severity {
            Severity::Error => lsp::DiagnosticSeverity::Error,
            Severity::Warning => lsp::DiagnosticSeverity::Warning,
            Severity::Note => lsp::DiagnosticSeverity::Information,
        }),
        code: Some(lsp::Code::String(shown.code.to_owned())),
        code_description: pages.then(|| lsp::CodeDescription { href: lsp::Uri(page_of(shown.code)) }),
        source: Some("modl".to_owned()),
        message: shown.message.clone().into(),
        related_information: (!related.is_empty()).then_some(related),
        ..Default::default()
    }
}

/// Returns a hover text.
pub(super) fn hover(markdown: String) -> lsp::Hover {
    let contents = lsp::MarkupContent { kind: lsp::MarkupKind::Markdown, value: markdown };
    lsp::Hover { contents: contents.into(), range: None }
}

/// Returns the candidates of completion at an offset of a text.
pub(super) fn completion(
    text: &str,
    at: usize,
    found: &Completion,
    encoding: Encoding,
) -> Vec<lsp::CompletionItem> {
    let range = range(text, &(found.start..at), encoding);
    let item = |named: &crate::session::complete::Named| lsp::CompletionItem {
        label: named.name.trim_end().to_owned(),
        kind: Some(kind_of(&named.name, &named.about)),
        detail: (!named.about.is_empty()).then(|| named.about.clone()),
        text_edit: Some(lsp::TextEdit { range, new_text: named.name.clone() }.into()),
        ..Default::default()
    };
    found.candidates.iter().map(item).collect()
}

/// Returns the kind of a candidate by what is said about it.
fn kind_of(name: &str, about: &str) -> lsp::CompletionItemKind {
    use lsp::CompletionItemKind as Kind;
    match about {
        "" => Kind::Keyword,
        "unit" => Kind::Unit,
        "file" => Kind::File,
        "library" => Kind::Module,
        "choice" => Kind::EnumMember,
        "module" | "config" | "scene" | "connector" | "cell" | "strut" | "lattice" | "truss" => Kind::Class,
        "record" | "a record" => Kind::Struct,
        _ if about.starts_with('(') => Kind::Function,
        _ if name.ends_with(": ") => Kind::Field,
        _ => Kind::Variable,
    }
}

/// Returns the parameters of the call in which a text ends.
pub(super) fn signature(found: &Signature) -> lsp::SignatureHelp {
    let parameter = |text: &String| lsp::ParameterInformation {
        label: lsp::ParameterInformationLabel::String(text.clone()),
        documentation: None,
    };
    let information = lsp::SignatureInformation {
        label: format!("{}({})", found.callee, found.parameters.join(", ")),
        documentation: None,
        parameters: Some(found.parameters.iter().map(parameter).collect()),
        active_parameter: None,
    };
    lsp::SignatureHelp {
        signatures: vec![information],
        active_signature: Some(0),
        active_parameter: Some((found.active as u32).into()),
    }
}

/// Returns the declarations of a document.
pub(super) fn symbols(text: &str, found: &[Symbol], encoding: Encoding) -> Vec<lsp::DocumentSymbol> {
    let one = |symbol: &Symbol| lsp::DocumentSymbol {
        name: symbol.name.clone(),
        detail: Some(symbol.detail.clone()),
        kind: kind_of_symbol(symbol.word),
        range: range(text, &symbol.whole, encoding),
        selection_range: range(text, &symbol.named, encoding),
        children: Some(symbols(text, &symbol.inside, encoding)).filter(|inside| !inside.is_empty()),
        ..symbol_default()
    };
    found.iter().map(one).collect()
}

/// Returns the kind of a declaration by the keyword that declares it.
fn kind_of_symbol(word: &str) -> lsp::SymbolKind {
    use lsp::SymbolKind as Kind;
    match word {
        "fn" | "behavior" | "method" => Kind::Function,
        "let" | "parameter" => Kind::Variable,
        "record" | "type" => Kind::Struct,
        "part" | "joint" | "port" | "obstacle" | "field" => Kind::Field,
        "connector" => Kind::Interface,
        _ => Kind::Class,
    }
}

/// Returns a declaration of a project.
pub(super) fn workspace_symbol(found: &Found, encoding: Encoding) -> lsp::WorkspaceSymbol {
    let uri = lsp::Uri(uri_of(&found.path.to_string_lossy()));
    lsp::WorkspaceSymbol {
        location: lsp::Location { uri, range: range(&found.text, &found.named, encoding) }.into(),
        data: None,
        base_symbol_information: lsp::BaseSymbolInformation {
            name: found.name.clone(),
            kind: kind_of_symbol(found.word),
            tags: None,
            container_name: found.around.clone(),
        },
    }
}

#[allow(deprecated, reason = "the protocol's type has a field that is")]
fn symbol_default() -> lsp::DocumentSymbol {
    let nowhere = lsp::Range::default();
    lsp::DocumentSymbol {
        name: String::new(),
        detail: None,
        kind: lsp::SymbolKind::File,
        tags: None,
        deprecated: None,
        range: nowhere,
        selection_range: nowhere,
        children: None,
    }
}

/// Returns the highlighted pieces of a text, each within one line, each relative to the one before.
pub(super) fn tokens(
    text: &str,
    classes: &[(Range<usize>, Class)],
    encoding: Encoding,
) -> lsp::SemanticTokens {
    let mut data = Vec::with_capacity(classes.len());
    let mut last = Place::default();
    let mut line = (0, 0);
    for (range, class) in classes {
        let kind = match class {
            Class::Keyword => 0,
            Class::Type => 1,
            Class::Number => 2,
            Class::Text => 3,
            Class::Comment => 4,
        };
        let mut start = range.start;
        for piece in text[range.clone()].split_inclusive('\n') {
            let bare = piece.trim_end_matches(['\n', '\r']);
            // The number of the line is counted on from the piece before.
            line.0 += text[line.1..start].bytes().filter(|byte| *byte == b'\n').count() as u32;
            line.1 = start;
            let begin = text[..start].rfind('\n').map_or(0, |at| at + 1);
            let column = place(&text[begin..], start - begin, encoding).column;
            let length = place(bare, bare.len(), encoding).column;
            let here = Place { line: line.0, column };
            if length > 0 {
                let same = here.line == last.line;
                data.push(lsp::SemanticToken {
                    delta_line: here.line - last.line,
                    delta_start: if same { here.column - last.column } else { here.column },
                    length,
                    token_type: kind,
                    token_modifiers_bitset: 0,
                });
                last = here;
            }
            start += piece.len();
        }
    }
    lsp::SemanticTokens { result_id: None, data }
}

/// Returns ranges of a text that may be folded.
pub(super) fn folds(text: &str, found: &[Range<usize>], encoding: Encoding) -> Vec<lsp::FoldingRange> {
    let fold = |bytes: &Range<usize>| {
        let range = range(text, bytes, encoding);
        lsp::FoldingRange {
            start_line: range.start.line,
            start_character: Some(range.start.character),
            end_line: range.end.line,
            end_character: Some(range.end.character),
            kind: None,
            collapsed_text: None,
        }
    };
    found.iter().map(fold).collect()
}

/// Returns hints that are shown in a text.
pub(super) fn inlays(text: &str, found: &[Hint], encoding: Encoding) -> Vec<lsp::InlayHint> {
    let hint = |hint: &Hint| lsp::InlayHint {
        position: position(place(text, hint.at, encoding)),
        label: hint.label.clone().into(),
        kind: match hint.kind {
            HintKind::Parameter | HintKind::Default => Some(lsp::InlayHintKind::Parameter),
            HintKind::Type => Some(lsp::InlayHintKind::Type),
            HintKind::Value => None,
        },
        text_edits: None,
        tooltip: (!hint.about.is_empty()).then(|| hint.about.clone().into()),
        padding_left: (hint.kind == HintKind::Value).then_some(true),
        padding_right: (hint.kind == HintKind::Parameter).then_some(true),
        data: None,
    };
    found.iter().map(hint).collect()
}

/// Returns a change of a document that is offered.
pub(super) fn mend(uri: &str, text: &str, mend: &Mend, encoding: Encoding) -> lsp::CodeAction {
    let edit = lsp::TextEdit { range: range(text, &mend.range, encoding), new_text: mend.new.clone() };
    let changes = [(lsp::Uri(uri.to_owned()), vec![edit])].into();
    lsp::CodeAction {
        title: mend.title.clone(),
        kind: Some(lsp::CodeActionKind::QuickFix),
        diagnostics: None,
        is_preferred: None,
        disabled: None,
        edit: Some(lsp::WorkspaceEdit { changes: Some(changes), ..Default::default() }),
        command: None,
        data: None,
        tags: None,
    }
}

/// Returns a command that is offered at a place of a document.
pub(super) fn lens(uri: &str, text: &str, lens: &Lens, encoding: Encoding) -> lsp::CodeLens {
    lsp::CodeLens {
        range: range(text, &lens.range, encoding),
        command: Some(lsp::Command {
            title: lens.title.clone(),
            tooltip: None,
            command: lens.command.to_owned(),
            arguments: Some([uri].into_iter().chain(lens.argument.as_deref()).map(Into::into).collect()),
        }),
        data: None,
    }
}
