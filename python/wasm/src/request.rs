//! Requests: the functions and methods of `_cplan`, as JSON.

use cplan::study::Row;
use cplan_calls::{Arm, ArmNumbers, DrawnAnswer, JointBox, Motion, Options, World};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Number of an object that a session keeps: a problem, a plan, a study or a journal.
pub type Id = u64;

/// Corners of a polygon. A missing number is not a number.
pub type Corners = Vec<[Option<f64>; 2]>;

/// A request, with the working folder and the objects to release.
#[derive(Deserialize)]
pub struct Envelope {
    /// The working folder, to which paths are relative.
    pub folder: PathBuf,
    /// Objects that are no longer needed.
    #[serde(default)]
    pub released: Vec<Id>,
    /// The request itself.
    pub request: Request,
}

/// A request.
#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub enum Request {
    ReadArm { path: PathBuf, arguments: BTreeMap<String, String> },
    ArmOfText { text: String, name: String },
    Rr { lengths: [f64; 2], width: f64, numbers: ArmNumbers },
    Scara { links: Option<[f64; 2]>, stroke: Option<f64>, numbers: ArmNumbers },
    ArmRestored { arm: Arm },
    Joints { arm: Arm, world: World },
    ReadWorld { path: PathBuf },
    WorldOfText { text: String, name: String },
    WorldOfKeys { keys: String },
    WorldRestored { world: World },
    Options { options: Vec<String> },
    Problem { arm: Arm, world: World, options: Vec<String> },
    ProblemRestored { data: String },
    ProblemStored { problem: Id },
    Plan { problem: Id, options: Options },
    PlanRestored { data: String },
    SecondsInRust { problem: Id, options: Options, count: u32 },
    PlanText { plan: Id, content: PlanText },
    Path { plan: Id },
    Trajectory { plan: Id },
    Save { plan: Id, path: PathBuf },
    Check { arm: Arm, world: World, at: String, clearance: Option<f64> },
    Slices { arm: Arm, world: World, q1: Vec<Option<f64>> },
    Verify { arm: Arm, world: World, motion: Motion, options: Options, anywhere: bool, unwrap: bool },
    Compare { arm: Arm, world: World, words: Vec<String> },
    ComparedProblems { arm: Arm, world: World, words: Vec<String> },
    Explain { arm: Arm, world: World, options: Options, time: f64 },
    ExplainDrawn { arm: Arm, world: World, options: Options, page: bool, time: f64 },
    PenetrationDepth { a: Corners, b: Corners },
    PolygonTest { a: Corners, b: Corners },
    MinkowskiDifference { a: Corners, b: Corners },
    JointRanges { arm: Arm, world: World },
    JudgeBoxes { arm: Arm, world: World, boxes: Vec<JointBox>, colliding: bool },
    Separate { arm: Arm, world: World, boxes: Vec<JointBox> },
    Drawn { arm: Arm, world: World, answer: DrawnAnswer },
    ReadStudy { path: PathBuf },
    StudyOfSources { sources: String },
    StudySources { text: String, arm: Arm, world: World },
    StudyStored { study: Id },
    Values { study: Id, layout: usize },
    Layout { study: Id, values: Vec<f64> },
    Rows { study: Id, first: usize, last: usize },
    Search { study: Id, known: Vec<Row>, done: Vec<Row> },
    Table { study: Id, rows: Vec<Row>, content: TableContent },
    OpenJournal { study: Id, path: PathBuf, fresh: bool },
    AddRows { journal: Id, rows: Vec<Row> },
    RemoveJournal { journal: Id },
    Run { arguments: Vec<String> },
}

/// A text of a plan.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlanText {
    /// The summary for people.
    Summary,
    /// The result.
    Json,
    /// The picture.
    Svg,
    /// The page.
    Html,
    /// The configuration spaces.
    CSpaces,
    /// The pickled plan.
    Stored,
}

/// A form of the rows of a study.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TableContent {
    /// The summary for people.
    Summary,
    /// The summary as a JSON object.
    Json,
    /// The table as CSV.
    Csv,
    /// The table as a Parquet file.
    Parquet,
    /// The page.
    Html,
    /// The columns by name.
    Columns,
}
