//! Falsified certificates. Each must be refused, or its statement must still be true. A floating-point oracle that
//! shares no code with the checker decides this: it samples the boxes, and floods the cells between their ends.

use crate::common::two_bars::{LIMIT, TWO_BARS};
use cplan_cases as random;
use cplan_cases::dice::Dice;
use cplan_check_files::{CheckError, check};

/// Corners of both bars, relative to their joints.
const BARS: [[[f64; 2]; 4]; 2] =
    [[[0.0, -0.05], [1.0, -0.05], [1.0, 0.05], [0.0, 0.05]], [[0.0, -0.05], [0.8, -0.05], [0.8, 0.05], [0.0, 0.05]]];

const START: [f64; 2] = [-1.0, 0.2];
const GOAL: [f64; 2] = [1.0, -0.3];

/// A claim about a wall from `from` to 2.5 on the x axis. Each box states which of the bars touches this wall, or
/// touches a second wall out of reach.
#[derive(Clone, Debug)]
struct Claim {
    from: f64,
    boxes: Vec<Stuck>,
}

#[derive(Clone, Debug)]
struct Stuck {
    lower: [f64; 2],
    upper: [f64; 2],
    shape: usize,
    part: usize,
}

impl Claim {
    /// Returns a true claim. Its boxes are slices that overlap or have a common end, each cut in two at some value near
    /// 0.
    fn random_true(random: &mut Dice) -> Self {
        let mut boxes = Vec::new();
        let mut bottom = -LIMIT;
        while bottom < LIMIT {
            let top = (bottom + random.within(0.3, 1.5)).min(LIMIT);
            let cut = random.within(-0.005, 0.005);
            for [left, right] in [[cut - 0.02, cut], [cut, cut + 0.02]] {
                boxes.push(Stuck { lower: [left, bottom], upper: [right, top], shape: 0, part: 0 });
            }
            bottom = if top == LIMIT { top } else { top - random.within(0.0, 0.2) * random.below(2) as f64 };
        }
        Self { from: 0.5, boxes }
    }

    fn falsify(&mut self, random: &mut Dice) {
        let number = random.below(self.boxes.len());
        let [k, end] = [random.below(2), random.below(2)];
        let kind = random.below(10);
        let other = self.boxes[random.below(self.boxes.len())].clone();
        let stuck = &mut self.boxes[number];
        let ends = if end == 0 { &mut stuck.lower } else { &mut stuck.upper };
        match kind {
            0 => _ = self.boxes.remove(number),
            1 => ends[k] = ends[k].next_up(),
            2 => ends[k] = ends[k].next_down(),
            3 => ends[k] += random.within(-0.1, 0.1),
            4 => ends[k] += random.within(-1e-9, 1e-9),
            5 => (stuck.lower[k], stuck.upper[k]) = (other.lower[k], other.upper[k]),
            6 => std::mem::swap(&mut stuck.lower[k], &mut stuck.upper[k]),
            7 => [stuck.shape, stuck.part] = [random.below(3), random.below(3)],
            8 => {
                stuck.lower[0] -= random.within(0.0, 0.05);
                stuck.upper[0] += random.within(0.0, 0.05);
            }
            _ => self.from = random.within(0.3, 1.1),
        }
        if self.boxes.is_empty() {
            *self = Self::random_true(random);
        }
    }

    fn judge(&self) -> Result<String, CheckError> {
        let world = format!(
            "start.joints = {START:?}\ngoal.joints = {GOAL:?}\n[[obstacle]]\npolyline = [[{:?}, 0.0], [2.5, 0.0]]\n\
             [[obstacle]]\npolyline = [[7.0, 0.0], [8.0, 0.0]]\n",
            self.from
        );
        let written = |Stuck { lower, upper, shape, part }: &Stuck| {
            format!(r#"{{"lower": {lower:?}, "upper": {upper:?}, "shape": {shape}, "part": {part}}}"#)
        };
        let boxes: Vec<String> = self.boxes.iter().map(written).collect();
        let certificate = format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible",
            "shapes": [{{"link": "upper", "collision": 0}}, {{"link": "fore", "collision": 0}}],
            "parts": [{{"obstacle": 0, "corners": [[0.5, 0], [2.5, 0]]}}, {{"obstacle": 1, "corners": [[7, 0], [8, 0]]}}],
            "boxes": [{}]}}"#,
            boxes.join(",")
        );
        check(TWO_BARS, &world, &certificate)
    }

    /// Returns true if all sampled configurations of every box collide, up to rounding.
    fn is_collision(&self) -> bool {
        let steps = || (0..=4).map(|i| f64::from(i) / 4.0);
        let at = |stuck: &Stuck, s: f64, t: f64| {
            [s, t]
                .into_iter()
                .enumerate()
                .map(|(k, s)| stuck.lower[k] + (stuck.upper[k] - stuck.lower[k]) * s)
                .collect()
        };
        let wall = |part: usize| if part == 0 { [[self.from, 0.0], [2.5, 0.0]] } else { [[7.0, 0.0], [8.0, 0.0]] };
        self.boxes.iter().all(|stuck| {
            steps().all(|s| {
                steps().all(|t| {
                    let q: Vec<f64> = at(stuck, s, t);
                    separation(&bar([q[0], q[1]], stuck.shape), &wall(stuck.part)) < 1e-9
                })
            })
        })
    }

    /// Returns true if the boxes separate start and goal. A flood over the cells between the boxes' ends must not reach
    /// the goal's cell from the start's cell.
    fn separates(&self) -> bool {
        let ends = [0, 1].map(|k| {
            let inside = |x: &f64| x.abs() < LIMIT;
            let mut ends: Vec<f64> = self.boxes.iter().flat_map(|b| [b.lower[k], b.upper[k]]).filter(inside).collect();
            ends.extend([-LIMIT, LIMIT]);
            ends.sort_by(f64::total_cmp);
            ends.dedup();
            ends
        });
        let [columns, rows] = ends.each_ref().map(|e| e.len() - 1);
        let is_free = |[i, j]: [usize; 2]| {
            let holds = |b: &Stuck| {
                [i, j].into_iter().enumerate().all(|(k, c)| b.lower[k] <= ends[k][c] && ends[k][c + 1] <= b.upper[k])
            };
            !self.boxes.iter().any(holds)
        };
        let cell = |q: [f64; 2]| [0, 1].map(|k| ends[k].partition_point(|e| *e <= q[k]) - 1);
        let mut seen = vec![false; columns * rows];
        let mut waiting = vec![cell(START)];
        while let Some([i, j]) = waiting.pop() {
            if seen[i * rows + j] || !is_free([i, j]) {
                continue;
            }
            seen[i * rows + j] = true;
            waiting.extend((i > 0).then(|| [i - 1, j]));
            waiting.extend((i + 1 < columns).then(|| [i + 1, j]));
            waiting.extend((j > 0).then(|| [i, j - 1]));
            waiting.extend((j + 1 < rows).then(|| [i, j + 1]));
        }
        let [i, j] = cell(GOAL);
        !seen[i * rows + j]
    }
}

/// Returns a bar's corners in a configuration.
fn bar(q: [f64; 2], shape: usize) -> [[f64; 2]; 4] {
    let turned = |[x, y]: [f64; 2], angle: f64| {
        let (s, c) = angle.sin_cos();
        [c * x - s * y, s * x + c * y]
    };
    BARS[shape].map(|corner| {
        let carried = if shape == 0 { corner } else { turned(corner, q[1]) };
        turned([carried[0] + if shape == 0 { 0.0 } else { 1.0 }, carried[1]], q[0])
    })
}

/// Returns the distance of two convex shapes along the best separating line; negative if they overlap.
fn separation(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let normals = |ring: &[[f64; 2]]| -> Vec<[f64; 2]> {
        (0..ring.len())
            .flat_map(|i| {
                let ([x, y], [u, v]) = (ring[i], ring[(i + 1) % ring.len()]);
                let length = (u - x).hypot(v - y);
                [[(v - y) / length, (x - u) / length], [(y - v) / length, (u - x) / length]]
            })
            .collect()
    };
    let gap = |[x, y]: [f64; 2]| {
        let along = |p: &[f64; 2]| x * p[0] + y * p[1];
        b.iter().map(along).fold(f64::INFINITY, f64::min) - a.iter().map(along).fold(f64::NEG_INFINITY, f64::max)
    };
    normals(a).into_iter().chain(normals(b)).map(gap).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn falsified_certificates_are_refused_or_still_true() {
    let (mut held, mut refused) = (0, 0);
    for seed in random::seeds(600) {
        let mut random = Dice::new(seed);
        let mut claim = Claim::random_true(&mut random);
        if seed % 100 == 0 {
            claim.judge().unwrap_or_else(|why| panic!("seed {seed}: {why}"));
        }
        for _ in 0..=random.below(2) {
            claim.falsify(&mut random);
        }
        match claim.judge() {
            Ok(_) => {
                assert!(claim.is_collision() && claim.separates(), "seed {seed}: {claim:?}");
                held += 1;
            }
            Err(CheckError::Fails(_)) => refused += 1,
            Err(error) => panic!("seed {seed}: {error}"),
        }
    }
    assert!(held > random::times(60) && refused > random::times(200), "{held} held, {refused} refused");
}
