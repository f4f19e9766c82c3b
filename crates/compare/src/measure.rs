//! Quantities measured for each run.

use super::comparison::Comparison;
use super::row::Row;

/// A number that runs are compared by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Length of the path over the proven bound on all.
    OverOptimum,
    /// Proven least distance from the obstacles.
    Clearance,
    /// Time that the motion takes.
    Duration,
    /// Computing time to prepare the space.
    Build,
    /// Computing time to answer the query.
    Query,
    /// Computing time of the certificate.
    Certify,
    /// Computing time to the verdict.
    Total,
    /// Memory at the most.
    Memory,
}

impl Measure {
    /// All measures, in the order of the tables.
    pub const ALL: [Measure; 8] = [
        Measure::OverOptimum,
        Measure::Clearance,
        Measure::Duration,
        Measure::Build,
        Measure::Query,
        Measure::Certify,
        Measure::Total,
        Measure::Memory,
    ];

    /// Returns its heading, with the unit used in tables.
    #[must_use]
    pub fn heading(self) -> &'static str {
        match self {
            Measure::OverOptimum => "length over the proven optimum",
            Measure::Clearance => "clearance [mm]",
            Measure::Duration => "motion [s]",
            Measure::Build => "build [ms]",
            Measure::Query => "query [ms]",
            Measure::Certify => "certify [ms]",
            Measure::Total => "total [ms]",
            Measure::Memory => "memory [MiB]",
        }
    }

    /// Returns its key in JSON, which uses SI units and bytes.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Measure::OverOptimum => "over_optimum",
            Measure::Clearance => "clearance",
            Measure::Duration => "duration",
            Measure::Build => "build",
            Measure::Query => "query",
            Measure::Certify => "certify",
            Measure::Total => "total",
            Measure::Memory => "memory",
        }
    }

    /// Formats a value in the unit of the heading.
    #[must_use]
    pub fn shown(self, value: f64) -> String {
        let decimals = match self {
            Measure::OverOptimum => 4,
            Measure::Memory => 2,
            _ => 3,
        };
        format!("{:.decimals$}", value * self.scale())
    }

    /// Returns the factor from SI units to the unit of the heading.
    #[must_use]
    pub fn scale(self) -> f64 {
        match self {
            Measure::OverOptimum | Measure::Duration => 1.0,
            Measure::Memory => 1.0 / f64::from(1 << 20),
            _ => 1e3,
        }
    }

    /// Returns a run's value, in SI units and bytes, if it has one.
    #[must_use]
    pub fn of(self, comparison: &Comparison, row: &Row) -> Option<f64> {
        match self {
            Measure::OverOptimum => comparison.over_optimum(row),
            Measure::Clearance => row.clearance,
            Measure::Duration => row.duration,
            Measure::Build => row.build,
            Measure::Query => row.query,
            Measure::Certify => row.certify,
            Measure::Total => row.total,
            Measure::Memory => row.memory.map(|bytes| bytes as f64),
        }
        .filter(|value| value.is_finite())
    }
}
