//! Decides which pairs of shapes of a scene can meet.

use super::attachment::MeetablePieces;
use super::{Carrier, Heights, Link, LooseObstacle, Obstacle, Pair, Part, SelfObstacle};
use cplan_geometry::{Convex, Point, separation};

/// Rule for two extents of heights if rounding leaves open whether they overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum HeightPolicy {
    /// The extents count as overlapping, so that no collision is missed.
    Conservative,
    /// The extents count as apart, so that every collision is proven.
    Definite,
}

impl HeightPolicy {
    /// Returns true if the heights of a part and of an obstacle meet. `is_attached` is true if the part belongs
    /// to the attachment, which may rest on the obstacle.
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
    /// Rule for heights whose overlap rounding leaves open.
    pub meet: HeightPolicy,
    /// Pieces of static obstacles farther than this from joint 1, metres, are in no pair.
    pub farthest: f64,
}

impl PairPolicy {
    /// Policy that includes all pairs that may meet.
    pub const ALL: Self = Self { meet: HeightPolicy::Conservative, farthest: f64::INFINITY };

    /// Returns true if a contact of a pair proves a collision.
    pub fn is_definite(&self) -> bool {
        self.meet == HeightPolicy::Definite
    }

    /// Returns true if contacts of this piece prove no collision, because the piece may be empty in exact
    /// arithmetic.
    pub fn may_be_empty(&self, piece: &Convex) -> bool {
        self.is_definite() && piece.is_sliver()
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
    /// The arm's links; the parts of the attachment are among those of link 2.
    pub links: &'a [Link; 2],
    /// Position of joint 1, metres.
    pub base: Point,
    /// All obstacles, in the order of their numbers.
    pub obstacles: &'a [(ObstacleKind<'a>, &'a Obstacle)],
    pub policy: PairPolicy,
    /// Number of link 2's own parts. The parts that follow belong to the attachment.
    pub own_parts: usize,
    /// For each attached part, the pieces that it can meet.
    pub attached: &'a [MeetablePieces],
    /// Numbers of the obstacles that link 2's own parts may touch.
    pub allowed_contacts: &'a [usize],
}

impl Pairing<'_> {
    /// Returns two lists: the pairs with obstacles that are not loose, and the pairs with loose obstacles. Each list is
    /// ordered by link, part, obstacle and piece.
    pub fn pairs(&self) -> [Vec<Pair>; 2] {
        let excluded_pieces = self.excluded_pieces();
        // For each attached part, the derived shapes are one full set of pieces, numbered after the pieces.
        let is_kept = |pair: &Pair| excluded_pieces.get(pair.obstacle).is_none_or(|all| !all[pair.piece % all.len()]);
        let (mut pairs, mut loose, mut folding) = (Vec::new(), Vec::new(), Vec::new());
        let parts = |link: usize| self.links[link].parts.iter().enumerate().map(move |(part, p)| (link, part, p));
        for (link, part, p) in parts(0).chain(parts(1)) {
            let attached = if link == 1 { part.checked_sub(self.own_parts) } else { None };
            let attached = attached.map(|number| &self.attached[number]);
            for (obstacle, &(kind, o)) in self.obstacles.iter().enumerate() {
                if !self.can_meet((link, part), p, attached.is_some(), kind, o) {
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

    /// Returns true if the heights and the carriers of a part and of an obstacle allow them to meet. `at` is the part's
    /// link, and its number there.
    fn can_meet(
        &self,
        at: (usize, usize),
        part: &Part,
        is_attached: bool,
        kind: ObstacleKind,
        obstacle: &Obstacle,
    ) -> bool {
        let ObstacleKind::Own(own) = kind else {
            return self.policy.meet.meet(is_attached, part.heights, obstacle.heights);
        };
        // The heights of links that lie on each other touch, so only definite overlaps count.
        (at.0 == 1 || own.carrier == Carrier::Base)
            && part.heights.overlap(obstacle.heights)
            && (is_attached || !own.ignores(at.0, at.1, &part.body))
    }

    /// Returns for each obstacle, and each of its pieces, whether the piece is in no pair. Returns an empty list if
    /// all pieces may be in pairs.
    fn excluded_pieces(&self) -> Vec<Vec<bool>> {
        let PairPolicy { farthest, .. } = self.policy;
        if farthest.is_infinite() && !self.policy.is_definite() {
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
