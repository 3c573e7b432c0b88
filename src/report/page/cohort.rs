//! What a group of trainees shows, as one page or as sections of another: the paper's figures with the numbers behind them.

use super::{document, figure, legend};
use crate::report::plots::bars::{Counts, Row, counts, shares};
use crate::report::plots::boxes::{Named, boxes};
use crate::report::plots::histogram::histogram;
use crate::report::plots::likert::{Question, likert};
use crate::report::table::{Cell, Table, download};
use crate::report::words;
use crate::training::cohort::{Cohort, Comparison, Likert, tables};
use crate::training::questionnaire::{ENGLISH, Item, read_wording};
use crate::training::record::Crashes;
use maud::{Markup, html};

/// Scores in the order of showing, with the most that each can be.
const SCORES: [(&str, f64); 5] =
    [("conformity", 100.0), ("efficiency", 100.0), ("safety", 100.0), ("accuracy", 100.0), ("overall", 400.0)];
/// The five answers.
const ANSWERS: [(&str, &str); 5] = [
    ("answer-1", "strongly agree"),
    ("answer-2", "agree"),
    ("answer-3", "neutral"),
    ("answer-4", "disagree"),
    ("answer-5", "strongly disagree"),
];
/// Kinds of crashes: style and name.
const KINDS: [(&str, &str); 5] = [
    ("k-bridge", "bridge"),
    ("k-terrain", "ground"),
    ("k-water", "water"),
    ("k-other", "other"),
    ("k-grave", "person or vehicle"),
];

/// The page that opens offline.
#[must_use]
pub fn cohort(cohort: &Cohort) -> String {
    let sections = sections(cohort);
    document(
        "Cohort report",
        None,
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
    sections.push(("distributions", "Scores of the first sessions", distributions(cohort)));
    sections.push(("people", "People and tasks", people(cohort)));
    sections.push(("crashes", "Crashes", crashes(cohort)));
    if !cohort.boxes.is_empty() && cohort.repetitions > 1 {
        sections.push(("repetitions", "Repetitions", repetitions(cohort)));
    }
    if !cohort.likert.is_empty() {
        sections.push(("answers", "Answers", answers(cohort)));
    }
    if !cohort.self_rating.people.is_empty() {
        sections.push(("self-rating", "Self-rating and measurement", self_rating(cohort)));
    }
    sections.push(("files", "All tables as files", files(cohort)));
    sections
}

fn distributions(cohort: &Cohort) -> Markup {
    let rows = cohort.distributions.iter().map(|one| {
        let s = &one.summary;
        let maybe = |value: Option<f64>| value.map_or(Cell::Empty, |value| Cell::Number(value, 2));
        let numbers = [s.min, s.q1, s.median, s.q3, s.max].map(|value| Cell::Number(value, 1));
        let mut row = vec![one.score.clone().into(), s.n.into(), Cell::Number(s.mean, 2), maybe(s.sd)];
        row.extend(numbers);
        row.push(maybe(s.skewness));
        row
    });
    let columns = vec!["score", "n", "mean", "sd", "min", "q1", "median", "q3", "max", "skewness"];
    let table = Table { name: "distributions", caption: "first sessions", columns, rows: rows.collect() };
    html! {
        div.trio {
            @for one in &cohort.distributions {
                (figure(&one.score, &histogram(&one.histogram, one.summary.mean, &format!("Histogram of {}, the line is the mean", one.score))))
            }
        }
        (table.shown())
    }
}

fn people(cohort: &Cohort) -> Markup {
    let rows: Vec<Row> = cohort
        .individuals
        .iter()
        .map(|one| Row {
            name: one.trainee.clone(),
            bars: one
                .tasks
                .iter()
                .zip(["dot-1", "dot-2", "dot-3", "dot-4"].iter().cycle())
                .map(|(task, class)| (*class, task.on_path))
                .collect(),
            instead: one.tasks.is_empty().then_some("no tasks"),
        })
        .collect();
    let key: Vec<(&str, String)> = cohort
        .individuals
        .first()
        .map(|one| {
            one.tasks
                .iter()
                .zip(["dot-1", "dot-2", "dot-3", "dot-4"].iter().cycle())
                .map(|(task, class)| (*class, format!("{} · {}", task.id, task.name)))
                .collect()
        })
        .unwrap_or_default();
    let maybe = |value: Option<f64>| value.map_or(Cell::Empty, |value| Cell::Number(value, 1));
    let table = cohort.individuals.iter().map(|one| {
        vec![
            one.trainee.clone().into(),
            maybe(one.conformity),
            Cell::Number(one.efficiency, 1),
            Cell::Number(one.safety, 1),
            maybe(one.accuracy),
            Cell::Number(one.overall, 1),
            Cell::Clock(one.seconds),
        ]
    });
    let columns = vec!["trainee", "conformity", "efficiency", "safety", "accuracy", "overall", "flight time"];
    let table = Table { name: "individuals", caption: "first session of each person", columns, rows: table.collect() };
    html! {
        (table.shown())
        details.numbers { summary { "Share of each task's time on the path, person by person" }
            (figure("Share of the time on the path", &html! { (legend(&key)) (shares(&rows, "On the path by person and task")) }))
        }
    }
}

/// Counts in the order of [`KINDS`].
fn kinds(crashes: &Crashes) -> [usize; 5] {
    [crashes.bridge, crashes.terrain, crashes.water, crashes.other, crashes.person + crashes.vehicle]
}

fn crashes(cohort: &Cohort) -> Markup {
    let table = &cohort.crashes;
    let segments = KINDS.iter().zip(kinds(&table.by_kind)).map(|((class, _), count)| (*class, count)).collect();
    let key: Vec<(&str, String)> =
        KINDS.iter().zip(kinds(&table.by_kind)).map(|((class, name), count)| (*class, format!("{name}: {count}"))).collect();
    let names = table.tasks.iter().map(|id| format!("task {id}")).chain(["outside".to_owned()]);
    let by_task: Vec<Counts> =
        names.zip(&table.by_task).map(|(name, count)| Counts { name, kinds: vec![("k-bridge", *count)] }).collect();
    let people: Vec<Counts> =
        table.rows.iter().map(|row| Counts { name: row.trainee.clone(), kinds: vec![("k-bridge", row.total)] }).collect();
    html! {
        p { (table.total) " crashes in the first sessions." }
        div.split {
            (figure("By what was hit", &html! { (legend(&key)) (counts(&[Counts { name: "all".into(), kinds: segments }], "Crashes by kind")) }))
            (figure("By task", &counts(&by_task, "Crashes by task")))
        }
        details.numbers { summary { "Person by person" } (figure("Crashes by person", &counts(&people, "Crashes by person"))) }
    }
}

fn repetitions(cohort: &Cohort) -> Markup {
    html! {
        div.trio {
            @for (score, most) in SCORES {
                @let named: Vec<Named<'_>> = cohort.boxes.iter().filter(|one| one.score == score).map(|one| Named { name: one.repetition.to_string(), plot: &one.plot }).collect();
                @if !named.is_empty() { (figure(score, &boxes(&named, most, &format!("Box plots of {score} by repetition")))) }
            }
        }
        p.note { "Boxes from the lower to the upper quartile with the median; the cross is the mean; whiskers reach to the last value within 1.5 interquartile ranges." }
        @if !cohort.tests.is_empty() { (t_tests(&cohort.tests).shown()) }
        @if !cohort.homogeneity.is_empty() { (homogeneity(cohort).shown()) }
    }
}

fn t_tests(tests: &[Comparison]) -> Table {
    let maybe = |value: Option<f64>| value.map_or(Cell::Empty, |value| Cell::Number(value, 3));
    let row = |one: &Comparison| {
        let (t, p) = (&one.test, one.test.p);
        vec![
            one.score.clone().into(),
            format!("{} vs. {}", one.earlier, one.later).into(),
            t.n.into(),
            Cell::Number(t.mean_difference, 2),
            Cell::Number(t.interval_95[0], 2),
            Cell::Number(t.interval_95[1], 2),
            maybe(t.t),
            maybe(p.map(|p| p.upper)),
            maybe(p.map(|p| p.lower)),
            maybe(p.map(|p| p.two)),
            maybe(one.p_holm.map(|p| p.two)),
            maybe(t.effect_size_dz),
        ]
    };
    let columns = vec![
        "score",
        "repetitions",
        "pairs",
        "change",
        "95 % from",
        "to",
        "t",
        "p upper",
        "p lower",
        "p two",
        "p two, Holm",
        "d_z",
    ];
    Table { name: "t_tests", caption: "paired t tests, later less earlier", columns, rows: tests.iter().map(row).collect() }
}

fn homogeneity(cohort: &Cohort) -> Table {
    let counted = |counts: &[usize]| counts.iter().map(ToString::to_string).collect::<Vec<_>>().join(" / ");
    let rows = cohort.homogeneity.iter().map(|one| {
        vec![
            one.score.clone().into(),
            counted(&one.group).into(),
            counted(&one.others).into(),
            Cell::Number(one.test.chi_squared, 2),
            one.test.df.into(),
            Cell::Number(one.test.p, 3),
        ]
    });
    Table {
        name: "homogeneity",
        caption: "first sessions of those who repeated against the others (low / middle / high)",
        columns: vec!["score", "who repeated", "others", "chi-squared", "df", "p"],
        rows: rows.collect(),
    }
}

fn answers(cohort: &Cohort) -> Markup {
    let key: Vec<(&str, String)> = ANSWERS.iter().map(|(class, words)| (*class, (*words).to_owned())).collect();
    let of = |repetition: Option<usize>| -> Vec<Question> {
        let those = cohort.likert.iter().filter(|one| one.repetition == repetition);
        those.map(|one| Question { name: asked(one), counts: one.counts }).collect()
    };
    let later: Vec<(usize, Vec<Question>)> =
        (1..=cohort.repetitions).map(|k| (k, of(Some(k)))).filter(|(_, questions)| !questions.is_empty()).collect();
    let first = of(None);
    html! {
        (legend(&key))
        (figure(&format!("All first sessions, {} answers at most", cohort.trainees), &likert(&first, "Answers of all first sessions")))
        @for (k, questions) in &later {
            details.numbers { summary { "Those who repeated, repetition " (k) } (likert(questions, &format!("Answers in repetition {k}"))) }
        }
    }
}

/// A question in the shipped words; its key when they have none.
fn asked(one: &Likert) -> String {
    let wording = read_wording("en.toml", ENGLISH).ok();
    match (Item::from_key(&one.question), wording) {
        (Some(item), Some(wording)) => {
            let statement = wording.statement(item);
            if matches!(item, Item::Overall(_)) {
                statement.to_owned()
            } else {
                format!("{}: {statement}", wording.heading(item, |_| String::new()).trim_end_matches([':', ' ']))
            }
        }
        (_, _) => one.question.clone(),
    }
}

fn self_rating(cohort: &Cohort) -> Markup {
    let rating = &cohort.self_rating;
    let rows = rating
        .people
        .iter()
        .map(|one| vec![one.trainee.clone().into(), Cell::Number(one.self_rating, 2), Cell::Number(one.measured_pct, 1)]);
    let table = Table {
        name: "self_rating",
        caption: "self-rating and measured share",
        columns: vec!["trainee", "self-rating, 1 to 5", "measured, %"],
        rows: rows.collect(),
    };
    html! {
        @if let Some(overall) = &rating.overall {
            p { "Spearman's correlation of self-rating and overall score: " (words::number(overall.r, 2)) ", " (overall.n) " people." }
        }
        @if !rating.contradictions.is_empty() { ul { @for one in &rating.contradictions { li { b { (one.trainee) } ": " (one.words) } } } }
        (table.folded())
    }
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
