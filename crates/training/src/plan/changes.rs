//! Changes since the previous session.

use crate::cohort::{MeasureReliability, reliability_of};
use crate::record::SessionRecord;
use crate::terms::{contact_title, score_title, task_title};
use serde::Serialize;
use spandrel_text::{Language, text};

/// Minimum score change, points. Smaller changes are reported as unchanged.
const MIN_REPORTED_CHANGE: f64 = 0.05;

/// The latest session compared with the previous one on the same job.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SessionChanges {
    /// ID of the previous session.
    pub since: String,
    /// Changed measures, scores first.
    pub changes: Vec<MeasureChange>,
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
            let ChangedMeasure::Score(key) = change.measure else { continue };
            let reliability = reliability_of(known, key);
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
    /// Returns the measure's name, including the unit. `scenario` is the name of the job.
    #[must_use]
    pub fn title(&self, scenario: &str, language: Language) -> String {
        self.measure.title(scenario, language)
    }
}

/// Compares the latest record with the previous one for the same scenario and level; `None` if there is none. A session that was
/// frozen or rewound is not compared.
pub fn changes(records: &[SessionRecord]) -> Option<SessionChanges> {
    let (last, earlier) = records.split_last().filter(|(last, _)| last.is_unaided())?;
    let mut comparable = earlier.iter().rev().filter(|record| record.is_unaided());
    let before = comparable.find(|record| record.scenario_with_level() == last.scenario_with_level())?;
    let mut changes = Vec::new();
    let mut add = |measure: ChangedMeasure, before: Option<f64>, now: Option<f64>, more_is_better: bool| {
        if let (Some(before), Some(now)) = (before, now) {
            let same = (now - before).abs() < MIN_REPORTED_CHANGE;
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
    Some(SessionChanges { since: before.id.clone(), changes })
}
