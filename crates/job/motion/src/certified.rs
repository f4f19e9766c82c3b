//! Rounds the corners of certified paths as far as the clearance allows.

use super::blend::{BLEND_TOLERANCE, BlendedPath};
use super::span::tube_about_part;
use cplan_handling::Piece;
use cplan_judge::{CertifiedPath, CurveSearch, Nearest, Rejection, Vicinity};
use cplan_model::Scene;
use cplan_model::space::Path;

/// Fraction of the straight path's excess over the required clearance that rounded corners must keep. With one half, a motion on
/// blends provably keeps at least half the distance of the straight path.
const KEPT_CLEARANCE_SHARE: f64 = 0.5;

/// Greatest share of an inner leg that a blend at one end may take. A part between the two blends stays straight.
const INNER_LEG_SHARE: f64 = 0.45;

/// Greatest share of the first or the last leg that a blend may take. Such a leg has only one blend.
const END_LEG_SHARE: f64 = 0.9;

/// Number of times that a radius is halved before the corner stays. The speed on a blend grows with the root of its radius, so
/// the smallest blend saves a hundredth of the time that the largest would save.
const MAX_RADIUS_HALVINGS: u32 = 13;

/// Number of further radii that are tried between the first certified radius and the refused one before it.
const RADIUS_REFINEMENTS: u32 = 2;

/// Number of checks per pair of shapes after which a blend is refused. A blend at a clear distance needs about ten
/// checks, and trying a smaller blend costs little.
const MAX_CHECKS_PER_BLEND: usize = 64;

/// A path with rounded corners. The whole motion provably stays within the joint limits and keeps its clearance. The proof covers
/// the straight legs up to their corners, the blends, and all motions within [`BLEND_TOLERANCE`] of the blends. If other curves
/// round the corners, it covers these curves. Only [`blend`] and [`Rounding`] create such paths.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedCurve {
    curve: BlendedPath,
    /// The straight path, with the clearance of the whole motion.
    straight: CertifiedPath,
    /// `None` if blends round all corners. For other curves, the extents of the rounding (see [`CertifiedCurve::radii`]), and a
    /// polyline for pictures.
    driven: Option<(Vec<f64>, Path)>,
}

impl From<CertifiedPath> for CertifiedCurve {
    /// Returns the straight path, without blends.
    fn from(path: CertifiedPath) -> Self {
        Self { curve: path.path().clone().into(), straight: path, driven: None }
    }
}

impl CertifiedCurve {
    /// Returns the path and its blends.
    pub fn curve(&self) -> &BlendedPath {
        &self.curve
    }

    /// Returns the extent of the rounding at each waypoint, in joint space: the greatest distance from the waypoint at which the
    /// motion is off the path, such as the radius of a blend. The motion is never farther from the path than half of it. The
    /// extent is 0 where the motion stops at the corner, unless the motion stops at both ends of a curved leg.
    pub fn radii(&self) -> Vec<f64> {
        self.driven.as_ref().map_or_else(|| self.curve.extents(), |(radii, _)| radii.clone())
    }

    /// Returns a proven lower bound on the distance between arm and obstacles, metres, along the blends, and along the straight
    /// legs up to their corners. It is at least the required clearance, and infinite if no shapes can meet.
    pub fn clearance(&self) -> f64 {
        self.straight.clearance()
    }

    /// Returns the place nearest to an obstacle, among the places that the search examined. `None` if no shapes can
    /// meet.
    pub fn nearest(&self) -> Option<Nearest> {
        self.straight.nearest()
    }

    /// Returns the straight path, which is proven free up to its corners.
    pub fn straight(&self) -> &CertifiedPath {
        &self.straight
    }

    /// Returns a polyline for pictures.
    pub fn outline(&self) -> Path {
        self.driven.as_ref().map_or_else(|| self.curve.outline(), |(_, outline)| outline.clone())
    }

    /// Returns this motion followed by another, which begins where this one ends. The arm is at rest in between.
    #[must_use]
    pub fn then(self, next: &Self) -> Self {
        let driven = (self.driven.is_some() || next.driven.is_some()).then(|| {
            let mut radii = self.radii();
            radii.pop();
            radii.extend(next.radii());
            let outline = self.outline().waypoints().iter().chain(next.outline().waypoints()).copied().collect();
            (radii, Path::new(outline))
        });
        Self { curve: self.curve.then(&next.curve), straight: self.straight.then(&next.straight), driven }
    }

    /// Adds what was proven about moving obstacles: `clearance` and `nearest` replace the motion's own if they are nearer.
    #[must_use]
    pub fn among_movers(self, clearance: f64, nearest: Option<Nearest>) -> Self {
        let known = self.nearest();
        let nearer = |a: &Nearest| known.is_none_or(|b| a.contact.separation.distance < b.contact.separation.distance);
        let nearest = nearest.filter(nearer).or(known);
        Self { straight: self.straight.within(clearance, nearest), ..self }
    }

    /// Removes the blend at an inner waypoint.
    #[must_use]
    pub fn without(self, waypoint: usize) -> Self {
        let curve = self.curve.clone().with(waypoint, 0.0);
        self.reduced_to(curve)
    }

    /// Replaces curved legs by straight ones, at whose ends the motion stops.
    pub(super) fn without_curves(self) -> Self {
        let curve = self.curve.clone();
        let legs = 0..curve.path().waypoints().len() - 1;
        let curved = legs.filter(|&leg| self.curve.curved_leg(leg).is_some());
        let curve = curved.fold(curve, BlendedPath::without_curve);
        self.reduced_to(curve)
    }

    /// Replaces the curve by one with fewer blends and curved legs. No proof is needed, because the straight legs are proven up
    /// to the corners.
    pub(super) fn reduced_to(self, curve: BlendedPath) -> Self {
        Self { curve, ..self }
    }
}

/// Rounds the corners of a certified path by blends, each as large as can be certified. The radius of a blend is at most
/// `greatest` (in joint space, mixing radians and metres; infinite for no limit), and at most 0.45 of each leg (0.9 of the first
/// and the last leg). The motion keeps more than half of the excess of the path's clearance over `clearance`. A radius that
/// cannot be certified is halved; after some halvings, the corner stays. A waypoint at which the path does not turn gets a
/// straight blend.
///
/// A blend lies in the triangle of its control points, so joint limits need no check. Each blend is judged by the same bisection
/// as a straight piece, with a tube around the blend's chord.
pub fn blend(scene: &Scene, path: &CertifiedPath, greatest: f64, clearance: f64) -> CertifiedCurve {
    let greatest = vec![greatest; path.path().waypoints().len()];
    blend_curved(scene, path, path.path().clone().into(), &greatest, clearance)
}

/// Does the same as [`blend`] for a path with curved legs, with a greatest radius for each waypoint; with 0, the motion stops
/// there. Curved legs that cannot be certified become straight. A smooth waypoint has no blend, unless one of its legs becomes
/// straight.
///
/// # Panics
/// If `curve` does not belong to the path, or if there are fewer radii than waypoints.
pub fn blend_curved(
    scene: &Scene,
    path: &CertifiedPath,
    mut curve: BlendedPath,
    greatest: &[f64],
    clearance: f64,
) -> CertifiedCurve {
    assert!(curve.path() == path.path(), "the curve is along the path");
    loop {
        match blended(scene, path, curve.clone(), greatest, clearance) {
            Ok(blended) => return blended,
            Err(legs) => curve = legs.into_iter().fold(curve, BlendedPath::straightened),
        }
    }
}

/// Rounds the corners of a curve without blends.
///
/// # Errors
/// The curved legs that are not certified.
fn blended(
    scene: &Scene,
    path: &CertifiedPath,
    curve: BlendedPath,
    greatest: &[f64],
    clearance: f64,
) -> Result<CertifiedCurve, Vec<usize>> {
    let q = path.path().waypoints();
    let required = required_distance(path, clearance);
    if path.clearance() <= clearance {
        return Ok(CertifiedCurve::from(path.clone()));
    }
    let mut blended = CertifiedCurve::from(path.clone()).reduced_to(curve);
    let vicinity = Vicinity::new(scene);
    let budget = MAX_CHECKS_PER_BLEND * scene.pairs().len();
    let topology = scene.arm().topology();
    let judge_piece = |straight: &CertifiedPath, piece: &Piece, half: f64| {
        let mut search = CurveSearch::continued_from(straight, scene, required, budget);
        follow(&mut search, &vicinity, piece, BLEND_TOLERANCE * half).ok()?;
        Some(search.proven_clearance())
    };
    let last = q.len() - 1;
    for waypoint in 1..last {
        let share = |end: usize| if end == 0 || end == last { END_LEG_SHARE } else { INNER_LEG_SHARE };
        let room = |end: usize| share(end) * (q[end] - q[waypoint]).norm();
        let most = greatest[waypoint].min(room(waypoint - 1)).min(room(waypoint + 1));
        // A leg with less than the least positive length has no room.
        if most <= 0.0 || blended.curve.is_smooth(waypoint) {
            continue;
        }
        let judge = |radius: f64| {
            let blend = blended.curve.blend_of(waypoint, radius);
            let is_beside_curve = (waypoint - 1..=waypoint).any(|leg| blended.curve.curved_leg(leg).is_some());
            if is_beside_curve && !(topology.contains(blend.from) && topology.contains(blend.to)) {
                return None;
            }
            Some((radius, judge_piece(&blended.straight, &blend.piece(), blend.radius())?))
        };
        if let Some((radius, (clearance, nearest))) = largest(most, judge) {
            let straight = blended.straight.within(clearance, nearest);
            blended = CertifiedCurve { curve: blended.curve.with(waypoint, radius), straight, driven: None };
        }
    }
    let mut open = Vec::new();
    for leg in 0..last {
        let Some(curved) = blended.curve.curved_leg(leg) else { continue };
        let piece = curved.piece();
        let is_within = piece.control().iter().all(|q| topology.contains(*q));
        match is_within.then(|| judge_piece(&blended.straight, &piece, curved.length / 2.0)).flatten() {
            Some((clearance, nearest)) => blended.straight = blended.straight.within(clearance, nearest),
            None => open.push(leg),
        }
    }
    if open.is_empty() { Ok(blended) } else { Err(open) }
}

/// Checks a tube around a piece of a motion. `beside` is its half width in each joint.
fn follow(search: &mut CurveSearch, vicinity: &Vicinity, piece: &Piece, beside: f64) -> Result<(), Rejection> {
    search.curve(vicinity, |middle: f64, half: f64| tube_about_part(piece, middle - half, middle + half, beside))
}

/// Returns the distance, metres, that a motion that leaves the path at corners must keep from obstacles.
fn required_distance(path: &CertifiedPath, clearance: f64) -> f64 {
    clearance + KEPT_CLEARANCE_SHARE * (path.clearance() - clearance)
}

/// Number of checks per pair of shapes after which a piece of a motion is refused. It is large, because a straight
/// piece may slide along an obstacle at a tiny distance.
const MAX_CHECKS_PER_PIECE: usize = 2048;

/// A check for motions that follow a path and round its corners by curves other than blends.
pub struct Rounding<'a> {
    scene: &'a Scene,
    vicinity: Vicinity<'a>,
    path: &'a CertifiedPath,
    required: f64,
}

impl<'a> Rounding<'a> {
    /// Creates the check. As on blends, motions must keep more than half of the path's clearance in excess of
    /// `clearance`.
    pub fn new(scene: &'a Scene, path: &'a CertifiedPath, clearance: f64) -> Self {
        Self { scene, vicinity: Vicinity::new(scene), path, required: required_distance(path, clearance) }
    }

    /// Returns the indices of the pieces of a motion that are not proven free. Does not check joint limits.
    pub fn uncertified_pieces(&self, pieces: &[Piece]) -> Vec<usize> {
        let budget = MAX_CHECKS_PER_PIECE * self.scene.pairs().len();
        let is_open = |piece: &Piece| {
            let mut search = CurveSearch::deciding(self.scene, self.required, budget);
            follow(&mut search, &self.vicinity, piece, 0.0).is_err()
        };
        (0..pieces.len()).filter(|&i| is_open(&pieces[i])).collect()
    }

    /// Certifies a motion that rounds the path's corners with these extents (see [`CertifiedCurve::radii`]). `None` if it is not
    /// proven free. Does not check joint limits.
    pub fn certified(&self, radii: Vec<f64>, pieces: &[Piece]) -> Option<CertifiedCurve> {
        let budget = MAX_CHECKS_PER_PIECE * self.scene.pairs().len() * pieces.len();
        let mut search = CurveSearch::continued_from(self.path, self.scene, self.required, budget);
        pieces.iter().try_for_each(|piece| follow(&mut search, &self.vicinity, piece, 0.0)).ok()?;
        let (clearance, nearest) = search.proven_clearance();
        let knots = pieces.iter().map(|piece| piece.at(0.0)).chain(pieces.last().map(|piece| piece.at(1.0)));
        let straight = self.path.clone().within(clearance, nearest);
        let curve = straight.path().clone().into();
        Some(CertifiedCurve { curve, straight, driven: Some((radii, Path::new(knots.collect()))) })
    }
}

/// Returns the result of `judge` for the largest accepted radius among those that are tried, of which the first is `most`.
fn largest<T>(most: f64, judge: impl Fn(f64) -> Option<T>) -> Option<T> {
    let mut refused = f64::INFINITY;
    let mut radius = most;
    let mut best = None;
    for _ in 0..=MAX_RADIUS_HALVINGS {
        best = judge(radius);
        if best.is_some() {
            break;
        }
        refused = radius;
        radius /= 2.0;
    }
    best.as_ref()?;
    for _ in 0..RADIUS_REFINEMENTS {
        if refused.is_infinite() {
            break;
        }
        let between = (radius + refused) / 2.0;
        match judge(between) {
            Some(better) => (best, radius) = (Some(better), between),
            None => refused = between,
        }
    }
    best
}
