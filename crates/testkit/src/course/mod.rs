//! The small figures of the course, one per idea, computed from the formulas of the chapters. `examples/pictures.rs` writes their
//! files.

mod arms;
mod graphs;
mod grids;
mod plane;
mod scene;
mod shapes;

use cplan::Point;
use cplan::view::Frame;
use cplan::view::figure::{Anchor, Figure, Item, Rect, Step, Style, bold, chain, label};
use cplan_theme::{ACCENT, GRAY, INK, Rgb, WHITE, obstacle};

/// Width of a figure, in pixels.
const WIDTH: f64 = 720.0;
/// Height of letters, in pixels.
const TEXT: f64 = 15.0;

/// The name of a figure's file in `docs/pictures/course`, and the function that draws it.
pub type NamedFigure = (&'static str, fn() -> Figure);

/// All figures.
pub const FIGURES: [NamedFigure; 16] = [
    ("slice", shapes::slice),
    ("minkowski", shapes::minkowski),
    ("turning", shapes::turning),
    ("visibility", graphs::visibility),
    ("voronoi", graphs::voronoi),
    ("probabilistic", graphs::probabilistic),
    ("trapezoids", plane::trapezoids),
    ("boxes", plane::boxes),
    ("wave", grids::wave),
    ("astar", grids::astar),
    ("minimum", grids::minimum),
    ("harmonic", grids::harmonic),
    ("pieces", plane::pieces),
    ("torus", plane::torus),
    ("solutions", arms::solutions),
    ("payload", arms::payload),
];

/// Returns a colour for surfaces of obstacles.
fn solid(index: usize) -> Style {
    let color = obstacle(index);
    Style::line(color.darker(0.25), 1.4).filled(color.lighter(0.35))
}

/// A figure that grows item by item.
struct Sketch {
    height: f64,
    items: Vec<Item>,
}

impl Sketch {
    fn new(height: f64) -> Self {
        Self { height, items: Vec::new() }
    }

    fn figure(self) -> Figure {
        Figure { width: WIDTH, height: self.height, items: self.items, is_dark: false }
    }

    /// Returns a frame with this range of coordinates in a part of the page.
    fn frame(area: [f64; 4], x: (f64, f64), y: (f64, f64)) -> Frame {
        let [x0, y0, width, height] = area;
        Frame::filling(Rect { x: x0, y: y0, width, height }, x, y)
    }

    fn polygon(&mut self, frame: &Frame, corners: &[Point], style: Style) {
        self.items.push(Item::Outline(chain(corners.iter().map(|p| frame.at(p.x, p.y)), true), style));
    }

    fn line(&mut self, frame: &Frame, points: &[Point], style: Style) {
        self.items.push(Item::Outline(chain(points.iter().map(|p| frame.at(p.x, p.y)), false), style));
    }

    /// Draws many segments as one item.
    fn segments(&mut self, frame: &Frame, segments: &[[Point; 2]], style: Style) {
        let steps = segments.iter().flat_map(|[a, b]| [Step::Move(frame.at(a.x, a.y)), Step::Line(frame.at(b.x, b.y))]);
        self.items.push(Item::Outline(steps.collect(), style));
    }

    /// Draws many rectangles, given by two corners each, as one item.
    fn rectangles(&mut self, frame: &Frame, rectangles: &[[Point; 2]], style: Style) {
        let steps = rectangles.iter().flat_map(|[a, b]| {
            let ([left, bottom], [right, top]) = (frame.at(a.x, a.y), frame.at(b.x, b.y));
            [[left, bottom], [right, bottom], [right, top], [left, top]]
                .into_iter()
                .enumerate()
                .map(|(k, spot)| if k == 0 { Step::Move(spot) } else { Step::Line(spot) })
                .chain([Step::Close])
                .collect::<Vec<_>>()
        });
        self.items.push(Item::Outline(steps.collect(), style));
    }

    fn dot(&mut self, frame: &Frame, p: Point, radius: f64, style: Style) {
        self.items.push(Item::Disc(frame.at(p.x, p.y), radius, style));
    }

    /// Draws a path over a pale line.
    fn path(&mut self, frame: &Frame, points: &[Point]) {
        self.line(frame, points, Style::line(WHITE, 6.0).faded(0.85));
        self.line(frame, points, Style::line(ACCENT, 2.8));
    }

    /// Draws the start as a ring and the goal as a disc, each with its name below.
    fn ends(&mut self, frame: &Frame, start: Point, goal: Point) {
        self.dot(frame, start, 6.0, Style::line(INK, 2.2).filled(WHITE));
        self.dot(frame, goal, 6.0, Style::fill(INK));
        for (p, name) in [(start, "start"), (goal, "goal")] {
            let [x, y] = frame.at(p.x, p.y);
            self.bold([x, y + 21.0], name, INK);
        }
    }

    /// Writes a text with its middle at a spot of the page.
    fn text(&mut self, at: [f64; 2], text: impl Into<String>, color: Rgb) {
        self.items.push(label(at, text, TEXT, Anchor::Middle, color));
    }

    fn bold(&mut self, at: [f64; 2], text: impl Into<String>, color: Rgb) {
        self.items.push(bold(at, text, TEXT, Anchor::Middle, color));
    }

    /// Writes a heading above a part of the page.
    fn heading(&mut self, left: f64, text: &str) {
        self.items.push(bold([left, 22.0], text, TEXT, Anchor::Start, INK));
    }

    /// Writes an explanation at the lower side of the page.
    fn note(&mut self, left: f64, text: &str) {
        self.items.push(label([left, self.height - 10.0], text, TEXT - 1.0, Anchor::Start, GRAY));
    }
}
