//! Reads line maps, and the goals of a preference file.

use super::{ReadResult, Reader, Value, origin};
use crate::files::Files;
use cplan_check::decimal::Decimal;
use cplan_check::obstacle::{Obstacle, Outline};
use cplan_check::polygon::Corner;
use cplan_check::world::{Goal, World};
use cplan_check::{CheckError, Input};
use std::collections::VecDeque;
use std::path::Path;

/// Conversion from the unit of a map to that of the world.
struct Unit {
    scale: Decimal,
    offset: Corner,
}

impl Unit {
    fn place(&self, p: &Corner) -> Corner {
        [0, 1].map(|k| &(&p[k] * &self.scale) + &self.offset[k])
    }
}

impl Reader<'_> {
    /// Reads `[map]`. Adds the map's walls after the obstacles. The map's goal applies if the world has neither a goal
    /// nor steps.
    pub(super) fn map(&self, value: &Value, has_steps: bool, world: &mut World) -> ReadResult<()> {
        let (mut file, mut wishes, mut is_framed, mut heights) = (None, None, true, None);
        let mut unit = Unit { scale: Decimal::power_of_ten(3), offset: origin() };
        for (key, value) in self.table(value)? {
            match &**key.get_ref() {
                "file" => file = Some(self.file(&self.text(value)?)?),
                "preferences" => wishes = Some(self.file(&self.text(value)?)?),
                "scale" => unit.scale = self.number(value)?,
                "offset" => unit.offset = self.pair(value, |n| self.length(n))?,
                "frame" => is_framed = value.get_ref().as_bool().unwrap_or(true),
                "height" => heights = Some(self.heights(value)?),
                other => return self.error(value, &format!("the checker does not know the key {other} of a map")),
            }
        }
        let Some(file) = file else { return self.error(value, "the map has no file") };
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        for (own, outline) in walls(self.files, &file, &unit, is_framed)? {
            let (name, heights) = (Some(format!("{stem}, {own}")), heights.clone());
            world.obstacles.push(Obstacle { name, heights, ..Obstacle::new(outline) });
        }
        if let (None, Some(path), false) = (&world.goal, wishes, has_steps) {
            world.goal = Some(Goal::Areas(goals(self.files, &path, &unit)?));
        }
        Ok(())
    }
}

/// The lines of a file without comments, and the file's name.
struct Text<'a> {
    name: &'a str,
    lines: Vec<(usize, &'a str)>,
    next: usize,
}

impl<'a> Text<'a> {
    fn new(name: &'a str, text: &'a str) -> Self {
        let lines = text.lines().enumerate().map(|(number, line)| (number + 1, line.trim()));
        let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')).collect();
        Self { name, lines, next: 0 }
    }

    fn wrong<T>(&self, expected: &str) -> Result<T, CheckError> {
        let place = self.lines.get(self.next).map_or_else(|| "at its end".to_owned(), |(n, _)| format!("line {n}"));
        Err(CheckError::in_file(Input::World, format!("{}, {place}: expected {expected}", self.name)))
    }

    fn word(&mut self, word: &str) -> Result<(), CheckError> {
        if self.lines.get(self.next).is_none_or(|(_, line)| *line != word) {
            return self.wrong(word);
        }
        self.next += 1;
        Ok(())
    }

    fn next_line_begins_with(&self, key: &str) -> bool {
        self.lines.get(self.next).is_some_and(|(_, line)| line.starts_with(key))
    }

    /// Reads a line of numbers, which follow a key and a colon unless `key` is empty.
    fn numbers<const N: usize>(&mut self, key: &str) -> Result<[Decimal; N], CheckError> {
        let line = self.lines.get(self.next).map(|(_, line)| *line);
        let after = |line: &'a str| match key {
            "" => Some(line),
            key => line.strip_prefix(key)?.trim_start().strip_prefix(':'),
        };
        let words = line.and_then(after).map(|rest| rest.split_whitespace().map(Decimal::read));
        let numbers = words.and_then(|words| words.collect::<Result<Vec<_>, _>>().ok()?.try_into().ok());
        let Some(numbers) = numbers else { return self.wrong(&format!("{key} {N} numbers")) };
        self.next += 1;
        Ok(numbers)
    }

    /// Reads the corners of the whole map.
    fn bounds(&mut self) -> Result<[Corner; 2], CheckError> {
        self.word("2D-Map")?;
        Ok([self.numbers("LineMinPos")?, self.numbers("LineMaxPos")?])
    }
}

fn text_of(files: &Files, path: &Path) -> Result<String, CheckError> {
    let text = String::from_utf8(files.bytes(Input::World, path)?);
    let text = text.map_err(|_| CheckError::in_file(Input::World, format!("{} is not text", path.display())))?;
    Ok(text.trim_start_matches('\u{feff}').to_owned())
}

/// Reads the walls of a line map, and their names. Consecutive lines that share an end form one wall.
///
/// # Errors
/// If the file is not a line map.
fn walls(files: &Files, path: &Path, unit: &Unit, is_framed: bool) -> Result<Vec<(String, Outline)>, CheckError> {
    let (name, content) = (path.display().to_string(), text_of(files, path)?);
    let mut text = Text::new(&name, &content);
    let [[left, low], [right, high]] = text.bounds()?;
    let [count] = text.numbers("NumLines")?;
    text.word("LINES")?;
    let mut walls: Vec<(String, VecDeque<Corner>)> = Vec::new();
    let (mut lines, mut first) = (0, 0);
    while text.word("DATA").is_err() {
        let [a, b, c, d] = text.numbers::<4>("")?;
        let (from, to) = ([a, b], [c, d]);
        lines += 1;
        let is_point = from == to;
        // Extend the current wall at its end, or else at its beginning.
        let open = walls.last_mut().and_then(|(called, wall)| {
            let at_end = [wall.back(), wall.front()].map(|end| end.is_some_and(|end| *end == from || *end == to));
            let end = at_end.iter().position(|found| *found)?;
            *called = format!("lines {first} to {lines}");
            Some((wall, end == 0))
        });
        match open {
            Some((wall, at_end)) => {
                let end = if at_end { wall.back() } else { wall.front() };
                let other = if end == Some(&from) { to } else { from };
                match (is_point, at_end) {
                    (true, _) => {}
                    (false, true) => wall.push_back(other),
                    (false, false) => wall.push_front(other),
                }
            }
            None => {
                first = lines;
                walls.push((format!("line {first}"), if is_point { [from].into() } else { [from, to].into() }));
            }
        }
    }
    if count != Decimal::whole(lines) || text.next != text.lines.len() {
        return text.wrong("as many lines as NumLines says, and nothing after DATA");
    }
    if is_framed {
        let corner = |x: &Decimal, y: &Decimal| [x.clone(), y.clone()];
        let [a, b] = [corner(&left, &low), corner(&right, &high)];
        walls.push(("frame".into(), [a.clone(), corner(&right, &low), b, corner(&left, &high), a].into()));
    }
    let outline = |wall: VecDeque<Corner>| {
        let mut points: Vec<Corner> = wall.iter().map(|p| unit.place(p)).collect();
        if points.len() > 1 { Outline::Polyline(points) } else { Outline::Circle(points.remove(0), Decimal::whole(0)) }
    };
    Ok(walls.into_iter().map(|(called, wall)| (called, outline(wall))).collect())
}

/// Reads the goals of a preference file.
///
/// # Errors
/// If the file is not a preference file, up to the goals.
fn goals(files: &Files, path: &Path, unit: &Unit) -> Result<Vec<[Corner; 2]>, CheckError> {
    let (name, content) = (path.display().to_string(), text_of(files, path)?);
    let mut text = Text::new(&name, &content);
    text.bounds()?;
    let [count] = text.numbers("NumGoal")?;
    text.word("GOAL")?;
    let mut goals = Vec::new();
    while !text.next_line_begins_with("NumPoint") {
        let [a, b, c, d] = text.numbers::<4>("")?;
        goals.push([unit.place(&[a, b]), unit.place(&[c, d])]);
    }
    if goals.is_empty() || count != Decimal::whole(goals.len() as i32) {
        return text.wrong("as many goals as NumGoal says");
    }
    Ok(goals)
}
