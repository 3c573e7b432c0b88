//! The report page, section by section. User-provided text is escaped by maud; data for the page's script is escaped by
//! [`series`].

mod air;
mod briefing;
mod certification;
pub mod cohort;
mod compare;
mod coverage;
mod crash_kinds;
mod defects_found;
mod feedback;
mod figure;
mod flight_section;
mod gallery;
mod moment;
mod next_steps;
pub mod progress;
mod record;
pub mod series;
mod summary;
mod tasks;
mod to_do_better;
pub mod within_error;

pub use briefing::{briefing, contents as briefing_contents, figure as briefing_picture};
pub use compare::comparison;
pub use flight_section::VIDEO_SOURCE;

use super::Review;
use super::assets;
use crate::marks::marks_key;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use spandrel_text::{Language, text};

/// Name of the element that contains the key of the instructor's marks, [`marks_key`].
pub const MARKS_META_NAME: &str = "spandrel-marks";

/// Renders a session's report page.
#[must_use]
pub fn session(review: &Review) -> String {
    let metadata = &review.metadata;
    let language = metadata.language;
    let (trainee, started) = (metadata.trainee.as_str(), metadata.started_utc.as_str());
    let title = text!(language, "report-title", trainee = trainee, started = started);
    let sketcher = gallery::sketcher(review);
    let sections = [
        ("better", text!(language, "report-section-better"), to_do_better::section(review)),
        ("scores", text!(language, "report-section-scores"), summary::scores(review)),
        ("tasks", text!(language, "report-section-tasks"), tasks::section(review)),
        ("next", text!(language, "report-section-next"), next_steps::section(review)),
        ("flight", text!(language, "report-section-flight"), flight_section::section(review)),
        ("pictures", text!(language, "report-section-pictures"), gallery::section(review, &sketcher)),
        ("defects", text!(language, "report-section-defects"), defects_found::section(review, &sketcher)),
        ("feedback", text!(language, "report-section-feedback"), feedback::section(review)),
        ("coverage", text!(language, "report-section-coverage"), coverage::section(review)),
        ("certification", text!(language, "report-section-certification"), certification::section(review)),
        ("record", text!(language, "report-section-record"), record::section(review)),
    ];
    let data = series::data(review);
    document(
        language,
        &title,
        &PageScripts::Session { data, marks: marks_key(&review.metadata.marks) },
        &html! {
            (summary::header(review))
            nav aria-label=(text!(language, "report-sections")) {
                @for (id, name, _) in &sections { a href={ "#" (id) } { (name) } }
                (print_button(language))
            }
            main {
                @for (id, name, body) in &sections {
                    section id=(id) aria-labelledby={ (id) "-head" } { h2 id={ (id) "-head" } { (name) } (body) }
                }
            }
        },
    )
}

/// A page's interactive content: embedded data and the scripts that use it.
enum PageScripts {
    /// The page is static.
    None,
    /// Only its print button.
    Print,
    /// Slider, charts and 3D view of a session.
    Session {
        /// Embedded data.
        data: String,
        /// Key of the instructor's marks; `None` without marks.
        marks: Option<String>,
    },
    /// Slider and charts of two sessions.
    Comparison(String),
}

/// Renders a complete document: content security policy, styles, body, data and scripts. Styles and scripts are part of
/// Spandrel or a library and contain no user input.
fn document(language: Language, title: &str, moves: &PageScripts, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang=(language.tag()) {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(assets::page_policy());
                @if let PageScripts::Session { marks: Some(marks), .. } = moves { meta name=(MARKS_META_NAME) content=(marks); }
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(concat!("spandrel ", env!("CARGO_PKG_VERSION")));
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(assets::UPLOT_STYLE)) }
                style { (PreEscaped(assets::STYLE)) }
            }
            body {
                (body)
                @match moves {
                    PageScripts::None => {}
                    PageScripts::Print => { (scripts(&[assets::PRINT_SCRIPT])) }
                    PageScripts::Session { data, .. } => {
                        script type="application/json" id="flight-data" { (PreEscaped(data)) }
                        script type="text/plain" id="three-core" { (PreEscaped(assets::THREE_CORE_SCRIPT)) }
                        script type="text/plain" id="three-module" data-core=(assets::THREE_CORE_NAME) { (PreEscaped(assets::THREE_SCRIPT)) }
                        (scripts(&[assets::UPLOT_SCRIPT, assets::COMMON_SCRIPT, assets::SCRIPT, assets::PRINT_SCRIPT]))
                    }
                    PageScripts::Comparison(data) => {
                        script type="application/json" id="comparison-data" { (PreEscaped(data)) }
                        (scripts(&[assets::UPLOT_SCRIPT, assets::COMMON_SCRIPT, assets::COMPARE_SCRIPT]))
                    }
                }
            }
        }
    }
    .into_string()
}

/// Renders the button that prints the page. Its script shows it.
#[must_use]
pub fn print_button(language: Language) -> Markup {
    html! { button type="button" id="print" hidden { (text!(language, "report-print")) } }
}

fn scripts(texts: &[&str]) -> Markup {
    html! { @for text in texts { script { (PreEscaped(text)) } } }
}
