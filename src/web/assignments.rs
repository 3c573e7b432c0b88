//! Assigns jobs to trainees and classes.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::{self, StoredScenario};
use super::state::ServerState;
use crate::io::clock;
use maud::Markup;
use spandrel_model::calendar::{day, end_of_day_unix_us};
use spandrel_model::scenario::variant_names;
use spandrel_monitor::folder::sha256_hex;
use spandrel_text::{Language, text};
use spandrel_training::assignment::{AssignedJob, Assignment, AssignmentTarget, assigned_jobs};
use spandrel_training::record::SessionRecord;
use spandrel_training::terms::scenario_title;
use spandrel_training::web::assignments::{self as pages, AssignPage, JobChoice};
use spandrel_training::web::rejected_form::RejectedForm;

/// Length of a day, µs.
const DAY_US: u64 = 86_400_000_000;
/// Days until the due date that the page suggests (estimate: a weekly course).
const SUGGESTED_DAYS: u64 = 7;
/// Latest due date, days from now: ten years.
const MAX_DAYS: u64 = 3_652;
/// Length of an assignment's ID, hexadecimal digits.
const ID_DIGITS: usize = 16;

/// Returns a trainee's assignments with their states, from the trainee's records in chronological order.
///
/// # Errors
/// Returns an error if the database fails.
pub fn jobs_of(
    state: &ServerState,
    trainee: &str,
    records: &[SessionRecord],
    now_unix_us: u64,
) -> Result<Vec<AssignedJob>, WebError> {
    Ok(assigned_jobs(state.database.assignments_of_trainee(trainee)?, records, now_unix_us))
}

/// Field of the form with an error, and the error.
type FieldError = (&'static str, WebError);

/// Responds with the page that assigns a job.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let language = request.visitor.language;
    let target =
        target(language, request.query_param("trainee"), request.query_param("class")).map_err(|_| WebError::NotFound)?;
    Ok(WebResponse::page(render(state, request, &target, None)?))
}

fn render(
    state: &ServerState,
    request: &WebRequest,
    target: &AssignmentTarget,
    rejected: Option<RejectedForm<'_>>,
) -> Result<Markup, WebError> {
    if !exists(state, target)? {
        return Err(WebError::NotFound);
    }
    let choice = |job: StoredScenario| JobChoice {
        variants: variant_names(&job.text),
        title: scenario_title(&job.named.name, &job.named.title, request.visitor.language),
        name: job.named.name,
    };
    // A session record does not contain which steps of a lesson were done.
    let jobs = scenario_library::all(&state.scenarios).into_iter().filter(|job| job.scenario.lesson.is_empty());
    let jobs: Vec<JobChoice> = jobs.map(choice).collect();
    let now = clock::unix_us();
    let about = AssignPage {
        target,
        jobs: &jobs,
        scenario: request.query_param("scenario"),
        variant: request.query_param("variant"),
        due: (&day(now + SUGGESTED_DAYS * DAY_US), &day(now)),
        rejected,
    };
    Ok(pages::assign_page(&request.visitor, &about))
}

/// Returns the trainee or class in a request, which must name exactly one.
fn target(language: Language, trainee: Option<&str>, class: Option<&str>) -> Result<AssignmentTarget, WebError> {
    match (trainee, class) {
        (Some(name), None) => Ok(AssignmentTarget::Trainee(name.to_owned())),
        (None, Some(name)) => Ok(AssignmentTarget::Class(name.to_owned())),
        (Some(_), Some(_)) | (None, None) => Err(WebError::BadRequest(text!(language, "people-assign-one-target"))),
    }
}

fn exists(state: &ServerState, target: &AssignmentTarget) -> Result<bool, WebError> {
    Ok(match target {
        AssignmentTarget::Trainee(name) => state.database.account(name)?.is_some(),
        AssignmentTarget::Class(name) => state.database.classes()?.iter().any(|class| &class.name == name),
    })
}

/// Assigns a job. Shows the form again if a field is not possible.
pub fn assign(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let language = request.visitor.language;
    let target = target(language, request.form_field("trainee"), request.form_field("class"))?;
    match assignment(state, request, target.clone()) {
        Ok(assignment) if state.database.assign(&assignment)? => Ok(WebResponse::redirect(&target_url(&target))),
        Ok(_) => Err(WebError::NotFound),
        Err((field, error)) => {
            let form = request.rejected(field, &error).ok_or_else(|| error.clone())?;
            Ok(WebResponse::rejected_form(render(state, request, &target, Some(form))?))
        }
    }
}

/// Returns the assignment in the form.
fn assignment(state: &ServerState, request: &WebRequest, target: AssignmentTarget) -> Result<Assignment, FieldError> {
    let (language, now) = (request.visitor.language, clock::unix_us());
    let required = |field: &'static str| request.required_field(field).map_err(|error| (field, error));
    let scenario = required("scenario")?;
    let job = job(state, language, scenario).map_err(|error| ("scenario", error))?;
    let given = request.form_field("variant").unwrap_or_default().trim();
    let variant = variant(&job, language, given).map_err(|error| ("variant", error))?;
    let due_unix_us = due(language, required("due")?, now).map_err(|error| ("due", error))?;
    let key = format!("{target:?} {scenario} {variant:?} {now}");
    Ok(Assignment {
        id: sha256_hex(key.as_bytes()).chars().take(ID_DIGITS).collect(),
        target,
        scenario: scenario.to_owned(),
        variant,
        assigned_unix_us: now,
        due_unix_us,
        assigned_by: request.visitor.name.clone().unwrap_or_default(),
    })
}

/// Returns the scenario with this name.
fn job(state: &ServerState, language: Language, scenario: &str) -> Result<StoredScenario, WebError> {
    let unknown = || WebError::BadRequest(text!(language, "web-error-unknown-name", field = "scenario"));
    scenario_library::find(&state.scenarios, scenario).ok_or_else(unknown)
}

/// Checks the form or level of a scenario; empty for none.
fn variant(job: &StoredScenario, language: Language, given: &str) -> Result<Option<String>, WebError> {
    let scenario = job.named.name.as_str();
    if given.is_empty() {
        return Ok(None);
    }
    let names = variant_names(&job.text);
    if names.iter().any(|name| name == given) {
        return Ok(Some(given.to_owned()));
    }
    let short: String = given.chars().take(60).collect();
    Err(WebError::BadRequest(if names.is_empty() {
        text!(language, "people-assign-no-variants", value = short, job = scenario)
    } else {
        text!(language, "people-assign-variant-unknown", value = short, job = scenario, allowed = names.join(", "))
    }))
}

/// Returns the end of the due date, which is today or later.
fn due(language: Language, given: &str, now_unix_us: u64) -> Result<u64, WebError> {
    let latest = now_unix_us + MAX_DAYS * DAY_US;
    end_of_day_unix_us(given).filter(|end| (now_unix_us..=latest).contains(end)).ok_or_else(|| {
        let short: String = given.chars().take(60).collect();
        let (first, last) = (day(now_unix_us), day(latest));
        WebError::BadRequest(text!(language, "people-assign-due-invalid", value = short, first = first, last = last))
    })
}

/// Removes an assignment.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let assignment = state.database.assignment(id)?.ok_or(WebError::NotFound)?;
    state.database.remove_assignment(id)?;
    Ok(WebResponse::redirect(&target_url(&assignment.target)))
}

fn target_url(target: &AssignmentTarget) -> String {
    match target {
        AssignmentTarget::Trainee(name) => format!("/trainees/{name}"),
        AssignmentTarget::Class(name) => class_url(name),
    }
}

/// Returns the URL of a class's page.
pub fn class_url(name: &str) -> String {
    format!("/classes/{name}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_due_dates_are_from_today_to_ten_years() {
        let now = 1_700_000_000_000_000; // 2023-11-14 22:13 UTC
        assert_eq!(due(Language::English, "2023-11-14", now), Ok(1_700_006_399_999_999));
        for wrong in ["2023-11-13", "2033-12-01", "soon", ""] {
            let told = due(Language::English, wrong, now).unwrap_err();
            let expected = format!("due = {wrong}: invalid date (allowed: 2023-11-14 to 2033-11-13)");
            assert_eq!(told, WebError::BadRequest(expected));
        }
    }

    #[test]
    fn exact_assignment_is_for_one_trainee_or_one_class() {
        let target = |trainee, class| target(Language::English, trainee, class);
        assert_eq!(target(Some("anna"), None), Ok(AssignmentTarget::Trainee("anna".into())));
        assert_eq!(target(None, Some("spring")), Ok(AssignmentTarget::Class("spring".into())));
        assert!(target(None, None).is_err() && target(Some("anna"), Some("spring")).is_err());
    }
}
