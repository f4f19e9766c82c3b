//! Continuous collision check of a path.

use super::deviation::{Deviation, Posture};
use super::vicinity::Vicinity;
use cplan_model::checkpoint;
use cplan_model::space::{Configuration, LimitedValue, Path};
use cplan_model::{Contact, Pair, Scene};

/// A lower bound for a piece of the path is accepted if it is at least this fraction of the least distance seen.
/// Otherwise the piece is halved. So the proven clearance is at least this fraction of the true one. With values closer
/// to 1, there are more evaluations: a few more for every halving of the difference.
const TIGHTNESS: f64 = 0.9;

/// Number of distance evaluations before the search gives up, for a path with few waypoints. They take several seconds.
const MAX_EVALUATIONS: usize = 5_000_000;
/// Number of distance evaluations per waypoint that are added to [`MAX_EVALUATIONS`]. Paths through mazes have hundreds
/// of thousands of waypoints.
const EVALUATIONS_PER_PIECE: usize = 500;

/// Rounding error of a configuration on a segment, relative to the larger end of the segment: three operations. On
/// circles, joint values may be many turns from zero, where doubles are coarse.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Number of a part of a curve below which all pairs of shapes share one [`Posture`] of the part. These parts are the
/// whole curve and three levels of halves.
const SHARED_PARTS: usize = 16;

/// Allowed distance of the end of one path from the start of the next, relative to the size of the joint values.
const JOIN_ROUNDING: f64 = 1e-9;

/// Pairs of shapes farther apart than this multiple of the target are not checked. The target is at least [`TIGHTNESS`]
/// of the least distance seen, so a nearer pair determines the proven clearance. The multiple must exceed the inverse
/// of [`TIGHTNESS`], with room for rounding.
const DISTANCE_CUTOFF: f64 = 2.0;

/// A path whose whole continuous motion is proven to stay within the joint limits and at the required clearance from
/// obstacles. [`certify`] creates one from a path. [`CertifiedPath::then`], [`CertifiedPath::part`] and
/// [`CertifiedPath::within`] derive others.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedPath {
    path: Path,
    clearance: f64,
    nearest: Option<Nearest>,
}

/// The configuration nearest to an obstacle among those that the search examined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The configuration at which it was found.
    pub at: Configuration,
    /// The shapes and their distance at that configuration. It is an upper bound on the true clearance.
    pub contact: Contact,
}

impl CertifiedPath {
    /// Returns the path that was proven to be free.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the same path for a motion that deviates from it. Replaces the nearest approach, and lowers the
    /// clearance to `clearance` if `clearance` is less.
    #[must_use]
    pub fn within(self, clearance: f64, nearest: Option<Nearest>) -> Self {
        Self { clearance: self.clearance.min(clearance), nearest, ..self }
    }

    /// Returns this path followed by `next`, which begins where this path ends. The clearance is the lower one of
    /// the two.
    ///
    /// # Panics
    /// If `next` begins elsewhere, by more than rounding.
    #[must_use]
    pub fn then(self, next: &Self) -> Self {
        let (goal, start) = (self.path.goal(), next.path.start());
        assert!(
            (goal - start).amax() <= JOIN_ROUNDING * (1.0 + goal.amax()),
            "the next path begins at {start}, not at {goal}"
        );
        let distance = |nearest: &Nearest| nearest.contact.separation.distance;
        let both = self.nearest.into_iter().chain(next.nearest);
        let nearest = both.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let waypoints = self.path.waypoints().iter().chain(next.path.waypoints()).copied().collect();
        Self { path: Path::new(waypoints), clearance: self.clearance.min(next.clearance), nearest }
    }

    /// Returns the part between two distances along the path, reversed if the first is greater. A part of a certified
    /// path is certified, in either direction. Its reported clearance is the clearance of the whole path, which is a
    /// lower bound.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        Self { path: self.path.part(from, to), ..self.clone() }
    }

    /// Returns the proven lower bound on the distance between the arm and obstacles along the whole motion, metres;
    /// infinite if nothing can meet. It is positive and at least the required clearance. It is also at least 0.9 of
    /// the true clearance.
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Returns the nearest approach to an obstacle that the search found; `None` if nothing can meet.
    pub fn nearest(&self) -> Option<Nearest> {
        self.nearest
    }
}

/// The reason why a path is not certified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rejection {
    /// A waypoint is outside the limits.
    OutOfLimits {
        /// Index of the waypoint.
        waypoint: usize,
        /// The violated limit.
        limited: LimitedValue,
    },
    /// At this configuration on the path, two shapes touch, overlap, or are nearer than the required clearance.
    TooClose(Nearest),
    /// The search gave up at this configuration, because the distance is too close to the required clearance.
    Undecided(Nearest),
}

/// Checks the whole motion along `path`, which is straight in joint space between waypoints. It must be within the
/// joint limits. Every pair that can meet must keep a distance of more than zero and at least the scene's clearance.
///
/// For each pair and segment, the lower bound of [`Posture::bound`] about the middle decides. If it is too low, both
/// halves are checked. If the least distance exceeds the clearance by `d`, the search ends, and the number of pieces
/// grows like `1 / sqrt(d)`.
///
/// # Errors
/// [`Rejection`]: `OutOfLimits` and `TooClose` prove that the path fails, `Undecided` does not.
pub fn certify(scene: &Scene, path: Path) -> Result<CertifiedPath, Rejection> {
    certify_at(scene, path, scene.workspace().clearance)
}

/// Like [`certify`], for a distance of at least `clearance` metres.
///
/// # Errors
/// Same as for [`certify`].
pub fn certify_at(scene: &Scene, path: Path, clearance: f64) -> Result<CertifiedPath, Rejection> {
    let topology = scene.arm().topology();
    for (waypoint, q) in path.waypoints().iter().enumerate() {
        if let Some(limited) = topology.violated_limit(*q) {
            return Err(Rejection::OutOfLimits { waypoint, limited });
        }
    }
    let vicinity = Vicinity::new(scene);
    let budget = MAX_EVALUATIONS + EVALUATIONS_PER_PIECE * path.waypoints().len();
    let mut search = CurveSearch::new(scene, clearance, budget);
    for &q in path.waypoints() {
        let posture = Posture::new(scene, q);
        let here = Deviation::Box([0.0, 0.0]);
        vicinity.near(&posture, here, search.least_distance(), |pair| {
            // Pairs that are farther apart than the nearest pair so far need no exact distance.
            if posture.disc_bound(pair, here) < search.least_distance() {
                search.record(q, Contact { pair, separation: posture.separation(pair) })?;
            }
            Ok(())
        })?;
    }
    // A path without motion has no segment, but still a clearance.
    let rest = path.waypoints().len() == 1;
    for (from, to) in path.segments().chain(rest.then(|| (path.start(), path.start()))) {
        search.segment(&vicinity, from, to)?;
    }
    Ok(CertifiedPath { path, clearance: search.proven, nearest: search.nearest })
}

/// A check of many straight motions in one scene. It only decides whether a motion keeps the clearance, which is much
/// faster than [`certify`].
pub struct StraightMotions<'a> {
    scene: &'a Scene,
    vicinity: Vicinity<'a>,
    clearance: f64,
}

impl<'a> StraightMotions<'a> {
    /// Creates a check for a distance of more than zero and at least `clearance` metres. `O(n log n)` in the pairs
    /// that can meet.
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        Self { scene, vicinity: Vicinity::new(scene), clearance }
    }

    /// Returns true if the straight motion is proven to be free and within the joint limits.
    pub fn is_free(&self, from: Configuration, to: Configuration) -> bool {
        let topology = self.scene.arm().topology();
        topology.contains(from)
            && topology.contains(to)
            && CurveSearch::deciding(self.scene, self.clearance, MAX_EVALUATIONS)
                .segment(&self.vicinity, from, to)
                .is_ok()
    }
}

/// Returns the deviations from a point of a segment to all points at most the fraction `half` of the segment away. They
/// include the rounding error of that point.
fn part_of(from: Configuration, to: Configuration, half: f64) -> Deviation {
    let rounded = [0, 1].map(|k| ROUNDING * from[k].abs().max(to[k].abs()));
    Deviation::Tube((to - from) * half, rounded)
}

/// A check of a motion along any curves, one after the other.
#[derive(Debug, Clone)]
pub struct CurveSearch<'a> {
    scene: &'a Scene,
    required: f64,
    /// A bound is accepted if it is at least this fraction of the least distance seen. 0 if only `required` counts.
    tightness: f64,
    /// The least of the accepted bounds.
    proven: f64,
    /// The nearest approach found so far.
    nearest: Option<Nearest>,
    /// Number of checks of pairs until the search gives up.
    budget: usize,
    /// Parts of a curve that must still be checked, the next one last: number, middle, and half width of the parameter.
    /// The whole curve has number 1. The halves of part `n` have `2 n` and `2 n + 1`.
    open: Vec<(usize, f64, f64)>,
}

impl<'a> CurveSearch<'a> {
    fn new(scene: &'a Scene, required: f64, budget: usize) -> Self {
        Self { scene, required, tightness: TIGHTNESS, proven: f64::INFINITY, nearest: None, budget, open: Vec::new() }
    }

    /// Creates a search that only decides whether the motion keeps the distance `required`. It makes at most `budget`
    /// distance evaluations.
    pub fn deciding(scene: &'a Scene, required: f64, budget: usize) -> Self {
        Self { tightness: 0.0, ..Self::new(scene, required, budget) }
    }

    /// Creates a search that continues from a certified path. It finds the common clearance of the path and the curves.
    pub fn continued_from(known: &CertifiedPath, scene: &'a Scene, required: f64, budget: usize) -> Self {
        Self { proven: known.clearance, nearest: known.nearest, ..Self::new(scene, required, budget) }
    }

    /// Returns the proven clearance of all pieces so far, and the nearest approach found.
    pub fn proven_clearance(&self) -> (f64, Option<Nearest>) {
        (self.proven, self.nearest)
    }

    /// Records the distance of a pair at a configuration of the motion. Fails if it is too small.
    fn record(&mut self, at: Configuration, contact: Contact) -> Result<(), Rejection> {
        let distance = contact.separation.distance;
        if self.nearest.is_none_or(|n| distance < n.contact.separation.distance) {
            self.nearest = Some(Nearest { at, contact });
        }
        if distance <= 0.0 || distance < self.required {
            return Err(Rejection::TooClose(Nearest { at, contact }));
        }
        Ok(())
    }

    /// Returns the least distance found so far; infinite before the first.
    fn least_distance(&self) -> f64 {
        self.nearest.map_or(f64::INFINITY, |n| n.contact.separation.distance)
    }

    /// Returns the least bound that is accepted if `distance` is one of the distances seen.
    fn target(&self, distance: f64) -> f64 {
        if self.tightness > 0.0 {
            (self.tightness * self.least_distance().min(distance)).max(self.required)
        } else {
            self.required
        }
    }

    /// Returns the distance, in metres, beyond which pairs of shapes need no check.
    fn cutoff(&self) -> f64 {
        if self.tightness > 0.0 { DISTANCE_CUTOFF * self.target(f64::INFINITY) } else { self.required }
    }

    fn segment(&mut self, vicinity: &Vicinity, from: Configuration, to: Configuration) -> Result<(), Rejection> {
        self.curve(vicinity, |middle, half| (from + (to - from) * middle, part_of(from, to, half)))
    }

    /// Checks a curve with the parameter from 0 to 1. `part` receives the middle and the half width of a range of the
    /// parameter, and returns the configuration in the middle with deviations that cover the range.
    ///
    /// # Errors
    /// [`Rejection`] if the curve does not keep the required distance, or is not proven to keep it.
    pub fn curve(
        &mut self,
        vicinity: &Vicinity,
        part: impl Fn(f64, f64) -> (Configuration, Deviation),
    ) -> Result<(), Rejection> {
        let scene = self.scene;
        let posed = |middle: f64, half: f64| {
            let (at, deviation) = part(middle, half);
            (Posture::new(scene, at), deviation)
        };
        let whole = posed(0.5, 0.5);
        let mut shared = [const { None }; SHARED_PARTS];
        vicinity.near(&whole.0, whole.1, self.cutoff(), |pair| self.pair(pair, &whole, &mut shared, posed))
    }

    /// Checks one pair of shapes along a curve. The postures of parts with low numbers are shared with other pairs.
    fn pair(
        &mut self,
        pair: Pair,
        whole: &(Posture<'a>, Deviation),
        shared: &mut [Option<(Posture<'a>, Deviation)>; SHARED_PARTS],
        posed: impl Fn(f64, f64) -> (Posture<'a>, Deviation),
    ) -> Result<(), Rejection> {
        self.open.clear();
        self.open.push((1, 0.5, 0.5));
        while let Some((number, middle, half)) = self.open.pop() {
            checkpoint();
            let own;
            let (posture, deviation) = match shared.get_mut(number) {
                _ if number == 1 => whole,
                Some(known) => known.get_or_insert_with(|| posed(middle, half)),
                None => {
                    own = posed(middle, half);
                    &own
                }
            };
            let (at, deviation) = (posture.configuration(), *deviation);
            self.budget = self.budget.saturating_sub(1);
            let apart = posture.disc_bound(pair, deviation);
            if apart > 0.0 && apart >= self.target(f64::INFINITY) {
                self.proven = self.proven.min(apart);
                continue;
            }
            let bounded = posture.bound_up_to(pair, deviation, |distance| self.target(distance));
            let contact = Contact { pair, separation: bounded.here };
            self.record(at, contact)?;
            if bounded.least > 0.0 && bounded.least >= self.target(f64::INFINITY) {
                self.proven = self.proven.min(bounded.least);
            } else if self.budget == 0 || half < f64::EPSILON {
                return Err(Rejection::Undecided(Nearest { at, contact }));
            } else {
                let quarter = half / 2.0;
                let first = number.saturating_mul(2);
                self.open.push((first.saturating_add(1), middle + quarter, quarter));
                self.open.push((first, middle - quarter, quarter));
            }
        }
        Ok(())
    }
}
