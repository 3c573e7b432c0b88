//! `spandrel records push`: sends sessions as xAPI statements to a learning record store. Each statement's ID is
//! derived from its contents, so statements that the store already has are not sent again.

use super::location::RecordsLocation;
use crate::errors::AppError;
use crate::io::progress::ProgressLog;
use crate::io::replace::replace;
use serde_json::Value;
use spandrel_training::record::SessionRecord;
use spandrel_training::xapi;
use std::path::Path;
use std::time::Duration;

/// Name of the file in a session folder that contains the session's statements.
pub const STATEMENTS_FILE: &str = "xapi.jsonl";
/// Maximum number of statements per request.
const BATCH_SIZE: usize = 50;
/// Delays before retries if the store does not respond or is temporarily unavailable.
const RETRY_DELAYS: [Duration; 5] = [
    Duration::from_millis(200),
    Duration::from_secs(1),
    Duration::from_secs(3),
    Duration::from_secs(10),
    Duration::from_secs(30),
];
/// Timeout for a request.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(60);
/// Environment variables for the user name and password, which must not appear in process lists.
const USER_VARIABLE: &str = "SPANDREL_LRS_USER";
const PASSWORD_VARIABLE: &str = "SPANDREL_LRS_PASSWORD";

/// Numbers of statements by the store's response.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PushCounts {
    /// Statements that were new to the store.
    pub sent: usize,
    /// Statements that the store already had.
    pub already_stored_count: usize,
}

/// Checks an endpoint's URL and removes trailing slashes.
///
/// # Errors
/// Returns an error if it has a different scheme, no host, or a user, query or fragment.
pub fn endpoint(text: &str) -> Result<String, String> {
    let rest = text.strip_prefix("https://").or_else(|| text.strip_prefix("http://")).unwrap_or_default();
    if rest.is_empty() || rest.starts_with('/') || text.contains(['?', '#', ' ', '@']) {
        return Err(format!(
            "'{text}' is not an xAPI endpoint (allowed: http:// or https://, host, path; no user, query or fragment)"
        ));
    }
    Ok(text.trim_end_matches('/').to_owned())
}

/// Sends these sessions in the given order.
///
/// # Errors
/// Returns an error if the store rejects statements or cannot be reached. Statements accepted before the error stay in
/// the store.
pub fn push(
    records_location: &RecordsLocation,
    records: &[SessionRecord],
    url: &str,
    home: &str,
) -> Result<PushCounts, AppError> {
    let store = LearningRecordStore::new(url)?;
    let mut progress = ProgressLog::start("sending statements");
    let mut all = PushCounts::default();
    for (k, record) in records.iter().enumerate() {
        progress.report(|| format!("session {} of {}", k + 1, records.len()));
        let statements = xapi::statements(record, home);
        save_statements(records_location, record, &statements)?;
        for parcel in statements.chunks(BATCH_SIZE) {
            let done = store.send_batch(parcel)?;
            all = PushCounts {
                sent: all.sent + done.sent,
                already_stored_count: all.already_stored_count + done.already_stored_count,
            };
        }
    }
    progress.finish();
    Ok(all)
}

/// Writes the statements to the session folder, if it is on this machine.
fn save_statements(records_location: &RecordsLocation, record: &SessionRecord, statements: &[Value]) -> Result<(), AppError> {
    let here = |folder: &Path| crate::io::session_folder::is_session(&folder.join(&record.id));
    match records_location.sessions.iter().find(|folder| here(folder)) {
        Some(folder) => replace(&folder.join(&record.id).join(STATEMENTS_FILE), xapi::lines(statements).as_bytes()),
        None => Ok(()),
    }
}

/// A learning record store.
struct LearningRecordStore {
    agent: ureq::Agent,
    url: String,
    authorization: Option<String>,
}

impl LearningRecordStore {
    fn new(url: &str) -> Result<Self, AppError> {
        let config = ureq::Agent::config_builder()
            .http_status_as_error(false)
            .timeout_global(Some(REQUEST_TIMEOUT))
            .max_redirects(0)
            .build();
        let authorization = match (std::env::var(USER_VARIABLE), std::env::var(PASSWORD_VARIABLE)) {
            (Ok(user), Ok(password)) => {
                Some(format!("Basic {}", spandrel_training::report::assets::base64(format!("{user}:{password}").as_bytes())))
            }
            (Err(_), Err(_)) => None,
            (Ok(_), Err(_)) | (Err(_), Ok(_)) => {
                return Err(AppError::invalid(format!("{USER_VARIABLE} and {PASSWORD_VARIABLE} must be set together")));
            }
        };
        Ok(Self { agent: config.into(), url: url.to_owned(), authorization })
    }

    /// Sends statements. On a conflict (at least one already exists), sends each one separately.
    fn send_batch(&self, statements: &[Value]) -> Result<PushCounts, AppError> {
        match self.send(statements)? {
            StoreResponse::Accepted => Ok(PushCounts { sent: statements.len(), already_stored_count: 0 }),
            StoreResponse::Conflict if statements.len() == 1 => Ok(PushCounts { sent: 0, already_stored_count: 1 }),
            StoreResponse::Conflict => statements.iter().try_fold(PushCounts::default(), |sum, one| {
                let done = self.send_batch(std::slice::from_ref(one))?;
                Ok(PushCounts {
                    sent: sum.sent + done.sent,
                    already_stored_count: sum.already_stored_count + done.already_stored_count,
                })
            }),
        }
    }

    fn send(&self, statements: &[Value]) -> Result<StoreResponse, AppError> {
        let address = format!("{}/statements", self.url);
        let body = Value::from(statements.to_vec()).to_string();
        let mut waits = RETRY_DELAYS.iter();
        loop {
            let why = match self.send_once(&address, &body) {
                Ok(PushOutcome::Done(sent)) => return Ok(sent),
                Ok(PushOutcome::Rejected(words)) => return Err(AppError::failed(format!("{address}: {words}"))),
                Ok(PushOutcome::Retry(words)) | Err(words) => words,
            };
            let Some(wait) = waits.next() else {
                return Err(AppError::failed(format!("{address}: {why}, after {} attempts", RETRY_DELAYS.len() + 1)));
            };
            tracing::info!("{address}: {why}; retrying in {:.1} s", wait.as_secs_f64());
            std::thread::sleep(*wait);
        }
    }

    /// Sends one request. Connection errors can be retried.
    fn send_once(&self, address: &str, body: &str) -> Result<PushOutcome, String> {
        let mut request =
            self.agent.post(address).header("Content-Type", "application/json").header("X-Experience-API-Version", xapi::VERSION);
        if let Some(authorization) = &self.authorization {
            request = request.header("Authorization", authorization);
        }
        let mut answer = request.send(body).map_err(|error| error.to_string())?;
        let status = answer.status().as_u16();
        let mut words = || {
            let text = answer.body_mut().with_config().limit(4_096).read_to_string().unwrap_or_default();
            let short: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(200).collect();
            format!("status {status} {short}")
        };
        Ok(match status {
            200..=299 => PushOutcome::Done(StoreResponse::Accepted),
            409 => PushOutcome::Done(StoreResponse::Conflict),
            408 | 425 | 429 | 500..=599 => PushOutcome::Retry(words()),
            _ => PushOutcome::Rejected(words()),
        })
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StoreResponse {
    Accepted,
    Conflict,
}

enum PushOutcome {
    Done(StoreResponse),
    Retry(String),
    Rejected(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_endpoint_urls_are_validated() {
        assert_eq!(endpoint("https://lrs.example/xapi/"), Ok("https://lrs.example/xapi".into()));
        for bad in ["lrs.example", "ftp://x", "https://", "https:///x", "https://user:secret@x/", "https://x/?a", "https://x/#a"]
        {
            assert!(endpoint(bad).is_err(), "{bad}");
        }
    }
}
