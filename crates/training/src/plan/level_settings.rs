//! The values at a difficulty level in the language of a page. Scenarios describe them in English.

use spandrel_text::{Language, Sentence, SentenceTable, text};
use std::sync::LazyLock;

/// Separates the values in the scenario's description.
const SEPARATOR: &str = ", ";

/// Descriptions of the quantities.
static SETTINGS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(1, |l, v| text!(l, "plan-setting-wind", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-turbulence", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-threshold", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-crown-gap", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-detection", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-size-factor", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-hazard-severity", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-time-best", value = value(v[0], l))),
        Sentence::new(1, |l, v| text!(l, "plan-setting-time-max", value = value(v[0], l))),
    ])
});

/// Returns a value with its unit, or a range such as "1.2 to 1.8 m".
fn value(value: &str, language: Language) -> String {
    match value.split_once(" to ") {
        Some((low, high)) => text!(language, "plan-setting-range", low = low, high = high),
        None => value.to_owned(),
    }
}

/// Returns the values at a level, such as "wind 2.73 m/s, on path within 1.33 m", in a language.
#[must_use]
pub fn level_settings(settings: &str, language: Language) -> String {
    let translated = |part: &str| SETTINGS.translate(part, language).unwrap_or_else(|| part.to_owned());
    settings.split(SEPARATOR).map(translated).collect::<Vec<_>>().join(SEPARATOR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario;
    use spandrel_model::shipped::SCENARIOS;

    #[test]
    fn exact_levels_of_all_shipped_jobs_are_described_in_every_language() {
        let mut levels = 0;
        for (name, text) in SCENARIOS {
            let scenario = scenario::read(name, text, &|file| Err(file.to_owned())).unwrap();
            for settings in scenario.difficulty.iter().flat_map(|difficulty| &difficulty.settings) {
                levels += 1;
                assert_eq!(level_settings(settings, Language::English), *settings);
                for part in settings.split(SEPARATOR) {
                    let [german, spanish] = [Language::German, Language::Spanish].map(|l| level_settings(part, l));
                    assert!(german != part && spanish != part, "{name}: {part}");
                }
            }
        }
        assert!(levels > 20, "{levels}");
    }

    #[test]
    fn exact_values_and_ranges_are_in_the_language() {
        let settings = "wind 2.73 m/s, on path within 1 to 1.5 m, predicted detection 60%, full score up to 4 min";
        let german = "Wind 2.73 m/s, Bahntoleranz 1 bis 1.5 m, vorhergesagte Entdeckung 60%, volle Punktzahl bis 4 min";
        assert_eq!(level_settings(settings, Language::German), german);
        let others = "turbulence 0.5, gap 3 m, defect size factor 2, hazard severity 1.5, time limit 9 min";
        assert_eq!(
            level_settings(others, Language::Spanish),
            "turbulencia 0.5, espacio intermedio 3 m, factor de tamaño de los defectos 2, intensidad de los peligros 1.5, límite de tiempo 9 min"
        );
        assert_eq!(level_settings("", Language::German), "");
    }
}
