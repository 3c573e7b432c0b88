//! Session lists and session pages.

use super::access::{AccessLevel, Visitor};
use super::assets;
use super::layout::{ELEMENT, page, page_navigation, page_with_script, section, table, token, with_element};
use super::rubric::MAX_NAME_LEN;
use crate::advice::SessionAdvice;
use crate::marks::{MAX_TEXT_LEN, TimelineMark};
use crate::questionnaire::QuestionnaireItem;
use crate::record::{CertificationRecord, SessionListEntry, SessionOutcome, SessionRecord, TaskRecord};
use crate::report::formatting;
use crate::report::plots::bars::{ShareRow, shares};
use crate::report::plots::radar::{RadarAxis, radar};
use crate::standing::SessionStanding;
use crate::terms::{end_reason_title, job_title, purpose_title, score_title, task_title};
use maud::{Markup, html};
use spandrel_model::calendar::minute;
use spandrel_monitor::stored_text::all_translated;
use spandrel_text::terms::capitalized;
use spandrel_text::{Language, text};

/// One page of the session list.
#[derive(Debug, Clone, Copy)]
pub struct SessionList<'a> {
    /// Sessions on this page of the list.
    pub lines: &'a [SessionListEntry],
    /// Trainee to filter the list by, if any.
    pub trainee: Option<&'a str>,
    /// Page number, from 1.
    pub page: u32,
    /// Number of the last page.
    pub last: u32,
    /// Total number of sessions.
    pub count: u64,
}

/// Renders one page of the session list.
#[must_use]
pub fn list(visitor: &Visitor, listing: &SessionList<'_>) -> Markup {
    let language = visitor.language;
    let address = match listing.trainee {
        Some(trainee) => format!("/sessions?trainee={trainee}&"),
        None => "/sessions?".to_owned(),
    };
    let body = html! {
        section {
            div.tools {
                @if visitor.satisfies(AccessLevel::Instructor) {
                    form.inline method="get" action="/sessions" {
                        label { (text!(language, "sessions-trainee")) " " input name="trainee" value=[listing.trainee] maxlength="32" autocapitalize="none"; }
                        button type="submit" { (text!(language, "sessions-show")) }
                        @if listing.trainee.is_some() { a href="/sessions" { (text!(language, "sessions-show-all")) } }
                    }
                    a href="/upload" { (text!(language, "sessions-import")) }
                } @else if let Some(name) = &visitor.name {
                    a href={ "/trainees/" (name) } { (text!(language, "sessions-my-progress")) }
                }
            }
            @if listing.lines.is_empty() {
                p.calm { (text!(language, "sessions-none")) }
            } @else {
                (lines(visitor, &text!(language, "sessions-count", count = listing.count), listing.lines))
                (page_navigation(language, &address, listing.page, listing.last))
            }
        }
    };
    page(visitor, "/sessions", &text!(language, "sessions-title"), &body)
}

/// Renders a table of sessions.
#[must_use]
pub fn lines(visitor: &Visitor, caption: &str, lines: &[SessionListEntry]) -> Markup {
    let (language, all) = (visitor.language, visitor.satisfies(AccessLevel::Instructor));
    // The columns that fit on a phone without scrolling come first: date, trainee, score.
    let mut heads = vec![
        (text!(language, "sessions-started"), false),
        (text!(language, "sessions-trainee"), false),
        (text!(language, "sessions-overall"), true),
        (text!(language, "sessions-certified"), false),
        (text!(language, "sessions-scenario"), false),
        (text!(language, "sessions-purpose"), false),
        (text!(language, "sessions-end"), false),
    ];
    if !all {
        heads.remove(1);
    }
    table(
        caption,
        &heads,
        &html! {
            @for one in lines {
                tr {
                    th.when scope="row" { a href={ "/sessions/" (one.id) } { (minute(one.started_unix_us)) } }
                    @if all { td { a href={ "/trainees/" (one.trainee) } { (one.trainee) } } }
                    @if one.is_complete() { td.number { (text!(language, "sessions-overall-of", score = formatting::number(one.overall, 1), most = formatting::number(one.overall_max, 0))) } }
                    @else { td { (one.completion_summary(language)) } }
                    td { (one.verdict(language)) }
                    td { (one.scenario) }
                    td { (one.purpose.as_deref().map_or_else(|| "–".to_owned(), |purpose| purpose_title(purpose, language))) }
                    td { (end_reason_title(&one.end_reason, language)) }
                }
            }
        },
    )
}

/// Session page data that is not part of the session record.
#[derive(Debug, Clone, Copy)]
pub struct SessionPageData<'a> {
    /// Whether the session folder exists. The report, questionnaire and downloads require it.
    pub folder: bool,
    /// The same trainee's other sessions.
    pub others: &'a [SessionListEntry],
    /// Things to do better, from the session folder. The page shows them in the visitor's language.
    pub advice: Option<&'a SessionAdvice>,
    /// Comparison with the trainee's other sessions on this job.
    pub standing: Option<&'a SessionStanding>,
    /// The instructor's marks, by moment.
    pub marks: &'a [TimelineMark],
    /// File numbers of the photographs, ascending. The report numbers its pictures from 1.
    pub pictures: &'a [u32],
    /// Whether there is a video.
    pub video: bool,
}

/// Renders a session's page.
#[must_use]
pub fn session(visitor: &Visitor, record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    let language = visitor.language;
    let (time, end) = (formatting::duration(record.seconds), end_reason_title(&record.end_reason, language));
    let advice = page_data.advice.map(|advice| advice.in_language(language));
    let page_data = &SessionPageData { advice: advice.as_ref(), ..*page_data };
    let body = html! {
        p.lead {
            a href={ "/trainees/" (record.trainee) } { (record.trainee) } " · " (minute(record.started_unix_us)) " · " (record.vehicle)
            @if let Some(purpose) = &record.purpose { " · " (purpose_title(purpose, language)) } " · "
            (text!(language, "sessions-flight-time", time = time, end = end))
        }
        (section("better", &text!(language, "sessions-better"), &to_do_better(language, record, page_data)))
        (actions(language, record, page_data))
        @if page_data.folder && (!page_data.marks.is_empty() || visitor.satisfies(AccessLevel::Instructor)) {
            (section("marks", &text!(language, "sessions-marks"), &timeline_marks(visitor, record, page_data.marks)))
        }
        @if page_data.video { (section("video", &text!(language, "sessions-video"), &video(language, record, page_data))) }
        @if !page_data.pictures.is_empty() { (section("pictures", &text!(language, "sessions-pictures"), &photographs(language, record, page_data.pictures))) }
        (section("scores", &text!(language, "sessions-scores"), &scores(language, record)))
        @if let Some(certification) = &record.certification { (section("certification", &text!(language, "sessions-certification"), &requirements(language, certification))) }
        @if !record.tasks.is_empty() { (section("tasks", &text!(language, "sessions-tasks"), &tasks(language, record))) }
        @if !record.defects.is_empty() { (section("defects", &text!(language, "sessions-defects"), &defects(language, record))) }
        (section("compare", &text!(language, "sessions-compare-with"), &compare(language, record, page_data.others)))
    };
    let script = page_data.video.then_some(assets::SESSION_NAME);
    let title = text!(language, "sessions-page", scenario = record.scenario_with_level());
    page_with_script(visitor, "/sessions", &title, script, &body)
}

/// Renders the outcome, the things to do better with links to their moments in the report, and the next flight.
fn to_do_better(language: Language, record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    html! {
        p { b { (record.completion_summary(language)) ". " (record.verdict(language)) "." } }
        @if let Some(standing) = page_data.standing { p { (standing.words(language)) } }
        @if let Some(advice) = page_data.advice {
            @if let Some(note) = &advice.note { p { (note) } }
            ol.advice {
                @for point in &advice.points {
                    li { (point.words) " "
                        @if page_data.folder { (moment_link(record, point.t_s, &text!(language, "sessions-show-moment", time = formatting::clock(point.t_s)))) } }
                }
            }
            @if let Some(next) = &advice.next {
                p { (next_flight(language, &next.scenario)) " "
                    a href={ "/trainees/" (record.trainee) } { (text!(language, "sessions-plan")) } }
            }
        }
    }
}

/// Renders the recommended job, and how to fly it.
fn next_flight(language: Language, scenario: &str) -> Markup {
    let sentence = text!(language, "sessions-next-flight", job = ELEMENT);
    html! { (with_element(&sentence, &html! { b { (job_title(scenario, language)) } })) " " (text!(language, "job-how-to-fly")) }
}

/// Renders the instructor's marks with links to their moments in the report, and the form that adds one.
fn timeline_marks(visitor: &Visitor, record: &SessionRecord, marks: &[TimelineMark]) -> Markup {
    let (language, instructor) = (visitor.language, visitor.satisfies(AccessLevel::Instructor));
    html! {
        @if marks.is_empty() { p.calm { (text!(language, "sessions-no-marks")) } }
        ol.marks {
            @for mark in marks {
                li { (moment_link(record, mark.t_s, &formatting::clock(mark.t_s))) " " (mark.text) @if !mark.by.is_empty() { span.note { " (" (mark.by) ")" } }
                    @if instructor {
                        form.inline method="post" action={ "/sessions/" (record.id) "/marks/remove" } {
                            (token(visitor))
                            input type="hidden" name="mark" value=(mark.added_unix_us);
                            button type="submit" aria-label=(text!(language, "sessions-remove-mark-at", time = formatting::clock(mark.t_s))) { (text!(language, "sessions-remove-mark")) }
                        }
                    }
                }
            }
        }
        @if instructor {
            form.stacked method="post" action={ "/sessions/" (record.id) "/marks" } {
                (token(visitor))
                label { (text!(language, "sessions-mark-time")) input name="time" required pattern="[0-9]+(:[0-5][0-9])?" maxlength="10" autocomplete="off" placeholder="1:25"; }
                label { (text!(language, "sessions-mark-text")) input name="text" required maxlength=(MAX_TEXT_LEN) autocomplete="off"; }
                @if visitor.name.is_none() { label { (text!(language, "sessions-your-name")) input name="by" required maxlength=(MAX_NAME_LEN) autocomplete="name"; } }
                button type="submit" { (text!(language, "sessions-add-mark")) }
            }
        }
    }
}

/// Renders a link to a moment of the report, s since lift-off.
fn moment_link(record: &SessionRecord, t_s: f64, label: &str) -> Markup {
    html! { a href={ "/sessions/" (record.id) "/report#t=" (formatting::number(t_s, 2)) } { (label) } }
}

/// Renders the camera's video with buttons for the moments of the advice and the marks.
fn video(language: Language, record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    let advice = page_data.advice.into_iter().flat_map(|advice| &advice.points).map(|point| (point.t_s, point.words.as_str()));
    let marks = page_data.marks.iter().map(|mark| (mark.t_s, mark.text.as_str()));
    let mut moments: Vec<(f64, &str)> = advice.chain(marks).collect();
    moments.sort_by(|a, b| a.0.total_cmp(&b.0));
    html! {
        video.flight src={ "/sessions/" (record.id) "/video.mp4" } controls muted playsinline preload="metadata" {
            track kind="chapters" src={ "/sessions/" (record.id) "/video.vtt" } srclang="en" label=(text!(language, "sessions-pictures"));
        }
        @if !moments.is_empty() {
            ol.moments hidden id="video-moments" {
                @for (t_s, words) in moments {
                    li { button type="button" data-t=(formatting::number(t_s, 2)) { (formatting::clock(t_s)) } " " (words) }
                }
            }
        }
    }
}

/// Renders the photographs with links to their assessment in the report.
fn photographs(language: Language, record: &SessionRecord, pictures: &[u32]) -> Markup {
    html! {
        ul.photographs {
            @for (k, file) in pictures.iter().enumerate() {
                li { a href={ "/sessions/" (record.id) "/report#picture-" (k + 1) } {
                    img src={ "/sessions/" (record.id) "/pictures/" (file) ".jpg" } alt=(text!(language, "sessions-picture", number = k + 1)) loading="lazy";
                } }
            }
        }
    }
}

fn actions(language: Language, record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    let tasks: Vec<u32> = record.tasks.iter().map(|task| task.id).collect();
    let all = QuestionnaireItem::all(&tasks).len();
    let answered = record.answers.as_ref().map_or(0, |answers| all - answers.open(&tasks).len());
    html! {
        @if page_data.folder {
            ul.actions {
                li { a.button href={ "/sessions/" (record.id) "/report" } { (text!(language, "sessions-report")) } }
                li { a.button href={ "/sessions/" (record.id) "/questions" } {
                    @if answered == 0 { (text!(language, "sessions-questions-answer")) }
                    @else if answered < all { (text!(language, "sessions-questions-continue", answered = answered, all = all)) }
                    @else { (text!(language, "sessions-questions-view", all = all)) }
                } }
                li { a href={ "/sessions/" (record.id) "/frames.csv" } { (text!(language, "sessions-frames")) } }
                li { a href={ "/sessions/" (record.id) "/telemetry.tlog" } { (text!(language, "sessions-telemetry")) } }
            }
        } @else {
            p.note { (text!(language, "sessions-no-folder")) }
        }
    }
}

/// Returns the four scores by name, 0 to 100.
fn scores_by_name(language: Language, record: &SessionRecord) -> [(String, Option<f64>); 4] {
    let scores = &record.scores;
    [
        ("conformity", scores.conformity),
        ("efficiency", Some(scores.efficiency)),
        ("safety", Some(scores.safety)),
        ("accuracy", scores.accuracy),
    ]
    .map(|(key, value)| (capitalized(&score_title(key, language)), value))
}

fn scores(language: Language, record: &SessionRecord) -> Markup {
    let spokes: Vec<RadarAxis> =
        scores_by_name(language, record).into_iter().map(|(name, value)| RadarAxis { name, values: vec![value] }).collect();
    html! {
        p { b { (record.completion_summary(language)) ". " (record.verdict(language)) "." } @if !record.is_complete() { " " (text!(language, "sessions-partial")) } }
        div.split {
            figure { figcaption { (text!(language, "sessions-radar-caption")) } (radar(&spokes, &text!(language, "sessions-radar"), language)) }
            div.cards {
                @if record.is_complete() {
                    div.card { h3 { (text!(language, "sessions-overall")) } p.figure { (formatting::number(record.scores.overall, 0)) span.of { " " (text!(language, "sessions-of-most", most = formatting::number(record.scores.overall_max, 0))) } } }
                }
                @for (name, value) in scores_by_name(language, record) {
                    div.card { h3 { (name) } p.figure { @if let Some(value) = value { (formatting::number(value, 0)) } @else { (text!(language, "sessions-not-available")) } } }
                }
            }
        }
    }
}

/// Renders every requirement of the certification profile with its limit and the value reached.
fn requirements(language: Language, certification: &CertificationRecord) -> Markup {
    table(
        &text!(language, "sessions-requirements"),
        &[
            (text!(language, "sessions-requirement"), false),
            (text!(language, "sessions-reached"), true),
            (text!(language, "sessions-needed"), true),
            (text!(language, "sessions-met"), false),
        ],
        &html! {
            @for one in &certification.requirements {
                tr {
                    th scope="row" { (one.title(language)) div.note { (one.explanation(language)) } }
                    td.number { (one.reached_text(language)) }
                    td.number { (one.limit_text(language)) }
                    td { @if one.met { (text!(language, "sessions-yes")) } @else { b { (text!(language, "sessions-no")) } } }
                }
            }
        },
    )
}

fn tasks(language: Language, record: &SessionRecord) -> Markup {
    let row = |task: &TaskRecord| ShareRow {
        name: format!("{} · {}", task.id, task_title(&record.scenario, &task.name, language)),
        bars: vec![("b-on", task.on_path)],
        placeholder: (!task.attempted).then(|| text!(language, "sessions-not-attempted")),
    };
    let rows: Vec<ShareRow> = record.tasks.iter().map(row).collect();
    let by_task = text!(language, "sessions-on-path-by-task");
    html! {
        div.split {
            figure { figcaption { (by_task) } (shares(&rows, &by_task)) }
            (table(
                &text!(language, "sessions-task-results"),
                &[
                    (text!(language, "sessions-task"), false),
                    (text!(language, "sessions-path-flown"), false),
                    (text!(language, "sessions-on-path"), true),
                    (text!(language, "sessions-speeding"), true),
                    (text!(language, "sessions-crashes"), true),
                    (text!(language, "sessions-defects-found"), true),
                ],
                &html! {
                    @for task in &record.tasks {
                        tr {
                            th scope="row" { (task.id) " · " (task_title(&record.scenario, &task.name, language)) }
                            td { (task_completion_text(language, record, task)) }
                            td.number { (formatting::number(100.0 * task.on_path, 0)) }
                            td.number { (formatting::number(task.speeding_s, 1)) }
                            td.number { (task.crashes.total()) }
                            td.number { (text!(language, "sessions-found-of", found = task.defects_found, placed = task.defects_placed)) }
                        }
                    }
                },
            ))
        }
        @if record.crashes_outside.total() > 0 { p.note { (text!(language, "sessions-crashes-outside", count = record.crashes_outside.total())) } }
    }
}

/// Describes a task's completion.
fn task_completion_text(language: Language, record: &SessionRecord, task: &TaskRecord) -> String {
    let done_share = record.completion.map_or(0.0, |completion| completion.done_share);
    task.state
        .zip(task.covered)
        .map_or_else(|| text!(language, "sessions-unknown"), |(state, covered)| state.description(covered, done_share, language))
}

fn defects(language: Language, record: &SessionRecord) -> Markup {
    let found = record.defects.iter().filter(|d| d.found).count();
    let (placed, hits, pictures) = (record.defects.len(), record.hits, record.snapshots);
    table(
        &text!(language, "sessions-defects-caption", found = found, placed = placed, hits = hits, pictures = pictures),
        &[
            (text!(language, "sessions-defect"), false),
            (text!(language, "sessions-task"), true),
            (text!(language, "sessions-found"), false),
            (text!(language, "sessions-why-not"), false),
        ],
        &html! {
            @for defect in &record.defects {
                tr {
                    th scope="row" { (defect.id) " · " (defect.kind_title(language)) }
                    td.number { @if let Some(task) = defect.task { (task) } }
                    td { @if defect.found { (text!(language, "sessions-yes")) } @else { (text!(language, "sessions-no")) } }
                    td { @if !defect.found { @if defect.lacked.is_empty() { (text!(language, "sessions-no-picture")) } @else { (all_translated(&defect.lacked, language).join(", ")) } } }
                }
            }
        },
    )
}

fn compare(language: Language, record: &SessionRecord, others: &[SessionListEntry]) -> Markup {
    html! {
        @if others.is_empty() {
            p.calm { (text!(language, "sessions-no-others")) }
        } @else {
            form.inline method="get" action="/compare" {
                input type="hidden" name="first" value=(record.id);
                label { (text!(language, "sessions-other")) " "
                    select name="second" {
                        @for one in others { option value=(one.id) { (minute(one.started_unix_us)) ", " (one.scenario) ", " @if one.is_complete() { (formatting::number(one.overall, 0)) } @else { (text!(language, "sessions-incomplete")) } } }
                    }
                }
                button type="submit" { (text!(language, "sessions-compare")) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use crate::advice::{AdvicePoint, NextFlight};
    use crate::testing::{aborted_record, perfect_record};
    use crate::trainee::Role;
    use std::collections::BTreeMap;

    fn page_data(folder: bool, others: &[SessionListEntry]) -> SessionPageData<'_> {
        SessionPageData { folder, others, advice: None, standing: None, marks: &[], pictures: &[], video: false }
    }

    #[test]
    fn exact_advice_is_escaped_and_links_to_its_moment() {
        let point = AdvicePoint {
            words: HOSTILE_NAME.into(),
            translations: BTreeMap::new(),
            rule: HOSTILE_NAME.into(),
            frame: 301,
            t_s: 10.0,
            drill: HOSTILE_NAME.into(),
        };
        let next = Some(NextFlight { scenario: HOSTILE_NAME.into(), command: HOSTILE_NAME.into() });
        let advice = SessionAdvice { points: vec![point], note: Some(HOSTILE_NAME.into()), next, ..SessionAdvice::default() };
        let standing = SessionStanding {
            best: 350.0,
            is_best: false,
            change: Some(-30.0),
            within_error: None,
            left_out: 0,
            most: 400.0,
            forms: Vec::new(),
        };
        let standing = Some(&standing);
        let record = perfect_record("anna", 1);
        let data = SessionPageData { advice: Some(&advice), standing, ..page_data(true, &[]) };
        let text = session(&administrator(), &record, &data).into_string();
        check(&text);
        assert!(text.contains("/report#t=10.00\">Show 0:10</a>"), "{text}");
        assert!(text.contains("Personal best on this job: 350 of 400. Change since last time: 30 points down."), "{text}");
        let bare = session(&administrator(), &record, &SessionPageData { folder: false, ..data }).into_string();
        assert!(!bare.contains("#t="), "there is no report to link to");
    }

    fn point(t_s: f64, words: &str) -> AdvicePoint {
        let (rule, drill) = ("r".into(), "d".into());
        AdvicePoint { words: words.into(), translations: BTreeMap::new(), rule, frame: 1, t_s, drill }
    }

    #[test]
    fn exact_advice_is_shown_in_the_visitors_language() {
        let translated = |words: &str| BTreeMap::from([("de".to_owned(), words.to_owned())]);
        let points =
            vec![AdvicePoint { translations: translated("Sie flogen zu schnell."), ..point(70.0, "You flew too fast.") }];
        let (note, note_translations) = (Some("Well flown.".to_owned()), translated("Gut geflogen."));
        let advice = SessionAdvice { points, note, note_translations, next: None };
        let data = SessionPageData { advice: Some(&advice), video: true, ..page_data(true, &[]) };
        let shown = |language| session(&administrator_with(language), &perfect_record("anna", 1), &data).into_string();
        let (english, german, spanish) = (shown(Language::English), shown(Language::German), shown(Language::Spanish));
        assert!(english.contains("You flew too fast.") && english.contains("Well flown."), "{english}");
        assert_eq!(german.matches("Sie flogen zu schnell.").count(), 2, "in the list and beside the video: {german}");
        assert!(german.contains("Gut geflogen.") && !german.contains("You flew") && !german.contains("Well flown"), "{german}");
        assert!(spanish.contains("You flew too fast."), "there is no translation: {spanish}");
    }

    #[test]
    fn exact_video_has_the_moments_in_order_and_photographs_lead_to_the_report() {
        let advice = SessionAdvice { points: vec![point(70.0, "late"), point(10.0, HOSTILE_NAME)], ..SessionAdvice::default() };
        let marks = [TimelineMark { t_s: 30.0, text: "middle".into(), by: String::new(), added_unix_us: 7 }];
        let data =
            SessionPageData { advice: Some(&advice), marks: &marks, pictures: &[4, 9], video: true, ..page_data(true, &[]) };
        let record = perfect_record("anna", 1);
        let text = session(&administrator(), &record, &data).into_string();
        check(&text);
        let moments = ["data-t=\"10.00\"", "data-t=\"30.00\"", "data-t=\"70.00\""].map(|moment| text.find(moment).unwrap());
        assert!(moments.is_sorted(), "{text}");
        assert!(text.contains("/pictures/9.jpg\" alt=\"Picture 2\"") && text.contains("/report#picture-2"), "{text}");
        let without = session(&administrator(), &record, &page_data(true, &[])).into_string();
        assert!(!without.contains("<video") && !without.contains("session.js"));
    }

    #[test]
    fn exact_marks_are_escaped_and_only_instructors_change_them() {
        let (record, mark) = (perfect_record("anna", 1), |t_s| TimelineMark {
            t_s,
            text: HOSTILE_NAME.into(),
            by: HOSTILE_NAME.into(),
            added_unix_us: 7,
        });
        let marks = [mark(5.0), mark(85.25)];
        let data = SessionPageData { marks: &marks, ..page_data(true, &[]) };
        let text = session(&administrator(), &record, &data).into_string();
        check(&text);
        assert!(text.contains("/report#t=85.25\">1:25</a>") && text.contains("Add mark"), "{text}");
        assert_eq!((text.matches("/marks/remove").count(), text.matches("name=\"by\"").count()), (2, 0));
        let local = Visitor { name: None, open: true, ..administrator() };
        assert!(session(&local, &record, &data).into_string().contains("name=\"by\""));
        let trainee = Visitor { role: Role::Trainee, ..administrator() };
        let text = session(&trainee, &record, &data).into_string();
        check(&text);
        assert!(text.contains("#t=85.25") && !text.contains("/marks"), "{text}");
        let without = |data: &SessionPageData<'_>| session(&trainee, &record, data).into_string();
        assert!(
            !without(&page_data(true, &[])).contains("id=\"marks\"")
                && !without(&SessionPageData { folder: false, ..data }).contains("id=\"marks\"")
        );
    }

    #[test]
    fn exact_session_page_escapes_record_text() {
        let mut record = perfect_record("anna", 1);
        record.tasks[0].name = HOSTILE_NAME.into();
        record.defects[0].lacked = vec![HOSTILE_NAME.into()];
        record.defects[0].found = false;
        record.end_reason = HOSTILE_NAME.into();
        record.unmet = vec![HOSTILE_NAME.into()];
        record.certified = false;
        let other = SessionListEntry {
            id: "x".into(),
            trainee: HOSTILE_NAME.into(),
            started_unix_us: 0,
            scenario: HOSTILE_NAME.into(),
            overall: 1.0,
            overall_max: 400.0,
            end_reason: HOSTILE_NAME.into(),
            purpose: Some(HOSTILE_NAME.into()),
            completion: None,
            certified: false,
            unmet: vec![HOSTILE_NAME.into()],
        };
        let others = [other];
        check(&session(&administrator(), &record, &page_data(true, &others)).into_string());
        let listing = SessionList { lines: &others, trainee: Some(HOSTILE_NAME), page: 1, last: 9, count: 401 };
        check(&list(&administrator(), &listing).into_string());
    }

    #[test]
    fn regress_incomplete_session_shows_completion_without_overall_score() {
        let record = aborted_record("anna", 1);
        let text = session(&administrator(), &record, &page_data(true, &[])).into_string();
        assert!(text.contains("Incomplete: 0 of 4 tasks, 15% of the path"), "{text}");
        assert!(text.contains("Not certified: task 1 not done: 60% of its path, 80% needed (and 1 more)"), "{text}");
        assert!(text.contains("cover only the part that was flown") && !text.contains("<h3>Overall</h3>"), "{text}");
        assert!(
            session(&administrator(), &perfect_record("anna", 1), &page_data(true, &[]))
                .into_string()
                .contains("<h3>Overall</h3>")
        );
    }

    /// Texts of the monitor, which has catalogs of its own.
    const NAMES: [&str; 1] = ["anna"];

    #[test]
    fn exact_session_pages_are_translated() {
        let visitor = administrator_with(Language::Pseudo);
        let listing = SessionList { lines: &[], trainee: Some("anna"), page: 1, last: 9, count: 401 };
        check_translated(&list(&visitor, &listing).into_string(), &NAMES);
        for end in ["landed", "battery", "time_limit", "person", "vehicle", "crash", "abort", "restart"] {
            assert_ne!(end_reason_title(end, Language::Pseudo), end_reason_title(end, Language::English));
        }
        let ends =
            [Language::English, Language::German, Language::Spanish].map(|language| end_reason_title("time_limit", language));
        assert_eq!(ends, ["time limit reached", "Zeitlimit erreicht", "límite de tiempo alcanzado"]);
        let german = administrator_with(Language::German);
        let text = session(&german, &perfect_record("anna", 1), &page_data(true, &[])).into_string();
        assert!(text.contains("Bericht öffnen") && text.contains("Bahntreue") && text.contains("Anteil auf der Bahn"), "{text}");
        let standing = SessionStanding {
            best: 350.0,
            is_best: false,
            change: Some(30.0),
            within_error: None,
            left_out: 0,
            most: 400.0,
            forms: Vec::new(),
        };
        let told = |standing: &SessionStanding| standing.words(Language::German);
        assert_eq!(
            told(&standing),
            "Persönliche Bestleistung bei diesem Auftrag: 350 von 400. Änderung seit dem letzten Mal: 30 Punkte mehr."
        );
        let labeled = SessionStanding { is_best: true, within_error: Some(true), left_out: 2, ..standing.clone() };
        assert_eq!(
            labeled.words(Language::English),
            "This is the personal best on this job. Change since last time: 30 points up (within error). 2 incomplete sessions excluded."
        );
        let first = SessionStanding { change: None, within_error: None, left_out: 1, ..labeled };
        assert!(told(&first).ends_with(" 1 unvollständige Sitzung nicht gezählt."), "{}", told(&first));
    }

    #[test]
    fn exact_questionnaire_link_shows_progress() {
        let mut record = perfect_record("anna", 1);
        let text = |record: &SessionRecord| session(&administrator(), record, &page_data(true, &[])).into_string();
        assert!(text(&record).contains("all 24 answered"));
        if let Some(answers) = &mut record.answers {
            answers.given.pop_first();
        }
        assert!(text(&record).contains("23 of 24"));
        record.answers = None;
        assert!(text(&record).contains("Answer the questionnaire"));
        let bare = session(&administrator(), &record, &page_data(false, &[])).into_string();
        assert!(!bare.contains("/report") && bare.contains("not on this machine"));
    }
}
