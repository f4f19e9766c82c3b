//! The field that a planner followed, as results describe it.

use serde::Serialize;

/// Settings of a field and the result of its relaxation, in the words of the command line. Fields that do not apply to
/// the equation are omitted. The number of sweeps is among the sizes of the report.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct FieldReport {
    /// Name of the field: `harmonic`, `oriented`, `local`, `bvp`, `bvp2` or `khatib`.
    pub equation: &'static str,
    /// Strength of the drift, per cell: everywhere, or outside zones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub epsilon: Option<f64>,
    /// Direction of the drift in joint space, of length 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 2]>,
    /// Discretisation of slopes: `central` or `upwind`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference: Option<&'static str>,
    /// Relaxation: `jacobi`, `weighted-jacobi`, `gauss-seidel` or `sor`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relaxation: Option<&'static str>,
    /// Order of updates: `rows`, `columns`, `corners` or `red-black`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<String>,
    /// Relaxation factor on the last grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// True if over-relaxation also multiplies preferences by its factor; omitted if it adds them without the factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relaxes_preferences: Option<bool>,
    /// `low` if free cells start at the value of goals; omitted if they start at the value of obstacles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
    /// `anisotropic` if the equation takes the shape of cells into account; omitted if cells count as square.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stencil: Option<&'static str>,
    /// Measure that must fall below the tolerance: `absolute`, `greatest`, `squares` or `sums`; omitted for the
    /// relative change.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measure: Option<&'static str>,
    /// Tolerance: the field has converged when the measure falls below this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Largest number of sweeps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_sweeps: Option<usize>,
    /// Name and interface of the GPU that relaxed the field; omitted for the CPU.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<&'static str>,
    /// Law of the attraction by the goal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attraction: Option<String>,
    /// Law of the repulsion by obstacles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repulsion: Option<String>,
    /// True if both forces pass through tanh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saturated: Option<bool>,
    /// Escape from local minima, as on the command line; omitted if local minima end the search.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub escape: Option<String>,
    /// Number of local minima from which the path escaped; omitted without `escape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub escaped: Option<usize>,
    /// Boundary condition at joint limits: `high` or `reflecting`.
    pub limits: &'static str,
    /// True if relaxation reached the tolerance; omitted for fields without relaxation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub converged: Option<bool>,
}
