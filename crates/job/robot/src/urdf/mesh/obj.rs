//! Wavefront OBJ: lines that state vertices, and lines that state faces by the numbers of their vertices.

use super::Mesh;
use nalgebra::Point3;

pub(super) fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let (mut vertices, mut mesh) = (Vec::new(), Mesh::default());
    let mut lines = bytes.split(|&byte| byte == b'\n').zip(1..);
    let mut line = Vec::new();
    while let Some((mut piece, number)) = lines.next() {
        line.clear();
        while let Some(begun) = without_continuation_mark(piece) {
            line.extend_from_slice(begun);
            line.push(b' ');
            piece = lines.next().map_or(&[], |(next, _)| next);
        }
        line.extend_from_slice(piece);
        // Names may be in any encoding; all other words are ASCII.
        let line = String::from_utf8_lossy(&line);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.take(3).filter_map(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers[..] else { return Err(format!("line {number}: a vertex needs three numbers")) };
                vertices.push(Point3::new(x, y, z));
            }
            Some("f") => {
                let first = mesh.points.len();
                for word in words {
                    // The number of a vertex may be followed by slashes and the numbers of textures and normals. Negative numbers
                    // count from the end.
                    let vertex = word.split('/').next().and_then(|word| word.parse::<i64>().ok());
                    let index =
                        vertex.and_then(|k| if k < 0 { vertices.len() as i64 + k } else { k - 1 }.try_into().ok());
                    let point = index.and_then(|index: usize| vertices.get(index));
                    let unknown = || format!("line {number}: vertex \"{word}\" is not defined before this line");
                    mesh.points.push(*point.ok_or_else(unknown)?);
                }
                mesh.close_face(first);
            }
            _ => {}
        }
    }
    if mesh.points.is_empty() {
        return Err("the mesh has no face".into());
    }
    Ok(mesh)
}

/// Returns the content of a line that ends in a backslash and thus continues on the next line; `None` for other lines. Comments
/// do not continue, because they may contain Windows paths.
fn without_continuation_mark(line: &[u8]) -> Option<&[u8]> {
    line.trim_ascii_end().strip_suffix(b"\\").filter(|begun| !begun.trim_ascii_start().starts_with(b"#"))
}
