//! Coordinates two paths: finds the waits with which both arms follow their paths earliest.

use crate::between::Between;
use crate::curve::Curve;
use crate::diagram::{Rectangle, rectangles};
use crate::interlock::{Interlock, interlocks};
use crate::judged::{Judgement, NearestPlace, judge};
use crate::legs::Legs;
use crate::order::{Diagram, Waits};
use crate::schedule::{HandoverTimes, Schedule, Scheduled, StepTimes};
use crate::stage::{Precedence, StagePairs, StageTime};
use cplan_handling::Task;
use cplan_judge::CertifiedPath;
use cplan_legs::Leg as TaskLeg;
use cplan_model::space::Configuration;
use cplan_motion::{Drive, TimedMotion, TimingError, Trajectory, Wait};

/// Motion of the links in a rectangle of the diagram that is not examined further, as a share of the reach of the arms.
const RESOLUTION: f64 = 1.0 / 250.0;

/// Resolution for arms with steps, as a share of the reach. It is coarser, because their diagrams are larger.
const RESOLUTION_OF_STEPS: f64 = 1.0 / 80.0;

/// Distance between the arms beyond their clearance, as a share of the resolution. Without it, an arm may wait so near to the
/// other one that no proof succeeds.
const MARGIN_SHARE: f64 = 0.5;

/// Greatest number by which the resolution of the final diagram is divided, until signals are found.
const FINEST_DIAGRAM: f64 = 32.0;

/// Share of the duration of the longer motion that waits may cost without a second attempt.
const ACCEPTED_LOSS: f64 = 0.005;

/// Seconds by which a handover is shortened in a diagram, so that it does not touch its border. Departures are later by more.
const BORDER: f64 = 1e-6;

/// A motion of both arms on one clock.
#[derive(Debug, Clone)]
pub struct Coordination {
    /// The motion of each arm, in the order of the file. It is certified among the obstacles.
    pub motions: [TimedMotion; 2],
    /// The waits of each arm: at its start, and on its route.
    pub waits: [Vec<Wait>; 2],
    /// Time until both arms are at their goals, seconds.
    pub duration: f64,
    /// Proven lower bound on the distance of the arms, for all skews, metres. Infinite if no links can meet.
    pub clearance: f64,
    /// The nearest place that was seen. `None` if no links can meet.
    pub nearest: Option<NearestPlace>,
    /// The fewest signals with which the motions hold for any skew. `None` if no signals suffice.
    pub interlocks: Option<Vec<Interlock>>,
    /// The diagram: for each arm, the times of rectangles in which the arms may be too near to each other.
    pub diagram: Vec<[[f64; 2]; 2]>,
    /// For each arm, its steps in the order of execution. Empty for an arm without steps.
    pub steps: [Vec<StepTimes>; 2],
    /// The objects that one arm hands over to the other, with the times on the common clock.
    pub handovers: Vec<HandoverTimes>,
    /// For each arm, the plan of its steps without the other arm's waits. `None` if the cell has no steps.
    pub planned: Option<[PlannedSteps; 2]>,
    /// For each arm, its legs in time.
    pub(crate) schedules: [Schedule; 2],
}

/// The steps of an arm as they were planned for it.
#[derive(Debug, Clone)]
pub struct PlannedSteps {
    /// The task. Objects that only the other arm moves have no shape.
    pub task: Task,
    /// The steps in the order of execution. Their paths are those of the motion.
    pub legs: Vec<TaskLeg>,
}

impl Coordination {
    /// Returns the configuration of an arm at a time on its clock.
    pub fn place(&self, arm: usize, time: f64) -> Configuration {
        Curve::of_legs([&self.motions[arm].trajectory]).at(time)
    }

    /// Returns the length of an arm's path up to a time on its clock, in joint space. The motion must stop at each corner of
    /// the path.
    pub fn travelled(&self, arm: usize, time: f64) -> f64 {
        Curve::of_legs([&self.motions[arm].trajectory]).travelled(time)
    }
}

/// Why paths are not coordinated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Conflict {
    /// Proven: no timing along these paths avoids a collision, even if the arms move back and forth.
    Deadlock,
    /// No timing was found.
    NoTiming,
    /// A timing was found, but the judge did not accept the motions.
    NotCertified,
    /// The motions take longer than those that are known.
    Slower,
}

impl Conflict {
    /// Describes the conflict.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Deadlock => "the arms block each other along these paths (deadlock), proven",
            Self::NoTiming => "no timing was found",
            Self::NotCertified => "a timing was found, but its motions are not proven to be safe",
            Self::Slower => "not faster",
        }
    }
}

/// Coordinates pairs of paths.
#[derive(Clone, Copy)]
pub(crate) struct Coordinator<'a> {
    pub pairs: &'a StagePairs<'a>,
    pub drive: Drive,
    /// Seconds by which the clock of one arm may be ahead of the other's.
    pub skew: f64,
}

impl<'a> Coordinator<'a> {
    /// Returns the arms at their starts.
    pub fn between(&self) -> &'a Between<'a> {
        self.pairs.between([0, 0])
    }

    /// Returns the motion of the links, metres, up to which a rectangle of the diagram is divided.
    pub fn resolution(&self) -> f64 {
        let share = if self.pairs.is_single() { RESOLUTION } else { RESOLUTION_OF_STEPS };
        share * self.pairs.scenes().map(|scene| scene.arm().reach()).into_iter().fold(0.0, f64::max)
    }

    /// Returns the earliest motions along two paths that are found, if they end before `before`, seconds.
    ///
    /// # Errors
    /// A path that cannot be timed.
    pub fn along(
        &self,
        paths: [&CertifiedPath; 2],
        before: f64,
    ) -> Result<Result<Coordination, Conflict>, TimingError> {
        let scenes = self.pairs.scenes();
        let legs = |arm: usize| Legs::along(&self.drive, scenes[arm], paths[arm]);
        self.of_legs([&legs(0)?, &legs(1)?], before)
    }

    /// Returns the earliest motions along the legs of both arms that are found, if they end before `before`, seconds.
    ///
    /// # Errors
    /// A path that cannot be timed.
    pub fn of_legs(&self, legs: [&Legs; 2], before: f64) -> Result<Result<Coordination, Conflict>, TimingError> {
        let found = self.of_legs_with(legs, before, MARGIN_SHARE * self.resolution())?;
        match found {
            Err(Conflict::NoTiming | Conflict::NotCertified) => self.of_legs_with(legs, before, 0.0),
            _ => Ok(found),
        }
    }

    /// Does the same with a distance of `margin` metres beyond the clearance.
    fn of_legs_with(
        &self,
        whole: [&Legs; 2],
        before: f64,
        margin: f64,
    ) -> Result<Result<Coordination, Conflict>, TimingError> {
        let longest = whole.map(Legs::duration).into_iter().fold(0.0, f64::max);
        if longest >= before {
            return Ok(Err(Conflict::Slower));
        }
        let whole = whole.map(Legs::clone);
        let diagram = self.diagram(&whole, margin);
        let direct =
            diagram.route(Waits::BetweenLegs, self.skew).and_then(|route| diagram.departures(&route, self.skew));
        let duration = |legs: &[Legs; 2], departures: &[Vec<f64>; 2]| {
            let ends = [0, 1].map(|arm| {
                let lasts = legs[arm].legs.last().map_or(0.0, |leg| leg.trajectory.duration());
                departures[arm].last().copied().unwrap_or(0.0) + lasts
            });
            ends[0].max(ends[1])
        };
        let mut best = direct.map(|departures| (duration(&whole, &departures), whole.clone(), departures));
        if best.as_ref().is_none_or(|(duration, ..)| *duration > longest * (1.0 + ACCEPTED_LOSS)) {
            if best.is_none() && diagram.is_deadlock() {
                return Ok(Err(Conflict::Deadlock));
            }
            if let Some(legs) = self.with_stops(&whole, &diagram)? {
                let diagram = self.diagram(&legs, margin);
                let departures = diagram
                    .route(Waits::BetweenLegs, self.skew)
                    .and_then(|route| diagram.departures(&route, self.skew));
                if let Some(departures) = departures {
                    let lasts = duration(&legs, &departures);
                    if best.as_ref().is_none_or(|(known, ..)| lasts < *known) {
                        best = Some((lasts, legs, departures));
                    }
                }
            }
        }
        let Some((duration, legs, departures)) = best else { return Ok(Err(Conflict::NoTiming)) };
        if duration >= before {
            return Ok(Err(Conflict::Slower));
        }
        Ok(self.certified(&legs, &departures))
    }

    /// Returns the diagram of these legs.
    fn diagram(&self, legs: &[Legs; 2], margin: f64) -> Diagram {
        let curves = legs.each_ref().map(Legs::curve);
        let mut rectangles = rectangles(self.pairs, curves.each_ref(), margin, self.resolution());
        let times = legs.each_ref().map(Legs::times);
        rectangles.extend(self.pairs.precedences.iter().map(|precedence| {
            let of = |arm: usize, at: StageTime| {
                let (leg, is_end) = legs[arm].leg_of(at);
                (leg, times[arm][leg + usize::from(is_end)])
            };
            handover(precedence, of, times.each_ref().map(|times| times[times.len() - 1]))
        }));
        Diagram { legs: times, rectangles }
    }

    /// Divides the paths where the fastest route through the diagram waits. Returns `None` without a route, or without waits on
    /// the paths.
    fn with_stops(&self, legs: &[Legs; 2], diagram: &Diagram) -> Result<Option<[Legs; 2]>, TimingError> {
        let cost = self.pairs.scenes().map(|scene| {
            let braking = scene.arm().joints.each_ref().map(|joint| joint.velocity / joint.acceleration);
            braking[0].max(braking[1])
        });
        let Some(route) = diagram.route(Waits::Anywhere { cost }, self.skew) else { return Ok(None) };
        let mut divided = Vec::new();
        for (arm, waits) in route.waits().iter().enumerate() {
            let times = &diagram.legs[arm];
            let mut own = Legs { legs: Vec::new(), ..legs[arm].clone() };
            for (number, leg) in legs[arm].legs.iter().enumerate() {
                let inside = waits.iter().filter(|time| times[number] < **time && **time < times[number + 1]);
                own.legs.extend(leg.divided(&self.drive, inside.map(|time| time - times[number]), cost[arm])?);
            }
            divided.push(own);
        }
        let divided = <[Legs; 2]>::try_from(divided).ok();
        let count = |legs: &[Legs; 2]| legs.iter().map(|legs| legs.legs.len()).sum::<usize>();
        Ok(divided.filter(|divided| count(divided) > count(legs)))
    }

    /// Judges the motions with these departures.
    fn certified(&self, legs: &[Legs; 2], departures: &[Vec<f64>; 2]) -> Result<Coordination, Conflict> {
        let scheduled = [0, 1].map(|arm| legs[arm].departing(&departures[arm]));
        let steps = [0, 1].map(|arm| legs[arm].steps(&scheduled[arm].schedule));
        Ok(Coordination { steps, ..self.judged_legs(scheduled)? })
    }

    /// Judges motions of arms without steps that are certified among the obstacles.
    pub fn judged(&self, motions: [TimedMotion; 2]) -> Result<Coordination, Conflict> {
        self.judged_legs(motions.map(Scheduled::single))
    }

    fn judged_legs(&self, scheduled: [Scheduled; 2]) -> Result<Coordination, Conflict> {
        let times = |precedence: &Precedence| HandoverTimes {
            object: precedence.name.clone(),
            giver: precedence.giver,
            placed: scheduled[precedence.giver].schedule.time(precedence.placed),
            taken: scheduled[1 - precedence.giver].schedule.time(precedence.taken),
        };
        let handovers: Vec<HandoverTimes> = self.pairs.precedences.iter().map(times).collect();
        if handovers.iter().any(|handover| handover.placed + self.skew > handover.taken) {
            return Err(Conflict::NotCertified);
        }
        let duration = scheduled.each_ref().map(|own| own.motion.trajectory.duration()).into_iter().fold(0.0, f64::max);
        let whole = [-self.skew, duration + self.skew];
        let curves = scheduled.each_ref().map(|own| own.schedule.curve(&own.motion.trajectory, whole));
        let Judgement::Apart { clearance, nearest } = judge(self.pairs, &curves, self.skew) else {
            return Err(Conflict::NotCertified);
        };
        let [one, two] = scheduled;
        Ok(Coordination {
            motions: [one.motion, two.motion],
            waits: [one.waits, two.waits],
            schedules: [one.schedule, two.schedule],
            steps: [vec![], vec![]],
            handovers,
            duration,
            clearance,
            nearest,
            interlocks: None,
            planned: None,
            diagram: vec![],
        })
    }

    /// Adds the diagram and the signals.
    pub fn with_diagram(&self, found: Coordination) -> Coordination {
        let trajectories = found.motions.each_ref().map(|motion| &motion.trajectory);
        let ends = trajectories.map(Trajectory::duration);
        let curves = [0, 1].map(|arm| found.schedules[arm].curve(trajectories[arm], [0.0, ends[arm]]));
        let time = |arm: usize, at: StageTime| (0, found.schedules[arm].time(at));
        let handovers = self.pairs.precedences.iter().map(|precedence| handover(precedence, time, ends));
        let handovers: Vec<Rectangle> = handovers.collect();
        let is_beside = |rectangle: &Rectangle| {
            let [one, two] = rectangle.times;
            one[1] <= two[0] || two[1] <= one[0]
        };
        let mut resolution = self.resolution();
        loop {
            let mut rectangles = rectangles(self.pairs, curves.each_ref(), 0.0, resolution);
            rectangles.extend(&handovers);
            let interlocks = rectangles.iter().all(is_beside).then(|| interlocks(&rectangles));
            resolution /= 2.0;
            if interlocks.is_some() || resolution < self.resolution() / FINEST_DIAGRAM {
                let diagram = rectangles.iter().map(|rectangle| rectangle.times).collect();
                return Coordination { interlocks, diagram, ..found };
            }
        }
    }
}

/// Returns the rectangle of a handover: the taker must not begin before the giver has ended. `of` returns the leg and the
/// time of a stage of an arm, and `ends` are the ends of both motions, seconds.
fn handover(precedence: &Precedence, of: impl Fn(usize, StageTime) -> (usize, f64), ends: [f64; 2]) -> Rectangle {
    let (giver, taker) = (precedence.giver, 1 - precedence.giver);
    let ((gives, placed), (takes, taken)) = (of(giver, precedence.placed), of(taker, precedence.taken));
    let (mut times, mut legs) = ([[0.0; 2]; 2], [0; 2]);
    times[giver] = [0.0, placed.min(ends[giver] - BORDER)];
    times[taker] = [taken.max(BORDER), ends[taker]];
    (legs[giver], legs[taker]) = (gives, takes);
    Rectangle { times, legs, is_collision: true }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::{Convex, Point, Vector};
    use cplan_judge::certify;
    use cplan_model::space::Path;
    use cplan_model::{Arm, Joint, Link, Scene, Workspace};

    const RADIUS: f64 = 0.1;

    /// Returns a disc that slides in the plane.
    fn sliding_disc() -> Scene {
        let joints = [Joint::sliding("x", Vector::x(), -3.0, 3.0), Joint::sliding("y", Vector::y(), -3.0, 3.0)];
        let disc = Convex::disc(Point::zeros(), RADIUS).unwrap();
        let arm = Arm::new(joints, [Link::of("x", []), Link::of("y", [disc])], [0.0, 0.0]);
        Scene::new(arm, Workspace::new([])).unwrap()
    }

    fn path(scene: &Scene, corners: &[[f64; 2]]) -> CertifiedPath {
        certify(scene, Path::new(corners.iter().map(|corner| (*corner).into()).collect())).unwrap()
    }

    fn along(paths: [&[[f64; 2]]; 2], skew: f64) -> Result<Coordination, Conflict> {
        let scene = sliding_disc();
        let pairs = StagePairs::single(Between::new([&scene, &scene], false, 0.0));
        let coordinator = Coordinator { pairs: &pairs, drive: Drive::default(), skew };
        let paths = paths.map(|corners| path(&scene, corners));
        let found = coordinator.along(paths.each_ref(), f64::INFINITY).unwrap();
        found.map(|found| coordinator.with_diagram(found))
    }

    /// Returns the least distance of the discs on clocks that differ by up to `skew`.
    fn least_distance(found: &Coordination, skew: f64) -> f64 {
        let times = (0..=4000).map(|k| found.duration * f64::from(k) / 4000.0);
        let pairs = times.flat_map(|time| [-skew, 0.0, skew].map(|shift| [time, time + shift]));
        let distance = |times: [f64; 2]| (found.place(0, times[0]) - found.place(1, times[1])).norm() - 2.0 * RADIUS;
        pairs.map(distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn an_arm_makes_room_and_waits_on_its_path() {
        // The second disc passes the start and the goal of the first.
        let first: &[[f64; 2]] = &[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]];
        let second: &[[f64; 2]] = &[[-1.0, 0.0], [2.0, 0.0]];
        for skew in [0.0, 0.05] {
            let found = along([first, second], skew).unwrap();
            let wait = found.waits[0].iter().find(|wait| wait.from > 0.0).expect("a wait on the path");
            assert!(wait.at[1] > 0.2, "{wait:?}");
            let least = least_distance(&found, skew);
            assert!(0.0 < found.clearance && found.clearance <= least + 1e-9, "{} {least}", found.clearance);
            assert!(found.clearance > 0.5 * least, "{} {least}", found.clearance);
        }
    }

    #[test]
    fn discs_that_change_places_on_one_line_are_a_deadlock() {
        let [one, two]: [&[[f64; 2]]; 2] = [&[[0.0, 0.0], [1.0, 0.0]], &[[1.0, 0.0], [0.0, 0.0]]];
        assert_eq!(along([one, two], 0.0).unwrap_err(), Conflict::Deadlock);
        // Beside each other, they pass at once.
        let two: &[[f64; 2]] = &[[1.0, 0.3], [0.0, 0.3]];
        let found = along([one, two], 0.5).unwrap();
        assert!(found.waits.iter().all(Vec::is_empty), "{:?}", found.waits);
        assert_eq!(found.interlocks, Some(vec![]));
    }
}
