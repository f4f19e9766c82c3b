//! The sign test: whether one side wins more often than is likely by chance.

/// Returns the two-sided p-value of the sign test: the probability that as many throws of a fair coin are at least as uneven as
/// `wins` to `losses`. 1 without throws. `O(n)` for `n` throws.
pub fn sign_test(wins: usize, losses: usize) -> f64 {
    let n = wins + losses;
    let fewer = wins.min(losses);
    // Binomial coefficients times 2^-n, as logarithms, because 2^-n underflows beyond a thousand throws.
    let mut log_term = -(n as f64) * std::f64::consts::LN_2;
    let mut tail = 0.0;
    for k in 0..=fewer {
        tail += log_term.exp();
        log_term += ((n - k) as f64 / (k + 1) as f64).ln();
    }
    (2.0 * tail).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes the same probability by enumerating all throws.
    fn enumerated_probability(wins: usize, losses: usize) -> f64 {
        let n = wins + losses;
        let fewer = wins.min(losses) as u32;
        let uneven = (0..1_u32 << n).filter(|coins| coins.count_ones().min(n as u32 - coins.count_ones()) <= fewer);
        uneven.count() as f64 / f64::from(1_u32 << n)
    }

    #[test]
    fn the_sign_test_matches_enumeration() {
        for wins in 0..8 {
            for losses in 0..8 {
                let (test, all) = (sign_test(wins, losses), enumerated_probability(wins, losses));
                assert!((test - all).abs() < 1e-12, "{wins} to {losses}: {test} {all}");
            }
        }
    }

    #[test]
    fn many_coins_underflow_to_zero() {
        assert!((sign_test(1000, 1000) - 1.0).abs() < 1e-12);
        let rare = sign_test(3000, 0);
        assert!((0.0..1e-300).contains(&rare));
    }
}
