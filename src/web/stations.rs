//! Check-ins of training stations, and the page where an instructor starts flights at them.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_pictures;
use super::state::ServerState;
use crate::io::clock;
use crate::io::station_key::StationKey;
use crate::io::trainee_id::{ALLOWED_IDS, is_plain_id};
use axum::http::StatusCode;
use spandrel_monitor::folder::sha256_hex;
use spandrel_text::{Language, text};
use spandrel_training::stations::{CheckIn, CheckInRefusal, CheckInReply, FlightOrder, OrderError, StationFlight};
use spandrel_training::web::browser_sessions::constant_time_eq;
use spandrel_training::web::stations::{StationList, StationsPage, URL, stations_now, stations_page};

/// Length of an order's ID, hexadecimal digits.
const ID_DIGITS: usize = 16;
/// Purposes of a flight.
const PURPOSES: [&str; 2] = ["practice", "assessment"];

/// Handles a station's check-in. A station that is rejected receives the reason as JSON.
pub fn check_in(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let key = state.station_key.as_ref().ok_or(WebError::NotFound)?;
    let (value, status) = match reply(state, request, key) {
        Ok(reply) => (serde_json::to_value(reply), StatusCode::OK),
        Err((error, status)) => {
            tracing::warn!("station check-in from {}: {error}", request.from);
            (serde_json::to_value(CheckInRefusal { error }), status)
        }
    };
    let value = value.map_err(|error| WebError::Failed(error.to_string()))?;
    Ok(WebResponse::json(&value).with_status(status))
}

/// Returns whether a request contains the stations' key.
fn is_from_station(request: &WebRequest, key: &StationKey) -> bool {
    request.authorization.as_deref().is_some_and(|sent| constant_time_eq(sent, &key.authorization()))
}

/// Responds to a station with a picture of an uploaded scenario's briefing.
pub fn picture(state: &ServerState, request: &WebRequest) -> HandlerResult {
    state.station_key.as_ref().filter(|key| is_from_station(request, key)).ok_or(WebError::NotFound)?;
    scenario_pictures::show(state, request)
}

fn reply(state: &ServerState, request: &WebRequest, key: &StationKey) -> Result<CheckInReply, (String, StatusCode)> {
    if !is_from_station(request, key) {
        return Err(("wrong station key (--station-key)".to_owned(), StatusCode::FORBIDDEN));
    }
    let invalid = |why: String| (why, StatusCode::UNPROCESSABLE_ENTITY);
    let message: CheckIn = serde_json::from_slice(&request.body).map_err(|error| invalid(format!("not a check-in: {error}")))?;
    if !is_plain_id(&message.station) {
        return Err(invalid(format!("'{}' is not a station name (allowed: {ALLOWED_IDS})", message.station)));
    }
    let reply = lock(&state.stations).check_in(message, clock::unix_us());
    reply.map_err(|error| (error.to_string(), StatusCode::CONFLICT))
}

/// Responds with the page of all stations.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render(state, request, (None, [""; 4]))
}

/// Responds with the part of the page that changes.
pub fn now(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let board = lock(&state.stations).clone();
    let list = StationList { stations: board.stations().collect(), now_unix_us: clock::unix_us() };
    Ok(WebResponse::page(stations_now(request.visitor.language, &list)))
}

fn render(state: &ServerState, request: &WebRequest, (refusal, entered): (Option<&str>, [&str; 4])) -> HandlerResult {
    let board = lock(&state.stations).clone();
    let jobs = state.station_jobs.all(&state.scenarios);
    let scenarios: Vec<&str> = jobs.iter().flat_map(|job| &job.names).map(String::as_str).collect();
    let trainees: Vec<String> = state.database.trainees()?.into_iter().map(|person| person.pseudonym).collect();
    let about = StationsPage {
        list: StationList { stations: board.stations().collect(), now_unix_us: clock::unix_us() },
        scenarios: &scenarios,
        trainees: &trainees,
        refusal,
        entered,
        enabled: state.station_key.is_some(),
    };
    Ok(WebResponse::page(stations_page(&request.visitor, &about)))
}

/// Orders a flight at a station.
pub fn order(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let language = request.visitor.language;
    let station = request.required_field("station")?;
    let trainee = request.form_field("trainee").unwrap_or_default().trim();
    if !is_plain_id(trainee) {
        return refused(state, request, &text!(language, "stations-error-trainee"));
    }
    let scenario = request.required_field("scenario")?;
    let purpose = request.required_field("purpose")?;
    if !PURPOSES.contains(&purpose) {
        return Err(WebError::unknown(language, "purpose", &PURPOSES.join(", ")));
    }
    let jobs = state.station_jobs.all(&state.scenarios);
    let job = jobs.iter().find(|job| job.names.iter().any(|name| name == scenario));
    let job = job.ok_or_else(|| WebError::BadRequest(text!(language, "web-error-unknown-name", field = "scenario")))?;
    let now = clock::unix_us();
    let order = FlightOrder {
        id: sha256_hex(format!("{station} {trainee} {scenario} {now}").as_bytes()).chars().take(ID_DIGITS).collect(),
        flight: StationFlight { trainee: trainee.to_owned(), scenario: scenario.to_owned(), purpose: purpose.to_owned() },
        scenario_text: job.uploaded_text.clone(),
    };
    // The page of the refusal locks the board again.
    let ordered = lock(&state.stations).order(station, order, now);
    match ordered {
        Ok(()) => Ok(WebResponse::redirect(URL)),
        Err(error) => refused(state, request, &refusal_words(language, error, station)),
    }
}

fn refused(state: &ServerState, request: &WebRequest, words: &str) -> HandlerResult {
    let entered = ["station", "trainee", "scenario", "purpose"].map(|name| request.form_field(name).unwrap_or_default());
    Ok(render(state, request, (Some(words), entered))?.with_status(StatusCode::CONFLICT))
}

fn refusal_words(language: Language, error: OrderError, station: &str) -> String {
    match error {
        OrderError::Unknown => text!(language, "stations-error-unknown", station = station),
        OrderError::Lost => text!(language, "stations-error-lost", station = station),
        OrderError::Flying => text!(language, "stations-error-flying", station = station),
    }
}
