//! Occupancy maps: a picture of a place from above, described by the YAML of ROS's map server.
//!
//! ```yaml
//! image: room.pgm
//! resolution: 0.05
//! origin: [-1.0, -2.0, 0.0]
//! negate: 0
//! occupied_thresh: 0.65
//! free_thresh: 0.196
//! ```

mod description;
mod pgm;
mod picture;
mod png;
mod rectangles;

pub use picture::{MAX_CELLS, Occupancy};
pub use rectangles::{PixelRectangle, rectangles};

use cplan_geometry::{Convex, Point, Pose, Vector};
use cplan_robot::{Diagnostic, InputError, MAX_LENGTH, Source, read_bounded};
use description::Description;
use picture::{Judge, Picture, UnusablePicture};
use std::path::{Path, PathBuf};

/// An occupancy map in the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyMap {
    /// Number of cells along the picture's width and height.
    pub size: [usize; 2],
    /// Side of a cell, metres.
    pub resolution: f64,
    /// Pose of the lower left corner of the picture.
    pub pose: Pose,
    /// Cells row by row, as in the picture: from the top, and from the left in each row.
    pub cells: Vec<Occupancy>,
    /// Notes for the user about the description.
    pub notes: Vec<String>,
    /// Path of the picture. `None` for a map that was not read from a file.
    pub picture: Option<PathBuf>,
}

impl OccupancyMap {
    /// Reads a description and the picture that it names, relative to itself: PGM (P2, P5; 8 or 16 bits) or PNG.
    ///
    /// Let `p = 1 - shade` (`p = shade` with `negate`), where black is 0 and white is 1. A cell is occupied if
    /// `p > occupied_thresh`, free if `p < free_thresh`, and unknown otherwise. The modes `trinary` and `scale` give the same
    /// obstacles.
    ///
    /// The shade 205 of 255 (50 with `negate`) is an exception: ROS's map savers use it for unknown cells, so it means unknown
    /// even if `free_thresh` exceeds its `p` of 0.196. Colours are averaged. Pixels that are not opaque are unknown. The mode
    /// `raw` is refused, because its values are costs.
    ///
    /// # Errors
    /// An invalid description; a picture that is damaged, of another format or of more than [`MAX_CELLS`]; and a place too far
    /// away for the program's arithmetic.
    pub fn read(yaml: &Path) -> Result<Self, InputError> {
        let source = Source::read(yaml)?;
        let description = Description::read(&source)?;
        let image = &description.image;
        let path = yaml.with_file_name(&image.value);
        let (line, column) = (image.referenced.line() as usize, image.referenced.column() as usize);
        if !path.is_file() {
            let message = format!("there is no file {}", path.display());
            let help = "name the picture relative to this file";
            return Err(source.diagnostic_at_position(line, column, message).help(help).into());
        }
        let broken = |UnusablePicture { message, help }: UnusablePicture| {
            Diagnostic::new(path.display().to_string(), message).help(help)
        };
        let bytes = read_bounded(&path).map_err(|e| {
            broken(UnusablePicture::new(format!("cannot be read: {e}"), "check the file's permissions"))
        })?;
        let picture = picture(&bytes, &|shade| description.judge(shade)).map_err(broken)?;
        let size = [picture.width, picture.height];
        let [x, y, yaw] = description.origin;
        let extent = size[0].max(size[1]) as f64 * description.resolution;
        if x.abs().max(y.abs()) + 2.0 * extent > MAX_LENGTH {
            let message = format!(
                "a picture of {} x {} pixels with a resolution of {} m extends beyond {MAX_LENGTH:e} m",
                size[0], size[1], description.resolution
            );
            return Err(source
                .diagnostic(message)
                .help(format!("the resolution is in metres per pixel, and a map may extend to {MAX_LENGTH:e} m"))
                .into());
        }
        let pose = Pose::new(Vector::new(x, y), yaw);
        let notes = description.notes(picture.cells.contains(&Occupancy::Unknown));
        Ok(Self { size, resolution: description.resolution, pose, cells: picture.cells, notes, picture: Some(path) })
    }

    /// Returns the occupancy at a point. `None` outside the picture. A cell includes its lower and its left side.
    pub fn at(&self, place: Point) -> Option<Occupancy> {
        let cell = self.pose.inverse_point(place) / self.resolution;
        let [width, height] = self.size;
        if cell.x < 0.0 || cell.y < 0.0 || cell.x >= width as f64 || cell.y >= height as f64 {
            return None;
        }
        Some(self.cells[(height - 1 - cell.y as usize) * width + cell.x as usize])
    }

    /// Returns the solid cells as rectangles with disjoint interiors: occupied cells and, unless `unknown_is_free`, unknown
    /// cells. `None` if there are more than `most` rectangles; see [`rectangles`]. Corners that rectangles share are exactly
    /// equal.
    pub fn pieces(&self, unknown_is_free: bool, most: usize) -> Option<Vec<Convex>> {
        let is_solid = |cell: usize| match self.cells[cell] {
            Occupancy::Free => false,
            Occupancy::Occupied => true,
            Occupancy::Unknown => !unknown_is_free,
        };
        self.rectangles_of(is_solid, most)
    }

    /// Does the same as [`OccupancyMap::pieces`], for the cells for which `is_among` is true.
    pub fn rectangles_of(&self, is_among: impl Fn(usize) -> bool, most: usize) -> Option<Vec<Convex>> {
        let [width, height] = self.size;
        let corner = |x: usize, y: usize| {
            self.pose.point(Point::new(x as f64 * self.resolution, (height - y) as f64 * self.resolution))
        };
        let piece = |r: &PixelRectangle| {
            let ([left, right], [top, bottom]) = (r.columns, r.rows);
            Convex::trusted(
                vec![corner(left, bottom), corner(right, bottom), corner(right, top), corner(left, top)],
                0.0,
            )
        };
        Some(rectangles(self.size, |x, y| is_among(y * width + x), most)?.iter().map(piece).collect())
    }
}

/// Reads a picture, whose first bytes determine the format.
fn picture(bytes: &[u8], judge: Judge) -> Result<Picture, UnusablePicture> {
    const FORMAT_HINT: &str = "save it as PGM or PNG";
    match bytes {
        [b'P', b'2' | b'5', ..] => pgm::read(bytes, judge),
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes, judge),
        [b'P', kind @ b'1'..=b'7', ..] => {
            let format = match kind {
                b'1' | b'4' => "a bitmap of single bits (PBM)",
                b'7' => "a PAM",
                _ => "in colour (PPM)",
            };
            Err(UnusablePicture::new(format!("is {format}, not a greymap (PGM)"), FORMAT_HINT))
        }
        [0xff, 0xd8, ..] => {
            Err(UnusablePicture::new("is a JPEG, which does not preserve the shades of pixels", FORMAT_HINT))
        }
        [] => Err(UnusablePicture::new("is empty", FORMAT_HINT)),
        _ => Err(UnusablePicture::new("is neither PGM nor PNG", FORMAT_HINT)),
    }
}
