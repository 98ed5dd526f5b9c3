//! SplitMix64, a pseudorandom number generator of 64 bits of state (Steele, Lea, Flood: "Fast Splittable
//! Pseudorandom Number Generators", OOPSLA 2014): the same seed gives the same numbers on every platform.

/// The generator of pseudo-random numbers SplitMix64 (Steele, Lea and Flood 2014); its field is the state, at first
/// the seed. Any seed is valid.
#[derive(Clone, Debug)]
pub struct SplitMix64(pub u64);

/// The increment of the state: the golden ratio times 2⁶⁴, made odd.
const GAMMA: u64 = 0x9E37_79B9_7F4A_7C15;

impl SplitMix64 {
    /// Returns the next pseudo-random number, uniform over all of `u64`.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GAMMA);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    /// Advances the state as if `count` numbers had been taken by [`next_u64`](Self::next_u64), in constant time.
    pub fn skip(&mut self, count: usize) {
        self.0 = self.0.wrapping_add(GAMMA.wrapping_mul(count as u64));
    }

    /// Returns the next pseudo-random integer, uniform in `0..limit` up to a bias of `limit` / 2⁶⁴ (multiply and
    /// shift); 0 if `limit` is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        ((u128::from(self.next_u64()) * limit as u128) >> 64) as usize
    }

    /// Returns the next pseudo-random number, uniform in [-1, 1), a multiple of 2⁻⁵².
    pub fn next_signed(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Returns the next pseudo-random number, uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn next_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Permutes a list in place at random (Fisher and Yates): every permutation is equally likely up to the bias of
    /// [`below`](Self::below), as far as 64 bits of state can tell permutations apart.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
    }
}
