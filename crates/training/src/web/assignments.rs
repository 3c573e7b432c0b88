//! Assignments on the pages of trainees and classes, and the page that assigns a job.

use super::access::{AccessLevel, Visitor};
use super::layout::{ELEMENT, page, table, token, with_element};
use super::rejected_form::{FormField, RejectedForm};
use crate::assignment::{AssignedJob, Assignment, AssignmentCounts, AssignmentState, AssignmentTarget};
use crate::terms::job_title;
use maud::{Markup, html};
use spandrel_model::calendar::day;
use spandrel_text::{Language, text};

/// Renders a trainee's assignments: the pending ones, then the others in a section that opens.
#[must_use]
pub fn trainee_assignments(visitor: &Visitor, trainee: &str, jobs: &[AssignedJob]) -> Markup {
    let language = visitor.language;
    let (pending, done): (Vec<&AssignedJob>, Vec<&AssignedJob>) = jobs.iter().partition(|job| job.state.is_pending());
    html! {
        @if pending.is_empty() { p.calm { (text!(language, "people-no-open")) } }
        @else { (job_table(visitor, trainee, &text!(language, "people-open-count", count = pending.len()), &pending)) }
        @if !done.is_empty() {
            details { summary { (text!(language, "people-done-count", count = done.len())) } (job_table(visitor, trainee, &text!(language, "people-finished"), &done)) }
        }
        @if visitor.satisfies(AccessLevel::Instructor) {
            ul.actions { li { a.button href={ "/assign?trainee=" (trainee) } { (text!(language, "people-assign-to", name = trainee)) } } }
        }
    }
}

fn job_table(visitor: &Visitor, trainee: &str, caption: &str, jobs: &[&AssignedJob]) -> Markup {
    let (language, instructor) = (visitor.language, visitor.satisfies(AccessLevel::Instructor));
    let mut heads = vec![
        (text!(language, "people-job"), false),
        (text!(language, "people-due"), false),
        (text!(language, "people-state"), false),
        (text!(language, "people-assigned-to"), false),
        (text!(language, "people-to-fly"), false),
    ];
    if instructor {
        heads.push((text!(language, "people-change"), false));
    }
    let rows = html! {
        @for job in jobs {
            @let assignment = &job.assignment;
            tr {
                th scope="row" { (job_name(language, assignment)) }
                td { (day(assignment.due_unix_us)) }
                td { (state(language, &job.state)) }
                td { (target(visitor, assignment)) }
                td { @if !job.state.is_pending() { "–" } @else if instructor { code { (assignment.command(trainee)) } } @else { (how_to_fly(language, assignment)) } }
                @if instructor { td { (remove(visitor, assignment)) } }
            }
        }
    };
    table(caption, &heads, &rows)
}

/// Describes how the trainee flies an assigned job: by a row of the window's start page.
fn how_to_fly(language: Language, assignment: &Assignment) -> String {
    let (date, job) = (day(assignment.due_unix_us), job_title(&assignment.scenario, language));
    text!(language, "job-how-to-fly-assigned", row = text!(language, "window-start-assigned", date = date, job = job))
}

/// Renders the scenario with a link, and the form or level.
fn job_name(language: Language, assignment: &Assignment) -> Markup {
    let job = html! { a href={ "/scenarios/" (assignment.scenario) } { (assignment.scenario) } };
    match assignment.variant.as_deref() {
        // Levels are numbers.
        Some(level) if level.bytes().all(|byte| byte.is_ascii_digit()) => {
            with_element(&text!(language, "people-job-level-or-harder", job = ELEMENT, level = level), &job)
        }
        Some(form) => with_element(&text!(language, "people-job-form", job = ELEMENT, form = form), &job),
        None => job,
    }
}

fn state(language: Language, state: &AssignmentState) -> Markup {
    html! {
        @match state {
            AssignmentState::Open => (state.words(language)),
            AssignmentState::Overdue => b.due.overdue { (state.words(language)) },
            AssignmentState::Done { session, .. } => a href={ "/sessions/" (session) } { (state.words(language)) },
        }
    }
}

/// Renders for whom the assignment is, and who assigned it.
fn target(visitor: &Visitor, assignment: &Assignment) -> Markup {
    let language = visitor.language;
    let target = match &assignment.target {
        AssignmentTarget::Trainee(name) => html! { (name) },
        AssignmentTarget::Class(name) => {
            let words = text!(language, "people-target-class", name = name.as_str());
            html! { @if visitor.satisfies(AccessLevel::Instructor) { a href={ "/classes/" (name) } { (words) } } @else { (words) } }
        }
    };
    match assignment.assigned_by.as_str() {
        "" => target,
        by => with_element(&text!(language, "people-assigned-by", target = ELEMENT, instructor = by), &target),
    }
}

fn remove(visitor: &Visitor, assignment: &Assignment) -> Markup {
    html! {
        form method="post" action={ "/assignments/" (assignment.id) "/remove" } {
            (token(visitor))
            button type="submit" aria-label=(text!(visitor.language, "people-remove-assignment", job = assignment.job())) { (text!(visitor.language, "people-remove")) }
        }
    }
}

/// Renders a trainee's pending assignments as a short list.
pub(super) fn pending_list(language: Language, jobs: &[AssignedJob]) -> Markup {
    let pending: Vec<&AssignedJob> = jobs.iter().filter(|job| job.state.is_pending()).collect();
    html! {
        @if pending.is_empty() { (text!(language, "people-none")) }
        @for job in pending {
            div { (job.assignment.job()) ", "
                @match job.state {
                    AssignmentState::Overdue => b class="due overdue" { (text!(language, "people-overdue-since", day = day(job.assignment.due_unix_us))) },
                    AssignmentState::Open | AssignmentState::Done { .. } => (text!(language, "people-due-on", day = day(job.assignment.due_unix_us))),
                }
            }
        }
    }
}

/// Renders a class's assignments with the number of trainees by state.
pub(super) fn class_assignments(visitor: &Visitor, assignments: &[(Assignment, AssignmentCounts)]) -> Markup {
    let language = visitor.language;
    let heads = [
        (text!(language, "people-job"), false),
        (text!(language, "people-due"), false),
        (text!(language, "people-done"), true),
        (text!(language, "people-open"), true),
        (text!(language, "people-overdue"), true),
        (text!(language, "people-change"), false),
    ];
    let rows = html! {
        @for (assignment, counts) in assignments {
            tr {
                th scope="row" { (job_name(language, assignment)) }
                td { (day(assignment.due_unix_us)) }
                td.number { (counts.done) }
                td.number { (counts.open) }
                td.number { (counts.overdue) }
                td { (remove(visitor, assignment)) }
            }
        }
    };
    table(&text!(language, "people-assignment-count", count = assignments.len()), &heads, &rows)
}

/// Renders a link that opens the page for assigning this job to a trainee.
pub(super) fn assign_link(language: Language, trainee: &str, scenario: &str, variant: Option<&str>) -> Markup {
    let mut query = form_urlencoded::Serializer::new(String::new());
    query.append_pair("trainee", trainee).append_pair("scenario", scenario);
    if let Some(variant) = variant {
        query.append_pair("variant", variant);
    }
    let label = text!(language, "people-assign-job-to", job = scenario, name = trainee);
    html! { a href={ "/assign?" (query.finish()) } aria-label=(label) { (text!(language, "people-assign")) } }
}

/// A job that can be assigned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobChoice {
    /// Machine-readable scenario name.
    pub name: String,
    /// Title in the language of the page.
    pub title: String,
    /// Names of its forms or levels, in order; empty if it has neither.
    pub variants: Vec<String>,
}

impl JobChoice {
    /// Returns name and title with the forms or levels, such as `drill-gap: Drill: gap (levels 1 to 9)`.
    fn label(&self, language: Language) -> String {
        let job = format!("{}: {}", self.name, self.title);
        let is_level = |variant: &String| variant.bytes().all(|byte| byte.is_ascii_digit());
        match (self.variants.first(), self.variants.last()) {
            (Some(first), Some(last)) if self.variants.iter().all(is_level) => {
                text!(language, "people-choice-levels", job = job, first = first.as_str(), last = last.as_str())
            }
            (Some(_), Some(_)) => text!(language, "people-choice-forms", job = job, forms = self.variants.join(", ")),
            (_, _) => job,
        }
    }
}

/// Contents of the page that assigns a job.
#[derive(Debug, Clone, Copy)]
pub struct AssignPage<'a> {
    /// Trainee or class.
    pub target: &'a AssignmentTarget,
    /// Jobs to choose from.
    pub jobs: &'a [JobChoice],
    /// Job that is selected first.
    pub scenario: Option<&'a str>,
    /// Form or level that is entered first.
    pub variant: Option<&'a str>,
    /// Due date that is entered first, and the earliest one allowed, as `YYYY-MM-DD`.
    pub due: (&'a str, &'a str),
    /// The form, if it was rejected. Its values replace the others.
    pub rejected: Option<RejectedForm<'a>>,
}

/// Renders the page that assigns a job.
#[must_use]
pub fn assign_page(visitor: &Visitor, about: &AssignPage<'_>) -> Markup {
    let language = visitor.language;
    let (kind, name, at) = match about.target {
        AssignmentTarget::Trainee(name) => ("trainee", name.as_str(), "/trainees"),
        AssignmentTarget::Class(name) => ("class", name.as_str(), "/classes"),
    };
    let title = match about.target {
        AssignmentTarget::Trainee(_) => text!(language, "people-assign-title-trainee", name = name),
        AssignmentTarget::Class(_) => text!(language, "people-assign-title-class", name = name),
    };
    let body = html! {
        section {
            p { (text!(language, "people-assign-note")) }
            form.stacked method="post" action="/assign" {
                (token(visitor))
                input type="hidden" name=(kind) value=(name);
                (assign_fields(language, about))
                button type="submit" { (text!(language, "people-assign")) }
            }
        }
    };
    page(visitor, at, &title, &body)
}

fn assign_fields(language: Language, about: &AssignPage<'_>) -> Markup {
    let [scenario, variant, due] = ["scenario", "variant", "due"].map(|name| FormField::of(about.rejected.as_ref(), name));
    let selected = scenario.value.or(about.scenario);
    html! {
        label { (text!(language, "people-job"))
            select name="scenario" required aria-invalid=[scenario.invalid()] aria-describedby=[scenario.described_by(None)] {
                @for job in about.jobs { option value=(job.name) selected[selected == Some(job.name.as_str())] { (job.label(language)) } }
            }
        }
        (scenario.problem())
        label { (text!(language, "people-assign-variant")) input name="variant" value=[variant.value.or(about.variant)] maxlength="8" autocomplete="off" aria-invalid=[variant.invalid()] aria-describedby=[variant.described_by(Some("variant-note"))]; }
        (variant.problem())
        p.note id="variant-note" { (text!(language, "people-assign-variant-note")) }
        label { (text!(language, "people-assign-due")) input type="date" name="due" required min=(about.due.1) value=(due.value.unwrap_or(about.due.0)) aria-invalid=[due.invalid()] aria-describedby=[due.described_by(None)]; }
        (due.problem())
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use crate::trainee::Role;

    fn job(variant: Option<&str>, state: AssignmentState) -> AssignedJob {
        let assignment = Assignment {
            id: "a1".into(),
            target: AssignmentTarget::Class(HOSTILE_NAME.into()),
            scenario: HOSTILE_NAME.into(),
            variant: variant.map(str::to_owned),
            assigned_unix_us: 0,
            due_unix_us: 1_700_000_000_000_000,
            assigned_by: HOSTILE_NAME.into(),
        };
        AssignedJob { assignment, state }
    }

    #[test]
    fn exact_only_instructors_can_change_assignments() {
        let done = AssignmentState::Done { session: HOSTILE_NAME.into(), late: true };
        let jobs = [job(Some("6"), AssignmentState::Overdue), job(Some("B"), AssignmentState::Open), job(None, done)];
        let text = trainee_assignments(&administrator(), HOSTILE_NAME, &jobs).into_string();
        check(&text);
        assert!(text.contains("level 6 or harder") && text.contains("form B") && text.contains("done late"), "{text}");
        assert!(text.contains("2 open assignments") && text.contains("Done (1)") && text.contains("2023-11-14"), "{text}");
        assert_eq!(text.matches("/assignments/a1/remove").count(), 3);
        let trainee = Visitor { role: Role::Trainee, ..administrator() };
        let text = trainee_assignments(&trainee, "anna", &jobs).into_string();
        check(&text);
        assert!(!text.contains("<form") && !text.contains("/assign?") && !text.contains("/classes/"), "{text}");
        assert!(trainee_assignments(&trainee, "anna", &[]).into_string().contains("No open assignments"));
    }

    #[test]
    fn exact_assign_page_lists_forms_and_levels() {
        let choice = |variants: &[&str]| JobChoice {
            name: HOSTILE_NAME.into(),
            title: "A title".into(),
            variants: variants.iter().map(|name| (*name).to_owned()).collect(),
        };
        let jobs = [choice(&["1", "2", "3"]), choice(&["A", "B", "H"]), choice(&[])];
        let target = AssignmentTarget::Class(HOSTILE_NAME.into());
        let about = AssignPage {
            target: &target,
            jobs: &jobs,
            scenario: Some(HOSTILE_NAME),
            variant: Some(HOSTILE_NAME),
            due: ("2026-12-02", "2026-11-25"),
            rejected: None,
        };
        let text = assign_page(&administrator(), &about).into_string();
        check(&text);
        assert!(text.contains("(levels 1 to 3)") && text.contains("(forms A, B, H)"), "{text}");
        assert!(text.contains("min=\"2026-11-25\" value=\"2026-12-02\""), "{text}");
        assert!(
            assign_link(Language::English, "anna", "drill-gap", Some("6"))
                .into_string()
                .contains("trainee=anna&amp;scenario=drill-gap&amp;variant=6")
        );
    }

    #[test]
    fn regress_a_rejected_assignment_keeps_what_was_entered() {
        let jobs =
            ["drill-gap", "two-bridges"].map(|name| JobChoice { name: name.into(), title: name.into(), variants: Vec::new() });
        let target = AssignmentTarget::Trainee("anna".into());
        let entered = [("scenario", "two-bridges"), ("variant", "99"), ("due", "2026-12-24")];
        let entered = entered.map(|(name, value)| (name.to_owned(), value.to_owned()));
        let rejected = Some(RejectedForm { entered: &entered, field: "variant", problem: "unknown level" });
        let due = ("2026-12-02", "2026-11-25");
        let about = AssignPage { target: &target, jobs: &jobs, scenario: None, variant: None, due, rejected };
        let text = assign_page(&administrator(), &about).into_string();
        assert!(text.contains("<option value=\"two-bridges\" selected>"), "{text}");
        assert!(text.contains("value=\"2026-12-24\"") && text.contains("name=\"variant\" value=\"99\""), "{text}");
        assert!(text.contains("aria-invalid=\"true\" aria-describedby=\"variant-problem variant-note\""), "{text}");
        assert_eq!(text.matches("unknown level").count(), 1);
    }

    #[test]
    fn exact_assignments_are_translated() {
        let done = |late| AssignmentState::Done { session: "7".into(), late };
        let states = [AssignmentState::Overdue, AssignmentState::Open, done(false), done(true)];
        let jobs: Vec<AssignedJob> =
            states.into_iter().zip(["6", "B", "6", "6"]).map(|(state, form)| job(Some(form), state)).collect();
        let visitor = administrator_with(Language::Pseudo);
        let names = ["script", "alert", "train", "two", "spandrel"];
        let text = trainee_assignments(&visitor, "7", &jobs).into_string();
        check_translated(&text.replace(&maud::html! { (HOSTILE_NAME) }.into_string(), "7"), &names);
        let (target, choice) = (
            AssignmentTarget::Trainee("7".into()),
            JobChoice { name: "8".into(), title: "8".into(), variants: vec!["1".into()] },
        );
        let due = ("2026-12-02", "2026-11-25");
        let about = AssignPage { target: &target, jobs: &[choice], scenario: None, variant: None, due, rejected: None };
        check_translated(&assign_page(&visitor, &about).into_string(), &[]);
        let german = assign_page(&administrator_with(Language::German), &about).into_string();
        assert!(german.contains("Trainee 7 einen Auftrag zuweisen") && german.contains("8 (Stufen 1 bis 1)"), "{german}");
    }
}
