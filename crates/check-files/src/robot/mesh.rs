//! Reads meshes: the corners of faces, whose convex hull is the collision shape, and the edges between corners.

use super::pose::Vector;
use super::solid::Mesh;
use super::tree::{ReadResult, Tree};
use super::{collada, manifest};
use crate::files::Files;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval};
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;
use roxmltree::Node;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Number of bytes of a binary STL before its triangles.
const STL_HEADER_BYTES: usize = 84;
/// Number of bytes of each triangle of a binary STL.
const STL_TRIANGLE_BYTES: usize = 50;
/// Number of bytes of a triangle's normal, which precedes its corners.
const STL_NORMAL_BYTES: usize = 12;

/// Number of folders above the URDF in which packages are searched.
const MAX_PARENT_FOLDERS: usize = 5;

/// Coordinates of a corner as the bits of single-precision numbers, as in STL.
type Single = [u32; 3];

impl<'a> Tree<'a> {
    /// Reads a `<mesh>`. The outer error is a mistake in the URDF, the inner one the reason why the mesh's file cannot be read.
    pub(super) fn mesh(&self, node: Node<'a, 'a>) -> ReadResult<ReadResult<Mesh>> {
        let is_scaled = node.has_attribute("scale");
        let scale = if is_scaled { self.vector(node, "scale")? } else { [1; 3].map(Interval::whole) };
        let Mesh { points, edges } = match read(self.files, self.text(node, "filename")?) {
            Err(CheckError::Input { message, .. }) => return Ok(self.error(node, message)),
            mesh => mesh?,
        };
        Ok(Ok(Mesh { points: points.into_iter().map(|p| [0, 1, 2].map(|k| &p[k] * &scale[k])).collect(), edges }))
    }
}

/// Returns the distinct corners of faces, and the edges around all faces as pairs of indices of corners.
fn of_faces<T: Ord + Copy>(faces: &[Vec<T>]) -> (Vec<T>, Vec<[usize; 2]>) {
    let corners: BTreeSet<T> = faces.iter().flatten().copied().collect();
    let corners: Vec<T> = corners.into_iter().collect();
    let mut edges = BTreeSet::new();
    for face in faces {
        let numbers: Vec<usize> = face.iter().map(|corner| corners.partition_point(|other| other < corner)).collect();
        edges.extend((0..face.len()).map(|k| {
            let [a, b] = [numbers[k], numbers[(k + 1) % face.len()]];
            [a.min(b), a.max(b)]
        }));
    }
    (corners, edges.into_iter().collect())
}

/// Reads a mesh from its file.
///
/// # Errors
/// If the file is not found, cannot be read, or has another format.
fn read(files: &Files, name: &str) -> Result<Mesh, CheckError> {
    let wrong = |why: &str| CheckError::in_file(Input::Urdf, format!("mesh \"{name}\": {why}"));
    let read: fn(&[u8]) -> Result<Mesh, String> = match name.to_lowercase().rsplit_once('.') {
        Some((_, "stl")) => stl,
        Some((_, "obj")) => obj,
        Some((_, "dae")) => |bytes| Ok(Mesh { points: collada::vertices(bytes)?, edges: Vec::new() }),
        _ => return Err(wrong("the checker reads only meshes in STL, OBJ and Collada (.dae)")),
    };
    let path = candidates(name, files.path(Input::Urdf)?).into_iter().find(|path| path.is_file());
    let bytes = files.bytes(Input::Urdf, &path.ok_or_else(|| wrong("it does not exist"))?)?;
    match read(&bytes) {
        Ok(mesh) if mesh.points.is_empty() => Err(wrong("it has no corners")),
        read => read.map_err(|why| wrong(&why)),
    }
}

/// Reads the triangles of an STL, in text or binary form.
fn stl(bytes: &[u8]) -> Result<Mesh, String> {
    let count = bytes
        .get(STL_HEADER_BYTES - 4..STL_HEADER_BYTES)
        .map(|count| count.iter().rev().fold(0, |sum, b| sum << 8 | usize::from(*b)));
    let triangles = match count {
        Some(count) if bytes.len() == STL_HEADER_BYTES + STL_TRIANGLE_BYTES * count => {
            in_bytes(&bytes[STL_HEADER_BYTES..])
        }
        _ => std::str::from_utf8(bytes).ok().and_then(as_text).ok_or("this is not an STL file")?,
    };
    let (corners, edges) = of_faces(&triangles);
    let points: Option<Vec<Vector>> = corners.into_iter().map(exact_vector).collect();
    Ok(Mesh { points: points.ok_or("a corner is not finite")?, edges })
}

/// Reads the faces of an OBJ. A line that ends in a backslash continues on the next line, unless it is a comment.
fn obj(bytes: &[u8]) -> Result<Mesh, String> {
    let text = String::from_utf8_lossy(bytes);
    let (mut vertices, mut faces, mut lines) = (Vec::<Vector>::new(), Vec::new(), text.split('\n'));
    while let Some(mut piece) = lines.next() {
        let mut line = String::new();
        while let Some(begun) = piece.trim_end().strip_suffix('\\').filter(|begun| !begun.trim_start().starts_with('#'))
        {
            line += begun;
            line.push(' ');
            piece = lines.next().unwrap_or_default();
        }
        line += piece;
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<Decimal> = words.take(3).map(Decimal::read).collect::<Result<_, _>>()?;
                let point = <[Decimal; 3]>::try_from(numbers).map_err(|_| "a vertex needs three numbers")?;
                vertices.push(point.each_ref().map(Interval::from));
            }
            // Slashes separate the numbers of textures and normals. Negative numbers count from the end.
            Some("f") => {
                let mut face = Vec::new();
                for word in words {
                    let number = word.split('/').next().and_then(|number| number.parse::<i64>().ok());
                    let at = number.map(|n| if n < 0 { n.saturating_add(vertices.len() as i64) } else { n - 1 });
                    let at = at.and_then(|at| usize::try_from(at).ok()).filter(|at| *at < vertices.len());
                    face.push(at.ok_or("a face uses a vertex that is not defined before it")?);
                }
                faces.push(face);
            }
            // Skip appearance, names and other keys that do not affect the shape.
            None
            | Some("vt" | "vn" | "vp" | "g" | "o" | "s" | "mg" | "usemtl" | "mtllib" | "shadow_obj" | "trace_obj") => {}
            Some(word) if word.starts_with('#') => {}
            Some(word) => return Err(format!("the checker does not know \"{word}\" in an OBJ")),
        }
    }
    let (shown, edges) = of_faces(&faces);
    Ok(Mesh { points: shown.into_iter().map(|at| vertices[at].clone()).collect(), edges })
}

fn in_bytes(triangles: &[u8]) -> Vec<Vec<Single>> {
    let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u32::from(*byte));
    let corner = |bytes: &[u8]| [0, 4, 8].map(|at| number(&bytes[at..at + 4]));
    let triangle = |bytes: &[u8]| bytes[STL_NORMAL_BYTES..STL_NORMAL_BYTES + 36].chunks_exact(12).map(corner).collect();
    triangles.chunks_exact(STL_TRIANGLE_BYTES).map(triangle).collect()
}

/// Reads the triangles of all solids of an STL in text form. Returns `None` if the text is not an STL.
fn as_text(text: &str) -> Option<Vec<Vec<Single>>> {
    let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let mut lines = lines.filter(|words| !words.is_empty());
    let mut triangles = Vec::new();
    while let Some(words) = lines.next() {
        (words[0] == "solid").then_some(())?;
        loop {
            match lines.next()?[..] {
                ["endsolid", ..] => break,
                ["facet", "normal", _, _, _] => {}
                _ => return None,
            }
            (lines.next()?[..] == ["outer", "loop"]).then_some(())?;
            let mut triangle = Vec::new();
            for _ in 0..3 {
                let ["vertex", x, y, z] = lines.next()?[..] else { return None };
                let number = |word: &str| Some(word.parse::<f32>().ok()?.to_bits());
                triangle.push([number(x)?, number(y)?, number(z)?]);
            }
            triangles.push(triangle);
            (lines.next()?[..] == ["endloop"]).then_some(())?;
            (lines.next()?[..] == ["endfacet"]).then_some(())?;
        }
    }
    Some(triangles)
}

/// Returns the exact values of single-precision numbers. Returns `None` if one is infinite or not a number.
fn exact_vector(corner: Single) -> Option<Vector> {
    let number = |bits: u32| {
        let (exponent, fraction) = (bits >> 23 & 0xff, bits & 0x7f_ffff);
        let digits = BigInt::from(if exponent == 0 { fraction } else { fraction | 1 << 23 });
        let signed = if bits >> 31 == 1 { -digits } else { digits };
        // A unit of the last digit is `2^(exponent - 150)`.
        (exponent < 0xff).then(|| Interval::exact(signed << (exponent.max(1) + BITS - 150)))
    };
    let [x, y, z] = corner.map(number);
    Some([x?, y?, z?])
}

/// Returns the paths at which a mesh may be: relative to the URDF, or in a package. For `package://NAME/...`, these are
/// first the folders whose `package.xml` states NAME, in or below the folders above the URDF and those of
/// `ROS_PACKAGE_PATH`. Then they are folders called NAME in the same places and in `AMENT_PREFIX_PATH`.
fn candidates(name: &str, urdf: &Path) -> Vec<PathBuf> {
    let Some(rest) = name.strip_prefix("package://") else {
        return vec![urdf.with_file_name(name.strip_prefix("file://").unwrap_or(name))];
    };
    let (package, inside) = rest.split_once('/').unwrap_or((rest, ""));
    let from = |variable: &str| {
        let paths = std::env::var_os(variable).unwrap_or_default();
        std::env::split_paths(&paths).filter(|path| !path.as_os_str().is_empty()).collect::<Vec<_>>()
    };
    let folder = urdf.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let above = folder.ancestors().map(Path::to_owned);
    let ros = from("ROS_PACKAGE_PATH");
    let ament = from("AMENT_PREFIX_PATH").into_iter().map(|path| path.join("share"));
    let is_package = |folder: &Path| folder.file_name().is_some_and(|name| name == package);
    let named = |folder: PathBuf| {
        let own = is_package(&folder).then(|| folder.clone());
        own.into_iter().chain([folder.join(package)])
    };
    let places: Vec<PathBuf> = above.chain(ros).collect();
    // Do not search above the root of a repository.
    let repository =
        places.iter().position(|place| place.join(".git").exists()).map_or(MAX_PARENT_FOLDERS, |at| at + 1);
    let declared =
        places.iter().take(repository.min(MAX_PARENT_FOLDERS)).flat_map(|place| manifest::declared(package, place));
    let called = places.iter().cloned().chain(ament).flat_map(named);
    declared.chain(called).map(|package| package.join(inside)).collect()
}
