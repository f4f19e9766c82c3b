//! The legs of one arm in time: when each begins and ends on the arm's clock.

use crate::curve::Curve;
use crate::stage::StageTime;
use cplan_geometry::Pose;
use cplan_handling::{RecordedTurn, RecordedWrist};
use cplan_motion::{TimedMotion, Trajectory, Wait};

/// The legs of an arm's motion in time, in order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Schedule(pub Vec<ScheduledLeg>);

/// A leg in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScheduledLeg {
    /// Index of its stage.
    pub stage: usize,
    /// True if the arm moves along a path. Otherwise it rests, and may move its tool.
    pub is_motion: bool,
    /// Beginning on the arm's clock, seconds.
    pub begin: f64,
    /// End on the arm's clock, seconds.
    pub end: f64,
}

/// The motion of an arm with its waits.
#[derive(Debug, Clone)]
pub(crate) struct Scheduled {
    pub motion: TimedMotion,
    pub waits: Vec<Wait>,
    pub schedule: Schedule,
}

/// The times of a handover on the common clock, seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct HandoverTimes {
    /// Name of the object.
    pub object: String,
    /// The arm that places the object, 0 or 1.
    pub giver: usize,
    /// The end of the step that places the object.
    pub placed: f64,
    /// The arrival of the other arm, which then takes the object.
    pub taken: f64,
}

/// The times of a step on the common clock, seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct StepTimes {
    /// Number of the step of the arm, from 1 in the order of execution.
    pub number: usize,
    /// Number of the step in the arm's task, from 1 in the order of the file: first the steps that either arm may do, then those
    /// of the arm, then the move to its goal.
    pub file_step: usize,
    /// Number of the step's repetition, from 1.
    pub cycle: usize,
    /// The action in a few words.
    pub action: String,
    /// Name of the object that is picked or placed.
    pub object: Option<String>,
    /// Time at which the tool begins to rise before the departure. `None` if it is raised already.
    pub raising: Option<f64>,
    /// The departure of the arm.
    pub begin: f64,
    /// The arrival of the arm.
    pub arrival: f64,
    /// Time at which the object is grasped or released. `None` for other steps.
    pub event: Option<f64>,
    /// The end of the step: the tool is raised, and the dwell is over.
    pub end: f64,
    /// Pose of the object after its release. `None` for other steps.
    pub released: Option<Pose>,
    /// The turn of the wrist with the object.
    pub turn: Option<RecordedTurn>,
    /// The beginning and the end of this turn.
    pub turn_span: Option<[f64; 2]>,
    /// Values of the stroke's joint while the tool is lowered, before and after the motion, metres. `None` if it is raised.
    pub lowered: [Option<f64>; 2],
    /// The turn of the wrist to the value of its joint that the step states.
    pub wrist: Option<RecordedWrist>,
}

/// Returns the beginning and the end of a turn at one end of a rest: at its beginning before a release, and at its end after a
/// grasp.
pub(crate) fn turn_span(turn: RecordedTurn, [begin, end]: [f64; 2], is_before_release: bool) -> [f64; 2] {
    if is_before_release { [begin, begin + turn.seconds] } else { [end - turn.seconds, end] }
}

impl Scheduled {
    /// Creates a motion without steps and waits.
    pub fn single(motion: TimedMotion) -> Self {
        let leg = ScheduledLeg { stage: 0, is_motion: true, begin: 0.0, end: motion.trajectory.duration() };
        Self { motion, waits: Vec::new(), schedule: Schedule(vec![leg]) }
    }
}

impl Schedule {
    /// Returns a time of a stage, seconds. A stage may consist of several legs.
    pub fn time(&self, at: StageTime) -> f64 {
        match at {
            StageTime::Begin(stage) => self.of_stage(stage).map(|leg| leg.begin).next().unwrap_or(0.0),
            StageTime::End(stage) => self.of_stage(stage).map(|leg| leg.end).last().unwrap_or(0.0),
        }
    }

    /// Iterates over the legs of a stage.
    fn of_stage(&self, stage: usize) -> impl Iterator<Item = &ScheduledLeg> {
        self.0.iter().filter(move |leg| leg.stage == stage)
    }

    /// Returns the curve of the whole motion between two times, with rests before and after it. A wait belongs to the motion
    /// beside it, because the tool is raised then.
    pub fn curve(&self, trajectory: &Trajectory, [from, to]: [f64; 2]) -> Curve {
        let bounds = self.0.windows(2).map(|legs| if legs[1].is_motion { legs[0].end } else { legs[1].begin });
        let stages: Vec<usize> = self.0.iter().map(|leg| leg.stage).collect();
        Curve::of_legs([trajectory]).resting(from, to).divided(&bounds.collect::<Vec<_>>(), &stages)
    }
}
