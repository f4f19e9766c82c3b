//! The objects that the arms move: where each lies, and which arm carries it, at all times.

use super::Answer;
use super::motions::ShownMotions;
use super::page::short;
use crate::StepTimes;
use cplan_geometry::{Convex, Pose};
use cplan_handling::{Holding, Object, Task};
use cplan_model::{Grip, Scene};
use cplan_theme::Rgb;
use cplan_view::{ObstacleView, RoundingSteps};
use serde_json::{Value, json};

/// Number of the first object's colour. Those before it resemble the colours of the arms.
const FIRST_COLOR: usize = 3;

/// An object that the arms can move.
pub struct ShownObject<'a> {
    object: &'a Object,
    number: usize,
    grain: RoundingSteps,
    /// Its changes of place, in the order of time. Empty without motions.
    changes: Vec<Change>,
}

/// The grasp or the release of an object.
struct Change {
    /// Time on the common clock, seconds.
    time: f64,
    /// The arm that grasps or releases the object, 0 or 1.
    arm: usize,
    place: Place,
}

/// The place of an object between two changes.
enum Place {
    /// The arm carries the object, and its wrist turns it: beginning and end, seconds, and angle, radians, of each turn.
    Carried(Grip, Vec<[f64; 3]>),
    /// The object lies there.
    Lies(Pose),
}

impl Answer<'_> {
    /// Returns the objects of a cell whose arms have steps, in the order of the file.
    pub(super) fn objects(&self, motions: Option<&ShownMotions>) -> Vec<ShownObject<'_>> {
        let scenes = self.scenes();
        let grain = RoundingSteps::of(scenes[0].arm());
        let objects = self.tasks().into_iter().flatten().take(1).flat_map(|task| &task.objects).enumerate();
        objects
            .map(|(number, known)| {
                let object = self.first_holder(&known.name).unwrap_or(known);
                let changes = motions.map_or_else(Vec::new, |motions| changes(object, motions, scenes));
                ShownObject { object, number, grain, changes }
            })
            .collect()
    }

    /// Returns an object at its place at the beginning. In the task of an arm that takes it from the other one, it lies where
    /// that arm places it.
    fn first_holder(&self, name: &str) -> Option<&Object> {
        let mut all = self.tasks().into_iter().flatten().flat_map(|task| &task.objects);
        all.find(|object| object.name == name && object.initial_static_pose().is_some())
    }

    pub(super) fn tasks(&self) -> [Option<&Task>; 2] {
        self.cell.arms.each_ref().map(|arm| arm.task.as_ref())
    }
}

impl ShownObject<'_> {
    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.object.name
    }

    /// Returns the colour.
    pub fn color(&self) -> Rgb {
        cplan_theme::obstacle(FIRST_COLOR + self.number)
    }

    /// Returns the object at its place at the beginning.
    pub fn at_first(&self) -> ObstacleView {
        self.at(self.object.at)
    }

    /// Returns the object at all places to which the arms bring it.
    pub fn destinations(&self) -> impl Iterator<Item = ObstacleView> {
        self.released().map(|pose| self.at(pose))
    }

    /// Iterates over the shapes of the object at all places where it lies.
    pub fn shapes(&self) -> impl Iterator<Item = Convex> {
        let poses = [self.object.at].into_iter().chain(self.released());
        poses.flat_map(|pose| self.object.pieces.iter().map(move |piece| piece.at(&pose)))
    }

    fn released(&self) -> impl Iterator<Item = Pose> {
        self.changes.iter().filter_map(|change| match change.place {
            Place::Lies(pose) => Some(pose),
            Place::Carried(..) => None,
        })
    }

    fn at(&self, pose: Pose) -> ObstacleView {
        let obstacle = self.object.obstacle_at(Some(&pose.into()));
        ObstacleView::new(&obstacle, FIRST_COLOR + self.number, self.grain)
    }

    /// Returns the object for the page: its shape in its own frame, its first place, and its changes.
    pub fn json(&self) -> Value {
        let mut view = json!(self.at(Pose::identity()));
        view["at"] = place(self.object.at);
        view["changes"] = self.changes.iter().map(Change::json).collect();
        view
    }
}

impl Change {
    fn json(&self) -> Value {
        let mut change = json!({ "time": short(self.time), "arm": self.arm });
        match &self.place {
            Place::Lies(pose) => change["at"] = place(*pose),
            Place::Carried(grip, turns) => {
                change["grip"] = match *grip {
                    Grip::Rigid(pose) => json!({ "rigid": place(pose) }),
                    Grip::Level { angle, point } => json!({ "level": rounded([angle, point.x, point.y]) }),
                };
                if !turns.is_empty() {
                    change["turns"] = turns.iter().copied().map(rounded).collect();
                }
            }
        }
        change
    }
}

/// Returns the grasps and releases of an object in the order of time.
fn changes(object: &Object, motions: &ShownMotions, scenes: [&Scene; 2]) -> Vec<Change> {
    let is_about = |step: &&StepTimes| step.object.as_ref() == Some(&object.name);
    let of_arm = |arm: usize| motions.steps[arm].iter().filter(is_about).map(move |step| (arm, step));
    let mut events: Vec<(f64, usize, &StepTimes)> =
        [0, 1].into_iter().flat_map(of_arm).filter_map(|(arm, step)| Some((step.event?, arm, step))).collect();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pose = object.at;
    let mut changes: Vec<Change> = Vec::new();
    for (time, arm, step) in events {
        let place = if let Some(released) = step.released {
            if let Some(Change { place: Place::Carried(_, turns), .. }) = changes.last_mut() {
                turns.extend(turn(step));
            }
            pose = released;
            Place::Lies(released)
        } else {
            let (model, q) = (scenes[arm].arm(), motions.place(arm, time));
            let grip = match object.holding {
                Holding::Rigid => Grip::Rigid(model.poses(q)[1].inverse_pose(&pose)),
                Holding::Level => {
                    Grip::Level { angle: pose.rotation.angle(), point: pose.inverse_point(model.tip_at(q)) }
                }
            };
            Place::Carried(grip, turn(step).into_iter().collect())
        };
        changes.push(Change { time, arm, place });
    }
    changes
}

/// Returns the beginning, the end and the angle of the turn in a step.
fn turn(step: &StepTimes) -> Option<[f64; 3]> {
    step.turn.zip(step.turn_span).map(|(turn, [begin, end])| [begin, end, turn.to - turn.from])
}

/// Returns the coordinates and the angle of a pose for the page.
fn place(pose: Pose) -> Value {
    rounded([pose.translation.x, pose.translation.y, pose.rotation.angle()])
}

/// Rounds coordinates, angles and times for the page.
fn rounded(values: [f64; 3]) -> Value {
    json!(values.map(|value| (value * 1e5).round() / 1e5 + 0.0))
}
