//! Session lists and session pages.

use super::access::{AccessLevel, Visitor};
use super::assets;
use super::layout::{page, page_navigation, page_with_script, section, table, token};
use super::rubric::MAX_NAME_LEN;
use super::standing::SessionStanding;
use crate::advice::SessionAdvice;
use crate::marks::{MAX_TEXT_LEN, TimelineMark};
use crate::questionnaire::QuestionnaireItem;
use crate::record::{CertificationRecord, SessionListEntry, SessionOutcome, SessionRecord, TaskRecord};
use crate::report::formatting;
use crate::report::plots::bars::{ShareRow, shares};
use crate::report::plots::radar::{RadarAxis, radar};
use maud::{Markup, html};
use spandrel_model::calendar::minute;
use spandrel_text::Language;

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
    let address = match listing.trainee {
        Some(trainee) => format!("/sessions?trainee={trainee}&"),
        None => "/sessions?".to_owned(),
    };
    let body = html! {
        section {
            div.tools {
                @if visitor.satisfies(AccessLevel::Instructor) {
                    form.inline method="get" action="/sessions" {
                        label { "Trainee " input name="trainee" value=[listing.trainee] maxlength="32" autocapitalize="none"; }
                        button type="submit" { "Show" }
                        @if listing.trainee.is_some() { a href="/sessions" { "Show all" } }
                    }
                    a href="/upload" { "Import flight" }
                } @else if let Some(name) = &visitor.name {
                    a href={ "/trainees/" (name) } { "My progress and plan" }
                }
            }
            @if listing.lines.is_empty() {
                p.calm { "No sessions yet. Flights appear here after they end." }
            } @else {
                (lines(visitor, &format!("{} sessions, newest first", listing.count), listing.lines))
                (page_navigation(&address, listing.page, listing.last))
            }
        }
    };
    page(visitor, "/sessions", "Sessions", &body)
}

/// Renders a table of sessions.
#[must_use]
pub fn lines(visitor: &Visitor, caption: &str, lines: &[SessionListEntry]) -> Markup {
    let all = visitor.satisfies(AccessLevel::Instructor);
    // The columns that fit on a phone without scrolling come first: date, trainee, score.
    let mut heads = vec![
        ("Started", false),
        ("Trainee", false),
        ("Overall", true),
        ("Certified", false),
        ("Scenario", false),
        ("Purpose", false),
        ("End", false),
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
                    th scope="row" { a href={ "/sessions/" (one.id) } { (minute(one.started_unix_us)) } }
                    @if all { td { a href={ "/trainees/" (one.trainee) } { (one.trainee) } } }
                    @if one.is_complete() { td.number { (formatting::number(one.overall, 1)) " of " (formatting::number(one.overall_max, 0)) } }
                    @else { td { (one.completion_summary()) } }
                    td { (one.verdict()) }
                    td { (one.scenario) }
                    td { (one.purpose.as_deref().unwrap_or("–")) }
                    td { (one.end_reason.replace('_', " ")) }
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
    /// Things to do better, from the session folder.
    pub advice: Option<&'a SessionAdvice>,
    /// Comparison with the trainee's other sessions on this job.
    pub standing: Option<SessionStanding>,
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
    let body = html! {
        p.lead {
            a href={ "/trainees/" (record.trainee) } { (record.trainee) } " · " (minute(record.started_unix_us)) " · " (record.vehicle)
            @if let Some(purpose) = &record.purpose { " · " (purpose) } " · "
            "flight time " (formatting::duration(record.seconds)) ", ended: " (record.end_reason.replace('_', " "))
        }
        (section("better", "Do better", &to_do_better(record, page_data)))
        (actions(record, page_data))
        @if page_data.folder && (!page_data.marks.is_empty() || visitor.satisfies(AccessLevel::Instructor)) {
            (section("marks", "Marks", &timeline_marks(visitor, record, page_data.marks)))
        }
        @if page_data.video { (section("video", "Video", &video(record, page_data))) }
        @if !page_data.pictures.is_empty() { (section("pictures", "Photographs", &photographs(record, page_data.pictures))) }
        (section("scores", "Scores", &scores(record)))
        @if let Some(certification) = &record.certification { (section("certification", "Certification", &requirements(certification))) }
        @if !record.tasks.is_empty() { (section("tasks", "Tasks", &tasks(record))) }
        @if !record.defects.is_empty() { (section("defects", "Defects", &defects(record))) }
        (section("compare", "Compare with", &compare(record, page_data.others)))
    };
    let script = page_data.video.then_some(assets::SESSION_NAME);
    page_with_script(visitor, "/sessions", &format!("Session: {}", record.scenario_with_level()), script, &body)
}

/// Renders the outcome, the things to do better with links to their moments in the report, and the next flight.
fn to_do_better(record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    html! {
        p { b { (record.completion_summary()) ". " (record.verdict()) "." } }
        @if let Some(standing) = &page_data.standing { p { (standing_text(standing, record.scores.overall_max)) } }
        @if let Some(advice) = page_data.advice {
            @if let Some(note) = &advice.note { p { (note) } }
            ol.advice {
                @for point in &advice.points {
                    li { (point.words) " "
                        @if page_data.folder { (moment_link(record, point.t_s, &format!("Show {}", formatting::clock(point.t_s)))) } }
                }
            }
            @if let Some(next) = &advice.next {
                p { "Next flight: " b { (next.scenario) } ", " code { (next.command) } ". "
                    a href={ "/trainees/" (record.trainee) } { "Training plan" } }
            }
        }
    }
}

/// Renders the instructor's marks with links to their moments in the report, and the form that adds one.
fn timeline_marks(visitor: &Visitor, record: &SessionRecord, marks: &[TimelineMark]) -> Markup {
    let instructor = visitor.satisfies(AccessLevel::Instructor);
    html! {
        @if marks.is_empty() { p.calm { "No marks yet. Marks appear on the timeline of the report; they do not change scores." } }
        ol.marks {
            @for mark in marks {
                li { (moment_link(record, mark.t_s, &formatting::clock(mark.t_s))) " " (mark.text) @if !mark.by.is_empty() { span.note { " (" (mark.by) ")" } }
                    @if instructor {
                        form.inline method="post" action={ "/sessions/" (record.id) "/marks/remove" } {
                            (token(visitor))
                            input type="hidden" name="mark" value=(mark.added_unix_us);
                            button type="submit" aria-label={ "Remove the mark at " (formatting::clock(mark.t_s)) } { "Remove" }
                        }
                    }
                }
            }
        }
        @if instructor {
            form.stacked method="post" action={ "/sessions/" (record.id) "/marks" } {
                (token(visitor))
                label { "Time on the report's slider (minutes:seconds)" input name="time" required pattern="[0-9]+(:[0-5][0-9])?" maxlength="10" autocomplete="off" placeholder="1:25"; }
                label { "Text" input name="text" required maxlength=(MAX_TEXT_LEN) autocomplete="off"; }
                @if visitor.name.is_none() { label { "Your name" input name="by" required maxlength=(MAX_NAME_LEN) autocomplete="name"; } }
                button type="submit" { "Add mark" }
            }
        }
    }
}

/// Renders a link to a moment of the report, s since lift-off.
fn moment_link(record: &SessionRecord, t_s: f64, label: &str) -> Markup {
    html! { a href={ "/sessions/" (record.id) "/report#t=" (formatting::number(t_s, 2)) } { (label) } }
}

/// Renders the camera's video with buttons for the moments of the advice and the marks.
fn video(record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    let advice = page_data.advice.into_iter().flat_map(|advice| &advice.points).map(|point| (point.t_s, point.words.as_str()));
    let marks = page_data.marks.iter().map(|mark| (mark.t_s, mark.text.as_str()));
    let mut moments: Vec<(f64, &str)> = advice.chain(marks).collect();
    moments.sort_by(|a, b| a.0.total_cmp(&b.0));
    html! {
        video.flight src={ "/sessions/" (record.id) "/video.mp4" } controls muted playsinline preload="metadata" {
            track kind="chapters" src={ "/sessions/" (record.id) "/video.vtt" } srclang="en" label="Photographs";
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
fn photographs(record: &SessionRecord, pictures: &[u32]) -> Markup {
    html! {
        ul.photographs {
            @for (k, file) in pictures.iter().enumerate() {
                li { a href={ "/sessions/" (record.id) "/report#picture-" (k + 1) } {
                    img src={ "/sessions/" (record.id) "/pictures/" (file) ".jpg" } alt={ "Picture " (k + 1) } loading="lazy";
                } }
            }
        }
    }
}

/// Describes how a session compares with the trainee's other sessions on the job.
fn standing_text(standing: &SessionStanding, most: f64) -> String {
    let best = if standing.is_best {
        "This is the personal best on this job.".to_owned()
    } else {
        format!("Personal best on this job: {} of {}.", formatting::number(standing.best, 0), formatting::number(most, 0))
    };
    let points = |change: f64| formatting::number(change.abs(), 0);
    match standing.change {
        Some(change) if points(change) == "0" => format!("{best} Change since last time: none."),
        Some(change) => {
            format!("{best} Change since last time: {} points {}.", points(change), if change > 0.0 { "up" } else { "down" })
        }
        None => best,
    }
}

fn actions(record: &SessionRecord, page_data: &SessionPageData<'_>) -> Markup {
    let tasks: Vec<u32> = record.tasks.iter().map(|task| task.id).collect();
    let all = QuestionnaireItem::all(&tasks).len();
    let answered = record.answers.as_ref().map_or(0, |answers| all - answers.open(&tasks).len());
    html! {
        @if page_data.folder {
            ul.actions {
                li { a.button href={ "/sessions/" (record.id) "/report" } { "Open the report" } }
                li { a.button href={ "/sessions/" (record.id) "/questions" } {
                    @if answered == 0 { "Answer the questionnaire" }
                    @else if answered < all { "Continue the questionnaire (" (answered) " of " (all) ")" }
                    @else { "View the questionnaire (all " (all) " answered)" }
                } }
                li { a href={ "/sessions/" (record.id) "/frames.csv" } { "Frames (CSV)" } }
                li { a href={ "/sessions/" (record.id) "/telemetry.tlog" } { "Telemetry (tlog)" } }
            }
        } @else {
            p.note { "The session folder is not on this machine, so the report, questionnaire and downloads are unavailable." }
        }
    }
}

/// Returns the four scores by name, 0 to 100.
#[must_use]
pub fn scores_by_name(record: &SessionRecord) -> [(&'static str, Option<f64>); 4] {
    let scores = &record.scores;
    [
        ("Conformity", scores.conformity),
        ("Efficiency", Some(scores.efficiency)),
        ("Safety", Some(scores.safety)),
        ("Accuracy", scores.accuracy),
    ]
}

fn scores(record: &SessionRecord) -> Markup {
    let spokes: Vec<RadarAxis> = scores_by_name(record)
        .into_iter()
        .map(|(name, value)| RadarAxis { name: name.to_owned(), values: vec![value] })
        .collect();
    html! {
        p { b { (record.completion_summary()) ". " (record.verdict()) "." } @if !record.is_complete() { " The scores below cover only the part that was flown." } }
        div.split {
            figure { figcaption { "The four scores, 0 at the center, 100 at the edge" } (radar(&spokes, "Radar chart of the four scores", Language::English)) }
            div.cards {
                @if record.is_complete() {
                    div.card { h3 { "Overall" } p.figure { (formatting::number(record.scores.overall, 0)) span.of { " of " (formatting::number(record.scores.overall_max, 0)) } } }
                }
                @for (name, value) in scores_by_name(record) {
                    div.card { h3 { (name) } p.figure { @if let Some(value) = value { (formatting::number(value, 0)) } @else { "n/a" } } }
                }
            }
        }
    }
}

/// Renders every requirement of the certification profile with its limit and the value reached.
fn requirements(certification: &CertificationRecord) -> Markup {
    table(
        "Requirements",
        &[("Requirement", false), ("Reached", true), ("Needed", true), ("Met", false)],
        &html! {
            @for one in &certification.requirements {
                tr {
                    th scope="row" { (one.name) }
                    td.number { (one.reached_text()) }
                    td.number { (one.limit_text()) }
                    td { @if one.met { "yes" } @else { b { "no" } } }
                }
            }
        },
    )
}

fn tasks(record: &SessionRecord) -> Markup {
    let row = |task: &TaskRecord| ShareRow {
        name: format!("{} · {}", task.id, task.name),
        bars: vec![("b-on", task.on_path)],
        placeholder: (!task.attempted).then(|| "not attempted".to_owned()),
    };
    let rows: Vec<ShareRow> = record.tasks.iter().map(row).collect();
    html! {
        div.split {
            figure { figcaption { "On-path share by task" } (shares(&rows, "On-path share by task")) }
            (table(
                "Task results",
                &[("Task", false), ("Path flown", false), ("On-path share (%)", true), ("Speeding time (s)", true), ("Crashes", true), ("Defects found", true)],
                &html! {
                    @for task in &record.tasks {
                        tr {
                            th scope="row" { (task.id) " · " (task.name) }
                            td { (task_completion_text(record, task)) }
                            td.number { (formatting::number(100.0 * task.on_path, 0)) }
                            td.number { (formatting::number(task.speeding_s, 1)) }
                            td.number { (task.crashes.total()) }
                            td.number { (task.defects_found) " of " (task.defects_placed) }
                        }
                    }
                },
            ))
        }
        @if record.crashes_outside.total() > 0 { p.note { (record.crashes_outside.total()) " crashes outside the tasks." } }
    }
}

/// Describes a task's completion.
fn task_completion_text(record: &SessionRecord, task: &TaskRecord) -> String {
    let done_share = record.completion.map_or(0.0, |completion| completion.done_share);
    task.state.zip(task.covered).map_or_else(|| "unknown".to_owned(), |(state, covered)| state.description(covered, done_share))
}

fn defects(record: &SessionRecord) -> Markup {
    table(
        &format!(
            "{} of {} found; {} of {} pictures showed a new defect",
            record.defects.iter().filter(|d| d.found).count(),
            record.defects.len(),
            record.hits,
            record.snapshots
        ),
        &[("Defect", false), ("Task", true), ("Found", false), ("Why the best picture did not count", false)],
        &html! {
            @for defect in &record.defects {
                tr {
                    th scope="row" { (defect.id) " · " (defect.kind_name) }
                    td.number { @if let Some(task) = defect.task { (task) } }
                    td { @if defect.found { "yes" } @else { "no" } }
                    td { @if !defect.found { @if defect.lacked.is_empty() { "no picture taken nearby" } @else { (defect.lacked.join(", ")) } } }
                }
            }
        },
    )
}

fn compare(record: &SessionRecord, others: &[SessionListEntry]) -> Markup {
    html! {
        @if others.is_empty() {
            p.calm { "This trainee has no other sessions yet." }
        } @else {
            form.inline method="get" action="/compare" {
                input type="hidden" name="first" value=(record.id);
                label { "Other session "
                    select name="second" {
                        @for one in others { option value=(one.id) { (minute(one.started_unix_us)) ", " (one.scenario) ", " @if one.is_complete() { (formatting::number(one.overall, 0)) } @else { "incomplete" } } }
                    }
                }
                button type="submit" { "Compare" }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::advice::{AdvicePoint, NextFlight};
    use crate::testing::{aborted_record, perfect_record};
    use crate::trainee::Role;

    fn page_data(folder: bool, others: &[SessionListEntry]) -> SessionPageData<'_> {
        SessionPageData { folder, others, advice: None, standing: None, marks: &[], pictures: &[], video: false }
    }

    #[test]
    fn exact_advice_is_escaped_and_links_to_its_moment() {
        let point = AdvicePoint {
            words: HOSTILE_NAME.into(),
            rule: HOSTILE_NAME.into(),
            frame: 301,
            t_s: 10.0,
            drill: HOSTILE_NAME.into(),
        };
        let next = Some(NextFlight { scenario: HOSTILE_NAME.into(), command: HOSTILE_NAME.into() });
        let advice = SessionAdvice { points: vec![point], note: Some(HOSTILE_NAME.into()), next };
        let standing = Some(SessionStanding { best: 350.0, is_best: false, change: Some(-30.0) });
        let record = perfect_record("anna", 1);
        let data = SessionPageData { advice: Some(&advice), standing, ..page_data(true, &[]) };
        let text = session(&administrator(), &record, &data).into_string();
        check(&text);
        assert!(text.contains("/report#t=10.00\">Show 0:10</a>"), "{text}");
        assert!(text.contains("Personal best on this job: 350 of 400. Change since last time: 30 points down."), "{text}");
        let bare = session(&administrator(), &record, &SessionPageData { folder: false, ..data }).into_string();
        assert!(!bare.contains("#t="), "there is no report to link to");
    }

    #[test]
    fn exact_video_has_the_moments_in_order_and_photographs_lead_to_the_report() {
        let point = |t_s, words: &str| AdvicePoint { words: words.into(), rule: "r".into(), frame: 1, t_s, drill: "d".into() };
        let advice = SessionAdvice { points: vec![point(70.0, "late"), point(10.0, HOSTILE_NAME)], note: None, next: None };
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
