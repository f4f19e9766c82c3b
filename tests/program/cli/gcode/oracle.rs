//! A machine with its own kinematics, as its maker would write it: it shares no code with cplan.

use cplan_cases::plane::polygon_distance;
use std::f64::consts::TAU;

pub use cplan_cases::plane::{Point, distance};

/// Two bars of constant width on revolute joints, the first at the origin, with a firmware that keeps the side of its elbow.
pub struct Machine {
    pub lengths: [f64; 2],
    pub width: f64,
    pub limits: [[f64; 2]; 2],
    /// Range of the elbow's motor, if it is mounted on the base: it turns the sum of both joint values.
    pub motor: Option<[f64; 2]>,
    pub obstacles: Vec<Vec<Point>>,
}

/// A move of a program, metres.
#[derive(Debug, Clone)]
pub struct Move {
    /// Number of its line, from 1.
    pub line: usize,
    pub from: Point,
    pub to: Point,
    /// 0 to 3, for G0 to G3.
    pub kind: u32,
    /// The centre of an arc.
    pub center: Point,
}

impl Move {
    /// Returns the place at a share of the move.
    pub fn at(&self, u: f64) -> Point {
        let mix = |k: usize| self.from[k] + u * (self.to[k] - self.from[k]);
        if self.kind < 2 {
            return [mix(0), mix(1)];
        }
        let [first, last] = [self.from, self.to].map(|p| (p[1] - self.center[1]).atan2(p[0] - self.center[0]));
        let turn = (last - first).rem_euclid(TAU);
        let turn = match (self.kind, turn < 1e-9) {
            (3, true) => TAU,
            (3, false) => turn,
            (_, true) => -TAU,
            (_, false) => turn - TAU,
        };
        let radius = distance(self.from, self.center);
        let (sin, cos) = (first + u * turn).sin_cos();
        [self.center[0] + radius * cos, self.center[1] + radius * sin]
    }

    pub fn length(&self) -> f64 {
        (0..64).map(|k| distance(self.at(f64::from(k) / 64.0), self.at(f64::from(k + 1) / 64.0))).sum()
    }
}

/// Runs a program, and returns its moves after the first one, whose beginning it does not state.
pub fn moves(text: &str) -> Vec<Move> {
    let (mut unit, mut is_relative, mut kind) = (1e-3, false, 0);
    let (mut at, mut moves) = (None::<Point>, Vec::new());
    for (line, number) in text.lines().zip(1..) {
        let code = line.split([';', '(']).next().unwrap();
        let words = code.split_whitespace().map(|word| (&word[..1], word[1..].parse::<f64>().unwrap()));
        let words: Vec<(&str, f64)> = words.collect();
        let value = |letter: &str| words.iter().find(|word| word.0 == letter).map(|word| word.1);
        for (_, value) in words.iter().filter(|word| word.0 == "G") {
            match *value as u32 {
                20 => unit = 0.0254,
                21 => unit = 1e-3,
                90 => is_relative = false,
                91 => is_relative = true,
                other => kind = other,
            }
        }
        if value("X").is_none() && value("Y").is_none() && value("I").is_none() && value("J").is_none() {
            continue;
        }
        let from = at.unwrap_or([0.0; 2]);
        let coordinate = |letter: &str, k: usize| match value(letter) {
            Some(value) if is_relative => from[k] + unit * value,
            Some(value) => unit * value,
            None => from[k],
        };
        let to = [coordinate("X", 0), coordinate("Y", 1)];
        let center = [("I", 0), ("J", 1)].map(|(letter, k)| from[k] + unit * value(letter).unwrap_or(0.0));
        if at.is_some() && (distance(from, to) > 0.0 || kind > 1) {
            moves.push(Move { line: number, from, to, kind, center });
        }
        at = Some(to);
    }
    moves
}

/// The reason why the machine cannot play a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    OutOfReach,
    Jump,
    Limit,
    /// The arm is nearer to an obstacle than this, metres.
    Near(f64),
}

impl Machine {
    pub fn urdf(&self) -> String {
        let [a, b] = self.lengths;
        let limit = |k: usize| {
            let [lower, upper] = self.limits[k];
            format!("<limit lower=\"{lower}\" upper=\"{upper}\" effort=\"9\" velocity=\"3\"/>")
        };
        let bar = |length: f64| {
            format!(
                "<collision><origin xyz=\"{} 0 0\"/><geometry><box size=\"{length} {} 0.1\"/></geometry></collision>",
                length / 2.0,
                self.width
            )
        };
        format!(
            "<robot name=\"plotter\"><link name=\"base\"/>\
             <joint name=\"one\" type=\"revolute\"><parent link=\"base\"/><child link=\"upper\"/><axis xyz=\"0 0 1\"/>{}</joint>\
             <link name=\"upper\">{}</link>\
             <joint name=\"two\" type=\"revolute\"><parent link=\"upper\"/><child link=\"fore\"/><origin xyz=\"{a} 0 0\"/>\
             <axis xyz=\"0 0 1\"/>{}</joint><link name=\"fore\">{}</link>\
             <joint name=\"three\" type=\"fixed\"><parent link=\"fore\"/><child link=\"pen\"/><origin xyz=\"{b} 0 0\"/></joint>\
             <link name=\"pen\"/></robot>",
            limit(0),
            bar(a),
            limit(1),
            bar(b)
        )
    }

    pub fn world(&self) -> String {
        let obstacle = |corners: &Vec<Point>| format!("[[obstacle]]\npolygon = {corners:?}\n");
        let motor = self.motor.map_or(String::new(), |[lower, upper]| {
            format!("drives = {{ motors = {{ lower = [-9.0, {lower:?}], upper = [9.0, {upper:?}] }} }}\n")
        });
        format!("[robot]\ntip = \"pen\"\n{motor}{}", self.obstacles.iter().map(obstacle).collect::<String>())
    }

    /// Returns the joint values that put the tip at a place; `None` if it is out of reach.
    pub fn solve(&self, [x, y]: Point, is_left: bool) -> Option<Point> {
        let [a, b] = self.lengths;
        let cos = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
        if cos.abs() > 1.0 {
            return None;
        }
        // With the elbow to the left, the forearm is turned clockwise.
        let bend = if is_left { -cos.acos() } else { cos.acos() };
        Some([y.atan2(x) - (b * bend.sin()).atan2(a + b * bend.cos()), bend])
    }

    /// Returns the distance between the arm and the obstacles, metres; 0 if they meet.
    pub fn clearance(&self, [p, q]: Point) -> f64 {
        let elbow = [self.lengths[0] * p.cos(), self.lengths[0] * p.sin()];
        let bars = [bar([0.0; 2], p, self.lengths[0], self.width), bar(elbow, p + q, self.lengths[1], self.width)];
        let pairs =
            bars.iter().flat_map(|bar| self.obstacles.iter().map(move |obstacle| polygon_distance(bar, obstacle)));
        pairs.fold(f64::INFINITY, f64::min)
    }

    pub fn is_within_limits(&self, q: Point) -> bool {
        let is_within = |value: f64, [lower, upper]: [f64; 2]| lower - 1e-6 <= value && value <= upper + 1e-6;
        (0..2).all(|k| is_within(q[k], self.limits[k])) && self.motor.is_none_or(|range| is_within(q[0] + q[1], range))
    }

    /// Returns the joint values with whole turns that bring them within the limits, if there are any.
    pub fn turned(&self, q: Point) -> Option<Point> {
        [-TAU, 0.0, TAU].into_iter().map(|turn| [q[0] + turn, q[1]]).find(|q| self.is_within_limits(*q))
    }

    /// Plays a move by samples, with the tip on the line. Returns the joint values at both ends and the least distance.
    pub fn play(&self, own: &Move, is_left: bool) -> Result<([Point; 2], f64), Stop> {
        let count = (own.length() / 1e-3).ceil().max(16.0) as u32;
        let (mut ends, mut least) = ([[0.0; 2]; 2], f64::INFINITY);
        for k in 0..=count {
            let q = self.solve(own.at(f64::from(k) / f64::from(count)), is_left).ok_or(Stop::OutOfReach)?;
            let q = self.turned(q).ok_or(Stop::Limit)?;
            if k > 0 && (q[0] - ends[1][0]).abs() > 1.0 {
                return Err(Stop::Jump);
            }
            least = least.min(self.clearance(q));
            ends = [if k == 0 { q } else { ends[0] }, q];
        }
        if least <= 0.0 { Err(Stop::Near(least)) } else { Ok((ends, least)) }
    }

    /// Returns the least distance while both joints move straight, by samples.
    pub fn straight(&self, [from, to]: [Point; 2]) -> f64 {
        let at = |u: f64| [0, 1].map(|k| from[k] + u * (to[k] - from[k]));
        (0..=200).map(|k| self.clearance(at(f64::from(k) / 200.0))).fold(f64::INFINITY, f64::min)
    }

    /// Returns true if samples of a grid join two configurations with the elbow on the same side. The distances at the samples
    /// exceed the required one by the motion between samples, so they prove that there is a path.
    pub fn joins(&self, from: Point, to: Point, required: f64) -> bool {
        const SIZE: [usize; 2] = [140, 70];
        const ROOM: f64 = 0.005;
        let side = if from[1] < 0.0 { [self.limits[1][0], 0.0] } else { [0.0, self.limits[1][1]] };
        let ranges = [self.limits[0], side];
        let value = |k: usize, i: usize| ranges[k][0] + (ranges[k][1] - ranges[k][0]) * i as f64 / (SIZE[k] - 1) as f64;
        let cell = |q: Point| {
            [0, 1].map(|k| {
                let share = (q[k] - ranges[k][0]) / (ranges[k][1] - ranges[k][0]);
                (share * (SIZE[k] - 1) as f64).round().clamp(0.0, (SIZE[k] - 1) as f64) as usize
            })
        };
        let free = |q: Point| self.clearance(q) > required + ROOM;
        let goal = cell(to);
        let mut seen = vec![false; SIZE[0] * SIZE[1]];
        let mut open = vec![cell(from)];
        while let Some([i, j]) = open.pop() {
            if [i, j] == goal {
                return true;
            }
            for [di, dj] in [[0, 1], [1, 0], [1, 2], [2, 1]] {
                let (ni, nj) = (i + di, j + dj);
                if ni == 0 || nj == 0 || ni > SIZE[0] || nj > SIZE[1] || seen[(ni - 1) * SIZE[1] + nj - 1] {
                    continue;
                }
                let (here, there) = ([value(0, i), value(1, j)], [value(0, ni - 1), value(1, nj - 1)]);
                let middle = [0, 1].map(|k| (here[k] + there[k]) / 2.0);
                if free(there) && free(middle) {
                    seen[(ni - 1) * SIZE[1] + nj - 1] = true;
                    open.push([ni - 1, nj - 1]);
                }
            }
        }
        false
    }
}

fn bar(from: Point, angle: f64, length: f64, width: f64) -> Vec<Point> {
    let (sin, cos) = angle.sin_cos();
    let half = width / 2.0;
    [[0.0, -half], [length, -half], [length, half], [0.0, half]]
        .map(|[u, v]| [from[0] + u * cos - v * sin, from[1] + u * sin + v * cos])
        .to_vec()
}
