//! Distributions that replace individual lists for large cohorts.

use super::super::figure::figure;
use crate::cohort::{Cohort, SelfRatingPair};
use crate::report::plots::boxes::{NamedBox, boxes};
use crate::report::plots::histogram::histogram;
use crate::report::table::{Table, TableCell, folded, shown};
use crate::statistics::{BoxPlot, HistogramBin, box_plot};
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Maximum number of bins in the crash histogram; beyond it, each bin covers several counts.
const MAX_BINS: usize = 20;

fn too_many_trainees_note(cohort: &Cohort, file: &str, language: Language) -> Markup {
    html! { p.note { (text!(language, "cohort-pooled-note", count = cohort.trainees, file = file)) } }
}

/// A labeled box plot.
type LabeledBox = (String, BoxPlot);

fn draw_boxes(of: &[LabeledBox], max_value: f64, title: &str, language: Language) -> Markup {
    let named: Vec<NamedBox<'_>> = of.iter().map(|(name, plot)| NamedBox { name: name.clone(), plot }).collect();
    boxes(&named, max_value, title, language)
}

/// Returns a table of boxes; `head` is the heading of the first column.
fn table(name: &'static str, (caption, head): (String, String), of: &[LabeledBox], language: Language) -> Table {
    let row = |(name, b): &LabeledBox| {
        let figures = [b.mean, b.low_whisker, b.q1, b.median, b.q3, b.high_whisker].map(|value| TableCell::Number(value, 1));
        [vec![name.clone().into(), b.n.into()], figures.to_vec()].concat()
    };
    let columns = vec![
        head,
        "n".to_owned(),
        text!(language, "cohort-column-mean"),
        text!(language, "cohort-column-low-whisker"),
        "q1".to_owned(),
        text!(language, "cohort-column-median"),
        "q3".to_owned(),
        text!(language, "cohort-column-high-whisker"),
    ];
    Table { name, caption, columns, rows: of.iter().map(row).collect() }
}

/// Renders on-path shares by task.
pub fn tasks(cohort: &Cohort, language: Language) -> Markup {
    let shares = |id: u32| -> Vec<f64> {
        let tasks = cohort.individuals.iter().flat_map(|one| &one.tasks);
        tasks.filter(|task| task.id == id && task.attempted).map(|task| 100.0 * task.on_path).collect()
    };
    let by_task = |language: Language| -> Vec<LabeledBox> {
        let of = |id: &u32| Some((text!(language, "report-task", task = *id), box_plot(&shares(*id)).ok()?));
        cohort.crashes.tasks.iter().filter_map(of).collect()
    };
    let all = by_task(language);
    let table = |language: Language| {
        let texts = (text!(language, "cohort-pooled-tasks-caption"), text!(language, "report-column-task"));
        table("on_path_by_task", texts, &by_task(language), language)
    };
    html! {
        (too_many_trainees_note(cohort, "individuals.csv", language))
        @if !all.is_empty() {
            (figure(&text!(language, "cohort-pooled-tasks"), &draw_boxes(&all, 100.0, &text!(language, "cohort-pooled-tasks-title"), language)))
            (shown(language, table))
        }
    }
}

/// Renders the number of crashes per trainee.
pub fn crashes(cohort: &Cohort, language: Language) -> Markup {
    let counts: Vec<usize> = cohort.crashes.rows.iter().map(|row| row.total).collect();
    let bins = bins(&counts);
    let mean = counts.iter().sum::<usize>() as f64 / counts.len().max(1) as f64;
    let row = |bin: &HistogramBin| vec![TableCell::Number(bin.from, 0), TableCell::Number(bin.to - 1.0, 0), bin.count.into()];
    let table = |language: Language| Table {
        name: "crashes_by_person",
        caption: text!(language, "cohort-pooled-crashes-caption"),
        columns: vec![
            text!(language, "cohort-column-crashes-from"),
            text!(language, "cohort-column-crashes-to"),
            text!(language, "cohort-column-trainees"),
        ],
        rows: bins.iter().map(row).collect(),
    };
    let chart = histogram(&bins, mean, &text!(language, "cohort-pooled-crashes-title"), language);
    html! {
        (figure(&text!(language, "cohort-pooled-crashes"), &chart))
        (folded(language, table))
    }
}

/// Returns equal-width bins that cover the counts from 0 to the maximum.
fn bins(counts: &[usize]) -> Vec<HistogramBin> {
    let max_value = counts.iter().copied().max().unwrap_or(0);
    let wide = (max_value + 1).div_ceil(MAX_BINS).max(1);
    let bin = |from: usize| {
        let to = from + wide;
        HistogramBin { from: from as f64, to: to as f64, count: counts.iter().filter(|count| (from..to).contains(count)).count() }
    };
    (0..=max_value).step_by(wide).map(bin).collect()
}

/// Renders measured scores grouped by self-rating, which is rounded to an integer.
pub fn self_rating(cohort: &Cohort, language: Language) -> Markup {
    let rated = |rating: usize| {
        let people = cohort.self_rating.people.iter();
        let near = |one: &&SelfRatingPair| one.self_rating.round() == rating as f64;
        box_plot(&people.filter(near).map(|one| one.measured_pct).collect::<Vec<f64>>()).ok()
    };
    let all: Vec<LabeledBox> = (1..=5).filter_map(|rating| Some((rating.to_string(), rated(rating)?))).collect();
    let table = |language: Language| {
        let texts = (text!(language, "cohort-pooled-rating-caption"), text!(language, "cohort-column-self-rating"));
        table("measured_by_self_rating", texts, &all, language)
    };
    html! {
        (too_many_trainees_note(cohort, "self_rating.csv", language))
        @if !all.is_empty() {
            (figure(&text!(language, "cohort-pooled-rating"), &draw_boxes(&all, 100.0, &text!(language, "cohort-pooled-rating-title"), language)))
            (shown(language, table))
        }
        p { (text!(language, "cohort-pooled-contradictions", count = cohort.self_rating.contradictions.len())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_each_value_falls_in_exactly_one_bin() {
        let bins = bins(&[0, 0, 1, 3, 45]);
        assert_eq!((bins.len(), bins[0].to, bins.iter().map(|bin| bin.count).sum::<usize>()), (16, 3.0, 5));
        assert_eq!(super::bins(&[0, 2]).iter().map(|bin| bin.count).collect::<Vec<_>>(), [1, 0, 1]);
        assert_eq!(super::bins(&[]).len(), 1);
    }
}
