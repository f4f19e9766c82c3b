//! The proof that no motions of both arms exist: boxes in four joints in which the arms collide separate the starts from all
//! goals.
//!
//! The joint ranges form a box with four sides. A grid divides it. Boxes in which a collision is proven are removed, and so
//! are those that the others do not connect with the starts. If a remaining box contains a goal, one axis of the grid is
//! halved. Otherwise no motion exists. Boxes that have a face in common are connected. A point where boxes meet only at
//! an edge or a corner is in all boxes around it, so if one of these is a collision, the point is one as well.

use crate::between::{Between, Swept, surely_hits};
use cplan_interrupt::checkpoint;
use cplan_judge::Deviation;
use cplan_model::space::{Configuration, JointRange, Segment};
use cplan_model::{MotionProblem, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// Widening of a box by rounding, as a share of the values in it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The boxes of a proof.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Boxes {
    /// Number of boxes that were examined.
    pub examined: usize,
    /// Number of cells of the finest grid along each joint: those of the first arm, then those of the second.
    pub cells: [usize; 4],
}

/// The number of a box along each of the four joints.
type Index = [usize; 4];

/// The joints of both arms.
struct Joints<'a> {
    between: &'a Between<'a>,
    /// Scenes for proofs of collisions.
    inner: [Scene; 2],
    domains: [(f64, f64); 4],
    is_circle: [bool; 4],
    /// Motion of the links per unit of each joint, metres.
    levers: [f64; 4],
    cells: [usize; 4],
}

/// The links of one arm in a box of two joints. `None` if the arm is proven to collide with an obstacle in the whole box.
type InBox = Option<Swept>;

/// Examines at most `most` boxes.
///
/// # Errors
/// The reason why there is no proof, in words.
pub(crate) fn refuted_in_boxes(between: &Between, problems: [&MotionProblem; 2], most: usize) -> Result<Boxes, String> {
    let mut joints = Joints::new(between);
    let mut left: BTreeSet<Index> = BTreeSet::from([[0; 4]]);
    let mut examined = 0;
    loop {
        let axis = joints.halved_axis();
        if joints.domains.iter().all(|(lower, upper)| lower == upper) || examined + 2 * left.len() > most {
            let cells = joints.cells;
            return Err(format!(
                "proof of infeasibility: not found with {examined} boxes in the space of all four joints ({cells:?} cells)"
            ));
        }
        joints.cells[axis] *= 2;
        let mut placed = [BTreeMap::new(), BTreeMap::new()];
        let mut open = BTreeSet::new();
        for parent in &left {
            for half in 0..2 {
                checkpoint();
                let mut index = *parent;
                index[axis] = 2 * index[axis] + half;
                examined += 1;
                if !joints.is_collision(index, &mut placed) {
                    open.insert(index);
                }
            }
        }
        left = joints.connected(open, problems.map(MotionProblem::start));
        if !left.iter().any(|index| joints.has_goal(*index, problems)) {
            return Ok(Boxes { examined, cells: joints.cells });
        }
    }
}

impl<'a> Joints<'a> {
    fn new(between: &'a Between<'a>) -> Self {
        let (mut domains, mut is_circle) = ([(0.0, 0.0); 4], [false; 4]);
        for (arm, scene) in between.scenes.into_iter().enumerate() {
            let own = scene.arm();
            for (joint, range) in own.topology().ranges.into_iter().enumerate() {
                let k = 2 * arm + joint;
                domains[k] = range.domain();
                is_circle[k] = matches!(range, JointRange::Circle);
            }
        }
        let inner = between.scenes.map(|scene| scene.inner().into_owned());
        Self { between, inner, domains, is_circle, levers: between.levers(), cells: [1; 4] }
    }

    /// Returns the axis whose cells move the links farthest.
    fn halved_axis(&self) -> usize {
        let motion = |k: usize| self.levers[k] * (self.domains[k].1 - self.domains[k].0) / self.cells[k] as f64;
        (0..4).max_by(|a, b| motion(*a).total_cmp(&motion(*b)).then(b.cmp(a))).unwrap_or(0)
    }

    /// Returns the interval of a cell along an axis.
    fn interval(&self, axis: usize, cell: usize) -> [f64; 2] {
        let (lower, upper) = self.domains[axis];
        let at = |k: usize| {
            if k == self.cells[axis] { upper } else { lower + (upper - lower) * (k as f64 / self.cells[axis] as f64) }
        };
        [at(cell), at(cell + 1)]
    }

    /// Returns the links of an arm in a box of its two joints.
    fn placed(&self, arm: usize, cells: [usize; 2]) -> InBox {
        let (mut middle, mut half) = (Configuration::zeros(), [0.0; 2]);
        for joint in 0..2 {
            let [from, to] = self.interval(2 * arm + joint, cells[joint]);
            middle[joint] = f64::midpoint(from, to);
            half[joint] = (to - from) / 2.0 + ROUNDING * from.abs().max(to.abs());
        }
        let deviation = Deviation::Box(half);
        (!surely_hits(&self.inner[arm], middle, deviation)).then(|| self.between.swept(arm, middle, deviation))
    }

    /// Returns true if a collision is proven in a whole box.
    fn is_collision(&self, index: Index, known: &mut [BTreeMap<[usize; 2], InBox>; 2]) -> bool {
        let cells = [[index[0], index[1]], [index[2], index[3]]];
        for arm in 0..2 {
            known[arm].entry(cells[arm]).or_insert_with(|| self.placed(arm, cells[arm]));
        }
        match [0, 1].map(|arm| known[arm][&cells[arm]].as_ref()) {
            [Some(one), Some(two)] => self.between.surely_collide([one, two]),
            _ => true,
        }
    }

    /// Returns the boxes that are connected with the starts.
    fn connected(&self, mut boxes: BTreeSet<Index>, starts: [Configuration; 2]) -> BTreeSet<Index> {
        let at = [starts[0][0], starts[0][1], starts[1][0], starts[1][1]];
        let has_start = |index: &Index| {
            (0..4).all(|k| {
                let range = if self.is_circle[k] {
                    JointRange::Circle
                } else {
                    JointRange::Interval { lower: f64::NEG_INFINITY, upper: f64::INFINITY }
                };
                let [from, to] = self.interval(k, index[k]);
                let near = ROUNDING * (1.0 + at[k].abs());
                let value = range.wrap(at[k]);
                let copies = if self.is_circle[k] { vec![value, value + std::f64::consts::TAU] } else { vec![value] };
                copies.into_iter().any(|value| from - near <= value && value <= to + near)
            })
        };
        let mut open: Vec<Index> = boxes.iter().filter(|index| has_start(index)).copied().collect();
        boxes.retain(|index| !has_start(index));
        let mut reached = BTreeSet::new();
        while let Some(index) = open.pop() {
            checkpoint();
            reached.insert(index);
            for (axis, step) in (0..4).flat_map(|axis| [(axis, 1), (axis, self.cells[axis] - 1)]) {
                let mut next = index;
                next[axis] = (next[axis] + step) % self.cells[axis];
                let crosses_end = next[axis].abs_diff(index[axis]) > 1 || self.cells[axis] == 1;
                if (!crosses_end || self.is_circle[axis]) && boxes.remove(&next) {
                    open.push(next);
                }
            }
        }
        reached
    }

    /// Returns true if a box may contain goals of both arms.
    fn has_goal(&self, index: Index, problems: [&MotionProblem; 2]) -> bool {
        (0..2).all(|arm| {
            let topology = self.between.scenes[arm].arm().topology();
            problems[arm].goals().wrapped(&topology).any(|piece| self.meets(arm, index, &piece))
        })
    }

    /// Returns true if a box may contain a point of a segment of goals.
    fn meets(&self, arm: usize, index: Index, piece: &Segment) -> bool {
        let [a, b] = piece.ends();
        (0..2).all(|joint| {
            let [from, to] = self.interval(2 * arm + joint, index[2 * arm + joint]);
            let near = ROUNDING * (1.0 + a[joint].abs().max(b[joint].abs()));
            let (least, greatest) = (a[joint].min(b[joint]), a[joint].max(b[joint]));
            let is_met = |shift: f64| from - near <= greatest + shift && least + shift <= to + near;
            is_met(0.0)
                || self.is_circle[2 * arm + joint]
                    && [-1.0, 1.0].into_iter().any(|turn| is_met(turn * std::f64::consts::TAU))
        })
    }
}
