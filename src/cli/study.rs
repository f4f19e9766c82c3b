//! `cplan study`: plans in many layouts, with one row per layout.

use super::exit::{DONE, INTERRUPTED};
use super::failure::Failure;
use super::headings::OUTPUT;
use super::outputs::{Outputs, by_extension, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::progress::Progress;
use super::{signals, sinks};
use crate::input;
use crate::study::{Journal, JournalError, Row, Study, Summary, pictures};
use crate::text::{counted, for_a_shell};
use clap::{Args, ValueHint};
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::available_parallelism;

/// Plan one task in many layouts, and find the best layout.
#[derive(Debug, Args)]
#[command(after_help = "\
A study file (TOML) names a robot, a world, the numbers in the two files that
change from layout to layout, and the objective:

  robot = \"../../robots/planar_2r.urdf\"
  world = \"../shelf.toml\"
  objective = \"least duration\"

  [[parameter]]
  name = \"base x\"
  unit = \"m\"
  sets = \"world.robot.at[0]\"   # or urdf.joint.elbow.origin.xyz[0], or several
  from = -0.2
  to = 0.2
  steps = 21                   # or values = [...], or draw = \"latin\", with
                               # draws = 1000 above the first parameter

Each layout is planned with its numbers in the two files, and has one row.
Rows do not depend on the number of jobs. While a study runs, cplan keeps rows
in FILE.part beside the first output; after Ctrl-C, the same command continues.
A layout is refused if obstacles overlap in it that do not overlap in the world,
unless the study sets overlap = true.

Examples:
  cplan study workspaces/studies/base.toml
  cplan study workspaces/studies/base.toml --output base.csv --output base.html
  cplan study workspaces/studies/base.toml --output best.toml
  cplan study workspaces/studies/base.toml --layout 17 --output layout_17.toml

Exit codes: 0 every layout has its row, 1 bad input or I/O, 2 wrong command
line.")]
pub struct StudyArgs {
    /// Study file (TOML).
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    pub study: PathBuf,
    /// Write the table (.csv, or .parquet if built with the feature parquet), a page with maps, trade-offs and pictures
    /// (.html), the summary (.json), or the best layout's world (.toml) and robot (.urdf). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Write the world (.toml) and the robot (.urdf) of this layout without planning.
    #[arg(long, value_name = "N")]
    pub layout: Option<usize>,
    /// Number of layouts planned at the same time [default: the number of cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Discard the rows of a stopped study, and begin again.
    #[arg(long)]
    pub fresh: bool,
    /// Print tables in their full width, instead of parts of 80 columns.
    #[arg(long, help_heading = OUTPUT)]
    pub wide: bool,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// The content of an output file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Content {
    Csv,
    #[cfg(feature = "parquet")]
    Parquet,
    Page,
    Summary,
    World,
    Robot,
}

/// Plans in all layouts, and prints and writes the results.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &StudyArgs) -> Result<u8, Failure> {
    let outputs = contents(&args.output, args.layout.is_some())?;
    let files = &outputs.results;
    let study = Study::load(&args.study, &|words| super::read_words(words), &input::robot)?;
    let inputs = study.files();
    refuse_to_overwrite_inputs(outputs.paths(), &inputs)?;
    if let Some(layout) = args.layout {
        return write_layout(&study, layout, &outputs);
    }
    let journal = files.first().map(|(path, _)| part(path));
    refuse_to_overwrite_inputs(journal.iter().map(PathBuf::as_path), &inputs)?;
    let opened = journal.map(|path| Journal::open(&path, &study, args.fresh)).transpose()?;
    study.remarks().iter().for_each(|remark| args.print.print_status(remark));
    let (journal, mut rows) = opened.map_or((None, Vec::new()), |(journal, rows)| (Some(journal), rows));
    if !rows.is_empty() {
        args.print.print_status(&format!("continues the stopped study after {}", counted(rows.len(), "layout")));
    }
    let total = study.count() + study.searched;
    let kept = SharedRows::new(journal, rows.len());
    signals::run_before_exit(&[], {
        let kept = kept.clone();
        move || {
            sinks::print_status(&kept.stopped(total));
            i32::from(INTERRUPTED)
        }
    });
    let progress = Progress::new(total.saturating_sub(rows.len()), "layouts", false, args.print.quiet);
    let jobs = args.jobs.map_or_else(|| available_parallelism().map_or(1, NonZeroUsize::get), usize::from);
    let tried = rows.split_off(study.count().min(rows.len()));
    let keep = |row: &Row, is_new: bool| -> Result<(), JournalError> {
        if is_new {
            progress.begin(&study.name, &format!("layout {}", row.layout));
            progress.done();
            kept.add(row)?;
        }
        Ok(())
    };
    study.rows(rows.len()..study.count(), jobs, |row| {
        keep(&row, true)?;
        rows.push(row);
        Ok::<_, JournalError>(())
    })?;
    let mut found = Vec::new();
    study.search(&rows, &tried, jobs, |row| {
        keep(&row, found.len() >= tried.len())?;
        found.push(row);
        Ok::<_, JournalError>(())
    })?;
    rows.append(&mut found);
    progress.end();
    let summary = Summary::new(&study, &rows);
    let result = |path: &Path, content| {
        let bytes = bytes(&study, &rows, &summary, content, files)?;
        if bytes.is_none() {
            let path = path.display();
            sinks::print_status(&format!("warning: {path} is not written, because no layout meets the conditions"));
        }
        Ok(bytes)
    };
    outputs.write_results(result)?;
    note_robot(&study, files);
    kept.remove()?;
    let planned = summary.best().and_then(|best| Some((best.layout, command(&study, files)?)));
    let planned = planned.map_or_else(String::new, |(best, command)| format!("to plan layout {best}: {command}\n"));
    args.print.report(DONE, || sinks::pretty(&summary.to_json()), || summary.to_text(args.wide) + &planned)?;
    Ok(DONE)
}

/// Checks the names of the outputs, which determine their contents.
fn contents(outputs: &[PathBuf], is_layout: bool) -> Result<Outputs<Content>, Failure> {
    let layout = [("toml", Content::World), ("urdf", Content::Robot)];
    let whole = [
        ("csv", Content::Csv),
        #[cfg(feature = "parquet")]
        ("parquet", Content::Parquet),
        ("html", Content::Page),
        ("json", Content::Summary),
    ];
    if is_layout {
        return Outputs::new(outputs, by_extension(&layout, "a layout is written as .toml (world) or .urdf"), &[], []);
    }
    #[cfg(not(feature = "parquet"))]
    refuse_parquet(outputs)?;
    let expected = "the name must end in .csv, .parquet, .html or .json for the table of the study, or in .toml or .urdf for the best layout";
    Outputs::new(outputs, by_extension(&[&whole[..], &layout].concat(), expected), &[], [])
}

/// Refuses names of Parquet files if this build of the program cannot write them.
#[cfg(not(feature = "parquet"))]
fn refuse_parquet(outputs: &[PathBuf]) -> Result<(), Failure> {
    let is_parquet = |path: &&PathBuf| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("parquet"));
    outputs.iter().find(is_parquet).map_or(Ok(()), |path| {
        let description = "this program was built without Parquet; use .csv, or build with --features parquet";
        Err(Failure::Refused(format!("{}: {description}", path.display())))
    })
}

/// Returns the path of the journal for an output file.
fn part(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".part");
    name.into()
}

fn write_layout(study: &Study, layout: usize, outputs: &Outputs<Content>) -> Result<u8, Failure> {
    let files = &outputs.results;
    if layout >= study.count() {
        let count = counted(study.count(), "layout");
        let message = format!(
            "--layout {layout}: the study has {count}, numbered from 0; --output best.toml writes the best layout of the search"
        );
        return Err(Failure::Refused(message));
    }
    let [world, urdf] = texts(study, layout, &study.values(layout), files);
    if files.is_empty() {
        sinks::print(&world)?;
    }
    let text = |content| if content == Content::Robot { &urdf } else { &world };
    outputs.write_results(|_, content| Ok(Some(text(content).clone().into_bytes())))?;
    note_robot(study, files);
    Ok(DONE)
}

/// Prints a note if the robot of a layout differs from the study's, but only the world of the layout is written.
fn note_robot(study: &Study, files: &[(PathBuf, Content)]) {
    let of = |wanted: Content| files.iter().find(|(_, content)| *content == wanted);
    if let (Some((world, _)), None, true) = (of(Content::World), of(Content::Robot), study.varies_robots()) {
        let robot = world.with_extension("urdf");
        sinks::print_status(&format!(
            "note: the layout also changes the robot; --output {} writes its URDF",
            robot.display()
        ));
    }
}

/// Returns the bytes of a file. Returns `None` for the best layout if there is none.
fn bytes(
    study: &Study,
    rows: &[Row],
    summary: &Summary,
    content: Content,
    files: &[(PathBuf, Content)],
) -> Result<Option<Vec<u8>>, Failure> {
    let best = |which: usize| {
        let best = summary.best()?;
        Some(texts(study, best.layout, &best.values, files)[which].clone().into_bytes())
    };
    Ok(match content {
        Content::Csv => Some(study.csv(rows).into_bytes()),
        #[cfg(feature = "parquet")]
        Content::Parquet => Some(study.parquet(rows).map_err(|error| Failure::Refused(format!("Parquet: {error}")))?),
        Content::Page => Some(study.html(rows, &pictures(study, rows)).into_bytes()),
        Content::Summary => Some(sinks::pretty(&summary.to_json())?.into_bytes()),
        Content::World => best(0),
        Content::Robot => best(1),
    })
}

/// Returns the world and the robot of a layout as texts. A comment at the beginning of the world has the command that
/// plans in it.
fn texts(study: &Study, layout: usize, values: &[f64], files: &[(PathBuf, Content)]) -> [String; 2] {
    let [world, urdf] = study.layout(values);
    let command = command(study, files).unwrap_or_else(|| command_of(study, "world.toml", files));
    let [source, ..] = study.sources();
    let head =
        format!("# Layout {layout} of the study {}. The command that plans it:\n# {command}\n", short(&source.name()));
    [head + world.text(), urdf.text().to_owned()]
}

/// Returns the command that plans in a layout whose world is written. `None` if no world is written.
fn command(study: &Study, files: &[(PathBuf, Content)]) -> Option<String> {
    let (world, _) = files.iter().find(|(_, content)| *content == Content::World)?;
    Some(command_of(study, &world.to_string_lossy(), files))
}

fn command_of(study: &Study, world: &str, files: &[(PathBuf, Content)]) -> String {
    let [_, urdf, _] = study.sources();
    let written = files.iter().find(|(_, content)| *content == Content::Robot).map(|(path, _)| path.to_string_lossy());
    let robot = match written {
        Some(written) => written.into_owned(),
        // The robot's file of the study would be that of another layout.
        None if study.varies_robots() => Path::new(world).with_extension("urdf").to_string_lossy().into_owned(),
        None => short(&urdf.name()),
    };
    let words = ["cplan", &robot, world].into_iter().chain(study.options().iter().map(String::as_str));
    words.map(for_a_shell).collect::<Vec<_>>().join(" ")
}

/// Removes detours through folders from a path, if the short path leads to the same file.
fn short(name: &str) -> String {
    let mut short = PathBuf::new();
    for part in Path::new(name).components() {
        match part {
            Component::ParentDir if matches!(short.components().next_back(), Some(Component::Normal(_))) => {
                short.pop();
            }
            part => short.push(part),
        }
    }
    let same = [Path::new(name), &short].map(|path| path.canonicalize().ok());
    if same[0].is_some() && same[0] == same[1] { short.to_string_lossy().into_owned() } else { name.to_owned() }
}

/// Rows of a running study, also for the handler of Ctrl-C.
#[derive(Debug, Clone)]
struct SharedRows(Arc<Mutex<Rows>>);

#[derive(Debug)]
struct Rows {
    journal: Option<Journal>,
    count: usize,
}

impl SharedRows {
    fn new(journal: Option<Journal>, count: usize) -> Self {
        Self(Arc::new(Mutex::new(Rows { journal, count })))
    }

    fn add(&self, row: &Row) -> Result<(), JournalError> {
        let mut rows = self.rows();
        rows.count += 1;
        rows.journal.as_mut().map_or(Ok(()), |journal| journal.add(row))
    }

    /// Removes the journal of a finished study, because all rows are in the output files.
    fn remove(&self) -> Result<(), JournalError> {
        self.rows().journal.take().map_or(Ok(()), Journal::remove)
    }

    /// Writes all rows to disk. Returns a message with the number of rows and the number of layouts in the study (`total`).
    fn stopped(&self, total: usize) -> String {
        let mut rows = self.rows();
        let count = rows.count;
        match rows.journal.as_mut().map(|journal| (journal.flush(), journal.path().display().to_string())) {
            Some((Ok(()), path)) => {
                format!("\nstopped: {count} of {total} rows are in {path}; the same command continues from there")
            }
            Some((Err(error), _)) => format!("\nstopped: {error}"),
            None => "\nstopped: the rows are lost; with --output, cplan keeps them".to_owned(),
        }
    }

    fn rows(&self) -> MutexGuard<'_, Rows> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
