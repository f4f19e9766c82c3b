//! The arm among its obstacles.

use super::{Arm, Workspace};
use crate::geometry::{Convex, Separation, separation};
use crate::space::Configuration;

/// A part of a link and a piece of an obstacle that can meet: their heights do. Indices into the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// 0 or 1.
    pub link: usize,
    /// Into the link's parts.
    pub part: usize,
    /// Into the workspace's obstacles.
    pub obstacle: usize,
    /// Into the obstacle's pieces.
    pub piece: usize,
}

/// A pair and how its shapes lie to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Which shapes.
    pub pair: Pair,
    /// Their signed distance and its direction.
    pub separation: Separation,
}

/// Arm and workspace, with the pairs of shapes that can meet at all. Every module that asks about collisions asks
/// about these pairs, so a pair that heights rule out is ruled out everywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The arm.
    pub arm: Arm,
    /// What surrounds it.
    pub workspace: Workspace,
    pairs: Vec<Pair>,
}

impl Scene {
    /// Puts the arm into the workspace.
    #[must_use]
    pub fn new(arm: Arm, workspace: Workspace) -> Self {
        let mut pairs = Vec::new();
        for (link, l) in arm.links.iter().enumerate() {
            for (part, p) in l.parts.iter().enumerate() {
                for (obstacle, o) in workspace.obstacles.iter().enumerate() {
                    if p.heights.meet(o.heights) {
                        pairs.extend((0..o.pieces.len()).map(|piece| Pair { link, part, obstacle, piece }));
                    }
                }
            }
        }
        Self { arm, workspace, pairs }
    }

    /// All pairs that can meet, ordered by link, part, obstacle, piece.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// The link part of a pair, in its link's frame.
    #[must_use]
    pub fn part(&self, pair: Pair) -> &Convex {
        &self.arm.links[pair.link].parts[pair.part].shape
    }

    /// The obstacle piece of a pair, in plane coordinates.
    #[must_use]
    pub fn piece(&self, pair: Pair) -> &Convex {
        &self.workspace.obstacles[pair.obstacle].pieces[pair.piece]
    }

    /// Signed distance of every pair at `q`, in the order of [`Scene::pairs`].
    pub fn separations(&self, q: Configuration) -> impl Iterator<Item = Contact> + '_ {
        let poses = self.arm.poses(q);
        self.pairs.iter().map(move |&pair| Contact {
            pair,
            separation: separation(&self.part(pair).at(&poses[pair.link]), self.piece(pair)),
        })
    }

    /// The pair with the least signed distance at `q`; none when nothing can meet.
    #[must_use]
    pub fn closest(&self, q: Configuration) -> Option<Contact> {
        self.separations(q).min_by(|a, b| a.separation.distance.total_cmp(&b.separation.distance))
    }

    /// Least signed distance between arm and obstacles at `q`, metres; infinite when nothing can meet.
    #[must_use]
    pub fn clearance(&self, q: Configuration) -> f64 {
        self.closest(q).map_or(f64::INFINITY, |c| c.separation.distance)
    }

    /// The pair in words: `link "forearm" and obstacle "shelf"`.
    #[must_use]
    pub fn describe(&self, pair: Pair) -> String {
        let link = &self.arm.links[pair.link];
        let body = &link.parts[pair.part].body;
        let obstacle = &self.workspace.obstacles[pair.obstacle].name;
        if *body == link.name {
            format!("link \"{}\" and obstacle \"{obstacle}\"", link.name)
        } else {
            format!("link \"{}\" (body \"{body}\") and obstacle \"{obstacle}\"", link.name)
        }
    }
}
