//! Bars that replace links without geometry.

use super::Robot;
use super::tree::ReadResult;
use cplan_check::decimal::Decimal;
use cplan_check::interval::Interval;
use cplan_check::overlap::Shape;
use cplan_check::shapes::{Body, CollisionShape};
use cplan_check::{CheckError, Input};
use num_bigint::Sign;
use std::collections::BTreeSet;

impl Robot<'_> {
    /// Makes the bar: all points within a radius of the segment from a joint to the next joint or the tip.
    pub(super) fn bar(&self, last: usize, radius: &Decimal) -> ReadResult<CollisionShape> {
        if radius.sign() != Sign::Plus {
            return Err(CheckError::in_file(Input::World, "the radius of a bar must be positive"));
        }
        let link = self.children[last];
        let (next, end) = match last {
            0 => (self.children[1], self.arm.offset.clone()),
            _ => (self.tip_link, self.arm.tip.shape.points[0].clone()),
        };
        let radius = Interval::from(radius);
        let [a, b] = [self.tree.pose(link)?, self.tree.pose(next)?].map(|pose| self.plane.height(&pose.at));
        let least = Interval { lower: (&a.lower).min(&b.lower).clone(), upper: (&a.upper).min(&b.upper).clone() };
        let most = Interval { lower: a.lower.max(b.lower), upper: a.upper.max(b.upper) };
        let heights = Some([&least - &radius, &most + &radius]);
        let body =
            Body { link: last, shape: Shape { points: vec![[0, 0].map(Interval::whole), end], radius }, heights };
        let (link, around, within) = (link.to_owned(), body.clone(), body);
        let (layer, ignored) = (None, BTreeSet::new());
        Ok(CollisionShape { link, kind: "bar", number: 0, last: Some(last), layer, around, within, ignored })
    }
}
