//! Figures of C-obstacles: contact angles, and Minkowski differences.

use super::{Sketch, solid};
use cplan::Point;
use cplan::view::figure::{Figure, Style};
use cplan_theme::{ACCENT, GHOST, GRAY, INFEASIBLE, INK, PALE, WHITE, obstacle};

/// Distance of the corner from the elbow, angle of the corner at the elbow, and distance of the side from the elbow.
const CORNER: (f64, f64, f64) = (1.2, 0.21, 0.8);

/// Draws the contact angles of the two front corners of a link with one side of an obstacle. The link is blocked between the
/// outer ones; at the inner ones, the other corner is already inside.
pub fn slice() -> Figure {
    let (r, alpha, d) = CORNER;
    let mut sketch = Sketch::new(300.0);
    let left = Sketch::frame([10.0, 34.0, 290.0, 236.0], (-0.5, 1.6), (-1.25, 1.25));
    let right = Sketch::frame([360.0, 34.0, 340.0, 236.0], (-1.9, 1.9), (-1.3, 1.35));
    sketch.heading(10.0, "corners of link 2, and a side");
    sketch.heading(340.0, "distance of each corner from the elbow's line");
    sketch.polygon(&left, &[[d, -1.2], [1.5, -1.2], [1.5, 1.2], [d, 1.2]].map(point), solid(0));
    let contact = (d / r).acos();
    // One corner touches at the outer angle; the other one has the opposite angle at the elbow.
    for (turn, fill) in [(contact + alpha, WHITE), (contact - alpha, GHOST), (-contact - alpha, WHITE)] {
        let (length, half) = (r * alpha.cos(), r * alpha.sin());
        let corners = [[-0.12, -half], [length, -half], [length, half], [-0.12, half]].map(point);
        let turned = corners.map(|p| rotated(p, turn));
        sketch.polygon(
            &left,
            &turned,
            Style::line(if fill == GHOST { PALE } else { INK }, 1.4).filled(fill).faded(0.85),
        );
    }
    let arc: Vec<Point> = (-40..=40).map(|k| polar(r, f64::from(k) / 40.0 * 1.35)).collect();
    sketch.line(&left, &arc, Style::line(GRAY, 1.0).dashed(&[4.0, 3.0]));
    sketch.line(&left, &[Point::zeros(), polar(r, -contact)], Style::line(ACCENT, 1.6));
    sketch.line(&left, &[Point::zeros(), Point::new(d, 0.0)], Style::line(INFEASIBLE, 1.6));
    sketch.dot(&left, Point::zeros(), 4.5, Style::fill(INK));
    for turn in [contact, -contact] {
        sketch.dot(&left, polar(r, turn), 4.5, Style::line(WHITE, 1.2).filled(INFEASIBLE));
    }
    let [x, y] = left.at(d / 2.0, 0.0);
    sketch.bold([x, y - 6.0], "d", INFEASIBLE);
    let [x, y] = left.at(0.3, -0.55);
    sketch.bold([x - 8.0, y], "r", ACCENT);

    let limit = contact + alpha;
    let bottom = -1.2;
    sketch.rectangles(
        &right,
        &[[Point::new(-limit, bottom), Point::new(limit, d)]],
        Style::fill(obstacle(0)).faded(0.25),
    );
    sketch.line(&right, &[Point::new(-1.9, bottom), Point::new(1.9, bottom)], Style::line(GRAY, 1.2));
    sketch.line(&right, &[Point::new(-1.9, d), Point::new(1.9, d)], Style::line(INFEASIBLE, 1.6));
    for (shift, style) in [(alpha, Style::line(ACCENT, 2.2)), (-alpha, Style::line(ACCENT, 2.2).dashed(&[6.0, 4.0]))] {
        let curve: Vec<Point> =
            (-38..=38).map(|k| f64::from(k) / 20.0).map(|phi| Point::new(phi, r * (phi + shift).cos())).collect();
        sketch.line(&right, &curve, style);
        for sign in [-1.0, 1.0] {
            let phi = sign * contact - shift;
            let is_limit = (phi.abs() - limit).abs() < 1e-9;
            sketch.dot(
                &right,
                Point::new(phi, d),
                4.5,
                Style::line(INFEASIBLE, 1.6).filled(if is_limit { INFEASIBLE } else { WHITE }),
            );
        }
    }
    let [x, y] = right.at(-1.75, d);
    sketch.bold([x, y - 6.0], "d", INFEASIBLE);
    let [x, y] = right.at(0.0, 0.0);
    sketch.text([x, y + 22.0], "blocked angles \u{3c6}", INK);
    let [x, y] = right.at(1.45, -0.8);
    sketch.bold([x, y], "r cos(\u{3c6} \u{2212} \u{3b1})", ACCENT);
    let [x, y] = right.at(-1.45, -0.8);
    sketch.bold([x, y], "r cos(\u{3c6} + \u{3b1})", ACCENT);
    sketch.note(10.0, "Filled: limits of the blocked angles. Hollow: there, the other corner is already inside.");
    sketch.figure()
}

/// Draws the sides of B and of the mirrored A, ordered by direction, and the difference that they enclose.
pub fn minkowski() -> Figure {
    let (a, b) = pair();
    let mirrored: Vec<Point> = a.iter().map(|p| -p).collect();
    let mut sketch = Sketch::new(270.0);
    let left = Sketch::frame([10.0, 34.0, 330.0, 200.0], (-1.05, 1.55), (-0.75, 0.85));
    let right = Sketch::frame([380.0, 34.0, 330.0, 200.0], (-1.05, 1.55), (-0.75, 0.85));
    sketch.heading(10.0, "\u{2212}A and B");
    sketch.heading(380.0, "B \u{2296} A: their sides, by direction");
    let [blue, orange] = [ACCENT, obstacle(1)].map(|color| Style::line(color, 3.0));
    sketch.polygon(&left, &mirrored, Style::fill(ACCENT).faded(0.18));
    sketch.polygon(&left, &b, Style::fill(obstacle(1)).faded(0.3));
    let sides = sorted_sides(&a, &b);
    let mut at = lowest(&b) + lowest(&mirrored);
    let corners: Vec<Point> = sides
        .iter()
        .map(|(side, _)| {
            at += side;
            at
        })
        .collect();
    sketch.polygon(&right, &corners, Style::fill(PALE).faded(0.35));
    for (polygon, style) in [(&mirrored, blue), (&b, orange)] {
        sketch.polygon(&left, polygon, style);
    }
    let mut from = corners[corners.len() - 1];
    for (k, (&to, (side, is_of_a))) in corners.iter().zip(&sides).enumerate() {
        sketch.line(&right, &[from, to], if *is_of_a { blue } else { orange });
        // The number is outside, to the right of the side's direction.
        let out = Point::new(side.y, -side.x);
        let length = out.x.hypot(out.y);
        let [x, y] = right.at(
            f64::midpoint(from.x, to.x) + 0.12 * out.x / length,
            f64::midpoint(from.y, to.y) + 0.12 * out.y / length,
        );
        sketch.text([x, y + 5.0], (k + 1).to_string(), INK);
        from = to;
    }
    for frame in [&left, &right] {
        sketch.dot(frame, Point::zeros(), 4.0, Style::fill(INK));
    }
    sketch.note(
        10.0,
        "A meets B exactly where A\u{2019}s origin (dot) is in B \u{2296} A. One sweep round the circle of directions.",
    );
    sketch.figure()
}

/// Draws the differences of a block and a turning link, one above the other.
pub fn turning() -> Figure {
    let link = [[-0.1, -0.08], [0.6, -0.08], [0.6, 0.08], [-0.1, 0.08]].map(point);
    let block = [[-0.35, -0.35], [0.35, -0.35], [0.35, 0.35], [-0.35, 0.35]].map(point);
    let mut sketch = Sketch::new(330.0);
    let frame = Sketch::frame([150.0, 10.0, 420.0, 280.0], (-1.6, 1.6), (-0.6, 1.55));
    let oblique = |p: Point, height: f64| Point::new(p.x + 0.35 * p.y, 0.45 * p.y + height);
    for k in 0..=6 {
        let share = f64::from(k) / 6.0;
        let turned = link.map(|p| rotated(p, share * std::f64::consts::FRAC_PI_2));
        let mut at = lowest(&block) + lowest(&turned.map(|p| -p));
        let corners: Vec<Point> = sorted_sides(&turned, &block)
            .iter()
            .map(|(side, _)| {
                at += side;
                oblique(at, 1.1 * share)
            })
            .collect();
        sketch.polygon(
            &frame,
            &corners,
            Style::line(obstacle(1).darker(0.25), 1.3).filled(obstacle(1).lighter(0.6 - 0.4 * share)).faded(0.85),
        );
        if k % 3 == 0 {
            let [x, y] = frame.at(1.35, 1.1 * share);
            sketch.text([x, y + 5.0], format!("\u{3b8} = {}\u{b0}", 15 * k), GRAY);
            // The link at that angle, next to its section.
            let small = turned.map(|p| Point::new(0.45 * p.x - 1.35, 0.45 * p.y + 1.1 * share));
            sketch.polygon(&frame, &small, Style::line(INK, 1.2).filled(WHITE));
        }
    }
    sketch.note(60.0, "One difference for each angle \u{3b8} of the link (left). The C-obstacle is the stack of all.");
    sketch.figure()
}

/// Returns a triangle and a trapezium.
fn pair() -> (Vec<Point>, Vec<Point>) {
    let a = [[0.0, 0.0], [0.6, 0.1], [0.2, 0.5]].map(point).to_vec();
    let b = [[0.0, 0.0], [0.9, 0.0], [0.75, 0.55], [0.1, 0.45]].map(point).to_vec();
    (a, b)
}

/// Returns the sides of `b` and of the mirrored `a` by direction, beginning with that of the positive x axis. The flag is true
/// for sides of `a`.
fn sorted_sides(a: &[Point], b: &[Point]) -> Vec<(Point, bool)> {
    let side = |corners: &[Point], i: usize| corners[(i + 1) % corners.len()] - corners[i];
    let mirrored = (0..a.len()).map(|i| (-side(a, i), true));
    let mut sides: Vec<_> = mirrored.chain((0..b.len()).map(|i| (side(b, i), false))).collect();
    let direction = |v: &Point| v.y.atan2(v.x).rem_euclid(std::f64::consts::TAU);
    sides.sort_by(|(v, _), (w, _)| direction(v).total_cmp(&direction(w)));
    sides
}

/// Returns the lowest corner of a convex polygon. From it on, the directions of the sides increase.
fn lowest(corners: &[Point]) -> Point {
    let lower = |p: &&Point, q: &&Point| p.y.total_cmp(&q.y).then(p.x.total_cmp(&q.x));
    *corners.iter().min_by(lower).expect("a polygon has corners")
}

fn point([x, y]: [f64; 2]) -> Point {
    Point::new(x, y)
}

fn polar(r: f64, angle: f64) -> Point {
    Point::new(r * angle.cos(), r * angle.sin())
}

fn rotated(p: Point, angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)
}
