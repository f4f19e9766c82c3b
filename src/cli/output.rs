//! Files and streams.

use super::failure::Failure;
use crate::cspace::{CObstacle, c_obstacles};
use crate::draw::{self, Ending, Picture, Posture, TaskPicture, View};
use crate::engine::task::TaskVerdict;
use crate::input::{FileIdentity, read_from};
use crate::model::{Problem, Scene, plain, plain_json};
use crate::motion::{Format, Report, check_writable, write_whole};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A file to write.
#[derive(Debug, Clone, PartialEq)]
pub enum Sink {
    /// The result.
    Result(Format, PathBuf),
    /// A picture.
    Picture(PictureFormat, PathBuf),
}

impl Sink {
    /// The file.
    pub fn path(&self) -> &Path {
        match self {
            Sink::Result(_, path) | Sink::Picture(_, path) => path,
        }
    }

    /// Whether the file could be filled: a table or message without a trajectory could not.
    pub fn is_filled_by(&self, report: &Report) -> bool {
        match self {
            Sink::Result(Format::Json, _) | Sink::Picture(..) => true,
            Sink::Result(..) => report.trajectory.is_some(),
        }
    }
}

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Vector graphics.
    Svg,
    /// Pixels.
    #[cfg(feature = "png")]
    Png,
    /// A page with both, in which the arm can be moved.
    Html,
}

/// Pixels of a PNG picture per unit of the SVG.
#[cfg(feature = "png")]
const PNG_SCALE: f64 = 2.0;

/// Share of the arm's reach by which contours of C-obstacles may deviate in pictures: less than a pixel.
const PICTURE_TOLERANCE: f64 = 1e-3;

/// What the file names ask for, checked before any work is done.
///
/// # Errors
/// Extensions that are none of ours or not in this program, and files that cannot be written.
pub fn sinks(results: &[PathBuf], pictures: &[PathBuf]) -> Result<Vec<Sink>, Failure> {
    let mut sinks = Vec::new();
    for path in results {
        sinks.push(Sink::Result(Format::from_path(path)?, path.clone()));
    }
    for path in pictures {
        sinks.push(Sink::Picture(picture_format(path)?, path.clone()));
    }
    sinks.iter().try_for_each(|sink| check_writable(sink.path()))?;
    distinct(sinks.iter().map(Sink::path))?;
    Ok(sinks)
}

/// Refuses to write two outputs onto one file, however they are spelt.
///
/// # Errors
/// When two are one; both are named.
pub fn distinct<'a>(outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let mut known: Vec<(&Path, FileIdentity)> = Vec::new();
    for path in outputs {
        let Some(identity) = FileIdentity::of(path) else { continue };
        if let Some((other, _)) = known.iter().find(|(_, other)| other.is(&identity)) {
            let (one, other) = (path.display(), other.display());
            let message = format!("the outputs {other} and {one} are one file; nothing was written");
            return Err(Failure::Option(format!("{message}\n  cure: give each a file of its own")));
        }
        known.push((path, identity));
    }
    Ok(())
}

/// Refuses to overwrite what has been read, also through links: to be asked when all inputs have been.
///
/// # Errors
/// When an output is an input; both are named.
pub fn spare_inputs<'a>(mut outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let onto = outputs.find_map(|path| Some((path, read_from(path)?)));
    onto.map_or(Ok(()), |(path, input)| {
        let (path, input) = (path.display(), input.display());
        let message = format!("the output {path} is the input {input}; nothing was written");
        Err(Failure::Option(format!("{message}\n  cure: give the output a file of its own")))
    })
}

/// The format that a picture's extension stands for.
///
/// # Errors
/// Any other extension than .svg, .png and .html, and .png in a program built without it.
pub fn picture_format(path: &Path) -> Result<PictureFormat, Failure> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("svg") => Ok(PictureFormat::Svg),
        #[cfg(feature = "png")]
        Some("png") => Ok(PictureFormat::Png),
        #[cfg(not(feature = "png"))]
        Some("png") => {
            Err(Failure::Option(format!("{}: this program was built without PNG; use .svg or .html", path.display())))
        }
        Some("html") => Ok(PictureFormat::Html),
        _ => Err(Failure::Usage(format!("{}: a picture's name must end in .svg, .png or .html", path.display()))),
    }
}

/// Writes a result file; says so on stderr if the format has no room for a result without a trajectory.
///
/// # Errors
/// I/O.
pub fn write_result(format: Format, path: &Path, report: &Report) -> Result<(), Failure> {
    match format.bytes(report) {
        Some(bytes) => write_whole(path, &bytes)?,
        None => warn_unwritten(path),
    }
    Ok(())
}

/// Says on stderr that a format has no room for a result without a trajectory.
pub fn warn_unwritten(path: &Path) {
    say(&format!("warning: {} is not written: there is no trajectory to put into it", path.display()));
}

/// Workspace and robot.
pub fn title(problem: &Problem) -> String {
    title_of(problem.scene())
}

/// The same without a start and a goal.
pub fn title_of(scene: &Scene) -> String {
    match scene.workspace().name.as_str() {
        "" => scene.arm().name.clone(),
        name => format!("{name}: {}", scene.arm().name),
    }
}

/// C-obstacles for pictures.
pub fn contours(scene: &Scene) -> Vec<CObstacle> {
    let tolerance = PICTURE_TOLERANCE * scene.arm().reach();
    c_obstacles(scene, tolerance, tolerance)
}

/// Writes a picture.
///
/// # Errors
/// I/O, or a picture that cannot be made of pixels.
pub fn save_picture(format: PictureFormat, path: &Path, picture: &Picture) -> Result<(), Failure> {
    Ok(write_whole(path, &drawn(format, picture)?)?)
}

/// A picture as a file holds it.
///
/// # Errors
/// A picture that cannot be made of pixels.
pub fn drawn(format: PictureFormat, picture: &Picture) -> Result<Vec<u8>, Failure> {
    Ok(match format {
        PictureFormat::Svg => draw::svg(picture).into_bytes(),
        #[cfg(feature = "png")]
        PictureFormat::Png => draw::png(picture, PNG_SCALE)?,
        PictureFormat::Html => draw::page(&View::of_picture(picture, Ending::Shown, Vec::new(), None)).into_bytes(),
    })
}

/// Writes a page.
///
/// # Errors
/// I/O.
pub fn save_view(path: &Path, view: &View) -> Result<(), Failure> {
    Ok(write_whole(path, draw::page(view).as_bytes())?)
}

/// Writes a picture of a task; `facts` are for pages.
///
/// # Errors
/// I/O, or a picture that cannot be made of pixels.
pub fn save_task_picture(
    format: PictureFormat,
    path: &Path,
    picture: &TaskPicture,
    facts: impl FnOnce() -> Vec<[String; 2]>,
) -> Result<(), Failure> {
    Ok(write_whole(path, &drawn_task(format, picture, facts)?)?)
}

/// A picture of a task as a file holds it.
///
/// # Errors
/// A picture that cannot be made of pixels.
pub fn drawn_task(
    format: PictureFormat,
    picture: &TaskPicture,
    facts: impl FnOnce() -> Vec<[String; 2]>,
) -> Result<Vec<u8>, Failure> {
    Ok(match format {
        PictureFormat::Svg => draw::task_svg(picture).into_bytes(),
        #[cfg(feature = "png")]
        PictureFormat::Png => draw::task_png(picture, PNG_SCALE)?,
        PictureFormat::Html => {
            let ending = match picture.answer.verdict {
                TaskVerdict::Done => Ending::Found,
                TaskVerdict::Infeasible(_) => Ending::Infeasible,
                TaskVerdict::Unknown(_) => Ending::Unknown,
            };
            draw::page(&View::of_task(picture, ending, facts())).into_bytes()
        }
    })
}

/// Writes a picture of an arm in one configuration.
///
/// # Errors
/// I/O, or a picture that cannot be made of pixels.
pub fn save_posture(format: PictureFormat, path: &Path, posture: &Posture) -> Result<(), Failure> {
    match format {
        PictureFormat::Svg => write_whole(path, draw::posture_svg(posture).as_bytes())?,
        #[cfg(feature = "png")]
        PictureFormat::Png => write_whole(path, &draw::posture_png(posture, PNG_SCALE)?)?,
        PictureFormat::Html => save_view(path, &View::of_posture(posture))?,
    }
    Ok(())
}

/// Prints a line on stderr: progress, warnings and errors. Nobody may be listening there; that stops no job.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", plain(text));
}

/// Prints for people on stdout: as [`print`], but what names hold that would act on a terminal is seen instead.
///
/// # Errors
/// I/O.
pub fn tell(text: &str) -> Result<(), Failure> {
    print(&plain(text))
}

/// Prints JSON on stdout, in which names do nothing to a terminal, either.
///
/// # Errors
/// I/O.
pub fn print_json(json: &str) -> Result<(), Failure> {
    print(&plain_json(json))
}

/// Prints on stdout. A reader that has seen enough (`cplan ... | head`) is no error.
///
/// # Errors
/// I/O.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Option(format!("stdout: {error}"))),
        _ => Ok(()),
    }
}
