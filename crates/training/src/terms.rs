//! Names of bridge elements, defects, scores, tasks and jobs in the language of a page: AASHTO MBEI in English, DIN 1076 and
//! RI-EBW-PRÜF in German.

use spandrel_model::defect_codes::{
    ABRASION, CONNECTION, CORROSION, CRACK, EFFLORESCENCE, FATIGUE, MORTAR, PSC_CRACK, REBAR, SPALL, SPLIT_STONE,
};
use spandrel_model::elements::Element;
use spandrel_model::scenario::DefectCause;
use spandrel_model::shipped::SCENARIOS;
use spandrel_monitor::score::certification::names::title as certification_title;
use spandrel_text::terms::shipped_task_title;
pub use spandrel_text::terms::{contact_title, end_reason_title, purpose_title, score_title};
use spandrel_text::{Language, find, text};

/// Returns the name of an element: the part, then its material.
#[must_use]
pub fn element_title(element: Element, language: Language) -> String {
    find(language, &format!("terms-element-{}", element.number()), &[])
        .unwrap_or_else(|| text!(language, "terms-element-unlisted"))
}

/// Returns the name of a defect with this AASHTO MBEI code.
#[must_use]
pub fn defect_title(kind: u32, language: Language) -> String {
    match kind {
        CORROSION => text!(language, "terms-defect-corrosion"),
        FATIGUE => text!(language, "terms-defect-fatigue"),
        CONNECTION => text!(language, "terms-defect-connection"),
        SPALL => text!(language, "terms-defect-spall"),
        REBAR => text!(language, "terms-defect-rebar"),
        PSC_CRACK => text!(language, "terms-defect-psc-crack"),
        EFFLORESCENCE => text!(language, "terms-defect-efflorescence"),
        CRACK => text!(language, "terms-defect-crack"),
        ABRASION => text!(language, "terms-defect-abrasion"),
        MORTAR => text!(language, "terms-defect-mortar"),
        SPLIT_STONE => text!(language, "terms-defect-split-stone"),
        _ => text!(language, "terms-defect-unknown"),
    }
}

/// Returns the cause of a defect.
#[must_use]
pub fn cause_title(cause: DefectCause, language: Language) -> String {
    match cause {
        DefectCause::Bending => text!(language, "terms-cause-bending"),
        DefectCause::Shear => text!(language, "terms-cause-shear"),
        DefectCause::Shrinkage => text!(language, "terms-cause-shrinkage"),
        DefectCause::Swelling => text!(language, "terms-cause-swelling"),
        DefectCause::LeakingJoint => text!(language, "terms-cause-leaking-joint"),
        DefectCause::Drain => text!(language, "terms-cause-drain"),
        DefectCause::Reinforcement => text!(language, "terms-cause-reinforcement"),
        DefectCause::Edge => text!(language, "terms-cause-edge"),
        DefectCause::WaterLine => text!(language, "terms-cause-water-line"),
        DefectCause::Weld => text!(language, "terms-cause-weld"),
        DefectCause::Fasteners => text!(language, "terms-cause-fasteners"),
        DefectCause::Cable => text!(language, "terms-cause-cable"),
        DefectCause::Seepage => text!(language, "terms-cause-seepage"),
        DefectCause::Frost => text!(language, "terms-cause-frost"),
    }
}

/// Returns the name of a measure with this key: a score, `flight_time`, `crashes`, `rms_distance`, `certification_sum`, or
/// `certification_` and a score of the certification profile; the key if there is no such measure.
#[must_use]
pub fn measure_title(key: &str, language: Language) -> String {
    match key {
        "certification_sum" => text!(language, "report-measure-certification-sum"),
        "flight_time" => text!(language, "report-measure-flight-time"),
        "crashes" => text!(language, "report-measure-crashes"),
        "rms_distance" => text!(language, "report-column-rms-distance"),
        other => match other.strip_prefix("certification_").and_then(|score| certification_title(score, language)) {
            Some(title) => title,
            None => score_title(other, language),
        },
    }
}

/// Returns the title of a job from its name and the title in its file. Titles other than those of the shipped files are the
/// user's and stay as they are.
#[must_use]
pub fn scenario_title(name: &str, title: &str, language: Language) -> String {
    let id = format!("job-{name}");
    let is_shipped = find(Language::English, &id, &[]).as_deref() == Some(title);
    find(language, &id, &[]).filter(|_| is_shipped).unwrap_or_else(|| title.to_owned())
}

/// Returns the title of the shipped job with this name; the name of another job.
#[must_use]
pub fn job_title(name: &str, language: Language) -> String {
    let is_shipped = SCENARIOS.iter().any(|(shipped, _)| *shipped == name);
    find(language, &format!("job-{name}"), &[]).filter(|_| is_shipped).unwrap_or_else(|| name.to_owned())
}

/// Returns the name of a task from the name of its job, which a level can follow, and the task's name in the job's file. Names in files
/// other than the shipped ones are the user's and stay as they are.
#[must_use]
pub fn task_title(scenario: &str, task: &str, language: Language) -> String {
    let scenario = scenario.split_once('@').map_or(scenario, |(job, _)| job);
    if !SCENARIOS.iter().any(|(name, _)| *name == scenario) {
        return task.to_owned();
    }
    shipped_task_title(task, language)
}

/// Returns tasks with their titles.
#[must_use]
pub fn task_titles(scenario: &str, tasks: &[(u32, String)], language: Language) -> Vec<(u32, String)> {
    tasks.iter().map(|(id, name)| (*id, task_title(scenario, name, language))).collect()
}

/// Returns the label of a change: within the error of its measure or beyond it.
#[must_use]
pub fn error_label(within_error: bool, language: Language) -> String {
    if within_error { text!(language, "report-within-error") } else { text!(language, "report-beyond-error") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::defect_codes::{self, defect_name};
    use spandrel_model::scenario;

    #[test]
    fn exact_english_names_are_those_of_the_model_and_others_are_translated() {
        let elements = Element::ALL.iter().map(|element| (element.name(), Language::ALL.map(|l| element_title(*element, l))));
        let defects = defect_codes::ALL.iter().map(|code| (defect_name(*code), Language::ALL.map(|l| defect_title(*code, l))));
        for (name, [english, german, spanish]) in elements.chain(defects) {
            assert_eq!(english, name);
            assert!(german != english && spanish != english && german != spanish, "{name}: {german}, {spanish}");
        }
        for (keyword, cause) in DefectCause::ALL {
            let [english, german, spanish] = Language::ALL.map(|language| cause_title(cause, language));
            assert!(german != english && spanish != english && german != spanish, "{keyword}: {english}, {german}, {spanish}");
        }
        assert_eq!(element_title(Element::RcDeck, Language::German), "Fahrbahntafel, Stahlbeton");
        assert_eq!(defect_title(defect_codes::SPALL, Language::Spanish), "delaminación o descascaramiento");
    }

    #[test]
    fn exact_titles_and_tasks_of_shipped_jobs_are_translated_and_those_of_others_are_not() {
        for (name, text) in SCENARIOS {
            let scenario = scenario::read(name, text, &|file| Err(file.to_owned())).unwrap();
            let shown = |language| scenario_title(&scenario.name, &scenario.title, language);
            assert_eq!(shown(Language::English), scenario.title);
            assert!(shown(Language::German) != scenario.title && !shown(Language::Pseudo).is_ascii(), "{name}");
            for task in &scenario.tasks {
                let shown = |language| task_title(&scenario.name, &task.name, language);
                assert_eq!(shown(Language::English), task.name);
                assert!(shown(Language::German) != task.name && !shown(Language::Pseudo).is_ascii(), "{name}: {}", task.name);
            }
        }
        assert_eq!(scenario_title("drill-hover", "My hover", Language::German), "My hover");
        assert_eq!(scenario_title("mine", "Drill: hover", Language::German), "Drill: hover");
        assert_eq!(task_title("mine", "Hover", Language::German), "Hover");
        assert_eq!(
            (job_title("drill-hover", Language::English), job_title("mine", Language::German)),
            ("Drill: hover".into(), "mine".into())
        );
        assert_eq!(job_title("task-hover", Language::German), "task-hover");
    }
}
