//! Measures of layouts, and conditions on them.

use cplan_engine::Plan;
use cplan_solver::Bound;
use std::fmt;

/// A quantity that is measured for each plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Length of the path in joint space. For a task, the total length of all motions.
    Length,
    /// The length divided by the proven lower bound.
    OverBound,
    /// Proven lower bound on the length of all paths.
    LowerBound,
    /// Proven lower bound on the distance from obstacles along the whole motion, in metres.
    Clearance,
    /// Duration of the motion, or of a whole cycle of a task, in seconds.
    Duration,
}

impl Measure {
    /// All measures, in the order of the columns.
    pub const ALL: [Self; 5] = [Self::Length, Self::OverBound, Self::LowerBound, Self::Clearance, Self::Duration];

    /// Returns the name of the measure, which is also that of its column.
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::OverBound => "over_bound",
            Self::LowerBound => "lower_bound",
            Self::Clearance => "clearance",
            Self::Duration => "duration",
        }
    }

    /// Returns the unit, if it is the same for all arms.
    pub fn unit(self) -> Option<&'static str> {
        match self {
            Self::Clearance => Some("m"),
            Self::Duration => Some("s"),
            Self::Length | Self::OverBound | Self::LowerBound => None,
        }
    }

    /// Returns the measure with this name.
    ///
    /// # Errors
    /// The list of names, for an unknown name.
    pub fn named(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        let found = Self::ALL.into_iter().find(|measure| measure.name() == name);
        found.ok_or_else(|| format!("\"{name}\" is not a measure; measures are {}", names()))
    }

    /// Returns the value of this measure for a plan. `None` if the plan has none.
    pub(super) fn of(self, plan: &Plan) -> Option<f64> {
        match self {
            Self::Clearance => plan.clearance(),
            Self::Duration => plan.duration(),
            Self::Length | Self::OverBound | Self::LowerBound => self.of_path(plan.length(), plan.bound()),
        }
    }
}

impl Measure {
    /// Returns true if the measure depends only on the path, not on the motion along it.
    pub(super) fn is_of_the_path(self) -> bool {
        matches!(self, Self::Length | Self::OverBound | Self::LowerBound)
    }

    /// Returns the value of this measure for a path with this length and bound, if it has one.
    pub(super) fn of_path(self, length: Option<f64>, bound: Option<Bound>) -> Option<f64> {
        match self {
            Self::Length => length,
            // This ratio is in the requested metric. The measured length may be in another one.
            Self::OverBound => bound.and_then(|bound| length_ratio(bound.upper, bound.lower)),
            Self::LowerBound => bound.map(|bound| bound.lower),
            Self::Clearance | Self::Duration => None,
        }
    }
}

fn length_ratio(length: f64, bound: f64) -> Option<f64> {
    Some(length / bound).filter(|ratio| ratio.is_finite())
}

/// A condition that a layout must satisfy, in addition to having a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// The measure that is compared with the bound.
    pub measure: Measure,
    /// True for a lower bound, false for an upper bound.
    pub at_least: bool,
    /// The bound.
    pub bound: f64,
}

impl Condition {
    /// Parses `clearance >= 0.01`.
    ///
    /// # Errors
    /// The syntax error.
    pub fn parse(text: &str) -> Result<Self, String> {
        let parts = [(">=", true), ("<=", false)].into_iter();
        let split = parts.filter_map(|(sign, at_least)| Some((text.split_once(sign)?, at_least))).next();
        let ((measure, bound), at_least) = split.ok_or_else(|| format!("\"{text}\" is not a condition"))?;
        let bound: f64 = bound.trim().parse().map_err(|_| format!("\"{}\" is not a number", bound.trim()))?;
        if !bound.is_finite() {
            return Err(format!("{bound} is not finite"));
        }
        Ok(Self { measure: Measure::named(measure.trim())?, at_least, bound })
    }

    /// Returns true if a value satisfies the condition. A missing clearance means that no obstacle is within reach, so
    /// it satisfies every lower bound. Other missing values satisfy no condition.
    pub(super) fn holds(&self, value: Option<f64>) -> bool {
        let unbounded = (self.measure == Measure::Clearance).then_some(f64::INFINITY);
        value.or(unbounded).is_some_and(|value| if self.at_least { value >= self.bound } else { value <= self.bound })
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.measure.name(), if self.at_least { ">=" } else { "<=" }, self.bound)
    }
}

/// An objective that ranks layouts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Objective {
    /// The measure.
    pub measure: Measure,
    /// True if greater values are better.
    pub most: bool,
}

impl Objective {
    /// Parses `least duration` or `most clearance`.
    ///
    /// # Errors
    /// The syntax error.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut words = text.split_whitespace();
        let most = match words.next() {
            Some("least") => false,
            Some("most") => true,
            _ => return Err(format!("\"{text}\" is not an objective")),
        };
        match (words.next(), words.next()) {
            (Some(measure), None) => Ok(Self { measure: Measure::named(measure)?, most }),
            _ => Err(format!("\"{text}\" is not an objective")),
        }
    }

    /// Converts a value to a cost, where less is better. Applied to a cost, it returns the value.
    pub(super) fn cost(&self, value: f64) -> f64 {
        if self.most { -value } else { value }
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", if self.most { "most" } else { "least" }, self.measure.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_and_objectives_are_words() {
        let condition = Condition::parse("clearance >= 0.01").unwrap();
        assert_eq!(condition.to_string(), "clearance >= 0.01");
        assert_eq!([Some(0.01), Some(0.009), None].map(|value| condition.holds(value)), [true, false, true]);
        assert!(!Condition::parse("length <= 9").unwrap().holds(None));
        assert!(Condition::parse("duration <= 2").unwrap().holds(Some(2.0)));
        assert_eq!(Condition::parse("duration < 2"), Err("\"duration < 2\" is not a condition".into()));
        assert!(
            Condition::parse("speed <= 2").unwrap_err().starts_with("\"speed\" is not a measure; measures are length")
        );
        assert_eq!(Objective::parse("most clearance").unwrap().to_string(), "most clearance");
        assert!(Objective::parse("duration").is_err() && Objective::parse("least").is_err());
    }
}
