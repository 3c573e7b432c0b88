//! Writes frames as Parquet for notebooks and databases. The columns match those of the CSV export, but are typed; each
//! field's metadata contains its unit, frame and definition.

mod arrow_schema;

use crate::errors::AppError;
use arrow_schema::{Field, FieldType};
use base64::Engine;
use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use spandrel_monitor::export::columns::ColumnReader;
use spandrel_monitor::export::{COLUMNS, Column, FrameRow};
use std::sync::Arc;

/// Metadata key under which Arrow-based readers look for field types and metadata.
const ARROW_SCHEMA: &str = "ARROW:schema";

/// Returns the frames as a Parquet file.
///
/// # Errors
/// Not expected in practice, because the file is written to memory.
pub fn frames_to_parquet(rows: &[FrameRow]) -> Result<Vec<u8>, AppError> {
    write(rows).map_err(|error| AppError::failed(format!("cannot create the Parquet file: {error}")))
}

fn write(rows: &[FrameRow]) -> Result<Vec<u8>, ParquetError> {
    let schema = Arc::new(parse_message_type(&message_type())?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_key_value_metadata(Some(vec![KeyValue::new(ARROW_SCHEMA.to_owned(), arrow_metadata())]))
        .set_created_by(concat!("spandrel ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties.build()))?;
    let mut group = file.next_row_group()?;
    for column in COLUMNS {
        write_column(&mut group, column, rows)?;
    }
    group.close()?;
    file.into_inner()
}

/// Returns the schema in Parquet's notation.
fn message_type() -> String {
    let line = |column: &Column| {
        let (kind, annotation) = match column.read {
            ColumnReader::Integer(_) => ("int64", ""),
            ColumnReader::Float(_) => ("double", ""),
            ColumnReader::Boolean(_) => ("boolean", ""),
            ColumnReader::Text(_) => ("binary", " (utf8)"),
        };
        let repetition = if column.optional { "optional" } else { "required" };
        format!("{repetition} {kind} {}{annotation};", column.name)
    };
    format!("message frames {{ {} }}", COLUMNS.iter().map(line).collect::<Vec<_>>().join(" "))
}

/// Returns the same schema in Arrow's format, with units, frames and definitions.
fn arrow_metadata() -> String {
    let field = |column: &Column| Field {
        name: column.name,
        nullable: column.optional,
        kind: match column.read {
            ColumnReader::Integer(_) => FieldType::Int64,
            ColumnReader::Float(_) => FieldType::Double,
            ColumnReader::Boolean(_) => FieldType::Bool,
            ColumnReader::Text(_) => FieldType::Utf8,
        },
        metadata: [("unit", column.unit), ("frame", column.frame), ("description", column.description)]
            .into_iter()
            .filter(|(_, text)| !text.is_empty())
            .collect(),
    };
    let message = arrow_schema::message(&COLUMNS.iter().map(field).collect::<Vec<_>>());
    base64::engine::general_purpose::STANDARD.encode(message)
}

type Group<'a> = SerializedRowGroupWriter<'a, Vec<u8>>;

fn write_column(group: &mut Group<'_>, column: &Column, rows: &[FrameRow]) -> Result<(), ParquetError> {
    match column.read {
        ColumnReader::Integer(value) => write_next_column::<Int64Type>(group, column, rows.iter().map(value)),
        ColumnReader::Float(value) => write_next_column::<DoubleType>(group, column, rows.iter().map(value)),
        ColumnReader::Boolean(value) => write_next_column::<BoolType>(group, column, rows.iter().map(|row| Some(value(row)))),
        ColumnReader::Text(value) => {
            write_next_column::<ByteArrayType>(group, column, rows.iter().map(|row| Some(ByteArray::from(value(row)))))
        }
    }
}

/// Writes the next column. Definition level 1 marks a value, 0 a null.
fn write_next_column<T: DataType>(
    group: &mut Group<'_>,
    column: &Column,
    values: impl Iterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let cells: Vec<Option<T::T>> = values.collect();
    let levels: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
    let known: Vec<T::T> = cells.into_iter().flatten().collect();
    if !column.optional && known.len() != levels.len() {
        return Err(ParquetError::General(format!("the column {} must not be empty", column.name)));
    }
    let mut writer = group.next_column()?.ok_or_else(|| ParquetError::General("more columns than the schema has".into()))?;
    writer.typed::<T>().write_batch(&known, column.optional.then_some(&levels), None)?;
    writer.close()
}
