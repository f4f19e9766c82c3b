//! The plane in floating point, for oracles: points, segments, and the arm of [`two_bars`](super::robots::two_bars).

pub use cplan_cases::plane::{Point as P, distance, distance_to_segment, minus, plus, segment_distance, turned};

/// Lengths of both bars, metres.
pub const LENGTHS: P = [1.0, 0.8];

/// Half of the width of both bars, metres.
pub const HALF_WIDTH: f64 = 0.05;

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
