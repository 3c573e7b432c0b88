//! Rules for training plans, from a file or built in.

use super::files;
use crate::errors::AppError;
use spandrel_training::plan::{DEFAULT_RULES, PlanRules, read_rules};
use std::path::Path;

/// Returns the rules from a file, or the built-in rules if no file is specified. Scenarios that are not installed are
/// replaced by the rules' alternatives. The rules include the difficulty levels of the shipped drills.
///
/// # Errors
/// Returns an error if the file cannot be read or is invalid.
pub fn rules(file: Option<&Path>) -> Result<PlanRules, AppError> {
    let rules = match file {
        Some(path) => read_rules(&path.display().to_string(), &files::read(path)?)?,
        None => read_rules("rules.toml", DEFAULT_RULES)?,
    };
    Ok(rules.for_installed(|name| files::scenario_names().contains(&name)).with_shipped_levels())
}
