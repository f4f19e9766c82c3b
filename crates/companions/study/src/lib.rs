//! Studies: one task in many layouts.
//!
//! A [`Study`] consists of a robot in a world, of parameters that set numbers in their files, and of measures. A layout
//! is the same pair of files with other numbers. So parameters can set any number of the files, and each layout can be
//! written to files and planned separately ([`Study::layout`]). A layout's row depends only on its number and the
//! files, not on threads, machines or interruptions.
//!
//! ```text
//! study.toml -> Study -> Row, Row, ... -> Table -> CSV; Parquet with the feature `parquet`
//!                 |        (journal)        |
//!               search                    Summary, page
//! ```

mod address;
mod answer;
mod drawings;
mod file;
mod journal;
mod measure;
mod overlap;
mod page;
mod parameter;
#[cfg(feature = "parquet")]
mod parquet_table;
mod pictures;
mod row;
mod schema;
mod search;
mod shades;
mod summary;
mod swarm;
mod table;
mod template;

pub use file::ReadOptions;
pub use journal::{Journal, JournalError};
pub use measure::{Condition, Measure, Objective};
pub use parameter::{Parameter, Values};
pub use pictures::pictures;
pub use row::{Ending, Row};
pub use summary::Summary;

use cplan_engine::{Plan, Problem, plan};
use cplan_parallel::{caught, run_in_order};
use cplan_robot::{InputError, RobotFile, Source};
use cplan_solver::{Options, solve};
use cplan_tasks::SEARCHES;
use cplan_world::{LoadedScene, Overrides};
use file::NamedFile;
use overlap::overlap;
use parameter::Design;
use std::ops::Range;
use std::path::{Path, PathBuf};
use template::Template;

/// A task in many layouts.
#[derive(Debug, Clone)]
pub struct Study {
    /// The title of tables and pages.
    pub name: String,
    /// The parameters, which vary between layouts.
    pub parameters: Vec<Parameter>,
    /// The measures, in the order of the columns.
    pub measures: Vec<Measure>,
    /// Conditions on layouts.
    pub conditions: Vec<Condition>,
    /// The objective that ranks layouts.
    pub objective: Option<Objective>,
    /// Largest number of layouts that the search for a better layout may try.
    pub searched: usize,
    /// Seed of the random numbers of draws and search.
    seed: u64,
    /// The study file.
    source: Source,
    design: Design,
    world: Template,
    urdf: Template,
    /// Robot and world as the files state them, before parameters set any numbers.
    base: LoadedScene,
    options: Options,
    /// The planning options as text.
    words: Vec<String>,
    /// True if layouts may have overlapping obstacles that do not overlap in the world file.
    may_overlap: bool,
    overrides: Overrides,
}

impl Study {
    /// Returns warnings and assumptions about the robot, as in [`cplan_robot::RobotReport::remarks`].
    pub fn remarks(&self) -> Vec<String> {
        self.base.robot.remarks(self.base.scene.arm())
    }

    /// Returns the paths of all files that were read, beginning with the study file.
    pub fn files(&self) -> Vec<PathBuf> {
        self.source.files().into_iter().chain(self.base.files()).collect()
    }

    /// Reads a study file, and the robot and the world that it names. `robot` states how to convert the robot's file.
    ///
    /// # Errors
    /// All defects of the files, with line, column and hint.
    pub fn load(
        path: impl AsRef<Path>,
        read_options: ReadOptions,
        robot: &dyn Fn(PathBuf) -> RobotFile,
    ) -> Result<Self, InputError> {
        file::load(path.as_ref(), read_options, robot)
    }

    /// Reads a study from the texts of the study file, of the robot and of the world.
    ///
    /// # Errors
    /// All defects of the texts, with line, column and hint.
    pub fn from_sources([study, urdf, world]: [Source; 3], read_options: ReadOptions) -> Result<Self, InputError> {
        file::read(&study, read_options, &|which, _| {
            Ok(if which == NamedFile::Robot { urdf.clone() } else { world.clone() })
        })
    }

    /// Returns the texts of study, robot and world. [`Study::from_sources`] creates the same study from them. In the
    /// world's text, defaults that parameters set are written out.
    pub fn sources(&self) -> [&Source; 3] {
        [&self.source, self.urdf.source(), self.world.source()]
    }

    /// Returns the planning options as text.
    pub fn options(&self) -> &[String] {
        &self.words
    }

    /// Returns true if parameters set numbers of the robot.
    pub fn varies_robots(&self) -> bool {
        !self.urdf.is_fixed()
    }

    /// Returns the number of layouts that are listed or drawn. Layouts of the search are not included.
    pub fn count(&self) -> usize {
        self.design.count()
    }

    /// Returns the values of a layout, one per parameter.
    pub fn values(&self, layout: usize) -> Vec<f64> {
        self.design.values(layout)
    }

    /// Returns the column of a measure in [`Row::measured`].
    pub fn column(&self, measure: Measure) -> Option<usize> {
        self.measures.iter().position(|m| *m == measure)
    }

    /// Returns the texts of world and robot with these values of the parameters.
    pub fn layout(&self, values: &[f64]) -> [Source; 2] {
        [self.world.filled(values), self.urdf.filled(values)]
    }

    /// Returns the problem with these values of the parameters.
    ///
    /// # Errors
    /// Invalid values; overlapping obstacles; a start or goal that is out of reach or not free.
    pub fn problem(&self, values: &[f64]) -> Result<Problem, InputError> {
        let [world, urdf] = self.layout(values);
        let scene = match self.urdf.is_fixed() {
            true => self.base.with_world_text(&urdf, world)?,
            false => cplan_world::scene_from(urdf, world)?,
        };
        if !self.may_overlap
            && let Some(why) =
                overlap(&self.base.world.workspace.fixed.obstacles, &scene.world.workspace.fixed.obstacles)
        {
            let source = self.world.source();
            return Err(source.diagnostic(why).help("if overlaps are allowed, set overlap = true in the study").into());
        }
        Problem::of_scene(scene, &self.overrides)
    }

    /// Plans with these values of the parameters.
    ///
    /// # Errors
    /// The errors of [`Study::problem`], and the reasons for which planning is refused.
    pub fn plan(&self, values: &[f64]) -> Result<Plan, String> {
        let problem = self.problem(values).map_err(|error| describe_error(&error))?;
        plan(&problem, &self.options, SEARCHES, &mut |_| ()).map_err(|error| error.to_string())
    }

    /// Plans a layout and returns its row.
    pub fn row(&self, layout: usize) -> Row {
        self.row_of(layout, self.values(layout))
    }

    fn row_of(&self, layout: usize, values: Vec<f64>) -> Row {
        // An error in one layout becomes its row. An interruption of the whole study also unwinds, but is passed on.
        let judged = caught(|| self.measure_layout(&values)).unwrap_or_else(Err);
        let (ending, reason, measured) = match judged {
            Ok(judged) => judged,
            Err(reason) => (Ending::Refused, Some(reason), vec![None; self.measures.len()]),
        };
        let of = |measure: Measure| self.column(measure).and_then(|column| measured[column]);
        let fits =
            ending == Ending::Found && self.conditions.iter().all(|condition| condition.holds(of(condition.measure)));
        Row { layout, values, ending, reason, measured, fits }
    }

    /// Plans with these values and measures the result.
    fn measure_layout(&self, values: &[f64]) -> Result<LayoutResult, String> {
        let problem = self.problem(values).map_err(|error| describe_error(&error))?;
        if let Some(lack) = self.options.planner.missing_preference(&problem.scene().workspace().preferences) {
            return Err(lack);
        }
        if let (Some(motion), true) = (problem.motion(), self.measures.iter().all(|measure| measure.is_of_the_path())) {
            // If only the path is measured, no motion is computed.
            let answer = solve(motion, &self.options, &mut |_| ());
            let (length, bound) = (answer.path().map(|path| path.length()), answer.bound());
            let measured = self.measures.iter().map(|measure| measure.of_path(length, bound)).collect();
            return Ok((answer.outcome.status().into(), answer.reason(), measured));
        }
        let plan = plan(&problem, &self.options, SEARCHES, &mut |_| ()).map_err(|error| error.to_string())?;
        let measured = self.measures.iter().map(|measure| measure.of(&plan)).collect();
        let ending: Ending = plan.status().into();
        // The reason of a task begins with the ending, which is a column of its own in tables.
        let reason = plan.reason().map(|reason| match reason.strip_prefix(&format!("{}: ", ending.name())) {
            Some(rest) => rest.to_owned(),
            None => reason,
        });
        Ok((ending, reason, measured))
    }

    /// Computes the rows of these layouts on `jobs` threads. Passes the rows to `each` in order, each as soon as it and
    /// all earlier rows are known.
    ///
    /// # Errors
    /// The error of `each`.
    pub fn rows<E>(&self, layouts: Range<usize>, jobs: usize, each: impl FnMut(Row) -> Result<(), E>) -> Result<(), E> {
        run_in_order(layouts.len(), jobs, |i| self.row(layouts.start + i), each)
    }
}

/// The ending, the reason if there is no motion, and the measured values.
type LayoutResult = (Ending, Option<String>, Vec<Option<f64>>);

/// Describes the first defect on one line. Omits its position, because the files of a layout exist only in memory.
fn describe_error(error: &InputError) -> String {
    error.diagnostics().first().map_or_else(|| error.to_string(), |first| first.message.clone())
}
