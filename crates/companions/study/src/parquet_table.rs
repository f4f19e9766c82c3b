//! The rows of a study as a Parquet file (feature `parquet`).

use super::Study;
use super::row::Row;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::sync::Arc;

/// Number of rows per row group, the unit that readers load at once.
const ROWS_PER_GROUP: usize = 1 << 16;

/// A column of the table.
enum Cells {
    Counts(Vec<i64>),
    Flags(Vec<bool>),
    Numbers(Vec<Option<f64>>),
    Words(Vec<Option<String>>),
}

impl Cells {
    fn logical(&self) -> (Physical, Repetition, Option<LogicalType>) {
        match self {
            Self::Counts(_) => (Physical::INT64, Repetition::REQUIRED, None),
            Self::Flags(_) => (Physical::BOOLEAN, Repetition::REQUIRED, None),
            Self::Numbers(_) => (Physical::DOUBLE, Repetition::OPTIONAL, None),
            Self::Words(_) => (Physical::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String)),
        }
    }
}

impl Study {
    /// Returns the table as a Parquet file. It has the columns of [`Study::csv`], as counts, flags, doubles and text.
    /// Missing values are null.
    ///
    /// # Errors
    /// Rows that the format cannot represent.
    pub fn parquet(&self, rows: &[Row]) -> Result<Vec<u8>, ParquetError> {
        let names = self.columns();
        let fields = names.iter().zip(self.cells(&[])).map(|(name, cells)| {
            let (physical, repetition, logical) = cells.logical();
            let field =
                Type::primitive_type_builder(name, physical).with_repetition(repetition).with_logical_type(logical);
            field.build().map(Arc::new)
        });
        let schema = Type::group_type_builder("study").with_fields(fields.collect::<Result<_, _>>()?).build()?;
        let properties =
            WriterProperties::builder().set_created_by(format!("cplan {}", env!("CARGO_PKG_VERSION"))).build();
        let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
        for rows in rows.chunks(ROWS_PER_GROUP) {
            let mut group = writer.next_row_group()?;
            for cells in self.cells(rows) {
                let Some(mut column) = group.next_column()? else { break };
                match cells {
                    Cells::Counts(values) => column.typed::<Int64Type>().write_batch(&values, None, None)?,
                    Cells::Flags(values) => column.typed::<BoolType>().write_batch(&values, None, None)?,
                    Cells::Numbers(values) => {
                        let (values, levels) = split_optional(values.into_iter());
                        column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?
                    }
                    Cells::Words(values) => {
                        let values = values.into_iter().map(|word| word.map(|word| ByteArray::from(word.as_str())));
                        let (values, levels) = split_optional(values);
                        column.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?
                    }
                };
                column.close()?;
            }
            group.close()?;
        }
        writer.into_inner()
    }

    /// Returns the cells of these rows, column by column.
    fn cells(&self, rows: &[Row]) -> Vec<Cells> {
        let mut cells = vec![Cells::Counts(rows.iter().map(|row| row.layout as i64).collect())];
        let numbers = |of: &dyn Fn(&Row) -> Option<f64>| Cells::Numbers(rows.iter().map(of).collect());
        cells.extend((0..self.parameters.len()).map(|k| numbers(&|row| Some(row.values[k]))));
        cells.push(Cells::Words(rows.iter().map(|row| Some(row.ending.name().to_owned())).collect()));
        cells.push(Cells::Words(rows.iter().map(|row| row.reason.clone()).collect()));
        cells.extend((0..self.measures.len()).map(|k| numbers(&|row| row.measured[k])));
        cells.push(Cells::Flags(rows.iter().map(|row| row.fits).collect()));
        cells
    }
}

/// Splits optional values into the present ones, and a flag for each value: 1 if it is present, otherwise 0.
fn split_optional<T>(values: impl Iterator<Item = Option<T>>) -> (Vec<T>, Vec<i16>) {
    let (mut there, mut levels) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        there.extend(value);
    }
    (there, levels)
}
