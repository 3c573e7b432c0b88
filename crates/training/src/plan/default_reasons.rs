//! Reasons of the default rules in the language of a page. Rules files contain one language; a rule whose reason is the default one
//! is translated by its name.

use spandrel_text::{Language, find};

/// Values in a reason, as text.
#[derive(Debug, Clone, Default)]
pub(super) struct ReasonValues {
    /// Name of the task, or the number of tasks.
    pub task: String,
    /// Measured value.
    pub value: String,
    /// Direction off the path.
    pub axis: String,
    /// Maximum speed.
    pub fastest: String,
    /// Missed defects.
    pub defects: String,
}

/// Returns the reason of the default rule with this name; `None` if there is no such rule.
pub(super) fn default_reason(rule: &str, values: &ReasonValues, language: Language) -> Option<String> {
    let ReasonValues { task, value, axis, fastest, defects } = values;
    let named = [("task", task), ("value", value), ("axis", axis), ("fastest", fastest), ("defects", defects)];
    find(language, &format!("plan-reason-{}", rule.replace(' ', "-")), &named.map(|(name, text)| (name, text.as_str().into())))
}
