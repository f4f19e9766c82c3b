//! Settings of the field planner: the field, its equation, and its solution.

use crate::{Device, Difference, Direction, Equation, Escape, Initial, Khatib, Limits, Measure, Relaxation, Stencil};
use cplan_planners::cspace::ZonedGrid;
use cplan_planners::planner::PathKind;
use serde::{Deserialize, Serialize};
use std::fmt;

/// An equation as the user chooses it, without a grid. On a grid, it becomes an [`Equation`], in which arrays with one entry per
/// cell represent the zones of the workspace.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EquationChoice {
    /// Laplace's equation.
    Harmonic,
    /// The same drift in all cells.
    Oriented {
        /// Direction of the drift, in joint space.
        direction: Direction,
        /// Strength of the drift, per cell.
        epsilon: f64,
        /// Discretisation of slopes.
        difference: Difference,
    },
    /// A separate drift in each zone, and no drift elsewhere.
    LocallyOriented {
        /// Direction of the drift in zones that have no direction of their own.
        direction: Option<Direction>,
        /// Discretisation of slopes.
        difference: Difference,
    },
    /// Preferences. The drift is along the slope of the harmonic field.
    Preference {
        /// Strength of the drift outside all zones.
        elsewhere: f64,
        /// Discretisation of slopes.
        difference: Difference,
    },
    /// Altered preferences. The drift is along the slope of the field itself.
    AlteredPreference {
        /// Strength of the drift outside all zones.
        elsewhere: f64,
    },
}

/// The kind of a field.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldChoice {
    /// The solution of an equation, computed by relaxation.
    Relaxed {
        /// The equation that is solved.
        equation: EquationChoice,
        /// The relaxation that solves it.
        relaxation: Relaxation,
        /// Measure of the changes in a sweep, which must fall below the tolerance. Only the relative measure notices changes of
        /// small values. With another measure, values around the path may still be too small at the end, so that the path gets
        /// stuck. Relaxation then continues with the relative measure.
        #[serde(default, skip_serializing_if = "Measure::is_relative")]
        measure: Measure,
        /// Tolerance: relaxation ends when the measure is below it.
        tolerance: f64,
        /// Largest number of sweeps in each stage.
        max_sweeps: usize,
        /// The device that relaxes the field.
        #[serde(default, skip_serializing_if = "Device::is_cpu")]
        on: Device,
        /// Treatment of cells that are not square: whether the equation takes their shape into account.
        #[serde(default, skip_serializing_if = "Stencil::is_square")]
        stencil: Stencil,
        /// Value of free cells before the first sweep.
        #[serde(default, skip_serializing_if = "Initial::is_high")]
        initial: Initial,
    },
    /// Attraction by the goal and repulsion by obstacles.
    Khatib(Khatib),
}

/// A planner that computes a field on the cells of a grid and follows it from the start to a goal. The fixed values are
/// [`Levels::PROBABILITY`](crate::Levels::PROBABILITY), with which small values have the same relative precision as large ones.
///
/// The field may not lead to a goal: there may be a local minimum, values may differ by less than the precision of doubles (on a
/// GPU, of single precision), or relaxation may diverge. Then the planner gives up and reports where and why. Only
/// [`Proposal::NoPath`](cplan_planners::planner::Proposal::NoPath) means that there is no path through free cells.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldPlanner {
    /// The field whose gradient is followed.
    pub field: FieldChoice,
    /// Boundary condition at the limits of intervals.
    pub limits: Limits,
    /// Escape from local minima of attraction and repulsion. With `None`, the planner gives up in a local minimum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub escape: Option<Escape>,
    /// Kind of the path. [`PathKind::Own`] is the curve along the gradient or the force.
    pub path: PathKind,
}

impl EquationChoice {
    /// Returns the equation on a grid. Takes `O(cells)`.
    ///
    /// # Errors
    /// Returns the reason, in words, if a zone lacks a direction that the equation needs.
    pub fn on(self, space: &ZonedGrid, stencil: Stencil) -> Result<Equation, String> {
        let cells = 0..space.grid.blocked.len();
        // If cells count as square, a direction in joint space must be converted to units of cells.
        let step = if stencil.is_square() { space.grid.step() } else { [1.0; 2] };
        let in_cells = |direction: Direction| {
            let [a, b] = direction.components();
            Direction::of([a / step[0], b / step[1]]).unwrap_or(direction)
        };
        let strengths = |elsewhere: f64| {
            cells.clone().map(|cell| space.zone(cell).map_or(elsewhere, |zone| zone.epsilon)).collect()
        };
        Ok(match self {
            Self::Harmonic => Equation::Harmonic,
            Self::Oriented { direction, epsilon, difference } => {
                Equation::Oriented { direction: in_cells(direction), epsilon, difference }
            }
            Self::Preference { elsewhere, difference } => {
                Equation::Preference { epsilon: strengths(elsewhere), difference }
            }
            Self::AlteredPreference { elsewhere } => Equation::AlteredPreference { epsilon: strengths(elsewhere) },
            Self::LocallyOriented { direction, difference } => {
                let drift = |cell: usize| match space.zone(cell) {
                    None => Ok([0.0; 2]),
                    Some(zone) => zone
                        .direction
                        .and_then(Direction::of)
                        .or(direction)
                        .map(|direction| in_cells(direction).drift(zone.epsilon))
                        .ok_or_else(|| format!("the preference \"{}\" has no direction", zone.name)),
                };
                Equation::LocallyOriented { drift: cells.clone().map(drift).collect::<Result<_, _>>()?, difference }
            }
        })
    }
}

impl fmt::Display for EquationChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Harmonic => write!(f, "harmonic"),
            Self::Oriented { direction, epsilon, difference } => {
                let [a, b] = direction.components();
                write!(f, "oriented, epsilon {epsilon}, direction ({a:.4}, {b:.4}), {difference}")
            }
            Self::LocallyOriented { difference, .. } => write!(f, "oriented by region, {difference}"),
            Self::Preference { elsewhere, difference } => {
                write!(f, "preferences, epsilon {elsewhere} outside of regions, {difference}")
            }
            Self::AlteredPreference { elsewhere } => {
                write!(f, "altered preferences, epsilon {elsewhere} outside of regions")
            }
        }
    }
}

impl fmt::Display for FieldPlanner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.field {
            FieldChoice::Relaxed { equation, relaxation, on, stencil, initial, .. } => {
                write!(f, "{equation}; {relaxation}")?;
                if !initial.is_high() {
                    f.write_str("; free cells start low")?;
                }
                if !stencil.is_square() {
                    f.write_str("; anisotropic stencil")?;
                }
                if !on.is_cpu() {
                    write!(f, "; on {}", on.adapter().ok().flatten().unwrap_or("a GPU"))?;
                }
            }
            FieldChoice::Khatib(Khatib { attraction, repulsion, saturated }) => {
                write!(
                    f,
                    "attraction {attraction}, repulsion {repulsion}{}",
                    if saturated { ", saturated" } else { "" }
                )?;
                if let Some(escape) = self.escape {
                    write!(f, ", escape {escape}")?;
                }
            }
        }
        write!(f, "; limits {}", if self.limits == Limits::High { "high" } else { "reflecting" })
    }
}
