//! Pages for trainees and cohorts.

use super::assignments::jobs_of;
use super::person::person;
use super::plan_rules::rules_in_use;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::rubric::rubric_in_use;
use super::state::ServerState;
use crate::io::clock;
use crate::io::trainee_id::TraineeId;
use crate::records::{erase_trainee, trainee_data};
use spandrel_monitor::export::json_text;
use spandrel_text::text;
use spandrel_training::cohort::{JobReliability, Selection, TABLES, table};
use spandrel_training::plan::plan_for_policy;
use spandrel_training::record::{IncompletePolicy, SessionRecord};
use spandrel_training::report::{assets, page::cohort as report};
use spandrel_training::trainee::{AGE_BANDS, EXPERIENCE_LEVELS, Role};
use spandrel_training::web::rubric::count_words;
use spandrel_training::web::served_report::{ParentPage, with_back_links};
use spandrel_training::web::{cohort_page, trainees as pages};
use std::collections::BTreeMap;

/// Maximum number of sessions on a trainee's page.
const MAX_SESSIONS: u32 = 200;
/// Default number of repetitions to compare.
const DEFAULT_REPETITIONS: usize = 3;

/// Responds with the list of all trainees.
pub fn trainee_list(state: &ServerState, request: &WebRequest) -> HandlerResult {
    Ok(WebResponse::page(pages::trainee_list(&request.visitor, &state.database.trainees()?)))
}

/// Responds with a trainee's sessions, progress and training plan.
pub fn trainee_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (language, person) = (request.visitor.language, person(state, request)?);
    let records = state.database.records(Some(&person.pseudonym))?;
    let listed = state.database.list(Some(&person.pseudonym), MAX_SESSIONS, 0)?;
    let incomplete = incomplete_policy(request);
    let (rules, problem) = rules_in_use(state, language)?;
    let now = clock::unix_us();
    let mut plan = plan_for_policy(records.clone(), incomplete, &rules, now, language);
    if let Some((plan, problem)) = plan.as_mut().zip(problem) {
        plan.note = Some(plan.note.take().map_or_else(|| problem.clone(), |note| format!("{note} {problem}")));
    }
    let reliability = reliability_of_repeated_jobs(state, &records, incomplete)?;
    let about = pages::TraineeProfile {
        person: &person,
        records: &records,
        listed: &listed,
        jobs: &jobs_of(state, &person.pseudonym, &records, now)?,
        classes: &state.database.classes_of(&person.pseudonym)?,
        rubric: &count_words(language, &rubric_in_use(state, language)?.0, &state.database.sign_offs(&person.pseudonym)?),
        plan: plan.as_ref(),
        incomplete,
        reliability: &reliability,
    };
    Ok(WebResponse::page(pages::trainee_page(&request.visitor, &about)))
}

/// Returns the reliability of the measures on each job that the trainee flew more than once: only there, sessions are
/// compared.
fn reliability_of_repeated_jobs(
    state: &ServerState,
    records: &[SessionRecord],
    incomplete: IncompletePolicy,
) -> Result<JobReliability, WebError> {
    let mut flown: BTreeMap<String, usize> = BTreeMap::new();
    for record in records {
        *flown.entry(record.scenario_with_level()).or_default() += 1;
    }
    let repeated = flown.into_iter().filter(|(_, times)| *times > 1);
    let known = repeated.map(|(job, _)| Ok((job.clone(), state.figures.reliability(&job, incomplete)?)));
    known.collect()
}

/// Responds with all of a trainee's data.
pub fn export(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let person = person(state, request)?;
    let kept = trainee_data(&state.database, &state.records_location, &person.pseudonym)?.ok_or(WebError::NotFound)?;
    let name = format!("{}.json", person.pseudonym.parse::<TraineeId>().as_ref().map_or("trainee", TraineeId::as_str));
    Ok(WebResponse::download(&name, "application/json", json_text(&kept.with_folder_names()).into_bytes()))
}

/// The fields for a person's details, with their allowed values.
const DETAIL_FIELDS: [(&str, &[&str]); 3] =
    [("age_band", AGE_BANDS), ("drone_experience", EXPERIENCE_LEVELS), ("gaming_experience", EXPERIENCE_LEVELS)];

/// Saves a person's details, unless they have been changed elsewhere since the page was loaded.
pub fn details(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (language, person) = (request.visitor.language, person(state, request)?);
    let (mut before, mut after) = ([""; 3], [""; 3]);
    for (k, (field, allowed)) in DETAIL_FIELDS.into_iter().enumerate() {
        let given = request.form_field(field).unwrap_or_default();
        if !given.is_empty() && !allowed.contains(&given) {
            let short: String = given.chars().take(60).collect();
            let allowed = allowed.join(", ");
            let words = text!(language, "web-error-unknown-value", field = field, value = short, allowed = allowed);
            return Err(WebError::BadRequest(words));
        }
        let shown = format!("{}{field}", pages::ORIGINAL_VALUE_PREFIX);
        before[k] = request.form_field(&shown).ok_or_else(|| WebError::missing(language, &shown))?;
        after[k] = given;
    }
    if !state.database.set_details(&person.pseudonym, before, after)? {
        return Err(WebError::BadRequest(text!(language, "people-details-changed")));
    }
    Ok(WebResponse::redirect(&format!("/trainees/{}", request.path_param("name"))))
}

/// Erases a trainee and all their data. The user must type the pseudonym to confirm.
pub fn erase(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (language, person) = (request.visitor.language, person(state, request)?);
    let name = &person.pseudonym;
    if request.required_field("again")? != name {
        return Err(WebError::BadRequest(text!(language, "people-erase-wrong-name", name = name.as_str())));
    }
    // Administrators cannot erase themselves, so there is always at least one administrator.
    if person.role == Role::Administrator && request.visitor.name.as_deref() == Some(name) {
        return Err(WebError::BadRequest(text!(language, "people-erase-self")));
    }
    erase_trainee(&state.database, &state.records_location, name)?;
    state.auth.end_other_sessions(name, None);
    tracing::info!("erased a trainee");
    Ok(WebResponse::redirect("/trainees"))
}

/// Returns the selection on the page: whether incomplete sessions count.
fn incomplete_policy(request: &WebRequest) -> IncompletePolicy {
    IncompletePolicy::included(request.query_param("incomplete").is_some())
}

fn selection_from_query(request: &WebRequest) -> Result<Selection, WebError> {
    let repetitions = match request.query_param("repetitions") {
        None => DEFAULT_REPETITIONS,
        Some(text) => text
            .parse()
            .ok()
            .filter(|count| (1..=100).contains(count))
            .ok_or_else(|| WebError::not_in_range(request.visitor.language, "repetitions", 1, 100))?,
    };
    let scenarios = request.query.iter().filter(|(key, _)| key == "scenario").map(|(_, name)| name.clone()).collect();
    Ok(Selection { scenarios, repetitions, incomplete: incomplete_policy(request) })
}

/// Responds with the cohort page.
pub fn cohort_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let selection = selection_from_query(request)?;
    let figured = state.figures.get(&selection)?;
    let counted = figured.non_empty_cohort();
    let scenarios = counted.map_or(selection.scenarios, |cohort| cohort.scenarios.clone());
    let chosen = cohort_page::CohortPageSelection {
        flown_scenarios: &figured.flown_scenarios,
        scenarios: &scenarios,
        repetitions: selection.repetitions,
        incomplete: selection.incomplete,
        left_out: figured.cohort.left_out,
    };
    Ok(WebResponse::page(cohort_page::cohort_page(&request.visitor, &chosen, counted)))
}

/// Responds with a cohort table as CSV.
pub fn cohort_table(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let name = TABLES.into_iter().find(|name| *name == request.path_param("name")).ok_or(WebError::NotFound)?;
    let figured = state.figures.get(&selection_from_query(request)?)?;
    let csv = figured.non_empty_cohort().and_then(|cohort| table(cohort, name)).ok_or(WebError::NotFound)?;
    Ok(WebResponse::download(name, "text/csv; charset=utf-8", csv.into_bytes()))
}

/// Responds with the cohort report as a single page that works offline.
pub fn cohort_report(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let figured = state.figures.get(&selection_from_query(request)?)?;
    let nothing = || WebError::BadRequest(text!(request.visitor.language, "people-cohort-nothing"));
    let cohort = figured.non_empty_cohort().ok_or_else(nothing)?;
    let page = report::cohort(cohort, request.visitor.language).into_bytes();
    let served = with_back_links(page, &[ParentPage::Cohort], request.visitor.language);
    Ok(WebResponse::sandboxed_page(served, &assets::page_policy()))
}
