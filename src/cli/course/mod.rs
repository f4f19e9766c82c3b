//! `cplan course`: the course as pages in a folder.

mod embedded;

use super::exit::DONE;
use super::failure::Failure;
use super::fresh::{existing_files, folder};
use super::plan::page_view;
use super::serve::{DEFAULT_TIME_LIMIT, page_with_engine};
use super::{sinks, words};
use crate::engine::{Problem, plan};
use crate::input::scene_from;
use crate::motion::write_whole_set;
use crate::output::format_columns;
use crate::view::page;
use clap::{Args, ValueHint};
use cplan_course::{Chapter, Figure};
use std::path::{Path, PathBuf};

/// Write the course on configuration spaces, with exercises.
#[derive(Debug, Args)]
#[command(after_help = "\
The folder has an index, seven chapters with live figures, a sheet of exercises
without answers, and a folder `answers`. The pages need no network and no
server: open index.html, copy the folder to a web host, or upload it to Moodle.
Remove `answers` before students get the folder; no other page leads there.

Examples:
  cplan course course
  cplan course course --engine target/page/cplan.wasm.gz

Exit codes: 0 written, 1 existing files or I/O, 2 wrong command line.")]
pub struct CourseArgs {
    /// Folder for the course.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// Planner for a page with experiments, lab.html: WebAssembly packed by gzip, as `.ci/page` builds it.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub engine: Option<PathBuf>,
    /// Replace existing files.
    #[arg(long)]
    pub force: bool,
}

/// Writes the course.
///
/// # Errors
/// Files that exist already, and I/O. If there is an error, no file is written.
pub fn run(args: &CourseArgs) -> Result<u8, Failure> {
    let chapters = embedded::CHAPTERS;
    let mut files: Vec<(String, String)> =
        cplan_course::files(&chapters, args.engine.is_some()).into_iter().map(|file| (file.path, file.text)).collect();
    for figure in chapters.iter().filter_map(Chapter::figure) {
        files.push((format!("live/{}", figure.page()), live_page(&figure)?));
    }
    files.extend(embedded::PICTURES.map(|(name, text)| (format!("pictures/{name}"), text.to_owned())));
    if let Some(engine) = &args.engine {
        let [robot, world] = embedded::LAB.map(|path| embedded::source(path).text().to_owned());
        files.push(("lab.html".into(), page_with_engine([robot, world], "shortest", DEFAULT_TIME_LIMIT, engine)?));
    }
    let files: Vec<(PathBuf, String)> = files.into_iter().map(|(path, text)| (args.dir.join(path), text)).collect();
    let paths: Vec<PathBuf> = files.iter().map(|(path, _)| path.clone()).collect();
    refuse_existing_course(args, &paths)?;
    paths.iter().filter_map(|path| path.parent()).try_for_each(folder)?;
    write_whole_set(&files)?;
    sinks::report(&description(&args.dir))?;
    Ok(DONE)
}

/// Checks that the folder has no files of a course, unless they may be replaced. The message counts them, because they are many.
fn refuse_existing_course(args: &CourseArgs, paths: &[PathBuf]) -> Result<(), Failure> {
    let there = existing_files(paths);
    let Some(first) = there.first().filter(|_| !args.force) else { return Ok(()) };
    let (dir, first) = (args.dir.display(), first.display());
    let files = if there.len() == 1 { "a file".to_owned() } else { format!("{} files", there.len()) };
    Err(Failure::Refused(format!(
        "{dir} already has {files} of a course, such as {first}; nothing was written\n  \
         hint: choose another folder, remove this one, or replace the files by --force"
    )))
}

/// Returns the page of a live figure, which the command in the chapter also writes.
fn live_page(figure: &Figure) -> Result<String, Failure> {
    let settings = words::parse_settings(&figure.options)?;
    let scene = scene_from(embedded::source(&figure.robot), embedded::source(&figure.world))?;
    let problem = Problem::of_scene(scene, &settings.overrides)?;
    Ok(page(&page_view(&plan(&problem, &settings.options)?)))
}

/// Describes the written files and the next steps.
fn description(dir: &Path) -> String {
    let at = |name: &str| dir.join(name).display().to_string();
    format_columns(&[
        ("file", format!("{}: the list of chapters", at("index.html"))),
        ("file", format!("{}: exercises without answers, to print", at("exercises.html"))),
        ("file", format!("{}: the answers, for teachers", at("answers/index.html"))),
        ("next", format!("open {} in a browser, or copy the folder to a web host", at("index.html"))),
    ])
}
