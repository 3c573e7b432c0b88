//! `spandrel cohort`: statistics for a group of trainees.

use super::args;
use super::records::RecordsArgs;
use crate::cli::invocation::typed;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::files;
use crate::records::read_json_lines;
use spandrel_monitor::export::json_text;
use spandrel_text::Language;
use spandrel_training::cohort::{Cohort, Selection, cohort, tables};
use spandrel_training::record::{IncompletePolicy, excluded_sessions_note, included_sessions_note};
use spandrel_training::report::page::cohort as page;
use spandrel_training::report::page::within_error::measure_name;
use spandrel_training::terms::error_label;
use std::fmt::Write;
use std::path::PathBuf;

/// Maximum number of contradictions in the text output; the tables list all of them.
const MAX_CONTRADICTIONS: usize = 12;

/// Summarize the results of a group of trainees
///
/// Reports distributions of scores, trainees and tasks, box plots by repetition, crashes, and answer counts. Compares
/// self-ratings with measurements. Runs paired t-tests (effect sizes, confidence intervals, Holm correction) and
/// homogeneity tests, reports the reliability of each measure (ICC, standard error, minimal detectable change (MDC)), fits a
/// causal model of demand, strain and performance, and shows each trainee's progress. Writes
/// text, JSON, CSV tables or an HTML page.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel cohort                                       print a summary
  spandrel cohort --json cohort.json --csv tables       write all results
  spandrel cohort --report cohort.html                  write all figures as one page that works offline
  spandrel cohort --scenario two-bridges --scenario two-bridges-small --repetitions 2
  spandrel cohort --records all.jsonl --json -

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    records_location: RecordsArgs,
    /// Read records from this file, as written by `spandrel records export`, instead of a database
    #[arg(long, value_name = "FILE")]
    records: Option<PathBuf>,
    /// Scenario to include; may be repeated [default: the scenario flown most often]
    #[arg(long, value_name = "NAME")]
    scenario: Vec<String>,
    /// Number of repetitions to compare (1 to 100); includes only trainees who flew at least that many
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=100))]
    repetitions: u8,
    /// Include incomplete sessions
    #[arg(long)]
    include_incomplete: bool,
    /// Write all results as JSON; '-' for standard output
    #[arg(long, value_name = "FILE")]
    json: Option<String>,
    /// Write all figures as one HTML page that works offline; '-' for standard output
    #[arg(long, value_name = "FILE")]
    report: Option<String>,
    #[command(flatten)]
    page: args::LanguageArgs,
    /// Write each table as a CSV file to this folder
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files or the database are invalid, or output cannot be written.
pub fn run(args: &Args) -> Result<(), AppError> {
    let records = match &args.records {
        Some(file) => read_json_lines(file)?,
        None => args.records_location.location().open()?.records(None)?,
    };
    let selection = Selection {
        scenarios: args.scenario.clone(),
        repetitions: usize::from(args.repetitions),
        incomplete: IncompletePolicy::included(args.include_incomplete),
    };
    let cohort = cohort(&records, &selection);
    if cohort.sessions == 0
        && let Some(words) = excluded_sessions_note(cohort.left_out, Language::English)
    {
        return Err(AppError::invalid(format!(
            "this scenario has no complete sessions: {words} (to count them, use --include-incomplete)"
        )));
    }
    if cohort.sessions == 0 {
        return Err(AppError::invalid(format!(
            "the records contain no sessions of this scenario; to add sessions, use `{}`",
            typed("spandrel records import")
        )));
    }
    if let Some(folder) = &args.csv {
        let cannot = |error: std::io::Error| AppError::failed(format!("{}: cannot create the folder: {error}", folder.display()));
        std::fs::create_dir_all(folder).map_err(cannot)?;
        for (name, table) in tables(&cohort) {
            files::write(&folder.join(name).display().to_string(), table.as_bytes())?;
        }
    }
    if let Some(target) = &args.report {
        files::write(target, page::cohort(&cohort, args.page.language()).as_bytes())?;
    }
    match &args.json {
        Some(target) => files::write(target, json_text(&cohort).as_bytes()),
        None => files::write("-", summary_text(&cohort).as_bytes()),
    }
}

/// Formats the session count and the main statistics for first sessions as text.
fn first_session_summary(cohort: &Cohort) -> String {
    let mut out = format!("{} trainees, {} sessions of {}\n", cohort.trainees, cohort.sessions, cohort.scenarios.join(", "));
    if let Some(words) = excluded_sessions_note(cohort.left_out, Language::English) {
        let _ = writeln!(out, "{words} (use --include-incomplete to count them)");
    }
    if let Some(words) = included_sessions_note(cohort.incomplete, Language::English) {
        let _ = writeln!(out, "{words}: the scores of an incomplete session cover only a part of the job");
    }
    let _ = writeln!(out, "certified {} of {} sessions\n", cohort.certified, cohort.sessions);
    let _ = writeln!(out, "{:<12}{:>5}{:>9}{:>8}{:>8}{:>8}{:>8}", "first", "n", "mean", "sd", "min", "median", "max");
    for one in &cohort.distributions {
        let s = &one.summary;
        let sd = s.sd.map_or("-".to_owned(), |sd| format!("{sd:.2}"));
        let _ = writeln!(out, "{:<12}{:>5}{:>9.2}{sd:>8}{:>8.1}{:>8.1}{:>8.1}", one.score, s.n, s.mean, s.min, s.median, s.max);
    }
    let crashes = cohort.crashes.by_kind.by_kind().into_iter().filter(|(_, count)| *count > 0);
    let kinds: Vec<String> = crashes.map(|(kind, count)| format!("{kind} {count}")).collect();
    let _ = writeln!(
        out,
        "{} crashes in first sessions: {}",
        cohort.crashes.total,
        if kinds.is_empty() { "none".into() } else { kinds.join(", ") }
    );
    out
}

/// Formats the reliability of the measures as text.
fn reliability_text(cohort: &Cohort) -> String {
    let mut out = String::new();
    let names = cohort.reliability.iter().map(|one| measure_name(&one.measure, one.unit, Language::English).chars().count());
    let width = names.max().unwrap_or(0) + 1;
    let _ = writeln!(
        out,
        "\n{:<width$}{:>9}{:>10}{:>10}{:>10}{:>9}{:>8}",
        "reliability", "ceiling", "trainees", "ICC(2,1)", "ICC(3,1)", "SEM", "MDC"
    );
    let shown = |value: Option<f64>, digits: usize| value.map_or("-".to_owned(), |value| format!("{value:.digits$}"));
    for one in &cohort.reliability {
        let known = one.reliability;
        let _ = writeln!(
            out,
            "{:<width$}{:>9}{:>10}{:>10}{:>10}{:>9}{:>8}",
            measure_name(&one.measure, one.unit, Language::English),
            one.at_ceiling.map_or("-".to_owned(), |share| format!("{:.0}%", 100.0 * share)),
            known.map_or("-".to_owned(), |one| one.n.to_string()),
            shown(known.map(|one| one.icc_2_1), 2),
            shown(known.map(|one| one.icc_3_1), 2),
            shown(known.map(|one| one.sem), 2),
            shown(known.map(|one| one.minimal_detectable_change), 2),
        );
    }
    out
}

fn summary_text(cohort: &Cohort) -> String {
    let mut out = first_session_summary(cohort) + &reliability_text(cohort);
    if !cohort.tests.is_empty() {
        let _ = writeln!(out, "\n{} people, {} repetitions", cohort.group.len(), cohort.repetitions);
        let _ = writeln!(
            out,
            "{:<12}{:<9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}  measurement error",
            "paired t", "", "change", "t", "p upper", "p lower", "p two", "d_z", "Holm two"
        );
    }
    for one in &cohort.tests {
        let shown = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
        let (t, p) = (&one.test, one.test.p);
        let _ = writeln!(
            out,
            "{:<12}{:<9}{:>9.2}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}  {}",
            one.score,
            format!("{} vs. {}", one.earlier, one.later),
            t.mean_difference,
            shown(t.t),
            shown(p.map(|p| p.upper)),
            shown(p.map(|p| p.lower)),
            shown(p.map(|p| p.two)),
            shown(t.effect_size_dz),
            shown(one.p_holm.map(|p| p.two)),
            one.within_error.map_or_else(|| "unknown".to_owned(), |within| error_label(within, Language::English)),
        );
    }
    for one in &cohort.homogeneity {
        let (score, test) = (&one.score, &one.test);
        let _ = writeln!(
            out,
            "{score}: this group vs. the other trainees, chi-squared {:.2}, df {}, p {:.3}",
            test.chi_squared, test.df, test.p
        );
    }
    if let Some(model) = &cohort.causal {
        let _ = writeln!(out, "\ndemand -> strain -> performance, {} people", model.n);
        for one in &model.indirect {
            let ends = one.interval_95.map_or(String::new(), |[low, high]| format!(" [{low:.2}, {high:.2}]"));
            let _ = writeln!(out, "at feedback {:.1}: {:.2}% per demand step{ends}", one.feedback, one.effect);
        }
    }
    for one in &cohort.learning {
        let (first, last) = (one.means.first().copied().unwrap_or_default(), one.means.last().copied().unwrap_or_default());
        let _ = writeln!(
            out,
            "{}: from {first:.1} to {last:.1} over {} repetitions by {} people, learning exponent {:.3}{}",
            one.score,
            one.means.len(),
            one.people,
            one.curve.exponent,
            one.within_error.map_or(String::new(), |within| format!(", {}", error_label(within, Language::English)))
        );
    }
    let contradictions = &cohort.self_rating.contradictions;
    for one in contradictions.iter().take(MAX_CONTRADICTIONS) {
        let _ = writeln!(out, "{}: {}", one.trainee, one.kind.words(Language::English));
    }
    if contradictions.len() > MAX_CONTRADICTIONS {
        let _ = writeln!(
            out,
            "and {} more contradictions (use --json or --csv to list all)",
            contradictions.len() - MAX_CONTRADICTIONS
        );
    }
    for limitation in &cohort.limitations {
        let _ = writeln!(out, "note: {}", limitation.words(Language::English));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_training::testing::{aborted_record, perfect_record};

    #[test]
    fn exact_summary_states_how_many_sessions_are_certified_and_incomplete() {
        let records = [aborted_record("anna", 1), perfect_record("ben", 1), perfect_record("cleo", 1)];
        let text = |incomplete| {
            let selection = Selection { scenarios: Vec::new(), repetitions: 1, incomplete };
            first_session_summary(&cohort(&records, &selection))
        };
        let with = text(IncompletePolicy::Include);
        assert!(
            with.contains("1 incomplete session included: the scores of an incomplete session cover only a part of the job\n"),
            "{with}"
        );
        assert!(with.contains("certified 2 of 3 sessions\n"), "{with}");
        let without = text(IncompletePolicy::Exclude);
        assert!(without.contains("certified 2 of 2 sessions\n") && !without.contains("included"), "{without}");
    }
}
