//! The cohort page: the sections of the offline page and a form that selects the sessions.

use super::access::Visitor;
use super::layout::{page, section};
use crate::cohort::Cohort;
use crate::record::{IncompletePolicy, excluded_sessions_note};
use crate::report::page::cohort::{TableLinks, sections, summary_lines};
use maud::{Markup, html};
use spandrel_text::text;

/// The form's selection.
#[derive(Debug, Clone, Copy)]
pub struct CohortPageSelection<'a> {
    /// All scenarios that were flown.
    pub flown_scenarios: &'a [String],
    /// Selected scenarios.
    pub scenarios: &'a [String],
    /// Number of repetitions compared.
    pub repetitions: usize,
    /// Whether to count incomplete sessions.
    pub incomplete: IncompletePolicy,
    /// Number of excluded incomplete sessions.
    pub left_out: usize,
}

/// Renders the page; without sessions, only the form and a note.
#[must_use]
pub fn cohort_page(visitor: &Visitor, selection: &CohortPageSelection<'_>, cohort: Option<&Cohort>) -> Markup {
    let language = visitor.language;
    let body = html! {
        section {
            form.inline method="get" action="/cohort" {
                fieldset {
                    legend { (text!(language, "people-cohort-scenarios")) }
                    @for name in selection.flown_scenarios {
                        label { input type="checkbox" name="scenario" value=(name) checked[selection.scenarios.contains(name)]; " " (name) }
                    }
                }
                label { (text!(language, "people-cohort-repetitions")) " " input type="number" name="repetitions" min="1" max="100" value=(selection.repetitions); }
                label { input type="checkbox" name="incomplete" value="1" checked[selection.incomplete == IncompletePolicy::Include]; " " (text!(language, "people-include-incomplete")) }
                button type="submit" { (text!(language, "people-cohort-show")) }
                @if cohort.is_some() { a href={ "/cohort/report.html?" (query(selection)) } { (text!(language, "people-cohort-download")) } }
            }
            @match cohort {
                Some(cohort) => (summary_lines(cohort, language)),
                None => p.calm { (text!(language, "people-no-sessions")) @if let Some(words) = excluded_sessions_note(selection.left_out, language) { " " (words) "." } },
            }
        }
        @if let Some(cohort) = cohort {
            @for (id, name, body) in sections(cohort, TableLinks::Served("/cohort/tables/", &format!("?{}", query(selection))), language) { (section(id, &name, &body)) }
        }
    };
    page(visitor, "/cohort", &text!(language, "people-cohort"), &body)
}

fn query(selection: &CohortPageSelection<'_>) -> String {
    let mut query = form_urlencoded::Serializer::new(String::new());
    query.extend_pairs(selection.scenarios.iter().map(|name| ("scenario", name)));
    query.append_pair("repetitions", &selection.repetitions.to_string());
    if selection.incomplete == IncompletePolicy::Include {
        query.append_pair("incomplete", "1");
    }
    query.finish()
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use crate::cohort::{Selection, cohort};
    use crate::testing::perfect_record;

    #[test]
    fn exact_cohort_page_contains_report_sections_and_escapes_names() {
        let mut records = vec![perfect_record("anna", 1), perfect_record("ben", 1)];
        records[0].scenario = HOSTILE_NAME.into();
        records[1].scenario = HOSTILE_NAME.into();
        let cohort =
            cohort(&records, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete: IncompletePolicy::Exclude });
        let names = [HOSTILE_NAME.to_owned()];
        let selection = CohortPageSelection {
            flown_scenarios: &names,
            scenarios: &names,
            repetitions: 1,
            incomplete: IncompletePolicy::Exclude,
            left_out: 0,
        };
        let text = cohort_page(&administrator(), &selection, Some(&cohort)).into_string();
        check(&text);
        assert!(text.contains("href=\"/cohort/tables/t_tests.csv?scenario="), "{text}");
        assert!(text.contains("2 trainees, 2 sessions") && text.contains("class=\"histogram\""), "{text}");
        assert!(cohort_page(&administrator(), &selection, None).into_string().contains("No sessions yet"));
        let visitor = administrator_with(spandrel_text::Language::Pseudo);
        let nothing = CohortPageSelection { flown_scenarios: &[], scenarios: &[], ..selection };
        check_translated(&cohort_page(&visitor, &nothing, None).into_string(), &[]);
        let selection = CohortPageSelection { incomplete: IncompletePolicy::Include, ..selection };
        let text = cohort_page(&administrator(), &selection, Some(&cohort)).into_string();
        assert!(text.contains("incomplete=1") && text.contains("value=\"1\" checked"), "{text}");
    }
}
