//! Made-up problems with results by brute force: every cell of a grid is checked, and no code of the planners is used.

use cplan::cspace::CObstacle;
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{
    Arm, Heights, Joint, JointType, Link, Obstacle, OutlineSource, Part, Plane, Scene, Shape, Workspace,
};
use cplan::space::{Configuration, JointRange, Path, Topology};
use cplan_testkit::scenes::placed;
use cplan_testkit::shapes::{self, convex, disc};
use nalgebra::Vector3;
use std::collections::VecDeque;

pub const TURN: JointType = JointType::Revolute { sign: 1.0 };

pub fn slide(x: f64, y: f64) -> JointType {
    JointType::Prismatic { direction: Vector::new(x, y) }
}

pub fn interval(lower: f64, upper: f64) -> JointRange {
    JointRange::Interval { lower, upper }
}

/// Returns an arm whose links are bars along x.
pub fn arm(
    names: [&str; 2],
    motions: [JointType; 2],
    axes: [JointRange; 2],
    lengths: [f64; 2],
    bars: [Convex; 2],
) -> Arm {
    let joint = |k: usize| Joint {
        name: names[k].to_owned(),
        joint_type: motions[k],
        range: axes[k],
        velocity: 1.0,
        acceleration: 1.0,
        jerk: None,
    };
    let link = |k: usize| Link {
        name: format!("link{k}"),
        parts: vec![Part {
            shape: bars[k].clone(),
            inner: None,
            number: 0,
            is_visual: false,
            heights: Heights::ALL,
            body: format!("link{k}"),
        }],
        source: OutlineSource::Collision,
    };
    Arm {
        name: "test arm".to_owned(),
        joints: [joint(0), joint(1)],
        links: [link(0), link(1)],
        base: Point::zeros(),
        offset: Vector::new(lengths[0], 0.0),
        tip: Point::new(lengths[1], 0.0),
        tip_name: "tool0".to_owned(),
        plane: Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() },
        dynamics: None,
        motors: None,
        self_obstacles: Vec::new(),
    }
}

pub fn capsule(length: f64, radius: f64) -> Convex {
    shapes::wall(Point::zeros(), Point::new(length, 0.0)).grown(radius)
}

pub fn block(x0: f64, y0: f64, x1: f64, y1: f64) -> Convex {
    convex(vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)], 0.0)
}

pub fn polygon(name: &str, corners: &[(f64, f64)]) -> Obstacle {
    let corners: Vec<Point> = corners.iter().map(|c| Point::new(c.0, c.1)).collect();
    obstacle(name, Shape::Polygon(corners.clone()), vec![convex(corners, 0.0)])
}

pub fn circle(name: &str, x: f64, y: f64, radius: f64) -> Obstacle {
    let center = Point::new(x, y);
    obstacle(name, Shape::Circle { center, radius }, vec![disc(center, radius)])
}

pub fn wall(name: &str, corners: &[(f64, f64)]) -> Obstacle {
    let corners: Vec<Point> = corners.iter().map(|c| Point::new(c.0, c.1)).collect();
    let pieces = corners.windows(2).map(|w| shapes::wall(w[0], w[1])).collect();
    obstacle(name, Shape::Polyline(corners), pieces)
}

fn obstacle(name: &str, shape: Shape, pieces: Vec<Convex>) -> Obstacle {
    Obstacle { name: name.to_owned(), shape, pieces, heights: Heights::ALL }
}

pub fn scene(arm: Arm, obstacles: Vec<Obstacle>) -> Scene {
    placed(arm, Workspace { name: "test".to_owned(), obstacles, clearance: 0.0, preferences: Vec::new() })
}

/// The cells of a grid, and the obstacles that the arm hits at their centres.
pub struct Cells {
    topology: Topology,
    pub n: usize,
    /// For each cell, the first obstacle that the arm hits at its centre. `None` if it hits nothing.
    hit: Vec<Option<usize>>,
    /// For each cell, all obstacles that the arm hits at its centre.
    all: Vec<Vec<usize>>,
}

impl Cells {
    pub fn sample(scene: &Scene, n: usize) -> Self {
        let mut cells = Self { topology: scene.arm().topology(), n, hit: Vec::new(), all: Vec::new() };
        for index in 0..n * n {
            let q = cells.center(index);
            let mut hits: Vec<usize> =
                scene.separations(q).filter(|c| c.separation.distance <= 0.0).map(|c| c.pair.obstacle).collect();
            hits.dedup();
            cells.hit.push(hits.first().copied());
            cells.all.push(hits);
        }
        cells
    }

    fn at(&self, axis: usize, steps: f64) -> f64 {
        let axis = self.topology.ranges[axis];
        axis.domain().0 + steps / self.n as f64 * axis.extent()
    }

    pub fn center(&self, index: usize) -> Configuration {
        let (i, j) = (index / self.n, index % self.n);
        Configuration::new(self.at(0, i as f64 + 0.5), self.at(1, j as f64 + 0.5))
    }

    /// Returns runs of cells in each column for which `inside` is true, as corners of rectangles.
    fn runs(&self, inside: impl Fn(usize) -> bool) -> Vec<Vec<Configuration>> {
        let mut boxes = Vec::new();
        for i in 0..self.n {
            let mut j = 0;
            while j < self.n {
                let begin = j;
                while j < self.n && inside(i * self.n + j) {
                    j += 1;
                }
                if j > begin {
                    let [x0, x1] = [0, 1].map(|d| self.at(0, (i + d) as f64));
                    let [y0, y1] = [begin, j].map(|j| self.at(1, j as f64));
                    boxes.push([(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|c| Configuration::new(c.0, c.1)).to_vec());
                }
                j = (j + 1).max(begin + 1);
            }
        }
        boxes
    }

    pub fn c_obstacles(&self, count: usize) -> Vec<CObstacle> {
        let of = |obstacle: usize| {
            self.runs(move |k| self.all[k].contains(&obstacle)).into_iter().map(move |corners| CObstacle {
                obstacle,
                link: 1,
                contour: corners,
            })
        };
        (0..count).flat_map(of).collect()
    }

    pub fn free_boxes(&self) -> Vec<Vec<Configuration>> {
        self.runs(|k| self.hit[k].is_none())
    }

    fn neighbors(&self, index: usize) -> Vec<(usize, [f64; 2])> {
        let n = self.n as i64;
        let (i, j) = (index as i64 / n, index as i64 % n);
        let step = |d: [i64; 2]| {
            let mut to = [i + d[0], j + d[1]];
            for (to, axis) in to.iter_mut().zip(self.topology.ranges) {
                if axis.is_circle() {
                    *to = to.rem_euclid(n);
                } else if !(0..n).contains(to) {
                    return None;
                }
            }
            let moved = [0, 1].map(|k| d[k] as f64 * self.topology.ranges[k].extent() / n as f64);
            Some(((to[0] * n + to[1]) as usize, moved))
        };
        [[-1, 0], [1, 0], [0, -1], [0, 1]].into_iter().filter_map(step).collect()
    }

    pub fn index(&self, q: Configuration) -> usize {
        (0..self.n * self.n)
            .min_by(|&a, &b| (self.center(a) - q).norm().total_cmp(&(self.center(b) - q).norm()))
            .unwrap()
    }

    /// Returns the number of steps from `goal` to each cell, by breadth-first search.
    pub fn labels(&self, goal: usize) -> Vec<u32> {
        let mut labels = vec![u32::MAX; self.hit.len()];
        labels[goal] = 0;
        let mut queue = VecDeque::from([goal]);
        while let Some(k) = queue.pop_front() {
            for (to, _) in self.neighbors(k) {
                if self.hit[to].is_none() && labels[to] == u32::MAX {
                    labels[to] = labels[k] + 1;
                    queue.push_back(to);
                }
            }
        }
        labels
    }

    /// Returns the path that follows the labels down to zero, continued past whole turns on circles.
    pub fn descend(&self, start: usize, labels: &[u32]) -> Path {
        let (mut at, mut q) = (start, self.center(start));
        let mut waypoints = vec![q];
        while labels[at] > 0 {
            let (to, d) = self.neighbors(at).into_iter().min_by_key(|(to, _)| labels[*to]).unwrap();
            q += Configuration::new(d[0], d[1]);
            waypoints.push(q);
            at = to;
        }
        Path::new(waypoints)
    }

    /// Computes the logarithm of the harmonic potential by plain relaxation.
    pub fn potential(&self, goal: usize) -> Vec<f64> {
        let mut p = vec![0.0_f64; self.hit.len()];
        for _ in 0..700 {
            for k in 0..p.len() {
                p[k] = match self.hit[k] {
                    _ if k == goal => 1.0,
                    Some(_) => 0.0,
                    None => self.neighbors(k).into_iter().map(|(to, _)| p[to]).sum::<f64>() / 4.0,
                };
            }
        }
        p.into_iter().map(f64::ln).collect()
    }
}
