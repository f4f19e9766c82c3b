//! Random cases for tests: their number and their seeds. They are the same in every run, unless the environment
//! requests others. The submodules generate numbers, mazes, cells of two arms, and texts with typing
//! mistakes. The module [`plane`] has distances for oracles.
//!
//! - `CPLAN_TIMES=20`: twenty times as many cases (0.1: a tenth).
//! - `CPLAN_SEED=7`: other cases, choice number seven; 0 is the default. The same two variables reproduce a failure.

pub mod cells;
pub mod dice;
pub mod mazes;
pub mod plane;
pub mod slips;

use dice::Dice;
use proptest::test_runner::{Config, RngSeed};
use std::ops::Range;
use std::str::FromStr;

/// Distance between the first seeds of consecutive values of `CPLAN_SEED`.
const SEED_STRIDE: u64 = 1 << 32;

/// Returns the configuration for `proptest!`: this many cases, always the same. Every block must have it
/// (`tests/architecture/seeds.rs`).
///
/// # Panics
/// If `CPLAN_TIMES` or `CPLAN_SEED` is not a number.
pub fn cases(usual: u32) -> Config {
    let cases = u32::try_from(times(u64::from(usual))).expect("CPLAN_TIMES is too large");
    Config {
        cases,
        // `prop_assume` may turn down twenty draws for each case that is kept.
        max_global_rejects: cases.saturating_mul(20).max(1024),
        rng_seed: RngSeed::Fixed(seed()),
        // A file of failures would change the next run. Instead, turn each failure into a named test.
        failure_persistence: None,
        ..Config::default()
    }
}

/// Returns seeds for generators written by hand: this many, always the same.
///
/// # Panics
/// Same as [`cases`].
pub fn seeds(usual: u64) -> Range<u64> {
    let first = seed().wrapping_mul(SEED_STRIDE);
    first..first + times(usual)
}

/// Returns the generator with this number. It depends on `CPLAN_SEED`.
///
/// # Panics
/// Same as [`cases`].
pub fn dice(stream: u64) -> Dice {
    Dice::new(stream ^ seed().wrapping_mul(0xd134_2543_de82_ef95))
}

/// Returns the number of cases, given the default number; at least one.
///
/// # Panics
/// Same as [`cases`].
pub fn times(usual: u64) -> u64 {
    let factor = from_environment("CPLAN_TIMES", 1.0);
    assert!(factor > 0.0 && factor < 1e9, "CPLAN_TIMES must be a positive factor, not {factor}");
    ((usual as f64 * factor).round() as u64).max(1)
}

/// Returns `CPLAN_SEED`, the number of the choice of cases.
///
/// # Panics
/// Same as [`cases`].
pub fn seed() -> u64 {
    from_environment("CPLAN_SEED", 0)
}

/// Returns true if the cases are the default ones. Only then may tests count how many cases of a kind occur.
///
/// # Panics
/// Same as [`cases`].
pub fn uses_default_cases() -> bool {
    seed() == 0 && times(1 << 20) == 1 << 20
}

fn from_environment<T: FromStr>(name: &str, usual: T) -> T {
    match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|_| panic!("{name} is not a number: {text:?}")),
        Err(_) => usual,
    }
}
