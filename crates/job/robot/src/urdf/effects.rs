//! Effects of motions of the fixed joints.

use super::chain::{Chooser, is_movable};
use super::plane::project;
use super::reduction::Reduction;
use super::tool::PARALLEL_TOLERANCE;
use super::tree;
use cplan_handling::{HeldEffect, HeldJoint};
use cplan_model::Plane;
use urdf_rs::JointType;

impl Reduction<'_> {
    /// Returns the fixed joints whose values matter to the arm, with the effects of their motion.
    pub fn held_joints(&self, plane: &Plane) -> Vec<HeldJoint> {
        let below = |joint: usize| (0..self.tree.links.len()).filter(move |&link| self.tree.carries(joint, link));
        let held = |&index: &usize| HeldJoint {
            name: self.document.robot.joints[index].name.clone(),
            value: self.chain.values[index],
            effect: self.held_effect(index, plane).unwrap_or_else(|why| HeldEffect::Unjudged { why }),
            bodies: below(index).map(|link| self.tree.links[link].clone()).collect(),
        };
        self.chain.held.iter().map(held).collect()
    }

    /// Returns the effect of a joint's motion, or the reason why cplan cannot check such a motion.
    fn held_effect(&self, index: usize, plane: &Plane) -> Result<HeldEffect, String> {
        let chooser = Chooser { document: self.document, tree: self.tree, settings: self.settings };
        let joints = chooser.all();
        let joint = &joints[index];
        if let Some(mimic) = &joint.mimic {
            return Err(format!("follows joint \"{}\"", mimic.joint));
        }
        let follows =
            |(other, _): &(usize, &urdf_rs::Joint)| chooser.leader(*other).is_ok_and(|leader| leader == index);
        let mut others = joints.iter().enumerate().filter(|(other, joint)| *other != index && is_movable(joint));
        if let Some((_, follower)) = others.find(follows) {
            return Err(format!("moves joint \"{}\" with it", follower.name));
        }
        let child = self.tree.child[index];
        let along = (self.poses[child] * tree::axis(joint)).dot(&plane.normal);
        if along.abs() < 1.0 - PARALLEL_TOLERANCE {
            return Err("has an axis that is not along the normal of the arm's plane".into());
        }
        match joint.joint_type {
            JointType::Prismatic => Ok(HeldEffect::Lifts { sign: along.signum() }),
            JointType::Revolute | JointType::Continuous if self.tree.carries(self.chain.joints[1], child) => {
                let elbow = self.at(plane, self.tree.child[self.chain.joints[1]]);
                let axis = project(plane, &self.poses[child].translation.vector) - elbow;
                Ok(HeldEffect::Turns { axis, sign: along.signum() })
            }
            _ => Err("turns links that only one of the two planned joints carries, or none".into()),
        }
    }
}
