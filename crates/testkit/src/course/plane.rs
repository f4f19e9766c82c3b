//! Figures of cell decompositions and of proofs.

use super::graphs::scene;
use super::scene::{ROOM, distance, ends, obstacles, shortest, visibility};
use super::{Sketch, solid};
use cplan::Point;
use cplan::view::figure::{Figure, Item, Style};
use cplan_theme::{ACCENT, CHANNEL, FOUND, FREE, GRAY, INFEASIBLE, INK, OCCUPIED, PROOF, UNDECIDED, WHITE};

/// Draws the verticals of a sweep, those trapezoids between them that the taut path passes, and the path.
pub fn trapezoids() -> Figure {
    let mut sketch = Sketch::new(320.0);
    let obstacles = obstacles();
    let (points, edges) = visibility();
    let path = shortest(&points, &edges);
    // The nearest obstacles above and below a point of a vertical.
    let limits = |x: f64, y: f64| {
        let heights = obstacles.iter().flat_map(|polygon| crossings(polygon, x));
        let (mut low, mut high) = (0.0f64, ROOM[1]);
        for height in heights {
            if height <= y - 1e-9 {
                low = low.max(height);
            } else if height >= y + 1e-9 {
                high = high.min(height);
            }
        }
        (low, high)
    };
    let mut corners: Vec<Point> = obstacles.iter().flatten().copied().collect();
    corners.sort_by(|a, b| a.x.total_cmp(&b.x));
    let frame = scene(&mut sketch);
    let stops: Vec<f64> = [0.0].into_iter().chain(corners.iter().map(|p| p.x)).chain([ROOM[0]]).collect();
    for ends in stops.windows(2).filter(|ends| ends[1] - ends[0] > 1e-9) {
        let middle = f64::midpoint(ends[0], ends[1]);
        let Some(y) = height(&path, middle) else { continue };
        // Slightly within the strip, both sides belong to it.
        let sides = [ends[0] + 1e-6, ends[1] - 1e-6].map(|x| (x, along(&path, x, y)));
        let [(a, ya), (b, yb)] = sides;
        let ((la, ha), (lb, hb)) = (limits(a, ya), limits(b, yb));
        let cell = [Point::new(a, la), Point::new(b, lb), Point::new(b, hb), Point::new(a, ha)];
        sketch.polygon(&frame, &cell, Style::fill(CHANNEL).faded(0.7));
    }
    let mut verticals = Vec::new();
    for p in &corners {
        let (low, high) = limits(p.x, p.y);
        let is_free =
            |to: f64| !obstacles.iter().any(|polygon| distance(polygon, Point::new(p.x, f64::midpoint(p.y, to))) < 0.0);
        verticals.extend([low, high].into_iter().filter(|&to| is_free(to)).map(|to| [*p, Point::new(p.x, to)]));
    }
    for polygon in &obstacles {
        sketch.polygon(&frame, polygon, solid(0));
    }
    sketch.segments(&frame, &verticals, Style::line(GRAY, 1.0));
    sketch.path(&frame, &path);
    let [start, goal] = ends();
    sketch.ends(&frame, start, goal);
    sketch.note(
        10.0,
        "At each corner, a vertical up and down to the next side. Yellow: the channel, with its taut path.",
    );
    sketch.figure()
}

/// Returns the heights at which a vertical crosses the outline of a polygon.
fn crossings(polygon: &[Point], x: f64) -> Vec<f64> {
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let cross = |(a, b): (&Point, &Point)| {
        let is_between = (a.x <= x) != (b.x <= x) || a.x == x;
        (is_between && a.x != b.x).then(|| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
    };
    sides.filter_map(cross).collect()
}

/// Returns the height of a path that is monotone in x.
fn height(path: &[Point], x: f64) -> Option<f64> {
    let piece = path.windows(2).find(|ends| (ends[0].x..=ends[1].x).contains(&x))?;
    Some(piece[0].y + (piece[1].y - piece[0].y) * (x - piece[0].x) / (piece[1].x - piece[0].x))
}

/// Returns the height of the path at `x`, or `otherwise` beyond its ends.
fn along(path: &[Point], x: f64, otherwise: f64) -> f64 {
    height(path, x).unwrap_or(otherwise)
}

/// Draws boxes that are free, in collision or undecided, after at most four halvings of each side.
pub fn boxes() -> Figure {
    const DEPTH: u32 = 4;
    let mut sketch = Sketch::new(320.0);
    let frame = Sketch::frame([10.0, 8.0, 700.0, 280.0], (0.0, ROOM[0]), (0.0, ROOM[1]));
    let obstacles = obstacles();
    let mut kinds: [Vec<[Point; 2]>; 3] = Default::default();
    let mut open = vec![([Point::zeros(), Point::new(ROOM[0], ROOM[1])], 0)];
    while let Some(([low, high], depth)) = open.pop() {
        let (middle, half) = ((low + high) / 2.0, (high - low).norm() / 2.0);
        let nearest = obstacles.iter().map(|polygon| distance(polygon, middle)).fold(f64::INFINITY, f64::min);
        if nearest.abs() < half && depth < DEPTH {
            for [i, j] in [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]] {
                let size = high - low;
                let corner = low + Point::new(i * size.x, j * size.y);
                open.push(([corner, corner + size / 2.0], depth + 1));
            }
            continue;
        }
        kinds[if nearest >= half {
            0
        } else if nearest <= -half {
            1
        } else {
            2
        }]
        .push([low, high]);
    }
    for (boxes, color) in kinds.iter().zip([FREE, INFEASIBLE.lighter(0.55), UNDECIDED]) {
        sketch.rectangles(&frame, boxes, Style::line(GRAY, 0.5).filled(color));
    }
    for polygon in &obstacles {
        sketch.polygon(&frame, polygon, Style::line(INK, 1.6));
    }
    sketch.note(
        10.0,
        "Free boxes (green), collision boxes (red), and undecided ones (grey), which would be split further.",
    );
    sketch.figure()
}

/// Draws pieces of a path, each with the disc that its motion bound allows.
pub fn pieces() -> Figure {
    let mut sketch = Sketch::new(320.0);
    let frame = scene(&mut sketch);
    let obstacles = obstacles();
    let path = [[0.7, 1.0], [1.0, 3.1], [4.3, 3.3], [4.3, 0.7], [6.6, 0.75], [6.7, 3.0], [9.3, 3.0]]
        .map(|[x, y]| Point::new(x, y));
    let mut open: Vec<[Point; 2]> = path.windows(2).rev().map(|ends| [ends[0], ends[1]]).collect();
    let mut cuts = vec![path[0]];
    while let Some([a, b]) = open.pop() {
        let middle = (a + b) / 2.0;
        let clearance = obstacles.iter().map(|polygon| distance(polygon, middle)).fold(f64::INFINITY, f64::min);
        if clearance <= (b - a).norm() / 2.0 {
            open.extend([[middle, b], [a, middle]]);
            continue;
        }
        let [x, y] = frame.at(middle.x, middle.y);
        let radius = (b - a).norm() / 2.0 * frame.scale();
        sketch.items.push(Item::Disc([x, y], radius, Style::line(FOUND, 1.2).filled(FREE).faded(0.7)));
        cuts.push(b);
    }
    sketch.path(&frame, &path);
    for p in cuts {
        sketch.dot(&frame, p, 2.8, Style::line(WHITE, 0.8).filled(INK));
    }
    sketch.ends(&frame, path[0], path[path.len() - 1]);
    sketch.note(
        10.0,
        "No point moves farther from the middle of a piece than its disc. Near obstacles, the pieces are shorter.",
    );
    sketch.figure()
}

/// Draws two joint spaces of continuous joints. With one wall, a path leads around it; two walls leave none.
pub fn torus() -> Figure {
    let mut sketch = Sketch::new(280.0);
    let [start, goal] = [Point::new(0.25, 0.5), Point::new(0.75, 0.5)];
    let wall = |x: f64| -> Vec<[Point; 2]> {
        let cell = |k: i32| [Point::new(x - 0.035, f64::from(k) / 8.0), Point::new(x + 0.035, f64::from(k + 1) / 8.0)];
        (0..8).map(cell).collect()
    };
    for (left, walls, heading) in [(90.0, &[0.5][..], "one wall"), (410.0, &[0.035, 0.5], "two walls")] {
        let frame = Sketch::frame([left, 34.0, 210.0, 210.0], (0.0, 1.0), (0.0, 1.0));
        sketch.heading(left, heading);
        sketch.rectangles(
            &frame,
            &[[Point::zeros(), Point::new(1.0, 1.0)]],
            Style::line(GRAY, 1.2).filled(OCCUPIED.lighter(0.6)),
        );
        for &x in walls {
            sketch.rectangles(&frame, &wall(x), Style::line(PROOF, 1.2).filled(PROOF.lighter(0.6)));
        }
        if walls.len() == 1 {
            // Leaves on the left, and enters on the right.
            sketch.line(&frame, &[start, Point::new(0.0, 0.5)], Style::line(ACCENT, 2.8));
            sketch.line(&frame, &[Point::new(1.0, 0.5), goal], Style::line(ACCENT, 2.8));
        }
        sketch.ends(&frame, start, goal);
    }
    sketch.note(90.0, "The left side is the right side: one wall of collision boxes leaves the way around.");
    sketch.figure()
}
