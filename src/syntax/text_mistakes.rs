//! Explanation of mistakes with values in texts: how other languages format them.

use super::failure::Mistake;
use crate::source::{Diagnostic, Span, code};

/// The characters of formats of other languages.
const FORMAT: fn(char) -> bool = |c| c.is_ascii_alphanumeric() || ".<>=^+-,_%#?! ".contains(c);

impl Mistake<'_> {
    /// Returns the diagnostic for a format of other languages in a text, such as `{x:.2f}`, `{x:>8}` or `{x:.2 in
    /// mm}`; `None` if the mistake is something else.
    pub(super) fn foreign_format(&self) -> Option<Diagnostic> {
        if !self.in_text {
            return None;
        }
        let at = self.failure.at;
        let open = self.text[..at].rfind('{')? + 1;
        let close = at + self.text[at..].find(['}', '"', '\n'])?;
        let (value, format) = self.text[open..close].rsplit_once(':')?;
        let ended = value.matches('(').count() == value.matches(')').count();
        if !ended || format.trim().is_empty() || !format.chars().all(FORMAT) {
            return None;
        }
        let colon = open + value.len();
        let span = Span::new(self.file, self.base + colon, self.base + close);
        let digits = format.split_once('.').map_or("", |(_, behind)| behind);
        let digits: String = digits.chars().take_while(char::is_ascii_digit).collect();
        let unit = format.split_once(" in ").map(|(_, unit)| unit.trim());
        let hint = match (unit, digits.as_str()) {
            (Some(unit), digits) if !digits.is_empty() => {
                format!("the unit stands before the decimals: `{{{value} in {unit}:.{digits}}}`")
            }
            (_, "") => "decimals are written `{x:.2}`; `pad(text, 8)` fills a text up to a width".to_owned(),
            (_, digits) => {
                format!("decimals are written `{{{value}:.{digits}}}`, a unit before them: `{{x in mm:.2}}`")
            }
        };
        Some(
            Diagnostic::error(code::SYNTAX, format!("`{}` is no format of a value", format.trim()))
                .label(span, "")
                .hint(hint),
        )
    }
}
