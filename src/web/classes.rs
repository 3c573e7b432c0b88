//! Class pages.

use super::assignments::{class_url, jobs_of};
use super::plan_rules::rules_in_use;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use crate::io::clock;
use crate::io::trainee_id::is_plain_id;
use maud::Markup;
use spandrel_text::{Language, text};
use spandrel_training::assignment::{Assignment, AssignmentCounts};
use spandrel_training::plan::{PlanRules, plan_for_policy};
use spandrel_training::record::IncompletePolicy;
use spandrel_training::training_class::TrainingClass;
use spandrel_training::web::classes::{self as pages, ClassMember, ClassPage, MAX_NEW_MEMBERS};
use spandrel_training::web::rejected_form::RejectedForm;

/// Responds with the list of classes.
pub fn class_list(state: &ServerState, request: &WebRequest) -> HandlerResult {
    Ok(WebResponse::page(pages::class_list(&request.visitor, &state.database.classes()?, None)))
}

/// Creates a class. Shows the form again if its name is not possible.
pub fn create(state: &ServerState, request: &WebRequest) -> HandlerResult {
    match add_class(state, request) {
        Ok(name) => Ok(WebResponse::redirect(&class_url(name))),
        Err(error) => {
            let form = request.rejected("name", &error).ok_or_else(|| error.clone())?;
            let page = pages::class_list(&request.visitor, &state.database.classes()?, Some(&form));
            Ok(WebResponse::rejected_form(page))
        }
    }
}

/// Adds the class in the form, and returns its name.
fn add_class<'a>(state: &ServerState, request: &'a WebRequest) -> Result<&'a str, WebError> {
    let (language, name) = (request.visitor.language, request.required_field("name")?);
    if !is_plain_id(name) {
        let short: String = name.chars().take(60).collect();
        return Err(WebError::BadRequest(text!(language, "people-class-name", name = short)));
    }
    if !state.database.add_class(name)? {
        return Err(WebError::BadRequest(text!(language, "people-class-exists", name = name)));
    }
    Ok(name)
}

/// Responds with a class's page.
pub fn class_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    Ok(WebResponse::page(render_class(state, request, None)?))
}

fn render_class(state: &ServerState, request: &WebRequest, rejected: Option<RejectedForm<'_>>) -> Result<Markup, WebError> {
    let class = class(state, request)?;
    let (rules, _) = rules_in_use(state, request.visitor.language)?;
    let now = clock::unix_us();
    let members = class
        .members
        .iter()
        .map(|trainee| member(state, trainee, &rules, (now, request.visitor.language)))
        .collect::<Result<Vec<_>, _>>()?;
    let assignments: Vec<(Assignment, AssignmentCounts)> =
        state.database.assignments_of_class(&class.name)?.into_iter().map(|one| counted(one, &members)).collect();
    let about = ClassPage { name: &class.name, members: &members, assignments: &assignments, rejected };
    Ok(pages::class_page(&request.visitor, &about))
}

/// Returns the class named in the path.
fn class(state: &ServerState, request: &WebRequest) -> Result<TrainingClass, WebError> {
    let name = request.path_param("name");
    state.database.classes()?.into_iter().find(|class| class.name == name).ok_or(WebError::NotFound)
}

fn member(
    state: &ServerState,
    trainee: &str,
    rules: &PlanRules,
    (now_unix_us, language): (u64, Language),
) -> Result<ClassMember, WebError> {
    let records = state.database.records(Some(trainee))?;
    let jobs = jobs_of(state, trainee, &records, now_unix_us)?;
    let last = state.database.list(Some(trainee), 1, 0)?.pop();
    let plan = plan_for_policy(records, IncompletePolicy::Exclude, rules, now_unix_us, language);
    Ok(ClassMember { trainee: trainee.to_owned(), last, next: plan.and_then(|plan| plan.steps.into_iter().next()), jobs })
}

/// Counts the members by the state of an assignment.
fn counted(assignment: Assignment, members: &[ClassMember]) -> (Assignment, AssignmentCounts) {
    let mut counts = AssignmentCounts::default();
    let jobs = members.iter().flat_map(|member| &member.jobs);
    jobs.filter(|job| job.assignment.id == assignment.id).for_each(|job| counts.add(&job.state));
    (assignment, counts)
}

/// Adds trainees to a class. Shows the form again if a pseudonym is not possible.
pub fn add_members(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let name = request.path_param("name");
    match new_members(state, request) {
        Ok(trainees) if state.database.add_members(name, &trainees)? => Ok(WebResponse::redirect(&class_url(name))),
        Ok(_) => Err(WebError::NotFound),
        Err(error) => {
            let form = request.rejected("trainees", &error).ok_or_else(|| error.clone())?;
            Ok(WebResponse::rejected_form(render_class(state, request, Some(form))?))
        }
    }
}

/// Returns the pseudonyms in the form.
fn new_members(state: &ServerState, request: &WebRequest) -> Result<Vec<String>, WebError> {
    let given = request.required_field("trainees")?;
    let separated = given.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
    let trainees = separated.map(|word| Ok(request.trainee_id("trainees", word)?.as_str().to_owned()));
    let trainees: Vec<String> = trainees.collect::<Result<_, WebError>>()?;
    if !(1..=MAX_NEW_MEMBERS).contains(&trainees.len()) {
        let count = trainees.len();
        return Err(WebError::BadRequest(text!(
            request.visitor.language,
            "people-too-many-members",
            count = count,
            most = MAX_NEW_MEMBERS
        )));
    }
    reject_lookalikes(state, &trainees, request.visitor.language)?;
    Ok(trainees)
}

/// Rejects pseudonyms that differ from a known trainee's only in the case of letters: the instructor means that trainee.
fn reject_lookalikes(state: &ServerState, added: &[String], language: Language) -> Result<(), WebError> {
    let known: Vec<String> = state.database.trainees()?.into_iter().map(|trainee| trainee.pseudonym).collect();
    for new in added.iter().filter(|new| !known.contains(new)) {
        if let Some(other) = known.iter().find(|other| other.eq_ignore_ascii_case(new)) {
            let words = text!(language, "people-lookalike", name = new.as_str(), other = other.as_str());
            return Err(WebError::BadRequest(words));
        }
    }
    Ok(())
}

/// Removes a trainee from a class.
pub fn remove_member(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let name = request.path_param("name");
    if !state.database.remove_member(name, request.required_field("trainee")?)? {
        return Err(WebError::NotFound);
    }
    Ok(WebResponse::redirect(&class_url(name)))
}

/// Deletes a class.
pub fn remove(state: &ServerState, request: &WebRequest) -> HandlerResult {
    if state.database.remove_class(request.path_param("name"))? {
        Ok(WebResponse::redirect("/classes"))
    } else {
        Err(WebError::NotFound)
    }
}
