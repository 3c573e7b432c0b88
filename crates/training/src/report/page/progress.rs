//! One trainee's progress on one job by repetition, as shown in the TASBID paper for participant 18: scores, on-path
//! share by task, crashes by kind and, after four repetitions, learning curves. Used on the trainee's page and the
//! cohort pages.

use super::crash_kinds::{crash_counts, kinds, segments};
use super::figure::{figure, legend};
use super::within_error;
use crate::cohort::{JobProgress, MeasureReliability, Repetition, ScoreCurve, TraineeProgress, reliability_of};
use crate::record::excluded_sessions_note;
use crate::report::plots::bars::{CountRow, counts};
use crate::report::plots::learning_curve::{PracticeChart, practice};
use crate::report::plots::lines::{ChartLine, color_number, lines};
use crate::report::table::{Table, TableCell, folded};
use crate::terms::{score_title, task_titles};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Names of the four scores.
const SCORES: [&str; 4] = ["conformity", "efficiency", "safety", "accuracy"];
/// Scores whose changes are listed.
const CHANGING_SCORES: [&str; 5] = ["conformity", "efficiency", "safety", "accuracy", "overall"];
/// Returns the maximum value of a score.
#[must_use]
pub fn max_value(score: &str) -> f64 {
    if score == "overall" { 400.0 } else { 100.0 }
}

/// Renders a trainee's progress on one job.
#[must_use]
pub fn job_progress(job: &JobProgress, language: Language) -> Markup {
    let progress = &job.progress;
    let left_out = html! { @if let Some(words) = excluded_sessions_note(job.left_out, language) { p.note { (words) "." } } };
    if progress.repetitions.is_empty() {
        return left_out;
    }
    let tasks = |language| task_titles(&job.scenario, &job.tasks, language);
    html! {
        (left_out)
        (progress_figures(progress, &tasks(language), language))
        @if !progress.curves.is_empty() { (learning(progress, language)) }
        (folded(language, |language| changes(progress, &job.reliability, language)))
        (folded(language, |language| numbers(&job.scenario, progress, language)))
        @if !job.tasks.is_empty() { (folded(language, |language| on_path_table(progress, &tasks(language), language))) }
    }
}

/// Renders three figures by repetition: scores, on-path shares and crashes.
pub fn progress_figures(progress: &TraineeProgress, tasks: &[(u32, String)], language: Language) -> Markup {
    let scores = scores(progress, language);
    let shares = shares(progress, tasks);
    let rows: Vec<CountRow> = progress
        .repetitions
        .iter()
        .map(|one| CountRow {
            name: text!(language, "report-progress-repetition", repetition = one.number),
            kinds: segments(&one.crashes),
        })
        .collect();
    let all = progress.repetitions.iter().fold([0; 5], |mut sum, one| {
        sum.iter_mut().zip(crash_counts(&one.crashes)).for_each(|(sum, count)| *sum += count);
        sum
    });
    let seen = kinds(language)
        .into_iter()
        .zip(all)
        .filter(|(_, count)| *count > 0)
        .map(|((class, name), count)| (class, format!("{name}: {count}")));
    let seen: Vec<(&str, String)> = seen.collect();
    let score_lines = lines(&scores, 100.0, &text!(language, "report-progress-scores-title"));
    let share_lines = lines(&shares, 100.0, &text!(language, "report-progress-shares-title"));
    html! {
        div.three {
            (figure(&text!(language, "report-progress-scores"), &html! { (key(&scores)) (score_lines) }))
            @if !tasks.is_empty() { (figure(&text!(language, "report-progress-shares"), &html! { (key(&shares)) (share_lines) })) }
            (figure(&text!(language, "report-progress-crashes"), &html! {
                @if seen.is_empty() { p.calm { (text!(language, "report-progress-crashes-none")) } }
                @else { (legend(&seen)) (counts(&rows, &text!(language, "report-progress-crashes-title"))) }
            }))
        }
    }
}

fn scores(progress: &TraineeProgress, language: Language) -> Vec<ChartLine> {
    let line = |(k, name): (usize, &&str)| ChartLine {
        name: score_title(name, language),
        style: k + 1,
        values: progress.repetitions.iter().map(|one| one.score(name)).collect(),
    };
    let all = SCORES.iter().enumerate().map(line);
    all.filter(|one| one.values.iter().any(Option::is_some)).collect()
}

fn on_path(one: &Repetition, task: u32) -> Option<f64> {
    one.on_path.iter().find(|(id, _)| *id == task).and_then(|(_, share)| *share).map(|share| 100.0 * share)
}

fn shares(progress: &TraineeProgress, tasks: &[(u32, String)]) -> Vec<ChartLine> {
    let line = |(k, (id, name)): (usize, &(u32, String))| ChartLine {
        name: format!("{id} · {name}"),
        style: k + 1,
        values: progress.repetitions.iter().map(|one| on_path(one, *id)).collect(),
    };
    tasks.iter().enumerate().map(line).collect()
}

fn key(lines: &[ChartLine]) -> Markup {
    const DOT_CLASSES: [&str; 4] = ["dot-1", "dot-2", "dot-3", "dot-4"];
    legend(&lines.iter().map(|one| (DOT_CLASSES[color_number(one.style) - 1], one.name.clone())).collect::<Vec<_>>())
}

fn learning(progress: &TraineeProgress, language: Language) -> Markup {
    let values = |curve: &ScoreCurve| progress.repetitions.iter().filter_map(|one| one.score(&curve.score)).collect::<Vec<f64>>();
    html! {
        h4 { (text!(language, "report-progress-curves")) }
        div.trio {
            @for curve in &progress.curves {
                @let values = values(curve);
                @let chart = PracticeChart { values: &values, curve: &curve.curve, others: &[], max_value: max_value(&curve.score) };
                @let score = score_title(&curve.score, language);
                (figure(&score, &practice(&chart, &text!(language, "report-progress-curve", score = score.as_str()), language)))
            }
        }
        p.note { (text!(language, "report-progress-curves-note")) }
        (folded(language, |language| curve_table(&progress.curves, language)))
    }
}

fn curve_table(curves: &[ScoreCurve], language: Language) -> Table {
    let row = |one: &ScoreCurve| {
        let c = &one.curve;
        let next = TableCell::Number(c.next.min(max_value(&one.score)), 1);
        let r_squared = c.r_squared.map_or(TableCell::Empty, |value| TableCell::Number(value, 2));
        vec![
            score_title(&one.score, language).into(),
            c.n.into(),
            TableCell::Number(c.first, 1),
            TableCell::Number(c.exponent, 3),
            r_squared,
            next,
            within_error::label(one.within_error, language),
        ]
    };
    Table {
        name: "learning_curves",
        caption: text!(language, "report-progress-curves-caption"),
        columns: vec![
            text!(language, "report-column-score"),
            text!(language, "report-column-repetitions"),
            text!(language, "report-column-first"),
            text!(language, "report-column-exponent"),
            "R²".to_owned(),
            text!(language, "report-column-next"),
            text!(language, "report-column-measurement-error"),
        ],
        rows: curves.iter().map(row).collect(),
    }
}

/// Returns the changes of the scores since the preceding repetition, each labeled if the measure's error is known.
fn changes(progress: &TraineeProgress, reliability: &[MeasureReliability], language: Language) -> Table {
    let pairs = progress.repetitions.iter().zip(progress.repetitions.iter().skip(1));
    let rows = pairs.flat_map(|(before, after)| {
        let row = move |score: &&str| {
            let change = after.score(score)? - before.score(score)?;
            let known = reliability_of(reliability, score).and_then(|one| one.reliability);
            let least = known.map_or(TableCell::Empty, |one| TableCell::Number(one.minimal_detectable_change, 1));
            let label = within_error::label(known.map(|_| after.within_error.iter().any(|name| name == score)), language);
            Some(vec![after.number.into(), score_title(score, language).into(), TableCell::Number(change, 1), least, label])
        };
        CHANGING_SCORES.iter().filter_map(row).collect::<Vec<_>>()
    });
    Table {
        name: "changes",
        caption: text!(language, "report-progress-changes-caption"),
        columns: vec![
            text!(language, "report-column-repetition"),
            text!(language, "report-column-score"),
            text!(language, "report-column-change"),
            text!(language, "report-column-minimal-change"),
            text!(language, "report-column-measurement-error"),
        ],
        rows: rows.collect(),
    }
}

fn numbers(scenario: &str, progress: &TraineeProgress, language: Language) -> Table {
    let maybe = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 1));
    let row = |one: &Repetition| {
        let mut row = vec![one.number.into(), scenario.into()];
        row.extend(SCORES.map(|score| maybe(one.score(score))));
        row.extend([TableCell::Number(one.overall, 1), TableCell::Clock(one.seconds)]);
        row.extend(crash_counts(&one.crashes).map(TableCell::from));
        row
    };
    let mut columns = vec![text!(language, "report-column-repetition"), text!(language, "report-column-scenario")];
    columns.extend(CHANGING_SCORES.map(|score| score_title(score, language)));
    columns.extend([
        text!(language, "report-column-flight-time"),
        text!(language, "report-column-bridge-crashes"),
        text!(language, "report-column-ground-crashes"),
        text!(language, "report-column-water-crashes"),
        text!(language, "report-column-other-crashes"),
        text!(language, "report-column-grave-crashes"),
    ]);
    Table {
        name: "progress",
        caption: text!(language, "report-progress-caption"),
        columns,
        rows: progress.repetitions.iter().map(row).collect(),
    }
}

fn on_path_table(progress: &TraineeProgress, tasks: &[(u32, String)], language: Language) -> Table {
    let row = |one: &Repetition, (id, name): &(u32, String)| {
        let missing = || text!(language, "report-not-attempted").into();
        let share = on_path(one, *id).map_or_else(missing, |share| TableCell::Number(share, 1));
        vec![one.number.into(), (*id).into(), name.clone().into(), share]
    };
    Table {
        name: "on_path",
        caption: text!(language, "report-progress-on-path-caption"),
        columns: vec![
            text!(language, "report-column-repetition"),
            text!(language, "report-column-task"),
            text!(language, "report-column-name"),
            text!(language, "report-column-on-path-share"),
        ],
        rows: progress.repetitions.iter().flat_map(|one| tasks.iter().map(move |task| row(one, task))).collect(),
    }
}

/// Returns the message that there are too few repetitions for a learning curve.
pub fn too_few_repetitions(language: Language) -> String {
    text!(language, "report-progress-too-few", count = crate::statistics::MIN_LEARNING_REPETITIONS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cohort::{JobReliability, by_job};
    use crate::record::{IncompletePolicy, SessionRecord};
    use crate::testing::perfect_record;

    fn progress_page(count: usize) -> Markup {
        let mut records: Vec<SessionRecord> = (1..=count).map(|k| perfect_record("anna", k)).collect();
        records[0].tasks[2].attempted = false;
        records[0].tasks[0].name = "<b>slab</b>".into();
        records[count - 1].tasks[0].name = "<b>slab</b>".into();
        records[0].tasks[1].crashes.water = 2;
        records[0].tasks[1].crashes.person = 1;
        job_progress(&by_job(&records, IncompletePolicy::Exclude, &JobReliability::new())[0], Language::English)
    }

    #[test]
    fn exact_progress_lists_each_repetition() {
        let text = progress_page(3).into_string();
        assert_eq!(text.matches("class=\"lines\"").count(), 2);
        // Four score lines with three points each. The task lines have one point fewer because one task was not
        // attempted in one session.
        assert_eq!(text.matches("<circle class=\"dot-").count(), 12 + 11);
        assert!(text.contains("water: 2") && text.contains("person or vehicle: 1") && !text.contains("bridge: "), "{text}");
        assert!(text.contains("not attempted") && text.contains("&lt;b&gt;slab") && !text.contains("<b>slab"));
        assert!(!text.contains("Learning curves"), "three repetitions are too few");
    }

    #[test]
    fn exact_learning_curves_appear_at_fourth_repetition() {
        let text = progress_page(4).into_string();
        assert_eq!(text.matches("class=\"practice\"").count(), 5);
        assert!(text.contains("learning_curves.csv") && !text.contains("NaN"));
    }

    #[test]
    fn exact_changes_within_the_error_are_labeled() {
        let mut records = Vec::new();
        for (who, gain) in [("anna", 30.0), ("ben", 28.0)] {
            for k in 1..=2 {
                let mut record = perfect_record(who, k);
                record.scores.safety = 40.0 + gain * k as f64;
                record.scores.accuracy = Some(if (k + who.len()) % 2 == 0 { 70.0 } else { 90.0 });
                records.push(record);
            }
        }
        let selection = crate::cohort::Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude };
        let reliability = crate::cohort::cohort(&records, &selection).reliability;
        let known = JobReliability::from([("two-bridges".to_owned(), reliability)]);
        let job = &by_job(&records[..2], IncompletePolicy::Exclude, &known)[0];
        let table = changes(&job.progress, &job.reliability, Language::English);
        let label = |score: &str| table.rows.iter().find(|row| row[1] == score.into()).map(|row| row[4].clone()).unwrap();
        assert_eq!((label("safety"), label("accuracy")), ("beyond error".into(), "within error".into()));
        assert_eq!(label("conformity"), TableCell::Empty, "a score without variance has no label");
        let unknown = &by_job(&records[..2], IncompletePolicy::Exclude, &JobReliability::new())[0];
        assert!(changes(&unknown.progress, &[], Language::English).rows.iter().all(|row| row[4] == TableCell::Empty));
    }
}
