//! Tests of the briefing.

use super::*;
use crate::testing::untranslated_word;
use spandrel_model::scenario::edit::with_briefing_picture;
use spandrel_model::{scenario, shipped, vehicle};

fn briefing(text: &str) -> Briefing {
    briefing_in(text, Language::English)
}

fn briefing_in(text: &str, language: Language) -> Briefing {
    let scenario = scenario::read("job.toml", text, &|file| Err(file.to_owned())).unwrap();
    let vehicle = vehicle::read("phantom2.toml", shipped::PHANTOM2).unwrap();
    Briefing::new(&scenario, &vehicle, &Site::build(&scenario, 0), language)
}

#[test]
fn exact_briefing_of_the_paper_job_names_order_direction_and_hazards() {
    let briefing = briefing(shipped::TWO_BRIDGES);
    let ids: Vec<u32> = briefing.tasks.iter().map(|task| task.id).collect();
    assert_eq!(ids, [1, 2, 3, 4]);
    let loops: Vec<bool> = briefing.tasks.iter().map(|task| task.place.contains("once around")).collect();
    assert_eq!(loops, [false, false, false, true]);
    let lamp: Vec<String> = briefing.tasks.iter().filter(|task| task.lamp).map(|task| task.id.to_string()).collect();
    assert!(briefing.hazards.contains(&format!("Darkness: the lamp is needed in tasks {}.", lamp.join(", "))));
    assert_eq!(briefing.site_check.len(), 4);
    assert!(briefing.site_check[3].contains("walk to one of the 3 other places"), "{}", briefing.site_check[3]);
    let total_m: f64 = briefing.tasks.iter().map(|task| task.length_m).sum();
    let tasks = briefing.conditions.iter().find(|(name, _)| name == "tasks").map(|(_, value)| value.clone());
    assert_eq!(tasks, Some(format!("4, {total_m:.0} m of path")));
}

#[test]
fn exact_every_shipped_job_has_a_briefing_that_fits_a_terminal() {
    for (name, text) in shipped::SCENARIOS {
        let briefing = briefing(text);
        assert!(!briefing.counts.is_empty() && !briefing.site_check.is_empty(), "{name}");
        let shown = text::render(&briefing, Language::English);
        assert!(shown.lines().all(|line| line.chars().count() <= 96), "{name}:\n{shown}");
        assert!(shown.contains(&briefing.title) && !shown.contains("inf") && !shown.contains("NaN"), "{name}:\n{shown}");
        for line in briefing.hazards.iter().chain(&briefing.site_check) {
            assert!(line.ends_with('.'), "{name}: {line}");
        }
    }
}

#[test]
fn exact_the_instructors_words_come_first() {
    let text = format!("briefing = [\"Meet at the gate.\", \"Bring a vest.\"]\n{}", shipped::TWO_BRIDGES);
    let briefing = briefing(&text);
    assert_eq!(briefing.notes, ["Meet at the gate.", "Bring a vest."]);
    let shown = text::render(&briefing, Language::English);
    assert!(shown.find("Meet at the gate.") < shown.find("Tasks, in this order"), "{shown}");
}

#[test]
fn exact_pictures_follow_the_words_with_file_and_caption() {
    let picture = BriefingPicture { file: "site/gate.jpg".into(), caption: "The gate, seen from the road".into() };
    let briefing = briefing(&with_briefing_picture(shipped::TWO_BRIDGES, &picture).unwrap());
    let shown = text::render(&briefing, Language::English);
    assert!(shown.contains("\nPictures from your instructor\n  site/gate.jpg: The gate, seen from the road\n"), "{shown}");
    assert!(!text::render(&self::briefing(shipped::TWO_BRIDGES), Language::English).contains("Pictures"));
    assert_eq!(briefing.pictures, [picture]);
}

#[test]
fn exact_briefing_is_in_the_language_of_the_page() {
    let shown = |language| text::render(&briefing_in(shipped::TWO_BRIDGES, language), language);
    let german = shown(Language::German);
    assert!(
        german.contains("\nGefahren\n")
            && german.contains("in beliebiger Richtung")
            && german.contains("Für die Zertifizierung: "),
        "{german}"
    );
    let words = shown(Language::Pseudo);
    assert_eq!(untranslated_word(&words, &["arch", "suspension", "Phantom", "class", "mph", "s", "x", "dB"]), None, "{words}");
}
