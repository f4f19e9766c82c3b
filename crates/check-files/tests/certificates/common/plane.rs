//! The plane in floating point, for oracles: points, segments, and the arm of [`two_bars`](super::robots::two_bars).

pub type P = [f64; 2];

/// Lengths of both bars, metres.
pub const LENGTHS: P = [1.0, 0.8];

/// Half of the width of both bars, metres.
pub const HALF_WIDTH: f64 = 0.05;

pub fn turned([x, y]: P, angle: f64) -> P {
    let (s, c) = angle.sin_cos();
    [x * c - y * s, x * s + y * c]
}

pub fn plus(a: P, b: P) -> P {
    [a[0] + b[0], a[1] + b[1]]
}

pub fn minus(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn distance(a: P, b: P) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the origin of each bar, and the direction of its length, in a configuration.
pub fn links(q: P) -> [(P, f64); 2] {
    [([0.0; 2], q[0]), (turned([LENGTHS[0], 0.0], q[0]), q[0] + q[1])]
}

pub fn tip(q: P) -> P {
    let (elbow, angle) = links(q)[1];
    plus(elbow, turned([LENGTHS[1], 0.0], angle))
}

/// Returns the corners of a bar in its own frame, in order.
pub fn bar(link: usize) -> [P; 4] {
    let (length, half) = (LENGTHS[link], HALF_WIDTH);
    [[0.0, -half], [length, -half], [length, half], [0.0, half]]
}

/// Returns the corners of a bar in a configuration.
pub fn bar_at(q: P, link: usize) -> [P; 4] {
    let (from, angle) = links(q)[link];
    bar(link).map(|corner| plus(from, turned(corner, angle)))
}

/// Returns the distance of a point from a segment.
pub fn distance_to_segment(p: P, [a, b]: [P; 2]) -> f64 {
    let (u, v) = (minus(b, a), minus(p, a));
    let share = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
    (v[0] - share * u[0]).hypot(v[1] - share * u[1])
}

/// Returns the distance of two segments; 0 if they cross.
pub fn segment_distance(s: [P; 2], t: [P; 2]) -> f64 {
    let side = |[a, b]: [P; 2], p: P| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    if side(s, t[0]) * side(s, t[1]) < 0.0 && side(t, s[0]) * side(t, s[1]) < 0.0 {
        return 0.0;
    }
    let ends = [(s[0], t), (s[1], t), (t[0], s), (t[1], s)];
    ends.map(|(p, segment)| distance_to_segment(p, segment)).into_iter().fold(f64::INFINITY, f64::min)
}
