//! The cohort page: the sections of the offline page and a form that selects the sessions.

use super::access::Visitor;
use super::frame::{page, section};
use crate::cohort::Cohort;
use crate::record::{IncompletePolicy, omitted_summary};
use crate::report::page::cohort::{TableLinks, sections, summary_lines};
use maud::{Markup, html};

/// Selection shown in the form.
#[derive(Debug, Clone, Copy)]
pub struct GroupSelection<'a> {
    /// All scenarios that were flown.
    pub flown_scenarios: &'a [String],
    /// Selected scenarios.
    pub scenarios: &'a [String],
    /// Number of repetitions compared.
    pub repetitions: usize,
    /// Whether incomplete sessions count.
    pub incomplete: IncompletePolicy,
    /// Number of incomplete sessions excluded.
    pub left_out: usize,
}

/// Renders the page; without sessions, only the form and a note.
#[must_use]
pub fn group(visitor: &Visitor, chosen: &GroupSelection<'_>, cohort: Option<&Cohort>) -> Markup {
    let body = html! {
        section {
            form.inline method="get" action="/cohort" {
                fieldset {
                    legend { "Scenarios that count as the job" }
                    @for name in chosen.flown_scenarios {
                        label { input type="checkbox" name="scenario" value=(name) checked[chosen.scenarios.contains(name)]; " " (name) }
                    }
                }
                label { "Repetitions " input type="number" name="repetitions" min="1" max="100" value=(chosen.repetitions); }
                label { input type="checkbox" name="incomplete" value="1" checked[chosen.incomplete == IncompletePolicy::Include]; " Include incomplete sessions" }
                button type="submit" { "Show" }
                @if cohort.is_some() { a href={ "/cohort/report.html?" (query(chosen)) } { "Download as an offline page" } }
            }
            @match cohort {
                Some(cohort) => (summary_lines(cohort)),
                None => p.calm { "No sessions yet." @if let Some(words) = omitted_summary(chosen.left_out) { " " (words) "." } },
            }
        }
        @if let Some(cohort) = cohort {
            @for (id, name, body) in sections(cohort, TableLinks::At("/cohort/tables/", &format!("?{}", query(chosen)))) { (section(id, name, &body)) }
        }
    };
    page(visitor, "/cohort", "Cohort", &body)
}

fn query(chosen: &GroupSelection<'_>) -> String {
    let mut query = form_urlencoded::Serializer::new(String::new());
    query.extend_pairs(chosen.scenarios.iter().map(|name| ("scenario", name)));
    query.append_pair("repetitions", &chosen.repetitions.to_string());
    if chosen.incomplete == IncompletePolicy::Include {
        query.append_pair("incomplete", "1");
    }
    query.finish()
}

#[cfg(test)]
mod tests {
    use super::super::frame::tests::{EVIL, administrator, check};
    use super::*;
    use crate::cohort::{Selection, cohort};
    use crate::testing::faultless;

    #[test]
    fn exact_the_page_holds_the_reports_sections_and_escapes() {
        let mut records = vec![faultless("anna", 1), faultless("ben", 1)];
        records[0].scenario = EVIL.into();
        records[1].scenario = EVIL.into();
        let cohort =
            cohort(&records, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete: IncompletePolicy::LeaveOut });
        let names = [EVIL.to_owned()];
        let chosen = GroupSelection {
            flown_scenarios: &names,
            scenarios: &names,
            repetitions: 1,
            incomplete: IncompletePolicy::LeaveOut,
            left_out: 0,
        };
        let text = group(&administrator(), &chosen, Some(&cohort)).into_string();
        check(&text);
        assert!(text.contains("href=\"/cohort/tables/t_tests.csv?scenario="), "{text}");
        assert!(text.contains("2 trainees, 2 sessions") && text.contains("class=\"histogram\""), "{text}");
        assert!(group(&administrator(), &chosen, None).into_string().contains("No sessions yet"));
        let chosen = GroupSelection { incomplete: IncompletePolicy::Include, ..chosen };
        let text = group(&administrator(), &chosen, Some(&cohort)).into_string();
        assert!(text.contains("incomplete=1") && text.contains("value=\"1\" checked"), "{text}");
    }
}
