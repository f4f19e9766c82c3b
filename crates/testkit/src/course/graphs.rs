//! Figures of roadmaps in one scene.

use super::scene::{ROOM, distance, ends, obstacles, sees, shortest, visibility as visible};
use super::{Sketch, solid};
use cplan::Point;
use cplan::view::Frame;
use cplan::view::figure::{Figure, Style};
use cplan_theme::{ACCENT, GRAY, INK, WHITE};

/// Draws the scene, and returns the frame.
pub fn scene(sketch: &mut Sketch) -> Frame {
    let frame = Sketch::frame([10.0, 8.0, 700.0, 280.0], (0.0, ROOM[0]), (0.0, ROOM[1]));
    sketch.rectangles(&frame, &[[Point::zeros(), Point::new(ROOM[0], ROOM[1])]], Style::line(GRAY, 1.2));
    for corners in obstacles() {
        sketch.polygon(&frame, &corners, solid(0));
    }
    frame
}

/// Draws the visibility graph, and the shortest path in it.
pub fn visibility() -> Figure {
    let mut sketch = Sketch::new(320.0);
    let frame = scene(&mut sketch);
    let (points, edges) = visible();
    let segments: Vec<[Point; 2]> = edges.iter().map(|&[i, j]| [points[i], points[j]]).collect();
    sketch.segments(&frame, &segments, Style::line(GRAY, 0.8));
    sketch.path(&frame, &shortest(&points, &edges));
    let [start, goal] = ends();
    sketch.ends(&frame, start, goal);
    sketch.note(10.0, "Corners that see each other are joined. The shortest path bends only at corners.");
    sketch.figure()
}

/// Draws the points that are equally far from the two nearest parts of the boundary.
pub fn voronoi() -> Figure {
    /// Side of a cell, in which the curve counts as straight.
    const STEP: f64 = 0.2;
    let mut sketch = Sketch::new(320.0);
    let frame = scene(&mut sketch);
    let obstacles = obstacles();
    // The lower and the left side of the room form one part, the upper and the right one another.
    let distances = |p: Point| -> Vec<f64> {
        let walls = [p.x.min(p.y), (ROOM[0] - p.x).min(ROOM[1] - p.y)];
        obstacles.iter().map(|polygon| distance(polygon, p)).chain(walls).collect()
    };
    let mut segments = Vec::new();
    let [columns, rows] = ROOM.map(|side| (side / STEP).round() as usize);
    for i in 0..columns {
        for j in 0..rows {
            let corners =
                [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| Point::new((i + u) as f64 * STEP, (j + v) as f64 * STEP));
            let values = corners.map(distances);
            let nearest = |k: usize| (0..values[k].len()).min_by(|&a, &b| values[k][a].total_cmp(&values[k][b]));
            let found: Vec<usize> = (0..4).filter_map(nearest).collect();
            let Some(&other) = found.iter().find(|&&site| site != found[0]) else { continue };
            let f = |k: usize| values[k][found[0]] - values[k][other];
            let crossing = |k: usize| {
                let l = (k + 1) % 4;
                ((f(k) < 0.0) != (f(l) < 0.0)).then(|| corners[k] + (corners[l] - corners[k]) * (f(k) / (f(k) - f(l))))
            };
            let ends: Vec<Point> = (0..4).filter_map(crossing).collect();
            if let [a, b] = ends[..]
                && distances(a).iter().all(|d| *d > 0.0)
            {
                segments.push([a, b]);
            }
        }
    }
    sketch.segments(&frame, &segments, Style::line(WHITE, 5.0));
    sketch.segments(&frame, &segments, Style::line(ACCENT, 2.4));
    let [start, goal] = ends();
    sketch.ends(&frame, start, goal);
    sketch.note(10.0, "Each point of the curves is equally far from two parts of the boundary.");
    sketch.figure()
}

/// Draws random points, each joined to the nearest points that it sees.
pub fn probabilistic() -> Figure {
    const COUNT: usize = 60;
    const NEIGHBORS: usize = 4;
    let mut sketch = Sketch::new(320.0);
    let frame = scene(&mut sketch);
    let obstacles = obstacles();
    let mut points = ends().to_vec();
    // Halton's sequence: evenly spread, and the same on every machine.
    let halton = |mut k: usize, base: usize| {
        let (mut value, mut share) = (0.0, 1.0);
        while k > 0 {
            share /= base as f64;
            value += share * (k % base) as f64;
            k /= base;
        }
        value
    };
    let samples = (1..=COUNT).map(|k| Point::new(ROOM[0] * halton(k, 2), ROOM[1] * halton(k, 3)));
    points.extend(samples.filter(|&p| obstacles.iter().all(|polygon| distance(polygon, p) > 0.0)));
    let mut edges = Vec::new();
    for i in 0..points.len() {
        let mut others: Vec<usize> =
            (0..points.len()).filter(|&j| j != i && sees(&obstacles, points[i], points[j])).collect();
        others.sort_by(|&a, &b| (points[a] - points[i]).norm().total_cmp(&(points[b] - points[i]).norm()));
        edges.extend(others.into_iter().take(NEIGHBORS).map(|j| [i.min(j), i.max(j)]));
    }
    edges.sort_unstable();
    edges.dedup();
    let segments: Vec<[Point; 2]> = edges.iter().map(|&[i, j]| [points[i], points[j]]).collect();
    sketch.segments(&frame, &segments, Style::line(GRAY, 0.8));
    sketch.path(&frame, &shortest(&points, &edges));
    for &p in &points[2..] {
        sketch.dot(&frame, p, 2.6, Style::fill(INK));
    }
    let [start, goal] = ends();
    sketch.ends(&frame, start, goal);
    sketch
        .note(10.0, "Each sample is joined to the nearest four that it sees. The path is the shortest in this graph.");
    sketch.figure()
}
