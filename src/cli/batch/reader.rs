//! Converts lines to problems. Robots, worlds and option lists that several lines have in common are read only once.

use super::lines::Line;
use crate::cli::failure::Failure;
use crate::cli::verify::{RecordingSource, judge};
use crate::cli::words::{self, ParsedWords};
use crate::engine::findings::MotionFindings;
use crate::engine::{Plan, Problem, plan};
use crate::input::{self, Diagnostic, InputError, LoadedScene, Position, RobotFile, Source, scene_from};
use crate::interrupt::{Instant, Interrupt};
use crate::parallel::caught;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::error::Category;
use serde_json::value::RawValue;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Largest number of remembered robots, and of remembered option lists.
const MAX_REMEMBERED: usize = 256;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LineKeys {
    /// The key `id`, which is copied to the answer unchanged.
    #[serde(rename = "id")]
    _id: Option<IgnoredAny>,
    urdf: Option<PathBuf>,
    urdf_text: Option<String>,
    #[serde(default)]
    xacro_args: BTreeMap<String, String>,
    world: Option<World>,
    world_text: Option<String>,
    verify: Option<Motion>,
    #[serde(default)]
    options: Options,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "`verify` must be a path, or an object with a motion, as in a result of cplan")]
enum Motion {
    Path(PathBuf),
    Keys(Map<String, Value>),
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "`world` must be a path, or an object with the keys of a world file")]
enum World {
    Path(PathBuf),
    Keys(Map<String, Value>),
}

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "`options` must be a list of words such as \"--cells=80\", or an object of names and values"
)]
enum Options {
    Words(Vec<String>),
    Named(Map<String, Value>),
}

impl Default for Options {
    fn default() -> Self {
        Self::Words(Vec::new())
    }
}

/// A file, given by its name or by its text.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Named {
    File(PathBuf),
    Robot(PathBuf, Vec<(String, String)>),
    Text(String),
}

/// The answer to a line.
pub struct Answer {
    /// The line's `id` unchanged, so that even very large numbers are preserved.
    pub id: Option<Box<RawValue>>,
    /// True if the line is a JSON object.
    pub is_object: bool,
    /// The plan, or the reason why there is none.
    pub plan: Result<ProblemOutcome, Failure>,
}

/// The outcome of a problem.
pub enum ProblemOutcome {
    /// The finished plan.
    Done(Box<Plan>),
    /// The findings about a recorded motion.
    Judged(Box<MotionFindings>),
    /// The time limit was reached. Contains the reason in words.
    Stopped(String),
}

/// A reader of lines. It remembers their robots and options.
#[derive(Default)]
pub struct Reader {
    robots: HashMap<Named, RememberedRobot>,
    words: HashMap<Vec<String>, ParsedWords>,
}

/// A robot, and the last world that was loaded with it.
struct RememberedRobot {
    source: Source,
    world: Named,
    scene: LoadedScene,
}

impl Reader {
    /// Answers a line within a time limit. `input` is the name of its file in messages.
    pub fn answer(&mut self, line: &Line, input: &str, limit: Option<Duration>) -> Answer {
        let refused = |message: String, help: &str| refused(input, line.number, message, help);
        // The parser's position is within the line, not within the file.
        let json_error = |error: serde_json::Error| error.to_string().replace(" at line 1 column", " at column");
        let mut keys = match serde_json::from_slice::<HashMap<String, Box<RawValue>>>(&line.text) {
            Ok(keys) => keys,
            Err(error) => {
                let failure = match error.classify() {
                    Category::Data => {
                        refused("this is not a JSON object".into(), "write an object with `urdf` and `world`")
                    }
                    _ => refused(
                        format!("this is not JSON: {}", json_error(error)),
                        "write each problem as one line of JSON",
                    ),
                };
                return Answer { id: None, is_object: false, plan: Err(failure) };
            }
        };
        let given = serde_json::from_slice(&line.text)
            .map_err(|error| refused(json_error(error), "`cplan batch --help` describes the members of a line"));
        // A failure for one line does not affect the others.
        let planned = given.and_then(|given| {
            let help = "please report it with this line; the other lines are answered";
            caught(|| self.plan_within_limit(given, &refused, limit)).unwrap_or_else(|why| Err(refused(why, help)))
        });
        Answer { id: keys.remove("id"), is_object: true, plan: planned }
    }

    /// Plans, and stops when the time limit is reached.
    fn plan_within_limit(
        &mut self,
        given: LineKeys,
        refused: &dyn Fn(String, &str) -> Failure,
        limit: Option<Duration>,
    ) -> Result<ProblemOutcome, Failure> {
        let Some(limit) = limit else { return self.plan(given, refused) };
        let interrupt = Interrupt::new().with_deadline(Instant::now() + limit);
        let stopped = |_| Ok(ProblemOutcome::Stopped(format!("stopped after {} s", limit.as_secs_f64())));
        interrupt.run(|| self.plan(given, refused)).unwrap_or_else(stopped)
    }

    fn plan(&mut self, given: LineKeys, refused: &dyn Fn(String, &str) -> Failure) -> Result<ProblemOutcome, Failure> {
        let one = |what: &str| refused(format!("give either `{what}` or `{what}_text`"), "see `cplan batch --help`");
        let robot = match (given.urdf, given.urdf_text) {
            (Some(path), None) => Named::Robot(path, given.xacro_args.into_iter().collect()),
            (None, Some(text)) => Named::Text(text),
            _ => return Err(one("urdf")),
        };
        let world = match (given.world, given.world_text) {
            (Some(World::Path(path)), None) => Named::File(path),
            (Some(World::Keys(keys)), None) => Named::Text(toml::to_string(&keys).map_err(|error| {
                refused(format!("`world` cannot be written as TOML: {error}"), "remove null values")
            })?),
            (None, Some(text)) => Named::Text(text),
            _ => return Err(one("world")),
        };
        let words = written_options(given.options, refused)?;
        if let Some(motion) = given.verify {
            let settings = words::parse_verify_settings(&words)?;
            let scene = self.scene(robot, world)?;
            let source = match motion {
                Motion::Path(path) => RecordingSource::File(path),
                Motion::Keys(mut keys) => {
                    // Values without names are in the order of the joints.
                    let names = scene.scene.arm().joints.each_ref().map(|joint| joint.name.as_str());
                    keys.entry("joints").or_insert_with(|| names.as_slice().into());
                    RecordingSource::Text(Value::Object(keys).to_string())
                }
            };
            return Ok(ProblemOutcome::Judged(Box::new(judge(scene, &source, &settings)?.findings)));
        }
        let ParsedWords { options, overrides } = self.parse_options(words)?;
        let problem = Problem::of_scene(self.scene(robot, world)?, &overrides)?;
        Ok(ProblemOutcome::Done(Box::new(plan(&problem, &options)?)))
    }

    fn scene(&mut self, robot: Named, world: Named) -> Result<LoadedScene, InputError> {
        if let Some(known) = self.robots.get_mut(&robot) {
            if known.world != world {
                known.scene = known.scene.with_world_text(&known.source, world.source("world")?)?;
                known.world = world;
            }
            return Ok(known.scene.clone());
        }
        let source = robot.source("urdf")?;
        let scene = scene_from(source.clone(), world.source("world")?)?;
        clear_if_full(&mut self.robots);
        self.robots.insert(robot, RememberedRobot { source, world, scene: scene.clone() });
        Ok(scene)
    }

    fn parse_options(&mut self, words: Vec<String>) -> Result<ParsedWords, Failure> {
        if let Some(asked) = self.words.get(&words) {
            return Ok(asked.clone());
        }
        let asked = words::parse_settings(&words)?;
        clear_if_full(&mut self.words);
        self.words.insert(words, asked.clone());
        Ok(asked)
    }
}

/// Returns options as words of the command line.
fn written_options(options: Options, refused: &dyn Fn(String, &str) -> Failure) -> Result<Vec<String>, Failure> {
    match options {
        Options::Words(words) => Ok(words),
        Options::Named(named) => {
            let words: Result<Vec<_>, String> = named.iter().map(|(name, value)| word(name, value)).collect();
            let words = words.map_err(|message| refused(message, "give numbers, words, lists of them, or true"))?;
            Ok(words.into_iter().flatten().collect())
        }
    }
}

impl Named {
    /// Returns the text of the file. If the text was given directly, `name` replaces the file name in messages.
    fn source(&self, name: &str) -> Result<Source, InputError> {
        match self {
            Self::File(path) => Source::read(path),
            Self::Robot(path, arguments) => RobotFile { arguments: arguments.clone(), ..input::robot(path) }.read(),
            Self::Text(text) => Ok(Source::in_memory(Path::new(name), text.clone())),
        }
    }
}

/// Converts an option of a line to a word of the command line. Returns `None` if the option's value is false or null.
/// Pairs are written with a comma, and numbers of cells with an x.
fn word(name: &str, value: &Value) -> Result<Option<String>, String> {
    let option = format!("--{}", name.replace('_', "-"));
    let one = |value: &Value| match value {
        Value::String(text) => Ok(text.clone()),
        Value::Number(number) => Ok(number.to_string()),
        Value::Null => Ok("none".into()),
        other => Err(format!("`options`: {name} cannot be {other}")),
    };
    Ok(match value {
        Value::Null | Value::Bool(false) => None,
        Value::Bool(true) => Some(option),
        Value::Array(values) => {
            let separator = if ["cells", "grid"].contains(&name) { "x" } else { "," };
            let values: Result<Vec<_>, _> = values.iter().map(one).collect();
            Some(format!("{option}={}", values?.join(separator)))
        }
        value => Some(format!("{option}={}", one(value)?)),
    })
}

/// Removes all entries if there is no room for another one. Entries that are needed again are added again.
fn clear_if_full<K, V>(known: &mut HashMap<K, V>) {
    if known.len() >= MAX_REMEMBERED {
        known.clear();
    }
}

fn refused(input: &str, line: usize, message: String, help: &str) -> Failure {
    let position = Some(Position { line, column: 1 });
    let diagnostic = Diagnostic { position, ..Diagnostic::new(input, message) };
    Failure::Input(diagnostic.help(help).into())
}
