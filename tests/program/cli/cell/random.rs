//! Random cells of two bars each, compared with the oracle.

use super::super::Place;
use super::oracle::{Arm, Flood, clearance, distance};
use super::proofs::{check_boxes, verified};
use super::{SKEW, answer, check_found, check_waits};
use cplan_cases::dice::Dice;
use std::f64::consts::PI;

/// A random cell.
pub struct Cell {
    pub arms: [Arm; 2],
    width: f64,
    ranges: [[f64; 2]; 4],
    starts: [[f64; 2]; 2],
    goals: [[f64; 2]; 2],
    post: [f64; 2],
}

/// Half of the side of the post.
const POST: f64 = 0.03;

impl Cell {
    /// Returns a cell whose starts and goals are free.
    pub fn new(random: &mut Dice) -> Self {
        loop {
            let width = random.within(0.04, 0.1);
            let lengths = [0, 1].map(|_| [random.within(0.3, 0.5), random.within(0.2, 0.4)]);
            let apart = random.within(0.6, 1.1);
            let arms = [
                Arm::bars([0.0, 0.0], 0.0, lengths[0], width, [2.0, 3.0]),
                Arm::bars([apart, random.within(-0.1, 0.1)], PI, lengths[1], width, [1.5, 2.5]),
            ];
            let is_small = random.within(0.0, 1.0) < 0.4;
            let ranges = [0, 1, 2, 3].map(|_| {
                let half = if is_small { random.within(0.2, 0.5) } else { random.within(0.8, 2.0) };
                let middle = random.within(-0.3, 0.3);
                [middle - half, middle + half]
            });
            let mut within = |arm: usize| [0, 1].map(|k| random.within(ranges[2 * arm + k][0], ranges[2 * arm + k][1]));
            let (starts, goals) = ([within(0), within(1)], [within(0), within(1)]);
            let post = [random.within(0.1, 0.9) * apart, random.within(-0.6, 0.6)];
            let cell = Self { arms, width, ranges, starts, goals, post };
            let is_free = |q: [[f64; 2]; 2]| {
                distance(&cell.arms, q) > 0.005
                    && (0..2).all(|arm| clearance(&cell.arms[arm], q[arm], &[cell.post()]) > 0.005)
            };
            if is_free(cell.starts) && is_free(cell.goals) {
                return cell;
            }
        }
    }

    pub fn post(&self) -> Vec<[f64; 2]> {
        let [x, y] = self.post;
        vec![[x - POST, y - POST], [x + POST, y - POST], [x + POST, y + POST], [x - POST, y + POST]]
    }

    fn urdf(&self, arm: usize) -> String {
        let own = &self.arms[arm];
        let width = self.width;
        let bar = |length: f64| {
            format!(
                "<collision><origin xyz=\"{} 0 0.5\"/><geometry><box size=\"{length} {width} 1\"/></geometry></collision>",
                length / 2.0
            )
        };
        let joint = |k: usize, parent: &str, child: &str, at: f64| {
            let [lower, upper] = self.ranges[2 * arm + k];
            format!(
                "<joint name=\"j{k}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
                 <origin xyz=\"{at} 0 0\"/><axis xyz=\"0 0 1\"/>\
                 <limit lower=\"{lower}\" upper=\"{upper}\" effort=\"9\" velocity=\"{}\"/></joint>",
                own.speeds[k]
            )
        };
        format!(
            "<robot name=\"bars\"><link name=\"base\"/>{}<link name=\"inner\">{}</link>{}<link name=\"outer\">{}</link>\
             <joint name=\"flange\" type=\"fixed\"><parent link=\"outer\"/><child link=\"tip\"/><origin xyz=\"{} 0 0\"/></joint>\
             <link name=\"tip\"/></robot>",
            joint(0, "base", "inner", 0.0),
            bar(own.inner_length),
            joint(1, "inner", "outer", own.inner_length),
            bar(own.outer_length),
            own.outer_length
        )
    }

    /// Returns a folder with the files of the cell.
    pub fn place(&self) -> Place {
        Place::new().with("left.urdf", self.urdf(0)).with("right.urdf", self.urdf(1)).with("cell.toml", self.toml())
    }

    fn toml(&self) -> String {
        let arm = |k: usize, name: &str| {
            let Arm { base, angle, .. } = &self.arms[k];
            format!(
                "[[arm]]\nname = \"{name}\"\nurdf = \"{name}.urdf\"\nbase = {{ at = {base:?}, angle = {angle:?} }}\n\
                 start = {{ joints = {:?} }}\ngoal = {{ joints = {:?} }}\n",
                self.starts[k], self.goals[k]
            )
        };
        format!("{}{}[[obstacle]]\nname = \"post\"\npolygon = {:?}\n", arm(0, "left"), arm(1, "right"), self.post())
    }
}

#[test]
fn random_cells_agree_with_the_oracle() {
    let mut counts = [0; 3];
    for seed in cplan_cases::seeds(100) {
        let cell = Cell::new(&mut Dice::new(seed));
        let place = cell.place();
        let done = place.run(&["cell", "cell.toml", "--json", "--quiet", "--boxes", "20000"], "");
        assert!([0, 3, 4].contains(&done.code), "seed {seed}: {}", done.stderr);
        let answer = answer(&done);
        match done.code {
            0 => {
                let motions = check_found(&answer, &cell.arms, SKEW);
                for (k, motion) in motions.iter().enumerate() {
                    check_waits(&answer["arms"][k], motion);
                    assert_eq!(motion.position[0], cell.starts[k], "seed {seed}");
                    assert_eq!(motion.position[motion.position.len() - 1], cell.goals[k], "seed {seed}");
                    for step in 0..=400 {
                        let q = motion.at(motion.end() * f64::from(step) / 400.0);
                        assert!(clearance(&cell.arms[k], q, &[cell.post()]) > 0.0, "seed {seed}");
                    }
                }
                counts[0] += 1;
            }
            3 => {
                let flood = Flood { arms: &cell.arms, ranges: cell.ranges, obstacles: &[cell.post()], cells: 14 };
                assert!(!flood.connects(cell.starts, cell.goals), "seed {seed}: there are motions, {answer:.300}");
                verified(&place, "cell.toml", &answer, "").exits(3).says(&["infeasible: proven"]);
                check_boxes(&answer["proof"], &cell.arms, &[cell.post()], &mut Dice::new(seed));
                counts[1] += 1;
            }
            _ => counts[2] += 1,
        }
    }
    if cplan_cases::uses_default_cases() {
        assert!(counts[0] >= 60 && counts[1] >= 6 && counts[2] <= 25, "found, infeasible, unknown: {counts:?}");
    }
}

/// Returns joint values of a SCARA that put its tip at a place, with the elbow on one side.
fn scara_at(arm: &Arm, tip: [f64; 2], side: f64) -> Option<[f64; 2]> {
    let (sin, cos) = arm.angle.sin_cos();
    let [x, y] = [tip[0] - arm.base[0], tip[1] - arm.base[1]];
    let [x, y] = [cos * x + sin * y, cos * y - sin * x];
    let (a, b) = (arm.inner_length, arm.outer_length);
    let bend = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
    (bend.abs() < 1.0).then(|| {
        let elbow = side * bend.acos();
        let shoulder = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
        [(shoulder + PI).rem_euclid(2.0 * PI) - PI, elbow]
    })
}

#[test]
#[ignore = "a measurement: cargo test --release --test program -- --ignored --nocapture fifty_cells"]
fn fifty_cells_with_crossing_goals() {
    let mut random = cplan_cases::dice(57);
    let (mut times, mut gaps, mut count) = (Vec::new(), Vec::new(), 0);
    while count < 50 {
        let apart = random.within(0.6, 0.95);
        let arms = [super::scara([0.0, 0.0], 0.0), super::scara([apart, 0.0], PI)];
        let mut tip = |side: f64| [apart / 2.0 + random.within(-0.12, 0.12), side * random.within(0.08, 0.3)];
        let (starts, goals) = ([tip(-1.0), tip(1.0)], [tip(1.0), tip(-1.0)]);
        let sides = [0, 1].map(|_| if random.chance(0.5) { 1.0 } else { -1.0 });
        let [Some(one), Some(two)] = [0, 1].map(|arm| scara_at(&arms[arm], starts[arm], sides[arm])) else { continue };
        let arm = |name: &str, base: [f64; 2], angle: f64, start: [f64; 2], goal: [f64; 2]| {
            format!(
                "[[arm]]\nname = \"{name}\"\nurdf = \"{}\"\nbase = {{ at = {base:?}, angle = {angle:?} }}\n\
                 robot = {{ joints = [\"axis_1\", \"axis_2\"], tip = \"flange\", fixed = {{ axis_3 = -0.15 }} }}\n\
                 start = {{ joints = {start:?} }}\ngoal = {{ tip = {goal:?} }}\n",
                super::shipped("robots/scara.urdf")
            )
        };
        let cell = arm("left", [0.0; 2], 0.0, one, goals[0]) + &arm("right", [apart, 0.0], PI, two, goals[1]);
        let begun = std::time::Instant::now();
        let done =
            Place::new().with("cell.toml", cell).run(&["cell", "cell.toml", "--json", "--quiet", "--boxes", "0"], "");
        // Starts that collide, or goals out of reach.
        if ![0, 4].contains(&done.code) {
            continue;
        }
        count += 1;
        times.push(begun.elapsed().as_secs_f64());
        let answer = answer(&done);
        if done.code == 0 {
            check_found(&answer, &arms, SKEW);
            gaps.push(super::number(&answer["gap"]));
        }
    }
    times.sort_by(f64::total_cmp);
    gaps.sort_by(f64::total_cmp);
    println!(
        "found {} of {count}; {:.3} s in the median, 90 % within {:.3} s; gap {:.1} % in the median",
        gaps.len(),
        times[count / 2],
        times[count * 9 / 10],
        100.0 * gaps[gaps.len() / 2]
    );
    assert!(gaps.len() >= 48, "{} found", gaps.len());
}
