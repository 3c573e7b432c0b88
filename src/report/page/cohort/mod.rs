//! What a group of trainees shows, as one page or as sections of another: the paper's figures with the numbers behind them.

mod answers;
mod first;
mod repetitions;

use super::{Moves, document};
use crate::report::table::download;
use crate::training::cohort::{Cohort, tables};
use maud::{Markup, html};

/// The page that opens offline.
#[must_use]
pub fn cohort(cohort: &Cohort) -> String {
    let sections = sections(cohort);
    document(
        "Cohort report",
        &Moves::Nothing,
        &html! {
            header { div { p.kicker { "Cohort report" } h1 { (cohort.scenarios.join(", ")) } (in_short(cohort)) } }
            nav aria-label="Sections" { @for (id, name, _) in &sections { a href={ "#" (id) } { (name) } } }
            main {
                @for (id, name, body) in &sections {
                    section id=(id) aria-labelledby={ (id) "-head" } { h2 id={ (id) "-head" } { (name) } (body) }
                }
            }
        },
    )
}

/// Who flew what.
#[must_use]
pub fn in_short(cohort: &Cohort) -> Markup {
    html! {
        p { (cohort.trainees) " trainees, " (cohort.sessions) " sessions of " (cohort.scenarios.join(", ")) ". "
            @if !cohort.group.is_empty() && cohort.repetitions > 1 { (cohort.group.len()) " of them flew " (cohort.repetitions) " times or more." } }
    }
}

/// Id, name and body of each section; those with nothing to show are left out.
#[must_use]
pub fn sections(cohort: &Cohort) -> Vec<(&'static str, &'static str, Markup)> {
    let mut sections = Vec::new();
    if !cohort.warnings.is_empty() {
        sections.push(("mind", "To keep in mind", html! { ul { @for words in &cohort.warnings { li { (words) } } } }));
    }
    sections.push(("distributions", "Scores of the first sessions", first::distributions(cohort)));
    sections.push(("people", "People and tasks", first::people(cohort)));
    sections.push(("crashes", "Crashes", first::crashes(cohort)));
    if !cohort.boxes.is_empty() && cohort.repetitions > 1 {
        sections.push(("repetitions", "Repetitions", repetitions::repetitions(cohort)));
    }
    if !cohort.likert.is_empty() {
        sections.push(("answers", "Answers", answers::answers(cohort)));
    }
    if !cohort.self_rating.people.is_empty() {
        sections.push(("self-rating", "Self-rating and measurement", answers::self_rating(cohort)));
    }
    sections.push(("files", "All tables as files", files(cohort)));
    sections
}

fn files(cohort: &Cohort) -> Markup {
    html! { ul.actions { @for (name, csv) in tables(cohort) { li { (download(name, &csv, name)) } } } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::cohort::{Selection, cohort as of};
    use crate::training::record::Record;
    use crate::training::testing::faultless;

    fn group() -> Vec<Record> {
        let mut records = Vec::new();
        for person in 0..6 {
            for number in 1..=2 {
                let mut record = faultless(&format!("t{person}"), number);
                record.scores.safety = 70.0 + 3.0 * f64::from(person) + number as f64;
                record.tasks[0].crashes.bridge = number;
                records.push(record);
            }
        }
        records[0].trainee = "<script>alert(1)</script>".into();
        records
    }

    #[test]
    fn exact_the_page_shows_every_figure_and_escapes_names() {
        let cohort = of(&group(), &Selection { scenarios: Vec::new(), repetitions: 2 });
        let page = super::cohort(&cohort);
        assert!(!page.contains("<script>alert") && page.contains("&lt;script&gt;"));
        for figure in
            ["class=\"histogram\"", "class=\"boxes\"", "class=\"likert\"", "Crashes by kind", "t_tests.csv", "8 crashes"]
        {
            assert!(page.contains(figure), "{figure}");
        }
        assert!(!page.contains(" style=") && !page.contains("NaN"));
    }

    #[test]
    fn exact_a_group_without_answers_or_repetitions_leaves_those_sections_out() {
        let mut records = group();
        records.iter_mut().for_each(|record| record.answers = None);
        let cohort = of(&records[..1], &Selection { scenarios: Vec::new(), repetitions: 1 });
        let ids: Vec<&str> = sections(&cohort).into_iter().map(|(id, _, _)| id).collect();
        assert!(!ids.contains(&"answers") && !ids.contains(&"repetitions") && ids.contains(&"files"), "{ids:?}");
    }
}
