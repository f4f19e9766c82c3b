//! Finds the pairs whose obstacle is near a part of the arm.

use super::deviation::{Deviation, Posture};
use cplan_geometry::{BoxTree, Vector};
use cplan_model::{Pair, Scene};
use std::borrow::Cow;

/// The pairs of a scene, indexed by the place of the obstacle's piece.
pub struct Vicinity<'a> {
    pairs: Cow<'a, [Pair]>,
    /// For each part, the index of its first pair and the bounding boxes of the pieces in its pairs.
    parts: Vec<(usize, BoxTree)>,
}

impl<'a> Vicinity<'a> {
    /// Creates an index of all pairs. `O(n log n)`.
    pub fn new(scene: &'a Scene) -> Self {
        Self::of(scene, Cow::Borrowed(scene.pairs()))
    }

    /// Creates an index of these pairs, which must be grouped by part.
    pub fn of(scene: &Scene, pairs: Cow<'a, [Pair]>) -> Self {
        let mut from = 0;
        let stretches = pairs.chunk_by(|a, b| (a.link, a.part) == (b.link, b.part)).map(|stretch| {
            let first = from;
            from += stretch.len();
            (first, BoxTree::new(stretch.iter().map(|&pair| scene.piece(pair).bounds()).collect()))
        });
        let parts = stretches.collect();
        Self { pairs, parts }
    }

    /// Calls `f`, in the order of the pairs, with every pair whose shapes are within `distance` of each other at some
    /// deviation from the posture, and possibly with other pairs. Stops at the first error of `f`.
    pub fn near<E>(
        &self,
        posture: &Posture,
        deviation: Deviation,
        distance: f64,
        mut f: impl FnMut(Pair) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut found = Vec::new();
        for (first, tree) in &self.parts {
            let (center, radius) = posture.place(self.pairs[*first], deviation);
            let reach = Vector::repeat(radius + distance);
            found.clear();
            tree.meeting(&[center - reach, center + reach], &mut found);
            found.iter().try_for_each(|&k| f(self.pairs[first + k as usize]))?;
        }
        Ok(())
    }
}
