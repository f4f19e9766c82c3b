//! Who goes how far, and when it ends.

use super::GpuError;

/// Who goes when.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sweep {
    /// All cells at once, from the values of the sweep before: Jacobi's relaxation; with a factor below 1 the weighted one.
    Jacobi,
    /// First the cells whose indices have an even sum, then the others, each from the newest values: Gauss-Seidel's relaxation; with
    /// a factor above 1 SOR.
    #[default]
    RedBlack,
}

/// What is measured in a sweep; `change` is the difference between a value after and before it.
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
    /// Difference between the sum of `|change|` and that of the sweep before.
    DifferenceOfSums,
}

/// How a problem is relaxed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Who goes when.
    pub sweep: Sweep,
    /// A cell goes so many times the way that its neighbours ask for.
    pub factor: f64,
    /// New values are brought into this range, if any.
    pub clamp: Option<[f64; 2]>,
    /// What is measured.
    pub measure: Measure,
    /// It has converged when the measure falls below this, or a sweep changes nothing.
    pub below: f64,
    /// It ends after so many sweeps anyway.
    pub max_sweeps: u32,
}

impl Default for Settings {
    /// Gauss-Seidel's, until the squares of a sweep's changes add up to less than 10^-6, as in Silva 2011.
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

/// How a relaxation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The measure fell below its bound, or nothing changed any more.
    Converged,
    /// Single precision goes no further: in 64 sweeps (or as many as the grid has rows or columns, if these are more) values changed by
    /// what may be rounding, eight units in the last place and with over-relaxation more, and the measure did not become less.
    Floor,
    /// Neither, after as many sweeps as the rule allows.
    Unconverged,
}

/// What the kernels know of settings and grid. The order is that of `Rule` in `kernels/rule.wgsl`.
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
    /// Partial sums of a sweep.
    pub blocks: u32,
    pub outside: f32,
    pub factor: f32,
    pub low: f32,
    pub high: f32,
    pub below: f32,
    pub beyond: f32,
    /// Relative changes up to this may be nothing but rounding.
    pub rounding: f32,
    /// So many sweeps that only round make a floor.
    pub patience: u32,
    pub unused: [u32; 2],
}

/// What the kernels say of a relaxation so far. The order is that of `State` in `kernels/rule.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct State {
    /// 0 while it goes on, and how it ended.
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
    /// Why they make no sense, if they do not.
    pub(super) fn refusal(&self) -> Option<GpuError> {
        let reason = match self {
            _ if !(self.factor.is_finite() && self.factor > 0.0) => {
                format!("a relaxation factor must be positive, this one is {}", self.factor)
            }
            // Written so that what is no number is refused, too.
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
