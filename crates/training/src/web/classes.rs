//! Class list and class page: members with their last session and next job, assignments, and the forms to change them.

use super::access::Visitor;
use super::assignments::{assign_link, class_assignments, pending_list};
use super::layout::{ELEMENT, page, section, table, token, with_element};
use super::rejected_form::{FormField, RejectedForm};
use crate::assignment::{AssignedJob, Assignment, AssignmentCounts};
use crate::plan::PlanStep;
use crate::record::{SessionListEntry, SessionOutcome};
use crate::training_class::TrainingClass;
use maud::{Markup, html};
use spandrel_model::calendar::minute;
use spandrel_text::{Language, text};

/// Maximum number of trainees that can be added at once.
pub const MAX_NEW_MEMBERS: usize = 100;

/// Renders the list of classes, and the form for a new one.
#[must_use]
pub fn class_list(visitor: &Visitor, classes: &[TrainingClass], rejected: Option<&RejectedForm<'_>>) -> Markup {
    let language = visitor.language;
    let rows = html! {
        @for class in classes {
            tr {
                th scope="row" { a href={ "/classes/" (class.name) } { (class.name) } }
                td.number { (class.members.len()) }
                td { (class.members.join(", ")) }
            }
        }
    };
    let heads = [
        (text!(language, "people-class"), false),
        (text!(language, "people-trainees"), true),
        (text!(language, "people-members"), false),
    ];
    let body = html! {
        section {
            @if classes.is_empty() { p.calm { (text!(language, "people-no-classes")) } }
            @else { (table(&text!(language, "people-class-count", count = classes.len()), &heads, &rows)) }
        }
        (section("new", &text!(language, "people-new-class"), &html! {
            (new_class_form(visitor, FormField::of(rejected, "name")))
        }))
    };
    page(visitor, "/classes", &text!(language, "people-classes"), &body)
}

fn new_class_form(visitor: &Visitor, name: FormField<'_>) -> Markup {
    let language = visitor.language;
    html! {
        form.stacked method="post" action="/classes" {
            (token(visitor))
            label { (text!(language, "people-name"))
                input name="name" value=[name.value] required maxlength="32" autocomplete="off" autocapitalize="none" placeholder="spring-2027" aria-invalid=[name.invalid()] aria-describedby=[name.described_by(None)];
            }
            (name.problem())
            p.note { (text!(language, "people-new-class-note")) }
            button type="submit" { (text!(language, "people-create-class")) }
        }
    }
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
    /// The form that adds trainees, if it was rejected.
    pub rejected: Option<RejectedForm<'a>>,
}

/// Renders a class's page.
#[must_use]
pub fn class_page(visitor: &Visitor, class: &ClassPage<'_>) -> Markup {
    let language = visitor.language;
    let body = html! {
        (section("members", &text!(language, "people-trainees"), &html! {
            @if class.members.is_empty() { p.calm { (text!(language, "people-no-members")) } } @else { (members(visitor, class)) }
        }))
        (section("assignments", &text!(language, "people-assignments"), &html! {
            @if class.assignments.is_empty() { p.calm { (text!(language, "people-no-class-jobs")) } } @else { (class_assignments(visitor, class.assignments)) }
            ul.actions { li { a.button href={ "/assign?class=" (class.name) } { (text!(language, "people-assign-to-class")) } } }
        }))
        (section("add", &text!(language, "people-add-trainees"), &html! {
            (add_members_form(visitor, class.name, FormField::of(class.rejected.as_ref(), "trainees")))
        }))
        (section("delete", &text!(language, "people-delete"), &html! {
            details {
                summary { (text!(language, "people-delete-this-class")) }
                form.stacked method="post" action={ "/classes/" (class.name) "/remove" } {
                    (token(visitor))
                    p { (text!(language, "people-delete-note")) }
                    button.danger type="submit" { (text!(language, "people-delete-class")) }
                }
            }
        }))
    };
    page(visitor, "/classes", &text!(language, "people-class-title", name = class.name), &body)
}

fn add_members_form(visitor: &Visitor, class: &str, trainees: FormField<'_>) -> Markup {
    let language = visitor.language;
    html! {
        form.stacked method="post" action={ "/classes/" (class) "/members" } {
            (token(visitor))
            label { (text!(language, "people-add-pseudonyms"))
                textarea name="trainees" rows="3" required autocapitalize="none" spellcheck="false" aria-invalid=[trainees.invalid()] aria-describedby=[trainees.described_by(None)] { (trainees.value.unwrap_or_default()) }
            }
            (trainees.problem())
            p.note { (text!(language, "people-add-note")) }
            button type="submit" { (text!(language, "people-add-button")) }
        }
    }
}

fn members(visitor: &Visitor, class: &ClassPage<'_>) -> Markup {
    let language = visitor.language;
    let heads = [
        (text!(language, "people-head-trainee"), false),
        (text!(language, "people-head-last"), false),
        (text!(language, "people-head-certified"), false),
        (text!(language, "people-head-next"), false),
        (text!(language, "people-head-open"), false),
        (text!(language, "people-head-change"), false),
    ];
    let rows = html! {
        @for member in class.members {
            tr {
                th scope="row" { a href={ "/trainees/" (member.trainee) } { (member.trainee) } }
                @match &member.last {
                    Some(last) => {
                        td.when { a href={ "/sessions/" (last.id) } { (minute(last.started_unix_us)) } br; (last.scenario) }
                        td { (last.verdict(language)) }
                    }
                    None => { td { (text!(language, "people-not-flown")) } td { "–" } }
                }
                td { @match &member.next { Some(step) => (next_step(language, &member.trainee, step)), None => "–" } }
                td { (pending_list(language, &member.jobs)) }
                td {
                    form method="post" action={ "/classes/" (class.name) "/members/remove" } {
                        (token(visitor))
                        input type="hidden" name="trainee" value=(member.trainee);
                        button type="submit" aria-label=(text!(language, "people-remove-member", name = member.trainee.as_str())) { (text!(language, "people-remove")) }
                    }
                }
            }
        }
    };
    table(&text!(language, "people-trainee-count", count = class.members.len()), &heads, &rows)
}

/// Renders a recommended job with a link that assigns it.
fn next_step(language: Language, trainee: &str, step: &PlanStep) -> Markup {
    let level = step.level.as_ref().map(|advice| advice.level.to_string());
    let job = html! { a href={ "/scenarios/" (step.scenario) } { (step.scenario) } };
    html! {
        @match &level {
            Some(level) => (with_element(&text!(language, "people-job-level", job = ELEMENT, level = level.as_str()), &job)),
            None => (job),
        }
        br;
        (assign_link(language, trainee, &step.scenario, level.as_deref()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use crate::assignment::{AssignmentState, AssignmentTarget};

    #[test]
    fn exact_class_pages_escape_names_and_show_pending_assignments() {
        let class = TrainingClass { name: HOSTILE_NAME.into(), members: vec![HOSTILE_NAME.into()] };
        let text = class_list(&administrator(), &[class], None).into_string();
        check(&text);
        assert!(text.contains("<caption>1 class</caption>"), "{text}");
        check(&class_list(&administrator(), &[], None).into_string());
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
        let page = ClassPage { name: HOSTILE_NAME, members: &members, assignments: &assignments, rejected: None };
        let text = class_page(&administrator(), &page).into_string();
        check(&text);
        assert_eq!(text.matches("not flown yet").count(), 2);
        let overdue = text.matches("class=\"due overdue\"").count();
        assert_eq!(overdue, 1, "only the pending assignment of the first member: {text}");
        check(&class_page(&administrator(), &ClassPage { members: &[], assignments: &[], ..page }).into_string());
    }

    #[test]
    fn regress_rejected_class_forms_keep_what_was_entered() {
        let entered = [("name".to_owned(), "spring 2027".to_owned()), ("trainees".to_owned(), "anna, b/c".to_owned())];
        let form = |field| RejectedForm { entered: &entered, field, problem: "invalid" };
        let text = class_list(&administrator(), &[], Some(&form("name"))).into_string();
        assert!(text.contains("name=\"name\" value=\"spring 2027\"") && text.contains("aria-invalid=\"true\""), "{text}");
        assert!(text.contains("aria-describedby=\"name-problem\"") && text.contains("id=\"name-problem\""), "{text}");
        let page = ClassPage { name: "autumn", members: &[], assignments: &[], rejected: Some(form("trainees")) };
        let text = class_page(&administrator(), &page).into_string();
        assert!(text.contains("aria-describedby=\"trainees-problem\">anna, b/c</textarea>"), "{text}");
        assert!(text.contains("id=\"trainees-problem\" role=\"alert\">invalid</p>"), "{text}");
    }

    #[test]
    fn exact_class_pages_are_translated() {
        let visitor = administrator_with(Language::Pseudo);
        let class = TrainingClass { name: "7".into(), members: vec!["8".into()] };
        check_translated(&class_list(&visitor, &[class], None).into_string(), &["spring"]);
        check_translated(&class_list(&visitor, &[], None).into_string(), &["spring"]);
        let step = PlanStep { scenario: "9".into(), urgency: 0.0, reasons: Vec::new(), level: None };
        let members = [ClassMember { trainee: "8".into(), last: None, next: Some(step), jobs: Vec::new() }];
        let page = ClassPage { name: "7", members: &members, assignments: &[], rejected: None };
        check_translated(&class_page(&visitor, &page).into_string(), &[]);
        check_translated(&class_page(&visitor, &ClassPage { members: &[], ..page }).into_string(), &[]);
        let german = class_page(&administrator_with(Language::German), &page).into_string();
        assert!(german.contains("<h1>Klasse 7</h1>") && german.contains("<caption>1 Trainee</caption>"), "{german}");
    }
}
