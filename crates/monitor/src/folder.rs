//! What the session folder says about itself: the names of its files and `session.json`. The shell writes them.

use serde::Serialize;
use sha2::{Digest, Sha256};
use spandrel_mavlink::telemetry::timeline::LinkCounts;

/// Every MAVLink frame as it came.
pub const TELEMETRY: &str = "telemetry.tlog";
/// Scenario as resolved.
pub const SCENARIO: &str = "scenario.toml";
/// Vehicle as resolved.
pub const VEHICLE: &str = "vehicle.toml";
/// Who, when, versions, hashes.
pub const SESSION: &str = "session.json";
/// What happened, one JSON object per line.
pub const EVENTS: &str = "events.jsonl";
/// The event in it that says that the simulator has begun anew.
pub const SIMULATOR_RESTARTED: &str = "simulator_restarted";
/// Scores.
pub const ASSESSMENT: &str = "assessment.json";
/// The page for people.
pub const REPORT: &str = "report.html";
/// Folder of the photographs.
pub const SNAPSHOTS: &str = "snapshots";
/// Folder in it: their copies for the report, of the same names.
pub const SMALL: &str = "small";

/// `session.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SessionInfo {
    /// Who flew.
    pub trainee: String,
    /// Wall time of simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// The same for people, UTC, RFC 3339.
    pub started_utc: String,
    /// Version of this program.
    pub spandrel_version: String,
    /// Scenario name.
    pub scenario: String,
    /// Its `scn_crc`, hexadecimal.
    pub scenario_crc: String,
    /// SHA-256 of `scenario.toml`, hexadecimal.
    pub scenario_sha256: String,
    /// Vehicle id.
    pub vehicle: String,
    /// SHA-256 of `vehicle.toml`, hexadecimal.
    pub vehicle_sha256: String,
    /// Seed, once heard.
    pub seed: Option<u64>,
    /// Practice or assessment, where somebody chose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub purpose: Option<String>,
    /// Times that the monitor was started on this folder.
    pub monitor_starts: u32,
    /// The link, as far as this monitor saw it.
    pub link: LinkCounts,
    /// Bytes that were no MAVLink.
    pub bad_bytes: u64,
}

/// SHA-256 in hexadecimal.
#[must_use]
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
