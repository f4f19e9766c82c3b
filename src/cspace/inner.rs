//! C-obstacles from the inside: polygons of configurations that are blocked, all of them.

use super::curves::first_breaks;
use super::outline::{Flattening, Source, contours};
use super::overlap::Overlaps;
use super::regions::bands;
use super::rows::Rows;
use super::{CObstacle, translation};
use crate::geometry::{Convex, Hits, Point, inset};
use crate::model::{Pair, Scene};
use crate::space::Configuration;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Share of the depth that the joints' motion over the narrowest strips may use up; the rest is for what neighbouring
/// contours overlap, and for rounding.
const NARROWEST: f64 = 0.5;

/// Overlap of neighbouring contours, relative to the width of the narrowest strip.
const OVERLAP: f64 = 1e-3;

/// Depth that the middle of a link's side may have, relative to that of its ends: more would be far from the boundary.
const DEEPEST: f64 = 2.0;

/// Share of the depth that the links of contours leave unused, so that they survive rounding.
const SPARE: f64 = 1.0 / 16.0;

/// Contours within the C-obstacles of a scene, made as they are asked for.
///
/// Of every pair the rows of smaller shapes are linked: they meet where the pair itself overlaps by `margin`, and so for
/// all configurations nearby. A link is made only where the whole quadrilateral between two rows is proven to be
/// blocked (module `overlap`); where none can be made, strips of a width over which the joints move the shapes by less
/// than the margin take the blocked intervals of both their rows. What is left out is left out: contours may have gaps,
/// but hold no configuration that keeps both more than zero and the clearance. Vertices grow like `1 / sqrt(margin)`.
///
/// Shapes without area cannot be made smaller, and are shortened instead. Two such shapes, of link 1, have no contour.
#[derive(Debug, Clone)]
pub struct InnerObstacles {
    margin: f64,
    made: BTreeMap<usize, Vec<CObstacle>>,
}

impl InnerObstacles {
    /// None made yet; `margin` in metres.
    ///
    /// # Panics
    /// If `margin` is not positive.
    #[must_use]
    pub fn new(margin: f64) -> Self {
        assert!(margin > 0.0, "a margin for the flattening of curves");
        Self { margin, made: BTreeMap::new() }
    }

    /// By how much obstacles are made smaller, metres.
    #[must_use]
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// The contours of pair number `index` of the scene, which must always be the same one.
    ///
    /// # Panics
    /// If there is no such pair.
    pub fn contours(&mut self, scene: &Scene, index: usize) -> &[CObstacle] {
        let margin = self.margin;
        self.made.entry(index).or_insert_with(|| {
            let pair = scene.pairs()[index];
            let (obstacle, link) = (pair.obstacle, pair.link);
            made(scene, pair, margin).into_iter().map(|contour| CObstacle { obstacle, link, contour }).collect()
        })
    }
}

fn made(scene: &Scene, pair: Pair, margin: f64) -> Vec<Vec<Point>> {
    let (part, piece, level) = (scene.part(pair), scene.piece(pair), scene.workspace.clearance);
    if let (1, Some(map)) = (pair.link, translation::joint_map(&scene.arm)) {
        return translation::inner_contour(&scene.arm, &map, part, piece, level, margin).into_iter().collect();
    }
    let Some(smaller) = smaller(part, piece, level, margin) else { return Vec::new() };
    let rows = Rows::of_pair(scene, pair, &smaller.part, &smaller.piece);
    match pair.link {
        0 if smaller.solid => bands(&rows, 0, 0.0, OVERLAP * margin),
        0 => Vec::new(),
        _ => InnerCurves::new(&rows, pair, &smaller, margin).contours(),
    }
}

/// The shapes of a pair that meet only where the pair itself overlaps.
struct Smaller {
    part: Convex,
    piece: Convex,
    /// Whether they overlap by the depth asked for, whichever way they are moved; if not, they cross.
    solid: bool,
}

/// Shapes that meet where the pair's overlap by `depth`: radii are made smaller as far as there are any, then the polygon
/// with more room; two segments are shortened.
fn smaller(part: &Convex, piece: &Convex, level: f64, depth: f64) -> Option<Smaller> {
    let radius = part.radius() + piece.radius() + level - depth;
    let shape = |core: &[Point], radius: f64| Convex::new(core.to_vec(), radius);
    if radius >= 0.0 {
        return Some(Smaller { part: shape(part.core(), radius), piece: shape(piece.core(), 0.0), solid: true });
    }
    let bare = |shape: &Convex| Convex::new(shape.core().to_vec(), 0.0);
    let within = |shape: &Convex| Some(Convex::new(inset(shape.core(), -radius)?, 0.0));
    let (less_part, less_piece) = (within(part), within(piece));
    let area = |shape: &Option<Convex>| shape.as_ref().map_or(0.0, Convex::area);
    if area(&less_part) >= area(&less_piece) && less_part.is_some() {
        return less_part.map(|part| Smaller { part, piece: bare(piece), solid: true });
    }
    if let Some(piece) = less_piece {
        return Some(Smaller { part: bare(part), piece, solid: true });
    }
    Some(Smaller { part: shortened(part, depth)?, piece: shortened(piece, depth)?, solid: false })
}

/// A segment without its ends.
fn shortened(shape: &Convex, by: f64) -> Option<Convex> {
    let &[a, b] = shape.core() else { return None };
    let length = (b - a).norm();
    let end = (b - a) * (by / length);
    (length > 2.0 * by).then(|| Convex::segment(a + end, b - end))
}

/// The rows of a pair's smaller shapes, and the proof that what lies between them is blocked.
struct InnerCurves<'a> {
    rows: &'a Rows<'a>,
    overlaps: Overlaps<'a>,
    smaller: &'a Smaller,
    min_width: f64,
    /// By which the smaller shapes are smaller.
    depth: f64,
}

impl<'a> InnerCurves<'a> {
    fn new(rows: &'a Rows<'a>, pair: Pair, smaller: &'a Smaller, depth: f64) -> Self {
        let scene = rows.scene();
        let (part, piece) = (scene.part(pair), scene.piece(pair));
        let radius = part.radius() + piece.radius() + scene.workspace.clearance;
        let spare = if smaller.solid { SPARE * depth } else { 0.0 };
        let overlaps = Overlaps::new(&scene.arm, part, piece, radius - spare);
        let min_width = NARROWEST * depth / overlaps.speed().max(f64::MIN_POSITIVE);
        Self { rows, overlaps, smaller, min_width, depth }
    }

    fn contours(&self) -> Vec<Vec<Point>> {
        if self.rows.reach_range(0, 0.0, &mut Vec::new()) == Hits::Never {
            return Vec::new();
        }
        let turning = self.rows.scene().arm.joints[1].motion.is_revolute();
        // Both joints' motion over the overlap is a small part of the depth.
        let width = self.min_width.min(self.depth / self.rows.lever(0).max(f64::MIN_POSITIVE));
        let overlap = if self.smaller.solid { OVERLAP * width } else { 0.0 };
        let breaks = first_breaks(self.rows, 0, [&self.smaller.part, &self.smaller.piece], &[(0.0, false)], overlap);
        contours(&mut &*self, &breaks, Flattening { turning, min_width: self.min_width, overlap })
    }
}

impl Source for &InnerCurves<'_> {
    type End = Configuration;

    fn intervals(&mut self, q1: f64, out: &mut Vec<[f64; 2]>) {
        if self.rows.second_link(0, q1, 0.0, out) == Hits::Always {
            out.push([-PI, PI]);
        }
    }

    fn end(&self, q1: f64, q2: f64) -> Configuration {
        Configuration::new(q1, q2)
    }

    fn point(&self, end: &Configuration) -> Point {
        Point::from(*end)
    }

    fn shifted(&self, end: &Configuration, turns: f64) -> Configuration {
        Configuration::new(end[0], end[1] + turns * TAU)
    }

    fn links(&self, from: &[Configuration; 2], to: &[Configuration; 2]) -> bool {
        (0..2).all(|side| self.overlaps.depth((from[side] + to[side]) / 2.0) <= DEEPEST * self.depth)
            && self.overlaps.everywhere(&[*from, *to])
    }

    /// A line may not stand alone: what is blocked is proven for whole quadrilaterals.
    fn shortens(&self, _: &Configuration, _: &Configuration) -> bool {
        false
    }

    fn fills(&self, u: f64, v: f64, [lower, upper]: [f64; 2]) -> bool {
        // Over a strip this narrow solid shapes that meet in one of its rows go on overlapping.
        self.smaller.solid && v - u <= self.min_width
            || self.overlaps.everywhere(&[u, v].map(|q1| [lower, upper].map(|q2| Configuration::new(q1, q2))))
    }

    fn is_spent(&self) -> bool {
        self.overlaps.is_spent()
    }
}
