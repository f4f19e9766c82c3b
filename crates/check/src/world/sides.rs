//! What of an obstacle a shape that does not begin inside it has to stay off.

use super::{Obstacle, Outline};
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::interval::{BITS, Interval, Point, turned};
use crate::overlap::Shape;
use crate::polygon::{Corner, edges, surrounds};
use num_bigint::{BigInt, Sign};

impl Obstacle {
    /// The segments of its border, or its disc, in their places. What is connected, touches none of them and is not inside is off
    /// the obstacle.
    ///
    /// # Errors
    /// An obstacle that the checker does not know, or that is none.
    pub fn sides(&self) -> Result<Vec<Shape>, CheckError> {
        let side = |corners: &[&Corner], radius: &Interval| Shape {
            points: corners.iter().map(|corner| self.placed(corner)).collect(),
            radius: radius.clone(),
        };
        let zero = Interval::whole(0);
        let wrong = |message: &str| Err(CheckError::in_file(Input::World, message));
        match &self.outline {
            Outline::Polygon(rings) if rings.iter().all(|ring| ring.len() > 2) => {
                Ok(rings.iter().flat_map(|ring| edges(ring)).map(|(a, b)| side(&[a, b], &zero)).collect())
            }
            Outline::Polyline(points) if points.len() > 1 => {
                Ok(points.windows(2).map(|ends| side(&[&ends[0], &ends[1]], &zero)).collect())
            }
            Outline::Circle(center, radius) if radius.sign() == Sign::Plus => {
                Ok(vec![side(&[center], &Interval::from(radius))])
            }
            Outline::Image => {
                wrong("the checker does not know obstacles that are images: no motion is certified among them")
            }
            _ => wrong("an obstacle has too few points, or no radius"),
        }
    }

    /// Whether its rings surround a point that is farther than this from all of them. None if the point is not known well enough
    /// to say.
    pub fn surrounds(&self, at: &Point, farther: &BigInt) -> Option<bool> {
        let Outline::Polygon(rings) = &self.outline else { return Some(false) };
        let from_there = [0, 1].map(|k| &at[k] - &self.at[k]);
        let [sine, cosine] = &self.turn;
        let own = turned(&from_there, &[-sine, cosine.clone()]).map(|c| c.middle());
        // What stands in for the point is nearer to it than any ring.
        let is_near = own.iter().map(|(_, radius)| radius).sum::<BigInt>() < *farther;
        is_near.then(|| surrounds(rings, &own.map(|(middle, _)| Decimal::dyadic(&middle, BITS))))
    }
}
