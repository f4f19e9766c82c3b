//! Motion queries whose start or goal may be blocked, and the same queries with fewer elements in the world.

use super::element::{Element, Side, widened};
use cplan_geometry::{Convex, Point};
use cplan_interrupt::{Instant, Interrupt};
use cplan_judge::{CertifiedPath, CheckedProof};
use cplan_legs::{FailedStep, Standstill, StandstillScene};
use cplan_model::space::{Configuration, GoalSet, Segment};
use cplan_model::{Arm, Elbow, Goal, JointType, MotionProblem, Outcome, Scene, Workspace, area_goals, inverse};
use cplan_solver::decide;
use serde::Serialize;
use std::f64::consts::TAU;
use std::time::Duration;

/// Least clearance in a world without some of its elements, in metres, if the world requires less or the clearance itself is
/// removed. A path through a narrower gap would exist only by chance. Without any clearance, boxes could neither prove nor refute
/// a path past an obstacle as thin as a line. For arms that reach less than a metre, the least clearance is this fraction of
/// their reach.
pub const MIN_CLEARANCE: f64 = 1e-6;

/// Default time limit of an explanation, from the moment at which it is known whether there is a motion. Most explanations take
/// tenths of a second.
pub const TIME_LIMIT: Duration = Duration::from_secs(5);

/// One of the two ends of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The start of the motion.
    Start,
    /// The goal of the motion.
    Goal,
}

/// The target of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// Any of these configurations.
    Goals(GoalSet),
    /// Any configuration that puts the tip at this place, with the elbow on the stated side. In a world with fewer elements,
    /// there may be more of them.
    Tip(Point, Option<Elbow>),
}

impl Target {
    /// Converts the goals of an arm to one target.
    fn of_goals(goals: &[Goal], arm: &Arm, start: Configuration) -> Self {
        let goals: Vec<Goal> = goals.iter().map(|goal| goal.of_arm(arm)).collect();
        if let [goal @ (Goal::Tip(tip) | Goal::TipAndElbow(tip, _))] = goals[..] {
            return Self::Tip(tip, goal.elbow());
        }
        let pieces = goals.into_iter().flat_map(|goal| match goal {
            Goal::Joints(q) => vec![Segment::point(q)],
            Goal::Tip(tip) | Goal::TipAndElbow(tip, _) => {
                inverse(arm, tip, start).with_elbow(arm, goal.elbow()).solutions(arm)
            }
            Goal::Area(area) => area_goals(arm, area, start).pieces().to_vec(),
        });
        Self::Goals(pieces.collect())
    }
}

/// A query for a motion. In contrast to a [`MotionProblem`], its start and goals may be blocked, outside the limits or out of
/// reach.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionQuestion {
    scene: Scene,
    start: Configuration,
    target: Target,
    /// Standstills at the start and at goals.
    standstills: [Vec<Standstill>; 2],
    /// Distance by which each joint may exceed a removed limit, in radians or metres. It does not depend on other removed
    /// elements.
    beyond: [f64; 2],
    /// Least clearance in a world without some elements: [`MIN_CLEARANCE`], or 0 if start and goals are nearer to obstacles.
    least_clearance: f64,
    /// Time limit for all decisions together. `None` for no limit.
    time_limit: Option<Duration>,
    /// Time at which the limit is reached. `None` until the clock is started.
    deadline: Option<Instant>,
}

impl From<&MotionProblem> for MotionQuestion {
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

impl MotionQuestion {
    /// Creates a query for a motion from a start to a target. Both may be blocked.
    pub fn new(scene: Scene, start: Configuration, target: impl Into<Target>) -> Self {
        let target = target.into();
        let beyond = margins_beyond_limits(&scene, start, &target);
        let standstills = [Vec::new(), Vec::new()];
        let asked =
            Self { scene, start, target, standstills, beyond, least_clearance: 0.0, time_limit: None, deadline: None };
        asked.with_least_clearance()
    }

    /// Returns the question of a failed step of a task, whose motion leads from the arm's configuration to the IK solutions that
    /// were tried. At both ends, the arm must also be free while the tool is lowered.
    pub fn of_failed_step(failed: &FailedStep) -> Self {
        let goals: GoalSet = failed.ik_solutions.iter().map(|refused| Segment::point(refused.ik_solution)).collect();
        Self::new((*failed.scene).clone(), failed.from, goals).with_standstills(failed.standstills.clone())
    }

    /// Adds standstills at the start and at goals. If a goal has several standstills, one of them must be free.
    #[must_use]
    pub fn with_standstills(self, standstills: [Vec<Standstill>; 2]) -> Self {
        Self { standstills, ..self }.with_least_clearance()
    }

    fn with_least_clearance(self) -> Self {
        let hardly_any = MIN_CLEARANCE * self.scene.arm().reach().min(1.0);
        let kept = self.with_clearance(self.scene.workspace().clearance.max(hardly_any));
        let keeps = kept.is_start_free() == self.is_start_free() && kept.goals() == self.goals();
        Self { least_clearance: if keeps { hardly_any } else { 0.0 }, ..self }
    }

    /// Creates a query for a motion from a start to any of some goals. The goals may be blocked.
    pub fn of_goals(scene: Scene, start: Configuration, goals: &[Goal]) -> Self {
        let target = Target::of_goals(goals, scene.arm(), start);
        Self::new(scene, start, target)
    }

    /// Sets a time limit for the explanation, from the moment at which it is known whether there is a motion. A decision that is
    /// not reached in time stays unknown, so the explanation may depend on the machine.
    #[must_use]
    pub fn with_time_limit(self, limit: Duration) -> Self {
        Self { time_limit: Some(limit), ..self }
    }

    /// Returns the time limit of an explanation. `None` for no limit.
    pub fn time_limit(&self) -> Option<Duration> {
        self.time_limit
    }

    /// Returns the question with its clock started.
    pub fn started(&self) -> Self {
        let deadline = self.time_limit.map(|limit| Instant::now() + limit);
        Self { deadline, ..self.clone() }
    }

    /// Returns the result of `work`. `None` if the time is up before the result is known.
    pub fn within_time_limit<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        match self.deadline {
            Some(deadline) => Interrupt::new().with_deadline(deadline).run(work).ok(),
            None => Some(work()),
        }
    }

    /// Returns true if the time is up.
    pub fn is_out_of_time(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Returns the scene of arm and obstacles.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the start.
    pub fn start(&self) -> Configuration {
        self.start
    }

    /// Returns the target.
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// Returns true if the start is within the limits and free, also for standstills there.
    pub fn is_start_free(&self) -> bool {
        let is_free =
            self.scene.arm().topology().contains(self.start) && self.scene.obstructions(self.start).is_empty();
        is_free && self.blocked_standstill(End::Start, self.start).is_none()
    }

    /// Returns the scene in which a standstill at an end of the motion is blocked, although the motion itself may end there.
    /// `None` if the standstill is free.
    pub fn blocked_standstill(&self, end: End, q: Configuration) -> Option<&StandstillScene> {
        let standing = self.standstills[end as usize].iter().filter(|standing| standing.at == q);
        let blocked: Vec<_> = standing.map(|standing| Some(&standing.scenes[standing.blocked_scene()?])).collect();
        // Another standstill at the same configuration may be free.
        blocked.into_iter().collect::<Option<Vec<_>>>()?.first().copied()
    }

    /// Returns all elements that may block the motion or a standstill, in the order of [`Element::all`].
    pub fn elements(&self) -> Vec<Element> {
        let mut all = Element::all(&self.scene);
        let standing = self.standstills.iter().flatten().flat_map(|standing| &standing.scenes);
        for element in standing.flat_map(|standing| Element::all(&standing.scene)) {
            if !all.contains(&element) {
                all.push(element);
            }
        }
        all.sort_by_key(|element| element.obstacle());
        all
    }

    /// Returns all configurations of the target within the limits, blocked or not.
    pub fn ends(&self) -> Vec<Segment> {
        let topology = self.scene.arm().topology();
        match &self.target {
            Target::Goals(goals) => {
                let within = |piece: &&Segment| piece.ends().into_iter().all(|q| topology.contains(q));
                goals.pieces().iter().filter(within).copied().collect()
            }
            Target::Tip(tip, elbow) => {
                let arm = self.scene.arm();
                inverse(arm, *tip, self.start).with_elbow(arm, *elbow).solutions(arm)
            }
        }
    }

    /// Returns the goals within the limits that are not known to be blocked.
    pub fn goals(&self) -> GoalSet {
        let is_open = |q| self.scene.obstructions(q).is_empty() && self.blocked_standstill(End::Goal, q).is_none();
        let open = |piece: &Segment| match piece.is_point() {
            true => is_open(piece.ends()[0]),
            false => self.scene.blocked_along(piece).is_none(),
        };
        self.ends().into_iter().filter(open).collect()
    }

    /// Returns the motion problem. `None` unless the start and at least one goal are free.
    pub fn problem(&self) -> Option<MotionProblem> {
        let goals = self.goals();
        (self.is_start_free() && !goals.is_empty())
            .then(|| MotionProblem::trusted(self.scene.clone(), self.start, goals))
    }

    /// Decides the question by slabs and at most `boxes` boxes.
    pub fn answer(&self, boxes: usize) -> Outcome<CertifiedPath, Option<CheckedProof>> {
        let Some(problem) = self.problem() else { return Outcome::Infeasible(None) };
        match self.within_time_limit(|| decide(&problem, boxes)) {
            None => Outcome::Unknown("the time is up".into()),
            Some(Outcome::Found(path)) => Outcome::Found(path),
            Some(Outcome::Infeasible(proof)) => Outcome::Infeasible(Some(proof)),
            Some(Outcome::Unknown(reason)) => Outcome::Unknown(reason),
        }
    }

    /// Returns the distance by which a joint may exceed a removed limit, in radians or metres. It is at least a whole turn for a
    /// revolute joint, suffices for a prismatic joint to pass all obstacles, and includes start and goals.
    pub fn margin_beyond_limit(&self, joint: usize) -> f64 {
        self.beyond[joint]
    }

    /// Returns the question without some of its elements. A wider limit replaces a removed one, see
    /// [`MotionQuestion::margin_beyond_limit`]. The clearance is at least [`MIN_CLEARANCE`], unless start or goals are nearer to
    /// obstacles. The other elements keep their indices, so a proof that names no removed element is valid for both questions.
    #[must_use]
    pub fn without(&self, elements: &[Element]) -> Self {
        self.without_at_clearance(elements).rebuilt(|_, workspace| {
            workspace.set_clearance(workspace.clearance.max(self.least_clearance));
        })
    }

    /// Does the same as [`MotionQuestion::without`], but with the world's own clearance, however small. For statements about
    /// lengths: a larger clearance makes paths longer, so a lower bound would not be valid for this question.
    #[must_use]
    pub fn without_at_clearance(&self, elements: &[Element]) -> Self {
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
                    Element::Motor => arm.motors.iter_mut().for_each(|motors| motors.range = None),
                    Element::Clearance => workspace.limit_clearances(0.0),
                }
            }
        })
    }

    /// Returns the question with the pieces of one obstacle replaced.
    pub fn with_pieces(&self, number: usize, pieces: Vec<Convex>) -> Self {
        self.rebuilt(|_, workspace| workspace.obstacles[number].pieces.clone_from(&pieces))
    }

    /// Returns the question with one end of a joint's range moved outwards.
    pub fn with_wider(&self, joint: usize, side: Side, by: f64) -> Self {
        self.rebuilt(|arm, _| arm.joints[joint].range = widened(arm.joints[joint].range, side, by))
    }

    /// Returns the question with another clearance of the world.
    pub fn with_clearance(&self, clearance: f64) -> Self {
        self.rebuilt(|_, workspace| workspace.set_clearance(clearance))
    }

    /// Returns the question with at most this clearance from every obstacle.
    pub fn with_clearance_at_most(&self, clearance: f64) -> Self {
        self.rebuilt(|_, workspace| workspace.limit_clearances(clearance))
    }

    /// Applies `edit` to the arm and the workspace of all scenes.
    pub fn rebuilt(&self, edit: impl Fn(&mut Arm, &mut Workspace)) -> Self {
        let standing =
            |standing: &StandstillScene| StandstillScene { scene: standing.scene.changed(&edit), ..*standing };
        let changed =
            |stands: &Standstill| Standstill { scenes: stands.scenes.iter().map(standing).collect(), ..*stands };
        let standstills = self.standstills.each_ref().map(|stands| stands.iter().map(changed).collect());
        Self { scene: self.scene.changed(&edit), target: self.target.clone(), standstills, ..*self }
    }
}

/// Computes the distances by which joints may exceed removed limits.
fn margins_beyond_limits(scene: &Scene, start: Configuration, target: &Target) -> [f64; 2] {
    let arm = scene.arm();
    let (asked, tip) = match target {
        Target::Goals(goals) => (goals.pieces().iter().flat_map(Segment::ends).chain([start]).collect(), arm.base),
        Target::Tip(tip, _) => (vec![start], *tip),
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

/// Prismatic joints whose directions differ by less than this angle, in radians, count as moving along one line.
const PARALLEL_ANGLE: f64 = 1e-3;

/// Returns the sine of the angle between two prismatic joints. The smaller it is, the farther each joint must move to bring the
/// arm past an obstacle beside the other joint's line. Returns 1 for other arms, and for joints along one line, which cannot move
/// the arm sideways.
fn crossing(arm: &Arm) -> f64 {
    let across = match arm.joints.each_ref().map(|joint| joint.joint_type) {
        [JointType::Prismatic { direction: a }, JointType::Prismatic { direction: b }] => a.perp(&b).abs(),
        _ => 1.0,
    };
    if across < PARALLEL_ANGLE { 1.0 } else { across }
}

/// Returns a distance within which a prismatic joint passes all obstacles, from any start.
pub fn farthest(scene: &Scene) -> f64 {
    let base = scene.arm().base;
    let pieces = scene.workspace().obstacles.iter().flat_map(|obstacle| &obstacle.pieces);
    let across = pieces.map(|piece| piece.reach_from(base)).fold(0.0, f64::max);
    2.0 * (across + scene.arm().reach())
}
