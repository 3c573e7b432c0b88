//! Writes tables as Parquet for notebooks and databases: the frames of a flight, with the same columns as the CSV export but
//! typed, and the flights of a study. Each field's metadata contains its unit, frame and definition.

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

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TableColumn<'a> {
    /// Column name.
    pub name: &'a str,
    /// Unit; empty if there is none.
    pub unit: &'a str,
    /// Reference frame; empty if there is none.
    pub frame: &'a str,
    /// Definition of the values.
    pub description: &'a str,
    /// True if values may be missing.
    pub optional: bool,
    /// Values of all rows.
    pub values: TypedValues,
}

/// Values of a column; `None` for a missing value.
#[derive(Debug, Clone, PartialEq)]
pub enum TypedValues {
    /// Signed 64-bit integers.
    Integer(Vec<Option<i64>>),
    /// 64-bit floats.
    Float(Vec<Option<f64>>),
    /// Truth values.
    Boolean(Vec<Option<bool>>),
    /// UTF-8 text.
    Text(Vec<Option<String>>),
}

/// Returns the frames as a Parquet file.
///
/// # Errors
/// Not expected in practice, because the file is written to memory.
pub fn frames_to_parquet(rows: &[FrameRow]) -> Result<Vec<u8>, AppError> {
    table_to_parquet("frames", &COLUMNS.iter().map(|column| frame_column(column, rows)).collect::<Vec<_>>())
}

fn frame_column<'a>(column: &'a Column, rows: &[FrameRow]) -> TableColumn<'a> {
    let values = match column.read {
        ColumnReader::Integer(value) => TypedValues::Integer(rows.iter().map(value).collect()),
        ColumnReader::Float(value) => TypedValues::Float(rows.iter().map(value).collect()),
        ColumnReader::Boolean(value) => TypedValues::Boolean(rows.iter().map(|row| Some(value(row))).collect()),
        ColumnReader::Text(value) => TypedValues::Text(rows.iter().map(|row| Some(value(row).to_owned())).collect()),
    };
    let Column { name, unit, frame, description, optional, .. } = column;
    TableColumn { name, unit, frame, description, optional: *optional, values }
}

/// Returns a table as a Parquet file. The same table always gives the same bytes.
///
/// # Errors
/// Returns an error if a column that is not optional has a missing value, or if the columns differ in length.
pub fn table_to_parquet(name: &str, columns: &[TableColumn<'_>]) -> Result<Vec<u8>, AppError> {
    write(name, columns).map_err(|error| AppError::failed(format!("cannot create the Parquet file: {error}")))
}

fn write(name: &str, columns: &[TableColumn<'_>]) -> Result<Vec<u8>, ParquetError> {
    let schema = Arc::new(parse_message_type(&message_type(name, columns))?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_key_value_metadata(Some(vec![KeyValue::new(ARROW_SCHEMA.to_owned(), arrow_metadata(columns))]))
        .set_created_by(concat!("spandrel ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties.build()))?;
    let mut group = file.next_row_group()?;
    for column in columns {
        write_column(&mut group, column)?;
    }
    group.close()?;
    file.into_inner()
}

/// Returns the schema in Parquet's notation.
fn message_type(name: &str, columns: &[TableColumn<'_>]) -> String {
    let line = |column: &TableColumn<'_>| {
        let (kind, annotation) = match column.values {
            TypedValues::Integer(_) => ("int64", ""),
            TypedValues::Float(_) => ("double", ""),
            TypedValues::Boolean(_) => ("boolean", ""),
            TypedValues::Text(_) => ("binary", " (utf8)"),
        };
        let repetition = if column.optional { "optional" } else { "required" };
        format!("{repetition} {kind} {}{annotation};", column.name)
    };
    format!("message {name} {{ {} }}", columns.iter().map(line).collect::<Vec<_>>().join(" "))
}

/// Returns the same schema in Arrow's format, with units, frames and definitions.
fn arrow_metadata(columns: &[TableColumn<'_>]) -> String {
    let fields: Vec<Field<'_>> = columns
        .iter()
        .map(|column| Field {
            name: column.name,
            nullable: column.optional,
            kind: match column.values {
                TypedValues::Integer(_) => FieldType::Int64,
                TypedValues::Float(_) => FieldType::Double,
                TypedValues::Boolean(_) => FieldType::Bool,
                TypedValues::Text(_) => FieldType::Utf8,
            },
            metadata: [("unit", column.unit), ("frame", column.frame), ("description", column.description)]
                .into_iter()
                .filter(|(_, text)| !text.is_empty())
                .collect(),
        })
        .collect();
    base64::engine::general_purpose::STANDARD.encode(arrow_schema::message(&fields))
}

type Group<'a> = SerializedRowGroupWriter<'a, Vec<u8>>;

fn write_column(group: &mut Group<'_>, column: &TableColumn<'_>) -> Result<(), ParquetError> {
    match &column.values {
        TypedValues::Integer(values) => write_next_column::<Int64Type>(group, column, values.iter().copied()),
        TypedValues::Float(values) => write_next_column::<DoubleType>(group, column, values.iter().copied()),
        TypedValues::Boolean(values) => write_next_column::<BoolType>(group, column, values.iter().copied()),
        TypedValues::Text(values) => {
            let texts = values.iter().map(|text| text.as_ref().map(|text| ByteArray::from(text.as_str())));
            write_next_column::<ByteArrayType>(group, column, texts)
        }
    }
}

/// Writes the next column. Definition level 1 marks a value, 0 a null.
fn write_next_column<T: DataType>(
    group: &mut Group<'_>,
    column: &TableColumn<'_>,
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
