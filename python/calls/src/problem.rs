//! Problems: an arm, a world, options.

use crate::error::Refusal;
use cplan::Joint;
use cplan::cli::scara_urdf;
use cplan::input::{self, LoadedScene, Overrides, RobotFile, Source, scene_from, scene_of};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A planar two-joint arm: a robot in URDF, or one that is made in code.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Arm {
    /// A robot in URDF.
    Urdf(Source),
    /// An arm that is made in code.
    Made(Box<cplan::Arm>),
}

/// Numbers of an arm that is made in code; missing ones have defaults.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
pub struct ArmNumbers {
    /// Lower and upper limit of each joint, in radians.
    pub limits: Option<[(f64, f64); 2]>,
    /// Top speed of each joint, in rad/s.
    pub velocity: Option<[f64; 2]>,
    /// Acceleration of each joint, in rad/s2.
    pub acceleration: Option<[f64; 2]>,
}

impl Arm {
    /// Reads a URDF or xacro file; `arguments` replace the defaults of its arguments.
    ///
    /// # Errors
    /// The defects of the file.
    pub fn read(path: PathBuf, arguments: BTreeMap<String, String>) -> Result<Self, Refusal> {
        let arguments = arguments.into_iter().collect();
        Ok(Self::Urdf(RobotFile { arguments, ..input::robot(path) }.read()?))
    }

    /// Creates an arm from a URDF text. `name` appears in messages.
    pub fn of_text(text: String, name: &str) -> Self {
        Self::Urdf(Source::in_memory(name, text))
    }

    /// Creates an arm of two bars with round ends, of these lengths and this width in metres.
    ///
    /// # Errors
    /// Impossible numbers.
    pub fn rr(lengths: [f64; 2], width: f64, numbers: &ArmNumbers) -> Result<Self, Refusal> {
        let mut arm = cplan::Arm::rr(lengths, width).map_err(Refusal::value)?;
        for (k, joint) in arm.joints.iter_mut().enumerate() {
            if let Some((lower, upper)) = numbers.limits.map(|limits| limits[k]) {
                *joint = Joint::turning(&joint.name, lower, upper);
            }
            let speed = numbers.velocity.map_or(joint.velocity, |velocity| velocity[k]);
            let acceleration = joint.acceleration * speed / joint.velocity;
            *joint = joint.clone().at_most(speed, numbers.acceleration.map_or(acceleration, |all| all[k]));
        }
        Ok(Self::Made(Box::new(arm)))
    }

    /// Creates a SCARA by the numbers of its data sheet: lengths of both links and travel of the quill, in metres.
    ///
    /// # Errors
    /// Impossible numbers.
    pub fn scara(links: Option<[f64; 2]>, stroke: Option<f64>, numbers: &ArmNumbers) -> Result<Self, Refusal> {
        let urdf = scara_urdf(links, stroke, numbers.limits, numbers.velocity).map_err(Refusal::value)?;
        Ok(Self::of_text(urdf, "arm.urdf"))
    }

    /// Returns the URDF; `None` for an arm that is made in code.
    pub fn source(&self) -> Option<&Source> {
        if let Self::Urdf(source) = self { Some(source) } else { None }
    }

    /// Reads the arm together with its world.
    ///
    /// # Errors
    /// The defects of both.
    pub fn among(&self, world: &World) -> Result<LoadedScene, Refusal> {
        let world = world.source.clone();
        Ok(match self {
            Self::Urdf(source) => scene_from(source.clone(), world),
            Self::Made(arm) => scene_of(*arm.clone(), world),
        }?)
    }

    /// Returns the names of the two joints that are planned in a world, base to tip.
    ///
    /// # Errors
    /// The defects of arm and world.
    pub fn joints(&self, world: &World) -> Result<[String; 2], Refusal> {
        Ok(self.among(world)?.scene.arm().joints.each_ref().map(|joint| joint.name.clone()))
    }

    /// Returns the text that Python prints for the object.
    pub fn description(&self) -> String {
        match self {
            Self::Urdf(source) => format!("<cplan.Arm: URDF of {} characters>", source.text().len()),
            Self::Made(arm) => format!("<cplan.Arm: {} with a reach of {} m>", arm.kind(), arm.reach()),
        }
    }
}

/// A polygonal workspace, with start and goal or steps: the text of a world file (TOML).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct World {
    source: Source,
}

impl World {
    /// Reads a world file.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: PathBuf) -> Result<Self, Refusal> {
        Ok(Self::of(Source::read(&path)?))
    }

    /// Creates a world from a world file.
    pub fn of(source: Source) -> Self {
        Self { source }
    }

    /// Creates a world from the text of a world file. `name` appears in messages.
    pub fn of_text(text: String, name: &str) -> Self {
        Self::of(Source::in_memory(name, text))
    }

    /// Creates a world from the keys of a world file, as a JSON object.
    ///
    /// # Errors
    /// Values that TOML does not have.
    pub fn of_keys(json: &str) -> Result<Self, Refusal> {
        let keys: serde_json::Value = serde_json::from_str(json).map_err(Refusal::value)?;
        Ok(Self::of_text(toml::to_string(&keys).map_err(Refusal::value)?, "World(...)"))
    }

    /// Returns the world file.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Returns the text that Python prints for the object.
    pub fn description(&self) -> String {
        format!("<cplan.World: TOML of {} lines>", self.source.text().lines().count())
    }
}

/// Options of a plan, which can also replace the world's start, goal and clearance.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(try_from = "Vec<String>")]
pub struct Options {
    words: Vec<String>,
    /// Options of the planner.
    pub options: cplan::Options,
    /// Values that replace those of the world.
    pub overrides: Overrides,
}

impl Options {
    /// Parses words such as `--planner=harmonic`.
    ///
    /// # Errors
    /// The defect, in a line or two.
    pub fn parse(words: Vec<String>) -> Result<Self, String> {
        if words.is_empty() {
            return Ok(Self::default());
        }
        let (options, overrides) = cplan::cli::read_words(&words)?;
        Ok(Self { words, options, overrides })
    }

    /// Returns the words.
    pub fn words(&self) -> &[String] {
        &self.words
    }
}

impl TryFrom<Vec<String>> for Options {
    type Error = String;

    fn try_from(words: Vec<String>) -> Result<Self, String> {
        Self::parse(words)
    }
}

/// Creates a problem.
///
/// # Errors
/// All defects of arm, world, start and goal.
pub fn problem(arm: &Arm, world: &World, options: &Options) -> Result<cplan::Problem, Refusal> {
    Ok(cplan::Problem::of_scene(arm.among(world)?, &options.overrides)?)
}

/// Returns the notes of a problem for the user, line by line.
pub fn notes(problem: &cplan::Problem) -> Vec<String> {
    let robot = problem.robot();
    let assumptions = robot.assumptions(problem.scene().arm());
    robot.warnings.iter().chain(problem.notes()).cloned().chain(assumptions).collect()
}
