//! File names in a session folder, and the contents of `session.json`. The application writes the files.

use serde::Serialize;
use sha2::{Digest, Sha256};
use spandrel_mavlink::telemetry::timeline::LinkCounts;

/// Telemetry log with all MAVLink frames as received.
pub const TELEMETRY: &str = "telemetry.tlog";
/// Scenario file with all included files resolved.
pub const SCENARIO: &str = "scenario.toml";
/// Vehicle file with all included files resolved.
pub const VEHICLE: &str = "vehicle.toml";
/// Session metadata: trainee, time, versions, hashes.
pub const SESSION: &str = "session.json";
/// Event log with one JSON object per line.
pub const EVENTS: &str = "events.jsonl";
/// Event logged when the simulator restarts.
pub const SIMULATOR_RESTARTED: &str = "simulator_restarted";
/// Session scores and measures.
pub const ASSESSMENT: &str = "assessment.json";
/// Things to do better, and the scenario to fly next. Written with the report.
pub const ADVICE: &str = "advice.json";
/// Report page.
pub const REPORT: &str = "report.html";
/// Folder that contains the pictures.
pub const SNAPSHOTS: &str = "snapshots";
/// Subfolder with downsized copies of the pictures for the report. The file names are the same.
pub const SMALL_SNAPSHOTS: &str = "small";
/// Video of the camera's view (MP4), from lift-off.
pub const VIDEO: &str = "video.mp4";

/// Contents of `session.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SessionInfo {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Wall-clock time at simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Start time in UTC, RFC 3339.
    pub started_utc: String,
    /// Spandrel version that recorded the session.
    pub spandrel_version: String,
    /// Machine-readable scenario name, such as `two-bridges`.
    pub scenario: String,
    /// Selected form of the scenario; `None` if the scenario has no forms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<String>,
    /// Selected difficulty level of the scenario; `None` if the scenario has no levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u8>,
    /// The scenario's `scn_crc`, hexadecimal.
    pub scenario_crc: String,
    /// SHA-256 of `scenario.toml`, hexadecimal.
    pub scenario_sha256: String,
    /// Vehicle ID, such as `phantom2`.
    pub vehicle: String,
    /// SHA-256 of `vehicle.toml`, hexadecimal.
    pub vehicle_sha256: String,
    /// The session's seed; `None` until received.
    pub seed: Option<u64>,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub purpose: Option<String>,
    /// Wall-clock time at which the trainee acknowledged the site check of the briefing, µs since the Unix epoch; `None` if
    /// no briefing was shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub site_check_unix_us: Option<u64>,
    /// Number of times that the monitor was started for this folder.
    pub monitor_starts: u32,
    /// Link statistics since the monitor was last started.
    pub link: LinkCounts,
    /// Number of received bytes that are not valid MAVLink.
    pub bad_bytes: u64,
}

/// Returns the SHA-256 of `bytes` in hexadecimal.
#[must_use]
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
