//! Cohort results, as a standalone page or as sections of another page: the TASBID paper's figures with the underlying
//! numbers. For large cohorts, the page shows distributions; the CSV files contain the individual data.

mod answers;
mod causal;
mod first_sessions;
mod learning;
mod lists_individuals;
mod pooled;
mod reliability;
mod repetitions;

pub use lists_individuals::MAX_LISTED_TRAINEES;

use super::figure::{SLOT, filled};
use super::{PageScripts, document};
use crate::cohort::{Cohort, Limitation, TABLES, tables};
use crate::record::{excluded_sessions_note, included_sessions_note};
use crate::report::table::download;
use lists_individuals::lists_individuals;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Largest number of limitations that are listed without being asked for.
const MAX_OPEN_LIMITATIONS: usize = 3;

/// Where the table files are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableLinks<'a> {
    /// Embedded in the page. Tables with one row per trainee are included only if the page lists trainees individually.
    Embedded,
    /// Downloaded from the server: URL prefix and query, which surround the file name.
    Served(&'a str, &'a str),
}

/// Renders the standalone offline page.
#[must_use]
pub fn cohort(cohort: &Cohort, language: Language) -> String {
    let sections = sections(cohort, TableLinks::Embedded, language);
    let title = text!(language, "cohort-title");
    document(
        language,
        &title,
        &PageScripts::None,
        &html! {
            header { div { p.kicker { (title) } h1 { (cohort.scenarios.join(", ")) } (summary_lines(cohort, language)) } }
            nav aria-label=(text!(language, "cohort-sections")) { @for (id, name, _) in &sections { a href={ "#" (id) } { (name) } } }
            main {
                @for (id, name, body) in &sections {
                    section id=(id) aria-labelledby={ (id) "-head" } { h2 id={ (id) "-head" } { (name) } (body) }
                }
            }
        },
    )
}

/// Renders the numbers of trainees and sessions.
#[must_use]
pub fn summary_lines(cohort: &Cohort, language: Language) -> Markup {
    let scenarios = cohort.scenarios.join(", ");
    let group = || text!(language, "cohort-group", trainees = cohort.group.len(), repetitions = cohort.repetitions);
    html! {
        p { (text!(language, "cohort-summary", trainees = cohort.trainees, sessions = cohort.sessions, scenarios = scenarios)) " "
            @if !cohort.group.is_empty() && cohort.repetitions > 1 { (group()) }
            @if let Some(words) = excluded_sessions_note(cohort.left_out, language) { " " (words) "." }
            @if let Some(words) = included_sessions_note(cohort.incomplete, language) { " " (words) "." } }
        p { (text!(language, "cohort-certified", certified = cohort.certified, sessions = cohort.sessions)) }
    }
}

/// Lists the limitations: a few, or one line that opens.
fn limitations(found: &[Limitation], language: Language) -> Markup {
    let list = html! { ul { @for one in found { li { (one.words(language)) } } } };
    html! {
        @if found.len() > MAX_OPEN_LIMITATIONS { details { summary { (text!(language, "cohort-limitations", count = found.len())) } (list) } }
        @else { (list) }
    }
}

/// Returns the ID, name and body of each section, omitting empty sections.
#[must_use]
pub fn sections(cohort: &Cohort, files_at: TableLinks<'_>, language: Language) -> Vec<(&'static str, String, Markup)> {
    let mut sections = Vec::new();
    let mut add = |id: &'static str, name: String, body: Markup| sections.push((id, name, body));
    if !cohort.limitations.is_empty() {
        add("mind", text!(language, "cohort-section-limitations"), limitations(&cohort.limitations, language));
    }
    let name = text!(language, "cohort-section-distributions");
    add("distributions", name, first_sessions::distributions(cohort, language));
    add("people", text!(language, "cohort-section-people"), first_sessions::people(cohort, language));
    add("crashes", text!(language, "cohort-section-crashes"), first_sessions::crashes(cohort, language));
    add("reliability", text!(language, "cohort-section-reliability"), reliability::reliability(cohort, language));
    if !cohort.boxes.is_empty() && cohort.repetitions > 1 {
        add("repetitions", text!(language, "cohort-section-repetitions"), repetitions::repetitions(cohort, language));
    }
    if learning::repeat_trainees(cohort).next().is_some() {
        add("learning", text!(language, "cohort-section-learning"), learning::curves(cohort, language));
        add("one-by-one", text!(language, "cohort-section-individual"), learning::individual_results(cohort, language));
    }
    if !cohort.likert.is_empty() {
        add("answers", text!(language, "cohort-section-answers"), answers::answers(cohort, language));
    }
    if !cohort.self_rating.people.is_empty() {
        add("self-rating", text!(language, "cohort-section-self-rating"), answers::self_rating(cohort, language));
    }
    if !cohort.likert.is_empty() {
        add("causal", text!(language, "cohort-section-causal"), causal::causal(cohort, language));
    }
    add("files", text!(language, "cohort-section-files"), files(cohort, files_at, language));
    sections
}

/// Tables with one or more rows per trainee.
const TABLES_BY_TRAINEE: [&str; 7] = [
    "individuals.csv",
    "conformity_by_task.csv",
    "crashes.csv",
    "self_rating.csv",
    "contradictions.csv",
    "progress.csv",
    "learning_curves.csv",
];

fn files(cohort: &Cohort, at: TableLinks<'_>, language: Language) -> Markup {
    match at {
        TableLinks::Served(address, query) => html! {
            ul.actions { @for name in TABLES { li { a href={ (address) (name) (query) } { (name) } } } }
        },
        TableLinks::Embedded => {
            let inside = |name: &str| lists_individuals(cohort) || !TABLES_BY_TRAINEE.contains(&name);
            let note = text!(language, "cohort-files-note", command = SLOT, files = TABLES_BY_TRAINEE.join(", "));
            html! {
                ul.actions { @for (name, csv) in tables(cohort).into_iter().filter(|(name, _)| inside(name)) { li { (download(name, &csv, name)) } } }
                @if !lists_individuals(cohort) {
                    p.note { (filled(&note, &html! { code { "spandrel cohort --csv FOLDER" } })) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cohort::{Selection, cohort as of};
    use crate::record::{IncompletePolicy, SessionRecord};
    use crate::testing::{aborted_record, perfect_record};

    fn group() -> Vec<SessionRecord> {
        let mut records = Vec::new();
        for person in 0..6 {
            for number in 1..=2 {
                let mut record = perfect_record(&format!("t{person}"), number);
                record.scores.safety = 70.0 + 3.0 * f64::from(person) + number as f64;
                record.tasks[0].crashes.bridge = number;
                records.push(record);
            }
        }
        records[0].trainee = "<script>alert(1)</script>".into();
        records
    }

    #[test]
    fn exact_cohort_page_shows_all_figures_and_escapes_names() {
        let cohort = of(&group(), &Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude });
        let page = super::cohort(&cohort, Language::English);
        assert!(!page.contains("<script>alert") && page.contains("&lt;script&gt;"));
        for figure in
            ["class=\"histogram\"", "class=\"boxes\"", "class=\"likert\"", "Crashes by kind", "t_tests.csv", "8 crashes"]
        {
            assert!(page.contains(figure), "{figure}");
        }
        assert!(!page.contains(" style=") && !page.contains("NaN"));
    }

    #[test]
    fn exact_page_shows_completion_and_certification() {
        let records = [aborted_record("anna", 1), perfect_record("ben", 1)];
        let of = |incomplete| of(&records, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete });
        let page = super::cohort(&of(IncompletePolicy::Include), Language::English);
        for words in [
            "Certified: 1 of 2 sessions.",
            "1 incomplete session included.",
            ">Incomplete: 0 of 4 tasks, 15% of the path<",
            ">Not certified: task 1 not done: 60% of its path, 80% needed (and 1 more)<",
            ">Complete: 4 of 4 tasks, 100% of the path<",
            ">Certified<",
        ] {
            assert!(page.contains(words), "{words}");
        }
        let page = super::cohort(&of(IncompletePolicy::Exclude), Language::German);
        assert!(page.contains("Zertifiziert: 1 von 1 Sitzung.") && page.contains(">Vollständigkeit<"), "{page}");
        assert!(!page.contains("mitgezählt"));
    }

    #[test]
    fn exact_sections_without_data_are_omitted() {
        let mut records = group();
        records.iter_mut().for_each(|record| record.answers = None);
        let cohort =
            of(&records[..1], &Selection { scenarios: Vec::new(), repetitions: 1, incomplete: IncompletePolicy::Exclude });
        let ids: Vec<&str> =
            sections(&cohort, TableLinks::Embedded, Language::English).into_iter().map(|(id, _, _)| id).collect();
        assert!(!ids.contains(&"answers") && !ids.contains(&"repetitions") && ids.contains(&"files"), "{ids:?}");
        assert!(!ids.contains(&"causal") && !ids.contains(&"learning"), "{ids:?}");
    }

    #[test]
    fn exact_causal_model_is_drawn_or_explained() {
        // All test answers are identical, so the model cannot be estimated.
        let selection = Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude };
        let page = super::cohort(&of(&group(), &selection), Language::English);
        assert!(page.contains("No estimate available") && !page.contains("class=\"model-drawing\""));
        let mut records: Vec<SessionRecord> = (0..20).map(|person| perfect_record(&format!("t{person}"), 1)).collect();
        let mut chance = spandrel_model::random::RandomStream::new(3, "made-up answers");
        for record in &mut records {
            for answer in record.answers.as_mut().unwrap().given.values_mut() {
                *answer = 1 + chance.below(5) as u8;
            }
            record.scores.overall = chance.range(200.0, 400.0);
        }
        let cohort = of(&records, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete: IncompletePolicy::Exclude });
        assert!(cohort.causal.is_some(), "{:?}", cohort.limitations);
        let page = super::cohort(&cohort, Language::English);
        assert!(page.contains("class=\"model-drawing\"") && page.contains("With fewer than 78"), "no warning");
        assert_eq!(page.matches("class=\"intervals\"").count(), 1);
        assert!(!page.contains("NaN"));
    }

    #[test]
    fn exact_learning_curve_is_shown_after_enough_repetitions() {
        let flown = |times: usize| {
            let records: Vec<SessionRecord> =
                (1..=times).flat_map(|k| [perfect_record("anna", k), perfect_record("ben", k)]).collect();
            let selection = Selection { scenarios: Vec::new(), repetitions: 1, incomplete: IncompletePolicy::Exclude };
            super::cohort(&of(&records, &selection), Language::English)
        };
        let (three, four) = (flown(3), flown(4));
        assert!(three.contains("requires 4 repetitions") && !three.contains("class=\"practice\""));
        assert_eq!((four.matches("class=\"practice\"").count(), four.matches("one-of-many\"").count()), (5, 10));
        assert!(three.contains("anna, 3 times") && four.contains("overall, 2 trainees"));
    }

    #[test]
    fn exact_large_cohort_page_shows_distributions_and_stays_small() {
        let people = |count: usize| {
            let records: Vec<SessionRecord> =
                (0..count).flat_map(|k| [perfect_record(&format!("p{k}"), 1), perfect_record(&format!("p{k}"), 2)]).collect();
            of(&records, &Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude })
        };
        let page = |count: usize| super::cohort(&people(count), Language::English);
        let few = page(MAX_LISTED_TRAINEES);
        assert!(few.contains("By trainee") && few.contains("individuals.csv\" href") && few.contains(">p59<"));
        let (some, many) = (page(MAX_LISTED_TRAINEES + 1), page(20 * MAX_LISTED_TRAINEES));
        assert!(!some.contains("By trainee") && !some.contains(">p59<") && some.contains("61 trainees are too many to list"));
        assert!(!some.contains("individuals.csv\" href") && some.contains("t_tests.csv\" href"));
        assert!(some.contains("Histogram of crashes per trainee") && some.contains("On-path share by task"));
        assert!(many.len() < some.len() + 2_000, "{} and {} bytes", some.len(), many.len());
        // On the server, every file has a link.
        let cohort = people(MAX_LISTED_TRAINEES + 1);
        let links = TableLinks::Served("/cohort/", "?repetitions=2");
        let (_, _, files) = sections(&cohort, links, Language::English).pop().unwrap();
        let files = files.into_string();
        let names: Vec<&str> = tables(&cohort).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, TABLES);
        assert!(names.iter().all(|name| files.contains(&format!("href=\"/cohort/{name}?repetitions=2\""))));
    }

    #[test]
    fn exact_page_is_in_its_language_and_downloads_are_in_english() {
        let selection = Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude };
        let cohort = of(&group(), &selection);
        let page = |language: Language| super::cohort(&cohort, language);
        let (english, german) = (page(Language::English), page(Language::German));
        for words in ["<html lang=\"de\">", "Wertungen der ersten Sitzungen", "7 Trainees", "Kollisionen nach Art", "Bahntreue"] {
            assert!(german.contains(words) && !english.contains(words), "{words}");
        }
        let downloads = |page: &str| -> Vec<String> {
            page.split("href=\"data:").skip(1).map(|rest| rest.split('"').next().unwrap_or_default().to_owned()).collect()
        };
        assert_eq!(downloads(&german), downloads(&english));
        let pseudo = page(Language::Pseudo);
        let heading = |rest: &str| rest.split('<').next().unwrap_or_default().to_owned();
        for start in ["<caption>", "<figcaption>", "<th scope=\"col\">"] {
            for text in pseudo.split(start).skip(1).map(heading) {
                // Symbols and some letters stay.
                let plain = |letter: char| letter.is_ascii_alphabetic() && !"mqvxMQVX".contains(letter);
                assert!(!text.contains(plain) || text.len() < 9, "{start} {text}");
            }
        }
    }
}
