//! Changes since the previous session.

use crate::record::SessionRecord;
use serde::Serialize;

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
    /// Measure name, including the unit.
    pub what: String,
    /// Value in the earlier session.
    pub before: f64,
    /// Value in the latest session.
    pub now: f64,
    /// Whether the change is an improvement; `None` if the values are equal.
    pub better: Option<bool>,
}

/// Compares the latest record with the previous one for the same scenario and level; `None` if there is none. A session that was
/// frozen or rewound is not compared.
pub fn changes(records: &[SessionRecord]) -> Option<SessionChanges> {
    let (last, earlier) = records.split_last().filter(|(last, _)| last.is_unaided())?;
    let mut comparable = earlier.iter().rev().filter(|record| record.is_unaided());
    let before = comparable.find(|record| record.scenario_with_level() == last.scenario_with_level())?;
    let mut changes = Vec::new();
    let mut add = |what: String, before: Option<f64>, now: Option<f64>, more_is_better: bool| {
        if let (Some(before), Some(now)) = (before, now) {
            let same = (now - before).abs() < MIN_REPORTED_CHANGE;
            changes.push(MeasureChange { what, before, now, better: (!same).then_some((now > before) == more_is_better) });
        }
    };
    let (then, now) = (&before.scores, &last.scores);
    add("overall".into(), Some(then.overall), Some(now.overall), true);
    add("conformity".into(), then.conformity, now.conformity, true);
    add("efficiency".into(), Some(then.efficiency), Some(now.efficiency), true);
    add("safety".into(), Some(then.safety), Some(now.safety), true);
    add("accuracy".into(), then.accuracy, now.accuracy, true);
    for task in &last.tasks {
        let Some(then) = before.tasks.iter().find(|other| other.id == task.id) else { continue };
        add(format!("{}: on-path share (%)", task.name), Some(100.0 * then.on_path), Some(100.0 * task.on_path), true);
        add(format!("{}: time above the speed limit (s)", task.name), Some(then.speeding_s), Some(task.speeding_s), false);
        let crashes = (then.crashes.total() as f64, task.crashes.total() as f64);
        add(format!("{}: crashes", task.name), Some(crashes.0), Some(crashes.1), false);
    }
    for ((kind, then), (_, now)) in before.crashes().by_kind().into_iter().zip(last.crashes().by_kind()) {
        if then + now > 0 {
            add(format!("crashes: {kind}"), Some(then as f64), Some(now as f64), false);
        }
    }
    Some(SessionChanges { since: before.id.clone(), changes })
}
