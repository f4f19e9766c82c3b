//! The timing of a motion along a path with blends.

use super::bounds::Bounds;
use super::clock::reserve;
use super::corner::Corner;
use super::jerk;
use super::limits::{Axes, Limits};
use super::profile::{Phase, State, passing, rest_to_rest};
use super::sample::{MIN_INTERVAL, MIN_PERIODIC_INTERVAL, Trajectory, sample};
use super::tip::{Part, TIP_SPEED_STEP};
use crate::{Blend, BlendedPath, CurvedLeg};
use cplan_model::space::Configuration;
use std::ops::Range;

/// Greatest number of parts of a straight stretch.
const MAX_LINE_PARTS: f64 = 1024.0;

/// Least duration of a phase on a straight stretch that is passed without a stop, as a fraction of the least time for the
/// stretch. A shorter phase would cost more speed than it gains, because [`reserve`] leaves a share of the limits unused for it.
const MIN_PHASE_SHARE: f64 = 1.0 / 32.0;

/// If a finer division of blends shortens the motion by less than this share, no finer one is tried. A finer division helps if a
/// joint with a low acceleration limit turns back within a blend: near that place, the other joint may accelerate more, which
/// coarse spans do not show.
const MIN_GAIN: f64 = 0.005;

/// Greatest number of blends in a run whose spans are divided more finely than necessary for accuracy. With more blends, this
/// takes long and gains little, because most of them are short.
const MAX_FINER_BLENDS: usize = 256;

/// A stretch of a path, as a function of the distance along it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Track {
    Line(Line),
    Corner(Corner),
}

/// A straight stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    from: Axes,
    to: Axes,
    length: f64,
    direction: Axes,
    /// Greatest speed along the line within the joints' limits.
    speed: f64,
    acceleration: f64,
    /// Greatest jerk along the line; infinite without a limit.
    jerk: f64,
}

impl Line {
    /// Creates a line. If torques are limited, its acceleration may exceed what they allow: see [`Line::safe`].
    fn new([from, to]: [Axes; 2], limits: &Limits) -> Self {
        let offset = to - from;
        // In contrast to the root of the sum of squares, this does not vanish for very short offsets.
        let length = offset[0].hypot(offset[1]);
        let direction = offset / length;
        let (speed, jerk) = (limits.speed_along(direction), limits.jerk_along(direction));
        let acceleration = limits.acceleration_along(direction);
        let line = Self { from, to, length, direction, speed, acceleration, jerk };
        let speed = limits.tip.map_or(speed, |tip| speed.min(tip.speed_within_limit(&line.part())));
        Self { speed, ..line }
    }

    /// Returns the line as a part of a curve, for the limit on the tip.
    fn part(&self) -> Part {
        let middle = self.from + (self.to - self.from) / 2.0;
        let (zero, half) = (Configuration::zeros(), self.length / 2.0);
        Part { middle: middle.xy(), slope: self.direction.xy(), bend: zero, third: zero, half }
    }

    /// Returns the line with a speed and an acceleration that torques allow everywhere on it.
    fn safe(self, limits: &Limits) -> Self {
        let [speed, acceleration] =
            limits.torque.map_or([f64::INFINITY; 2], |torque| torque.safe(self.from.xy(), self.to.xy()));
        Self { speed: self.speed.min(speed), acceleration: self.acceleration.min(acceleration), ..self }
    }

    /// Splits a straight stretch into parts with their own top speeds, as many as the tip's limit requires.
    fn parts([from, to]: [Axes; 2], limits: &Limits) -> Vec<Self> {
        let whole = Self::new([from, to], limits);
        let own = Self::new([from, to], &Limits { tip: None, ..*limits }).speed;
        let Some(tip) = limits.tip.filter(|_| whole.speed < own) else { return vec![whole] };
        // Tolerance of the derivative of the tip's path where it exceeds speed / own; elsewhere, it does not matter.
        let off = TIP_SPEED_STEP * tip.speed / own;
        let count = (tip.slack(&whole.part()) / off).ceil().clamp(1.0, MAX_LINE_PARTS);
        let end = |i: f64| if i == count { to } else { from + (to - from) * (i / count) };
        (0..count as u32).map(f64::from).map(|i| Self::new([end(i), end(i + 1.0)], limits)).collect()
    }

    /// Returns the least duration of a phase on the line, seconds.
    fn shortest(&self) -> f64 {
        (self.length / self.speed * MIN_PHASE_SHARE).clamp(MIN_INTERVAL, MIN_PERIODIC_INTERVAL)
    }

    /// Adapts the line to a motion that passes it without rests at its ends. The phases of such a motion may end between two
    /// nanoseconds.
    fn passed(self) -> Self {
        let left = 1.0 - reserve(self.shortest());
        Self { speed: left * self.speed, acceleration: left * self.acceleration, ..self }
    }

    fn at(&self, state: State) -> [Axes; 3] {
        let State { distance, speed, acceleration } = state;
        let (part, Self { from, to, .. }) = (distance / self.length, self);
        // A rounding error must not move a sample beyond the end, which may lie on a joint limit.
        let between = |value: f64, a: f64, b: f64| value.clamp(a.min(b), a.max(b));
        let position = (from + (to - from) * part).zip_zip_map(from, to, between);
        [position, self.direction * speed, self.direction * acceleration]
    }
}

impl Track {
    /// Splits a straight stretch into as many tracks as its limits require.
    fn straight(ends: [Axes; 2], limits: &Limits, tip_share: f64) -> Vec<Self> {
        let limits = &limits.with_tip_share(tip_share);
        if limits.torque.is_none() {
            return Line::parts(ends, limits).into_iter().map(Track::Line).collect();
        }
        let corner = Corner::straight(ends[0], ends[1], limits);
        let corner = corner.map(|corner| Track::Corner(corner.with_tip_share(tip_share)));
        vec![corner.unwrap_or_else(|| Track::Line(Line::new(ends, limits).safe(limits)))]
    }

    /// Returns position, velocity and acceleration of all axes.
    pub(super) fn at(&self, state: State) -> [Axes; 3] {
        match self {
            Track::Line(line) => line.at(state),
            Track::Corner(corner) => corner.at(state),
        }
    }

    /// Returns true if the track is a blend at a waypoint.
    pub(super) fn is_blend(&self) -> bool {
        matches!(self, Track::Corner(corner) if corner.is_blend())
    }

    /// Returns the longest interval between samples within a phase.
    pub(super) fn interval(&self, phase: &Phase, limits: &Limits) -> f64 {
        match self {
            Track::Line(_) => f64::INFINITY,
            Track::Corner(corner) => corner.interval(phase, limits),
        }
    }
}

/// A track and the phases in which it is passed.
pub(super) type TimedTrack = (Track, Vec<Phase>);

/// Returns the timed tracks along a path, and the path with the blends and curved legs in use. Each list of tracks leads from
/// rest to rest, in order. Blends that do not make the motion faster are removed, so that it stops at their corners.
///
/// With a limit on a jerk, all blends and curved legs are removed, because the acceleration would jump where they start. `shares`
/// has, for each waypoint's blend, the speed as a share of the greatest possible one. On straight pieces, the arm coasts for at
/// least `coast` seconds between acceleration and deceleration.
pub(super) fn schedule(
    curve: &BlendedPath,
    limits: &Limits,
    shares: &[f64],
    coast: f64,
) -> (BlendedPath, Vec<Vec<TimedTrack>>) {
    scheduled(curve, limits, shares, coast, Spans::Enough)
}

/// Returns an upper bound on the duration along a curve, seconds, from a coarse division into spans. With it, similar curves can
/// be compared at a fraction of the cost of [`schedule`].
pub(super) fn duration_bound(curve: &BlendedPath, limits: &Limits) -> f64 {
    let (_, runs) = scheduled(curve, limits, &vec![1.0; curve.radii().len()], 0.0, Spans::Few);
    runs.iter().map(|run| duration(run)).sum()
}

/// How finely a blend is divided into spans.
#[derive(Clone, Copy, PartialEq)]
enum Spans {
    /// The initial number of spans.
    Few,
    /// As many as the accuracy needs.
    Enough,
}

fn scheduled(
    curve: &BlendedPath,
    limits: &Limits,
    shares: &[f64],
    coast: f64,
    spans: Spans,
) -> (BlendedPath, Vec<Vec<TimedTrack>>) {
    let corner = |waypoint: usize| {
        let blend = curve.blend(waypoint).filter(|_| !limits.stops_at_corners());
        blend.and_then(|blend| Corner::new(blend_points(curve, waypoint, blend, limits), limits, shares[waypoint]))
    };
    let count = curve.radii().len();
    let mut used = curve.clone();
    for waypoint in (0..count).filter(|&w| curve.radii()[w] > 0.0) {
        if corner(waypoint).is_none() {
            used = used.with(waypoint, 0.0);
        }
    }
    for leg in 0..count - 1 {
        let is_used = !limits.stops_at_corners() && curved_track(&used, leg, limits).is_some();
        if !is_used && used.curved_leg(leg).is_some() {
            used = used.without_curve(leg);
        }
    }
    let mut runs = Vec::new();
    let stops: Vec<usize> = (0..count).filter(|&w| used.radii()[w] == 0.0 && !used.is_smooth(w)).collect();
    for run in stops.windows(2) {
        let stopping = stopping(&used, run[0]..run[1], limits, spans);
        let is_moving = run[1] - run[0] > 1 || used.curved_leg(run[0]).is_some();
        let tracks = is_moving.then(|| tracks(&used, run[0]..run[1], limits, shares)).flatten();
        let blended = tracks.and_then(|tracks| driven(tracks, limits, coast, spans));
        let took: f64 = stopping.iter().map(|timed_tracks| duration(timed_tracks)).sum();
        match blended.filter(|blended| duration(blended) <= took) {
            Some(blended) => runs.push(blended),
            None => {
                used = (run[0] + 1..run[1]).fold(used, |used, waypoint| used.with(waypoint, 0.0));
                used = (run[0]..run[1]).fold(used, BlendedPath::without_curve);
                runs.extend(stopping);
            }
        }
    }
    (used, runs)
}

/// Returns the total duration of timed tracks, seconds.
pub(super) fn duration(timed_tracks: &[TimedTrack]) -> f64 {
    timed_tracks.iter().flat_map(|(_, phases)| phases).map(|phase| phase.duration).sum()
}

/// Appends the samples of the leg after a waypoint, from rest to rest, except the last sample. Returns its end, in nanoseconds.
pub(super) fn stopping_at(
    curve: &BlendedPath,
    waypoint: usize,
    limits: &Limits,
    begin: u64,
    period: f64,
    trajectory: &mut Trajectory,
) -> u64 {
    let runs = stopping(curve, waypoint..waypoint + 1, limits, Spans::Enough);
    runs.iter().fold(begin, |begin, run| sample(run, begin, limits, period, trajectory))
}

/// Returns the configurations of a run at the multiples of a time step, from its beginning to its end.
pub(super) fn places(run: &[TimedTrack], step: f64) -> Vec<Configuration> {
    let mut places = Vec::new();
    let mut since = 0.0;
    for (track, phase) in run.iter().flat_map(|(track, phases)| phases.iter().map(move |phase| (track, phase))) {
        while places.len() as f64 * step < since + phase.duration {
            let [place, ..] = track.at(phase.at(places.len() as f64 * step - since));
            places.push(place.xy());
        }
        since += phase.duration;
    }
    if let Some((track, phase)) = run.last().and_then(|(track, phases)| Some((track, phases.last()?))) {
        places.push(track.at(phase.at(phase.duration))[0].xy());
    }
    places
}

/// Returns the tracks from rest to rest for each leg between two waypoints.
fn stopping(curve: &BlendedPath, waypoints: Range<usize>, limits: &Limits, spans: Spans) -> Vec<Vec<TimedTrack>> {
    let timed_tracks = |number: usize| {
        let tip_share = limits.tip_share(number);
        let whole_limits = limits;
        let ends = [number, number + 1].map(|w| limits.axes_at(w, curve.path().waypoints()[w]));
        let limits = &limits.with_tip_share(tip_share);
        let line = Line::new(ends, limits);
        let whole = || {
            let line = line.safe(limits);
            let phases = rest_to_rest(line.length, line.speed, line.acceleration, MIN_INTERVAL);
            vec![(Track::Line(line), phases)]
        };
        if line.jerk.is_finite() {
            // A common top speed for all parts avoids jumps between them.
            let speed = Line::parts(ends, limits).iter().map(|part| part.speed).fold(f64::INFINITY, f64::min);
            let line = Line { speed, ..line }.safe(limits);
            let phases = jerk::rest_to_rest(line.length, line.speed, line.acceleration, line.jerk, MIN_INTERVAL);
            return vec![(Track::Line(line), phases)];
        }
        let tracks = Track::straight(ends, whole_limits, tip_share);
        let is_more = tracks.len() > 1 || matches!(tracks[0], Track::Corner(_));
        is_more.then(|| driven(tracks, whole_limits, 0.0, spans)).flatten().unwrap_or_else(whole)
    };
    waypoints.map(timed_tracks).collect()
}

/// A part of a run: one with a linear squared speed, or a line that is passed as fast as possible.
enum Span {
    Line(Line),
    Part(Bounds),
}

impl Span {
    /// Returns the greatest squared speed at the beginning from which a squared speed of at most `most` can be reached at the
    /// end.
    fn greatest_squared_start(&self, most: f64) -> f64 {
        match self {
            Span::Line(line) => (most + 2.0 * line.acceleration * line.length).min(line.speed * line.speed),
            Span::Part(bounds) => bounds.greatest_start(most),
        }
    }

    /// Returns the greatest squared speed of at most `most` at the end that can be reached from the squared speed `from` at the
    /// beginning.
    fn greatest_squared_end(&self, from: f64, most: f64) -> f64 {
        match self {
            Span::Line(line) => (from + 2.0 * line.acceleration * line.length).min(line.speed * line.speed).min(most),
            Span::Part(bounds) => bounds.greatest_end(from, most),
        }
    }
}

/// Returns the phases from rest at the beginning of the first track to rest at the end of the last one. `None` if a phase would
/// be too short to be sampled.
fn driven(tracks: Vec<Track>, limits: &Limits, coast: f64, spans: Spans) -> Option<Vec<TimedTrack>> {
    let passed = |track| match track {
        Track::Line(line) => Track::Line(line.passed()),
        corner @ Track::Corner(_) => corner,
    };
    let mut tracks: Vec<Track> = tracks.into_iter().map(passed).collect();
    let squared = loop {
        let squared = squared_speeds(&tracks, limits);
        if spans == Spans::Few {
            return timed_tracks(&tracks, &squared, coast);
        }
        let mut refined = false;
        for (track, squared) in tracks.iter_mut().zip(&squared) {
            if let Track::Corner(corner) = track
                && let Some(finer) = corner.finer(squared, limits)
            {
                (*corner, refined) = (finer, true);
            }
        }
        if !refined {
            break squared;
        }
    };
    let mut best = (timed_tracks(&tracks, &squared, coast)?, squared);
    if tracks.iter().filter(|track| track.is_blend()).count() > MAX_FINER_BLENDS {
        return Some(best.0);
    }
    while let Some(finer) = much_finer(&tracks, &best.1) {
        let squared = squared_speeds(&finer, limits);
        let Some(timed_tracks) = timed_tracks(&finer, &squared, coast) else { break };
        if duration(&timed_tracks) > (1.0 - MIN_GAIN) * duration(&best.0) {
            break;
        }
        (tracks, best) = (finer, (timed_tracks, squared));
    }
    Some(best.0)
}

/// Returns the tracks with several times as many spans on their blends. `None` if no blend can be cut.
fn much_finer(tracks: &[Track], squared: &[Vec<f64>]) -> Option<Vec<Track>> {
    let mut cut = false;
    let finer = |(track, squared): (&Track, &Vec<f64>)| match track {
        Track::Line(_) => track.clone(),
        Track::Corner(corner) if corner.is_leg() => track.clone(),
        Track::Corner(corner) => corner.much_finer(squared).map_or_else(
            || track.clone(),
            |finer| {
                cut = true;
                Track::Corner(finer)
            },
        ),
    };
    let tracks = tracks.iter().zip(squared).map(finer).collect();
    cut.then_some(tracks)
}

/// Returns the phases of tracks with these squared speeds. `None` if one would be too short to be sampled.
fn timed_tracks(tracks: &[Track], squared: &[Vec<f64>], coast: f64) -> Option<Vec<TimedTrack>> {
    let timed_track = |(track, squared): (&Track, &Vec<f64>)| {
        let phases = match track {
            Track::Line(line) => {
                let ends = [squared[0].sqrt(), squared[1].sqrt()];
                passing(line.length, ends, line.speed, line.acceleration, line.shortest(), coast)?
            }
            Track::Corner(corner) => corner.phases(squared),
        };
        let lasts = |phase: &Phase| phase.duration.is_finite() && phase.duration >= MIN_INTERVAL;
        phases.iter().all(lasts).then(|| (track.clone(), phases))
    };
    tracks.iter().zip(squared).map(timed_track).collect()
}

/// Returns the squared speeds of a motion from rest to rest along tracks: at the ends of lines, and at the ends of the spans of
/// corners.
///
/// Forward-backward integration in the phase plane: the backward pass finds the greatest squared speeds from which the arm can
/// still stop at the end, and the forward pass the greatest ones within these that can be reached. Lines are treated in closed
/// form, blends span by span.
fn squared_speeds(tracks: &[Track], limits: &Limits) -> Vec<Vec<f64>> {
    let spans: Vec<Vec<Span>> = tracks
        .iter()
        .map(|track| match track {
            Track::Line(line) => vec![Span::Line(*line)],
            Track::Corner(corner) => corner.bounds(limits).into_iter().map(Span::Part).collect(),
        })
        .collect();
    let mut next = 0.0;
    let mut most: Vec<f64> = Vec::new();
    for span in spans.iter().flatten().rev() {
        most.push(next);
        next = span.greatest_squared_start(next);
    }
    let mut most = most.into_iter().rev();
    let mut squared = 0.0;
    let mut speeds = Vec::with_capacity(tracks.len());
    for spans in spans {
        let mut along = vec![squared];
        for (span, most) in spans.iter().zip(&mut most) {
            squared = span.greatest_squared_end(squared, most);
            along.push(squared);
        }
        speeds.push(along);
    }
    speeds
}

/// Returns the tracks between two waypoints, with a blend at each waypoint in between that is not smooth. `None` if one cannot be
/// sampled.
fn tracks(curve: &BlendedPath, waypoints: Range<usize>, limits: &Limits, shares: &[f64]) -> Option<Vec<Track>> {
    let mut tracks = Vec::new();
    for leg in waypoints.clone() {
        let tip_share = limits.tip_share(leg);
        if curve.curved_leg(leg).is_some() {
            tracks.push(Track::Corner(curved_track(curve, leg, limits)?.with_tip_share(tip_share)));
        } else {
            tracks.extend(Track::straight(leg_ends(curve, leg, limits), limits, tip_share));
        }
        let waypoint = leg + 1;
        if let Some(blend) = curve.blend(waypoint).filter(|_| waypoint < waypoints.end) {
            let corner = Corner::new(blend_points(curve, waypoint, blend, limits), limits, shares[waypoint])?;
            tracks.push(Track::Corner(corner.with_tip_share(tip_share.min(limits.tip_share(waypoint)))));
        }
    }
    Some(tracks)
}

/// Returns a curved leg between the blends at its ends. `None` if it is straight, or too small to be sampled.
fn curved_track(curve: &BlendedPath, leg: usize, limits: &Limits) -> Option<Corner> {
    let CurvedLeg { tangents, length, .. } = curve.curved_leg(leg)?;
    Corner::leg(leg_ends(curve, leg, limits), limits.leg_directions(leg, tangents), length, limits)
}

/// Returns the values of all axes at both ends of a leg, between the blends there.
fn leg_ends(curve: &BlendedPath, leg: usize, limits: &Limits) -> [Axes; 2] {
    [leg, leg + 1].map(|waypoint| match curve.blend(waypoint) {
        Some(blend) => blend_points(curve, waypoint, blend, limits)[if waypoint == leg { 2 } else { 0 }],
        None => limits.axes_at(waypoint, curve.path().waypoints()[waypoint]),
    })
}

/// Returns the values of all axes at the beginning of a blend, at its corner, and at its end.
fn blend_points(curve: &BlendedPath, waypoint: usize, blend: Blend, limits: &Limits) -> [Axes; 3] {
    let (q, radius) = (curve.path().waypoints(), curve.radii()[waypoint]);
    let toward = |other: usize| match curve.curved_leg(waypoint.min(other)) {
        None => limits.wrist_at(waypoint, other, radius, (q[other] - q[waypoint]).norm()),
        Some(CurvedLeg { tangents, .. }) => {
            let [first, last] = limits.leg_directions(waypoint.min(other), tangents);
            let beside = if other > waypoint { first * radius } else { -last * radius };
            limits.axes_at(waypoint, q[waypoint])[2] + beside[2]
        }
    };
    let corner = limits.axes_at(waypoint, blend.corner);
    [blend.from.push(toward(waypoint - 1)), corner, blend.to.push(toward(waypoint + 1))]
}
