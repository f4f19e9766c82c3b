//! Problems with fewer pieces of obstacles. If fewer pieces block all paths, so do all pieces.

use cplan_geometry::{Convex, Point};
use cplan_model::{MotionProblem, Obstacle, Pair};
use std::collections::HashMap;

/// A problem with only some of the pieces of its obstacles.
pub(super) struct ThinnedProblem {
    /// The problem with the remaining pieces.
    pub problem: MotionProblem,
    /// For each obstacle, the original indices of the remaining pieces, and the original number of pieces.
    kept: Vec<(Vec<usize>, usize)>,
}

impl ThinnedProblem {
    /// Keeps the piece with the greatest depth of each group of similar pieces. Pieces are similar if they lie along the same
    /// diagonal, and if their bounding boxes are equal after rounding to a lattice with this spacing, metres.
    ///
    /// Omitted pieces lie near remaining ones. If the remaining pieces block all paths, so do all pieces. `O(n)` for `n` pieces.
    pub fn new(problem: &MotionProblem, lattice: f64) -> Self {
        let kept: Vec<(Vec<usize>, usize)> = problem
            .scene()
            .workspace()
            .obstacles
            .iter()
            .map(|obstacle| (largest_alike(obstacle, lattice), obstacle.pieces.len()))
            .collect();
        let mut numbers = kept.iter();
        let some = |obstacle: &Obstacle| {
            let (kept, _) = numbers.next().unwrap_or_else(|| unreachable!("as many as obstacles"));
            kept.iter().map(|&k| obstacle.pieces[k].clone()).collect()
        };
        let scene = problem.scene().reshaped(|_| {}, some);
        Self { problem: MotionProblem::trusted(scene, problem.start(), problem.goals().clone()), kept }
    }

    /// Returns the original scene's pair for a pair of the scene with fewer pieces.
    pub fn original_pair(&self, pair: Pair) -> Pair {
        // Links of the robot keep all their pieces.
        let Some((kept, all)) = self.kept.get(pair.obstacle) else { return pair };
        // If a payload stays level, more shapes are derived from the pieces. Their numbers follow those of the pieces, once or
        // several times in the same order.
        Pair { piece: pair.piece / kept.len() * all + kept[pair.piece % kept.len()], ..pair }
    }
}

/// Returns, in ascending order, the index of the deepest piece of each group of similar pieces.
fn largest_alike(obstacle: &Obstacle, lattice: f64) -> Vec<usize> {
    let mut largest: HashMap<[i64; 5], (f64, usize)> = HashMap::new();
    for (number, piece) in obstacle.pieces.iter().enumerate() {
        let size = piece.depth();
        let best = largest.entry(place(piece, lattice)).or_insert((size, number));
        if size > best.0 {
            *best = (size, number);
        }
    }
    let mut kept: Vec<usize> = largest.into_values().map(|(_, number)| number).collect();
    kept.sort_unstable();
    kept
}

/// Returns the bounding box rounded down to lattice cells, and the diagonal along which the piece mostly lies: 1 if it
/// rises, 0 if it falls.
fn place(piece: &Convex, lattice: f64) -> [i64; 5] {
    let [lower, upper] = piece.bounds();
    let on = |v: f64| (v / lattice).floor() as i64;
    let core = piece.core();
    let middle = |k: usize| core.iter().map(|p| p[k]).sum::<f64>() / core.len() as f64;
    let (x, y) = (middle(0), middle(1));
    let leans = core.iter().map(|p: &Point| (p.x - x) * (p.y - y)).sum::<f64>();
    [on(lower.x), on(lower.y), on(upper.x), on(upper.y), i64::from(leans > 0.0)]
}
