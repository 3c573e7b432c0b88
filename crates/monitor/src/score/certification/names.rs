//! Names and explanations of the certification's requirements and scores. Four of these scores have the keys of the TASBID
//! scores but other formulas, so that people read other names.

use spandrel_text::{Language, text};

/// Returns the name of the requirement or score with this ID; `None` if there is none.
#[must_use]
pub fn title(id: &str, language: Language) -> Option<String> {
    Some(match id {
        "tasks_done" => text!(language, "certification-tasks-done"),
        "landed_at_home" => text!(language, "certification-landed-at-home"),
        "person_or_vehicle_hits" => text!(language, "certification-person-or-vehicle-hits"),
        "battery" => text!(language, "certification-battery"),
        "contacts" => text!(language, "certification-contacts"),
        "contact_speed" => text!(language, "certification-contact-speed"),
        "conformity" => text!(language, "certification-conformity"),
        "precision" => text!(language, "certification-precision"),
        "safety" => text!(language, "certification-safety"),
        "accuracy" => text!(language, "certification-accuracy"),
        "efficiency" => text!(language, "certification-efficiency"),
        "practice_aids" => text!(language, "certification-practice-aids"),
        _ => return None,
    })
}

/// Returns one sentence about how the value of the requirement or score with this ID is measured; `None` if there is none.
#[must_use]
pub fn explanation(id: &str, language: Language) -> Option<String> {
    Some(match id {
        "tasks_done" => text!(language, "certification-explain-tasks-done"),
        "landed_at_home" => text!(language, "certification-explain-landed-at-home"),
        "person_or_vehicle_hits" => text!(language, "certification-explain-person-or-vehicle-hits"),
        "battery" => text!(language, "certification-explain-battery"),
        "contacts" => text!(language, "certification-explain-contacts"),
        "contact_speed" => text!(language, "certification-explain-contact-speed"),
        "conformity" => text!(language, "certification-explain-conformity"),
        "precision" => text!(language, "certification-explain-precision"),
        "safety" => text!(language, "certification-explain-safety"),
        "accuracy" => text!(language, "certification-explain-accuracy"),
        "efficiency" => text!(language, "certification-explain-efficiency"),
        "practice_aids" => text!(language, "certification-explain-practice-aids"),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_no_certification_score_has_the_name_of_a_tasbid_score() {
        let tasbid = |language| {
            [
                text!(language, "terms-score-conformity"),
                text!(language, "terms-score-efficiency"),
                text!(language, "terms-score-safety"),
                text!(language, "terms-score-accuracy"),
            ]
        };
        for language in Language::ALL {
            for id in ["conformity", "precision", "safety", "accuracy", "efficiency"] {
                let name = title(id, language).unwrap_or_default();
                assert!(!name.is_empty() && !tasbid(language).contains(&name), "{language:?}: {name}");
                let sentence = explanation(id, language).unwrap_or_default();
                assert!(sentence.ends_with('.') && sentence.len() > name.len(), "{language:?}: {sentence}");
            }
        }
    }
}
