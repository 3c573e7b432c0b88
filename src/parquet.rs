//! Frames as Parquet, for notebooks and databases: the columns of the CSV export, typed.

use super::errors::AppError;
use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use spandrel_mavlink::telemetry::Frame;
use std::sync::Arc;

/// The columns, in the order of [`spandrel_monitor::export::FRAME_COLUMNS`].
const SCHEMA: &str = "message frames {
    required int64 frame; required double t_s;
    required double fb; required double rl; required double ud; required double rt;
    required boolean light; required boolean snapshot;
    required double east_m; required double north_m; required double up_m;
    required double speed_m_s; required double battery_pct;
    required binary contact (utf8); required boolean missing;
}";

/// The file; `t_s` counts from lift-off.
///
/// # Errors
/// Never in practice: it is written to memory.
pub fn frames(frames: &[Frame]) -> Result<Vec<u8>, AppError> {
    write(frames).map_err(|error| AppError::failed(format!("the Parquet file cannot be made: {error}")))
}

fn write(frames: &[Frame]) -> Result<Vec<u8>, ParquetError> {
    let schema = Arc::new(parse_message_type(SCHEMA)?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_created_by(concat!("spandrel ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties.build()))?;
    let mut group = file.next_row_group()?;
    let first = frames.first().map(|frame| frame.time);
    let since = |frame: &Frame| first.map_or(0.0, |first| (frame.time - first).ns() as f64 / 1e9);
    whole(&mut group, frames, |frame| i64::from(frame.index))?;
    real(&mut group, frames, since)?;
    for k in 0..4 {
        real(&mut group, frames, |frame| frame.sticks[k])?;
    }
    truth(&mut group, frames, |frame| frame.light)?;
    truth(&mut group, frames, |frame| frame.snapshot)?;
    for k in 0..3 {
        real(&mut group, frames, |frame| frame.position_m.array()[k])?;
    }
    real(&mut group, frames, Frame::speed_m_s)?;
    real(&mut group, frames, |frame| frame.battery_pct)?;
    let words: Vec<ByteArray> = frames.iter().map(|frame| ByteArray::from(frame.contact.word())).collect();
    next::<ByteArrayType>(&mut group, &words)?;
    truth(&mut group, frames, |frame| frame.missing)?;
    group.close()?;
    file.into_inner()
}

fn whole(group: &mut Group<'_>, frames: &[Frame], value: impl Fn(&Frame) -> i64) -> Result<(), ParquetError> {
    next::<Int64Type>(group, &frames.iter().map(value).collect::<Vec<_>>())
}

fn real(group: &mut Group<'_>, frames: &[Frame], value: impl Fn(&Frame) -> f64) -> Result<(), ParquetError> {
    next::<DoubleType>(group, &frames.iter().map(value).collect::<Vec<_>>())
}

fn truth(group: &mut Group<'_>, frames: &[Frame], value: impl Fn(&Frame) -> bool) -> Result<(), ParquetError> {
    next::<BoolType>(group, &frames.iter().map(value).collect::<Vec<_>>())
}

type Group<'a> = SerializedRowGroupWriter<'a, Vec<u8>>;

/// Writes the next column.
fn next<T: parquet::data_type::DataType>(group: &mut Group<'_>, values: &[T::T]) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.ok_or_else(|| ParquetError::General("more columns than the schema has".into()))?;
    column.typed::<T>().write_batch(values, None, None)?;
    column.close()
}
