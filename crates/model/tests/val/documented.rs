//! Tests that the READMEs of scenarios and vehicles document exactly the keys, ranges and defaults in the code.

use crate::shipped::files;
use spandrel_model::scenario::BridgeKind;
use spandrel_model::toml::DocumentedKey;
use std::collections::BTreeMap;
use std::path::Path;

type Keys = BTreeMap<String, DocumentedKey>;

/// Scenario fragments with keys that no shipped scenario uses. They need not be valid, since keys are recorded before values are
/// checked.
const OTHER_BRANCHES: [&str; 3] = [
    "[terrain]\nsource = \"flat\"\n[[wind.events]]\nkind = \"gust\"\n[[wind.events]]\nkind = \"change\"\n[[defects.placed]]\n",
    "[terrain]\nsource = \"valley\"\n[[bridges]]\ntype = \"arch\"\n[[bridges]]\ntype = \"suspension\"\n",
    "[terrain]\nsource = \"file\"\n[[tasks]]\nkind = \"free\"\n[[tasks]]\nkind = \"interlayer\"\nbridge = \"none\"\n",
];

fn merge(all: &mut Keys, keys: Keys) {
    for (key, asked) in keys {
        let known = all.entry(key.clone()).or_insert_with(|| asked.clone());
        assert_eq!(*known, asked, "{key} has two different definitions");
    }
}

fn scenario_keys() -> Keys {
    let mut all = Keys::new();
    let shipped = files("scenarios").into_iter().map(|path| std::fs::read_to_string(path).unwrap());
    for text in shipped.chain(OTHER_BRANCHES.map(String::from)) {
        merge(&mut all, spandrel_model::scenario::read_asked("keys.toml", &text, &|_| Err("no file".into())).1);
    }
    all
}

fn vehicle_keys() -> Keys {
    let mut all = Keys::new();
    for path in files("vehicle-params") {
        merge(&mut all, spandrel_model::vehicle::read_asked("keys.toml", &std::fs::read_to_string(path).unwrap()).1);
    }
    all
}

const HEADER: &str = "| key | allowed | default | meaning |";

/// Returns key, definition and meaning from each row of the key tables in a README.
fn documented(readme: &str) -> Vec<(String, DocumentedKey, String)> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(readme);
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let cells: Vec<&str> = line.strip_prefix("| `")?.strip_suffix(" |")?.splitn(4, " | ").collect();
        let [key, allowed, default, meaning] = cells[..] else { panic!("{readme}: the row does not have four columns: {line}") };
        let asked = DocumentedKey { allowed: allowed.into(), default: default.into() };
        Some((key.trim_end_matches('`').to_string(), asked, meaning.to_string()))
    };
    let tables = text.split(HEADER).skip(1).flat_map(|rest| rest.lines().skip(1).take_while(|line| !line.is_empty()));
    tables.filter_map(row).collect()
}

fn compare(readme: &str, keys: &Keys) -> Vec<String> {
    let rows = documented(readme);
    let mut wrong = Vec::new();
    for (key, asked, meaning) in &rows {
        let right = keys.get(key);
        if right != Some(asked) {
            wrong.push(format!("{key}: {asked:?} in the README, but {right:?} in the code"));
        }
        if meaning.trim().is_empty() {
            wrong.push(format!("{key}: the meaning is empty"));
        }
        if rows.iter().filter(|row| row.0 == *key).count() != 1 {
            wrong.push(format!("{key}: documented twice"));
        }
    }
    for (key, asked) in keys.iter().filter(|(key, _)| !rows.iter().any(|row| row.0 == **key)) {
        wrong.push(format!("missing row: | `{key}` | {} | {} | |", asked.allowed, asked.default));
    }
    wrong
}

#[test]
fn val_every_scenario_key_is_documented_as_the_code_reads_it() {
    let wrong = compare("scenarios/README.md", &scenario_keys());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn val_the_dimensions_of_every_bridge_type_are_documented_with_their_meaning() {
    let rows = documented("scenarios/README.md");
    for bridge in BridgeKind::TYPES {
        for field in bridge.fields {
            let key = format!("bridges[].{}.{}", bridge.name, field.key);
            let row = rows.iter().find(|row| row.0 == key).unwrap_or_else(|| panic!("{key} is not documented"));
            assert_eq!(row.2, field.meaning, "{key}");
        }
    }
}

#[test]
fn val_every_aircraft_key_is_documented_as_the_code_reads_it() {
    let wrong = compare("vehicle-params/README.md", &vehicle_keys());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
