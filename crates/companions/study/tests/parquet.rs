//! Tests that Parquet tables contain the same values as the rows.

use cplan_robot::RobotFile;
use cplan_solver::Options;
use cplan_study::{Ending, Row, Study};
use cplan_world::Overrides;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::io::Write;
use std::path::Path;

/// Returns a shipped study with two parameters and four measures.
fn study() -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../workspaces/studies/base.toml");
    Study::load(path, &|_| Ok((Options::default(), Overrides::default())), &RobotFile::from).unwrap()
}

/// Returns rows with each ending in turn.
fn row(layout: usize) -> Row {
    let ending = Ending::ALL[layout % Ending::ALL.len()];
    let is_found = ending == Ending::Found;
    let x = layout as f64 / 3.0;
    let measured = [Some(x), Some(-x), None, Some(0.1)].map(|value| value.filter(|_| is_found));
    Row {
        layout,
        values: vec![x, -x],
        ending,
        reason: (!is_found).then(|| format!("layout {layout}: \"crate\", as in the world, is in the way")),
        measured: measured.to_vec(),
        fits: is_found && layout.is_multiple_of(8),
    }
}

#[test]
fn a_file_has_the_columns_and_cells_of_the_rows() {
    let study = study();
    // More than one group of rows.
    let rows: Vec<Row> = (0..70_000).map(row).collect();
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(&study.parquet(&rows).unwrap()).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    assert_eq!(reader.num_row_groups(), 2);
    let optional = |value: &Option<f64>| value.map_or(Field::Null, Field::Double);
    let mut count = 0;
    for (read, row) in reader.get_row_iter(None).unwrap().zip(&rows) {
        let read = read.unwrap();
        let (names, cells): (Vec<&String>, Vec<&Field>) = read.get_column_iter().unzip();
        assert_eq!(names, study.columns().iter().collect::<Vec<_>>());
        let mut expected = vec![Field::Long(row.layout as i64)];
        expected.extend(row.values.iter().copied().map(Field::Double));
        expected.push(Field::Str(row.ending.name().to_owned()));
        expected.push(row.reason.clone().map_or(Field::Null, Field::Str));
        expected.extend(row.measured.iter().map(optional));
        expected.push(Field::Bool(row.fits));
        assert_eq!(cells, expected.iter().collect::<Vec<_>>());
        count += 1;
    }
    assert_eq!(count, rows.len());
}

#[test]
fn the_same_rows_make_the_same_bytes() {
    let (study, rows) = (study(), (0..100).map(row).collect::<Vec<_>>());
    assert_eq!(study.parquet(&rows).unwrap(), study.parquet(&rows).unwrap());
}
