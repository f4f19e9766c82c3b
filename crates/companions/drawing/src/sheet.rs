//! The sheet on which readers collect shapes.

use crate::curve::{Ellipse, TooFineCurve};
use crate::fill::{FillRule, filled};
use crate::join::joined;
use crate::map::Map;
use crate::notes::Notes;
use crate::{Drawing, Error, Frame, Geometry, Point, Ring, Settings, Shape};
use std::collections::BTreeMap;

/// Greatest number of points of a drawing. A drawing with more points would be useless for planning.
pub const MAX_POINTS: usize = 1 << 21;

/// Greatest coordinate, metres. Beyond it, doubles are coarser than tolerances.
const MAX_COORDINATE: f64 = 1e12;

/// Greatest distance, metres, between ends that differ only by the rounding of rotations and scales.
const ROUNDING: f64 = 1e-9;

/// The origin of a shape in the file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Origin {
    pub name: Option<String>,
    pub layer: Option<String>,
    pub height: Option<[f64; 2]>,
    pub hidden_by: Option<String>,
    pub kind: String,
    pub line: Option<usize>,
    pub frame: Option<Frame>,
}

impl Origin {
    /// Returns the words by which a user may select the element.
    pub fn called(&self) -> Vec<String> {
        [&self.layer, &self.name, &self.hidden_by].into_iter().flatten().cloned().collect()
    }
}

/// Shapes in the order of the file, and open curves that will be joined.
pub(crate) struct Sheet {
    pub tolerance: f64,
    pub notes: Notes,
    /// Shapes, each with its number in the file.
    shapes: Vec<(usize, Shape)>,
    /// Open curves by group: number in the file, origin, points. Only curves of one group are joined.
    open: BTreeMap<usize, Vec<(usize, Origin, Vec<Point>)>>,
    count: usize,
    points: usize,
}

impl Sheet {
    pub fn new(settings: &Settings) -> Self {
        let (notes, shapes, open) = (Notes::default(), Vec::new(), BTreeMap::new());
        Self { tolerance: settings.tolerance, notes, shapes, open, count: 0, points: 0 }
    }

    /// Adds a note about an element.
    pub fn note(&mut self, message: impl Into<String>, origin: &Origin) {
        self.notes.add_of(origin.called(), message, origin.line);
    }

    /// Adds a note that an element is omitted.
    pub fn leave_out(&mut self, what: &str, origin: &Origin) {
        self.note(format!("{what}: left out"), origin);
    }

    /// Creates the error that a curve needs too many chords to stay within the tolerance.
    pub fn too_fine(&self, origin: &Origin) -> Error {
        let (kind, tolerance) = (&origin.kind, self.tolerance);
        let message = format!("{kind}: too many chords are needed for a tolerance of {tolerance} m");
        Error::new(origin.line, message, "use a larger tolerance, or check the unit")
    }

    /// Converts the failure to approximate a curve to an error about the element.
    pub fn chords<T>(&self, chords: Result<T, TooFineCurve>, origin: &Origin) -> Result<T, Error> {
        chords.map_err(|TooFineCurve| self.too_fine(origin))
    }

    /// Adds a closed outline.
    pub fn closed(&mut self, ring: Ring, origin: &Origin) -> Result<(), Error> {
        self.polygon(ring, Vec::new(), origin)
    }

    /// Adds an outline with holes.
    pub fn polygon(&mut self, outer: Ring, holes: Vec<Ring>, origin: &Origin) -> Result<(), Error> {
        let outer = without_repeated_points(outer, true);
        if has_no_area(&outer) {
            return self.wall(outer, origin);
        }
        let holes: Vec<Ring> = holes
            .into_iter()
            .map(|hole| without_repeated_points(hole, true))
            .filter(|hole| !has_no_area(hole))
            .collect();
        self.check_and_count(outer.iter().chain(holes.iter().flatten()), origin)?;
        self.add(Geometry::Polygon { outer, holes }, origin);
        Ok(())
    }

    /// Adds the region that several rings enclose under a fill rule.
    pub fn region(&mut self, rings: Vec<Ring>, rule: FillRule, origin: &Origin) -> Result<(), Error> {
        if let [_] = &rings[..] {
            return rings.into_iter().try_for_each(|ring| self.closed(ring, origin));
        }
        self.check_and_count(rings.iter().flatten(), origin)?;
        for (outer, holes) in filled(&rings, rule) {
            self.polygon(outer, holes, origin)?;
        }
        Ok(())
    }

    /// Adds a polyline that is not joined with others.
    pub fn wall(&mut self, points: Vec<Point>, origin: &Origin) -> Result<(), Error> {
        let points = without_repeated_points(points, false);
        if points.len() < 2 {
            self.leave_out(&format!("{} without extent", origin.kind), origin);
            return Ok(());
        }
        self.check_and_count(points.iter(), origin)?;
        self.add(Geometry::Polyline(points), origin);
        Ok(())
    }

    /// Adds a curve. It will be joined with curves of its group whose ends meet its ends.
    pub fn open(&mut self, points: Vec<Point>, group: usize, origin: &Origin) -> Result<(), Error> {
        let points = without_repeated_points(points, false);
        if points.len() < 2 {
            return self.wall(points, origin);
        }
        self.check_and_count(points.iter(), origin)?;
        self.count += 1;
        self.open.entry(group).or_default().push((self.count, origin.clone(), points));
        Ok(())
    }

    /// Adds a circle, or a ring if the map stretches the circle.
    pub fn circle(&mut self, center: Point, radius: f64, map: &Map, origin: &Origin) -> Result<(), Error> {
        match map.similarity() {
            Some(scale) if radius * scale > 0.0 => {
                let (center, radius) = (map.point(center), radius * scale);
                self.check_and_count([center, [radius, 0.0]].iter(), origin)?;
                self.add(Geometry::Circle { center, radius }, origin);
                Ok(())
            }
            _ => self.ellipse(&Ellipse::circle(center, radius).mapped(map), origin),
        }
    }

    /// Adds a whole ellipse in coordinates of the drawing.
    pub fn ellipse(&mut self, ellipse: &Ellipse, origin: &Origin) -> Result<(), Error> {
        let ring = self.chords(ellipse.ring(self.tolerance), origin)?;
        self.closed(ring, origin)
    }

    /// Checks that coordinates are within range, and counts the points towards the limit of the drawing.
    fn check_and_count<'a>(&mut self, points: impl Iterator<Item = &'a Point>, origin: &Origin) -> Result<(), Error> {
        for point in points {
            self.points += 1;
            if !point.iter().all(|x| x.abs() <= MAX_COORDINATE) {
                let message = format!("{}: coordinates are too large (beyond {MAX_COORDINATE:e} m)", origin.kind);
                return Err(Error::new(origin.line, message, "check the scale and the coordinates"));
            }
        }
        if self.points > MAX_POINTS {
            let message = format!("the drawing has more than {MAX_POINTS} points");
            return Err(Error::new(
                origin.line,
                message,
                "remove parts that the arm cannot reach, or use a larger tolerance",
            ));
        }
        Ok(())
    }

    fn add(&mut self, geometry: Geometry, origin: &Origin) {
        self.count += 1;
        self.add_at(self.count, geometry, origin);
    }

    fn add_at(&mut self, number: usize, geometry: Geometry, origin: &Origin) {
        let Origin { name, layer, height, hidden_by, kind, line, frame } = origin.clone();
        self.shapes.push((number, Shape { name, layer, geometry, height, hidden_by, kind, line, frame }));
    }

    /// Joins the open curves and returns the drawing.
    pub fn finish(mut self) -> Drawing {
        for curves in std::mem::take(&mut self.open).into_values() {
            let (origins, curves): (Vec<_>, Vec<_>) = curves.into_iter().map(|(n, o, p)| ((n, o), p)).unzip();
            for chain in joined(&curves, self.tolerance) {
                let (number, origin) = &origins[*chain.curves.iter().min().expect("at least one")];
                let mut origin = origin.clone();
                if chain.curves.len() > 1 {
                    origin.kind = format!("{} and {} more, joined end to end", origin.kind, chain.curves.len() - 1);
                }
                if chain.gap > ROUNDING {
                    let message = format!("ends that are less than {} m apart: joined", self.tolerance);
                    self.note(message, &origin);
                }
                let points = without_repeated_points(chain.points, chain.is_closed);
                let geometry = if chain.is_closed && !has_no_area(&points) {
                    Geometry::Polygon { outer: points, holes: Vec::new() }
                } else {
                    Geometry::Polyline(points)
                };
                self.add_at(*number, geometry, &origin);
            }
        }
        self.shapes.sort_by_key(|(number, _)| *number);
        Drawing { shapes: self.shapes.into_iter().map(|(_, shape)| shape).collect(), notes: self.notes }
    }
}

/// Removes points that repeat the previous one. In a ring, the last point precedes the first.
pub(crate) fn without_repeated_points(mut points: Vec<Point>, is_ring: bool) -> Vec<Point> {
    points.dedup();
    while is_ring && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// Returns true if all corners lie on one line, in their rounded coordinates.
fn has_no_area(ring: &[Point]) -> bool {
    let [a, rest @ ..] = ring else { return true };
    let far = rest.iter().max_by(|p, q| distance(a, p).total_cmp(&distance(a, q)));
    let Some(b) = far else { return true };
    let [ux, uy] = [b[0] - a[0], b[1] - a[1]];
    rest.iter().all(|p| (ux * (p[1] - a[1]) - uy * (p[0] - a[0])) == 0.0)
}

fn distance(a: &Point, b: &Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
