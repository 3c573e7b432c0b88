//! Distributions that replace individual lists for large cohorts.

use super::super::figure::figure;
use crate::cohort::{Cohort, SelfRatingPair};
use crate::report::plots::boxes::{NamedBox, boxes};
use crate::report::plots::histogram::histogram;
use crate::report::table::{Table, TableCell};
use crate::statistics::{BoxPlot, HistogramBin, box_plot};
use maud::{Markup, html};

/// Maximum number of bins in the crash histogram; beyond it, each bin covers several counts.
const MAX_BINS: usize = 20;

fn too_many_trainees_note(cohort: &Cohort, file: &str) -> Markup {
    html! { p.note { (cohort.trainees) " trainees are too many to list. The figures show distributions; for individual data, see " (file) "." } }
}

/// A labeled box plot.
type LabeledBox = (String, BoxPlot);

fn draw_boxes(of: &[LabeledBox], max_value: f64, title: &str) -> Markup {
    let named: Vec<NamedBox<'_>> = of.iter().map(|(name, plot)| NamedBox { name: name.clone(), plot }).collect();
    boxes(&named, max_value, title)
}

fn table(name: &'static str, caption: &'static str, head: &'static str, of: &[LabeledBox]) -> Table {
    let row = |(name, b): &LabeledBox| {
        let figures = [b.mean, b.low_whisker, b.q1, b.median, b.q3, b.high_whisker].map(|value| TableCell::Number(value, 1));
        [vec![name.clone().into(), b.n.into()], figures.to_vec()].concat()
    };
    let columns = vec![head, "n", "mean", "low whisker", "q1", "median", "q3", "high whisker"];
    Table { name, caption, columns, rows: of.iter().map(row).collect() }
}

/// Renders on-path shares by task.
pub fn tasks(cohort: &Cohort) -> Markup {
    let shares = |id: u32| -> Vec<f64> {
        let tasks = cohort.individuals.iter().flat_map(|one| &one.tasks);
        tasks.filter(|task| task.id == id && task.attempted).map(|task| 100.0 * task.on_path).collect()
    };
    let of = |id: &u32| Some((format!("task {id}"), box_plot(&shares(*id)).ok()?));
    let all: Vec<LabeledBox> = cohort.crashes.tasks.iter().filter_map(of).collect();
    html! {
        (too_many_trainees_note(cohort, "individuals.csv"))
        @if !all.is_empty() {
            (figure("On-path share by task (%)", &draw_boxes(&all, 100.0, "On-path share by task")))
            (table("on_path_by_task", "on-path share by task, %, only for trainees who attempted the task", "task", &all).shown())
        }
    }
}

/// Renders the number of crashes per trainee.
pub fn crashes(cohort: &Cohort) -> Markup {
    let counts: Vec<usize> = cohort.crashes.rows.iter().map(|row| row.total).collect();
    let bins = bins(&counts);
    let mean = counts.iter().sum::<usize>() as f64 / counts.len().max(1) as f64;
    let row = |bin: &HistogramBin| vec![TableCell::Number(bin.from, 0), TableCell::Number(bin.to - 1.0, 0), bin.count.into()];
    let columns = vec!["crashes, from", "to", "trainees"];
    let table = Table {
        name: "crashes_by_person",
        caption: "trainees by number of crashes",
        columns,
        rows: bins.iter().map(row).collect(),
    };
    html! {
        (figure("Trainees by number of crashes; the line marks the mean", &histogram(&bins, mean, "Histogram of crashes per trainee")))
        (table.folded())
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
pub fn self_rating(cohort: &Cohort) -> Markup {
    let rated = |rating: usize| {
        let people = cohort.self_rating.people.iter();
        let near = |one: &&SelfRatingPair| one.self_rating.round() == rating as f64;
        box_plot(&people.filter(near).map(|one| one.measured_pct).collect::<Vec<f64>>()).ok()
    };
    let all: Vec<LabeledBox> = (1..=5).filter_map(|rating| Some((rating.to_string(), rated(rating)?))).collect();
    html! {
        (too_many_trainees_note(cohort, "self_rating.csv"))
        @if !all.is_empty() {
            (figure("Overall score (% of maximum) by self-rating (5 is best)", &draw_boxes(&all, 100.0, "Measured score by self-rating")))
            (table("measured_by_self_rating", "measured score by self-rating (%)", "self-rating", &all).shown())
        }
        p { (cohort.self_rating.contradictions.len()) " contradictions are listed in contradictions.csv." }
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
