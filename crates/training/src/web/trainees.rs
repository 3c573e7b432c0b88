//! Trainee list and trainee page: progress, plan, details, export and erasure.

use super::access::{AccessLevel, Visitor};
use super::assignments::trainee_assignments;
use super::layout::{page, section, table, token};
use super::sessions::lines;
use crate::assignment::AssignedJob;
use crate::cohort::{JobReliability, MeasureReliability, by_job, reliability_of};
use crate::plan::{MeasureChange, TrainingPlan};
use crate::record::{IncompletePolicy, SessionListEntry, SessionOutcome, SessionRecord, excluded_sessions_note};
use crate::report::formatting;
use crate::report::page::progress::job_progress;
use crate::report::page::within_error;
use crate::trainee::{AGE_BANDS, EXPERIENCE_LEVELS, Trainee};
use maud::{Markup, html};
use spandrel_model::calendar::minute;
use spandrel_text::Language;

/// Prefix of the fields that contain the values from when the page was opened, used to detect conflicting edits.
pub const ORIGINAL_VALUE_PREFIX: &str = "before_";

/// Renders the list of trainees.
#[must_use]
pub fn trainee_list(visitor: &Visitor, people: &[Trainee]) -> Markup {
    let rows = html! {
        @for one in people {
            tr {
                th scope="row" { a href={ "/trainees/" (one.pseudonym) } { (one.pseudonym) } }
                td { (one.role.word()) }
                td { (one.age_band.as_deref().unwrap_or_default()) }
                td { (one.drone_experience.as_deref().unwrap_or_default()) }
                td { (one.gaming_experience.as_deref().unwrap_or_default()) }
            }
        }
    };
    let heads = [("Pseudonym", false), ("Role", false), ("Age", false), ("Drones", false), ("Games", false)];
    let body = html! {
        section {
            @if people.is_empty() { p.calm { "No trainees yet. Trainees appear here after their first flight." } }
            @else { (table(&format!("{} users", people.len()), &heads, &rows)) }
            ul.actions { li { a href="/plan-rules" { "Training plan rules" } } li { a href="/rubric" { "Rubric" } } }
        }
    };
    page(visitor, "/trainees", "Trainees", &body)
}

/// Contents of a trainee's page.
#[derive(Debug, Clone, Copy)]
pub struct TraineeProfile<'a> {
    /// The trainee shown.
    pub person: &'a Trainee,
    /// Sessions, in chronological order.
    pub records: &'a [SessionRecord],
    /// The same sessions as list entries, newest first.
    pub listed: &'a [SessionListEntry],
    /// Assignments with their states.
    pub jobs: &'a [AssignedJob],
    /// Names of the trainee's classes.
    pub classes: &'a [String],
    /// Number of rubric criteria that are signed off, as text.
    pub rubric: &'a str,
    /// Training plan; `None` without sessions.
    pub plan: Option<&'a TrainingPlan>,
    /// Whether incomplete sessions count toward progress and plan.
    pub incomplete: IncompletePolicy,
    /// Reliability of the measures on the jobs that the trainee flew more than once.
    pub reliability: &'a JobReliability,
}

/// Renders a trainee's page.
#[must_use]
pub fn trainee_page(visitor: &Visitor, profile: &TraineeProfile<'_>) -> Markup {
    let name = &profile.person.pseudonym;
    let body = html! {
        @if !profile.classes.is_empty() { p.lead { (class_names(visitor, profile.classes)) } }
        (section("assignments", "Assignments", &trainee_assignments(visitor, name, profile.jobs)))
        @if let Some(plan) = profile.plan { (section("plan", "Next flights", &next(plan, profile))) }
        @if !profile.records.is_empty() { (section("progress", "Progress", &progress(name, profile))) }
        (section("sessions", "Sessions", &html! {
            @if profile.listed.is_empty() { p.calm { "No sessions yet." } }
            @else { (lines(visitor, &format!("{} sessions, newest first", profile.listed.len()), profile.listed)) }
        }))
        (section("rubric", "Rubric", &html! { p { a href={ "/trainees/" (name) "/rubric" } { (profile.rubric) } } }))
        (section("details", "Details", &details(visitor, profile.person)))
        (section("data", "Data", &html! {
            p { a href={ "/trainees/" (name) "/export.json" } { "Download all data for " (name) } }
            @if visitor.satisfies(AccessLevel::Administrator) { (erase(visitor, name)) }
        }))
    };
    page(visitor, "/trainees", &format!("Trainee {name}"), &body)
}

fn class_names(visitor: &Visitor, classes: &[String]) -> Markup {
    html! {
        (if classes.len() == 1 { "Class: " } else { "Classes: " })
        @for (k, name) in classes.iter().enumerate() {
            @if k > 0 { ", " }
            @if visitor.satisfies(AccessLevel::Instructor) { a href={ "/classes/" (name) } { (name) } } @else { (name) }
        }
    }
}

fn next(plan: &TrainingPlan, profile: &TraineeProfile<'_>) -> Markup {
    let told = |change: &&MeasureChange| change.better.is_some();
    html! {
        p { "Fly between " (minute(plan.from_unix_us)) " and " (minute(plan.until_unix_us)) "." @if plan.overdue { " " b { "It has been a long time since the last flight, and skills fade without practice." } } }
        ol.steps {
            @for step in &plan.steps {
                li { b { a href={ "/scenarios/" (step.scenario) } { (step.scenario) } } @if let Some(level) = &step.level { p { (level.words) } } ul { @for reason in &step.reasons { li { @if reason.consequence_of.is_some() { "Consequence: " } (reason.words) } } } }
            }
        }
        @if let Some(note) = &plan.note { p.note { (note) } }
        @if !plan.drills.is_empty() {
            h3 { "Drills" }
            ul { @for drill in &plan.drills { li { (drill.scenario) ": " (drill.words()) @if let Some(next) = &drill.next_level { "; next level: " (next.level) } "." } } }
        }
        @if let Some(words) = excluded_sessions_note(plan.left_out) { p.note { (words) "." } }
        @if let Some(changes) = &plan.changes {
            h3 { "Changes" }
            p.note { "Compared with " a href={ "/sessions/" (changes.since) } { "the previous session on the same job" } "." }
            @let known = reliability_of_session(profile, &changes.since);
            ul {
                @for change in changes.changes.iter().filter(told) {
                    li { (change.what) ": " (formatting::number(change.before, 1)) " → " (formatting::number(change.now, 1)) ", " (if change.better == Some(true) { "better" } else { "worse" }) @if change_is_within_error(change, known) { " (" (within_error::words(true, Language::English)) ")" } }
                }
            }
        }
    }
}

/// Returns the reliability of the measures on the job of a session; empty if unknown.
fn reliability_of_session<'a>(profile: &TraineeProfile<'a>, session: &str) -> &'a [MeasureReliability] {
    let flown = profile.records.iter().find(|record| record.id == session);
    flown.and_then(|record| profile.reliability.get(&record.scenario_with_level())).map_or(&[], Vec::as_slice)
}

fn change_is_within_error(change: &MeasureChange, known: &[MeasureReliability]) -> bool {
    reliability_of(known, &change.what).and_then(|one| one.is_within_error(change.now - change.before)) == Some(true)
}

/// Renders progress separately for each job because practice on one says little about another.
fn progress(name: &str, profile: &TraineeProfile<'_>) -> Markup {
    let (records, incomplete) = (profile.records, profile.incomplete);
    let unfinished = records.iter().filter(|record| !record.is_complete()).count();
    html! {
        @if unfinished > 0 { p {
            @match incomplete {
                IncompletePolicy::Exclude => a href={ "/trainees/" (name) "?incomplete=1" } { "Include incomplete sessions" },
                IncompletePolicy::Include => a href={ "/trainees/" (name) } { "Exclude incomplete sessions" },
            }
        } }
        @for job in by_job(records, incomplete, profile.reliability) {
            @let times = job.progress.repetitions.len();
            h3.job { a href={ "/scenarios/" (job.scenario) } { (job.scenario) } ", " (times) @if times == 1 { " session" } @else { " sessions" } }
            (job_progress(&job, Language::English))
        }
    }
}

fn details(visitor: &Visitor, person: &Trainee) -> Markup {
    let choice = |name: &str, label: &str, given: Option<&str>, all: &[&str]| {
        html! {
            input type="hidden" name={ (ORIGINAL_VALUE_PREFIX) (name) } value=(given.unwrap_or_default());
            label { (label)
                select name=(name) {
                    option value="" selected[given.is_none()] { "not specified" }
                    @for one in all { option value=(one) selected[given == Some(one)] { (one) } }
                }
            }
        }
    };
    html! {
        p { "Role: " (person.role.word()) ". The following information is optional and used only for the study." }
        form.stacked method="post" action={ "/trainees/" (person.pseudonym) "/details" } {
            (token(visitor))
            (choice("age_band", "Age (years)", person.age_band.as_deref(), AGE_BANDS))
            (choice("drone_experience", "Experience with drones", person.drone_experience.as_deref(), EXPERIENCE_LEVELS))
            (choice("gaming_experience", "Experience with video games", person.gaming_experience.as_deref(), EXPERIENCE_LEVELS))
            button type="submit" { "Save" }
        }
    }
}

fn erase(visitor: &Visitor, name: &str) -> Markup {
    html! {
        details {
            summary { "Erase" }
            form.stacked method="post" action={ "/trainees/" (name) "/erase" } {
                (token(visitor))
                p { "This erases " (name) " and all their sessions, answers and session folders. This cannot be undone." }
                label { "Enter the pseudonym to confirm" input name="again" required maxlength="32" autocomplete="off" autocapitalize="none"; }
                button.danger type="submit" { "Erase permanently" }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::plan::{DEFAULT_RULES, plan, read_rules};
    use crate::testing::{aborted_record, perfect_record};
    use crate::trainee::Role;

    #[test]
    fn exact_trainee_page_escapes_and_offers_erasure_only_to_administrators() {
        let mut records = vec![perfect_record(HOSTILE_NAME, 1), perfect_record(HOSTILE_NAME, 2), perfect_record(HOSTILE_NAME, 3)];
        records[0].scenario = HOSTILE_NAME.into();
        let person = Trainee { age_band: Some(HOSTILE_NAME.into()), ..Trainee::new(HOSTILE_NAME) };
        let plan = plan(&records, &read_rules("rules.toml", DEFAULT_RULES).unwrap(), records[2].started_unix_us);
        let profile = TraineeProfile {
            person: &person,
            records: &records,
            listed: &[],
            jobs: &[],
            classes: &[HOSTILE_NAME.to_owned()],
            rubric: HOSTILE_NAME,
            plan: plan.as_ref(),
            incomplete: IncompletePolicy::Exclude,
            reliability: &JobReliability::new(),
        };
        let text = trainee_page(&administrator(), &profile).into_string();
        check(&text);
        assert!(text.contains("Erase permanently") && text.contains("class=\"lines\"") && text.contains("Next flights"));
        assert_eq!(
            (text.matches("class=\"job\"").count(), text.matches("class=\"lines\"").count()),
            (2, 4),
            "one section per job"
        );
        assert!(text.contains(", 1 session<") && text.contains(", 2 sessions<"), "{text}");
        let unfinished = vec![perfect_record("anna", 1), aborted_record("anna", 2)];
        let text = |incomplete: IncompletePolicy| {
            trainee_page(&administrator(), &TraineeProfile { records: &unfinished, plan: None, incomplete, ..profile })
                .into_string()
        };
        let (without, with) = (text(IncompletePolicy::Exclude), text(IncompletePolicy::Include));
        assert!(
            without.contains("1 incomplete session excluded") && without.contains("Include incomplete sessions"),
            "{without}"
        );
        assert!(with.contains(", 2 sessions<") && !with.contains("excluded.") && with.contains("Exclude incomplete"), "{with}");
        let instructor = Visitor { role: Role::Instructor, ..administrator() };
        assert!(!trainee_page(&instructor, &profile).into_string().contains("Erase permanently"));
        check(&trainee_list(&administrator(), &[person]).into_string());
    }

    #[test]
    fn exact_changes_within_the_error_are_labeled_on_the_trainee_page() {
        let mut everyone = Vec::new();
        for (trainee, safety) in [("anna", [50.0, 52.0]), ("ben", [70.0, 76.0]), ("cleo", [90.0, 95.0])] {
            for (number, safety) in (1..).zip(safety) {
                let mut record = perfect_record(trainee, number);
                record.scores.safety = safety;
                everyone.push(record);
            }
        }
        let selection = crate::cohort::Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude };
        let reliability = crate::cohort::cohort(&everyone, &selection).reliability;
        let person = Trainee::new("anna");
        let plan = plan(&everyone[..2], &read_rules("rules.toml", DEFAULT_RULES).unwrap(), everyone[1].started_unix_us);
        let text = |reliability: &JobReliability| {
            let profile = TraineeProfile {
                person: &person,
                records: &everyone[..2],
                listed: &[],
                jobs: &[],
                classes: &[],
                rubric: "",
                plan: plan.as_ref(),
                incomplete: IncompletePolicy::Exclude,
                reliability,
            };
            trainee_page(&administrator(), &profile).into_string()
        };
        let known = text(&JobReliability::from([("two-bridges".to_owned(), reliability)]));
        check(&known);
        assert!(known.contains("safety: 50.0 → 52.0, better (within error)") && known.contains(">within error<"), "{known}");
        let unknown = text(&JobReliability::new());
        assert!(unknown.contains("safety: 50.0 → 52.0, better<") && !unknown.contains("within error"), "{unknown}");
    }
}
