//! Reads the outlines of an SVG drawing as a line for the tip of a robot.

use crate::{Settings, StrokeCurve, strokes};
use cplan_toolpath::{Curve, Error, Piece, Placement, Point, Source, Toolpath};

/// Reads the outlines of all visible elements of an SVG as a line, in the order of the file, with straight travels between
/// them. Curves stay exact, as for [`strokes`].
///
/// # Errors
/// If the file is not SVG, or has no line.
pub fn read_line(bytes: &[u8], placement: &Placement) -> Result<Toolpath, Error> {
    let settings = Settings { unit: placement.unit, ..Settings::default() };
    let drawing = strokes(bytes, &settings)
        .map_err(|error| Error::new(error.line, None, error.message.clone(), error.cure.clone()))?;
    let mut pieces: Vec<Piece> = Vec::new();
    for stroke in &drawing.strokes {
        let source = Source::of_line(stroke.line);
        let piece = |curve: Curve, is_travel: bool| Piece { curve, speed: None, is_travel, dwell: None, source };
        let last: Option<Point> = pieces.last().map(|piece| piece.curve.end());
        if let Some(from) = last.filter(|end| *end != stroke.start) {
            pieces.push(piece(Curve::Line { from, to: stroke.start }, true));
        }
        let mut from = stroke.start;
        for curve in &stroke.curves {
            let curve = match *curve {
                StrokeCurve::Line(to) => Curve::Line { from, to },
                StrokeCurve::Cubic([b, c, d]) => Curve::Cubic([from, b, c, d]),
                StrokeCurve::Arc { center, radius, from, by } => Curve::Arc { center, radius, from, by, growth: 0.0 },
            };
            from = curve.end();
            pieces.push(piece(curve, false));
        }
    }
    if pieces.iter().all(|piece| piece.is_travel || piece.curve.length() == 0.0) {
        let hint = "add at least one visible path or shape, such as <path d=\"M 0 0 H 10\"/>";
        return Err(Error::new(None, None, "the file has no line", hint));
    }
    let placed = pieces.into_iter().map(|piece| Piece { curve: placement.place(&piece.curve), ..piece }).collect();
    let notes = drawing.notes.all().iter().map(ToString::to_string).collect();
    Toolpath::new(placed).map(|path| path.with_notes(notes))
}
