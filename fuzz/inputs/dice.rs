//! The source of choices: a seed, or the bytes of a fuzzer.

/// A source of choices, the same on every machine: numbers of a seed (xorshift), or bytes that a fuzzer chose. Behind the last
/// byte every choice is the first.
pub struct Dice {
    state: u64,
    bytes: Option<std::vec::IntoIter<u8>>,
}

impl Dice {
    /// Returns the choices of a seed.
    pub fn new(seed: u64) -> Dice {
        Dice { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1, bytes: None }
    }

    /// Returns the choices that bytes stand for.
    pub fn of_bytes(bytes: &[u8]) -> Dice {
        Dice { state: 0, bytes: Some(Vec::from(bytes).into_iter()) }
    }

    /// Returns a number below `n`, which must not be 0.
    pub fn below(&mut self, n: usize) -> usize {
        if let Some(bytes) = &mut self.bytes {
            // As many bytes as the number needs, so that a fuzzer that changes one changes one choice.
            let many = (usize::BITS - (n - 1).leading_zeros()).div_ceil(8).max(1);
            let number = bytes.by_ref().take(many as usize).fold(0, |sum, byte| sum << 8 | usize::from(byte));
            return number % n;
        }
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 11) as usize % n
    }

    /// Returns one of the choices.
    pub fn of<'a, T: ?Sized>(&mut self, choices: &[&'a T]) -> &'a T {
        choices[self.below(choices.len())]
    }

    /// Returns a number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.below(1 << 24) as f64 / f64::from(1 << 24))
    }
}
