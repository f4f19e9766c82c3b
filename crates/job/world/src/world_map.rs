//! The table `[map]` of the world file: a line map and a preference file, converted to metres.

use super::line_map::LineMap;
use super::obstacle::MAX_PIECES;
use super::preference_map::{PreferenceMap, PreferenceRectangle};
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_geometry::{Convex, Point, SimplePolygon, Vector};
use cplan_model::{Goal, Growth, Obstacle, Preference, Region, Shape};
use cplan_robot::{InputError, Lengths, MAX_LENGTH, Number, Spanned, toml_table};
use std::ops::Range;
use std::path::Path;

toml_table! {
    /// Walls from a line map in the format of MobileSim. File names are relative to the world file.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "map"))]
    pub(super) struct MapTable {
        /// The line map.
        file: Spanned<String>,
        /// A preference file: rectangles for field planners, and goals, which are used if the world file has no goal.
        preferences: Option<Spanned<String>>,
        /// Metres per unit of the map and of the preference file; by default 0.001.
        #[cfg_attr(test, schemars(with = "Option<Positive>"))]
        scale: Option<Number>,
        /// Offset that is added to all coordinates after scaling, m; by default [0, 0].
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        offset: Option<Lengths>,
        /// True if the bounds of the map are walls, too; by default true.
        frame: Option<bool>,
        /// Extent of the walls along the plane's normal, m; by default all heights.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        height: Option<Lengths>,
    }
}

/// The obstacles, goals and preferences, in metres, that a map adds to a world.
#[derive(Default)]
pub(super) struct MapContent {
    pub obstacles: Vec<Obstacle>,
    /// The goal rectangles, and the position of their file's name in the world file.
    pub goals: Option<(Vec<Goal>, Range<usize>)>,
    pub preferences: Vec<Preference>,
}

/// Metres per unit of a map. Maps are in millimetres unless the world file states another scale.
const MILLIMETER: f64 = 1e-3;

/// Reads the files that the table names.
pub(super) fn read(reader: &Reader, table: &MapTable) -> Result<MapContent, InputError> {
    let scale = table.scale.as_ref().map(|s| scale(reader, s)).transpose()?.unwrap_or(MILLIMETER);
    let offset = table.offset.as_ref().map(|o| reader.number_pair(o, "map offset")).transpose()?.unwrap_or_default();
    let heights = reader.heights(table.height.as_ref(), "map")?;
    let place = |p: Point| p * scale + Vector::from(offset);
    let within = |bounds: [Point; 2], file: &Spanned<String>| {
        let farthest = bounds.map(place).iter().map(|p| p.amax()).fold(0.0, f64::max);
        if farthest <= MAX_LENGTH {
            return Ok(());
        }
        let message = format!(
            "the map is too large: with {scale} m per unit, it extends to {farthest:e} m (at most {MAX_LENGTH:e})"
        );
        Err(reader.source.diagnostic_at(file.span(), message).help("set `scale` in [map], metres per unit of the file"))
    };

    let path = reader.path_of_named_file(&table.file, "map")?;
    let map = LineMap::read(&path)?;
    within(map.bounds, &table.file)?;
    if map.lines.len() > MAX_PIECES {
        let message = format!("the map has {} lines (at most {MAX_PIECES})", map.lines.len());
        return Err(reader.source.diagnostic_at(table.file.span(), message).help("simplify the map").into());
    }
    let name = stem(&path);
    let mut obstacles = Vec::new();
    let mut add = |name: String, points: Vec<Point>| {
        let points: Vec<Point> = points.into_iter().map(place).collect();
        let (shape, pieces) = match points[..] {
            [center] => (Shape::Circle { center, radius: 0.0 }, vec![Convex::point(center)]),
            // The ends differ in the file but coincide in metres.
            _ => {
                let pieces = points.windows(2).map(|w| Convex::between(w[0], w[1])).collect();
                (Shape::Polyline(points), pieces)
            }
        };
        obstacles.push(Obstacle { name, shape, pieces, heights, growth: Growth::default() });
    };
    for chain in map.chains() {
        let [first, last] = chain.lines.map(|line| line + 1);
        let which = if first == last { format!("line {first}") } else { format!("lines {first} to {last}") };
        add(format!("{name}, {which}"), chain.points);
    }
    if table.frame.unwrap_or(true) {
        let [a, b] = map.bounds;
        add(format!("{name}, frame"), vec![a, Point::new(b.x, a.y), b, Point::new(a.x, b.y), a]);
    }

    let mut content = MapContent { obstacles, ..MapContent::default() };
    if let Some(file) = &table.preferences {
        let path = reader.path_of_named_file(file, "preferences")?;
        let map = PreferenceMap::read(&path)?;
        within(map.bounds, file)?;
        let goals = map.goals.iter().map(|corners| Goal::Area(corners.map(place)));
        content.goals = Some((goals.collect(), file.span()));
        let name = stem(&path);
        for (i, PreferenceRectangle { corners: [a, b], epsilon }) in map.rectangles.into_iter().enumerate() {
            let name = format!("{name}, rectangle {}", i + 1);
            let corners = [a, Point::new(b.x, a.y), b, Point::new(a.x, b.y)].map(place);
            let polygon = SimplePolygon::new(corners.to_vec()).map_err(|diagnostic| {
                let message =
                    format!("with {scale} m per unit, preference \"{name}\" is not a rectangle: {diagnostic}");
                reader
                    .source
                    .diagnostic_at(file.span(), message)
                    .help("set `scale` in [map], metres per unit of the file")
            })?;
            content.preferences.push(Preference { name, region: Region::Tip(polygon), epsilon, direction: None });
        }
    }
    Ok(content)
}

/// Returns the file's name without its extension, which becomes a prefix of obstacles' names.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "map".to_owned(), |s| s.to_string_lossy().into_owned())
}

/// Returns the number of metres per unit of the map.
fn scale(reader: &Reader, number: &Number) -> Result<f64, InputError> {
    let scale = reader.source.finite(number, "map scale")?;
    if scale > 0.0 {
        return Ok(scale);
    }
    let message = format!("map scale must be positive, is {scale}");
    Err(reader
        .source
        .diagnostic_at(number.span(), message)
        .help("metres per unit of the file: 0.001 for millimetres")
        .into())
}
