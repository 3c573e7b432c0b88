//! The questionnaire: every answer is written to `answers.json` as soon as it comes.

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::sessions;
use super::state::{State, lock};
use crate::questionnaire::{stored, task_ids};
use crate::session_folder::{self, Stored};
use serde_json::json;
use spandrel_model::scenario::Scenario;
use spandrel_monitor::export::json_text;
use spandrel_training::questionnaire::{ANSWERS, Answers, Item, Wording};
use spandrel_training::web::form;

/// The form.
pub fn page(state: &State, asked: &Asked) -> Answered {
    shown(state, asked, false)
}

fn shown(state: &State, asked: &Asked, saved: bool) -> Answered {
    let id = asked.part("id");
    let folder = sessions::folder(state, asked, id)?;
    let scenario = Stored::scenario_of(&folder)?.scenario;
    let answers = stored(&folder, &scenario)?.unwrap_or_default();
    let wording = language(state, asked, &answers)?;
    let tasks = names(&scenario);
    let languages = state.languages.all();
    let about = form::Asked { id, tasks: &tasks, wording, languages, answers: &answers, saved };
    Ok(Answer::page(form::page(&asked.visitor, &about)))
}

/// The language asked for, that of the answers so far, or the one that the browser likes best.
fn language<'a>(state: &'a State, asked: &Asked, answers: &Answers) -> Result<&'a Wording, Refusal> {
    if let Some(tag) = asked.field("language").or_else(|| asked.word("language")) {
        return state
            .languages
            .of(tag)
            .ok_or_else(|| Refusal::Wrong(format!("language: not there (allowed: {})", names_of(state))));
    }
    let begun = state.languages.of(&answers.language).filter(|_| !answers.language.is_empty());
    Ok(begun.unwrap_or_else(|| state.languages.accepted(&asked.languages)))
}

fn names_of(state: &State) -> String {
    state.languages.all().iter().map(|wording| wording.language.as_str()).collect::<Vec<_>>().join(", ")
}

fn names(scenario: &Scenario) -> Vec<(u32, String)> {
    scenario.tasks.iter().map(|task| (task.id, task.name.clone())).collect()
}

/// Saves what a form brings.
pub fn save(state: &State, asked: &Asked) -> Answered {
    let id = asked.part("id");
    let folder = sessions::folder(state, asked, id)?;
    let scenario = Stored::scenario_of(&folder)?.scenario;
    let tasks = task_ids(&scenario);
    let answers = {
        let _others_wait = lock(&state.answers);
        let mut answers = stored(&folder, &scenario)?.unwrap_or_default();
        form::take(&mut answers, &asked.form, &tasks).map_err(|wrong| Refusal::Wrong(wrong.to_string()))?;
        answers.language.clone_from(&language(state, asked, &answers)?.language);
        session_folder::replace(&folder.join(ANSWERS), json_text(&answers).as_bytes())?;
        answers
    };
    state.taking_in.again(folder);
    if asked.by_script {
        let all = Item::all(&tasks).len();
        return Ok(Answer::json(&json!({ "answered": answered(&answers, &tasks, all), "all": all })));
    }
    shown(state, asked, true)
}

fn answered(answers: &Answers, tasks: &[u32], all: usize) -> usize {
    all - answers.open(tasks).len()
}
