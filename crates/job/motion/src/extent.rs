//! Extents of a motion at the corners of its path.

use cplan_handling::Piece;
use cplan_model::space::{Configuration, Path};

/// A motion within this distance of its path, radians or metres, is on the path. It covers the rounding of splines on straight
/// pieces.
const ON_PATH: f64 = 1e-9;

/// Number of intervals of a piece. At their ends, its distance from the path is measured.
const INTERVALS_PER_PIECE: u32 = 4;

/// Share by which distances between the measured positions may be greater.
const DISTANCE_MARGIN: f64 = 0.01;

/// Number of halvings that locate the place where a motion leaves its path.
const PLACE_HALVINGS: u32 = 24;

/// Greatest number of legs between those of two consecutive positions.
const MAX_LEGS_AHEAD: usize = 8;

/// A motion's position, compared with a path.
#[derive(Clone, Copy)]
struct Position {
    at: Configuration,
    /// The nearest leg, and the distance from it.
    leg: usize,
    off: f64,
}

/// Returns the extent of a motion at each waypoint of its path: the motion is off the path only within this distance of the
/// waypoint. Its distance from the path, and from the waypoint when it passes it, is at most half of this. The extent is 0 at
/// waypoints that the motion does not round, and positive at all others.
pub(super) fn extents(path: &Path, pieces: &[Piece], is_rounded: impl Fn(usize) -> bool) -> Vec<f64> {
    let q = path.waypoints();
    let corners: Vec<usize> = (0..q.len()).filter(|&w| is_rounded(w)).collect();
    let mut extents = vec![0.0_f64; q.len()];
    let mut nearest = vec![f64::INFINITY; q.len()];
    let distance = |position: &Position, w: usize| (q[w] - position.at).norm();
    let nearest_corner = |position: &Position| {
        corners.iter().copied().min_by(|a, b| distance(position, *a).total_cmp(&distance(position, *b)))
    };
    // Halfway to the next measured position, the distance may be greater than at both.
    let mut count = |position: Position, between: f64| {
        if let Some(w) = nearest_corner(&position) {
            let off = 2.0 * position.off * (1.0 + DISTANCE_MARGIN);
            extents[w] = extents[w].max(distance(&position, w) + between).max(off);
        }
    };
    let mut leg = 0;
    for piece in pieces {
        let mut before: Option<(f64, Position)> = None;
        for k in 0..=INTERVALS_PER_PIECE {
            let share = f64::from(k) / f64::from(INTERVALS_PER_PIECE);
            let here = located(q, piece.at(share), leg);
            leg = here.leg;
            for w in leg..(leg + MAX_LEGS_AHEAD).min(q.len()) {
                nearest[w] = nearest[w].min((q[w] - here.at).norm());
            }
            if here.off > ON_PATH {
                let both = before.filter(|(_, was)| was.off > ON_PATH).and_then(|(_, was)| {
                    let [a, b] = [distance(&was, nearest_corner(&was)?), distance(&here, nearest_corner(&here)?)];
                    Some(((a - b + (was.at - here.at).norm()) / 2.0).max(0.0))
                });
                count(here, both.unwrap_or(0.0));
            }
            if let Some((from, was)) = before
                && (was.off > ON_PATH) != (here.off > ON_PATH)
            {
                count(located(q, piece.at(last_on_path(q, piece, [from, share], [was, here])), was.leg), 0.0);
            }
            before = Some((share, here));
        }
    }
    for w in corners {
        let cut = if nearest[w].is_finite() { 2.0 * nearest[w] * (1.0 + DISTANCE_MARGIN) } else { 0.0 };
        extents[w] = extents[w].max(cut).max(f64::MIN_POSITIVE);
    }
    extents
}

/// Returns the share of a piece at which it leaves or joins the path. It is between two shares, one of which is on the path.
fn last_on_path(q: &[Configuration], piece: &Piece, [from, to]: [f64; 2], [was, is]: [Position; 2]) -> f64 {
    let (mut on, mut off) = if was.off > is.off { (to, from) } else { (from, to) };
    for _ in 0..PLACE_HALVINGS {
        let middle = (on + off) / 2.0;
        if located(q, piece.at(middle), was.leg).off > ON_PATH { off = middle } else { on = middle }
    }
    on
}

/// Finds the leg, from `leg` on, that is nearest to a configuration.
fn located(q: &[Configuration], at: Configuration, leg: usize) -> Position {
    let legs = leg..(leg + MAX_LEGS_AHEAD).min(q.len() - 1);
    let off = legs.map(|leg| (distance_to_leg(at, q[leg], q[leg + 1]), leg)).min_by(|a, b| a.0.total_cmp(&b.0));
    let (off, leg) = off.unwrap_or_else(|| ((at - q[leg]).norm(), leg));
    Position { at, leg, off }
}

/// Returns the distance of a configuration from a straight piece.
pub fn distance_to_leg(at: Configuration, from: Configuration, to: Configuration) -> f64 {
    let (along, off) = (to - from, at - from);
    let length2 = along.norm_squared();
    let share = if length2 > 0.0 { (along.dot(&off) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (off - along * share).norm()
}
