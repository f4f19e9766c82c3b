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

    /// Returns the key in JSON, the heading with unit, the factor from SI units and bytes to that unit, and the number of
    /// decimals.
    fn facts(self) -> (&'static str, &'static str, f64, usize) {
        match self {
            Measure::OverOptimum => ("over_optimum", "length over the proven optimum", 1.0, 4),
            Measure::Clearance => ("clearance", "clearance [mm]", 1e3, 3),
            Measure::Duration => ("duration", "motion [s]", 1.0, 3),
            Measure::Build => ("build", "build [ms]", 1e3, 3),
            Measure::Query => ("query", "query [ms]", 1e3, 3),
            Measure::Certify => ("certify", "certify [ms]", 1e3, 3),
            Measure::Total => ("total", "total [ms]", 1e3, 3),
            Measure::Memory => ("memory", "memory [MiB]", 1.0 / f64::from(1 << 20), 2),
        }
    }

    /// Returns the measure's key in JSON. Values in JSON are in SI units and bytes.
    pub fn key(self) -> &'static str {
        self.facts().0
    }

    /// Returns the measure's heading, with the unit of the tables.
    pub fn heading(self) -> &'static str {
        self.facts().1
    }

    /// Returns the factor from SI units to the unit of the heading.
    pub fn scale(self) -> f64 {
        self.facts().2
    }

    /// Returns the direction in which the measure is better.
    pub fn better(self) -> Better {
        if self == Measure::Clearance { Better::More } else { Better::Less }
    }

    /// Formats a value in the unit of the heading.
    pub fn format(self, value: f64) -> String {
        format!("{:.*}", self.facts().3, value * self.scale())
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
