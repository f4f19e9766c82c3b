//! The configuration space: values of the joints, and what is one of them.

use crate::decimal::Decimal;
use crate::interval::{BITS, Interval};
use num_bigint::BigInt;

/// Enclosures of half a turn reach `2^-SEAM` beyond what is known of it.
const SEAM: u32 = 100;

/// All values from the first to the second.
pub type Range = [Decimal; 2];

/// All configurations from one corner to another, joint by joint.
pub type Rectangle = [Range; 2];

/// Whether a rectangle is part of another.
pub fn within(part: &Rectangle, whole: &Rectangle) -> bool {
    (0..2).all(|k| whole[k][0] <= part[k][0] && part[k][1] <= whole[k][1])
}

/// The values of a joint.
#[derive(Debug, Clone)]
pub enum Axis {
    /// Between limits.
    Line(Range),
    /// All angles: values that differ by whole turns are one.
    Circle,
}

/// The configuration space as a rectangle of the plane, and what is one on its border.
#[derive(Debug)]
pub struct Domain {
    /// A range that holds all values. A circle's goes from a little below -pi to a little above pi.
    pub ranges: Rectangle,
    /// Enclosures of a circle's -pi and pi, which are one angle.
    pub seams: [Option<[Range; 2]>; 2],
}

impl Domain {
    /// The domain of two joints.
    pub fn new(axes: [&Axis; 2]) -> Self {
        // So wide that they hold half a turn in degrees.
        let pi = Interval::pi().widened(&(BigInt::from(1) << (BITS - SEAM)));
        let turn = [(-&pi).ends(), pi.ends()];
        Self {
            ranges: [0, 1].map(|k| match axes[k] {
                Axis::Line(range) => range.clone(),
                Axis::Circle => [turn[0][0].clone(), turn[1][1].clone()],
            }),
            seams: [0, 1].map(|k| matches!(axes[k], Axis::Circle).then(|| turn.clone())),
        }
    }

    /// A value's enclosure within the domain, whole turns taken off. None if it is outside, or too near a seam to say.
    pub fn wrapped(&self, axis: usize, value: &Range) -> Option<Range> {
        let within = |[low, high]: &Range| self.ranges[axis][0] <= *low && *high <= self.ranges[axis][1];
        if within(value) {
            return Some(value.clone());
        }
        self.seams[axis].as_ref()?;
        let value = Interval::around(value);
        let turn = Interval::pi() + Interval::pi();
        let turns = (&value.lower + &Interval::pi().lower) / &turn.lower;
        let candidates = [-1, 0, 1].map(|more| &value - &(&turn * &(Interval::exactly((&turns + more) << BITS))));
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
