//! `spandrel check`: reports all errors in scenario and vehicle files at once.

use crate::errors::{AppError, EXIT_CODES};
use crate::io::files::{self, SourceFile};
use serde_json::json;
use spandrel_model::scenario;
use spandrel_model::site::defects;
use spandrel_model::toml::{Problem, split_displayed};
use spandrel_model::vehicle;
use spandrel_text::Language;
use spandrel_training::scenario_check::{self, CheckOptions, Findings, ScenarioText};

/// Check scenario and vehicle files
///
/// Reports all errors at once, each with file, line, key, value and allowed range. For a scenario, it also builds the
/// site and reports every task with a reference path that is too close to an obstacle, with the location. The minimum
/// clearance is half the aircraft's tip-to-tip width plus 0.5 m. It also reports places of the inspector, and straight
/// paths from each to the next, that are in water, in a bridge, on the landing pad or at the truck. It loads the pictures of the
/// briefing. It warns if it cannot place as many defects as the scenario requests, and if more than 10% of a path is within the
/// threshold of another task. It prints the total quantity of each element of each bridge. For each form of a scenario, it prints
/// the predicted detection of the defects; for each difficulty level, it prints what the level changes.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel check my-bridge.toml                        check the paths for the default aircraft
  spandrel check my-bridge.toml --vehicle m30          check them for another aircraft
  spandrel check scenarios/*.toml vehicle-params/*.toml --json

{EXIT_CODES}"))]
pub struct Args {
    /// Scenario and vehicle files, or names of shipped scenarios and aircraft
    #[arg(value_name = "FILE", required = true)]
    files: Vec<String>,
    /// Form to check; the files must have it [default: all forms]
    #[arg(long, value_name = "NAME")]
    form: Option<String>,
    /// Difficulty level to check; the files must have it [default: the standard, the easiest and the hardest level]
    #[arg(long, value_name = "N", conflicts_with = "form")]
    level: Option<u8>,
    /// Aircraft for the clearance check: a file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    vehicle: String,
    /// Print {"problems": [{file, line, key, value, allowed, message}], "warnings": [...], "notes": [...]} on standard
    /// output
    #[arg(long)]
    json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if a file is invalid.
pub fn run(args: &Args) -> Result<(), AppError> {
    let aircraft = files::vehicle(&args.vehicle)?.vehicle;
    let options = CheckOptions { aircraft: &aircraft, may_continue: &|| true, language: Language::English };
    let mut findings = Findings::default();
    for file in &args.files {
        match files::any_source(&files::with_variant(file, args.form.as_deref(), args.level)) {
            Ok(source) => check_file(&source, args, &options, &mut findings),
            Err(error) => findings.problems.push(unreadable(file, &error)),
        }
    }
    let Findings { problems, warnings, notes } = &findings;
    let (first, more) = split_displayed(problems);
    if args.json {
        println!("{:#}", json!({ "problems": first, "more_problems": more, "warnings": warnings, "notes": notes }));
    } else {
        notes.iter().for_each(|note| println!("note: {note}"));
        warnings.iter().for_each(|warning| println!("warning: {warning}"));
        // Errors in unreadable files have no line number.
        first.iter().for_each(|problem| if problem.line == 0 { println!("{}", problem.message) } else { println!("{problem}") });
        if more > 0 {
            println!("and {more} more problems");
        }
    }
    match problems.len() {
        0 if args.json => Ok(()),
        0 => {
            let files = count(args.files.len(), "file");
            match warnings.len() {
                0 => println!("{files} valid"),
                many => println!("{files} valid ({})", count(many, "warning")),
            }
            Ok(())
        }
        many => Err(AppError::invalid(format!("{} in {}", count(many, "problem"), count(args.files.len(), "file")))),
    }
}

fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}

fn unreadable(file: &str, error: &AppError) -> Problem {
    let text = String::new;
    Problem {
        file: file.into(),
        line: 0,
        key: text(),
        location: text(),
        value: text(),
        allowed: text(),
        message: error.to_string(),
    }
}

fn check_file(source: &SourceFile, args: &Args, options: &CheckOptions<'_>, findings: &mut Findings) {
    if is_vehicle_file(&source.text) {
        check_vehicle(source, findings);
        return;
    }
    let siblings = |name: &str| source.read_referenced_file(name);
    let text = ScenarioText { file: &source.file, text: &source.text, siblings: &siblings };
    match scenario::read(text.file, text.text, text.siblings) {
        Ok(scenario) => {
            findings.problems.extend(source.picture_problems());
            scenario_check::check_scenario(&text, &scenario, options, findings);
        }
        Err(wrong) => findings.problems.extend(wrong.0),
    }
    scenario_check::check_forms(&text, args.form.as_deref(), options, findings);
    scenario_check::check_levels(&text, args.level, options, findings);
}

fn check_vehicle(source: &SourceFile, findings: &mut Findings) {
    match vehicle::read(&source.file, &source.text) {
        Ok(vehicle) => {
            let short = defects::reference_shortfalls(&vehicle.camera, &vehicle.lamp);
            findings.notes.extend(short.into_iter().map(|what| format!("{}: {what}", source.file)));
        }
        Err(wrong) => findings.problems.extend(wrong.0),
    }
}

/// Top-level keys that appear in only one of the two file types. They identify the file type even if some keys are
/// missing.
const VEHICLE_KEYS: [&str; 10] =
    ["mass_kg", "inertia_kg_m2", "rotors", "drag", "hull", "battery", "limits", "sensors", "camera", "lamp"];
const SCENARIO_KEYS: [&str; 19] = [
    "title",
    "briefing",
    "briefing_pictures",
    "difficulty",
    "forms",
    "seed",
    "origin",
    "terrain",
    "ground_team",
    "bridges",
    "tasks",
    "defects",
    "traffic",
    "wind",
    "light",
    "weather",
    "rules",
    "scoring",
    "certification",
];

fn is_vehicle_file(text: &str) -> bool {
    let mut in_table = false;
    let words = text.lines().filter_map(|line| {
        let line = line.trim();
        let head = line.starts_with('[');
        in_table |= head;
        let word = line.trim_start_matches(['[', ' ']).split(['.', ']', '=', ' ', '\t']).next();
        word.filter(|_| head || !in_table)
    });
    let weigh = |word: &str| i32::from(VEHICLE_KEYS.contains(&word)) - i32::from(SCENARIO_KEYS.contains(&word));
    words.map(weigh).sum::<i32>() > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_only_similar_keys_are_suggested() {
        let message = |key: &str| {
            let mut source = files::any_source("drill-straight-line").unwrap();
            source.text = source.text.replace("[defects]\n", &format!("[defects]\n{key} = 1\n"));
            let wrong = scenario::read(&source.file, &source.text, &|name| source.read_referenced_file(name)).unwrap_err();
            wrong.0.first().map(|problem| problem.message.clone()).unwrap()
        };
        assert_eq!(message("model"), "unknown key");
        assert_eq!(message("wether"), "unknown key");
        assert_eq!(message("kind"), "unknown key; did you mean kinds?");
        assert_eq!(message("size_facter"), "unknown key; did you mean size_factor?");
    }
}
