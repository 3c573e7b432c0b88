//! The catalogs: every language has the messages of the English one, with the same variables.

#![allow(clippy::unwrap_used, reason = "test code")]

use fluent_syntax::ast::Entry;
use spandrel_text::{Language, Value, message, text};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use variables::variables;

#[path = "../variables.rs"]
mod variables;

/// Files with texts whose English source is not the catalog.
const WITHOUT_ENGLISH: [&str; 1] = ["scenario-keys"];

/// Variables of each message.
type Messages = BTreeMap<String, BTreeSet<String>>;

fn folder(language: Language) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("catalog").join(language.tag())
}

/// Returns the catalog files of a language by name.
fn files(language: Language) -> BTreeMap<String, Messages> {
    let entries = std::fs::read_dir(folder(language)).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), read(&path))).collect()
}

fn read(path: &Path) -> Messages {
    let file = path.display();
    let text = std::fs::read_to_string(path).unwrap();
    let resource = fluent_syntax::parser::parse(text).unwrap_or_else(|(_, errors)| panic!("{file}: {errors:?}"));
    let mut messages = Messages::new();
    for entry in resource.body {
        match entry {
            Entry::Message(message) => {
                let found = message.value.as_ref().unwrap_or_else(|| panic!("{file}: {} has no text", message.id.name));
                let known = messages.insert(message.id.name.clone(), variables(found));
                assert!(known.is_none(), "{file}: {} twice", message.id.name);
            }
            Entry::Junk { content } => panic!("{file}: {content}"),
            Entry::Term(_) | Entry::Comment(_) | Entry::GroupComment(_) | Entry::ResourceComment(_) => {}
        }
    }
    messages
}

#[test]
fn exact_every_language_has_every_message_with_the_same_variables() {
    let english = files(Language::English);
    assert!(!english.is_empty());
    for language in Language::ALL {
        let mut own = files(language);
        own.retain(|file, _| language == Language::English || !WITHOUT_ENGLISH.contains(&file.as_str()));
        assert_eq!(own.keys().collect::<Vec<_>>(), english.keys().collect::<Vec<_>>(), "files of {language:?}");
        for (file, messages) in &english {
            let missing: Vec<&String> = messages.keys().filter(|id| !own[file].contains_key(*id)).collect();
            let unknown: Vec<&String> = own[file].keys().filter(|id| !messages.contains_key(*id)).collect();
            assert!(
                missing.is_empty() && unknown.is_empty(),
                "{language:?}, {file}.ftl: missing {missing:?}, unknown {unknown:?}"
            );
            for (id, variables) in messages {
                assert_eq!(&own[file][id], variables, "{language:?}, {file}.ftl: variables of {id}");
            }
        }
    }
}

#[test]
fn exact_texts_with_another_english_source_are_in_all_other_languages() {
    let (english, german, spanish) = (files(Language::English), files(Language::German), files(Language::Spanish));
    for file in WITHOUT_ENGLISH {
        assert!(!english.contains_key(file) && !german[file].is_empty());
        assert_eq!(german[file], spanish[file], "messages of {file}.ftl");
    }
}

#[test]
fn exact_catalogs_are_in_their_language() {
    for language in Language::ALL {
        assert_eq!(text!(language, "common-language-name"), language.name());
    }
}

#[test]
fn exact_names_begin_with_the_name_of_their_file() {
    for (file, messages) in Language::ALL.into_iter().flat_map(files) {
        for id in messages.keys() {
            assert!(id.starts_with(&format!("{file}-")), "{file}.ftl: {id}");
        }
    }
}

#[test]
fn exact_pseudo_language_changes_texts() {
    let pseudo = text!(Language::Pseudo, "common-language-name");
    assert!(!pseudo.is_ascii() && pseudo.chars().count() > "English".len(), "{pseudo}");
}

/// Messages with a number, and the word that they must have with the number 1, in English, German and Spanish.
const SINGULAR: &[(&str, &[&str], [&str; 3])] = &[
    ("advice-no-pictures", &["count"], ["the defect;", "keinen Schaden", "del defecto;"]),
    ("advice-none-found", &["all"], ["the defect;", "den Schaden nicht", "el defecto;"]),
    ("advice-moving-pictures", &["count", "taken"], ["your only picture", "Ihr einziges Bild", "su única foto"]),
    ("advice-picture-poor", &["count", "found"], ["the defect that", "dem gefundenen Schaden", "del defecto que"]),
    ("certification-job-contacts", &["contacts"], ["1 contact,", "höchstens 1", "1 contacto,"]),
    ("cohort-certified", &["certified", "sessions"], ["1 of 1 session.", "1 von 1 Sitzung.", "1 de 1 sesión."]),
    ("cohort-answers-first", &["count"], ["1 answer)", "1 Antwort)", "1 respuesta)"]),
    ("cohort-limit-imprecise", &["count"], ["1 trainee;", "1 Trainee;", "1 alumno;"]),
    ("editor-traffic-text", &["cars", "trucks", "pedestrians"], ["1 car, 1 truck, 1 pedestrian", "Pkw: 1", "autos: 1"]),
    ("editor-rules-summary", &["rules", "drills", "of"], ["1 rule, criteria for 1 drill.", "Regeln: 1", "Reglas: 1"]),
    ("live-gnss-now", &["satellites"], ["1 satellite", "1 Satellit", "1 satélite"]),
    ("live-gnss-lost", &["satellites"], ["1 satellite", "1 Satellit", "1 satélite"]),
    ("plan-tasks-over", &["over", "all"], ["1 of 1 task", "1 von 1 Aufgabe", "1 de 1 tarea"]),
    ("plan-drill-done", &["counted"], ["the last session met", "die letzte Sitzung erfüllte", "la última sesión cumplió"]),
    (
        "report-explain-defects",
        &["found", "placed", "hits", "taken"],
        ["1 defect found; 1 of 1 picture", "1 Bild zeigte ", "1 foto mostró"],
    ),
    ("report-explain-skipped", &["skipped", "tasks"], ["1 of 1 task ", "1 von 1 Aufgabe ", "1 tarea no iniciada"]),
    ("report-defects-count", &["found", "placed"], ["1 defect was", "1 Schaden wurde ", "Se encontró 1"]),
    (
        "sessions-defects-caption",
        &["found", "placed", "hits", "pictures"],
        ["1 of 1 picture ", "1 Bild zeigte ", "1 foto mostró"],
    ),
    ("sessions-standing-up", &["points"], ["1 point up", "1 Punkt mehr", "1 punto más"]),
    ("sessions-standing-down", &["points"], ["1 point down", "1 Punkt weniger", "1 punto menos"]),
    ("web-password-length", &["length"], ["1 character ", "1 Zeichen", "1 carácter "]),
    ("web-settings-erased", &["sessions", "folders"], ["1 session and 1 folder.", "Sitzungen: 1", "borradas: 1"]),
    ("window-result-lesson-steps", &["done", "steps"], ["1 of 1 step ", "1 von 1 Schritt ", "1 de 1 paso "]),
    ("window-train-lesson-progress", &["done", "steps"], ["1 of 1 step ", "1 von 1 Schritt ", "1 de 1 paso "]),
];

#[test]
fn exact_one_is_singular_in_every_language() {
    for (id, counted, expected) in SINGULAR {
        let all = &files(Language::English).into_values().find_map(|messages| messages.get(*id).cloned()).unwrap();
        for (language, expected) in Language::ALL.into_iter().zip(expected) {
            let value = |name: &String| if counted.contains(&name.as_str()) { Value::from(1) } else { Value::from("x") };
            let variables: Vec<(&str, Value<'_>)> = all.iter().map(|name| (name.as_str(), value(name))).collect();
            let shown = message(language, id, &variables);
            assert!(shown.contains(expected), "{id}, {}: {shown}", language.tag());
        }
    }
}
