//! Curves of the plane with exact formulas.

use serde::{Deserialize, Serialize};

/// A point or a displacement in the plane, metres.
pub type Point = [f64; 2];

/// Number of intervals in the numerical integral for the length of a cubic curve.
const LENGTH_INTERVALS: usize = 32;

/// Step of the parameter in the search for the nearest point of a cubic curve.
const NEAREST_STEP: f64 = 1.0 / 64.0;

/// Number of steps that refine the nearest point of a spiral. Near the curve, each step reduces the error to a small share of it.
const NEAREST_DIRECTION_STEPS: usize = 4;

/// Number of golden sections that refine the nearest point of a cubic curve.
const NEAREST_STEPS: usize = 6;

/// Number of Newton steps after the golden sections. The remaining error is below a billionth of the parameter, except near
/// cusps.
const NEWTON_STEPS: usize = 3;

/// A curve. Its parameter `u` runs from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Curve {
    /// A straight line at constant speed of the parameter.
    Line {
        /// The first end, metres.
        from: Point,
        /// The other end, metres.
        to: Point,
    },
    /// An arc about a centre, at constant angular speed of the parameter. It is part of a circle, or of a spiral whose radius
    /// changes linearly.
    Arc {
        /// The centre, metres.
        center: Point,
        /// The radius at the first end, metres.
        radius: f64,
        /// Direction from the centre to the first end, radians from the x axis.
        from: f64,
        /// Angle about the centre from the first end to the other, radians; positive counter-clockwise.
        by: f64,
        /// Radius at the other end minus radius at the first end, metres; 0 for a circle.
        #[serde(default, skip_serializing_if = "is_zero")]
        growth: f64,
    },
    /// A cubic Bézier curve with these control points, metres. The first and the last are its ends.
    Cubic([Point; 4]),
}

impl Curve {
    /// Returns the point at a parameter, metres. At both ends it is exact, on arcs up to rounding.
    pub fn at(&self, u: f64) -> Point {
        match *self {
            Curve::Line { from, to } => mix(from, to, u),
            Curve::Arc { center, radius, from, by, growth } => {
                let (sin, cos) = (from + by * u).sin_cos();
                let radius = radius + growth * u;
                [center[0] + radius * cos, center[1] + radius * sin]
            }
            Curve::Cubic([a, b, c, d]) => {
                let [ab, bc, cd] = [mix(a, b, u), mix(b, c, u), mix(c, d, u)];
                mix(mix(ab, bc, u), mix(bc, cd, u), u)
            }
        }
    }

    /// Returns the derivative by the parameter, metres.
    pub fn derivative(&self, u: f64) -> Point {
        match *self {
            Curve::Line { from, to } => minus(to, from),
            Curve::Arc { radius, from, by, growth, .. } => {
                let (sin, cos) = (from + by * u).sin_cos();
                let across = (radius + growth * u) * by;
                [growth * cos - across * sin, growth * sin + across * cos]
            }
            Curve::Cubic([a, b, c, d]) => {
                let [ab, bc, cd] = [minus(b, a), minus(c, b), minus(d, c)];
                mix(mix(ab, bc, u), mix(bc, cd, u), u).map(|x| 3.0 * x)
            }
        }
    }

    /// Returns the rate at which the direction turns, radians per unit of the parameter. Returns `None` where the derivative
    /// vanishes.
    pub fn turning(&self, u: f64) -> Option<f64> {
        let along = self.derivative(u);
        let second = match *self {
            Curve::Line { .. } => return Some(0.0),
            // In polar coordinates about the centre.
            Curve::Arc { radius, by, growth, .. } => {
                let [out, across] = [growth, (radius + growth * u) * by];
                let square = out * out + across * across;
                return (square > 0.0).then(|| by * (1.0 + out * out / square));
            }
            Curve::Cubic([a, b, c, d]) => {
                let [ab, bc, cd] = [minus(b, a), minus(c, b), minus(d, c)];
                mix(minus(bc, ab), minus(cd, bc), u).map(|x| 6.0 * x)
            }
        };
        let square = dot(along, along);
        (square > 0.0).then(|| (along[0] * second[1] - along[1] * second[0]) / square)
    }

    /// Returns an upper bound on the length of the second derivative by the parameter, metres, for the whole curve.
    pub fn bend(&self) -> f64 {
        match *self {
            Curve::Line { .. } => 0.0,
            Curve::Arc { radius, by, growth, .. } => (radius.max(radius + growth) * by * by).hypot(2.0 * growth * by),
            Curve::Cubic([a, b, c, d]) => {
                let second = |p: Point, q: Point, r: Point| norm(minus(minus(r, q), minus(q, p)));
                6.0 * second(a, b, c).max(second(b, c, d))
            }
        }
    }

    /// Does the same as [`Curve::bend`] for the part between two parameters.
    pub fn bend_between(&self, ends: [f64; 2]) -> f64 {
        let Curve::Cubic([a, b, c, d]) = *self else { return self.bend() };
        // The second derivative of a cubic curve is linear.
        let second = |p: Point, q: Point, r: Point| minus(minus(r, q), minus(q, p));
        let [first, last] = [second(a, b, c), second(b, c, d)];
        ends.map(|u| 6.0 * norm(mix(first, last, u))).into_iter().fold(0.0, f64::max)
    }

    /// Returns the first end.
    pub fn start(&self) -> Point {
        self.at(0.0)
    }

    /// Returns the other end.
    pub fn end(&self) -> Point {
        self.at(1.0)
    }

    /// Returns the unit direction in which the curve leaves its first end (`end` is 0) or reaches its other end (1). `None` if
    /// the curve has no length.
    pub fn direction(&self, end: f64) -> Option<Point> {
        let derivative = match *self {
            // Where control points coincide, the derivative vanishes. Then the next control point gives the direction.
            Curve::Cubic(points) => {
                let own = points[if end > 0.5 { 3 } else { 0 }];
                let others = if end > 0.5 { [2, 1, 0] } else { [1, 2, 3] };
                let away = others.map(|k| minus(points[k], own)).into_iter().find(|v| norm(*v) > 0.0)?;
                if end > 0.5 { away.map(|x| -x) } else { away }
            }
            _ => self.derivative(end),
        };
        let length = norm(derivative);
        (length > 0.0).then(|| derivative.map(|x| x / length))
    }

    /// Returns the length, metres. For a cubic curve and a spiral it is a numerical integral.
    pub fn length(&self) -> f64 {
        self.length_to(1.0)
    }

    /// Returns the length from the first end to a parameter, metres. For a cubic curve and a spiral it is a numerical
    /// integral.
    pub fn length_to(&self, u: f64) -> f64 {
        match *self {
            Curve::Line { from, to } => u * norm(minus(to, from)),
            Curve::Arc { radius, by, growth: 0.0, .. } => u * radius * by.abs(),
            Curve::Arc { .. } | Curve::Cubic(_) => {
                // Simpson's rule.
                let step = u / LENGTH_INTERVALS as f64;
                let speed = |k: f64| {
                    let derivative = self.derivative(k * step);
                    dot(derivative, derivative).sqrt()
                };
                let part = |k: usize| speed(k as f64) + 4.0 * speed(k as f64 + 0.5) + speed(k as f64 + 1.0);
                (0..LENGTH_INTERVALS).map(part).sum::<f64>() * step / 6.0
            }
        }
    }

    /// Returns a parameter of at least `least` at which the curve is near a point. On lines, and on circles within half a turn,
    /// it is the nearest one. On spirals, it is near the place in the same direction from the centre. On cubic curves, it is the
    /// first parameter, in small steps, from which the distance grows.
    pub fn nearest(&self, point: Point, least: f64) -> f64 {
        match *self {
            Curve::Line { from, to } => {
                let along = minus(to, from);
                let square = dot(along, along);
                let u = if square > 0.0 { dot(minus(point, from), along) / square } else { 0.0 };
                u.clamp(least, 1.0)
            }
            Curve::Arc { center, from, by, growth, .. } => {
                let away = minus(point, center);
                let middle = from + by * least;
                let turned = (away[1].atan2(away[0]) - middle) * by.signum();
                // Within half a turn of the place at `least`.
                let turn = turned - std::f64::consts::TAU * (turned / std::f64::consts::TAU).round();
                let beside = (least + (turn / by.abs()).max(0.0)).clamp(least, 1.0);
                if growth == 0.0 { beside } else { self.refined(point, least, beside) }
            }
            Curve::Cubic(_) => self.nearest_ahead(point, least),
        }
    }

    /// Refines a guess for the parameter nearest to a point, by steps along the tangent.
    fn refined(&self, point: Point, least: f64, guess: f64) -> f64 {
        let far = |u: f64| norm(minus(self.at(u), point));
        (0..NEAREST_DIRECTION_STEPS).fold(guess, |u, _| {
            let along = self.derivative(u);
            let next = (u + dot(minus(point, self.at(u)), along) / dot(along, along)).clamp(least, 1.0);
            if far(next) < far(u) { next } else { u }
        })
    }

    /// Finds the first parameter of at least `least` from which the distance grows, and refines it by golden sections and by
    /// Newton's method.
    fn nearest_ahead(&self, point: Point, least: f64) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let far = |u: f64| {
            let off = minus(self.at(u), point);
            dot(off, off)
        };
        let (mut low, mut middle) = (least, least);
        let mut high = (middle + NEAREST_STEP).min(1.0);
        while far(high) < far(middle) && high < 1.0 {
            (low, middle, high) = (middle, high, (high + NEAREST_STEP).min(1.0));
        }
        let [mut a, mut b] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let [mut at_a, mut at_b] = [far(a), far(b)];
        for _ in 0..NEAREST_STEPS {
            if at_a <= at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - GOLDEN * (high - low);
                at_a = far(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + GOLDEN * (high - low);
                at_b = far(b);
            }
        }
        let mut refined = (low + high) / 2.0;
        for _ in 0..NEWTON_STEPS {
            let (off, along) = (minus(self.at(refined), point), self.derivative(refined));
            let square = dot(along, along);
            if square > 0.0 {
                refined = (refined - dot(off, along) / square).clamp(low, high);
            }
        }
        [low, high, refined].into_iter().min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(middle)
    }

    /// Returns the curve scaled about the origin, then turned about it by `turn` radians, then moved.
    #[must_use]
    pub fn placed(&self, scale: f64, turn: f64, shift: Point) -> Self {
        let (sin, cos) = turn.sin_cos();
        let moved = |[x, y]: Point| [scale * (x * cos - y * sin) + shift[0], scale * (x * sin + y * cos) + shift[1]];
        match *self {
            Curve::Line { from, to } => Curve::Line { from: moved(from), to: moved(to) },
            Curve::Arc { center, radius, from, by, growth } => {
                let [radius, growth] = [scale * radius, scale * growth];
                Curve::Arc { center: moved(center), radius, from: from + turn, by, growth }
            }
            Curve::Cubic(points) => Curve::Cubic(points.map(moved)),
        }
    }

    /// Returns true if all numbers are finite and no coordinate exceeds `most`, metres.
    pub(crate) fn is_within(&self, most: f64) -> bool {
        let near = |p: &Point| p.iter().all(|x| x.abs() <= most);
        match self {
            Curve::Line { from, to } => near(from) && near(to),
            Curve::Arc { center, radius, from, by, growth } => {
                near(center) && near(&[*radius, *growth]) && near(&[*from, *by])
            }
            Curve::Cubic(points) => points.iter().all(near),
        }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

fn mix(a: Point, b: Point, u: f64) -> Point {
    [0, 1].map(|k| a[k] * (1.0 - u) + b[k] * u)
}

pub(crate) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn norm(v: Point) -> f64 {
    v[0].hypot(v[1])
}
