//! Record of the external autopilot that flew: its version, Git hash and parameters.

use super::config::AutopilotKind;
use crate::errors::AppError;
use crate::io::replace::replace;
use serde_json::{Map, Value, json};
use spandrel_mavlink::dialect::MavParamType;
use spandrel_sitl::backend::launch::LaunchParam;
use spandrel_sitl::endpoint::relay::{AutopilotReport, ReportedParam};
use std::path::Path;

/// File in the autopilot's working directory.
const RECORD_FILE: &str = "autopilot.json";

/// Returns the record as JSON.
pub fn text(kind: AutopilotKind, report: &AutopilotReport, set_at_start: &[LaunchParam]) -> String {
    let version = report.version.map(|version| {
        json!({
            "number": version.number_text(),
            "release_type": version.release_type,
            "git_hash": version.hash_text(),
        })
    });
    let value = |param: &ReportedParam| match kind {
        AutopilotKind::ArduPilot => json!(param.wire),
        AutopilotKind::Px4 if param.kind == MavParamType::MAV_PARAM_TYPE_REAL32 => json!(param.wire),
        // PX4 sends the bits of an integer in the float field.
        AutopilotKind::Px4 => json!(param.wire.to_bits().cast_signed()),
    };
    let parameters: Map<String, Value> = report.parameters.iter().map(|(name, param)| (name.clone(), value(param))).collect();
    let set: Map<String, Value> = set_at_start.iter().map(|param| (param.name.clone(), json!(param.value))).collect();
    let record = json!({
        "autopilot": kind.name(),
        "version": version,
        "reproducible": false,
        "parameters_set_at_start": set,
        "parameters": parameters,
    });
    serde_json::to_string_pretty(&record).unwrap_or_default() + "\n"
}

/// Writes the record.
///
/// # Errors
/// Returns an error that names the file.
pub fn write(folder: &Path, text: &str) -> Result<(), AppError> {
    replace(&folder.join(RECORD_FILE), text.as_bytes())
}
