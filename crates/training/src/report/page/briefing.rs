//! The briefing as a page to read on a screen or to print: drawings of the site, tasks, conditions, hazards, what counts, and
//! the site check with boxes to tick.

use super::super::formatting;
use super::super::plots::job::{job_plan, job_side, job_south};
use super::figure::{SLOT, filled};
use super::{PageScripts, document, print_button};
use crate::briefing::{Briefing, TaskBriefing};
use maud::{Markup, html};
use spandrel_model::scenario::{BriefingPicture, Scenario};
use spandrel_model::site::Site;
use spandrel_text::{Language, text};

/// Renders the briefing as a complete document. It works offline if the addresses of the pictures are data URIs; `None` stands for
/// a missing picture.
#[must_use]
pub fn briefing(
    briefing: &Briefing,
    (scenario, site): (&Scenario, &Site),
    pictures: &[Option<String>],
    language: Language,
) -> String {
    let title = text!(language, "report-briefing-title", title = briefing.title.as_str());
    let lead = text!(language, "report-briefing-lead", job = SLOT);
    let body = html! {
        header { h1 { (briefing.title) } p.lead { (filled(&lead, &html! { code { (briefing.job) } })) } (print_button(language)) }
        main { (contents(briefing, (scenario, site), pictures, language)) }
    };
    document(language, &title, &PageScripts::Print, &body)
}

/// Renders the sections of the briefing, for a document or a page of the web server.
#[must_use]
pub fn contents(
    briefing: &Briefing,
    (scenario, site): (&Scenario, &Site),
    pictures: &[Option<String>],
    language: Language,
) -> Markup {
    html! {
        @if !briefing.notes.is_empty() { (section("notes", &text!(language, "report-briefing-notes"), &paragraphs(&briefing.notes))) }
        @if !briefing.pictures.is_empty() {
            (section("pictures", &text!(language, "report-briefing-pictures"), &figures(&briefing.pictures, pictures, language)))
        }
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

fn figures(pictures: &[BriefingPicture], addresses: &[Option<String>], language: Language) -> Markup {
    let addresses = addresses.iter().map(Option::as_deref).chain(std::iter::repeat(None));
    html! { div.briefing-pictures { @for (picture, address) in pictures.iter().zip(addresses) { (figure(picture, address, language)) } } }
}

/// Renders a picture with its caption. Without an address, a note says that the picture is missing.
#[must_use]
pub fn figure(picture: &BriefingPicture, address: Option<&str>, language: Language) -> Markup {
    html! {
        figure {
            @match address {
                Some(address) => { img src=(address) alt=(picture.caption); }
                None => { p.note { (text!(language, "report-briefing-picture-missing", file = picture.file.as_str())) } }
            }
            figcaption { (picture.caption) }
        }
    }
}

fn list(lines: &[String]) -> Markup {
    html! { ul { @for line in lines { li { (line) } } } }
}

fn drawings(scenario: &Scenario, site: &Site, language: Language) -> Markup {
    let drawn = |caption: &str, drawing: &Markup| {
        html! { figure.wide { figcaption { (caption) } div.scroll tabindex="0" role="region" aria-label=(caption) { (drawing) } } }
    };
    html! {
        (drawn(&text!(language, "report-briefing-above"), &job_plan(scenario, site, language)))
        @for bridge in &scenario.bridges {
            (drawn(&text!(language, "report-briefing-side", bridge = bridge.name.as_str()), &job_side(scenario, site, bridge, language)))
        }
        @if scenario.bridges.is_empty() { (drawn(&text!(language, "report-briefing-south"), &job_south(scenario, site, language))) }
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

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::edit::with_briefing_picture;
    use spandrel_model::{scenario, shipped, vehicle};

    fn page(pictures: &[BriefingPicture], addresses: &[Option<String>]) -> String {
        let add = |text: String, picture: &BriefingPicture| with_briefing_picture(&text, picture).unwrap();
        let text = pictures.iter().fold(shipped::PRACTICE.to_owned(), add);
        let scenario = scenario::read("job.toml", &text, &|_| Err(String::new())).unwrap();
        let (site, vehicle) = (Site::without_defects(&scenario), vehicle::read("phantom2.toml", shipped::PHANTOM2).unwrap());
        let language = Language::English;
        briefing(&Briefing::new(&scenario, &vehicle, &site, language), (&scenario, &site), addresses, language)
    }

    #[test]
    fn exact_pictures_have_their_captions_and_missing_ones_are_named() {
        let picture = |file: &str, caption: &str| BriefingPicture { file: file.into(), caption: caption.into() };
        let pictures = [picture("gate.png", "The <gate>"), picture("pier.jpg", "The \"pier\"")];
        let uri = "data:image/png;base64,AAAA";
        let shown = page(&pictures, &[Some(uri.into()), None]);
        assert!(
            shown.contains(&format!("<img src=\"{uri}\" alt=\"The &lt;gate&gt;\"><figcaption>The &lt;gate&gt;</figcaption>"))
        );
        assert!(shown.contains("pier.jpg") && shown.contains("<figcaption>The &quot;pier&quot;</figcaption>"));
        assert_eq!((shown.matches("<img").count(), shown.matches("<figcaption>The").count()), (1, 2));
        assert!(shown.contains("img-src data:"), "the policy of the page allows the pictures");
        assert_eq!(page(&pictures, &[]).matches("<img").count(), 0);
        assert!(!page(&[], &[]).contains("id=\"pictures\""));
    }
}
