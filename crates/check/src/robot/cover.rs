//! All that of an arm can collide, by outlines that cover at least its projection.

use super::{Arm, Body, OBLIQUE, Pose, Read, Solid, child, is_nearly_one};
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::interval::{Interval, Point, length};
use crate::sweep::{Axis, Range};
use crate::world::World;
use num_bigint::Sign;

/// A shape of the arm, and what it is called.
pub struct Covered {
    pub name: String,
    pub body: Body,
    /// The link that it belongs to.
    link: String,
}

/// Sides of the polygon round an oblique cylinder's end.
const SIDES: u32 = 32;

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
                let body = self.cover(last, &pose, &solid)?;
                found.push(Covered { name: format!("link \"{name}\", {kind} {number}"), body, link: name.into() });
            }
        }
        Ok(found)
    }

    /// What covers a solid in the plane, and its heights.
    fn cover(&self, link: usize, pose: &Pose, solid: &Solid) -> Read<Body> {
        let mut body = self.project(link, pose, solid)?;
        let normal = self.plane.normal;
        let unit = [0, 1, 2].map(|k| pose.rows[k][2].clone());
        match solid {
            Solid::Box(half) => {
                let along = |k: usize| &half[k] * &pose.rows[normal][k].abs();
                let reach = &(&along(0) + &along(1)) + &along(2);
                body.heights = [&pose.at[normal] - &reach, &pose.at[normal] + &reach];
            }
            Solid::Cylinder { radius, half } if !unit[normal].abs().is_whole(1) => {
                let joint = if link == 0 { self.base.clone() } else { [0, 1].map(|k| &self.base[k] + &self.offset[k]) };
                let center = [0, 1].map(|k| &pose.at[self.plane.across[k]] - &joint[k]);
                let along = self.plane.across.map(|k| unit[k].clone());
                (body.shape.points, body.shape.radius) = oblique(&center, &along, &unit[normal].abs(), radius, half);
            }
            Solid::Cylinder { .. } | Solid::Capsule { .. } => {}
        }
        Ok(body)
    }

    /// Whether a joint that lowers the tool carries a shape.
    ///
    /// # Errors
    /// A joint that is not there, or does not slide along the plane's normal, exactly.
    pub fn lowers(&self, joint: &str, shape: &Covered) -> Read<bool> {
        let wrong = |why: &str| Err(CheckError::in_file(Input::World, format!("the stroke's joint \"{joint}\" {why}")));
        let found = self.tree.joints.iter().find(|(_, node)| node.attribute("name") == Some(joint));
        let Some((&carried, &node)) = found else { return wrong("is none of the robot's") };
        let axis = self.tree.pose(carried)?.direction(&self.tree.axis(node)?);
        let is_along = self.plane.across.iter().all(|k| axis[*k].is_whole(0));
        if node.attribute("type") != Some("prismatic") || !is_along {
            return wrong("does not slide, exactly, along the normal of the plane");
        }
        let link = self.tree.order.iter().find(|name| **name == shape.link).expect("links of shapes are the robot's");
        Ok(self.tree.above(link)?.contains(&node))
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

    /// Least and greatest value of each joint; none of one that turns without end.
    ///
    /// # Errors
    /// Soft limits, which the checker does not know.
    pub fn limits(&self, world: &World) -> Read<[Option<Range>; 2]> {
        for node in self.tree.joints.values().filter(|node| child(**node, "safety_controller").is_some()) {
            if !world.limits.contains_key(self.tree.text(*node, "name")?) {
                return self.tree.error(*node, "the checker does not know soft limits: give the joint [robot] limits");
            }
        }
        Ok(self.joints.each_ref().map(|joint| match (world.limits.get(&joint.name), &joint.axis) {
            (_, Axis::Circle) => None,
            // Of what is in degrees no more than is known.
            (Some([[_, low], [high, _]]), _) => Some([low.clone(), high.clone()]),
            (None, Axis::Line(range)) => Some(range.clone()),
        }))
    }
}

impl Body {
    /// The same at all heights from where it is to where it is lowered by a length.
    pub fn lowered(&self, by: &Decimal) -> Self {
        let [low, high] = &self.heights;
        let by = Interval::from(by);
        let least = if by.lower.sign() == Sign::Minus { low.clone() } else { low - &by };
        let most = if by.lower.sign() == Sign::Minus { high - &by } else { high.clone() };
        Self { link: self.link, shape: self.shape.clone(), heights: [least, most] }
    }

    /// Whether its heights and these are known to have none in common.
    pub fn passes(&self, heights: Option<&Range>) -> bool {
        let Some([low, high]) = heights.map(|range| range.each_ref().map(Interval::from)) else { return false };
        self.heights[1].upper < low.lower || high.upper < self.heights[0].lower
    }
}

/// A core and a radius that cover the projection of a cylinder: the hull of two ellipses, of half-axes `radius` across the
/// projected axis and `radius * tilt` along it, at its ends.
fn oblique(
    center: &Point,
    along: &Point,
    tilt: &Interval,
    radius: &Interval,
    half: &Interval,
) -> (Vec<Point>, Interval) {
    let end = along.each_ref().map(|c| c * half);
    let both = |by: &Point| [[0, 1].map(|k| &center[k] + &by[k]), [0, 1].map(|k| &center[k] - &by[k])];
    let length = length(along);
    // A turn by so much that its enclosure says nothing is such a case, too.
    if is_nearly_one(tilt) || length.lower.sign() != Sign::Plus {
        return (both(&end).to_vec(), radius.clone());
    }
    let direction = along.each_ref().map(|c| c.divided(&length));
    let across = [-&(&direction[1] * radius), &direction[0] * radius];
    let bulge = direction.each_ref().map(|c| &(c * radius) * tilt);
    let plus = |a: &Point, b: &Point| [0, 1].map(|k| &a[k] + &b[k]);
    let minus = |a: &Point, b: &Point| [0, 1].map(|k| &a[k] - &b[k]);
    let points = if tilt.upper <= Interval::whole(1).over(OBLIQUE).upper {
        let end = plus(&end, &bulge);
        [plus(&end, &across), minus(&end, &across)].iter().flat_map(both).collect()
    } else {
        // The sides touch the ellipse halfway between corners.
        let half_step = Interval::pi().over(SIDES);
        let grown = &half_step.sin_cos()[1];
        let rim = (0..SIDES).flat_map(|i| {
            let [sine, cosine] = (&half_step * &Interval::whole(2 * i as i32 + 1)).sin_cos();
            let by = |k: usize| (&(&bulge[k] * &cosine) + &(&across[k] * &sine)).divided(grown);
            let offset = [by(0), by(1)];
            [plus(&plus(center, &end), &offset), plus(&minus(center, &end), &offset)]
        });
        rim.collect()
    };
    (points, Interval::whole(0))
}
