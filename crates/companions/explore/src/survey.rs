//! The known part of a world, cell by cell, and the true contents of the cells.

use super::views::{CELL_RADIUS, Crossing};
use cplan_geometry::{Convex, Point, Pose, Vector, shapes_meet};
use cplan_model::space::{Configuration, SplitMix64};
use cplan_model::{Arm, Growth, Heights, JointType, Obstacle, Scene, Shape, Workspace};
use cplan_world::{Occupancy, OccupancyMap, Sensor};

/// Largest number of cells of a map.
pub const MAX_CELLS: usize = 1 << 22;

/// Width of the margin between the arm's reach and the sides of the map, in cells.
const MAP_MARGIN: f64 = 2.0;

/// A map that a sensor fills in. A known cell never changes.
///
/// The sensor's rays are as wide as the cells that they cross. A ray ends at the first occupied cell, and the cells
/// before it are empty. So a free cell is free as a whole, and the result of a reading can be predicted up to the first
/// unknown cell of each ray.
#[derive(Debug, Clone)]
pub struct Survey {
    pub(super) known: OccupancyMap,
    /// Range from the bottom of the lowest obstacle to the top of the highest one. The space above and below is known
    /// to be free.
    heights: Heights,
    /// For each occupied cell, the range from the lowest bottom to the highest top of its obstacles. A reading that
    /// shows the cell also shows this range.
    truth: Vec<Option<Heights>>,
}

impl Survey {
    /// Creates a map of a scene in which nothing is known. Returns `None` if it would have more than [`MAX_CELLS`]
    /// cells.
    pub fn new(scene: &Scene, cell: f64) -> Option<Self> {
        let obstacles = &scene.workspace().obstacles;
        let heights = obstacles.iter().map(|obstacle| obstacle.heights).reduce(Heights::and);
        let heights = heights.unwrap_or(Heights::ALL);
        let [low, high] = extent(scene, heights);
        let size = [0, 1].map(|k| ((high[k] - low[k]) / cell + 2.0 * MAP_MARGIN).ceil());
        let count = size[0] * size[1];
        if count.is_nan() || count > MAX_CELLS as f64 {
            return None;
        }
        // The map is centred on the reach of the arm.
        let origin = [0, 1].map(|k| f64::midpoint(low[k], high[k]) - size[k] * cell / 2.0);
        let size = size.map(|n| n as usize);
        let known = OccupancyMap {
            size,
            resolution: cell,
            pose: Pose::translation(Vector::from(origin)),
            cells: vec![Occupancy::Unknown; size[0] * size[1]],
            notes: Vec::new(),
            picture: None,
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

    /// Adds the knowledge of an earlier exploration.
    ///
    /// # Errors
    /// The reason, if the map has other cells or is of another world.
    pub fn add_earlier_map(&mut self, map: &OccupancyMap) -> Result<(), String> {
        let own = &self.known;
        if (map.size, map.resolution, map.pose) != (own.size, own.resolution, own.pose) {
            let [width, height] = own.size;
            let at = self.origin();
            return Err(format!(
                "has other cells than this arm and sensor need: {width} x {height} cells of {} m, the first one at ({}, {})",
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
                let at = map.pose.point(Point::new(x, y));
                let (expected, is) =
                    if self.truth[cell].is_some() { ("free", "an obstacle") } else { ("occupied", "free space") };
                return Err(format!(
                    "shows {expected} space near ({:.4}, {:.4}), but the world has {is} there",
                    at.x, at.y
                ));
            }
        }
        self.known.cells.clone_from(&map.cells);
        Ok(())
    }

    /// Returns the map of what is known.
    pub fn map(&self) -> &OccupancyMap {
        &self.known
    }

    /// Returns the numbers of free, occupied and unknown cells.
    pub fn counts(&self) -> [usize; 3] {
        let count = |label| self.known.cells.iter().filter(|&&cell| cell == label).count();
        [count(Occupancy::Free), count(Occupancy::Occupied), count(Occupancy::Unknown)]
    }

    /// Returns the fraction of the map's cells that are known.
    pub fn share_seen(&self) -> f64 {
        let unknown = self.known.cells.iter().filter(|&&cell| cell == Occupancy::Unknown).count();
        1.0 - unknown as f64 / self.known.cells.len() as f64
    }

    /// Returns the corner of the map from which cells are counted.
    pub(super) fn origin(&self) -> Vector {
        self.known.pose.translation
    }

    /// Returns the number of a cell, by column from the left and row from below.
    fn index(&self, x: usize, y: usize) -> usize {
        (self.known.size[1] - 1 - y) * self.known.size[0] + x
    }

    /// Iterates over the cells that a shape, grown by a margin, touches and for which `asked` is true.
    ///
    /// It works row by row. In a row, the cells farther beyond a side of the shape than a cell's radius are all those
    /// before some column, or all those after some column.
    fn touched(&self, shape: &Convex, margin: f64, asked: impl Fn(usize) -> bool) -> impl Iterator<Item = usize> {
        let cell = self.known.resolution;
        let grown = Convex::trusted(shape.core().to_vec(), shape.radius() + margin);
        let around = grown.radius() / cell + CELL_RADIUS;
        // Coordinates in cells, from the centre of the first cell.
        let core: Vec<Vector> = shape.core().iter().map(|p| (p - self.origin()) / cell - Vector::repeat(0.5)).collect();
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

    /// Returns the square of a cell, by column from the left and row from below.
    fn square(&self, x: usize, y: usize) -> Convex {
        let at = |x: usize, y: usize| self.origin() + Vector::new(x as f64, y as f64) * self.known.resolution;
        Convex::trusted(vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)], 0.0)
    }

    /// Iterates over the arm's shapes at `q`, with their heights. Omits shapes that are not at the height of any
    /// obstacle.
    fn parts(&self, arm: &Arm, q: Configuration) -> impl Iterator<Item = (Convex, Heights)> {
        let poses = arm.poses(q);
        let parts = (0..2).flat_map(|link| arm.links[link].parts.iter().map(move |part| (link, part)));
        let high = parts.filter(|(_, part)| part.heights.meet(self.heights));
        high.map(move |(link, part)| (part.shape.at(&poses[link]), part.heights))
    }

    /// Returns all cells that the arm, grown by a margin, touches at `q`, in ascending order.
    fn under(&self, arm: &Arm, q: Configuration, margin: f64) -> Vec<usize> {
        let parts = self.parts(arm, q);
        let mut cells: Vec<usize> =
            parts.flat_map(|(part, _)| self.touched(&part, margin, |_| true).collect::<Vec<_>>()).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// Returns a cell that is not known to be free and that the arm, grown by a margin, touches at `q`. `None` if there
    /// is no such cell.
    pub fn obstruction(&self, arm: &Arm, q: Configuration, margin: f64) -> Option<usize> {
        self.parts(arm, q).find_map(|(part, heights)| {
            let is_solid = |cell: usize| self.solid(cell).is_some_and(|solid| solid.meet(heights));
            self.touched(&part, margin, is_solid).next()
        })
    }

    /// Returns the heights at which a cell counts as solid; `None` if it is free. An unknown cell has the heights of
    /// everything in the world. A cell that has been seen has the heights of its contents.
    fn solid(&self, cell: usize) -> Option<Heights> {
        match self.known.cells[cell] {
            Occupancy::Free => None,
            Occupancy::Occupied => self.truth[cell],
            Occupancy::Unknown => Some(self.heights),
        }
    }

    /// Returns the unknown cells that the arm touches at `q`, in ascending order.
    pub fn unknown_at(&self, arm: &Arm, q: Configuration) -> Vec<usize> {
        let mut cells = self.under(arm, q, 0.0);
        cells.retain(|&cell| self.is_unknown(cell));
        cells
    }

    /// Returns true if a cell is unknown.
    pub fn is_unknown(&self, cell: usize) -> bool {
        self.known.cells[cell] == Occupancy::Unknown
    }

    /// Returns the map cell that contains a point.
    pub(super) fn cell_at(&self, point: Point) -> Option<usize> {
        let local = (point - self.origin()) / self.known.resolution;
        let is_inside = (0..2).all(|k| 0.0 <= local[k] && local[k] < self.known.size[k] as f64);
        is_inside.then(|| self.index(local.x as usize, local.y as usize))
    }

    /// Records the result of a reading at `q`. Returns the cells that became known, in the order in which they were
    /// seen.
    ///
    /// If distances have errors, only facts that hold for every possible error are recorded. Cells that the ray crosses before
    /// the first cell in which it may have ended are free. If it can have ended in only one cell, that cell is occupied.
    pub fn record_reading(
        &mut self,
        sensor: &Sensor,
        arm: &Arm,
        q: Configuration,
        errors: &mut SplitMix64,
    ) -> Vec<usize> {
        let (from, ahead) = sensor.pose(arm, q.into());
        let mut new = Vec::new();
        for angle in sensor.rays(ahead) {
            let crossings: Vec<Crossing> = self.crossings(from, angle, sensor.range).collect();
            let error = if sensor.noise > 0.0 { sensor.noise * (2.0 * errors.unit() - 1.0) } else { 0.0 };
            let hit = crossings.iter().position(|crossing| self.truth[crossing.cell].is_some());
            let reported = hit.map(|hit| crossings[hit].enters + error);
            // Index of the first cell in which the ray may have ended, and true if it must have ended there.
            let (first, is_sole) = match (hit, reported) {
                (Some(hit), Some(reported)) if sensor.noise > 0.0 => {
                    let may_be =
                        |crossing: &Crossing| (crossing.enters - reported).abs() <= sensor.noise * (1.0 + 1e-9);
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

    /// Records the contents of the cells that the arm, grown by `margin`, touches at `q`. They are known, because the
    /// user who placed the arm there has seen them.
    pub fn survey_around(&mut self, arm: &Arm, q: Configuration, margin: f64) -> Vec<usize> {
        let mut new = self.under(arm, q, margin);
        new.retain(|&cell| self.is_unknown(cell));
        for &cell in &new {
            self.known.cells[cell] = if self.truth[cell].is_some() { Occupancy::Occupied } else { Occupancy::Free };
        }
        new
    }

    /// Returns a scene in which everything that is not known to be free is solid. With `unknown_is_free`, only
    /// obstacles that have been seen are solid.
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
            Obstacle { name: name.into(), shape: Shape::Pieces, pieces, heights, growth: Growth::default() }
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

/// Returns the corners of a rectangle that contains the base, and everything that the arm can touch or approach within
/// the clearance at some heights.
fn extent(scene: &Scene, heights: Heights) -> [Point; 2] {
    let (arm, clearance) = (scene.arm(), scene.workspace().clearance);
    let discs = swept_discs(arm, heights);
    let side = |k: usize, sign: f64| {
        let values = discs.iter().map(|(center, radius)| sign * center[k] + radius + clearance);
        sign * values.fold(sign * arm.base[k], f64::max)
    };
    [-1.0, 1.0].map(|sign| Point::new(side(0, sign), side(1, sign)))
}

/// Returns discs (centre and radius) whose convex hull contains the tip and everything that the arm can touch at some
/// heights.
fn swept_discs(arm: &Arm, heights: Heights) -> Vec<(Point, f64)> {
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
            discs.push(if turns { (arm.elbow_at(q1), arm.tip.norm()) } else { (arm.tip_at([q1, q2].into()), 0.0) });
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
