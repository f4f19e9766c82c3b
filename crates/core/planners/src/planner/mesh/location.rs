//! Finds the triangle that contains a point.

use cplan_geometry::planar::{HalfEdges, starts};
use cplan_geometry::{Orientation, Point, orientation};

/// An index of triangles by vertical strips. The number of strips is the square root of the number of triangles.
#[derive(Debug, Clone)]
pub struct Columns {
    left: f64,
    /// Number of strips per unit of length.
    density: f64,
    /// The triangles of strip `k` are `triangles[first[k]..first[k + 1]]`.
    first: Vec<u32>,
    triangles: Vec<Entry>,
}

/// A triangle with its range of ordinates.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    low: f64,
    high: f64,
    triangle: u32,
}

impl Columns {
    /// Builds the index. For `n` triangles it has `O(n)` entries if they have similar sizes, and `O(n sqrt n)` if each
    /// is as wide as free space.
    pub fn new(vertices: &[Point], edges: &HalfEdges) -> Self {
        let count = edges.origin.len() / 3;
        let strips = (count as f64).sqrt().ceil().max(1.0);
        // The vertices are sorted by abscissa.
        let (left, right) = (vertices.first().map_or(0.0, |p| p.x), vertices.last().map_or(0.0, |p| p.x));
        let density = if right > left { strips / (right - left) } else { 0.0 };
        let mut columns = Self { left, density, first: vec![0; strips as usize + 1], triangles: Vec::new() };
        let range = |t: usize| {
            let x = [0, 1, 2].map(|k| vertices[edges.origin[3 * t + k] as usize].x);
            columns.strip(x[0].min(x[1]).min(x[2]))..=columns.strip(x[0].max(x[1]).max(x[2]))
        };
        let ranges: Vec<_> = (0..count).map(range).collect();
        columns.first = starts(strips as usize, ranges.iter().cloned().flatten());
        let mut place = columns.first.clone();
        columns.triangles = vec![Entry::default(); columns.first.last().map_or(0, |&n| n as usize)];
        for (t, range) in ranges.into_iter().enumerate() {
            let y = [0, 1, 2].map(|k| vertices[edges.origin[3 * t + k] as usize].y);
            let (low, high) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
            for strip in range {
                columns.triangles[place[strip] as usize] = Entry { low, high, triangle: t as u32 };
                place[strip] += 1;
            }
        }
        columns
    }

    /// Returns the strip that contains an abscissa, or the nearest strip. The function is monotone in spite of
    /// rounding. So a point within a triangle's range of abscissae is in one of the triangle's strips.
    fn strip(&self, x: f64) -> usize {
        // Casts from floats saturate: the result is 0 to the left of all strips.
        (((x - self.left) * self.density) as usize).min(self.first.len() - 2)
    }

    pub fn triangles_at<'a>(
        &'a self,
        vertices: &'a [Point],
        edges: &'a HalfEdges,
        p: Point,
    ) -> impl Iterator<Item = u32> + 'a {
        let strip = self.strip(p.x);
        let entries = &self.triangles[self.first[strip] as usize..self.first[strip + 1] as usize];
        let contains = move |t: u32| {
            let [a, b, c] = [0, 1, 2].map(|k| vertices[edges.origin[3 * t as usize + k] as usize]);
            [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| orientation(a, b, p) != Orientation::Clockwise)
        };
        entries.iter().filter(move |e| e.low <= p.y && p.y <= e.high).map(|e| e.triangle).filter(move |&t| contains(t))
    }
}
