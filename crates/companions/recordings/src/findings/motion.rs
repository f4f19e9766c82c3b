//! Findings about a motion, as data.

use super::{PlanFinding, StepFinding};
use cplan_handling::{Claims, Recording};
use cplan_model::{Joint, Scene};
use cplan_motion::Margins;
use cplan_motion::recorded::{CollisionCheck, Encounter, FIRST_MOTOR, Limit, LimitViolation, Moment, Touch};
use cplan_robot::AssumedLimits;
use serde::Serialize;

/// The verdict on a motion, from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Judgement {
    /// Proven free, and within all limits that can be judged.
    Free,
    /// Neither proven free nor proven to collide.
    Undecided,
    /// Free, but the file states some wrong values.
    Claims,
    /// Not known to collide, but begins or ends at the wrong place.
    Ends,
    /// Not known to collide, but violates a limit.
    Limits,
    /// Not known to collide, but differs from the requested task.
    Task,
    /// Proven to collide, or to come nearer than the required clearance.
    Collision,
}

impl Judgement {
    /// Returns the word for the verdict in JSON.
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

/// Findings about a motion, or about the motions of a task.
#[derive(Debug, Clone, Serialize)]
pub struct MotionFindings {
    /// The verdict on the motion.
    pub verdict: Judgement,
    /// Names of the joints, base to tip.
    pub joints: [String; 2],
    /// Units of the joints' values: `rad` or `m`.
    pub units: [&'static str; 2],
    /// Number of samples.
    pub samples: usize,
    /// Time from the first to the last sample, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// The required clearance, metres.
    pub required: f64,
    /// Collisions and clearance along the motion.
    #[serde(flatten)]
    pub collisions: CollisionFinding,
    /// Margins of a free motion. `None` for any other motion, and for tasks.
    #[serde(flatten)]
    pub margins: Option<Margins>,
    /// Violated limits, each listed once.
    pub limits_broken: Vec<LimitFinding>,
    /// Exceeded limits that the input files do not state, each listed once. They do not affect the verdict.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub assumed_exceeded: Vec<LimitFinding>,
    /// Differences from the requested motion or task, and false statements in the file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<String>,
    /// Members of a result that were not judged.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_judged: Vec<String>,
    /// Distance from the plan. `None` if no plan was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan: Option<PlanFinding>,
    /// Findings about the steps of a task.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<Vec<StepFinding>>,
    /// Notes on the reading of the file, and on the parts that were judged.
    pub notes: Vec<String>,
}

impl MotionFindings {
    /// Names of all fields, in the order of the JSON members.
    pub const FIELD_NAMES: [&str; 23] = [
        "verdict",
        "joints",
        "units",
        "samples",
        "duration",
        "required",
        "clearance",
        "nearest",
        "touches",
        "shortfall",
        "first_contact",
        "free_until",
        "deepest",
        "undecided",
        "margins",
        "tolerances",
        "limits_broken",
        "assumed_exceeded",
        "faults",
        "not_judged",
        "plan",
        "steps",
        "notes",
    ];
}

/// Collisions and clearance along a motion.
#[derive(Debug, Clone, Default, Serialize)]
pub struct CollisionFinding {
    /// Proven lower bound on the distance to every obstacle, in metres. Only for free motions with obstacles within reach.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// The place where a free motion comes nearest to an obstacle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest: Option<EncounterFinding>,
    /// True if the motion is proven to touch an obstacle. False if it violates the clearance, but is proven to touch
    /// nothing. `None` if neither is proven, and for motions that keep the clearance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub touches: Option<bool>,
    /// Required clearance minus the least signed distance found on the motion, in metres. The true shortfall may be
    /// greater. `None` if the motion keeps the clearance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shortfall: Option<f64>,
    /// The first place at which a motion collides, or comes nearer than the required clearance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_contact: Option<EncounterFinding>,
    /// Time before which a colliding motion is proven free, on the same clock as the time of `first_contact`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_until: Option<f64>,
    /// Place with the least signed distance found on a motion that violates the clearance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deepest: Option<EncounterFinding>,
    /// The place where it is not known whether the motion collides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<EncounterFinding>,
}

/// A link and an obstacle at one moment of a motion.
#[derive(Debug, Clone, Serialize)]
pub struct EncounterFinding {
    /// The time and the arm's configuration.
    #[serde(flatten)]
    pub moment: MomentFinding,
    /// Name of the arm's link.
    pub link: String,
    /// Name of the URDF link that has the shape in contact. The arm's link may consist of several URDF links.
    pub body: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// Penetration depth, metres. A negative value is a distance.
    pub depth: f64,
    /// Description of the pair in words.
    #[serde(skip)]
    pub pair: String,
}

/// A moment of a motion.
#[derive(Debug, Clone, Serialize)]
pub struct MomentFinding {
    /// Time as in the file, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Place on a motion without times: index of the waypoint, from 0, plus the fraction of the segment that follows it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waypoint: Option<f64>,
    /// Index of the last sample at or before this moment, from 0.
    pub sample: usize,
    /// Joint values at this moment, base to tip.
    pub configuration: [f64; 2],
}

/// A violated limit.
#[derive(Debug, Clone, Serialize)]
pub struct LimitFinding {
    /// Name of the joint.
    pub joint: String,
    /// The quantity that is limited, such as `velocity`.
    pub limit: &'static str,
    /// The value that the motion reaches, with the unit of the limit: radians or metres, per second, per second squared
    /// or per second cubed.
    pub value: f64,
    /// The allowed value, in the same unit.
    pub allowed: f64,
    /// The moment at which the limit is violated.
    #[serde(flatten)]
    pub moment: MomentFinding,
    /// The violation as the judge reports it.
    #[serde(skip)]
    pub excess: LimitViolation,
}

/// Violations of limits, grouped by the source of the limit.
pub(crate) struct ExceededLimits {
    /// Violations of limits that the files state.
    pub given: Vec<LimitViolation>,
    /// Violations of limits that cplan assumes.
    pub assumed: Vec<LimitViolation>,
}

impl ExceededLimits {
    /// Groups violations of limits by their source.
    pub fn new(joints: &[Joint; 2], broken: &[LimitViolation], assumed: &AssumedLimits) -> Self {
        let is_assumed = |excess: &LimitViolation| {
            let Some(Joint { name, .. }) = joints.get(excess.joint) else { return false };
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
    /// Creates the findings from the results of the checks of one motion.
    pub(crate) fn new(
        scene: &Scene,
        recording: &Recording,
        collision_check: &CollisionCheck,
        broken: ExceededLimits,
        notes: Vec<String>,
    ) -> Self {
        let timed = recording.times().is_some();
        let of = |excesses: &[LimitViolation]| limits(&scene.arm().joints, excesses, timed);
        Self {
            verdict: verdict(collision_check, &broken.given),
            collisions: CollisionFinding::new(scene, collision_check, timed),
            limits_broken: of(&broken.given),
            assumed_exceeded: of(&broken.assumed),
            notes,
            ..Self::of_nothing(scene, recording)
        }
    }

    /// Creates the findings about a recording before any check: the verdict is *free*; clearance and limits are not judged.
    pub(crate) fn of_nothing(scene: &Scene, recording: &Recording) -> Self {
        let joints = &scene.arm().joints;
        Self {
            verdict: Judgement::Free,
            joints: joints.each_ref().map(|j| j.name.clone()),
            units: joints.each_ref().map(Joint::unit),
            samples: recording.positions().len(),
            duration: recording.duration(),
            required: scene.workspace().clearance,
            collisions: CollisionFinding::default(),
            margins: None,
            limits_broken: Vec::new(),
            assumed_exceeded: Vec::new(),
            faults: Vec::new(),
            not_judged: Vec::new(),
            plan: None,
            steps: None,
            notes: Vec::new(),
        }
    }

    /// Adds faults. If there are any, the verdict becomes at least as bad as `verdict`.
    pub(crate) fn with_faults(mut self, verdict: Judgement, faults: Vec<impl ToString>) -> Self {
        if !faults.is_empty() {
            self.verdict = self.verdict.max(verdict);
        }
        self.faults.extend(faults.iter().map(ToString::to_string));
        self
    }

    /// Adds the claims of the file that no check judges.
    pub(crate) fn leaving(mut self, claims: &Claims) -> Self {
        self.not_judged.clone_from(&claims.unjudged);
        self
    }
}

pub(crate) fn verdict(collision_check: &CollisionCheck, broken: &[LimitViolation]) -> Judgement {
    match collision_check {
        CollisionCheck::Collision { .. } => Judgement::Collision,
        _ if !broken.is_empty() => Judgement::Limits,
        CollisionCheck::Free { .. } => Judgement::Free,
        CollisionCheck::Undecided(_) => Judgement::Undecided,
    }
}

impl CollisionFinding {
    /// Converts the result of the collision check of a motion. `timed` states whether the motion has times.
    pub(crate) fn new(scene: &Scene, collision_check: &CollisionCheck, timed: bool) -> Self {
        let encounter = |e: &Encounter| encounter(scene, e, timed);
        match collision_check {
            CollisionCheck::Free { clearance, nearest } => Self {
                clearance: Some(*clearance).filter(|c| c.is_finite()),
                nearest: nearest.as_ref().map(encounter),
                ..Self::default()
            },
            CollisionCheck::Collision { first, free_until, deepest, touch } => Self {
                touches: match touch {
                    // Shapes that are enlarged for errors may touch although the real ones do not.
                    Touch::Proven if scene.growth(deepest.contact.pair) > 0.0 => {
                        (scene.real_distance(&deepest.contact) <= 0.0).then_some(true)
                    }
                    Touch::Proven => Some(true),
                    Touch::Excluded => Some(false),
                    Touch::Undecided => None,
                },
                shortfall: Some(scene.workspace().clearance - deepest.contact.separation.distance),
                first_contact: Some(encounter(first)),
                free_until: Some(*free_until),
                deepest: Some(encounter(deepest)),
                ..Self::default()
            },
            CollisionCheck::Undecided(nearest) => Self { undecided: Some(encounter(nearest)), ..Self::default() },
        }
    }
}

pub(crate) fn limits(joints: &[Joint; 2], broken: &[LimitViolation], timed: bool) -> Vec<LimitFinding> {
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
        depth: -scene.real_distance(&e.contact),
        pair: scene.describe(pair),
    }
}

pub(crate) fn moment(m: &Moment, timed: bool) -> MomentFinding {
    MomentFinding {
        time: timed.then_some(m.time),
        waypoint: (!timed).then_some(m.time),
        sample: m.sample,
        configuration: [m.at[0], m.at[1]],
    }
}

fn limit(joints: &[Joint; 2], excess: &LimitViolation, timed: bool) -> LimitFinding {
    LimitFinding {
        joint: match excess.joint {
            FIRST_MOTOR => "first motor".into(),
            joint => joints.get(joint).map_or("elbow motor", |joint| &joint.name).to_owned(),
        },
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
