//! Numbers and texts: the contents of literals.

use super::ast::*;
use super::build::{Builder, next};
use super::build_expr::Tall;
use super::build_types::run;
use super::parse::{Node, Rule};
use crate::source::{Span, Symbol, code};

impl Builder<'_> {
    /// Builds a number from the text at its span: splits `1_000.5e-3N*m` into its digits and its unit.
    pub(super) fn number(&mut self, span: Span) -> ExprKind {
        let text = &self.read[span.range()];
        let end = digits_end(text.as_bytes());
        let digits = &text[..end];
        if digits.ends_with('_') || digits.contains("__") || digits.contains("_.") || digits.contains("_e") {
            self.error(code::BAD_NUMBER, "an underscore in a number stands between two digits", span);
        }
        let digits = match digits.contains('_') {
            true => Symbol::new(&digits.replace('_', "")),
            false => self.symbol(Span::new(span.file, span.start as usize, span.start as usize + end)),
        };
        let unit = Span::new(span.file, span.start as usize + end, span.end as usize);
        let unit = (end < text.len()).then(|| self.unit(unit));
        ExprKind::Number { digits, unit }
    }

    /// Builds a text `"..."`, with its escapes and `{expr}`, from its parse node; reports unknown escapes.
    pub(super) fn text(&mut self, node: Node) -> Tall {
        let span = self.span(&node);
        let mut parts = Vec::new();
        let mut literal = String::new();
        let mut height = 0;
        for node in node.into_inner() {
            match node.as_rule() {
                Rule::text_chars => literal.push_str(node.as_str()),
                Rule::escape => {
                    let span = self.span(&node);
                    literal.extend(self.escape(node.as_str(), span));
                }
                _ => {
                    if !literal.is_empty() {
                        parts.push(TextPart::Literal(std::mem::take(&mut literal)));
                    }
                    let mut inside = node.into_inner();
                    let value = self.tall_expr(next(&mut inside));
                    height = height.max(value.height);
                    parts.push(self.hole(value.expr, inside));
                }
            }
        }
        if !literal.is_empty() {
            parts.push(TextPart::Literal(literal));
        }
        self.grown(span, ExprKind::Text(parts), height)
    }

    /// Builds an interpolated value with what follows it: a unit, a number of decimals, both, or nothing.
    fn hole<'i>(&mut self, value: Expr, behind: impl Iterator<Item = Node<'i>>) -> TextPart {
        let (mut unit, mut decimals) = (None, None);
        for node in behind {
            let span = self.span(&node);
            match node.as_rule() {
                Rule::hole_unit => unit = Some(self.unit(span)),
                _ => decimals = Some((Symbol::new(&node.as_str()[1..]), span)),
            }
        }
        if unit.is_none() && decimals.is_none() {
            return TextPart::Value(value);
        }
        TextPart::Shown { value, unit, decimals }
    }

    /// Returns (text, span) of `use "..."` and `test "..."`: the text with escapes resolved, and its span, quotes
    /// included. Reports unknown escapes.
    pub(super) fn plain_text(&mut self, node: &Node) -> (String, Span) {
        let span = self.span(node);
        let inside = &node.as_str()[1..node.as_str().len() - 1];
        let mut text = String::new();
        let mut rest = inside;
        while let Some(at) = rest.find('\\') {
            text.push_str(&rest[..at]);
            let length = escape_length(&rest[at..]);
            let start = node.as_span().start() + 1 + (inside.len() - rest.len()) + at;
            let escape_span = self.at(start, start + length);
            text.extend(self.escape(&rest[at..at + length], escape_span));
            rest = &rest[at + length..];
        }
        text.push_str(rest);
        (text, span)
    }

    /// Returns the character of an escape; `None` (and a diagnostic) for an unknown one.
    fn escape(&mut self, escape: &str, span: Span) -> Option<char> {
        let known = match &escape[1..] {
            "n" => Some('\n'),
            "t" => Some('\t'),
            "\"" => Some('"'),
            "\\" => Some('\\'),
            "{" => Some('{'),
            "}" => Some('}'),
            code => code
                .strip_prefix("u{")
                .and_then(|code| u32::from_str_radix(code.strip_suffix('}')?, 16).ok())
                .and_then(char::from_u32),
        };
        if known.is_none() {
            self.error(code::BAD_ESCAPE, format!("text knows no escape `{escape}`"), span)
                .hints
                .push(r#"the escapes are \" \\ \n \t \u{...} \{ \}"#.into());
        }
        known
    }
}

/// Returns the length in bytes of the escape with which a text begins.
fn escape_length(text: &str) -> usize {
    let unicode = text.strip_prefix("\\u{").and_then(|code| {
        let digits = run(code.as_bytes(), 0, |b| b.is_ascii_hexdigit());
        (code.as_bytes().get(digits) == Some(&b'}')).then_some(digits + 4)
    });
    unicode.unwrap_or_else(|| 1 + text[1..].chars().next().map_or(0, char::len_utf8))
}

/// Returns the offset at which the digits of a number end and its unit begins.
fn digits_end(text: &[u8]) -> usize {
    let digits = |start: usize| run(text, start, |b| b.is_ascii_digit() || b == b'_');
    let is_digit = |at: usize| text.get(at).is_some_and(u8::is_ascii_digit);
    let mut end = digits(0);
    if text.get(end) == Some(&b'.') && is_digit(end + 1) {
        end = digits(end + 1);
    }
    if matches!(text.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(text.get(end + 1), Some(b'+' | b'-')));
        if is_digit(end + 1 + sign) {
            end = digits(end + 1 + sign);
        }
    }
    end
}

/// Returns a `"""` text without its quotes, the blank first and last lines and the common indentation. Panics on fewer
/// than 6 bytes, the quotes.
pub(super) fn raw(quoted: &str) -> String {
    let inside = &quoted[3..quoted.len() - 3];
    let mut lines: Vec<&str> =
        inside.split('\n').map(|line| line.strip_suffix('\r').unwrap_or(line)).collect();
    if lines.len() > 1 && is_blank(lines[0]) {
        lines.remove(0);
    }
    if lines.len() > 1 && lines.last().is_some_and(|line| is_blank(line)) {
        lines.pop();
    }
    let indentation = |line: &&str| line.len() - line.trim_start_matches([' ', '\t']).len();
    let common = lines.iter().filter(|line| !is_blank(line)).map(indentation).min().unwrap_or(0);
    let lines: Vec<&str> = lines.iter().map(|line| line.get(common..).unwrap_or("")).collect();
    lines.join("\n")
}

fn is_blank(line: &str) -> bool {
    line.bytes().all(|b| b == b' ' || b == b'\t')
}
