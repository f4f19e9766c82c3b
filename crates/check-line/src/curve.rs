//! The pieces of a line as curves with the parameter from 0 to 1.

use crate::bezier;
use cplan_check::interval::{Interval, Point, sum};

/// A piece of a line.
#[derive(PartialEq)]
pub enum Curve {
    /// A Bezier curve with these control points. A straight line has two.
    Bezier(Vec<Point>),
    /// An arc of a circle.
    Arc(Box<Arc>),
}

/// An arc of a circle: from the centre in direction `from + by u` at the parameter `u`.
#[derive(PartialEq)]
pub struct Arc {
    pub center: Point,
    pub radius: Interval,
    pub from: Interval,
    pub by: Interval,
}

impl Curve {
    /// Returns the point at the parameter.
    pub fn at(&self, u: &Interval) -> Point {
        match self {
            Self::Bezier(control) => bezier::at(control, u),
            Self::Arc(arc) => {
                let [sine, cosine] = arc.direction(u);
                sum(&arc.center, &[&arc.radius * &cosine, &arc.radius * &sine])
            }
        }
    }

    /// Returns the first and the second derivative by the parameter.
    pub fn derivatives(&self, u: &Interval) -> [Point; 2] {
        match self {
            Self::Bezier(control) => {
                let first = bezier::derivative(control);
                [bezier::at(&first, u), bezier::at(&bezier::derivative(&first), u)]
            }
            Self::Arc(arc) => {
                let [sine, cosine] = arc.direction(u);
                let speed = &arc.radius * &arc.by;
                let bend = -&(&speed * &arc.by);
                [[-&(&speed * &sine), &speed * &cosine], [&bend * &cosine, &bend * &sine]]
            }
        }
    }
}

impl Arc {
    /// Returns the sine and the cosine of the direction at the parameter.
    fn direction(&self, u: &Interval) -> Point {
        (&self.from + &(&self.by * u)).sin_cos()
    }
}
