//! Departures and waits of a motion along a certified path.

use super::blocked::MovingObstacles;
use super::departures::{blocked_departures, first_departure};
use cplan_geometry::{Interval, OrderedF64};
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, Posture};
use cplan_model::space::{Metric, Path};
use cplan_motion::{CertifiedCurve, Drive, Limits, TimedMotion, TimingError, Trajectory, Wait, least_duration};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Number of configurations along a path at which safe times are computed.
const PLACES_PER_PATH: usize = 64;

/// Limits of the search for the timing of a motion along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Largest number of places where the arm may wait, in addition to the ends. Each pair of places may need a motion.
    most_stops: usize,
    /// True to add evenly spread places up to that number.
    spread: bool,
    /// True if the arm may also move back along the path.
    backward: bool,
}

impl Effort {
    /// Limits that suffice for most motions. The search takes milliseconds.
    pub const QUICK: Self = Self { most_stops: 6, spread: false, backward: false };
    /// Limits with which the search also finds motions through short gaps in time.
    pub const THOROUGH: Self = Self { most_stops: 12, spread: true, backward: true };
}

/// Requirements on the timing of a motion along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimingRequirements {
    /// Fraction of the joints' top speeds at which the arm moves.
    pub speed: f64,
    /// Interval in which the motion must arrive, in seconds since the earliest departure. Events after the arrival are
    /// ignored. If `None`, the arm should be able to stay at the goal for ever.
    pub arrival: Option<Interval>,
    /// Time until which the arm must be able to wait at the goal after an earlier arrival. `None` if it need not wait.
    pub until: Option<f64>,
}

impl TimingRequirements {
    /// Requirements for a query with a single motion.
    pub const UNCONSTRAINED: Self = Self { speed: 1.0, arrival: None, until: None };
}

/// A motion along a path, with waits.
#[derive(Debug, Clone)]
pub struct ScheduledMotion {
    /// The whole motion, and its curve with a corner at each place where the arm waits.
    pub timed: TimedMotion,
    /// Waits in order.
    pub waits: Vec<Wait>,
    /// Time until which no moving obstacle comes too near to the arm at the goal, in seconds. Infinite if none ever
    /// does.
    pub free_until: f64,
}

impl ScheduledMotion {
    /// Returns the duration in seconds, waits included.
    pub fn duration(&self) -> f64 {
        self.timed.trajectory.duration()
    }

    /// Returns true if the arm may stay at the end of the motion for ever.
    pub fn may_stay_forever(&self) -> bool {
        self.free_until == f64::INFINITY
    }

    /// Returns true if this motion is better than another. A motion after which the arm can stay is better than one
    /// after which it cannot. Otherwise, the earlier motion is better.
    pub fn is_better_than(&self, other: &Self) -> bool {
        let rank = |it: &Self| (!it.may_stay_forever(), it.duration());
        rank(self) < rank(other)
    }
}

/// The stops along a path, and the motions between them.
struct Stops<'a> {
    movers: &'a MovingObstacles<'a>,
    path: &'a CertifiedPath,
    drive: &'a Drive,
    effort: Effort,
    demand: &'a TimingRequirements,
    /// Distance of each stop from the beginning of the path, in ascending order. The first and the last stop are its
    /// ends.
    at: Vec<f64>,
    /// Time from the first stop to each stop at the joints' top speeds, in seconds.
    gone: Vec<f64>,
    /// For each stop, the intervals of time in which the arm may stay there.
    safe: Vec<Vec<Interval>>,
    /// Motions from one stop to another, by the indices of both.
    legs: BTreeMap<(usize, usize), TimedMotion>,
}

/// The index of a stop, and the index of one of its safe intervals.
type SafeStop = (usize, usize);

/// An arrival at a stop: its time, the previous stop, and the departure from that.
#[derive(Debug, Clone, Copy)]
struct Arrival {
    time: f64,
    from: Option<(SafeStop, f64)>,
}

/// A sequence of stops from the first to the last.
struct StopSequence {
    /// The index of each stop, with the time of departure from it. The last stop has the time of arrival.
    stops: Vec<(usize, f64)>,
    /// Time until which the arm may stay at the last stop.
    free_until: f64,
}

/// The earliest known arrivals, and the queue of those that the search must still extend.
struct EarliestArrivals {
    known: BTreeMap<SafeStop, Arrival>,
    open: BinaryHeap<Reverse<(OrderedF64, usize, usize)>>,
    /// Earliest known arrival at the goal after which the arm can stay for ever. Later arrivals need no search.
    earliest_permanent_arrival: f64,
}

impl EarliestArrivals {
    fn from_the_start(earliest_permanent_arrival: f64) -> Self {
        let mut reached = Self { known: BTreeMap::new(), open: BinaryHeap::new(), earliest_permanent_arrival };
        reached.record_arrival((0, 0), Arrival { time: 0.0, from: None }, false);
        reached
    }

    /// Removes and returns the earliest arrival in the queue.
    fn next(&mut self) -> Option<(SafeStop, f64)> {
        loop {
            let Reverse((OrderedF64(time), stop, interval)) = self.open.pop()?;
            // The queue may still contain an arrival for which an earlier one has been found since.
            if self.known[&(stop, interval)].time >= time {
                return Some(((stop, interval), time));
            }
        }
    }

    /// Returns true if no arrival at this stop and interval is known, or if `time` is earlier than the known one.
    fn is_improved_by(&self, at: SafeStop, time: f64) -> bool {
        self.known.get(&at).is_none_or(|known| known.time > time)
    }

    /// Stores an arrival if it is earlier than the known one.
    fn record_arrival(&mut self, at: SafeStop, arrival: Arrival, may_stay_forever: bool) {
        if !self.is_improved_by(at, arrival.time) {
            return;
        }
        if may_stay_forever {
            self.earliest_permanent_arrival = self.earliest_permanent_arrival.min(arrival.time);
        }
        self.known.insert(at, arrival);
        self.open.push(Reverse((OrderedF64(arrival.time), at.0, at.1)));
    }

    /// Returns the stops up to an arrival. Each has its departure time, and the last one its arrival time.
    fn stops_to(&self, end: SafeStop) -> Vec<(usize, f64)> {
        let mut stops = vec![(end.0, self.known[&end].time)];
        let mut at = end;
        while let Some((from, departs)) = self.known[&at].from {
            stops.push((from.0, departs));
            at = from;
        }
        stops.reverse();
        stops
    }
}

/// Computes the earliest motion along a path. The motion goes from rest to rest between places where the arm may wait.
/// If possible, it ends where the arm can stay for ever. Returns `None` if no such motion arrives by the time `before`.
/// `whole` is the motion without a wait.
///
/// The search is over safe intervals (Phillips, Likhachev 2011): within one safe interval of a stop, the earliest
/// arrival is always the best.
///
/// # Errors
/// A part of the path that cannot be timed.
pub fn schedule(
    movers: &MovingObstacles,
    path: &CertifiedPath,
    whole: &TimedMotion,
    drive: &Drive,
    demand: &TimingRequirements,
    effort: Effort,
    before: f64,
) -> Result<Option<ScheduledMotion>, TimingError> {
    let at = places(movers, path.path(), effort);
    let safe_at = |&distance: &f64| movers.safe_intervals(&posture_at(movers, path.path(), distance));
    let mut safe: Vec<Vec<Interval>> = at.iter().map(safe_at).collect();
    if let (Some([begins, ends]), Some(goal)) = (demand.arrival, safe.last_mut().filter(|_| at.len() > 1)) {
        goal.iter_mut().for_each(|safe| *safe = [safe[0].max(begins), safe[1].min(ends)]);
        goal.retain(|[begins, ends]| begins <= ends);
    }
    let legs = BTreeMap::from([((0, at.len() - 1), whole.clone())]);
    let speeds = movers.scene().arm().joints.each_ref().map(|joint| joint.velocity);
    let metric = Metric::Time { speeds, sum: None };
    let gone = at.iter().map(|&distance| metric.length(&path.path().part(0.0, distance))).collect();
    let mut stops = Stops { movers, path, drive, effort, demand, at, gone, safe, legs };
    let Some(StopSequence { stops: sequence, free_until }) = stops.search(before)? else { return Ok(None) };
    let (timed, waits) = stops.driven(&sequence)?;
    Ok(Some(ScheduledMotion { timed, waits, free_until }))
}

impl Stops<'_> {
    /// Returns the motion from one stop to another.
    fn leg(&mut self, from: usize, to: usize) -> Result<&TimedMotion, TimingError> {
        if !self.legs.contains_key(&(from, to)) {
            checkpoint();
            let part = self.path.part(self.at[from], self.at[to]);
            let timed = self.drive.along(self.movers.scene(), &part, self.demand.speed)?;
            self.legs.insert((from, to), timed);
        }
        Ok(&self.legs[&(from, to)])
    }

    /// Estimates the least duration of a motion from rest to rest between two stops, in seconds. It is not a bound,
    /// because rounded corners shorten the path.
    fn estimated_duration(&self, from: usize, to: usize) -> f64 {
        let limits = Limits::from(&self.movers.scene().arm().joints);
        least_duration((self.gone[to] - self.gone[from]).abs(), &limits)
    }

    /// Finds the sequence of stops that reaches the last one earliest. Sequences that arrive after `before` are not found.
    fn search(&mut self, before: f64) -> Result<Option<StopSequence>, TimingError> {
        // Only the first interval at the start can contain time 0.
        if self.safe[0].first().is_none_or(|first| first[0] > 0.0) {
            return Ok(None);
        }
        let last = self.at.len() - 1;
        let mut reached = EarliestArrivals::from_the_start(before);
        let mut fallback = None;
        while let Some((at, time)) = reached.next() {
            let (stop, interval) = at;
            if stop == last {
                let free_until = self.stay_until(interval, time);
                if free_until == f64::INFINITY {
                    return Ok(Some(StopSequence { stops: reached.stops_to(at), free_until }));
                }
                if self.demand.arrival.is_none() && fallback.is_none() {
                    fallback = Some(StopSequence { stops: reached.stops_to(at), free_until });
                }
                continue;
            }
            let backward = self.effort.backward;
            // Try the goal first: an early arrival there makes other departures useless.
            for next in (0..=last).rev().filter(|&next| next != stop && (backward || next > stop)) {
                self.depart(&mut reached, at, time, next)?;
            }
        }
        Ok(fallback)
    }

    /// Adds the earliest arrival at another stop for each of its safe intervals.
    fn depart(
        &mut self,
        reached: &mut EarliestArrivals,
        (stop, interval): SafeStop,
        time: f64,
        next: usize,
    ) -> Result<(), TimingError> {
        let last = self.at.len() - 1;
        let (soonest, onwards) = (time + self.estimated_duration(stop, next), self.estimated_duration(next, last));
        let is_target = |&k: &usize| {
            let [begins, ends] = self.safe[next][k];
            let is_of_use = next == last || soonest.max(begins) + onwards < reached.earliest_permanent_arrival;
            is_of_use && ends >= soonest && reached.is_improved_by((next, k), soonest)
        };
        let targets: Vec<usize> = (0..self.safe[next].len()).filter(is_target).collect();
        if targets.is_empty() {
            return Ok(());
        }
        let leaves_by = self.safe[stop][interval][1];
        let trajectory = &self.leg(stop, next)?.trajectory;
        let (lasts, pieces) = (trajectory.duration(), trajectory.pieces());
        let window = |target: usize| {
            let [begins, ends] = self.safe[next][target];
            let by = leaves_by.min(ends - lasts).min(reached.earliest_permanent_arrival - onwards - lasts);
            (target, [time.max(begins - lasts), by])
        };
        let windows: Vec<(usize, Interval)> =
            targets.into_iter().map(window).filter(|(_, [from, to])| from <= to).collect();
        let (Some((_, [first, _])), Some((_, [_, end]))) = (windows.first(), windows.last()) else { return Ok(()) };
        let blocked = blocked_departures(self.movers, &pieces, [*first, *end]);
        for (target, [from, to]) in windows {
            let Some(departs) = first_departure(&blocked, from, to) else { continue };
            let is_endless = self.safe[next][target][1] == f64::INFINITY;
            let may_stay_forever = next == last && (is_endless || self.demand.arrival.is_some());
            let arrival = Arrival { time: departs + lasts, from: Some(((stop, interval), departs)) };
            reached.record_arrival((next, target), arrival, may_stay_forever);
        }
        Ok(())
    }

    /// Returns the time until which the arm may stay at the goal after arriving at `time`. Infinite if the requirements
    /// limit the arrival, because events after it are then ignored.
    fn stay_until(&self, interval: usize, time: f64) -> f64 {
        let last = self.at.len() - 1;
        let until = self.safe[last][interval][1];
        match self.demand.arrival {
            None => until,
            // A path of length zero has no arrival, so the arm must be able to stay there until the requested time.
            Some([begins, _]) if last == 0 && self.demand.until.unwrap_or(begins).max(time) > until => until,
            Some(_) => f64::INFINITY,
        }
    }

    /// Returns the motion along a sequence of stops.
    fn driven(&mut self, sequence: &[(usize, f64)]) -> Result<(TimedMotion, Vec<Wait>), TimingError> {
        let start = self.path.part(0.0, 0.0);
        let mut trajectory = Trajectory::default();
        let mut curve: Option<CertifiedCurve> = None;
        let (mut waits, mut arrived) = (Vec::new(), 0.0);
        for legs in sequence.windows(2) {
            let [(from, departs), (to, _)] = [legs[0], legs[1]];
            let pause = departs - arrived;
            if trajectory.time.is_empty() && pause > 0.0 {
                trajectory = self.drive.along(self.movers.scene(), &start, 1.0)?.trajectory;
            }
            let at = self.path.path().part(self.at[from], self.at[from]).start();
            let timed = self.leg(from, to)?;
            trajectory.then(pause, &timed.trajectory);
            let begins = trajectory.duration() - timed.trajectory.duration();
            if pause > 0.0 {
                waits.push(Wait { from: arrived, to: begins, at: at.into() });
            }
            arrived = trajectory.duration();
            curve = Some(match curve {
                Some(curve) => curve.then(&timed.curve),
                None => timed.curve.clone(),
            });
        }
        if trajectory.time.is_empty() {
            trajectory = self.drive.along(self.movers.scene(), &start, 1.0)?.trajectory;
        }
        let curve = curve.unwrap_or_else(|| start.into());
        if let Some([begins, _]) = self.demand.arrival {
            trajectory.append_rest_until(self.demand.until.unwrap_or(begins));
            let (to, goal) = (trajectory.duration(), self.path.path().goal());
            waits.extend((to > arrived).then(|| Wait { from: arrived, to, at: goal.into() }));
        }
        Ok((TimedMotion { curve, trajectory }, waits))
    }
}

/// Returns the posture of the arm at a distance along a path.
fn posture_at<'a>(movers: &MovingObstacles<'a>, path: &Path, distance: f64) -> Posture<'a> {
    Posture::new(movers.scene(), path.part(distance, distance).start())
}

/// Returns the places where the arm may wait: the ends of the path, and the ends of those parts of the path that no
/// moving obstacle ever comes near. A thorough search adds more places.
fn places(movers: &MovingObstacles, path: &Path, effort: Effort) -> Vec<f64> {
    let length = path.length();
    if length == 0.0 {
        return vec![0.0];
    }
    let looks: Vec<f64> = (0..=PLACES_PER_PATH).map(|k| length * k as f64 / PLACES_PER_PATH as f64).collect();
    let is_always_safe = |&distance: &f64| movers.is_always_safe(&posture_at(movers, path, distance));
    let calm: Vec<bool> = looks.iter().map(is_always_safe).collect();
    let is_end = |&k: &usize| calm[k] && (!calm[k - 1] || !calm[k + 1]);
    let mut stops: Vec<usize> = (1..PLACES_PER_PATH).filter(is_end).take(effort.most_stops).collect();
    let left = if effort.spread { effort.most_stops - stops.len() } else { 0 };
    stops.extend((1..=left).map(|k| k * PLACES_PER_PATH / (left + 1)).filter(|k| (1..PLACES_PER_PATH).contains(k)));
    stops.extend([0, PLACES_PER_PATH]);
    stops.sort_unstable();
    stops.dedup();
    stops.into_iter().map(|k| looks[k]).collect()
}
