//! Scenarios and vehicles, given by shipped name or file path, and autopilot protocols.

use crate::errors::{self, JobError};
use pyo3::prelude::*;
use spandrel_model::scenario::{self, AfterCrash, Scenario};
use spandrel_model::shipped;
use spandrel_model::vehicle::{self, Vehicle};
use spandrel_sitl::endpoint::flavor::{Flavor, ardupilot, generic, px4};
use std::fs;
use std::path::Path;

/// Returns the names of the shipped scenarios.
#[pyfunction]
pub fn scenarios() -> Vec<&'static str> {
    shipped::SCENARIOS.iter().map(|(name, _)| *name).collect()
}

/// Returns the names of the shipped vehicles.
#[pyfunction]
pub fn vehicles() -> Vec<&'static str> {
    shipped::VEHICLES.iter().map(|(name, _)| *name).collect()
}

/// Reads a scenario by shipped name or file path. A form or a difficulty level follows an `@`, as in `pilot-study@B` or
/// `drill-gap@6`.
pub fn read_scenario(argument: &str) -> PyResult<Scenario> {
    let (name, variant) = split_variant(argument);
    let text = read_text(name, "scenario", shipped::SCENARIOS)?;
    let Some(variant) = variant else { return parse_scenario(name, &text) };
    let selected = scenario::select_variant(&text, variant).ok_or_else(|| {
        let names = scenario::variant_names(&text);
        let allowed = if names.is_empty() { "it has none".to_owned() } else { format!("allowed: {}", names.join(", ")) };
        JobError::new_err(format!("{name}: no form or difficulty level '{variant}' ({allowed})"))
    })?;
    parse_scenario(name, &selected)
}

/// Reads the form or difficulty level of a scenario that has this CRC; `None` if there is none, or if the argument selects
/// another one.
pub fn read_variant_with_crc(argument: &str, crc: u32) -> PyResult<Option<Scenario>> {
    if split_variant(argument).1.is_some() {
        return Ok(None);
    }
    let text = read_text(argument, "scenario", shipped::SCENARIOS)?;
    scenario::variant_with_crc(&text, &|file| read_sibling(argument, file), crc)
        .map(|variant| parse_scenario(argument, &variant))
        .transpose()
}

/// Splits an argument into the scenario and its form or difficulty level, if it selects one.
fn split_variant(argument: &str) -> (&str, Option<&str>) {
    match argument.rsplit_once('@') {
        Some((name, variant)) if !variant.contains(['/', '\\', '.']) => (name, Some(variant)),
        Some(_) | None => (argument, None),
    }
}

/// Parses a scenario. The files that it names, such as height maps, are read from its folder.
fn parse_scenario(name: &str, text: &str) -> PyResult<Scenario> {
    scenario::read(&file_name(name), text, &|file| read_sibling(name, file)).map_err(|problems| errors::problems(&problems))
}

/// Reads a file in the folder of a scenario.
fn read_sibling(name: &str, file: &str) -> Result<Vec<u8>, String> {
    let folder = Path::new(name).parent().unwrap_or(Path::new("."));
    fs::read(folder.join(file)).map_err(|error| error.to_string())
}

/// Reads a vehicle by shipped name or file path.
pub fn read_vehicle(name: &str) -> PyResult<Vehicle> {
    let text = read_text(name, "vehicle", shipped::VEHICLES)?;
    vehicle::read(&file_name(name), &text).map_err(|problems| errors::problems(&problems))
}

fn file_name(name: &str) -> String {
    if is_path(name) { name.to_owned() } else { format!("{name}.toml") }
}

/// Returns whether the name is a path. Shipped names have neither an extension nor a folder.
fn is_path(name: &str) -> bool {
    name.contains(['.', '/', '\\'])
}

fn read_text(name: &str, what: &str, shipped: &[(&str, &str)]) -> PyResult<String> {
    if is_path(name) {
        return fs::read_to_string(name).map_err(|error| JobError::new_err(format!("{name}: {error}")));
    }
    let found = shipped.iter().find(|(stem, _)| *stem == name);
    found.map(|(_, text)| (*text).to_owned()).ok_or_else(|| {
        let names: Vec<&str> = shipped.iter().map(|(stem, _)| *stem).collect();
        JobError::new_err(format!("{name}: no such {what}; use a .toml file or one of {}", names.join(", ")))
    })
}

/// Returns an autopilot protocol by name.
pub fn flavor(name: &str) -> PyResult<&'static Flavor> {
    match name {
        "px4" => Ok(&px4::FLAVOR),
        "ardupilot" => Ok(&ardupilot::FLAVOR),
        "generic" => Ok(&generic::FLAVOR),
        _ => Err(JobError::new_err(format!("unknown flavor {name}; allowed: px4, ardupilot, generic"))),
    }
}

/// Returns the rule after a crash; `None` for the scenario's own rule.
pub fn after_crash(name: &str) -> PyResult<Option<AfterCrash>> {
    match name {
        "scenario" => Ok(None),
        "continue" => Ok(Some(AfterCrash::Continue)),
        "respawn" => Ok(Some(AfterCrash::Respawn)),
        "end" => Ok(Some(AfterCrash::End)),
        _ => Err(JobError::new_err(format!("unknown crash rule {name}; allowed: scenario, continue, respawn, end"))),
    }
}
