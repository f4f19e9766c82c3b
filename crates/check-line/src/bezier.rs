//! Bezier curves of enclosed points.

use cplan_check::interval::{Interval, Point, minus, sum, times};

/// Returns the point at the parameter `u`, by de Casteljau's algorithm. Without control points, it is zero.
pub fn at(control: &[Point], u: &Interval) -> Point {
    cut(control, u).0.pop().unwrap_or_else(|| [0, 0].map(Interval::whole))
}

/// Returns the control points of the parts before and after the parameter `u`.
pub fn cut(control: &[Point], u: &Interval) -> (Vec<Point>, Vec<Point>) {
    let (mut first, mut second, mut points) = (Vec::new(), Vec::new(), control.to_vec());
    while let (Some(from), Some(to)) = (points.first(), points.last()) {
        first.push(from.clone());
        second.push(to.clone());
        points = points.windows(2).map(|p| sum(&p[0], &times(&minus(&p[1], &p[0]), u))).collect();
    }
    second.reverse();
    (first, second)
}

/// Returns the control points of the derivative with respect to the parameter.
pub fn derivative(control: &[Point]) -> Vec<Point> {
    let degree = Interval::whole(control.len() as i32 - 1);
    control.windows(2).map(|p| times(&minus(&p[1], &p[0]), &degree)).collect()
}

/// Returns the least enclosure of all control points, which contains the whole curve. Without control points, it is zero.
pub fn enclosure(control: &[Point]) -> Point {
    [0, 1].map(|k| {
        let ends = control.iter().map(|p| &p[k]);
        let (least, greatest) = (ends.clone().map(|c| &c.lower).min(), ends.map(|c| &c.upper).max());
        match (least, greatest) {
            (Some(lower), Some(upper)) => Interval { lower: lower.clone(), upper: upper.clone() },
            _ => Interval::whole(0),
        }
    })
}
