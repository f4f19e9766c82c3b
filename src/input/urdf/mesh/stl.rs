//! STL, binary or as text.

use nalgebra::Point3;
use std::io::Cursor;

/// Bytes of a binary STL before its triangles, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Vertices of the triangles.
pub(super) fn read(mut bytes: Vec<u8>) -> Result<Vec<Point3<f64>>, String> {
    let count = bytes.get(80..HEADER).and_then(|c| c.try_into().ok()).map(u32::from_le_bytes);
    let binary = count.is_some_and(|n| bytes.len() as u64 == HEADER as u64 + TRIANGLE as u64 * u64::from(n));
    if binary {
        // Exporters begin binary headers with "solid" too, by which readers tell text; the header means nothing else.
        bytes[..5].fill(0);
    } else if !bytes.starts_with(b"solid") {
        return Err("the file is no STL: its length does not fit its number of triangles".into());
    }
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|e| format!("the STL is broken: {e}"))?;
    if mesh.faces.is_empty() {
        return Err("the mesh has no triangle".into());
    }
    Ok(mesh.vertices.iter().map(|v| Point3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))).collect())
}
