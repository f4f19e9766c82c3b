//! Guesses a direction that may separate two shapes. The caller verifies it.

/// Returns the indices of the points on the convex hull, in order (Andrew 1979).
pub(super) fn ring(points: &[[f64; 2]]) -> Vec<usize> {
    let turns = |a: usize, b: usize, c: usize| {
        let [p, q, r] = [points[a], points[b], points[c]];
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0
    };
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| points[*a][0].total_cmp(&points[*b][0]).then(points[*a][1].total_cmp(&points[*b][1])));
    let mut ring: Vec<usize> = Vec::new();
    for back in [false, true] {
        let first = ring.len();
        for k in 0..order.len() {
            let next = order[if back { order.len() - 1 - k } else { k }];
            while ring.len() > first + 1 && !turns(ring[ring.len() - 2], ring[ring.len() - 1], next) {
                ring.pop();
            }
            ring.push(next);
        }
        ring.pop();
    }
    if ring.is_empty() { order } else { ring }
}

/// Returns the direction from one shape to the nearest point of the other. `None` unless their distance exceeds `apart`.
pub(super) fn direction(here: &[[f64; 2]], there: &[[f64; 2]], apart: f64) -> Option<[f64; 2]> {
    let minus = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    // Returns the vector from a point to the nearest point of a segment. Between the ends of the segment, it is perpendicular to
    // the segment. A difference of two positions would lose all digits of a vector that is much shorter than the segment.
    let to_segment = |p: [f64; 2], a: [f64; 2], b: [f64; 2]| {
        let (along, to) = (minus(b, a), minus(a, p));
        let square = dot(along, along);
        let share = if square > 0.0 { -dot(to, along) / square } else { 0.0 };
        if 0.0 < share && share < 1.0 {
            let across = [-along[1], along[0]];
            return across.map(|c| c * (dot(to, across) / square));
        }
        let share = share.clamp(0.0, 1.0);
        [to[0] + share * along[0], to[1] + share * along[1]]
    };
    let mut nearest = ([0.0; 2], f64::INFINITY);
    let mut see = |direction: [f64; 2]| {
        if dot(direction, direction) < nearest.1 {
            nearest = (direction, dot(direction, direction));
        }
    };
    let sides = |ring: &[[f64; 2]]| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]).collect::<Vec<_>>();
    let (ours, theirs) = (sides(here), sides(there));
    for [a, _] in &ours {
        theirs.iter().for_each(|[c, d]| see(to_segment(*a, *c, *d)));
    }
    for [c, _] in &theirs {
        ours.iter().for_each(|[a, b]| see(to_segment(*c, *a, *b).map(|c| -c)));
    }
    let length = nearest.1.sqrt();
    (length > apart && length.is_finite()).then(|| nearest.0.map(|c| c / length))
}
