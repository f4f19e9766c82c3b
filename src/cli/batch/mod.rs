//! `cplan batch`: reads problems as JSON lines, and writes one result per line. A single process plans for thousands.

mod lines;
mod reader;

use super::error_json::ErrorJson;
use super::exit::DONE;
use super::failure::Failure;
use super::sinks;
use super::values::time_limit;
use crate::engine::Plan;
use crate::engine::findings::MotionFindings;
use crate::model::Status;
use crate::text::plain_json;
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueHint};
use lines::Input;
use reader::{Answer, ProblemOutcome, Reader};
use serde::ser::Error as _;
use serde::{Serialize, Serializer};
use serde_json::value::RawValue;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Plan for many problems, or judge many motions, in JSON lines.
#[derive(Debug, Args)]
#[command(after_help = "\
Each line of the input is a JSON object with these members:
  urdf         path of the robot; for xacro with xacro_args, an object
  urdf_text    text of the URDF, instead of urdf
  world        path of the world file, or its content as an object
  world_text   text of the world file (TOML), instead of world
  options      options of `cplan plan`, as a list or as an object
  verify       instead of planning, judge this motion: a path as in `cplan
               verify`, or an object such as {\"path\": [[0, 0], [1, 1]]};
               `options` are then those of `verify`
  id           any value; the result repeats it

For example:
  {\"id\": 7, \"urdf\": \"arm.urdf\", \"world\": \"world.toml\",
   \"options\": [\"--planner=wavefront\", \"--cells=80\"]}
  {\"urdf\": \"arm.urdf\", \"world\": \"world.toml\",
   \"options\": {\"goal\": [1.2, -0.3], \"clearance\": 0.01}}
(each on one line). Each line gives one line of output, in the same order: the
result of `cplan plan` or `cplan verify`, or an error. Output does not depend on
--jobs. A robot that occurs in several lines is read once. Blank lines are
skipped. With --time SECONDS, a problem that takes longer gets the status
`unknown` and this reason.

Examples:
  cplan batch problems.jsonl
  cplan batch problems.jsonl --jobs 2 \\
    --fields status,length,clearance > rows.jsonl
  cplan batch problems.jsonl --time 10

Exit codes: 0 each line has a result, of any status; 1 a file cannot be read or
written, or no line is a JSON object; 2 wrong command line.")]
pub struct BatchArgs {
    /// File with one problem per line, as a JSON object [default: standard input].
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub problems: Option<PathBuf>,
    /// Number of problems planned at the same time.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Fields of the results to write, such as status,length [default: all].
    #[arg(long, value_name = "NAMES", value_delimiter = ',', hide_possible_values = true,
        value_parser = PossibleValuesParser::new(field_names()))]
    pub fields: Vec<String>,
    /// Time limit for each problem, seconds [default: no limit].
    #[arg(long, value_name = "SECONDS", value_parser = time_limit, allow_hyphen_values = true)]
    pub time: Option<f64>,
}

/// Returns the names of all fields of plans and of findings about motions, each once.
fn field_names() -> Vec<&'static str> {
    let is_new = |name: &&str| !Plan::FIELD_NAMES.contains(name);
    Plan::FIELD_NAMES.into_iter().chain(MotionFindings::FIELD_NAMES.into_iter().filter(is_new)).collect()
}

/// The answer to a line as JSON.
#[derive(Serialize)]
struct Row<T> {
    #[serde(skip_serializing_if = "Option::is_none")]
    id: Option<Box<RawValue>>,
    #[serde(flatten)]
    answer: T,
}

/// Some fields of findings about a motion, in their usual order.
struct Selected<'a> {
    findings: &'a MotionFindings,
    /// Names of the fields. Empty for all.
    fields: &'a [String],
}

impl Serialize for Selected<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.fields.is_empty() {
            return self.findings.serialize(serializer);
        }
        let all = serde_json::to_value(self.findings).map_err(S::Error::custom)?;
        let is_selected = |name: &&str| self.fields.iter().any(|field| field == name);
        let selected = MotionFindings::FIELD_NAMES.into_iter().filter(is_selected);
        serializer.collect_map(selected.filter_map(|name| Some((name, all.get(name)?))))
    }
}

/// The answer to a problem whose time limit was reached.
#[derive(Serialize)]
struct Stopped {
    status: Status,
    reason: String,
}

/// Answers all lines of the input.
///
/// # Errors
/// Input that cannot be read or that contains no JSON objects, and output that cannot be written.
pub fn run(args: &BatchArgs) -> Result<u8, Failure> {
    let input = args.problems.as_ref().map_or_else(|| "stdin".into(), |path| path.display().to_string());
    let warnings = Mutex::new(BTreeSet::new());
    let readers = Mutex::new(Vec::<Reader>::new());
    let lines = Input::new(BufReader::new(open_input(args)?), &input);
    let count = lines.answer_all(io::stdout(), args.jobs.into(), |line| {
        let mut reader = locked(&readers).pop().unwrap_or_default();
        let answer = reader.answer(line, &input, args.time.map(Duration::from_secs_f64));
        locked(&readers).push(reader);
        if let Ok(ProblemOutcome::Done(plan)) = &answer.plan {
            locked(&warnings).extend(plan.problem().robot().warnings.iter().cloned());
        }
        row(answer, &args.fields)
    });
    // Print each warning once, in an order that does not depend on the number of jobs.
    locked(&warnings).iter().for_each(|warning| sinks::print_status(&format!("warning: {warning}")));
    let count = count?;
    if count.lines > 0 && count.objects == 0 {
        let cure = r#"write one problem per line, such as {"urdf": "arm.urdf", "world": "world.toml"}"#;
        return Err(Failure::Refused(format!("{input}: no line is a JSON object\n  hint: {cure}")));
    }
    Ok(DONE)
}

fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

fn open_input(args: &BatchArgs) -> Result<Box<dyn Read + Send>, Failure> {
    let Some(path) = &args.problems else { return Ok(Box::new(io::stdin())) };
    if path.is_dir() {
        let cure = "give a file of JSON lines, or send the lines of several files to stdin";
        return Err(Failure::Io(format!("{}: cannot be read: it is a folder\n  hint: {cure}", path.display())));
    }
    let refused = |error| {
        let cure = "check the path and the file's permissions";
        Failure::Io(format!("{}: cannot be read: {error}\n  hint: {cure}", path.display()))
    };
    Ok(Box::new(File::open(path).map_err(refused)?))
}

/// Returns the answer as a line of output, and true if the line of input is a JSON object.
fn row(answer: Answer, fields: &[String]) -> (String, bool) {
    let Answer { id, is_object, plan } = answer;
    let text = match plan {
        Ok(ProblemOutcome::Done(plan)) => text(&Row { id, answer: plan.result(fields) }),
        Ok(ProblemOutcome::Judged(findings)) => text(&Row { id, answer: Selected { findings: &findings, fields } }),
        Ok(ProblemOutcome::Stopped(reason)) => text(&Row { id, answer: Stopped { status: Status::Unknown, reason } }),
        Err(failure) => text(&Row { id, answer: ErrorJson::of_failure(&failure) }),
    };
    (text, is_object)
}

fn text(row: &impl Serialize) -> String {
    let json = serde_json::to_string(row).expect("string keys, and a buffer that takes all");
    plain_json(&json).into_owned() + "\n"
}
