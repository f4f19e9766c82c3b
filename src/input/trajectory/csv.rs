//! Joint values as a table: a header of names, then a sample a line. Values are separated by commas, semicolons or tabs, as
//! the header has it; lines that begin with `#` are comments, but for the header itself.

use super::columns::{Meaning, meanings};
use super::records::{Field, Records};
use super::{Names, Samples, Series};
use crate::input::error::{Diagnostic, InputError, quoted};
use crate::input::source::Source;

/// Reads a table. See [`super::load_recording`] for the names of columns.
pub(super) fn read(source: &Source, names: &Names) -> Result<Samples, InputError> {
    let separator = separator(&source.text, names);
    let mut records = Records::new(&source.text, separator);
    // A comment may be the header.
    let header = records.find(|record| !is_comment(record) || names_joints(record, names));
    let header = header.ok_or_else(|| {
        source.diagnostic("is empty").help("write a header of names, then the samples: time,joint1,joint2")
    })?;
    let mut columns = Columns::new(source, names, &header)?;
    let mut samples = Samples { what: "sample", ..Samples::default() };
    let mut values: Vec<Vec<f64>> = columns.used.iter().map(|_| Vec::new()).collect();
    let mut repeated = 0;
    for record in records.filter(|record| !is_comment(record)) {
        if record.len() != header.len() {
            let message = format!("this line has {} values, the header has {} names", record.len(), header.len());
            return Err(source
                .diagnostic_at(whole(&record), message)
                .help("give every line one value for each name of the header")
                .into());
        }
        let sample = columns.used.iter().map(|&(index, _)| number(source, &header[index], &record[index]));
        let sample = sample.collect::<Result<Vec<f64>, Diagnostic>>()?;
        // The same line again, its time included, is the same sample.
        if columns.has_time()
            && !sample.is_empty()
            && values.iter().map(|column| column.last()).eq(sample.iter().map(Some))
        {
            repeated += 1;
            continue;
        }
        values.iter_mut().zip(sample).for_each(|(column, value)| column.push(value));
        samples.places.push(whole(&record));
    }
    if repeated > 0 {
        let plural = if repeated == 1 { " repeats the one before it" } else { "s repeat the ones before them" };
        columns.notes.push(format!("{repeated} sample{plural}; taken once"));
    }
    if separator != ',' {
        let name = if separator == ';' { "semicolons" } else { "tabs" };
        columns.notes.push(format!("values are separated by {name}"));
    }
    columns.fill(&mut samples, values);
    Ok(samples)
}

/// The character that separates values: of comma, semicolon and tab the first with which some line names a joint.
fn separator(text: &str, names: &Names) -> char {
    let names_some = |separator: &char| {
        let mut heads = Records::new(text, *separator).take(HEAD);
        heads.any(|record| record.len() > 1 && names_joints(&record, names))
    };
    [',', ';', '\t'].into_iter().find(names_some).unwrap_or(',')
}

/// So many lines are looked at for the header.
const HEAD: usize = 64;

fn is_comment(record: &[Field]) -> bool {
    record.first().is_some_and(|field| field.text.starts_with('#'))
}

/// Whether a line names a joint of the arm.
fn names_joints(record: &[Field], names: &Names) -> bool {
    let joints: Vec<&str> = names.all().collect();
    let name = |field: &Field| field.text.trim_start_matches(['#', ' ']).to_owned();
    record.iter().any(|field| meanings(&name(field), &joints).iter().any(|m| matches!(m, Meaning::Of(..))))
}

fn whole(record: &[Field]) -> std::ops::Range<usize> {
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
                format!("{} is \"{}\", which is no number", quoted([&name.text]), field.text),
            )
            .help("write numbers with a decimal point and no unit: radians or metres, and seconds")),
    }
}

/// Which columns are read.
struct Columns {
    /// Names of the joints that a meaning's index stands for.
    joints: Vec<String>,
    /// Where each is, and what it means; ordered as in the file.
    used: Vec<(usize, Meaning)>,
    notes: Vec<String>,
}

impl Columns {
    fn new(source: &Source, names: &Names, header: &[Field]) -> Result<Self, Diagnostic> {
        let joints: Vec<&str> = names.all().collect();
        let (mut used, mut unknown): (Vec<(usize, Meaning)>, Vec<&str>) = (Vec::new(), Vec::new());
        for (index, field) in header.iter().enumerate() {
            // Some programs begin the header as a comment.
            let name = if index == 0 { field.text.trim_start_matches(['#', ' ']) } else { &field.text };
            match meanings(name, &joints)[..] {
                [] => unknown.push(name),
                [meaning] => {
                    if let Some((other, _)) = used.iter().find(|(_, known)| *known == meaning) {
                        let message = format!("columns \"{}\" and \"{name}\" mean the same", header[*other].text);
                        return Err(source.diagnostic_at(field.range.clone(), message).help("keep one of them"));
                    }
                    used.push((index, meaning));
                }
                _ => {
                    let message = format!("the column \"{name}\" can be read in more than one way");
                    let help = "name it after its joint, with .position, .velocity or .acceleration behind it";
                    return Err(source.diagnostic_at(field.range.clone(), message).help(help));
                }
            }
        }
        if used.is_empty() && header.iter().all(|f| f.text.parse::<f64>().is_ok()) {
            let help = format!("name the columns in the first line: time, {}", names.arm.join(", "));
            return Err(source.diagnostic_at(whole(header), "there is no header").help(help));
        }
        let mut notes = Vec::new();
        if !unknown.is_empty() {
            notes.push(format!("columns that are not used: {}", quoted(unknown)));
        }
        Ok(Self { joints: joints.into_iter().map(str::to_owned).collect(), used, notes })
    }

    fn has_time(&self) -> bool {
        self.used.iter().any(|(_, meaning)| *meaning == Meaning::Time)
    }

    /// Puts the columns' values where they belong.
    fn fill(self, samples: &mut Samples, values: Vec<Vec<f64>>) {
        let mut series: Vec<[Option<Vec<f64>>; 4]> = self.joints.iter().map(|_| Default::default()).collect();
        for ((_, meaning), column) in self.used.into_iter().zip(values) {
            match meaning {
                Meaning::Time => samples.time = Some(column),
                Meaning::Of(joint, quantity) => series[joint][quantity as usize] = Some(column),
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
