//! What is found of a motion, as data.

use super::StepFinding;
use cplan_core::model::{Joint, Scene};
use cplan_handling::{Claims, Recording};
use cplan_motion::recorded::{CollisionCheck, Encounter, Excess, Limit, Moment};
use cplan_robot::AssumedLimits;
use serde::Serialize;

/// What is found in a word, the worst last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Judgement {
    /// Proven free and within all limits that can be judged.
    Free,
    /// Neither proven free nor proven to collide.
    Undecided,
    /// Free, but something that the file says of the motion is false.
    Claims,
    /// Not known to collide, but it does not lead from the start to the goal.
    Ends,
    /// Not known to collide, but a limit is broken.
    Limits,
    /// Not known to collide, but not the task that was asked for.
    Task,
    /// Proven to collide.
    Collision,
}

impl Judgement {
    /// As it is written in JSON.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Judgement::Free => "free",
            Judgement::Collision => "collision",
            Judgement::Limits => "limits",
            Judgement::Undecided => "undecided",
            Judgement::Task => "task",
            Judgement::Ends => "ends",
            Judgement::Claims => "claims",
        }
    }
}

/// What there is to say about a motion, or about the motions of a task.
#[derive(Debug, Clone, Serialize)]
pub struct MotionFindings {
    /// In a word.
    pub verdict: Judgement,
    /// Names of the joints, base to tip.
    pub joints: [String; 2],
    /// Units of the joints' values: `rad` or `m`.
    pub units: [&'static str; 2],
    /// How many samples there are.
    pub samples: usize,
    /// Seconds from the first to the last sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// The distance to keep, metres.
    pub required: f64,
    /// What it meets.
    #[serde(flatten)]
    pub way: WayFinding,
    /// Limits that are broken, each once.
    pub limits_broken: Vec<LimitFinding>,
    /// Limits that nobody gives and that the motion exceeds as cplan assumes them, each once. They do not decide.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub assumed_exceeded: Vec<LimitFinding>,
    /// In what a motion or a task is not the one asked for, and what the file says of it that is false.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<String>,
    /// Members of a result that were not judged.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_judged: Vec<String>,
    /// Of a task.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<Vec<StepFinding>>,
    /// How the file was read and what was judged, line by line.
    pub notes: Vec<String>,
}

/// What a motion meets, or how near it comes.
#[derive(Debug, Clone, Default, Serialize)]
pub struct WayFinding {
    /// Proven lower bound on the distance to every obstacle, metres; only of a free motion that could hit something.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Where a free motion comes nearest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest: Option<EncounterFinding>,
    /// Where a motion that collides first does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_contact: Option<EncounterFinding>,
    /// The motion before this is proven free, on the clock of `first_contact`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_until: Option<f64>,
    /// The least distance seen on a motion that collides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deepest: Option<EncounterFinding>,
    /// Where it could not be decided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<EncounterFinding>,
}

/// A link and an obstacle at a moment.
#[derive(Debug, Clone, Serialize)]
pub struct EncounterFinding {
    /// When, and where the arm is.
    #[serde(flatten)]
    pub moment: MomentFinding,
    /// Name of the arm's link.
    pub link: String,
    /// Name of the body of the URDF that moves with it.
    pub body: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// Penetration depth, metres; negative is a distance.
    pub depth: f64,
    /// The pair, for people.
    #[serde(skip)]
    pub pair: String,
}

/// A moment of a motion.
#[derive(Debug, Clone, Serialize)]
pub struct MomentFinding {
    /// Seconds on the file's clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Without a clock: number of the waypoint, counted from 0, and the share of the way to the next.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waypoint: Option<f64>,
    /// The sample at or before it, counted from 0.
    pub sample: usize,
    /// Joint values then, base to tip.
    pub configuration: [f64; 2],
}

/// A limit that is broken.
#[derive(Debug, Clone, Serialize)]
pub struct LimitFinding {
    /// Name of the joint.
    pub joint: String,
    /// What it is a limit of, such as `velocity`.
    pub limit: &'static str,
    /// What is reached: rad or m, and per second, second squared or cubed.
    pub value: f64,
    /// What is allowed, in the same unit.
    pub allowed: f64,
    /// When.
    #[serde(flatten)]
    pub moment: MomentFinding,
    /// The same as it was found.
    #[serde(skip)]
    pub excess: Excess,
}

/// Limits that a motion exceeds, by where they come from.
pub(super) struct Broken {
    /// Limits that the files give.
    pub given: Vec<Excess>,
    /// Limits that cplan assumes.
    pub assumed: Vec<Excess>,
}

impl Broken {
    /// Tells given limits from assumed ones.
    pub fn new(joints: &[Joint; 2], broken: &[Excess], assumed: &AssumedLimits) -> Self {
        let is_assumed = |excess: &Excess| {
            let name = &joints[excess.joint].name;
            match excess.limit {
                Limit::Velocity => assumed.velocity.contains_key(name),
                Limit::Acceleration => assumed.acceleration.contains_key(name),
                _ => false,
            }
        };
        let (assumed, given) = broken.iter().partition(|excess| is_assumed(excess));
        Self { given, assumed }
    }
}

impl MotionFindings {
    /// Collects what the checks found of one motion.
    pub(super) fn new(
        scene: &Scene,
        recording: &Recording,
        collision_check: &CollisionCheck,
        broken: Broken,
        notes: Vec<String>,
    ) -> Self {
        let timed = recording.times().is_some();
        let of = |excesses: &[Excess]| limits(&scene.arm().joints, excesses, timed);
        Self {
            verdict: verdict(collision_check, &broken.given),
            way: WayFinding::new(scene, collision_check, timed),
            limits_broken: of(&broken.given),
            assumed_exceeded: of(&broken.assumed),
            notes,
            ..Self::of_nothing(scene, recording)
        }
    }

    /// What there is to say of a recording before it is judged.
    pub(super) fn of_nothing(scene: &Scene, recording: &Recording) -> Self {
        let joints = &scene.arm().joints;
        Self {
            verdict: Judgement::Free,
            joints: joints.each_ref().map(|j| j.name.clone()),
            units: joints.each_ref().map(Joint::unit),
            samples: recording.positions().len(),
            duration: recording.duration(),
            required: scene.workspace().clearance,
            way: WayFinding::default(),
            limits_broken: Vec::new(),
            assumed_exceeded: Vec::new(),
            faults: Vec::new(),
            not_judged: Vec::new(),
            steps: None,
            notes: Vec::new(),
        }
    }

    /// With faults of a kind, if there are any.
    pub(super) fn but(mut self, verdict: Judgement, faults: Vec<impl ToString>) -> Self {
        if !faults.is_empty() {
            self.verdict = self.verdict.max(verdict);
        }
        self.faults.extend(faults.iter().map(ToString::to_string));
        self
    }

    /// With what nobody judges of what a file says.
    pub(super) fn leaving(mut self, claims: &Claims) -> Self {
        self.not_judged.clone_from(&claims.unjudged);
        self
    }
}

/// What to say of a motion in a word.
pub(super) fn verdict(collision_check: &CollisionCheck, broken: &[Excess]) -> Judgement {
    match collision_check {
        CollisionCheck::Collision { .. } => Judgement::Collision,
        _ if !broken.is_empty() => Judgement::Limits,
        CollisionCheck::Free { .. } => Judgement::Free,
        CollisionCheck::Undecided(_) => Judgement::Undecided,
    }
}

impl WayFinding {
    /// What the check found of a motion, which has times or not.
    pub(super) fn new(scene: &Scene, collision_check: &CollisionCheck, timed: bool) -> Self {
        let encounter = |e: &Encounter| encounter(scene, e, timed);
        match collision_check {
            CollisionCheck::Free { clearance, nearest } => Self {
                clearance: Some(*clearance).filter(|c| c.is_finite()),
                nearest: nearest.as_ref().map(encounter),
                ..Self::default()
            },
            CollisionCheck::Collision { first, free_until, deepest } => Self {
                first_contact: Some(encounter(first)),
                free_until: Some(*free_until),
                deepest: Some(encounter(deepest)),
                ..Self::default()
            },
            CollisionCheck::Undecided(nearest) => Self { undecided: Some(encounter(nearest)), ..Self::default() },
        }
    }
}

/// The limits that are broken.
pub(super) fn limits(joints: &[Joint; 2], broken: &[Excess], timed: bool) -> Vec<LimitFinding> {
    broken.iter().map(|excess| limit(joints, excess, timed)).collect()
}

fn encounter(scene: &Scene, e: &Encounter, timed: bool) -> EncounterFinding {
    let pair = e.contact.pair;
    let link = scene.link(pair);
    EncounterFinding {
        moment: moment(&e.moment, timed),
        link: link.name.clone(),
        body: link.parts[pair.part].body.clone(),
        obstacle: scene.obstacle_name(pair).to_owned(),
        depth: -e.contact.separation.distance,
        pair: scene.describe(pair),
    }
}

fn moment(m: &Moment, timed: bool) -> MomentFinding {
    MomentFinding {
        time: timed.then_some(m.time),
        waypoint: (!timed).then_some(m.time),
        sample: m.sample,
        configuration: [m.at[0], m.at[1]],
    }
}

fn limit(joints: &[Joint; 2], excess: &Excess, timed: bool) -> LimitFinding {
    LimitFinding {
        joint: joints[excess.joint].name.clone(),
        limit: match excess.limit {
            Limit::Position => "position",
            Limit::Velocity => "velocity",
            Limit::Acceleration => "acceleration",
            Limit::Jerk => "jerk",
            Limit::Torque => "torque",
            Limit::AccelerationJump => "acceleration jump",
            Limit::RestAtStart => "rest at start",
            Limit::RestAtEnd => "rest at end",
        },
        value: excess.value,
        allowed: excess.allowed,
        moment: moment(&excess.moment, timed),
        excess: *excess,
    }
}
