//! The pieces of a line as curves with the parameter from 0 to 1.

use crate::bezier;
use cplan_check::interval::{Interval, Point, double, sum};

/// A piece of a line.
#[derive(PartialEq)]
pub enum Curve {
    /// A Bezier curve with these control points. A straight line has two.
    Bezier(Vec<Point>),
    /// An arc of a circle or a spiral.
    Arc(Box<Arc>),
}

/// An arc of a circle or a spiral. At the parameter `u`, it is `radius + growth u` from the centre, in the direction
/// `from + by u`.
#[derive(PartialEq)]
pub struct Arc {
    pub center: Point,
    pub radius: Interval,
    pub from: Interval,
    pub by: Interval,
    pub growth: Interval,
}

impl Curve {
    /// Returns the point at the parameter.
    pub fn at(&self, u: &Interval) -> Point {
        match self {
            Self::Bezier(control) => bezier::at(control, u),
            Self::Arc(arc) => {
                let [sine, cosine] = arc.direction(u);
                let radius = arc.radius_at(u);
                sum(&arc.center, &[&radius * &cosine, &radius * &sine])
            }
        }
    }

    /// Returns the first and the second derivative with respect to the parameter.
    pub fn derivatives(&self, u: &Interval) -> [Point; 2] {
        match self {
            Self::Bezier(control) => {
                let first = bezier::derivative(control);
                [bezier::at(&first, u), bezier::at(&bezier::derivative(&first), u)]
            }
            Self::Arc(arc) => {
                let [sine, cosine] = arc.direction(u);
                let speed = &arc.radius_at(u) * &arc.by;
                let bend = -&(&speed * &arc.by);
                let twist = double(&(&arc.growth * &arc.by));
                let along = |out: &Interval, across: &Interval| {
                    [&(out * &cosine) - &(across * &sine), &(out * &sine) + &(across * &cosine)]
                };
                [along(&arc.growth, &speed), along(&bend, &twist)]
            }
        }
    }
}

impl Arc {
    /// Returns the distance from the centre at the parameter.
    fn radius_at(&self, u: &Interval) -> Interval {
        &self.radius + &(&self.growth * u)
    }

    /// Returns the sine and the cosine of the direction at the parameter.
    fn direction(&self, u: &Interval) -> Point {
        (&self.from + &(&self.by * u)).sin_cos()
    }
}
