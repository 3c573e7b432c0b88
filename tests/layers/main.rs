//! Enforces the dependency rules that Cargo cannot: reads every path in the sources and compares it with the table in
//! ARCHITECTURE.md. Planted violations of each kind check that the rules are effective.
#![allow(clippy::unwrap_used, reason = "a test")]

mod paths;
mod rules;

use std::path::{Path, PathBuf};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect();
    files.sort();
    files
}

#[test]
fn exact_every_path_in_the_house_is_allowed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = rules::crates().map(|folder| root.join("crates").join(folder)).chain([root.to_owned()]);
    let files: Vec<PathBuf> = folders.flat_map(|folder| sources(&folder.join("src"))).collect();
    assert!(files.len() > 500, "only {} files were checked", files.len());
    let violations: Vec<String> = files
        .iter()
        .flat_map(|path| {
            let file = path.strip_prefix(root).unwrap().display().to_string();
            rules::violations(&file, &std::fs::read_to_string(path).unwrap())
        })
        .collect();
    assert!(violations.is_empty(), "\n{}", violations.join("\n"));
}

#[test]
fn exact_every_crate_has_a_place_in_the_table_and_depends_on_lower_ones_alone() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in std::fs::read_dir(root.join("crates")).unwrap() {
        let folder = entry.unwrap().file_name().into_string().unwrap();
        assert!(rules::crates().any(|name| name == folder), "crate {folder} is missing in tests/layers/rules.rs");
        let manifest = std::fs::read_to_string(root.join("crates").join(&folder).join("Cargo.toml")).unwrap();
        let dependencies = manifest.split("[dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
        for line in dependencies.lines() {
            let Some(name) = line.strip_prefix("spandrel-").and_then(|rest| rest.split(['.', ' ']).next()) else { continue };
            assert!(rules::may_depend_on(&folder).contains(&name), "{folder} must not depend on {name}");
        }
    }
}

#[test]
fn exact_the_map_names_every_room_and_quotes_real_places() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = std::fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    for room in rules::rooms() {
        assert!(map.contains(&format!("`{room}`")), "ARCHITECTURE.md does not contain {room}");
    }
    let quoted = map.split('`').skip(1).step_by(2);
    let places = quoted.filter(|text| {
        ["src/", "crates/", "tests/", "tools/", "scenarios/", "vehicle-params/"].iter().any(|start| text.starts_with(start))
    });
    for place in places {
        assert!(root.join(place).exists(), "ARCHITECTURE.md refers to {place}, which does not exist");
    }
}
