//! Random numbers and configurations that depend only on a seed.

use super::{Configuration, Topology};

/// A sequence of random numbers, the same on every machine for the same seed.
///
/// This is Sebastiano Vigna's SplitMix64, with 64 bits of state. It is implemented here so that no library release
/// can change the numbers of a seed.
#[derive(Debug, Clone)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// Creates the sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Creates the sequence with this number among the sequences of a seed.
    pub fn nth(seed: u64, number: u64) -> Self {
        // Numbers of a sequence are random enough to be seeds themselves.
        let mut seeds = Self(seed ^ number.rotate_left(32));
        Self(seeds.bits())
    }

    /// Returns the next 64 bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number that is uniform in `[0, 1)` and a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a uniformly distributed configuration within the limits; on circles, within one turn. Draws the value of
    /// joint 1 first.
    pub fn configuration(&mut self, topology: &Topology) -> Configuration {
        let [q1, q2] = topology.ranges.map(|axis| {
            let (lower, upper) = axis.domain();
            (lower + (upper - lower) * self.unit()).clamp(lower, upper)
        });
        Configuration::new(q1, q2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequence_equals_the_published_one() {
        let mut draws = SplitMix64::new(1_234_567);
        let numbers: Vec<u64> = (0..5).map(|_| draws.bits()).collect();
        let published = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!(numbers, published);
    }

    #[test]
    fn units_fill_the_interval_evenly() {
        let mut draws = SplitMix64::new(7);
        let mut counts = [0_i32; 10];
        for _ in 0..100_000 {
            let unit = draws.unit();
            assert!((0.0..1.0).contains(&unit));
            counts[(unit * 10.0) as usize] += 1;
        }
        // Five standard deviations of a binomial count: 5 sqrt(100000 * 0.09).
        assert!(counts.iter().all(|n| (n - 10_000).abs() < 475), "{counts:?}");
    }
}
