//! Two arms with their own kinematics and their own distances of polygons: this shares no code with cplan.

use cplan_cases::plane::polygon_distance;
use serde_json::Value;

pub use cplan_cases::plane::Point;

/// A shape of a link in the link's frame, with its heights.
#[derive(Debug, Clone)]
pub struct Solid {
    corners: Vec<Point>,
    heights: [f64; 2],
}

impl Solid {
    /// Returns a box with these sides about a centre.
    pub fn rectangle(center: Point, [width, depth]: [f64; 2], heights: [f64; 2]) -> Self {
        let corner = |x: f64, y: f64| [center[0] + x * width / 2.0, center[1] + y * depth / 2.0];
        let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        Self { corners, heights }
    }

    /// Returns a polygon of 32 corners on a circle.
    pub fn disc([x, y]: Point, radius: f64, heights: [f64; 2]) -> Self {
        let corner = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 32.0).sin_cos();
            [x + radius * cos, y + radius * sin]
        };
        Self { corners: (0..32).map(corner).collect(), heights }
    }
}

impl Solid {
    /// Returns a disc that contains the shape.
    fn disc_around(&self) -> (Point, f64) {
        let count = self.corners.len() as f64;
        let center = [0, 1].map(|k| self.corners.iter().map(|p| p[k]).sum::<f64>() / count);
        let far = |p: &Point| (p[0] - center[0]).hypot(p[1] - center[1]);
        (center, self.corners.iter().map(far).fold(0.0, f64::max))
    }
}

/// An arm whose joints turn about z.
#[derive(Debug, Clone)]
pub struct Arm {
    pub base: Point,
    pub angle: f64,
    /// Distance between the axes.
    pub inner_length: f64,
    /// Distance of the tip from the second axis.
    pub outer_length: f64,
    pub links: [Vec<Solid>; 2],
    pub speeds: [f64; 2],
}

impl Arm {
    /// Returns two bars with square ends, at one height.
    pub fn bars(base: Point, angle: f64, lengths: [f64; 2], width: f64, speeds: [f64; 2]) -> Self {
        let bar = |length: f64| vec![Solid::rectangle([length / 2.0, 0.0], [length, width], [0.0, 1.0])];
        let [inner_length, outer_length] = lengths;
        Self { base, angle, inner_length, outer_length, links: lengths.map(bar), speeds }
    }

    fn elbow(&self, q: [f64; 2]) -> Point {
        let (sin, cos) = (self.angle + q[0]).sin_cos();
        [self.base[0] + self.inner_length * cos, self.base[1] + self.inner_length * sin]
    }

    pub fn tip(&self, q: [f64; 2]) -> Point {
        let (sin, cos) = (self.angle + q[0] + q[1]).sin_cos();
        let [x, y] = self.elbow(q);
        [x + self.outer_length * cos, y + self.outer_length * sin]
    }

    fn solids(&self, q: [f64; 2]) -> Vec<Solid> {
        let frames = [(self.base, self.angle + q[0]), (self.elbow(q), self.angle + q[0] + q[1])];
        let placed = |(solids, ([x, y], angle)): (&Vec<Solid>, (Point, f64))| {
            let (sin, cos) = angle.sin_cos();
            let moved = move |[a, b]: &Point| [x + cos * a - sin * b, y + sin * a + cos * b];
            let place =
                move |solid: &Solid| Solid { corners: solid.corners.iter().map(moved).collect(), ..solid.clone() };
            solids.iter().map(place).collect::<Vec<_>>()
        };
        self.links.iter().zip(frames).flat_map(placed).collect()
    }
}

/// Returns the least distance of two arms, 0 if they overlap.
pub fn distance(arms: &[Arm; 2], q: [[f64; 2]; 2]) -> f64 {
    let (one, two) = (arms[0].solids(q[0]), arms[1].solids(q[1]));
    let mut least = f64::INFINITY;
    for (a, b) in one.iter().flat_map(|a| two.iter().map(move |b| (a, b))) {
        let overlap = a.heights[0].max(b.heights[0]) < a.heights[1].min(b.heights[1]);
        let ((p, r), (s, t)) = (a.disc_around(), b.disc_around());
        if overlap && (p[0] - s[0]).hypot(p[1] - s[1]) - r - t < least {
            least = least.min(polygon_distance(&a.corners, &b.corners));
        }
    }
    least
}

/// Returns the least distance of an arm from polygons, 0 if they overlap.
pub fn clearance(arm: &Arm, q: [f64; 2], obstacles: &[Vec<Point>]) -> f64 {
    let solids = arm.solids(q);
    let pairs = solids.iter().flat_map(|solid| obstacles.iter().map(move |other| (solid, other)));
    pairs.map(|(solid, other)| polygon_distance(&solid.corners, other)).fold(f64::INFINITY, f64::min)
}

/// A motion of one arm as the result states it: cubics through positions and velocities.
pub struct Motion {
    pub time: Vec<f64>,
    pub position: Vec<[f64; 2]>,
    pub velocity: Vec<[f64; 2]>,
}

impl Motion {
    /// Reads the motion of an arm from the result of `cplan cell`.
    pub fn read(arm: &Value) -> Self {
        let pairs = |name: &str| {
            let rows = arm["trajectory"][name].as_array().unwrap().iter();
            rows.map(|row| [row[0].as_f64().unwrap(), row[1].as_f64().unwrap()]).collect()
        };
        let time = arm["trajectory"]["time"].as_array().unwrap().iter().map(|time| time.as_f64().unwrap()).collect();
        Self { time, position: pairs("position"), velocity: pairs("velocity") }
    }

    pub fn end(&self) -> f64 {
        self.time[self.time.len() - 1]
    }

    pub fn at(&self, time: f64) -> [f64; 2] {
        let last = self.time.len() - 1;
        let next = self.time.partition_point(|known| *known <= time);
        if next == 0 || next > last {
            return self.position[if next == 0 { 0 } else { last }];
        }
        let (from, to) = (self.time[next - 1], self.time[next]);
        let (h, u) = (to - from, (time - from) / (to - from));
        [0, 1].map(|k| {
            let (p, r) = (self.position[next - 1][k], self.position[next][k]);
            let (v, w) = (self.velocity[next - 1][k], self.velocity[next][k]);
            let (u2, u3) = (u * u, u * u * u);
            p * (2.0 * u3 - 3.0 * u2 + 1.0)
                + v * h * (u3 - 2.0 * u2 + u)
                + r * (3.0 * u2 - 2.0 * u3)
                + w * h * (u3 - u2)
        })
    }
}

/// Replays both motions, the clock of one arm ahead of the other's by each skew. Returns the least distance.
pub fn replayed(arms: &[Arm; 2], motions: &[Motion; 2], skew: f64, step: f64) -> f64 {
    let end = motions[0].end().max(motions[1].end()) + skew;
    let mut least = f64::INFINITY;
    for shift in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let count = (end / step).ceil() as usize;
        for k in 0..=count {
            let time = end * k as f64 / count as f64;
            let q = [motions[0].at(time), motions[1].at(time + shift * skew)];
            least = least.min(distance(arms, q));
        }
    }
    least
}

/// A flood fill in four joints. It moves from cell to cell where the arms are certainly apart.
pub struct Flood<'a> {
    pub arms: &'a [Arm; 2],
    /// The ranges of all four joints.
    pub ranges: [[f64; 2]; 4],
    pub obstacles: &'a [Vec<Point>],
    /// Number of cells along each joint.
    pub cells: usize,
}

impl Flood<'_> {
    /// Returns true if there certainly are motions from starts to goals.
    pub fn connects(&self, starts: [[f64; 2]; 2], goals: [[f64; 2]; 2]) -> bool {
        let size = [0, 1, 2, 3].map(|k| (self.ranges[k][1] - self.ranges[k][0]) / self.cells as f64);
        let center = |index: [usize; 4]| [0, 1, 2, 3].map(|k| self.ranges[k][0] + (index[k] as f64 + 0.5) * size[k]);
        // Within a cell, and from its centre to a neighbour's, no point moves farther than this.
        let reach = |arm: &Arm| arm.inner_length + arm.outer_length + 0.1;
        let far = [0, 1].map(|arm| (size[2 * arm] + size[2 * arm + 1]) / 2.0 * reach(&self.arms[arm]));
        let is_free = |index: [usize; 4]| {
            let [a, b, c, d] = center(index);
            let q = [[a, b], [c, d]];
            distance(self.arms, q) > far[0] + far[1]
                && (0..2).all(|arm| clearance(&self.arms[arm], q[arm], self.obstacles) > far[arm])
        };
        let cell = |q: [[f64; 2]; 2]| {
            let values = [q[0][0], q[0][1], q[1][0], q[1][1]];
            [0, 1, 2, 3].map(|k| (((values[k] - self.ranges[k][0]) / size[k]) as usize).min(self.cells - 1))
        };
        let number = |index: [usize; 4]| index.iter().fold(0, |number, k| number * self.cells + k);
        let (from, to) = (cell(starts), cell(goals));
        let mut known = vec![false; self.cells.pow(4)];
        let mut open = if is_free(from) && is_free(to) { vec![from] } else { vec![] };
        while let Some(index) = open.pop() {
            if index == to {
                return true;
            }
            for (axis, is_up) in (0..4).flat_map(|axis| [(axis, true), (axis, false)]) {
                let mut next = index;
                let moved = if is_up { next[axis] + 1 } else { next[axis].wrapping_sub(1) };
                if moved >= self.cells {
                    continue;
                }
                next[axis] = moved;
                if !std::mem::replace(&mut known[number(next)], true) && is_free(next) {
                    open.push(next);
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_by_hand() {
        let arms = [
            Arm::bars([0.0, 0.0], 0.0, [1.0, 1.0], 0.2, [1.0; 2]),
            Arm::bars([3.0, 0.0], std::f64::consts::PI, [0.5, 0.4], 0.2, [1.0; 2]),
        ];
        assert!((distance(&arms, [[0.0, 0.0], [0.0, 0.0]]) - 0.1).abs() < 1e-12);
        assert!((distance(&arms, [[0.0, 0.0], [0.0, std::f64::consts::FRAC_PI_2]]) - 0.4).abs() < 1e-12);
        let near = Arm { base: [2.5, 0.0], ..arms[1].clone() };
        assert_eq!(distance(&[arms[0].clone(), near], [[0.0, 0.0], [0.0, 0.0]]), 0.0);
    }
}
