//! Text of the scenario and vehicle files that ship with Spandrel. New files in `scenarios/` or `vehicle-params/` are included
//! automatically.

include!(concat!(env!("OUT_DIR"), "/shipped.rs"));

/// Returns a shipped job's text without its section `[hazards]`, to compare flights with and without hazards.
#[must_use]
pub fn without_hazards(job: &str) -> String {
    let mut inside = false;
    let mut kept = String::new();
    for line in job.lines() {
        if line.starts_with('[') {
            inside = line == "[hazards]";
        }
        if !inside {
            kept.extend([line, "\n"]);
        }
    }
    kept
}

/// Text of `scenarios/README.md`, with the table of all keys.
pub const SCENARIO_README: &str = include_str!("../../../scenarios/README.md");
