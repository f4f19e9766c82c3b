//! `cplan study`: many layouts, a row each.

use super::DONE;
use super::failure::Failure;
use super::print_args::PrintArgs;
use super::progress::Progress;
use super::sinks;
use crate::motion::{check_writable, write_whole_set};
use crate::study::{Journal, JournalError, Row, Study, Summary, pictures};
use crate::text::counted;
use clap::{Args, ValueHint};
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

/// Arguments of `study`.
#[derive(Debug, Args)]
#[command(after_help = "\
A study file (TOML) names a robot, a world, numbers of both that differ from layout to layout, and what is measured:

  robot = \"../../robots/planar_2r.urdf\"
  world = \"../shelf.toml\"
  objective = \"least duration\"

  [[parameter]]
  name = \"base x\"
  unit = \"m\"
  sets = \"world.robot.at[0]\"      # or urdf.joint.elbow.origin.xyz[0], or several
  from = -0.2
  to = 0.2
  steps = 21                      # or values = [...], or draw = \"latin\" with draws = 1000 above

Each layout is planned in as the two files with its numbers in place. Rows are the same for any number of jobs. While it runs, rows are
kept beside the first output (FILE.part): the same command goes on where it was stopped.

Examples:
  cplan study workspaces/studies/base.toml
  cplan study workspaces/studies/base.toml --output base.csv --output base.parquet --output base.html
  cplan study workspaces/studies/base.toml --output best.toml
  cplan study workspaces/studies/base.toml --layout 17 --output layout_17.toml

Exit codes: 0 every layout has its row, 1 bad input or I/O, 2 wrong command line.")]
pub struct StudyArgs {
    /// The study, TOML.
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    pub study: PathBuf,
    /// Write the table (.csv, .parquet), a page with maps, trade-offs and pictures (.html), the summary (.json), or the best layout's
    /// world (.toml) and robot (.urdf). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Vec<PathBuf>,
    /// Write the world (.toml) and the robot (.urdf) of this layout, and plan nothing.
    #[arg(long, value_name = "N")]
    pub layout: Option<usize>,
    /// Layouts at the same time [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Begin anew, whatever an earlier run has left.
    #[arg(long)]
    pub fresh: bool,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// What a file is to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Content {
    Csv,
    Parquet,
    Page,
    Summary,
    World,
    Robot,
}

/// Plans in all layouts.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &StudyArgs) -> Result<u8, Failure> {
    let files = contents(&args.output, args.layout.is_some())?;
    let study = Study::load(&args.study, &|words| super::read_words(words))?;
    sinks::spare_inputs(files.iter().map(|(path, _)| path.as_path()))?;
    if let Some(layout) = args.layout {
        return write_layout(&study, layout, &files);
    }
    let journal = files.first().map(|(path, _)| part(path));
    sinks::spare_inputs(journal.iter().map(PathBuf::as_path))?;
    let opened = journal.map(|path| Journal::open(&path, &study, args.fresh)).transpose()?;
    let (mut journal, mut rows) = opened.map_or((None, Vec::new()), |(journal, rows)| (Some(journal), rows));
    if !rows.is_empty() {
        args.print.say(&format!("goes on after {} that an earlier run has planned in", counted(rows.len(), "layout")));
    }
    let total = study.count() + study.searched;
    let progress = Progress::new(total.saturating_sub(rows.len()), false, args.print.quiet);
    let jobs = args.jobs.map_or_else(|| available_parallelism().map_or(1, NonZeroUsize::get), usize::from);
    let tried = rows.split_off(study.count().min(rows.len()));
    let mut keep = |row: &Row, is_new: bool| -> Result<(), JournalError> {
        if is_new {
            progress.begin(&study.name, &format!("layout {}", row.layout));
            progress.done();
            journal.as_mut().map_or(Ok(()), |journal| journal.add(row))?;
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
    let mut written = Vec::new();
    for (path, content) in &files {
        match bytes(&study, &rows, &summary, *content)? {
            Some(bytes) => written.push((path.clone(), bytes)),
            None => {
                sinks::say(&format!("warning: {} is not written: no layout fits, so none is the best", path.display()))
            }
        }
    }
    write_whole_set(&written)?;
    journal.map_or(Ok(()), Journal::remove)?;
    args.print.tell(|| sinks::pretty(&summary.to_json()), || summary.to_text())?;
    Ok(DONE)
}

/// What the names of the outputs ask for, checked before any work is done.
fn contents(outputs: &[PathBuf], is_layout: bool) -> Result<Vec<(PathBuf, Content)>, Failure> {
    let content = |path: &PathBuf| {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let content = match extension.as_deref() {
            Some("toml") => Content::World,
            Some("urdf") => Content::Robot,
            Some("csv") if !is_layout => Content::Csv,
            Some("parquet") if !is_layout => Content::Parquet,
            Some("html") if !is_layout => Content::Page,
            Some("json") if !is_layout => Content::Summary,
            _ if is_layout => {
                return Err(Failure::Usage(format!(
                    "{}: a layout is written as .toml (world) or .urdf",
                    path.display()
                )));
            }
            _ => {
                let endings = ".csv, .parquet, .html or .json, a layout's in .toml or .urdf";
                return Err(Failure::Usage(format!("{}: a study's name must end in {endings}", path.display())));
            }
        };
        Ok((path.clone(), content))
    };
    let contents = outputs.iter().map(content).collect::<Result<Vec<_>, _>>()?;
    contents.iter().try_for_each(|(path, _)| check_writable(path))?;
    sinks::distinct(contents.iter().map(|(path, _)| path.as_path()))?;
    Ok(contents)
}

/// Where rows are kept while a study runs.
fn part(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".part");
    name.into()
}

fn write_layout(study: &Study, layout: usize, files: &[(PathBuf, Content)]) -> Result<u8, Failure> {
    if layout >= study.count() {
        let count = counted(study.count(), "layout");
        let message = format!(
            "--layout {layout}: the study has {count}, from 0 on; of the search's the best is written by --output best.toml alone"
        );
        return Err(Failure::Option(message));
    }
    let [world, urdf] = study.layout(&study.values(layout));
    if files.is_empty() {
        sinks::print(world.text())?;
    }
    let text = |content| if content == Content::Robot { urdf.text() } else { world.text() };
    write_whole_set(&files.iter().map(|(path, content)| (path.clone(), text(*content))).collect::<Vec<_>>())?;
    Ok(DONE)
}

/// What a file holds; none of the best layout where there is none.
fn bytes(study: &Study, rows: &[Row], summary: &Summary, content: Content) -> Result<Option<Vec<u8>>, Failure> {
    let best = |which: usize| Some(study.layout(&summary.best()?.values)[which].text().as_bytes().to_vec());
    Ok(match content {
        Content::Csv => Some(study.csv(rows).into_bytes()),
        Content::Parquet => Some(study.parquet(rows).map_err(|error| Failure::Option(format!("Parquet: {error}")))?),
        Content::Page => Some(study.html(rows, &pictures(study, rows)).into_bytes()),
        Content::Summary => Some(sinks::pretty(&summary.to_json())?.into_bytes()),
        Content::World => best(0),
        Content::Robot => best(1),
    })
}
