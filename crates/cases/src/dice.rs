//! Random numbers for generators written by hand, the same in every run.

use std::fmt::Debug;

/// A generator of pseudorandom numbers: SplitMix64 (Steele, Lea, Flood, *Fast splittable pseudorandom number
/// generators*, 2014).
pub struct Dice(u64);

impl Dice {
    /// Returns the generator with this seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Draws 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Draws a number that is uniform in `[from, to)`.
    pub fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Draws a whole number, at least 0 and below `n`.
    ///
    /// # Panics
    /// If `n` is not positive.
    pub fn below<N>(&mut self, n: N) -> N
    where
        N: TryInto<u64, Error: Debug> + TryFrom<u64, Error: Debug>,
    {
        let n = n.try_into().expect("a positive number");
        N::try_from(self.bits() % n).expect("less than another")
    }

    /// Draws a whole number from `-n` to `n`.
    pub fn about_zero(&mut self, n: i64) -> i64 {
        self.below(2 * n + 1) - n
    }

    /// Draws a truth value that is true in this share of the cases.
    pub fn chance(&mut self, share: f64) -> bool {
        self.within(0.0, 1.0) < share
    }
}
