//! Trainees and groups of them.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use crate::io::clock;
use crate::io::plan_rules;
use crate::io::trainee_id::TraineeId;
use crate::records::{erase_person, kept};
use spandrel_monitor::export::json_text;
use spandrel_training::cohort::{Selection, TABLES, table};
use spandrel_training::plan::plan_counting;
use spandrel_training::record::IncompletePolicy;
use spandrel_training::report::{assets, page::cohort as report};
use spandrel_training::trainee::{AGE_BANDS, EXPERIENCE, Role, Trainee};
use spandrel_training::web::{group, trainees as pages};

/// Sessions on a trainee's page.
const SESSIONS: u32 = 200;
/// Repetitions compared unless asked otherwise.
const REPETITIONS: usize = 3;

/// Everybody.
pub fn trainee_list(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    Ok(WebResponse::page(pages::trainee_list(&asked.visitor, &state.database.trainees()?)))
}

/// The person of the path, if the visitor may see him.
fn person(state: &ServerState, asked: &WebRequest) -> Result<Trainee, WebError> {
    let name = asked.path_part("name");
    asked.require_access(name)?;
    state.database.account(name)?.map(|account| account.person).ok_or(WebError::NotFound)
}

/// One trainee.
pub fn trainee_page(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let person = person(state, asked)?;
    let records = state.database.records(Some(&person.pseudonym))?;
    let listed = state.database.list(Some(&person.pseudonym), SESSIONS, 0)?;
    let incomplete = incomplete(asked);
    let plan = plan_counting(records.clone(), incomplete, &plan_rules::rules(None)?, clock::unix_us());
    let about = pages::TraineeProfile { person: &person, records: &records, listed: &listed, plan: plan.as_ref(), incomplete };
    Ok(WebResponse::page(pages::trainee_page(&asked.visitor, &about)))
}

/// Everything that is kept of one.
pub fn export(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let person = person(state, asked)?;
    let kept = kept(&state.database, &state.place, &person.pseudonym)?.ok_or(WebError::NotFound)?;
    let name = format!("{}.json", person.pseudonym.parse::<TraineeId>().as_ref().map_or("trainee", TraineeId::as_str));
    Ok(WebResponse::download(&name, "application/json", json_text(&kept.without_places()).into_bytes()))
}

/// What one tells of oneself: field, and what it may be.
const DETAILS: [(&str, &[&str]); 3] =
    [("age_band", AGE_BANDS), ("drone_experience", EXPERIENCE), ("gaming_experience", EXPERIENCE)];

/// Takes what one tells of oneself, unless somebody else has changed it since the page was opened.
pub fn details(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let person = person(state, asked)?;
    let (mut before, mut after) = ([""; 3], [""; 3]);
    for (k, (field, allowed)) in DETAILS.into_iter().enumerate() {
        let given = asked.form_field(field).unwrap_or_default();
        if !given.is_empty() && !allowed.contains(&given) {
            let short: String = given.chars().take(60).collect();
            return Err(WebError::BadRequest(format!("{field} = {short}: unknown (allowed: {})", allowed.join(", "))));
        }
        let shown = format!("{}{field}", pages::BEFORE);
        before[k] = asked.form_field(&shown).ok_or_else(|| WebError::BadRequest(format!("{shown}: missing")))?;
        after[k] = given;
    }
    if !state.database.set_details(&person.pseudonym, before, after)? {
        return Err(WebError::BadRequest(
            "somebody has changed these details meanwhile: open the page again and look at them".into(),
        ));
    }
    Ok(WebResponse::redirect(&format!("/trainees/{}", asked.path_part("name"))))
}

/// Erases one with everything; the name must be written once more.
pub fn erase(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let person = person(state, asked)?;
    let name = &person.pseudonym;
    if asked.required_field("again")? != name {
        return Err(WebError::BadRequest(format!("the pseudonym that was written is not {name}: nothing is erased")));
    }
    // Whoever erases is an administrator who stays: so the last one is never erased.
    if person.role == Role::Administrator && asked.visitor.name.as_deref() == Some(name) {
        return Err(WebError::BadRequest("you would shut yourself out: let another administrator erase you".into()));
    }
    erase_person(&state.database, &state.place, name)?;
    state.auth.end_other_sessions(name, None);
    tracing::info!("a trainee was erased");
    Ok(WebResponse::redirect("/trainees"))
}

/// Incomplete sessions count where the page's switch is on.
fn incomplete(asked: &WebRequest) -> IncompletePolicy {
    IncompletePolicy::included(asked.query_value("incomplete").is_some())
}

fn chosen(asked: &WebRequest) -> Result<Selection, WebError> {
    let repetitions = match asked.query_value("repetitions") {
        None => REPETITIONS,
        Some(text) => text
            .parse()
            .ok()
            .filter(|count| (1..=100).contains(count))
            .ok_or_else(|| WebError::BadRequest("repetitions: no such number (allowed: 1 to 100)".into()))?,
    };
    let scenarios = asked.query.iter().filter(|(key, _)| key == "scenario").map(|(_, name)| name.clone()).collect();
    Ok(Selection { scenarios, repetitions, incomplete: incomplete(asked) })
}

/// The group's page.
pub fn cohort_page(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let selection = chosen(asked)?;
    let figured = state.figures.of(&selection)?;
    let counted = figured.non_empty();
    let scenarios = counted.map_or(selection.scenarios, |cohort| cohort.scenarios.clone());
    let chosen = group::GroupSelection {
        flown_scenarios: &figured.flown_scenarios,
        scenarios: &scenarios,
        repetitions: selection.repetitions,
        incomplete: selection.incomplete,
        left_out: figured.cohort.left_out,
    };
    Ok(WebResponse::page(group::group(&asked.visitor, &chosen, counted)))
}

/// One of its tables as a file.
pub fn cohort_table(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let name = TABLES.into_iter().find(|name| *name == asked.path_part("name")).ok_or(WebError::NotFound)?;
    let figured = state.figures.of(&chosen(asked)?)?;
    let csv = figured.non_empty().and_then(|cohort| table(cohort, name)).ok_or(WebError::NotFound)?;
    Ok(WebResponse::download(name, "text/csv; charset=utf-8", csv.into_bytes()))
}

/// The same as one page that opens offline.
pub fn cohort_report(state: &ServerState, asked: &WebRequest) -> HandlerResult {
    let figured = state.figures.of(&chosen(asked)?)?;
    let nothing = || WebError::BadRequest("there is no session of these scenarios that counts".into());
    let cohort = figured.non_empty().ok_or_else(nothing)?;
    Ok(WebResponse::sandboxed_page(report::cohort(cohort).into_bytes(), &assets::page_policy()))
}
