//! Settings of a relaxation: order of updates, factor and stopping rule.

use super::GpuError;

/// The order of updates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sweep {
    /// Updates all cells at once from the values of the previous sweep: Jacobi relaxation, weighted if the factor is
    /// below 1.
    Jacobi,
    /// Updates first the cells whose indices have an even sum, then the others, each from the newest values:
    /// Gauss-Seidel relaxation, or SOR if the factor is above 1.
    #[default]
    RedBlack,
}

/// The quantity that is measured in a sweep. `change` is the difference of a cell's value before and after the sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Measure {
    /// Sum of `|change|`.
    Sum,
    /// Sum of `change^2`.
    #[default]
    Squares,
    /// Greatest `|change|`.
    Greatest,
    /// Greatest `|change| / |value after|`.
    Relative,
    /// Difference between the sum of `|change|` and that of the previous sweep.
    DifferenceOfSums,
}

/// Settings of a relaxation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The order of updates.
    pub sweep: Sweep,
    /// Relaxation factor: a cell's value changes by this multiple of its difference from the implied value.
    pub factor: f64,
    /// Range to which new values are clamped; `None` for no limits.
    pub clamp: Option<[f64; 2]>,
    /// The measured quantity.
    pub measure: Measure,
    /// Bound for the measure. The relaxation has converged when the measure falls below the bound, or when a sweep
    /// changes nothing.
    pub below: f64,
    /// Largest number of sweeps.
    pub max_sweeps: u32,
}

impl Default for Settings {
    /// Returns the settings of Silva 2011: Gauss-Seidel relaxation until the squared changes of a sweep add up to less
    /// than 10^-6.
    fn default() -> Self {
        Self {
            sweep: Sweep::RedBlack,
            factor: 1.0,
            clamp: None,
            measure: Measure::Squares,
            below: 1e-6,
            max_sweeps: 10_000,
        }
    }
}

/// Reason why a relaxation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The measure fell below its bound, or nothing changed.
    Converged,
    /// Single precision allows no further progress: the measure did not decrease, and changes were within rounding, for
    /// 64 sweeps, or for as many as there are rows or columns if these are more. Rounding is eight units in the last
    /// place, or more with over-relaxation.
    Floor,
    /// The limit on the number of sweeps was reached.
    Unconverged,
}

/// Parameters of the relaxation for the kernels, in the order of `Rule` in `kernels/rule.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Rule {
    pub rows: u32,
    pub columns: u32,
    pub half: u32,
    pub edge_rows: u32,
    pub edge_columns: u32,
    pub odd: u32,
    pub stencil: u32,
    pub measure: u32,
    pub max_sweeps: u32,
    /// Number of partial sums that a sweep computes.
    pub blocks: u32,
    pub outside: f32,
    pub factor: f32,
    pub low: f32,
    pub high: f32,
    pub below: f32,
    pub beyond: f32,
    /// Greatest relative change that may be only rounding.
    pub rounding: f32,
    /// Number of sweeps with only rounding after which the relaxation ends with [`Ending::Floor`].
    pub patience: u32,
    pub unused: [u32; 2],
}

/// State of a relaxation on the GPU, in the order of `State` in `kernels/rule.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct State {
    /// The code of the ending, or 0 while the relaxation runs.
    pub done: u32,
    pub sweeps: u32,
    pub lost: u32,
    pub since: u32,
    pub change: f32,
    pub before: f32,
    pub least: f32,
    pub unused: f32,
}

impl Settings {
    /// Returns the reason why the settings are invalid. Returns `None` if they are valid.
    pub(super) fn refusal(&self) -> Option<GpuError> {
        let reason = match self {
            _ if !(self.factor.is_finite() && self.factor > 0.0) => {
                format!("a relaxation factor must be positive, this one is {}", self.factor)
            }
            // This comparison also refuses NaN.
            Self { clamp: Some([low, high]), .. } if !matches!(low.partial_cmp(high), Some(o) if o.is_le()) => {
                format!("values cannot be brought into the empty range {low}..{high}")
            }
            _ => return None,
        };
        Some(GpuError::Refused(reason))
    }
}

impl Measure {
    pub(super) fn code(self) -> u32 {
        match self {
            Self::Sum => 0,
            Self::Squares => 1,
            Self::Greatest => 2,
            Self::Relative => 3,
            Self::DifferenceOfSums => 4,
        }
    }
}
