//! Reasons why a configuration is not free.

use super::{Contact, Pair, Scene};
use crate::space::Configuration;
use cplan_geometry::{Convex, Pose, separation, shapes_meet};
use cplan_text::{length, length_unlike};
use std::borrow::Cow;

/// A collision, or a distance below the clearance: a reason why a configuration is not free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstruction {
    /// The pair of shapes, with their distance.
    pub contact: Contact,
    /// True if the shapes meet, decided exactly. False if they are merely nearer than the clearance.
    pub touches: bool,
}

/// Depths below this, metres, are printed as "just touching".
const TOUCHING_DEPTH: f64 = 1e-9;

impl Scene {
    /// Returns the collisions of `q` with static obstacles and the distances below the clearance. Each link, and the
    /// attachment, has at most one entry per obstacle: the worst pair of shapes. Empty if `q` is free.
    pub fn obstructions(&self, q: Configuration) -> Vec<Obstruction> {
        self.worst(q, self.pairs().iter().map(|&pair| (pair, Cow::Borrowed(self.piece(pair)))))
    }

    /// Does the same as [`Scene::obstructions`], and includes the loose obstacles, which are at `poses`.
    pub fn obstructions_among(&self, q: Configuration, poses: &[Pose]) -> Vec<Obstruction> {
        let static_obstacles = self.pairs().iter().map(|&pair| (pair, Cow::Borrowed(self.piece(pair))));
        let loose = self.loose_pairs().iter().filter_map(|&pair| {
            let pose = poses.get(self.loose_index(pair)?)?;
            Some((pair, Cow::Owned(self.piece(pair).at(pose))))
        });
        self.worst(q, static_obstacles.chain(loose))
    }

    /// Returns the two bodies that are too close: the link, true if its payload is meant instead, and the obstacle.
    pub(super) fn bodies(&self, obstruction: &Obstruction) -> (usize, bool, usize) {
        let pair = obstruction.contact.pair;
        (pair.link, self.is_attached(pair), pair.obstacle)
    }

    fn worst<'a>(&self, q: Configuration, pieces: impl Iterator<Item = (Pair, Cow<'a, Convex>)>) -> Vec<Obstruction> {
        let poses = self.arm().pair_poses(q);
        let mut worst: Vec<Obstruction> = Vec::new();
        for (pair, piece) in pieces {
            let part = self.part(pair).at(&poses[pair.link]);
            let contact = Contact { pair, separation: separation(&part, &piece) };
            let (distance, growth) = (contact.separation.distance, self.growth(pair));
            let meet = distance <= 0.0 || shapes_meet(&part, &piece);
            // Grown shapes that meet need not touch.
            let touches = meet && distance + growth <= 0.0;
            if !meet && distance >= self.workspace().clearance {
                continue;
            }
            let found = Obstruction { contact, touches };
            match worst.iter_mut().find(|known| self.bodies(known) == self.bodies(&found)) {
                Some(known) if known.contact.separation.distance <= distance => {}
                Some(known) => *known = found,
                None => worst.push(found),
            }
        }
        worst
    }

    /// Describes an obstruction in words: `link "forearm" hits obstacle "shelf", 12.00 mm deep`.
    pub fn explain(&self, obstruction: &Obstruction) -> String {
        let pair = obstruction.contact.pair;
        let part = self.describe_part(pair);
        let moves = if self.loose_index(pair).is_some() { "moving " } else { "" };
        let obstacle = format!("{moves}{}", self.describe_obstacle(pair.obstacle));
        let distance = self.real_distance(&obstruction.contact);
        if !obstruction.touches {
            let required = self.required(pair);
            let (distance, least) = (length_unlike(distance, required), self.describe_required(pair));
            return format!("{part} is {distance} from {obstacle}, nearer than {least}");
        }
        let depth = (-distance).max(0.0);
        let how = match depth {
            _ if depth < TOUCHING_DEPTH => "just touching".to_owned(),
            _ => format!("{} deep", length(depth)),
        };
        format!("{part} hits {obstacle}, {how}")
    }
}
