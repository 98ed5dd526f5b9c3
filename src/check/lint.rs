//! Lints on the style of names: CamelCase for types and configurations, snake_case for the rest.

use super::checker::{Checker, DefItem};
use super::typed::DefId;
use crate::source::{Diagnostic, Span, Symbol, code};

impl Checker<'_> {
    /// Warns if the name of a declaration is not in the style of its kind: snake_case for variables, CamelCase for
    /// types and configurations.
    pub(super) fn lint_def(&mut self, id: DefId) {
        let info = self.def(id);
        let (name, span) = (info.name, info.span);
        match info.item {
            DefItem::Let(_) => self.lint_snake(name, span, "variables"),
            DefItem::Study(_) => self.lint_snake(name, span, "studies"),
            DefItem::Fn(_) | DefItem::Native(_) | DefItem::Method(..) => {}
            _ if is_camel(name.as_str()) => {}
            _ => self.style(span, name, "types and configurations", &camel(name.as_str())),
        }
    }

    /// Warns if a name is not in snake_case; `what` is the plural noun for its kind in the message.
    pub(super) fn lint_snake(&mut self, name: Symbol, span: Span, what: &str) {
        if name.as_str().len() > 1 && name.as_str().contains(|c: char| c.is_ascii_uppercase()) {
            self.style(span, name, what, &snake(name.as_str()));
        }
    }

    /// Warns of a name in another style, except in the standard library.
    fn style(&mut self, span: Span, name: Symbol, what: &str, mended: &str) {
        if self.sources.file(span.file).library || mended == name.as_str() {
            return;
        }
        self.report(
            Diagnostic::warning(code::NAME_STYLE, format!("{what} are written like `{mended}`"))
                .label(span, format!("`{name}`")),
        );
    }
}

/// Returns true if a name is in CamelCase.
fn is_camel(name: &str) -> bool {
    let name = name.trim_start_matches('_');
    name.starts_with(|c: char| c.is_ascii_uppercase()) && !name.contains('_')
}

/// Returns a name in CamelCase.
fn camel(name: &str) -> String {
    let mut out = String::new();
    for word in name.split('_').filter(|w| !w.is_empty()) {
        let mut letters = word.chars();
        out.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        out.push_str(letters.as_str());
    }
    out
}

/// Returns a name in snake_case: `maxSpeed` and `MaxSpeed` become `max_speed`; runs of capitals stay
/// together: `com_WB` becomes `com_wb`.
fn snake(name: &str) -> String {
    let mut out = String::new();
    let mut last = '_';
    for c in name.chars() {
        if c.is_ascii_uppercase() && last.is_ascii_lowercase() {
            out.push('_');
        }
        out.push(c.to_ascii_lowercase());
        last = c;
    }
    out
}
