//! Tests that the READMEs of scenarios and vehicles document exactly the keys, ranges and defaults in the code.

use crate::shipped_files::toml_files;
use spandrel_model::key_table::{self, KeyDescription};
use spandrel_model::scenario::BridgeKind;
use spandrel_model::toml::DocumentedKey;
use std::collections::BTreeMap;
use std::path::Path;

type Keys = BTreeMap<String, DocumentedKey>;

/// Scenario fragments with keys that no shipped scenario uses. They need not be valid, because keys are recorded before
/// values are checked.
const EXTRA_FRAGMENTS: [&str; 4] = [
    "[terrain]\nsource = \"flat\"\n[[wind.events]]\nkind = \"gust\"\n[[wind.events]]\nkind = \"change\"\n[[defects.placed]]\n[[briefing_pictures]]\n[[drones]]\n[[ropes]]\n",
    "[terrain]\nsource = \"valley\"\n[[bridges]]\ntype = \"model\"\n",
    "[terrain]\nsource = \"geotiff\"\n",
    "[terrain]\nsource = \"file\"\n[[tasks]]\nkind = \"free\"\n[[tasks]]\nkind = \"interlayer\"\nbridge = \"none\"\n",
];

fn merge_keys(all: &mut Keys, keys: Keys) {
    for (key, asked) in keys {
        let known = all.entry(key.clone()).or_insert_with(|| asked.clone());
        assert_eq!(*known, asked, "{key} has two different definitions");
    }
}

fn scenario_keys() -> Keys {
    let mut all = Keys::new();
    let shipped = toml_files("scenarios").into_iter().map(|path| std::fs::read_to_string(path).unwrap());
    let of_types = BridgeKind::TYPES.iter().map(|bridge| format!("[[bridges]]\ntype = \"{}\"\n", bridge.name));
    for to_text in shipped.chain(EXTRA_FRAGMENTS.map(String::from)).chain(of_types) {
        merge_keys(&mut all, spandrel_model::scenario::read_with_keys("keys.toml", &to_text, &|_| Err("no file".into())).1);
    }
    all
}

fn vehicle_keys() -> Keys {
    let mut all = Keys::new();
    for path in toml_files("vehicle-params") {
        merge_keys(&mut all, spandrel_model::vehicle::read_with_keys("keys.toml", &std::fs::read_to_string(path).unwrap()).1);
    }
    all
}

/// Returns the rows of the key tables in a README.
fn documented_keys(readme: &str) -> Vec<KeyDescription> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(readme);
    key_table::parse(&std::fs::read_to_string(path).unwrap())
}

fn find_differences(readme: &str, keys: &Keys) -> Vec<String> {
    let rows = documented_keys(readme);
    let mut wrong = Vec::new();
    for KeyDescription { key, documented: asked, meaning } in &rows {
        let right = keys.get(key);
        if right != Some(asked) {
            wrong.push(format!("{key}: {asked:?} in the README, but {right:?} in the code"));
        }
        if meaning.trim().is_empty() {
            wrong.push(format!("{key}: the meaning is empty"));
        }
        if rows.iter().filter(|row| row.key == *key).count() != 1 {
            wrong.push(format!("{key}: documented twice"));
        }
    }
    for (key, asked) in keys.iter().filter(|(key, _)| !rows.iter().any(|row| row.key == **key)) {
        wrong.push(format!("missing row: | `{key}` | {} | {} | |", asked.allowed, asked.default));
    }
    wrong
}

#[test]
fn val_scenario_keys_match_the_documentation() {
    let wrong = find_differences("scenarios/README.md", &scenario_keys());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn val_bridge_dimensions_are_documented_with_their_meaning() {
    let rows = documented_keys("scenarios/README.md");
    for bridge in BridgeKind::TYPES {
        for field in bridge.fields {
            let key = format!("bridges[].{}.{}", bridge.name, field.key);
            let row = rows.iter().find(|row| row.key == key).unwrap_or_else(|| panic!("{key} is not documented"));
            assert_eq!(row.meaning, field.meaning, "{key}");
        }
    }
}

#[test]
fn val_vehicle_keys_match_the_documentation() {
    let wrong = find_differences("vehicle-params/README.md", &vehicle_keys());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
