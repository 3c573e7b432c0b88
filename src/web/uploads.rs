//! Imports recorded flights as sessions. A recording is kept only if it can be scored.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library as scenarios;
use super::state::ServerState;
use crate::io::report;
use crate::io::scoring;
use crate::io::session_folder::SessionFolder;
use crate::io::{clock, files};
use axum::http::StatusCode;
use spandrel_mavlink::telemetry::tlog;
use spandrel_monitor::export::json_text;
use spandrel_monitor::folder::sha256_hex;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{AssessError, Monitor, MonitorConfig, SessionOutput};
use spandrel_text::text;
use spandrel_training::web::scenarios as pages;
use std::path::{Path, PathBuf};

/// Responds with the upload form.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render_form(state, request, None)
}

fn render_form(state: &ServerState, request: &WebRequest, told: Option<pages::UploadMessage<'_>>) -> HandlerResult {
    let named: Vec<_> = scenarios::all(&state.scenarios).into_iter().map(|job| job.named).collect();
    let vehicles: Vec<String> = files::vehicle_names().into_iter().map(str::to_owned).collect();
    Ok(WebResponse::page(pages::recorded(&request.visitor, &named, &vehicles, told)))
}

/// Result of an upload.
enum UploadOutcome {
    /// Folder of the imported session.
    Session(PathBuf),
    /// ID and trainee of an existing session with the same recording.
    AlreadyImported(String, String),
}

/// Imports an uploaded recording.
pub fn recording(state: &ServerState, request: &WebRequest) -> HandlerResult {
    // Only one import runs at a time, so two simultaneous uploads of the same recording create only one session.
    let _one_at_a_time = lock(&state.scoring);
    match import_recording(state, request) {
        Ok(UploadOutcome::Session(folder)) => {
            let id = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let record = crate::records::read_session(&folder, &std::collections::BTreeMap::new())?;
            state.database.put(&Vec::from_iter(record))?;
            Ok(WebResponse::redirect(&format!("/sessions/{id}")))
        }
        Ok(UploadOutcome::AlreadyImported(id, trainee)) => {
            let told = pages::UploadMessage::AlreadyImported { id: &id, trainee: &trainee };
            Ok(render_form(state, request, Some(told))?.with_status(StatusCode::CONFLICT))
        }
        Err(WebError::BadRequest(words)) => Ok(render_form(state, request, Some(pages::UploadMessage::Invalid(&words)))?
            .with_status(StatusCode::UNPROCESSABLE_ENTITY)),
        Err(other) => Err(other),
    }
}

fn import_recording(state: &ServerState, request: &WebRequest) -> Result<UploadOutcome, WebError> {
    let language = request.visitor.language;
    let trainee = request.trainee_field("trainee")?;
    let scenario = files::scenario(&scenarios::argument(&state.scenarios, language, request.required_field("scenario")?)?)?;
    let vehicle = request.required_field("vehicle")?;
    if !files::vehicle_names().contains(&vehicle) {
        return Err(WebError::BadRequest(text!(language, "web-error-unknown-name", field = "vehicle")));
    }
    let vehicle = files::vehicle(vehicle)?;
    let log = &*request.required_upload()?.file.bytes()?;
    // The telemetry is stored unmodified up to the last complete record.
    let kept = &log[..tlog::complete_len(log)];
    if let Some((id, trainee)) = state.database.find_by_telemetry(&sha256_hex(kept))? {
        return Ok(UploadOutcome::AlreadyImported(id, trainee));
    }
    // A recording that cannot be scored counts as an invalid file, no matter which error the scorer reports.
    let unfit = |error: AssessError| {
        WebError::BadRequest(text!(language, "editor-import-unfit", reason = scoring::scoring_error(&error).to_string()))
    };
    let (scenario, assessed_session) = scoring::assess_any_variant(log, scenario, &vehicle.vehicle).map_err(unfit)?;
    let started_unix_us = tlog::session_start_us(log).unwrap_or_else(clock::unix_us);
    if state.database.erased()?.contains("", trainee.as_str(), started_unix_us) {
        return Err(WebError::BadRequest(text!(language, "editor-import-erased", name = trainee.as_str())));
    }
    let first = state.default_folder();
    let aside = state.spool();
    let mut folder = SessionFolder::create(&aside, trainee.as_str(), started_unix_us, &scenario, &vehicle)?;
    let config = MonitorConfig {
        scenario: scenario.scenario.clone(),
        vehicle: vehicle.vehicle.clone(),
        trainee: trainee.as_str().to_owned(),
        purpose: None,
        started_unix_us,
        system_id: 1,
        seed: None,
        survey_builder: build_site,
    };
    // The monitor replays the recording so that the folder has the same contents as after a live flight.
    let mut monitor = Monitor::new(config);
    for record in tlog::TlogReader::new(log) {
        monitor.handle_datagram(record.frame);
        while let Some(event) = monitor.poll_record() {
            if matches!(event, SessionOutput::Event(_)) {
                folder.record(event);
            }
        }
        while monitor.poll_transmit().is_some() {}
    }
    folder.record(SessionOutput::Telemetry(kept.to_vec()));
    folder.flush()?;
    if let Some(survey) = monitor.survey() {
        folder.resolve(assessed_session.seed, survey.defects())?;
    }
    folder.write_session_json(|scenario, vehicle, utc, starts| monitor.session_info(scenario, vehicle, utc, starts))?;
    if let Err(error) = report::write(folder.path(), request.visitor.language, &|job| state.figures.reliability_if_known(job)) {
        tracing::warn!("cannot write the report: {error}");
    }
    folder.write_assessment(&json_text(&assessed_session.assessment))?;
    // The complete folder is moved to the sessions folder; if the server is killed before that, nothing appears there.
    let place = unused_folder_path(&first, &folder.path().file_name().unwrap_or_default().to_string_lossy());
    let moved = std::fs::rename(folder.path(), &place);
    moved.map_err(|error| WebError::Failed(format!("{}: cannot move: {error}", place.display())))?;
    Ok(UploadOutcome::Session(place))
}

/// Returns a path with this name, or with a similar name if another recording with the same start time is already using
/// it.
fn unused_folder_path(sessions: &Path, name: &str) -> PathBuf {
    let stem = name.rsplit_once('-').map_or(name, |(stem, _)| stem);
    let others = (1..).map(|k: u32| format!("{stem}-{}", &sha256_hex(format!("{name} {k}").as_bytes())[..6]));
    let mut places = std::iter::once(name.to_owned()).chain(others).map(|name| sessions.join(name));
    places.find(|place| !place.exists()).unwrap_or_else(|| sessions.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_existing_folder_name_gets_a_suffix() {
        let sessions = tempfile::tempdir().unwrap();
        let name = "20231114T221320Z-anna-two-bridges-1a2b3c";
        assert_eq!(unused_folder_path(sessions.path(), name), sessions.path().join(name));
        let mut seen = std::collections::BTreeSet::new();
        for _ in 0..3 {
            let place = unused_folder_path(sessions.path(), name);
            std::fs::create_dir(&place).unwrap();
            let name = place.file_name().unwrap().to_string_lossy().into_owned();
            assert!(name.starts_with("20231114T221320Z-anna-two-bridges-") && seen.insert(name));
        }
    }
}
