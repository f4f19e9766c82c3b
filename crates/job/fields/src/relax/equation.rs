//! The field equations.
//!
//! Each equation has the form `lap p + <b, grad p> = 0` with a drift `b = epsilon v`. A random walk with that drift ends at an
//! obstacle or a goal, and `p` is the expected level of that place. Lengths are in cells, so `epsilon` is a number per cell.

use super::Domain;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Discretisation of the slope in a drift term.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Difference {
    /// Central difference `(p_+ - p_-) / 2`, of second order. Monotone only for `|b_k| < 2` along each axis. With a stronger
    /// drift, values are no longer means of their neighbours: relaxations may diverge, and fields may have local minima.
    #[default]
    Central,
    /// One-sided difference with the neighbour in the direction of the drift, of first order. Monotone for every drift.
    Upwind,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Central => "central differences",
            Self::Upwind => "upwind differences",
        })
    }
}

/// Largest deviation of a direction's length from 1: a few rounding errors.
const UNIT_ROUNDING: f64 = 1e-15;

/// A direction in the plane of joint values: a unit vector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "[f64; 2]")]
pub struct Direction([f64; 2]);

impl TryFrom<[f64; 2]> for Direction {
    type Error = &'static str;

    /// Accepts a vector of length 1 unchanged, so that a direction is read as it was written to a file.
    fn try_from(vector: [f64; 2]) -> Result<Self, &'static str> {
        let length = vector[0].hypot(vector[1]);
        ((length - 1.0).abs() <= UNIT_ROUNDING)
            .then_some(Self(vector))
            .ok_or("a direction must be a vector of length 1")
    }
}

impl Direction {
    /// Returns the direction of a vector. `None` if its length is zero or NaN.
    pub fn of(vector: [f64; 2]) -> Option<Self> {
        let greatest = vector[0].abs().max(vector[1].abs());
        // Scaling first keeps the length from overflowing or vanishing.
        let scaled = vector.map(|x| x / greatest);
        let length = scaled[0].hypot(scaled[1]);
        (greatest > 0.0 && length.is_finite()).then(|| Self(scaled.map(|x| x / length)))
    }

    /// Returns the components along the first and the second joint.
    pub fn components(self) -> [f64; 2] {
        self.0
    }

    /// Returns the drift `epsilon v`.
    pub fn drift(self, epsilon: f64) -> [f64; 2] {
        self.0.map(|v| epsilon * v)
    }
}

/// An equation for the values of free cells. Arrays have one entry per cell of the domain; entries of obstacles and goals have no
/// effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Equation {
    /// Laplace's equation `lap p = 0` (Connolly, Grupen 1993).
    Harmonic,
    /// `lap p + epsilon <v, grad p> = 0` with the same drift in all cells (Prestes 2003).
    Oriented {
        /// The direction `v`.
        direction: Direction,
        /// The strength `epsilon`, per cell.
        epsilon: f64,
        /// Discretisation of the drift.
        difference: Difference,
    },
    /// A separate drift in every cell, possibly 0: around robots (Faria 2006, see [`drift_around_robots`]), or in regions.
    LocallyOriented {
        /// The drift `epsilon v` of each cell.
        drift: Vec<[f64; 2]>,
        /// Discretisation of the drift.
        difference: Difference,
    },
    /// Preferences (Prestes, Idiart 2009): `v` is the normalised gradient of the harmonic field, towards obstacles, and each cell
    /// has the `epsilon` of its region. A positive `epsilon` makes the region less attractive, a negative one more. Relaxation
    /// has two stages, of which the first gives the harmonic field.
    Preference {
        /// The strength `epsilon` of each cell.
        epsilon: Vec<f64>,
        /// Discretisation of the drift.
        difference: Difference,
    },
    /// Altered preferences ("BVP 2" of Deicu 2012): `p = h + epsilon / 4 d`, where `h` is the mean of the four neighbours and
    /// `d = |p_E - p_W| / 2 + |p_N - p_S| / 2`. This equation is not linear, because the drift is along the slope of the field
    /// itself. It also has two stages.
    ///
    /// This formula is for high obstacles. For low ones, `epsilon` has the opposite sign: with `u = 1 - p`, the mean becomes
    /// `1 - h` and `d` stays the same, so `u = h - epsilon / 4 d` in terms of the new mean.
    AlteredPreference {
        /// One value per cell.
        epsilon: Vec<f64>,
    },
}

/// A disc of cells with a drift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Influence {
    /// Centre as row and column, which may be fractions. Whole numbers are the centres of cells.
    pub center: [f64; 2],
    /// Radius, in cells.
    pub radius: f64,
    /// The drift `epsilon v` in the cells of the disc.
    pub drift: [f64; 2],
}

/// Returns the drift of [`Equation::LocallyOriented`] around robots. Each cell has the drift of the nearest robot, if it is
/// within that robot's radius, otherwise none. `O(cells * influences)`.
pub fn drift_around_robots(domain: &Domain, influences: &[Influence]) -> Vec<[f64; 2]> {
    let columns = domain.cells()[1];
    let nearest = |cell: usize| {
        let at = [(cell / columns) as f64, (cell % columns) as f64];
        // Squares are compared, because roots would take longer than all the rest.
        let square = |i: &Influence| (at[0] - i.center[0]).powi(2) + (at[1] - i.center[1]).powi(2);
        let nearest = influences.iter().min_by(|a, b| square(a).total_cmp(&square(b)))?;
        (nearest.radius > 0.0 && square(nearest) < nearest.radius.powi(2)).then_some(nearest.drift)
    };
    (0..domain.kinds().len()).map(|cell| nearest(cell).unwrap_or_default()).collect()
}

/// A function that returns the drift of a cell.
pub(super) type DriftOf<'a> = Box<dyn Fn(usize) -> [f64; 2] + 'a>;

impl Equation {
    /// Returns true if each cell's value is a mean of its neighbours' values with non-negative weights. Then no value leaves the
    /// range of the fixed values, and goals are the only minima. Assumes square cells.
    pub fn is_monotone(&self) -> bool {
        self.is_monotone_with(1.0)
    }

    /// Does the same as [`Equation::is_monotone`] for a domain, whose cells need not be square.
    pub fn is_monotone_on(&self, domain: &Domain) -> bool {
        self.is_monotone_with(domain.beta())
    }

    fn is_monotone_with(&self, beta: f64) -> bool {
        let is_small = |[first, second]: [f64; 2]| first.abs() < 2.0 && second.abs() < 2.0 * beta;
        let small = |epsilon: f64| is_small([epsilon; 2]);
        match self {
            Self::Harmonic => true,
            Self::Oriented { difference: Difference::Upwind, .. }
            | Self::LocallyOriented { difference: Difference::Upwind, .. }
            | Self::Preference { difference: Difference::Upwind, .. } => true,
            Self::Oriented { direction, epsilon, .. } => is_small(direction.drift(*epsilon)),
            Self::LocallyOriented { drift, .. } => drift.iter().copied().all(is_small),
            Self::Preference { epsilon, .. } | Self::AlteredPreference { epsilon } => {
                epsilon.iter().copied().all(small)
            }
        }
    }

    /// Returns true for the equations with preferences, which have two stages.
    pub(crate) fn has_preferences(&self) -> bool {
        matches!(self, Self::Preference { .. } | Self::AlteredPreference { .. })
    }

    /// Returns the drift of each cell, and its discretisation. `None` if the drift depends on a field.
    pub(super) fn drift(&self) -> Option<(DriftOf<'_>, Difference)> {
        match self {
            Self::Harmonic => Some((Box::new(|_| [0.0; 2]), Difference::Central)),
            Self::Oriented { direction, epsilon, difference } => {
                let drift = direction.drift(*epsilon);
                Some((Box::new(move |_| drift), *difference))
            }
            Self::LocallyOriented { drift, difference } => Some((Box::new(|cell| drift[cell]), *difference)),
            Self::Preference { .. } | Self::AlteredPreference { .. } => None,
        }
    }

    /// Returns the reason why the equation is invalid on this domain. `None` if it is valid.
    pub(super) fn refusal(&self, domain: &Domain) -> Option<String> {
        let cells = domain.kinds().len();
        let (count, finite) = match self {
            Self::Harmonic => (cells, true),
            Self::Oriented { epsilon, .. } => (cells, epsilon.is_finite()),
            Self::LocallyOriented { drift, .. } => (drift.len(), drift.iter().flatten().all(|b| b.is_finite())),
            Self::Preference { epsilon, .. } | Self::AlteredPreference { epsilon } => {
                (epsilon.len(), epsilon.iter().all(|e| e.is_finite()))
            }
        };
        if count != cells {
            return Some(format!("the equation has {count} cells, but the domain has {cells}"));
        }
        (!finite).then(|| "epsilon must be a finite number".into())
    }
}
