//! A published number beside a measured one.

use std::fmt;

/// A claim about a measured number. The example fails if it is false.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Claim {
    /// The measured number equals the published one.
    Match,
    /// The measured number differs from the published one by at most this many per cent.
    Close(f64),
    /// The measured number may differ from the published one. A note below the table states the reason.
    Unmatched,
}

/// A published number, a measured one, and the claim about them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Count {
    /// The number printed in the source.
    pub published: f64,
    /// The measured number; `None` if the relaxation does not converge.
    pub measured: Option<f64>,
    /// The claim.
    pub claim: Claim,
}

impl Count {
    /// Pairs a published number of sweeps with the measured one.
    pub fn of_sweeps(published: usize, measured: Option<usize>, claim: Claim) -> Self {
        Self { published: published as f64, measured: measured.map(|sweeps| sweeps as f64), claim }
    }

    /// Returns the relative deviation of the measured number in per cent. Returns infinity if there is no measured
    /// number.
    fn deviation(&self) -> f64 {
        self.measured.map_or(f64::INFINITY, |measured| 100.0 * (measured / self.published - 1.0))
    }

    /// Returns true if the claim is true.
    pub fn holds(&self) -> bool {
        match self.claim {
            Claim::Match => self.measured == Some(self.published),
            Claim::Close(bound) => self.deviation().abs() <= bound,
            Claim::Unmatched => true,
        }
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Means have decimals, sweeps have none.
        let decimals = if self.published.fract() == 0.0 { 0 } else { 2 };
        let verdict = match self.claim {
            _ if !self.holds() => "NOT AS CLAIMED",
            Claim::Match => "match",
            Claim::Close(_) if self.deviation() == 0.0 => "match",
            Claim::Close(_) => "close",
            Claim::Unmatched => "unmatched",
        };
        write!(f, "{:>7.decimals$}", self.published)?;
        match self.measured {
            None => write!(f, "        -  {verdict}: does not converge"),
            Some(measured) if verdict == "match" => write!(f, " {measured:>8.decimals$}  {verdict}"),
            Some(measured) => write!(f, " {measured:>8.decimals$}  {verdict} {:+.1} %", self.deviation()),
        }
    }
}
