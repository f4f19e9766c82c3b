//! STL, binary or as text.

use super::Mesh;
use nalgebra::Point3;
use std::io::Cursor;

/// Number of bytes before the triangles of a binary STL (`HEADER_BYTES`), and number of bytes of a triangle.
const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

pub(super) fn read(mut bytes: Vec<u8>) -> Result<Mesh, String> {
    let count = bytes.get(80..HEADER_BYTES).and_then(|c| c.try_into().ok()).map(u32::from_le_bytes);
    let binary =
        count.is_some_and(|n| bytes.len() as u64 == HEADER_BYTES as u64 + TRIANGLE_BYTES as u64 * u64::from(n));
    let mesh = if binary {
        // The headers of some binary files begin with "solid", which readers take as a sign of text. The header has no other
        // meaning, so the word is removed.
        bytes[..5].fill(0);
        let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|e| format!("the STL is broken: {e}"))?;
        let points =
            mesh.vertices.iter().map(|v| Point3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))).collect();
        let edges = |[a, b, c]: [usize; 3]| [[a, b], [b, c], [c, a]].map(|edge| edge.map(|corner| corner as u32));
        Mesh { points, edges: mesh.faces.iter().flat_map(|face| edges(face.vertices)).collect() }
    } else if bytes.starts_with(b"solid") {
        text(&String::from_utf8_lossy(&bytes))?
    } else {
        return Err("this is not an STL file: the length of the file does not match the number of triangles".into());
    };
    if mesh.points.is_empty() { Err("the mesh has no triangle".into()) } else { Ok(mesh) }
}

/// Reads the triangles of a text STL, which may contain several solids. (`stl_io` reads only the first one.)
fn text(text: &str) -> Result<Mesh, String> {
    /// The lines of a triangle, by their first words.
    const FACET_LINES: [&str; 7] = ["facet normal", "outer loop", "vertex", "vertex", "vertex", "endloop", "endfacet"];
    let mut mesh = Mesh::default();
    // Index of the expected line of a triangle. `None` outside solids.
    let mut next: Option<usize> = None;
    for (number, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(first) = words.first() else { continue };
        next = match next {
            None if *first == "solid" => Some(0),
            Some(0) if *first == "endsolid" => None,
            Some(k) if words.join(" ").starts_with(FACET_LINES[k]) => {
                let numbers = &words[FACET_LINES[k].split(' ').count()..];
                let parsed: Vec<f64> =
                    numbers.iter().filter_map(|word| word.parse::<f32>().ok().map(f64::from)).collect();
                match (FACET_LINES[k], &parsed[..]) {
                    ("vertex", &[x, y, z]) if numbers.len() == 3 => mesh.points.push(Point3::new(x, y, z)),
                    ("facet normal", _) if numbers.len() == 3 => {}
                    ("outer loop" | "endloop", _) if numbers.is_empty() => {}
                    ("endfacet", _) if numbers.is_empty() => mesh.close_face(mesh.points.len() - 3),
                    _ => return Err(format!("the STL is broken: line {}: {:?}", number + 1, line.trim())),
                }
                Some((k + 1) % FACET_LINES.len())
            }
            _ => return Err(format!("the STL is broken: line {}: {:?}", number + 1, line.trim())),
        };
    }
    match next {
        None => Ok(mesh),
        Some(_) => Err("the STL is broken: the last solid does not end".into()),
    }
}
