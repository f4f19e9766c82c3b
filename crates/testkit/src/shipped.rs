//! The worlds in `workspaces`, and the statements in their first comments.

use crate::root;
use cplan::input::{self, Overrides};
use cplan::model::MotionProblem;
use cplan::{Plan, Problem};
use std::path::PathBuf;

/// A shipped world. Its first comments state the robot (`# robot: scara`) and the outcome (`# expect: found`).
#[derive(Debug, Clone)]
pub struct Shipped {
    /// Name of the file, without the extension.
    pub name: String,
    /// File of the robot.
    pub robot: PathBuf,
    /// File of the world.
    pub world: PathBuf,
    /// Stated outcome.
    pub expect: String,
    text: String,
}

impl Shipped {
    /// Returns the value of a line `# key: value`; empty if there is none.
    pub fn stated(&self, key: &str) -> &str {
        self.text.lines().find_map(|line| line.strip_prefix(&format!("# {key}:"))).unwrap_or_default().trim()
    }

    /// Returns the problem, which may be a task.
    pub fn problem(&self) -> Problem {
        Problem::load(&self.robot, &self.world).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Returns the problem of a single motion.
    pub fn motion(&self) -> MotionProblem {
        let loaded = input::load(&self.robot, &self.world, &Overrides::default());
        loaded.unwrap_or_else(|error| panic!("{error}")).problem
    }
}

/// Returns the file of a shipped robot.
pub fn robot(name: &str) -> PathBuf {
    root().join(format!("robots/{name}.urdf"))
}

/// Returns a shipped world, such as `shelf` or `tasks/feeder`, for the robot that it states.
pub fn world(name: &str) -> Shipped {
    let world = root().join(format!("workspaces/{name}.toml"));
    let text = std::fs::read_to_string(&world).unwrap_or_else(|error| panic!("{name}: {error}"));
    let name = world.file_stem().unwrap().to_string_lossy().into_owned();
    let shipped = Shipped { name, robot: PathBuf::new(), world, expect: String::new(), text };
    let expect = shipped.stated("expect").to_owned();
    Shipped { robot: robot(shipped.stated("robot")), expect, ..shipped }
}

/// Returns all worlds in a folder of `workspaces` that state a robot, ordered by name.
pub fn worlds(folder: &str) -> Vec<Shipped> {
    let files = std::fs::read_dir(root().join("workspaces").join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let names = files.filter(|file| file.extension().is_some_and(|extension| extension == "toml"));
    let mut names: Vec<_> = names.map(|file| file.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    let worlds = names.into_iter().map(|name| world(&format!("{folder}/{name}")));
    worlds.filter(|shipped| !shipped.stated("robot").is_empty()).collect()
}

/// Returns the plan of a shipped world for another robot than the stated one, or with other options.
pub fn plan(robot_name: &str, world_name: &str, options: &cplan::Options) -> Plan {
    let problem = Problem::load(robot(robot_name), world(world_name).world).unwrap_or_else(|error| panic!("{error}"));
    cplan::plan(&problem, options).unwrap()
}
