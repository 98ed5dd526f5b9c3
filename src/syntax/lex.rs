//! A lexer for brackets, comments, line beginnings and error messages. The grammar does not use it; it
//! reads the text itself.

/// A token of the lexer: bytes `start..end` of the text. A line feed is a token of its own ([`TokenKind::LineBreak`]);
/// blanks, tabs and carriage returns between tokens belong to none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token {
    /// The kind of the token, by its first characters.
    pub kind: TokenKind,
    /// The offset of the token's first byte in the text, from 0.
    pub start: usize,
    /// The offset after the token's last byte in the text.
    pub end: usize,
}

/// The kinds of tokens, by what the text means to the grammar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A line feed, which ends a statement or clause where it may.
    LineBreak,
    /// A line comment, `// ...`, without the line end.
    LineComment,
    /// A block comment, `/* ... */`, which may contain others.
    BlockComment {
        /// The depth of comments within each other in the comment; 1 if no comment is nested.
        depth: usize,
    },
    /// A word: a name or a keyword.
    Word,
    /// A number with its unit: from the lexer with a simple one, `3m` of `3m/s`; in an
    /// [`Outline`](super::Outline) all of it.
    Number,
    /// A text literal, `"..."` or `"""..."""`, with the contents of its `{ }`.
    Text {
        /// The depth of brackets and texts nested in the text; 0 without `{ }`.
        depth: usize,
    },
    /// An opening bracket: `(`, `[` or `{`.
    Open,
    /// A closing bracket: `)`, `]` or `}`.
    Close,
    /// A sign or mark, such as `+` or `:`.
    Operator,
    /// A text literal `"` that is not closed on its line.
    UnclosedText,
    /// A text literal `"""` that is never closed.
    UnclosedRawText,
    /// A block comment `/*` that is never closed.
    UnclosedComment,
    /// A character with which no token begins.
    Stray,
}

/// An iterator over the tokens of a text. Every byte belongs to one, but for blanks, tabs and carriage returns between
/// tokens; a line feed is a token.
#[derive(Clone)]
pub(super) struct Lexer<'t> {
    bytes: &'t [u8],
    text: &'t str,
    at: usize,
    /// True after the words `use` and `test`, whose text has no `{expr}`.
    plain_text: bool,
}

impl<'t> Lexer<'t> {
    /// Returns a lexer of a text from the offset `start`, in bytes, on; it must not be within a token.
    pub(super) fn new(text: &'t str, start: usize) -> Lexer<'t> {
        Lexer { bytes: text.as_bytes(), text, at: start, plain_text: false }
    }

    fn peek(&self, ahead: usize) -> u8 {
        self.bytes.get(self.at + ahead).copied().unwrap_or(0)
    }

    fn slash(&mut self) -> TokenKind {
        match self.peek(1) {
            b'/' => {
                self.at = line_end(self.bytes, self.at);
                TokenKind::LineComment
            }
            b'*' => self.block_comment(),
            _ => self.operator(),
        }
    }

    fn block_comment(&mut self) -> TokenKind {
        let mut open = 1;
        let mut depth = 1;
        self.at += 2;
        while self.at < self.bytes.len() {
            match (self.bytes[self.at], self.peek(1)) {
                (b'/', b'*') => {
                    open += 1;
                    depth = depth.max(open);
                    self.at += 2;
                }
                (b'*', b'/') => {
                    open -= 1;
                    self.at += 2;
                    if open == 0 {
                        return TokenKind::BlockComment { depth };
                    }
                }
                _ => self.at += 1,
            }
        }
        TokenKind::UnclosedComment
    }

    fn word(&mut self) -> TokenKind {
        let start = self.at;
        self.skip_word();
        self.plain_text = matches!(&self.bytes[start..self.at], b"use" | b"test");
        TokenKind::Word
    }

    fn skip_word(&mut self) {
        while self.at < self.bytes.len() && is_word_byte(self.bytes[self.at]) {
            self.at += 1;
        }
    }

    /// Reads digits with a fraction, an exponent and a simple unit. A unit such as `m/s` continues in
    /// further tokens.
    fn number(&mut self) -> TokenKind {
        let start = self.at;
        self.skip_word();
        // An `e` behind letters belongs to a unit.
        let exponent = self.bytes[start..self.at].split_last().is_some_and(|(last, before)| {
            matches!(last, b'e' | b'E') && before.iter().all(|b| !b.is_ascii_alphabetic())
        });
        if exponent && matches!(self.peek(0), b'+' | b'-') && self.peek(1).is_ascii_digit() {
            self.at += 1;
            self.skip_word();
        }
        if self.peek(0) == b'.' && self.peek(1).is_ascii_digit() {
            self.at += 1;
            return self.number();
        }
        TokenKind::Number
    }

    fn quoted(&mut self) -> TokenKind {
        if self.bytes[self.at..].starts_with(b"\"\"\"") {
            return self.raw_text();
        }
        let (end, depth) = text_end(self.bytes, self.at, self.plain_text);
        self.at = end;
        match depth {
            Some(depth) => TokenKind::Text { depth },
            None => TokenKind::UnclosedText,
        }
    }

    fn raw_text(&mut self) -> TokenKind {
        let inside = self.at + 3;
        match self.text[inside..].find("\"\"\"") {
            Some(length) => {
                self.at = inside + length + 3;
                TokenKind::Text { depth: 0 }
            }
            None => {
                self.at = self.bytes.len();
                TokenKind::UnclosedRawText
            }
        }
    }

    fn operator(&mut self) -> TokenKind {
        const LONG: [&[u8]; 15] = [
            b"<->", b"...", b"--", b"->", b"++", b"..", b"=>", b"==", b"!=", b"<=", b">=", b"&&", b"||",
            b"**", b"<>",
        ];
        let rest = &self.bytes[self.at..];
        self.at += LONG.iter().find(|long| rest.starts_with(long)).map_or(1, |long| long.len());
        TokenKind::Operator
    }
}

impl Iterator for Lexer<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        while matches!(self.bytes.get(self.at), Some(b' ' | b'\t' | b'\r')) {
            self.at += 1;
        }
        let byte = *self.bytes.get(self.at)?;
        let start = self.at;
        let plain_text = std::mem::take(&mut self.plain_text);
        let kind = match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => self.word(),
            b'0'..=b'9' => self.number(),
            b'\n' => {
                self.at += 1;
                TokenKind::LineBreak
            }
            b'/' => self.slash(),
            b'"' => {
                self.plain_text = plain_text;
                let kind = self.quoted();
                self.plain_text = false;
                kind
            }
            b'(' | b'[' | b'{' => {
                self.at += 1;
                TokenKind::Open
            }
            b')' | b']' | b'}' => {
                self.at += 1;
                TokenKind::Close
            }
            b'&' if self.peek(1) != b'&' => self.stray(),
            b'+' | b'-' | b'*' | b'%' | b'^' | b'<' | b'>' | b'=' | b'!' | b'.' | b',' | b':' | b'|'
            | b'&' | b'?' => self.operator(),
            _ => self.stray(),
        };
        Some(Token { kind, start, end: self.at })
    }
}

impl Lexer<'_> {
    fn stray(&mut self) -> TokenKind {
        self.at += self.text[self.at..].chars().next().map_or(1, char::len_utf8);
        TokenKind::Stray
    }
}

/// Returns true if a byte may be part of a name.
pub(super) fn is_word_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Returns the offset, in bytes, of the first line feed at or after the offset `start`; the length of the text if there
/// is none.
pub(super) fn line_end(bytes: &[u8], start: usize) -> usize {
    bytes[start..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |length| start + length)
}

/// Returns the end of the text literal that begins at `start`, and the depth of brackets in its `{ }`; no
/// depth if its line ends first.
fn text_end(bytes: &[u8], start: usize, plain: bool) -> (usize, Option<usize>) {
    // The open quotes and brackets, innermost last.
    let mut open = vec![b'"'];
    let mut depth = 0;
    let mut at = start + 1;
    while let Some(&byte) = bytes.get(at) {
        let in_text = open.last() == Some(&b'"');
        at += 1;
        match byte {
            b'\n' => return (at - 1, None),
            b'\\' if in_text && bytes.get(at).is_some_and(|b| *b != b'\n') => at += 1,
            b'"' if in_text => {
                open.pop();
                if open.is_empty() {
                    return (at, Some(depth));
                }
            }
            b'"' => open.push(b'"'),
            b'{' if in_text && plain => {}
            b'{' => open.push(byte),
            b'(' | b'[' if !in_text => open.push(byte),
            b'}' if !in_text => {
                // Closes the `{ }`, with whatever is unclosed in it.
                while open.pop().is_some_and(|b| b != b'{') {}
            }
            b')' | b']' if !in_text && open.last() != Some(&b'{') => {
                open.pop();
            }
            _ => {}
        }
        depth = depth.max(open.len() - 1);
    }
    (bytes.len(), None)
}
