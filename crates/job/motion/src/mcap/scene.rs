//! What a recording displays: bodies, each with a frame, and the poses of the frames over time.

use super::super::clock::nanoseconds;
use cplan_geometry::{Convex, Point, Pose, Vector};
use cplan_model::{Heights, Plane};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Bodies to display, and their motion in the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// The plane of motion.
    pub plane: Plane,
    /// The bodies. The first one has everything static, and does not move.
    pub bodies: Vec<Body>,
    /// Changes of poses in order of time. Each has the time in seconds from the beginning, the index of a body, its pose from
    /// then on, and its lift along the plane's normal, metres.
    pub poses: Vec<(f64, usize, Pose, f64)>,
    /// Size of the arm, metres. The sizes of displayed details are relative to it.
    pub size: f64,
}

/// A rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name of its frame. The frame of the first body is the parent of all other frames.
    pub name: String,
    /// The solids in the frame, whose axes are those of the plane and its normal.
    pub solids: Vec<Solid>,
}

/// Convex pieces of one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// A name for display.
    pub name: String,
    /// Red, green and blue, each from 0 to 1.
    pub color: [f32; 3],
    /// The pieces, each with its extent along the plane's normal.
    pub pieces: Vec<(Convex, Heights)>,
}

/// A point of space, metres.
pub type Place = [f64; 3];

/// Number of chords around a full circle. A chord is within 2 % of the radius of its arc.
const CHORDS_PER_CIRCLE: f64 = 16.0;

/// Height, as a share of the arm's size, of bodies with infinite height if no body has a finite one.
const THIN_BODY_HEIGHT: f64 = 0.02;

/// Distance between points of outlines, as a share of the arm's size.
const OUTLINE_SPACING: f64 = 0.01;

impl Stage {
    /// Returns the displayed heights of bodies with infinite heights: the range of all finite heights.
    pub fn heights(&self) -> Heights {
        let pieces = self.bodies.iter().flat_map(|body| &body.solids).flat_map(|solid| &solid.pieces);
        let ends = pieces.flat_map(|(_, heights)| [heights.lower, heights.upper]).filter(|end| end.is_finite());
        let (lower, upper) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), end| (l.min(end), u.max(end)));
        if lower < upper {
            Heights { lower, upper }
        } else {
            Heights { lower: 0.0, upper: THIN_BODY_HEIGHT * self.size }
        }
    }

    /// Returns the plane's axes in space as a rotation. The third axis is the normal or its opposite.
    fn basis(&self) -> Matrix3<f64> {
        let Plane { u, v, .. } = self.plane;
        Matrix3::from_columns(&[u, v, u.cross(&v)])
    }

    /// Returns the direction of the normal along the third axis of frames.
    fn normal_direction(&self) -> f64 {
        self.basis().column(2).dot(&self.plane.normal).signum()
    }

    /// Returns position and orientation (x, y, z, w) of a body's frame in space.
    fn transform(&self, pose: &Pose, raised: f64) -> (Place, [f64; 4]) {
        let basis = Rotation3::from_matrix_unchecked(self.basis());
        let at = basis * Vector3::new(pose.translation.x, pose.translation.y, raised * self.normal_direction());
        let turn =
            UnitQuaternion::from(basis) * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), pose.rotation.angle());
        (at.into(), [turn.i, turn.j, turn.k, turn.w])
    }

    /// Returns the movements of bodies: time in nanoseconds, index of the body, and its transform. Omits bodies that never move.
    pub fn moves(&self) -> Vec<(u64, usize, (Place, [f64; 4]))> {
        let mut last = vec![None; self.bodies.len()];
        let moved = |&(time, body, pose, raised): &(f64, usize, Pose, f64)| {
            let at = self.transform(&pose, raised);
            (last[body].replace(at) != Some(at)).then_some((nanoseconds(time), body, at))
        };
        self.poses.iter().filter_map(moved).collect()
    }

    /// Returns the surface of a solid in its frame as triangles: each three consecutive points are the corners of one.
    pub fn triangles(&self, solid: &Solid) -> Vec<Place> {
        let mut corners = Vec::new();
        for (piece, heights) in &solid.pieces {
            let [low, high] = self.ends(*heights);
            let ring = ring(piece);
            let at = |p: Point, height: f64| [p.x, p.y, height];
            for k in 0..ring.len() {
                let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
                corners.extend([at(a, low), at(b, low), at(b, high), at(a, low), at(b, high), at(a, high)]);
                if (1..ring.len() - 1).contains(&k) {
                    corners.extend([at(ring[0], high), at(a, high), at(b, high)]);
                    corners.extend([at(ring[0], low), at(b, low), at(a, low)]);
                }
            }
        }
        corners
    }

    /// Returns points along the lower and the upper rims of a body's pieces, in its frame.
    pub fn rims(&self, body: &Body) -> Vec<Place> {
        let mut points = Vec::new();
        for (piece, heights) in body.solids.iter().flat_map(|solid| &solid.pieces) {
            let (ring, ends) = (ring(piece), self.ends(*heights));
            for k in 0..ring.len() {
                let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
                let count = ((b - a).norm() / (OUTLINE_SPACING * self.size)).ceil().max(1.0) as usize;
                for i in 0..count {
                    let p = a + (b - a) * (i as f64 / count as f64);
                    points.extend(ends.map(|height| [p.x, p.y, height]));
                }
            }
        }
        points
    }

    /// Returns the lower and the upper end of a piece along the frame's third axis.
    fn ends(&self, heights: Heights) -> [f64; 2] {
        let usual = self.heights();
        let or = |end: f64, usual: f64| if end.is_finite() { end } else { usual };
        let ends =
            [or(heights.lower, usual.lower), or(heights.upper, usual.upper)].map(|end| end * self.normal_direction());
        if self.normal_direction() > 0.0 { ends } else { [ends[1], ends[0]] }
    }
}

/// Returns the corners of a piece, counter-clockwise, with chords for its round ends.
fn ring(piece: &Convex) -> Vec<Point> {
    let (core, radius) = (piece.core(), piece.radius().max(0.0));
    if radius == 0.0 {
        return core.to_vec();
    }
    let n = core.len();
    let outward = |k: usize| {
        let side = core[(k + 1) % n] - core[k];
        (-side.x).atan2(side.y)
    };
    let mut ring = Vec::new();
    for (k, corner) in core.iter().enumerate() {
        let (from, turn) = match n {
            1 => (0.0, TAU),
            _ => {
                let from = outward((k + n - 1) % n);
                (from, (outward(k) - from).rem_euclid(TAU))
            }
        };
        let steps = (turn / TAU * CHORDS_PER_CIRCLE).ceil().max(1.0);
        let last = if n == 1 { steps as usize - 1 } else { steps as usize };
        ring.extend((0..=last).map(|i| {
            let angle = from + turn * i as f64 / steps;
            corner + Vector::new(angle.cos(), angle.sin()) * radius
        }));
    }
    ring
}
