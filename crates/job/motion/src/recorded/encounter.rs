//! Results of the continuous check of a motion.

use cplan_handling::Piece;
use cplan_model::Contact;
use cplan_model::space::Configuration;

/// A time during a recorded motion, with the configuration at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Time on the recording's clock, seconds. Without times, the index of the waypoint plus the fraction of the distance to the
    /// next one.
    pub time: f64,
    /// Index of the last sample at or before the moment, from 0.
    pub sample: usize,
    /// Configuration of the arm.
    pub at: Configuration,
}

impl Moment {
    /// Creates the moment at the share `u` of a piece. The piece leads from the sample `index` to the next one.
    pub fn new(index: usize, piece: &Piece, u: f64) -> Self {
        // The end of a piece is the next sample, unless the piece has no duration.
        let sample = index + usize::from(u == 1.0 && piece.to > piece.from);
        Self { time: piece.time(u), sample, at: piece.at(u) }
    }
}

/// A pair of shapes at a moment of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    /// The moment on the motion.
    pub moment: Moment,
    /// The shapes, and their signed distance at that moment.
    pub contact: Contact,
}

/// Whether a motion that comes too near an obstacle also touches it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// Proven: the motion touches an obstacle.
    Proven,
    /// Proven: the motion touches no obstacle.
    Excluded,
    /// Neither is proven.
    Undecided,
}

/// Result of the continuous check of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CollisionCheck {
    /// Proven: the whole motion keeps more than zero and at least the required clearance.
    Free {
        /// Lower bound on the distance between arm and obstacles along the whole motion, metres; infinite if nothing can meet. It
        /// is at least 0.9 of the true distance, or at least the required clearance.
        clearance: f64,
        /// The nearest place found; `None` if nothing can meet.
        nearest: Option<Encounter>,
    },
    /// Proven: the motion touches an obstacle, or comes nearer to it than the required clearance.
    Collision {
        /// The earliest contact found.
        first: Encounter,
        /// Time, on the same clock, before which the motion is proven free. Usually it is a trillionth of a piece before `first`;
        /// it is earlier if the motion grazes an obstacle before.
        free_until: f64,
        /// The encounter with the least signed distance that was seen.
        deepest: Encounter,
        /// Whether the motion touches the obstacle.
        touch: Touch,
    },
    /// Undecided: the first moment at which the distance is too near the clearance to decide, or at which the search reached its
    /// limit.
    Undecided(Encounter),
}

impl CollisionCheck {
    /// Returns the proven clearance of a free motion.
    pub fn clearance(&self) -> Option<f64> {
        match self {
            Self::Free { clearance, .. } => Some(*clearance),
            Self::Collision { .. } | Self::Undecided(_) => None,
        }
    }

    /// Returns true if the motion is free.
    pub fn is_free(&self) -> bool {
        self.clearance().is_some()
    }

    /// Returns true if the other motion is free, and this one is not, or has a smaller clearance.
    pub fn is_worse_than(&self, other: &Self) -> bool {
        other.clearance().is_some_and(|least| self.clearance().is_none_or(|clearance| clearance < least))
    }

    /// Returns the moments of all encounters.
    pub fn moments_mut(&mut self) -> impl Iterator<Item = &mut Moment> {
        let encounters = match self {
            Self::Free { nearest, .. } => [nearest.as_mut(), None],
            Self::Collision { first, deepest, .. } => [Some(first), Some(deepest)],
            Self::Undecided(nearest) => [Some(nearest), None],
        };
        encounters.into_iter().flatten().map(|encounter| &mut encounter.moment)
    }
}
