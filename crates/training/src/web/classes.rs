//! Class list and class page: members with their last session and next job, assignments, and the forms to change them.

use super::access::Visitor;
use super::assignments::{assign_link, class_assignments, pending_list};
use super::layout::{counted, page, section, table, token};
use crate::assignment::{AssignedJob, Assignment, AssignmentCounts};
use crate::plan::PlanStep;
use crate::record::{SessionListEntry, SessionOutcome};
use crate::training_class::TrainingClass;
use maud::{Markup, html};
use spandrel_model::calendar::minute;
use spandrel_text::Language;

/// Maximum number of trainees that can be added at once.
pub const MAX_NEW_MEMBERS: usize = 100;

/// Renders the list of classes.
#[must_use]
pub fn class_list(visitor: &Visitor, classes: &[TrainingClass]) -> Markup {
    let rows = html! {
        @for class in classes {
            tr {
                th scope="row" { a href={ "/classes/" (class.name) } { (class.name) } }
                td.number { (class.members.len()) }
                td { (class.members.join(", ")) }
            }
        }
    };
    let body = html! {
        section {
            @if classes.is_empty() { p.calm { "No classes yet." } }
            @else { (table(&counted(classes.len(), "class", "classes"), &[("Class", false), ("Trainees", true), ("Members", false)], &rows)) }
        }
        (section("new", "New class", &html! {
            form.stacked method="post" action="/classes" {
                (token(visitor))
                label { "Name" input name="name" required maxlength="32" autocomplete="off" autocapitalize="none" placeholder="spring-2027"; }
                p.note { "Letters, digits, - and _. A trainee may be in several classes." }
                button type="submit" { "Create class" }
            }
        }))
    };
    page(visitor, "/classes", "Classes", &body)
}

/// A member of a class.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassMember {
    /// The trainee's pseudonym.
    pub trainee: String,
    /// Latest session; `None` before the first flight.
    pub last: Option<SessionListEntry>,
    /// First step of the trainee's training plan; `None` before the first flight.
    pub next: Option<PlanStep>,
    /// The trainee's assignments, including individual ones and those of other classes.
    pub jobs: Vec<AssignedJob>,
}

/// Contents of a class's page.
#[derive(Debug, Clone, Copy)]
pub struct ClassPage<'a> {
    /// Name of the class.
    pub name: &'a str,
    /// Members in alphabetical order.
    pub members: &'a [ClassMember],
    /// The class's assignments, with the number of members by state.
    pub assignments: &'a [(Assignment, AssignmentCounts)],
}

/// Renders a class's page.
#[must_use]
pub fn class_page(visitor: &Visitor, class: &ClassPage<'_>) -> Markup {
    let body = html! {
        (section("members", "Trainees", &html! {
            @if class.members.is_empty() { p.calm { "No trainees in this class yet." } } @else { (members(visitor, class)) }
        }))
        (section("assignments", "Assignments", &html! {
            @if class.assignments.is_empty() { p.calm { "No jobs assigned to this class." } } @else { (class_assignments(visitor, class.assignments)) }
            ul.actions { li { a.button href={ "/assign?class=" (class.name) } { "Assign a job to this class" } } }
        }))
        (section("add", "Add trainees", &html! {
            form.stacked method="post" action={ "/classes/" (class.name) "/members" } {
                (token(visitor))
                label { "Pseudonyms, separated by spaces or commas" textarea name="trainees" rows="3" required autocapitalize="none" spellcheck="false" {} }
                p.note { "You can add trainees before their first flight." }
                button type="submit" { "Add to class" }
            }
        }))
        (section("delete", "Delete", &html! {
            details {
                summary { "Delete this class" }
                form.stacked method="post" action={ "/classes/" (class.name) "/remove" } {
                    (token(visitor))
                    p { "This deletes the class and its assignments. The trainees and their sessions remain." }
                    button.danger type="submit" { "Delete class" }
                }
            }
        }))
    };
    page(visitor, "/classes", &format!("Class {}", class.name), &body)
}

fn members(visitor: &Visitor, class: &ClassPage<'_>) -> Markup {
    let heads = [
        ("Trainee", false),
        ("Last session", false),
        ("Certified", false),
        ("Recommended next", false),
        ("Open assignments", false),
        ("Change", false),
    ];
    let rows = html! {
        @for member in class.members {
            tr {
                th scope="row" { a href={ "/trainees/" (member.trainee) } { (member.trainee) } }
                @match &member.last {
                    Some(last) => {
                        td.when { a href={ "/sessions/" (last.id) } { (minute(last.started_unix_us)) } br; (last.scenario) }
                        td { (last.verdict(Language::English)) }
                    }
                    None => { td { "not flown yet" } td { "–" } }
                }
                td { @match &member.next { Some(step) => (next_step(&member.trainee, step)), None => "–" } }
                td { (pending_list(&member.jobs)) }
                td {
                    form method="post" action={ "/classes/" (class.name) "/members/remove" } {
                        (token(visitor))
                        input type="hidden" name="trainee" value=(member.trainee);
                        button type="submit" aria-label={ "Remove " (member.trainee) " from this class" } { "Remove" }
                    }
                }
            }
        }
    };
    table(&counted(class.members.len(), "trainee", "trainees"), &heads, &rows)
}

/// Renders a recommended job with a link that assigns it.
fn next_step(trainee: &str, step: &PlanStep) -> Markup {
    let level = step.level.as_ref().map(|advice| advice.level.to_string());
    html! {
        a href={ "/scenarios/" (step.scenario) } { (step.scenario) } @if let Some(level) = &level { ", level " (level) } br;
        (assign_link(trainee, &step.scenario, level.as_deref()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::assignment::{AssignmentState, AssignmentTarget};

    #[test]
    fn exact_class_pages_escape_names_and_show_pending_assignments() {
        let class = TrainingClass { name: HOSTILE_NAME.into(), members: vec![HOSTILE_NAME.into()] };
        let text = class_list(&administrator(), &[class]).into_string();
        check(&text);
        assert!(text.contains("<caption>1 class</caption>"), "{text}");
        check(&class_list(&administrator(), &[]).into_string());
        let assignment = Assignment {
            id: "a1".into(),
            target: AssignmentTarget::Class(HOSTILE_NAME.into()),
            scenario: HOSTILE_NAME.into(),
            variant: Some(HOSTILE_NAME.into()),
            assigned_unix_us: 0,
            due_unix_us: 0,
            assigned_by: HOSTILE_NAME.into(),
        };
        let step = PlanStep { scenario: HOSTILE_NAME.into(), urgency: 0.0, reasons: Vec::new(), level: None };
        let job = |state| AssignedJob { assignment: assignment.clone(), state };
        let finished = AssignmentState::Done { session: HOSTILE_NAME.into(), late: false };
        let jobs = vec![job(AssignmentState::Overdue), job(finished)];
        let member = |jobs, next| ClassMember { trainee: HOSTILE_NAME.into(), last: None, next, jobs };
        let members = [member(jobs, Some(step)), member(Vec::new(), None)];
        let assignments = [(assignment.clone(), AssignmentCounts { done: 0, open: 0, overdue: 1 })];
        let page = ClassPage { name: HOSTILE_NAME, members: &members, assignments: &assignments };
        let text = class_page(&administrator(), &page).into_string();
        check(&text);
        assert_eq!(text.matches("not flown yet").count(), 2);
        let overdue = text.matches("class=\"due overdue\"").count();
        assert_eq!(overdue, 1, "only the pending assignment of the first member: {text}");
        check(&class_page(&administrator(), &ClassPage { members: &[], assignments: &[], ..page }).into_string());
    }
}
