//! The answer about a program.

use crate::fault::{Cause, Fault};
use crate::player::Player;
use crate::walk::{Replaced, Walk};
use crate::{Dialect, Job, written};
use cplan_deviation::Kinematics;
use cplan_handling::{DEFAULT_TOLERANCE, MIN_TOLERANCE};
use cplan_model::{Elbow, Scene, Status};
use cplan_toolpath::ProgramMove;

/// Greatest difference between the drawing moves of the program and of the written one, metres. It covers rounding.
const MAX_DIFFERENCE: f64 = 1e-9;

/// The firmware's division of each line into segments, on which the joints move straight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Segments {
    /// Segments so short that the tip stays within the tolerance of the line.
    #[default]
    Short,
    /// Segments of at most this length, metres.
    OfLength(f64),
    /// Segments of straight lines as in Marlin or RepRapFirmware: their number follows from the length and the speed
    /// (F) of the move.
    PerSecond {
        /// Number of segments per second.
        rate: f64,
        /// Least length of a segment, metres. `None` for the firmware's default.
        least: Option<f64>,
        /// Greatest length of the segments of arcs, metres.
        arcs: f64,
    },
}

impl Segments {
    /// Returns a number that is not positive and finite.
    fn invalid(&self) -> Option<f64> {
        let numbers = match *self {
            Segments::Short => vec![],
            Segments::OfLength(length) => vec![length],
            Segments::PerSecond { rate, least, arcs } => [rate, arcs].into_iter().chain(least).collect(),
        };
        numbers.into_iter().find(|number| !(number.is_finite() && *number > 0.0))
    }
}

/// Settings for the judgement of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Greatest distance of the tip from the line in the machine, metres, at least [`MIN_TOLERANCE`].
    pub tolerance: f64,
    /// Division of each line into segments, on which the joints move straight.
    pub segments: Segments,
    /// The side of the elbow. `None` if the machine can be set up with either side.
    pub elbow: Option<Elbow>,
    /// True if unsafe travels are replaced.
    pub repairs: bool,
}

impl Default for Settings {
    /// Returns a tolerance of a hundredth of a millimetre, short segments, either side of the elbow, and replaced travels.
    fn default() -> Self {
        Self { tolerance: DEFAULT_TOLERANCE, segments: Segments::Short, elbow: None, repairs: true }
    }
}

/// The reason why a program cannot be judged or written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GcodeError {
    /// A length of segments, or their number per second, is not a positive number.
    #[error("the length of segments, or their number per second, is {0}, but must be a finite number above 0")]
    Segment(f64),
    /// The firmware does not divide lines by a number of segments per second.
    #[error("{0} does not divide lines by segments per second; state the length of segments, or leave the number out")]
    SegmentsPerSecond(Dialect),
    /// A move has no speed, although the speed determines its number of segments.
    #[error(
        "line {0}: no speed is stated before this move, but the number of segments depends on the speed; write an F before this line"
    )]
    NoSpeed(usize),
    /// The tolerance is too small, or not a number.
    #[error("the tolerance is {0} m; it must be a finite number of at least {MIN_TOLERANCE} m")]
    Tolerance(f64),
    /// The arm has no elbow, but a side of the elbow is required.
    #[error("only arms with two revolute joints have an elbow; leave out the side of the elbow")]
    NoElbow,
    /// A travel with a checksum would have to be replaced.
    #[error("line {0} has a checksum, which cplan would have to change; write the program without checksums")]
    Checksum(usize),
}

/// A move that the machine cannot play, or that is not proven to be safe.
#[derive(Debug, Clone, PartialEq)]
pub struct Failed {
    /// The move.
    pub own: ProgramMove,
    /// The reason.
    pub fault: Fault,
}

/// A travel that was replaced.
#[derive(Debug, Clone, PartialEq)]
pub struct Travel {
    /// Number of its line.
    pub line: usize,
    /// The ends of the moves that replace it, from the beginning to the end of the travel, metres.
    pub points: Vec<[f64; 2]>,
}

impl Travel {
    /// Returns the number of moves that replace it.
    pub fn moves(&self) -> usize {
        self.points.len() - 1
    }
}

/// The answer about a program.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The side of the elbow; `None` for arms without one.
    pub elbow: Option<Elbow>,
    /// All moves that fail, in order.
    pub failed: Vec<Failed>,
    /// All travels that are replaced, in order.
    pub replaced: Vec<Travel>,
    /// The program with safe travels. `None` if a move fails, or if travels should not be replaced.
    pub text: Option<Vec<u8>>,
    /// The answer for the other side of the elbow, if that was tried and fails, too.
    pub other: Option<Box<Answer>>,
}

impl Answer {
    /// Returns the status. It is *found* if all moves are proven, and *infeasible* if the machine cannot play the
    /// program with any permitted side of the elbow.
    pub fn status(&self) -> Status {
        let is_proven = |answer: &Self| answer.failed.iter().any(|failed| failed.fault.is_proven);
        if self.failed.is_empty() {
            Status::Found
        } else if is_proven(self) && self.other.as_deref().is_none_or(is_proven) {
            Status::Infeasible
        } else {
            Status::Unknown
        }
    }
}

/// Judges a program, and replaces unsafe travels on request. The time is proportional to the number of moves, plus the
/// planning of a motion for each unsafe travel that cannot follow an earlier path.
///
/// # Errors
/// [`GcodeError`]: unusable settings, a move without a necessary speed, and a checksum on a line that must be replaced.
pub fn judge(scene: &Scene, job: &Job, settings: &Settings) -> Result<Answer, GcodeError> {
    if !(settings.tolerance.is_finite() && settings.tolerance >= MIN_TOLERANCE) {
        return Err(GcodeError::Tolerance(settings.tolerance));
    }
    if let Some(number) = settings.segments.invalid() {
        return Err(GcodeError::Segment(number));
    }
    let dialect = job.setup.dialect;
    if matches!(settings.segments, Segments::PerSecond { .. }) {
        if dialect.least_segment().is_none() {
            return Err(GcodeError::SegmentsPerSecond(dialect));
        }
        if let Some(own) = job.program.moves.iter().find(|own| own.modes.feed.is_none()) {
            return Err(GcodeError::NoSpeed(own.piece.source.line));
        }
    }
    let has_elbow = scene.arm().only_turns();
    if settings.elbow.is_some() && !has_elbow {
        return Err(GcodeError::NoElbow);
    }
    let kinematics = Kinematics::new(scene.arm());
    let sides: Vec<(Option<Elbow>, usize)> = match settings.elbow {
        Some(elbow) => vec![(Some(elbow), elbow.solution())],
        None if has_elbow => Elbow::ALL.map(|elbow| (Some(elbow), elbow.solution())).to_vec(),
        None => (0..if kinematics.has_two_solutions() { 2 } else { 1 }).map(|solution| (None, solution)).collect(),
    };
    let players: Vec<(Option<Elbow>, Player)> = sides
        .into_iter()
        .map(|(elbow, solution)| (elbow, Player::new(scene, &kinematics, solution, settings, dialect)))
        .collect();
    let mut walks: Vec<(Option<Elbow>, Walk)> =
        players.iter().map(|(elbow, player)| (*elbow, Walk::new(player, &job.program.moves))).collect();
    // Prefer the side with fewer failed moves.
    walks.sort_by_key(|(_, walk)| (walk.failed.len(), walk.broken.len()));
    let mut best: Option<Answer> = None;
    for (elbow, walk) in walks {
        let answer = finished(job, settings, elbow, walk)?;
        if answer.failed.is_empty() {
            return Ok(answer);
        }
        best = Some(match best {
            None => answer,
            Some(first) => Answer { other: Some(Box::new(answer)), ..first },
        });
    }
    Ok(best.expect("at least one side"))
}

/// Replaces travels on request, and proves the written program.
fn finished(job: &Job, settings: &Settings, elbow: Option<Elbow>, mut walk: Walk) -> Result<Answer, GcodeError> {
    let moves = &job.program.moves;
    let replaced = if settings.repairs { walk.repair(job.setup.frame) } else { Vec::new() };
    walk.keep_travels();
    let travel = |own: &Replaced| {
        let piece = &moves[own.index].piece;
        let points = [piece.curve.start()].into_iter().chain(own.points.iter().map(|point| (*point).into()));
        Travel { line: piece.source.line, points: points.collect() }
    };
    let travels = replaced.iter().map(travel).collect();
    let failed = walk.failed.iter().map(|(index, fault)| Failed { own: moves[*index].clone(), fault: fault.clone() });
    let mut answer = Answer { elbow, failed: failed.collect(), replaced: travels, text: None, other: None };
    if answer.failed.is_empty() && settings.repairs {
        let text = text(job, &replaced)?;
        match first_unproven(job, &walk, &text) {
            None => answer.text = Some(text),
            Some(failed) => answer.failed.push(failed),
        }
    }
    Ok(answer)
}

fn text(job: &Job, replaced: &[Replaced]) -> Result<Vec<u8>, GcodeError> {
    if replaced.is_empty() {
        return Ok(job.bytes.clone());
    }
    let text = String::from_utf8_lossy(&job.bytes);
    // The reader counts characters after the byte order mark.
    let (mark, rest) = text.split_at(text.len() - text.trim_start_matches('\u{feff}').len());
    let form = (job.setup.dialect, job.setup.frame);
    let program = written::program(rest, &job.program.moves, replaced, form).map_err(GcodeError::Checksum)?;
    Ok(format!("{mark}{program}").into_bytes())
}

/// Reads a written program, and judges it again. Returns the first move that differs from the program, or that is not proven.
fn first_unproven(job: &Job, walk: &Walk, text: &[u8]) -> Option<Failed> {
    let moves = &job.program.moves;
    if text == job.bytes {
        return None;
    }
    let differs = |own: &ProgramMove, why: &str| Failed {
        own: own.clone(),
        fault: Fault { cause: Cause::NoTravel, ..Fault::undecided(own.piece.curve.end().into(), why.to_owned()) },
    };
    let Ok(again) = job.again(text) else { return Some(differs(&moves[0], "the written program cannot be read")) };
    let again = again.program;
    let drawn = |moves: &[ProgramMove]| -> Vec<ProgramMove> {
        moves.iter().filter(|own| !own.piece.is_travel).cloned().collect()
    };
    let (before, after) = (drawn(moves), drawn(&again.moves));
    let is_same = |one: &ProgramMove, two: &ProgramMove| {
        [0.0, 0.5, 1.0].iter().all(|u| {
            let [a, b] = [one, two].map(|own| own.piece.curve.at(*u));
            (a[0] - b[0]).hypot(a[1] - b[1]) <= MAX_DIFFERENCE
        })
    };
    if let Some((own, _)) = before.iter().zip(&after).find(|(one, two)| !is_same(one, two)) {
        return Some(differs(own, "in the written program, this line is different"));
    }
    if before.len() != after.len() {
        return Some(differs(&moves[0], "the written program has more or fewer lines"));
    }
    let mut proven = walk.again(&again.moves);
    proven.keep_travels();
    let (index, fault) = proven.failed.into_iter().next()?;
    Some(Failed { own: again.moves[index].clone(), fault })
}
