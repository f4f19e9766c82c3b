//! Names with the shapes that they name.

use super::axes::Frame;
use super::checked::nearest_points;
use super::figure::Rect;
use super::labels::centered_rect;
use super::view::bounding_box;
use cplan_geometry::{Convex, Point, separation};
use cplan_model::Shape;

/// Side of the square in the middle of a wall around which the wall's name may lie, in pixels. It is the width of the wall's
/// line.
const WALL_SPOT_SIDE: f64 = 3.0;

/// A name and the shape that it names.
pub struct Named {
    /// The name.
    pub text: String,
    /// The box on which the name may lie, or around which it may lie.
    pub rect: Rect,
    /// The shape as a union of convex pieces, in pixels that count upwards.
    pieces: Vec<Convex>,
}

impl Named {
    pub fn of_box(text: String, rect: Rect) -> Self {
        Self { text, rect, pieces: vec![outline_of(&rect, 0.0)] }
    }

    /// Creates the name of a union of pieces in the panel's plane. The name may lie around `rect`.
    pub fn of_pieces<'a>(
        text: String,
        rect: Rect,
        frame: &Frame,
        pieces: impl IntoIterator<Item = &'a Convex>,
    ) -> Self {
        Self { text, rect, pieces: pieces.into_iter().map(|piece| in_pixels(frame, piece)).collect() }
    }

    /// Creates the name of a shape with these pieces. It may lie on or around the box of the shape, or around the middle
    /// of a wall's longest stretch.
    pub fn of_shape<'a>(
        text: String,
        frame: &Frame,
        shape: &Shape,
        pieces: impl IntoIterator<Item = &'a Convex>,
    ) -> Self {
        let pieces: Vec<&Convex> = pieces.into_iter().collect();
        let rect = place(frame, shape, pieces.iter().copied());
        Self::of_pieces(text, rect, frame, pieces)
    }

    /// Creates the name of lines, given by their points. `rect` is the box around them.
    pub fn of_lines(text: String, rect: Rect, lines: &[Vec<[f64; 2]>]) -> Self {
        let corner = |&[x, y]: &[f64; 2]| Point::new(x, -y);
        let side = |ends: &[[f64; 2]]| Convex::trusted(ends.iter().map(corner).collect(), 0.0);
        Self { text, rect, pieces: lines.iter().flat_map(|spots| spots.windows(2)).map(side).collect() }
    }

    /// Returns the distance in pixels between a box and the shape, which is not positive if they overlap, and the point of the
    /// shape that is nearest to the box.
    pub fn nearest(&self, place: &Rect) -> (f64, [f64; 2]) {
        let own = outline_of(place, 0.0);
        let distance = |piece: &Convex| separation(&own, piece).distance;
        let nearest = self.pieces.iter().map(|piece| (distance(piece), piece)).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((distance, piece)) = nearest else { return (f64::INFINITY, [f64::NAN; 2]) };
        let corners = |shape: &Convex| shape.core().iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
        let [from, to] = nearest_points(&corners(&own), &corners(piece));
        // The share of the distance from the core to the rounded outline.
        let share = piece.radius() / (distance + piece.radius()).max(f64::MIN_POSITIVE);
        let [x, y] = [0, 1].map(|k| to[k] + (from[k] - to[k]) * share);
        (distance, [x, -y])
    }
}

/// Returns a convex shape of the panel's plane, in pixels that count upwards, so that corners stay counter-clockwise.
pub fn in_pixels(frame: &Frame, shape: &Convex) -> Convex {
    let corner = |p: Point| {
        let [x, y] = frame.at(p.x, p.y);
        Point::new(x, -y)
    };
    shape.mapped(corner, shape.radius() * frame.scale())
}

/// Returns a box in pixels that count upwards, grown by a radius.
pub fn outline_of(place: &Rect, radius: f64) -> Convex {
    let [left, right, top, bottom] = [place.x, place.right(), -place.y, -place.bottom()];
    let corners = [[left, bottom], [right, bottom], [right, top], [left, top]].map(|[x, y]| Point::new(x, y));
    Convex::trusted(corners.to_vec(), radius)
}

/// Returns the box to which a name refers: the box around the shape or, for a wall, a square in the middle of its longest
/// stretch.
fn place<'a>(frame: &Frame, shape: &Shape, pieces: impl IntoIterator<Item = &'a Convex>) -> Rect {
    if let Shape::Polyline(points) = shape {
        let longest = points.windows(2).max_by(|a, b| (a[1] - a[0]).norm().total_cmp(&(b[1] - b[0]).norm()));
        if let Some([a, b]) = longest {
            return centered_rect(frame.at((a.x + b.x) / 2.0, (a.y + b.y) / 2.0), [WALL_SPOT_SIDE; 2]);
        }
    }
    let [x, y] = bounding_box(pieces);
    let ([left, bottom], [right, top]) = (frame.at(x.0, y.0), frame.at(x.1, y.1));
    Rect { x: left, y: top, width: right - left, height: bottom - top }
}
