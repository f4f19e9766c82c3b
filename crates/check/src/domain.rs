//! The configuration space: values of the joints, and which values are the same angle.

use crate::decimal::Decimal;
use crate::interval::{BITS, Interval};
use num_bigint::BigInt;

/// Enclosures of half a turn exceed the known digits of pi by `2^-SEAM_BITS` radians on each side.
const SEAM_BITS: u32 = 100;

/// All numbers from the first to the second, ends included.
pub type Range = [Decimal; 2];

/// A rectangle of configurations: the range of each joint.
pub type Rectangle = [Range; 2];

/// Returns true if the rectangle `part` lies within `whole`.
pub fn within(part: &Rectangle, whole: &Rectangle) -> bool {
    (0..2).all(|k| whole[k][0] <= part[k][0] && part[k][1] <= whole[k][1])
}

/// The set of a joint's values.
#[derive(Debug, Clone)]
pub enum Axis {
    /// Values between limits.
    Line(Range),
    /// All angles. Values that differ by whole turns are the same angle.
    Circle,
}

/// The configuration space as a rectangle of the plane whose opposite borders may be identified.
#[derive(Debug)]
pub struct Domain {
    /// A range that contains all values. For a circle, it extends from slightly below -pi to slightly above pi.
    pub ranges: Rectangle,
    /// Enclosures of a circle's -pi and pi, which are the same angle.
    pub seams: [Option<[Range; 2]>; 2],
}

impl Domain {
    /// Makes the domain of two joints.
    pub fn new(axes: [&Axis; 2]) -> Self {
        // The enclosures are wide enough to contain half a turn that is given in degrees.
        let pi = Interval::pi().widened(&(BigInt::from(1) << (BITS - SEAM_BITS)));
        let turn = [(-&pi).ends(), pi.ends()];
        Self {
            ranges: [0, 1].map(|k| match axes[k] {
                Axis::Line(range) => range.clone(),
                Axis::Circle => [turn[0][0].clone(), turn[1][1].clone()],
            }),
            seams: [0, 1].map(|k| matches!(axes[k], Axis::Circle).then(|| turn.clone())),
        }
    }

    /// Shifts the enclosure of a value of a continuous joint into the domain by whole turns. Leaves values of other
    /// joints unchanged. Returns `None` if the result is not within the domain.
    pub fn wrapped(&self, axis: usize, value: &Range) -> Option<Range> {
        let within = |[low, high]: &Range| self.ranges[axis][0] <= *low && *high <= self.ranges[axis][1];
        if within(value) {
            return Some(value.clone());
        }
        self.seams[axis].as_ref()?;
        let value = Interval::enclosing(value);
        let turn = Interval::pi() + Interval::pi();
        let turns = (&value.lower + &Interval::pi().lower) / &turn.lower;
        let candidates = [-1, 0, 1].map(|more| &value - &(&turn * &(Interval::exact((&turns + more) << BITS))));
        candidates.into_iter().map(|c| c.ends()).find(within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str) -> Decimal {
        text.parse().unwrap()
    }

    fn range(low: &str, high: &str) -> Range {
        [number(low), number(high)]
    }

    #[test]
    fn whole_turns_are_taken_off() {
        let domain = Domain::new([&Axis::Circle, &Axis::Line(range("-2", "2.1"))]);
        for (value, wrapped) in
            [("7", "0.716"), ("-7", "-0.716"), ("3", "3"), ("-600.25", "2.935"), ("600.25", "-2.935")]
        {
            let [low, high] = domain.wrapped(0, &range(value, value)).unwrap();
            let near = |a: &Decimal, by: &str| (&(a - &number(wrapped))).max(&(&number(wrapped) - a)) < &number(by);
            assert!(near(&low, "0.001") && near(&high, "0.001") && low <= high, "{value}: {low} {high}");
        }
        assert!(domain.wrapped(1, &range("2.2", "2.2")).is_none() && domain.wrapped(1, &range("2.1", "2.1")).is_some());
    }
}
