//! SplitMix64: a seed, and ever the same numbers.

#[derive(Clone, Debug)]
pub struct Dice(pub u64);

const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

impl Dice {
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    /// As if so many numbers had been taken.
    pub fn skip(&mut self, numbers: usize) {
        self.0 = self.0.wrapping_add(STEP.wrapping_mul(numbers as u64));
    }

    /// A number below `limit`, which is far below the range of a word: none is noticeably preferred.
    pub fn below(&mut self, limit: usize) -> usize {
        ((u128::from(self.word()) * limit as u128) >> 64) as usize
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// From 0 on, below 1.
    pub fn part(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
    }
}
