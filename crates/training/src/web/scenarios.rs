//! Scenario list, scenario page and upload, and import of recorded flights.

use super::access::{AccessLevel, Visitor};
use super::assets::PRINT_NAME;
use super::layout::{ELEMENT, Notice, message, page, page_with_script, section, table, token, with_element};
use crate::briefing::Briefing;
use crate::plan::level_settings;
use crate::report::formatting;
use crate::report::page::{briefing_contents, briefing_picture, print_button};
use crate::report::plots::job::job_plan;
use crate::terms::{scenario_title, task_title};
use maud::{Markup, html};
use spandrel_model::scenario::{BriefingPicture, Difficulty, MAX_BRIEFING_PICTURES, MAX_CAPTION_CHARS, Scenario};
use spandrel_model::site::Site;
use spandrel_text::{Language, text};

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

impl ScenarioEntry {
    /// Returns the title in the language of a page. A title other than that of a shipped scenario stays as it is.
    #[must_use]
    pub fn shown_title(&self, language: Language) -> String {
        scenario_title(&self.name, &self.title, language)
    }
}

/// Renders the scenario list with the result of an upload, if any.
#[must_use]
pub fn list(visitor: &Visitor, named: &[ScenarioEntry], notice: Option<Notice<'_>>) -> Markup {
    let language = visitor.language;
    let rows = html! {
        @for one in named {
            tr {
                th scope="row" { a href={ "/scenarios/" (one.name) } { (one.name) } }
                td { (one.shown_title(language)) }
                td { @if one.uploaded { (text!(language, "editor-uploaded")) } @else { (text!(language, "editor-shipped")) } }
            }
        }
    };
    let heads = [
        (text!(language, "editor-name"), false),
        (text!(language, "editor-title"), false),
        (text!(language, "editor-source"), false),
    ];
    let body = html! {
        @if let Some(notice) = notice { (notice.render()) }
        @if visitor.satisfies(AccessLevel::Instructor) { p { a.button href="/scenarios/new" { (text!(language, "editor-new-scenario")) } } }
        section { (table(&text!(language, "editor-scenario-count", count = named.len()), &heads, &rows)) }
        @if visitor.satisfies(AccessLevel::Instructor) { (section("upload", &text!(language, "editor-upload-scenario"), &upload(visitor))) }
    };
    page(visitor, "/scenarios", &text!(language, "editor-scenarios"), &body)
}

fn upload(visitor: &Visitor) -> Markup {
    html! {
        p { (text!(visitor.language, "editor-upload-scenario-note")) }
        form.stacked method="post" action="/scenarios" enctype="multipart/form-data" {
            (token(visitor))
            label { (text!(visitor.language, "editor-file")) input type="file" name="file" accept=".toml" required; }
            button type="submit" { (text!(visitor.language, "web-validate-and-save")) }
        }
    }
}

/// Describes the ends of the difficulty levels and the standard level.
fn levels(language: Language, difficulty: &Difficulty) -> String {
    let (standard, levels) = (difficulty.standard, difficulty.levels());
    let [first, middle, last] = [1, standard, levels].map(|level| level_settings(difficulty.settings_at(level), language));
    text!(language, "editor-levels", levels = levels, first = first, standard = standard, middle = middle, last = last)
}

/// Renders the summary of a scenario.
fn facts(language: Language, scenario: &Scenario) -> Markup {
    let (scoring, traffic, wind) = (&scenario.scoring, &scenario.traffic, &scenario.wind);
    let (cars, trucks, pedestrians) = (traffic.cars, traffic.trucks, traffic.pedestrians);
    let (speed, from) = (formatting::number(wind.speed_m_s, 1), formatting::number(wind.from_deg, 0));
    let (best, most) = (formatting::duration(scoring.time_best_s), formatting::duration(scoring.time_max_s));
    html! {
        dl.facts {
            dt { (text!(language, "editor-bridges")) } dd { (scenario.bridges.len()) }
            dt { (text!(language, "editor-tasks")) } dd { (scenario.tasks.len()) }
            dt { (text!(language, "editor-defects-to-find")) } dd { (scenario.defects.number()) }
            dt { (text!(language, "editor-traffic")) } dd { (text!(language, "editor-traffic-text", cars = cars, trucks = trucks, pedestrians = pedestrians)) }
            dt { (text!(language, "editor-wind")) } dd { (text!(language, "editor-wind-text", speed = speed, from = from)) }
            dt { (text!(language, "editor-speed-limit")) } dd { (scoring.speed_limit_unit.format_limit(scoring.speed_limit_m_s)) }
            dt { (text!(language, "editor-time")) } dd { (text!(language, "editor-time-text", best = best, most = most)) }
            @if let Some(difficulty) = &scenario.difficulty { dt { (text!(language, "editor-difficulty")) } dd { (levels(language, difficulty)) } }
        }
    }
}

fn edit_link(language: Language, named: &ScenarioEntry) -> Markup {
    html! {
        @if named.uploaded {
            a.button href={ "/scenarios/" (named.name) "/edit" } { (text!(language, "editor-edit")) }
        } @else {
            a.button href={ "/scenarios/new?base=" (named.name) } { (text!(language, "editor-copy")) }
        }
    }
}

/// Contents of a scenario's page.
#[derive(Debug, Clone, Copy)]
pub struct ScenarioPage<'a> {
    /// Name, title and origin.
    pub named: &'a ScenarioEntry,
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Its site.
    pub site: &'a Site,
    /// Source text (TOML).
    pub text: &'a str,
    /// Version of the text, by which a change to the pictures notices changes by others.
    pub version: &'a str,
    /// Address of each picture of the briefing; `None` if it is missing.
    pub pictures: &'a [Option<String>],
    /// Result of a change.
    pub notice: Option<Notice<'a>>,
}

/// Renders one scenario's page. Only instructors see the file, because it contains the seed and thus reveals the
/// defects.
#[must_use]
pub fn scenario_page(visitor: &Visitor, about: &ScenarioPage<'_>) -> Markup {
    let language = visitor.language;
    let ScenarioPage { named, scenario, site, text, .. } = *about;
    let heads = [(text!(language, "editor-task"), false), (text!(language, "editor-tolerance"), true)];
    let briefing = html! { a href={ "/scenarios/" (named.name) "/briefing" } { (text!(language, "editor-briefing")) } };
    let rows = html! {
        @for task in &scenario.tasks {
            tr { th scope="row" { (task.id) " · " (task_title(&scenario.name, &task.name, language)) } td.number { (formatting::number(task.threshold_m, 1)) } }
        }
    };
    let body = html! {
        @if let Some(notice) = about.notice { (notice.render()) }
        p.lead { (scenario_title(&scenario.name, &scenario.title, language)) }
        p { (with_element(&text!(language, "editor-briefing-link", briefing = ELEMENT), &briefing)) }
        @if visitor.satisfies(AccessLevel::Instructor) { p { (edit_link(language, named)) } }
        (section("facts", &text!(language, "editor-summary"), &facts(language, scenario)))
        @if !scenario.tasks.is_empty() {
            (section("tasks", &text!(language, "editor-tasks"), &table(&text!(language, "editor-tolerances"), &heads, &rows)))
        }
        (section("site", &text!(language, "editor-site-plan"), &html! { figure.wide { div.scroll tabindex="0" role="region" aria-label=(text!(language, "editor-drawing")) { (job_plan(scenario, site, language)) } } }))
        @if visitor.satisfies(AccessLevel::Instructor) && named.uploaded {
            (section("pictures", &text!(language, "editor-briefing-pictures"), &pictures(visitor, about)))
        }
        @if visitor.satisfies(AccessLevel::Instructor) { (section("file", &text!(language, "editor-file"), &html! {
            details { summary { (text!(language, "editor-show")) } div.scroll tabindex="0" role="region" aria-label=(text!(language, "editor-file-contents")) { pre { code { (text) } } } }
            @if named.uploaded {
                form method="post" action={ "/scenarios/" (named.name) "/remove" } { (token(visitor)) button.danger type="submit" { (text!(language, "editor-delete-scenario")) } }
            }
        })) }
    };
    page(visitor, "/scenarios", &text!(language, "editor-scenario-title", name = named.name.as_str()), &body)
}

/// Renders the pictures of the briefing with a button that removes each, and the form that adds one.
fn pictures(visitor: &Visitor, about: &ScenarioPage<'_>) -> Markup {
    let pictures = &about.scenario.briefing_pictures;
    let addresses = about.pictures.iter().map(Option::as_deref).chain(std::iter::repeat(None));
    html! {
        p { (text!(visitor.language, "editor-briefing-pictures-note", most = MAX_BRIEFING_PICTURES)) }
        @if !pictures.is_empty() {
            div.briefing-pictures { @for (picture, address) in pictures.iter().zip(addresses) {
                div { (briefing_picture(picture, address, visitor.language)) (remove_picture(visitor, about, picture)) }
            } }
        }
        @if pictures.len() < MAX_BRIEFING_PICTURES { (add_picture(visitor, about)) }
    }
}

fn remove_picture(visitor: &Visitor, about: &ScenarioPage<'_>, picture: &BriefingPicture) -> Markup {
    let label = text!(visitor.language, "editor-briefing-picture-remove", caption = picture.caption.as_str());
    html! {
        form method="post" action={ "/scenarios/" (about.named.name) "/pictures/remove" } {
            (token(visitor))
            input type="hidden" name="version" value=(about.version);
            input type="hidden" name="file" value=(picture.file);
            button.danger type="submit" aria-label=(label) { (text!(visitor.language, "editor-remove")) }
        }
    }
}

fn add_picture(visitor: &Visitor, about: &ScenarioPage<'_>) -> Markup {
    let language = visitor.language;
    html! {
        form.stacked method="post" action={ "/scenarios/" (about.named.name) "/pictures" } enctype="multipart/form-data" {
            (token(visitor))
            input type="hidden" name="version" value=(about.version);
            label { (text!(language, "editor-briefing-picture-file")) input type="file" name="file" accept=".png,.jpg,.jpeg" required; }
            label { (text!(language, "editor-key-caption")) input name="caption" required maxlength=(MAX_CAPTION_CHARS); }
            button type="submit" { (text!(language, "editor-briefing-picture-add")) }
        }
    }
}

/// Renders the briefing for a scenario. `pictures` are the addresses of its pictures; `None` stands for a missing one.
#[must_use]
pub fn briefing_page(
    visitor: &Visitor,
    briefing: &Briefing,
    (scenario, site): (&Scenario, &Site),
    pictures: &[Option<String>],
) -> Markup {
    let language = visitor.language;
    let body = html! {
        p.lead { (briefing.title) }
        (print_button(language))
        (briefing_contents(briefing, (scenario, site), pictures, language))
    };
    let title = text!(language, "editor-briefing-title", name = briefing.job.as_str());
    page_with_script(visitor, "/scenarios", &title, Some(PRINT_NAME), &body)
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
    let language = visitor.language;
    let imported = |id: &str, trainee: &str| html! { a href={ "/sessions/" (id) } { (text!(language, "editor-imported-session", name = trainee)) } };
    let body = html! {
        @match notice {
            None => {},
            Some(UploadMessage::Invalid(words)) => (message("bad", words)),
            Some(UploadMessage::AlreadyImported { id, trainee }) => p.message.good role="status" {
                (with_element(&text!(language, "editor-imported", session = ELEMENT), &imported(id, trainee)))
            },
        }
        section.narrow {
            p { (text!(language, "editor-import-note")) }
            form.stacked method="post" action="/upload" enctype="multipart/form-data" {
                (token(visitor))
                label { (text!(language, "editor-import-trainee")) input name="trainee" required maxlength="32" pattern="[A-Za-z0-9][A-Za-z0-9_\\-]*" autocapitalize="none"; }
                label { (text!(language, "editor-import-scenario")) select name="scenario" { @for one in scenarios { option value=(one.name) { (one.name) } } } }
                label { (text!(language, "editor-import-aircraft")) select name="vehicle" { @for one in vehicles { option value=(one) { (one) } } } }
                label { (text!(language, "editor-import-recording")) input type="file" name="file" accept=".tlog" required; }
                button type="submit" { (text!(language, "editor-import-button")) }
            }
        }
    };
    page(visitor, "/sessions", &text!(language, "editor-import-title"), &body)
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use crate::trainee::Role;

    #[test]
    fn exact_only_instructors_can_upload_and_file_contents_are_escaped() {
        let named = [ScenarioEntry { name: HOSTILE_NAME.into(), title: HOSTILE_NAME.into(), uploaded: true }];
        let text =
            list(&administrator(), &named, Some(Notice { kind: "bad", text: HOSTILE_NAME, details: HOSTILE_NAME })).into_string();
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

    fn shown<'a>(named: &'a ScenarioEntry, scenario: &'a Scenario, site: &'a Site) -> ScenarioPage<'a> {
        ScenarioPage { named, scenario, site, text: "", version: "v1", pictures: &[], notice: None }
    }

    #[test]
    fn exact_instructors_add_and_remove_the_pictures_of_uploaded_scenarios() {
        let mut scenario =
            spandrel_model::scenario::read("job.toml", spandrel_model::shipped::PRACTICE, &|_| Err(String::new())).unwrap();
        let picture = |k: usize| BriefingPicture { file: format!("job/{k}.png"), caption: HOSTILE_NAME.into() };
        let site = Site::without_defects(&scenario);
        let entry = |uploaded| ScenarioEntry { name: "job".into(), title: "Job".into(), uploaded };
        let count = |page: &str| (page.matches("/scenarios/job/pictures/remove").count(), page.matches("type=\"file\"").count());
        for (pictures, forms) in [(0, 1), (2, 1), (MAX_BRIEFING_PICTURES, 0)] {
            scenario.briefing_pictures = (0..pictures).map(picture).collect();
            let (uploaded, shipped) = (entry(true), entry(false));
            let addresses = [Some("/scenarios/job/pictures/0.png".to_owned()), None];
            let about = ScenarioPage { pictures: &addresses, ..shown(&uploaded, &scenario, &site) };
            let page = scenario_page(&administrator(), &about).into_string();
            check(&page);
            assert_eq!((count(&page), page.matches("<img").count()), ((pictures, forms), pictures.min(1)));
            assert_eq!(page.matches("name=\"version\" value=\"v1\"").count(), pictures + forms);
            let trainee = Visitor { role: Role::Trainee, ..administrator() };
            assert_eq!(count(&scenario_page(&trainee, &about).into_string()), (0, 0));
            let shipped = ScenarioPage { named: &shipped, ..about };
            assert_eq!(count(&scenario_page(&administrator(), &shipped).into_string()), (0, 0));
        }
    }

    #[test]
    fn exact_titles_of_shipped_scenarios_are_translated() {
        let entry = |title: &str| ScenarioEntry { name: "drill-hover".into(), title: title.into(), uploaded: false };
        let shipped = entry("Drill: hover");
        let german = shipped.shown_title(Language::German);
        assert_ne!(german, shipped.title);
        let page = list(&administrator_with(Language::German), &[shipped], None).into_string();
        assert!(page.contains(&german), "{page}");
        assert_eq!(entry("Hover here").shown_title(Language::German), "Hover here");
    }

    #[test]
    fn exact_scenario_pages_are_translated() {
        let visitor = administrator_with(Language::Pseudo);
        let entry = |uploaded| ScenarioEntry { name: "7".into(), title: "8".into(), uploaded };
        check_translated(&list(&visitor, &[entry(true), entry(false)], None).into_string(), &["TOML"]);
        let told = [None, Some(UploadMessage::AlreadyImported { id: "1", trainee: "2" })];
        for told in told {
            check_translated(&recorded(&visitor, &[entry(true)], &["9".into()], told).into_string(), &["tlog"]);
        }
        let mut scenario =
            spandrel_model::scenario::read("job.toml", spandrel_model::shipped::PRACTICE, &|_| Err(String::new())).unwrap();
        (scenario.title, scenario.tasks) = ("8".into(), Vec::new());
        let site = Site::without_defects(&scenario);
        for entry in [entry(true), entry(false)] {
            let about = ScenarioPage { text: "9", ..shown(&entry, &scenario, &site) };
            let page = scenario_page(&visitor, &about).into_string();
            check_translated(&page, &["mph", "min", "PNG", "JPEG", "MiB"]);
            let german = scenario_page(&administrator_with(Language::German), &about).into_string();
            assert!(german.contains("Zu findende Schäden") && german.contains("<h1>Szenario 7</h1>"), "{german}");
        }
    }
}
