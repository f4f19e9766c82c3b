//! Studies: one task in many layouts.
//!
//! A [`Study`] is a robot in a world, parameters that set numbers of both, and what is measured. A layout is the same two files with other
//! numbers in place, so whatever the files can say can be varied, and each layout can be written as files and planned in by itself
//! ([`Study::layout`]). What a layout's row says follows from its number and the files alone: rows are the same for any number of
//! threads, machines and interruptions.
//!
//! ```text
//! study.toml -> Study -> Row, Row, ... -> Table -> CSV; Parquet with the feature `parquet`
//!                 |        (journal)        |
//!               search                    Summary, page
//! ```

mod address;
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
pub use schema::study_schema;
pub use summary::Summary;

use cplan_engine::{Options, Plan, Problem, plan, solve};
use cplan_parallel::{caught, in_order};
use cplan_robot::{InputError, Source};
use cplan_world::{LoadedScene, Overrides};
use file::Named;
use overlap::overlap;
use parameter::Design;
use std::ops::Range;
use std::path::Path;
use template::Template;

/// A task in many layouts.
#[derive(Debug, Clone)]
pub struct Study {
    /// The title of tables and pages.
    pub name: String,
    /// What differs from layout to layout.
    pub parameters: Vec<Parameter>,
    /// What is measured, in the order of the columns.
    pub measures: Vec<Measure>,
    /// What layouts must meet.
    pub conditions: Vec<Condition>,
    /// By what layouts are better.
    pub objective: Option<Objective>,
    /// Layouts that may be tried to find a better one.
    pub searched: usize,
    /// What draws and search follow from.
    seed: u64,
    /// The study file.
    source: Source,
    design: Design,
    world: Template,
    urdf: Template,
    /// Robot and world as the files have them.
    base: LoadedScene,
    options: Options,
    /// The same as they are written.
    words: Vec<String>,
    /// Whether obstacles may stand in each other.
    may_overlap: bool,
    overrides: Overrides,
}

impl Study {
    /// What may surprise about the robot, and what is assumed of it: [`cplan_robot::RobotReport::remarks`].
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        self.base.robot.remarks(self.base.scene.arm())
    }

    /// Reads a study file, and robot and world that it names.
    ///
    /// # Errors
    /// Everything that is wrong with them, with line, column and cure.
    pub fn load(path: impl AsRef<Path>, read_options: ReadOptions) -> Result<Self, InputError> {
        file::load(path.as_ref(), read_options)
    }

    /// The same from texts: the study, and the robot and the world that it names.
    ///
    /// # Errors
    /// Everything that is wrong with them, with line, column and cure.
    pub fn from_sources([study, urdf, world]: [Source; 3], read_options: ReadOptions) -> Result<Self, InputError> {
        file::read(&study, read_options, &|which, _| {
            Ok(if which == Named::Robot { urdf.clone() } else { world.clone() })
        })
    }

    /// Study, robot and world as they are read, with what the world leaves unsaid written out: what [`Study::from_sources`] takes.
    #[must_use]
    pub fn sources(&self) -> [&Source; 3] {
        [&self.source, self.urdf.source(), self.world.source()]
    }

    /// Options of the main job with which it plans, as they are written.
    #[must_use]
    pub fn options(&self) -> &[String] {
        &self.words
    }

    /// Whether robots differ from layout to layout.
    #[must_use]
    pub fn varies_robots(&self) -> bool {
        !self.urdf.is_fixed()
    }

    /// The number of layouts that are listed and drawn.
    #[must_use]
    pub fn count(&self) -> usize {
        self.design.count()
    }

    /// The values of a layout, a parameter each.
    #[must_use]
    pub fn values(&self, layout: usize) -> Vec<f64> {
        self.design.values(layout)
    }

    /// The column of a measure among those of [`Row::measured`].
    pub fn column(&self, measure: Measure) -> Option<usize> {
        self.measures.iter().position(|m| *m == measure)
    }

    /// World and robot with these values in place, as files have them.
    #[must_use]
    pub fn layout(&self, values: &[f64]) -> [Source; 2] {
        [self.world.filled(values), self.urdf.filled(values)]
    }

    /// What is asked with these values.
    ///
    /// # Errors
    /// Values that make no sense; obstacles that stand in each other; a start or goal that is out of reach or not free.
    pub fn problem(&self, values: &[f64]) -> Result<Problem, InputError> {
        let [world, urdf] = self.layout(values);
        let scene = match self.urdf.is_fixed() {
            true => self.base.edited(&urdf, world)?,
            false => cplan_world::scene_from(urdf, world)?,
        };
        if !self.may_overlap
            && let Some(why) = overlap(&self.base.world.workspace, &scene.world.workspace)
        {
            let source = self.world.source();
            return Err(source.diagnostic(why).help("a study in which that may be says overlap = true").into());
        }
        Problem::of_scene(scene, &self.overrides)
    }

    /// The plan with these values.
    ///
    /// # Errors
    /// As [`Study::problem`], and what a plan is refused for.
    pub fn plan(&self, values: &[f64]) -> Result<Plan, String> {
        let problem = self.problem(values).map_err(|error| told(&error))?;
        plan(&problem, &self.options).map_err(|error| error.to_string())
    }

    /// A layout's row.
    #[must_use]
    pub fn row(&self, layout: usize) -> Row {
        self.row_of(layout, self.values(layout))
    }

    fn row_of(&self, layout: usize, values: Vec<f64>) -> Row {
        // What goes wrong with one layout is its own affair: it is a row. Whoever stops the whole unwinds, too, and goes on doing so.
        let judged = caught(|| self.judged(&values)).unwrap_or_else(Err);
        let (ending, reason, measured) = match judged {
            Ok(judged) => judged,
            Err(reason) => (Ending::Refused, Some(reason), vec![None; self.measures.len()]),
        };
        let of = |measure: Measure| self.column(measure).and_then(|column| measured[column]);
        let fits =
            ending == Ending::Found && self.conditions.iter().all(|condition| condition.holds(of(condition.measure)));
        Row { layout, values, ending, reason, measured, fits }
    }

    /// How planning with these values ends, why without a motion, and what is measured.
    fn judged(&self, values: &[f64]) -> Result<Judged, String> {
        let problem = self.problem(values).map_err(|error| told(&error))?;
        if let Some(lack) = self.options.planner.lack(&problem.scene().workspace().preferences) {
            return Err(lack);
        }
        if let (Some(motion), true) = (problem.motion(), self.measures.iter().all(|measure| measure.is_of_the_path())) {
            // The path is known before it is driven along.
            let answer = solve(motion, &self.options, &mut |_| ());
            let (length, bound) = (answer.path().map(|path| path.length()), answer.bound());
            let measured = self.measures.iter().map(|measure| measure.of_path(length, bound)).collect();
            return Ok((answer.outcome.status().into(), answer.reason(), measured));
        }
        let plan = plan(&problem, &self.options).map_err(|error| error.to_string())?;
        let measured = self.measures.iter().map(|measure| measure.of(&plan)).collect();
        Ok((plan.status().into(), plan.reason(), measured))
    }

    /// Rows of these layouts, on so many threads, each handed to `each` in order as soon as it is there.
    ///
    /// # Errors
    /// What `each` refuses with.
    pub fn rows<E>(&self, layouts: Range<usize>, jobs: usize, each: impl FnMut(Row) -> Result<(), E>) -> Result<(), E> {
        in_order(layouts.len(), jobs, |i| self.row(layouts.start + i), each)
    }
}

/// How planning ended, why without a motion, and what was measured.
type Judged = (Ending, Option<String>, Vec<Option<f64>>);

/// What is wrong, on a line: the first of it, without the place in files that are made for one layout.
fn told(error: &InputError) -> String {
    error.diagnostics().first().map_or_else(|| error.to_string(), |first| first.message.clone())
}
