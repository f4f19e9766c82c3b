//! Parameters and state of a relaxation, as the kernels read them.

use cplan_fields::Measure;

/// Reason why a relaxation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The measure fell below its bound, or nothing changed.
    Converged,
    /// Single precision allows no further progress. The measure did not decrease, and changes were within rounding, for
    /// a number of sweeps: at least 64, and at least the number of rows and of columns. Rounding is eight units in the
    /// last place, or more with over-relaxation.
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
    /// Number of sweeps with changes within rounding after which the relaxation ends with [`Ending::Floor`].
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

/// Returns the code of a measure in the kernels.
pub(super) fn code(measure: Measure) -> u32 {
    match measure {
        Measure::SumOfChange => 0,
        Measure::SumOfSquares => 1,
        Measure::GreatestChange => 2,
        Measure::GreatestRelativeChange => 3,
        Measure::DifferenceOfSums => 4,
    }
}
