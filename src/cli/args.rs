//! Arguments shared by several subcommands, with their allowed ranges.

use crate::errors::AppError;
use crate::io::clock;
use crate::io::files::{self, ScenarioFile};
use crate::io::user_language::user_language;
use spandrel_model::scenario::Scenario;
use spandrel_sitl::endpoint::flavor as endpoint;
use spandrel_text::Language;
use spandrel_view::flow::pipe;

/// Maximum seed: MAVLink messages encode the seed as a signed 32-bit integer.
const MAX_SEED: u64 = i32::MAX as u64;

/// A flight's scenario, aircraft and seed.
#[derive(Debug, Clone, clap::Args)]
pub struct JobArgs {
    /// Scenario file, or the name of a shipped scenario
    #[arg(long, value_name = "FILE|NAME", default_value = "two-bridges")]
    pub scenario: String,
    /// Form of the scenario, if it has forms: one of several sets of defects (`spandrel check` lists them) [default: the first]
    #[arg(long, value_name = "NAME")]
    pub form: Option<String>,
    /// Difficulty level of the scenario, if it has levels: 1 is the easiest (`spandrel check` lists them) [default: the standard
    /// level]
    #[arg(long, value_name = "N", conflicts_with = "form")]
    pub level: Option<u8>,
    /// Aircraft file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    pub vehicle: String,
    /// Random seed (0 to 2147483647) for defects, traffic, gusts and sensor noise [default: the scenario's seed, or a
    /// new one]
    #[arg(long, value_name = "N", value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: Option<u64>,
}

impl JobArgs {
    /// Loads the scenario with the requested form or level.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or is invalid, or if it does not have the form or the level.
    pub fn load_scenario(&self) -> Result<ScenarioFile, AppError> {
        files::scenario(&self.scenario_argument())
    }

    /// Returns the scenario with the requested form or level, as one argument.
    fn scenario_argument(&self) -> String {
        files::with_variant(&self.scenario, self.form.as_deref(), self.level)
    }

    /// Returns the requested seed, or else the scenario's seed, or else a new one.
    pub fn seed_for(&self, scenario: &Scenario) -> u64 {
        self.seed.or(scenario.seed).unwrap_or_else(random_seed)
    }
}

/// The language of a page or text that a command writes.
#[derive(Debug, Clone, clap::Args)]
pub struct LanguageArgs {
    /// Language of the page or text: en, de or es [default: the window's setting, else the operating system's language]
    #[arg(long, value_name = "LANGUAGE", value_parser = parse_language)]
    language: Option<Language>,
}

impl LanguageArgs {
    /// Returns the requested language, or else the user's.
    pub fn language(&self) -> Language {
        self.language.unwrap_or_else(user_language)
    }
}

/// Parses a language tag.
fn parse_language(tag: &str) -> Result<Language, String> {
    Language::from_tag(tag).ok_or_else(|| "unknown (allowed: en, de, es)".to_owned())
}

/// Parses a value of `--seed` (0 to 2147483647).
pub fn parse_seed(text: &str) -> Result<u64, String> {
    text.parse().ok().filter(|seed| *seed <= MAX_SEED).ok_or_else(|| format!("'{text}' is not a seed (allowed: 0 to {MAX_SEED})"))
}

/// Creates a new seed from the wall clock.
pub fn random_seed() -> u64 {
    spandrel_model::random::RandomStream::new(clock::unix_us(), "session seed").bits() & MAX_SEED
}

/// Autopilot protocol that the vehicle's MAVLink interface uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Flavor {
    /// PX4; best supported by ground stations and SDKs
    Px4,
    /// ArduCopter: its flight modes and parameter names, home as the first mission item, telemetry streams on request
    Ardupilot,
    /// Standard MAVLink only: QGroundControl shows the vehicle, but offers no flight modes or guided flight
    Generic,
}

impl Flavor {
    /// Returns the autopilot protocol.
    pub fn display_name(self) -> &'static endpoint::Flavor {
        match self {
            Self::Px4 => &endpoint::px4::FLAVOR,
            Self::Ardupilot => &endpoint::ardupilot::FLAVOR,
            Self::Generic => &endpoint::generic::FLAVOR,
        }
    }

    /// Formats the option as command-line arguments for a child process.
    pub fn to_args(self) -> Vec<String> {
        vec!["--flavor".to_owned(), self.display_name().name.to_owned()]
    }
}

/// The purpose of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Purpose {
    /// You can pause or restart
    Practice,
    /// One attempt: no pause, restart or map
    Assessment,
}

impl Purpose {
    /// Converts the purpose to the type that the window and the session files use.
    pub fn display_name(self) -> pipe::Purpose {
        match self {
            Self::Practice => pipe::Purpose::Practice,
            Self::Assessment => pipe::Purpose::Assessment,
        }
    }

    /// Returns the purpose as a single word.
    pub fn word(self) -> &'static str {
        self.display_name().word()
    }
}

/// Returns the command-line arguments shared by all child processes.
pub fn common_args(job: &JobArgs, log: tracing::Level) -> Vec<String> {
    let mut args = vec!["--log".to_owned(), log.to_string().to_lowercase()];
    args.extend(["--scenario", &job.scenario_argument(), "--vehicle", &job.vehicle].map(str::to_owned));
    if let Some(seed) = job.seed {
        args.extend(["--seed".to_owned(), seed.to_string()]);
    }
    args
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_languages_are_parsed_by_tag() {
        assert_eq!(parse_language("de"), Ok(Language::German));
        assert!(parse_language("fr").is_err());
        assert_eq!(LanguageArgs { language: Some(Language::Spanish) }.language(), Language::Spanish);
    }

    #[test]
    fn exact_seeds_fit_in_32_bits() {
        assert_eq!(parse_seed("2147483647"), Ok(2_147_483_647));
        assert!(parse_seed("2147483648").is_err());
        assert!(parse_seed("-1").is_err());
        assert!(random_seed() <= MAX_SEED);
    }
}
