//! Names of bridge elements, defects, scores, tasks and jobs in the language of a page: AASHTO MBEI in English, DIN 1076 and
//! RI-EBW-PRÜF in German.

use spandrel_model::defect_codes::{ABRASION, CONNECTION, CORROSION, CRACK, EFFLORESCENCE, FATIGUE, PSC_CRACK, REBAR, SPALL};
use spandrel_model::elements::Element;
use spandrel_model::shipped::SCENARIOS;
use spandrel_text::{Language, text};

/// Returns the name of an element: the part, then its material.
#[must_use]
pub fn element_title(element: Element, language: Language) -> String {
    match element {
        Element::RcDeck => text!(language, "terms-element-12"),
        Element::PscDeck => text!(language, "terms-element-13"),
        Element::PscTopFlange => text!(language, "terms-element-15"),
        Element::RcTopFlange => text!(language, "terms-element-16"),
        Element::SteelOpenGridDeck => text!(language, "terms-element-28"),
        Element::SteelFilledGridDeck => text!(language, "terms-element-29"),
        Element::SteelOrthotropicDeck => text!(language, "terms-element-30"),
        Element::TimberDeck => text!(language, "terms-element-31"),
        Element::RcSlab => text!(language, "terms-element-38"),
        Element::PscSlab => text!(language, "terms-element-39"),
        Element::SteelBoxGirder => text!(language, "terms-element-102"),
        Element::PscBoxGirder => text!(language, "terms-element-104"),
        Element::RcBoxGirder => text!(language, "terms-element-105"),
        Element::SteelGirder => text!(language, "terms-element-107"),
        Element::PscGirder => text!(language, "terms-element-109"),
        Element::RcGirder => text!(language, "terms-element-110"),
        Element::SteelStringer => text!(language, "terms-element-113"),
        Element::PscStringer => text!(language, "terms-element-115"),
        Element::RcStringer => text!(language, "terms-element-116"),
        Element::SteelTruss => text!(language, "terms-element-120"),
        Element::SteelArch => text!(language, "terms-element-141"),
        Element::OtherArch => text!(language, "terms-element-142"),
        Element::PscArch => text!(language, "terms-element-143"),
        Element::RcArch => text!(language, "terms-element-144"),
        Element::MasonryArch => text!(language, "terms-element-145"),
        Element::MainCable => text!(language, "terms-element-147"),
        Element::Hanger => text!(language, "terms-element-148"),
        Element::OtherSecondaryCable => text!(language, "terms-element-149"),
        Element::SteelFloorBeam => text!(language, "terms-element-152"),
        Element::PscFloorBeam => text!(language, "terms-element-154"),
        Element::RcFloorBeam => text!(language, "terms-element-155"),
        Element::Pin => text!(language, "terms-element-161"),
        Element::GussetPlate => text!(language, "terms-element-162"),
        Element::SteelColumn => text!(language, "terms-element-202"),
        Element::PscColumn => text!(language, "terms-element-204"),
        Element::RcColumn => text!(language, "terms-element-205"),
        Element::SteelTower => text!(language, "terms-element-207"),
        Element::RcPierWall => text!(language, "terms-element-210"),
        Element::MasonryPierWall => text!(language, "terms-element-213"),
        Element::RcAbutment => text!(language, "terms-element-215"),
        Element::RcFooting => text!(language, "terms-element-220"),
        Element::SteelPile => text!(language, "terms-element-225"),
        Element::PscPile => text!(language, "terms-element-226"),
        Element::RcPile => text!(language, "terms-element-227"),
        Element::SteelPierCap => text!(language, "terms-element-231"),
        Element::PscPierCap => text!(language, "terms-element-233"),
        Element::RcPierCap => text!(language, "terms-element-234"),
        Element::StripSealJoint => text!(language, "terms-element-300"),
        Element::PourableJoint => text!(language, "terms-element-301"),
        Element::CompressionJoint => text!(language, "terms-element-302"),
        Element::SealedAssemblyJoint => text!(language, "terms-element-303"),
        Element::OpenJoint => text!(language, "terms-element-304"),
        Element::UnsealedAssemblyJoint => text!(language, "terms-element-305"),
        Element::OtherJoint => text!(language, "terms-element-306"),
        Element::ElastomericBearing => text!(language, "terms-element-310"),
        Element::MovableBearing => text!(language, "terms-element-311"),
        Element::EnclosedBearing => text!(language, "terms-element-312"),
        Element::FixedBearing => text!(language, "terms-element-313"),
        Element::PotBearing => text!(language, "terms-element-314"),
        Element::DiskBearing => text!(language, "terms-element-315"),
        Element::OtherBearing => text!(language, "terms-element-316"),
        Element::PscApproachSlab => text!(language, "terms-element-320"),
        Element::RcApproachSlab => text!(language, "terms-element-321"),
        Element::MetalRailing => text!(language, "terms-element-330"),
        Element::RcRailing => text!(language, "terms-element-331"),
        Element::TimberRailing => text!(language, "terms-element-332"),
        Element::OtherRailing => text!(language, "terms-element-333"),
        Element::MasonryRailing => text!(language, "terms-element-334"),
        Element::WearingSurface => text!(language, "terms-element-510"),
        Element::SteelCoating => text!(language, "terms-element-515"),
        Element::RebarProtection => text!(language, "terms-element-520"),
        Element::ConcreteCoating => text!(language, "terms-element-521"),
        Element::Unlisted(_) => text!(language, "terms-element-unlisted"),
    }
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
        _ => text!(language, "terms-defect-unknown"),
    }
}

/// Returns the name of a score with this key, such as `conformity`; the key if there is no such score.
#[must_use]
pub fn score_title(key: &str, language: Language) -> String {
    match key {
        "overall" => text!(language, "terms-score-overall"),
        "conformity" => text!(language, "terms-score-conformity"),
        "efficiency" => text!(language, "terms-score-efficiency"),
        "safety" => text!(language, "terms-score-safety"),
        "accuracy" => text!(language, "terms-score-accuracy"),
        "precision" => text!(language, "terms-score-precision"),
        _ => key.to_owned(),
    }
}

/// Returns the name of a kind of task with this key, such as `slab_side`; the key if there is no such kind.
#[must_use]
pub fn task_kind_title(key: &str, language: Language) -> String {
    match key {
        "slab_side" => text!(language, "terms-task-slab-side"),
        "arch_bottom" => text!(language, "terms-task-arch-bottom"),
        "interlayer" => text!(language, "terms-task-interlayer"),
        "pier_circle" => text!(language, "terms-task-pier-circle"),
        "free" => text!(language, "terms-task-free"),
        _ => key.to_owned(),
    }
}

/// Returns the name of a kind of object hit with this label, such as `terrain`; the label if there is no such kind.
#[must_use]
pub fn contact_title(label: &str, language: Language) -> String {
    match label {
        "none" => text!(language, "terms-contact-none"),
        "bridge" => text!(language, "terms-contact-bridge"),
        "terrain" => text!(language, "terms-contact-terrain"),
        "water" => text!(language, "terms-contact-water"),
        "vehicle" => text!(language, "terms-contact-vehicle"),
        "person" => text!(language, "terms-contact-person"),
        "other" => text!(language, "terms-contact-other"),
        _ => label.to_owned(),
    }
}

/// Returns the reason why a flight ended, from its label in a record, such as `time_limit`; the label if there is no such reason.
#[must_use]
pub fn end_reason_title(label: &str, language: Language) -> String {
    match label {
        "landed" => text!(language, "terms-end-landed"),
        "battery" => text!(language, "terms-end-battery"),
        "time_limit" => text!(language, "terms-end-time-limit"),
        "person" => text!(language, "terms-end-person"),
        "vehicle" => text!(language, "terms-end-vehicle"),
        "crash" => text!(language, "terms-end-crash"),
        "abort" => text!(language, "terms-end-abort"),
        "restart" => text!(language, "terms-end-restart"),
        _ => label.replace('_', " "),
    }
}

/// Returns the title of a job from its name and the title in its file. Titles other than those of the shipped files are the
/// user's and stay as they are.
#[must_use]
pub fn scenario_title(name: &str, title: &str, language: Language) -> String {
    match (name, title) {
        ("drill-curve-under-arch", "Drill: curve under the arch") => text!(language, "job-drill-curve-under-arch"),
        ("drill-framing", "Drill: framing") => text!(language, "job-drill-framing"),
        ("drill-gap", "Drill: gap") => text!(language, "job-drill-gap"),
        ("drill-hover", "Drill: hover") => text!(language, "job-drill-hover"),
        ("drill-lamp", "Drill: lamp") => text!(language, "job-drill-lamp"),
        ("drill-landing", "Drill: landing") => text!(language, "job-drill-landing"),
        ("drill-orbit", "Drill: orbit") => text!(language, "job-drill-orbit"),
        ("drill-search", "Drill: search") => text!(language, "job-drill-search"),
        ("drill-stand-off", "Drill: stand-off") => text!(language, "job-drill-stand-off"),
        ("drill-straight-line", "Drill: straight line") => text!(language, "job-drill-straight-line"),
        ("first-flight", "Lesson: first flight") => text!(language, "job-first-flight"),
        ("pilot-study", "Pilot study: slab side, arch bottom, interlayer, pier") => text!(language, "job-pilot-study"),
        ("practice", "Practice at two bridges") => text!(language, "job-practice"),
        ("two-bridges", "Two bridges: slab side, arch bottom, interlayer, pier") => text!(language, "job-two-bridges"),
        _ => title.to_owned(),
    }
}

/// Returns the name of a task from the name of its job and the task's name in the job's file. Names in files other than the
/// shipped ones are the user's and stay as they are.
#[must_use]
pub fn task_title(scenario: &str, task: &str, language: Language) -> String {
    if !SCENARIOS.iter().any(|(name, _)| *name == scenario) {
        return task.to_owned();
    }
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
        _ => task.to_owned(),
    }
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
        assert_eq!(element_title(Element::RcDeck, Language::German), "Fahrbahntafel, Stahlbeton");
        assert_eq!(defect_title(defect_codes::SPALL, Language::Spanish), "delaminación o descascaramiento");
        assert_eq!(end_reason_title("time_limit", Language::English), "time limit");
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
    }
}
