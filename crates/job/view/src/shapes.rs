//! Shapes in the workspace.

use super::axes::Frame;
use super::figure::{Item, Step, Style, chain};
use super::view::ObstacleView;
use cplan_geometry::{Convex, Point, Vector};
use cplan_model::Shape;

/// Dashes, in pixels, for objects at future places and for obstacles into which links may reach.
pub const ABSENT_DASH: &[f64] = &[5.0, 3.0];

/// Draws an obstacle at its pose.
pub fn solid(frame: &Frame, obstacle: &ObstacleView) -> Item {
    let color = obstacle.color;
    let style = Style::line(color.darker(0.25), 1.2).filled(color.lighter(0.25));
    item(frame, obstacle, style, Style::line(color.darker(0.1), 3.0))
}

/// Draws an object at its future pose.
pub fn dashed(frame: &Frame, object: &ObstacleView) -> Item {
    let line = Style::line(object.color.darker(0.25), 1.6).dashed(ABSENT_DASH);
    item(frame, object, line.filled(object.color.lighter(0.85)).faded(0.9), line)
}

/// Draws the outline of an obstacle.
pub fn marked(frame: &Frame, obstacle: &ObstacleView, pen: Style) -> Item {
    item(frame, obstacle, pen, pen)
}

fn item(frame: &Frame, obstacle: &ObstacleView, surface: Style, wall: Style) -> Item {
    match &obstacle.outline {
        Shape::Polygon(points) => Item::Outline(chain(points.iter().map(|p| frame.at(p.x, p.y)), true), surface),
        Shape::Circle { center, radius } => {
            Item::Disc(frame.at(center.x, center.y), (radius * frame.scale()).max(1.0), surface)
        }
        Shape::Polyline(points) => Item::Outline(chain(points.iter().map(|p| frame.at(p.x, p.y)), false), wall),
        Shape::Pieces => union(frame, obstacle.own().cloned(), surface),
    }
}

/// Draws pieces as one surface.
pub fn union(frame: &Frame, pieces: impl IntoIterator<Item = Convex>, style: Style) -> Item {
    let steps = pieces.into_iter().flat_map(|piece| outline(frame, &piece)).collect();
    Item::Outline(steps, Style { pen_below: true, ..style })
}

/// Returns the outline of a rounded convex polygon: its sides moved outwards, joined by arcs.
pub fn outline(frame: &Frame, shape: &Convex) -> Vec<Step> {
    let (core, r) = (shape.core(), shape.radius());
    let pixels = r * frame.scale();
    let at = |p: Point| frame.at(p.x, p.y);
    if let [center] = core {
        let [x, y] = at(*center);
        return vec![
            Step::Move([x + pixels, y]),
            Step::Arc(pixels, [x - pixels, y]),
            Step::Arc(pixels, [x + pixels, y]),
            Step::Close,
        ];
    }
    let mut steps = Vec::new();
    let mut begin = None;
    for (i, &a) in core.iter().enumerate() {
        let b = core[(i + 1) % core.len()];
        let Some(along) = (b - a).try_normalize(0.0) else { continue };
        let outward = Vector::new(along.y, -along.x) * r;
        let from = at(a + outward);
        steps.push(match begin {
            None => Step::Move(from),
            Some(_) if r > 0.0 => Step::Arc(pixels, from),
            Some(_) => Step::Line(from),
        });
        begin = begin.or(Some(from));
        steps.push(Step::Line(at(b + outward)));
    }
    if let Some(begin) = begin {
        if r > 0.0 {
            steps.push(Step::Arc(pixels, begin));
        }
        steps.push(Step::Close);
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::super::figure::Rect;
    use super::*;

    /// Compares the area of the flattened outline with that by Steiner's formula.
    #[test]
    fn outlines_enclose_their_shape() {
        let area = Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 };
        let frame = Frame::filling(area, (-2.0, 2.0), (-2.0, 2.0));
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|c| Point::new(c.0, c.1));
        for (n, r) in [(1, 0.5), (2, 0.3), (3, 0.2), (4, 0.0), (4, 0.4)] {
            let shape = Convex::trusted(square[..n].to_vec(), r);
            let (mut twice, mut at, mut arcs) = (0.0, [0.0; 2], 0.0);
            let mut line = |from: [f64; 2], to: [f64; 2]| twice += from[0] * to[1] - from[1] * to[0];
            for step in outline(&frame, &shape) {
                match step {
                    Step::Move(to) => at = to,
                    Step::Line(to) => {
                        line(at, to);
                        at = to;
                    }
                    Step::Arc(radius, to) => {
                        line(at, to);
                        let chord = (to[0] - at[0]).hypot(to[1] - at[1]);
                        let angle = 2.0 * (chord / 2.0 / radius).min(1.0).asin();
                        arcs += radius * radius / 2.0 * (angle - angle.sin());
                        at = to;
                    }
                    Step::Close => {}
                }
            }
            // The y axis points down, so counter-clockwise on the page is clockwise in its coordinates.
            let found = (-twice / 2.0 + arcs) / frame.scale().powi(2);
            // The arc sine loses half of the digits near half a turn.
            assert!((found - shape.area()).abs() < 1e-7, "{n} corners, radius {r}: {found} for {}", shape.area());
        }
    }
}
