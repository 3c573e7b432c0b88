//! Scenario list, scenario page and upload, and import of recorded flights.

use super::access::{AccessLevel, Visitor};
use super::layout::{message, message_lines, page, section, table, token};
use crate::briefing::Briefing;
use crate::report::formatting;
use crate::report::page::briefing_contents;
use crate::report::plots::job::job_plan;
use maud::{Markup, html};
use spandrel_model::scenario::{Difficulty, Scenario};
use spandrel_model::site::Site;
use spandrel_text::Language;

/// An entry in the scenario list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioEntry {
    /// Machine-readable scenario name, such as `two-bridges`.
    pub name: String,
    /// Scenario title.
    pub title: String,
    /// Whether the scenario was uploaded and can be removed.
    pub uploaded: bool,
}

/// Renders the scenario list with the result of an upload, if any.
#[must_use]
pub fn list(visitor: &Visitor, named: &[ScenarioEntry], notice: Option<(&str, &str)>) -> Markup {
    let rows = html! {
        @for one in named {
            tr {
                th scope="row" { a href={ "/scenarios/" (one.name) } { (one.name) } }
                td { (one.title) }
                td { (if one.uploaded { "uploaded" } else { "shipped" }) }
            }
        }
    };
    let body = html! {
        @if let Some((kind, words)) = notice { (message_lines(kind, words)) }
        @if visitor.satisfies(AccessLevel::Instructor) { p { a.button href="/scenarios/new" { "New scenario" } } }
        section { (table(&format!("{} scenarios", named.len()), &[("Name", false), ("Title", false), ("Source", false)], &rows)) }
        @if visitor.satisfies(AccessLevel::Instructor) { (section("upload", "Upload a scenario", &upload(visitor))) }
    };
    page(visitor, "/scenarios", "Scenarios", &body)
}

fn upload(visitor: &Visitor) -> Markup {
    html! {
        p { "One self-contained TOML file. It is validated before it is saved, and all errors are listed." }
        form.stacked method="post" action="/scenarios" enctype="multipart/form-data" {
            (token(visitor))
            label { "File" input type="file" name="file" accept=".toml" required; }
            button type="submit" { "Validate and save" }
        }
    }
}

/// Describes the ends of the difficulty levels and the standard level.
fn levels(difficulty: &Difficulty) -> String {
    let (standard, last) = (difficulty.standard, difficulty.levels());
    let at = |level: u8| difficulty.settings_at(level);
    format!(
        "{last} levels. Level 1: {}. Level {standard}, the standard level: {}. Level {last}: {}.",
        at(1),
        at(standard),
        at(last)
    )
}

fn edit_link(named: &ScenarioEntry) -> Markup {
    html! {
        @if named.uploaded {
            a.button href={ "/scenarios/" (named.name) "/edit" } { "Edit" }
        } @else {
            a.button href={ "/scenarios/new?base=" (named.name) } { "Make a copy to edit" }
        }
    }
}

/// Renders one scenario's page. Only instructors see the file, because it contains the seed and thus reveals the
/// defects.
#[must_use]
pub fn scenario_page(visitor: &Visitor, named: &ScenarioEntry, scenario: &Scenario, site: &Site, text: &str) -> Markup {
    let s = &scenario.scoring;
    let facts = html! {
        dl.facts {
            dt { "Bridges" } dd { (scenario.bridges.len()) }
            dt { "Tasks" } dd { (scenario.tasks.len()) }
            dt { "Defects to find" } dd { (scenario.defects.count) }
            dt { "Traffic" } dd { (scenario.traffic.cars) " cars, " (scenario.traffic.trucks) " trucks, " (scenario.traffic.pedestrians) " pedestrians" }
            dt { "Wind" } dd { (formatting::number(scenario.wind.speed_m_s, 1)) " m/s from " (formatting::number(scenario.wind.from_deg, 0)) "°" }
            dt { "Speed limit" } dd { (s.speed_limit_unit.format_limit(s.speed_limit_m_s)) }
            dt { "Time" } dd { "full score up to " (formatting::duration(s.time_best_s)) ", at most " (formatting::duration(s.time_max_s)) }
            @if let Some(difficulty) = &scenario.difficulty { dt { "Difficulty" } dd { (levels(difficulty)) } }
        }
    };
    let rows = html! {
        @for task in &scenario.tasks {
            tr { th scope="row" { (task.id) " · " (task.name) } td.number { (formatting::number(task.threshold_m, 1)) } }
        }
    };
    let body = html! {
        p.lead { (scenario.title) }
        p { a href={ "/scenarios/" (named.name) "/briefing" } { "Briefing" } ": tasks in order, hazards, what counts, and the site check, to read before the flight or to print." }
        @if visitor.satisfies(AccessLevel::Instructor) { p { (edit_link(named)) } }
        (section("facts", "Summary", &facts))
        @if !scenario.tasks.is_empty() {
            (section("tasks", "Tasks", &table("Tasks and path tolerances", &[("Task", false), ("Path tolerance (m)", true)], &rows)))
        }
        (section("site", "Site plan", &html! { figure.wide { div.scroll tabindex="0" role="region" aria-label="Drawing" { (job_plan(scenario, site, Language::English)) } } }))
        @if visitor.satisfies(AccessLevel::Instructor) { (section("file", "File", &html! {
            details { summary { "Show" } div.scroll tabindex="0" role="region" aria-label="File contents" { pre { code { (text) } } } }
            @if named.uploaded {
                form method="post" action={ "/scenarios/" (named.name) "/remove" } { (token(visitor)) button.danger type="submit" { "Delete this scenario" } }
            }
        })) }
    };
    page(visitor, "/scenarios", &format!("Scenario {}", named.name), &body)
}

/// Renders the briefing for a scenario.
#[must_use]
pub fn briefing_page(visitor: &Visitor, briefing: &Briefing, scenario: &Scenario, site: &Site) -> Markup {
    let body = html! { p.lead { (briefing.title) } (briefing_contents(briefing, scenario, site, Language::English)) };
    page(visitor, "/scenarios", &format!("Briefing {}", briefing.job), &body)
}

/// Reason why a recording was not imported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UploadMessage<'a> {
    /// The recording is invalid.
    Invalid(&'a str),
    /// The session already exists.
    AlreadyImported {
        /// Session ID (its folder name).
        id: &'a str,
        /// Trainee of that session.
        trainee: &'a str,
    },
}

/// Renders the import form for recorded flights, with the error from the previous import, if any.
#[must_use]
pub fn recorded(
    visitor: &Visitor,
    scenarios: &[ScenarioEntry],
    vehicles: &[String],
    notice: Option<UploadMessage<'_>>,
) -> Markup {
    let body = html! {
        @match notice {
            None => {},
            Some(UploadMessage::Invalid(words)) => (message("bad", words)),
            Some(UploadMessage::AlreadyImported { id, trainee }) => p.message.good role="status" {
                "This recording was already imported as " a href={ "/sessions/" (id) } { "a session by " (trainee) } ". No changes were made."
            },
        }
        section.narrow {
            p { "Choose a .tlog file recorded by a ground station or the monitor. It must include the simulator's truth messages. The flight is scored before it is saved." }
            form.stacked method="post" action="/upload" enctype="multipart/form-data" {
                (token(visitor))
                label { "Trainee" input name="trainee" required maxlength="32" pattern="[A-Za-z0-9][A-Za-z0-9_\\-]*" autocapitalize="none"; }
                label { "Scenario" select name="scenario" { @for one in scenarios { option value=(one.name) { (one.name) } } } }
                label { "Aircraft" select name="vehicle" { @for one in vehicles { option value=(one) { (one) } } } }
                label { "Recording" input type="file" name="file" accept=".tlog" required; }
                button type="submit" { "Import" }
            }
        }
    };
    page(visitor, "/sessions", "Import flight", &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::trainee::Role;

    #[test]
    fn exact_only_instructors_can_upload_and_file_contents_are_escaped() {
        let named = [ScenarioEntry { name: HOSTILE_NAME.into(), title: HOSTILE_NAME.into(), uploaded: true }];
        let text = list(&administrator(), &named, Some(("bad", HOSTILE_NAME))).into_string();
        check(&text);
        assert!(text.contains("type=\"file\""));
        let trainee = Visitor { role: Role::Trainee, ..administrator() };
        assert!(!list(&trainee, &named, None).into_string().contains("type=\"file\""));
        for told in [UploadMessage::Invalid(HOSTILE_NAME), UploadMessage::AlreadyImported { id: "s-1", trainee: HOSTILE_NAME }] {
            check(&recorded(&administrator(), &named, &[HOSTILE_NAME.into()], Some(told)).into_string());
        }
        let there = recorded(&administrator(), &named, &[], Some(UploadMessage::AlreadyImported { id: "s-1", trainee: "anna" }))
            .into_string();
        assert!(there.contains("href=\"/sessions/s-1\"") && there.contains("a session by anna"), "{there}");
    }
}
