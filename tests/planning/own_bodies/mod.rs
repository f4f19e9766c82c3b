//! The robot's own body against brute force that knows no rule for pairs.
//!
//! For the brute force, two shapes of different links collide where they overlap, unless they overlap in all of many
//! postures. All other pairs count. `CPLAN_TIMES=50` tries fifty times as many robots.

mod drawn;

use cplan::engine::Method;
use cplan::input::Overrides;
use cplan::{Options, Outcome, plan};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_check_files::check;
use cplan_testkit::flood::Cells;
use cplan_testkit::problems::{problem_of_texts, scene_of_texts};
use cplan_testkit::solid::V;
use drawn::{ELBOW, Robot, Shape};

/// Depths and distances below this count as touching, metres.
const TOUCHING: f64 = 1e-7;

/// Number of postures along a joint's range at which the brute force looks: for pairs whose distance depends on one
/// joint, and for the others.
const POSTURES: [usize; 2] = [2000, 120];

/// Number of postures along each straight piece of a path.
const ALONG: usize = 300;

/// Number of cells of the flood fill along a joint's range.
const CELLS: usize = 64;

/// The robot and the pairs of its shapes that count for the brute force.
struct Oracle<'a> {
    robot: &'a Robot,
    counted: Vec<[&'a Shape; 2]>,
    /// Number of pairs that share heights, but overlap in all postures.
    permanent: usize,
}

/// Returns the signed distance of two shapes at a posture.
fn distance([a, b]: [&Shape; 2], q: V) -> f64 {
    let turn = |angle: f64| [angle.cos(), angle.sin()];
    let placed = |shape: &Shape| match shape.group {
        0 => shape.solid,
        1 => shape.solid.placed(turn(q[0]), [0.0, 0.0]),
        _ => shape.solid.placed(turn(q[0] + q[1]), turn(q[0]).map(|c| ELBOW * c)),
    };
    placed(a).distance(&placed(b))
}

/// Returns evenly spaced numbers of a range, both ends included.
fn spread([low, high]: [f64; 2], count: usize) -> impl Iterator<Item = f64> {
    (0..=count).map(move |k| low + (high - low) * k as f64 / count as f64)
}

impl<'a> Oracle<'a> {
    fn new(robot: &'a Robot) -> Self {
        let (mut counted, mut permanent) = (Vec::new(), 0);
        for (number, a) in robot.shapes.iter().enumerate() {
            for b in &robot.shapes[number + 1..] {
                if a.group == b.group || !a.shares_heights(b) {
                    continue;
                }
                if Self::is_ever_free(robot, [a, b]) { counted.push([a, b]) } else { permanent += 1 }
            }
        }
        Self { robot, counted, permanent }
    }

    fn is_ever_free(robot: &Robot, pair: [&Shape; 2]) -> bool {
        let [first, second] = robot.ranges;
        let is_free = |q: V| distance(pair, q) > TOUCHING;
        match pair.map(|shape| shape.group) {
            [0, 1] => spread(first, POSTURES[0]).any(|q1| is_free([q1, 0.0])),
            [1, _] => spread(second, POSTURES[0]).any(|q2| is_free([0.0, q2])),
            _ => spread(first, POSTURES[1]).any(|q1| spread(second, POSTURES[1]).any(|q2| is_free([q1, q2]))),
        }
    }

    /// Returns the least signed distance of the pairs that count.
    fn clearance(&self, q: V) -> f64 {
        self.counted.iter().map(|pair| distance(*pair, q)).fold(f64::INFINITY, f64::min)
    }

    /// Returns true if cells that are free as a whole lead from one posture to the other.
    fn are_connected(&self, ends: [V; 2]) -> bool {
        let size = self.robot.ranges.map(|[low, high]| (high - low) / CELLS as f64);
        // No point of the arm is farther than 1.1 m from joint 1, or 0.6 m from joint 2.
        let moved = 1.1 * size[0] / 2.0 + 0.6 * size[1] / 2.0;
        let cells = Cells { count: [CELLS; 2], circles: [false; 2] };
        let is_free = |cell: usize| self.clearance(cells.middle(self.robot.ranges, cell)) > moved;
        let [from, to] = ends.map(|q| cells.locate(self.robot.ranges, q));
        cells.flood(is_free(from).then_some(from), |_, next| is_free(next))[to]
    }
}

/// Numbers of answers.
#[derive(Debug, Default)]
struct Tally {
    found: usize,
    infeasible: usize,
    unknown: usize,
    blocked: usize,
    /// Pairs that overlap in every posture.
    permanent: usize,
}

/// Plans between random postures of a robot, and compares the answers with the brute force.
fn attack(seed: u64, tally: &mut Tally) {
    let mut dice = Dice::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let robot = Robot::drawn(&mut dice);
    let oracle = Oracle::new(&robot);
    tally.permanent += oracle.permanent;
    for _ in 0..4 {
        let mut draw = || robot.ranges.map(|[low, high]| dice.within(low, high));
        let mut draw_free = || {
            let all: Vec<V> = (0..30).map(|_| draw()).collect();
            all.iter().copied().find(|q| oracle.clearance(*q) > 1e-4).unwrap_or(all[0])
        };
        let ends = [draw_free(), draw_free()];
        let world = format!(
            "[robot]\njoints = [\"j0\", \"j1\"]\n[start]\njoints = {:?}\n[goal]\njoints = {:?}\n",
            ends[0], ends[1]
        );
        let case = || format!("seed {seed}, {ends:?}\n{}\n{world}", robot.urdf);
        assert!(scene_of_texts(&robot.urdf, &world).is_ok(), "{}", case());
        let problem = match problem_of_texts(&robot.urdf, &world) {
            Ok(problem) => problem,
            Err(why) => {
                let least = ends.map(|q| oracle.clearance(q)).into_iter().fold(f64::INFINITY, f64::min);
                assert!(least <= TOUCHING, "refused, but free: {why}\n{}", case());
                tally.blocked += 1;
                continue;
            }
        };
        assert!(ends.iter().all(|q| oracle.clearance(*q) > -TOUCHING), "an end collides\n{}", case());
        let options = if dice.chance(0.2) { Options::default() } else { Method::First.into() };
        let answer = plan(&problem, &options).unwrap();
        match answer.outcome() {
            Outcome::Found(trajectory) => {
                for q in &trajectory.position {
                    assert!(oracle.clearance(*q) > -TOUCHING, "collides at {q:?}\n{}", case());
                }
                let path = answer.motion().and_then(|(_, answer)| answer.path()).expect("a path");
                for pair in path.waypoints().windows(2) {
                    for t in spread([0.0, 1.0], ALONG) {
                        let q = [0, 1].map(|k| pair[0][k] + t * (pair[1][k] - pair[0][k]));
                        assert!(oracle.clearance(q) > -TOUCHING, "collides at {q:?}\n{}", case());
                    }
                }
                tally.found += 1;
            }
            Outcome::Infeasible(_) => {
                assert!(!oracle.are_connected(ends), "infeasible, but there is a path\n{}", case());
                tally.infeasible += 1;
            }
            Outcome::Unknown(_) => {
                tally.unknown += 1;
                continue;
            }
        }
        let certificate = answer.certificate(&Overrides::default(), None).unwrap();
        check(&robot.urdf, &world, &certificate).unwrap_or_else(|why| panic!("certificate: {why}\n{}", case()));
    }
}

#[test]
fn bases_of_several_parts_are_in_the_way() {
    let mut tally = Tally::default();
    for seed in seeds(60) {
        attack(seed, &mut tally);
    }
    println!("{tally:?}");
    if uses_default_cases() {
        let Tally { found, infeasible, permanent, .. } = tally;
        assert!(found > 50 && infeasible > 10 && permanent > 20, "{found} {infeasible} {permanent}");
    }
}
