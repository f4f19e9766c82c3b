//! The effect of words on the line.

use super::words::Word;

/// The effect of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    /// It affects the tip's line.
    Follow(Slot),
    /// It commands the machine, or repeats what cplan does anyway. It is only listed.
    Listed,
    /// It would change the line in a way that cplan cannot follow.
    Refused(Reason),
    /// It is the number of its line, which has no effect.
    Number,
}

/// The purposes of words that affect the tip's line. A program's line has at most one word for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// G0 to G3.
    Motion,
    /// G80, which ends the kind of move.
    NoMotion,
    /// G20 and G21.
    Unit,
    /// G90 and G91.
    Distance,
    /// G90.1 and G91.1.
    Centers,
    /// G54 to G59.3.
    System,
    /// G92 to G92.3.
    Shift,
    /// G28, G30 and G53.
    Home,
    /// G4.
    Dwell,
    /// M2 and M30.
    End,
    F,
    I,
    J,
    R,
    X,
    Y,
}

pub(super) const SLOTS: usize = Slot::Y as usize + 1;

/// The reason why cplan cannot follow a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Reason {
    /// The effect, as words that follow the word in a message.
    pub does: &'static str,
    /// Another form of the same line.
    pub hint: &'static str,
}

const fn reason(does: &'static str, hint: &'static str) -> Reason {
    Reason { does, hint }
}

const NUMBERS: &str = "let the program that writes the file write out each move, with numbers";

const PLANE: Reason = reason("changes the plane of arcs", "write the arcs in the plane of X and Y (G17)");
const OFFSET: Reason = reason(
    "offsets the line by the tool's radius",
    "let the program that writes the file compute the offset line, and use G40",
);
const FRAME: Reason = reason("moves, turns, scales or mirrors the coordinates", "write the resulting coordinates");
pub(super) const OTHER_SYSTEM: Reason = reason(
    "selects a coordinate system whose origin the file does not state",
    "write all coordinates in one system, such as G54",
);
pub(super) const OPTIONAL: Reason =
    reason("begins a line that some machines run and others leave out", "remove the line, or its /");
pub(super) const UNSTATED_ORIGIN: Reason = reason(
    "returns to an origin that the file does not state",
    "write coordinates that do not need this origin, without G92.3",
);
const CYCLE: Reason = reason("is a cycle of several moves", NUMBERS);
const PROBE: Reason = reason("moves until a probe touches something", "write a move to the place where it stops");
const CURVE: Reason = reason("draws a curve that cplan does not read", "write straight lines (G1) and arcs (G2, G3)");
const FEED: Reason = reason("changes the meaning of F", "write F in units per minute (G94)");
const DIAMETER: Reason = reason("makes X a diameter", "write X as a radius (G8)");
const FLOW: Reason = reason("repeats, skips or calls lines", NUMBERS);
const COMPUTED: Reason = reason("stands for a computed number", NUMBERS);
const TURN: Reason = reason("turns the tool", "write a file for the axes X, Y and Z");
const OTHER_AXIS: Reason = reason("moves an axis that the arm does not have", "write a file for the axes X, Y and Z");
const OTHER_CENTER: Reason =
    reason("is part of an arc in another plane", "write the arcs in the plane of X and Y (G17)");
const REPEAT: Reason = reason("repeats the line", NUMBERS);
const UNKNOWN: Reason =
    reason("is not a word that cplan knows", "use G0 to G3; docs/following.md lists the words that cplan reads");

/// Returns the reason why cplan cannot follow a move to a place of the machine. Unless `is_inside`, nothing is drawn
/// before or after the move, so the program does not need it.
pub(super) fn machine_place(is_inside: bool) -> Reason {
    let hint = match is_inside {
        true => "write a move (G0) to that place, in the coordinates of the file",
        false => "remove this line; nothing is drawn before or after it",
    };
    reason("moves to a place of the machine, which the file does not state", hint)
}

/// Returns the effect of a word among the words of its block.
pub(super) fn of(word: &Word, block: &[Word]) -> Meaning {
    use Meaning::{Follow, Listed, Refused};
    if word.is_computed {
        return Refused(if word.letter == 'O' { FLOW } else { COMPUTED });
    }
    let has = |letter: char, values: &[f64]| block.iter().any(|other| other.is(letter, values));
    match word.letter {
        'G' => word.value.map_or(Refused(UNKNOWN), |value| preparatory(value, block)),
        'M' => match word.value {
            Some(2.0 | 30.0) => Follow(Slot::End),
            Some(97.0..=99.0) => Refused(FLOW),
            _ => Listed,
        },
        'N' => Meaning::Number,
        'F' => Follow(Slot::F),
        'I' => Follow(Slot::I),
        'J' => Follow(Slot::J),
        'R' => Follow(Slot::R),
        'X' => Follow(Slot::X),
        'Y' => Follow(Slot::Y),
        'A' | 'B' | 'C' if !has('G', &[92.0]) => Refused(TURN),
        'U' if has('G', &[4.0]) => Listed,
        'U' | 'V' | 'W' if !has('G', &[92.0]) => Refused(OTHER_AXIS),
        'K' if word.value != Some(0.0) => Refused(OTHER_CENTER),
        'L' if !block.iter().any(|other| other.letter == 'M') => Refused(REPEAT),
        _ => Listed,
    }
}

/// Returns the effect of a G word among the words of its block.
fn preparatory(value: f64, block: &[Word]) -> Meaning {
    use Meaning::{Follow, Listed, Refused};
    // G codes have at most one decimal.
    let tenths = (value * 10.0).round();
    if (tenths - value * 10.0).abs() > 1e-6 || !(0.0..1e4).contains(&tenths) {
        return Refused(UNKNOWN);
    }
    match tenths as u32 {
        0 | 10 | 20 | 30 => Follow(Slot::Motion),
        800 => Follow(Slot::NoMotion),
        40 => Follow(Slot::Dwell),
        200 | 210 => Follow(Slot::Unit),
        900 | 910 => Follow(Slot::Distance),
        901 | 911 => Follow(Slot::Centers),
        540 | 550 | 560 | 570 | 580 | 590..=593 => Follow(Slot::System),
        920..=923 => Follow(Slot::Shift),
        280 | 300 | 530 => Follow(Slot::Home),
        70 => Refused(DIAMETER),
        180 | 190 => Refused(PLANE),
        410..=421 => Refused(OFFSET),
        160 | 510 | 511 | 520 | 680..=689 => Refused(FRAME),
        100 if block.iter().any(|word| word.letter == 'L') => Refused(FRAME),
        50..=63 | 120 | 130 => Refused(CURVE),
        310 | 380..=389 => Refused(PROBE),
        320..=339 | 700..=769 | 810..=899 => Refused(CYCLE),
        930 | 950 | 960 => Refused(FEED),
        // Exact stop, a lathe's radius, retraction, cancelled modes, the plane, tool length, and path control.
        80 | 90 | 100 | 110 | 150 | 170 | 400 | 430..=449 | 490 | 500 | 501 => Listed,
        281 | 301 | 610 | 611 | 640 | 690 | 940 | 970 | 980 | 990 => Listed,
        _ => Refused(UNKNOWN),
    }
}

/// Returns the reason why cplan cannot follow a firmware's command; `None` if it does not change the line.
pub(super) fn of_command(name: &str) -> Option<Reason> {
    match name.to_ascii_uppercase().as_str() {
        "SET_GCODE_OFFSET" | "SET_KINEMATIC_POSITION" | "RESTORE_GCODE_STATE" => Some(FRAME),
        "$J" | "FORCE_MOVE" => Some(machine_place(true)),
        _ => None,
    }
}
