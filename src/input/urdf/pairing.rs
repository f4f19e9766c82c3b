//! Which two joints of a robot form a planar arm, and whether that settles which are meant.

use super::chain;
use super::document::Document;
use super::reduction::Reduction;
use super::tree::Tree;
use crate::input::world::World;
use urdf_rs::JointType;

/// More pairs than this are not listed in a message.
const LISTED: usize = 6;

/// Of robots with more joints than this that can move, pairs are not tried: their number grows with the square.
pub(super) const MOST_TRIED: usize = 40;

/// Every two joints that form a planar arm and go with all that the world says; base first.
pub(super) fn planar(document: &Document, tree: &Tree, world: &World) -> Vec<[usize; 2]> {
    let forms_arm = |pair: &[usize; 2]| {
        chain::with_joints(document, tree, world, *pair)
            .is_ok_and(|chain| Reduction::new(document, tree, world, &chain).common_plane().is_ok())
    };
    chain::pairs(document, tree).into_iter().filter(forms_arm).collect()
}

/// The pair that must be meant: the only planar one, if none turns between; or else the only planar one without any joint
/// between that moves.
pub(super) fn evident(document: &Document, tree: &Tree, planar: &[[usize; 2]]) -> Option<[usize; 2]> {
    let between = |[a, b]: &[usize; 2]| -> Vec<&urdf_rs::Joint> {
        let is_inner = |j: &usize| tree.carries(*a, tree.parent[*j]) && tree.carries(*j, tree.parent[*b]);
        let inner = (0..document.robot.joints.len()).filter(is_inner);
        inner.map(|j| &document.robot.joints[j]).filter(|joint| chain::is_movable(joint)).collect()
    };
    if let [only] = planar {
        let turns = |joint: &&urdf_rs::Joint| joint.joint_type != JointType::Prismatic;
        return (!between(only).iter().any(turns)).then_some(*only);
    }
    let adjacent: Vec<&[usize; 2]> = planar.iter().filter(|pair| between(pair).is_empty()).collect();
    match adjacent[..] {
        [only] => Some(*only),
        _ => None,
    }
}

/// The entries that would choose these pairs, for messages.
pub(super) fn choices(document: &Document, pairs: &[[usize; 2]]) -> String {
    let entry = |pair: &[usize; 2]| {
        let [a, b] = pair.map(|j| document.robot.joints[j].name.as_str());
        format!("[robot] joints = [{a:?}, {b:?}]")
    };
    let shown: Vec<String> = pairs.iter().take(LISTED).map(entry).collect();
    let more = if pairs.len() > LISTED { ", ..." } else { "" };
    shown.join(", or ") + more
}

/// The world without what it says of joints and tip, and of where joints are held.
pub(super) fn freed(world: &World) -> World {
    let mut robot = world.robot.clone();
    robot.joints = None;
    robot.tip = None;
    robot.fixed.clear();
    World { robot, ..World::silent() }
}
