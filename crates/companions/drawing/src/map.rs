//! Affine maps of the plane.

use crate::{Frame, Point};

/// The map `x u + y v + o`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Map {
    pub u: Point,
    pub v: Point,
    pub o: Point,
}

impl Map {
    pub const IDENTITY: Map = Map { u: [1.0, 0.0], v: [0.0, 1.0], o: [0.0, 0.0] };

    pub fn scaling(x: f64, y: f64) -> Self {
        Self { u: [x, 0.0], v: [0.0, y], ..Self::IDENTITY }
    }

    pub fn moving(o: Point) -> Self {
        Self { o, ..Self::IDENTITY }
    }

    pub fn turning(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { u: [cos, sin], v: [-sin, cos], ..Self::IDENTITY }
    }

    /// Maps a direction.
    pub fn vector(&self, [x, y]: Point) -> Point {
        [0, 1].map(|k| self.u[k] * x + self.v[k] * y)
    }

    /// Maps a point.
    pub fn point(&self, p: Point) -> Point {
        let moved = self.vector(p);
        [0, 1].map(|k| moved[k] + self.o[k])
    }

    /// Returns the map that applies `inner` first, and then this map.
    pub fn compose(&self, inner: &Map) -> Map {
        Map { u: self.vector(inner.u), v: self.vector(inner.v), o: self.point(inner.o) }
    }

    /// Returns the frame of a map that does not distort shapes: the image of the origin, and the rotation of the y
    /// axis. The x axis may be mirrored.
    pub fn frame(&self) -> Frame {
        Frame { at: self.o, angle: (-self.v[0]).atan2(self.v[1]) }
    }

    /// Returns the scale factor. `None` if it depends on the direction.
    pub fn similarity(&self) -> Option<f64> {
        const EQUALITY_TOLERANCE: f64 = 1e-9;
        let [u, v] = [self.u, self.v].map(|[x, y]| x.hypot(y));
        let across = self.u[0] * self.v[0] + self.u[1] * self.v[1];
        ((u - v).abs() <= EQUALITY_TOLERANCE * u && across.abs() <= EQUALITY_TOLERANCE * u * v).then_some(u)
    }

    /// Returns true if the map does not collapse areas to lines or points.
    pub fn is_regular(&self) -> bool {
        let area = self.u[0] * self.v[1] - self.u[1] * self.v[0];
        area != 0.0 && area.is_finite() && self.o.iter().all(|x| x.is_finite())
    }
}
