//! The briefing as a page to read on a screen or to print: drawings of the site, tasks, conditions, hazards, what counts, and
//! the site check with boxes to tick.

use super::super::formatting;
use super::super::plots::job::{job_plan, job_side, job_south};
use super::{PageScripts, document};
use crate::briefing::{Briefing, TaskBriefing};
use maud::{Markup, html};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;

/// Renders the briefing as a complete document that works offline.
#[must_use]
pub fn briefing(briefing: &Briefing, scenario: &Scenario, site: &Site) -> String {
    let title = format!("Briefing: {}", briefing.title);
    let body = html! {
        header { h1 { (briefing.title) } p.lead { "Briefing for the job " code { (briefing.job) } } }
        main { (contents(briefing, scenario, site)) }
    };
    document(&title, &PageScripts::None, &body)
}

/// Renders the sections of the briefing, for a document or a page of the web server.
#[must_use]
pub fn contents(briefing: &Briefing, scenario: &Scenario, site: &Site) -> Markup {
    html! {
        @if !briefing.notes.is_empty() { (section("notes", "From your instructor", &paragraphs(&briefing.notes))) }
        (section("site", "Site", &drawings(scenario, site)))
        @if !briefing.tasks.is_empty() { (section("tasks", "Tasks, in this order", &tasks(&briefing.tasks))) }
        (section("conditions", "Conditions", &conditions(&briefing.conditions)))
        @if !briefing.hazards.is_empty() { (section("hazards", "Hazards", &list(&briefing.hazards))) }
        (section("counts", "What counts", &list(&briefing.counts)))
        (section("check", "Site check before takeoff", &site_check(&briefing.site_check)))
    }
}

fn section(id: &str, heading: &str, body: &Markup) -> Markup {
    html! { section id=(id) aria-labelledby={ (id) "-head" } { h2 id={ (id) "-head" } { (heading) } (body) } }
}

fn paragraphs(texts: &[String]) -> Markup {
    html! { @for text in texts { p { (text) } } }
}

fn list(lines: &[String]) -> Markup {
    html! { ul { @for line in lines { li { (line) } } } }
}

fn drawings(scenario: &Scenario, site: &Site) -> Markup {
    let figure = |caption: &str, drawing: &Markup| {
        html! { figure.wide { figcaption { (caption) } div.scroll tabindex="0" role="region" aria-label=(caption) { (drawing) } } }
    };
    html! {
        (figure("From above, north up", &job_plan(scenario, site)))
        @for bridge in &scenario.bridges {
            (figure(&format!("Bridge '{}' from the side", bridge.name), &job_side(scenario, site, bridge)))
        }
        @if scenario.bridges.is_empty() { (figure("From the south", &job_south(scenario, site))) }
    }
}

fn tasks(tasks: &[TaskBriefing]) -> Markup {
    let number = |value: f64, digits: usize| formatting::number(value, digits);
    html! {
        div.scroll tabindex="0" role="region" aria-label="Tasks" {
            table.list {
                thead { tr {
                    th scope="col" { "Task" } th scope="col" { "Where" } th.number scope="col" { "Length (m)" }
                    th.number scope="col" { "Height above the pad (m)" } th.number scope="col" { "Stand-off (m)" } th scope="col" { "Lamp" }
                } }
                tbody { @for task in tasks { tr {
                    th scope="row" { (task.id) " · " (task.name) }
                    td { (task.place) }
                    td.number { (number(task.length_m, 0)) }
                    td.number { (heights_words(task.heights_m)) }
                    td.number { @match task.stand_off_m {
                        Some((recommended_m, tolerance_m)) => { (number(recommended_m, 1)) " ± " (number(tolerance_m, 1)) },
                        None => "–",
                    } }
                    td { (if task.lamp { "needed" } else { "–" }) }
                } } }
            }
        }
    }
}

/// Returns a range of heights, or one height if both ends are the same.
fn heights_words((low_m, high_m): (f64, f64)) -> String {
    let (low, high) = (formatting::number(low_m, 0), formatting::number(high_m, 0));
    if low == high { high } else { format!("{low} to {high}") }
}

fn conditions(rows: &[(String, String)]) -> Markup {
    html! { table.list { tbody { @for (name, value) in rows { tr { th scope="row" { (name) } td { (value) } } } } } }
}

fn site_check(items: &[String]) -> Markup {
    html! { @for item in items { p { label { input type="checkbox"; " " (item) } } } }
}
