//! Continuous collision check of a path.

use super::deviation::{Deviation, Posture};
use super::vicinity::Vicinity;
use crate::model::{Contact, Pair, Scene};
use crate::space::{Configuration, Path};
use cplan_interrupt::checkpoint;

/// The proven clearance is at least this share of the true one. Below it, pieces of the path are halved and bounded
/// again. A value nearer to 1 costs more evaluations, a few more for every halving of the gap.
const TIGHTNESS: f64 = 0.9;

/// Greatest number of checks of a pair and a piece of a path: some seconds' worth, ...
const MAX_EVALUATIONS: usize = 5_000_000;
/// ... plus some for each straight piece, since paths through mazes have hundreds of thousands.
const EVALUATIONS_PER_PIECE: usize = 500;

/// Rounding of a configuration on a segment, relative to the larger of its ends: three operations. It matters where joints on
/// circles are many turns from zero, where doubles lie far apart.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Number of parts of a curve whose postures all pairs share: four levels of halves.
const SHARED_PARTS: usize = 16;

/// Rounding of a place where two paths join, relative to its size.
const JOIN_ROUNDING: f64 = 1e-9;

/// Pairs at more than this multiple of the least distance seen are not checked, because the proven clearance is that of
/// a nearer pair. Larger than the inverse of [`TIGHTNESS`], with room for rounding.
const DISTANCE_CUTOFF: f64 = 2.0;

/// A path whose whole continuous motion is proven to be within the joint limits and to keep its clearance. Only
/// [`certify`] makes one.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedPath {
    path: Path,
    clearance: f64,
    nearest: Option<Nearest>,
}

/// The place where a path comes nearest to an obstacle, as far as the search looked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The configuration of the nearest approach.
    pub at: Configuration,
    /// The shapes and their distance there, an upper bound on the true clearance.
    pub contact: Contact,
}

impl CertifiedPath {
    /// Returns the path that was shown to be free.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path with a lower clearance, if this is lower, and another nearest place. For motions that leave the
    /// path.
    #[must_use]
    pub fn within(self, clearance: f64, nearest: Option<Nearest>) -> Self {
        Self { clearance: self.clearance.min(clearance), nearest, ..self }
    }

    /// Returns this path followed by another one that begins where this ends. The clearance is the lower one of both.
    ///
    /// # Panics
    /// If the other path begins elsewhere, by more than rounding.
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

    /// Returns the part between two distances along the path, backwards if the first is the greater. A part of a
    /// certified path is certified, and so is its reverse. The reported clearance is that of the whole path, and the
    /// part keeps at least that.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        Self { path: self.path.part(from, to), ..self.clone() }
    }

    /// Returns the proven lower bound on the distance between arm and obstacles along the whole motion, metres;
    /// infinite if nothing can meet. It is positive and at least the required clearance. It is at least 0.9 of the true
    /// value unless the required clearance is nearer to that.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Returns the place where the path comes nearest to an obstacle; `None` if nothing can meet.
    #[must_use]
    pub fn nearest(&self) -> Option<Nearest> {
        self.nearest
    }
}

/// Why a path is not certified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rejection {
    /// A waypoint is outside a joint's limits.
    OutOfLimits {
        /// Index of the waypoint.
        waypoint: usize,
        /// 0 or 1.
        joint: usize,
    },
    /// The shapes touch, overlap, or are nearer than the clearance to keep, at this configuration on the path.
    TooClose(Nearest),
    /// The search ran out here: the distance is too near to the clearance to keep to decide which is larger.
    Undecided(Nearest),
}

/// Checks the whole motion along `path`, straight in joint space between waypoints: limits, and a distance of more
/// than zero and at least `clearance` metres between every pair that can meet.
///
/// For every pair and segment the lower bound of [`Posture::bound`] about the middle decides; otherwise both halves are
/// checked. The search ends because a motion that keeps more than the clearance exceeds it by a positive amount; the
/// number of halvings grows like the square root of its inverse.
///
/// # Errors
/// [`Rejection`]; `TooClose` is a proof that the path fails, the others are not.
pub fn certify(scene: &Scene, path: Path, clearance: f64) -> Result<CertifiedPath, Rejection> {
    let topology = scene.arm().topology();
    for (waypoint, q) in path.waypoints().iter().enumerate() {
        if let Some(joint) = (0..2).find(|&k| !topology.ranges[k].contains(q[k])) {
            return Err(Rejection::OutOfLimits { waypoint, joint });
        }
    }
    let vicinity = Vicinity::new(scene);
    let budget = MAX_EVALUATIONS + EVALUATIONS_PER_PIECE * path.waypoints().len();
    let mut search = CurveSearch::new(scene, clearance, budget);
    for &q in path.waypoints() {
        let posture = Posture::new(scene, q);
        let here = Deviation::Box([0.0, 0.0]);
        vicinity.near(&posture, here, search.least_distance(), |pair| {
            // Pairs farther off than the nearest so far are of no interest.
            if posture.disc_bound(pair, here) < search.least_distance() {
                search.record(q, Contact { pair, separation: posture.separation(pair) })?;
            }
            Ok(())
        })?;
    }
    // A path that does not move has no segment, but still a clearance.
    let rest = path.waypoints().len() == 1;
    for (from, to) in path.segments().chain(rest.then(|| (path.start(), path.start()))) {
        search.segment(&vicinity, from, to)?;
    }
    Ok(CertifiedPath { path, clearance: search.proven, nearest: search.nearest })
}

/// A check of many straight motions in one scene. For each it only decides whether the motion keeps the clearance, not
/// how much more it keeps. That is a small part of the cost of [`certify`].
pub struct StraightMotions<'a> {
    scene: &'a Scene,
    vicinity: Vicinity<'a>,
    clearance: f64,
}

impl<'a> StraightMotions<'a> {
    /// Creates a check for motions that keep more than zero and at least `clearance` metres. `O(n log n)` in the pairs
    /// that can meet.
    #[must_use]
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        Self { scene, vicinity: Vicinity::new(scene), clearance }
    }

    /// Returns true if a motion is shown to be free, within the joint limits.
    #[must_use]
    pub fn is_free(&self, from: Configuration, to: Configuration) -> bool {
        let topology = self.scene.arm().topology();
        let within = [from, to].iter().all(|q| (0..2).all(|k| topology.ranges[k].contains(q[k])));
        within
            && CurveSearch::deciding(self.scene, self.clearance, MAX_EVALUATIONS)
                .segment(&self.vicinity, from, to)
                .is_ok()
    }
}

/// Returns the part of a segment within the share `half` on either side of a place, plus the rounding of that place.
fn part_of(from: Configuration, to: Configuration, half: f64) -> Deviation {
    let rounded = [0, 1].map(|k| ROUNDING * from[k].abs().max(to[k].abs()));
    Deviation::Tube((to - from) * half, rounded)
}

/// Judges the pieces of a motion one after the other, along any curves.
#[derive(Debug, Clone)]
pub struct CurveSearch<'a> {
    scene: &'a Scene,
    required: f64,
    /// A bound is accepted if it is at least this share of the least distance seen.
    tightness: f64,
    /// Least of the accepted bounds.
    proven: f64,
    /// Least distance seen.
    nearest: Option<Nearest>,
    /// Number of remaining checks.
    budget: usize,
    /// Parts of a curve as (number, middle, half width) of the parameter, the next one last. The whole has number 1,
    /// the halves of `n` have `2 n` and `2 n + 1`.
    open: Vec<(usize, f64, f64)>,
}

impl<'a> CurveSearch<'a> {
    fn new(scene: &'a Scene, required: f64, budget: usize) -> Self {
        Self { scene, required, tightness: TIGHTNESS, proven: f64::INFINITY, nearest: None, budget, open: Vec::new() }
    }

    /// Returns a search that only decides if the distance `required` is kept, not how much more, with at most `budget`
    /// checks of pairs.
    #[must_use]
    pub fn deciding(scene: &'a Scene, required: f64, budget: usize) -> Self {
        Self { tightness: 0.0, ..Self::new(scene, required, budget) }
    }

    /// Returns a search that continues from the known clearance of a path, and finds the clearance of both.
    #[must_use]
    pub fn continued_from(known: &CertifiedPath, scene: &'a Scene, required: f64, budget: usize) -> Self {
        Self { proven: known.clearance, nearest: known.nearest, ..Self::new(scene, required, budget) }
    }

    /// Returns the proven clearance of all pieces so far, and the place where they come nearest to an obstacle.
    #[must_use]
    pub fn proven_clearance(&self) -> (f64, Option<Nearest>) {
        (self.proven, self.nearest)
    }

    /// Records a distance on the path.
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

    /// Returns the least distance seen.
    fn least_distance(&self) -> f64 {
        self.nearest.map_or(f64::INFINITY, |n| n.contact.separation.distance)
    }

    /// Returns the value that a bound must reach to be accepted, once this distance is seen, too.
    fn target(&self, distance: f64) -> f64 {
        if self.tightness > 0.0 {
            (self.tightness * self.least_distance().min(distance)).max(self.required)
        } else {
            self.required
        }
    }

    /// Returns the distance beyond which pairs need no check.
    fn cutoff(&self) -> f64 {
        if self.tightness > 0.0 { DISTANCE_CUTOFF * self.target(f64::INFINITY) } else { self.required }
    }

    fn segment(&mut self, vicinity: &Vicinity, from: Configuration, to: Configuration) -> Result<(), Rejection> {
        self.curve(vicinity, |middle, half| (from + (to - from) * middle, part_of(from, to, half)))
    }

    /// Judges a curve. Its parameter goes from 0 to 1. `part` takes a middle and a half width of the parameter, and
    /// returns the configuration there and the deviations from it that hold all of that part.
    ///
    /// # Errors
    /// [`Rejection`], if the curve does not keep the required distance, or is not shown to keep it.
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

    /// Judges one pair along a curve. The postures of its first parts are shared with other pairs.
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
