//! The search for a proof that no motions of both arms exist: boxes in four joints in which the arms collide separate the starts
//! from all goals.
//!
//! The joint ranges form a box with four sides. A grid divides it. Boxes in which a collision is proven are removed, and so
//! are those that the others do not connect with the starts. If a remaining box contains a goal, one axis of the grid is
//! halved. Otherwise no motion exists. Boxes that have a face in common are connected. A point where boxes meet only at
//! an edge or a corner is in all boxes around it, so if one of these is a collision, the point is one as well.
//!
//! The proof consists of those boxes of collisions that are next to the remaining ones. It must pass its own check.

use crate::between::{Between, Swept, proven_hit};
use crate::proof::{BoxProof, Contact, ContactBox, Grid, Index};
use cplan_interrupt::checkpoint;
use cplan_judge::Deviation;
use cplan_model::space::Configuration;
use cplan_model::{MotionProblem, Pair, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// Widening of a box by rounding, as a share of the values in it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The search for boxes.
struct Search<'a> {
    between: &'a Between<'a>,
    /// Scenes for proofs of collisions.
    inner: [Scene; 2],
    grid: Grid,
    /// Motion of the links per unit of each joint, metres.
    levers: [f64; 4],
    /// The boxes of collisions in the grids so far, the coarsest first.
    found: Vec<Collisions>,
}

/// The boxes of collisions in one grid.
#[derive(Default)]
struct Collisions {
    cells: Index,
    /// For each arm and each box of its joints, the contact with an obstacle in the whole box, or the links in the box.
    placed: [BTreeMap<[usize; 2], Result<Swept, Pair>>; 2],
    /// The contacts of both arms.
    between: BTreeMap<Index, Contact>,
}

/// Examines at most `most` boxes, and returns a checked proof.
///
/// # Errors
/// The reason why there is no proof, in words.
pub(crate) fn refuted_in_boxes(
    between: &Between,
    problems: [&MotionProblem; 2],
    most: usize,
) -> Result<BoxProof, String> {
    let inner = between.scenes.map(|scene| scene.inner().into_owned());
    let (grid, levers) = (Grid::new(between.scenes), between.levers());
    let mut search = Search { between, inner, grid, levers, found: Vec::new() };
    let mut left: BTreeSet<Index> = BTreeSet::from([[0; 4]]);
    let mut examined = 0;
    loop {
        let axis = search.halved_axis();
        let is_point = search.grid.ranges.iter().all(|[lower, upper]| lower == upper);
        let cells = search.grid.cells;
        search.grid.cells[axis] *= 2;
        if is_point || examined + 2 * left.len() > most || search.grid.count().is_none() {
            return Err(format!(
                "proof of infeasibility: not found with {examined} boxes in the space of all four joints ({cells:?} cells)"
            ));
        }
        search.found.push(Collisions { cells: search.grid.cells, ..Collisions::default() });
        let mut open = BTreeSet::new();
        for parent in &left {
            for half in 0..2 {
                checkpoint();
                let mut index = *parent;
                index[axis] = 2 * index[axis] + half;
                examined += 1;
                if !search.is_collision(index) {
                    open.insert(index);
                }
            }
        }
        let starts = [0, 1].map(|arm| search.grid.start_cells(arm, problems[arm]));
        let goals = [0, 1].map(|arm| search.grid.goal_cells(arm, problems[arm]));
        let is_at = |places: &[BTreeSet<[usize; 2]>; 2], [a, b, c, d]: &Index| {
            places[0].contains(&[*a, *b]) && places[1].contains(&[*c, *d])
        };
        left = search.connected(open, |index| is_at(&starts, index));
        if !left.iter().any(|index| is_at(&goals, index)) {
            let starts = starts[0].iter().flat_map(|[a, b]| starts[1].iter().map(|[c, d]| [*a, *b, *c, *d]));
            let proof = search.proof(&left, starts.collect(), examined);
            return match proof.check(problems) {
                Ok(()) => Ok(proof),
                Err(why) => Err(format!("proof of infeasibility: found, but refused by its check: {why}")),
            };
        }
    }
}

impl Search<'_> {
    /// Returns the axis whose cells move the links farthest.
    fn halved_axis(&self) -> usize {
        let Grid { ranges, cells, .. } = &self.grid;
        let motion = |k: usize| self.levers[k] * (ranges[k][1] - ranges[k][0]) / cells[k] as f64;
        (0..4).max_by(|a, b| motion(*a).total_cmp(&motion(*b)).then(b.cmp(a))).unwrap_or(0)
    }

    /// Returns the links of an arm in a box of its two joints, or a contact with an obstacle in the whole box.
    fn placed(&self, arm: usize, cells: [usize; 2]) -> Result<Swept, Pair> {
        let (mut middle, mut half) = (Configuration::zeros(), [0.0; 2]);
        for joint in 0..2 {
            let [from, to] = self.grid.interval(2 * arm + joint, [cells[joint], cells[joint] + 1]);
            middle[joint] = f64::midpoint(from, to);
            half[joint] = (to - from) / 2.0 + ROUNDING * from.abs().max(to.abs());
        }
        let deviation = Deviation::Box(half);
        proven_hit(&self.inner[arm], middle, deviation)
            .map_or_else(|| Ok(self.between.swept(arm, middle, deviation)), Err)
    }

    /// Returns true if a collision is proven in a whole box of the finest grid.
    fn is_collision(&mut self, index: Index) -> bool {
        let cells = [[index[0], index[1]], [index[2], index[3]]];
        let Some(mut found) = self.found.pop() else { return false };
        for (arm, cells) in cells.into_iter().enumerate() {
            found.placed[arm].entry(cells).or_insert_with(|| self.placed(arm, cells));
        }
        let contact = match [0, 1].map(|arm| &found.placed[arm][&cells[arm]]) {
            [Ok(one), Ok(two)] => self.between.colliding_pair([one, two]).map(|pair| {
                let parts = self.between.link_parts(pair).expect("arms without objects have only links");
                found.between.insert(index, Contact::Arms(parts));
            }),
            _ => Some(()),
        };
        self.found.push(found);
        contact.is_some()
    }

    /// Returns the boxes that are connected with the starts.
    fn connected(&self, mut boxes: BTreeSet<Index>, has_start: impl Fn(&Index) -> bool) -> BTreeSet<Index> {
        let mut open: Vec<Index> = boxes.iter().filter(|index| has_start(index)).copied().collect();
        boxes.retain(|index| !has_start(index));
        let mut reached = BTreeSet::new();
        while let Some(index) = open.pop() {
            checkpoint();
            reached.insert(index);
            open.extend(self.grid.neighbors(index).filter(|next| boxes.remove(next)));
        }
        reached
    }

    /// Returns the proof: the boxes of collisions that contain a start or are next to a box that remains.
    fn proof(&self, left: &BTreeSet<Index>, starts: Vec<Index>, examined: usize) -> BoxProof {
        let beside = left.iter().flat_map(|index| self.grid.neighbors(*index)).chain(starts);
        let beside: BTreeSet<Index> = beside.filter(|index| !left.contains(index)).collect();
        let boxes: BTreeSet<(Contact, [[usize; 2]; 4])> =
            beside.into_iter().filter_map(|index| self.collision_around(index)).collect();
        let mut contacts: Vec<Contact> = boxes.iter().map(|(contact, _)| *contact).collect();
        contacts.dedup();
        let stated =
            |(contact, cells)| ContactBox { contact: contacts.partition_point(|other| *other < contact), cells };
        let boxes = boxes.into_iter().map(stated).collect();
        let Grid { ranges, cells, .. } = self.grid;
        BoxProof { examined, ranges, cells, contacts, boxes }
    }

    /// Returns the largest box of collisions that contains a box of the finest grid.
    fn collision_around(&self, index: Index) -> Option<(Contact, [[usize; 2]; 4])> {
        self.found.iter().find_map(|Collisions { cells, placed, between }| {
            let step = [0, 1, 2, 3].map(|k| self.grid.cells[k] / cells[k]);
            let coarse = [0, 1, 2, 3].map(|k| index[k] / step[k]);
            let mut stated = [0, 1, 2, 3].map(|k| [coarse[k] * step[k], (coarse[k] + 1) * step[k]]);
            let hit = |arm: usize| placed[arm].get(&[coarse[2 * arm], coarse[2 * arm + 1]])?.as_ref().err();
            if let Some((arm, pair)) = (0..2).find_map(|arm| Some((arm, hit(arm)?))) {
                // The other arm can be anywhere.
                for axis in [2 - 2 * arm, 3 - 2 * arm] {
                    stated[axis] = [0, self.grid.cells[axis]];
                }
                return Some((Contact::with_obstacle(arm, *pair), stated));
            }
            Some((*between.get(&coarse)?, stated))
        })
    }
}
