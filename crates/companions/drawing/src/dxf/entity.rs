//! Converts the entities that lie in the plane to shapes.

use super::document::Entity;
use super::tags::Record;
use super::{BlockPlacement, Reader, oriented, upwards};
use crate::curve::{Ellipse, Spline, bulge, cubic};
use crate::interpolation::{EndConditions, interpolated};
use crate::map::Map;
use crate::sheet::{Origin, without_repeated_points};
use crate::stroke::{Piece, covering_rings};
use crate::{Error, FillRule, Point, filled};
use std::f64::consts::TAU;

/// A corner of a polyline, with the bulge and the widths of the segment that follows.
struct Corner {
    at: Point,
    bulge: f64,
    widths: [f64; 2],
}

impl<'a> Reader<'_, 'a> {
    /// Adds an entity to the sheet. If the entity cannot be used, adds a note that it is omitted.
    pub(super) fn entity(
        &mut self,
        entity: &Entity<'a>,
        place: &BlockPlacement<'a>,
        origin: &Origin,
    ) -> Result<(), Error> {
        let record = entity.record;
        if is_tilted(&record)? {
            self.sheet.leave_out(&format!("{} across the plane", record.kind), origin);
            return Ok(());
        }
        // Lines, ellipses and splines are in the coordinates of the drawing.
        let (world, own) = (place.map, place.map.compose(&oriented(entity)?));
        match record.kind {
            "LINE" => {
                let ends = [record.point(10)?, record.point(11)?].map(|p| world.point(p));
                self.open(ends.to_vec(), place, origin)
            }
            "LWPOLYLINE" => self.polyline(&corners(&record)?, record.flag(1)?, &own, place, origin),
            "POLYLINE" => self.read_old_polyline(entity, &own, place, origin),
            "CIRCLE" | "ARC" if record.needed(40)? == 0.0 => {
                self.sheet.leave_out(&format!("{} of radius 0", record.kind), origin);
                Ok(())
            }
            "CIRCLE" => self.sheet.circle(record.point(10)?, size(&record, 40)?, &own, origin),
            "ARC" => {
                let circle = Ellipse::circle(record.point(10)?, size(&record, 40)?).mapped(&own);
                let [from, to] = [record.needed(50)?.to_radians(), record.needed(51)?.to_radians()];
                self.arc(&circle, from, to, place, origin)
            }
            "ELLIPSE" => {
                let u = record.point(11)?;
                let flat = size(&record, 40)? * upwards(entity);
                let ellipse = Ellipse { center: record.point(10)?, u, v: [-u[1] * flat, u[0] * flat] }.mapped(&world);
                let [from, to] = [record.number_or(41, 0.0)?, record.number_or(42, TAU)?];
                self.arc(&ellipse, from, to, place, origin)
            }
            "SPLINE" => self.spline(&record, &world, place, origin),
            // The file has the last two corners in reading order, not in the order around the shape.
            "SOLID" | "TRACE" => {
                let corners: [Point; 4] =
                    [record.point(10)?, record.point(11)?, record.point(13).or(record.point(12))?, record.point(12)?];
                self.sheet.closed(corners.map(|p| own.point(p)).to_vec(), origin)
            }
            kind => {
                self.sheet.leave_out(kind, origin);
                Ok(())
            }
        }
    }

    fn open(&mut self, points: Vec<Point>, place: &BlockPlacement, origin: &Origin) -> Result<(), Error> {
        let group = self.group(place, origin);
        self.sheet.open(points, group, origin)
    }

    /// Adds corners joined by lines and arcs.
    fn polyline(
        &mut self,
        corners: &[Corner],
        is_closed: bool,
        map: &Map,
        place: &BlockPlacement,
        origin: &Origin,
    ) -> Result<(), Error> {
        let [first, ..] = corners else {
            self.sheet.leave_out(&format!("{} without points", origin.kind), origin);
            return Ok(());
        };
        let mut points = vec![map.point(first.at)];
        let closing = corners.last().filter(|_| is_closed).map(|last| (last, first));
        let ways: Vec<_> = corners.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing).collect();
        if ways.iter().any(|(from, to)| from.is_wide() && from.at != to.at) {
            return self.read_wide_polyline(&ways, is_closed, map, place, origin);
        }
        for (from, to) in ways {
            let arc = bulge(from.at, to.at, from.bulge, map, self.sheet.tolerance);
            points.extend(self.sheet.chords(arc, origin)?);
        }
        if is_closed { self.sheet.closed(points, origin) } else { self.open(points, place, origin) }
    }

    /// Adds the area that a polyline with widths covers. Segments of width 0 become lines.
    fn read_wide_polyline(
        &mut self,
        ways: &[(&Corner, &Corner)],
        is_closed: bool,
        map: &Map,
        place: &BlockPlacement,
        origin: &Origin,
    ) -> Result<(), Error> {
        let ways: Vec<_> = ways.iter().filter(|(from, to)| from.at != to.at).collect();
        let mut rings = Vec::new();
        for run in ways.chunk_by(|(a, _), (b, _)| a.is_wide() == b.is_wide()) {
            if run[0].0.is_wide() {
                let piece = |(from, to): &&(&Corner, &Corner)| Piece {
                    ends: [from.at, to.at],
                    bulge: from.bulge,
                    widths: from.widths,
                };
                let pieces: Vec<Piece> = run.iter().map(piece).collect();
                let is_whole = is_closed && run.len() == ways.len();
                let covered = covering_rings(&pieces, is_whole, map, self.sheet.tolerance);
                rings.extend(self.sheet.chords(covered, origin)?);
            } else {
                let mut points = vec![map.point(run[0].0.at)];
                for (from, to) in run {
                    let arc = bulge(from.at, to.at, from.bulge, map, self.sheet.tolerance);
                    points.extend(self.sheet.chords(arc, origin)?);
                }
                self.open(points, place, origin)?;
            }
        }
        let parts = filled(&rings, FillRule::NonZero);
        if is_closed && parts.iter().any(|(_, holes)| !holes.is_empty()) {
            let message = "closed polylines with a width: read as frames of this width, with a free inside";
            self.sheet.note(message, origin);
        }
        parts.into_iter().try_for_each(|(outer, holes)| self.sheet.polygon(outer, holes, origin))
    }

    /// Adds a polyline of the older form, whose vertices are separate records.
    fn read_old_polyline(
        &mut self,
        entity: &Entity,
        map: &Map,
        place: &BlockPlacement,
        origin: &Origin,
    ) -> Result<(), Error> {
        const MESH_FLAGS: i64 = 16 | 64;
        const CONTROL_POINT_FLAG: i64 = 16;
        let record = entity.record;
        if record.flag(MESH_FLAGS)? {
            self.sheet.leave_out("POLYLINE that is a mesh", origin);
            return Ok(());
        }
        let widths = [record.number_or(40, 0.0)?, record.number_or(41, 0.0)?];
        let mut corners = Vec::new();
        for vertex in entity.parts.iter().filter(|part| part.kind == "VERTEX") {
            if !vertex.flag(CONTROL_POINT_FLAG)? {
                let widths = [vertex.number_or(40, widths[0])?.abs(), vertex.number_or(41, widths[1])?.abs()];
                corners.push(Corner { at: vertex.point(10)?, bulge: vertex.number_or(42, 0.0)?, widths });
            }
        }
        self.polyline(&corners, record.flag(1)?, map, place, origin)
    }

    fn arc(
        &mut self,
        ellipse: &Ellipse,
        from: f64,
        to: f64,
        place: &BlockPlacement,
        origin: &Origin,
    ) -> Result<(), Error> {
        const WHOLE_TURN_TOLERANCE: f64 = 1e-9;
        let turn = (to - from).rem_euclid(TAU);
        if !(WHOLE_TURN_TOLERANCE..=TAU - WHOLE_TURN_TOLERANCE).contains(&turn) {
            return self.sheet.ellipse(ellipse, origin);
        }
        let points = self.sheet.chords(ellipse.arc(from, turn, self.sheet.tolerance), origin)?;
        let points = [ellipse.at(from)].into_iter().chain(points).collect();
        self.open(points, place, origin)
    }

    fn spline(&mut self, record: &Record, map: &Map, place: &BlockPlacement, origin: &Origin) -> Result<(), Error> {
        let control: Vec<Point> = record.points(10)?.into_iter().map(|p| map.point(p)).collect();
        let weights = record.numbers(41)?;
        let weights = if weights.is_empty() { vec![1.0; control.len()] } else { weights };
        let degree = usize::try_from(record.integer_or(71, 3)?).unwrap_or_default();
        let spline = Spline { degree, knots: record.numbers(40)?, control, weights };
        if spline.control.is_empty() && record.points(11)?.len() > 1 {
            return self.read_fit_spline(record, map, place, origin);
        }
        if !spline.is_sound() {
            let message = "SPLINE: the numbers of knots, weights and control points do not match its degree";
            return Err(Error::new(record.line, message, "draw the spline again, or convert it to a polyline"));
        }
        let points = self.sheet.chords(spline.points(self.sheet.tolerance), origin)?;
        self.open(points, place, origin)
    }

    /// Adds a spline that is given only by its fit points.
    fn read_fit_spline(
        &mut self,
        record: &Record,
        map: &Map,
        place: &BlockPlacement,
        origin: &Origin,
    ) -> Result<(), Error> {
        const CLOSED_FLAGS: i64 = 1 | 2;
        let is_closed = record.flag(CLOSED_FLAGS)?;
        let fit = without_repeated_points(record.points(11)?, is_closed);
        let direction = |code: i32| record.number(code)?.map(|_| record.point(code)).transpose();
        let ends =
            if is_closed { EndConditions::Closed } else { EndConditions::Open([direction(12)?, direction(13)?]) };
        let mut points: Vec<Point> = fit.first().map(|&p| map.point(p)).into_iter().collect();
        for piece in interpolated(&fit, ends) {
            let piece = cubic(piece.map(|p| map.point(p)), self.sheet.tolerance);
            points.extend(self.sheet.chords(piece, origin)?);
        }
        if is_closed { self.sheet.closed(points, origin) } else { self.open(points, place, origin) }
    }
}

fn size(record: &Record, code: i32) -> Result<f64, Error> {
    let size = record.needed(code)?;
    if size > 0.0 {
        return Ok(size);
    }
    let message = format!("{} of size {size}", record.kind);
    Err(Error::new(record.line, message, "give it a size above 0, or remove it"))
}

/// Returns true if the z axis of an entity is not parallel to that of the drawing.
fn is_tilted(record: &Record) -> Result<bool, Error> {
    const NORMAL_TOLERANCE: f64 = 1e-6;
    let [x, y] = [record.number_or(210, 0.0)?, record.number_or(220, 0.0)?];
    Ok(x.hypot(y) > NORMAL_TOLERANCE)
}

/// Returns the corners of a polyline that is stored in one record.
fn corners(record: &Record) -> Result<Vec<Corner>, Error> {
    let width = record.number_or(43, 0.0)?.abs();
    let corner = |at: Point| Corner { at, bulge: 0.0, widths: [width; 2] };
    let mut corners: Vec<Corner> = record.points(10)?.into_iter().map(corner).collect();
    let mut count = 0;
    for tag in record.tags {
        match tag.code {
            10 => count += 1,
            40 if count > 0 => corners[count - 1].widths[0] = tag.number()?.abs(),
            41 if count > 0 => corners[count - 1].widths[1] = tag.number()?.abs(),
            42 if count > 0 => corners[count - 1].bulge = tag.number()?,
            _ => {}
        }
    }
    Ok(corners)
}

impl Corner {
    fn is_wide(&self) -> bool {
        self.widths.iter().any(|&width| width > 0.0)
    }
}
