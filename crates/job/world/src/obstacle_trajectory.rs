//! The key `motion` of `[[obstacle]]` and `[[object]]` in the world file: how the obstacle moves while the arm does.

use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_geometry::{Pose, Vector};
use cplan_handling::{ObstacleTrajectory, ObstacleTrajectoryError, Stop};
use cplan_robot::{Diagnostic, Lengths, Number, Numbers, Spanned, Written, toml_table};

toml_table! {
    /// The motion of an obstacle: straight and at constant speed from stop to stop, then at a constant velocity. At
    /// least one of the two keys is required.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "motion", extend("anyOf" = [{ "required": ["stops"] }, { "required": ["velocity"] }])))]
    pub(super) struct ObstacleTrajectoryTable {
        /// Positions at increasing times. Before the first of these times, the obstacle waits at the first stop. By
        /// default there is a single stop at time 0.
        #[cfg_attr(test, schemars(length(min = 1)))]
        stops: Option<Spanned<Vec<Spanned<StopTable>>>>,
        /// Velocity after the last stop, m/s, as on a conveyor. By default the obstacle stays at the last stop.
        #[cfg_attr(test, schemars(with = "Option<NumberPair>"))]
        velocity: Option<Numbers>,
    }

    /// The position of an obstacle at a time.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "stop"))]
    pub(super) struct StopTable {
        /// Seconds since the arm's motion begins.
        #[cfg_attr(test, schemars(with = "NotNegative"))]
        time: Number,
        /// Origin of its own frame at that time, m; by default the obstacle's `at`.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        at: Option<Lengths>,
        /// Angle of its frame at that time, rad; by default the obstacle's `angle`. Between two stops the obstacle
        /// turns by the difference, including whole turns.
        angle: Option<Written>,
    }
}

impl ObstacleTrajectoryTable {
    /// Returns the motion of an obstacle. Stops without a position or an angle get that of `place`.
    ///
    /// # Errors
    /// Times that do not increase, numbers that are not finite, and an empty table.
    pub fn read(
        &self,
        reader: &Reader,
        what: &str,
        place: Option<&Pose>,
        at: Span,
    ) -> Result<ObstacleTrajectory, Diagnostic> {
        let what = format!("{what}, motion");
        if self.stops.is_none() && self.velocity.is_none() {
            let message = format!("{what} has neither `stops` nor `velocity`");
            return Err(reader.source.diagnostic_at(at, message).help(MOTION_HINT));
        }
        let given = |time: f64| {
            let origin = place.map_or_else(Vector::zeros, |place| place.translation);
            Stop { time, at: origin, angle: place.map_or(0.0, |place| place.rotation.angle()) }
        };
        let tables = self.stops.iter().flat_map(|stops| stops.get_ref());
        let stops = tables.clone().zip(1..).map(|(stop, number)| {
            let (what, table) = (format!("{what}, stop {number}"), stop.get_ref());
            let mut stop = given(reader.not_negative(&table.time, &format!("{what}, time"))?);
            if let Some(at) = &table.at {
                stop.at = reader.point(at, &format!("{what}, at"))?;
            }
            if let Some(angle) = &table.angle {
                stop.angle = reader.quantity(angle, &format!("{what}, angle"))?;
            }
            Ok(stop)
        });
        let stops = stops.collect::<Result<Vec<Stop>, Diagnostic>>()?;
        let velocity =
            self.velocity.as_ref().map(|v| reader.number_pair(v, &format!("{what}, velocity"))).transpose()?;
        let stops = if self.stops.is_none() { vec![given(0.0)] } else { stops };
        ObstacleTrajectory::new(stops, velocity.map_or_else(Vector::zeros, Vector::from)).map_err(|error| {
            let (message, at, help) = match error {
                ObstacleTrajectoryError::Time { stop, time } => (
                    format!(
                        "{what}, stop {}: the time {time} s is not later than the time of the previous stop",
                        stop + 1
                    ),
                    tables.clone().nth(stop).map_or(at, |stop| stop.get_ref().time.span()),
                    "sort the stops by time; times must increase",
                ),
                ObstacleTrajectoryError::Empty | ObstacleTrajectoryError::Place { .. } => {
                    (format!("{what}: {error}"), self.stops.as_ref().map_or(at, Spanned::span), MOTION_HINT)
                }
            };
            reader.source.diagnostic_at(at, message).help(help)
        })
    }
}

const MOTION_HINT: &str =
    "motion = { stops = [{ time = 0, at = [x, y] }, { time = 2, at = [x, y] }] }, or { velocity = [vx, vy] }";

type Span = std::ops::Range<usize>;
