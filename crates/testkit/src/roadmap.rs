//! Scenes for planners with roadmaps, and checks of their answers that share no code with the planners.

use cplan::cspace::{PolygonWithHoles, Proves, Regions};
use cplan::geometry::{Point, segments_cross};
use cplan::space::{Configuration, JointRange, Metric, Path, Topology};
use cplan_cases::dice::Dice;

/// Returns free space over a window of two intervals.
pub fn regions(window: [(f64, f64); 2], free: Vec<PolygonWithHoles>) -> Regions {
    let axes = window.map(|(lower, upper)| JointRange::Interval { lower, upper });
    Regions { topology: Topology::new(axes), proves: Proves::Exact, window, obstacles: Vec::new(), free }
}

/// Returns points from pairs of coordinates.
pub fn points(corners: &[(f64, f64)]) -> Vec<Point> {
    corners.iter().map(|&(x, y)| Point::new(x, y)).collect()
}

/// Returns a rectangle, counter-clockwise.
pub fn rectangle(x: (f64, f64), y: (f64, f64)) -> Vec<Point> {
    points(&[(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1)])
}

/// Returns a rectangular window with holes, which are counter-clockwise, within the window and disjoint.
pub fn window_with_holes(x: (f64, f64), y: (f64, f64), holes: Vec<Vec<Point>>) -> Regions {
    let reversed = holes.into_iter().map(|hole| hole.into_iter().rev().collect()).collect();
    regions([x, y], vec![PolygonWithHoles { outer: rectangle(x, y), holes: reversed }])
}

/// Returns `side * side` disjoint convex polygons with `corners` corners each, within `[0, side]^2`.
pub fn convex_crowd(random: &mut Dice, side: usize, corners: usize) -> Vec<Vec<Point>> {
    let mut crowd = Vec::new();
    for i in 0..side {
        for j in 0..side {
            let radius = random.within(0.15, 0.35);
            let [x, y] = [i, j].map(|k| k as f64 + 0.5 + random.within(-0.1, 0.1));
            // One corner in each of equal parts of the circle, so that every polygon contains its centre.
            let part = std::f64::consts::TAU / corners as f64;
            let angles = (0..corners).map(|k| part * (k as f64 + random.within(0.05, 0.95)));
            crowd.push(angles.map(|a| Point::new(x + radius * a.cos(), y + radius * a.sin())).collect());
        }
    }
    crowd
}

/// Returns `count` disjoint star-shaped polygons with ten corners each. Most of them are not convex. Their sizes and places
/// are random, in a window of `count` unit squares. They fill about 23 % of it.
pub fn star_crowd(random: &mut Dice, count: usize) -> Regions {
    let columns = (count as f64).sqrt().ceil() as usize;
    let rows = count.div_ceil(columns);
    let stars = (0..count).map(|k| {
        let size = random.within(0.25, 0.49);
        let [x, y] = [k % columns, k / columns].map(|k| k as f64 + random.within(size, 1.0 - size));
        let angle = |k: usize, random: &mut Dice| (k as f64 + random.within(0.05, 0.95)) * std::f64::consts::TAU / 10.0;
        let corner = |k: usize| {
            let (a, r) = (angle(k, random), size * random.within(0.55, 1.0));
            Point::new(x + r * a.cos(), y + r * a.sin())
        };
        (0..10).map(corner).collect()
    });
    let stars = stars.collect();
    window_with_holes((-0.25, columns as f64 + 0.25), (-0.25, rows as f64 + 0.25), stars)
}

/// Returns free space: a window slightly larger than the crowd, with the crowd as holes.
pub fn crowd_regions(side: usize, crowd: &[Vec<Point>]) -> Regions {
    let window = (-0.25, side as f64 + 0.25);
    window_with_holes(window, window, crowd.to_vec())
}

/// The free unit squares of a board. As regions, they have many collinear sides, equal abscissae and touching corners.
pub struct Board {
    /// Number of squares along a side.
    pub size: usize,
    /// For each square, column by column, true if it is free.
    pub free: Vec<bool>,
}

impl Board {
    /// Returns a board on which about this share of the squares is blocked.
    pub fn random(random: &mut Dice, size: usize, density: f64) -> Self {
        Self { size, free: (0..size * size).map(|_| random.within(0.0, 1.0) >= density).collect() }
    }

    /// Returns true if a square is on the board and free.
    pub fn is_free(&self, x: i32, y: i32) -> bool {
        let inside = |k: i32| (0..self.size as i32).contains(&k);
        inside(x) && inside(y) && self.free[x as usize * self.size + y as usize]
    }

    /// Returns the 4-connected component of every square, by flood fill.
    pub fn components(&self) -> Vec<Option<usize>> {
        let n = self.size as i32;
        let mut component = vec![None; self.free.len()];
        let mut count = 0;
        for seed in 0..self.free.len() {
            let mut stack = vec![(seed as i32 / n, seed as i32 % n)];
            let mut found = false;
            while let Some((x, y)) = stack.pop() {
                if self.is_free(x, y) && component[(x * n + y) as usize].is_none() {
                    component[(x * n + y) as usize] = Some(count);
                    found = true;
                    stack.extend([(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]);
                }
            }
            count += usize::from(found);
        }
        component
    }

    /// Returns the free squares as polygons, mapped by the integer matrix `map` (of positive determinant). Where two squares of
    /// one component touch only in a corner, `link` decides whether a contour continues along the other square.
    pub fn regions(&self, map: [[i32; 2]; 2], mut link: impl FnMut() -> bool) -> Regions {
        let n = self.size as i32;
        let component = self.components();
        let of = |x: i32, y: i32| if self.is_free(x, y) { component[(x * n + y) as usize] } else { None };
        // Unit steps with the free square on their left.
        let left_square = |(x, y): (i32, i32), (dx, dy): (i32, i32)| (x + (dx - dy - 1) / 2, y + (dx + dy - 1) / 2);
        let right_square = |(x, y): (i32, i32), (dx, dy): (i32, i32)| (x + (dx + dy - 1) / 2, y + (dy - dx - 1) / 2);
        let is_side = |p: (i32, i32), d: (i32, i32)| {
            let ((a, b), (c, d)) = (left_square(p, d), right_square(p, d));
            of(a, b).is_some() && of(c, d).is_none()
        };
        let mut free: Vec<PolygonWithHoles> = Vec::new();
        free.resize(
            component.iter().flatten().max().map_or(0, |k| k + 1),
            PolygonWithHoles { outer: vec![], holes: vec![] },
        );
        let mut used = std::collections::BTreeSet::new();
        let mut linked = std::collections::BTreeMap::new();
        for x in 0..=n {
            for y in 0..=n {
                for d in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
                    if !is_side((x, y), d) || used.contains(&((x, y), d)) {
                        continue;
                    }
                    let (mut at, mut step, mut contour) = ((x, y), d, Vec::new());
                    let (sx, sy) = left_square(at, step);
                    let Some(polygon) = of(sx, sy) else { continue };
                    while used.insert((at, step)) {
                        contour.push(at);
                        at = (at.0 + step.0, at.1 + step.1);
                        let (left, right) = ((-step.1, step.0), (step.1, -step.0));
                        let (ox, oy) = left_square(at, right);
                        let pinch = is_side(at, left) && is_side(at, right) && !is_side(at, step);
                        let goes_on =
                            pinch && of(ox, oy) == Some(polygon) && *linked.entry(at).or_insert_with(&mut link);
                        step = *[left, step, right].iter().find(|s| is_side(at, **s)).unwrap_or(&step);
                        if goes_on {
                            step = right;
                        }
                    }
                    let area: i32 = (0..contour.len())
                        .map(|k| (contour[k], contour[(k + 1) % contour.len()]))
                        .map(|(p, q)| p.0 * q.1 - p.1 * q.0)
                        .sum();
                    let contour = contour.iter().map(|&p| mapped(map, f64::from(p.0), f64::from(p.1))).collect();
                    if area > 0 {
                        free[polygon].outer = contour;
                    } else {
                        free[polygon].holes.push(contour);
                    }
                }
            }
        }
        let corners = [(0, 0), (n, 0), (0, n), (n, n)].map(|(x, y)| mapped(map, f64::from(x), f64::from(y)));
        let range = |k: usize| {
            let values = corners.map(|p| p[k]);
            (values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max))
        };
        regions([range(0), range(1)], free)
    }
}

/// Maps a board point by an integer matrix.
pub fn mapped(map: [[i32; 2]; 2], x: f64, y: f64) -> Point {
    let row = |k: usize| f64::from(map[k][0]) * x + f64::from(map[k][1]) * y;
    Point::new(row(0), row(1))
}

/// Returns all contours of free space.
pub fn contours(regions: &Regions) -> impl Iterator<Item = &Vec<Point>> {
    regions.free.iter().flat_map(|p| std::iter::once(&p.outer).chain(&p.holes))
}

/// Returns all sides of free space.
pub fn sides(regions: &Regions) -> Vec<(Point, Point)> {
    contours(regions).flat_map(|c| (0..c.len()).map(|k| (c[k], c[(k + 1) % c.len()]))).collect()
}

/// Returns the area of free space (shoelace formula).
pub fn area(contours: impl IntoIterator<Item = Vec<Point>>) -> f64 {
    let twice = |c: &Vec<Point>| -> f64 {
        (0..c.len()).map(|k| (c[k], c[(k + 1) % c.len()])).map(|(p, q)| p.x * q.y - p.y * q.x).sum()
    };
    contours.into_iter().map(|c| twice(&c) / 2.0).sum()
}

/// Returns all arcs of the reduced visibility graph of obstacles in general position, each with its left end first, by plain
/// arithmetic.
pub fn bitangents(regions: &Regions) -> Vec<[Configuration; 2]> {
    let turn = |a: Point, b: Point, c: Point| (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    let sides = sides(regions);
    let neighbours = |c: &Vec<Point>, k: usize| (c[(k + c.len() - 1) % c.len()], c[k], c[(k + 1) % c.len()]);
    let corners: Vec<_> = contours(regions).flat_map(|c| (0..c.len()).map(|k| neighbours(c, k))).collect();
    // Free space is to the left of a contour, so a convex corner of an obstacle is a right turn.
    let convex: Vec<_> = corners.into_iter().filter(|&(a, b, c)| turn(a, b, c) < 0.0).collect();
    let tangent =
        |(a, b, c): (Point, Point, Point), p: Point| p == a || p == c || (turn(p, b, a) > 0.0) == (turn(p, b, c) > 0.0);
    let mut arcs = Vec::new();
    for (i, &c) in convex.iter().enumerate() {
        for &d in &convex[..i] {
            let apart = |&(a, b): &(Point, Point)| {
                let ends = [a, b].map(|end| end == c.1 || end == d.1);
                let crosses = (turn(a, b, c.1) > 0.0) != (turn(a, b, d.1) > 0.0)
                    && (turn(c.1, d.1, a) > 0.0) != (turn(c.1, d.1, b) > 0.0);
                ends.contains(&true) || !crosses
            };
            if tangent(c, d.1) && tangent(d, c.1) && sides.iter().all(apart) {
                let ends = if (c.1.x, c.1.y) < (d.1.x, d.1.y) { [c.1, d.1] } else { [d.1, c.1] };
                arcs.push(ends);
            }
        }
    }
    arcs
}

/// Returns true if `p` is in free space or within 1e-9 of it, by winding angles and distances in plain floats.
pub fn is_nearly_free(sides: &[(Point, Point)], p: Point) -> bool {
    let winding: f64 = sides
        .iter()
        .map(|(a, b)| {
            let (u, v) = (a - p, b - p);
            (u.x * v.y - u.y * v.x).atan2(u.dot(&v))
        })
        .sum();
    winding.abs() > std::f64::consts::PI || sides.iter().any(|(a, b)| distance(p, *a, *b) < 1e-9)
}

/// Returns the distance of a point and a segment.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
    (p - (a + (b - a) * t)).norm()
}

/// Panics unless the path stays in closed free space: no piece of it crosses a side properly, and no point of a dense sampling is
/// in an obstacle.
pub fn assert_free(regions: &Regions, path: &Path) {
    let sides = sides(regions);
    let samples = 50;
    for (a, b) in path.segments() {
        for (c, d) in &sides {
            assert!(!segments_cross(a, b, *c, *d), "{a} {b} crosses {c} {d}");
        }
        for k in 0..=samples {
            let p = a + (b - a) * (f64::from(k) / f64::from(samples));
            assert!(is_nearly_free(&sides, p), "{p} between {a} and {b} is in an obstacle");
        }
    }
}

/// Returns the length of the shortest path among open convex obstacles (counter-clockwise) within a window, by brute force: all
/// pairs of all corners are clipped against all obstacles; then Dijkstra's algorithm runs on the full matrix.
pub fn brute_force_length(obstacles: &[Vec<Point>], window: (f64, f64), start: Point, goal: Point) -> Option<f64> {
    brute_force(obstacles, window, start, goal, Metric::Euclidean)
}

/// Returns the length of the shortest path in any metric, by the same brute force.
pub fn brute_force(
    obstacles: &[Vec<Point>],
    window: (f64, f64),
    start: Point,
    goal: Point,
    metric: Metric,
) -> Option<f64> {
    let inside_window = |p: &Point| p.iter().all(|v| (window.0..=window.1).contains(v));
    let mut nodes = vec![start, goal];
    nodes.extend(obstacles.iter().flatten().copied().filter(inside_window));
    let mut length = vec![f64::INFINITY; nodes.len()];
    let mut done = vec![false; nodes.len()];
    length[0] = 0.0;
    while let Some(i) = (0..nodes.len()).filter(|&i| !done[i]).min_by(|&i, &j| length[i].total_cmp(&length[j])) {
        if length[i].is_infinite() || i == 1 {
            break;
        }
        done[i] = true;
        for j in 0..nodes.len() {
            let through = length[i] + metric.norm(nodes[j] - nodes[i]);
            if through < length[j] && !obstacles.iter().any(|o| enters(o, nodes[i], nodes[j])) {
                length[j] = through;
            }
        }
    }
    length[1].is_finite().then_some(length[1])
}

/// Returns true if a segment enters a convex polygon by more than rounding errors (Cyrus and Beck's clipping).
fn enters(polygon: &[Point], p: Point, q: Point) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..polygon.len() {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let along = (b - a).normalize();
        let depth = |v: Point| along.x * (v.y - a.y) - along.y * (v.x - a.x) - 1e-10;
        let (d, e) = (depth(p), depth(q));
        if d <= 0.0 && e <= 0.0 {
            return false;
        } else if d < 0.0 {
            from = from.max(d / (d - e));
        } else if e < 0.0 {
            to = to.min(d / (d - e));
        }
    }
    from < to
}
