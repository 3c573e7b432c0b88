//! The rules of the training plans: shipped, or the server's own.

use super::own_file::OwnFile;
use super::request::{WebRequest, not_text};
use super::response::{HandlerResult, WebError, WebResponse};
use super::scenario_library::all;
use super::state::ServerState;
use crate::errors::AppError;
use crate::io::plan_rules;
use axum::http::StatusCode;
use spandrel_text::{Language, text};
use spandrel_training::plan::{DEFAULT_RULES, PlanRules, read_rules};
use spandrel_training::web::layout::Notice;
use spandrel_training::web::plan_rules::{PlanRulesPage, plan_rules_page};
use std::path::Path;

/// Path of the page.
const PAGE: &str = "/plan-rules";

/// The server's own rules.
const OWN: OwnFile = OwnFile { folder: "plan-rules", name: "rules.toml" };

/// Returns the rules in use on the server, as [`rules_beside`].
///
/// # Errors
/// Returns an error if the shipped rules are invalid.
pub fn rules_in_use(state: &ServerState, language: Language) -> Result<(PlanRules, Option<String>), AppError> {
    rules_beside(&state.scenarios, language)
}

/// Returns the rules in use beside a folder of scenarios, with the difficulty levels of the drills, which may be uploaded scenarios,
/// and a note if the instructors' own rules can't be used.
///
/// # Errors
/// Returns an error if the shipped rules are invalid.
pub fn rules_beside(scenarios: &Path, language: Language) -> Result<(PlanRules, Option<String>), AppError> {
    let (rules, note) = valid_rules(scenarios, language)?;
    // Reading all scenarios takes longer than the plan, and only uploaded ones can add anything.
    if rules.drills.iter().all(|drill| drill.difficulty.is_some()) {
        return Ok((rules, note));
    }
    let known = all(scenarios);
    let levels = |name: &str| known.iter().find(|job| job.named.name == name)?.scenario.difficulty.clone();
    Ok((rules.with_levels(levels), note))
}

fn valid_rules(scenarios: &Path, language: Language) -> Result<(PlanRules, Option<String>), AppError> {
    let shipped = || plan_rules::rules(None);
    let own = OWN.path_in(scenarios);
    if !own.is_file() {
        return Ok((shipped()?, None));
    }
    match plan_rules::rules(Some(&own)) {
        Ok(rules) => Ok((rules, None)),
        Err(AppError::Wrong(_) | AppError::Failed(_) | AppError::Autopilot(..)) => {
            Ok((shipped()?, Some(text!(language, "editor-rules-invalid"))))
        }
    }
}

/// Responds with the page.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let own = OWN.text(state)?;
    let text = own.as_deref().unwrap_or(DEFAULT_RULES);
    let rules = read_rules("rules.toml", text);
    let problems = rules.as_ref().err().map(ToString::to_string);
    let notice = problems.as_deref().map(|details| Notice { kind: "bad", text: "", details });
    let about = PlanRulesPage { text, own: own.is_some(), rules: rules.as_ref().ok(), notice };
    Ok(WebResponse::page(plan_rules_page(&request.visitor, &about)))
}

/// Validates and saves the edited rules.
pub fn save(state: &ServerState, request: &WebRequest) -> HandlerResult {
    // Browsers send line breaks as CR LF.
    let text = request.required_field("rules")?.replace("\r\n", "\n");
    save_text(state, request, "rules.toml", &text)
}

/// Validates and saves an uploaded file.
pub fn upload(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let upload = request.required_upload()?;
    let (shown, bytes) = (upload.shown_name(), upload.file.bytes()?);
    let text = std::str::from_utf8(&bytes);
    let text = text.map_err(|error| WebError::BadRequest(not_text(request.visitor.language, &shown, error)))?;
    save_text(state, request, &shown, text)
}

fn save_text(state: &ServerState, request: &WebRequest, shown: &str, text: &str) -> HandlerResult {
    let rules = match read_rules(shown, text) {
        Ok(rules) => rules,
        Err(problems) => {
            let (words, problems) = (text!(request.visitor.language, "web-not-saved"), problems.to_string());
            let notice = Notice { kind: "bad", text: &words, details: &problems };
            let about = PlanRulesPage { text, own: OWN.exists(state), rules: None, notice: Some(notice) };
            let shown = WebResponse::page(plan_rules_page(&request.visitor, &about));
            return Ok(shown.with_status(StatusCode::UNPROCESSABLE_ENTITY));
        }
    };
    OWN.save(state, text)?;
    let words = text!(request.visitor.language, "editor-rules-saved");
    let about = PlanRulesPage { text, own: true, rules: Some(&rules), notice: Some(Notice::good(&words)) };
    Ok(WebResponse::page(plan_rules_page(&request.visitor, &about)))
}

/// Deletes the server's own rules.
pub fn reset(state: &ServerState, _: &WebRequest) -> HandlerResult {
    OWN.delete(state)?;
    Ok(WebResponse::redirect(PAGE))
}
