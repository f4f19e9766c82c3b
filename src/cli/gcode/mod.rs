//! `cplan gcode`: judges G-code for a machine with its own kinematics, and replaces unsafe travels.

mod picture;

use crate::cli::exit::code_of;
use crate::cli::failure::Failure;
use crate::cli::files::Files;
use crate::cli::headings::OUTPUT;
use crate::cli::outputs::{Outputs, drawn, refuse_to_overwrite_inputs};
use crate::cli::print_args::PrintArgs;
use crate::cli::sinks;
use crate::cli::theme::ThemeArgs;
use crate::cli::values::{clearance, displacement, tolerance, turn};
use crate::input::{self, CalibrationTable, LoadedScene, line_diagnostic};
use crate::model::{Elbow, Status};
use crate::options::{positive, word};
use crate::output::{format_columns, title_of};
use crate::text::{chosen_length, counted};
use clap::{Args, ValueHint};
use cplan_gcode::{
    Answer, Dialect, Failed, Frame, GcodeError, Job, Pen, PenWords, Segments, Settings, Setup, Travel, judge,
};
use cplan_toolpath::{Curve, Source};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Greatest number of failed moves in the summary.
const MAX_SHOWN: usize = 8;

/// Commands by which many plotters move the pen.
const PEN_WORDS: [&str; 4] = ["M3", "M5", "M280", "M300"];

/// Default length of the segments into which firmwares divide arcs, metres.
const ARC_SEGMENT: f64 = 1e-3;

/// Prove G-code for machines with their own kinematics.
#[derive(Debug, Args)]
#[command(after_help = "\
The machine's firmware moves the tip along each line, with the elbow always on
the same side. Drawing moves (G1, G2, G3) remain unchanged; cplan proves that
they are within reach and limits, and free of collisions. Travels (G0) for which
this does not hold are replaced by others. Coordinates of the file, turned by
--turn and then moved by --move, are those of the world.

Examples:
  cplan gcode robots/scara.urdf workspaces/gcode/labels.toml \\
    workspaces/gcode/labels.gcode --output safe.gcode
  cplan gcode robots/scara.urdf workspaces/gcode/labels.toml safe.gcode --check
  cplan gcode robots/scara.urdf workspaces/gcode/labels.toml \\
    workspaces/gcode/labels.gcode --output safe.nc --dialect grbl --elbow right

Exit codes: 0 all moves are proven, 1 bad input or I/O, 2 wrong command line, 3
a move is proven to be impossible, 4 unknown.")]
pub struct GcodeArgs {
    #[command(flatten)]
    files: Files,
    /// G-code program.
    #[arg(value_name = "JOB", value_hint = ValueHint::FilePath)]
    job: PathBuf,
    /// Judge the original program, travels included, and write nothing.
    #[arg(long, conflicts_with = "output", required_unless_present = "output")]
    check: bool,
    /// Firmware of the machine [default: the firmware that the program names in a comment, or whose own words it uses;
    /// otherwise marlin].
    #[arg(long, value_name = "NAME", value_parser = word(Dialect::ALL.map(|own| (own, own.name(), ""))))]
    dialect: Option<Dialect>,
    /// Side of the elbow, seen from joint 1 towards the tip, if it is fixed on the machine. By default, cplan tries
    /// both sides.
    #[arg(long, value_name = "SIDE", value_parser = word(Elbow::ALL.map(|own| (own, own.name(), ""))))]
    elbow: Option<Elbow>,
    /// Place of the tip at the beginning and after homing (G28), metres, in the coordinates of the program. Without
    /// this option, moves that begin there are not judged.
    #[arg(long, value_name = "x,y", value_parser = displacement, allow_hyphen_values = true)]
    home: Option<[f64; 2]>,
    /// Angle by which the machine's coordinates are turned in the world: radians, or degrees such as 90deg.
    #[arg(long, value_name = "ANGLE", value_parser = turn, allow_hyphen_values = true, default_value_t = 0.0)]
    turn: f64,
    /// Position of the machine's origin in the world, metres; by default 0,0.
    #[arg(long = "move", value_name = "x,y", value_parser = displacement, allow_hyphen_values = true)]
    shift: Option<[f64; 2]>,
    /// Words of the lines that lift the pen, such as "M300 S50" or Z5. G1 with a lifted pen then counts as a travel.
    #[arg(long, value_name = "WORDS", requires = "pen_down")]
    pen_up: Option<PenWords>,
    /// Words of the lines that lower the pen, such as "M300 S30".
    #[arg(long, value_name = "WORDS", requires = "pen_up")]
    pen_down: Option<PenWords>,
    /// Greatest distance of the tip from the line, metres or with a unit such as 0.05mm.
    #[arg(long, value_name = "LENGTH", value_parser = tolerance, default_value_t = Settings::default().tolerance)]
    tolerance: f64,
    /// Length of the firmware's segments, on which the joints move straight, metres or with a unit such as 5mm
    /// [default: such that the tip stays within the tolerance of the line]. With --segments-per-second: greatest length
    /// of the segments of arcs [default: 1mm].
    #[arg(long, value_name = "LENGTH", value_parser = tolerance)]
    segment: Option<f64>,
    /// Number of segments per second (S in M665 of Marlin, and in M669 of RepRapFirmware). The firmware then divides
    /// straight lines according to their lengths and F.
    #[arg(long, value_name = "RATE", value_parser = positive)]
    segments_per_second: Option<f64>,
    /// Least length of segments with --segments-per-second, metres or with a unit [default: 0.5mm for marlin, 0.2mm for
    /// duet].
    #[arg(long, value_name = "LENGTH", value_parser = tolerance, requires = "segments_per_second")]
    min_segment: Option<f64>,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance)]
    clearance: Option<f64>,
    /// Errors within which the answer holds, instead of the world's, such as
    /// "base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm".
    #[arg(long, value_name = "KEY=VALUE,..")]
    calibration: Option<CalibrationTable>,
    /// Write the program with safe travels.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    output: Option<PathBuf>,
    /// Draw the drawing moves, the replaced travels and the moves that fail: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    picture: Vec<PathBuf>,
    #[command(flatten)]
    theme: ThemeArgs,
    #[command(flatten)]
    print: PrintArgs,
}

/// Judges a program, and writes it with safe travels.
///
/// # Errors
/// Bad input and I/O, and options that do not suit the robot.
pub fn run(args: &GcodeArgs) -> Result<u8, Failure> {
    let outputs = Outputs::of_pictures(&args.picture, args.output.clone())?.without_animation("a program")?;
    let bytes = input::read_bytes(&args.job)?;
    let file = args.job.display().to_string();
    let pen = args.pen_up.clone().zip(args.pen_down.clone()).map(|(up, down)| Pen { up, down });
    let found = Dialect::of_program(&String::from_utf8_lossy(&bytes)).filter(|_| args.dialect.is_none());
    let dialect = args.dialect.or(found.map(|(dialect, _)| dialect)).unwrap_or_default();
    let frame = Frame { turn: args.turn, origin: args.shift.unwrap_or_default() };
    let setup = Setup { dialect, pen, home: args.home, frame };
    let job = Job::read(&bytes, &setup).map_err(|error| Failure::Input(line_diagnostic(file, error).into()))?;
    let loaded =
        input::load_scene(args.files.robot(), &args.files.world)?.with_margins(args.clearance, args.calibration)?;
    loaded.require_static_obstacles("G-code can be judged only if all obstacles are static")?;
    // If only padding makes a move come too near, it is not proven to collide.
    let padded = loaded.scene.arm().links.iter().flat_map(|link| &link.parts).any(|part| part.padding > 0.0)
        || loaded.scene.workspace().obstacles.iter().any(|obstacle| obstacle.growth.padding > 0.0);
    if padded {
        let message = "G-code is judged only for errors of the places of base and obstacles; replace errors of angles, lengths and zeros by a clearance that covers them";
        return Err(Failure::Refused(message.into()));
    }
    let read: Vec<_> = loaded.files().into_iter().chain([args.job.clone()]).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &read)?;
    loaded.robot.warnings.iter().for_each(|warning| args.print.print_status(&format!("warning: {warning}")));
    let settings =
        Settings { tolerance: args.tolerance, segments: args.segments(), elbow: args.elbow, repairs: !args.check };
    let answer = judge(&loaded.scene, &job, &settings).map_err(|error| match error {
        GcodeError::NoElbow => Failure::Usage(format!("--elbow: {error}")),
        GcodeError::SegmentsPerSecond(_) => Failure::Usage(format!("--segments-per-second: {error}")),
        error => Failure::Refused(format!("{}: {error}", args.job.display())),
    })?;
    let code = code_of(answer.status());
    let named = found.map(|(dialect, source)| {
        format!(
            "the dialect is {dialect}, because line {} of the program names it; --dialect overrides this",
            source.line
        )
    });
    let notes = named.into_iter().chain(pen_note(args, &job, &answer)).collect();
    let answered = Answered { args, loaded: &loaded, job: &job, answer: &answer, dialect, notes };
    let program = args.output.as_ref().zip(answer.text.as_ref()).map(|(path, text)| (path.clone(), text.clone()));
    if let (Some(path), None) = (&args.output, &program) {
        sinks::warn_unwritten(path, "safe program");
    }
    outputs.write_pictures(program.into_iter().collect(), drawn(|| args.theme.apply(picture::view(&answered))))?;
    args.print.report(code, || sinks::pretty(&answered.json()), || answered.summary())?;
    Ok(code)
}

/// A program with its answer.
struct Answered<'a> {
    args: &'a GcodeArgs,
    loaded: &'a LoadedScene,
    job: &'a Job,
    answer: &'a Answer,
    dialect: Dialect,
    /// Notes about the dialect and the pen.
    notes: Vec<String>,
}

impl GcodeArgs {
    fn segments(&self) -> Segments {
        match (self.segments_per_second, self.segment) {
            (Some(rate), arcs) => {
                Segments::PerSecond { rate, least: self.min_segment, arcs: arcs.unwrap_or(ARC_SEGMENT) }
            }
            (None, Some(length)) => Segments::OfLength(length),
            (None, None) => Segments::Short,
        }
    }
}

impl Answered<'_> {
    fn json(&self) -> Value {
        let Answer { elbow, failed, replaced, other, .. } = self.answer;
        let [drawing, travels] = self.job.counts();
        let failures = |failed: &[Failed]| failed.iter().map(failure).collect::<Vec<_>>();
        let side = |elbow: &Option<Elbow>| elbow.map(Elbow::name);
        json!({
            "status": self.answer.status().name(),
            "file": self.args.job.display().to_string(),
            "dialect": self.dialect.name(),
            "elbow": side(elbow),
            "tolerance": self.args.tolerance,
            "segment": self.args.segment,
            "segments_per_second": self.args.segments_per_second,
            "clearance": self.loaded.scene.workspace().clearance,
            "lines": {
                "drawing": drawing,
                "travels": travels,
                "replaced": replaced.iter().map(|own| json!({ "line": own.line, "moves": own.moves() })).collect::<Vec<_>>(),
                "failed": failures(failed),
                "unstated": self.job.program.unstated.iter().map(|source| source.line).collect::<Vec<_>>(),
            },
            "other": other.as_ref().map(|other| json!({ "elbow": side(&other.elbow), "failed": failures(&other.failed) })),
            "notes": self.notes.iter().chain(&self.job.program.notes).collect::<Vec<_>>(),
        })
    }

    fn summary(&self) -> String {
        let Answer { elbow, failed, replaced, other, .. } = self.answer;
        let mut lines = vec![("result", self.result())];
        let shown = failed.iter().take(MAX_SHOWN).map(described).collect::<Vec<_>>();
        lines.extend(shown.into_iter().enumerate().map(|(k, text)| (if k == 0 { "failed" } else { "" }, text)));
        if failed.len() > MAX_SHOWN {
            lines.push(("", format!("and {} more", counted(failed.len() - MAX_SHOWN, "move"))));
        }
        if let Some((other, first)) = other.as_ref().and_then(|other| Some((other, other.failed.first()?))) {
            let side = other.elbow.map_or("other solution", Elbow::name);
            let count = counted(other.failed.len(), "move");
            lines.push((
                side,
                format!("with this side of the elbow, {count} would fail; the first one: {}", described(first)),
            ));
        }
        let [drawing, travels] = self.job.counts();
        let tolerance = chosen_length(self.args.tolerance);
        let moves = format!("{}, {}", counted(drawing, "drawing move"), counted(travels, "travel"));
        lines.push(("program", format!("{moves}; tolerance {tolerance}; dialect {}", self.dialect)));
        lines.extend(
            elbow.map(|elbow| ("elbow", format!("to the {} of the line from joint 1 to the tip", elbow.name()))),
        );
        if let Some(first) = replaced.first() {
            let count: usize = replaced.iter().map(Travel::moves).sum();
            let text = format!(
                "{} by {}; the first in line {}",
                counted(replaced.len(), "travel"),
                counted(count, "move"),
                first.line
            );
            lines.push(("replaced", text));
        }
        let program = &self.job.program;
        lines.extend(unstated(&program.unstated).map(|text| ("note", text)));
        let notes = self.notes.iter().chain(&program.notes).chain(&self.loaded.robot.notes);
        lines.extend(notes.map(|note| ("note", note.clone())));
        format!("{}\n{}", title_of(&self.loaded.scene), format_columns(&lines))
    }

    /// Returns the answer in one line.
    fn result(&self) -> String {
        let failed = &self.answer.failed;
        let proven = failed.iter().filter(|failed| failed.fault.is_proven).count();
        match self.answer.status() {
            Status::Found if self.args.check => "found: the machine can run all moves; proven".to_owned(),
            Status::Found => "found: the machine can run all moves of the written program; proven".to_owned(),
            Status::Infeasible => format!("infeasible: the machine cannot run {}; proven", counted(proven, "move")),
            Status::Unknown => format!("unknown: {} not proven to be safe", counted(failed.len(), "move")),
        }
    }
}

/// Returns a note about the words that move the pen, if a failed drawing move may be a travel with a lifted pen.
fn pen_note(args: &GcodeArgs, job: &Job, answer: &Answer) -> Option<String> {
    let words =
        PEN_WORDS.iter().filter(|word| job.program.notes.iter().any(|note| note.contains(&format!("{word} ("))));
    let words: Vec<&str> = words.copied().collect();
    let is_straight = |failed: &&Failed| matches!(failed.own.piece.curve, Curve::Line { .. });
    let first = answer.failed.iter().filter(is_straight).find(|failed| !failed.own.piece.is_travel)?;
    let is_open = args.pen_up.is_none() && !words.is_empty();
    is_open.then(|| {
        let (line, words) = (first.own.piece.source.line, words.join(" or "));
        format!(
            "if {words} lifts the pen before line {line}, name the words by --pen-up and --pen-down; then the line counts as a travel"
        )
    })
}

/// Returns a note about moves that begin at unstated places, if any.
fn unstated(sources: &[Source]) -> Option<String> {
    let more = sources.len().saturating_sub(MAX_SHOWN);
    let shown: Vec<String> = sources.iter().take(MAX_SHOWN).map(|source| source.line.to_string()).collect();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let (moves, begin) = if sources.len() == 1 { ("move in line", "begins") } else { ("moves in lines", "begin") };
    let stated =
        format!("not judged: the {moves} {}{more} {begin} at a place that the file does not state", shown.join(", "));
    (!sources.is_empty()).then_some(stated)
}

/// Returns a move that fails, in words.
fn described(failed: &Failed) -> String {
    let kind = if failed.own.piece.is_travel { "travel" } else { "drawing" };
    let proven = if failed.fault.is_proven { "" } else { " (not proven)" };
    format!("line {} ({kind}): {}{proven}", failed.own.piece.source.line, failed.fault.reason)
}

/// Returns a move that fails, for JSON.
fn failure(failed: &Failed) -> Value {
    let (piece, fault) = (&failed.own.piece, &failed.fault);
    json!({
        "line": piece.source.line,
        "column": piece.source.column,
        "kind": if piece.is_travel { "travel" } else { "drawing" },
        "cause": fault.cause,
        "reason": fault.reason,
        "place": [fault.place.x, fault.place.y],
        "proven": fault.is_proven,
    })
}
