//! The command line, with one file per subcommand. Each subcommand parses its arguments and runs a sans-IO core.
//! Results go to standard output, everything else to standard error.

mod args;
mod assess;
mod autopilot_args;
mod brief;
mod check;
mod cohort;
mod demo;
mod export;
mod generate;
mod import;
mod invocation;
mod monitor;
#[cfg(feature = "view")]
mod picture_args;
mod pilot;
pub mod plan;
mod ports;
mod questionnaire;
mod rc;
mod records;
mod render;
mod report;
mod serve;
mod sim;
mod study;
mod table;
mod train;
mod view;

use crate::errors::{self, AppError};
use crate::io::logging;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

/// Open-source trainer for bridge inspectors who fly drones: a simulated MAVLink vehicle, a monitor that scores the
/// flight from its telemetry, and a synthetic trainee.
///
/// First steps: run `spandrel demo` to fly a complete session automatically, or `spandrel train` to fly with your own
/// ground station (QGroundControl connects automatically) and get your scores.
#[derive(Debug, Parser)]
#[command(name = "spandrel", version, max_term_width = 110, after_help = errors::EXIT_CODES)]
pub struct Cli {
    /// Log level on standard error: error, warn, info, debug or trace
    #[arg(long, global = true, value_name = "LEVEL", default_value = "info")]
    log: tracing::Level,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Brief(brief::Args),
    Train(train::Args),
    Demo(demo::Args),
    Sim(sim::Args),
    Monitor(monitor::Args),
    Pilot(pilot::Args),
    Rc(rc::Args),
    Assess(assess::Args),
    Export(export::Args),
    Import(import::Args),
    Questionnaire(questionnaire::Args),
    Records(records::Args),
    Plan(plan::Args),
    Cohort(cohort::Args),
    Study(study::Args),
    Report(report::Args),
    Serve(serve::Args),
    Render(render::Args),
    View(view::Args),
    Check(check::Args),
}

/// Runs the program and returns its exit code: 0 success, 1 failure, 2 invalid arguments or files.
#[must_use]
pub fn main() -> ExitCode {
    let matches = Cli::command().subcommand(generate::subcommand()).get_matches();
    let done = match matches.subcommand() {
        Some((generate::NAME, inner)) => {
            let what = generate::GeneratorCommand::from_arg_matches(inner).unwrap_or_else(|error| error.exit());
            generate::run(&what, Cli::command())
        }
        _ => run(&Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

fn run(cli: &Cli) -> Result<(), AppError> {
    logging::start(cli.log);
    match &cli.command {
        Command::Brief(args) => brief::run(args),
        Command::Train(args) => train::run(args, cli.log),
        Command::Demo(args) => demo::run(args, cli.log),
        Command::Sim(args) => sim::run(args),
        Command::Monitor(args) => monitor::run(args),
        Command::Pilot(args) => pilot::run(args),
        Command::Rc(args) => rc::run(args),
        Command::Assess(args) => assess::run(args),
        Command::Export(args) => export::run(args),
        Command::Import(args) => import::run(args),
        Command::Questionnaire(args) => questionnaire::run(args),
        Command::Records(args) => records::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Cohort(args) => cohort::run(args),
        Command::Study(args) => study::run(args),
        Command::Report(args) => report::run(args),
        Command::Serve(args) => serve::run(args),
        Command::Render(args) => render::run(args),
        Command::View(args) => view::run(args),
        Command::Check(args) => check::run(args),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_clap_definitions_are_valid() {
        Cli::command().debug_assert();
    }

    #[test]
    fn exact_every_subcommand_help_has_examples() {
        for command in Cli::command().get_subcommands() {
            let help = command.clone().render_long_help().to_string();
            assert!(help.contains("Examples:"), "{}: no examples", command.get_name());
            for argument in command.get_arguments().filter(|argument| !argument.is_hide_set()) {
                assert!(argument.get_help().is_some(), "{} {}: no help", command.get_name(), argument.get_id());
            }
        }
    }
}
