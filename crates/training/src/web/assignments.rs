//! Assignments on the pages of trainees and classes, and the page that assigns a job.

use super::access::{AccessLevel, Visitor};
use super::layout::{counted, page, table, token};
use crate::assignment::{AssignedJob, Assignment, AssignmentCounts, AssignmentState, AssignmentTarget};
use maud::{Markup, html};
use spandrel_model::calendar::day;
use spandrel_text::Language;

/// Renders a trainee's assignments: the pending ones, then the others in a section that opens.
#[must_use]
pub fn trainee_assignments(visitor: &Visitor, trainee: &str, jobs: &[AssignedJob]) -> Markup {
    let (pending, done): (Vec<&AssignedJob>, Vec<&AssignedJob>) = jobs.iter().partition(|job| job.state.is_pending());
    html! {
        @if pending.is_empty() { p.calm { "No open assignments." } }
        @else { (job_table(visitor, trainee, &counted(pending.len(), "open assignment", "open assignments"), &pending)) }
        @if !done.is_empty() {
            details { summary { "Done (" (done.len()) ")" } (job_table(visitor, trainee, "Finished assignments", &done)) }
        }
        @if visitor.satisfies(AccessLevel::Instructor) {
            ul.actions { li { a.button href={ "/assign?trainee=" (trainee) } { "Assign a job to " (trainee) } } }
        }
    }
}

fn job_table(visitor: &Visitor, trainee: &str, caption: &str, jobs: &[&AssignedJob]) -> Markup {
    let instructor = visitor.satisfies(AccessLevel::Instructor);
    let mut heads = vec![("Job", false), ("Due", false), ("State", false), ("Assigned to", false), ("To fly it", false)];
    if instructor {
        heads.push(("Change", false));
    }
    let rows = html! {
        @for job in jobs {
            @let assignment = &job.assignment;
            tr {
                th scope="row" { (job_name(assignment)) }
                td { (day(assignment.due_unix_us)) }
                td { (state(&job.state)) }
                td { (target(visitor, assignment)) @if !assignment.assigned_by.is_empty() { ", by " (assignment.assigned_by) } }
                td { @if job.state.is_pending() { code { (assignment.command(trainee)) } } @else { "–" } }
                @if instructor { td { (remove(visitor, assignment)) } }
            }
        }
    };
    table(caption, &heads, &rows)
}

/// Renders the scenario with a link, and the form or level.
fn job_name(assignment: &Assignment) -> Markup {
    html! {
        a href={ "/scenarios/" (assignment.scenario) } { (assignment.scenario) }
        @if let Some(variant) = &assignment.variant { (variant_words(variant)) }
    }
}

/// Describes a form or level: levels are numbers.
fn variant_words(variant: &str) -> String {
    if variant.bytes().all(|byte| byte.is_ascii_digit()) {
        format!(", level {variant} or harder")
    } else {
        format!(", form {variant}")
    }
}

fn state(state: &AssignmentState) -> Markup {
    html! {
        @match state {
            AssignmentState::Open => (state.words(Language::English)),
            AssignmentState::Overdue => b.due.overdue { (state.words(Language::English)) },
            AssignmentState::Done { session, .. } => a href={ "/sessions/" (session) } { (state.words(Language::English)) },
        }
    }
}

fn target(visitor: &Visitor, assignment: &Assignment) -> Markup {
    html! {
        @match &assignment.target {
            AssignmentTarget::Trainee(name) => (name),
            AssignmentTarget::Class(name) => {
                @if visitor.satisfies(AccessLevel::Instructor) { a href={ "/classes/" (name) } { "class " (name) } } @else { "class " (name) }
            }
        }
    }
}

fn remove(visitor: &Visitor, assignment: &Assignment) -> Markup {
    html! {
        form method="post" action={ "/assignments/" (assignment.id) "/remove" } {
            (token(visitor))
            button type="submit" aria-label={ "Remove assignment " (assignment.job()) } { "Remove" }
        }
    }
}

/// Renders a trainee's pending assignments as a short list.
pub(super) fn pending_list(jobs: &[AssignedJob]) -> Markup {
    let pending: Vec<&AssignedJob> = jobs.iter().filter(|job| job.state.is_pending()).collect();
    html! {
        @if pending.is_empty() { "none" }
        @for job in pending {
            div { (job.assignment.job()) ", "
                @match job.state {
                    AssignmentState::Overdue => b class="due overdue" { "overdue since " (day(job.assignment.due_unix_us)) },
                    AssignmentState::Open | AssignmentState::Done { .. } => { "due " (day(job.assignment.due_unix_us)) }
                }
            }
        }
    }
}

/// Renders a class's assignments with the number of trainees by state.
pub(super) fn class_assignments(visitor: &Visitor, assignments: &[(Assignment, AssignmentCounts)]) -> Markup {
    let heads = [("Job", false), ("Due", false), ("Done", true), ("Open", true), ("Overdue", true), ("Change", false)];
    let rows = html! {
        @for (assignment, counts) in assignments {
            tr {
                th scope="row" { (job_name(assignment)) }
                td { (day(assignment.due_unix_us)) }
                td.number { (counts.done) }
                td.number { (counts.open) }
                td.number { (counts.overdue) }
                td { (remove(visitor, assignment)) }
            }
        }
    };
    table(&counted(assignments.len(), "assignment", "assignments"), &heads, &rows)
}

/// Renders a link that opens the page for assigning this job to a trainee.
pub(super) fn assign_link(trainee: &str, scenario: &str, variant: Option<&str>) -> Markup {
    let mut query = form_urlencoded::Serializer::new(String::new());
    query.append_pair("trainee", trainee).append_pair("scenario", scenario);
    if let Some(variant) = variant {
        query.append_pair("variant", variant);
    }
    let label = format!("Assign {scenario} to {trainee}");
    html! { a href={ "/assign?" (query.finish()) } aria-label=(label) { "Assign" } }
}

/// A job that can be assigned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobChoice {
    /// Machine-readable scenario name.
    pub name: String,
    /// Names of its forms or levels, in order; empty if it has neither.
    pub variants: Vec<String>,
}

impl JobChoice {
    /// Returns the name with the forms or levels, such as `drill-gap (levels 1 to 9)`.
    fn label(&self) -> String {
        let is_level = |variant: &String| variant.bytes().all(|byte| byte.is_ascii_digit());
        match (self.variants.first(), self.variants.last()) {
            (Some(first), Some(last)) if self.variants.iter().all(is_level) => {
                format!("{} (levels {first} to {last})", self.name)
            }
            (Some(_), Some(_)) => format!("{} (forms {})", self.name, self.variants.join(", ")),
            (_, _) => self.name.clone(),
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
}

/// Renders the page that assigns a job.
#[must_use]
pub fn assign_page(visitor: &Visitor, about: &AssignPage<'_>) -> Markup {
    let (kind, name, at) = match about.target {
        AssignmentTarget::Trainee(name) => ("trainee", name, "/trainees"),
        AssignmentTarget::Class(name) => ("class", name, "/classes"),
    };
    let body = html! {
        section {
            p { "The assignment is done after the first complete flight of the job that starts after you assign it." }
            form.stacked method="post" action="/assign" {
                (token(visitor))
                input type="hidden" name=(kind) value=(name);
                label { "Job"
                    select name="scenario" required {
                        @for job in about.jobs { option value=(job.name) selected[about.scenario == Some(job.name.as_str())] { (job.label()) } }
                    }
                }
                label { "Level or form (optional)" input name="variant" value=[about.variant] maxlength="8" autocomplete="off" aria-describedby="variant-note"; }
                p.note id="variant-note" { "A harder level counts as well. Without a level or form, any counts." }
                label { "Due (end of the day, UTC)" input type="date" name="due" required min=(about.due.1) value=(about.due.0); }
                button type="submit" { "Assign" }
            }
        }
    };
    page(visitor, at, &format!("Assign a job to {kind} {name}"), &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
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
        };
        let text = assign_page(&administrator(), &about).into_string();
        check(&text);
        assert!(text.contains("(levels 1 to 3)") && text.contains("(forms A, B, H)"), "{text}");
        assert!(text.contains("min=\"2026-11-25\" value=\"2026-12-02\""), "{text}");
        assert!(
            assign_link("anna", "drill-gap", Some("6"))
                .into_string()
                .contains("trainee=anna&amp;scenario=drill-gap&amp;variant=6")
        );
    }
}
