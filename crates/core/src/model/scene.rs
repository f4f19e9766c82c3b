//! The arm among its obstacles.

use super::pairing::{HeightPolicy, PairPolicy, Pairing, numbered};
use super::scene_error::{check, check_clearance};
use super::scene_record::SceneRecord;
use super::{
    Additions, Arm, Attachment, Carrier, Heights, Joint, Link, LooseObstacle, Obstacle, Part, SceneError, SelfObstacle,
    Workspace,
};
use crate::space::{Configuration, JointRange};
use cplan_geometry::{Convex, Pose, Separation, separation};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A part of a link and a piece of an obstacle that can meet, because they share a height. Indices into the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// 0 or 1 for the link; 2 for link 2 relative to link 1, with an obstacle that joint 1 carries.
    pub link: usize,
    /// Index into the link's parts.
    pub part: usize,
    /// Index into the workspace's obstacles, followed by the loose obstacles, followed by the arm's self obstacles.
    pub obstacle: usize,
    /// Index into the obstacle's pieces, followed by the shapes derived from them for an attachment.
    pub piece: usize,
}

/// A pair with its distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The pair of shapes.
    pub pair: Pair,
    /// Their signed distance and its direction.
    pub separation: Separation,
}

/// Arm and workspace, with the pairs of shapes that can meet at all. Every module that asks about collisions asks
/// about these pairs, so a pair that heights rule out is ruled out everywhere.
///
/// The shapes of an [`Attachment`] are parts of link 2. One that is kept level only translates with the tip: it meets a
/// piece exactly when the tip lies in their Minkowski difference, so its part is the tip, a point, and its pieces are
/// these differences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SceneRecord", into = "SceneRecord")]
pub struct Scene {
    arm: Arm,
    workspace: Workspace,
    additions: Additions,
    /// Number of link 2's own parts; those that follow are attached.
    own_parts: usize,
    policy: PairPolicy,
    pairs: Vec<Pair>,
    /// The pairs with loose obstacles.
    loose_pairs: Vec<Pair>,
    /// For each static, loose and self obstacle, in this order: the shapes derived from its pieces for a level
    /// attachment, and the smaller pieces of supports.
    differences: Vec<Vec<Convex>>,
}

/// A search omits the pairs out of reach if there are more than this; with fewer it is as fast.
const MIN_PAIRS_TO_OMIT: usize = 200;

/// Share by which rounding may make a distance too large or a reach too small, with a wide margin.
const ROUNDING: f64 = 1e-9;

impl Scene {
    /// Puts the arm into the workspace.
    ///
    /// # Errors
    /// If a number of either makes no sense: see [`SceneError`].
    pub fn new(arm: Arm, workspace: Workspace) -> Result<Self, SceneError> {
        Self::with(arm, workspace, Additions::default())
    }

    /// Puts the arm into the workspace, with these additions.
    ///
    /// # Errors
    /// Same as for [`Scene::new`]; also if there is no obstacle of a given number.
    pub fn with(arm: Arm, workspace: Workspace, additions: Additions) -> Result<Self, SceneError> {
        check(&arm, &workspace, &additions)?;
        Ok(Self::with_trusted(arm, workspace, additions))
    }

    /// Same as [`Scene::new`], without checks.
    #[must_use]
    #[doc(hidden)]
    pub fn trusted(arm: Arm, workspace: Workspace) -> Self {
        Self::with_trusted(arm, workspace, Additions::default())
    }

    /// Same as [`Scene::with`], without checks.
    #[must_use]
    #[doc(hidden)]
    pub fn with_trusted(arm: Arm, workspace: Workspace, additions: Additions) -> Self {
        Self::assembled(arm, workspace, additions, PairPolicy::ALL)
    }

    /// Creates the scene without checks.
    fn assembled(mut arm: Arm, workspace: Workspace, additions: Additions, policy: PairPolicy) -> Self {
        debug_assert_eq!(check(&arm, &workspace, &additions), Ok(()));
        let Additions { loose, attachment, allowed_contacts } = &additions;
        let own_parts = arm.links[1].parts.len();
        let obstacles = numbered(&workspace.obstacles, loose, &arm.self_obstacles);
        let mut differences = vec![Vec::new(); obstacles.len()];
        let (parts, attached): (Vec<_>, Vec<_>) = attachment
            .iter()
            .flat_map(|carried| carried.on_link(arm.tip, &obstacles, workspace.clearance, &policy, &mut differences))
            .unzip();
        arm.links[1].parts.extend(parts);
        let pairing = Pairing {
            links: &arm.links,
            base: arm.base,
            obstacles: &obstacles,
            policy,
            own_parts,
            attached: &attached,
            allowed_contacts,
        };
        let [pairs, loose_pairs] = pairing.pairs();
        Self { arm, workspace, additions, own_parts, policy, pairs, loose_pairs, differences }
    }

    /// Returns the scene for proofs of collisions. It uses inner shapes where an outline covers more than the real
    /// part, only heights that certainly meet, and no pieces that may be empty without rounding.
    #[must_use]
    pub fn inner(&self) -> Cow<'_, Self> {
        let parts = || self.arm.links.iter().flat_map(|link| &link.parts);
        let placed = || self.workspace.obstacles.iter().chain(self.loose().iter().map(|loose| &loose.obstacle));
        let own = self.arm.self_obstacles.iter().map(|own| &own.obstacle);
        let is_level = self.attachment().is_some_and(|attachment| attachment.grip.is_level());
        let is_covered = is_level && self.arm.self_obstacles.iter().any(|own| own.carrier == Carrier::FirstJoint);
        // The heights of the robot's links are always known.
        let is_known = |is_carried: bool, part: &Part| {
            let meets = |meet: HeightPolicy, obstacle: &Obstacle| meet.meet(is_carried, part.heights, obstacle.heights);
            placed()
                .all(|obstacle| meets(HeightPolicy::Conservative, obstacle) == meets(HeightPolicy::Definite, obstacle))
        };
        let is_exact = self.policy.proves_collisions()
            || (0..2).all(|link| {
                let (own, carried) = (self.own_parts(link), &self.arm.links[link].parts[self.own_parts(link).len()..]);
                own.iter().all(|part| is_known(false, part)) && carried.iter().all(|part| is_known(true, part))
            });
        let mut attached = self.attachment().into_iter().flat_map(|attachment| &attachment.parts);
        let mut pieces = placed().chain(own).flat_map(|obstacle| &obstacle.pieces);
        let is_whole = self.policy.proves_collisions()
            || !(pieces.any(Convex::is_sliver) || attached.any(|part| !part.proves_collisions));
        if is_exact && is_whole && !is_covered && parts().all(|part| part.inner.is_none()) {
            return Cow::Borrowed(self);
        }
        let shrink = |part: &mut Part| {
            if let Some(inner) = part.inner.take() {
                part.shape = inner;
            }
        };
        Cow::Owned(self.remade(
            shrink,
            |obstacle| obstacle.pieces.clone(),
            PairPolicy { meet: HeightPolicy::Definite, ..self.policy },
        ))
    }

    /// Returns the scene with other shapes for the arm's own parts and for the pieces of obstacles. Each part stays one
    /// part, each obstacle stays one obstacle, and the attachment is unchanged.
    #[must_use]
    pub fn reshaped(&self, reshape: impl Fn(&mut Part), pieces: impl FnMut(&Obstacle) -> Vec<Convex>) -> Self {
        self.remade(reshape, pieces, self.policy)
    }

    /// Returns the scene with other heights for the arm's self obstacles. The function gets the URDF link's name and
    /// its present heights.
    #[must_use]
    pub fn with_self_heights(&self, heights: impl Fn(&str, Heights) -> Heights) -> Self {
        self.changed(|arm, _| {
            for SelfObstacle { obstacle, .. } in &mut arm.self_obstacles {
                obstacle.heights = heights(&obstacle.name, obstacle.heights);
            }
        })
    }

    /// Returns the scene without the pairs of static obstacles that are out of the arm's reach, clearance included.
    /// Returns `None` if these are few, or if there is an attachment. Each part, obstacle and piece keeps its number.
    #[must_use]
    pub fn within_reach(&self) -> Option<Self> {
        if self.attachment().is_some() || self.pairs.len() <= MIN_PAIRS_TO_OMIT {
            return None;
        }
        let slide = |joint: &Joint| match (joint.joint_type.is_revolute(), joint.range) {
            (true, _) => 0.0,
            (false, JointRange::Interval { lower, upper }) => lower.abs().max(upper.abs()),
            (false, JointRange::Circle) => f64::INFINITY,
        };
        let out = self.arm.reach() + self.arm.joints.iter().map(slide).sum::<f64>() + self.workspace.clearance;
        let policy = PairPolicy { farthest: out * (1.0 + ROUNDING), ..self.policy };
        let near = self.remade(|_| (), |obstacle| obstacle.pieces.clone(), policy);
        (near.pairs.len() + MIN_PAIRS_TO_OMIT < self.pairs.len()).then_some(near)
    }

    fn remade(
        &self,
        reshape: impl Fn(&mut Part),
        pieces: impl FnMut(&Obstacle) -> Vec<Convex>,
        policy: PairPolicy,
    ) -> Self {
        let pieces: Vec<Vec<Convex>> = self.workspace.obstacles.iter().map(pieces).collect();
        self.rebuilt_with(policy, |arm, workspace| {
            arm.links.iter_mut().flat_map(|link| &mut link.parts).for_each(reshape);
            for (obstacle, pieces) in workspace.obstacles.iter_mut().zip(pieces) {
                obstacle.pieces = pieces;
            }
        })
    }

    /// Returns the scene with a change of the arm (without its attachment) or the workspace, without checks. The
    /// additions stay as they are.
    #[must_use]
    #[doc(hidden)]
    pub fn changed(&self, change: impl FnOnce(&mut Arm, &mut Workspace)) -> Self {
        self.rebuilt_with(self.policy, change)
    }

    fn rebuilt_with(&self, policy: PairPolicy, change: impl FnOnce(&mut Arm, &mut Workspace)) -> Self {
        let (mut arm, mut workspace) = (self.arm.clone(), self.workspace.clone());
        arm.links[1].parts.truncate(self.own_parts);
        change(&mut arm, &mut workspace);
        Self::assembled(arm, workspace, self.additions.clone(), policy)
    }

    /// Returns the scene with another distance to keep, metres.
    ///
    /// # Errors
    /// If the distance is negative or not finite.
    pub fn with_clearance(self, clearance: f64) -> Result<Self, SceneError> {
        check_clearance(clearance)?;
        Ok(self.changed(|_, workspace| workspace.clearance = clearance))
    }

    /// Returns the scene with its loose obstacles at these poses. They become static, after all static ones.
    #[must_use]
    pub fn with_loose_at(&self, poses: impl IntoIterator<Item = Pose>) -> Self {
        if self.loose().is_empty() {
            return self.clone();
        }
        let mut scene = self.clone();
        let loose = std::mem::take(&mut scene.additions.loose);
        let placed = loose.iter().zip(poses).map(|(loose, pose)| loose.obstacle.at(&pose));
        scene.changed(|_, workspace| workspace.obstacles.extend(placed))
    }

    /// Returns the scene with one more static obstacle.
    #[must_use]
    pub fn with_static_obstacle(&self, obstacle: Obstacle) -> Self {
        let (mut scene, static_obstacles) = (self.clone(), self.workspace.obstacles.len());
        // Loose obstacles are numbered after the static ones.
        let numbers = scene.additions.allowed_contacts.iter_mut();
        numbers.filter(|number| **number >= static_obstacles).for_each(|number| *number += 1);
        scene.changed(|_, workspace| workspace.obstacles.push(obstacle))
    }

    /// Returns the arm without its attachment, and the workspace, from which another scene can be made.
    #[must_use]
    pub fn into_parts(mut self) -> (Arm, Workspace) {
        self.arm.links[1].parts.truncate(self.own_parts);
        (self.arm, self.workspace)
    }

    /// Obstacles that link 2 itself is free to meet, by their number.
    #[must_use]
    pub fn allowed_contacts(&self) -> &[usize] {
        &self.additions.allowed_contacts
    }

    /// Returns what the scene has beyond arm and workspace.
    #[must_use]
    pub fn additions(&self) -> &Additions {
        &self.additions
    }

    /// Returns the loose obstacles.
    #[must_use]
    pub fn loose(&self) -> &[LooseObstacle] {
        &self.additions.loose
    }

    /// Returns the arm, with its attachment as parts of link 2.
    #[must_use]
    pub fn arm(&self) -> &Arm {
        &self.arm
    }

    /// Returns the workspace.
    #[must_use]
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// Gives access to the arm, to change its joints' limits on speed, acceleration, jerk and effort. The pairs do not
    /// depend on them.
    pub fn arm_mut(&mut self) -> &mut Arm {
        &mut self.arm
    }

    /// Returns the attachment, if any.
    #[must_use]
    pub fn attachment(&self) -> Option<&Attachment> {
        self.additions.attachment.as_ref()
    }

    /// Returns the link's own outline, without the attachment.
    #[must_use]
    pub fn own_parts(&self, link: usize) -> &[Part] {
        let parts = &self.arm.links[link].parts;
        if link == 1 { &parts[..self.own_parts] } else { parts }
    }

    /// Returns all pairs that can meet, ordered by link, part, obstacle, piece.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Returns the pairs of a part and a loose obstacle that can meet, in the same order. All other methods are about
    /// static obstacles.
    #[must_use]
    pub fn loose_pairs(&self) -> &[Pair] {
        &self.loose_pairs
    }

    /// Returns the index of a pair's obstacle among the loose ones, if the pair is one of [`Scene::loose_pairs`].
    #[must_use]
    pub fn loose_index(&self, pair: Pair) -> Option<usize> {
        pair.obstacle.checked_sub(self.workspace.obstacles.len()).filter(|index| *index < self.loose().len())
    }

    /// Returns the link of a pair's part.
    #[must_use]
    pub fn link(&self, pair: Pair) -> &Link {
        &self.arm.links[pair.link.min(1)]
    }

    /// Returns the link part of a pair, in its link's frame.
    #[must_use]
    pub fn part(&self, pair: Pair) -> &Convex {
        &self.link(pair).parts[pair.part].shape
    }

    /// Returns the obstacle piece of a pair, or the shape derived from it for an attachment, in plane coordinates. For a
    /// loose obstacle it is in the obstacle's own frame.
    #[must_use]
    pub fn piece(&self, pair: Pair) -> &Convex {
        let own = &self.obstacle(pair.obstacle).pieces;
        own.get(pair.piece).unwrap_or_else(|| &self.differences[pair.obstacle][pair.piece - own.len()])
    }

    /// Returns all pieces of a loose obstacle, in its own frame, as [`Pair::piece`] counts them.
    pub fn pieces_of_loose(&self, index: usize) -> impl Iterator<Item = &Convex> {
        let made = &self.differences[self.workspace.obstacles.len() + index];
        self.loose()[index].obstacle.pieces.iter().chain(made)
    }

    /// Returns the signed distance of every pair at `q`, in the order of [`Scene::pairs`].
    pub fn separations(&self, q: Configuration) -> impl Iterator<Item = Contact> + '_ {
        let poses = self.arm.pair_poses(q);
        self.pairs.iter().map(move |&pair| Contact {
            pair,
            separation: separation(&self.part(pair).at(&poses[pair.link]), self.piece(pair)),
        })
    }

    /// Returns the pair with the least signed distance at `q`; `None` if nothing can meet.
    #[must_use]
    pub fn closest(&self, q: Configuration) -> Option<Contact> {
        self.separations(q).min_by(|a, b| a.separation.distance.total_cmp(&b.separation.distance))
    }

    /// Returns the least signed distance between arm and obstacles at `q`, metres; infinite when nothing can meet.
    #[must_use]
    pub fn clearance(&self, q: Configuration) -> f64 {
        self.closest(q).map_or(f64::INFINITY, |c| c.separation.distance)
    }

    /// Returns true if a pair's part belongs to the attachment.
    #[must_use]
    pub fn is_attached(&self, pair: Pair) -> bool {
        pair.link > 0 && pair.part >= self.own_parts
    }

    /// Returns the original piece of the obstacle in a pair, at its place, even if the pair uses a shape derived from
    /// it for an attachment.
    #[must_use]
    pub fn obstacle_piece(&self, pair: Pair) -> &Convex {
        let pieces = &self.obstacle(pair.obstacle).pieces;
        // Derived shapes come after the pieces: one full set of pieces per attached part.
        &pieces[pair.piece % pieces.len()]
    }
}
