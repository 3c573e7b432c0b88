//! Changes since the previous session.

use crate::cohort::{MeasureReliability, TaskDetail, crash_key, reliability_of};
use crate::record::{SessionRecord, differing_forms};
use crate::terms::{contact_title, error_label, score_title, task_title};
use serde::Serialize;
use spandrel_text::{Language, text};

/// Steps of one between which values are shown: with one decimal.
const SHOWN_STEPS: f64 = 10.0;

/// The latest session compared with the previous one on the same job.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SessionChanges {
    /// ID of the previous session.
    pub since: String,
    /// Names of the forms of both sessions, earlier one first; absent if they flew the same one, or the job has no forms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forms: Option<[String; 2]>,
    /// Changed measures, scores first.
    pub changes: Vec<MeasureChange>,
}

impl SessionChanges {
    /// Returns the changes of measures whose values differ.
    pub fn shown(&self) -> impl Iterator<Item = &MeasureChange> {
        self.changes.iter().filter(|change| change.better.is_some())
    }

    /// Returns whether the error is known for at least one measure. Otherwise, one sentence says so instead of a label for each.
    #[must_use]
    pub fn is_labeled(&self) -> bool {
        self.changes.iter().any(|change| change.within_error.is_some())
    }
}

/// Change in one measure between two sessions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureChange {
    /// Measure name in English, including the unit. [`Self::title`] returns it in the language of a page.
    pub what: String,
    /// Measure.
    #[serde(skip)]
    pub measure: ChangedMeasure,
    /// Value in the earlier session.
    pub before: f64,
    /// Value in the latest session.
    pub now: f64,
    /// Whether the change is an improvement; `None` if the values are equal.
    pub better: Option<bool>,
    /// Whether the change is smaller than the minimal detectable change; absent if the measure's reliability is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within_error: Option<bool>,
}

impl SessionChanges {
    /// Labels each change with the reliability of the measures on the job.
    pub fn label(&mut self, known: &[MeasureReliability]) {
        for change in &mut self.changes {
            let reliability = reliability_of(known, &change.measure.reliability_key());
            change.within_error = reliability.and_then(|one| one.is_within_error(change.now - change.before));
        }
    }
}

/// Measure that is compared between two sessions.
#[derive(Debug, Clone, PartialEq)]
pub enum ChangedMeasure {
    /// Score with this key.
    Score(&'static str),
    /// Fraction of the time on the path of the task with this name, %.
    OnPath(String),
    /// Time above the speed limit in the task with this name, s.
    Speeding(String),
    /// Number of crashes in the task with this name.
    TaskCrashes(String),
    /// Number of crashes into objects of this kind.
    Crashes(&'static str),
}

impl ChangedMeasure {
    /// Returns the name under which a group's reliability lists the measure.
    fn reliability_key(&self) -> String {
        match self {
            Self::Score(key) => (*key).to_owned(),
            Self::OnPath(name) => TaskDetail::OnPath.key(name),
            Self::Speeding(name) => TaskDetail::Speeding.key(name),
            Self::TaskCrashes(name) => TaskDetail::Crashes.key(name),
            Self::Crashes(object) => crash_key(object),
        }
    }

    /// Returns the name, including the unit. `scenario` is the name of the job.
    fn title(&self, scenario: &str, language: Language) -> String {
        let task = |name: &str| task_title(scenario, name, language);
        match self {
            Self::Score(key) => score_title(key, language),
            Self::OnPath(name) => text!(language, "plan-change-on-path", task = task(name)),
            Self::Speeding(name) => text!(language, "plan-change-speeding", task = task(name)),
            Self::TaskCrashes(name) => text!(language, "plan-change-task-crashes", task = task(name)),
            Self::Crashes(object) => text!(language, "plan-change-crashes", object = contact_title(object, language)),
        }
    }
}

impl MeasureChange {
    /// Returns whether the change is within the error of the measure or beyond it, or that the error is unknown.
    #[must_use]
    pub fn error_label(&self, language: Language) -> String {
        match self.within_error {
            Some(within) => error_label(within, language),
            None => text!(language, "report-error-unknown"),
        }
    }

    /// Returns the measure's name, including the unit. `scenario` is the name of the job.
    #[must_use]
    pub fn title(&self, scenario: &str, language: Language) -> String {
        self.measure.title(scenario, language)
    }
}

/// Returns whether two values are the same as they are shown.
fn are_shown_equal(before: f64, now: f64) -> bool {
    (SHOWN_STEPS * now).round() == (SHOWN_STEPS * before).round()
}

/// Compares the latest record with the previous one for the same scenario, level and equated forms; `None` if there is none. A session that was
/// frozen or rewound is not compared.
pub fn changes(records: &[SessionRecord]) -> Option<SessionChanges> {
    let (last, earlier) = records.split_last().filter(|(last, _)| last.is_unaided())?;
    let mut comparable = earlier.iter().rev().filter(|record| record.is_unaided());
    let before = comparable.find(|record| record.is_same_job(last))?;
    let mut changes = Vec::new();
    let mut add = |measure: ChangedMeasure, before: Option<f64>, now: Option<f64>, more_is_better: bool| {
        if let (Some(before), Some(now)) = (before, now) {
            let same = are_shown_equal(before, now);
            let what = measure.title(&last.scenario, Language::English);
            let better = (!same).then_some((now > before) == more_is_better);
            changes.push(MeasureChange { what, measure, before, now, better, within_error: None });
        }
    };
    let (then, now) = (&before.scores, &last.scores);
    add(ChangedMeasure::Score("overall"), Some(then.overall), Some(now.overall), true);
    add(ChangedMeasure::Score("conformity"), then.conformity, now.conformity, true);
    add(ChangedMeasure::Score("efficiency"), Some(then.efficiency), Some(now.efficiency), true);
    add(ChangedMeasure::Score("safety"), Some(then.safety), Some(now.safety), true);
    add(ChangedMeasure::Score("accuracy"), then.accuracy, now.accuracy, true);
    for task in &last.tasks {
        let Some(then) = before.tasks.iter().find(|other| other.id == task.id) else { continue };
        let name = || task.name.clone();
        add(ChangedMeasure::OnPath(name()), Some(100.0 * then.on_path), Some(100.0 * task.on_path), true);
        add(ChangedMeasure::Speeding(name()), Some(then.speeding_s), Some(task.speeding_s), false);
        let crashes = (then.crashes.total() as f64, task.crashes.total() as f64);
        add(ChangedMeasure::TaskCrashes(name()), Some(crashes.0), Some(crashes.1), false);
    }
    for ((kind, then), (_, now)) in before.crashes().by_kind().into_iter().zip(last.crashes().by_kind()) {
        if then + now > 0 {
            add(ChangedMeasure::Crashes(kind), Some(then as f64), Some(now as f64), false);
        }
    }
    let differ = !differing_forms([&before.form, &last.form]).is_empty();
    let forms = before.form.clone().zip(last.form.clone()).filter(|_| differ).map(|(before, now)| [before, now]);
    Some(SessionChanges { since: before.id.clone(), forms, changes })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cohort::job_reliability;
    use crate::record::IncompletePolicy;
    use crate::testing::perfect_record;

    #[test]
    fn exact_details_are_labeled_with_their_own_error() {
        let mut everyone = Vec::new();
        for (trainee, bridge, on_path) in
            [("anna", [5, 0], [0.5, 0.9]), ("ben", [2, 9], [0.90, 0.91]), ("cleo", [7, 6], [0.7, 0.71])]
        {
            for (number, (crashes, on_path)) in (1..).zip(bridge.into_iter().zip(on_path)) {
                let mut record = perfect_record(trainee, number);
                (record.tasks[0].crashes.bridge, record.tasks[0].on_path) = (crashes, on_path);
                record.tasks[0].speeding_s = if trainee == "anna" { 10.0 * number as f64 } else { 3.0 };
                everyone.push(record);
            }
        }
        // The known errors leave out anna, whose changes are large.
        let known = job_reliability(&everyone[2..], "two-bridges", IncompletePolicy::Exclude);
        let mut changes = changes(&everyone[..2]).unwrap();
        assert!(!changes.is_labeled());
        changes.label(&known);
        let task = everyone[0].tasks[0].name.clone();
        let of = |measure: ChangedMeasure| changes.shown().find(|change| change.measure == measure).unwrap();
        let labels =
            [of(ChangedMeasure::Crashes("bridge")), of(ChangedMeasure::OnPath(task.clone())), of(ChangedMeasure::Speeding(task))];
        assert_eq!(labels.map(|change| change.error_label(Language::English)), ["within error", "beyond error", "error unknown"]);
        assert!(changes.is_labeled());
    }

    #[test]
    fn exact_values_that_look_the_same_have_not_changed() {
        assert!(are_shown_equal(367.16, 367.24) && are_shown_equal(0.0, 0.04));
        assert!(!are_shown_equal(367.24, 367.26) && !are_shown_equal(0.0, 0.05));
    }

    #[test]
    fn exact_changes_are_those_since_the_last_session_on_an_equated_form() {
        let forms = [("A", 95.0), ("H", 25.0), ("B", 95.0)];
        let mut records: Vec<SessionRecord> = (1..=3).map(|number| perfect_record("anna", number)).collect();
        for (record, (form, detection_pct)) in records.iter_mut().zip(forms) {
            (record.form, record.form_detection_pct) = (Some(form.into()), Some(detection_pct));
        }
        let found = changes(&records).unwrap();
        assert_eq!((found.since, found.forms), (records[0].id.clone(), Some(["A".into(), "B".into()])));
        assert_eq!(changes(&records[..2]), None, "form H is harder than form A");
        records[2].form = Some("A".into());
        assert_eq!(changes(&records).unwrap().forms, None, "the same form is not named");
    }
}
