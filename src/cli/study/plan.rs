//! The flights of a study: every combination of scenario, pilot and seed, in this order.

use super::flight::FlightInputs;
use crate::cli::args::parse_seed;
use crate::cli::pilot::SkillArgs;
use crate::errors::AppError;
use crate::io::files::{self, ScenarioFile, VehicleFile};
use clap::Parser;
use spandrel_clients::pilot::Skill;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::folder::sha256_hex;
use spandrel_monitor::score::SCORER_VERSION;
use std::collections::BTreeSet;
use std::str::FromStr;
use std::sync::Arc;

/// Separates a skill level from the parameters to take from the expert, as in `novice+delay`.
const FACTOR_SEPARATOR: char = '+';

/// Consecutive seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SeedRange {
    pub first: u64,
    pub last: u64,
}

impl FromStr for SeedRange {
    type Err = String;

    /// Parses "20" (seeds 1 to 20) or "21-40".
    fn from_str(text: &str) -> Result<Self, String> {
        let (first, last) = match text.split_once('-') {
            Some((first, last)) => (parse_seed(first)?, parse_seed(last)?),
            None => (1, parse_seed(text)?),
        };
        if first <= last {
            Ok(Self { first, last })
        } else {
            Err(format!("'{text}' contains no seeds (allowed: a number of seeds from 1, or a range such as 21-40)"))
        }
    }
}

/// A synthetic pilot: a skill level with the numbers to take from the expert, or a pilot file.
#[derive(Debug, Clone)]
pub struct PilotSpec {
    pub name: String,
    pub skill: Skill,
}

impl PilotSpec {
    /// Reads a pilot file. The pilot's name is the file name.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or is invalid.
    pub fn from_file(file: &str) -> Result<Self, AppError> {
        Ok(Self { name: file.to_owned(), skill: files::pilot(file)? })
    }
}

/// Parses the skill options of `spandrel pilot`.
#[derive(Debug, clap::Parser)]
#[command(no_binary_name = true)]
struct SkillOptions {
    #[command(flatten)]
    skill: SkillArgs,
}

impl FromStr for PilotSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (level, factors) = text.split_once(FACTOR_SEPARATOR).unwrap_or((text, ""));
        let factors = factors.replace(FACTOR_SEPARATOR, ",");
        let mut options = vec!["--skill", level];
        if !factors.is_empty() {
            options.extend(["--expert-in", &factors]);
        }
        let wrong = |problem: String| {
            format!(
                "'{text}' is not a pilot: {problem} (allowed: novice, trained or expert, and parameters to take from the expert, as in novice+delay+noise)"
            )
        };
        let parsed = SkillOptions::try_parse_from(options).map_err(|error| wrong(first_line(&error.to_string())))?;
        let skill = parsed.skill.skill().map_err(|error| wrong(error.to_string()))?;
        Ok(Self { name: text.to_owned(), skill })
    }
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
}

/// Position of a flight in the study.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FlightId {
    pub scenario: String,
    pub pilot: String,
    pub seed: u64,
}

impl std::fmt::Display for FlightId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {}, seed {}", self.scenario, self.pilot, self.seed)
    }
}

/// A flight to fly.
#[derive(Debug, Clone)]
pub struct PlannedFlight {
    pub id: FlightId,
    /// Hash of everything that the result depends on except the seed.
    pub fingerprint: String,
    pub inputs: FlightInputs,
}

/// The flights of a study.
#[derive(Debug, Clone)]
pub struct StudyPlan {
    pub vehicle: String,
    pub flights: Vec<PlannedFlight>,
}

impl StudyPlan {
    /// Reads the scenarios and the aircraft, and lists the flights.
    ///
    /// # Errors
    /// Returns an error if a file is invalid, or if two scenarios or two pilots have the same name.
    pub fn read(scenarios: &[String], vehicle: &str, pilots: &[PilotSpec], seeds: SeedRange) -> Result<Self, AppError> {
        let aircraft = files::vehicle(vehicle)?;
        let shared: Arc<Vehicle> = Arc::new(aircraft.vehicle.clone());
        let mut flights = Vec::new();
        let mut names = BTreeSet::new();
        for argument in scenarios {
            let file = files::scenario(argument)?;
            let job = Arc::new(file.scenario.clone());
            let name = job.name_with_form();
            for pilot in pilots {
                if !names.insert((name.clone(), pilot.name.clone())) {
                    let (scenario, pilot) = (&name, &pilot.name);
                    return Err(AppError::invalid(format!("the study contains {scenario} with the pilot {pilot} twice")));
                }
                let fingerprint = fingerprint(&file, &aircraft, pilot);
                let flight = |seed: u64| PlannedFlight {
                    id: FlightId { scenario: name.clone(), pilot: pilot.name.clone(), seed },
                    fingerprint: fingerprint.clone(),
                    inputs: FlightInputs { scenario: job.clone(), vehicle: shared.clone(), skill: pilot.skill, seed },
                };
                flights.extend((seeds.first..=seeds.last).map(flight));
            }
        }
        Ok(Self { vehicle: aircraft.vehicle.id, flights })
    }
}

fn fingerprint(scenario: &ScenarioFile, vehicle: &VehicleFile, pilot: &PilotSpec) -> String {
    let parts = [
        env!("CARGO_PKG_VERSION").to_owned(),
        SCORER_VERSION.to_string(),
        scenario.text.clone(),
        scenario.referenced_files.values().map(|bytes| sha256_hex(bytes)).collect::<String>(),
        vehicle.text.clone(),
        format!("{:?}", pilot.skill),
    ];
    sha256_hex(parts.join("\n---\n").as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_seeds_are_a_count_or_a_range() {
        assert_eq!("20".parse(), Ok(SeedRange { first: 1, last: 20 }));
        assert_eq!("21-40".parse(), Ok(SeedRange { first: 21, last: 40 }));
        for wrong in ["0", "5-4", "x", "1-", "-3"] {
            assert!(wrong.parse::<SeedRange>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn exact_pilots_take_parameters_from_the_expert() {
        let mixed: PilotSpec = "novice+delay+noise".parse().unwrap();
        assert_eq!((mixed.skill.delay_s, mixed.skill.noise), (Skill::EXPERT.delay_s, Skill::EXPERT.noise));
        assert_eq!(mixed.skill.gain, Skill::NOVICE.gain);
        let error = "novice+luck".parse::<PilotSpec>().unwrap_err();
        assert!(error.starts_with("'novice+luck' is not a pilot: ") && error.contains("luck"), "{error}");
        assert!("ace".parse::<PilotSpec>().is_err());
    }

    #[test]
    fn exact_plan_lists_every_combination_once() {
        let pilots = ["novice", "expert"].map(|name| name.parse::<PilotSpec>().unwrap());
        let scenarios = ["drill-hover".to_owned(), "drill-gap".to_owned()];
        let seeds = SeedRange { first: 3, last: 5 };
        let plan = StudyPlan::read(&scenarios, "phantom2", &pilots, seeds).unwrap();
        assert_eq!(plan.flights.len(), 12);
        assert_eq!(plan.flights[4].id.to_string(), "drill-hover, expert, seed 4");
        let hashes: BTreeSet<&str> = plan.flights.iter().map(|flight| flight.fingerprint.as_str()).collect();
        assert_eq!(hashes.len(), 4, "one for each scenario and pilot");
        let twice = ["drill-hover".to_owned(), "drill-hover".to_owned()];
        let error = StudyPlan::read(&twice, "phantom2", &pilots, seeds).unwrap_err();
        assert!(error.to_string().contains("drill-hover with the pilot novice twice"), "{error}");
    }
}
