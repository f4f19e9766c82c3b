//! Paths, and motions over time.

use super::numbers::{Chain, RoundingSteps};
use crate::figure::Pen;
use cplan_model::space::{Configuration, Path};
use cplan_motion::Trajectory;
use cplan_theme::{ACCENT, GRAY, INK, PlannerPen, Rgb, role_or_hex};
use serde::{Serialize, Serializer};

/// Number of the arm's poses that are shown between the ends of a path.
const GHOST_POSES: usize = 5;
/// Width of a highlighted path, in pixels.
const HIGHLIGHTED_WIDTH: f64 = 2.4;
/// Width of a path that is not highlighted, in pixels.
const LINE_WIDTH: f64 = 1.6;

/// Dashes and gaps, in pixels, of the line of a lower bound.
const BOUND_DASH: [f64; 2] = [7.0, 4.0];

/// A path in a world.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathView {
    /// Name. Empty if the path has none.
    pub name: String,
    /// Index of the world in which it is planned.
    pub world: usize,
    /// Colour of the line; `None` for [`cplan_theme::INK`].
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "color_name")]
    color: Option<Rgb>,
    /// Width of the line, in pixels.
    width: f64,
    /// Lengths of dashes and gaps in turn.
    dash: &'static [f64],
    /// Unwrapped configurations.
    pub points: Chain,
    /// Configurations whose poses are shown between start and goal. They divide the path into equal parts.
    pub ghosts: Chain,
    /// Number of the step in a task, from 1; 0 for a single motion.
    #[serde(skip_serializing_if = "is_none")]
    pub step: usize,
    /// True while an animation draws the path and has not reached its goal.
    #[serde(skip)]
    pub grows: bool,
}

/// Serialises the colour by its name, if it has one, because the page shows another colour on a dark background.
fn color_name<S: Serializer>(color: &Option<Rgb>, serializer: S) -> Result<S::Ok, S::Error> {
    color.map(role_or_hex).serialize(serializer)
}

fn is_one(round: &usize) -> bool {
    *round == 1
}

fn is_none(step: &usize) -> bool {
    *step == 0
}

impl PathView {
    /// Creates path `index` of `count`. The only path has the colour of ink.
    pub fn of_several(name: &str, path: &Path, [index, count]: [usize; 2], grain: RoundingSteps) -> Self {
        let (color, dash) = cplan_theme::path(index);
        let (color, dash) = if count > 1 { (Some(color), dash) } else { (None, &[][..]) };
        Self {
            name: name.to_owned(),
            world: 0,
            color,
            width: HIGHLIGHTED_WIDTH,
            dash,
            points: grain.configurations(path.waypoints()),
            ghosts: grain.configurations(&intermediate_configurations(path, GHOST_POSES)),
            step: 0,
            grows: false,
        }
    }

    /// Returns this path in the colour and with the dashes of a planner.
    pub fn of_planner(self, pen: PlannerPen) -> Self {
        Self { color: Some(pen.light()), dash: pen.dash, ..self }
    }

    /// Creates the path of a step, in the colour of the payload.
    pub fn of_step(
        name: String,
        path: &Path,
        world: usize,
        step: usize,
        carried: Option<Rgb>,
        grain: RoundingSteps,
    ) -> Self {
        let color = carried.map(|color| color.darker(0.25));
        let width = if carried.is_some() { HIGHLIGHTED_WIDTH } else { LINE_WIDTH };
        Self { name, world, color, width, step, ..Self::of_several("", path, [0, 1], grain) }
    }

    /// Returns the part of this line that an animation has drawn so far, through `points`, without poses in between.
    pub fn drawn_through(&self, points: Chain) -> Self {
        Self { points, ghosts: Chain::default(), grows: true, ..self.clone() }
    }

    /// Returns a grey line through `points`, to be drawn beside this one.
    pub fn grey_line(&self, points: Chain) -> Self {
        Self {
            name: "before it is pulled taut".to_owned(),
            color: Some(GRAY),
            width: LINE_WIDTH,
            ..self.drawn_through(points)
        }
    }

    /// Returns the first certified path as a line that is drawn beside this one.
    pub fn first_line(&self, points: Chain) -> Self {
        Self { name: "first path".to_owned(), ..self.grey_line(points) }
    }

    /// Returns the line of a lower bound that is drawn beside this path.
    pub fn bound_line(&self, points: Chain) -> Self {
        Self {
            name: "no motion is shorter".to_owned(),
            color: Some(ACCENT),
            dash: &BOUND_DASH,
            ..self.grey_line(points)
        }
    }

    /// Returns the pen of the path.
    pub fn pen(&self) -> Pen {
        let ink = if self.width < HIGHLIGHTED_WIDTH { INK.lighter(0.3) } else { INK };
        Pen { color: self.color.unwrap_or(ink), width: self.width, dash: self.dash }
    }

    /// Returns true if the arm carries a payload along the path.
    pub fn is_colored(&self) -> bool {
        self.color.is_some()
    }

    /// Returns the first configuration.
    pub fn start(&self) -> Configuration {
        self.points.0[0]
    }

    /// Returns the last configuration.
    pub fn goal(&self) -> Configuration {
        self.points.0[self.points.0.len() - 1]
    }
}

/// Returns configurations that divide the path into `count + 1` equal parts.
fn intermediate_configurations(path: &Path, count: usize) -> Vec<Configuration> {
    let total = path.length();
    let mut wanted = (1..=count).map(|k| total * k as f64 / (count + 1) as f64).peekable();
    let (mut found, mut done) = (Vec::new(), 0.0);
    for (a, b) in path.segments() {
        let length = (b - a).norm();
        while let Some(s) = wanted.next_if(|&s| s <= done + length) {
            found.push(a + (b - a) * ((s - done) / length));
        }
        done += length;
    }
    found
}

/// A motion between two moments of rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionView {
    pub world: usize,
    /// Index of the path. `None` for the world after the last motion.
    pub path: Option<usize>,
    /// Time at which its world becomes the current one, in seconds.
    pub from: f64,
    /// Description of the motion.
    pub label: String,
    /// Number of the step's repetition, from 1. Pages show it if the step is repeated.
    #[serde(skip_serializing_if = "is_one")]
    pub round: usize,
    /// Proven lower bound on the distance between arm and obstacles, metres. `None` for the world after the last motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Index of the planner's replay for this motion; `None` without a replay.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub replay: Option<usize>,
}

impl MotionView {
    /// Creates the view of a plan's only motion, of `duration` seconds.
    pub fn only(duration: f64) -> Self {
        Self {
            world: 0,
            path: Some(0),
            from: 0.0,
            label: format!("{duration:.3} s"),
            round: 1,
            clearance: None,
            replay: None,
        }
    }
}

/// The arm's configuration as a function of time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Clock {
    time: Vec<f64>,
    /// Position of both joints, in radians or metres.
    position: Chain,
    /// Velocity of both joints, in rad/s or m/s.
    velocity: Chain,
    /// Acceleration of both joints from this sample to the next, in rad/s² or m/s².
    acceleration: Chain,
    /// Torque or force of both joints from this sample to the next, if known.
    #[serde(skip_serializing_if = "Option::is_none")]
    torque: Option<Chain>,
}

impl Clock {
    /// Returns the time of the last sample, in seconds.
    pub fn duration(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0)
    }

    /// Returns the configuration at a time, interpolated linearly between two samples. The error is invisible.
    pub fn at(&self, time: f64) -> Configuration {
        let positions = &self.position.0;
        if let [only] = positions[..] {
            return only;
        }
        let next = self.time.partition_point(|&t| t <= time).clamp(1, positions.len() - 1);
        let [from, to] = [self.time[next - 1], self.time[next]];
        let part = ((time - from) / (to - from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        positions[next - 1] + (positions[next] - positions[next - 1]) * part
    }

    /// Creates the clock of a motion.
    pub fn new(trajectory: &Trajectory, grain: RoundingSteps) -> Self {
        Self::precise(trajectory, grain, grain)
    }

    /// Creates the clock of a motion, with other rounding steps for its positions.
    pub fn precise(trajectory: &Trajectory, grain: RoundingSteps, positions: RoundingSteps) -> Self {
        let fine = |&q: &[f64; 2]| positions.configuration(q.into()).into();
        let chain = |values: &[[f64; 2]]| Chain(values.iter().map(|&q| grain.configuration(q.into()).into()).collect());
        Self {
            time: trajectory.time.iter().map(|&t| (t * 1e6).round() / 1e6).collect(),
            position: Chain(trajectory.position.iter().map(fine).collect()),
            velocity: chain(&trajectory.velocity),
            acceleration: chain(&trajectory.acceleration),
            torque: (!trajectory.torque.is_empty()).then(|| chain(&trajectory.torque)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ghosts_are_equally_spaced() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.5, 3.0)];
        let path = Path::new(corners.iter().map(|c| Configuration::new(c.0, c.1)).collect());
        let all = intermediate_configurations(&path, 8);
        let expected: Vec<Configuration> =
            [(0.5, 0.0), (1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (1.0, 1.5), (1.0, 2.0), (1.0, 2.5), (1.0, 3.0)]
                .iter()
                .map(|c| Configuration::new(c.0, c.1))
                .collect();
        assert_eq!(all.len(), expected.len());
        assert!(all.iter().zip(&expected).all(|(a, b)| (a - b).norm() < 1e-12), "{all:?}");
        assert!(intermediate_configurations(&Path::new(vec![Configuration::zeros()]), 3).is_empty());
    }
}
