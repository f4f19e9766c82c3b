//! What is known of a world, cell by cell, and what really is there.

use crate::geometry::{Convex, Point, Vector, shapes_meet};
use crate::input::{Occupancy, OccupancyMap};
use crate::model::{Arm, Heights, JointType, Obstacle, Scene, Sensor, Shape, Workspace};
use crate::space::{Configuration, Draws};
use nalgebra::{Isometry2, Vector2};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Cells of the largest map.
pub const MOST_CELLS: usize = 1 << 22;

/// Margin of the map about what the arm can touch, in cells.
const MARGIN: f64 = 2.0;

/// Radius of a disc that holds a cell, in cells, with room for rounding.
const AROUND_CELL: f64 = 0.75;

/// A map that fills up with what a sensor sees. What was said of a cell once stays so.
///
/// The sensor's rays are as wide as the cells that they cross: one ends at the first cell that anything is in, and the cells
/// before it are empty. So what is known to be free is free, whole cells of it; and what a reading would add to the map is known
/// beforehand up to the first unknown cell of each ray.
#[derive(Debug, Clone)]
pub struct Survey {
    known: OccupancyMap,
    /// What is between the lowest obstacle's floor and the highest one's top; what is above or below is free, as everybody knows.
    heights: Heights,
    /// From the lowest floor to the highest top of what is in a cell, if anything is: known as soon as the cell is.
    truth: Vec<Option<Heights>>,
}

/// A cell that a ray crosses.
struct Crossing {
    cell: usize,
    /// Distance at which the ray enters it, metres.
    enters: f64,
}

impl Survey {
    /// Knows nothing yet of the obstacles of a scene. None if the map would have more than [`MOST_CELLS`].
    #[must_use]
    pub fn new(scene: &Scene, cell: f64) -> Option<Self> {
        let obstacles = &scene.workspace().obstacles;
        let heights = obstacles.iter().map(|obstacle| obstacle.heights).reduce(Heights::and);
        let heights = heights.unwrap_or(Heights::ALL);
        let [low, high] = extent(scene, heights);
        let size = [0, 1].map(|k| ((high[k] - low[k]) / cell + 2.0 * MARGIN).ceil());
        let count = size[0] * size[1];
        if count.is_nan() || count > MOST_CELLS as f64 {
            return None;
        }
        // The middle of the map is that of what the arm can touch.
        let origin = [0, 1].map(|k| f64::midpoint(low[k], high[k]) - size[k] * cell / 2.0);
        let size = size.map(|n| n as usize);
        let known = OccupancyMap {
            size,
            resolution: cell,
            pose: Isometry2::new(Vector2::from(origin), 0.0),
            cells: vec![Occupancy::Unknown; size[0] * size[1]],
        };
        let mut survey = Self { truth: vec![None; known.cells.len()], heights, known };
        for obstacle in obstacles {
            for cell in
                obstacle.pieces.iter().flat_map(|piece| survey.touched(piece, 0.0, |_| true)).collect::<Vec<_>>()
            {
                let own = obstacle.heights;
                survey.truth[cell] = Some(survey.truth[cell].map_or(own, |others| others.and(own)));
            }
        }
        Some(survey)
    }

    /// Takes over what an earlier exploration knew.
    ///
    /// # Errors
    /// A map of other cells, or of another world: what is wrong with it, in words.
    pub fn recall(&mut self, map: &OccupancyMap) -> Result<(), String> {
        let own = &self.known;
        if (map.size, map.resolution, map.pose) != (own.size, own.resolution, own.pose) {
            let [width, height] = own.size;
            let at = self.origin();
            return Err(format!(
                "has other cells than the {width} x {height} of {} m from ({}, {}) that the arm and its sensor ask for",
                own.resolution, at.x, at.y
            ));
        }
        for (cell, &label) in map.cells.iter().enumerate() {
            let is_wrong = match label {
                Occupancy::Free => self.truth[cell].is_some(),
                Occupancy::Occupied => self.truth[cell].is_none(),
                Occupancy::Unknown => false,
            };
            if is_wrong {
                let [width, height] = map.size;
                let [x, y] = [cell % width, height - 1 - cell / width].map(|k| (k as f64 + 0.5) * map.resolution);
                let at = map.pose * Point::new(x, y);
                let (said, is) =
                    if self.truth[cell].is_some() { ("free", "something") } else { ("occupied", "nothing") };
                return Err(format!("says that it is {said} about ({:.4}, {:.4}), where there is {is}", at.x, at.y));
            }
        }
        self.known.cells.clone_from(&map.cells);
        Ok(())
    }

    /// What is known.
    #[must_use]
    pub fn map(&self) -> &OccupancyMap {
        &self.known
    }

    /// How many cells are free, occupied and unknown.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let count = |label| self.known.cells.iter().filter(|&&cell| cell == label).count();
        [count(Occupancy::Free), count(Occupancy::Occupied), count(Occupancy::Unknown)]
    }

    /// The share of the map's cells of which something is known.
    #[must_use]
    pub fn share_seen(&self) -> f64 {
        let unknown = self.known.cells.iter().filter(|&&cell| cell == Occupancy::Unknown).count();
        1.0 - unknown as f64 / self.known.cells.len() as f64
    }

    /// The corner of the map from which cells are counted.
    fn origin(&self) -> Vector {
        self.known.pose.translation.vector
    }

    /// The number of a cell, by column from the left and row from below.
    fn index(&self, x: usize, y: usize) -> usize {
        (self.known.size[1] - 1 - y) * self.known.size[0] + x
    }

    /// The cells that a shape meets, grown by a margin, of those that are `asked` about.
    ///
    /// Row by row: beyond a side of the shape by more than a cell's radius are all cells before a column, or after one.
    fn touched(&self, shape: &Convex, margin: f64, asked: impl Fn(usize) -> bool) -> impl Iterator<Item = usize> {
        let cell = self.known.resolution;
        let grown = Convex::trusted(shape.core().to_vec(), shape.radius() + margin);
        let around = grown.radius() / cell + AROUND_CELL;
        // In cells, from the middle of the first.
        let core: Vec<Vector> =
            shape.core().iter().map(|p| (p.coords - self.origin()) / cell - Vector::repeat(0.5)).collect();
        let range = |k: usize| {
            let local = core.iter().map(|p| p[k]);
            let (least, most) = local.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
            let [from, to] = [(least - around).ceil(), (most + around).floor() + 1.0].map(|at| at.max(0.0) as usize);
            from..to.min(self.known.size[k])
        };
        let [columns, rows] = [range(0), range(1)];
        let sides = core.iter().zip(core.iter().cycle().skip(1)).map(|(&a, &b)| (a, b - a));
        let sides: Vec<(f64, f64, f64)> =
            sides.map(|(a, side)| (-side.y, side.x, side.perp(&a) - around * side.norm())).collect();
        let cells = rows.flat_map(move |y| {
            let (mut from, mut to) = (columns.start, columns.end);
            for &(along, across, least) in &sides {
                let least = least - across * y as f64;
                if along > 0.0 {
                    from = from.max((least / along).ceil().max(0.0) as usize);
                } else if along < 0.0 {
                    to = to.min(((least / along).floor() + 1.0).max(0.0) as usize);
                } else if least > 0.0 {
                    to = from;
                }
            }
            (from..to.max(from)).map(move |x| (x, y))
        });
        cells
            .map(|(x, y)| (self.index(x, y), x, y))
            .filter(move |&(cell, x, y)| asked(cell) && shapes_meet(&self.square(x, y), &grown))
            .map(|(cell, ..)| cell)
    }

    /// A cell as a shape, by column from the left and row from below.
    fn square(&self, x: usize, y: usize) -> Convex {
        let at =
            |x: usize, y: usize| Point::from(self.origin() + Vector::new(x as f64, y as f64) * self.known.resolution);
        Convex::trusted(vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)], 0.0)
    }

    /// The shapes of the arm at `q` that are as high as any obstacle, with their heights.
    fn parts(&self, arm: &Arm, q: Configuration) -> impl Iterator<Item = (Convex, Heights)> {
        let poses = arm.poses(q);
        let parts = (0..2).flat_map(|link| arm.links[link].parts.iter().map(move |part| (link, part)));
        let high = parts.filter(|(_, part)| part.heights.meet(self.heights));
        high.map(move |(link, part)| (part.shape.at(&poses[link]), part.heights))
    }

    /// The cells that the arm meets at `q`, grown by a margin, whatever is in them; in ascending order.
    fn under(&self, arm: &Arm, q: Configuration, margin: f64) -> Vec<usize> {
        let parts = self.parts(arm, q);
        let mut cells: Vec<usize> =
            parts.flat_map(|(part, _)| self.touched(&part, margin, |_| true).collect::<Vec<_>>()).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// A cell that is not known to be free and that the arm meets at `q`, grown by a margin; none if all are known to be.
    #[must_use]
    pub fn obstruction(&self, arm: &Arm, q: Configuration, margin: f64) -> Option<usize> {
        self.parts(arm, q).find_map(|(part, heights)| {
            let is_solid = |cell: usize| self.solid(cell).is_some_and(|solid| solid.meet(heights));
            self.touched(&part, margin, is_solid).next()
        })
    }

    /// The heights at which a cell is not known to be free. What is unknown is as high as anything in the world; of what was seen it is
    /// known how high it is.
    fn solid(&self, cell: usize) -> Option<Heights> {
        match self.known.cells[cell] {
            Occupancy::Free => None,
            Occupancy::Occupied => self.truth[cell],
            Occupancy::Unknown => Some(self.heights),
        }
    }

    /// The cells that a ray crosses as far as the sensor sees, those whole that it leaves before that, in order.
    ///
    /// From side to side (Amanatides, Woo 1987).
    fn crossings(&self, from: Point, angle: f64, range: f64) -> impl Iterator<Item = Crossing> + use<> {
        let cell = self.known.resolution;
        let (size, local) = (self.known.size, (from.coords - self.origin()) / cell);
        let ahead = [angle.cos(), angle.sin()];
        let step = ahead.map(|d| if d > 0.0 { 1_i64 } else { -1 });
        // Distance from one side across to the next.
        let across = ahead.map(|d| cell / d.abs());
        let mut at = [local.x, local.y].map(|v| v.floor() as i64);
        let mut next = [0, 1].map(|k| {
            let to_side = if step[k] > 0 { at[k] as f64 + 1.0 - local[k] } else { local[k] - at[k] as f64 };
            if ahead[k] == 0.0 { f64::INFINITY } else { to_side * across[k] }
        });
        let mut enters = 0.0;
        std::iter::from_fn(move || {
            let inside = (0..2).all(|k| 0 <= at[k] && at[k] < size[k] as i64);
            let k = usize::from(next[1] < next[0]);
            let leaves = next[k];
            if !inside || leaves > range {
                return None;
            }
            let crossing = Crossing { cell: (size[1] - 1 - at[1] as usize) * size[0] + at[0] as usize, enters };
            enters = leaves;
            at[k] += step[k];
            next[k] += across[k];
            Some(crossing)
        })
    }

    /// An unknown cell that a reading at `q` would come to; none if it would show nothing new. Rays come first to one of the
    /// [`Survey::edges`], where these are given: only those that may are looked along.
    #[must_use]
    pub fn promise(&self, sensor: &Sensor, arm: &Arm, q: Configuration, edges: Option<&[Vec<usize>]>) -> Option<usize> {
        match edges {
            Some(edges) => self.first_towards(sensor, arm, q, edges, |_| true),
            None => self.first_unknown(sensor, arm, q).next(),
        }
    }

    /// Whether a reading at `q` would come first to any of some unknown cells, by columns in ascending order, row by row.
    #[must_use]
    pub fn shows_any(&self, sensor: &Sensor, arm: &Arm, q: Configuration, wanted: &[Vec<usize>]) -> bool {
        let width = self.known.size[0];
        let is_wanted = |cell: usize| wanted[cell / width].binary_search(&(cell % width)).is_ok();
        self.first_towards(sensor, arm, q, wanted, is_wanted).is_some()
    }

    /// The first unknown cell of a ray of a reading at `q` that `is_asked` for. Only rays that may cross one of some cells are looked along,
    /// unless the sensor itself is where nothing is known.
    fn first_towards(
        &self,
        sensor: &Sensor,
        arm: &Arm,
        q: Configuration,
        cells: &[Vec<usize>],
        is_asked: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let (from, ahead) = sensor.pose(arm, q.into());
        if self.is_unknown_about(from) {
            return self.first_unknown(sensor, arm, q).find(|&cell| is_asked(cell));
        }
        let mut is_tried = vec![false; sensor.rays];
        self.near(cells, from, sensor.range).find_map(|cell| {
            let mut rays = self.rays_to(sensor, from, ahead, cell);
            rays.find_map(|ray| {
                let is_new = !std::mem::replace(&mut is_tried[ray], true);
                let mut view = self.crossings(from, sensor.ray(ahead, ray), sensor.range).map(|crossing| crossing.cell);
                let first = is_new.then(|| view.find(|&cell| self.known.cells[cell] != Occupancy::Free)).flatten();
                first.filter(|&cell| self.is_unknown(cell) && is_asked(cell))
            })
        })
    }

    /// Columns of some cells in ascending order, row by row from the top.
    #[must_use]
    pub fn by_rows(&self, cells: &BTreeSet<usize>) -> Vec<Vec<usize>> {
        let [width, height] = self.known.size;
        let row = |y: usize| cells.range(y * width..(y + 1) * width).map(|cell| cell % width).collect();
        (0..height).map(row).collect()
    }

    /// The numbers of those rays that may cross a cell.
    fn rays_to(&self, sensor: &Sensor, from: Point, ahead: f64, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let [width, height] = self.known.size;
        let middle = Vector::new((cell % width) as f64 + 0.5, (height - 1 - cell / width) as f64 + 0.5);
        let way = middle - (from.coords - self.origin()) / self.known.resolution;
        let sine = AROUND_CELL / way.norm();
        sensor.rays_about(ahead, way.y.atan2(way.x), if sine < 1.0 { sine.asin() } else { PI })
    }

    /// Of each ray of a reading at `q` the first cell that is not known to be free, if it is unknown.
    fn first_unknown(&self, sensor: &Sensor, arm: &Arm, q: Configuration) -> impl Iterator<Item = usize> {
        self.views(sensor, arm, q).filter_map(|mut view| {
            let first = view.find(|&cell| self.known.cells[cell] != Occupancy::Free);
            first.filter(|&cell| self.is_unknown(cell))
        })
    }

    /// The unknown cells that rays of a reading at `q` come to first, in ascending order.
    #[must_use]
    pub fn shown_first(&self, sensor: &Sensor, arm: &Arm, q: Configuration) -> Vec<usize> {
        let mut cells: Vec<usize> = self.first_unknown(sensor, arm, q).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// Whether the rays of a reading at `q` cross all of some cells before what is known to be there.
    #[must_use]
    pub fn shows_all(&self, sensor: &Sensor, arm: &Arm, q: Configuration, cells: &[usize]) -> bool {
        let (from, ahead) = sensor.pose(arm, q.into());
        cells.iter().all(|&wanted| {
            self.rays_to(sensor, from, ahead, wanted).any(|ray| {
                let view = self.crossings(from, sensor.ray(ahead, ray), sensor.range).map(|crossing| crossing.cell);
                view.take_while(|&cell| self.known.cells[cell] != Occupancy::Occupied).any(|cell| cell == wanted)
            })
        })
    }

    /// The unknown cells that the rays of a reading at `q` cross before what is known to be there; some more than once.
    pub fn visible_unknown(&self, sensor: &Sensor, arm: &Arm, q: Configuration) -> impl Iterator<Item = usize> {
        let open = |&cell: &usize| self.known.cells[cell] != Occupancy::Occupied;
        self.views(sensor, arm, q).flat_map(move |view| view.take_while(open)).filter(|&cell| self.is_unknown(cell))
    }

    /// The cells that each ray of a reading at `q` crosses.
    fn views(
        &self,
        sensor: &Sensor,
        arm: &Arm,
        q: Configuration,
    ) -> impl Iterator<Item = impl Iterator<Item = usize> + use<>> {
        let ((from, ahead), range) = (sensor.pose(arm, q.into()), sensor.range);
        sensor.rays(ahead).map(move |angle| self.crossings(from, angle, range).map(|crossing| crossing.cell))
    }

    /// The unknown cells that the arm meets at `q`, in ascending order.
    #[must_use]
    pub fn unknown_at(&self, arm: &Arm, q: Configuration) -> Vec<usize> {
        let mut cells = self.under(arm, q, 0.0);
        cells.retain(|&cell| self.is_unknown(cell));
        cells
    }

    /// Whether nothing is known of a cell.
    #[must_use]
    pub fn is_unknown(&self, cell: usize) -> bool {
        self.known.cells[cell] == Occupancy::Unknown
    }

    /// Columns of the unknown cells that share a side with a free one, in ascending order, row by row from the top.
    #[must_use]
    pub fn edges(&self) -> Vec<Vec<usize>> {
        let [width, height] = self.known.size;
        let is = |x: usize, y: usize, label| self.known.cells[y * width + x] == label;
        let is_edge = |x: usize, y: usize| {
            let is_free = |x: usize, y: usize| x < width && y < height && is(x, y, Occupancy::Free);
            is(x, y, Occupancy::Unknown)
                && (is_free(x.wrapping_sub(1), y)
                    || is_free(x + 1, y)
                    || is_free(x, y.wrapping_sub(1))
                    || is_free(x, y + 1))
        };
        (0..height).map(|y| (0..width).filter(|&x| is_edge(x, y)).collect()).collect()
    }

    /// Whether a point lies in a cell of which nothing is known.
    fn is_unknown_about(&self, point: Point) -> bool {
        let local = (point.coords - self.origin()) / self.known.resolution;
        let is_inside = (0..2).all(|k| 0.0 <= local[k] && local[k] < self.known.size[k] as f64);
        is_inside && self.is_unknown(self.index(local.x as usize, local.y as usize))
    }

    /// Those of the [`Survey::edges`] that are within a range of a point, and some more.
    fn near<'a>(&self, edges: &'a [Vec<usize>], point: Point, range: f64) -> impl Iterator<Item = usize> + use<'a> {
        let local = (point.coords - self.origin()) / self.known.resolution;
        let [width, height] = self.known.size;
        let (x, y) = (local.x, height as f64 - local.y);
        // A cell more to each side: for its far side, and rounding.
        let range = range / self.known.resolution + 2.0;
        let rows = (y - range).max(0.0) as usize..((y + range).max(0.0) as usize).min(height);
        rows.flat_map(move |row| {
            let half = (range.powi(2) - (row as f64 + 0.5 - y).powi(2)).max(0.0).sqrt() + 1.0;
            let columns = &edges[row];
            let first = columns.partition_point(|&column| (column as f64) < x - half);
            let near = columns[first..].iter().take_while(move |&&column| column as f64 <= x + half);
            near.map(move |column| row * width + column)
        })
    }

    /// Notes what a reading at `q` shows; the cells that are new, in the order in which they were seen.
    ///
    /// Of a distance that may be wrong only what holds whatever the error is noted: cells before all that the ray may have ended at are
    /// free, and where that is a single one it is occupied.
    pub fn look(&mut self, sensor: &Sensor, arm: &Arm, q: Configuration, errors: &mut Draws) -> Vec<usize> {
        let (from, ahead) = sensor.pose(arm, q.into());
        let mut new = Vec::new();
        for angle in sensor.rays(ahead) {
            let crossings: Vec<Crossing> = self.crossings(from, angle, sensor.range).collect();
            let error = if sensor.noise > 0.0 { sensor.noise * (2.0 * errors.unit() - 1.0) } else { 0.0 };
            let hit = crossings.iter().position(|crossing| self.truth[crossing.cell].is_some());
            let told = hit.map(|hit| crossings[hit].enters + error);
            // The first cell that the ray may have ended at, and whether no other is.
            let (first, is_sole) = match (hit, told) {
                (Some(hit), Some(told)) if sensor.noise > 0.0 => {
                    let may_be = |crossing: &Crossing| (crossing.enters - told).abs() <= sensor.noise * (1.0 + 1e-9);
                    let first = crossings.iter().position(may_be).unwrap_or(hit);
                    (first, crossings[first + 1..].iter().all(|crossing| !may_be(crossing)))
                }
                (Some(hit), _) => (hit, true),
                _ => (crossings.len(), false),
            };
            for (k, Crossing { cell, .. }) in crossings.into_iter().enumerate().take(first + usize::from(is_sole)) {
                let label = if k < first { Occupancy::Free } else { Occupancy::Occupied };
                if self.is_unknown(cell) {
                    self.known.cells[cell] = label;
                    new.push(cell);
                }
            }
        }
        new
    }

    /// Notes what is in the cells that the arm meets at `q`, and in those about them, as far as `margin`: whoever puts an arm somewhere
    /// has looked where it stands.
    pub fn survey_about(&mut self, arm: &Arm, q: Configuration, margin: f64) -> Vec<usize> {
        let mut new = self.under(arm, q, margin);
        new.retain(|&cell| self.is_unknown(cell));
        for &cell in &new {
            self.known.cells[cell] = if self.truth[cell].is_some() { Occupancy::Occupied } else { Occupancy::Free };
        }
        new
    }

    /// The arm among all that is not known to be free; or, with `unknown_is_free`, among what is known to be there.
    #[must_use]
    pub fn scene(&self, arm: &Arm, clearance: f64, unknown_is_free: bool) -> Scene {
        let seen = self.known.cells.iter().zip(&self.truth).filter(|(label, _)| **label == Occupancy::Occupied);
        let mut layers: Vec<Heights> = Vec::new();
        for heights in seen.filter_map(|(_, heights)| *heights) {
            if !layers.contains(&heights) {
                layers.push(heights);
            }
        }
        let obstacle = |name: &str, heights: Heights, is_among: &dyn Fn(usize) -> bool| {
            let pieces = self.known.rectangles_of(is_among, usize::MAX).unwrap_or_default();
            Obstacle { name: name.into(), shape: Shape::Pieces, pieces, heights }
        };
        let is_seen = |cell: usize| self.known.cells[cell] == Occupancy::Occupied;
        let unknown = obstacle("unknown", self.heights, &|cell| !unknown_is_free && self.is_unknown(cell));
        let seen = layers
            .iter()
            .map(|&layer| obstacle("seen", layer, &|cell| is_seen(cell) && self.truth[cell] == Some(layer)));
        let obstacles = std::iter::once(unknown).chain(seen).filter(|obstacle| !obstacle.pieces.is_empty()).collect();
        let workspace = Workspace { name: String::new(), obstacles, clearance, preferences: Vec::new() };
        Scene::trusted(arm.clone(), workspace)
    }
}

/// The corners of a rectangle that holds the base, and all that an arm can come nearer to than the clearance at some heights.
fn extent(scene: &Scene, heights: Heights) -> [Point; 2] {
    let (arm, clearance) = (scene.arm(), scene.workspace().clearance);
    let discs = swept(arm, heights);
    let side = |k: usize, sign: f64| {
        let values = discs.iter().map(|(center, radius)| sign * center[k] + radius + clearance);
        sign * values.fold(sign * arm.base[k], f64::max)
    };
    [-1.0, 1.0].map(|sign| Point::new(side(0, sign), side(1, sign)))
}

/// Discs, by their centres and radii, whose hull holds the tip and all that an arm can touch at some heights.
fn swept(arm: &Arm, heights: Heights) -> Vec<(Point, f64)> {
    let [first, second] = &arm.joints;
    let (turns, ends) = match second.joint_type {
        JointType::Revolute { .. } => (true, vec![0.0]),
        JointType::Prismatic { .. } => (false, <[f64; 2]>::from(second.range.domain()).to_vec()),
    };
    if matches!(first.joint_type, JointType::Revolute { .. }) {
        let slides = ends.iter().map(|q2| q2.abs()).fold(0.0, f64::max);
        return vec![(arm.base, arm.reach() + slides)];
    }
    let mut discs = Vec::new();
    for q1 in <[f64; 2]>::from(first.range.domain()) {
        for &q2 in &ends {
            let poses = arm.poses([q1, q2].into());
            discs.push(if turns {
                (arm.elbow_at(q1), arm.tip.coords.norm())
            } else {
                (arm.tip_at([q1, q2].into()), 0.0)
            });
            for (link, pose) in poses.iter().enumerate() {
                for part in arm.links[link].parts.iter().filter(|part| part.heights.meet(heights)) {
                    let (shape, elbow) = (part.shape.at(pose), arm.elbow_at(q1));
                    if turns && link == 1 {
                        discs.push((elbow, shape.reach_from(elbow)));
                    } else {
                        discs.extend(shape.core().iter().map(|p| (*p, shape.radius())));
                    }
                }
            }
        }
    }
    discs
}
