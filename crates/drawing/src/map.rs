//! Affine maps of the plane.

use crate::{Frame, Point};

/// Where a point goes: `x u + y v + o`.
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

    /// Where a direction goes.
    pub fn vector(&self, [x, y]: Point) -> Point {
        [0, 1].map(|k| self.u[k] * x + self.v[k] * y)
    }

    /// Where a point goes.
    pub fn point(&self, p: Point) -> Point {
        let moved = self.vector(p);
        [0, 1].map(|k| moved[k] + self.o[k])
    }

    /// First `inner`, then this.
    pub fn after(&self, inner: &Map) -> Map {
        Map { u: self.vector(inner.u), v: self.vector(inner.v), o: self.point(inner.o) }
    }

    /// Where it takes the origin, and the turn of whatever it mirrors or scales alike in all directions: that of the y axis, since what is
    /// seen from below has x turned round.
    pub fn frame(&self) -> Frame {
        Frame { at: self.o, angle: (-self.v[0]).atan2(self.v[1]) }
    }

    /// The factor by which it scales, if it stretches no direction more than another.
    pub fn similarity(&self) -> Option<f64> {
        const EQUAL: f64 = 1e-9;
        let [u, v] = [self.u, self.v].map(|[x, y]| x.hypot(y));
        let across = self.u[0] * self.v[0] + self.u[1] * self.v[1];
        ((u - v).abs() <= EQUAL * u && across.abs() <= EQUAL * u * v).then_some(u)
    }

    /// Whether it keeps areas apart from points and lines.
    pub fn is_regular(&self) -> bool {
        let area = self.u[0] * self.v[1] - self.u[1] * self.v[0];
        area != 0.0 && area.is_finite() && self.o.iter().all(|x| x.is_finite())
    }
}
