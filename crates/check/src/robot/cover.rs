//! All that of an arm can collide, by outlines that cover at least its projection.

use super::solid::Outline;
use super::tree::{Read, child};
use super::{Arm, Body};
use crate::error::{CheckError, Input};
use crate::sweep::{Axis, Range};
use crate::world::World;

/// A shape of the arm, and what it is called.
pub struct Covered {
    pub name: String,
    pub body: Body,
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
                found.push(Covered { name: format!("the bar of link \"{link}\""), body: self.bar(link)? });
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
                found.push(Covered { name: format!("link \"{name}\", {kind} {number}"), body });
            }
        }
        Ok(found)
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
