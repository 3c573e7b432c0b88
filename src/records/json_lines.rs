//! Reads and writes records as JSON lines, for exchange between databases.

use crate::errors::AppError;
use crate::io::files;
use spandrel_training::record::SessionRecord;
use std::path::Path;

/// Returns the records as JSON lines.
///
/// # Errors
/// Returns an error if a record cannot be serialized as JSON (not expected in practice).
pub fn lines(records: &[SessionRecord]) -> Result<String, AppError> {
    let line = |record: &SessionRecord| serde_json::to_string(record).map(|text| text + "\n");
    records.iter().map(line).collect::<Result<String, _>>().map_err(|error| AppError::failed(error.to_string()))
}

/// Reads records from a JSON lines file, as written by `records export`.
///
/// # Errors
/// Returns an error if the file cannot be read or a line is not a valid record.
pub fn read_json_lines(path: &Path) -> Result<Vec<SessionRecord>, AppError> {
    let text = files::read(path)?;
    let numbered = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let read = |(k, line): (usize, &str)| {
        let wrong = |message: String| AppError::invalid(format!("{}:{}: {message}", path.display(), k + 1));
        let record: SessionRecord = serde_json::from_str(line).map_err(|error| wrong(format!("not a valid record: {error}")))?;
        record.check().map_err(wrong)?;
        Ok(record)
    };
    numbered.map(read).collect()
}
