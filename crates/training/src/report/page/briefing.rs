//! The briefing as a page to read on a screen or to print: drawings of the site, tasks, conditions, hazards, what counts, and
//! the site check with boxes to tick.

use super::super::formatting;
use super::super::plots::job::{job_plan, job_side, job_south};
use super::figure::{SLOT, filled};
use super::{PageScripts, document};
use crate::briefing::{Briefing, TaskBriefing};
use maud::{Markup, html};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_text::{Language, text};

/// Renders the briefing as a complete document that works offline.
#[must_use]
pub fn briefing(briefing: &Briefing, scenario: &Scenario, site: &Site, language: Language) -> String {
    let title = text!(language, "report-briefing-title", title = briefing.title.as_str());
    let lead = text!(language, "report-briefing-lead", job = SLOT);
    let body = html! {
        header { h1 { (briefing.title) } p.lead { (filled(&lead, &html! { code { (briefing.job) } })) } }
        main { (contents(briefing, scenario, site, language)) }
    };
    document(language, &title, &PageScripts::None, &body)
}

/// Renders the sections of the briefing, for a document or a page of the web server.
#[must_use]
pub fn contents(briefing: &Briefing, scenario: &Scenario, site: &Site, language: Language) -> Markup {
    html! {
        @if !briefing.notes.is_empty() { (section("notes", &text!(language, "report-briefing-notes"), &paragraphs(&briefing.notes))) }
        (section("site", &text!(language, "report-briefing-site"), &drawings(scenario, site, language)))
        @if !briefing.tasks.is_empty() { (section("tasks", &text!(language, "report-briefing-tasks"), &tasks(&briefing.tasks, language))) }
        (section("conditions", &text!(language, "report-briefing-conditions"), &conditions(&briefing.conditions)))
        @if !briefing.hazards.is_empty() { (section("hazards", &text!(language, "report-briefing-hazards"), &list(&briefing.hazards))) }
        (section("counts", &text!(language, "report-briefing-counts"), &list(&briefing.counts)))
        (section("check", &text!(language, "report-briefing-check"), &site_check(&briefing.site_check)))
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

fn drawings(scenario: &Scenario, site: &Site, language: Language) -> Markup {
    let figure = |caption: &str, drawing: &Markup| {
        html! { figure.wide { figcaption { (caption) } div.scroll tabindex="0" role="region" aria-label=(caption) { (drawing) } } }
    };
    html! {
        (figure(&text!(language, "report-briefing-above"), &job_plan(scenario, site, language)))
        @for bridge in &scenario.bridges {
            (figure(&text!(language, "report-briefing-side", bridge = bridge.name.as_str()), &job_side(scenario, site, bridge, language)))
        }
        @if scenario.bridges.is_empty() { (figure(&text!(language, "report-briefing-south"), &job_south(scenario, site, language))) }
    }
}

fn tasks(tasks: &[TaskBriefing], language: Language) -> Markup {
    let number = |value: f64, digits: usize| formatting::number(value, digits);
    html! {
        div.scroll tabindex="0" role="region" aria-label=(text!(language, "report-briefing-task-region")) {
            table.list {
                thead { tr {
                    th scope="col" { (text!(language, "report-briefing-task")) }
                    th scope="col" { (text!(language, "report-briefing-where")) }
                    th.number scope="col" { (text!(language, "report-briefing-length")) }
                    th.number scope="col" { (text!(language, "report-briefing-height")) }
                    th.number scope="col" { (text!(language, "report-briefing-stand-off")) }
                    th scope="col" { (text!(language, "report-briefing-lamp")) }
                } }
                tbody { @for task in tasks { tr {
                    th scope="row" { (task.id) " · " (task.name) }
                    td { (task.place) }
                    td.number { (number(task.length_m, 0)) }
                    td.number { (heights_words(task.heights_m, language)) }
                    td.number { @match task.stand_off_m {
                        Some((recommended_m, tolerance_m)) => { (number(recommended_m, 1)) " ± " (number(tolerance_m, 1)) },
                        None => "–",
                    } }
                    td { @if task.lamp { (text!(language, "report-briefing-lamp-needed")) } @else { "–" } }
                } } }
            }
        }
    }
}

/// Returns a range of heights, or one height if both ends are the same.
fn heights_words((low_m, high_m): (f64, f64), language: Language) -> String {
    let (low, high) = (formatting::number(low_m, 0), formatting::number(high_m, 0));
    if low == high { high } else { text!(language, "report-briefing-heights", low = low, high = high) }
}

fn conditions(rows: &[(String, String)]) -> Markup {
    html! { table.list { tbody { @for (name, value) in rows { tr { th scope="row" { (name) } td { (value) } } } } } }
}

fn site_check(items: &[String]) -> Markup {
    html! { @for item in items { p { label { input type="checkbox"; " " (item) } } } }
}
