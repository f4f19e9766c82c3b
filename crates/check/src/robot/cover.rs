//! All that of an arm can collide, by outlines that cover at least its projection.

use super::solid::Outline;
use super::tree::Read;
use super::{Arm, Body};
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::interval::{Interval, length};
use crate::world::World;

/// The cosine of the angle between the normal and what counts as along it is no smaller than 1 by more than `10^-9`.
const UPRIGHT: u32 = 9;

/// A shape of the arm, and what it is called.
pub struct Covered {
    pub name: String,
    pub body: Body,
    /// The link that it belongs to.
    pub link: String,
}

impl Arm<'_> {
    /// All shapes that the joints move: collision shapes, or where one of the two parts of the arm has none, its visual
    /// ones, or else a bar.
    ///
    /// # Errors
    /// Shapes that the checker does not know. It is no matter here what the certificate says: nothing is left out.
    pub fn covered(&self, world: &World) -> Read<Vec<Covered>> {
        let mut all = Vec::new();
        for last in [0, 1] {
            let mut found = self.gathered(last, "collision")?;
            if found.is_empty() {
                found = self.gathered(last, "visual")?;
            }
            if found.is_empty() && world.bar.is_some() {
                let link = self.children[last];
                let name = format!("the bar of link \"{link}\"");
                found.push(Covered { name, body: self.bar(link)?, link: link.into() });
            }
            all.append(&mut found);
        }
        match all.is_empty() {
            true => Err(CheckError::in_file(Input::Urdf, "the arm has no shape that could collide")),
            false => Ok(all),
        }
    }

    /// Shapes of one kind of all links whose last joint of the two this one is.
    fn gathered(&self, last: usize, kind: &str) -> Read<Vec<Covered>> {
        let mut found = Vec::new();
        for &name in &self.tree.order {
            if self.moved_by(name)? != Some(last) {
                continue;
            }
            for (number, (node, solid)) in self.solids(name, kind)?.into_iter().enumerate() {
                let pose = self.tree.pose(name)?.after(&self.tree.origin(node)?);
                let body = self.project(last, &pose, &solid, Outline::Around);
                found.push(Covered { name: format!("link \"{name}\", {kind} {number}"), body, link: name.into() });
            }
        }
        Ok(found)
    }

    /// Whether a joint that lowers the tool carries a link.
    ///
    /// # Errors
    /// A joint that is not there, or does not slide along the plane's normal.
    pub fn lowers(&self, joint: &str, link: &str) -> Read<bool> {
        let wrong = |why: &str| Err(CheckError::in_file(Input::World, format!("the stroke's joint \"{joint}\" {why}")));
        let found = self.tree.joints.iter().find(|(_, node)| node.attribute("name") == Some(joint));
        let Some((&carried, &node)) = found else { return wrong("is none of the robot's") };
        let axis = self.tree.pose(carried)?.direction(&self.tree.axis(node)?);
        let along = self.plane.height(&axis).abs();
        let least = &Decimal::whole(1) - &Decimal::power_of_ten(UPRIGHT);
        if node.attribute("type") != Some("prismatic") || along.lower < Interval::from(&least).lower {
            return wrong("does not slide along the normal of the plane");
        }
        let link = self.tree.order.iter().find(|name| **name == link);
        Ok(link.map_or(Ok(Vec::new()), |link| self.tree.above(link))?.contains(&node))
    }

    /// How far the arm reaches at the least: from the first joint to the second, and on to where its shapes or the tip are.
    ///
    /// # Errors
    /// Without a tip.
    pub fn reach(&self, shapes: &[Covered]) -> Read<Interval> {
        let zero = Interval::whole(0);
        let farthest = |link: usize, first: Interval| {
            let of =
                |body: &Body| body.shape.points.iter().map(|p| &length(p) + &body.shape.radius).collect::<Vec<_>>();
            let all = shapes.iter().filter(|shape| shape.body.link == link).flat_map(|shape| of(&shape.body));
            all.fold(first, |a, b| if b.lower > a.lower { b } else { a })
        };
        let (_, tip) = self.tip()?;
        let out = &length(&self.offset) + &farthest(1, length(&tip.shape.points[0]));
        Ok([farthest(0, zero), out].into_iter().max_by(|a, b| a.lower.cmp(&b.lower)).expect("two"))
    }
}
