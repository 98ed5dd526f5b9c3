//! Colours of strokes, as crease patterns use them.

use super::Unread;
use super::numbers::{Numbers, shown};

/// The value of a channel up to which it is dark, and from which on it is bright, of 255: colours that were converted for
/// print are not pure.
const DARK: f64 = 64.0;
const BRIGHT: f64 = 192.0;

/// The colours with names that crease patterns use.
const NAMED: &[(&str, [f64; 3])] = &[
    ("black", [0.0, 0.0, 0.0]),
    ("red", [255.0, 0.0, 0.0]),
    ("blue", [0.0, 0.0, 255.0]),
    ("yellow", [255.0, 255.0, 0.0]),
    ("green", [0.0, 255.0, 0.0]),
    ("lime", [0.0, 255.0, 0.0]),
    ("magenta", [255.0, 0.0, 255.0]),
    ("fuchsia", [255.0, 0.0, 255.0]),
];

/// The green that CSS calls `green`, whose channel is neither dark nor bright.
const GREEN: [f64; 3] = [0.0, 128.0, 0.0];

/// A colour of a stroke.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::formats) enum Colour {
    /// All channels are dark.
    Black,
    /// Red is bright alone.
    Red,
    /// Blue is bright alone.
    Blue,
    /// Red and green are bright.
    Yellow,
    /// Green is bright alone.
    Green,
    /// Red and blue are bright.
    Magenta,
    /// The colour is none of these; the text states it.
    Other(String),
}

impl Colour {
    /// Returns the colour that a text states, with its opacity, 0 to 1.
    ///
    /// # Errors
    /// The reason why its numbers can't be read.
    pub(super) fn read(text: &str) -> Result<(Colour, f64), Unread> {
        let lower = text.trim().to_ascii_lowercase();
        let other = Colour::Other(shown(text.trim()));
        if let Some((_, channels)) = NAMED.iter().find(|(name, _)| *name == lower) {
            return Ok((Colour::of_channels(*channels).unwrap_or(other), 1.0));
        }
        let stated = match (lower.strip_prefix('#'), lower.strip_prefix("rgb")) {
            (Some(digits), _) => of_digits(digits),
            (None, Some(numbers)) => of_numbers(numbers)?,
            (None, None) => None,
        };
        let Some(([r, g, b], alpha)) = stated else { return Ok((other, 1.0)) };
        Ok((Colour::of_channels([r, g, b]).unwrap_or(other), alpha))
    }

    /// Returns the colour of channels from 0 to 255; `None` if it is none of those that have a meaning.
    fn of_channels(channels: [f64; 3]) -> Option<Colour> {
        if channels == GREEN {
            return Some(Colour::Green);
        }
        if channels.iter().any(|value| *value > DARK && *value < BRIGHT) {
            return None;
        }
        match channels.map(|value| value >= BRIGHT) {
            [false, false, false] => Some(Colour::Black),
            [true, false, false] => Some(Colour::Red),
            [false, false, true] => Some(Colour::Blue),
            [true, true, false] => Some(Colour::Yellow),
            [false, true, false] => Some(Colour::Green),
            [true, false, true] => Some(Colour::Magenta),
            [false, true, true] | [true, true, true] => None,
        }
    }
}

/// Returns (channels from 0 to 255, opacity) of hexadecimal digits: one or two for each channel, and the opacity behind.
fn of_digits(digits: &str) -> Option<([f64; 3], f64)> {
    let values: Option<Vec<u32>> = digits.chars().map(|digit| digit.to_digit(16)).collect();
    let values = values?;
    let channels: Vec<f64> = match values.len() {
        3 | 4 => values.iter().map(|value| f64::from(value * 17)).collect(),
        6 | 8 => values.chunks(2).map(|pair| f64::from(pair[0] * 16 + pair[1])).collect(),
        _ => return None,
    };
    Some(([channels[0], channels[1], channels[2]], channels.get(3).map_or(1.0, |alpha| alpha / 255.0)))
}

/// Returns (channels from 0 to 255, opacity) of the numbers of `rgb(...)` or `rgba(...)`; `None` if they are none.
///
/// # Errors
/// The reason why a number can't be read.
fn of_numbers(text: &str) -> Result<Option<([f64; 3], f64)>, Unread> {
    let inside = text.strip_prefix('a').unwrap_or(text).trim().strip_prefix('(');
    let Some(inside) = inside.and_then(|inside| inside.strip_suffix(')')) else { return Ok(None) };
    let mut values = Vec::new();
    for word in inside.split(|c: char| c == ',' || c == '/' || c.is_ascii_whitespace()) {
        if word.is_empty() {
            continue;
        }
        if values.len() == 4 {
            return Ok(None);
        }
        let plain = word.strip_suffix('%');
        let mut numbers = Numbers::of(plain.unwrap_or(word));
        let number = numbers.number()?;
        // Of a channel 100 % is 255, of the opacity 1.
        let whole = if values.len() < 3 { 255.0 } else { 1.0 };
        values.push(if plain.is_some() { number / 100.0 * whole } else { number });
        if !numbers.ended() {
            return Ok(None);
        }
    }
    let &[r, g, b, ..] = values.as_slice() else { return Ok(None) };
    Ok(Some(([r, g, b], values.get(3).map_or(1.0, |alpha| alpha.clamp(0.0, 1.0)))))
}
