//! The arm among its obstacles.

use super::calibration::slide;
use super::pairing::{HeightPolicy, PairPolicy, Pairing, numbered};
use super::scene_error::{check, check_clearance};
use super::scene_record::SceneRecord;
use super::{
    Additions, Arm, Attachment, Carrier, Heights, Link, LooseObstacle, Obstacle, Part, SceneError, SelfObstacle,
    Workspace,
};
use crate::space::Configuration;
use cplan_geometry::{Convex, Pose, Separation, separation};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A part of a link and a piece of an obstacle that can meet, because their heights overlap. All fields are indices
/// into the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// Index of the link, 0 or 1. 2 for a part of link 2 and an obstacle that joint 1 carries; their distance depends
    /// on joint 2 alone.
    pub link: usize,
    /// Index into the link's parts.
    pub part: usize,
    /// Index of the obstacle: first the workspace's obstacles, then the loose ones, then the arm's self obstacles.
    pub obstacle: usize,
    /// Index of the piece: first the obstacle's pieces, then the shapes derived from them for an attachment.
    pub piece: usize,
}

/// A pair with its distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The pair of shapes.
    pub pair: Pair,
    /// Signed distance of the two shapes, and its direction.
    pub separation: Separation,
}

/// An arm in a workspace, with the pairs of shapes that can meet. All collision checks use these pairs, so shapes at
/// different heights are ignored everywhere.
///
/// The shapes of an [`Attachment`] are parts of link 2. A level attachment never turns. It meets a piece exactly if
/// the tip lies in the Minkowski difference of the two. So the attachment's part is a point, the tip, and its pieces
/// are these differences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SceneRecord", into = "SceneRecord")]
pub struct Scene {
    arm: Arm,
    workspace: Workspace,
    additions: Additions,
    /// Number of link 2's own parts. The parts that follow belong to the attachment.
    own_parts: usize,
    policy: PairPolicy,
    pairs: Vec<Pair>,
    /// The pairs with loose obstacles.
    loose_pairs: Vec<Pair>,
    /// For each obstacle, in the order of their numbers: the shapes derived from its pieces. These are the Minkowski
    /// differences for a level attachment, and the smaller pieces of supports.
    differences: Vec<Vec<Convex>>,
}

/// [`Scene::within_reach`] returns a scene only if it omits more pairs than this. A few pairs more do not slow down a
/// search.
const MIN_PAIRS_TO_OMIT: usize = 200;

/// Bound on the relative rounding error of distances and of the reach, with a wide margin.
const ROUNDING: f64 = 1e-9;

impl Scene {
    /// Creates the scene of an arm in a workspace.
    ///
    /// # Errors
    /// If a value of the arm or the workspace is invalid: see [`SceneError`].
    pub fn new(arm: Arm, workspace: Workspace) -> Result<Self, SceneError> {
        Self::with(arm, workspace, Additions::default())
    }

    /// Creates the scene of an arm in a workspace, with additions.
    ///
    /// # Errors
    /// Same as for [`Scene::new`]; also if the additions name an obstacle that does not exist.
    pub fn with(arm: Arm, workspace: Workspace, additions: Additions) -> Result<Self, SceneError> {
        check(&arm, &workspace, &additions)?;
        Ok(Self::with_trusted(arm, workspace, additions))
    }

    /// Does the same as [`Scene::new`], without checks.
    #[doc(hidden)]
    pub fn trusted(arm: Arm, workspace: Workspace) -> Self {
        Self::with_trusted(arm, workspace, Additions::default())
    }

    /// Does the same as [`Scene::with`], without checks.
    #[doc(hidden)]
    pub fn with_trusted(arm: Arm, workspace: Workspace, additions: Additions) -> Self {
        Self::unchecked(arm, workspace, additions, PairPolicy::ALL)
    }

    /// Creates the scene without checks. `policy` decides which pairs it includes.
    fn unchecked(mut arm: Arm, workspace: Workspace, additions: Additions, policy: PairPolicy) -> Self {
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

    /// Returns the scene for proofs of collisions. It uses a part's inner shape where the outline covers more than the
    /// real part. Its pairs have heights that certainly overlap, and pieces that are not empty in exact arithmetic.
    pub fn inner(&self) -> Cow<'_, Self> {
        let parts = || self.arm.links.iter().flat_map(|link| &link.parts);
        let placed =
            || self.workspace.obstacles.iter().chain(self.loose_obstacles().iter().map(|loose| &loose.obstacle));
        let own = self.arm.self_obstacles.iter().map(|own| &own.obstacle);
        let is_level = self.attachment().is_some_and(|attachment| attachment.grip.is_level());
        let is_covered = is_level && self.arm.self_obstacles.iter().any(|own| own.carrier == Carrier::FirstJoint);
        // The heights of the robot's links are always known.
        let is_known = |is_carried: bool, part: &Part| {
            let meets = |meet: HeightPolicy, obstacle: &Obstacle| meet.meet(is_carried, part.heights, obstacle.heights);
            placed()
                .all(|obstacle| meets(HeightPolicy::Conservative, obstacle) == meets(HeightPolicy::Definite, obstacle))
        };
        let is_exact = self.policy.is_definite()
            || (0..2).all(|link| {
                let (own, carried) = (self.own_parts(link), &self.arm.links[link].parts[self.own_parts(link).len()..]);
                own.iter().all(|part| is_known(false, part)) && carried.iter().all(|part| is_known(true, part))
            });
        let mut attached = self.attachment().into_iter().flat_map(|attachment| &attachment.parts);
        let mut pieces = placed().chain(own).flat_map(|obstacle| &obstacle.pieces);
        let is_whole =
            self.policy.is_definite() || !(pieces.any(Convex::is_sliver) || attached.any(|part| !part.is_never_empty));
        let is_padded = placed()
            .chain(self.arm.self_obstacles.iter().map(|own| &own.obstacle))
            .any(|obstacle| obstacle.growth.padding > 0.0);
        let has_inner = |part: &Part| part.inner.is_some() || part.padding > 0.0;
        if is_exact && is_whole && !is_covered && !is_padded && !parts().any(has_inner) {
            return Cow::Borrowed(self);
        }
        let (policy, clearance) =
            (PairPolicy { meet: HeightPolicy::Definite, ..self.policy }, self.workspace.clearance);
        let unpad = |obstacle: &mut Obstacle| {
            obstacle.growth.padding = 0.0;
            obstacle.grow(clearance);
        };
        let inner = self.rebuilt_with(policy, |arm, workspace| {
            arm.links.iter_mut().flat_map(|link| &mut link.parts).for_each(Part::restrict_to_inner);
            let own = arm.self_obstacles.iter_mut().map(|own| &mut own.obstacle);
            workspace.obstacles.iter_mut().chain(own).for_each(unpad);
        });
        Cow::Owned(if is_padded { inner.with_loose(unpad) } else { inner })
    }

    /// Returns the scene with other shapes of the arm's own parts and other pieces of obstacles. How many parts and
    /// obstacles there are, and the attachment, stay the same.
    #[must_use]
    pub fn reshaped(&self, reshape: impl Fn(&mut Part), pieces: impl FnMut(&Obstacle) -> Vec<Convex>) -> Self {
        self.remade(reshape, pieces, self.policy)
    }

    /// Returns the scene with other heights of the arm's self obstacles. `heights` gets the name of the URDF link
    /// and its present heights, and returns the new ones.
    #[must_use]
    pub fn with_self_heights(&self, heights: impl Fn(&str, Heights) -> Heights) -> Self {
        self.changed(|arm, _| {
            for SelfObstacle { obstacle, .. } in &mut arm.self_obstacles {
                obstacle.heights = heights(&obstacle.name, obstacle.heights);
            }
        })
    }

    /// Returns the scene with its attachment at other heights.
    #[must_use]
    pub fn with_attached_heights(&self, heights: Heights) -> Self {
        self.with_attachment(|attachment| attachment.heights = heights)
    }

    /// Returns the scene after `change` has changed its attachment. Nothing is checked.
    #[must_use]
    #[doc(hidden)]
    pub fn with_attachment(&self, change: impl FnOnce(&mut Attachment)) -> Self {
        let mut scene = self.clone();
        if let Some(attachment) = &mut scene.additions.attachment {
            change(attachment);
        }
        scene.changed(|_, _| ())
    }

    /// Returns the scene without the pairs of static obstacles that the arm cannot reach, clearance included.
    /// Returns `None` if few pairs would be omitted, or if there is an attachment. Parts, obstacles and pieces keep
    /// their numbers.
    #[must_use]
    pub fn within_reach(&self) -> Option<Self> {
        if self.attachment().is_some() || self.pairs.len() <= MIN_PAIRS_TO_OMIT {
            return None;
        }
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

    /// Returns the scene after `change` has changed the arm (without its attachment) or the workspace. The additions
    /// stay the same. Nothing is checked.
    #[must_use]
    #[doc(hidden)]
    pub fn changed(&self, change: impl FnOnce(&mut Arm, &mut Workspace)) -> Self {
        self.rebuilt_with(self.policy, change)
    }

    fn rebuilt_with(&self, policy: PairPolicy, change: impl FnOnce(&mut Arm, &mut Workspace)) -> Self {
        let (mut arm, mut workspace) = (self.arm.clone(), self.workspace.clone());
        arm.links[1].parts.truncate(self.own_parts);
        change(&mut arm, &mut workspace);
        Self::unchecked(arm, workspace, self.additions.clone(), policy)
    }

    /// Returns the scene with another clearance, metres.
    ///
    /// # Errors
    /// If the clearance is negative, too large or not finite.
    pub fn with_clearance(self, clearance: f64) -> Result<Self, SceneError> {
        check_clearance(clearance)?;
        let changed = self.changed(|_, workspace| workspace.set_clearance(clearance));
        Ok(changed.with_loose(|obstacle| obstacle.grow(clearance)))
    }

    /// Returns the scene after `change` has changed each of its loose obstacles.
    pub(super) fn with_loose(mut self, change: impl Fn(&mut Obstacle)) -> Self {
        if self.additions.loose.is_empty() {
            return self;
        }
        self.additions.loose.iter_mut().for_each(|loose| change(&mut loose.obstacle));
        self.changed(|_, _| ())
    }

    /// Returns the scene with its loose obstacles at these poses. They become static obstacles, numbered after the
    /// others.
    #[must_use]
    pub fn with_loose_at(&self, poses: impl IntoIterator<Item = Pose>) -> Self {
        if self.loose_obstacles().is_empty() {
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

    /// Returns the arm without its attachment, and the workspace. They can be used for another scene.
    pub fn into_parts(mut self) -> (Arm, Workspace) {
        self.arm.links[1].parts.truncate(self.own_parts);
        (self.arm, self.workspace)
    }

    /// Returns the optional contents of the scene.
    pub fn additions(&self) -> &Additions {
        &self.additions
    }

    /// Returns the loose obstacles.
    pub fn loose_obstacles(&self) -> &[LooseObstacle] {
        &self.additions.loose
    }

    /// Returns the arm, with its attachment as parts of link 2.
    pub fn arm(&self) -> &Arm {
        &self.arm
    }

    /// Returns the workspace.
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// Returns mutable access to the arm, to change its joints' limits on speed, acceleration, jerk and effort. The
    /// pairs do not depend on these.
    pub fn arm_mut(&mut self) -> &mut Arm {
        &mut self.arm
    }

    /// Returns the attachment, if any.
    pub fn attachment(&self) -> Option<&Attachment> {
        self.additions.attachment.as_ref()
    }

    /// Returns the parts of a link, without those of the attachment.
    pub fn own_parts(&self, link: usize) -> &[Part] {
        let parts = &self.arm.links[link].parts;
        if link == 1 { &parts[..self.own_parts] } else { parts }
    }

    /// Returns all pairs of a part and a static or self obstacle that can meet. They are ordered by link, part,
    /// obstacle and piece.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Returns the pairs of a part and a loose obstacle that can meet, in the same order as [`Scene::pairs`]. Only
    /// the methods with `loose` in their names use them.
    pub fn loose_pairs(&self) -> &[Pair] {
        &self.loose_pairs
    }

    /// Returns the index of a pair's obstacle among the loose ones; `None` for other obstacles.
    pub fn loose_index(&self, pair: Pair) -> Option<usize> {
        pair.obstacle.checked_sub(self.workspace.obstacles.len()).filter(|index| *index < self.loose_obstacles().len())
    }

    /// Returns the link of a pair's part.
    pub fn link(&self, pair: Pair) -> &Link {
        &self.arm.links[pair.link.min(1)]
    }

    /// Returns the shape of a pair's part, in the link's frame.
    pub fn part(&self, pair: Pair) -> &Convex {
        &self.link(pair).parts[pair.part].shape
    }

    /// Returns the piece in a pair, or the shape derived from it for an attachment, in plane coordinates. For a
    /// loose obstacle, the coordinates are those of its own frame.
    pub fn piece(&self, pair: Pair) -> &Convex {
        let own = &self.obstacle(pair.obstacle).pieces;
        own.get(pair.piece).unwrap_or_else(|| &self.differences[pair.obstacle][pair.piece - own.len()])
    }

    /// Returns all pieces of a loose obstacle in its own frame, in the order of [`Pair::piece`].
    pub fn pieces_of_loose(&self, index: usize) -> impl Iterator<Item = &Convex> {
        let made = &self.differences[self.workspace.obstacles.len() + index];
        self.loose_obstacles()[index].obstacle.pieces.iter().chain(made)
    }

    /// Returns the signed distance of every pair at `q`, in the order of [`Scene::pairs`].
    pub fn separations(&self, q: Configuration) -> impl Iterator<Item = Contact> + '_ {
        let poses = self.arm.pair_poses(q);
        self.pairs.iter().map(move |&pair| Contact {
            pair,
            separation: separation(&self.part(pair).at(&poses[pair.link]), self.piece(pair)),
        })
    }

    /// Returns the pair with the least signed distance at `q`; `None` if there are no pairs.
    pub fn closest(&self, q: Configuration) -> Option<Contact> {
        self.separations(q).min_by(|a, b| a.separation.distance.total_cmp(&b.separation.distance))
    }

    /// Returns the least signed distance between the arm and the obstacles at `q`, metres; infinite if there are no
    /// pairs.
    pub fn clearance(&self, q: Configuration) -> f64 {
        self.closest(q).map_or(f64::INFINITY, |c| c.separation.distance)
    }

    /// Returns true if a pair's part belongs to the attachment.
    pub fn is_attached(&self, pair: Pair) -> bool {
        pair.link > 0 && pair.part >= self.own_parts
    }

    /// Returns the obstacle's piece of a pair, in plane coordinates. For an attachment, a pair may use a shape that is
    /// derived from this piece; this function still returns the piece itself.
    pub fn obstacle_piece(&self, pair: Pair) -> &Convex {
        let pieces = &self.obstacle(pair.obstacle).pieces;
        // For each attached part, the derived shapes are one full set of pieces, numbered after the pieces.
        &pieces[pair.piece % pieces.len()]
    }
}
