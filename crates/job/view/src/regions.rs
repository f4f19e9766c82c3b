//! A raster of the visible parts of regions. With it, names of regions find the place with the most room.

use super::figure::{Rect, Step};

/// Side of a cell, in pixels.
const CELL: f64 = 4.0;
/// Value of a cell without a region.
const NOTHING: i32 = 0;
/// Value of a cell that no name may cover.
const BLOCKED: i32 = -1;
/// Least share of a name that must lie on its region.
const MIN_PART: f64 = 0.3;
/// Bonus per cell of distance for places nearer to the middle of a region. It only decides between otherwise equal places.
const CENTER_PREFERENCE: f64 = 1e-4;

/// Cells of a panel, each with the number of the uppermost region that covers its middle.
pub struct RegionRaster {
    page: Rect,
    columns: usize,
    rows: usize,
    /// Region of each cell, numbered from 1, row by row; [`BLOCKED`] for cells that no name may cover.
    cells: Vec<i32>,
    /// Region of each cell, whether or not it is blocked.
    full: Vec<i32>,
}

impl RegionRaster {
    /// Creates the raster of regions, each given by its outline of straight lines. Later regions cover earlier ones.
    pub fn new<'a>(page: Rect, regions: impl IntoIterator<Item = &'a [Step]>) -> Self {
        let [columns, rows] = [page.width, page.height].map(|side| (side / CELL).ceil().max(1.0) as usize);
        let mut raster = Self { page, columns, rows, cells: vec![NOTHING; columns * rows], full: Vec::new() };
        for (outline, id) in regions.into_iter().zip(1..) {
            raster.fill(outline, id);
        }
        raster.full.clone_from(&raster.cells);
        raster
    }

    /// Keeps names off a box.
    pub fn block(&mut self, place: &Rect) {
        let [x, y] = [self.page.x, self.page.y];
        let range = |low: f64, high: f64, count: usize| {
            let [from, to] = [low, high].map(|at| (at / CELL).floor());
            (from.max(0.0) as usize, (to.min(count as f64 - 1.0) + 1.0).max(0.0) as usize)
        };
        let (from, to) = range(place.x - x, place.right() - x, self.columns);
        let (top, bottom) = range(place.y - y, place.bottom() - y, self.rows);
        for row in top..bottom {
            let at = row * self.columns;
            self.cells.get_mut(at + from..at + to).into_iter().for_each(|cells| cells.fill(BLOCKED));
        }
    }

    /// Returns the middle of the best place in a region for a name of this size in pixels, and true if the name fits into the
    /// region there. `None` if no cell of the region is visible.
    ///
    /// A name that fits lies as far as possible from the region's outline. A name that sticks out has its middle on the region,
    /// and covers no other region.
    pub fn roomiest(&self, region: usize, size: [f64; 2], may_stick_out: bool) -> Option<([f64; 2], bool)> {
        let size = size.map(|side| (side / CELL).ceil() as usize);
        let search = Search::new(self, &self.cells, region, size)?;
        search.roomiest(may_stick_out).map(|(at, fits)| (self.on_page(at), fits))
    }

    /// Returns the vertical stretch of a region through a place, as a box without width.
    pub fn upright_part(&self, region: usize, [x, y]: [f64; 2]) -> Rect {
        let [column, row] = [x - self.page.x, y - self.page.y].map(|at| (at / CELL).floor().max(0.0) as usize);
        let is_own = |row: &usize| {
            let cell = (column < self.columns).then(|| self.full.get(row * self.columns + column)).flatten();
            cell == Some(&(region as i32 + 1))
        };
        let above = (0..row).rev().take_while(is_own).count();
        let below = (row..self.rows).take_while(is_own).count();
        let top = self.page.y + (row - above) as f64 * CELL;
        Rect { x, y: top, width: 0.0, height: (above + below) as f64 * CELL }
    }

    /// Returns the middle of the largest part of a region, even if it is blocked.
    pub fn any_part(&self, region: usize) -> Option<[f64; 2]> {
        let (at, _) = Search::new(self, &self.full, region, [1, 1])?.roomiest(true)?;
        Some(self.on_page(at))
    }

    /// Returns the share of a box that lies on regions other than `except`, sampled at 15 points.
    pub fn covered_share(&self, place: &Rect, except: Option<usize>) -> f64 {
        let own = except.map_or(NOTHING, |region| region as i32 + 1);
        let spots = (0..5).flat_map(|i| (0..3).map(move |j| [(f64::from(i) + 0.5) / 5.0, (f64::from(j) + 0.5) / 3.0]));
        let is_region = |[x, y]: [f64; 2]| {
            let at = [place.x + place.width * x - self.page.x, place.y + place.height * y - self.page.y];
            let [column, row] = at.map(|at| (at / CELL).floor());
            let is_inside = column >= 0.0 && row >= 0.0 && column < self.columns as f64 && row < self.rows as f64;
            let cell = if is_inside { self.full[row as usize * self.columns + column as usize] } else { NOTHING };
            cell != NOTHING && cell != own
        };
        spots.filter(|&spot| is_region(spot)).count() as f64 / 15.0
    }

    fn on_page(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [self.page.x + column * CELL, self.page.y + row * CELL]
    }

    /// Fills an outline by the non-zero rule. A cell belongs to it if the cell's middle does.
    fn fill(&mut self, outline: &[Step], id: i32) {
        let sides = sides(outline);
        let mut crossings: Vec<(f64, i32)> = Vec::new();
        for row in 0..self.rows {
            let y = self.page.y + (row as f64 + 0.5) * CELL;
            crossings.clear();
            for [[x0, y0], [x1, y1]] in &sides {
                if (*y0 <= y) != (*y1 <= y) {
                    crossings.push((x0 + (x1 - x0) * (y - y0) / (y1 - y0), if y1 > y0 { 1 } else { -1 }));
                }
            }
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut winding = 0;
            for pair in crossings.windows(2) {
                winding += pair[0].1;
                if winding != 0 {
                    // The cells with their middles between two crossings.
                    let column =
                        |x: f64| ((x - self.page.x) / CELL - 0.5).ceil().clamp(0.0, self.columns as f64) as usize;
                    let (from, to) = (column(pair[0].0), column(pair[1].0));
                    let at = row * self.columns;
                    self.cells.get_mut(at + from..at + to).into_iter().for_each(|cells| cells.fill(id));
                }
            }
        }
    }
}

/// Returns the sides of an outline; all its pieces count as closed.
fn sides(outline: &[Step]) -> Vec<[[f64; 2]; 2]> {
    let (mut sides, mut begin, mut at) = (Vec::new(), None, None);
    for step in outline {
        match *step {
            Step::Move(spot) => (begin, at) = (Some(spot), Some(spot)),
            Step::Line(spot) | Step::Arc(_, spot) => {
                sides.extend(at.map(|at| [at, spot]));
                at = Some(spot);
            }
            Step::Close => {
                sides.extend(at.zip(begin).map(|(at, begin)| [at, begin]));
                at = begin;
            }
        }
    }
    sides
}

/// A search for a place in one region, in the part of the raster around the region.
struct Search<'a> {
    raster: &'a RegionRaster,
    cells: &'a [i32],
    id: i32,
    /// Size of the name, in cells.
    size: [usize; 2],
    /// First column and first row of the part.
    corner: [usize; 2],
    /// Number of columns and rows of the part.
    extent: [usize; 2],
    /// Middle of the region's cells.
    center: [f64; 2],
    own: Counter,
}

impl<'a> Search<'a> {
    fn new(raster: &'a RegionRaster, cells: &'a [i32], region: usize, size: [usize; 2]) -> Option<Self> {
        let id = region as i32 + 1;
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for (index, _) in cells.iter().enumerate().filter(|(_, cell)| **cell == id) {
            let at = [index % raster.columns, index / raster.columns];
            (low, high) = ([0, 1].map(|k| low[k].min(at[k])), [0, 1].map(|k| high[k].max(at[k])));
        }
        if low[0] == usize::MAX {
            return None;
        }
        let center = [0, 1].map(|k| (low[k] + high[k] + 1) as f64 / 2.0);
        // A name may stick out of the region.
        let corner = [0, 1].map(|k| low[k].saturating_sub(size[k]));
        let last = [0, 1].map(|k| (high[k] + size[k]).min([raster.columns, raster.rows][k] - 1));
        let extent = [0, 1].map(|k| last[k] - corner[k] + 1);
        let cell = |x: usize, y: usize| cells[(corner[1] + y) * raster.columns + corner[0] + x];
        let own = Counter::new(extent, |x, y| cell(x, y) == id);
        Some(Self { raster, cells, id, size, corner, extent, center, own })
    }

    fn cell(&self, x: usize, y: usize) -> i32 {
        self.cells[(self.corner[1] + y) * self.raster.columns + self.corner[0] + x]
    }

    fn roomiest(&self, may_stick_out: bool) -> Option<([f64; 2], bool)> {
        let [width, height] = self.size;
        if let Some(fit) = self.fitting([width, height]) {
            return Some((self.with_largest_margin(fit), true));
        }
        let foreign = Counter::new(self.extent, |x, y| self.cell(x, y) != self.id && self.cell(x, y) != NOTHING);
        let part = |x: usize, y: usize| {
            let part = self.own.count([x, y], self.size) as f64 / (width * height) as f64;
            let is_on = self.cell(x + width / 2, y + height / 2) == self.id;
            (is_on && foreign.count([x, y], self.size) == 0 && part >= MIN_PART).then_some(part)
        };
        if let Some(place) = may_stick_out.then(|| self.best(self.size, part)).flatten() {
            return Some((place, true));
        }
        let mut side = 1;
        while self.fitting([2 * side; 2]).is_some() {
            side *= 2;
        }
        Some((self.fitting([side; 2])?, false))
    }

    /// Returns the middle of the place with the most room around the name, by bisection.
    fn with_largest_margin(&self, mut fit: [f64; 2]) -> [f64; 2] {
        let (mut low, mut high) = (0, self.extent[0].max(self.extent[1]).div_ceil(2));
        while high > low + 1 {
            let margin = usize::midpoint(low, high);
            match self.fitting(self.size.map(|side| side + 2 * margin)) {
                Some(found) => (fit, low) = (found, margin),
                None => high = margin,
            }
        }
        fit
    }

    /// Returns the place within the region, for a box of this size, that is nearest to the middle of the region. Places are given
    /// by their middles.
    fn fitting(&self, size: [usize; 2]) -> Option<[f64; 2]> {
        self.best(size, |x, y| (self.own.count([x, y], size) as usize == size[0] * size[1]).then_some(1.0))
    }

    /// Returns the middle of the box with the best rating. `rate` returns `None` for impossible boxes.
    fn best(&self, size: [usize; 2], rate: impl Fn(usize, usize) -> Option<f64>) -> Option<[f64; 2]> {
        let (mut best, mut most) = (None, f64::NEG_INFINITY);
        for y in 0..(self.extent[1] + 1).saturating_sub(size[1]) {
            for x in 0..(self.extent[0] + 1).saturating_sub(size[0]) {
                let Some(rating) = rate(x, y) else { continue };
                let at = [0, 1].map(|k| (self.corner[k] + [x, y][k]) as f64 + size[k] as f64 / 2.0);
                let off = (at[0] - self.center[0]).abs() + (at[1] - self.center[1]).abs();
                let whole = rating - CENTER_PREFERENCE * off;
                if whole > most {
                    (best, most) = (Some(at), whole);
                }
            }
        }
        best
    }
}

/// Counts the cells of a kind in any box, by a table of sums.
struct Counter {
    sums: Vec<u32>,
    columns: usize,
}

impl Counter {
    fn new([columns, rows]: [usize; 2], is_counted: impl Fn(usize, usize) -> bool) -> Self {
        let mut sums = vec![0; (columns + 1) * (rows + 1)];
        for y in 0..rows {
            let mut row = 0;
            for x in 0..columns {
                row += u32::from(is_counted(x, y));
                sums[(y + 1) * (columns + 1) + x + 1] = sums[y * (columns + 1) + x + 1] + row;
            }
        }
        Self { sums, columns: columns + 1 }
    }

    fn count(&self, [x, y]: [usize; 2], [width, height]: [usize; 2]) -> u32 {
        let at = |x: usize, y: usize| self.sums[y * self.columns + x];
        at(x + width, y + height) + at(x, y) - at(x, y + height) - at(x + width, y)
    }
}

#[cfg(test)]
mod tests {
    use super::super::figure::rectangle;
    use super::*;

    const PAGE: Rect = Rect { x: 10.0, y: 20.0, width: 200.0, height: 100.0 };

    #[test]
    fn cells_belong_to_the_region_that_covers_their_middle() {
        let square = rectangle(Rect { x: 50.0, y: 40.0, width: 40.0, height: 20.0 });
        let raster = RegionRaster::new(PAGE, [&square[..]]);
        assert_eq!(raster.cells.iter().filter(|cell| **cell == 1).count(), 10 * 5);
        let (at, fits) = raster.roomiest(0, [16.0, 8.0], true).unwrap();
        assert!(fits && (at[0] - 70.0).abs() <= 4.0 && (at[1] - 50.0).abs() <= 4.0, "{at:?}");
        assert!(raster.roomiest(1, [16.0, 8.0], true).is_none());
    }

    #[test]
    fn blocked_cells_are_no_place_but_belong_to_their_region() {
        let square = rectangle(Rect { x: 50.0, y: 40.0, width: 40.0, height: 20.0 });
        let mut raster = RegionRaster::new(PAGE, [&square[..]]);
        raster.block(&Rect { x: 0.0, y: 0.0, width: 400.0, height: 400.0 });
        assert!(raster.roomiest(0, [16.0, 8.0], true).is_none());
        assert!(raster.any_part(0).is_some());
    }
}
