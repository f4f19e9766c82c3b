//! An exploration as JSON.

use super::result::{Ending, Exploration};
use cplan_world::Sensor;
use serde_json::{Value, json};

impl Exploration {
    /// Returns the exploration as JSON, without the picture of the map: the ending, the map's counts, every reading,
    /// every leg, and the motion.
    ///
    /// Each row of `readings` has both joint values, the length of the path so far, and the number of new cells.
    /// `decisions_ms` is present only if `timed`. Without it, the same input gives the same text.
    pub fn to_json(&self, joints: [&str; 2], sensor: &Sensor, timed: bool) -> Value {
        let map = self.survey.map();
        let [free, occupied, unknown] = self.survey.counts();
        let origin = map.pose.translation;
        let rows = self.readings.iter().map(|r| json!([r.at[0], r.at[1], r.length, r.new.len()]));
        let legs = self.legs.iter().map(|leg| {
            let waypoints = leg.curve.curve().path().waypoints().iter().map(|q| [q[0], q[1]]).collect::<Vec<_>>();
            let clearance = leg.curve.clearance();
            json!({ "path": waypoints, "clearance": clearance.is_finite().then_some(clearance), "readings": leg.readings })
        });
        let mut value = json!({
            "status": self.ending.name(),
            "joints": joints,
            "strategy": self.strategy,
            "sensor": sensor,
            "grid": self.cells,
            "map": {
                "origin": [origin.x, origin.y],
                "cell": map.resolution,
                "size": map.size,
                "free": free,
                "occupied": occupied,
                "unknown": unknown,
            },
            "length": self.length,
            "known_length": self.known_length,
            "duration": self.trajectory.as_ref().map_or(0.0, cplan_motion::Trajectory::duration),
            "decisions": self.decisions.len(),
            "readings": rows.collect::<Vec<_>>(),
            "legs": legs.collect::<Vec<_>>(),
            "trajectory": self.trajectory,
        });
        match &self.ending {
            Ending::Unreachable(why) | Ending::Unknown(why) => value["reason"] = json!(why),
            Ending::Explored { configurations, given_up } => {
                value["configurations"] = json!(configurations);
                value["given_up"] = json!(given_up);
            }
            Ending::Reached => {}
        }
        if timed {
            value["decisions_ms"] = self.decisions.iter().map(|d| 1e3 * d.as_secs_f64()).collect();
        }
        value
    }
}
