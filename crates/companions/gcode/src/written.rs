//! Writes a program with other travels. All other lines remain unchanged.

use crate::walk::Replaced;
use crate::{Dialect, Frame};
use cplan_geometry::Point;
use cplan_toolpath::{Modes, ProgramMove};
use std::collections::BTreeMap;

/// Number of decimals of written coordinates: 0.0001 mm or 0.00001 inch.
const DECIMALS: [i32; 2] = [4, 5];

/// Length of a unit, metres, above which the unit is an inch.
const MILLIMETRE: f64 = 1e-3;

/// Greatest number of decimals, for coordinates of the program that need them.
const MAX_DECIMALS: usize = 10;

/// Greatest rounding of a written number, in the unit of the file.
const ROUNDING: f64 = 1e-9;

/// The places that a line can state with few decimals.
pub(crate) struct Grid {
    frame: Frame,
    origin: Point,
    /// Distance between neighbouring places, metres.
    step: f64,
}

impl Grid {
    pub fn new(modes: &Modes, frame: Frame) -> Self {
        let decimals = DECIMALS[usize::from(modes.unit > MILLIMETRE)];
        Self { frame, origin: modes.origin.into(), step: modes.unit / 10_f64.powi(decimals) }
    }

    /// Returns the place nearest to a point.
    pub fn nearest(&self, point: Point) -> Point {
        let away = (self.frame.to_file(point) - self.origin) / self.step;
        self.frame.to_world(self.origin + away.map(f64::round) * self.step)
    }
}

/// Returns a number with as few decimals as it needs.
fn number(value: f64) -> String {
    let written = |decimals: usize| format!("{value:.decimals$}");
    let is_same = |text: &String| text.parse::<f64>().is_ok_and(|read| (read - value).abs() <= ROUNDING);
    let text = (0..MAX_DECIMALS).map(written).find(is_same).unwrap_or_else(|| written(MAX_DECIMALS));
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| "0.".contains(c)) => rest.to_owned(),
        _ => text,
    }
}

/// Returns the words X and Y of a move between two places of the world.
fn coordinates(modes: &Modes, frame: Frame, from: Point, to: Point) -> String {
    let [from, to] = [from, to].map(|point| frame.to_file(point));
    let origin = if modes.is_relative { from } else { Point::from(modes.origin) };
    let [x, y] = [0, 1].map(|k| number((to[k] - origin[k]) / modes.unit));
    format!("X{x} Y{y}")
}

/// Returns a program with other travels.
///
/// # Errors
/// The number of a line whose checksum would no longer hold.
pub(crate) fn program(
    text: &str,
    moves: &[ProgramMove],
    replaced: &[Replaced],
    (dialect, frame): (Dialect, Frame),
) -> Result<String, usize> {
    let by_line: BTreeMap<usize, &Replaced> =
        replaced.iter().map(|own| (moves[own.index].piece.source.line, own)).collect();
    let mut written = String::with_capacity(text.len());
    for (whole, number) in text.split_inclusive('\n').zip(1..) {
        let Some(own) = by_line.get(&number) else {
            written.push_str(whole);
            continue;
        };
        let line = whole.trim_end_matches(['\n', '\r']);
        let ending = if whole.len() > line.len() { &whole[line.len()..] } else { "\n" };
        if line.split([';', '(']).next().is_some_and(|code| code.contains('*')) {
            return Err(number);
        }
        let lines = travel(line, &moves[own.index], frame, &own.points);
        let count = lines.len();
        let comment = format!("cplan: the travel of line {number} of the original, in {count} moves");
        for line in [dialect.comment(&comment)].into_iter().chain(lines) {
            written.push_str(&line);
            written.push_str(ending);
        }
        if whole.len() == line.len() {
            written.truncate(written.len() - ending.len());
        }
    }
    Ok(written)
}

/// Returns the lines of a travel through places. The first one is the line of the program with other words X and Y, so its
/// modes, its speed and its other words apply from the beginning. A word Z that lowers the tool moves to the last line.
fn travel(line: &str, own: &ProgramMove, frame: Frame, points: &[Point]) -> Vec<String> {
    let (modes, start) = (&own.modes, Point::from(own.piece.curve.start()));
    let characters: Vec<char> = line.chars().collect();
    let [x, y, z] = &modes.words;
    let lowered = z.as_ref().filter(|_| points.len() > 1 && modes.rise.is_some_and(|rise| rise < 0.0));
    let mut edits = vec![(x.clone().or(y.clone()), coordinates(modes, frame, start, points[0]))];
    if x.is_some() && y.is_some() {
        edits.push((y.clone(), String::new()));
    }
    edits.push((lowered.cloned(), String::new()));
    let mut edits: Vec<_> = edits.into_iter().filter_map(|(range, text)| Some((range?, text))).collect();
    edits.sort_by_key(|(range, _)| range.start);
    let (mut first, mut from) = (String::new(), 0);
    for (range, text) in edits {
        first.extend(&characters[from..range.start]);
        first.push_str(&text);
        // The spaces after a removed word are removed, too.
        let spaces = characters[range.end..].iter().take_while(|c| **c == ' ' && text.is_empty()).count();
        from = range.end + spaces;
    }
    first.extend(&characters[from..]);
    // So are the spaces before a removed word at the end of the line.
    if !line.ends_with(' ') {
        first.truncate(first.trim_end_matches(' ').len());
    }
    let motion = if modes.is_rapid { "G0" } else { "G1" };
    let further = points.windows(2).map(|pair| format!("{motion} {}", coordinates(modes, frame, pair[0], pair[1])));
    let mut lines: Vec<String> = [first].into_iter().chain(further).collect();
    if let (Some(range), Some(last)) = (lowered, lines.last_mut()) {
        last.push(' ');
        last.extend(&characters[range.clone()]);
    }
    lines
}
