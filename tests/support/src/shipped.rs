//! The shipped scenarios and vehicles by name.

use spandrel_model::scenario::{self, Scenario};
use spandrel_model::shipped::{SCENARIOS, VEHICLES};
use spandrel_model::vehicle::{self, Vehicle};

/// Returns the text of a shipped file; `path` is relative to the workspace root, such as `scenarios/drill-hover.toml`.
pub fn text(path: &str) -> String {
    std::fs::read_to_string(format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR")))
        .unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn named(files: &[(&str, &'static str)], name: &str) -> &'static str {
    files.iter().find(|(stem, _)| *stem == name).unwrap_or_else(|| panic!("no shipped file is named {name}")).1
}

pub fn scenario(name: &str) -> Scenario {
    let file = format!("scenarios/{name}.toml");
    scenario::read(&file, named(SCENARIOS, name), &|f| Err(f.into())).unwrap_or_else(|problems| panic!("{problems}"))
}

pub fn vehicle(name: &str) -> Vehicle {
    let file = format!("vehicle-params/{name}.toml");
    vehicle::read(&file, named(VEHICLES, name)).unwrap_or_else(|problems| panic!("{problems}"))
}
