//! C-obstacles of link 2 if a joint is revolute: the exact slices of a pair, joined by proven chords.

use super::chord::{Contact, PairMotion};
use super::events::events;
use super::outline::{Breakpoint, Flattening, SlicedObstacle, contours};
use cplan_geometry::{Hits, Point};
use cplan_model::Contacts;
use cplan_model::space::Configuration;
use std::f64::consts::{PI, TAU};

/// Fraction of the tolerance that chords leave unused, so that strict inequalities survive rounding.
const TOLERANCE_RESERVE: f64 = 1.0 / 16.0;

/// Number of initial slices over a turn, or over the range of a prismatic joint 1. It affects only the shape of
/// contours and the speed, because [`events`] finds everything that coarse slices could miss.
const FIRST_SLICES: usize = 24;

/// Overlap of neighbouring contours in `q1`, as a fraction of the width of the narrowest strip. It is far greater than
/// the rounding of the union, and far smaller than the tolerance.
const CONTOUR_OVERLAP: f64 = 1e-3;

/// The slices of a shape of link 2 and a piece of an obstacle, with limits on the distances of chords between the slices.
pub(super) struct Curves<'a> {
    slices: &'a Contacts<'a>,
    index: usize,
    motion: PairMotion<'a>,
    /// Least distance that a chord must keep, metres.
    floor: f64,
    /// Distance of the pair on the boundary of the slices, metres.
    level: f64,
    /// Greatest allowed distance of the middle of a chord, metres.
    ceiling: f64,
    min_width: f64,
}

impl<'a> Curves<'a> {
    /// Prepares pair `index` of the scene. The contours must cover its configurations within `level`, see
    /// [`super::c_obstacles`].
    pub fn new(slices: &'a Contacts<'a>, index: usize, level: f64, tolerance: f64) -> Self {
        let scene = slices.scene();
        let pair = scene.pairs()[index];
        let motion = PairMotion::new(scene.arm(), scene.part(pair), scene.piece(pair));
        // While joint 1 moves by twice this width, no distance changes by more than the tolerance.
        let min_width = tolerance / (2.0 * motion.speed().max(f64::MIN_POSITIVE));
        let (floor, ceiling) = (level + TOLERANCE_RESERVE * tolerance, level + 2.0 * tolerance);
        Self { slices, index, motion, floor, level: level + tolerance, ceiling, min_width }
    }

    /// Returns contours that cover the pair's C-obstacle.
    pub fn contours(&self) -> Vec<Vec<Point>> {
        if self.slices.reach_range(self.index, self.level, &mut Vec::new()) == Hits::Never {
            return Vec::new();
        }
        let turning = self.slices.scene().arm().joints[1].joint_type.is_revolute();
        let overlap = CONTOUR_OVERLAP * self.min_width;
        contours(&mut &*self, &self.breaks(), Flattening { turning, min_width: self.min_width, overlap })
    }

    /// Returns the values of `q1` of the initial slices, in ascending order. Some are evenly spaced. At others, the
    /// pair begins or ceases to be within `level` or `floor`. Contours keep a vertex at values for `floor`. Of values
    /// nearer together than the overlap of contours, only one is returned.
    fn breaks(&self) -> Vec<Breakpoint> {
        let scene = self.slices.scene();
        let pair = scene.pairs()[self.index];
        let arm = scene.arm();
        let levels = [(self.floor, true), (self.level, false)];
        let joint = &arm.joints[0];
        let (start, end) = if joint.joint_type.is_revolute() {
            let start = seam(self.slices, self.index, self.level);
            (start, start + TAU)
        } else {
            joint.range.domain()
        };
        let step = (end - start) / FIRST_SLICES as f64;
        let mut breaks: Vec<Breakpoint> = (0..FIRST_SLICES)
            .map(|i| Breakpoint { q1: start + step * i as f64, keep: false })
            .chain([Breakpoint { q1: end, keep: false }])
            .collect();
        for (level, keep) in levels {
            for q1 in events(arm, scene.part(pair), scene.piece(pair), level) {
                let q1 = if joint.joint_type.is_revolute() { start + (q1 - start).rem_euclid(TAU) } else { q1 };
                if start <= q1 && q1 <= end {
                    breaks.push(Breakpoint { q1, keep });
                }
            }
        }
        breaks.sort_by(|a, b| a.q1.total_cmp(&b.q1));
        breaks.dedup_by(|b, a| {
            let near = b.q1 - a.q1 <= CONTOUR_OVERLAP * self.min_width;
            a.keep |= near && b.keep;
            near
        });
        breaks
    }
}

/// Returns the value at which the circle of joint 1 is cut. It has no contact if an initial slice without contact exists.
fn seam(slices: &Contacts, index: usize, level: f64) -> f64 {
    let mut intervals = Vec::new();
    (0..FIRST_SLICES)
        .map(|i| -PI + TAU / FIRST_SLICES as f64 * i as f64)
        .find(|&q1| slices.second_link(index, q1, level, &mut intervals) == Hits::Never)
        .unwrap_or(-PI)
}

impl SlicedObstacle for &Curves<'_> {
    type End = Contact;

    fn intervals(&mut self, q1: f64, out: &mut Vec<[f64; 2]>) {
        if self.slices.second_link(self.index, q1, self.level, out) == Hits::Always {
            out.push([-PI, PI]);
        }
    }

    fn end(&self, q1: f64, q2: f64) -> Contact {
        self.motion.contact(Configuration::new(q1, q2))
    }

    fn point(&self, end: &Contact) -> Point {
        end.q
    }

    fn shifted(&self, end: &Contact, turns: f64) -> Contact {
        end.turned(turns)
    }

    fn links(&self, from: &[Contact; 2], to: &[Contact; 2]) -> bool {
        (0..2).all(|side| self.shortens(&from[side], &to[side]))
    }

    fn shortens(&self, from: &Contact, to: &Contact) -> bool {
        self.motion.least_distance(from, to) >= self.floor
            && self.motion.separation((from.q + to.q) / 2.0).distance <= self.ceiling
    }
}
