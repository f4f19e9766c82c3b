//! What is asked, also where start or goal is not free, and the same with less in the way.

use super::element::{Element, Side, widened};
use cplan_core::check::{CertifiedPath, CheckedProof};
use cplan_core::model::{Arm, Goal, JointType, MotionProblem, Outcome, Scene, Workspace, area_goals, inverse};
use cplan_core::space::{Configuration, GoalSet, Segment};
use cplan_geometry::{Convex, Point};
use cplan_interrupt::{Instant, Interrupt};
use cplan_solver::decide;
use std::f64::consts::TAU;
use std::time::Duration;

/// The clearance among some of what is in the way where the world asks for less, or that is left out, metres: what passes through less passes by
/// luck. Without any, what passes nothing but obstacles as thin as a line could be shown neither to be a way nor to be none, by boxes. Of arms that
/// reach less than a metre this share of their reach.
pub const HARDLY_ANY: f64 = 1e-6;

/// Time for an explanation once it is known whether there is a motion, unless more is asked for. Most take tenths of a second.
pub const TIME_LIMIT: Duration = Duration::from_secs(5);

/// What is to be reached.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// Any of these configurations.
    Goals(GoalSet),
    /// Any configuration that puts the tip here: with less in the way these may be more.
    Tip(Point),
}

impl Target {
    /// Any of some goals of an arm.
    fn of_goals(goals: &[Goal], arm: &Arm, start: Configuration) -> Self {
        let goals: Vec<Goal> = goals.iter().map(|goal| goal.of_arm(arm)).collect();
        if let [Goal::Tip(tip)] = goals[..] {
            return Self::Tip(tip);
        }
        let pieces = goals.into_iter().flat_map(|goal| match goal {
            Goal::Joints(q) => vec![Segment::point(q)],
            Goal::Tip(tip) => inverse(arm, tip, start).solutions(arm),
            Goal::Area(area) => area_goals(arm, area, start).pieces().to_vec(),
        });
        Self::Goals(pieces.collect())
    }
}

/// A motion that is asked for. Unlike those of a [`MotionProblem`] its start and goals may be blocked, outside the limits, or out of reach.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    scene: Scene,
    start: Configuration,
    target: Target,
    /// How far the joints go beyond a limit that is left out: the same however much else is left out.
    beyond: [f64; 2],
    /// The least clearance when something is left out: [`HARDLY_ANY`], if start and goals keep it.
    least_clearance: f64,
    /// Time for all decisions together; none for as long as they take.
    time_limit: Option<Duration>,
    /// When that time is up, once its clock runs.
    deadline: Option<Instant>,
}

impl From<&MotionProblem> for Question {
    fn from(problem: &MotionProblem) -> Self {
        let target = Target::Goals(problem.goals().clone());
        Self::new(problem.scene().clone(), problem.start(), target)
    }
}

impl From<GoalSet> for Target {
    fn from(goals: GoalSet) -> Self {
        Self::Goals(goals)
    }
}

impl Question {
    /// A motion from a start to a target. Neither needs to be free.
    #[must_use]
    pub fn new(scene: Scene, start: Configuration, target: impl Into<Target>) -> Self {
        let target = target.into();
        let beyond = beyond(&scene, start, &target);
        let asked = Self { scene, start, target, beyond, least_clearance: 0.0, time_limit: None, deadline: None };
        let hardly_any = HARDLY_ANY * asked.scene.arm().reach().min(1.0);
        let kept = asked.with_clearance(asked.scene.workspace().clearance.max(hardly_any));
        let keeps = kept.is_free(start) == asked.is_free(start) && kept.goals() == asked.goals();
        Self { least_clearance: if keeps { hardly_any } else { 0.0 }, ..asked }
    }

    /// A motion from a start to any of some goals. None needs to be free.
    #[must_use]
    pub fn of_goals(scene: Scene, start: Configuration, goals: &[Goal]) -> Self {
        let target = Target::of_goals(goals, scene.arm(), start);
        Self::new(scene, start, target)
    }

    /// The same question, explained in at most this time, whose clock starts when it is known whether there is a motion. What is not decided by then
    /// is unknown, so that the answer may depend on the machine.
    #[must_use]
    pub fn with_time_limit(self, limit: Duration) -> Self {
        Self { time_limit: Some(limit), ..self }
    }

    /// Time for an explanation; none if it takes as long as it takes.
    #[must_use]
    pub fn time_limit(&self) -> Option<Duration> {
        self.time_limit
    }

    /// The same question, the clock of whose time limit runs from now on.
    pub(super) fn started(&self) -> Self {
        let deadline = self.time_limit.map(|limit| Instant::now() + limit);
        Self { deadline, ..self.clone() }
    }

    /// Does `work`; none if the time is up before it is done.
    pub(super) fn in_time<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        match self.deadline {
            Some(deadline) => Interrupt::new().by(deadline).run(work).ok(),
            None => Some(work()),
        }
    }

    /// Whether the time is up.
    pub(super) fn is_out_of_time(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Arm and obstacles.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where the arm begins.
    #[must_use]
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// What is to be reached.
    #[must_use]
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// Whether a configuration is within the limits and free.
    #[must_use]
    pub fn is_free(&self, q: Configuration) -> bool {
        self.scene.arm().topology().contains(q) && self.scene.obstructions(q).is_empty()
    }

    /// All configurations of the target within the limits, free or not.
    #[must_use]
    pub fn ends(&self) -> Vec<Segment> {
        let topology = self.scene.arm().topology();
        match &self.target {
            Target::Goals(goals) => {
                let within = |piece: &&Segment| piece.ends().into_iter().all(|q| topology.contains(q));
                goals.pieces().iter().filter(within).copied().collect()
            }
            Target::Tip(tip) => inverse(self.scene.arm(), *tip, self.start).solutions(self.scene.arm()),
        }
    }

    /// Those that are not known to be blocked.
    #[must_use]
    pub fn goals(&self) -> GoalSet {
        let open = |piece: &Segment| match piece.is_point() {
            true => self.scene.obstructions(piece.ends()[0]).is_empty(),
            false => self.scene.blocked_along(piece).is_none(),
        };
        self.ends().into_iter().filter(open).collect()
    }

    /// The problem, if start and some goal are free.
    #[must_use]
    pub fn problem(&self) -> Option<MotionProblem> {
        let goals = self.goals();
        (self.is_free(self.start) && !goals.is_empty())
            .then(|| MotionProblem::trusted(self.scene.clone(), self.start, goals))
    }

    /// By slabs and boxes, of these no more than so many.
    #[must_use]
    pub fn answer(&self, boxes: usize) -> Outcome<CertifiedPath, Option<CheckedProof>> {
        let Some(problem) = self.problem() else { return Outcome::Infeasible(None) };
        match self.in_time(|| decide(&problem, boxes)) {
            None => Outcome::Unknown("the time is up".into()),
            Some(Outcome::Found(path)) => Outcome::Found(path),
            Some(Outcome::Infeasible(proof)) => Outcome::Infeasible(Some(proof)),
            Some(Outcome::Unknown(reason)) => Outcome::Unknown(reason),
        }
    }

    /// How far a joint goes beyond a limit that is left out, radians or metres: a whole turn, or past all that there is, and in any case as far as
    /// start and goals ask for.
    #[must_use]
    pub fn beyond(&self, joint: usize) -> f64 {
        self.beyond[joint]
    }

    /// The same without some of what is in the way: no such obstacles; no such limits of joints (see [`Question::beyond`]); no
    /// clearance. At least [`HARDLY_ANY`] is kept, if start and goals do. All else keeps its number, so that a proof which names nothing of it holds in both.
    #[must_use]
    pub fn without(&self, elements: &[Element]) -> Self {
        self.just_without(elements).rebuilt(|_, workspace| {
            workspace.clearance = workspace.clearance.max(self.least_clearance);
        })
    }

    /// The same as [`Question::without`], but with the world's clearance however small it is. What is said of lengths is about this one: to keep a
    /// little more than the world asks for makes paths longer, so that a lower bound of that question is none of this one.
    #[must_use]
    pub fn just_without(&self, elements: &[Element]) -> Self {
        self.rebuilt(|arm, workspace| {
            for element in elements {
                match *element {
                    Element::Obstacle { number } => workspace.obstacles[number].pieces.clear(),
                    Element::Link { number } => {
                        let name = &self.scene.obstacle(number).name;
                        let layers = arm.self_obstacles.iter_mut().filter(|own| own.obstacle.name == *name);
                        layers.for_each(|own| own.obstacle.pieces.clear());
                    }
                    Element::Limit { joint, side } => {
                        arm.joints[joint].range = widened(arm.joints[joint].range, side, self.beyond[joint]);
                    }
                    Element::Clearance => workspace.clearance = 0.0,
                }
            }
        })
    }

    /// The same with other pieces for an obstacle.
    pub(super) fn with_pieces(&self, number: usize, pieces: Vec<Convex>) -> Self {
        self.rebuilt(|_, workspace| workspace.obstacles[number].pieces = pieces)
    }

    /// The same with a joint that moves farther.
    pub(super) fn with_wider(&self, joint: usize, side: Side, by: f64) -> Self {
        self.rebuilt(|arm, _| arm.joints[joint].range = widened(arm.joints[joint].range, side, by))
    }

    /// The same with another distance to keep.
    pub(super) fn with_clearance(&self, clearance: f64) -> Self {
        self.rebuilt(|_, workspace| workspace.clearance = clearance)
    }

    pub(super) fn rebuilt(&self, edit: impl FnOnce(&mut Arm, &mut Workspace)) -> Self {
        Self { scene: self.scene.changed(edit), target: self.target.clone(), ..*self }
    }
}

/// How far the joints go beyond limits that are left out.
fn beyond(scene: &Scene, start: Configuration, target: &Target) -> [f64; 2] {
    let arm = scene.arm();
    let (asked, tip) = match target {
        Target::Goals(goals) => (goals.pieces().iter().flat_map(Segment::ends).chain([start]).collect(), arm.base),
        Target::Tip(tip) => (vec![start], *tip),
    };
    [0, 1].map(|k| {
        let (joint, values) = (&arm.joints[k], asked.iter().map(|q| q[k]));
        let (lower, upper) = joint.range.domain();
        let outside = values.map(|value| (lower - value).max(value - upper)).fold(0.0, f64::max);
        match joint.joint_type.is_revolute() {
            true => TAU * (1.0 + (outside / TAU).ceil()),
            false => (farthest(scene) + 2.0 * (tip - arm.base).norm()) / crossing(arm) + outside,
        }
    })
}

/// Two slides whose directions cross by less than this angle, radians, go along one line.
const ONE_LINE: f64 = 1e-3;

/// The sine of the angle between two slides, by which each has to go the farther to leave something behind beside the other; 1 of other arms,
/// and of slides along one line, which leave nothing beside it.
fn crossing(arm: &Arm) -> f64 {
    let across = match arm.joints.each_ref().map(|joint| joint.joint_type) {
        [JointType::Prismatic { direction: a }, JointType::Prismatic { direction: b }] => a.perp(&b).abs(),
        _ => 1.0,
    };
    if across < ONE_LINE { 1.0 } else { across }
}

/// How far a joint slides that has left all obstacles behind, wherever it begins.
pub(super) fn farthest(scene: &Scene) -> f64 {
    let base = scene.arm().base;
    let pieces = scene.workspace().obstacles.iter().flat_map(|obstacle| &obstacle.pieces);
    let across = pieces.map(|piece| piece.reach_from(base)).fold(0.0, f64::max);
    2.0 * (across + scene.arm().reach())
}
