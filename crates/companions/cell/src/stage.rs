//! Stages of both arms: parts of their motions during which the same bodies move with the arm or rest.

use crate::between::Between;
use crate::body::Body;
use cplan_model::Scene;
use std::rc::Rc;

/// A part of an arm's motion with the same bodies: a motion between two steps, or the strokes and the grasp of a step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stage {
    /// Links, the payload, and the resting objects that only this arm moves.
    pub bodies: Vec<Rc<Body>>,
    /// Objects that the arm has placed for the other one.
    pub left: Vec<Left>,
    /// Objects that the arm will take from the other one.
    pub awaited: Vec<Awaited>,
}

/// An object that an arm has placed for the other one.
#[derive(Debug, Clone)]
pub(crate) struct Left {
    /// Index of the object.
    pub object: usize,
    /// Its pieces at rest.
    pub pieces: Vec<Body>,
    /// True if link 2 of the arm may touch the object, because the arm has just released it.
    pub is_released: bool,
}

/// An object that an arm will take from the other one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Awaited {
    /// Index of the object.
    pub object: usize,
    /// True if link 2 of the arm may touch the object, because the arm moves to it.
    pub is_next: bool,
}

/// A time of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StageTime {
    /// The beginning of the stage with this index.
    Begin(usize),
    /// The end of the stage with this index.
    End(usize),
}

/// A handover: the other arm takes an object after this arm has placed it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Precedence {
    /// Name of the object.
    pub name: String,
    /// The arm that places the object, 0 or 1.
    pub giver: usize,
    /// The end of its step.
    pub placed: StageTime,
    /// The time at which the other arm begins to take the object.
    pub taken: StageTime,
}

/// All pairs of a stage of one arm and a stage of the other arm.
#[derive(Debug)]
pub(crate) struct StagePairs<'a> {
    /// For each stage of the first arm, the pairs with the stages of the second arm.
    pairs: Vec<Vec<Between<'a>>>,
    /// The handovers.
    pub precedences: Vec<Precedence>,
}

impl<'a> StagePairs<'a> {
    /// Creates the only pair of two arms without steps.
    pub fn single(between: Between<'a>) -> Self {
        Self { pairs: vec![vec![between]], precedences: Vec::new() }
    }

    /// Creates all pairs of the stages of two arms.
    pub fn new(
        scenes: [&'a Scene; 2],
        stages: [&[Stage]; 2],
        is_one_robot: bool,
        clearance: f64,
        precedences: Vec<Precedence>,
    ) -> Self {
        let between =
            |one: &Stage, two: &Stage| Between::of_bodies(scenes, bodies([one, two]), is_one_robot, clearance);
        let row = |one: &Stage| stages[1].iter().map(|two| between(one, two)).collect();
        Self { pairs: stages[0].iter().map(row).collect(), precedences }
    }

    /// Returns true if both arms have a single stage.
    pub fn is_single(&self) -> bool {
        self.pairs.len() == 1 && self.pairs[0].len() == 1
    }

    /// Returns the bodies of both arms during two stages.
    pub fn between(&self, stages: [usize; 2]) -> &Between<'a> {
        &self.pairs[stages[0]][stages[1]]
    }

    /// Returns the scenes of both arms, without payloads.
    pub fn scenes(&self) -> [&'a Scene; 2] {
        self.pairs[0][0].scenes
    }

    /// Returns the distance to keep between the arms, metres.
    pub fn clearance(&self) -> f64 {
        self.pairs[0][0].clearance
    }
}

/// Returns the bodies of both arms during two stages. An object that one arm has placed for the other, and that waits there,
/// rests for both arms.
fn bodies(stages: [&Stage; 2]) -> [Vec<Rc<Body>>; 2] {
    let mut bodies = stages.map(|stage| stage.bodies.clone());
    for giver in 0..2 {
        let taker = 1 - giver;
        for left in &stages[giver].left {
            let Some(awaited) = stages[taker].awaited.iter().find(|awaited| awaited.object == left.object) else {
                continue;
            };
            for (side, may_touch) in [(giver, awaited.is_next), (taker, left.is_released)] {
                let resting = |body: &Body| Rc::new(Body { handover: Some(may_touch), ..body.clone() });
                bodies[side].extend(left.pieces.iter().map(resting));
            }
        }
    }
    bodies
}
