//! A task's steps with all repetitions written out, and the state of the objects after each step.

use super::group::{Body, Group, Leaf, LeafAction, Node, When};
use super::object::{MovableObject, Names, Supports, rests_on_itself};

use super::reader::Reader;
use super::requirement::{Required, Requirement, Requirements};
use super::{NAME_THE_WRIST, WITHOUT_JERK, WRIST_WITH_JERK};
use cplan_geometry::Point;
use cplan_handling::{Action, FollowedLine, Holding, Item, Step, ToolAngle};
use cplan_model::{Goal, Obstacle};
use cplan_robot::Diagnostic;
use nalgebra::Rotation2;
use std::f64::consts::TAU;
use std::ops::Range;

/// The task that a world file describes.
#[derive(Debug, Clone)]
pub(super) struct Sequence {
    pub items: Vec<Item>,
    /// Requirements on the arm. A requirement of a step is listed once, even if the step is repeated.
    pub requirements: Vec<Requirement>,
    /// Position in the file of the first step.
    pub at: Range<usize>,
}

/// Orientations count as equal within this angle, in radians. It is far above rounding errors, and below the repeatability of any
/// wrist.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Returns the file's steps with all repetitions written out. `at` is the position of the first step in the file.
///
/// # Errors
/// Picks while an object is carried, places without a carried object, repetitions that do not end in the state in which
/// they began, and impossible orientations.
pub(super) fn write_out(
    reader: &Reader,
    (names, obstacles, objects): (&Names, &[Obstacle], &[MovableObject]),
    wrist: WristOfWorld,
    steps: &Group,
    at: Range<usize>,
) -> Result<Sequence, Diagnostic> {
    let object_places: Vec<_> = objects.iter().map(ObjectPlace::initial).collect();
    let mut writer = Writer {
        reader,
        names,
        obstacles,
        objects,
        wrist,
        carried: None,
        object_places,
        rest_initially: Vec::new(),
        cycles: Vec::new(),
        items: Vec::new(),
        requirements: Requirements::default(),
    };
    writer.rest_initially = (0..objects.len()).map(|k| writer.is_carried(k, &writer.object_places[k])).collect();
    writer.group(steps)?;
    Ok(Sequence { items: writer.items, requirements: writer.requirements.all, at })
}

/// The place of an object. Parts of it may be unknown after the object was carried.
#[derive(Clone, Copy)]
pub(super) struct ObjectPlace {
    pub at: Point,
    /// The angle of the object. `None` if it depends on the configuration in which a rigid payload is placed.
    pub angle: Option<f64>,
    /// Position of the tip when the object was placed. The place step already requires that the tip can reach it.
    tip: Option<Point>,
    /// True if the object moves by itself. The other fields are then its initial values.
    moves: bool,
    /// Height by which the object is raised above its stated heights, metres.
    pub elevation: f64,
}

impl ObjectPlace {
    pub fn initial(movable: &MovableObject) -> Self {
        let pose = &movable.object.at;
        let moves = movable.object.trajectory.is_some();
        let (angle, elevation) = (Some(pose.rotation.angle()), 0.0);
        Self { at: pose.translation, angle, tip: None, moves, elevation }
    }

    /// Returns the position of a point of the object's frame, if it is known.
    fn point(&self, own: Point) -> Option<Point> {
        match self.angle {
            _ if own == Point::zeros() => Some(self.at),
            Some(angle) => Some(self.at + Rotation2::new(angle) * own),
            None => None,
        }
    }
}

/// What a world states about its wrist.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WristOfWorld {
    /// There is no wrist.
    None,
    /// The wrist's joint is not named.
    Nameless,
    /// The wrist's joint is named, and its jerk is limited.
    WithJerk,
    /// The wrist's joint is named.
    Named,
}

/// An object in the gripper.
#[derive(Clone, Copy)]
struct CarriedObject {
    object: usize,
    grasp: Point,
    /// Number of a step since the pick during which the object must keep its orientation.
    kept_by: Option<usize>,
}

pub(super) struct Writer<'a> {
    pub reader: &'a Reader<'a>,
    names: &'a Names<'a>,
    pub obstacles: &'a [Obstacle],
    pub objects: &'a [MovableObject],
    wrist: WristOfWorld,
    carried: Option<CarriedObject>,
    pub object_places: Vec<ObjectPlace>,
    /// For each object, true if something carries it initially. Otherwise, surfaces are assumed everywhere at the object's
    /// height.
    rest_initially: Vec<bool>,
    /// For each step of the file, the number of times that it has already been written out.
    cycles: Vec<usize>,
    items: Vec<Item>,
    requirements: Requirements,
}

impl Writer<'_> {
    fn group(&mut self, group: &Group) -> Result<(), Diagnostic> {
        let initial = self.carried.map(|c| c.object);
        for repetition in 0..group.repeat {
            if repetition > 0 {
                self.repeat(group, initial)?;
            }
            match &group.body {
                Body::InOrder(nodes) => {
                    for node in nodes {
                        match node {
                            Node::Group(group) => self.group(group)?,
                            Node::Step(leaf) => {
                                let step = self.step(leaf)?;
                                self.items.push(Item::Step(step));
                            }
                        }
                    }
                }
                Body::AnyOrder(pairs) => {
                    let pairs = pairs.iter().map(|[pick, place]| Ok([self.step(pick)?, self.step(place)?]));
                    let pairs = pairs.collect::<Result<_, Diagnostic>>()?;
                    self.items.push(Item::AnyOrder(pairs));
                }
            }
        }
        Ok(())
    }

    /// Begins the next repetition of a group. The arm must carry `initial`, the same object as when the group began.
    fn repeat(&mut self, group: &Group, initial: Option<usize>) -> Result<(), Diagnostic> {
        let carried = self.carried.map(|c| c.object);
        if carried != initial {
            let message = format!(
                "these steps cannot be repeated: the arm carries {} at their beginning and {} at their end",
                self.in_words(initial),
                self.in_words(carried)
            );
            let help = "add steps so that the arm carries the same at the end as at the beginning";
            return Err(self.reader.source.diagnostic_at(group.at.clone(), message).help(help));
        }
        if let Some(object) = carried.filter(|object| group.renewed.contains(object)) {
            let name = self.in_words(Some(object));
            let message = format!("object {name} is still carried when it is renewed");
            let help = "place the object before the steps are repeated, or remove its `renew`";
            return Err(self.reader.source.diagnostic_at(group.at.clone(), message).help(help));
        }
        if !group.renewed.is_empty() {
            for object in &group.renewed {
                self.object_places[*object] = ObjectPlace::initial(&self.objects[*object]);
            }
            self.items.push(Item::Renew(group.renewed.iter().copied().collect()));
        }
        Ok(())
    }

    fn in_words(&self, object: Option<usize>) -> String {
        object.map_or_else(|| "nothing".to_owned(), |o| format!("\"{}\"", self.objects[o].object.name))
    }

    fn step(&mut self, leaf: &Leaf) -> Result<Step, Diagnostic> {
        let handled = self.carried.map(|carried| carried.object);
        let action = match &leaf.action {
            LeafAction::Pick { object, grasp, supports, when } => {
                self.pick(leaf, *object, *grasp, supports, when.as_ref())?
            }
            LeafAction::Place { at, angle, supports, height } => {
                self.place(leaf, (*at, *height), angle.as_ref(), supports.as_ref())?
            }
            LeafAction::Move(goal) => {
                let required = match *goal {
                    Goal::Joints(q) => Some(Required::Joints(q)),
                    goal => goal.tip().map(|tip| Required::Tip(tip, goal.elbow())),
                };
                if let Some(required) = required {
                    self.requirements.add(leaf.number, required, leaf.at.clone());
                }
                Action::Move(*goal)
            }
            LeafAction::Follow(line) => Action::Follow(self.line(leaf, line)?),
        };
        let elbow = leaf.elbow;
        let of_line = matches!(&action, Action::Follow(line) if line.elbow.is_some());
        if elbow.is_some() || of_line || matches!(action, Action::Move(Goal::TipAndElbow(..))) {
            self.requirements.add(leaf.number, Required::Elbow, leaf.at.clone());
        }
        let handled = action.picked().or(handled.filter(|_| matches!(action, Action::Place { .. })));
        let elevation = handled.map_or(0.0, |object| self.object_places[object].elevation);
        if self.cycles.len() < leaf.number {
            self.cycles.resize(leaf.number, 0);
        }
        let cycle = &mut self.cycles[leaf.number - 1];
        *cycle += 1;
        Ok(Step {
            action,
            number: leaf.number,
            cycle: *cycle,
            place: leaf.place.clone(),
            speed: leaf.speed,
            dwell: leaf.dwell,
            tool: leaf.tool,
            elevation,
            elbow,
        })
    }

    /// Returns the line of a step. For a level payload, the stated angle is the angle of the payload, which does not change along
    /// the line anyway.
    ///
    /// # Errors
    /// An angle of the tool without a known wrist, or an angle that would turn the payload.
    fn line(&mut self, leaf: &Leaf, line: &FollowedLine) -> Result<FollowedLine, Diagnostic> {
        let Some(guide) = line.wrist else { return Ok(line.clone()) };
        let refuse = |message: String, help: &str| {
            let message = format!("step {}: {message}", leaf.number);
            Err(self.reader.source.diagnostic_at(leaf.at.clone(), message).help(help))
        };
        if self.wrist == WristOfWorld::WithJerk {
            return refuse(WRIST_WITH_JERK.into(), WITHOUT_JERK);
        }
        if self.wrist != WristOfWorld::Named {
            let message = "the line requires an angle of the tool, but the world does not name the wrist's joint";
            return refuse(message.into(), NAME_THE_WRIST);
        }
        let Some(CarriedObject { object, .. }) = self.carried else { return Ok(line.clone()) };
        let name = self.in_words(Some(object));
        let holding = self.objects[object].object.holding;
        match (holding, guide.angle, self.object_places[object].angle) {
            (Holding::Level, ToolAngle::Fixed(angle), Some(own)) => {
                let turn = (angle - own).rem_euclid(TAU);
                if turn.min(TAU - turn) > ANGLE_TOLERANCE {
                    let message =
                        format!("object {name} is carried level at {own} rad, but the line requires {angle} rad");
                    return refuse(message, "remove `wrist`, or write the angle of the object");
                }
                self.carried = self.carried.map(|carried| CarriedObject { kept_by: Some(leaf.number), ..carried });
                Ok(FollowedLine { wrist: None, ..line.clone() })
            }
            (Holding::Level, ..) => {
                let message = format!("object {name} is carried level, so the tool cannot turn along the line");
                refuse(message, "remove `wrist`, or place the object before the line")
            }
            (Holding::Rigid, ..) => {
                let message = format!("object {name} is held rigidly, so the wrist must not turn it along the line");
                refuse(message, "remove `wrist`, or place the object before the line")
            }
        }
    }

    fn pick(
        &mut self,
        leaf: &Leaf,
        object: usize,
        grasp: Point,
        supports: &Supports,
        when: Option<&When>,
    ) -> Result<Action, Diagnostic> {
        if let Some(carried) = self.carried {
            let message = format!(
                "step {} picks {} while {} is carried",
                leaf.number,
                self.in_words(Some(object)),
                self.in_words(Some(carried.object))
            );
            let diagnostic = self.reader.source.diagnostic_at(leaf.at.clone(), message);
            return Err(diagnostic.help("place the payload first"));
        }
        self.require_rest(leaf, object, supports)?;
        let object_places = self.object_places[object];
        if let Some(when) = when.filter(|_| !object_places.moves) {
            let name = self.in_words(Some(object));
            let message =
                format!("step {}: {name} no longer moves, because an earlier step has picked it", leaf.number);
            let diagnostic = self.reader.source.diagnostic_at(when.at.clone(), message);
            return Err(diagnostic.help("remove `at` and `window`; only the first pick of a moving object has them"));
        }
        if object_places.moves {
            self.object_places[object].moves = false;
        } else if let Some(tip) =
            object_places.point(grasp).filter(|tip| leaf.elbow.is_some() || object_places.tip != Some(*tip))
        {
            self.requirements.add(leaf.number, Required::Tip(tip, leaf.elbow), leaf.at.clone());
        }
        self.carried = Some(CarriedObject { object, grasp, kept_by: None });
        let when = when.map_or_else(Vec::new, |when| when.times.clone());
        Ok(Action::Pick { object, grasp, supports: supports.numbers.clone(), when })
    }

    fn place(
        &mut self,
        leaf: &Leaf,
        (at, height): (Point, Option<f64>),
        angle: Option<&(f64, Range<usize>)>,
        supports: Option<&Supports>,
    ) -> Result<Action, Diagnostic> {
        let Some(CarriedObject { object, grasp, kept_by }) = self.carried.take() else {
            let message = format!("step {} places an object, but the tool carries none", leaf.number);
            return Err(self.reader.source.diagnostic_at(leaf.at.clone(), message).help("pick an object first"));
        };
        let supports = supports.unwrap_or(&self.objects[object].supports);
        self.require_rest(leaf, object, supports)?;
        let asked = angle.map(|(angle, place)| self.turned(leaf, object, *angle, place)).transpose()?;
        if let (Some(kept_by), Some((angle, place))) = (kept_by, angle)
            && asked != self.object_places[object].angle
        {
            let name = self.in_words(Some(object));
            let message = format!(
                "step {}: object {name} is turned to {angle} rad, but step {kept_by} keeps its orientation",
                leaf.number
            );
            let help = "remove `wrist` from the line before, or the angle from this step";
            return Err(self.reader.source.diagnostic_at(place.clone(), message).help(help));
        }
        let before = self.object_places[object];
        let angle = match self.objects[object].object.holding {
            Holding::Rigid => None,
            Holding::Level => asked.or(before.angle),
        };
        let elevation = self.elevation(leaf, object, height)?;
        let mut object_places = ObjectPlace { at, angle, tip: None, moves: false, elevation };
        object_places.tip = object_places.point(grasp);
        let is_known = self.rest_initially[object] || elevation != 0.0;
        if is_known && !self.is_carried(object, &object_places) {
            if height.is_none() {
                return Err(self.in_the_air(leaf, object, &object_places));
            }
            self.note_surface(object, &object_places);
        }
        self.object_places[object] = object_places;
        if let Some(tip) = object_places.tip {
            self.requirements.add(leaf.number, Required::Tip(tip, leaf.elbow), leaf.at.clone());
        }
        Ok(Action::Place { at, angle: asked, supports: supports.numbers.clone() })
    }

    /// Returns the angle at which an object is placed: the requested angle, or the object's current one if both are equal up to
    /// rounding.
    ///
    /// # Errors
    /// An object that is held rigidly, or a requested turn without a wrist.
    fn turned(&self, leaf: &Leaf, object: usize, angle: f64, place: &Range<usize>) -> Result<f64, Diagnostic> {
        let refuse = |message: String, help: &str| {
            let message = format!("step {}: {message}", leaf.number);
            Err(self.reader.source.diagnostic_at(place.clone(), message).help(help))
        };
        let name = self.in_words(Some(object));
        // The orientation is unknown only for a rigid payload.
        let (Holding::Level, Some(before)) = (self.objects[object].object.holding, self.object_places[object].angle)
        else {
            let message =
                format!("object {name} is held rigidly, so the arm's configuration determines its orientation");
            return refuse(message, "write payload = \"level\" for the object, or remove the angle");
        };
        let turn = (angle - before).rem_euclid(TAU);
        if turn.min(TAU - turn) <= ANGLE_TOLERANCE {
            return Ok(before);
        }
        if self.wrist == WristOfWorld::None {
            let message = format!("object {name} must be turned from {before} to {angle} rad, but there is no wrist");
            return refuse(message, "add [robot] wrist = { velocity = 6.0 }, in rad/s, or remove the angle");
        }
        Ok(angle)
    }

    /// Requires that the object can rest on its supports.
    fn require_rest(&mut self, leaf: &Leaf, object: usize, supports: &Supports) -> Result<(), Diagnostic> {
        if supports.numbers.contains(&self.names.as_obstacle(object)) {
            return Err(rests_on_itself(self.reader, &self.objects[object].object.name, supports));
        }
        if !supports.numbers.is_empty() {
            self.requirements.add(leaf.number, Required::Rest(object), supports.at.clone());
        }
        Ok(())
    }
}
