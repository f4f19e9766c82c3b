//! Joint values as a table: a header with the names of columns, then one sample per line. Commas, semicolons or tabs separate
//! values. Lines that begin with `#` are comments, except for the header.

use super::columns::{Meaning, Quantity, meanings};
use super::records::{Field, Records};
use super::samples::{Names, Samples, Series};
use super::units::{self, Dimension, Unit};
use cplan_robot::{Diagnostic, InputError, Source, quoted};

/// Reads a table. For the names of columns, see [`super::load_recording`].
pub(super) fn read(source: &Source, names: &Names) -> Result<Samples, InputError> {
    let separator = separator(source.text(), names);
    let mut records = Records::new(source.text(), separator);
    // The header may begin with `#`, too.
    let header = records.find(|record| !is_comment(record) || names_joints(record, names));
    let header = header.ok_or_else(|| {
        source
            .diagnostic("is empty")
            .help("write a header with the names of the columns, such as time,joint1,joint2, and then the samples")
    })?;
    let mut columns = Columns::new(source, names, &header)?;
    let mut samples = Samples { what: "sample".into(), ..Samples::default() };
    let mut values: Vec<Vec<f64>> = columns.used.iter().map(|_| Vec::new()).collect();
    let (mut repeated, mut blank) = (0, 0);
    for record in records.filter(|record| !is_comment(record)) {
        if record.len() != header.len() {
            let message = format!("this line has {} values, but the header has {} names", record.len(), header.len());
            return Err(source
                .diagnostic_at(record_range(&record), message)
                .help("write one value for each name of the header")
                .into());
        }
        if columns.is_blank(&record) {
            blank += 1;
            continue;
        }
        let sample = (0..columns.used.len()).map(|k| columns.value(source, &header, k, &record));
        let sample = sample.collect::<Result<Vec<f64>, Diagnostic>>()?;
        // A line that is equal to the one before, including its time, repeats a sample.
        if columns.has_time()
            && !sample.is_empty()
            && values.iter().map(|column| column.last()).eq(sample.iter().map(Some))
        {
            repeated += 1;
            continue;
        }
        values.iter_mut().zip(sample).for_each(|(column, value)| column.push(value));
        samples.places.push(record_range(&record));
    }
    if repeated > 0 {
        let plural = if repeated == 1 { " repeats the previous one" } else { "s repeat the previous ones" };
        columns.notes.push(format!("{repeated} sample{plural}; ignored"));
    }
    if blank > 0 {
        let plural = if blank == 1 { " holds" } else { "s hold" };
        columns.notes.push(format!("{blank} line{plural} no value of any joint; ignored"));
    }
    if separator != ',' {
        let name = if separator == ';' { "semicolons" } else { "tabs" };
        columns.notes.push(format!("values are separated by {name}"));
    }
    columns.fill(&mut samples, values);
    Ok(samples)
}

/// Returns the separator of a table: the first of comma, semicolon and tab with which some line names a joint.
fn separator(text: &str, names: &Names) -> char {
    let names_some = |separator: &char| {
        let mut heads = Records::new(text, *separator).take(MAX_HEADER_LINES);
        heads.any(|record| record.len() > 1 && names_joints(&record, names))
    };
    [',', ';', '\t'].into_iter().find(names_some).unwrap_or(',')
}

/// The header is sought among this number of lines at the beginning.
const MAX_HEADER_LINES: usize = 64;

fn is_comment(record: &[Field]) -> bool {
    record.first().is_some_and(|field| field.text.starts_with('#'))
}

/// Returns true if a line names a joint of the arm.
fn names_joints(record: &[Field], names: &Names) -> bool {
    let joints: Vec<&str> = names.all().collect();
    let name = |field: &Field| field.text.trim_start_matches(['#', ' ']).to_owned();
    record.iter().any(|field| column_meanings(&name(field), &joints).0.iter().any(|m| matches!(m, Meaning::Of(..))))
}

fn record_range(record: &[Field]) -> std::ops::Range<usize> {
    record.first().map_or(0, |f| f.range.start)..record.last().map_or(0, |f| f.range.end)
}

fn number(source: &Source, name: &Field, field: &Field) -> Result<f64, Diagnostic> {
    match field.text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) => Err(source
            .diagnostic_at(field.range.clone(), format!("{} is {value}", quoted([&name.text])))
            .help("drop the samples that were not measured")),
        Err(_) => Err(source
            .diagnostic_at(
                field.range.clone(),
                format!("{} is \"{}\", which is not a number", quoted([&name.text]), field.text),
            )
            .help("write numbers with a decimal point and no unit; write units in the header: elbow [deg]")),
    }
}

/// A column that is read.
struct Column {
    /// Index of the column in each line.
    index: usize,
    meaning: Meaning,
    /// Unit of the values. `None` for radians, metres and seconds.
    unit: Option<Unit>,
}

/// The columns to read.
struct Columns {
    /// Names of the joints, in the order of the indices in meanings.
    joints: Vec<String>,
    used: Vec<Column>,
    /// Whole seconds of the first time if times are dates; they are subtracted from all times. `None` if times are not dates.
    epoch: Option<i64>,
    notes: Vec<String>,
}

impl Columns {
    fn new(source: &Source, names: &Names, header: &[Field]) -> Result<Self, Diagnostic> {
        let joints: Vec<&str> = names.all().collect();
        let (mut used, mut unknown): (Vec<Column>, Vec<&str>) = (Vec::new(), Vec::new());
        for (index, field) in header.iter().enumerate() {
            // Some programs write the header as a comment.
            let name = if index == 0 { field.text.trim_start_matches(['#', ' ']) } else { &field.text };
            let (known, unit) = column_meanings(name, &joints);
            match known[..] {
                [] => unknown.push(name),
                [meaning] => {
                    if let Some(other) = used.iter().find(|column| column.meaning == meaning) {
                        let message =
                            format!("columns \"{}\" and \"{name}\" have the same meaning", header[other.index].text);
                        return Err(source.diagnostic_at(field.range.clone(), message).help("keep one of them"));
                    }
                    let unit = unit.map(|unit| unit_of(source, names, field, unit, meaning)).transpose()?.flatten();
                    used.push(Column { index, meaning, unit });
                }
                _ => {
                    let message = format!("the column name \"{name}\" is ambiguous");
                    let help = "write the name of the joint, followed by .position, .velocity or .acceleration";
                    return Err(source.diagnostic_at(field.range.clone(), message).help(help));
                }
            }
        }
        if used.is_empty() && header.iter().all(|f| f.text.parse::<f64>().is_ok()) {
            let help = format!("name the columns in the first line: time, {}", names.arm.join(", "));
            return Err(source.diagnostic_at(record_range(header), "there is no header").help(help));
        }
        let has = |index: usize| used.iter().any(|column| column.meaning == Meaning::Of(index, Quantity::Position));
        // The arm's joints have the first indices.
        if let Some(missing) = (0..names.arm.len()).find(|index| !has(*index)) {
            let columns = quoted(header.iter().map(|field| &field.text));
            let message = format!("holds no positions of joint \"{}\"; the columns are {columns}", names.arm[missing]);
            let help = format!("name the columns of positions after the arm's joints: {}", quoted(names.arm));
            return Err(source.diagnostic_at(record_range(header), message).help(help));
        }
        let mut notes = Vec::new();
        let converted = used.iter().filter(|column| column.unit.is_some_and(|unit| unit.is_converted()));
        let converted: Vec<&str> = converted.map(|column| &*header[column.index].text).collect();
        if !converted.is_empty() {
            notes.push(format!("converted to radians, metres and seconds: {}", quoted(converted)));
        }
        if !unknown.is_empty() {
            notes.push(format!("unused columns: {}", quoted(unknown)));
        }
        Ok(Self { joints: joints.into_iter().map(str::to_owned).collect(), used, epoch: None, notes })
    }

    fn has_time(&self) -> bool {
        self.used.iter().any(|column| column.meaning == Meaning::Time)
    }

    /// Returns true if a record has no joint values. Tables with several sources that log at different times have such lines.
    fn is_blank(&self, record: &[Field]) -> bool {
        let mut joints = self.used.iter().filter(|column| column.meaning != Meaning::Time);
        joints.all(|column| record[column.index].text.is_empty())
    }

    /// Returns the value of a column in a line, in radians, metres or seconds.
    fn value(&mut self, source: &Source, header: &[Field], k: usize, record: &[Field]) -> Result<f64, Diagnostic> {
        let Column { index, meaning, unit } = self.used[k];
        let (name, field) = (&header[index], &record[index]);
        let value = number(source, name, field)?;
        if let Some(unit) = unit {
            return Ok(unit.convert(value));
        }
        if meaning != Meaning::Time {
            return Ok(value);
        }
        // As a double, a date would resolve only a quarter of a microsecond, so the decimals are read separately.
        let parts = field.text.split_once('.').unwrap_or((&field.text, "0"));
        let Ok(seconds) = parts.0.parse::<i64>() else { return Ok(value) };
        if self.epoch.is_none() {
            self.epoch = Some(if value > MAX_RELATIVE_TIME { seconds } else { 0 });
            if value > MAX_RELATIVE_TIME {
                self.notes.push(format!("times are dates; {seconds} s counts as 0"));
            }
        }
        let rest = self.epoch.filter(|epoch| *epoch > 0 && seconds >= *epoch).map(|epoch| seconds - epoch);
        Ok(rest.and_then(|rest| format!("{rest}.{}", parts.1).parse().ok()).unwrap_or(value))
    }

    fn fill(self, samples: &mut Samples, values: Vec<Vec<f64>>) {
        let mut series: Vec<[Option<Vec<f64>>; 4]> = self.joints.iter().map(|_| Default::default()).collect();
        for (column, values) in self.used.into_iter().zip(values) {
            match column.meaning {
                Meaning::Time => samples.time = Some(values),
                Meaning::Of(joint, quantity) => series[joint][quantity as usize] = Some(values),
            }
        }
        for (name, [position, velocity, acceleration, torque]) in self.joints.into_iter().zip(series) {
            samples.has_torques |= torque.is_some();
            if let Some(position) = position {
                samples.joints.push(Series { name, position, velocity, acceleration });
            }
        }
        samples.notes.extend(self.notes);
    }
}

/// Largest time, in seconds, that counts as relative to a start: eleven days. Larger times are dates.
const MAX_RELATIVE_TIME: f64 = 1e6;

/// Returns the possible meanings of a column, and the unit after its name if there is one.
fn column_meanings<'a>(name: &'a str, joints: &[&str]) -> (Vec<Meaning>, Option<&'a str>) {
    match (meanings(name, joints), units::split(name)) {
        (known, Some((base, unit))) if known.is_empty() => (meanings(base, joints), Some(unit)),
        (known, _) => (known, None),
    }
}

/// Returns the unit of a column; `None` for torques, which are not read.
///
/// # Errors
/// Units that are unknown, or do not fit the joint.
fn unit_of(
    source: &Source,
    names: &Names,
    field: &Field,
    unit: &str,
    meaning: Meaning,
) -> Result<Option<Unit>, Diagnostic> {
    let dimensions: &[Dimension] = match meaning {
        Meaning::Of(_, Quantity::Torque) => return Ok(None),
        Meaning::Time => &[Dimension::Time],
        Meaning::Of(joint, _) => match names.turns.get(joint) {
            Some(true) => &[Dimension::Angle],
            Some(false) => &[Dimension::Length],
            None => &[Dimension::Angle, Dimension::Length],
        },
    };
    let wrong = |message: String, help: String| Err(source.diagnostic_at(field.range.clone(), message).help(help));
    match units::unit(unit, meaning) {
        None => wrong(
            format!("the unit \"{unit}\" of column \"{}\" is unknown", field.text),
            format!("units are {}", units::KNOWN_UNITS_TEXT),
        ),
        Some(found) if !dimensions.contains(&found.dimension) => wrong(
            format!("column \"{}\" cannot have the unit \"{unit}\"", field.text),
            "joints that turn are in rad or deg, joints that slide in m, cm or mm, times in s, ms or ns".into(),
        ),
        found => Ok(found),
    }
}
