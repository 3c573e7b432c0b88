//! Summary of a study: means and spreads of each pilot's scores, pass rates, and effect sizes between pilots.

use super::row::{FlightResult, FlightRow};
use serde::Serialize;
use spandrel_training::statistics::{cohens_d, mean, proportion_interval_95, sd};
use std::fmt::Write;

/// Returns one measure of a flight; `None` if it does not apply.
type MeasurePicker = fn(&FlightResult) -> Option<f64>;

/// Measures in the tables: name, number of decimal places, value.
const MEASURES: [(&str, usize, MeasurePicker); 13] = [
    ("conformity", 1, |one| one.conformity),
    ("efficiency", 1, |one| Some(one.efficiency)),
    ("safety", 1, |one| Some(one.safety)),
    ("accuracy", 1, |one| one.accuracy),
    ("overall", 1, |one| Some(one.overall)),
    ("cert. conformity", 1, |one| one.certification_conformity),
    ("cert. efficiency", 1, |one| Some(one.certification_efficiency)),
    ("cert. safety", 1, |one| Some(one.certification_safety)),
    ("cert. accuracy", 1, |one| one.certification_accuracy),
    ("cert. precision", 1, |one| one.certification_precision),
    ("cert. sum", 1, |one| Some(one.certification_sum)),
    ("crashes", 2, |one| Some(one.crashes as f64)),
    ("minutes", 2, |one| Some(one.seconds / 60.0)),
];

/// Summary of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudySummary {
    /// Whether incomplete flights count toward means and effect sizes.
    pub incomplete_included: bool,
    /// One entry for each scenario and pilot, in the order of the command line.
    pub groups: Vec<Group>,
    /// Differences between all pairs of pilots on the same scenario.
    pub effects: Vec<Effect>,
    /// Failed flights.
    pub failures: Vec<Failure>,
}

/// Results of one pilot on one scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Group {
    pub scenario: String,
    pub pilot: String,
    /// Number of flights, including failed ones.
    pub flights: usize,
    pub failed: usize,
    pub complete: usize,
    pub certified: usize,
    /// 95% interval of the fraction of certified flights among those that did not fail.
    pub certified_interval_95: Option<[f64; 2]>,
    pub measures: Vec<MeasureSummary>,
    pub cues: CueSummary,
}

/// Cues in all flights of one pilot that did not fail, including incomplete ones.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CueSummary {
    /// Mean number of texts per minute of flight.
    pub texts_per_min: Option<f64>,
    pub off_path: i64,
    pub off_path_outside: i64,
    pub speeding: i64,
    pub speeding_short: i64,
    pub stand_off: i64,
    pub too_close: i64,
    pub deviations: i64,
    pub deviations_missed: i64,
}

/// Mean and spread of one measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureSummary {
    pub measure: &'static str,
    pub n: usize,
    pub mean: Option<f64>,
    pub sd: Option<f64>,
}

/// Effect sizes of the difference between two pilots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    pub scenario: String,
    pub first: String,
    pub second: String,
    /// Cohen's d, second minus first; `None` if the measure does not vary.
    pub d: Vec<(&'static str, Option<f64>)>,
}

/// A failed flight.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Failure {
    pub scenario: String,
    pub pilot: String,
    pub seed: u64,
    pub error: String,
}

impl StudySummary {
    /// Summarizes rows in the order of the study.
    pub fn of(rows: &[FlightRow], include_incomplete: bool) -> Self {
        let groups: Vec<&[FlightRow]> = rows.chunk_by(|a, b| (&a.scenario, &a.pilot) == (&b.scenario, &b.pilot)).collect();
        let mut effects = Vec::new();
        for (k, first) in groups.iter().enumerate() {
            let same_job = groups[k + 1..].iter().filter(|second| second[0].scenario == first[0].scenario);
            effects.extend(same_job.map(|second| effect(first, second, include_incomplete)));
        }
        let failure = |row: &FlightRow| {
            let error = row.error.clone()?;
            Some(Failure { scenario: row.scenario.clone(), pilot: row.pilot.clone(), seed: row.seed, error })
        };
        Self {
            incomplete_included: include_incomplete,
            groups: groups.iter().map(|rows| group(rows, include_incomplete)).collect(),
            effects,
            failures: rows.iter().filter_map(failure).collect(),
        }
    }

    /// Formats the summary as Markdown tables.
    pub fn text(&self) -> String {
        let mut out = String::new();
        let scenarios = self.groups.chunk_by(|a, b| a.scenario == b.scenario);
        for groups in scenarios {
            let scenario = &groups[0].scenario;
            let _ = writeln!(out, "## {scenario}\n");
            self.write_groups(&mut out, groups);
            let effects: Vec<&Effect> = self.effects.iter().filter(|one| one.scenario == *scenario).collect();
            if !effects.is_empty() {
                write_effects(&mut out, &effects);
            }
        }
        if !self.failures.is_empty() {
            let _ = writeln!(out, "## Failed flights\n");
        }
        for one in &self.failures {
            let _ = writeln!(out, "- {}, {}, seed {}: {}", one.scenario, one.pilot, one.seed, one.error);
        }
        out
    }

    fn write_groups(&self, out: &mut String, groups: &[Group]) {
        let names: Vec<&str> = groups.iter().map(|one| one.pilot.as_str()).collect();
        let _ = writeln!(out, "| | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
        let mut row = |name: &str, cell: &dyn Fn(&Group) -> String| {
            let _ = writeln!(out, "| {name} | {} |", groups.iter().map(cell).collect::<Vec<_>>().join(" | "));
        };
        row("flights", &|one| one.flights.to_string());
        row("failed", &|one| one.failed.to_string());
        row("complete", &|one| one.complete.to_string());
        row("certified", &certified);
        for (k, (measure, digits, _)) in MEASURES.iter().enumerate() {
            row(measure, &|one| mean_and_sd(&one.measures[k], *digits));
        }
        row("cue texts per minute", &|one| one.cues.texts_per_min.map_or("–".to_owned(), |mean| format!("{mean:.2}")));
        row("off-path cues outside a task", &|one| part(one.cues.off_path_outside, one.cues.off_path));
        row("speeding cues under 1 s", &|one| part(one.cues.speeding_short, one.cues.speeding));
        row("deviations without a cue", &|one| part(one.cues.deviations_missed, one.cues.deviations));
        row("stand-off cues", &|one| one.cues.stand_off.to_string());
        row("too-close cues", &|one| one.cues.too_close.to_string());
        let counted = if self.incomplete_included { "all flights that did not fail" } else { "complete flights" };
        let _ = writeln!(
            out,
            "\nMean ± standard deviation over {counted}; certified: share and 95% interval over all flights that did not fail. Cues: \
             all flights that did not fail.\n"
        );
    }
}

fn certified(group: &Group) -> String {
    let Some([low, high]) = group.certified_interval_95 else { return "–".to_owned() };
    let flown = group.flights - group.failed;
    let share = 100.0 * group.certified as f64 / flown as f64;
    format!("{} of {flown} ({share:.0}%, {:.0} to {:.0})", group.certified, 100.0 * low, 100.0 * high)
}

fn part(part: i64, whole: i64) -> String {
    let share = if whole == 0 { String::new() } else { format!(" ({:.0}%)", 100.0 * part as f64 / whole as f64) };
    format!("{part} of {whole}{share}")
}

fn mean_and_sd(one: &MeasureSummary, digits: usize) -> String {
    match (one.mean, one.sd) {
        (Some(mean), Some(sd)) => format!("{mean:.digits$} ± {sd:.digits$}"),
        (Some(mean), None) => format!("{mean:.digits$}"),
        (None, _) => "–".to_owned(),
    }
}

fn write_effects(out: &mut String, effects: &[&Effect]) {
    let names: Vec<String> = effects.iter().map(|one| format!("{} to {}", one.first, one.second)).collect();
    let _ = writeln!(out, "| Cohen's d | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
    for (k, (measure, ..)) in MEASURES.iter().enumerate() {
        let cell = |one: &&Effect| one.d[k].1.map_or("–".to_owned(), |d| format!("{d:.2}"));
        let _ = writeln!(out, "| {measure} | {} |", effects.iter().map(cell).collect::<Vec<_>>().join(" | "));
    }
    out.push('\n');
}

/// Returns the values of a measure in the flights that count.
fn values(rows: &[FlightRow], pick: MeasurePicker, include_incomplete: bool) -> Vec<f64> {
    let results = rows.iter().filter_map(|row| row.result.as_ref());
    results.filter(|result| include_incomplete || result.complete).filter_map(pick).collect()
}

fn group(rows: &[FlightRow], include_incomplete: bool) -> Group {
    let results: Vec<&FlightResult> = rows.iter().filter_map(|row| row.result.as_ref()).collect();
    let certified = results.iter().filter(|result| result.certified).count();
    let measure = |(measure, _, pick): (&'static str, usize, MeasurePicker)| {
        let values = values(rows, pick, include_incomplete);
        MeasureSummary { measure, n: values.len(), mean: mean(&values), sd: sd(&values) }
    };
    Group {
        scenario: rows[0].scenario.clone(),
        pilot: rows[0].pilot.clone(),
        flights: rows.len(),
        failed: rows.len() - results.len(),
        complete: results.iter().filter(|result| result.complete).count(),
        certified,
        certified_interval_95: proportion_interval_95(certified, results.len()),
        measures: MEASURES.into_iter().map(measure).collect(),
        cues: cues(&results),
    }
}

fn cues(results: &[&FlightResult]) -> CueSummary {
    let sum = |pick: fn(&FlightResult) -> i64| results.iter().map(|one| pick(one)).sum();
    let texts_per_min: Vec<f64> = results.iter().map(|one| 60.0 * one.cue_texts as f64 / one.seconds).collect();
    CueSummary {
        texts_per_min: mean(&texts_per_min),
        off_path: sum(|one| one.off_path_cues),
        off_path_outside: sum(|one| one.off_path_cues_outside),
        speeding: sum(|one| one.speeding_cues),
        speeding_short: sum(|one| one.speeding_cues_short),
        stand_off: sum(|one| one.stand_off_cues),
        too_close: sum(|one| one.too_close_cues),
        deviations: sum(|one| one.deviations),
        deviations_missed: sum(|one| one.deviations_missed),
    }
}

fn effect(first: &[FlightRow], second: &[FlightRow], include_incomplete: bool) -> Effect {
    let d = |(measure, _, pick): (&'static str, usize, MeasurePicker)| {
        let [first, second] = [first, second].map(|rows| values(rows, pick, include_incomplete));
        (measure, cohens_d(&first, &second).ok())
    };
    Effect {
        scenario: first[0].scenario.clone(),
        first: first[0].pilot.clone(),
        second: second[0].pilot.clone(),
        d: MEASURES.into_iter().map(d).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(pilot: &str, seed: u64, overall: f64, complete: bool) -> FlightRow {
        let result = FlightResult {
            conformity: Some(90.0),
            efficiency: 100.0,
            safety: 100.0,
            accuracy: None,
            overall,
            complete,
            tasks_done: 4,
            path_share: 1.0,
            certified: complete && overall > 350.0,
            unmet: String::new(),
            certification_conformity: None,
            certification_efficiency: 100.0,
            certification_safety: 100.0,
            certification_accuracy: None,
            certification_precision: None,
            certification_sum: 200.0,
            certification_sum_max: 400.0,
            seconds: 600.0,
            end_reason: "landed".into(),
            crashes: 1,
            crashes_by_task: "0 1 0 0 0".to_owned(),
            speeding_tasks: 0,
            off_path_tasks: 0,
            pictures: 0,
            hits: 0,
            defects_found: 0,
            defects_placed: 0,
            digest: String::new(),
            cue_texts: 20,
            off_path_cues: 4,
            off_path_cues_outside: 1,
            speeding_cues: 2,
            speeding_cues_short: 1,
            stand_off_cues: 1,
            too_close_cues: 3,
            deviations: 5,
            deviations_missed: 0,
        };
        let (scenario, vehicle, fingerprint) = ("job".to_owned(), "phantom2".to_owned(), String::new());
        FlightRow { scenario, vehicle, pilot: pilot.into(), seed, fingerprint, error: None, result: Some(result) }
    }

    #[test]
    fn exact_summary_counts_means_and_effects() {
        let mut rows: Vec<FlightRow> = [300.0, 320.0, 340.0].iter().zip(1..).map(|(x, k)| row("novice", k, *x, true)).collect();
        rows.push(row("novice", 4, 10.0, false));
        rows.push(FlightRow { result: None, error: Some("stuck".into()), ..row("novice", 5, 0.0, true) });
        rows.extend([360.0, 380.0, 400.0].iter().zip(1..).map(|(x, k)| row("expert", k, *x, true)));
        let summary = StudySummary::of(&rows, false);
        let novice = &summary.groups[0];
        assert_eq!((novice.flights, novice.failed, novice.complete, novice.certified), (5, 1, 3, 0));
        let overall = novice.measures.iter().find(|one| one.measure == "overall").unwrap();
        assert_eq!((overall.n, overall.mean, overall.sd), (3, Some(320.0), Some(20.0)));
        let d = |name: &str| summary.effects[0].d.iter().find(|(measure, _)| *measure == name).unwrap().1;
        assert_eq!((d("overall"), d("efficiency"), d("accuracy")), (Some(3.0), None, None));
        let text = summary.text();
        for line in [
            "| flights | 5 | 3 |",
            "| certified | 0 of 4 (0%, 0 to 49) | 3 of 3 (100%, 44 to 100) |",
            "| overall | 320.0 ± 20.0 | 380.0 ± 20.0 |",
            "| accuracy | – | – |",
            "| cue texts per minute | 2.00 | 2.00 |",
            "| off-path cues outside a task | 4 of 16 (25%) | 3 of 12 (25%) |",
            "| speeding cues under 1 s | 4 of 8 (50%) | 3 of 6 (50%) |",
            "| deviations without a cue | 0 of 20 (0%) | 0 of 15 (0%) |",
            "| overall | 3.00 |",
            "- job, novice, seed 5: stuck",
        ] {
            assert!(text.lines().any(|one| one == line), "{line}\n{text}");
        }
        let included = StudySummary::of(&rows, true);
        assert_eq!(included.groups[0].measures[4].n, 4);
    }
}
