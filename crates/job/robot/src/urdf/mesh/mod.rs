//! Mesh files: the search for them, and their vertices and edges.

mod dae;
mod obj;
mod stl;

use crate::quantity::MAX_LENGTH;
use crate::source::read_bounded;
use crate::urdf::document::Document;
use cplan_packages::packages;
use nalgebra::Point3;
use std::path::{Path, PathBuf};

/// The surface of a mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Mesh {
    /// Vertices of its faces.
    pub points: Vec<Point3<f64>>,
    /// Edges of the faces, as pairs of indices into `points`. An edge may occur more than once. Empty if the reader of the format
    /// ignores faces.
    pub edges: Vec<[u32; 2]>,
}

impl Mesh {
    /// Adds the edges of a face. Its corners are the points from index `first` to the last one.
    fn close_face(&mut self, first: usize) {
        let corners = first as u32..self.points.len() as u32;
        let next = corners.clone().cycle().skip(1);
        self.edges.extend(corners.zip(next).map(|(from, to)| [from, to]));
    }
}

/// The reason why a mesh cannot be read, with a hint.
pub(super) struct UnreadableMesh {
    pub message: String,
    pub cure: &'static str,
}

impl From<String> for UnreadableMesh {
    fn from(message: String) -> Self {
        let cure = "correct the path; or put the package folder beside the URDF, or its parent folder into ROS_PACKAGE_PATH; convert other formats to STL; or replace the links by bars between the joints, in the world file: [robot] bar = 0.05 (radius of the bars in metres)";
        Self { message, cure }
    }
}

/// Reads a mesh, scaled, in the geometry's frame.
///
/// `filename` is as in the URDF: `package://name/rest` (with the `name` in `package.xml`), `file://path`, absolute, or relative
/// to the URDF's folder.
///
/// # Errors
/// The reason, with the searched places: a missing file, a URDF in memory, or a mesh of an unknown format, damaged or too large.
pub(super) fn read(filename: &str, scale: [f64; 3], document: &Document) -> Result<Mesh, UnreadableMesh> {
    let extension = Path::new(filename).extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !["stl", "dae", "obj"].contains(&extension.as_str()) {
        let message = format!("mesh \"{filename}\": cplan reads only meshes in STL, Collada (.dae) and OBJ");
        return Err(message.into());
    }
    let anchor = document.source.anchor().map_err(|why| format!("mesh \"{filename}\" cannot be found: {why}"))?;
    let path = find(filename, anchor)?;
    document.meshes.borrow_mut().push(path.clone());
    let bytes = read_bounded(&path).map_err(|e| format!("mesh {} cannot be read: {e}", path.display()))?;
    let mesh = match extension.as_str() {
        "stl" => stl::read(bytes),
        "dae" => dae::read(&bytes).map(|points| Mesh { points, edges: Vec::new() }),
        _ => obj::read(&bytes),
    };
    let Mesh { points, edges } = mesh.map_err(|e| format!("mesh {}: {e}", path.display()))?;
    let scaled: Vec<_> = points.iter().map(|p| Point3::new(p.x * scale[0], p.y * scale[1], p.z * scale[2])).collect();
    match scaled.iter().position(|p| !p.iter().all(|c| c.abs() <= MAX_LENGTH)) {
        None => Ok(Mesh { points: scaled, edges }),
        Some(far) => Err(too_far(&points[far], scale, &path)),
    }
}

/// Returns the error about a vertex that is not finite after scaling, or too far away for any arm.
fn too_far(vertex: &Point3<f64>, scale: [f64; 3], path: &Path) -> UnreadableMesh {
    let [x, y, z] = vertex.coords.into();
    let [a, b, c] = scale;
    let what = if vertex.iter().all(|c| c.is_finite()) { "too large" } else { "not finite" };
    let message = format!(
        "mesh {}: a vertex is {what}: ({x:?}, {y:?}, {z:?}) with scale=\"{a:?} {b:?} {c:?}\" (at most {MAX_LENGTH:e} m)",
        path.display()
    );
    let cure =
        "give the scale that converts its numbers to metres, such as 0.001 for millimetres, or export the mesh again";
    UnreadableMesh { message, cure }
}

/// Finds the file of a mesh.
///
/// # Errors
/// A message with the searched places.
pub fn find(filename: &str, urdf: &Path) -> Result<PathBuf, String> {
    if let Some(path) = candidates(filename, urdf).find(|path| path.is_file()) {
        return Ok(path);
    }
    let mut places: Vec<String> = candidates(filename, urdf).map(|path| path.display().to_string()).collect();
    places.dedup();
    Err(match places.is_empty() {
        false => format!("mesh \"{filename}\" does not exist; cplan looked for {}", places.join(", ")),
        true => format!("mesh \"{filename}\" does not exist: there is no package of this name near the URDF"),
    })
}

/// Iterates over the possible paths of a mesh, the most likely first.
fn candidates<'f>(filename: &'f str, urdf: &Path) -> Box<dyn Iterator<Item = PathBuf> + 'f> {
    let folder = urdf.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let Some(path) = filename.strip_prefix("file://") {
        return Box::new(std::iter::once(folder.join(path)));
    }
    match filename.strip_prefix("package://") {
        None => Box::new(std::iter::once(folder.join(filename))),
        Some(rest) => {
            let (package, inside) = rest.split_once('/').unwrap_or((rest, ""));
            Box::new(packages(package, urdf).map(move |folder| folder.join(inside)))
        }
    }
}
