//! Motions with limits on jerks that leave their path only near its corners.
//!
//! A motion that is smoothed over time (`smooth`) leaves its path a fixed time before a corner, and thus far from it. If this
//! distance is limited, a smooth curve first replaces the path: a uniform cubic B-spline with a control point at each corner and
//! others on the legs. Those next to a corner are so near it that the curve leaves the leg within the limit; the spaces between
//! control points grow away from corners. `joint_curve` then finds a fast motion along the curve.

use super::extent::extents;
use super::joint_curve::motion;
use super::limits::Limits;
use super::sample::{TimedMotion, Trajectory};
use super::schedule::stopping_at;
use super::spline::Spline;
use crate::{BlendedPath, Rounding};
use cplan_handling::Piece;
use cplan_judge::CertifiedPath;
use cplan_model::Scene;
use cplan_model::space::Path;

/// The curve leaves a leg at this share of the allowed distance. The motion leaves it up to two steps earlier.
const USED_SHARE: f64 = 0.95;

/// Factor by which the distance at a corner is reduced if the curve is not proven free there.
const REDUCTION: f64 = 0.6;

/// Below this share of the allowed distance, the motion stops at the corner instead.
const MIN_SHARE: f64 = 1.0 / 64.0;

/// Ratio of consecutive spaces between control points on a leg, away from the corner.
const SPACE_GROWTH: f64 = 1.5;

/// Greatest space between control points, as a share of their leg.
const MAX_SPACE_SHARE: f64 = 1.0 / 8.0;

/// Smallest space between control points, as a share of the usual one.
const MIN_GAP_SHARE: f64 = 0.5;

/// Number of motions that are tried, each with reduced distances at some corners.
const MAX_TRIES: usize = 6;

/// Returns a fast motion along a path that is proven free and off the path only within `greatest` of a corner. `None` if no such
/// motion is found that is shorter than `below` seconds and passes at least one corner without a stop.
pub(super) fn rounded(
    scene: &Scene,
    path: &CertifiedPath,
    greatest: f64,
    limits: Limits,
    period: f64,
    below: f64,
) -> Option<TimedMotion> {
    let rounding = Rounding::new(scene, path, scene.workspace().clearance);
    let mut curve = RoundedPath::new(path.path(), greatest);
    for _ in 0..MAX_TRIES {
        curve.keep_free(&rounding)?;
        let trajectory = limits.within_torque(|limits| curve.driven(limits, period))?;
        if trajectory.duration() >= below {
            return None;
        }
        let pieces = trajectory.pieces();
        let open = rounding.uncertified_pieces(&pieces);
        if open.is_empty() {
            let radii = extents(path.path(), &pieces, |w| curve.distances[w] > 0.0);
            return rounding.certified(radii, &pieces).map(|curve| TimedMotion { curve, trajectory });
        }
        curve.reduce(open.iter().map(|&piece| &pieces[piece]));
    }
    None
}

/// A path, and the distances from its corners within which it is rounded.
struct RoundedPath<'a> {
    path: &'a Path,
    greatest: f64,
    /// Distance for each waypoint; 0 where the motion stops.
    distances: Vec<f64>,
}

impl<'a> RoundedPath<'a> {
    fn new(path: &'a Path, greatest: f64) -> Self {
        let mut distances = vec![USED_SHARE * greatest; path.waypoints().len()];
        let last = distances.len() - 1;
        (distances[0], distances[last]) = (0.0, 0.0);
        Self { path, greatest, distances }
    }

    /// Iterates over pairs of waypoints between which the motion does not stop.
    fn runs(&self) -> impl Iterator<Item = [usize; 2]> {
        let stops: Vec<usize> = (0..self.distances.len()).filter(|&w| self.distances[w] == 0.0).collect();
        (1..stops.len()).map(move |k| [stops[k - 1], stops[k]])
    }

    /// Reduces the distances until the curve is proven free. `None` if the motion would stop at all corners.
    fn keep_free(&mut self, rounding: &Rounding) -> Option<()> {
        loop {
            if self.distances.iter().all(|distance| *distance == 0.0) {
                return None;
            }
            let rounded = self.runs().filter(|[first, last]| last - first > 1);
            let pieces: Vec<Piece> = rounded.flat_map(|run| self.curve(run).pieces()).collect();
            let open = rounding.uncertified_pieces(&pieces);
            if open.is_empty() {
                return Some(());
            }
            self.reduce(open.iter().map(|&piece| &pieces[piece]));
        }
    }

    /// Reduces the distances at the corners that are nearest to these pieces.
    fn reduce<'p>(&mut self, pieces: impl Iterator<Item = &'p Piece>) {
        let q = self.path.waypoints();
        let rounded: Vec<usize> = (0..q.len()).filter(|&w| self.distances[w] > 0.0).collect();
        let nearest = |piece: &Piece| {
            let distance = |w: &&usize| (q[**w] - piece.at(0.5)).norm();
            rounded.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied()
        };
        let mut reduced: Vec<usize> = pieces.filter_map(nearest).collect();
        reduced.sort_unstable();
        reduced.dedup();
        for w in reduced {
            let less = REDUCTION * self.distances[w];
            self.distances[w] = if less < MIN_SHARE * self.greatest { 0.0 } else { less };
        }
    }

    /// Returns the curve between two stops.
    fn curve(&self, [first, last]: [usize; 2]) -> Spline {
        let q = self.path.waypoints();
        let mut points = vec![q[first]];
        for leg in first..last {
            let along = (q[leg + 1] - q[leg]) / (q[leg + 1] - q[leg]).norm();
            let places = spaced((q[leg + 1] - q[leg]).norm(), [self.distances[leg], self.distances[leg + 1]]);
            points.extend(places.into_iter().map(|place| q[leg] + along * place));
            points.push(q[leg + 1]);
        }
        Spline::of_curve(&points)
    }

    fn driven(&self, limits: &Limits, period: f64) -> Option<Trajectory> {
        let q = self.path.waypoints();
        let straight = BlendedPath::from(self.path.clone());
        let (mut trajectory, mut begin) = (Trajectory::default(), 0);
        for run @ [first, last] in self.runs() {
            // Torques vary along a straight leg, and a constant limit that is safe everywhere would be slow.
            if last - first == 1 && limits.torque.is_none() {
                begin = stopping_at(&straight, first, limits, begin, period, &mut trajectory);
                continue;
            }
            let part = Path::new(q[first..=last].to_vec());
            let too_far = |pieces: &[Piece]| {
                let extents = extents(&part, pieces, |w| 0 < w && w < last - first);
                if extents.iter().any(|extent| *extent > self.greatest) { vec![0] } else { Vec::new() }
            };
            let spline = motion(&self.curve(run), limits, period, &too_far)?;
            spline.sample(begin, period, &mut trajectory);
            begin += spline.duration();
        }
        trajectory.push_rest(begin, self.path.goal());
        Some(trajectory)
    }
}

/// Returns the positions of control points on a leg, ascending, without its ends. `distances` are those within which both ends
/// are rounded; 0 at a stop.
fn spaced(length: f64, distances: [f64; 2]) -> Vec<f64> {
    // If control points are at the corner, at `d` and at `(1 + g) d`, the curve leaves the leg at the distance `(5 + g) d / 6`.
    let nearest = distances.map(|distance| 6.0 / (5.0 + SPACE_GROWTH) * distance);
    let most = MAX_SPACE_SHARE * length;
    let [first, last] = nearest;
    if first + last > length {
        return Vec::new();
    }
    let from_end = |nearest: f64, until: f64| {
        let mut places = Vec::new();
        let (mut place, mut space) = (nearest, nearest);
        while nearest > 0.0 && place <= until {
            places.push(place);
            space = (SPACE_GROWTH * space).min(most.max(nearest));
            place += space;
        }
        places
    };
    let split = match nearest {
        [0.0, 0.0] => return (1..8).map(|k| length * f64::from(k) / 8.0).collect(),
        [0.0, _] => 0.0,
        [_, 0.0] => length,
        _ => length * first / (first + last),
    };
    let mut places = from_end(first, split);
    let mut back = from_end(last, length - split);
    // The rows from both ends meet somewhere. If their last places almost coincide, one of them is removed, unless a corner needs
    // it.
    let gap = length - back.last().copied().unwrap_or(0.0) - places.last().copied().unwrap_or(0.0);
    let longer = if places.len() > back.len() { &mut places } else { &mut back };
    if let [.., before, after] = longer[..]
        && longer.len() > 2
        && gap < MIN_GAP_SHARE * (after - before)
    {
        longer.pop();
    }
    places.extend(back.into_iter().rev().map(|place| length - place));
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::Configuration;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Samples curves through random corners, which must be off the path only within the distance of a corner.
        #[test]
        fn curves_are_off_the_path_only_near_corners(
            turns in prop::collection::vec((0.02..1.5_f64, -2.9..2.9_f64), 3..9), greatest in 0.005..0.5_f64,
        ) {
            let (mut corners, mut heading) = (vec![Configuration::new(0.5, -0.25)], 0.3_f64);
            for (length, turn) in turns {
                corners.push(corners[corners.len() - 1] + Configuration::new(heading.cos(), heading.sin()) * length);
                heading += turn;
            }
            let path = Path::new(corners.clone());
            let curve = RoundedPath::new(&path, greatest).curve([0, corners.len() - 1]);
            let ahead = |at: Configuration, leg: &[Configuration]| {
                let (along, off) = (leg[1] - leg[0], at - leg[0]);
                (off - along * (along.dot(&off) / along.norm_squared()).clamp(0.0, 1.0)).norm()
            };
            let mut is_rounded = false;
            for at in curve.pieces().iter().flat_map(|piece| (0..8).map(|k| piece.at(f64::from(k) / 8.0))) {
                let off = corners.windows(2).map(|leg| ahead(at, leg)).fold(f64::INFINITY, f64::min);
                let inner = &corners[1..corners.len() - 1];
                let nearest = inner.iter().map(|corner| (corner - at).norm()).fold(f64::INFINITY, f64::min);
                prop_assert!(off < 1e-9 || nearest <= greatest, "{off} {nearest} {greatest}");
                is_rounded |= off > 1e-6;
            }
            prop_assert!(is_rounded);
        }
    }
}
