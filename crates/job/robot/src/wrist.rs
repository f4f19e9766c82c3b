//! The table `wrist` of `[robot]` in the world file.

use super::assumed::assumed_acceleration_note;
use super::error::Diagnostic;
use super::quantity::{Number, PerJoint, find};
#[cfg(feature = "schema")]
use super::schema::*;
use super::source::Source;
use crate::Spanned;
use crate::toml_table;
use cplan_handling::Wrist;
use cplan_model::assumed_acceleration;

toml_table! {
    /// Limits of the wrist. The wrist keeps the orientation of level payloads, and turns them if their place has
    /// another angle. It turns them while the arm moves, if the payload stays free and the wrist within these limits.
    /// With `arch = false`, it turns them while the arm is at rest.
    #[derive(Debug, Clone, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "wrist"))]
    pub struct WristTable {
        /// The wrist's joint. If it is stated, ROS 2 files contain its values; otherwise the wrist stands still in
        /// them. Lines with a `wrist` angle need this key.
        pub joint: Option<Spanned<String>>,
        /// Top speed, rad/s.
        #[cfg_attr(feature = "schema", schemars(with = "Positive"))]
        pub velocity: Number,
        /// Greatest acceleration, rad/s2; by default top speed is reached in 0.25 s.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub acceleration: Option<Number>,
        /// Greatest jerk, rad/s3; by default the jerk limit of its joint, or else none.
        #[cfg_attr(feature = "schema", schemars(with = "Option<Positive>"))]
        pub jerk: Option<Number>,
    }
}

impl WristTable {
    /// Reads the wrist's limits. `source` is the file with the table, and `jerks` has the jerk limits of joints.
    /// `turns_on_the_way` is true if the wrist may turn objects while the arm moves.
    ///
    /// # Errors
    /// A limit that is not positive or not finite.
    pub fn read(&self, source: &Source, jerks: &PerJoint<Number>, turns_on_the_way: bool) -> Result<Wrist, Diagnostic> {
        let velocity = positive(source, &self.velocity, "velocity")?;
        let acceleration = self.acceleration.as_ref().map(|a| positive(source, a, "acceleration")).transpose()?;
        let acceleration = acceleration.unwrap_or(assumed_acceleration(velocity));
        let own = self.joint.as_ref().and_then(|name| find(jerks, name.get_ref()));
        let jerk = self.jerk.as_ref().or(own).map(|jerk| positive(source, jerk, "jerk")).transpose()?;
        Ok(Wrist { velocity, acceleration, jerk, turns_on_the_way, joint: None })
    }

    /// Returns a note about the acceleration limit. `None` if the file states the limit.
    pub fn note(&self, wrist: &Wrist) -> Option<String> {
        self.acceleration.is_none().then(|| assumed_acceleration_note("wrist", wrist.acceleration, "rad"))
    }
}

fn positive(source: &Source, number: &Number, what: &str) -> Result<f64, Diagnostic> {
    let value = source.finite(number, &format!("[robot] wrist, {what}"))?;
    if value > 0.0 {
        return Ok(value);
    }
    let message = format!("[robot] wrist: {what} must be positive, is {value}");
    Err(source.diagnostic_at(number.span(), message).help("wrist = { velocity = 6.0 }, in rad/s"))
}
