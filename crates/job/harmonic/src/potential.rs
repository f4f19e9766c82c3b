//! Positive numbers of practically unlimited range, and potentials of such numbers.

use super::Component;

/// Binary logarithm of the base of exponents. The base is so large that neighbours usually have the same exponent and can be
/// averaged as plain doubles.
const EXPONENT_STEP: i32 = 256;
/// Factor `2^-EXPONENT_STEP`, which lowers the exponent by 1.
const STEP_DOWN: f64 = f64::from_bits(((1023 - EXPONENT_STEP) as u64) << 52);
/// Factor `2^EXPONENT_STEP`, which raises the exponent by 1.
const STEP_UP: f64 = f64::from_bits(((1023 + EXPONENT_STEP) as u64) << 52);
/// Least mantissa of a normalised number. The greatest is its reciprocal, `2^192`. This range is wider than the base, so values
/// near a boundary do not alternate between two exponents. Products and sums of several cells stay within the range of doubles.
const MIN_MANTISSA: f64 = f64::from_bits((1023 - 192) << 52);
const MAX_MANTISSA: f64 = f64::from_bits((1023 + 192) << 52);

/// A positive number `mantissa * 2^(256 exponent)`. In a narrow corridor, a harmonic potential falls to about a quarter per cell,
/// so doubles would underflow after 540 cells. These numbers do not underflow within 10^9 cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ScaledNumber {
    pub mantissa: f64,
    pub exponent: i32,
}

impl ScaledNumber {
    /// Returns the same number with a mantissa in `2^-192 ..= 2^192`, with the least change of exponent.
    pub fn normalized(mut self) -> Self {
        while self.mantissa < MIN_MANTISSA {
            self.mantissa *= STEP_UP;
            self.exponent -= 1;
        }
        while self.mantissa > MAX_MANTISSA {
            self.mantissa *= STEP_DOWN;
            self.exponent += 1;
        }
        self
    }

    /// Returns the binary logarithm of the number.
    pub fn log2(self) -> f64 {
        self.mantissa.log2() + f64::from(self.exponent) * f64::from(EXPONENT_STEP)
    }

    /// Returns the number with the given binary logarithm.
    pub fn exp2(log2: f64) -> Self {
        let exponent = (log2 / f64::from(EXPONENT_STEP)).round();
        Self { mantissa: (log2 - exponent * f64::from(EXPONENT_STEP)).exp2(), exponent: exponent as i32 }
    }

    /// Returns the mantissa for `exponent`: 0 or `2^704` if the number is too small or too large beside numbers with that
    /// exponent.
    pub fn mantissa_at(self, exponent: i32) -> f64 {
        match exponent.saturating_sub(self.exponent) {
            ..=-2 => MAX_MANTISSA * STEP_UP * STEP_UP,
            -1 => self.mantissa * STEP_UP,
            0 => self.mantissa,
            1 => self.mantissa * STEP_DOWN,
            2 => self.mantissa * STEP_DOWN * STEP_DOWN,
            _ => 0.0,
        }
    }
}

/// A positive value for every position of a [`Component`], and 0 for walls. Each value has its own exponent, so it has
/// the relative precision of doubles, however far the goal is.
#[derive(Debug, Clone, PartialEq)]
pub struct Potential {
    /// Mantissa at each position, and then 0 for walls.
    pub(super) mantissa: Vec<f64>,
    /// Exponent at each position, without walls. Empty while all values are 0.
    exponent: Vec<i32>,
}

impl Potential {
    /// Creates the potential with `2^log2` at every position.
    pub fn from_log2(log2: &[f64]) -> Self {
        let mut potential = Self::zero(log2.len());
        log2.iter().enumerate().for_each(|(position, &log2)| potential.set(position, ScaledNumber::exp2(log2)));
        potential
    }

    /// Creates a potential that is zero in all cells.
    pub(super) fn zero(len: usize) -> Self {
        Self { mantissa: vec![0.0; len + 1], exponent: Vec::new() }
    }

    /// Sets the number at a position.
    pub(super) fn set(&mut self, position: usize, value: ScaledNumber) {
        self.mantissa[position] = value.mantissa;
        if value.exponent != 0 && self.exponent.is_empty() {
            self.exponent.resize(self.mantissa.len(), 0);
        }
        if let Some(exponent) = self.exponent.get_mut(position) {
            *exponent = value.exponent;
        }
    }

    /// Returns the number at a position.
    pub(super) fn at(&self, position: usize) -> ScaledNumber {
        ScaledNumber { mantissa: self.mantissa[position], exponent: self.exponent.get(position).copied().unwrap_or(0) }
    }

    /// Returns the natural logarithm of the value at `position`; minus infinity for the wall.
    pub fn ln(&self, position: usize) -> f64 {
        let ScaledNumber { mantissa, exponent } = self.at(position);
        mantissa.ln() + f64::from(exponent) * f64::from(EXPONENT_STEP) * std::f64::consts::LN_2
    }

    /// Returns true if the value at `a` is strictly greater than that at `b`. Exact.
    pub fn is_greater(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.at(a), self.at(b));
        if a.mantissa == 0.0 || b.mantissa == 0.0 {
            return a.mantissa > b.mantissa;
        }
        let exponent = a.exponent.max(b.exponent);
        a.mantissa_at(exponent) > b.mantissa_at(exponent)
    }

    /// Returns the neighbour of `position` with the greatest value (the first of equals), if it is strictly greater
    /// than at `position`.
    pub fn ascent(&self, component: &Component, position: usize) -> Option<usize> {
        component
            .neighbors(position)
            .into_iter()
            .fold(None, |best, n| if self.is_greater(n, best.unwrap_or(position)) { Some(n) } else { best })
    }

    /// Returns true if every cell except the goals has a strictly greater neighbour, so that steepest ascent leads to a goal from
    /// everywhere. Linear.
    pub fn navigates(&self, component: &Component) -> bool {
        (component.goals..component.len()).all(|i| component.neighbors(i).into_iter().any(|n| self.is_greater(n, i)))
    }

    /// Returns the positions from `from` to a goal by steepest ascent. `None` if it ends in a local maximum, which
    /// [`Potential::navigates`] excludes.
    pub fn ascend(&self, component: &Component, from: usize) -> Option<Vec<usize>> {
        let mut positions = vec![from];
        let mut at = from;
        while at >= component.goals {
            at = self.ascent(component, at)?;
            positions.push(at);
        }
        Some(positions)
    }
}
