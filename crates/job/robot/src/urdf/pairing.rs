//! Pairs of joints that form a planar arm, and the choice of one of them.

use super::chain;
use super::document::Document;
use super::plane::ALIGNMENT_TOLERANCE;
use super::reduction::Reduction;
use super::tree::Tree;
use crate::quantity::PerJoint;
use crate::robot_table::RobotTable;
use crate::settings::RobotSettings;
use cplan_model::Plane;
use urdf_rs::JointType;

/// Largest number of pairs that a message lists.
const MAX_LISTED_PAIRS: usize = 6;

/// Largest number of movable joints for which pairs are tried. The number of pairs grows with its square.
pub(super) const MAX_TRIED_JOINTS: usize = 40;

/// Two joints that form a planar arm.
pub(super) struct PlanarPair {
    /// The two joints, base to tip.
    pub joints: [usize; 2],
    plane: Plane,
}

/// A pair of joints that is chosen although the world names none.
pub(super) struct ImpliedPair {
    pub joints: [usize; 2],
    /// The reason for this pair, as a clause after the names of the joints.
    pub reason: String,
}

/// Returns all pairs of joints that form a planar arm and fit the world's other settings; base first.
pub(super) fn planar(document: &Document, tree: &Tree, settings: RobotSettings) -> Vec<PlanarPair> {
    let plane = |joints: [usize; 2]| {
        let chain = chain::with_joints(document, tree, settings, joints).ok()?;
        Reduction::new(document, tree, settings, &chain).common_plane().ok()
    };
    let pairs = chain::pairs(document, tree).into_iter();
    pairs.filter_map(|joints| Some(PlanarPair { joints, plane: plane(joints)? })).collect()
}

/// Returns the pair of joints that is evidently meant, if there is one. Movable joints between the two joints of a pair are
/// evidence against it.
///
/// - If there is only one planar pair, it is chosen unless a revolute joint lies between its joints.
/// - Otherwise, only planar pairs without movable joints in between count. If there is one, it is chosen. If several share a
///   plane along one chain, the first one is chosen.
pub(super) fn implied_pair(document: &Document, tree: &Tree, planar: &[PlanarPair]) -> Option<ImpliedPair> {
    let between = |pair: &PlanarPair| -> Vec<&urdf_rs::Joint> {
        let [a, b] = &pair.joints;
        let is_inner = |j: &usize| tree.carries(*a, tree.parent[*j]) && tree.carries(*j, tree.parent[*b]);
        let inner = (0..document.robot.joints.len()).filter(is_inner);
        inner.map(|j| &document.robot.joints[j]).filter(|joint| chain::is_movable(joint)).collect()
    };
    if let [only] = planar {
        let turns = |joint: &&urdf_rs::Joint| joint.joint_type != JointType::Prismatic;
        let reason = ", the only planar pair of neighbours".to_owned();
        return (!between(only).iter().any(turns)).then_some(ImpliedPair { joints: only.joints, reason });
    }
    let adjacent: Vec<&PlanarPair> = planar.iter().filter(|pair| between(pair).is_empty()).collect();
    let (first, others) = adjacent.split_first()?;
    let follows = |other: &&PlanarPair| {
        let [a, b] = [first.joints[1], other.joints[0]];
        (a == b || tree.carries(a, tree.parent[b]))
            && other.plane.normal.cross(&first.plane.normal).norm() <= ALIGNMENT_TOLERANCE.sin()
    };
    let reason = match others.len() {
        0 => ", the only planar pair of neighbours".to_owned(),
        more => format!(", the first of {} planar pairs of neighbours, which share a plane", more + 1),
    };
    others.iter().all(follows).then_some(ImpliedPair { joints: first.joints, reason })
}

/// Returns the entries of `[robot]` that choose these pairs, for messages.
pub(super) fn choices(document: &Document, pairs: &[PlanarPair]) -> String {
    let entry = |pair: &PlanarPair| {
        let [a, b] = pair.joints.map(|j| document.robot.joints[j].name.as_str());
        format!("[robot] joints = [{a:?}, {b:?}]")
    };
    let shown: Vec<String> = pairs.iter().take(MAX_LISTED_PAIRS).map(entry).collect();
    let more = if pairs.len() > MAX_LISTED_PAIRS { ", ..." } else { "" };
    shown.join(", or ") + more
}

/// Returns the table without the entries for joints, tip and fixed values.
pub(super) fn without_joints(table: &RobotTable) -> RobotTable {
    RobotTable { joints: None, tip: None, fixed: PerJoint::new(), ..table.clone() }
}
