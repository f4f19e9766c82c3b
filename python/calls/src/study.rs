//! Studies: one task in many layouts.

use crate::error::Refusal;
use crate::problem::{Arm, World};
use cplan::input::{Overrides, Source};
use cplan::study::{Row, Study};
use serde::Serialize;
use std::path::PathBuf;

fn words(words: &[String]) -> Result<(cplan::Options, Overrides), String> {
    cplan::cli::read_words(words)
}

/// Reads a study file, and the robot and world that it names.
///
/// # Errors
/// The defects of the files.
pub fn read_study(path: PathBuf) -> Result<Study, Refusal> {
    Ok(Study::load(path, &words, &cplan::input::robot)?)
}

/// Creates a study from its texts: a JSON array of the study, the robot and the world.
///
/// # Errors
/// The defects of the texts.
pub fn study_of_sources(sources: &str) -> Result<Study, Refusal> {
    Ok(Study::from_sources(serde_json::from_str(sources).map_err(Refusal::value)?, &words)?)
}

/// Returns the texts of a study with this text, a robot that was read from a URDF, and a world, as JSON.
///
/// # Errors
/// An arm that is made in code.
pub fn study_sources(text: String, arm: &Arm, world: &World) -> Result<String, Refusal> {
    let made = || Refusal::value("a study needs a robot in URDF, but this arm was made in code");
    let sources = (Source::in_memory("study.toml", text), arm.source().ok_or_else(made)?, world.source());
    serde_json::to_string(&sources).map_err(Refusal::value)
}

/// Returns the values of a layout, in the order of the parameters.
///
/// # Errors
/// A number that no layout has.
pub fn layout_values(study: &Study, layout: usize) -> Result<Vec<f64>, Refusal> {
    if layout >= study.count() {
        return Err(Refusal::value(format!("the study has {} layouts, numbered from 0", study.count())));
    }
    Ok(study.values(layout))
}

/// Returns robot and world with the values of a row.
///
/// # Errors
/// Another number of values than of parameters.
pub fn layout(study: &Study, values: &[f64]) -> Result<(Arm, World), Refusal> {
    if values.len() != study.parameters.len() {
        return Err(Refusal::value(format!("expected {} values", study.parameters.len())));
    }
    let [world, urdf] = study.layout(values);
    Ok((Arm::Urdf(urdf), World::of(world)))
}

/// Returns the names of a study's parameters.
pub fn parameter_names(study: &Study) -> Vec<String> {
    study.parameters.iter().map(|parameter| parameter.name.clone()).collect()
}

/// Returns the text that Python prints for a study.
pub fn study_description(study: &Study) -> String {
    let names = parameter_names(study).join(", ");
    format!("<cplan.Study \"{}\": {} layouts over {names}>", study.name, study.count())
}

/// The values of a column of a table.
#[derive(Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Column {
    /// Whole numbers.
    Counts(Vec<i64>),
    /// Numbers; `None` if missing.
    Numbers(Vec<Option<f64>>),
    /// Flags.
    Flags(Vec<bool>),
    /// Words; `None` if missing.
    Words(Vec<Option<String>>),
}

/// A table of rows: its columns by name, in order.
pub type Table = Vec<(String, Column)>;

/// Returns the table of rows of a study.
pub fn table(study: &Study, rows: &[Row]) -> Table {
    let parameters = study.parameters.iter().enumerate();
    let measures = study.measures.iter().enumerate();
    let mut columns = vec![("layout".to_owned(), Column::Counts(rows.iter().map(|row| row.layout as i64).collect()))];
    columns.extend(parameters.map(|(k, parameter)| {
        (parameter.name.clone(), Column::Numbers(rows.iter().map(|row| Some(row.values[k])).collect()))
    }));
    let outcomes = rows.iter().map(|row| Some(row.ending.name().to_owned())).collect();
    columns.push(("outcome".to_owned(), Column::Words(outcomes)));
    columns.push(("reason".to_owned(), Column::Words(rows.iter().map(|row| row.reason.clone()).collect())));
    columns.extend(measures.map(|(k, measure)| {
        (measure.name().to_owned(), Column::Numbers(rows.iter().map(|row| row.measured[k]).collect()))
    }));
    columns.push(("fits".to_owned(), Column::Flags(rows.iter().map(|row| row.fits).collect())));
    columns
}
