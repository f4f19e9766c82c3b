//! Safe travels: planned in joint space, and written as straight lines in the plane.
//!
//! The planner uses the configurations of one IK solution only: the range of joint 2 ends where both solutions meet. So
//! a proof that there is no path holds for the machine, too. The path is divided until the machine can play the
//! straight lines between its places. Paths with margins to obstacles and limits need few lines, so they are tried
//! first. Before any planning, the places of earlier travels are tried.

use crate::Frame;
use crate::fault::{Cause, Fault};
use crate::player::Player;
use crate::written::Grid;
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_model::space::{Configuration, GoalSet, JointRange, Path, Segment};
use cplan_model::{JointType, MotionProblem, MotionProblemError, Outcome};
use cplan_solver::{Options, solve};
use cplan_toolpath::{Curve, Modes, ProgramMove};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Shares of the margins below, in the order in which they are tried. Only an answer without margins can prove that
/// there is no travel.
const MARGIN_SHARES: [f64; 4] = [1.0, 0.2, 0.02, 0.0];

/// Extra clearance to try, as a share of the arm's reach.
const EXTRA_CLEARANCE: f64 = 0.03;

/// Greatest extra clearance, as a share of the room that the ends of a travel have beyond the required clearance.
const END_SHARE: f64 = 0.5;

/// Margin to joint limits and singular places, radians or metres.
const LIMIT_MARGIN: f64 = 0.1;

/// Greatest number of lines of a travel.
const MAX_LINES: usize = 200;

/// Shortest part of a path that may become a line, as a share of the path.
const MIN_SHARE: f64 = 1e-4;

/// Greatest difference between joint values on the path and those at the end of a line, radians or metres. A greater
/// one means that the number of whole turns differs.
const SAME_TURN: f64 = 0.1;

/// Number of planned travels whose places may be used again.
const MAX_KNOWN: usize = 16;

/// A travel that must be replaced.
pub(crate) struct Travel<'a> {
    pub own: &'a ProgramMove,
    /// The reason why the machine cannot play it.
    pub fault: &'a Fault,
    pub start: Configuration,
    /// Possible joint values at its end. There are several if the range of a joint exceeds a turn.
    pub goals: Vec<Configuration>,
}

/// A search for safe travels.
pub(crate) struct Detours<'a> {
    player: &'a Player<'a>,
    frame: Frame,
    /// Places of the travels that were planned so far, without their ends.
    known: Vec<Vec<Point>>,
}

/// The places of a travel, and the joint values at its end.
type Found = (Vec<Point>, Configuration);

impl<'a> Detours<'a> {
    pub fn new(player: &'a Player<'a>, frame: Frame) -> Self {
        Self { player, frame, known: Vec::new() }
    }

    /// Plans a safe travel.
    ///
    /// # Errors
    /// No safe travel was found; the fault states whether this is proven.
    pub fn plan(&mut self, travel: &Travel) -> Result<Found, Fault> {
        if let Some(found) = self.along_known(travel) {
            return Ok(found);
        }
        for share in MARGIN_SHARES {
            checkpoint();
            let problem = match self.problem(travel, share) {
                Ok(problem) => problem,
                Err(blocked) if share == 0.0 => return Err(blocked),
                Err(_) => continue,
            };
            let options = Options { bounded: false, ..Options::default() };
            let path = match solve(&problem, &options, &mut |_| ()).outcome {
                Outcome::Found(found) => Some(found.certified),
                Outcome::Infeasible(_) if share == 0.0 => return Err(no_travel(travel, true)),
                Outcome::Infeasible(_) => None,
                Outcome::Unknown(unknown) => unknown.witness,
            };
            if let Some(found) = path.and_then(|path| self.lines(travel.own, path.path())) {
                let (_, inner) = found.0.split_last().expect("a travel has an end");
                self.known.insert(0, inner.to_vec());
                self.known.truncate(MAX_KNOWN);
                return Ok(found);
            }
        }
        Err(no_travel(travel, false))
    }

    /// Returns the problem in joint space, with a share of all margins.
    ///
    /// # Errors
    /// An end that is not free.
    fn problem(&self, travel: &Travel, share: f64) -> Result<MotionProblem, Fault> {
        let (scene, arm) = (self.player.scene, self.player.kinematics.arm);
        let mut ranges = [arm.joints[0].range, self.side(travel.start[1])];
        let ends = || travel.goals.iter().chain([&travel.start]);
        for (k, range) in ranges.iter_mut().enumerate() {
            if let JointRange::Interval { lower, upper } = range {
                let inner = [*lower, *upper];
                // Ends that exceed a limit by rounding are set to the limit.
                let within = |q: &Configuration| q[k].clamp(inner[0], inner[1]);
                *lower = ends().map(within).fold(inner[0] + share * LIMIT_MARGIN, f64::min);
                *upper = ends().map(within).fold(inner[1] - share * LIMIT_MARGIN, f64::max);
            }
        }
        let required = scene.workspace().clearance;
        let room = ends().map(|q| scene.clearance(*q) - required).fold(f64::INFINITY, f64::min);
        let extra = share * (EXTRA_CLEARANCE * arm.reach()).min(END_SHARE * room.max(0.0));
        let curve = &travel.own.piece.curve;
        let blocked = |place: [f64; 2], reason: String| Fault {
            cause: Cause::Collision,
            reason,
            place: place.into(),
            is_proven: true,
        };
        let mut scene = scene
            .clone()
            .with_clearance(required + extra)
            .map_err(|error| Fault::undecided(curve.start().into(), error.to_string()))?;
        for (joint, range) in scene.arm_mut().joints.iter_mut().zip(ranges) {
            joint.range = range;
        }
        let within = |q: &Configuration| Configuration::from_fn(|k, _| ranges[k].clamp(q[k]));
        let (start, goals) = (within(&travel.start), travel.goals.iter().map(within).collect::<Vec<_>>());
        // If clamping changes a goal by more than rounding, the goal has another number of whole turns of joint 2. Omit it.
        let is_near = |(goal, stated): &(&Configuration, &Configuration)| (**goal - **stated).amax() < SAME_TURN;
        let goals: GoalSet =
            goals.iter().zip(&travel.goals).filter(is_near).map(|(goal, _)| Segment::point(*goal)).collect();
        MotionProblem::new(scene, start, goals).map_err(|error| match error {
            MotionProblemError::StartBlocked { why } => {
                blocked(curve.start(), format!("the start of the travel is not free: {why}"))
            }
            MotionProblemError::GoalBlocked { why, .. } => {
                blocked(curve.end(), format!("the end of the travel is not free: {why}"))
            }
            error => Fault::undecided(curve.start().into(), error.to_string()),
        })
    }

    /// Returns the range of joint 2 on the current side of the place where both IK solutions meet. It contains `q2`, up
    /// to rounding.
    fn side(&self, q2: f64) -> JointRange {
        use JointType::{Prismatic, Revolute};
        let arm = self.player.kinematics.arm;
        let side = if self.player.solution == 0 { 1.0 } else { -1.0 };
        let angle = |v: Point| v.y.atan2(v.x);
        let half_turn = |middle: f64| {
            let middle = middle + ((q2 - middle) / TAU).round() * TAU;
            [middle - FRAC_PI_2, middle + FRAC_PI_2]
        };
        let range = arm.joints[1].range;
        let [low, high] = match arm.joints.each_ref().map(|joint| joint.joint_type) {
            [Revolute { .. }, Revolute { sign }] => {
                half_turn(sign * (angle(arm.offset) - angle(arm.tip) + side * FRAC_PI_2))
            }
            [Prismatic { direction }, Revolute { sign }] => {
                half_turn(sign * (angle(direction * -side) - angle(arm.tip)))
            }
            [Revolute { .. }, Prismatic { direction }] => {
                let middle = -(arm.offset + arm.tip).dot(&direction);
                if side > 0.0 { [middle, f64::INFINITY] } else { [f64::NEG_INFINITY, middle] }
            }
            [Prismatic { .. }, Prismatic { .. }] => return range,
        };
        match range {
            JointRange::Circle => JointRange::Interval { lower: low, upper: high },
            JointRange::Interval { lower, upper } => {
                JointRange::Interval { lower: lower.max(low), upper: upper.min(high) }
            }
        }
    }

    /// Divides a path until the machine can play the straight lines between its places.
    fn lines(&self, own: &ProgramMove, path: &Path) -> Option<Found> {
        let (grid, length) = (Grid::new(&own.modes, self.frame), path.length());
        let end = Point::from(own.piece.curve.end());
        let arm = self.player.kinematics.arm;
        let (mut from, mut at) = (Point::from(own.piece.curve.start()), path.start());
        let (mut done, mut open, mut points) = (0.0, vec![length], vec![(from, at)]);
        while let Some(next) = open.pop() {
            checkpoint();
            let q = path.part(0.0, next).goal();
            let to = if next >= length { end } else { grid.nearest(arm.tip_at(q)) };
            let reached = self.line(own, [from, to], at).filter(|reached| (reached - q).amax() <= SAME_TURN);
            if let Some(reached) = reached {
                (from, at, done) = (to, reached, next);
                points.push((from, at));
            } else if next - done < MIN_SHARE * length || points.len() + open.len() > MAX_LINES {
                return None;
            } else {
                open.extend([next, (done + next) / 2.0]);
            }
        }
        Some(self.fewer(own, &points))
    }

    /// Removes places as long as the machine can play the lines between the others.
    fn fewer(&self, own: &ProgramMove, points: &[(Point, Configuration)]) -> Found {
        let (mut kept, mut from) = (Vec::new(), 0);
        while from + 1 < points.len() {
            let ((place, at), mut to) = (points[from], points.len() - 1);
            let leads = |to: usize| {
                let reached = self.line(own, [place, points[to].0], at);
                reached.is_some_and(|reached| (reached - points[to].1).amax() <= SAME_TURN)
            };
            while to > from + 1 && !leads(to) {
                to -= (to - from).div_ceil(2).max(1).min(to - from - 1);
            }
            kept.push(points[to].0);
            from = to;
        }
        (kept, points[points.len() - 1].1)
    }

    /// Plays a straight travel from given joint values. Returns the joint values at its end. `None` if the machine
    /// cannot play it.
    fn line(&self, own: &ProgramMove, [from, to]: [Point; 2], at: Configuration) -> Option<Configuration> {
        let curve = Curve::Line { from: from.into(), to: to.into() };
        // Which line gets the word Z is known only when the program is written. It is then judged again.
        let modes = Modes { words: Default::default(), ..own.modes.clone() };
        let swept = self.player.play(&curve, &modes).ok()?;
        let turns = self.player.kinematics.near(swept.start, at) - swept.start;
        let swept = swept.turned(turns);
        let is_within = (0..2).all(|k| match self.player.kinematics.arm.joints[k].range {
            JointRange::Circle => true,
            JointRange::Interval { lower, upper } => {
                let room = crate::player::LIMIT_ROUNDING;
                swept.low[k] >= lower - room && swept.high[k] <= upper + room
            }
        });
        (is_within && (swept.start - at).amax() <= SAME_TURN).then_some(swept.end)
    }

    /// Returns a travel along places of an earlier one. `None` if the machine can play none.
    fn along_known(&self, travel: &Travel) -> Option<Found> {
        let [from, to] = [travel.own.piece.curve.start(), travel.own.piece.curve.end()].map(Point::from);
        let is_goal = |q: &Configuration| travel.goals.iter().any(|goal| (goal - q).amax() <= SAME_TURN);
        let grid = Grid::new(&travel.own.modes, self.frame);
        let places = |known: &Vec<Point>| known.iter().map(|place| grid.nearest(*place)).collect::<Vec<_>>();
        let forward = self.known.iter().map(places);
        let backward = self.known.iter().map(|known| places(known).into_iter().rev().collect());
        forward.chain(backward).find_map(|known: Vec<Point>| {
            let parts = (1..=known.len()).flat_map(|count| (0..=known.len() - count).map(move |first| (first, count)));
            parts.into_iter().find_map(|(first, count)| {
                let mut points = known[first..first + count].to_vec();
                points.push(to);
                let mut at = travel.start;
                let mut place = from;
                for next in &points {
                    at = self.line(travel.own, [place, *next], at)?;
                    place = *next;
                }
                is_goal(&at).then_some((points, at))
            })
        })
    }
}

fn no_travel(travel: &Travel, is_proven: bool) -> Fault {
    let reason = match is_proven {
        true => format!("{}, and no safe travel exists", travel.fault.reason),
        false => {
            format!("{}; neither a safe travel nor a proof that none exists was found", travel.fault.reason)
        }
    };
    Fault { cause: Cause::NoTravel, reason, place: travel.fault.place, is_proven }
}
