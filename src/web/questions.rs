//! Questionnaire pages. Every answer is saved in `answers.json` immediately.

use super::lock::lock;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::sessions;
use super::state::ServerState;
use crate::io::answers::{read_saved_answers, task_ids};
use crate::io::replace::replace;
use crate::io::session_folder::StoredSession;
use serde_json::json;
use spandrel_model::scenario::Scenario;
use spandrel_monitor::export::json_text;
use spandrel_text::Language;
use spandrel_training::questionnaire::{ANSWERS, Answers, QuestionnaireItem, Wording};
use spandrel_training::terms::task_title;
use spandrel_training::web::questionnaire_form;

/// Responds with a session's questionnaire.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render_form(state, request, false)
}

fn render_form(state: &ServerState, request: &WebRequest, saved: bool) -> HandlerResult {
    let id = request.path_param("id");
    let folder = sessions::folder(state, request, id)?;
    let scenario = StoredSession::read_scenario(&folder)?.scenario;
    let answers = read_saved_answers(&folder, &scenario)?.unwrap_or_default();
    let wording = language(state, request, &answers)?;
    let tasks = task_names(&scenario, wording);
    let languages = state.languages.all();
    let about = questionnaire_form::FormContext { id, tasks: &tasks, wording, languages, answers: &answers, saved };
    Ok(WebResponse::page(questionnaire_form::page(&request.visitor, &about)))
}

/// Returns the wording in the requested language, in the language of the saved answers, or in the visitor's preferred
/// language.
fn language<'a>(state: &'a ServerState, request: &WebRequest, answers: &Answers) -> Result<&'a Wording, WebError> {
    if let Some(tag) = request.form_field("language").or_else(|| request.query_param("language")) {
        return state
            .languages
            .of(tag)
            .ok_or_else(|| WebError::unknown(request.visitor.language, "language", &language_tags(state)));
    }
    let begun = state.languages.of(&answers.language).filter(|_| !answers.language.is_empty());
    Ok(begun.unwrap_or_else(|| state.languages.accepted(&request.languages)))
}

fn language_tags(state: &ServerState) -> String {
    state.languages.all().iter().map(|wording| wording.language.as_str()).collect::<Vec<_>>().join(", ")
}

/// Returns the tasks with their titles in the language of a wording; their own names if Spandrel has no such language.
fn task_names(scenario: &Scenario, wording: &Wording) -> Vec<(u32, String)> {
    let language = Language::from_tag(&wording.language).unwrap_or_default();
    scenario.tasks.iter().map(|task| (task.id, task_title(&scenario.name, &task.name, language))).collect()
}

/// Saves the answers from a submitted form.
pub fn save(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let folder = sessions::folder(state, request, id)?;
    let scenario = StoredSession::read_scenario(&folder)?.scenario;
    let tasks = task_ids(&scenario);
    let answers = {
        let _others_wait = lock(&state.answers);
        let mut answers = read_saved_answers(&folder, &scenario)?.unwrap_or_default();
        questionnaire_form::parse_answers(&mut answers, &request.form, &tasks, request.visitor.language)
            .map_err(WebError::BadRequest)?;
        answers.language.clone_from(&language(state, request, &answers)?.language);
        replace(&folder.join(ANSWERS), json_text(&answers).as_bytes())?;
        answers
    };
    state.importer.import_again(folder);
    if request.expects_json {
        let all = QuestionnaireItem::all(&tasks).len();
        return Ok(WebResponse::json(&json!({ "answered": answered_count(&answers, &tasks, all), "all": all })));
    }
    render_form(state, request, true)
}

fn answered_count(answers: &Answers, tasks: &[u32], all: usize) -> usize {
    all - answers.open(tasks).len()
}
