//! The strip of progress along the motion against time, with the regions that moving obstacles block.

use super::numbers::{Chain, number};
use super::world::WorldView;
use cplan_geometry::Interval;
use cplan_model::space::Configuration;
use cplan_motion::{PlaceTime, Wait, WaitReason};
use cplan_theme::{GRAY, Rgb};
use serde::Serialize;

/// Invisible deviation of an outline, as a fraction of the strip's width.
const OUTLINE_TOLERANCE: f64 = 2e-3;

/// A strip of progress against time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StripView {
    /// Duration of the motion, in seconds.
    pub duration: f64,
    /// The moving obstacles, each with the regions that it blocks.
    pub obstacles: Vec<BlockedRegions>,
    /// Times in seconds, and progress along the motion from 0 to 1.
    pub motion: Chain,
    /// Waits of the motion.
    pub waits: Vec<WaitView>,
}

/// The regions of the strip that a moving obstacle blocks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BlockedRegions {
    /// Name of the obstacle.
    pub name: String,
    /// Its colour in both spaces.
    pub color: Rgb,
    /// Outlines: times and progress of the corners.
    pub regions: Vec<Chain>,
}

/// A wait of the motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WaitView {
    /// Beginning of the wait, in seconds.
    pub from: f64,
    /// End of the wait, in seconds.
    pub to: f64,
    /// Progress during the wait.
    pub at: f64,
    /// Description in a few words.
    pub text: String,
}

impl StripView {
    /// Creates the strip of a motion of `duration` seconds. Obstacles have the same colours as in the worlds.
    pub fn new(plane: &PlaceTime, duration: f64, waits: &[Wait], worlds: &[WorldView]) -> Self {
        let color = |name: &String| {
            let known = worlds.iter().flat_map(|world| &world.movers).find(|mover| mover.obstacle.name == *name);
            known.map_or(GRAY, |mover| mover.obstacle.color)
        };
        let obstacle = |(index, name): (usize, &String)| BlockedRegions {
            name: name.clone(),
            color: color(name),
            regions: regions(plane, index, duration),
        };
        let wait = |reason: &WaitReason| WaitView {
            from: number(reason.wait.from),
            to: number(reason.wait.to),
            at: number(reason.progress),
            text: format!("waits {}", reason.words()),
        };
        let spots = plane.motion.iter().map(|&[time, progress]| Configuration::new(time, progress));
        let mut motion = thinned(spots.collect(), duration);
        motion
            .extend((motion.last().is_some_and(|last| last[0] < duration)).then(|| Configuration::new(duration, 1.0)));
        Self {
            duration: number(duration),
            obstacles: plane.names.iter().enumerate().map(obstacle).filter(|known| !known.regions.is_empty()).collect(),
            motion: rounded(motion),
            waits: plane.reasons(waits).iter().map(wait).collect(),
        }
    }
}

/// Returns the regions that an obstacle blocks until `duration`. An interval of time at one place, and the first overlapping one
/// at the next place, belong to the same region.
fn regions(plane: &PlaceTime, obstacle: usize, duration: f64) -> Vec<Chain> {
    let mut done: Vec<Run> = Vec::new();
    let mut open: Vec<Run> = Vec::new();
    for (row, place) in plane.places.iter().enumerate() {
        let sides = sides(plane, row);
        let mut next: Vec<Run> = Vec::new();
        for times in place.blocked[obstacle].iter().filter_map(|times| within(*times, duration)) {
            let continues = |run: &Run| run.last[0] <= times[1] && times[0] <= run.last[1];
            let mut run = match open.iter().position(continues) {
                Some(index) => open.remove(index),
                None => Run::begin(times, sides[0]),
            };
            run.add(times, place.progress, sides[1]);
            next.push(run);
        }
        done.append(&mut open);
        open = next;
    }
    done.append(&mut open);
    done.into_iter().map(|run| run.outline(duration)).collect()
}

/// Returns the progress at both sides of a place's row: halfway to the neighbouring places.
fn sides(plane: &PlaceTime, row: usize) -> [f64; 2] {
    let at = |row: usize| plane.places[row].progress;
    let low = if row == 0 { 0.0 } else { f64::midpoint(at(row - 1), at(row)) };
    let high = if row + 1 == plane.places.len() { 1.0 } else { f64::midpoint(at(row), at(row + 1)) };
    [low, high]
}

fn within([from, to]: Interval, duration: f64) -> Option<Interval> {
    let cut = [from.max(0.0), to.min(duration)];
    (cut[0] < cut[1]).then_some(cut)
}

/// Overlapping intervals of time at consecutive places.
struct Run {
    /// Corners at the beginnings of the intervals, and corners at their ends.
    edges: [Vec<Configuration>; 2],
    last: Interval,
    /// Progress at the far side of the last place.
    until: f64,
}

impl Run {
    fn begin(times: Interval, progress: f64) -> Self {
        let edges = times.map(|time| vec![Configuration::new(time, progress)]);
        Self { edges, last: times, until: progress }
    }

    fn add(&mut self, times: Interval, progress: f64, until: f64) {
        for (edge, time) in self.edges.iter_mut().zip(times) {
            edge.push(Configuration::new(time, progress));
        }
        (self.last, self.until) = (times, until);
    }

    fn outline(self, duration: f64) -> Chain {
        let (last, until) = (self.last, self.until);
        let [mut begins, mut ends] = self.edges;
        begins.push(Configuration::new(last[0], until));
        ends.push(Configuration::new(last[1], until));
        let mut corners = thinned(begins, duration);
        corners.extend(thinned(ends, duration).into_iter().rev());
        rounded(corners)
    }
}

/// Omits corners that lie nearly on the line between their neighbours.
fn thinned(corners: Vec<Configuration>, duration: f64) -> Vec<Configuration> {
    let mut kept: Vec<Configuration> = Vec::new();
    let mut skipped: Vec<Configuration> = Vec::new();
    let unit = |q: Configuration| Configuration::new(q[0] / duration.max(f64::MIN_POSITIVE), q[1]);
    for corner in corners {
        let is_on_line = |from: Configuration, q: Configuration| {
            let (along, other) = (unit(corner) - unit(from), unit(q) - unit(from));
            (along[0] * other[1] - along[1] * other[0]).abs() <= OUTLINE_TOLERANCE / 4.0 * along.norm()
        };
        match kept.last() {
            Some(&from) if skipped.iter().all(|&q| is_on_line(from, q)) => {}
            Some(_) => {
                kept.extend(skipped.last());
                skipped.clear();
            }
            None => {
                kept.push(corner);
                continue;
            }
        }
        skipped.push(corner);
    }
    kept.extend(skipped.last());
    kept
}

fn rounded(corners: Vec<Configuration>) -> Chain {
    let round = |value: f64| (value * 1e4).round() / 1e4;
    Chain(corners.into_iter().map(|q| Configuration::new(round(q[0]), round(q[1]))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_motion::TimedPlace;

    /// The obstacle blocks a slanted stripe, which a motion with one wait passes.
    #[test]
    fn a_stripe_is_one_region_with_few_corners() {
        let place = |k: u32| {
            let progress = (f64::from(k) + 0.5) / 20.0;
            let blocked = vec![vec![[1.0 + progress, 2.0 + progress]]];
            TimedPlace { progress, time: 3.0 * progress, blocked }
        };
        let plane =
            PlaceTime::trusted(vec!["cart".to_owned()], (0..20).map(place).collect(), vec![[0.0, 0.0], [4.0, 1.0]]);
        let strip = StripView::new(&plane, 4.0, &[], &[]);
        let [obstacle] = &strip.obstacles[..] else { panic!("one obstacle") };
        let [Chain(region)] = &obstacle.regions[..] else { panic!("{:?}", obstacle.regions) };
        assert!(region.len() <= 8, "{region:?}");
        let area: f64 = (0..region.len())
            .map(|i| (region[i], region[(i + 1) % region.len()]))
            .map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0)
            .sum();
        assert!((area.abs() - 1.0).abs() < 0.01, "{area}");
    }
}
