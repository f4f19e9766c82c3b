//! Reads GeoJSON (RFC 7946): features with a name and a height.

use crate::map::Map;
use crate::sheet::{Origin, Sheet};
use crate::{Drawing, Error, Point, Ring, Settings, Unit};
use serde_json::Value;

/// Reads GeoJSON, in metres unless another unit is given.
///
/// # Errors
/// If the text is not JSON (with its line) or not GeoJSON (with the path of the value).
pub(crate) fn read(text: &str, settings: &Settings) -> Result<Drawing, Error> {
    if text.trim().is_empty() {
        return Err(Error::new(None, "the file is empty", STRUCTURE_HINT));
    }
    let value: Value = serde_json::from_str(text).map_err(|error| {
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        Error::new(error.line().max(1), format!("this is not JSON: {message}"), "export the file again")
    })?;
    let mut sheet = Sheet::new(settings);
    let unit = settings.unit.unwrap_or_else(|| {
        sheet.notes.add("GeoJSON does not state a unit: read as m", None);
        Unit::METER
    });
    let scale = unit.metres() * settings.scale;
    let mut reader = Reader { sheet, map: Map::scaling(scale, scale) };
    reader.object(&value, "", &Origin::default())?;
    Ok(reader.sheet.finish())
}

const STRUCTURE_HINT: &str = "a GeoJSON file contains a FeatureCollection, a Feature or a geometry";
const LIST_HINT: &str = "write features, geometries, rings and positions as lists: [[0, 0], [1, 0], [1, 1], [0, 0]]";
const NUMBER_HINT: &str = "write both coordinates as numbers, without quotes";
const HEIGHT_HINT: &str = "write heights as numbers, without quotes, or leave the height out";

/// Greatest height, metres. It is far beyond the reach of any arm.
const MAX_HEIGHT: f64 = 1e6;

struct Reader {
    sheet: Sheet,
    map: Map,
}

/// Creates an error about a value, with its path.
fn wrong(at: &str, message: &str, cure: &str) -> Error {
    let at = at.trim_start_matches('.');
    let message = if at.is_empty() { message.to_owned() } else { format!("{at}: {message}") };
    Error::new(None, message, cure)
}

fn list<'a>(value: Option<&'a Value>, at: &str) -> Result<&'a Vec<Value>, Error> {
    value.and_then(Value::as_array).ok_or_else(|| wrong(at, "expected a list", LIST_HINT))
}

impl Reader {
    fn object(&mut self, value: &Value, at: &str, origin: &Origin) -> Result<(), Error> {
        let kind = value
            .get("type")
            .and_then(Value::as_str)
            .ok_or_else(|| wrong(at, "expected an object with a type", STRUCTURE_HINT))?;
        let origin = &Origin { kind: kind.to_owned(), ..origin.clone() };
        let parts = |key: &str| Ok::<_, Error>((list(value.get(key), &format!("{at}.{key}"))?, format!("{at}.{key}")));
        match kind {
            "FeatureCollection" => {
                let (features, at) = parts("features")?;
                self.each(features, &at, |reader, feature, at| reader.object(feature, at, origin))
            }
            "GeometryCollection" => {
                let (geometries, at) = parts("geometries")?;
                self.each(geometries, &at, |reader, geometry, at| reader.object(geometry, at, origin))
            }
            "Feature" => {
                let named = feature(value, at, self.map.u[0])?;
                match value.get("geometry") {
                    Some(geometry) if !geometry.is_null() => self.object(geometry, &format!("{at}.geometry"), &named),
                    _ => {
                        self.sheet.leave_out("Feature without geometry", &named);
                        Ok(())
                    }
                }
            }
            "Polygon" => {
                let (rings, at) = parts("coordinates")?;
                self.polygon(rings, &at, origin)
            }
            "MultiPolygon" => {
                let (polygons, at) = parts("coordinates")?;
                self.each(polygons, &at, |reader, rings, at| reader.polygon(list(Some(rings), at)?, at, origin))
            }
            "LineString" => {
                let (_, at) = parts("coordinates")?;
                self.line(&value["coordinates"], &at, origin)
            }
            "MultiLineString" => {
                let (lines, at) = parts("coordinates")?;
                self.each(lines, &at, |reader, line, at| reader.line(line, at, origin))
            }
            "Point" | "MultiPoint" => {
                self.sheet.leave_out(kind, origin);
                Ok(())
            }
            "Topology" => {
                let cure = "convert it first, e.g. with `topo2geo` or `ogr2ogr cell.geojson cell.topojson`";
                Err(Error::new(None, "this is TopoJSON, not GeoJSON", cure))
            }
            other => Err(wrong(at, &format!("\"{other}\" is not a type of GeoJSON"), STRUCTURE_HINT)),
        }
    }

    fn each(
        &mut self,
        values: &[Value],
        at: &str,
        mut read: impl FnMut(&mut Self, &Value, &str) -> Result<(), Error>,
    ) -> Result<(), Error> {
        values.iter().enumerate().try_for_each(|(i, value)| read(self, value, &format!("{at}[{i}]")))
    }

    fn polygon(&mut self, rings: &[Value], at: &str, origin: &Origin) -> Result<(), Error> {
        let mut read = Vec::with_capacity(rings.len());
        for (i, ring) in rings.iter().enumerate() {
            read.push(self.points(ring, &format!("{at}[{i}]"))?);
        }
        let mut rings = read.into_iter();
        match rings.next() {
            Some(outer) => self.sheet.polygon(outer, rings.collect(), origin),
            None => {
                self.sheet.leave_out("Polygon without rings", origin);
                Ok(())
            }
        }
    }

    fn line(&mut self, line: &Value, at: &str, origin: &Origin) -> Result<(), Error> {
        let points = self.points(line, at)?;
        // A closed line is a thin wall, not a solid. In GeoJSON, solids are polygons.
        self.sheet.wall(points, origin)
    }

    fn points(&self, points: &Value, at: &str) -> Result<Ring, Error> {
        list(Some(points), at)?
            .iter()
            .enumerate()
            .map(|(i, point)| {
                let numbers = point.as_array().map(|p| p.iter().map(Value::as_f64).collect::<Vec<_>>());
                match numbers.as_deref() {
                    // A third coordinate is a height above the plane.
                    Some([Some(x), Some(y), ..]) => Ok::<Point, Error>(self.map.point([*x, *y])),
                    _ => Err(wrong(&format!("{at}[{i}]"), "expected a position: [x, y]", NUMBER_HINT)),
                }
            })
            .collect()
    }
}

/// Reads the properties of a feature. The property `height` is a height, or a lower and an upper end. `unit` is the
/// scaled unit of heights, metres.
fn feature(value: &Value, at: &str, unit: f64) -> Result<Origin, Error> {
    let property = |key: &str| value.get("properties").and_then(|properties| properties.get(key));
    let text = |value: &Value| match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    let height = match property("height").filter(|height| !height.is_null()) {
        None => None,
        Some(height) => {
            let ends = match height {
                Value::Array(ends) => ends.iter().map(Value::as_f64).collect(),
                one => vec![Some(0.0), one.as_f64()],
            };
            match ends[..] {
                [Some(low), Some(high)]
                    if low <= high && [low, high].iter().all(|z| (z * unit).abs() <= MAX_HEIGHT) =>
                {
                    Some([low * unit, high * unit])
                }
                [Some(low), Some(high)] if low <= high => {
                    let message = format!("{at}.properties.height: the height is too large (beyond {MAX_HEIGHT:e} m)");
                    let cure = "give heights in the unit of the coordinates, or leave the height out";
                    return Err(Error::new(None, message.trim_start_matches('.'), cure));
                }
                [Some(low), Some(high)] => {
                    let message = format!("{at}.properties.height: {high} is below {low}");
                    let cure = "write the lower end first; a single number must be above 0";
                    return Err(Error::new(None, message.trim_start_matches('.'), cure));
                }
                _ => {
                    let at = format!("{at}.properties.height");
                    let message = "expected a number, or the lower and the upper end: [0, 0.2]";
                    return Err(wrong(&at, message, HEIGHT_HINT));
                }
            }
        }
    };
    Ok(Origin {
        name: property("name").or(value.get("id")).and_then(text),
        layer: property("layer").and_then(text),
        height,
        ..Origin::default()
    })
}
