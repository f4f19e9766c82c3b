//! The check of a proof for a cell.

use super::grid::ArmCells;
use super::separation::separates;
use super::{BoxProof, Contact, ContactBox, GoalContact, Grid, LinkPart, Proof, ProofError};
use cplan_geometry::penetration_depth;
use cplan_interrupt::checkpoint;
use cplan_judge::{Cell, CollisionBox, Disconnection, ProofBox, farthest_displacement};
use cplan_model::space::Configuration;
use cplan_model::{MotionProblem, Pair, Part, Scene};

/// Margin by which a depth must exceed a displacement, as a fraction of the lengths in the comparison. It is far
/// greater than the rounding of both values.
const ROUNDING: f64 = 1e-12;

/// Greatest difference of two values of a joint that name the same goal, radians or metres.
const SAME_GOAL: f64 = 1e-9;

impl Proof {
    /// Checks the claim for a cell whose arms have no steps. Boxes in four joints take time in proportion to their number and to the
    /// number of cells of the grid.
    ///
    /// # Errors
    /// The first [`ProofError`] found.
    pub fn check(&self, cell: &crate::Cell) -> Result<(), ProofError> {
        let problems = cell.arms.each_ref().map(|arm| arm.problem.query());
        match self {
            Self::Alone { arm, boxes } => check_alone(cell, arm, boxes),
            Self::Starts { parts, .. } => {
                let starts = problems.map(MotionProblem::start);
                Shapes::new(problems, *parts, "the starts")?.collide_at(starts, || "the starts".into())
            }
            Self::Goals { pairs, .. } => check_goals(problems, pairs),
            Self::Boxes(proof) => proof.check(problems),
        }
    }
}

fn check_alone(cell: &crate::Cell, name: &str, boxes: &[ProofBox]) -> Result<(), ProofError> {
    let arm = cell.arms.iter().find(|arm| arm.name == name).ok_or_else(|| ProofError::UnknownArm(name.to_owned()))?;
    let problem = arm.problem.query();
    let clearance = problem.scene().workspace().clearance;
    let claim = Disconnection::new(boxes.iter().copied().map(CollisionBox::from).collect());
    let checked = claim.checked(problem.scene(), problem.start(), problem.goals(), clearance);
    checked.map(drop).map_err(|error| ProofError::Alone { arm: name.to_owned(), error })
}

/// Checks that each pair of goals of the problems has a contact in the list.
fn check_goals(problems: [&MotionProblem; 2], pairs: &[GoalContact]) -> Result<(), ProofError> {
    let goals = problems.map(MotionProblem::goals);
    if goals.iter().any(|goals| goals.pieces().iter().any(|piece| !piece.is_point())) {
        return Err(ProofError::FreeJoint);
    }
    for at in goals[0].points().flat_map(|one| goals[1].points().map(move |two| [one, two])) {
        let is_near = |stated: &GoalContact| {
            (0..2).all(|arm| (0..2).all(|joint| (stated.goals[arm][joint] - at[arm][joint]).abs() <= SAME_GOAL))
        };
        let goals = at.map(<[f64; 2]>::from);
        let stated = pairs.iter().find(|stated| is_near(stated)).ok_or(ProofError::MissingGoals(goals))?;
        let place = || format!("the goals {:?} and {:?}", goals[0], goals[1]);
        Shapes::new(problems, stated.parts, &place())?.collide_at(at, place)?;
    }
    Ok(())
}

/// A contact whose shapes exist and certainly meet if they overlap in the plane.
enum KnownContact<'a> {
    Obstacle {
        /// The arm's scene for proofs of collisions.
        scene: &'a Scene,
        arm: usize,
        pair: Pair,
    },
    Arms(Shapes<'a>),
}

/// A part of each arm, at heights that certainly overlap.
struct Shapes<'a> {
    scenes: [&'a Scene; 2],
    links: [usize; 2],
    parts: [&'a Part; 2],
}

impl BoxProof {
    /// Checks the claim for both arms.
    pub(crate) fn check(&self, problems: [&MotionProblem; 2]) -> Result<(), ProofError> {
        let grid = self.grid(problems)?;
        let is_in_grid = |[first, end]: [usize; 2], cells: usize| first < end && end <= cells;
        let is_valid = |stated: &ContactBox| {
            stated.contact < self.contacts.len() && (0..4).all(|axis| is_in_grid(stated.cells[axis], grid.cells[axis]))
        };
        if let Some(number) = self.boxes.iter().position(|stated| !is_valid(stated)) {
            return Err(ProofError::InvalidBox(number));
        }
        let inner = problems.map(|problem| problem.scene().inner());
        let contacts = self.contacts.iter().enumerate().map(|(number, contact)| {
            let place = format!("contact {number}");
            match *contact {
                Contact::Arms(parts) => Shapes::new(problems, parts, &place).map(KnownContact::Arms),
                Contact::Obstacle { arm, link, part, obstacle, piece } => {
                    let (scene, pair) = (inner.get(arm), Pair { link, part, obstacle, piece });
                    let scene = scene.filter(|scene| scene.pairs().binary_search(&pair).is_ok());
                    let scene = scene.ok_or(ProofError::UnknownContact(place))?;
                    Ok(KnownContact::Obstacle { scene, arm, pair })
                }
            }
        });
        let contacts = contacts.collect::<Result<Vec<_>, _>>()?;
        // The separation takes less time than the collisions.
        let starts = [0, 1].map(|arm| grid.start_cells(arm, problems[arm]));
        let goals = [0, 1].map(|arm| grid.goal_cells(arm, problems[arm]));
        if starts.iter().chain(&goals).any(ArmCells::is_empty) {
            return Err(ProofError::Grid);
        }
        if !separates(&grid, &self.boxes, &starts, &goals) {
            return Err(ProofError::NotSeparated);
        }
        for (number, stated) in self.boxes.iter().enumerate() {
            checkpoint();
            let ends = [0, 1, 2, 3].map(|axis| grid.interval(axis, stated.cells[axis]));
            contacts[stated.contact].collides_in(ends, number)?;
        }
        Ok(())
    }

    /// Returns the grid if it covers the ranges of all joints. One turn of a joint without end is always from -pi to pi.
    fn grid(&self, problems: [&MotionProblem; 2]) -> Result<Grid, ProofError> {
        let own = Grid::new(problems.map(MotionProblem::scene));
        let covers = |k: usize| {
            let ([lower, upper], [least, greatest]) = (self.ranges[k], own.ranges[k]);
            match own.is_circle[k] {
                true => [lower, upper] == [least, greatest],
                false => lower <= least && greatest <= upper && (upper - lower).is_finite(),
            }
        };
        let grid = Grid { ranges: self.ranges, cells: self.cells, ..own };
        let is_suitable = (0..4).all(covers) && grid.count().is_some_and(|count| count > 0);
        if is_suitable { Ok(grid) } else { Err(ProofError::Grid) }
    }
}

impl KnownContact<'_> {
    /// Checks that the shapes collide in a whole box.
    fn collides_in(&self, ends: [[f64; 2]; 4], number: usize) -> Result<(), ProofError> {
        let cell = |arm: usize| {
            let [[a, b], [c, d]] = [ends[2 * arm], ends[2 * arm + 1]];
            Cell { lower: [a, c], upper: [b, d] }
        };
        match self {
            Self::Obstacle { scene, arm, pair } => {
                let stated = CollisionBox { cell: cell(*arm), pair: *pair };
                if stated.holds(scene, scene.workspace().clearance) {
                    Ok(())
                } else {
                    Err(ProofError::NotBlocked(number))
                }
            }
            Self::Arms(shapes) => shapes.collide_in([cell(0), cell(1)], || format!("box {number}")),
        }
    }
}

impl<'a> Shapes<'a> {
    /// Returns parts of both arms.
    ///
    /// # Errors
    /// Parts that do not exist or cannot meet.
    fn new(problems: [&'a MotionProblem; 2], parts: [LinkPart; 2], place: &str) -> Result<Self, ProofError> {
        let scenes = problems.map(MotionProblem::scene);
        let part = |arm: usize| scenes[arm].arm().links.get(parts[arm].link)?.parts.get(parts[arm].part);
        let known = part(0).zip(part(1)).filter(|(one, two)| {
            one.heights.overlap(two.heights) && ![one, two].iter().any(|part| part.inner_shape().is_sliver())
        });
        let (one, two) = known.ok_or_else(|| ProofError::UnknownContact(place.to_owned()))?;
        Ok(Self { scenes, links: parts.map(|part| part.link), parts: [one, two] })
    }

    /// Checks that the parts are nearer than the clearance, or overlap, in a whole box of both arms. `place` names the box.
    fn collide_in(&self, cells: [Cell; 2], place: impl Fn() -> String) -> Result<(), ProofError> {
        let clearance = self.scenes[0].workspace().clearance;
        let (mut motion, mut scale) = (0.0, clearance);
        let shapes = [0, 1].map(|side| {
            let (arm, link, Cell { lower, upper }) = (self.scenes[side].arm(), self.links[side], cells[side]);
            let middle = Configuration::from_fn(|k, _| f64::midpoint(lower[k], upper[k]));
            // The middle is rounded, so use the greater one of the distances to both ends.
            let half = [0, 1].map(|k| (upper[k] - middle[k]).max(middle[k] - lower[k]));
            let part = self.parts[side].inner_shape();
            let shape = part.at(&arm.pose(link, middle));
            motion += farthest_displacement(arm, link, &part, middle, half);
            scale += shape.reach_from(arm.base) + arm.base.norm();
            shape
        });
        let depth = penetration_depth(&shapes[0], &shapes[1].grown(clearance));
        let collides = depth > motion + ROUNDING * scale;
        if collides { Ok(()) } else { Err(ProofError::NotColliding { place: place(), depth, motion }) }
    }

    /// Checks that the parts are nearer than the clearance, or overlap, while both arms rest.
    fn collide_at(&self, at: [Configuration; 2], place: impl Fn() -> String) -> Result<(), ProofError> {
        self.collide_in(at.map(|q| Cell { lower: q.into(), upper: q.into() }), place)
    }
}
