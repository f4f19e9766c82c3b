//! Coordinates two paths: finds the waits with which both arms follow their paths earliest.

use crate::between::Between;
use crate::curve::Curve;
use crate::diagram::{Rectangle, rectangles};
use crate::interlock::{Interlock, interlocks};
use crate::judged::{Judgement, NearestPlace, judge};
use crate::order::{Diagram, Waits};
use cplan_judge::CertifiedPath;
use cplan_model::space::{Configuration, Path};
use cplan_motion::{CertifiedCurve, Drive, TimedMotion, TimingError, Trajectory, Wait};

/// Motion of the links in a rectangle of the diagram that is not examined further, as a share of the reach of the arms.
const RESOLUTION: f64 = 1.0 / 250.0;

/// Distance between the arms beyond their clearance, as a share of the resolution. Without it, an arm may wait so near to the
/// other one that no proof succeeds.
const MARGIN_SHARE: f64 = 0.5;

/// Greatest number by which the resolution of the final diagram is divided, until signals are found.
const FINEST_DIAGRAM: f64 = 32.0;

/// Greatest number of inner places of a path at which an arm may wait.
const MAX_STOPS: usize = 4;

/// Share of the duration of the longer motion that waits may cost without a second attempt.
const ACCEPTED_LOSS: f64 = 0.005;

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

/// The legs of one arm: certified paths with their motions.
struct Legs(Vec<TimedMotion>);

impl Legs {
    fn curve(&self) -> Curve {
        Curve::of_legs(self.0.iter().map(|leg| &leg.trajectory))
    }

    /// Returns the times at which legs begin, and the end of the last.
    fn times(&self) -> Vec<f64> {
        let mut times = vec![0.0];
        for leg in &self.0 {
            times.push(times[times.len() - 1] + leg.trajectory.duration());
        }
        times
    }

    /// Returns the whole motion with these departures, and its waits.
    fn departing(&self, departures: &[f64], start: Trajectory) -> (TimedMotion, Vec<Wait>) {
        let (mut trajectory, mut waits) = (start, Vec::new());
        let mut curve: Option<CertifiedCurve> = None;
        for (leg, departs) in self.0.iter().zip(departures) {
            let from = trajectory.duration();
            let at = *trajectory.position.last().expect("a start");
            trajectory.then((departs - from).max(0.0), &leg.trajectory);
            let to = trajectory.duration() - leg.trajectory.duration();
            if to > from && leg.trajectory.duration() > 0.0 {
                waits.push(Wait { from, to, at });
            }
            curve = Some(match curve {
                Some(curve) => curve.then(&leg.curve),
                None => leg.curve.clone(),
            });
        }
        let curve = curve.expect("at least one leg");
        (TimedMotion { curve, trajectory }, waits)
    }
}

/// Coordinates pairs of paths.
#[derive(Clone, Copy)]
pub(crate) struct Coordinator<'a> {
    pub between: &'a Between<'a>,
    pub drive: Drive,
    /// Seconds by which the clock of one arm may be ahead of the other's.
    pub skew: f64,
}

impl Coordinator<'_> {
    /// Returns the motion of the links, metres, up to which a rectangle of the diagram is divided.
    pub fn resolution(&self) -> f64 {
        RESOLUTION * self.between.scenes.map(|scene| scene.arm().reach()).into_iter().fold(0.0, f64::max)
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
        let found = self.along_with(paths, before, MARGIN_SHARE * self.resolution())?;
        match found {
            Err(Conflict::NoTiming | Conflict::NotCertified) => self.along_with(paths, before, 0.0),
            _ => Ok(found),
        }
    }

    /// Does the same with a distance of `margin` metres beyond the clearance.
    fn along_with(
        &self,
        paths: [&CertifiedPath; 2],
        before: f64,
        margin: f64,
    ) -> Result<Result<Coordination, Conflict>, TimingError> {
        let whole = [
            Legs(vec![self.drive.along(self.between.scenes[0], paths[0], 1.0)?]),
            Legs(vec![self.drive.along(self.between.scenes[1], paths[1], 1.0)?]),
        ];
        let longest = whole.each_ref().map(|legs| legs.0[0].trajectory.duration()).into_iter().fold(0.0, f64::max);
        if longest >= before {
            return Ok(Err(Conflict::Slower));
        }
        let diagram = self.diagram(&whole, margin);
        let direct =
            diagram.route(Waits::BetweenLegs, self.skew).and_then(|route| diagram.departures(&route, self.skew));
        let duration = |legs: &[Legs; 2], departures: &[Vec<f64>; 2]| {
            let ends = [0, 1].map(|arm| {
                let lasts = legs[arm].0.last().map_or(0.0, |leg| leg.trajectory.duration());
                departures[arm].last().copied().unwrap_or(0.0) + lasts
            });
            ends[0].max(ends[1])
        };
        let mut best = direct.map(|departures| (duration(&whole, &departures), whole, departures));
        if best.as_ref().is_none_or(|(duration, ..)| *duration > longest * (1.0 + ACCEPTED_LOSS)) {
            if best.is_none() && diagram.is_deadlock() {
                return Ok(Err(Conflict::Deadlock));
            }
            if let Some(legs) = self.with_stops(paths, &diagram)? {
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
        let rectangles = rectangles(self.between, curves.each_ref(), margin, self.resolution());
        Diagram { legs: legs.each_ref().map(Legs::times), rectangles }
    }

    /// Divides the paths where the fastest route through the diagram waits. Returns `None` without a route, or without waits on
    /// the paths.
    fn with_stops(&self, paths: [&CertifiedPath; 2], diagram: &Diagram) -> Result<Option<[Legs; 2]>, TimingError> {
        let cost = self.between.scenes.map(|scene| {
            let braking = scene.arm().joints.each_ref().map(|joint| joint.velocity / joint.acceleration);
            braking[0].max(braking[1])
        });
        let Some(route) = diagram.route(Waits::Anywhere { cost }, self.skew) else { return Ok(None) };
        let waits = route.waits();
        if waits.iter().all(Vec::is_empty) {
            return Ok(None);
        }
        let mut divided = Vec::new();
        for (arm, waits) in waits.iter().enumerate() {
            let (scene, path) = (self.between.scenes[arm], paths[arm]);
            let motion = self.drive.along(scene, path, 1.0)?;
            let curve = Curve::of_legs([&motion.trajectory]);
            let mut ends: Vec<f64> = Vec::new();
            let mut last = f64::NEG_INFINITY;
            for time in waits {
                if time - last > cost[arm] && ends.len() < MAX_STOPS {
                    ends.push(distance_near(path.path(), curve.at(*time)));
                    last = *time;
                }
            }
            let length = path.path().length();
            ends.sort_by(f64::total_cmp);
            ends.retain(|end| *end > 0.0 && *end < length);
            ends.dedup();
            // The last leg ends exactly at the goal.
            ends.push(f64::INFINITY);
            let (mut legs, mut from) = (Vec::new(), 0.0);
            for to in ends {
                legs.push(self.drive.along(scene, &path.part(from, to), 1.0)?);
                from = to;
            }
            divided.push(Legs(legs));
        }
        Ok(<[Legs; 2]>::try_from(divided).ok())
    }

    /// Judges the motions with these departures.
    fn certified(&self, legs: &[Legs; 2], departures: &[Vec<f64>; 2]) -> Result<Coordination, Conflict> {
        let made = [0, 1].map(|arm| {
            let scene = self.between.scenes[arm];
            let start = legs[arm].0[0].curve.straight().path().start();
            legs[arm].departing(&departures[arm], Trajectory::at_rest(scene, start))
        });
        let [(one, waits_one), (two, waits_two)] = made;
        self.judged([one, two], [waits_one, waits_two])
    }

    /// Judges motions that are certified among the obstacles.
    pub fn judged(&self, [one, two]: [TimedMotion; 2], waits: [Vec<Wait>; 2]) -> Result<Coordination, Conflict> {
        let trajectories = [&one.trajectory, &two.trajectory];
        let Judgement::Apart { clearance, nearest } =
            judge(self.between, trajectories.map(|motion| Curve::of_legs([motion])), self.skew)
        else {
            return Err(Conflict::NotCertified);
        };
        let duration = trajectories.map(Trajectory::duration).into_iter().fold(0.0, f64::max);
        let motions = [one, two];
        Ok(Coordination { motions, waits, duration, clearance, nearest, interlocks: None, diagram: vec![] })
    }

    /// Adds the diagram and the signals.
    pub fn with_diagram(&self, found: Coordination) -> Coordination {
        let curves = found.motions.each_ref().map(|motion| Curve::of_legs([&motion.trajectory]));
        let is_beside = |rectangle: &Rectangle| {
            let [one, two] = rectangle.times;
            one[1] <= two[0] || two[1] <= one[0]
        };
        let mut resolution = self.resolution();
        loop {
            let rectangles = rectangles(self.between, curves.each_ref(), 0.0, resolution);
            let interlocks = rectangles.iter().all(is_beside).then(|| interlocks(&rectangles));
            resolution /= 2.0;
            if interlocks.is_some() || resolution < self.resolution() / FINEST_DIAGRAM {
                let diagram = rectangles.iter().map(|rectangle| rectangle.times).collect();
                return Coordination { interlocks, diagram, ..found };
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::{Convex, Point, Vector};
    use cplan_judge::certify;
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
        let between = Between::new([&scene, &scene], false, 0.0);
        let coordinator = Coordinator { between: &between, drive: Drive::default(), skew };
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
