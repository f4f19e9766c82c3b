//! The problems of a comparison: a single one, those of a suite, or random ones.

use super::args::CompareArgs;
use super::pairs::free_pairs;
use super::recorded::file_stem;
use crate::cli::failure::Failure;
use crate::compare::{Refusal, Sampling};
use crate::input::{self, DiagnosticKind, ExcludedWorld, LoadedScene, Overrides, RefusedProblem, Suite};
use crate::model::MotionProblem;
use crate::output::title_of;
use crate::space::Configuration;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The problems on which planners are compared, read and checked.
pub struct Cases {
    /// Title of all problems.
    pub title: String,
    /// The problems, at least one.
    pub cases: Vec<Case>,
    /// The sampling of random queries. `None` for the queries of the worlds.
    pub sampling: Option<Sampling>,
    /// Problems that were left out, each with the reason, on one line.
    pub left_out: Vec<String>,
    /// Problems that could not be run.
    pub refused: Vec<Refusal>,
    /// Warnings about the robots, one line each.
    pub warnings: Vec<String>,
    /// Paths of the files that were read.
    pub files: Vec<PathBuf>,
}

/// A problem of the comparison: a robot in a world.
#[derive(Clone)]
pub struct Case {
    /// Name of the problem in tables.
    pub name: String,
    /// Name of files about the problem, without extension.
    pub file: String,
    /// Index of the case's world, from 0.
    pub world: usize,
    /// The robot and the world, without values of the command line.
    pub scene: Arc<LoadedScene>,
    /// The problem with the world's own start and goal. For random queries, start and goal have no meaning.
    pub base: Arc<MotionProblem>,
    /// Start and goal of a random query. `None` for the world's own query.
    pub query: Option<[Configuration; 2]>,
}

impl Case {
    /// Returns the problem. For a random query it is created on demand, because a million stored problems would take
    /// too much memory.
    pub fn problem(&self) -> Cow<'_, MotionProblem> {
        match self.query {
            None => Cow::Borrowed(&self.base),
            Some([start, goal]) => Cow::Owned(MotionProblem::trusted(self.base.scene().clone(), start, goal)),
        }
    }
}

impl Cases {
    /// Reads the files that the arguments name.
    ///
    /// # Errors
    /// All diagnostics of all files together.
    pub fn load(args: &CompareArgs) -> Result<Self, Failure> {
        let suite = match (&args.urdf, &args.world, &args.suite) {
            (Some(urdf), Some(world), _) => single_robot_suite(input::load_scene(args.xacro.robot(urdf), world)?),
            (Some(urdf), None, Some(folder)) => input::load_folder(args.xacro.robot(urdf), folder)?,
            (_, _, Some(place)) => input::load_suite(place, &input::robot)?,
            _ => return Err(Failure::Usage("URDF and WORLD are required, or --suite".into())),
        };
        Self::of_suite(suite, args)
    }

    /// Creates the cases for a robot in a world that has been read.
    ///
    /// # Errors
    /// The errors of [`Cases::load`].
    pub fn of_scene(scene: LoadedScene, args: &CompareArgs) -> Result<Self, Failure> {
        Self::of_suite(single_robot_suite(scene), args)
    }

    fn of_suite(suite: Suite, args: &CompareArgs) -> Result<Self, Failure> {
        let left_out = |ExcludedWorld { world, why }: &ExcludedWorld| {
            format!("{} is left out: {why}; only `cplan plan` plans such worlds", world.display())
        };
        let left_out = suite.left_out.iter().map(left_out).collect();
        let mut warnings: Vec<String> = Vec::new();
        for warning in suite.members.iter().flat_map(|member| &member.scene.robot.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        for member in &suite.members {
            member.scene.require_static_obstacles("comparisons need static obstacles")?;
        }
        let (mut name, files) = (suite.name.clone(), suite.files.clone());
        let read: HashMap<String, Arc<LoadedScene>> =
            suite.members.iter().map(|member| (member.name.clone(), Arc::new(member.scene.clone()))).collect();
        let overrides = args.query.overrides();
        let (bases, refused) =
            if args.queries.is_some() { scenes(suite, &overrides)? } else { problems(suite, &overrides)? };
        let mut refused: Vec<Refusal> = refused.iter().map(refusal).collect();
        if let [(_, only)] = &bases[..]
            && args.suite.is_none()
        {
            name = title_of(only.scene());
        }
        let sampling = args.queries.map(|queries| Sampling { queries: queries as usize, seed: args.seed });
        let mut cases = Vec::new();
        // Worlds have consecutive numbers.
        let mut world = 0;
        for (member, problem) in bases {
            let scene = read[&member].clone();
            let name = if args.is_single() { title_of(problem.scene()) } else { member.clone() };
            let file = file_stem(&member);
            let whole = Case { name: name.clone(), file, world, scene, base: Arc::new(problem), query: None };
            match drawn(whole, sampling) {
                Ok(drawn) => {
                    cases.extend(drawn);
                    world += 1;
                }
                Err(reason) if args.suite.is_some() => refused.push(Refusal { problem: name, kind: "input", reason }),
                Err(reason) => return Err(Failure::Refused(reason)),
            }
        }
        if let ([], Some(Refusal { reason, .. })) = (&cases[..], refused.first()) {
            return Err(Failure::Refused(reason.clone()));
        }
        let title = match sampling {
            Some(Sampling { queries, seed }) if args.suite.is_some() => {
                format!("{name}: {queries} random queries per world, seed {seed}")
            }
            Some(Sampling { queries, seed }) => format!("{name}: {queries} random queries, seed {seed}"),
            None => name,
        };
        Ok(Self { title, cases, sampling, left_out, refused, warnings, files })
    }
}

/// Returns a suite of problems that consists of one robot in its world.
fn single_robot_suite(scene: LoadedScene) -> Suite {
    let name = scene.scene.workspace().name.clone();
    Suite {
        files: scene.files(),
        name: name.clone(),
        members: vec![input::Member { name, scene }],
        left_out: Vec::new(),
        refused: Vec::new(),
    }
}

/// Problems with their names, and those that cannot be run.
type LoadedProblems = (Vec<(String, MotionProblem)>, Vec<RefusedProblem>);

/// Returns the problems with the start and goal of their worlds, or with those of the command line.
fn problems(suite: Suite, overrides: &Overrides) -> Result<LoadedProblems, Failure> {
    let (problems, refused) = suite.problems(overrides)?;
    Ok((problems.into_iter().map(|(name, loaded)| (name, loaded.problem)).collect(), refused))
}

/// Returns the reason why a problem is not run, on one line.
fn refusal(refused: &RefusedProblem) -> Refusal {
    let diagnostic = refused.error.diagnostics().first();
    let kind = match diagnostic.map(|diagnostic| diagnostic.kind) {
        Some(DiagnosticKind::Start) => "start",
        Some(DiagnosticKind::Goal) => "goal",
        _ => "input",
    };
    let reason = refused.error.to_string().lines().next().unwrap_or_default().to_owned();
    Refusal { problem: refused.name.clone(), kind, reason }
}

/// Returns the scenes for random queries. The start and goal of a world are not used here, so they may be missing or
/// blocked.
fn scenes(suite: Suite, overrides: &Overrides) -> Result<LoadedProblems, Failure> {
    let scene = |member: input::Member| {
        // Only a world from the command line can have steps here. The request for its goal then reports the error.
        if member.scene.is_task() {
            member.scene.clone().problem(overrides)?;
        }
        let scene = member.scene.with_margins(overrides.clearance, overrides.calibration)?.scene;
        let nowhere = Configuration::zeros();
        Ok((member.name, MotionProblem::trusted(scene, nowhere, nowhere)))
    };
    let scenes: Result<Vec<_>, Failure> = suite.members.into_iter().map(scene).collect();
    Ok((scenes?, suite.refused))
}

/// Returns the problem itself, or random queries in its scene if `sampling` is given.
///
/// # Errors
/// A message if hardly any configuration is free.
fn drawn(whole: Case, sampling: Option<Sampling>) -> Result<Vec<Case>, String> {
    let Some(Sampling { queries, seed }) = sampling else { return Ok(vec![whole]) };
    let scene = whole.base.scene();
    let Some(pairs) = free_pairs(scene, queries, seed) else {
        return Err(format!(
            "--queries: almost no configuration of {} keeps the clearance of {} m; use a smaller --clearance, or a world \
             with more room",
            whole.name,
            scene.workspace().clearance
        ));
    };
    let width = queries.to_string().len();
    let case = |(i, pair)| Case {
        name: format!("{} #{:0width$}", whole.name, i + 1),
        file: format!("{}_{:0width$}", whole.file, i + 1),
        query: Some(pair),
        ..whole.clone()
    };
    Ok(pairs.into_iter().enumerate().map(case).collect())
}
