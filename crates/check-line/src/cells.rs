//! Rectangles that cover configurations, and tests whether they touch each other.

use cplan_check::decimal::Decimal;
use cplan_check::domain::{Domain, Rectangle};
use num_bigint::BigInt;

/// Maximum number of times that the domain is halved along each joint.
pub const MAX_LEVEL: u32 = 40;

/// A rectangle of the domain. The range of each joint is one of `2^level` equal parts of its values.
#[derive(Clone)]
pub struct Cell {
    /// Number of times that the domain was halved along each joint.
    pub level: u32,
    at: [u64; 2],
}

impl Cell {
    /// Returns the whole domain.
    pub fn whole() -> Self {
        Self { level: 0, at: [0, 0] }
    }

    /// Returns the four quarters.
    pub fn quarters(&self) -> [Self; 4] {
        let [a, b] = self.at.map(|at| 2 * at);
        [[a, b], [a + 1, b], [a, b + 1], [a + 1, b + 1]].map(|at| Self { level: self.level + 1, at })
    }

    /// Returns the ranges of the joints.
    pub fn rectangle(&self, domain: &Domain) -> Rectangle {
        [0, 1].map(|k| {
            let [low, high] = &domain.ranges[k];
            let size = high - low;
            [0, 1].map(|end| low + &(&size * &Decimal::dyadic(&BigInt::from(self.at[k] + end), self.level)))
        })
    }

    /// Returns the ends of the range of a joint, in units of the finest parts.
    fn ends(&self, joint: usize) -> [u64; 2] {
        [0, 1].map(|end| (self.at[joint] + end) << (MAX_LEVEL - self.level))
    }

    /// Returns true if two cells have a configuration in common. The opposite borders of a joint without limits are the
    /// same configurations.
    pub fn touches(&self, other: &Self, domain: &Domain) -> bool {
        (0..2).all(|k| {
            let ([a, b], [c, d]) = (self.ends(k), other.ends(k));
            let is_across = |low: u64, high: u64| low == 0 && high == 1 << MAX_LEVEL;
            (a <= d && c <= b) || (domain.seams[k].is_some() && (is_across(a, d) || is_across(c, b)))
        })
    }
}

/// Splits things into groups that do not touch each other.
pub fn groups<T>(mut things: Vec<T>, touches: impl Fn(&T, &T) -> bool) -> Vec<Vec<T>> {
    let mut groups = Vec::new();
    while let Some(first) = things.pop() {
        let (mut group, mut next) = (vec![first], 0);
        while next < group.len() {
            let (near, rest): (Vec<T>, Vec<T>) = things.into_iter().partition(|thing| touches(&group[next], thing));
            things = rest;
            group.extend(near);
            next += 1;
        }
        groups.push(group);
    }
    groups
}
