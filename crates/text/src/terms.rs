//! Terms that several pages, the window and the monitor share, by their words in files.

use crate::language::Language;
use crate::text;

/// Returns the name of a score with this key, such as `conformity`; the key if there is no such score.
#[must_use]
pub fn score_title(key: &str, language: Language) -> String {
    match key {
        "overall" => text!(language, "terms-score-overall"),
        "conformity" => text!(language, "terms-score-conformity"),
        "efficiency" => text!(language, "terms-score-efficiency"),
        "safety" => text!(language, "terms-score-safety"),
        "accuracy" => text!(language, "terms-score-accuracy"),
        _ => key.to_owned(),
    }
}

/// Returns the name of a kind of object hit with this label, such as `terrain`; the label if there is no such kind.
#[must_use]
pub fn contact_title(label: &str, language: Language) -> String {
    match label {
        "none" => text!(language, "terms-contact-none"),
        "bridge" => text!(language, "terms-contact-bridge"),
        "terrain" => text!(language, "terms-contact-ground"),
        "water" => text!(language, "terms-contact-water"),
        "vehicle" => text!(language, "terms-contact-vehicle"),
        "person" => text!(language, "terms-contact-person"),
        "other" => text!(language, "terms-contact-other"),
        _ => label.to_owned(),
    }
}

/// Returns why a flight ended, by the word in files, such as `time_limit`; the word if there is no such reason.
#[must_use]
pub fn end_reason_title(reason: &str, language: Language) -> String {
    match reason {
        "landed" => text!(language, "terms-end-landed"),
        "battery" => text!(language, "terms-end-battery"),
        "time_limit" => text!(language, "terms-end-time-limit"),
        "person" => text!(language, "terms-end-person"),
        "vehicle" => text!(language, "terms-end-vehicle"),
        "crash" => text!(language, "terms-end-crash"),
        "abort" => text!(language, "terms-end-abort"),
        "restart" => text!(language, "terms-end-restart"),
        _ => reason.replace('_', " "),
    }
}

/// Returns the name of a flight's purpose, by the word in files; the word if there is no such purpose.
#[must_use]
pub fn purpose_title(purpose: &str, language: Language) -> String {
    match purpose {
        "practice" => text!(language, "terms-purpose-practice"),
        "assessment" => text!(language, "terms-purpose-assessment"),
        _ => purpose.to_owned(),
    }
}

/// Returns the name of a task of a shipped job by its name in the job's file; the name itself if it is another one.
#[must_use]
pub fn shipped_task_title(task: &str, language: Language) -> String {
    match task {
        "Curve under the arch" => text!(language, "job-task-curve"),
        "Side of the slab, camera on the slab" => text!(language, "job-task-slab-framing"),
        "Gap between deck and arch" => text!(language, "job-task-gap"),
        "Hover" => text!(language, "job-task-hover"),
        "Arch bottom in the dark" => text!(language, "job-task-dark-arch"),
        "Out and back" => text!(language, "job-task-out-and-back"),
        "Orbit" => text!(language, "job-task-orbit"),
        "Pier, all faces" => text!(language, "job-task-pier-faces"),
        "Pier at 3 m" => text!(language, "job-task-pier-stand-off"),
        "Straight line" => text!(language, "job-task-straight-line"),
        "Square" => text!(language, "job-task-square"),
        "Slab of the arch bridge from one side" => text!(language, "job-task-slab"),
        "Arch-shaped bottom" => text!(language, "job-task-arch"),
        "Interlayer between deck and arch" => text!(language, "job-task-interlayer"),
        "Pier of the suspension bridge near the water" => text!(language, "job-task-pier"),
        "Outer girder and deck edge" => text!(language, "job-task-outer-girder"),
        "Girder bays of the last span" => text!(language, "job-task-girder-bays"),
        "Bearings on the start abutment" => text!(language, "job-task-bearings"),
        "Cap of the first pier" => text!(language, "job-task-pier-cap"),
        "Girder bays of the middle span" => text!(language, "job-task-middle-bays"),
        "Right truss of the first span" => text!(language, "job-task-right-truss"),
        "Floor system of the second span" => text!(language, "job-task-floor"),
        "Pins and bearings on the pier" => text!(language, "job-task-pins"),
        "Outer web and deck edge" => text!(language, "job-task-outer-web"),
        "Soffit of the main span" => text!(language, "job-task-main-soffit"),
        "Soffit of the last span" => text!(language, "job-task-last-soffit"),
        "Right spandrel wall and parapet" => text!(language, "job-task-spandrel-wall"),
        "Barrel of the middle span" => text!(language, "job-task-barrel"),
        "Barrel of the last span" => text!(language, "job-task-last-barrel"),
        "Arch ring of the first span" => text!(language, "job-task-arch-ring"),
        "First pier and its cutwaters" => text!(language, "job-task-cutwaters"),
        "Edge girder, stays and deck edge" => text!(language, "job-task-edge-girder"),
        "Longest stay of the start tower" => text!(language, "job-task-longest-stay"),
        "Floor of the start side span" => text!(language, "job-task-side-floor"),
        "Bearings on the second pier" => text!(language, "job-task-pier-bearings"),
        _ => task.to_owned(),
    }
}

/// Returns the words with an uppercase first letter.
#[must_use]
pub fn capitalized(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_terms_are_found_by_their_words_in_files_and_others_stay() {
        assert_eq!(score_title("safety", Language::Spanish), "seguridad");
        assert_eq!(contact_title("terrain", Language::English), "ground");
        assert_eq!(end_reason_title("time_limit", Language::German), "Zeitlimit erreicht");
        assert_eq!(purpose_title("assessment", Language::German), "Bewertungsflug");
        assert_eq!(end_reason_title("no_such_reason", Language::German), "no such reason");
        assert_eq!((score_title("x", Language::German), contact_title("x", Language::German)), ("x".into(), "x".into()));
    }

    #[test]
    fn exact_only_the_first_letter_changes() {
        assert_eq!(
            (capitalized("límite"), capitalized("éxito"), capitalized("")),
            ("Límite".into(), "Éxito".into(), String::new())
        );
    }
}
