//! Numbers as SVG writes them: separated by blanks or a comma, or by no more than the sign or point of the next one.

use super::Unread;

/// The remedy of a number that can't be read.
const MEND: &str = "state a finite number, as 12.5 or -3e-2";

/// A text of numbers and letters that is read from its start.
pub(super) struct Numbers<'a> {
    rest: &'a str,
}

impl<'a> Numbers<'a> {
    /// Returns the reader of a text.
    pub(super) fn of(text: &'a str) -> Numbers<'a> {
        let mut numbers = Numbers { rest: text };
        numbers.skip();
        numbers
    }

    /// Returns true if nothing is left.
    pub(super) fn ended(&self) -> bool {
        self.rest.is_empty()
    }

    /// Returns the text that is not read yet.
    pub(super) fn rest(&self) -> &'a str {
        self.rest
    }

    /// Reads a letter; `None` where none stands there.
    pub(super) fn letter(&mut self) -> Option<char> {
        let letter = self.rest.chars().next().filter(char::is_ascii_alphabetic)?;
        self.rest = &self.rest[1..];
        self.skip();
        Some(letter)
    }

    /// Returns true if a number can begin here.
    pub(super) fn at_number(&self) -> bool {
        self.rest.starts_with(|c: char| c.is_ascii_digit() || ['+', '-', '.'].contains(&c))
    }

    /// Reads a number.
    ///
    /// # Errors
    /// The reason why there is none, or none that is finite.
    pub(super) fn number(&mut self) -> Result<f64, Unread> {
        let bytes = self.rest.as_bytes();
        let digits = |mut at: usize| {
            while bytes.get(at).is_some_and(u8::is_ascii_digit) {
                at += 1;
            }
            at
        };
        let signed = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
        let mut end = digits(signed(0));
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let exponent = signed(end + 1);
            if digits(exponent) > exponent {
                end = digits(exponent);
            }
        }
        let (word, rest) = self.rest.split_at(end);
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        let Some(number) = number else {
            let found = match shown(self.rest) {
                rest if rest.is_empty() => "numbers end where one more is wanted".to_owned(),
                rest => format!("`{rest}` stands where a number is wanted"),
            };
            return Err(Unread::new(found, MEND));
        };
        self.rest = rest;
        self.skip();
        Ok(number)
    }

    /// Skips blanks and a comma between them.
    fn skip(&mut self) {
        let blank = |c: char| c.is_ascii_whitespace();
        let rest = self.rest.trim_start_matches(blank);
        self.rest = rest.strip_prefix(',').map_or(rest, |rest| rest.trim_start_matches(blank));
    }
}

/// Returns a length of a drawing: a number, or one of pixels, which are the drawing's unit.
///
/// # Errors
/// The reason why it is none.
pub(super) fn length(name: &str, text: &str) -> Result<f64, Unread> {
    let text = text.trim();
    let plain = text.strip_suffix("px").unwrap_or(text);
    let mut numbers = Numbers::of(plain);
    match numbers.number() {
        Ok(number) if numbers.ended() => Ok(number),
        Ok(_) => {
            let mend = "state lengths in the drawing's own unit: a number alone, or with `px`";
            Err(Unread::new(format!("`{name}` is `{}`", shown(text)), mend))
        }
        Err(_) => Err(Unread::new(format!("`{name}` is `{}`, which is no number", shown(text)), MEND)),
    }
}

/// Returns the beginning of a text for a message.
pub(super) fn shown(text: &str) -> String {
    let mut short: String = text.chars().take(24).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
