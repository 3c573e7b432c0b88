//! `spandrel brief`: the briefing before a flight.

use super::args;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::briefing_page::briefing_page;
use crate::io::files;
use spandrel_model::site::Site;
use spandrel_monitor::export::json_text;
use spandrel_text::Language;
use spandrel_training::briefing::{Briefing, text};

/// Print the briefing for a job
///
/// The tasks in order, with direction, length, height, stand-off and lamp; the conditions and hazards; what counts; and the
/// site check before takeoff. In the scenario file, the key `briefing` adds your own words, and `[[briefing_pictures]]` adds
/// pictures.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel brief --scenario two-bridges
  spandrel brief --scenario pilot-study --form B --vehicle m30
  spandrel brief --scenario two-bridges --html briefing.html     a page with drawings, to print

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: args::JobArgs,
    /// Write a page with drawings of the site to this file; '-' for standard output [default: print text]
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    html: Option<String>,
    #[command(flatten)]
    page: args::LanguageArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if the scenario or the aircraft is invalid, or if the page or a picture on it cannot be written or read.
pub fn run(args: &Args) -> Result<(), AppError> {
    let source = args.job.load_scenario()?;
    let scenario = &source.scenario;
    let vehicle = files::vehicle(&args.job.vehicle)?.vehicle;
    let briefing = |language| Briefing::new(scenario, &vehicle, &Site::without_defects(scenario), language);
    let language = args.page.language();
    match (&args.html, args.json) {
        (Some(file), _) => files::write(file, briefing_page(&source, &vehicle, language)?.as_bytes()),
        // Programs read the JSON, so it is always in English.
        (None, true) => files::write("-", json_text(&briefing(Language::English)).as_bytes()),
        (None, false) => files::write("-", text::render(&briefing(language), language).as_bytes()),
    }
}
