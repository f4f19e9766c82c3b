//! Checks of motions along lines, without code of the crate `follow`: kinematics, distances, and the order of a line's points.

use cplan::motion::Trajectory;
use cplan_cases::plane::polygon_distance;
use cplan_toolpath::Toolpath;

/// A point in the plane, or the values of both joints.
pub type Point = [f64; 2];

/// The arm of the tests: two bars with round ends, whose joints at these ends turn counter-clockwise.
#[derive(Debug, Clone, Copy)]
pub struct Bars {
    /// Lengths of the bars, in metres.
    pub lengths: [f64; 2],
    /// Width of the bars, in metres.
    pub width: f64,
}

impl Bars {
    /// Returns the places of joint 1, joint 2 and the tip.
    pub fn places(&self, q: Point) -> [Point; 3] {
        let [first, second] = self.lengths;
        let elbow = [first * q[0].cos(), first * q[0].sin()];
        let turned = q[0] + q[1];
        [[0.0; 2], elbow, [elbow[0] + second * turned.cos(), elbow[1] + second * turned.sin()]]
    }

    /// Returns the place of the tip.
    pub fn tip(&self, q: Point) -> Point {
        self.places(q)[2]
    }

    /// Returns the distance between the bars and a convex polygon, or a disc if it has one corner; 0 if they overlap.
    pub fn distance(&self, q: Point, corners: &[Point], radius: f64) -> f64 {
        let [base, elbow, tip] = self.places(q);
        let bars = [[base, elbow], [elbow, tip]];
        let apart = bars.iter().map(|bar| polygon_distance(bar, corners)).fold(f64::INFINITY, f64::min);
        (apart - self.width / 2.0 - radius).max(0.0)
    }

    /// Returns both IK solutions for a point within reach. They coincide where the arm is straight or folded.
    pub fn solutions(&self, [x, y]: Point) -> Option<[Point; 2]> {
        let [first, second] = self.lengths;
        let cosine = (x * x + y * y - first * first - second * second) / (2.0 * first * second);
        (cosine.abs() <= 1.0).then(|| {
            [1.0, -1.0].map(|side| {
                let bend: f64 = side * cosine.acos();
                let turned = (second * bend.sin()).atan2(first + second * bend.cos());
                [y.atan2(x) - turned, bend]
            })
        })
    }
}

/// A state of the executed motion.
#[derive(Debug, Clone, Copy)]
pub struct State {
    /// Time since the beginning of the motion, in seconds.
    pub time: f64,
    /// Values of the joints.
    pub position: Point,
    /// First derivatives of the joints by time.
    pub velocity: Point,
    /// Second derivatives of the joints by time.
    pub acceleration: Point,
}

/// Returns states of the motion that a controller executes by joining positions and velocities with cubics. Between two states,
/// the tip moves by less than `step`.
pub fn played(bars: &Bars, trajectory: &Trajectory, step: f64) -> Vec<State> {
    let mut states = Vec::new();
    for i in 1..trajectory.time.len() {
        let duration = trajectory.time[i] - trajectory.time[i - 1];
        let ends = [i - 1, i].map(|k| (trajectory.position[k], trajectory.velocity[k]));
        // Coefficients of the cubic in seconds.
        let cubic = [0, 1].map(|k| {
            let [(a, va), (b, vb)] = ends.map(|(q, v)| (q[k], v[k]));
            let [c, d] = [
                (3.0 * (b - a) / duration - 2.0 * va - vb) / duration,
                (2.0 * (a - b) / duration + va + vb) / duration / duration,
            ];
            [a, va, c, d]
        });
        let reach = bars.lengths[0] + 2.0 * bars.lengths[1];
        let fastest = cubic
            .iter()
            .map(|[_, v, c, d]| v.abs() + 2.0 * (c * duration).abs() + 3.0 * (d * duration * duration).abs());
        let count = (fastest.fold(0.0, f64::max) * duration * reach / step).ceil().max(4.0) as usize;
        let state = |t: f64| State {
            time: trajectory.time[i - 1] + t,
            position: cubic.map(|[a, v, c, d]| a + t * (v + t * (c + t * d))),
            velocity: cubic.map(|[_, v, c, d]| v + t * (2.0 * c + 3.0 * t * d)),
            acceleration: cubic.map(|[_, _, c, d]| 2.0 * c + 6.0 * t * d),
        };
        let first = usize::from(i > 1);
        states.extend((first..=count).map(|k| state(duration * k as f64 / count as f64)));
    }
    states
}

/// Returns points of a line that are less than `step` apart.
pub fn points(line: &Toolpath, step: f64) -> Vec<Point> {
    let mut points = vec![line.start()];
    for piece in line.pieces() {
        let count = (2.0 * piece.curve.length() / step).ceil().max(1.0) as usize;
        points.extend((1..=count).map(|k| piece.curve.at(k as f64 / count as f64)));
    }
    points
}

/// Returns true if two points can move along both sequences, from the first to the last members, never farther apart than `most`
/// (the discrete Fréchet distance).
pub fn pass_together(first: &[Point], second: &[Point], most: f64) -> bool {
    pass_together_if([first.len(), second.len()], |i, j| {
        (first[i][0] - second[j][0]).hypot(first[i][1] - second[j][1]) <= most
    })
}

/// Does the same as [`pass_together`] for two sequences of these lengths. `near` is true for two indices whose members may be
/// passed at the same time.
pub fn pass_together_if([first, second]: [usize; 2], near: impl Fn(usize, usize) -> bool) -> bool {
    let mut reached: Vec<usize> = (0..second).take_while(|&j| near(0, j)).collect();
    for i in 1..first {
        let Some(&begin) = reached.first() else { return false };
        let until = reached[reached.len() - 1] + 1;
        let mut next = Vec::new();
        let mut old = reached.iter().peekable();
        let mut before = None;
        let mut j = begin;
        while j < second && (j <= until || next.last() == Some(&(j - 1))) {
            while old.next_if(|&&k| k < j).is_some_and(|&k| {
                before = Some(k);
                true
            }) {}
            let comes = old.peek() == Some(&&j)
                || before.is_some_and(|k| k + 1 == j)
                || next.last().is_some_and(|&k| k + 1 == j);
            if comes && near(i, j) {
                next.push(j);
            }
            j += 1;
        }
        reached = next;
    }
    reached.last() == Some(&(second - 1))
}
