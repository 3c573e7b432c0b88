//! Cohort tables as CSV (RFC 4180), one file per table. Numbers use the fewest digits that represent the value exactly.

use super::Cohort;
use crate::record::SessionOutcome;
use crate::statistics::{Regression, TailProbabilities};
use spandrel_text::Language;
use std::fmt::Display;

/// File names of all tables.
pub const TABLES: [&str; 17] = [
    "distributions.csv",
    "histograms.csv",
    "individuals.csv",
    "conformity_by_task.csv",
    "crashes.csv",
    "repetitions.csv",
    "reliability.csv",
    "t_tests.csv",
    "homogeneity.csv",
    "likert.csv",
    "self_rating.csv",
    "contradictions.csv",
    "causal.csv",
    "progress.csv",
    "learning_curves.csv",
    "learning_of_the_group.csv",
    "warnings.csv",
];

/// Returns a table by file name; `None` if there is no such table.
#[must_use]
pub fn table(cohort: &Cohort, name: &str) -> Option<String> {
    Some(match name {
        "distributions.csv" => distributions(cohort),
        "histograms.csv" => histograms(cohort),
        "individuals.csv" => individuals(cohort),
        "conformity_by_task.csv" => conformity(cohort),
        "crashes.csv" => crashes(cohort),
        "repetitions.csv" => repetitions(cohort),
        "reliability.csv" => reliability(cohort),
        "t_tests.csv" => t_tests(cohort),
        "homogeneity.csv" => homogeneity(cohort),
        "likert.csv" => likert(cohort),
        "self_rating.csv" => self_rating(cohort),
        "contradictions.csv" => contradictions(cohort),
        "causal.csv" => causal(cohort),
        "progress.csv" => progress(cohort),
        "learning_curves.csv" => curves(cohort),
        "learning_of_the_group.csv" => learning(cohort),
        "warnings.csv" => {
            CsvWriter::new(&["warning"]).rows(cohort.limitations.iter().map(|one| vec![text(&one.words(Language::English))]))
        }
        _ => return None,
    })
}

/// Returns the file names and contents of all tables.
#[must_use]
pub fn tables(cohort: &Cohort) -> Vec<(&'static str, String)> {
    TABLES.iter().filter_map(|name| Some((*name, table(cohort, name)?))).collect()
}

struct CsvWriter(String);

impl CsvWriter {
    fn new(columns: &[&str]) -> Self {
        Self(columns.join(",") + "\n")
    }

    fn rows(mut self, rows: impl Iterator<Item = Vec<String>>) -> String {
        for row in rows {
            self.0.push_str(&row.join(","));
            self.0.push('\n');
        }
        self.0
    }
}

/// Returns a text field, quoted if necessary and escaped so that spreadsheets don't treat it as a formula.
fn text(value: &str) -> String {
    let formula = value.starts_with(['=', '+', '-', '@', '\t', '\r']);
    let value = if formula { format!("'{value}") } else { value.to_owned() };
    if value.contains([',', '"', '\n', '\r']) { format!("\"{}\"", value.replace('"', "\"\"")) } else { value }
}

fn number(value: impl Display) -> String {
    value.to_string()
}

fn optional_number(value: Option<f64>) -> String {
    value.map_or(String::new(), number)
}

fn distributions(cohort: &Cohort) -> String {
    let columns = ["score", "n", "mean", "sd", "min", "q1", "median", "q3", "max", "range", "skewness"];
    CsvWriter::new(&columns).rows(cohort.distributions.iter().map(|one| {
        let s = &one.summary;
        let figures = [s.min, s.q1, s.median, s.q3, s.max, s.range].map(number);
        [
            vec![text(&one.score), number(s.n), number(s.mean), optional_number(s.sd)],
            figures.to_vec(),
            vec![optional_number(s.skewness)],
        ]
        .concat()
    }))
}

fn histograms(cohort: &Cohort) -> String {
    let bars = cohort.distributions.iter().flat_map(|one| one.histogram.iter().map(|bar| (&one.score, bar)));
    let row = |(score, bar): (&String, &crate::statistics::HistogramBin)| {
        vec![text(score), number(bar.from), number(bar.to), number(bar.count)]
    };
    CsvWriter::new(&["score", "from", "to", "count"]).rows(bars.map(row))
}

fn individuals(cohort: &Cohort) -> String {
    let scores = ["conformity", "efficiency", "safety", "accuracy", "overall", "seconds"];
    let columns = [&["trainee", "session"], &scores[..], &["purpose", "complete", "completion", "certified", "unmet"]].concat();
    CsvWriter::new(&columns).rows(cohort.individuals.iter().map(|one| {
        let purpose = one.purpose.as_deref().map_or(String::new(), text);
        let scores = [one.conformity, Some(one.efficiency), Some(one.safety), one.accuracy, Some(one.overall), Some(one.seconds)];
        let completion = [number(u8::from(one.complete)), text(&one.completion_summary(Language::English))];
        let certification = [number(u8::from(one.certified)), text(&one.unmet.join("; "))];
        let start = vec![text(&one.trainee), text(&one.session)];
        [start, scores.map(optional_number).to_vec(), vec![purpose], completion.to_vec(), certification.to_vec()].concat()
    }))
}

fn conformity(cohort: &Cohort) -> String {
    let rows = cohort.individuals.iter().flat_map(|one| one.tasks.iter().map(|task| (&one.trainee, task)));
    CsvWriter::new(&["trainee", "task", "name", "attempted", "on_path", "speeding"]).rows(rows.map(|(trainee, task)| {
        let attempted = u8::from(task.attempted);
        vec![text(trainee), number(task.id), text(&task.name), number(attempted), number(task.on_path), number(task.speeding)]
    }))
}

fn crashes(cohort: &Cohort) -> String {
    let tasks: Vec<String> = cohort.crashes.tasks.iter().map(|id| format!("task_{id}")).collect();
    let columns: Vec<&str> =
        ["trainee"].into_iter().chain(tasks.iter().map(String::as_str)).chain(["outside", "total"]).collect();
    let sum = (&"all".to_owned(), &cohort.crashes.by_task, cohort.crashes.total);
    let people = cohort.crashes.rows.iter().map(|row| (&row.trainee, &row.by_task, row.total));
    CsvWriter::new(&columns).rows(people.chain([sum]).map(|(who, by_task, total)| {
        let counts = by_task.iter().map(number);
        [text(who)].into_iter().chain(counts).chain([number(total)]).collect()
    }))
}

fn repetitions(cohort: &Cohort) -> String {
    let columns = ["score", "repetition", "n", "mean", "low_whisker", "q1", "median", "q3", "high_whisker", "outliers"];
    CsvWriter::new(&columns).rows(cohort.boxes.iter().map(|one| {
        let p = &one.plot;
        let outliers: Vec<String> = p.outliers.iter().map(number).collect();
        let figures = [p.mean, p.low_whisker, p.q1, p.median, p.q3, p.high_whisker].map(number);
        [vec![text(&one.score), number(one.repetition), number(p.n)], figures.to_vec(), vec![outliers.join(" ")]].concat()
    }))
}

fn flag(value: Option<bool>) -> String {
    value.map_or(String::new(), |value| u8::from(value).to_string())
}

fn reliability(cohort: &Cohort) -> String {
    let columns = [
        "measure",
        "unit",
        "sessions",
        "at_ceiling",
        "n",
        "repetitions",
        "icc_2_1",
        "icc_3_1",
        "sem",
        "minimal_detectable_change",
    ];
    CsvWriter::new(&columns).rows(cohort.reliability.iter().map(|one| {
        let known = one.reliability;
        let count = |value: Option<usize>| value.map_or(String::new(), number);
        let figures = [
            known.map(|one| one.icc_2_1),
            known.map(|one| one.icc_3_1),
            known.map(|one| one.sem),
            known.map(|one| one.minimal_detectable_change),
        ];
        let start = vec![text(&one.measure), text(one.unit), number(one.sessions), optional_number(one.at_ceiling)];
        let sample = vec![count(known.map(|one| one.n)), count(known.map(|one| one.repetitions))];
        [start, sample, figures.map(optional_number).to_vec()].concat()
    }))
}

fn t_tests(cohort: &Cohort) -> String {
    let columns = [
        "score",
        "earlier",
        "later",
        "n",
        "mean_difference",
        "sd_difference",
        "low_95",
        "high_95",
        "df",
        "t",
        "p_upper",
        "p_lower",
        "p_two",
        "effect_size_dz",
        "p_upper_holm",
        "p_lower_holm",
        "p_two_holm",
        "minimal_detectable_mean_change",
        "within_error",
        "trainees_beyond_error",
    ];
    CsvWriter::new(&columns).rows(cohort.tests.iter().map(|one| {
        let t = &one.test;
        let tails = |p: &Option<TailProbabilities>| {
            [p.map(|p| p.upper), p.map(|p| p.lower), p.map(|p| p.two)].map(optional_number).to_vec()
        };
        let figures = [t.mean_difference, t.sd_difference, t.interval_95[0], t.interval_95[1]].map(number);
        let start = vec![text(&one.score), number(one.earlier), number(one.later), number(t.n)];
        let test = vec![number(t.df), optional_number(t.t)];
        let beyond = one.trainees_beyond_error.map_or(String::new(), number);
        let error = vec![optional_number(one.minimal_detectable_mean_change), flag(one.within_error), beyond];
        [start, figures.to_vec(), test, tails(&t.p), vec![optional_number(t.effect_size_dz)], tails(&one.p_holm), error].concat()
    }))
}

fn homogeneity(cohort: &Cohort) -> String {
    let columns = [
        "score",
        "low_up_to",
        "middle_up_to",
        "group_low",
        "group_middle",
        "group_high",
        "others_low",
        "others_middle",
        "others_high",
        "chi_squared",
        "df",
        "p",
        "smallest_expected",
    ];
    CsvWriter::new(&columns).rows(cohort.homogeneity.iter().map(|one| {
        let counts = one.group.iter().chain(&one.others).map(number).collect();
        let test = &one.test;
        let test = vec![number(test.chi_squared), number(test.df), number(test.p), number(test.smallest_expected)];
        [vec![text(&one.score), number(one.cuts[0]), number(one.cuts[1])], counts, test].concat()
    }))
}

fn likert(cohort: &Cohort) -> String {
    let columns =
        ["question", "repetition", "strongly_agree", "agree", "neutral", "disagree", "strongly_disagree", "n", "agreeing"];
    CsvWriter::new(&columns).rows(cohort.likert.iter().map(|one| {
        let repetition = one.repetition.map_or("all first".to_owned(), number);
        [vec![text(&one.question), repetition], one.counts.map(number).to_vec(), vec![number(one.n), number(one.agree)]].concat()
    }))
}

fn self_rating(cohort: &Cohort) -> String {
    let people = cohort.self_rating.people.iter();
    let row = |one: &super::SelfRatingPair| vec![text(&one.trainee), number(one.self_rating), number(one.measured_pct)];
    CsvWriter::new(&["trainee", "self_rating", "measured_pct"]).rows(people.map(row))
}

fn contradictions(cohort: &Cohort) -> String {
    let found = cohort.self_rating.contradictions.iter();
    CsvWriter::new(&["trainee", "words"])
        .rows(found.map(|one| vec![text(&one.trainee), text(&one.kind.words(Language::English))]))
}

fn causal(cohort: &Cohort) -> String {
    let columns = ["model", "term", "estimate", "standard_error", "t", "p", "low_95", "high_95"];
    let Some(model) = &cohort.causal else { return CsvWriter::new(&columns).rows(std::iter::empty()) };
    let terms = |name: &'static str, regression: &Regression| {
        let row = move |one: &crate::statistics::Coefficient| {
            let start = vec![name.to_owned(), text(&one.name), number(one.estimate), number(one.standard_error)];
            [start, vec![optional_number(one.t), optional_number(one.p), number(one.interval_95[0]), number(one.interval_95[1])]]
                .concat()
        };
        regression.coefficients.iter().map(row).collect::<Vec<_>>()
    };
    let effects = model.indirect.iter().map(|one| (format!("indirect at feedback {}", one.feedback), one));
    let effects = effects.chain([("moderation of the indirect effect".to_owned(), &model.moderation)]).map(|(name, one)| {
        let ends = one.interval_95.map_or([String::new(), String::new()], |ends| ends.map(number));
        let none = String::new;
        [vec!["resampled".to_owned(), text(&name), number(one.effect), none(), none(), none()], ends.to_vec()].concat()
    });
    let rows = [terms("strain", &model.strain), terms("performance", &model.performance), effects.collect()].concat();
    CsvWriter::new(&columns).rows(rows.into_iter())
}

fn progress(cohort: &Cohort) -> String {
    let tasks: Vec<String> = cohort.crashes.tasks.iter().map(|id| format!("on_path_{id}")).collect();
    let start = ["trainee", "repetition", "session", "conformity", "efficiency", "safety", "accuracy", "overall", "seconds"];
    let end = ["bridge", "terrain", "water", "other", "vehicle", "person", "change_within_error"];
    let columns: Vec<&str> = start.into_iter().chain(tasks.iter().map(String::as_str)).chain(end).collect();
    let rows = cohort.progress.iter().flat_map(|one| one.repetitions.iter().map(|repetition| (&one.trainee, repetition)));
    CsvWriter::new(&columns).rows(rows.map(|(trainee, one)| {
        let scores = [one.conformity, Some(one.efficiency), Some(one.safety), one.accuracy, Some(one.overall), Some(one.seconds)];
        let on_path = |id: &u32| optional_number(one.on_path.iter().find(|(task, _)| task == id).and_then(|(_, share)| *share));
        let crashes = one.crashes.by_kind().map(|(_, count)| number(count)).to_vec();
        let paths = cohort.crashes.tasks.iter().map(on_path).collect();
        let start = vec![text(trainee), number(one.number), text(&one.session)];
        [start, scores.map(optional_number).to_vec(), paths, crashes, vec![one.within_error.join(" ")]].concat()
    }))
}

fn curves(cohort: &Cohort) -> String {
    let rows = cohort.progress.iter().flat_map(|one| one.curves.iter().map(|curve| (&one.trainee, curve)));
    CsvWriter::new(&["trainee", "score", "n", "first", "exponent", "r_squared", "next", "within_error"]).rows(rows.map(
        |(trainee, one)| {
            let c = &one.curve;
            let figures = vec![number(c.n), number(c.first), number(c.exponent), optional_number(c.r_squared), number(c.next)];
            [vec![text(trainee), text(&one.score)], figures, vec![flag(one.within_error)]].concat()
        },
    ))
}

fn learning(cohort: &Cohort) -> String {
    let columns = ["score", "people", "repetition", "mean", "fitted", "first", "exponent", "r_squared", "within_error"];
    let rows = cohort.learning.iter().flat_map(|one| one.means.iter().enumerate().map(move |(k, mean)| (one, k + 1, *mean)));
    CsvWriter::new(&columns).rows(rows.map(|(one, repetition, mean)| {
        let c = &one.curve;
        let curve = vec![number(c.at(repetition as f64)), number(c.first), number(c.exponent), optional_number(c.r_squared)];
        [vec![text(&one.score), number(one.people), number(repetition), number(mean)], curve, vec![flag(one.within_error)]]
            .concat()
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_csv_fields_are_quoted_and_formulas_escaped() {
        assert_eq!(text("plain"), "plain");
        assert_eq!(text("a,b \"c\"\n"), "\"a,b \"\"c\"\"\n\"");
        assert_eq!(text("=1+1"), "'=1+1");
    }
}
