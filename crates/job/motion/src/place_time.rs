//! The plane with the place on a motion and time as coordinates, in which moving obstacles are forbidden regions. It shows
//! between which obstacles a motion passes, and for which ones it waits.

use super::sample::Trajectory;
use super::waits::Wait;
use cplan_geometry::Interval;
use cplan_handling::TimedScene;
use cplan_model::space::Configuration;

/// Number of places on the whole motion. A row of a small chart is then less than a pixel high.
const PLACES: usize = 120;

/// Shortest wait that results mention, in seconds. Shorter ones are due to rounding.
const MIN_WAIT: f64 = 5e-3;

/// To find the obstacle that a motion would meet without a wait, the motion after the wait begins earlier by these fractions of
/// the wait. The first one means no wait at all, the last one a slightly too early departure.
const EARLIER: [f64; 6] = [1.0, 0.75, 0.5, 0.25, 0.1, 0.02];

/// A part of a motion: the whole motion, or one step of a task.
#[derive(Clone, Copy)]
pub struct MotionPart<'a> {
    /// The scene, with the trajectories of its moving obstacles. Their times count from the beginning of the whole motion.
    pub timed: TimedScene<'a>,
    /// The motion. Its times count from its own beginning.
    pub trajectory: &'a Trajectory,
    /// Time at which the part begins, in seconds since the beginning of the whole motion.
    pub begin: f64,
    /// Name of the object for which the arm waits at the end of this part. `None` if it does not wait.
    pub awaited: Option<&'a str>,
}

/// Computes the intervals of time, in seconds, during which moving obstacles block the arm: for each configuration, a list for
/// each loose obstacle of the scene, ordered and disjoint. Less than the world's clearance counts as blocked.
pub type BlockedTimes<'a> = dyn Fn(TimedScene, &[Configuration]) -> Vec<Vec<Vec<Interval>>> + 'a;

/// A place on a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedPlace {
    /// Progress from the beginning (0) to the end (1), measured by the time that the joints need at top speed.
    pub progress: f64,
    /// Time at which the motion arrives there, in seconds.
    pub time: f64,
    /// Times at which each obstacle of [`PlaceTime::names`] blocks the arm there, in seconds, in order and disjoint.
    pub blocked: Vec<Vec<Interval>>,
}

/// A wait of a motion, with its reason.
#[derive(Debug, Clone, PartialEq)]
pub struct WaitReason {
    /// The wait.
    pub wait: Wait,
    /// Progress of the motion during the wait.
    pub progress: f64,
    /// Name of the obstacle that the motion would meet without the wait, or of the object for which it waits. `None` if neither
    /// is known.
    pub obstacle: Option<String>,
}

impl WaitReason {
    /// Describes the duration and the reason in a few words, such as `1.46 s for cart`.
    pub fn words(&self) -> String {
        let obstacle = self.obstacle.as_ref().map_or_else(String::new, |name| format!(" for {name}"));
        format!("{:.2} s{obstacle}", self.wait.to - self.wait.from)
    }
}

/// Places on a motion, the times at which moving obstacles block them, and the motion itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceTime {
    /// Names of the moving obstacles.
    pub names: Vec<String>,
    /// Places on the motion, in its order.
    pub places: Vec<TimedPlace>,
    /// Time and progress of the motion's samples, in order.
    pub motion: Vec<[f64; 2]>,
    /// Ends of parts: the time, and the name of the object for which the arm waits there.
    ends: Vec<(f64, Option<String>)>,
}

impl PlaceTime {
    /// Computes the plane for the parts of a motion in their order. `None` if no obstacle moves, or if the arm does not.
    pub fn of(parts: &[MotionPart], blocked_times: &BlockedTimes) -> Option<Self> {
        let mut names: Vec<String> = Vec::new();
        for part in parts {
            let loose = part.timed.scene.loose_obstacles().iter().take(part.timed.trajectories.len());
            for name in loose.map(|loose| &loose.obstacle.name) {
                if !names.contains(name) {
                    names.push(name.clone());
                }
            }
        }
        let lengths: Vec<Vec<f64>> = parts.iter().map(distances).collect();
        let whole: f64 = lengths.iter().filter_map(|gone| gone.last()).sum();
        if names.is_empty() || whole <= 0.0 {
            return None;
        }
        let (mut places, mut motion, mut before) = (Vec::new(), Vec::new(), 0.0);
        for (part, gone) in parts.iter().zip(&lengths) {
            let length = gone.last().copied().unwrap_or(0.0);
            let samples = part.trajectory.time.iter().zip(gone);
            motion.extend(samples.map(|(time, gone)| [part.begin + time, (before + gone) / whole]));
            places.extend(places_of(part, gone, [before, whole], &names, blocked_times));
            before += length;
        }
        let ends = parts.iter().map(|part| (part.begin + part.trajectory.duration(), part.awaited.map(str::to_owned)));
        Some(Self { names, places, motion, ends: ends.collect() })
    }

    /// Creates a plane of known places, for tests of pictures.
    pub fn trusted(names: Vec<String>, places: Vec<TimedPlace>, motion: Vec<[f64; 2]>) -> Self {
        Self { names, places, motion, ends: Vec::new() }
    }

    /// Returns the progress of the motion at a time.
    pub fn progress(&self, time: f64) -> f64 {
        let next = self.motion.partition_point(|[at, _]| *at <= time).clamp(1, self.motion.len() - 1);
        let [[from, low], [to, high]] = [self.motion[next - 1], self.motion[next]];
        low + (high - low) * ((time - from) / (to - from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }

    /// Returns the waits that are long enough to mention, with their reasons.
    pub fn reasons(&self, waits: &[Wait]) -> Vec<WaitReason> {
        let long: Vec<Wait> = waits.iter().copied().filter(|wait| wait.to - wait.from >= MIN_WAIT).collect();
        let reason = |wait: &Wait| {
            // The motion after the wait ends at the next wait, or with its part.
            let ends = self.ends.iter().map(|(end, _)| *end).chain(long.iter().map(|next| next.from));
            let until = ends.filter(|end| *end > wait.to).fold(f64::INFINITY, f64::min);
            WaitReason {
                wait: *wait,
                progress: self.progress(f64::midpoint(wait.from, wait.to)),
                obstacle: self.reason(wait, until),
            }
        };
        long.iter().map(reason).collect()
    }

    /// Returns the name of the object that passes at the end of a wait, or of the obstacle that the motion would meet if it
    /// departed earlier.
    fn reason(&self, wait: &Wait, until: f64) -> Option<String> {
        let at_end = self.ends.iter().find(|(end, _)| (end - wait.to).abs() < MIN_WAIT);
        at_end.and_then(|(_, name)| name.clone()).or_else(|| {
            let seconds = wait.to - wait.from;
            let met = EARLIER.iter().find_map(|part| self.first_met([wait.to, until], part * seconds));
            met.map(|index| self.names[index].clone())
        })
    }

    /// Returns the obstacle that the motion between two times meets first if it departs `earlier` by some seconds, including
    /// during a rest at its end.
    fn first_met(&self, [from, until]: Interval, earlier: f64) -> Option<usize> {
        let mut places = self.places.iter().filter(|place| (from..=until).contains(&place.time)).peekable();
        while let Some(place) = places.next() {
            let begin = place.time - earlier;
            let end = if places.peek().is_none() { place.time } else { begin };
            let meets = |times: &Vec<Interval>| times.iter().any(|[from, to]| *from <= end && begin <= *to);
            if let Some(index) = place.blocked.iter().position(meets) {
                return Some(index);
            }
        }
        None
    }
}

/// Returns the progress at each sample of a part: the time that the motion so far would take at the joints' top speeds.
fn distances(part: &MotionPart) -> Vec<f64> {
    let joints = &part.timed.scene.arm().joints;
    let mut gone = 0.0;
    let steps = part.trajectory.position.windows(2).map(|ends| {
        gone += [0, 1].map(|k| (ends[1][k] - ends[0][k]).abs() / joints[k].velocity).into_iter().fold(0.0, f64::max);
        gone
    });
    std::iter::once(0.0).chain(steps.collect::<Vec<_>>()).take(part.trajectory.position.len()).collect()
}

/// Returns places on a part, evenly by progress. `before` is the progress at its beginning, `whole` that of all parts.
fn places_of(
    part: &MotionPart,
    gone: &[f64],
    [before, whole]: [f64; 2],
    names: &[String],
    blocked_times: &BlockedTimes,
) -> Vec<TimedPlace> {
    let length = gone.last().copied().unwrap_or(0.0);
    let count = (PLACES as f64 * length / whole).ceil() as usize;
    let mut configurations = Vec::with_capacity(count);
    let mut places = Vec::with_capacity(count);
    for k in 0..count {
        let at = length * (k as f64 + 0.5) / count as f64;
        let next = gone.partition_point(|gone| *gone < at).clamp(1, gone.len() - 1);
        let share = (at - gone[next - 1]) / (gone[next] - gone[next - 1]).max(f64::MIN_POSITIVE);
        let [a, b] = [next - 1, next].map(|k| Configuration::from(part.trajectory.position[k]));
        let [from, to] = [next - 1, next].map(|k| part.trajectory.time[k]);
        configurations.push(a + (b - a) * share);
        let (progress, time) = ((before + at) / whole, part.begin + from + (to - from) * share);
        places.push(TimedPlace { progress, time, blocked: vec![Vec::new(); names.len()] });
    }
    // A moving obstacle has a number in the scene; `names` may have more entries.
    let loose = part.timed.scene.loose_obstacles().iter();
    let shown: Vec<Option<usize>> =
        loose.map(|loose| names.iter().position(|name| *name == loose.obstacle.name)).collect();
    for (place, blocked) in places.iter_mut().zip(blocked_times(part.timed, &configurations)) {
        for (times, name) in blocked.into_iter().zip(&shown) {
            if let Some(name) = *name {
                place.blocked[name] = times;
            }
        }
    }
    places
}
