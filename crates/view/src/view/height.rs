//! The strip of the tool's height against time.

use super::numbers::{Chain, number};
use cplan_core::space::Configuration;
use cplan_handling::Task;
use cplan_motion::single;
use cplan_tasks::Leg;
use serde::Serialize;

/// Number of lines that show a phase of constant acceleration.
const LINES_PER_PHASE: u32 = 8;

/// The height of the tool against time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeightView {
    /// Name of the joint that lowers the tool.
    pub joint: String,
    /// Duration of the task, in seconds.
    pub duration: f64,
    /// Times in seconds and values of the joint in millimetres.
    pub motion: Chain,
}

impl HeightView {
    /// Creates the strip of a task. `None` if the tool is never lowered.
    #[must_use]
    pub fn of_task(task: &Task, legs: &[Leg]) -> Option<Self> {
        let tool = task.stroke.as_ref()?;
        let duration = legs.last()?.end();
        let mut corners = vec![[0.0, tool.joint.rest]];
        for leg in legs {
            let Some((stroke, begins)) = leg.stroke.zip(leg.stroke_begins()) else { continue };
            let ends = [[stroke.raised, stroke.lowered], [stroke.lowered, stroke.raised]];
            for (begin, [from, to]) in begins.into_iter().zip(ends) {
                let sign = (to - from).signum();
                let phases = single((to - from).abs(), tool.velocity, tool.acceleration);
                corners.push([begin, from]);
                for phase in phases.windows(2) {
                    let [[since, distance, speed], [until, _, later]] = [phase[0], phase[1]];
                    corners.extend((1..=LINES_PER_PHASE).map(|line| {
                        let into = (until - since) * f64::from(line) / f64::from(LINES_PER_PHASE);
                        let rate = speed + (later - speed) * into / (until - since);
                        [begin + since + into, from + sign * (distance + into * (speed + rate) / 2.0)]
                    }));
                }
            }
        }
        corners.push([duration, tool.joint.rest]);
        let rounded =
            |[time, value]: [f64; 2]| Configuration::new((time * 1e4).round() / 1e4, (value * 1e6).round() / 1e3);
        let motion = Chain(corners.into_iter().map(rounded).collect());
        (motion.0.len() > 2).then(|| Self { joint: tool.joint.name.clone(), duration: number(duration), motion })
    }
}
