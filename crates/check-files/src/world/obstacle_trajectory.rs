//! Motions of obstacles and objects in time.

use super::{ReadResult, Reader, Value};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point, length, minus, sum, times, turned};
use cplan_check::obstacle::{ObstacleTrajectory, point};
use cplan_check::overlap::Shape;
use num_bigint::{BigInt, Sign};

/// Straight motion from stop to stop at constant speeds. The obstacle waits at the first stop until the time of that
/// stop. After the last stop, it continues at a constant velocity.
pub struct StopTrajectory {
    stops: Vec<Stop>,
    velocity: Point,
}

/// A time, and the position and the orientation of the frame at that time.
struct Stop {
    time: Decimal,
    at: Point,
    angle: Interval,
}

impl StopTrajectory {
    /// Returns the position of the frame's origin at a time, and the orientation of the frame.
    fn pose(&self, time: &Decimal) -> (Point, Interval) {
        let next = self.stops.partition_point(|stop| stop.time <= *time);
        let Stop { time: begin, at, angle } = &self.stops[next.saturating_sub(1)];
        let since = Interval::from(&(time - begin));
        match self.stops.get(next) {
            _ if next == 0 => (at.clone(), angle.clone()),
            None => (sum(at, &times(&self.velocity, &since)), angle.clone()),
            Some(to) => {
                let share = since.divided(&Interval::from(&(&to.time - begin)));
                let between = |from: &Interval, to: &Interval| from + &(&(to - from) * &share);
                ([0, 1].map(|k| between(&at[k], &to.at[k])), between(angle, &to.angle))
            }
        }
    }
}

impl ObstacleTrajectory for StopTrajectory {
    fn place(&self, time: &Decimal) -> [Point; 2] {
        let (at, angle) = self.pose(time);
        [at, angle.sin_cos()]
    }

    /// Returns the shape at the middle of the span, grown by its greatest displacement from there. Between stops, a convex
    /// function of time bounds the displacement of a point. So it is greatest at an end of the span or at a stop.
    fn swept_shape(&self, shape: &Shape, [from, to]: [&Decimal; 2]) -> Shape {
        let middle = Decimal::middle(from, to);
        let (at, angle) = self.pose(&middle);
        let reach = Interval::exact(shape.points.iter().map(|p| length(p).upper).max().unwrap_or_default());
        let stops = self.stops.iter().map(|stop| &stop.time).filter(|time| from < time && *time < to);
        let away = [from, to].into_iter().chain(stops).map(|time| {
            let (there, turned) = self.pose(time);
            let gone = length(&minus(&there, &at));
            (&gone + &(&reach * &(&turned - &angle).abs())).upper
        });
        let away: BigInt = away.max().expect("two ends");
        let turn = angle.sin_cos();
        Shape {
            points: shape.points.iter().map(|p| sum(&at, &turned(p, &turn))).collect(),
            radius: &shape.radius + &Interval::exact(away),
        }
    }
}

impl Reader<'_> {
    /// Reads the `motion` of an obstacle. `at` and `angle` are the defaults for its stops.
    pub(super) fn trajectory(&self, value: &Value, at: &Point, angle: &Interval) -> ReadResult<StopTrajectory> {
        let table = self.table(value)?;
        if let Some((key, _)) = table.iter().find(|(key, _)| !["stops", "velocity"].contains(&&**key.get_ref())) {
            return self.error(value, &format!("the checker does not know the key {} of a motion", key.get_ref()));
        }
        let stop = |value: &Value| {
            let stop = self.table(value)?;
            let Some(time) = stop.get("time") else { return self.error(value, "a stop needs a time") };
            if let Some((key, _)) = stop.iter().find(|(key, _)| !["time", "at", "angle"].contains(&&**key.get_ref())) {
                return self.error(value, &format!("the checker does not know the key {} of a stop", key.get_ref()));
            }
            Ok(Stop {
                time: self.number(time)?,
                at: stop.get("at").map_or(Ok(at.clone()), |at| Ok(point(&self.pair(at, |n| self.length(n))?)))?,
                angle: stop.get("angle").map_or(Ok(angle.clone()), |a| Ok(Interval::enclosing(&self.quantity(a)?)))?,
            })
        };
        let stops: Vec<Stop> = match table.get("stops") {
            Some(stops) => self.list(stops)?.into_iter().map(stop).collect::<ReadResult<_>>()?,
            None => vec![Stop { time: Decimal::whole(0), at: at.clone(), angle: angle.clone() }],
        };
        let is_later = |pair: &[Stop]| Interval::from(&(&pair[1].time - &pair[0].time)).lower.sign() == Sign::Plus;
        if stops.is_empty() || !stops.windows(2).all(is_later) {
            return self.error(value, "a motion needs stops, each later than the previous one");
        }
        let velocity = table.get("velocity").map(|v| self.pair(v, |n| self.number(n))).transpose()?;
        Ok(StopTrajectory { stops, velocity: velocity.map_or_else(|| [0, 0].map(Interval::whole), |v| point(&v)) })
    }
}
