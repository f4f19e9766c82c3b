//! The content of pictures and pages about a line that the tip follows.

use super::limits::ActiveLimit;
use super::played::is_smooth;
use super::solutions::other_solution;
use super::{FollowedMotion, LineSettings, SolutionPart, Stretch, solutions};
use crate::axes::span;
use crate::view::{Chain, Clock, RoundingSteps};
use crate::{Object, object};
use cplan_geometry::Point;
use cplan_model::space::Configuration;
use cplan_model::{Arm, Scene};
use cplan_motion::Trajectory;
use cplan_theme::{ACCENT, GRAY, INFEASIBLE, PATH_COLORS, Rgb};
use cplan_toolpath::{Curve, Toolpath};
use serde::Serialize;
use std::f64::consts::TAU;

/// Greatest distance between the line and its chords in pictures, as a share of the arm's reach.
const DRAWN_TOLERANCE: f64 = 2e-5;

/// Greatest error of the tip's position on a page, as a share of the tolerance. The lens magnifies it to half a pixel.
const LENS_ERROR_SHARE: f64 = 0.005;

/// Greatest number of pieces of a line whose exact curves pages get. The lens needs exact curves.
const MAX_EXACT_PIECES: usize = 4000;

/// Room around the line in a magnified workspace, as a share of the line's extent; and the greatest share of the workspace that
/// is still worth magnifying.
const FOCUS_MARGIN: f64 = 0.22;
const MAX_FOCUS_SHARE: f64 = 0.7;

/// Room for the overview beside the line; and the greatest share of the magnified part that the line may fill along the same
/// axis.
const OVERVIEW_ROOM: f64 = 0.36;
const MAX_LINE_SHARE: f64 = 0.58;

/// Radius of the part that the lens shows, as a multiple of the tolerance.
pub const LENS_TOLERANCES: f64 = 8.0;

/// Joint values closer than this belong to the same IK solution, radians or metres.
const SAME_SOLUTION: f64 = 1e-3;

/// A line that the tip should follow.
#[derive(Debug, Clone, PartialEq)]
pub struct LineView {
    /// Points of the line, metres. A travel separates one inner list from the next.
    pub(crate) strokes: Vec<Vec<Point>>,
    /// The exact curves, including travels.
    pub(crate) curves: Vec<Curve>,
    /// Greatest distance of the tip from the line, metres.
    pub(crate) tolerance: f64,
    /// The place on the line where no motion is possible; `None` for other answers.
    pub(crate) place: Option<Point>,
    /// The joint values of the IK solutions that are excluded.
    pub(crate) excluded: Vec<Configuration>,
    /// The images of the line in joint space.
    pub(crate) solutions: Vec<SolutionPart>,
    /// Number of the IK solution that the motion uses. `None` without a motion, or if the solution changes.
    pub(crate) used: Option<usize>,
    /// The motion along the line, and the proven bound on its distance from the line, metres.
    pub(crate) motion: Option<(FollowedMotion, f64)>,
    /// The motion in time, as precise as the lens needs it.
    pub(crate) clock: Option<Clock>,
    /// The arm's configuration where the tip is farthest from the line.
    pub(crate) pose: Option<Configuration>,
    /// The other IK solution there, and true if it is excluded.
    pub(crate) other: Option<(Configuration, bool)>,
    /// The magnified part of the workspace. `None` if nothing is magnified.
    pub(crate) focus: Option<Focus>,
    /// The marked moves of a program. `None` unless the line is a program for a machine.
    pub(crate) marked: Option<Vec<(MoveMark, Vec<Point>)>>,
    is_smooth: bool,
    names: [String; 2],
}

/// The part of the workspace around a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Focus {
    /// Least and greatest value of each coordinate, metres.
    pub ranges: [[f64; 2]; 2],
    /// The corner farthest from the arm, with room for an overview: for each axis -1 (left, below) or 1 (right, above).
    pub corner: [f64; 2],
}

/// The kinds of moves of a program that pictures mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveMark {
    /// A travel that was replaced, at its new position.
    Replaced,
    /// A move that the machine cannot play, or that is not proven.
    Failed,
}

impl MoveMark {
    pub(crate) const ALL: [Self; 2] = [Self::Replaced, Self::Failed];

    /// Returns the colour, and the name in the legend.
    pub(crate) fn look(self) -> (Rgb, &'static str) {
        match self {
            Self::Replaced => (ACCENT, "replaced travel"),
            Self::Failed => (INFEASIBLE, "move that fails"),
        }
    }
}

impl LineView {
    /// Marks these moves of a program for a machine, given by their points.
    #[must_use]
    pub fn with_marked_moves(mut self, marked: Vec<(MoveMark, Vec<Point>)>) -> Self {
        self.marked = Some(marked);
        self
    }

    /// Creates the view of a line without a motion.
    pub fn new(scene: &Scene, line: &Toolpath, tolerance: f64) -> Self {
        let strokes = line.outlines(DRAWN_TOLERANCE * scene.arm().reach());
        Self {
            strokes: strokes.into_iter().map(|stroke| stroke.into_iter().map(Into::into).collect()).collect(),
            curves: line.pieces().iter().map(|piece| piece.curve).collect(),
            tolerance,
            place: None,
            excluded: Vec::new(),
            solutions: solutions(scene, line),
            used: None,
            motion: None,
            clock: None,
            pose: None,
            other: None,
            focus: None,
            marked: None,
            is_smooth: is_smooth(scene.arm()),
            names: scene.arm().joints.each_ref().map(|joint| joint.name.clone()),
        }
    }

    /// Adds the place where no motion is possible, and the IK solutions that are excluded there.
    #[must_use]
    pub fn infeasible_at(mut self, place: Point, excluded: Vec<Configuration>) -> Self {
        (self.place, self.excluded) = (Some(place), excluded);
        self
    }

    /// Adds a motion. `deviation` is the proven bound on its distance from the line, metres; `changes` is true if the IK solution
    /// changes.
    #[must_use]
    pub fn with_motion(
        mut self,
        scene: &Scene,
        line: &Toolpath,
        trajectory: &Trajectory,
        settings: LineSettings,
        (deviation, changes): (f64, bool),
    ) -> Self {
        let arm = scene.arm();
        let motion = FollowedMotion::new(arm, line, trajectory, settings);
        let step = LENS_ERROR_SHARE * self.tolerance / arm.reach().max(f64::MIN_POSITIVE);
        self.used = (!changes).then(|| self.solution_of(trajectory.position[0].into())).flatten();
        let pose = motion.played.at(motion.farthest.time);
        self.pose = Some(pose);
        self.other = other_solution(scene, pose);
        let grain = RoundingSteps::of(arm);
        self.clock = Some(Clock::precise(trajectory, grain, grain.finer(step)));
        self.motion = Some((motion, deviation));
        self
    }

    /// Returns the number of the IK solution whose image begins with a configuration.
    fn solution_of(&self, q: Configuration) -> Option<usize> {
        let apart = |a: f64, b: f64| (a - b).abs().min((a - b - ((a - b) / TAU).round() * TAU).abs());
        let is_same = |part: &&SolutionPart| (0..2).all(|k| apart(part.points[0][k], q[k]) < SAME_SOLUTION);
        self.solutions.iter().find(is_same).map(|part| part.solution)
    }

    /// Determines the magnified part of a workspace whose visible part is `frame`. Without a motion, nothing is magnified.
    pub(crate) fn focus_within(&mut self, frame: [[f64; 2]; 2], arm: &Arm) {
        let Some(pose) = self.pose else { return };
        let ranges = [0, 1].map(|k| <[f64; 2]>::from(span(self.strokes.iter().flatten().map(|p| p[k]))));
        let extents = ranges.map(|[low, high]: [f64; 2]| high - low);
        // The axis along which the line leaves more room.
        let free = usize::from(extents[1] < extents[0]);
        let size = ((1.0 + 2.0 * FOCUS_MARGIN) * extents[1 - free]).max(extents[free] / MAX_LINE_SHARE);
        let whole = (frame[0][1] - frame[0][0]).min(frame[1][1] - frame[1][0]);
        if !(size > 0.0 && size <= MAX_FOCUS_SHARE * whole) {
            return;
        }
        let middle = Point::new((ranges[0][0] + ranges[0][1]) / 2.0, (ranges[1][0] + ranges[1][1]) / 2.0);
        // The directions from which the arm reaches the line.
        let arms = [arm.base, arm.elbow_at(pose[0])].map(|p| (p - middle).normalize());
        let nearness = |corner: &[f64; 2]| {
            arms.iter().map(|arm| arm.x * corner[0] + arm.y * corner[1]).fold(f64::NEG_INFINITY, f64::max)
        };
        let corners = [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0]];
        let corner = corners.into_iter().min_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        self.focus = corner.map(|corner| {
            let magnified = |k: usize| {
                let room = size - extents[k];
                // Along this axis, the overview lies beside the line.
                let beside = if k == free { (OVERVIEW_ROOM * size).max(room / 2.0) } else { room / 2.0 };
                let low = ranges[k][0] - if corner[k] > 0.0 { room - beside } else { beside };
                [low, low + size]
            };
            Focus { ranges: [magnified(0), magnified(1)], corner }
        });
    }

    /// Returns the limits that the motion reaches, in the order of the legend, with names and colours.
    pub(crate) fn limits(&self) -> Vec<(ActiveLimit, String, Rgb)> {
        let Some((motion, _)) = &self.motion else { return Vec::new() };
        let mut limits: Vec<ActiveLimit> = motion.stretches.iter().map(|stretch| stretch.limit).collect();
        limits.sort_unstable();
        limits.dedup();
        limits.into_iter().map(|limit| (limit, self.name(limit), color(limit))).collect()
    }

    fn name(&self, limit: ActiveLimit) -> String {
        let [kind, joint] = match limit {
            ActiveLimit::TipSpeed => return "speed limit of the tip".to_owned(),
            ActiveLimit::WristSpeed => return "speed limit of the wrist".to_owned(),
            ActiveLimit::WristAcceleration => return "acceleration limit of the wrist".to_owned(),
            ActiveLimit::None => return "no limit within 2 %".to_owned(),
            ActiveLimit::JointSpeed(k) => ["speed", &self.names[k]],
            ActiveLimit::JointAcceleration(k) => ["acceleration", &self.names[k]],
            ActiveLimit::JointJerk(k) => ["jerk", &self.names[k]],
        };
        format!("{kind} limit of {joint}")
    }

    /// Returns the name of an IK solution in pictures.
    pub(crate) fn solution_name(&self, solution: usize) -> String {
        let own = || self.solutions.iter().filter(|part| part.solution == solution);
        let note = match (self.used == Some(solution), own().any(|p| p.is_excluded), own().all(|p| p.is_excluded)) {
            (true, ..) => ", used",
            (_, _, true) => ", excluded",
            (_, true, _) => ", partly excluded",
            _ => "",
        };
        format!("IK solution {}{note}", solution + 1)
    }
}

/// Returns the colour of a limit: speeds of joints are blue, accelerations orange, jerks purple.
pub fn color(limit: ActiveLimit) -> Rgb {
    let path = |index: usize| PATH_COLORS[index].0;
    match limit {
        ActiveLimit::TipSpeed => path(2),
        ActiveLimit::JointSpeed(0) => path(0),
        ActiveLimit::JointSpeed(_) => path(5),
        ActiveLimit::JointAcceleration(0) => path(1),
        ActiveLimit::JointAcceleration(_) => path(4),
        ActiveLimit::WristSpeed => path(0).darker(0.45),
        ActiveLimit::WristAcceleration => path(1).darker(0.4),
        ActiveLimit::JointJerk(0) => path(3),
        ActiveLimit::JointJerk(_) => path(3).darker(0.4),
        ActiveLimit::None => GRAY,
    }
}

/// Rounds to nanometres or nanoseconds.
fn fine(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

/// Returns the line for pages. `curves` has the exact curves: each as two ends; as centre, radius, direction and angle; or as
/// four control points. `lens` is the radius of the lens. `smooth` is true if polynomials of degree five join the samples.
pub fn document(line: &LineView, grain: RoundingSteps) -> Object {
    let flat = |curve: &Curve| -> Vec<f64> {
        match *curve {
            Curve::Line { from, to } => [from, to].concat(),
            Curve::Arc { center, radius, from, by, growth: 0.0 } => vec![center[0], center[1], radius, from, by],
            Curve::Arc { center, radius, from, by, growth } => vec![center[0], center[1], radius, from, by, growth],
            Curve::Cubic(points) => points.concat(),
        }
    };
    let exact = |curve| flat(curve).into_iter().map(fine).collect();
    let curves: Vec<Vec<f64>> = line.curves.iter().map(exact).collect();
    let has_curves = line.motion.is_some() && (1..=MAX_EXACT_PIECES).contains(&curves.len());
    let count = line.solutions.iter().map(|part| part.solution + 1).max().unwrap_or(0);
    let solution = |part: &SolutionPart| {
        let points = grain.configurations(&part.points);
        object!("solution": part.solution, "excluded": part.is_excluded, "points": points)
    };
    let mark = |(mark, points): &(MoveMark, Vec<Point>)| (mark.look().0.to_string(), Chain(grain.points(points)));
    object!(
        "strokes": line.strokes.iter().map(|stroke| Chain(grain.points(stroke))).collect::<Vec<_>>(),
        "marked": line.marked.as_ref().map(|marked| marked.iter().map(mark).collect::<Vec<_>>()),
        "curves": has_curves.then_some(curves),
        "tolerance": line.tolerance,
        "lens": LENS_TOLERANCES * line.tolerance,
        "at": line.place.map(|at| grain.point(at)),
        "excluded": line.excluded.iter().map(|&q| grain.configuration(q)).collect::<Vec<_>>(),
        "solutions": line.solutions.iter().map(solution).collect::<Vec<_>>(),
        "names": (0..count).map(|solution| line.solution_name(solution)).collect::<Vec<_>>(),
        "motion": line.motion.as_ref().map(|(motion, deviation)| motion_document(line, motion, *deviation)),
        "focus": line.focus,
        "smooth": line.is_smooth.then_some(true),
    )
}

/// Returns the motion for pages:
/// - `deviation`: the proven bound on the distance from the line.
/// - `farthest`: time and distance of the position that is farthest from the line.
/// - `stretches`: the ends of each stretch, and the index of its limit.
/// - `deviations`: least and greatest distance in equal intervals of time, positive to the left, in thousandths of the tolerance.
fn motion_document(line: &LineView, motion: &FollowedMotion, deviation: f64) -> Object {
    let limits = line.limits();
    let index = |limit: ActiveLimit| limits.iter().position(|(known, ..)| *known == limit).unwrap_or_default();
    let share = |offset: f64| (1000.0 * offset / line.tolerance).round() as i64;
    let point = |&[time, speed]: &[f64; 2]| Configuration::new((time * 1e4).round() / 1e4, (speed * 1e5).round() / 1e5);
    let stretch = |stretch: &Stretch| ((stretch.to * 1e5).round() / 1e5, index(stretch.limit));
    object!(
        "deviation": deviation,
        "farthest": [motion.farthest.time, motion.farthest.offset].map(fine),
        "limits": limits.iter().map(|(_, name, color)| (name, color.to_string())).collect::<Vec<_>>(),
        "stretches": motion.stretches.iter().map(stretch).collect::<Vec<_>>(),
        "stops": motion.stops.iter().map(|time| fine(*time)).collect::<Vec<_>>(),
        "deviations": motion.deviations.iter().map(|ends| ends.map(share)).collect::<Vec<_>>(),
        "speeds": Chain(motion.speeds.iter().map(point).collect()),
    )
}
