//! When to go along a certified path, and where to wait.

use super::blocked::Movers;
use super::departures::{blocked_departures, first_departure};
use cplan_core::check::{CertifiedPath, Posture};
use cplan_core::space::{Metric, Path};
use cplan_geometry::{Interval, Ordered};
use cplan_interrupt::checkpoint;
use cplan_motion::CertifiedCurve;
use cplan_motion::{Drive, Limits, Timed, TimingError, Trajectory, least_duration};
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Places on a path at which it is looked when they are safe.
const LOOKS: usize = 64;

/// How hard it is looked for a motion along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Places at which the arm may wait, beside the ends: each pair of them is a motion to be timed.
    most_stops: usize,
    /// Whether they are spread over the path where there is nothing better.
    spread: bool,
    /// Whether the arm may go back along the path, too.
    backward: bool,
}

impl Effort {
    /// Enough for most, in milliseconds.
    pub const QUICK: Self = Self { most_stops: 6, spread: false, backward: false };
    /// For what is tight.
    pub const THOROUGH: Self = Self { most_stops: 12, spread: true, backward: true };
}

/// What is asked of a motion beside its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Share of the joints' top speeds that it takes.
    pub speed: f64,
    /// The times at which it may arrive, seconds since it may begin: what becomes of the arm then is no question of it. If none is given it is to
    /// arrive where it can stay for ever, as far as that is possible.
    pub arrival: Option<Interval>,
    /// Until when the arm stands at the goal, where that is asked for, if it is early.
    pub until: Option<f64>,
}

impl Demand {
    /// A motion by itself.
    pub const ALONE: Self = Self { speed: 1.0, arrival: None, until: None };
}

/// A time at which the arm stands still on its way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Wait {
    /// Seconds since the start.
    pub from: f64,
    /// Likewise.
    pub to: f64,
    /// Where that is.
    pub at: [f64; 2],
}

/// A motion that goes along a path when it may.
#[derive(Debug, Clone)]
pub struct Scheduled {
    /// What is followed, with corners where the arm waits, and the whole motion.
    pub timed: Timed,
    /// Where it waits.
    pub waits: Vec<Wait>,
    /// Until when nothing that moves comes too near to the goal; infinite if nothing ever does.
    pub free_until: f64,
}

impl Scheduled {
    /// Seconds, waits included.
    pub fn duration(&self) -> f64 {
        self.timed.trajectory.duration()
    }

    /// Whether the arm may stay where it ends.
    pub fn is_for_good(&self) -> bool {
        self.free_until == f64::INFINITY
    }

    /// Whether this one is to be had rather than another: one after which the arm can stay, then the sooner one.
    pub fn is_better_than(&self, other: &Self) -> bool {
        let rank = |it: &Self| (!it.is_for_good(), it.duration());
        rank(self) < rank(other)
    }
}

/// Departures along a path that some stops divide.
struct Stops<'a> {
    movers: &'a Movers<'a>,
    path: &'a CertifiedPath,
    drive: &'a Drive,
    effort: Effort,
    demand: &'a Demand,
    /// Distances along the path, ascending; the first and the last are its ends.
    at: Vec<f64>,
    /// Seconds up to there at the joints' top speeds.
    gone: Vec<f64>,
    /// When the arm may stand there.
    safe: Vec<Vec<Interval>>,
    /// Motions from one stop to another.
    legs: BTreeMap<(usize, usize), Timed>,
}

/// A stop and one of its safe intervals, by number.
type SafeStop = (usize, usize);

/// When the arm arrives at a stop; from which other, and when that was left.
#[derive(Debug, Clone, Copy)]
struct Arrival {
    time: f64,
    from: Option<(SafeStop, f64)>,
}

/// A way from the first stop to the last.
struct Way {
    /// The stops, and when each is left; the last, when it is reached.
    stops: Vec<(usize, f64)>,
    /// Until when the arm may stay at the last.
    free_until: f64,
}

/// The earliest known arrivals, and those from which the search goes on.
struct Reached {
    known: BTreeMap<SafeStop, Arrival>,
    open: BinaryHeap<Reverse<(Ordered, usize, usize)>>,
    /// What does not reach the goal for good sooner than this is of no use.
    soonest_for_good: f64,
}

impl Reached {
    fn from_the_start(soonest_for_good: f64) -> Self {
        let mut reached = Self { known: BTreeMap::new(), open: BinaryHeap::new(), soonest_for_good };
        reached.arrive((0, 0), Arrival { time: 0.0, from: None }, false);
        reached
    }

    /// Takes the earliest arrival from which the search has not gone on yet.
    fn next(&mut self) -> Option<(SafeStop, f64)> {
        loop {
            let Reverse((Ordered(time), stop, interval)) = self.open.pop()?;
            // A later one than this may be left from before.
            if self.known[&(stop, interval)].time >= time {
                return Some(((stop, interval), time));
            }
        }
    }

    /// Whether nothing as early is known.
    fn is_improved_by(&self, at: SafeStop, time: f64) -> bool {
        self.known.get(&at).is_none_or(|known| known.time > time)
    }

    /// Keeps an arrival that is earlier than what is known.
    fn arrive(&mut self, at: SafeStop, arrival: Arrival, is_for_good: bool) {
        if !self.is_improved_by(at, arrival.time) {
            return;
        }
        if is_for_good {
            self.soonest_for_good = self.soonest_for_good.min(arrival.time);
        }
        self.known.insert(at, arrival);
        self.open.push(Reverse((Ordered(arrival.time), at.0, at.1)));
    }

    /// The stops up to an arrival, and when each is left; the last, when it is reached.
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

/// The earliest motion along a path, from rest to rest between some places on it at which it may wait; none if there is none, or none that ends for
/// good before a time. `whole` is the motion without a wait.
///
/// Safe intervals (Phillips, Likhachev 2011): who is at a stop at all within an interval in which it is safe had best be there as early as possible.
/// It arrives where it can stay for ever, if that is possible.
///
/// # Errors
/// Parts of the path that cannot be timed.
pub fn schedule(
    movers: &Movers,
    path: &CertifiedPath,
    whole: &Timed,
    drive: &Drive,
    demand: &Demand,
    effort: Effort,
    before: f64,
) -> Result<Option<Scheduled>, TimingError> {
    let at = places(movers, path.path(), effort);
    let safe_at = |&distance: &f64| movers.safe_intervals(&posture_at(movers, path.path(), distance));
    let mut safe: Vec<Vec<Interval>> = at.iter().map(safe_at).collect();
    if let (Some([begins, ends]), Some(goal)) = (demand.arrival, safe.last_mut().filter(|_| at.len() > 1)) {
        goal.iter_mut().for_each(|safe| *safe = [safe[0].max(begins), safe[1].min(ends)]);
        goal.retain(|[begins, ends]| begins <= ends);
    }
    let legs = BTreeMap::from([((0, at.len() - 1), whole.clone())]);
    let speeds = movers.scene().arm().joints.each_ref().map(|joint| joint.velocity);
    let metric = Metric::Time { speeds };
    let gone = at.iter().map(|&distance| metric.length(&path.path().part(0.0, distance))).collect();
    let mut stops = Stops { movers, path, drive, effort, demand, at, gone, safe, legs };
    let Some(Way { stops: way, free_until }) = stops.search(before)? else { return Ok(None) };
    let (timed, waits) = stops.driven(&way)?;
    Ok(Some(Scheduled { timed, waits, free_until }))
}

impl Stops<'_> {
    /// The motion from one stop to another.
    fn leg(&mut self, from: usize, to: usize) -> Result<&Timed, TimingError> {
        if !self.legs.contains_key(&(from, to)) {
            checkpoint();
            let part = self.path.part(self.at[from], self.at[to]);
            let timed = self.drive.along(self.movers.scene(), &part, self.demand.speed)?;
            self.legs.insert((from, to), timed);
        }
        Ok(&self.legs[&(from, to)])
    }

    /// About the least that a motion from rest to rest between two stops takes: blends cut corners.
    fn least(&self, from: usize, to: usize) -> f64 {
        let limits = Limits::from(&self.movers.scene().arm().joints);
        least_duration((self.gone[to] - self.gone[from]).abs(), &limits)
    }

    /// Finds the earliest way to the last stop, of those that do not end for good after `before`.
    fn search(&mut self, before: f64) -> Result<Option<Way>, TimingError> {
        // At the start the interval that holds time 0 is the first.
        if self.safe[0].first().is_none_or(|first| first[0] > 0.0) {
            return Ok(None);
        }
        let last = self.at.len() - 1;
        let mut reached = Reached::from_the_start(before);
        let mut fallback = None;
        while let Some((at, time)) = reached.next() {
            let (stop, interval) = at;
            if stop == last {
                let free_until = self.stays(interval, time);
                if free_until == f64::INFINITY {
                    return Ok(Some(Way { stops: reached.stops_to(at), free_until }));
                }
                if self.demand.arrival.is_none() && fallback.is_none() {
                    fallback = Some(Way { stops: reached.stops_to(at), free_until });
                }
                continue;
            }
            let backward = self.effort.backward;
            // The goal first: what is known to be reached sooner needs no other way.
            for next in (0..=last).rev().filter(|&next| next != stop && (backward || next > stop)) {
                self.depart(&mut reached, at, time, next)?;
            }
        }
        Ok(fallback)
    }

    /// Departs for another stop, for each of its safe intervals as early as that is possible.
    fn depart(
        &mut self,
        reached: &mut Reached,
        (stop, interval): SafeStop,
        time: f64,
        next: usize,
    ) -> Result<(), TimingError> {
        let last = self.at.len() - 1;
        let (soonest, onwards) = (time + self.least(stop, next), self.least(next, last));
        let is_target = |&k: &usize| {
            let [begins, ends] = self.safe[next][k];
            let is_of_use = next == last || soonest.max(begins) + onwards < reached.soonest_for_good;
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
            let by = leaves_by.min(ends - lasts).min(reached.soonest_for_good - onwards - lasts);
            (target, [time.max(begins - lasts), by])
        };
        let windows: Vec<(usize, Interval)> =
            targets.into_iter().map(window).filter(|(_, [from, to])| from <= to).collect();
        let (Some((_, [first, _])), Some((_, [_, end]))) = (windows.first(), windows.last()) else { return Ok(()) };
        let blocked = blocked_departures(self.movers, &pieces, [*first, *end]);
        for (target, [from, to]) in windows {
            let Some(departs) = first_departure(&blocked, from, to) else { continue };
            let is_endless = self.safe[next][target][1] == f64::INFINITY;
            let is_for_good = next == last && (is_endless || self.demand.arrival.is_some());
            let arrival = Arrival { time: departs + lasts, from: Some(((stop, interval), departs)) };
            reached.arrive((next, target), arrival, is_for_good);
        }
        Ok(())
    }

    /// Until when the arm may stay at the goal that it reaches at a time; for ever, as far as anybody asks, where it is to arrive in time.
    fn stays(&self, interval: usize, time: f64) -> f64 {
        let last = self.at.len() - 1;
        let until = self.safe[last][interval][1];
        match self.demand.arrival {
            None => until,
            // On a way of no length nothing arrives: the arm stands where it is until then.
            Some([begins, _]) if last == 0 && self.demand.until.unwrap_or(begins).max(time) > until => until,
            Some(_) => f64::INFINITY,
        }
    }

    /// The motion along a way.
    fn driven(&mut self, way: &[(usize, f64)]) -> Result<(Timed, Vec<Wait>), TimingError> {
        let start = self.path.part(0.0, 0.0);
        let mut trajectory = Trajectory::default();
        let mut curve: Option<CertifiedCurve> = None;
        let (mut waits, mut arrived) = (Vec::new(), 0.0);
        for legs in way.windows(2) {
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
            trajectory.stand_until(self.demand.until.unwrap_or(begins));
            let (to, goal) = (trajectory.duration(), self.path.path().goal());
            waits.extend((to > arrived).then(|| Wait { from: arrived, to, at: goal.into() }));
        }
        Ok((Timed { curve, trajectory }, waits))
    }
}

/// The arm at a distance along a path.
fn posture_at<'a>(movers: &Movers<'a>, path: &Path, distance: f64) -> Posture<'a> {
    Posture::new(movers.scene(), path.part(distance, distance).start())
}

/// Where the arm may wait: the ends of the path; the ends of its parts that nothing ever comes near to; and, with more effort, some places more.
fn places(movers: &Movers, path: &Path, effort: Effort) -> Vec<f64> {
    let length = path.length();
    if length == 0.0 {
        return vec![0.0];
    }
    let looks: Vec<f64> = (0..=LOOKS).map(|k| length * k as f64 / LOOKS as f64).collect();
    let is_calm = |&distance: &f64| movers.is_calm(&posture_at(movers, path, distance));
    let calm: Vec<bool> = looks.iter().map(is_calm).collect();
    let is_end = |&k: &usize| calm[k] && (!calm[k - 1] || !calm[k + 1]);
    let mut stops: Vec<usize> = (1..LOOKS).filter(is_end).take(effort.most_stops).collect();
    let left = if effort.spread { effort.most_stops - stops.len() } else { 0 };
    stops.extend((1..=left).map(|k| k * LOOKS / (left + 1)).filter(|k| (1..LOOKS).contains(k)));
    stops.extend([0, LOOKS]);
    stops.sort_unstable();
    stops.dedup();
    stops.into_iter().map(|k| looks[k]).collect()
}
