//! Covers many small pieces by few polygons. The polygons consist of the cells of a lattice that the pieces meet.

use cplan_geometry::{Convex, Point, farthest, hull};
use cplan_interrupt::checkpoint;

/// Relative enlargement of pieces. It exceeds the rounding of cells.
const ROUNDING: f64 = 1e-13;

/// Largest total number of rows that the pieces cross. With more, the computation of the covering would take longer
/// than it saves.
const MAX_CROSSINGS: f64 = 4e7;

/// Adjacent cells of a row, from the first column to the last.
type Run = [i64; 2];

/// Returns convex polygons whose union contains all `pieces` and extends at most `within` beyond them. No piece may
/// be rounded. Returns `None` if the covering would take too long.
///
/// The diagonal of a cell is half of `within`. So if a piece meets a cell, each point of the cell is that close to the
/// piece. Runs of such cells in consecutive rows form a stack. Each stack is cut into convex polygons that extend at
/// most the other half of `within` beyond its cells. There are at most as many polygons as runs, however many pieces
/// there are. `O(n log n)` for `n` crossings of pieces with rows.
pub(super) fn covering(pieces: &[Convex], within: f64) -> Option<Vec<Convex>> {
    debug_assert!(pieces.iter().all(|piece| piece.radius() == 0.0), "pieces with corners");
    let lattice = Lattice::new(pieces, within / 2.0)?;
    let mut polygons = Vec::new();
    for stack in stacks(lattice.runs(pieces)) {
        checkpoint();
        lattice.convex(&stack, within / 2.0, &mut polygons);
    }
    Some(polygons)
}

/// A lattice of square cells, numbered by column and row.
struct Lattice {
    origin: Point,
    /// Length of a cell's side, metres.
    side: f64,
    rows: usize,
    /// Distance by which pieces are enlarged, metres.
    pad: f64,
}

impl Lattice {
    /// Creates a lattice of cells with this diagonal that covers all pieces. `None` if the pieces cross too many rows,
    /// or if rounding of the coordinates is too large for the cells.
    fn new(pieces: &[Convex], diagonal: f64) -> Option<Self> {
        let first = pieces.first()?.bounds();
        let [lower, upper] = pieces.iter().map(Convex::bounds).fold(first, |[l, u], b| [l.inf(&b[0]), u.sup(&b[1])]);
        let largest = lower.amax().max(upper.amax());
        let (side, pad) = (diagonal / 2_f64.sqrt() * (1.0 - 1e-9), ROUNDING * largest);
        let height = |[lower, upper]: [Point; 2]| (upper.y - lower.y) / side + 2.0;
        let crossings: f64 = pieces.iter().map(|piece| height(piece.bounds())).sum();
        let few = crossings <= MAX_CROSSINGS && (upper.x - lower.x) / side <= MAX_CROSSINGS;
        // Cells must be much larger than rounding errors to contain the pieces.
        (few && pad < side / 1024.0).then(|| {
            let pads = cplan_geometry::Vector::repeat(pad);
            let rows = height([lower, upper]) as usize + 1;
            Self { origin: lower - pads, side, rows, pad }
        })
    }

    fn column(&self, x: f64) -> i64 {
        ((x - self.origin.x) / self.side).floor() as i64
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) / self.side).floor().max(0.0) as usize).min(self.rows - 1)
    }

    fn corner(&self, column: i64, row: usize) -> Point {
        Point::new(self.origin.x + column as f64 * self.side, self.origin.y + row as f64 * self.side)
    }

    /// Returns, for each row, the runs of cells that pieces meet. They are disjoint, not adjacent, and ascending.
    fn runs(&self, pieces: &[Convex]) -> Vec<Vec<Run>> {
        let mut rows = vec![Vec::new(); self.rows];
        // To limit the memory, runs of a row are merged when there are this many.
        let mut full = vec![64; self.rows];
        for piece in pieces {
            checkpoint();
            let [lower, upper] = piece.bounds();
            for row in self.row(lower.y - self.pad)..=self.row(upper.y + self.pad) {
                let [bottom, top] = [row, row + 1].map(|row| self.corner(0, row).y);
                if let Some([left, right]) = extent(piece.core(), bottom - self.pad, top + self.pad) {
                    rows[row].push([self.column(left - self.pad), self.column(right + self.pad)]);
                    if rows[row].len() > full[row] {
                        merge(&mut rows[row]);
                        full[row] = 64.max(2 * rows[row].len());
                    }
                }
            }
        }
        rows.iter_mut().for_each(merge);
        rows
    }

    /// Cuts a stack into convex polygons that extend at most `within` beyond its cells. Galloping search finds the
    /// greatest number of rows for each polygon. `O(n log n)`.
    fn convex(&self, stack: &Stack, within: f64, out: &mut Vec<Convex>) {
        let allowed = within / self.side;
        let fits = |from: usize, to: usize| {
            let runs = &stack.runs[from..to];
            let side = |sign: i64, end: usize| bulge(runs.iter().map(|run| sign * (run[end] + end as i64))) <= allowed;
            side(1, 0) && side(-1, 1)
        };
        let count = stack.runs.len();
        let mut from = 0;
        while from < count {
            let to = farthest(from + 1, count, |to| fits(from, to));
            let corners = |row: usize| {
                let [left, right] = stack.runs[row];
                [row, row + 1].map(|at| [left, right + 1].map(|column| self.corner(column, stack.bottom + at)))
            };
            let corners: Vec<Point> = (from..to).flat_map(corners).flatten().collect();
            out.push(Convex::trusted(hull(&corners), 0.0));
            from = to;
        }
    }
}

/// Returns the least and the greatest abscissa of a convex polygon, segment or point within a horizontal strip. `None`
/// if it does not meet the strip.
fn extent(core: &[Point], bottom: f64, top: f64) -> Option<[f64; 2]> {
    let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |x: f64| extent = [extent[0].min(x), extent[1].max(x)];
    for (i, a) in core.iter().enumerate() {
        if bottom <= a.y && a.y <= top {
            add(a.x);
        }
        let b = core[(i + 1) % core.len()];
        for y in [bottom, top] {
            if (a.y < y) != (b.y < y) {
                // Rounding must not put the crossing outside the side's range.
                add((a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y))).clamp(a.x.min(b.x), a.x.max(b.x)));
            }
        }
    }
    (extent[0] <= extent[1]).then_some(extent)
}

/// Merges runs into disjoint, non-adjacent, ascending runs of the same cells.
fn merge(runs: &mut Vec<Run>) {
    runs.sort_unstable();
    runs.dedup_by(|next, kept| {
        let one = next[0] <= kept[1] + 1;
        if one {
            kept[1] = kept[1].max(next[1]);
        }
        one
    });
}

/// Runs in consecutive rows. Each run meets exactly one run of the next row.
struct Stack {
    /// The row of the first run.
    bottom: usize,
    runs: Vec<Run>,
}

fn stacks(rows: Vec<Vec<Run>>) -> Vec<Stack> {
    let (mut done, mut open): (Vec<Stack>, Vec<Stack>) = (Vec::new(), Vec::new());
    for (row, runs) in rows.into_iter().enumerate() {
        // For each stack, the number of runs that it meets, and the last of them. For each run, the same for stacks.
        let mut of_stack = vec![(0, 0); open.len()];
        let mut of_run = vec![(0, 0); runs.len()];
        let (mut i, mut j) = (0, 0);
        while i < open.len() && j < runs.len() {
            let top = open[i].runs[open[i].runs.len() - 1];
            if top[0].max(runs[j][0]) <= top[1].min(runs[j][1]) {
                of_stack[i] = (of_stack[i].0 + 1, j);
                of_run[j] = (of_run[j].0 + 1, i);
            }
            if top[1] < runs[j][1] { i += 1 } else { j += 1 }
        }
        let mut before: Vec<Option<Stack>> = open.into_iter().map(Some).collect();
        open = runs
            .iter()
            .zip(of_run)
            .map(|(&run, (count, stack))| {
                let goes_on = count == 1 && of_stack[stack].0 == 1;
                let below = if goes_on { before[stack].take() } else { None };
                let mut stack = below.unwrap_or_else(|| Stack { bottom: row, runs: Vec::new() });
                stack.runs.push(run);
                stack
            })
            .collect();
        done.extend(before.into_iter().flatten());
    }
    done.extend(open);
    done
}

/// Returns the distance by which the convex hull of a stack extends beyond its left side, in cells. `columns` are the
/// columns at which the rows start.
///
/// Between two corners of the hull, the left side lies within a band along their chord. The width of the band is the distance of
/// the side's farthest corner from the chord. So a point between chord and side is at most that far from the side.
fn bulge(columns: impl Iterator<Item = i64>) -> f64 {
    // The corners of the left side, from bottom to top.
    let side: Vec<[i64; 2]> = columns.enumerate().flat_map(|(row, x)| [0, 1].map(|at| [x, row as i64 + at])).collect();
    let cross = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    // The left side of the hull, which turns right on the way up.
    let mut chain: Vec<usize> = Vec::new();
    for (k, &corner) in side.iter().enumerate() {
        while let &[.., a, b] = chain.as_slice()
            && cross(side[a], side[b], corner) >= 0
        {
            chain.pop();
        }
        chain.push(k);
    }
    let off = |ends: &[usize]| {
        let (a, b) = (side[ends[0]], side[ends[1]]);
        let length = ((b[0] - a[0]) as f64).hypot((b[1] - a[1]) as f64);
        side[ends[0]..=ends[1]].iter().map(move |&p| cross(a, b, p).abs() as f64 / length.max(1.0)).fold(0.0, f64::max)
    };
    chain.windows(2).map(off).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::{separation, shapes_meet};
    use proptest::prelude::*;

    fn distance(p: Point, shapes: &[Convex]) -> f64 {
        let to = |shape: &Convex| separation(&Convex::point(p), shape).distance;
        shapes.iter().map(to).fold(f64::INFINITY, f64::min)
    }

    /// Returns points of a shape: its corners, and weighted means of its corners.
    fn points_of(shape: &Convex, shares: &[f64]) -> Vec<Point> {
        let core = shape.core();
        let between = |k: usize| {
            let (a, b, c) = (core[k % core.len()], core[(k + 1) % core.len()], core[(k * 7 + 2) % core.len()]);
            let share = |i: usize| shares[(k + i) % shares.len()];
            let along = a + (b - a) * share(0);
            [a, along, along + (c - along) * share(1)]
        };
        (0..3 * core.len()).flat_map(between).collect()
    }

    /// Asserts that polygons cover pieces, and extend at most `within` beyond them. Tests sampled points.
    fn assert_covers(pieces: &[Convex], polygons: &[Convex], within: f64, shares: &[f64]) {
        for p in pieces.iter().flat_map(|piece| points_of(piece, shares)) {
            // Rounding puts a weighted mean of corners off its segment or side.
            let dot = Convex::point(p).grown(1e-14);
            assert!(polygons.iter().any(|polygon| shapes_meet(&dot, polygon)), "{p} is left out");
        }
        for p in polygons.iter().flat_map(|polygon| points_of(polygon, shares)) {
            let off = distance(p, pieces);
            assert!(off <= within * (1.0 + 1e-6), "{p} is {off} away, more than {within}");
        }
    }

    /// Points, position and size of a piece. The flag is true if its corners may lie anywhere, and false if they lie on
    /// a lattice.
    type Given = (Vec<(f64, f64)>, (f64, f64, f64), bool);

    /// Generates pieces. Their corners lie anywhere, or on a lattice. On a lattice, sides often touch lattice lines, or
    /// are horizontal or vertical.
    fn pieces() -> impl Strategy<Value = Vec<Convex>> {
        let spread = |free: bool, v: f64| if free { v } else { (v * 8.0).round() / 8.0 };
        let piece = prop::collection::vec((-0.5..0.5f64, -0.5..0.5f64), 1..6);
        let place = (-1.0..1.0f64, -1.0..1.0f64, 0.01..1.0f64);
        prop::collection::vec((piece, place, any::<bool>()), 1..12).prop_map(move |all| {
            let convex = |(points, (x, y, size), free): Given| {
                let at = |(px, py)| Point::new(spread(free, x + size * px), spread(free, y + size * py));
                Convex::trusted(hull(&points.into_iter().map(at).collect::<Vec<_>>()), 0.0)
            };
            all.into_iter().map(convex).collect()
        })
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(200))]

        #[test]
        fn polygons_cover_all_pieces_and_little_more(
            pieces in pieces(), within in prop_oneof![0.01..0.4f64, Just(0.25)],
            shares in prop::collection::vec(0.0..=1.0f64, 7),
        ) {
            let polygons = covering(&pieces, within).expect("few rows");
            assert_covers(&pieces, &polygons, within, &shares);
        }

        /// Compares the bulge with distances between a side's corners and the hull, computed directly.
        #[test]
        fn a_bulge_is_the_depth_of_the_deepest_pocket(columns in prop::collection::vec(-6..6i64, 1..12)) {
            // The stack extends far to the right, so only the left side of the hull is near.
            let corner = |(row, x): (usize, i64)| [0, 1].map(|at| Point::new(x as f64, (row + at) as f64));
            let side: Vec<Point> = columns.iter().copied().enumerate().flat_map(corner).collect();
            let right = [0.0, columns.len() as f64].map(|y| Point::new(100.0, y));
            let outline = hull(&side.iter().copied().chain(right).collect::<Vec<_>>());
            let depth = |p: &Point| {
                let sides = (0..outline.len()).map(|i| Convex::between(outline[i], outline[(i + 1) % outline.len()]));
                distance(*p, &sides.collect::<Vec<_>>())
            };
            let deepest = side.iter().map(depth).fold(0.0, f64::max);
            let found = bulge(columns.iter().copied());
            // The distance from the line of a chord is at most the distance from the hull.
            prop_assert!(found + 1e-9 >= deepest, "{found} {deepest}");
        }
    }

    #[test]
    fn any_decomposition_of_a_disc_becomes_one_polygon() {
        let at = |k: usize| {
            Point::new(
                (k as f64 / 300.0 * std::f64::consts::TAU).cos(),
                (k as f64 / 300.0 * std::f64::consts::TAU).sin(),
            )
        };
        let slices: Vec<Convex> =
            (0..300).map(|k| Convex::trusted(vec![Point::zeros(), at(k), at(k + 1)], 0.0)).collect();
        let polygons = covering(&slices, 0.02).unwrap();
        assert_eq!(polygons.len(), 1);
        assert_covers(&slices, &polygons, 0.02, &[0.2, 0.7, 1.0]);
    }

    /// Tests that a hundred thousand short segments in a square need few polygons: about as many as the square has
    /// cells along its sides.
    #[test]
    fn pieces_of_a_square_are_covered_by_about_the_square() {
        let step = |k: u64| (k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / (1_u64 << 24) as f64;
        let at = |k: u64| Point::new(step(2 * k), step(2 * k + 1));
        let segments: Vec<Convex> =
            (0..100_000).map(|k| Convex::between(at(k), at(k) + (at(k + 7) - Point::new(0.5, 0.5)) * 0.02)).collect();
        let polygons = covering(&segments, 0.02).unwrap();
        assert!(polygons.len() < 300, "{}", polygons.len());
    }
}
