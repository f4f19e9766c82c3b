//! Quantities measured for each run.

use super::best::Better;
use super::comparison::Comparison;
use super::row::Row;

/// A quantity by which runs are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Length of the path, divided by the proven lower bound on all paths.
    OverOptimum,
    /// Proven lower bound on the distance from obstacles.
    Clearance,
    /// Duration of the motion.
    Duration,
    /// Computing time to prepare the space.
    Build,
    /// Computing time to answer the query.
    Query,
    /// Computing time to certify the path.
    Certify,
    /// Computing time from the problem to the outcome.
    Total,
    /// Greatest memory in use at a time.
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

    /// Returns the measure's heading, with the unit of the tables.
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

    /// Returns which value of the measure is the better one.
    pub fn better(self) -> Better {
        if self == Measure::Clearance { Better::More } else { Better::Less }
    }

    /// Returns the measure's key in JSON. Values in JSON are in SI units and bytes.
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
    pub fn format(self, value: f64) -> String {
        let decimals = match self {
            Measure::OverOptimum => 4,
            Measure::Memory => 2,
            _ => 3,
        };
        format!("{:.decimals$}", value * self.scale())
    }

    /// Returns the factor from SI units to the unit of the heading.
    pub fn scale(self) -> f64 {
        match self {
            Measure::OverOptimum | Measure::Duration => 1.0,
            Measure::Memory => 1.0 / f64::from(1 << 20),
            _ => 1e3,
        }
    }

    /// Returns the value of this measure for a run, in SI units and bytes. `None` if the run has none.
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
