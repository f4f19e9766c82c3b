//! The bottleneck of an infeasible motion. All obstacles shrink equally until a path opens. The bottleneck is the
//! narrowest place of that path.

use super::change::{fineness, middle, shrunk_pieces};
use super::threshold::{Threshold, threshold};
use cplan_blockers::MotionQuestion;
use cplan_geometry::{Convex, Point, separation};
use cplan_model::space::Configuration;
use cplan_model::{Contact, Obstruction};

/// The narrowest place of the first path that opens. To open it, the clearance is reduced first, and then all obstacles
/// shrink by one distance.
#[derive(Debug, Clone, PartialEq)]
pub struct Bottleneck {
    /// Amount at which the path opens, in metres: the reduction of the clearance plus the shrinking of the obstacles.
    pub by: Threshold,
    /// Configuration on this path that is nearest to the shrunk obstacles.
    pub at: Configuration,
    /// Point of the plane at which the arm, in this configuration, reaches deepest into an obstacle.
    pub point: Point,
    /// Collisions of the arm in this configuration: for each link and obstacle, the deepest pair of shapes.
    pub hits: Vec<Obstruction>,
}

/// Tolerance of the amount by which shapes are shrunk, as a fraction of the amount.
const RELATIVE_TOLERANCE: f64 = 1e-2;

/// Least tolerance of the amount, as a fraction of the tolerance of changes. Decisions closer to the threshold take long.
const MIN_TOLERANCE_SHARE: f64 = 1.0 / 16.0;

/// Number of configurations along the path at which the missing distance is computed.
const PATH_SAMPLES: usize = 1024;

impl Bottleneck {
    /// Returns the distance that is missing at the narrowest place, in metres. It is the sum over all obstacles that
    /// the arm hits, clearance included.
    pub fn missing_distance(&self, clearance: f64) -> f64 {
        missing_distance(&self.hits, clearance)
    }
}

/// Returns the sum, over all obstacles that the arm hits, of the largest missing distance to each.
fn missing_distance(hits: &[Obstruction], clearance: f64) -> f64 {
    let mut worst: Vec<(usize, f64)> = Vec::new();
    for hit in hits {
        let (obstacle, lack) = (hit.contact.pair.obstacle, clearance - hit.contact.separation.distance);
        match worst.iter_mut().find(|(known, _)| *known == obstacle) {
            Some((_, most)) => *most = most.max(lack),
            None => worst.push((obstacle, lack)),
        }
    }
    worst.iter().map(|(_, lack)| lack).sum()
}

/// Finds the bottleneck of an infeasible question. `None` if the motion is blocked even without obstacles and clearance.
pub fn bottleneck(question: &MotionQuestion, boxes: usize) -> Option<Bottleneck> {
    let scene = question.scene();
    let clearance = scene.workspace().clearance;
    let extents = scene.workspace().obstacles.iter().filter_map(middle).map(|(_, extent)| extent);
    let most = clearance + extents.fold(0.0, f64::max);
    if most == 0.0 {
        return None;
    }
    let ask = |by: f64| with_reduced_clearance(question, by).answer(boxes);
    let fine = fineness(question);
    let coarse = threshold(0.0, most, fine, ask)?;
    let finer = threshold(
        coarse.closed,
        coarse.opens,
        (RELATIVE_TOLERANCE * coarse.opens).max(MIN_TOLERANCE_SHARE * fine),
        ask,
    );
    let by = finer.unwrap_or(coarse);
    let (at, hits) = narrowest(question, &by)?;
    let depth = |hit: &&Obstruction| hit.contact.separation.distance;
    let deepest = hits.iter().min_by(|a, b| depth(a).total_cmp(&depth(b)))?.contact;
    let point = place(question, at, deepest);
    Some(Bottleneck { by, at, point, hits })
}

/// Returns the configuration on the opened path at which the most distance is missing in the true scene, and the
/// collisions there.
fn narrowest(question: &MotionQuestion, by: &Threshold) -> Option<(Configuration, Vec<Obstruction>)> {
    let (scene, path) = (question.scene(), by.path.path());
    let clearance = scene.workspace().clearance;
    let looks = (PATH_SAMPLES / path.waypoints().len().max(1)).max(1);
    let shares = (0..=looks).map(|k| k as f64 / looks as f64);
    let along = path.segments().flat_map(|(from, to)| shares.clone().map(move |share| from + (to - from) * share));
    let looked = along.chain([path.start()]).chain(by.path.nearest().map(|nearest| nearest.at));
    let hits = looked.map(|q| (q, scene.obstructions(q))).filter(|(_, hits)| !hits.is_empty());
    hits.max_by(|a, b| missing_distance(&a.1, clearance).total_cmp(&missing_distance(&b.1, clearance)))
}

/// Returns the question with the clearance reduced by the distance `by`. If `by` exceeds the clearance, the obstacles
/// shrink by the rest.
fn with_reduced_clearance(question: &MotionQuestion, by: f64) -> MotionQuestion {
    question.rebuilt(|_, workspace| {
        let beyond = by - workspace.clearance;
        workspace.clearance = (workspace.clearance - by).max(0.0);
        if beyond > 0.0 {
            for obstacle in &mut workspace.obstacles {
                obstacle.pieces = shrunk_pieces(obstacle, beyond);
            }
        }
    })
}

/// Returns the corner of one of the two shapes that lies deepest in the other shape.
fn place(question: &MotionQuestion, at: Configuration, Contact { pair, .. }: Contact) -> Point {
    let scene = question.scene();
    let (part, piece) = (scene.part(pair).at(&scene.arm().pose(pair.link, at)), scene.piece(pair));
    let deep = |shape: &Convex, corner: &Point| separation(shape, &Convex::point(*corner)).distance;
    let of_part = part.core().iter().map(|corner| (deep(piece, corner), *corner));
    let of_piece = piece.core().iter().map(|corner| (deep(&part, corner), *corner));
    let deepest = of_part.chain(of_piece).min_by(|a, b| a.0.total_cmp(&b.0));
    deepest.map_or(scene.arm().tip_at(at), |(_, corner)| corner)
}
