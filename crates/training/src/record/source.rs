//! Inputs to a session record.

use crate::questionnaire::Answers;
use spandrel_model::scenario::{PlacedDefect, Scenario};
use spandrel_monitor::AssessedSession;
use spandrel_monitor::folder::sha256_hex;
use spandrel_monitor::score::SCORER_VERSION;

/// Record format version. It is incremented when fields are added so that older records are recreated.
pub const FORMAT_VERSION: u32 = 10;

/// Inputs used to create a record.
#[derive(Debug, Clone, Copy)]
pub struct RecordSource<'a> {
    /// Session folder name.
    pub id: &'a str,
    /// Trainee's pseudonym.
    pub trainee: &'a str,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    pub purpose: Option<&'a str>,
    /// Wall-clock time at simulation time zero, µs since the Unix epoch.
    pub started_unix_us: u64,
    /// Spandrel version that recorded the session.
    pub spandrel_version: &'a str,
    /// The session's scenario.
    pub scenario: &'a Scenario,
    /// Vehicle ID, such as `phantom2`.
    pub vehicle: &'a str,
    /// Source file hashes.
    pub hashes: &'a SourceHashes,
    /// The session's assessment and frames.
    pub assessed_session: &'a AssessedSession,
    /// Defects placed according to the session's seed.
    pub placed: &'a [PlacedDefect],
    /// Questionnaire answers; `None` if the questionnaire was not started.
    pub answers: Option<&'a Answers>,
}

/// SHA-256 hashes of a session's source files, hexadecimal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceHashes {
    /// Hash of `scenario.toml`.
    pub scenario: String,
    /// Hash of `vehicle.toml`.
    pub vehicle: String,
    /// Hash of `telemetry.tlog`.
    pub telemetry: String,
    /// Hash of `answers.json`, or of an empty file if there is none.
    pub answers: String,
}

impl SourceHashes {
    /// Computes the hashes of the file contents.
    #[must_use]
    pub fn of(scenario: &[u8], vehicle: &[u8], telemetry: &[u8], answers: &[u8]) -> Self {
        let hex = sha256_hex;
        Self { scenario: hex(scenario), vehicle: hex(vehicle), telemetry: hex(telemetry), answers: hex(answers) }
    }

    /// Returns a single hash over all files, the scorer version and the record format. A record is up to date as long
    /// as this hash is unchanged.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        let Self { scenario, vehicle, telemetry, answers } = self;
        sha256_hex(format!("{FORMAT_VERSION} {SCORER_VERSION} {scenario} {vehicle} {telemetry} {answers}").as_bytes())
    }
}
