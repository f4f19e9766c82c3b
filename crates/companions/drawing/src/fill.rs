//! The region that rings enclose.

use crate::{Point, Ring};
use i_overlay::core::fill_rule::FillRule as Rule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};

/// The rule that determines which points are inside several rings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FillRule {
    /// Points with a nonzero winding number are inside.
    NonZero,
    /// Points with an odd winding number are inside.
    EvenOdd,
}

/// Returns the region that rings enclose under a fill rule, as polygons that do not cross themselves or each other. Each polygon
/// has an outer ring and holes. Corners are rounded to a grid of about 1e-17 times the extent of the rings.
pub fn filled(rings: &[Ring], rule: FillRule) -> Vec<(Ring, Vec<Ring>)> {
    let rule = match rule {
        FillRule::NonZero => Rule::NonZero,
        FillRule::EvenOdd => Rule::EvenOdd,
    };
    let none: [Point; 0] = [];
    let mut overlay = FloatOverlay::<Point, i64>::from_subj_and_clip_custom(
        rings,
        none.as_slice(),
        OverlayOptions::ogc(),
        Solver::default(),
    );
    let shapes = overlay.overlay(OverlayRule::Subject, rule);
    shapes
        .into_iter()
        .filter_map(|shape| {
            let mut rings = shape.into_iter();
            Some((rings.next()?, rings.collect()))
        })
        .collect()
}
