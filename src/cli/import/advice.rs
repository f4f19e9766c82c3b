//! Notes about parts of a world that are probably mistakes, with hints.

use super::obstacles::{ImportedObstacle, coordinates, placed};
use crate::cli::fresh::word;
use crate::text::counted;
use cplan_drawing::{Geometry, Notes, Shape};
use std::path::Path;

/// Usual range of the width of a drawing, in metres.
const USUAL_WIDTHS: [f64; 2] = [0.01, 100.0];

/// Least and greatest value of both coordinates.
type Bounds = [(f64, f64); 2];

/// Adds notes about unusual features: an obstacle at the arm's base, an obstacle around others, and the extent of the drawing.
pub(super) fn note(taken: &[ImportedObstacle], notes: &mut Notes) {
    let bounds: Vec<Bounds> = taken.iter().map(|taken| bounds(coordinates(&taken.shape))).collect();
    let border = border(taken, &bounds);
    for (i, ImportedObstacle { name, shape }) in taken.iter().enumerate() {
        let option = word(Path::new(name));
        if border == Some(i) {
            let message = format!(
                "\"{name}\" is solid and encloses everything else; --walls {option} makes it a wall, --without {option} leaves it out"
            );
            notes.add(message, shape.line);
            continue;
        }
        let inner: Vec<&str> = inside(taken, &bounds, i).map(|j| taken[j].name.as_str()).collect();
        if let Some(first) = inner.first() {
            let others = match inner.len() {
                1 => format!("\"{first}\""),
                count => format!("\"{first}\" and {}", counted(count - 1, "other")),
            };
            let message = format!(
                "\"{name}\" is solid and contains {others}; --walls {option} makes \"{name}\" a wall with a free inside"
            );
            notes.add(message, shape.line);
        }
        if solid_contains(shape, [0.0, 0.0]) {
            let message = format!(
                "\"{name}\" covers (0, 0), the place of the arm's base; --without {option} leaves it out, --move moves the drawing"
            );
            notes.add(message, shape.line);
        }
    }
    let all = bounds.iter().fold([(f64::INFINITY, f64::NEG_INFINITY); 2], |all, one| {
        [0, 1].map(|k| (all[k].0.min(one[k].0), all[k].1.max(one[k].1)))
    });
    let width = all.map(|(low, high)| high - low).into_iter().fold(0.0, f64::max);
    if !taken.is_empty() && !(USUAL_WIDTHS[0]..=USUAL_WIDTHS[1]).contains(&width) {
        let width = if width < 1.0 { format!("{:.3} mm", width * 1e3) } else { format!("{width:.0} m") };
        notes.add(format!("the whole drawing is {width} wide; if this is wrong, state its unit by --unit"), None);
    }
}

/// Returns the least and greatest coordinates of points.
pub(super) fn bounds(points: impl Iterator<Item = [f64; 2]>) -> Bounds {
    points.fold([(f64::INFINITY, f64::NEG_INFINITY); 2], |bounds, p| {
        [0, 1].map(|k| (bounds[k].0.min(p[k]), bounds[k].1.max(p[k])))
    })
}

/// Returns the index of the solid that surrounds all others, if there is one. Drawings often contain the walls of a
/// room, or the reach of an arm, as such a solid.
fn border(taken: &[ImportedObstacle], bounds: &[Bounds]) -> Option<usize> {
    // Only the widest obstacle can surround the others.
    let width = |i: usize| bounds[i][0].1 - bounds[i][0].0;
    let widest = (0..taken.len()).max_by(|&i, &j| width(i).total_cmp(&width(j)))?;
    let is_around =
        |mut others: std::ops::Range<usize>| others.all(|j| j == widest || surrounds(&bounds[widest], &bounds[j]));
    (taken.len() > 1 && is_solid(&taken[widest].shape) && is_around(0..taken.len())).then_some(widest)
}

/// Returns the indices of the solids that lie inside solid `i`.
fn inside<'a>(taken: &'a [ImportedObstacle], bounds: &'a [Bounds], i: usize) -> impl Iterator<Item = usize> + 'a {
    let outer = &taken[i].shape;
    let is_inside = move |j: usize| {
        surrounds(&bounds[i], &bounds[j])
            && is_solid(&taken[j].shape)
            && point_of(&taken[j].shape).is_some_and(|point| solid_contains(outer, point))
    };
    (0..taken.len()).filter(move |&j| j != i && is_solid(outer) && is_inside(j))
}

/// Returns a point of a solid, in world coordinates.
fn point_of(shape: &Shape) -> Option<[f64; 2]> {
    match &shape.geometry {
        Geometry::Circle { center, .. } => Some(placed(shape, *center)),
        Geometry::Polygon { .. } | Geometry::Polyline(_) => coordinates(shape).next(),
    }
}

fn surrounds(outer: &Bounds, inner: &Bounds) -> bool {
    (0..2).all(|k| outer[k].0 < inner[k].0 && inner[k].1 < outer[k].1)
}

/// Returns true if the shape is a solid without holes.
fn is_solid(shape: &Shape) -> bool {
    match &shape.geometry {
        Geometry::Polygon { holes, .. } => holes.is_empty(),
        Geometry::Circle { .. } => true,
        Geometry::Polyline(_) => false,
    }
}

/// Returns true if a point of the world lies in a solid.
fn solid_contains(shape: &Shape, point: [f64; 2]) -> bool {
    let within = |ring: &[[f64; 2]]| {
        let ring: Vec<[f64; 2]> = ring.iter().map(|&p| placed(shape, p)).collect();
        let next = ring.iter().cycle().skip(1);
        let crossed = ring.iter().zip(next).filter(|(p, q)| {
            let along = (point[1] - p[1]) / (q[1] - p[1]);
            (p[1] > point[1]) != (q[1] > point[1]) && point[0] < p[0] + along * (q[0] - p[0])
        });
        crossed.count() % 2 == 1
    };
    match &shape.geometry {
        Geometry::Polygon { outer, holes } => within(outer) && !holes.iter().any(|hole| within(hole)),
        Geometry::Circle { center, radius } => {
            let [x, y] = placed(shape, *center);
            (x - point[0]).hypot(y - point[1]) < *radius
        }
        Geometry::Polyline(_) => false,
    }
}
