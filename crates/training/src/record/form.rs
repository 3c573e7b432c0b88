//! Form of a job that a session flew, and which forms are equally difficult.

use serde::{Deserialize, Serialize};
use spandrel_model::scenario::Scenario;

/// Largest difference in predicted detection between equated forms, percentage points. The forms of the shipped jobs are placed
/// to agree this closely.
const MAX_EQUATED_DIFFERENCE_PCT: f64 = 3.0;

/// Form that a session flew. Equality means the same form; [`Self::is_equated_with`] says whether scores can be compared.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FlownForm {
    /// Name; `None` if the job has no forms.
    pub name: Option<String>,
    /// Predicted detection for which the form's defects were placed, %; `None` if unknown.
    pub detection_pct: Option<f64>,
}

impl FlownForm {
    /// Returns the selected form of a scenario.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self { name: scenario.form.as_ref().map(|form| form.name.clone()), detection_pct: detection_pct(scenario) }
    }

    /// Returns whether the defects of both forms are equally difficult to find. Different forms of unknown difficulty are not
    /// equated.
    #[must_use]
    pub fn is_equated_with(&self, other: &Self) -> bool {
        match (self.detection_pct, other.detection_pct) {
            (Some(own), Some(other)) => (own - other).abs() <= MAX_EQUATED_DIFFERENCE_PCT,
            _ => self.name == other.name,
        }
    }
}

/// Returns the predicted detection of the selected form, %; `None` without forms.
pub(super) fn detection_pct(scenario: &Scenario) -> Option<f64> {
    scenario.form.as_ref().and(scenario.defects.mean_detection).map(|share| 100.0 * share)
}

/// Returns the names of the forms in the order of their names, each once; empty if all sessions flew the same one.
#[must_use]
pub fn differing_forms<'a>(forms: impl IntoIterator<Item = &'a Option<String>>) -> Vec<String> {
    let mut names: Vec<String> = forms.into_iter().flatten().cloned().collect();
    names.sort();
    names.dedup();
    if names.len() > 1 { names } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    fn form(job: &str, name: &str) -> FlownForm {
        let (_, text) = shipped::SCENARIOS.iter().find(|(shipped, _)| *shipped == job).unwrap();
        let text = scenario::select_form(text, name);
        FlownForm::of(&scenario::read(job, &text, &|_| Err("none".into())).unwrap())
    }

    #[test]
    fn exact_only_forms_with_the_same_predicted_detection_are_equated() {
        for job in ["pilot-study", "certification"] {
            for other in ["B", "C"] {
                assert!(form(job, "A").is_equated_with(&form(job, other)), "{job} {other}");
            }
        }
        assert_eq!(form("pilot-study", "H"), FlownForm { name: Some("H".into()), detection_pct: Some(25.0) });
        assert!(!form("pilot-study", "B").is_equated_with(&form("pilot-study", "H")));
    }

    #[test]
    fn exact_forms_of_unknown_difficulty_are_equated_only_with_themselves() {
        let unknown = |name: &str| FlownForm { name: Some(name.into()), detection_pct: None };
        assert!(unknown("A").is_equated_with(&unknown("A")) && !unknown("A").is_equated_with(&unknown("B")));
        assert!(
            !unknown("A").is_equated_with(&FlownForm::default()) && FlownForm::default().is_equated_with(&FlownForm::default())
        );
        let known = |pct| FlownForm { name: Some("A".into()), detection_pct: Some(pct) };
        assert!(known(78.0).is_equated_with(&known(81.0)) && !known(78.0).is_equated_with(&known(81.5)));
    }

    #[test]
    fn exact_forms_are_named_only_if_they_differ() {
        let name = |name: &str| Some(name.to_owned());
        assert_eq!(differing_forms(&[name("B"), name("A"), name("B"), None]), ["A", "B"]);
        assert!(differing_forms(&[name("A"), name("A")]).is_empty() && differing_forms(&[None]).is_empty());
    }
}
