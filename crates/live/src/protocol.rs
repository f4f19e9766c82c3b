//! The protocol between page and program: JSON objects, one per message.

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

/// Most obstacles in the page's state.
pub const MAX_OBSTACLES: usize = 1000;

/// Most corners of all obstacles in the page's state.
pub const MAX_CORNERS: usize = 20_000;

/// A point of the plane, metres, or joint values.
pub type Pair = [f64; 2];

/// A request of the page.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub enum Request {
    /// Load these files, or the program's initial ones. The page receives the world.
    Open {
        /// Number of the request.
        id: u64,
        /// The files; `None` for those of the program.
        files: Option<Files>,
    },
    /// Plan in the world that the page shows.
    Plan(PlanRequest),
    /// Take another text for the world, and plan in it.
    Load {
        /// Number of the request; answers name it.
        id: u64,
        /// The world file's text.
        text: String,
        /// Options, as in [`PlanRequest`].
        options: String,
    },
    /// Plan, and send the result as a file.
    Download {
        /// The plan.
        ask: PlanRequest,
        /// The file format: `toml`, `json`, `csv`, `yaml`, `svg`, ...
        format: String,
    },
}

impl Request {
    /// Returns the number of the request.
    pub fn id(&self) -> u64 {
        match self {
            Self::Plan(ask) | Self::Download { ask, .. } => ask.id,
            Self::Open { id, .. } | Self::Load { id, .. } => *id,
        }
    }
}

/// The files that a page begins with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Files {
    /// The arm.
    pub urdf: String,
    /// The world.
    pub world: String,
    /// Planner and options.
    pub options: String,
}

/// A request for a plan.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanRequest {
    /// Number of the request; answers name it.
    pub id: u64,
    /// The text of the world that `state` is a change of; see [`Reply::World`].
    pub base: u64,
    /// True if the user stops here, so that the answer must be complete; false for an intermediate position.
    #[serde(rename = "final")]
    pub is_final: bool,
    /// The state of the page; `None` for the unchanged text.
    pub state: Option<State>,
    /// Planner and options, as on the command line: `visibility --gap 0.001`.
    pub options: String,
    /// True if a final answer must include how the planner found it.
    #[serde(default)]
    pub think: bool,
}

/// The part of a world that the page can change, as a whole.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// All obstacles in order. Obstacles of the text that are missing here are deleted.
    pub obstacles: Vec<Piece>,
    /// Start of the arm.
    pub start: Option<Begin>,
    /// Goal of the arm.
    pub goal: Option<End>,
    /// Least distance to keep, metres.
    pub clearance: f64,
}

/// An obstacle as the page edits it.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Index of the obstacle in the text, from 0; `None` for a new one.
    pub from: Option<usize>,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Its shape; `None` for an unchanged one.
    #[serde(flatten)]
    pub shape: Option<Form>,
}

/// A shape that the page can change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Corners in order round it.
    Polygon(Vec<Pair>),
    /// A disc, by its centre and radius.
    Circle {
        /// Its centre.
        center: Pair,
        /// Its radius, metres.
        radius: f64,
    },
    /// A wall without thickness.
    Polyline(Vec<Pair>),
}

impl Form {
    /// Returns the number of its corners; a disc counts as one.
    pub fn corners(&self) -> usize {
        match self {
            Self::Polygon(corners) | Self::Polyline(corners) => corners.len(),
            Self::Circle { .. } => 1,
        }
    }
}

/// Start of the arm.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, untagged)]
pub enum Begin {
    /// Joint values.
    Joints {
        /// Base to tip.
        joints: Pair,
    },
    /// A tip position, with the IK solution nearest to some configuration.
    Tip {
        /// Place of the tip.
        tip: Pair,
        /// Joint values to be near to.
        near: Pair,
    },
}

/// Goal of the arm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// Joint values.
    Joints(Pair),
    /// A tip position, with any IK solution.
    Tip(Pair),
}

/// A message of the program.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Reply {
    /// The initial world, or one that was loaded: its editable parts, and their context.
    World(Box<WorldReply>),
    /// The result of a plan.
    Answer(Box<AnswerReply>),
    /// The request is invalid, or failed. The page keeps its state.
    Failed {
        /// The number of the request that this answers.
        id: u64,
        /// The reason, for display.
        error: String,
    },
}

/// A message to the page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Message {
    /// A [`Reply`].
    Text(String),
    /// A file: the length of its head, four bytes; the head; the content.
    Binary(Vec<u8>),
}

impl From<&Reply> for Message {
    fn from(reply: &Reply) -> Self {
        // Replies consist of strings, numbers and lists, so JSON can represent them.
        Self::Text(serde_json::to_string(reply).unwrap_or_default())
    }
}

impl Message {
    /// Creates the reply with a requested file.
    pub fn file(id: u64, name: &str, content: &[u8]) -> Self {
        let head = format!("{{\"id\":{id},\"name\":{name:?}}}");
        let length = u32::try_from(head.len()).unwrap_or_default().to_be_bytes();
        Self::Binary([&length[..], head.as_bytes(), content].concat())
    }
}

/// A world as the page draws and edits it.
#[derive(Debug, Serialize)]
pub struct WorldReply {
    /// The request that opened or loaded it.
    pub id: u64,
    /// Number of the text: states are changes of one text.
    pub base: u64,
    /// The title above the picture.
    pub name: String,
    /// The robot, and the kind of its joints: `RR`.
    pub robot: String,
    /// Obstacles of the text, in order.
    pub obstacles: Vec<PieceReply>,
    /// Start of the arm.
    pub start: Option<Pair>,
    /// Goal of the arm.
    pub goal: Option<End>,
    /// Least distance to keep, metres.
    pub clearance: f64,
    /// True for a task, which the page shows and does not change.
    pub has_steps: bool,
    /// The joints, base to tip.
    pub joints: [JointReply; 2],
    /// Length of the stretched arm, metres.
    pub reach: f64,
    /// Planners to choose from.
    pub planners: Vec<&'static str>,
    /// The options of each planner, for the page's menus.
    pub menus: Vec<PlannerReply>,
    /// Initial planner and options; `None` with a world that was loaded.
    pub options: Option<String>,
    /// The arm, for a link that contains it with the world; `None` with a world that was loaded, and if either names
    /// other files.
    pub urdf: Option<String>,
    /// The current text of the world file.
    pub toml: String,
}

/// The menus of a planner.
#[derive(Debug, Serialize)]
pub struct PlannerReply {
    /// Its name on the command line.
    pub name: &'static str,
    /// Options that it takes, in the order of their menus.
    pub options: Vec<OptionReply>,
}

/// An option with the values that a menu offers.
#[derive(Debug, Serialize)]
pub struct OptionReply {
    /// Name on the command line: `--cells`.
    pub name: String,
    /// Label.
    pub label: &'static str,
    /// Description of the default.
    pub standard: String,
    /// Values to choose from, each with its label.
    pub values: Vec<[String; 2]>,
}

/// An obstacle of a world.
#[derive(Debug, Serialize)]
pub struct PieceReply {
    /// The obstacle's name in the world file.
    pub name: String,
    /// Its shape; `None` for one that the page cannot change, such as a map.
    #[serde(flatten)]
    pub shape: Option<Form>,
}

/// A joint with its unit and limits.
#[derive(Debug, Serialize)]
pub struct JointReply {
    /// Name in the URDF.
    pub name: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// Least and greatest value; `None` for a continuous joint.
    pub limits: Option<Pair>,
}

/// The result of a plan.
#[derive(Debug, Default, Serialize)]
pub struct AnswerReply {
    /// The number of the request that this answers.
    pub id: u64,
    /// True if a complete answer was requested.
    #[serde(rename = "final")]
    pub is_final: bool,
    /// True if this is the last answer to the request.
    pub done: bool,
    /// Description of the defect of the world, start or goal, without references to files; then there is no verdict.
    pub error: Option<String>,
    /// Subject of the error.
    pub about: Option<ErrorSubject>,
    /// Configurations of the start or the goal that are not free.
    pub blocked: Vec<BlockedReply>,
    /// `found`, `infeasible` or `unknown`; `None` with an error, and if the plan is not finished.
    pub verdict: Option<&'static str>,
    /// True if the whole motion is proven free.
    pub certified: bool,
    /// The reason why no path exists or is known.
    pub reason: Option<String>,
    /// Figures of the plan.
    pub figures: Figures,
    /// The start, whose joint values the page may not know.
    pub start: Option<Pair>,
    /// Configurations that fulfil the goal.
    pub goals: Vec<Pair>,
    /// The world as text, in final answers.
    pub toml: Option<String>,
    /// The drawing; `None` without a scene.
    pub view: Option<Box<RawValue>>,
}

/// Subject of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ErrorSubject {
    /// Planner and options.
    Options,
    /// Obstacles and everything else in the world.
    World,
    /// The start.
    Start,
    /// The goal.
    Goal,
}

/// A configuration that is not free.
#[derive(Debug, PartialEq, Serialize)]
pub struct BlockedReply {
    /// The joint values, in which it is not free.
    pub at: Pair,
    /// Obstacles in contact, deepest first; empty if the configuration is outside the joint limits.
    pub hits: Vec<HitReply>,
}

/// A link and an obstacle that meet, or are nearer than the clearance.
#[derive(Debug, PartialEq, Serialize)]
pub struct HitReply {
    /// The link: 0 or 1.
    pub link: usize,
    /// The obstacle, as the world counts them.
    pub obstacle: usize,
    /// Distance, metres; negative if they overlap.
    pub distance: f64,
}

/// Figures of a plan.
#[derive(Debug, Default, Serialize)]
pub struct Figures {
    /// Length of the path in the requested metric.
    pub length: Option<f64>,
    /// Proven lower bound on the length of every path.
    pub lower_bound: Option<f64>,
    /// Proven distance of the motion from all obstacles, metres; `None` if no obstacle is within reach.
    pub clearance: Option<f64>,
    /// The nearest obstacle.
    pub closest: Option<String>,
    /// Duration of the motion, seconds.
    pub duration: Option<f64>,
    /// Size of the planner's data, in words.
    pub size: Option<String>,
    /// Time that it took to answer, milliseconds.
    pub milliseconds: f64,
}

impl Figures {
    /// Creates facts with only a size.
    pub fn of_size(size: impl ToString) -> Self {
        Self { size: Some(size.to_string()), ..Self::default() }
    }
}
