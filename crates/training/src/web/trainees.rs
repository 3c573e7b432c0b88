//! Trainee list and trainee page: progress, plan, details, export and erasure.

use super::access::{AccessLevel, Visitor};
use super::assignments::trainee_assignments;
use super::layout::{ELEMENT, page, role_text, section, table, token, with_element};
use super::sessions::lines;
use crate::assignment::AssignedJob;
use crate::cohort::{JobReliability, MeasureReliability, by_job};
use crate::plan::{DrillProgress, MeasureChange, SessionChanges, TrainingPlan};
use crate::record::{IncompletePolicy, SessionListEntry, SessionOutcome, SessionRecord, excluded_sessions_note};
use crate::report::formatting;
use crate::report::page::progress::job_progress;
use crate::trainee::{AGE_BANDS, EXPERIENCE_LEVELS, Trainee};
use maud::{Markup, html};
use spandrel_model::calendar::minute;
use spandrel_text::{Language, text};

/// Prefix of the fields that contain the values from when the page was opened, used to detect conflicting edits.
pub const ORIGINAL_VALUE_PREFIX: &str = "before_";

/// Renders the list of trainees.
#[must_use]
pub fn trainee_list(visitor: &Visitor, people: &[Trainee]) -> Markup {
    let language = visitor.language;
    let experience = |given: &Option<String>| given.as_deref().map(|level| experience_text(language, level)).unwrap_or_default();
    let rows = html! {
        @for one in people {
            tr {
                th scope="row" { a href={ "/trainees/" (one.pseudonym) } { (one.pseudonym) } }
                td { (role_text(language, one.role)) }
                td { (one.age_band.as_deref().unwrap_or_default()) }
                td { (experience(&one.drone_experience)) }
                td { (experience(&one.gaming_experience)) }
            }
        }
    };
    let heads = [
        (text!(language, "people-pseudonym"), false),
        (text!(language, "people-role"), false),
        (text!(language, "people-age"), false),
        (text!(language, "people-drones"), false),
        (text!(language, "people-games"), false),
    ];
    let body = html! {
        section {
            @if people.is_empty() { p.calm { (text!(language, "people-no-trainees")) } }
            @else { (table(&text!(language, "people-users", count = people.len()), &heads, &rows)) }
            ul.actions { li { a href="/plan-rules" { (text!(language, "people-plan-rules")) } } li { a href="/rubric" { (text!(language, "people-rubric")) } } }
        }
    };
    page(visitor, "/trainees", &text!(language, "people-trainees"), &body)
}

/// Returns a level of experience, one of [`EXPERIENCE_LEVELS`], as text.
fn experience_text(language: Language, level: &str) -> String {
    match level {
        "none" => text!(language, "people-experience-none"),
        "some" => text!(language, "people-experience-some"),
        "regular" => text!(language, "people-experience-regular"),
        other => other.to_owned(),
    }
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
    let (language, name) = (visitor.language, profile.person.pseudonym.as_str());
    let body = html! {
        @if !profile.classes.is_empty() { p.lead { (class_names(visitor, profile.classes)) } }
        (section("assignments", &text!(language, "people-assignments"), &trainee_assignments(visitor, name, profile.jobs)))
        @if let Some(plan) = profile.plan { (section("plan", &text!(language, "people-next-flights"), &next(language, plan, profile))) }
        @if !profile.records.is_empty() { (section("progress", &text!(language, "people-progress"), &progress(language, name, profile))) }
        (section("sessions", &text!(language, "people-sessions"), &html! {
            @if profile.listed.is_empty() { p.calm { (text!(language, "people-no-sessions")) } }
            @else { (lines(visitor, &text!(language, "sessions-count", count = profile.listed.len()), profile.listed)) }
        }))
        (section("rubric", &text!(language, "people-rubric"), &html! { p { a href={ "/trainees/" (name) "/rubric" } { (profile.rubric) } } }))
        (section("details", &text!(language, "people-details"), &details(visitor, profile.person)))
        (section("data", &text!(language, "people-data"), &html! {
            p { a href={ "/trainees/" (name) "/export.json" } { (text!(language, "people-download", name = name)) } }
            @if visitor.satisfies(AccessLevel::Administrator) { (erase(visitor, name)) }
        }))
    };
    page(visitor, "/trainees", &text!(language, "people-trainee", name = name), &body)
}

fn class_names(visitor: &Visitor, classes: &[String]) -> Markup {
    html! {
        (text!(visitor.language, "people-of-classes", count = classes.len())) " "
        @for (k, name) in classes.iter().enumerate() {
            @if k > 0 { ", " }
            @if visitor.satisfies(AccessLevel::Instructor) { a href={ "/classes/" (name) } { (name) } } @else { (name) }
        }
    }
}

fn next(language: Language, plan: &TrainingPlan, profile: &TraineeProfile<'_>) -> Markup {
    let (from, until) = (minute(plan.from_unix_us), minute(plan.until_unix_us));
    html! {
        p { (text!(language, "people-plan-between", from = from, until = until)) @if plan.overdue { " " b { (text!(language, "people-plan-overdue")) } } }
        ol.steps {
            @for step in &plan.steps {
                li { b { a href={ "/scenarios/" (step.scenario) } { (step.scenario) } } @if let Some(level) = &step.level { p { (level.words) } } ul { @for reason in &step.reasons { li { @if reason.consequence_of.is_some() { (text!(language, "people-plan-consequence", reason = reason.words.as_str())) } @else { (reason.words) } } } } }
            }
        }
        @if let Some(note) = &plan.note { p.note { (note) } }
        @if !plan.drills.is_empty() {
            h3 { (text!(language, "people-plan-drills")) }
            ul { @for drill in &plan.drills { li { (drill_line(language, drill)) } } }
        }
        @if let Some(words) = excluded_sessions_note(plan.left_out, language) { p.note { (words) "." } }
        @if let Some(changes) = &plan.changes {
            @let changes = labeled(changes, reliability_of_session(profile, &changes.since));
            h3 { (text!(language, "people-changes")) }
            @let previous = html! { a href={ "/sessions/" (changes.since) } { (text!(language, "people-changes-session")) } };
            p.note { (with_element(&text!(language, "people-changes-compared", session = ELEMENT), &previous)) }
            @if let Some([before, now]) = &changes.forms {
                p.note { (text!(language, "people-changes-forms", before = before.as_str(), now = now.as_str())) }
            }
            ul {
                @let scenario = profile.records.last().map_or("", |record| record.scenario.as_str());
                @for change in changes.shown() {
                    li { (change_line(language, scenario, change)) @if changes.is_labeled() && change.within_error != Some(false) { " (" (change.error_label(language)) ")" } }
                }
            }
            @if !changes.is_labeled() { p.note { (text!(language, "compare-error-unknown")) } }
        }
    }
}

fn drill_line(language: Language, drill: &DrillProgress) -> String {
    let (name, progress) = (drill.scenario.as_str(), drill.words(language));
    match &drill.next_level {
        Some(next) => text!(language, "people-plan-drill-next", drill = name, progress = progress, level = next.level),
        None => text!(language, "people-plan-drill", drill = name, progress = progress),
    }
}

/// Describes a change. `scenario` is the name of the job.
fn change_line(language: Language, scenario: &str, change: &MeasureChange) -> String {
    let (before, now) = (formatting::number(change.before, 1), formatting::number(change.now, 1));
    let what = change.title(scenario, language);
    if change.better == Some(true) {
        text!(language, "people-change-better", what = what, before = before, now = now)
    } else {
        text!(language, "people-change-worse", what = what, before = before, now = now)
    }
}

fn labeled(changes: &SessionChanges, known: &[MeasureReliability]) -> SessionChanges {
    let mut labeled = changes.clone();
    labeled.label(known);
    labeled
}

/// Returns the reliability of the measures on the job of a session; empty if unknown.
fn reliability_of_session<'a>(profile: &TraineeProfile<'a>, session: &str) -> &'a [MeasureReliability] {
    let flown = profile.records.iter().find(|record| record.id == session);
    flown.and_then(|record| profile.reliability.get(&record.scenario_with_level())).map_or(&[], Vec::as_slice)
}

/// Renders progress separately for each job because practice on one says little about another.
fn progress(language: Language, name: &str, profile: &TraineeProfile<'_>) -> Markup {
    let (records, incomplete) = (profile.records, profile.incomplete);
    let unfinished = records.iter().filter(|record| !record.is_complete()).count();
    html! {
        @if unfinished > 0 { p {
            @match incomplete {
                IncompletePolicy::Exclude => a href={ "/trainees/" (name) "?incomplete=1" } { (text!(language, "people-include-incomplete")) },
                IncompletePolicy::Include => a href={ "/trainees/" (name) } { (text!(language, "people-exclude-incomplete")) },
            }
        } }
        @for job in by_job(records, incomplete, profile.reliability) {
            @let sessions = text!(language, "people-job-sessions", count = job.progress.repetitions.len());
            @let title = match job.forms.join(", ") {
                forms if forms.is_empty() => job.scenario.clone(),
                forms => text!(language, "people-choice-forms", job = job.scenario.as_str(), forms = forms),
            };
            h3.job { a href={ "/scenarios/" (job.scenario) } { (title) } ", " (sessions) }
            (job_progress(&job, language))
        }
    }
}

fn details(visitor: &Visitor, person: &Trainee) -> Markup {
    let language = visitor.language;
    let choice = |name: &str, label: String, given: Option<&str>, all: &[&str]| {
        html! {
            input type="hidden" name={ (ORIGINAL_VALUE_PREFIX) (name) } value=(given.unwrap_or_default());
            label { (label)
                select name=(name) {
                    option value="" selected[given.is_none()] { (text!(language, "people-not-specified")) }
                    @for one in all { option value=(one) selected[given == Some(one)] { (experience_text(language, one)) } }
                }
            }
        }
    };
    html! {
        p { (text!(language, "people-details-note", role = role_text(language, person.role))) }
        form.stacked method="post" action={ "/trainees/" (person.pseudonym) "/details" } {
            (token(visitor))
            (choice("age_band", text!(language, "people-age-years"), person.age_band.as_deref(), AGE_BANDS))
            (choice("drone_experience", text!(language, "people-drone-experience"), person.drone_experience.as_deref(), EXPERIENCE_LEVELS))
            (choice("gaming_experience", text!(language, "people-gaming-experience"), person.gaming_experience.as_deref(), EXPERIENCE_LEVELS))
            button type="submit" { (text!(language, "people-save")) }
        }
    }
}

fn erase(visitor: &Visitor, name: &str) -> Markup {
    let language = visitor.language;
    html! {
        details {
            summary { (text!(language, "people-erase")) }
            form.stacked method="post" action={ "/trainees/" (name) "/erase" } {
                (token(visitor))
                p { (text!(language, "people-erase-note", name = name)) }
                label { (text!(language, "people-erase-again")) input name="again" required maxlength="32" autocomplete="off" autocapitalize="none"; }
                button.danger type="submit" { (text!(language, "people-erase-button")) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use crate::plan::{DEFAULT_RULES, plan, read_rules};
    use crate::testing::{aborted_record, perfect_record};
    use crate::trainee::Role;

    #[test]
    fn exact_trainee_page_escapes_and_offers_erasure_only_to_administrators() {
        let mut records = vec![perfect_record(HOSTILE_NAME, 1), perfect_record(HOSTILE_NAME, 2), perfect_record(HOSTILE_NAME, 3)];
        records[0].scenario = HOSTILE_NAME.into();
        let person = Trainee { age_band: Some(HOSTILE_NAME.into()), ..Trainee::new(HOSTILE_NAME) };
        let plan =
            plan(&records, &read_rules("rules.toml", DEFAULT_RULES).unwrap(), records[2].started_unix_us, Language::English);
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
    fn exact_trainee_pages_are_translated() {
        let levels = [Some("none".to_owned()), Some("some".to_owned()), Some("regular".to_owned())];
        let person = |level: &Option<String>| Trainee {
            drone_experience: level.clone(),
            gaming_experience: level.clone(),
            ..Trainee::new("anna")
        };
        let people: Vec<Trainee> = levels.iter().map(person).collect();
        let visitor = administrator_with(Language::Pseudo);
        check_translated(&trainee_list(&visitor, &people).into_string(), &["anna"]);
        let profile = TraineeProfile {
            person: &people[0],
            records: &[],
            listed: &[],
            jobs: &[],
            classes: &["7".to_owned()],
            rubric: "7",
            plan: None,
            incomplete: IncompletePolicy::Exclude,
            reliability: &JobReliability::new(),
        };
        check_translated(&trainee_page(&visitor, &profile).into_string(), &["anna"]);
        let german = trainee_page(&administrator_with(Language::German), &profile).into_string();
        assert!(german.contains("Klasse: ") && german.contains("Erfahrung mit Drohnen"), "{german}");
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
        let plan = plan(
            &everyone[..2],
            &read_rules("rules.toml", DEFAULT_RULES).unwrap(),
            everyone[1].started_unix_us,
            Language::English,
        );
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
        let changes = &plan.as_ref().unwrap().changes.as_ref().unwrap().changes;
        let safety = changes.iter().find(|change| change.what == "safety").unwrap();
        assert_eq!(change_line(Language::German, "two-bridges", safety), "Sicherheit: 50.0 → 52.0, besser");
        let unknown = text(&JobReliability::new());
        assert!(unknown.contains("safety: 50.0 → 52.0, better<") && !unknown.contains("within error"), "{unknown}");
    }
}
