//! The planners that a comparison recommends.

use super::best::Better;
use super::comparison::Comparison;
use super::row::Row;
use cplan_model::Status;

/// A purpose for which one planner is the best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// The shortest path.
    Shortest,
    /// The greatest clearance.
    Safest,
    /// The least computing time to the answer.
    Quickest,
    /// The motion of the least duration.
    FastestMotion,
}

impl Purpose {
    /// All purposes, in the order of the page.
    pub const ALL: [Purpose; 4] = [Purpose::Shortest, Purpose::Safest, Purpose::Quickest, Purpose::FastestMotion];

    /// Returns the value by which rows compete for this purpose, in SI units. `None` without a path, or if the value is unknown.
    /// The clearance is infinite if no obstacle is within reach.
    pub fn value(self, row: &Row) -> Option<f64> {
        if row.outcome != Status::Found {
            return None;
        }
        match self {
            Purpose::Shortest => row.length,
            Purpose::Safest => Some(row.clearance.unwrap_or(f64::INFINITY)),
            Purpose::Quickest => row.total,
            Purpose::FastestMotion => row.duration,
        }
    }

    /// Returns which value is the better one.
    pub fn better(self) -> Better {
        if self == Purpose::Safest { Better::More } else { Better::Less }
    }
}

impl Comparison {
    /// Returns the index of the best row for a purpose, the first of equals. `None` if no planner found a path.
    pub fn recommended(&self, purpose: Purpose) -> Option<usize> {
        purpose.better().first_best(self.rows.iter().map(|row| purpose.value(row)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Family;

    fn row(outcome: Status, length: f64, clearance: Option<f64>, total: f64) -> Row {
        let (length, total) = (Some(length), Some(total));
        Row { length, clearance, total, ..Row::new("planner", Family::Field, outcome) }
    }

    #[test]
    fn only_found_paths_are_recommended() {
        let mut comparison = Comparison {
            problem: "p".to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: None,
            rows: vec![
                row(Status::Unknown, 0.5, Some(9.0), 0.1),
                row(Status::Found, 2.0, Some(0.1), 0.3),
                row(Status::Found, 1.0, None, 0.4),
                row(Status::Found, 1.0, Some(0.2), 0.2),
            ],
        };
        let all = |comparison: &Comparison| Purpose::ALL.map(|purpose| comparison.recommended(purpose));
        assert_eq!(all(&comparison), [Some(2), Some(2), Some(3), None]);
        comparison.rows.truncate(1);
        assert_eq!(all(&comparison), [None; 4]);
    }
}
