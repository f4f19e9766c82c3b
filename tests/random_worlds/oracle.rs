//! The truth by brute force. Shares no code with the library but the types of its input: kinematics, distances and
//! connectivity are its own.

use cplan::geometry::Convex;
use cplan::model::{Motion, Scene};
use cplan::space::{Configuration, Path};

type V = [f64; 2];

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn norm(a: V) -> f64 {
    a[0].hypot(a[1])
}

fn rotate(a: V, by: V) -> V {
    [by[0] * a[0] - by[1] * a[1], by[1] * a[0] + by[0] * a[1]]
}

/// Distance of a point to a segment.
fn to_segment(p: V, a: V, b: V) -> f64 {
    let d = sub(b, a);
    let t = if dot(d, d) > 0.0 { (dot(sub(p, a), d) / dot(d, d)).clamp(0.0, 1.0) } else { 0.0 };
    norm(sub(p, [a[0] + t * d[0], a[1] + t * d[1]]))
}

/// Signed distance of two convex cores: by separating axes if they overlap (the depth), else the least distance of a
/// corner of one to a side of the other.
fn cores(a: &[V], b: &[V]) -> f64 {
    let sides = |s: &[V]| -> Vec<(V, V)> { (0..s.len()).map(|i| (s[i], s[(i + 1) % s.len()])).collect() };
    let (sa, sb) = (sides(a), sides(b));
    let mut gap = f64::NEG_INFINITY;
    for &(p, q) in sa.iter().chain(&sb) {
        let d = sub(q, p);
        let length = norm(d);
        if length == 0.0 {
            continue;
        }
        for n in [[-d[1] / length, d[0] / length], [d[0] / length, d[1] / length]] {
            let span = |s: &[V]| {
                s.iter().map(|&x| dot(n, x)).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)))
            };
            let ((al, au), (bl, bu)) = (span(a), span(b));
            gap = gap.max(al - bu).max(bl - au);
        }
    }
    if a.len() == 1 && b.len() == 1 {
        return norm(sub(a[0], b[0]));
    }
    if gap < 0.0 {
        return gap;
    }
    let one = a.iter().flat_map(|&p| sb.iter().map(move |&(u, v)| to_segment(p, u, v)));
    let two = b.iter().flat_map(|&p| sa.iter().map(move |&(u, v)| to_segment(p, u, v)));
    one.chain(two).fold(f64::INFINITY, f64::min)
}

struct Solid {
    core: Vec<V>,
    radius: f64,
    /// Greatest distance from the frame's origin.
    reach: f64,
}

impl Solid {
    fn new(shape: &Convex) -> Self {
        let core: Vec<V> = shape.core().iter().map(|p| [p.x, p.y]).collect();
        let reach = core.iter().map(|&p| norm(p)).fold(0.0, f64::max) + shape.radius();
        Self { core, radius: shape.radius(), reach }
    }
}

/// A part of a link and what it can meet.
struct Mover {
    link: usize,
    solid: Solid,
    obstacles: Vec<usize>,
    /// Bounds on the speed of its points per unit of each joint's rate.
    speed: [f64; 2],
}

/// The world as the oracle sees it.
pub struct Oracle {
    motions: [Motion; 2],
    base: V,
    offset: V,
    movers: Vec<Mover>,
    obstacles: Vec<Solid>,
    clearance: f64,
    /// Lower and upper value of each axis; whether it is a circle.
    pub axes: [(f64, f64, bool); 2],
}

/// What the lattice says of a way from the start to any goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    Connected,
    Disconnected,
    Undecided,
}

const FREE: u8 = 1;
const BLOCKED: u8 = 2;
const OPEN: u8 = 3;

impl Oracle {
    pub fn new(scene: &Scene) -> Self {
        let arm = &scene.arm;
        let axes = [0, 1].map(|k| {
            let axis = arm.topology().axes[k];
            let (lower, upper) = axis.domain();
            (lower, upper, axis.is_circle())
        });
        let motions = [arm.joints[0].motion, arm.joints[1].motion];
        let offset = [arm.offset.x, arm.offset.y];
        let travel = axes[1].0.abs().max(axes[1].1.abs());
        let mut obstacles = Vec::new();
        let mut heights = Vec::new();
        for obstacle in &scene.workspace.obstacles {
            for piece in &obstacle.pieces {
                obstacles.push(Solid::new(piece));
                heights.push((obstacle.heights.lower, obstacle.heights.upper));
            }
        }
        let mut movers = Vec::new();
        for (link, l) in arm.links.iter().enumerate() {
            for part in &l.parts {
                let solid = Solid::new(&part.shape);
                let turns = motions.map(|m| matches!(m, Motion::Revolute { .. }));
                let arms = match (link, turns[1]) {
                    (0, _) => solid.reach,
                    (_, true) => norm(offset) + solid.reach,
                    (_, false) => norm(offset) + travel + solid.reach,
                };
                let first = if turns[0] { arms } else { 1.0 };
                let second = if link == 0 {
                    0.0
                } else if turns[1] {
                    solid.reach
                } else {
                    1.0
                };
                let meets = |&i: &usize| part.heights.lower <= heights[i].1 && heights[i].0 <= part.heights.upper;
                let speed = [first, second];
                movers.push(Mover { link, solid, obstacles: (0..obstacles.len()).filter(meets).collect(), speed });
            }
        }
        let base = [arm.base.x, arm.base.y];
        Self { motions, base, offset, movers, obstacles, clearance: scene.workspace.clearance, axes }
    }

    /// Turn (cosine, sine) and place of both links.
    fn frames(&self, q: Configuration) -> [(V, V); 2] {
        let mut turn = [1.0, 0.0];
        let mut place = self.base;
        [0, 1].map(|k| {
            if k == 1 {
                let o = rotate(self.offset, turn);
                place = [place[0] + o[0], place[1] + o[1]];
            }
            match self.motions[k] {
                Motion::Revolute { sign } => turn = rotate([(sign * q[k]).cos(), (sign * q[k]).sin()], turn),
                Motion::Prismatic { direction } => {
                    let d = rotate([direction.x * q[k], direction.y * q[k]], turn);
                    place = [place[0] + d[0], place[1] + d[1]];
                }
            }
            (turn, place)
        })
    }

    /// Least distance less the clearance to keep, over the movers; each reduced by how far it can move under the joint
    /// `deviation`, or (with `upper`) raised by it.
    fn measure(&self, q: Configuration, deviation: V, upper: bool) -> f64 {
        let frames = self.frames(q);
        let mut least = f64::INFINITY;
        for mover in &self.movers {
            let (turn, place) = frames[mover.link];
            let core: Vec<V> = mover.solid.core.iter().map(|&p| rotate(p, turn)).collect();
            let core: Vec<V> = core.iter().map(|p| [p[0] + place[0], p[1] + place[1]]).collect();
            let motion = dot(mover.speed, deviation) * if upper { 1.0 } else { -1.0 };
            for &i in &mover.obstacles {
                let obstacle = &self.obstacles[i];
                let rest = motion - mover.solid.radius - obstacle.radius - self.clearance;
                // No nearer than the distance of a corner less the part's size.
                let far = norm(sub(core[0], obstacle.core[0])) - size(&core) - size(&obstacle.core) + rest;
                if far < least {
                    least = least.min(cores(&core, &obstacle.core) + rest);
                }
            }
        }
        least
    }

    /// Distance to the nearest obstacle less the clearance to keep.
    pub fn room(&self, q: Configuration) -> f64 {
        self.measure(q, [0.0; 2], false)
    }

    /// Whether the start is connected to a goal, by a lattice of `n x n` cells (a power of two) whose cells are surely
    /// free, surely blocked, or neither.
    pub fn connected(&self, start: Configuration, goals: &[Configuration], n: usize) -> Truth {
        let mut labels = vec![OPEN; n * n];
        let first = n / 16;
        for i in 0..16 {
            for j in 0..16 {
                self.fill(&mut labels, n, [i * first, j * first], first);
            }
        }
        let from = self.cell(start, n);
        let goals: Vec<usize> = goals.iter().map(|&g| self.cell(g, n)).collect();
        let reach = |passes: &dyn Fn(u8) -> bool| {
            let seen = self.flood(&labels, n, from, passes);
            goals.iter().any(|&g| passes(labels[g]) && seen[g])
        };
        if reach(&|label| label == FREE) {
            Truth::Connected
        } else if !reach(&|label| label != BLOCKED) {
            Truth::Disconnected
        } else {
            Truth::Undecided
        }
    }

    /// Labels the square of cells, by halves where it is neither.
    fn fill(&self, labels: &mut [u8], n: usize, at: [usize; 2], width: usize) {
        let step = self.axes.map(|(lower, upper, _)| (upper - lower) / n as f64);
        let half = width as f64 / 2.0;
        let middle = Configuration::from_fn(|k, _| self.axes[k].0 + (at[k] as f64 + half) * step[k]);
        // A little more than half, so that neighbours' cells overlap despite rounding.
        let deviation = step.map(|s| s * half * (1.0 + 1e-9) + 1e-12);
        let label = if self.measure(middle, deviation, false) > 0.0 {
            FREE
        } else if self.measure(middle, deviation, true) < 0.0 {
            BLOCKED
        } else if width > 1 {
            let w = width / 2;
            for (i, j) in [(0, 0), (0, w), (w, 0), (w, w)] {
                self.fill(labels, n, [at[0] + i, at[1] + j], w);
            }
            return;
        } else {
            OPEN
        };
        for i in at[0]..at[0] + width {
            labels[i * n + at[1]..i * n + at[1] + width].fill(label);
        }
    }

    fn cell(&self, q: Configuration, n: usize) -> usize {
        let [i, j] = [0, 1].map(|k| {
            let (lower, upper, circle) = self.axes[k];
            let t = (q[k] - lower) / (upper - lower);
            let t = if circle { t.rem_euclid(1.0) } else { t };
            ((t * n as f64) as usize).min(n - 1)
        });
        i * n + j
    }

    fn flood(&self, labels: &[u8], n: usize, from: usize, passes: &dyn Fn(u8) -> bool) -> Vec<bool> {
        let mut seen = vec![false; n * n];
        let mut open = Vec::new();
        if passes(labels[from]) {
            seen[from] = true;
            open.push(from);
        }
        while let Some(at) = open.pop() {
            for (di, dj) in [(0, 1), (1, 0), (0, n - 1), (n - 1, 0)] {
                let (i, j) = ((at / n + di) % n, (at % n + dj) % n);
                let crosses_row = (di == 1 && i == 0) || (di == n - 1 && i == n - 1);
                let crosses_column = (dj == 1 && j == 0) || (dj == n - 1 && j == n - 1);
                if (crosses_row && !self.axes[0].2) || (crosses_column && !self.axes[1].2) {
                    continue;
                }
                let next = i * n + j;
                if !seen[next] && passes(labels[next]) {
                    seen[next] = true;
                    open.push(next);
                }
            }
        }
        seen
    }

    /// A configuration on the path with less room than `proven`: looked for in steps of `step`, longer ones only where
    /// the distance proves that nothing is left out.
    pub fn violation(&self, path: &Path, proven: f64, step: f64) -> Option<(Configuration, f64)> {
        let mut worst = None;
        for (a, b) in path.segments().chain([(path.goal(), path.goal())]) {
            let d = b - a;
            let length = d.norm();
            let speed = self.movers.iter().map(|m| dot(m.speed, [d[0].abs(), d[1].abs()])).fold(0.0, f64::max);
            let mut t = 0.0;
            loop {
                let at = a + d * t;
                let room = self.room(at);
                if room < proven {
                    worst = Some((at, room));
                }
                if t >= 1.0 || length == 0.0 {
                    break;
                }
                let safe = if speed > 0.0 { 0.9 * (room - proven) / speed } else { 1.0 };
                t = (t + safe.max(step / length)).min(1.0);
            }
        }
        worst
    }
}

/// Greatest distance from the first corner.
fn size(core: &[V]) -> f64 {
    core.iter().map(|&p| norm(sub(p, core[0]))).fold(0.0, f64::max)
}
