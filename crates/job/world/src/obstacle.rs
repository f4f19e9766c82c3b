//! The world file's `[[obstacle]]`.

use super::obstacle_trajectory::ObstacleTrajectoryTable;
use super::occupancy::OccupancyMap;
use super::polygon::{Ring, polygon, polyline};
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_geometry::{Convex, Pose};
use cplan_handling::MovingObstacle;
use cplan_model::{Growth, Obstacle, Shape};
use cplan_robot::{Diagnostic, InputError, Length, LengthError, Lengths, Spanned, Written, toml_table};

toml_table! {
    /// An obstacle, which the arm must not touch: exactly one of polygon, circle, polyline and image.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "obstacle", extend(
        "oneOf" = [
            { "required": ["polygon"] }, { "required": ["circle"] }, { "required": ["polyline"] }, { "required": ["image"] }
        ],
        "dependencies" = { "unknown": ["image"], "holes": ["polygon"] },
    )))]
    pub(super) struct ObstacleTable {
        /// Name in messages and pictures. Several obstacles may have the same name.
        name: Option<String>,
        /// Corners of the outline in order, m. The outline may be non-convex and touch itself in points, but must not
        /// cross itself. Or, as in GeoJSON, a list of such outlines: the outer one, then those of holes.
        #[cfg_attr(test, schemars(with = "Option<Rings>"))]
        polygon: Option<Ring>,
        /// Holes of the polygon, each a list of corners, m. The inside of a hole is free.
        #[cfg_attr(test, schemars(with = "Option<Vec<Corners>>"))]
        holes: Option<Spanned<Vec<Ring>>>,
        /// A disc.
        circle: Option<CircleTable>,
        /// Points of a wall without thickness, m.
        #[cfg_attr(test, schemars(with = "Option<Vec<NumberPair>>", length(min = 2)))]
        polyline: Option<Ring>,
        /// An occupancy map: a YAML file of ROS's map server, which names a PGM or PNG. The name is relative to the
        /// world file.
        image: Option<Spanned<String>>,
        /// Whether unknown cells of an image are obstacles: "solid" or "free"; by default "solid".
        #[cfg_attr(test, schemars(with = "Option<UnknownAs>"))]
        unknown: Option<Spanned<String>>,
        /// Origin of the frame in which its points are given, m; by default the origin of the world.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        at: Option<Lengths>,
        /// Angle of its frame, rad; by default 0.
        angle: Option<Written>,
        /// Motion of its frame in time; by default it is static.
        motion: Option<Spanned<ObstacleTrajectoryTable>>,
        /// Its extent along the plane's normal, m. Only parts of the arm at these heights can touch it; by default all
        /// heights.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        height: Option<Lengths>,
        /// Required distance from this obstacle, m; by default the world's `clearance`, and never less.
        #[cfg_attr(test, schemars(with = "Option<NotNegativeLength>"))]
        clearance: Option<Length>,
        /// Greatest displacement of the obstacle in any direction, m, or "1 mm". Motions stay free for each such
        /// displacement. By default `obstacles` of `[robot] calibration`.
        #[cfg_attr(test, schemars(with = "Option<StatedError>"))]
        calibration: Option<LengthError>,
    }

    /// A disc.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "circle"))]
    pub(super) struct CircleTable {
        /// Coordinates of its centre, m.
        #[cfg_attr(test, schemars(with = "LengthPair"))]
        center: Lengths,
        /// Radius, m.
        #[cfg_attr(test, schemars(with = "PositiveLength"))]
        radius: Length,
    }
}

/// Largest number of convex pieces of a map. With more pieces, each planner takes minutes.
pub(super) const MAX_PIECES: usize = 1 << 20;

/// Clearance and displacement of obstacles that state none of their own, metres.
#[derive(Clone, Copy)]
pub(super) struct Margins {
    /// Least distance to keep.
    pub clearance: f64,
    /// Greatest displacement for which motions must stay free.
    pub displacement: f64,
}

/// The kinds of obstacles in a world file.
pub(super) enum ObstacleKind {
    /// A static obstacle.
    Static(Obstacle),
    /// An obstacle with a motion.
    Moving(MovingObstacle),
}

const SIMPLE_POLYGON_HINT: &str =
    "list the corners in order round the shape (and round each hole), each once; a wall without area is a polyline";

impl ObstacleTable {
    /// Reads the obstacle with this index in its file. `world` has the least clearance of all obstacles, and the displacement of
    /// an obstacle whose table states none.
    ///
    /// # Errors
    /// A table without exactly one shape, values that are not finite, invalid shapes, and unusable files.
    pub fn read(
        reader: &Reader,
        index: usize,
        table: &Spanned<Self>,
        world: Margins,
    ) -> Result<ObstacleKind, InputError> {
        let obstacle = table.get_ref();
        let name = obstacle.name.clone().unwrap_or_else(|| format!("obstacle {}", index + 1));
        let what = format!("obstacle \"{name}\"");
        let place = reader.pose(obstacle.at.as_ref(), obstacle.angle.as_ref(), &what)?;
        let trajectory = obstacle.motion.as_ref().map(|m| m.get_ref().read(reader, &what, place.as_ref(), m.span()));
        let trajectory = trajectory.transpose()?;
        // If the obstacle moves, its shape stays in its own frame.
        let place = place.as_ref().filter(|_| trajectory.is_none());
        let (shape, pieces) = match (&obstacle.polygon, &obstacle.circle, &obstacle.polyline, &obstacle.image) {
            (Some(corners), None, None, None) => {
                polygon(reader, corners, obstacle.holes.as_ref(), place, &what, SIMPLE_POLYGON_HINT)?
            }
            (None, Some(disc), None, None) => moved(circle(reader, disc, &what)?, place),
            (None, None, Some(points), None) => polyline(reader, points, place, &what)?,
            (None, None, None, Some(file)) => moved(image(reader, file, obstacle.unknown.as_ref(), &what)?, place),
            (polygon, circle, polyline, image) => {
                let given = [polygon.is_some(), circle.is_some(), polyline.is_some(), image.is_some()];
                let count = given.iter().filter(|x| **x).count();
                let message = format!("{what} needs exactly one shape, but has {count}");
                let help =
                    "give it one of polygon, circle, polyline, image; put a second shape into another [[obstacle]]";
                return Err(reader.source.diagnostic_at(table.span(), message).help(help).into());
            }
        };
        if let (Some(unknown), None) = (&obstacle.unknown, &obstacle.image) {
            let message = format!("{what}: `unknown` needs `image`");
            return Err(reader.source.diagnostic_at(unknown.span(), message).help("remove the key").into());
        }
        if let (Some(holes), None) = (&obstacle.holes, &obstacle.polygon) {
            let message = format!("{what}: `holes` needs `polygon`");
            return Err(reader.source.diagnostic_at(holes.span(), message).help("remove the key").into());
        }
        let heights = reader.heights(obstacle.height.as_ref(), &what)?;
        let clearance = obstacle.clearance.as_ref();
        let growth = Growth {
            clearance: clearance
                .map(|c| reader.not_negative(c, &format!("{what}, clearance")))
                .transpose()?
                .unwrap_or(0.0),
            error: obstacle.calibration.map_or(world.displacement, |LengthError(error)| error),
            ..Growth::default()
        };
        if let Some(given) = clearance
            && growth.clearance < world.clearance
        {
            let message = format!(
                "{what}: the clearance of {} m is less than the world's clearance of {} m, which applies to every obstacle",
                growth.clearance, world.clearance
            );
            let help = "lower the world's clearance, and state a clearance for each of the other obstacles";
            return Err(reader.source.diagnostic_at(given.span(), message).help(help).into());
        }
        let obstacle = Obstacle { name, shape, pieces, heights, growth };
        Ok(match trajectory {
            Some(trajectory) => ObstacleKind::Moving(MovingObstacle { obstacle, trajectory }),
            None => ObstacleKind::Static(obstacle),
        })
    }
}

fn moved((shape, pieces): (Shape, Vec<Convex>), place: Option<&Pose>) -> (Shape, Vec<Convex>) {
    match place {
        Some(place) => (shape.at(place), pieces.iter().map(|piece| piece.at(place)).collect()),
        None => (shape, pieces),
    }
}

fn image(
    reader: &Reader,
    image: &Spanned<String>,
    unknown: Option<&Spanned<String>>,
    what: &str,
) -> Result<(Shape, Vec<Convex>), InputError> {
    let unknown_is_free = match unknown.map(|u| (u.get_ref().as_str(), u.span())) {
        None | Some(("solid", _)) => false,
        Some(("free", _)) => true,
        Some((other, at)) => {
            let message = format!("{what}: unknown cells are \"solid\" or \"free\", not \"{other}\"");
            return Err(reader.source.diagnostic_at(at, message).help("unknown = \"solid\", or leave it out").into());
        }
    };
    let path = reader.path_of_named_file(image, what)?;
    if path.extension().is_some_and(|e| e != "yaml" && e != "yml") {
        let message = format!(
            "{what}: `image` must name the YAML file of ROS's map server, which states the size of the picture"
        );
        let help = "name the YAML file instead of the picture";
        return Err(reader.source.diagnostic_at(image.span(), message).help(help).into());
    }
    let map = OccupancyMap::read(&path)?;
    reader.files.borrow_mut().extend(map.picture.clone());
    map.notes.iter().for_each(|note| reader.taken.note(what, note.clone()));
    let pieces = map.pieces(unknown_is_free, MAX_PIECES).ok_or_else(|| {
        let message = format!("{what}: its pixels form more than {MAX_PIECES} rectangles");
        let help = "remove single pixels from the picture, or make its pixels larger";
        reader.source.diagnostic_at(image.span(), message).help(help)
    })?;
    Ok((Shape::Pieces, pieces))
}

/// Reads a disc.
pub(super) fn circle(reader: &Reader, circle: &CircleTable, what: &str) -> Result<(Shape, Vec<Convex>), Diagnostic> {
    let center = reader.point(&circle.center, &format!("{what}, center"))?;
    let radius = reader.source.finite(&circle.radius, &format!("{what}, radius"))?;
    if radius <= 0.0 {
        let message = format!("{what}: the radius must be positive, is {radius}");
        return Err(reader
            .source
            .diagnostic_at(circle.radius.span(), message)
            .help("give a radius above 0, in metres, or leave the obstacle out"));
    }
    Ok((Shape::Circle { center, radius }, vec![Convex::trusted(vec![center], radius)]))
}
