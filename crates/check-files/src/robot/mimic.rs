//! Joints that mimic others.

use super::Robot;
use super::tree::{MAX_JOINTS, ReadResult, Tree, child, moves};
use cplan_check::interval::Interval;
use roxmltree::Node;

impl<'a> Tree<'a> {
    /// Returns the joint that a joint mimics, directly or through others. Returns `None` if it mimics no joint.
    fn leader(&self, joint: Node<'a, 'a>) -> ReadResult<Option<Node<'a, 'a>>> {
        let mut leader = None;
        let mut at = joint;
        for _ in 0..MAX_JOINTS {
            let Some(mimic) = child(at, "mimic") else { return Ok(leader) };
            let Some(next) = self.named.get(self.text(mimic, "joint")?) else { return Ok(None) };
            (leader, at) = (Some(*next), *next);
        }
        self.error(joint, "joints mimic one another in a cycle")
    }

    /// Returns the value of a joint: 0 for the two planned joints. The value of a mimic joint follows from its leader.
    pub(super) fn value(&self, joint: Node<'a, 'a>, followed: usize) -> ReadResult<Interval> {
        let Some(mimic) = child(joint, "mimic") else {
            return match self.values.get(self.text(joint, "name")?) {
                Some(value) => Ok(value.clone()),
                None if followed == 0 || !moves(&joint) => Ok(Interval::whole(0)),
                None => self.error(joint, "this joint moves and is mimicked, but has no value"),
            };
        };
        let number = |name: &str, else_: i32| match mimic.has_attribute(name) {
            true => Ok(Interval::from(&self.number(mimic, name)?)),
            false => Ok(Interval::whole(else_)),
        };
        match self.named.get(self.text(mimic, "joint")?) {
            Some(leader) if followed < MAX_JOINTS => {
                let by = &number("multiplier", 1)? * &self.value(*leader, followed + 1)?;
                Ok(&by + &number("offset", 0)?)
            }
            _ => self.error(mimic, "the mimicked joint does not exist, or mimics this joint"),
        }
    }
}

impl<'a> Robot<'a> {
    /// Checks that no joint that carries the tip or shapes mimics one of the given joints. The arm has no model for the
    /// motion of such links.
    pub(super) fn check_independence(&self, joints: &[Node<'a, 'a>]) -> ReadResult<()> {
        for &link in &self.tree.order {
            let has_shapes = ["collision", "visual"].iter().any(|kind| child(self.tree.links[link], kind).is_some());
            let counts = has_shapes || link == self.tip_link;
            for joint in if counts { self.tree.joints_above(link)? } else { Vec::new() } {
                if self.tree.leader(joint)?.is_some_and(|leader| joints.contains(&leader)) {
                    return self.tree.error(
                        joint,
                        "this joint mimics a planned joint, and carries the tip or a shape that could collide",
                    );
                }
            }
        }
        Ok(())
    }
}
