//! Outlines of SVG elements as exact curves.

use super::path::{Outline, OutlineCurve};
use super::{InheritedProperties, Reader, sheet_and_strokes};
use crate::curve::Ellipse;
use crate::{Error, MAX_POINTS, Point, Settings, Stroke, StrokeCurve, Strokes};
use roxmltree::Node;
use std::f64::consts::{FRAC_PI_2, TAU};
use svgtypes::PointsParser;

/// Greatest range of an ellipse's parameter that one cubic curve covers: a 32nd of a turn. Such a cubic deviates from
/// the ellipse by less than a billionth of its size.
const CUBIC_RANGE: f64 = TAU / 32.0;

/// Greatest relative difference between the half axes of an ellipse that counts as a circle. Also the greatest
/// deviation of their angle from a right angle.
const CIRCLE_TOLERANCE: f64 = 1e-12;

/// Reads the outlines of all visible elements.
///
/// # Errors
/// Same as for shapes.
pub(crate) fn read(text: &str, settings: &Settings) -> Result<Strokes, Error> {
    let (sheet, strokes) = sheet_and_strokes(text, settings, Some(Vec::new()))?;
    let count: usize = strokes.iter().map(|stroke| stroke.curves.len()).sum();
    if count > MAX_POINTS {
        let message = format!("the drawing has more than {MAX_POINTS} curves");
        return Err(Error::new(None, message, "split the drawing into several"));
    }
    Ok(Strokes { strokes, notes: sheet.finish().notes })
}

impl Reader<'_, '_> {
    /// Adds the outlines of an element.
    pub(super) fn add_strokes(&mut self, node: Node, inside: &InheritedProperties) -> Result<(), Error> {
        let outlines = self.outlines(node, inside)?;
        let line = self.line(node);
        let strokes = outlines.iter().filter(|outline| !outline.curves.is_empty()).map(|outline| Stroke {
            name: inside.name.clone(),
            line,
            start: outline.start,
            curves: curves(outline),
        });
        self.strokes.get_or_insert_default().extend(strokes);
        Ok(())
    }

    fn outlines(&self, node: Node, inside: &InheritedProperties) -> Result<Vec<Outline>, Error> {
        let map = &inside.map;
        let polyline = |points: Vec<Point>, is_closed: bool| {
            let lines = points.iter().skip(1).map(|point| OutlineCurve::Line(*point)).collect();
            points.first().map(|start| Outline { start: *start, curves: lines, is_closed })
        };
        Ok(match node.tag_name().name() {
            "path" => self.outlines_of_path(node, inside)?,
            "line" => polyline(self.line_ends(node, inside)?.to_vec(), false).into_iter().collect(),
            "rect" => self.rect_extents(node, inside)?.map(|extents| rect(extents, inside)).into_iter().collect(),
            "circle" | "ellipse" => {
                let whole = |[center, [rx, ry]]: [Point; 2]| {
                    let ellipse = Ellipse { center, u: [rx, 0.0], v: [0.0, ry] }.mapped(map);
                    let start = ellipse.at(0.0);
                    let arc = OutlineCurve::Arc { ellipse, from: 0.0, by: TAU, end: start };
                    Outline { start, curves: vec![arc], is_closed: true }
                };
                self.ellipse_extents(node, inside)?.map(whole).into_iter().collect()
            }
            kind => {
                let points = PointsParser::from(node.attribute("points").unwrap_or_default());
                let points = points.map(|(x, y)| map.point([x, y])).collect();
                polyline(points, kind == "polygon").into_iter().collect()
            }
        })
    }
}

/// Returns the outline of a rectangle with this corner, size and radii.
fn rect([[x, y], [w, h], [rx, ry]]: [Point; 3], inside: &InheritedProperties) -> Outline {
    let map = &inside.map;
    let is_round = rx > 0.0 && ry > 0.0;
    let [rx, ry] = if is_round { [rx, ry] } else { [0.0; 2] };
    // The corners in order, each with the quarter of an ellipse that rounds it.
    let corners = [[x + w - rx, y + ry], [x + w - rx, y + h - ry], [x + rx, y + h - ry], [x + rx, y + ry]];
    let start = map.point([x + rx, y]);
    let mut curves = Vec::new();
    for (center, quarter) in corners.into_iter().zip([3.0, 0.0, 1.0, 2.0]) {
        let ellipse = Ellipse { center, u: [rx, 0.0], v: [0.0, ry] };
        let from = quarter * FRAC_PI_2;
        curves.push(OutlineCurve::Line(map.point(ellipse.at(from))));
        if is_round {
            let end = map.point(ellipse.at(from + FRAC_PI_2));
            curves.push(OutlineCurve::Arc { ellipse: ellipse.mapped(map), from, by: FRAC_PI_2, end });
        }
    }
    Outline { start, curves, is_closed: true }
}

/// Returns the curves of an outline. A closed one ends exactly where it begins.
fn curves(outline: &Outline) -> Vec<StrokeCurve> {
    let mut curves = Vec::new();
    let mut at = outline.start;
    for curve in &outline.curves {
        match *curve {
            OutlineCurve::Line(end) => curves.push(StrokeCurve::Line(end)),
            OutlineCurve::Cubic(points) => curves.push(StrokeCurve::Cubic(points)),
            OutlineCurve::Arc { ellipse, from, by, end } => arc(&ellipse, from, by, end, &mut curves),
        }
        at = curve.end();
    }
    if outline.is_closed && at != outline.start {
        curves.push(StrokeCurve::Line(outline.start));
    }
    curves
}

/// Appends an arc: exactly if it belongs to a circle, otherwise as cubic curves.
fn arc(ellipse: &Ellipse, from: f64, by: f64, end: Point, curves: &mut Vec<StrokeCurve>) {
    let Ellipse { center, u, v } = *ellipse;
    let [a, b] = [u, v].map(|[x, y]| x.hypot(y));
    let (across, along) = (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
    if (a - b).abs() <= CIRCLE_TOLERANCE * a && along.abs() <= CIRCLE_TOLERANCE * a * b {
        let side = across.signum();
        let from = u[1].atan2(u[0]) + side * from;
        curves.push(StrokeCurve::Arc { center, radius: a, from, by: side * by });
        return;
    }
    let count = (by.abs() / CUBIC_RANGE).ceil().max(1.0);
    let step = by / count;
    // Control points on the tangents, at the distance that puts the middle of the cubic on the ellipse.
    let reach = 4.0 / 3.0 * (step / 4.0).tan();
    let tangent = |t: f64| [0, 1].map(|k| v[k] * t.cos() - u[k] * t.sin());
    for i in 0..count as u32 {
        let [t0, t1] = [from + step * f64::from(i), from + step * f64::from(i + 1)];
        let [first, last] = [ellipse.at(t0), if f64::from(i + 1) == count { end } else { ellipse.at(t1) }];
        let [d0, d1] = [tangent(t0), tangent(t1)];
        let inner = [[0, 1].map(|k| first[k] + reach * d0[k]), [0, 1].map(|k| last[k] - reach * d1[k])];
        curves.push(StrokeCurve::Cubic([inner[0], inner[1], last]));
    }
}
