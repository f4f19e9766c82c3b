//! Decides which pairs of shapes of a scene can meet.

use super::attachment::MeetablePieces;
use super::{Carrier, Heights, Link, LooseObstacle, Obstacle, Pair, Part, SelfObstacle};
use cplan_geometry::{Convex, Point, separation};

/// Treatment of heights where rounding leaves open whether they meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum HeightPolicy {
    /// They meet: conservative, for claims that a configuration is free.
    Conservative,
    /// They do not meet: for proofs that the arm collides.
    Definite,
}

impl HeightPolicy {
    /// Returns true if a part of the arm, or one that is attached to it, shares a height with an obstacle.
    pub fn meet(self, is_attached: bool, part: Heights, obstacle: Heights) -> bool {
        match (self, is_attached) {
            (Self::Conservative, false) => part.meet(obstacle),
            (Self::Conservative, true) => part.object_may_meet(obstacle),
            (Self::Definite, false) => part.definitely_meet(obstacle),
            (Self::Definite, true) => part.object_definitely_meets(obstacle),
        }
    }
}

/// The rule that decides which pairs a scene includes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PairPolicy {
    /// Treatment of heights.
    pub meet: HeightPolicy,
    /// Greatest distance of static pieces from joint 1, metres; farther ones are in no pair.
    pub farthest: f64,
}

impl PairPolicy {
    /// The rule that includes all pairs that may meet.
    pub const ALL: Self = Self { meet: HeightPolicy::Conservative, farthest: f64::INFINITY };

    /// Returns true if a contact proves a collision.
    pub fn proves_collisions(&self) -> bool {
        self.meet == HeightPolicy::Definite
    }

    /// Returns true if a piece may be empty without rounding, and so is no evidence.
    pub fn may_be_empty(&self, piece: &Convex) -> bool {
        self.proves_collisions() && piece.is_sliver()
    }
}

/// The kind of an obstacle of a scene.
#[derive(Clone, Copy)]
pub(super) enum ObstacleKind<'a> {
    /// A static obstacle.
    Static,
    /// A loose obstacle.
    Loose(&'a LooseObstacle),
    /// A link of the robot.
    Own(&'a SelfObstacle),
}

/// Returns all obstacles in the order of their numbers: static ones, loose ones, links of the robot.
pub(super) fn numbered<'a>(
    static_obstacles: &'a [Obstacle],
    loose: &'a [LooseObstacle],
    own: &'a [SelfObstacle],
) -> Vec<(ObstacleKind<'a>, &'a Obstacle)> {
    let static_obstacles = static_obstacles.iter().map(|obstacle| (ObstacleKind::Static, obstacle));
    let loose = loose.iter().map(|loose| (ObstacleKind::Loose(loose), &loose.obstacle));
    let own = own.iter().map(|own| (ObstacleKind::Own(own), &own.obstacle));
    static_obstacles.chain(loose).chain(own).collect()
}

/// The data that decide which pairs a scene has.
pub(super) struct Pairing<'a> {
    /// The arm's links, with the attachment.
    pub links: &'a [Link; 2],
    /// The place of joint 1.
    pub base: Point,
    /// All obstacles, in the order of their numbers.
    pub obstacles: &'a [(ObstacleKind<'a>, &'a Obstacle)],
    pub policy: PairPolicy,
    /// Number of link 2's own parts; those after them are attached.
    pub own_parts: usize,
    /// The pieces that each attached part can meet.
    pub attached: &'a [MeetablePieces],
    /// Obstacles that link 2 itself is free to meet.
    pub allowed_contacts: &'a [usize],
}

impl Pairing<'_> {
    /// Returns the pairs with static and with loose obstacles, each ordered by link, part, obstacle and piece.
    pub fn pairs(&self) -> [Vec<Pair>; 2] {
        let excluded_pieces = self.excluded_pieces();
        // Shapes derived from pieces come after the pieces: one full set of pieces per attached part.
        let is_kept = |pair: &Pair| excluded_pieces.get(pair.obstacle).is_none_or(|all| !all[pair.piece % all.len()]);
        let (mut pairs, mut loose, mut folding) = (Vec::new(), Vec::new(), Vec::new());
        let parts = |link: usize| self.links[link].parts.iter().enumerate().map(move |(part, p)| (link, part, p));
        for (link, part, p) in parts(0).chain(parts(1)) {
            let attached = if link == 1 { part.checked_sub(self.own_parts) } else { None };
            let attached = attached.map(|number| &self.attached[number]);
            for (obstacle, &(kind, o)) in self.obstacles.iter().enumerate() {
                if !self.can_meet(link, p, attached.is_some(), kind, o) {
                    continue;
                }
                let pieces = match attached {
                    Some(meetable) => meetable[obstacle].clone(),
                    None if link == 1 && self.allowed_contacts.contains(&obstacle) => 0..0,
                    None => 0..o.pieces.len(),
                };
                let (among, link) = match kind {
                    ObstacleKind::Loose(_) => (&mut loose, link),
                    ObstacleKind::Own(SelfObstacle { carrier: Carrier::FirstJoint, .. }) => (&mut folding, 2),
                    ObstacleKind::Static | ObstacleKind::Own(_) => (&mut pairs, link),
                };
                among.extend(pieces.map(|piece| Pair { link, part, obstacle, piece }).filter(is_kept));
            }
        }
        pairs.extend(folding);
        [pairs, loose]
    }

    /// Returns true if a part of a link and an obstacle can meet, by their heights and their carriers.
    fn can_meet(&self, link: usize, part: &Part, is_attached: bool, kind: ObstacleKind, obstacle: &Obstacle) -> bool {
        let ObstacleKind::Own(own) = kind else {
            return self.policy.meet.meet(is_attached, part.heights, obstacle.heights);
        };
        // Links of a robot lie on top of each other.
        (link == 1 || own.carrier == Carrier::Base)
            && part.heights.definitely_meet(obstacle.heights)
            && (is_attached || !own.ignores(&part.body))
    }

    /// Returns, for each obstacle, true for each piece that is in no pair; nothing at all if every piece may be in one.
    fn excluded_pieces(&self) -> Vec<Vec<bool>> {
        let PairPolicy { farthest, .. } = self.policy;
        if farthest.is_infinite() && !self.policy.proves_collisions() {
            return Vec::new();
        }
        let base = Convex::point(self.base);
        let is_left_out = |kind: ObstacleKind, piece: &Convex| {
            let is_far = || matches!(kind, ObstacleKind::Static) && separation(&base, piece).distance > farthest;
            (farthest.is_finite() && is_far()) || self.policy.may_be_empty(piece)
        };
        let of =
            |(kind, o): &(ObstacleKind, &Obstacle)| o.pieces.iter().map(|piece| is_left_out(*kind, piece)).collect();
        self.obstacles.iter().map(of).collect()
    }
}
