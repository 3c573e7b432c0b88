//! Holds who may know whom: reads every path in `src/` and compares it with the table of ARCHITECTURE.md. Its own tests plant each kind
//! of violation, so that a rule that no longer bites is noticed.

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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files = sources(&root);
    assert!(files.len() > 50, "only {} files were read", files.len());
    let violations: Vec<String> = files
        .iter()
        .flat_map(|path| {
            let file = path.strip_prefix(&root).unwrap().display().to_string();
            rules::violations(&file, &std::fs::read_to_string(path).unwrap())
        })
        .collect();
    assert!(violations.is_empty(), "\n{}", violations.join("\n"));
}

#[test]
fn exact_every_room_has_a_place_in_the_table() {
    let library = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    for line in library.lines() {
        if let Some(room) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';')) {
            assert!(rules::is_room(room), "the room {room} is missing in tests/layers/rules.rs");
        }
    }
}

#[test]
fn exact_the_map_names_every_room_and_quotes_real_places() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = std::fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    for room in rules::rooms() {
        assert!(
            map.contains(&format!("`{room}/`")) || map.contains(&format!("`src/{room}/`")),
            "ARCHITECTURE.md leaves out {room}"
        );
    }
    let quoted = map.split('`').skip(1).step_by(2);
    let places = quoted
        .filter(|text| ["src/", "tests/", "tools/", "scenarios/", "vehicle-params/"].iter().any(|start| text.starts_with(start)));
    for place in places {
        assert!(root.join(place).exists(), "ARCHITECTURE.md names {place}, which is not there");
    }
}
