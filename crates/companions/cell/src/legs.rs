//! The legs of one arm before they are timed: certified motions, and rests in which the tool acts. An arm may wait between
//! legs. A motion without steps is a single leg.

use crate::curve::Curve;
use crate::schedule::{Schedule, Scheduled, ScheduledLeg, StepTimes, turn_span};
use crate::stage::StageTime;
use cplan_geometry::Pose;
use cplan_handling::{RecordedTurn, RecordedWrist};
use cplan_judge::CertifiedPath;
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};
use cplan_motion::{CertifiedCurve, Drive, MIN_INTERVAL, TimedMotion, TimingError, Trajectory, Wait};
use std::sync::Arc;

/// Greatest number of inner places of a path at which an arm may wait.
const MAX_STOPS: usize = 4;

/// A part of an arm's motion, from rest to rest.
#[derive(Debug, Clone)]
pub(crate) struct Leg {
    /// Index of the stage to which it belongs.
    pub stage: usize,
    /// The motion on its own clock.
    pub trajectory: Trajectory,
    /// The path. `None` if the arm rests.
    pub moving: Option<Moving>,
}

/// The path of a leg.
#[derive(Debug, Clone)]
pub(crate) struct Moving {
    /// The scene in which it is certified.
    pub scene: Arc<Scene>,
    pub curve: CertifiedCurve,
    /// Share of the top speeds of the joints.
    pub speed: f64,
}

/// A step of an arm, without its times.
#[derive(Debug, Clone)]
pub(crate) struct LegStep {
    /// Number of the step in the arm's task, from 1.
    pub file_step: usize,
    /// Number of its repetition, from 1.
    pub cycle: usize,
    /// The action in a few words.
    pub action: String,
    /// Name of the object that is picked or placed.
    pub object: Option<String>,
    /// Stage in which the tool is raised before the motion. `None` if it is raised already.
    pub raises: Option<usize>,
    /// Stage of its motion.
    pub moves: usize,
    /// Stage in which the tool acts after the motion. `None` if there is no such rest.
    pub acts: Option<usize>,
    /// Time from the arrival to the grasp or release without waits, seconds. `None` for other steps.
    pub event_after: Option<f64>,
    /// Pose of the object after its release. `None` for other steps.
    pub released: Option<Pose>,
    /// The turn of the object.
    pub turn: Option<RecordedTurn>,
    /// Values of the stroke's joint while the tool is lowered, before and after the motion, metres.
    pub lowered: [Option<f64>; 2],
    /// The turn of the wrist to the value that the step states. It begins this long after the motion, seconds.
    pub wrist: Option<RecordedWrist>,
}

/// The legs of one arm, at least one, in order.
#[derive(Debug, Clone)]
pub(crate) struct Legs {
    pub legs: Vec<Leg>,
    /// The steps. Empty for an arm without steps.
    pub steps: Arc<[LegStep]>,
}

impl Leg {
    /// Returns the leg along a path.
    ///
    /// # Errors
    /// A path that cannot be timed.
    pub fn along(
        drive: &Drive,
        scene: &Arc<Scene>,
        path: &CertifiedPath,
        speed: f64,
        stage: usize,
    ) -> Result<Self, TimingError> {
        let TimedMotion { curve, trajectory } = drive.along(scene, path, speed)?;
        Ok(Self { stage, trajectory, moving: Some(Moving { scene: scene.clone(), curve, speed }) })
    }

    /// Divides the leg near these times since its beginning, which differ by more than `apart` seconds.
    ///
    /// # Errors
    /// A part that cannot be timed.
    pub fn divided(
        &self,
        drive: &Drive,
        times: impl Iterator<Item = f64>,
        apart: f64,
    ) -> Result<Vec<Self>, TimingError> {
        let Some(Moving { scene, curve, speed }) = &self.moving else { return Ok(vec![self.clone()]) };
        let (path, places) = (curve.straight(), Curve::of_legs([&self.trajectory]));
        let mut ends: Vec<f64> = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for time in times {
            if time - last > apart && ends.len() < MAX_STOPS {
                ends.push(distance_near(path.path(), places.at(time)));
                last = time;
            }
        }
        let length = path.path().length();
        ends.sort_by(f64::total_cmp);
        ends.retain(|end| *end > 0.0 && *end < length);
        ends.dedup();
        if ends.is_empty() {
            return Ok(vec![self.clone()]);
        }
        // The last part ends exactly at the goal.
        ends.push(f64::INFINITY);
        let (mut legs, mut from) = (Vec::new(), 0.0);
        for to in ends {
            legs.push(Self::along(drive, scene, &path.part(from, to), *speed, self.stage)?);
            from = to;
        }
        Ok(legs)
    }
}

impl Legs {
    /// Returns the single leg along a path.
    ///
    /// # Errors
    /// A path that cannot be timed.
    pub fn along(drive: &Drive, scene: &Scene, path: &CertifiedPath) -> Result<Self, TimingError> {
        let leg = Leg::along(drive, &Arc::new(scene.clone()), path, 1.0, 0)?;
        Ok(Self { legs: vec![leg], steps: Arc::new([]) })
    }

    /// Returns the curve of all legs without waits.
    pub fn curve(&self) -> Curve {
        let stages = self.legs.iter().map(|leg| leg.stage).collect();
        Curve::of_legs(self.legs.iter().map(|leg| &leg.trajectory)).with_stages(stages)
    }

    /// Returns the times at which legs begin, and the end of the last, without waits.
    pub fn times(&self) -> Vec<f64> {
        let mut times = vec![0.0];
        for leg in &self.legs {
            times.push(times[times.len() - 1] + leg.trajectory.duration());
        }
        times
    }

    /// Returns the duration without waits, seconds.
    pub fn duration(&self) -> f64 {
        self.legs.iter().map(|leg| leg.trajectory.duration()).sum()
    }

    /// Returns the index of the leg at a time of a stage, and true if it is the end of this leg.
    pub fn leg_of(&self, at: StageTime) -> (usize, bool) {
        match at {
            StageTime::Begin(stage) => (self.legs.iter().position(|leg| leg.stage == stage).unwrap_or(0), false),
            StageTime::End(stage) => (self.legs.iter().rposition(|leg| leg.stage == stage).unwrap_or(0), true),
        }
    }

    /// Returns the whole motion with these departures, and its waits.
    pub fn departing(&self, departures: &[f64]) -> Scheduled {
        let mut trajectory = self.at_start();
        let (mut waits, mut schedule) = (Vec::new(), Vec::new());
        let mut curve: Option<CertifiedCurve> = None;
        for (leg, departs) in self.legs.iter().zip(departures) {
            let from = trajectory.duration();
            let at = *trajectory.position.last().expect("a start");
            trajectory.then((departs - from).max(0.0), &leg.trajectory);
            let to = trajectory.duration() - leg.trajectory.duration();
            if to - from >= MIN_INTERVAL && leg.trajectory.duration() > 0.0 {
                waits.push(Wait { from, to, at });
            }
            schedule.push(ScheduledLeg {
                stage: leg.stage,
                is_motion: leg.moving.is_some(),
                begin: to.max(from),
                end: trajectory.duration(),
            });
            let next = leg.moving.as_ref().map(|moving| &moving.curve);
            curve = match (curve, next) {
                (Some(curve), Some(next)) => Some(curve.then(next)),
                (curve, next) => curve.or(next.cloned()),
            };
        }
        // Only some legs have the values of a wrist.
        trajectory.wrist.clear();
        let curve = curve.expect("at least one leg with a path");
        Scheduled { motion: TimedMotion { curve, trajectory }, waits, schedule: Schedule(schedule) }
    }

    /// Returns a single sample at the start.
    fn at_start(&self) -> Trajectory {
        let first = &self.legs[0].trajectory;
        let row = |rows: &[[f64; 2]]| rows.first().copied().into_iter().collect::<Vec<_>>();
        Trajectory {
            time: vec![0.0],
            position: row(&first.position),
            velocity: vec![[0.0; 2]],
            acceleration: vec![[0.0; 2]],
            torque: row(&first.torque),
            wrist: Vec::new(),
        }
    }

    /// Returns the steps with their times.
    pub fn steps(&self, schedule: &Schedule) -> Vec<StepTimes> {
        let step = |(number, step): (usize, &LegStep)| {
            let arrival = schedule.time(StageTime::End(step.moves));
            let acting = step.acts.map(|stage| schedule.time(StageTime::Begin(stage)));
            let end = step.acts.map_or(arrival, |stage| schedule.time(StageTime::End(stage)));
            let rest = [acting.unwrap_or(arrival), end];
            let turn_span = step.turn.map(|turn| turn_span(turn, rest, step.released.is_some()));
            let begin = schedule.time(StageTime::Begin(step.moves));
            StepTimes {
                number: number + 1,
                file_step: step.file_step,
                cycle: step.cycle,
                action: step.action.clone(),
                object: step.object.clone(),
                raising: step.raises.map(|stage| schedule.time(StageTime::Begin(stage))),
                begin,
                arrival,
                event: step.event_after.map(|after| acting.unwrap_or(arrival) + after),
                end,
                released: step.released,
                turn: step.turn,
                turn_span,
                lowered: step.lowered,
                wrist: step.wrist.map(|wrist| RecordedWrist { begin: begin + wrist.begin, ..wrist }),
            }
        };
        self.steps.iter().enumerate().map(step).collect()
    }
}

/// Returns the distance along a path of its point nearest to a configuration.
fn distance_near(path: &Path, q: Configuration) -> f64 {
    let (mut best, mut gone) = ((f64::INFINITY, 0.0), 0.0);
    for (a, b) in path.segments() {
        let (along, length) = (b - a, (b - a).norm());
        let share = ((q - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let beside = (a + along * share - q).norm();
        if beside < best.0 {
            best = (beside, gone + share * length);
        }
        gone += length;
    }
    best.1
}
