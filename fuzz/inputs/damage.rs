//! Damage: tokens, numbers, lines and bytes that are taken out, doubled, moved, or replaced by odd ones.

use super::dice::Dice;

/// The pieces of token soup: each word, sign and odd character of the language.
#[rustfmt::skip]
pub const TOKENS: &[&str] = &[
    "use", "let", "fn", "extern", "type", "connector", "module", "record", "with", "cell", "strut",
    "config", "lattice", "truss", "test", "of", "is", "as", "mates", "turns", "holds", "capture", "snap",
    "hinge", "mass", "link", "joint", "port", "motor", "touching", "alias", "part", "base", "behavior",
    "allows", "connect", "set", "node", "turn", "at", "turned", "on", "facing", "up", "closed", "and", "or",
    "not", "if", "else", "for", "in", "true", "X", "_", "expect", "require", "a", "b1", "Name", "Quantity",
    "0", "1.5", "90deg", "9.81m/s^2", "1e-3", "\"text\"", "\"a {b} c\"", "\"", "\"\"\"", "\"{", "\\", "(",
    ")", "[", "]", "{", "}", "<", ">", "<->", "->", "--", "=>", "==", "=", "!=", "<=", "+", "-", "++", "*",
    "/", "%", "^", "..", "...", ".", ",", ":", "?", "|", "||", "&&", "**", "<>", "!", "&", ";", "'", "//",
    "///", "//!", "/*", "*/", "\n", "\n", "\n", "\r\n", "\n  ", "\t", "ö", "−", "“", "\u{202e}", "\u{200b}",
    "\0", "\u{feff}", "🤖",
];

/// Numbers at which arithmetic goes wrong.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "1e308",
    "-1e308",
    "1e309",
    "1e-308",
    "5e-324",
    "1e20",
    "1e16",
    "NaN",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "9223372036854775808",
    "18446744073709551615",
    "4294967295",
    "4294967296",
    "2147483648",
    "255",
    "65536",
    "340282366920938463463374607431768211456",
    "0.1",
    "1e-9",
    "1e-12",
    "3.141592653589793",
    "1e5",
    "1000000000",
    "00",
    "1.",
    ".5",
    "1e",
    "0x10",
    "1_000",
];

/// Bytes at which readers go wrong.
const BYTES: &[u8] = &[
    0, 1, 9, 10, 13, 32, 34, 39, 45, 47, 48, 57, 60, 62, 91, 92, 93, 123, 125, 127, 128, 192, 239, 254, 255,
];

/// The greatest length of what is made of other inputs, bytes.
pub const LENGTH_MAX: usize = 1 << 16;

/// Returns a text with one to three damages of any kind.
pub fn damaged(dice: &mut Dice, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..1 + dice.below(3) {
        text = match dice.below(6) {
            0 | 1 => damaged_tokens(dice, &text),
            2 => odd_tokens(dice, &text),
            3 => damaged_numbers(dice, &text),
            4 => damaged_lines(dice, &text),
            _ => cut(dice, &text),
        };
    }
    text
}

/// A token or two of the program put where they do not belong, taken out, or doubled.
pub fn damaged_tokens(dice: &mut Dice, text: &str) -> String {
    let mut tokens: Vec<String> = Vec::new();
    for c in text.chars() {
        let joins =
            |last: &String| c.is_alphanumeric() && last.ends_with(|l: char| l.is_alphanumeric() || l == '_');
        match tokens.last_mut() {
            Some(last) if joins(last) => last.push(c),
            _ => tokens.push(c.to_string()),
        }
    }
    for _ in 0..1 + dice.below(3) {
        if tokens.is_empty() {
            break;
        }
        let (at, from) = (dice.below(tokens.len()), dice.below(tokens.len()));
        match dice.below(4) {
            0 => drop(tokens.remove(at)),
            1 => tokens[at] = tokens[from].clone(),
            2 => tokens.swap(at, from),
            _ => tokens.insert(at, tokens[from].clone()),
        }
    }
    tokens.concat()
}

/// Returns the places of a text where a character begins, and its end.
fn place(dice: &mut Dice, text: &str) -> usize {
    let mut at = dice.below(text.len() + 1);
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// Tokens of the language put anywhere, also within words.
fn odd_tokens(dice: &mut Dice, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..1 + dice.below(4) {
        let at = place(dice, &text);
        text.insert_str(at, dice.of(TOKENS));
    }
    text
}

/// A piece taken out, or all behind a place.
fn cut(dice: &mut Dice, text: &str) -> String {
    let (a, b) = (place(dice, text), place(dice, text));
    let (from, to) = (a.min(b), a.max(b));
    match dice.below(4) {
        0 => text[..from].to_owned(),
        1 => text[from..].to_owned(),
        // Pieces that are doubled grow.
        2 if text.len() < LENGTH_MAX => format!("{}{}{}", &text[..to], &text[from..to], &text[to..]),
        _ => format!("{}{}", &text[..from], &text[to..]),
    }
}

/// One or two numbers replaced by odd ones, or by others of the text.
pub fn damaged_numbers(dice: &mut Dice, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..1 + dice.below(2) {
        let places = numbers(&text);
        if places.is_empty() {
            return text;
        }
        let (from, to) = places[dice.below(places.len())];
        let new = match dice.below(3) {
            0 => {
                let (from, to) = places[dice.below(places.len())];
                text[from..to].to_owned()
            }
            _ => dice.of(NUMBERS).to_owned(),
        };
        text.replace_range(from..to, &new);
    }
    text
}

/// Returns the places of the numbers of a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let word = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
        if !bytes[at].is_ascii_digit() || at > 0 && word(bytes[at - 1]) {
            at += 1;
            continue;
        }
        let mut end = at;
        while end < bytes.len()
            && (bytes[end].is_ascii_digit()
                || bytes[end] == b'.' && bytes.get(end + 1).is_some_and(u8::is_ascii_digit))
        {
            end += 1;
        }
        let exponent = bytes.get(end).is_some_and(|b| b | 32 == b'e');
        let sign = usize::from(exponent && matches!(bytes.get(end + 1), Some(b'-' | b'+')));
        if exponent && bytes.get(end + 1 + sign).is_some_and(u8::is_ascii_digit) {
            end += 1 + sign;
            while end < bytes.len() && bytes[end].is_ascii_digit() {
                end += 1;
            }
        }
        let from = if at > 0 && bytes[at - 1] == b'-' { at - 1 } else { at };
        found.push((from, end));
        at = end.max(at + 1);
    }
    found
}

/// Lines taken out, doubled, or exchanged.
pub fn damaged_lines(dice: &mut Dice, text: &str) -> String {
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    for _ in 0..1 + dice.below(3) {
        if lines.is_empty() {
            break;
        }
        let (at, from) = (dice.below(lines.len()), dice.below(lines.len()));
        match dice.below(4) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[from]),
            2 => lines.swap(at, from),
            _ => lines[at] = lines[from],
        }
    }
    lines.concat()
}

/// Returns the beginning of one text and the end of another, each of whole lines.
pub fn spliced(dice: &mut Dice, first: &str, second: &str) -> String {
    let (a, b): (Vec<&str>, Vec<&str>) =
        (first.split_inclusive('\n').collect(), second.split_inclusive('\n').collect());
    let (to, from) = (dice.below(a.len() + 1), dice.below(b.len() + 1));
    let mut text = a[..to].concat();
    text.push_str(&b[from..].concat());
    let end = (0..=LENGTH_MAX.min(text.len())).rev().find(|at| text.is_char_boundary(*at));
    text.truncate(end.unwrap_or(0));
    text
}

/// Returns bytes of which some are changed, taken out or doubled.
pub fn damaged_bytes(dice: &mut Dice, bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..1 + dice.below(4) {
        let (at, from) = (dice.below(bytes.len() + 1), dice.below(bytes.len() + 1));
        let odd = BYTES[dice.below(BYTES.len())];
        match dice.below(7) {
            0 if at < bytes.len() => bytes[at] ^= 1 << dice.below(8),
            1 if at < bytes.len() => bytes[at] = odd,
            2 => bytes.insert(at, odd),
            3 => bytes.truncate(at),
            4 if at < bytes.len() => drop(bytes.drain(at..(at + 1 + dice.below(8)).min(bytes.len()))),
            5 if from < at && bytes.len() < LENGTH_MAX => {
                let piece = bytes[from..at].to_vec();
                bytes.splice(at..at, piece);
            }
            _ if at + 4 <= bytes.len() => {
                let number = [0_u32, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x7f80_0000, 0x7fc0_0000]
                    [dice.below(7)];
                bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
            }
            _ => bytes.push(odd),
        }
    }
    bytes
}
