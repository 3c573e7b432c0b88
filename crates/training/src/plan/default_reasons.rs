//! Names and reasons of the default rules in the language of a page. Rules files contain one language; a rule whose reason is the
//! default one is translated by its name.

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

/// Returns the name of a rule in a language. The name of a rule that is not one of the default rules is the user's and stays.
#[must_use]
pub fn rule_title(rule: &str, language: Language) -> String {
    let id = format!("plan-rule-{}", rule.replace(' ', "-"));
    let is_default = find(Language::English, &id, &[]).as_deref() == Some(rule);
    find(language, &id, &[]).filter(|_| is_default).unwrap_or_else(|| rule.to_owned())
}

/// Returns the reason of the default rule with this name; `None` if there is no such rule.
pub(super) fn default_reason(rule: &str, values: &ReasonValues, language: Language) -> Option<String> {
    let ReasonValues { task, value, axis, fastest, defects } = values;
    let named = [("task", task), ("value", value), ("axis", axis), ("fastest", fastest), ("defects", defects)];
    find(language, &format!("plan-reason-{}", rule.replace(' ', "-")), &named.map(|(name, text)| (name, text.as_str().into())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{DEFAULT_RULES, read_rules};

    #[test]
    fn exact_every_default_rule_has_a_name_in_every_language() {
        let rules = read_rules("rules.toml", DEFAULT_RULES).unwrap().rules;
        let names = rules.iter().map(|rule| rule.name.as_str()).chain(["mastery", "retention", "job"]);
        for name in names {
            let [english, german, spanish] = Language::ALL.map(|language| rule_title(name, language));
            assert_eq!(english, name);
            assert!(german != name && spanish != name && german != spanish, "{name}: {german}, {spanish}");
        }
        assert_eq!(rule_title("our own rule", Language::German), "our own rule");
        assert_eq!(rule_title("hit-a-person", Language::German), "hit-a-person");
    }
}
