//! Figures of tasks.

use super::{Sketch, solid};
use cplan::Point;
use cplan::view::figure::{Figure, Style};
use cplan_theme::{ACCENT, GRAY, INK, PALE, WHITE, obstacle};

/// Lengths of both links, and positions of the tip in the order of the steps.
const LINKS: [f64; 2] = [1.0, 0.8];
const PLACES: [(&str, [f64; 2]); 4] =
    [("start", [1.6, 0.2]), ("pick", [0.9, 0.9]), ("place", [-0.3, 1.3]), ("rest", [0.5, 1.5])];

/// Returns both IK solutions for a position, elbow down and elbow up, as joint angles.
fn solve([x, y]: [f64; 2]) -> [[f64; 2]; 2] {
    let [a, b] = LINKS;
    let elbow = ((x * x + y * y - a * a - b * b) / (2.0 * a * b)).clamp(-1.0, 1.0).acos();
    [elbow, -elbow].map(|elbow| [y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos()), elbow])
}

/// Draws the IK solutions of each step as a graph, whose edges have the turn of the joint that turns more, and the best sequence.
pub fn solutions() -> Figure {
    let columns: Vec<[[f64; 2]; 2]> = PLACES.iter().map(|(_, place)| solve(*place)).collect();
    let turn = |p: [f64; 2], q: [f64; 2]| (0..2).map(|k| (q[k] - p[k]).abs()).fold(0.0, f64::max);
    // At the start, only one IK solution counts: that of the arm.
    let mut best: Vec<[(f64, usize); 2]> = vec![[(0.0, 0), (f64::INFINITY, 0)]];
    for pair in columns.windows(2) {
        let before = best[best.len() - 1];
        let through = |to: usize, from: usize| before[from].0 + turn(pair[0][from], pair[1][to]);
        best.push(
            [0, 1].map(|to| if through(to, 0) <= through(to, 1) { (through(to, 0), 0) } else { (through(to, 1), 1) }),
        );
    }
    let last = best.len() - 1;
    let mut chosen = vec![usize::from(best[last][1].0 < best[last][0].0)];
    for step in (1..=last).rev() {
        chosen.push(best[step][chosen[chosen.len() - 1]].1);
    }
    chosen.reverse();

    let mut sketch = Sketch::new(300.0);
    let frame = Sketch::frame([60.0, 40.0, 600.0, 200.0], (0.0, 3.0), (0.0, 1.0));
    let at = |step: usize, solution: usize| Point::new(step as f64, 1.0 - solution as f64);
    for (step, pair) in columns.windows(2).enumerate() {
        for (from, to) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            if step == 0 && from == 1 {
                continue;
            }
            let is_chosen = chosen[step] == from && chosen[step + 1] == to;
            let style = if is_chosen { Style::line(ACCENT, 3.0) } else { Style::line(PALE, 1.4) };
            let (a, b) = (at(step, from), at(step + 1, to));
            sketch.line(&frame, &[a, b], style);
            let p = a + (b - a) * if from == to { 0.5 } else { 0.27 };
            let [x, y] = frame.at(p.x, p.y);
            let text = format!("{:.0}\u{b0}", turn(pair[0][from], pair[1][to]).to_degrees());
            sketch.text([x, y - 7.0], text, if is_chosen { INK } else { GRAY });
        }
    }
    for (step, (name, _)) in PLACES.iter().enumerate() {
        for solution in 0..if step == 0 { 1 } else { 2 } {
            sketch.dot(
                &frame,
                at(step, solution),
                9.0,
                Style::line(INK, 1.6).filled(if chosen[step] == solution { ACCENT } else { WHITE }),
            );
        }
        let [x, y] = frame.at(step as f64, 0.0);
        sketch.bold([x, y + 30.0], *name, INK);
    }
    for (name, y, by) in [("elbow down", 1.0, -20.0), ("elbow up", 0.0, 5.0)] {
        let [x, y] = frame.at(0.0, y);
        sketch.text([x, y + by], name, GRAY);
    }
    let total = best[last][chosen[last]].0.to_degrees();
    sketch.note(10.0, &format!("Two IK solutions per place; on each edge, the larger turn of the two joints. Blue: the least sum, {total:.0}\u{b0}."));
    sketch.figure()
}

/// Draws a gripper on a gantry before and after it takes a block, each with the C-obstacle of the same wall.
pub fn payload() -> Figure {
    let wall = [[1.2, 0.0], [1.5, 0.0], [1.5, 0.9], [1.2, 0.9]];
    let gripper = [[-0.12, 0.0], [0.12, 0.0], [0.12, 0.25], [-0.12, 0.25]];
    let block = [[-0.25, -0.3], [0.25, -0.3], [0.25, 0.0], [-0.25, 0.0]];
    let mut sketch = Sketch::new(280.0);
    for (left, parts, heading) in
        [(10.0, &[gripper][..], "empty-handed"), (370.0, &[gripper, block], "carrying the block")]
    {
        let frame = Sketch::frame([left, 34.0, 340.0, 210.0], (0.0, 2.2), (0.0, 1.36));
        sketch.heading(left, heading);
        // The positions of the gripper's origin at which a part meets the wall. All sides are parallel, so they are sums of
        // intervals.
        let shadows: Vec<[Point; 2]> = parts
            .iter()
            .map(|part| {
                let range = |all: &[[f64; 2]; 4], k: usize| {
                    all.iter().map(|p| p[k]).fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)))
                };
                let side = |k: usize| {
                    let ((low, high), (least, greatest)) = (range(&wall, k), range(part, k));
                    (low - greatest, high - least)
                };
                let ((x0, x1), (y0, y1)) = (side(0), side(1));
                [Point::new(x0, y0.max(0.0)), Point::new(x1, y1)]
            })
            .collect();
        sketch.rectangles(&frame, &shadows, Style::fill(obstacle(1)).faded(0.4));
        sketch.polygon(&frame, &wall.map(|[x, y]| Point::new(x, y)), solid(0));
        let at = Point::new(0.5, 0.55);
        for (k, part) in parts.iter().enumerate() {
            let corners = part.map(|[x, y]| at + Point::new(x, y));
            sketch.polygon(&frame, &corners, if k == 0 { Style::line(INK, 1.4).filled(WHITE) } else { solid(2) });
        }
        sketch.dot(&frame, at, 4.0, Style::fill(INK));
    }
    sketch.note(10.0, "The same wall (solid) has a larger C-obstacle (pale) for the arm with its payload. The dot is the arm\u{2019}s point.");
    sketch.figure()
}
