//! `spandrel report`: writes a session's report page from its folder.

use super::args;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::files;
use crate::io::progress::ProgressLog;
use crate::io::report::{self, address, comparison_page, review};
use crate::records::{read_json_lines, reliability_beside};
use spandrel_monitor::folder::REPORT;
use spandrel_training::cohort::{MeasureReliability, job_reliability};
use spandrel_training::record::IncompletePolicy;
use spandrel_training::report::page;
use std::path::PathBuf;

/// Write a session's report
///
/// The report is one printable page that opens offline in any browser: scores, tasks, the flight on the site, pictures
/// and missed defects, feedback and reactions, and surface coverage. It uses the telemetry and the two TOML files in
/// the session folder. Live sessions write it automatically at the end. For two sessions, the page compares them and labels the
/// changes that are within the error of the measures, if the database beside the first session or --records contains enough sessions.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel report sessions/20260801T...                      write report.html into the session folder
  spandrel report sessions/20260801T... --out anna.html      write it to another file; '-' for standard output
  spandrel report sessions/first sessions/second --out c.html    compare two sessions
  spandrel report sessions/20260801T... --language de        write the report in German

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder
    #[arg(value_name = "SESSION")]
    session: PathBuf,
    /// Second session folder to compare with the first
    #[arg(value_name = "SESSION", requires = "out")]
    other: Option<PathBuf>,
    /// Output file; '-' for standard output [default: report.html in the session folder]
    #[arg(long, value_name = "FILE")]
    out: Option<String>,
    /// For two sessions: records of all trainees on the job, as written by `spandrel records export`, to estimate the error
    /// of the measures [default: the database in the first session's parent folder, if there is one]
    #[arg(long, value_name = "FILE", requires = "other")]
    records: Option<PathBuf>,
    #[command(flatten)]
    page: args::LanguageArgs,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files are invalid, the session has no data to report, or the page cannot be written.
pub fn run(args: &Args) -> Result<(), AppError> {
    let progress = ProgressLog::start("writing the report");
    let language = args.page.language();
    let known = |job: &str| reliability_beside(&args.session, job);
    let text = match (&args.other, &args.out) {
        (Some(other), _) => comparison_page(&args.session, other, language, |scenario| reliability(args, scenario))?,
        (None, Some(_)) => page::session(&review(&args.session, language, &known)?),
        (None, None) => {
            report::write(&args.session, language, &known)?;
            progress.finish();
            println!("report        {}", address(&args.session.join(REPORT)));
            return Ok(());
        }
    };
    progress.finish();
    files::write(args.out.as_deref().unwrap_or("-"), text.as_bytes())
}

/// Returns the reliability of the measures on a job over the first two sessions of each trainee, from the given records or the
/// database beside the first session; empty without either.
fn reliability(args: &Args, scenario: &str) -> Result<Vec<MeasureReliability>, AppError> {
    match &args.records {
        Some(file) => Ok(job_reliability(&read_json_lines(file)?, scenario, IncompletePolicy::Exclude)),
        None => Ok(reliability_beside(&args.session, scenario)),
    }
}
