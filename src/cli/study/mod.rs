//! `spandrel study`: flies many synthetic pilots without windows, and summarizes how skill affects scores.

pub mod flight;
mod journal;
mod plan;
mod row;
mod summary;
mod workers;

use crate::errors::{AppError, EXIT_CODES};
use crate::io::files;
use crate::io::parquet::table_to_parquet;
use crate::io::progress::ProgressLog;
use crate::io::replace::replace;
use crate::io::stop::StopRequest;
use flight::fly;
use journal::{Journal, line};
use plan::{PilotSpec, PlannedFlight, SeedRange, StudyPlan};
use row::{FlightRow, columns};
use spandrel_monitor::export::json_text;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use summary::StudySummary;

/// File with one row per flight.
const TABLE: &str = "flights.parquet";
/// File with the summary.
const SUMMARY: &str = "summary.md";

/// Fly many synthetic trainees and compare their scores
///
/// Flies every combination of scenario, pilot and seed as fast as possible, on all cores, without windows or ports. Writes
/// one row per flight (both scoring profiles) to flights.parquet, and prints a summary: means, standard deviations, effect
/// sizes between the pilots, and pass rates. If it is interrupted or killed, run the same command again: it flies only the
/// missing flights. The same command always writes the same table, on any number of cores. A failed flight is recorded
/// with its reason.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel study --out study                                     novice, trained and expert, 20 seeds each
  spandrel study --out study --seeds 3334                        10,002 flights
  spandrel study --out study --skill novice,novice+noise,expert  also a novice with the expert's noise
  spandrel study --out study --scenario two-bridges --scenario mine.toml --seeds 101-200 --jobs 8
  spandrel study --flight 17 --skill expert                      fly only one flight of the study, and print its row

{EXIT_CODES}"))]
pub struct Args {
    /// Folder for the results; created if it does not exist. To add flights to a study, use the same folder
    #[arg(long, value_name = "DIR", default_value = "study")]
    out: PathBuf,
    /// Scenario file, or the name of a shipped scenario; may be repeated
    #[arg(long, value_name = "FILE|NAME", default_value = "two-bridges")]
    scenario: Vec<String>,
    /// Forms of every scenario, which must have them: sets of defects (`spandrel check` lists them) [default: the first]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    form: Vec<String>,
    /// Difficulty levels of every scenario, which must have them (`spandrel check` lists them) [default: the standard level]
    #[arg(long, value_name = "N,...", value_delimiter = ',', conflicts_with = "form")]
    level: Vec<u8>,
    /// Aircraft file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    vehicle: String,
    /// Pilots: novice, trained or expert, each with parameters to take from the expert, as in novice+delay+noise
    #[arg(
        long,
        value_name = "PILOT,...",
        value_delimiter = ',',
        default_value = "novice,trained,expert",
        default_value_if("pilot", clap::builder::ArgPredicate::IsPresent, None)
    )]
    skill: Vec<PilotSpec>,
    /// Pilot file (TOML) with a synthetic trainee's numbers, in addition to --skill; may be repeated. With pilot files, no skill
    /// level is flown by default
    #[arg(long, value_name = "FILE")]
    pilot: Vec<String>,
    /// Seeds of each pilot: a number of seeds from 1, or a range
    #[arg(long, value_name = "N|FIRST-LAST", default_value = "20")]
    seeds: SeedRange,
    /// Number of flights at the same time [default: the number of processor cores]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Count incomplete flights toward means and effect sizes
    #[arg(long)]
    include_incomplete: bool,
    /// Write the summary as JSON to this file instead of printing it; '-' for standard output
    #[arg(long, value_name = "FILE")]
    json: Option<String>,
    /// Print the flights that are missing in the folder, one per line, and exit: their number and the fingerprint of their
    /// inputs
    #[arg(long, conflicts_with = "flight")]
    missing: bool,
    /// Fly only this flight of the study (from 1), print its row as one line of JSON, and write nothing to the folder.
    /// Programs that distribute flights over several machines use it
    #[arg(long, value_name = "N")]
    flight: Option<NonZeroUsize>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid, results cannot be written, the study was interrupted, or a flight failed.
pub fn run(args: &Args) -> Result<(), AppError> {
    let files = args.pilot.iter().map(|file| PilotSpec::from_file(file)).collect::<Result<Vec<_>, _>>()?;
    let pilots = [args.skill.clone(), files].concat();
    let plan = StudyPlan::read(&with_variants(&args.scenario, &args.form, &args.level), &args.vehicle, &pilots, args.seeds)?;
    if let Some(number) = args.flight {
        return fly_one(&plan, number.get());
    }
    let mut journal = Journal::open(&args.out, &plan)?;
    let is_missing = |flight: &&PlannedFlight| journal.row(&plan.vehicle, &flight.id).is_none();
    if args.missing {
        let numbered = plan.flights.iter().enumerate().filter(|(_, flight)| is_missing(flight));
        numbered.for_each(|(k, flight)| println!("{} {}", k + 1, flight.fingerprint));
        return Ok(());
    }
    let missing: Vec<&PlannedFlight> = plan.flights.iter().filter(is_missing).collect();
    fly_missing(args, &plan, &missing, &mut journal)?;
    let rows: Vec<FlightRow> = plan.flights.iter().filter_map(|flight| journal.row(&plan.vehicle, &flight.id)).cloned().collect();
    write_results(args, &rows)
}

/// Returns every scenario with every form or level, as arguments.
fn with_variants(scenarios: &[String], forms: &[String], levels: &[u8]) -> Vec<String> {
    let forms = forms.iter().map(|form| (Some(form.as_str()), None));
    let mut variants: Vec<(Option<&str>, Option<u8>)> = forms.chain(levels.iter().map(|level| (None, Some(*level)))).collect();
    if variants.is_empty() {
        variants.push((None, None));
    }
    let with = |scenario: &String| variants.iter().map(|(form, level)| files::with_variant(scenario, *form, *level)).collect();
    scenarios.iter().flat_map(|scenario: &String| -> Vec<String> { with(scenario) }).collect()
}

/// Flies one flight and prints its row.
fn fly_one(plan: &StudyPlan, number: usize) -> Result<(), AppError> {
    let out_of_range =
        || AppError::invalid(format!("--flight {number}: there is no such flight (allowed: 1 to {})", plan.flights.len()));
    let flight = plan.flights.get(number - 1).ok_or_else(out_of_range)?;
    let stop = StopRequest::install(false)?;
    let row = FlightRow::of(flight, &plan.vehicle, fly(&flight.inputs, &stop));
    println!("{}", line(&row.ok_or_else(|| AppError::failed("interrupted"))?)?);
    Ok(())
}

fn fly_missing(args: &Args, plan: &StudyPlan, missing: &[&PlannedFlight], journal: &mut Journal) -> Result<(), AppError> {
    let stop = StopRequest::install(false)?;
    let jobs = args.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, NonZeroUsize::get), NonZeroUsize::get);
    let (total, mut flown) = (plan.flights.len(), plan.flights.len() - missing.len());
    if flown > 0 {
        tracing::info!("{flown} of {total} flights are already in {}", args.out.display());
    }
    let mut progress = ProgressLog::start("flying");
    let flying = workers::fly_all(missing, &plan.vehicle, jobs, &stop, |row| {
        if let Some(error) = &row.error {
            tracing::warn!("failed flight: {}, {}, seed {}: {error}", row.scenario, row.pilot, row.seed);
        }
        journal.add(row)?;
        flown += 1;
        progress.report(|| format!("{flown} of {total} flights"));
        Ok(())
    });
    progress.finish();
    flying?;
    if flown == total {
        return Ok(());
    }
    let folder = args.out.display();
    Err(AppError::failed(format!(
        "interrupted after {flown} of {total} flights: to continue, run the same command again ({folder})"
    )))
}

fn write_results(args: &Args, rows: &[FlightRow]) -> Result<(), AppError> {
    replace(&args.out.join(TABLE), &table_to_parquet("flights", &columns(rows))?)?;
    let summary = StudySummary::of(rows, args.include_incomplete);
    let text = summary.text();
    replace(&args.out.join(SUMMARY), text.as_bytes())?;
    match &args.json {
        Some(target) => files::write(target, json_text(&summary).as_bytes())?,
        None => files::write("-", text.as_bytes())?,
    }
    if summary.failures.is_empty() {
        return Ok(());
    }
    let first = &summary.failures[0];
    Err(AppError::failed(format!(
        "{} of {} flights failed, the first one is {}, {}, seed {}: {} (the others are listed in {})",
        summary.failures.len(),
        rows.len(),
        first.scenario,
        first.pilot,
        first.seed,
        first.error,
        args.out.join(SUMMARY).display()
    )))
}
