//! A mutant: one small change of one place of the code, as text.

use std::ops::Range;

/// A piece of what stands in place of the original: text of its own, or a range (bytes) of the original file.
#[derive(Clone, Debug)]
pub enum Piece {
    Text(String),
    Source(Range<usize>),
}

/// How the original and what stands in its place are put into one text, between which the number of the mutant decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// An expression: one of two values.
    Expression,
    /// A statement that is left out.
    Omission,
    /// A statement at the head of a function: the range is empty.
    Head,
}

/// One small change of one place of a file.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// The file, from the root of the project.
    pub file: String,
    /// The function with the type that it belongs to, `Type::function`.
    pub function: String,
    /// The operator that made it, which its line in the report begins with.
    pub operator: &'static str,
    /// The line of the original, from 1.
    pub line: usize,
    /// The place of the original in the file, in bytes.
    pub range: Range<usize>,
    pub form: Form,
    /// What stands in place of the original.
    pub pieces: Vec<Piece>,
    /// The original text, with single spaces.
    pub original: String,
    /// The text in its place, with single spaces.
    pub mutated: String,
    /// The number among mutants of the same file, function and texts, in order, from 0.
    pub ordinal: usize,
}

impl Mutant {
    /// Returns what identifies the mutant as long as its function does not change: no line numbers.
    pub fn key(&self) -> String {
        let Mutant { file, function, operator, original, mutated, ordinal, .. } = self;
        format!("{file} | {function} | {operator} | {original} => {mutated} | {ordinal}")
    }

    /// Returns the place in the order of the draw: a hash of seed and key, so that changes of other functions leave
    /// the draw as it is.
    pub fn rank(&self, seed: u64) -> u64 {
        // FNV-1a, and the finaliser of SplitMix64.
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let mut x =
            seed.to_le_bytes().into_iter().chain(self.key().into_bytes()).fold(0xcbf2_9ce4_8422_2325, step);
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }
}

/// Returns a text with single spaces in place of any.
pub fn spaced(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
