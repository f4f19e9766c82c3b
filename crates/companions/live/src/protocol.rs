//! The protocol between page and program: JSON objects, one per message.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::value::RawValue;

/// Largest number of obstacles in the page's state.
pub const MAX_OBSTACLES: usize = 1000;

/// Largest number of corners of all obstacles in the page's state.
pub const MAX_CORNERS: usize = 20_000;

/// Coordinates of a point of the plane in metres, or joint values.
pub type Pair = [f64; 2];

/// A request of the page.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub enum Request {
    /// Opens these files, or the program's initial files. The reply is the world.
    Open {
        /// Number of the request. Its answers repeat this number.
        id: u64,
        /// The files. `None` for the program's initial files.
        files: Option<Files>,
    },
    /// Plans in the world that the page shows.
    Plan(PlanRequest),
    /// Explains why there is no path in the world that the page shows.
    Explain(PlanRequest),
    /// Replaces the world by another text, and plans in it.
    Load {
        /// Number of the request. Its answers repeat this number.
        id: u64,
        /// The world file's text.
        text: String,
        /// Options, as in [`PlanRequest`].
        options: String,
    },
    /// Plans, and returns the result as a file.
    Download {
        /// The request for the plan.
        ask: PlanRequest,
        /// The file format: `toml`, `json`, `csv`, `yaml`, `svg`, ...
        format: String,
    },
}

impl Request {
    /// Returns the number of the request.
    pub fn id(&self) -> u64 {
        match self {
            Self::Plan(ask) | Self::Explain(ask) | Self::Download { ask, .. } => ask.id,
            Self::Open { id, .. } | Self::Load { id, .. } => *id,
        }
    }
}

/// The files that a page begins with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Files {
    /// The text of the URDF.
    pub urdf: String,
    /// The text of the world file.
    pub world: String,
    /// Planner and options.
    pub options: String,
}

/// A request for a plan.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanRequest {
    /// Number of the request. Its answers repeat this number.
    pub id: u64,
    /// Number of the text that `state` changes, see [`Reply::World`].
    pub base: u64,
    /// True for a final position, which needs a complete answer. False for a position during a drag.
    #[serde(rename = "final")]
    pub is_final: bool,
    /// The state of the page. `None` if the text is unchanged.
    pub state: Option<State>,
    /// Planner and options, as on the command line: `visibility --gap 0.001`.
    pub options: String,
    /// True if a final answer must include the replay of the planner's search.
    #[serde(default)]
    pub think: bool,
}

/// The editable part of a world, as a whole.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// All obstacles in order. Obstacles of the text that are not listed are deleted.
    pub obstacles: Vec<Piece>,
    /// Start of the arm.
    pub start: Option<Begin>,
    /// Goal of the arm.
    pub goal: Option<End>,
    /// Least distance to keep from obstacles, in metres.
    pub clearance: f64,
    /// Limits of joints that differ from those of the text.
    #[serde(default)]
    pub limits: Vec<JointLimits>,
}

/// The limits of a joint.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointLimits {
    /// Name of the joint in the URDF.
    pub joint: String,
    /// Least and greatest value, in radians or metres.
    pub range: Pair,
}

/// An obstacle as the page edits it.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Index of the obstacle in the text, from 0. `None` for a new obstacle.
    pub from: Option<usize>,
    /// Name of the obstacle. `None` if it has none.
    pub name: Option<String>,
    /// Shape of the obstacle. `None` if it is unchanged.
    #[serde(flatten)]
    pub shape: Option<Form>,
}

/// A shape that the page can change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// A polygon by its corners, in order round it.
    Polygon(Vec<Pair>),
    /// A disc.
    Circle {
        /// Centre of the disc.
        center: Pair,
        /// Radius of the disc, in metres.
        radius: f64,
    },
    /// A wall without thickness, by its points.
    Polyline(Vec<Pair>),
}

impl Form {
    /// Returns the number of corners. A disc counts as one corner.
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
        /// Values of both joints, base to tip.
        joints: Pair,
    },
    /// A place of the tip, reached by the IK solution nearest to a configuration.
    Tip {
        /// Coordinates of the tip.
        tip: Pair,
        /// The configuration to which the solution is nearest.
        near: Pair,
    },
}

/// Goal of the arm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// Joint values.
    Joints(Pair),
    /// A place of the tip, reached by any IK solution.
    Tip(Pair),
}

/// A message of the program.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Reply {
    /// A world that was opened or loaded: its editable parts, and further data for the page.
    World(Value),
    /// The result of a plan.
    Answer(Box<AnswerReply>),
    /// The reasons why there is no path, with the changes that open one.
    Explanation {
        /// Number of the request.
        id: u64,
        /// The explanation as JSON.
        explanation: Box<RawValue>,
    },
    /// The request is invalid or has failed. The page keeps its state.
    Failed {
        /// Number of the request.
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
    /// A file. Its first four bytes are the length of its head. The head and the content follow.
    Binary(Vec<u8>),
}

impl From<&Reply> for Message {
    fn from(reply: &Reply) -> Self {
        // Serialisation cannot fail, because replies consist of strings, numbers and lists.
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

/// The result of a plan.
#[derive(Debug, Default, Serialize)]
pub struct AnswerReply {
    /// Number of the request.
    pub id: u64,
    /// True if a complete answer was requested.
    #[serde(rename = "final")]
    pub is_final: bool,
    /// True if this is the last answer to the request.
    pub done: bool,
    /// Description of a defect of options, world, start or goal, without references to files. An answer with a defect
    /// has no verdict.
    pub error: Option<String>,
    /// Subject of the error.
    pub about: Option<&'static str>,
    /// Configurations of the start or the goal that are not free.
    pub blocked: Vec<Value>,
    /// `found`, `infeasible` or `unknown`. `None` if there is an error, or if the plan is not finished.
    pub verdict: Option<&'static str>,
    /// True if the whole motion is proven free.
    pub certified: bool,
    /// The reason why no path exists or is known.
    pub reason: Option<String>,
    /// Figures of the plan.
    pub figures: Figures,
    /// The start. The page may not know its joint values.
    pub start: Option<Pair>,
    /// Configurations that reach the goal.
    pub goals: Vec<Pair>,
    /// The text of the world. `None` if the answer is not final.
    pub toml: Option<String>,
    /// The view of the plan as JSON. `None` if there is no scene.
    pub view: Option<Box<RawValue>>,
}

/// Figures of a plan.
#[derive(Debug, Default, Serialize)]
pub struct Figures {
    /// Length of the path in the requested metric.
    pub length: Option<f64>,
    /// Unit of that length.
    pub length_unit: &'static str,
    /// Proven lower bound on the length of every path.
    pub lower_bound: Option<f64>,
    /// Proven lower bound on the distance of the motion from all obstacles, in metres. `None` if no obstacle is within
    /// reach.
    pub clearance: Option<f64>,
    /// Name of the nearest obstacle.
    pub closest: Option<String>,
    /// Duration of the motion, seconds.
    pub duration: Option<f64>,
    /// Size of the planner's data structures, in words.
    pub size: Option<String>,
    /// Time that the answer took, in milliseconds.
    pub milliseconds: f64,
}

impl Figures {
    /// Creates figures with a size and nothing else.
    pub fn of_size(size: impl ToString) -> Self {
        Self { size: Some(size.to_string()), ..Self::default() }
    }
}
