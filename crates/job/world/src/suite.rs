//! Several problems: those in a manifest, or one robot in all worlds of a folder.

use super::{LoadedProblem, LoadedScene, Overrides, RobotFile, load_scene};
use cplan_robot::{Diagnostic, InputError, Source, Spanned, toml_table};
use std::path::{Path, PathBuf};

/// Name of the manifest in a folder.
pub const MANIFEST_NAME: &str = "suite.toml";

/// Robots in their worlds, in the order in which they are listed.
#[derive(Debug, Clone)]
pub struct Suite {
    /// The title of the suite.
    pub name: String,
    /// The worlds that were read, at least one. Their names are distinct.
    pub members: Vec<Member>,
    /// Worlds in which planners cannot be compared.
    pub left_out: Vec<ExcludedWorld>,
    /// Problems that cannot be read.
    pub refused: Vec<RefusedProblem>,
    /// Paths of all files that were read.
    pub files: Vec<PathBuf>,
}

/// A world that is left out because planners cannot be compared in it.
#[derive(Debug, Clone)]
pub struct ExcludedWorld {
    /// The world file.
    pub world: PathBuf,
    /// The reason, as a clause that follows the word "it".
    pub why: &'static str,
}

/// A problem that cannot be read, or whose start or goal is invalid.
#[derive(Debug, Clone)]
pub struct RefusedProblem {
    /// Name of the problem in tables.
    pub name: String,
    /// The reason.
    pub error: InputError,
}

/// A robot in a world.
#[derive(Debug, Clone)]
pub struct Member {
    /// Name of the problem in tables.
    pub name: String,
    /// The scene, as from [`load_scene`].
    pub scene: LoadedScene,
}

toml_table! {
    struct ManifestFile {
        name: Option<String>,
        problem: Vec<ProblemTable>,
    }

    struct ProblemTable {
        name: Option<Spanned<String>>,
        robot: Spanned<String>,
        world: Spanned<String>,
    }
}

/// A robot file and a world file that have not been read yet.
struct Pair {
    name: Option<String>,
    robot: RobotFile,
    world: PathBuf,
}

/// Reads the problems that a manifest lists. `place` is the manifest, or a folder with a manifest named [`MANIFEST_NAME`]. Paths
/// in a manifest are relative to its folder.
///
/// ```toml
/// name = "two tables"          # optional
///
/// [[problem]]
/// robot = "../robots/scara.urdf"
/// world = "tray.toml"
/// name = "tray"                # optional; the world's file name without it
/// ```
///
/// `robot_file` converts the path of a robot's file.
///
/// # Errors
/// [`InputError`] if the manifest cannot be read, or none of its problems can; the error then has the diagnostics of all files.
/// If only some problems cannot be read, they are in [`Suite::refused`].
pub fn load_suite(place: &Path, robot_file: &dyn Fn(PathBuf) -> RobotFile) -> Result<Suite, InputError> {
    let manifest = if place.is_dir() { place.join(MANIFEST_NAME) } else { place.to_owned() };
    if place.is_dir() && !manifest.is_file() {
        let message = format!("this folder has no {MANIFEST_NAME}, the file that assigns robots to worlds");
        let help = format!(
            "write this file, with robot = \"arm.urdf\" and world = \"world.toml\" in a [[problem]] for each world; or name a robot for all worlds: cplan compare URDF --suite {}",
            place.display()
        );
        return Err(Diagnostic::new(place.display().to_string(), message).help(help).into());
    }
    let source = Source::read(&manifest)?;
    let hint = "write TOML, with robot = \"arm.urdf\" and world = \"world.toml\" in a [[problem]] for each world";
    let file: ManifestFile = source.toml(&|_, _| hint)?;
    let beside = |name: &Spanned<String>, what: &str| {
        let path = manifest.with_file_name("").join(name.get_ref());
        if path.is_file() {
            return Ok(path);
        }
        let message = format!("{what}: there is no file {}", path.display());
        Err(source.diagnostic_at(name.span(), message).help("paths are relative to the manifest"))
    };
    let (mut pairs, mut refused) = (Vec::new(), Vec::new());
    for problem in file.problem {
        let paths = [(&problem.robot, "robot"), (&problem.world, "world")].map(|(name, what)| beside(name, what));
        match paths {
            [Ok(robot), Ok(world)] => {
                pairs.push(Pair { name: problem.name.map(Spanned::into_inner), robot: robot_file(robot), world });
            }
            paths => {
                let name = problem.name.map_or_else(|| stem(Path::new(problem.world.get_ref())), Spanned::into_inner);
                refused.push(RefusedProblem {
                    name,
                    error: InputError::of(paths.into_iter().filter_map(Result::err).collect()),
                });
            }
        }
    }
    if pairs.is_empty() && refused.is_empty() {
        let diagnostic = source.diagnostic("the manifest lists no problem");
        return Err(diagnostic.help("add a [[problem]] with robot = \"arm.urdf\" and world = \"world.toml\"").into());
    }
    let name = file.name.unwrap_or_else(|| folder_name(&manifest.with_file_name("")));
    let mut suite = read(name, pairs, refused)?;
    suite.files.push(manifest);
    Ok(suite)
}

/// Reads one robot in all worlds of a folder: every file `.toml` except [`MANIFEST_NAME`], ordered by name.
///
/// # Errors
/// [`InputError`] if the folder has no worlds, or none of them can be read; the error then has the diagnostics of all files. If
/// only some worlds cannot be read, they are in [`Suite::refused`].
pub fn load_folder(robot: impl Into<RobotFile>, folder: &Path) -> Result<Suite, InputError> {
    let whole = |message: String| Diagnostic::new(folder.display().to_string(), message);
    let entries = std::fs::read_dir(folder).map_err(|error| {
        whole(format!("cannot be read as a folder: {error}")).help("give a folder with world files (.toml)")
    })?;
    let mut worlds: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    worlds.retain(|path| {
        path.is_file()
            && path.extension().is_some_and(|e| e == "toml")
            && path.file_name().is_some_and(|n| n != MANIFEST_NAME)
    });
    worlds.sort();
    if worlds.is_empty() {
        return Err(whole("the folder contains no world".into()).help("give a folder with world files (.toml)").into());
    }
    let robot = robot.into();
    let pairs = worlds.into_iter().map(|world| Pair { name: None, robot: robot.clone(), world }).collect();
    read(folder_name(folder), pairs, Vec::new())
}

fn read(name: String, pairs: Vec<Pair>, mut refused: Vec<RefusedProblem>) -> Result<Suite, InputError> {
    let (mut members, mut left_out) = (Vec::<Member>::new(), Vec::new());
    let mut files = Vec::new();
    for Pair { name, robot, world } in pairs {
        files.extend([robot.path.clone(), world.clone()]);
        let scene = load_scene(&robot, &world);
        files.extend(scene.iter().flat_map(LoadedScene::files));
        match scene {
            Ok(scene) if scene.is_task() => {
                let why = if scene.has_steps() { "it has steps, not a goal" } else { "it moves the tool" };
                left_out.push(ExcludedWorld { world, why });
            }
            Ok(scene) if scene.has_moving_obstacles() => {
                left_out.push(ExcludedWorld { world, why: "it has moving obstacles or objects" })
            }
            Ok(scene) => {
                let name = name.unwrap_or_else(|| stem(&world));
                let name = distinct(&name, &stem(&robot.path), |name| members.iter().any(|member| member.name == name));
                members.push(Member { name, scene });
            }
            Err(error) => refused.push(RefusedProblem { name: name.unwrap_or_else(|| stem(&world)), error }),
        }
    }
    if members.is_empty() {
        all_of(&refused)?;
    }
    if let (true, Some(ExcludedWorld { world, why })) = (members.is_empty(), left_out.first()) {
        let message = format!("the suite has no world that can be compared; the reason for this one: {why}");
        return Err(Diagnostic::new(world.display().to_string(), message)
            .help("comparisons need worlds with static obstacles and a [goal]: replace steps by a goal, and remove motions")
            .into());
    }
    Ok(Suite { name, members, left_out, refused, files })
}

/// Returns the defects of all these problems as one error.
///
/// # Errors
/// All defects, if there are any.
fn all_of(refused: &[RefusedProblem]) -> Result<(), InputError> {
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    for diagnostic in refused.iter().flat_map(|refused| refused.error.diagnostics()) {
        // A diagnostic about the robot recurs in every world, but is reported once.
        if !diagnostics.contains(diagnostic) {
            diagnostics.push(diagnostic.clone());
        }
    }
    InputError::check(diagnostics)
}

impl Suite {
    /// Reads start and goal of every scene, as [`LoadedScene::problem`] does. Adds invalid problems to the refused ones.
    ///
    /// # Errors
    /// [`InputError`] with the diagnostics of all problems, if no valid problem is left.
    pub fn problems(self, overrides: &Overrides) -> Result<LoadedProblems, InputError> {
        let (mut problems, mut refused) = (Vec::new(), self.refused);
        for Member { name, scene } in self.members {
            match scene.problem(overrides) {
                Ok(loaded) => problems.push((name, loaded)),
                Err(error) => refused.push(RefusedProblem { name, error }),
            }
        }
        if problems.is_empty() {
            all_of(&refused)?;
        }
        Ok((problems, refused))
    }
}

/// Valid problems with their names, and refused problems.
pub type LoadedProblems = (Vec<(String, LoadedProblem)>, Vec<RefusedProblem>);

/// Returns a file's name without its extension.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| path.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}

/// Returns the name of a folder, also for a path that is `..` or empty.
fn folder_name(folder: &Path) -> String {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    whole.file_name().map_or_else(|| whole.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// Returns `name` if it is free; otherwise appends the robot's name and, if necessary, a number.
fn distinct(name: &str, robot: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let with_robot = format!("{name}, {robot}");
    let numbered = (2_usize..).map(|number| format!("{with_robot}, {number}"));
    let mut all = [name.to_owned(), with_robot.clone()].into_iter().chain(numbered);
    all.find(|name| !is_taken(name)).unwrap_or(with_robot)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_made_distinct() {
        let mut names: Vec<String> = Vec::new();
        for robot in ["a", "a", "b", "a"] {
            let name = distinct("shelf", robot, |name| names.iter().any(|known| known == name));
            names.push(name);
        }
        assert_eq!(names, ["shelf", "shelf, a", "shelf, b", "shelf, a, 2"]);
    }

    #[test]
    fn folders_have_names_however_they_are_given() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("lab.v2")).unwrap();
        assert_eq!(folder_name(&folder.path().join("lab.v2")), "lab.v2");
        assert_eq!(folder_name(&folder.path().join("lab.v2/../lab.v2/.")), "lab.v2");
        assert!(!folder_name(Path::new("")).is_empty());
    }
}
