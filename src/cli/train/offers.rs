//! Contents of the window's start page and end page.

use super::aircraft::SelectedAircraft;
use crate::io::files::{self, ScenarioFile};
use crate::io::report;
use crate::io::session_folder::{purpose, trainee_and_start};
use crate::io::standing::standing_when_flown;
use crate::records::{reliability_beside, session_folders};
use crate::web::scenario_library::{UPLOAD_FOLDER, uploaded};
use serde::Deserialize;
use serde_json::Value;
use spandrel_model::scenario::{BriefingPicture, Scenario, form_names};
use spandrel_model::shipped;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::folder::{ASSESSMENT, EVENTS, REPORT, SESSION, TELEMETRY};
use spandrel_monitor::measures::practice_aids::PracticeAids;
use spandrel_monitor::score::certification::requirements;
use spandrel_monitor::score::completion::{Completion, verdict};
use spandrel_monitor::stored_text::translated;
use spandrel_text::terms::{capitalized, end_reason_title};
use spandrel_text::{Language, text};
use spandrel_training::advice::SessionAdvice;
use spandrel_training::briefing::{Briefing, TaskBriefing, flight_conditions, text as briefing_text};
use spandrel_training::plan::LESSON;
use spandrel_training::terms::scenario_title;
use spandrel_training::time_text::clock;
use spandrel_view::flow::pipe::{
    BriefingImage, FinalScore, FlightChoice, FlightMoment, FlightOptions, FlightSummary, GhostFlight, JobBriefing, JobOffer,
    LessonProgress, NextJob, Purpose, SCORE_NAMES, TraineeSummary,
};
use spandrel_view::path_guide::PathAids;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Trainee ID of the sessions that the synthetic expert flies.
pub const EXPERT_ID: &str = "synthetic-expert";

/// Returns the choices that the start page offers, with briefings for an aircraft, but without the aircraft to choose from.
pub fn flight_options(
    (sessions, folders, aircraft): (&Path, &SessionsByTrainee, &SelectedAircraft),
    choice: &FlightChoice,
    web: Option<&str>,
    language: Language,
) -> FlightOptions {
    let mut names: Vec<String> = files::scenario_names().into_iter().flat_map(scenarios_by_form).collect();
    names.extend(uploaded(&sessions.join(UPLOAD_FOLDER)).iter().map(|path| path.display().to_string()));
    if !names.contains(&choice.scenario) {
        names.push(choice.scenario.clone());
    }
    FlightOptions {
        trainees: trainee_summaries(folders, language),
        lesson: job_named(LESSON, language),
        scenarios: names.into_iter().filter_map(|name| job_offer(name, aircraft, language)).collect(),
        choice: choice.clone(),
        web: web.map(str::to_owned),
        vehicles: Vec::new(),
    }
}

/// Adds the trainees' next jobs that are not offered yet, such as another level of a drill: without its offer, a job has neither a
/// title nor a briefing.
pub fn add_next_jobs(options: &mut FlightOptions, aircraft: &SelectedAircraft, language: Language) {
    for next in options.trainees.iter().filter_map(|trainee| trainee.next.as_ref()) {
        if options.scenarios.iter().all(|job| job.name != next.scenario) {
            options.scenarios.extend(job_offer(next.scenario.clone(), aircraft, language));
        }
    }
}

/// Returns the job with this name or path in a language, with its briefing for an aircraft; `None` if it cannot be read.
pub fn job_offer(name: String, aircraft: &SelectedAircraft, language: Language) -> Option<JobOffer> {
    let file = files::scenario(&name).ok()?;
    let (briefing, conditions) = job_briefing(&file, &aircraft.vehicle, language);
    Some(JobOffer {
        name,
        title: job_title(&file.scenario, language),
        kind: contents_summary(&file.scenario, language),
        conditions,
        is_lesson: !file.scenario.lesson.is_empty(),
        briefing,
        vehicle: aircraft.name.clone(),
    })
}

/// Returns what the window's briefing page shows, and aircraft, wind and light in short.
fn job_briefing(file: &ScenarioFile, vehicle: &Vehicle, language: Language) -> (JobBriefing, String) {
    let scenario = &file.scenario;
    let site = Site::without_defects(scenario);
    let briefing = Briefing::new(scenario, vehicle, &site, language);
    let task = |task: &TaskBriefing| {
        format!("{}  {}: {}, {}", task.id, task.name, task.place, briefing_text::task_numbers(task, language))
    };
    let condition = |(name, value): &(String, String)| format!("{}: {value}", capitalized(name));
    let short = flight_conditions(scenario, vehicle, &site, language).each_ref().map(condition).join(" · ");
    let briefing = JobBriefing {
        tasks: briefing.tasks.iter().map(task).collect(),
        conditions: vec![briefing.conditions.iter().map(condition).collect::<Vec<_>>().join(" · ")],
        notes: briefing.notes,
        hazards: briefing.hazards,
        counts: brief_counts(scenario, briefing.counts, language),
        site_check: briefing.site_check,
        pictures: briefing_images(file),
    };
    (briefing, short)
}

/// Returns what counts, with all requirements of the certification in one paragraph.
fn brief_counts(scenario: &Scenario, mut counts: Vec<String>, language: Language) -> Vec<String> {
    let requirements = requirements::describe(scenario, language);
    counts.truncate(counts.len().saturating_sub(requirements.len()));
    let all = requirements.join("; ");
    counts.extend((!all.is_empty()).then(|| text!(language, "briefing-to-be-certified", requirement = all)));
    counts
}

/// Returns the pictures of the briefing that can be used. The others are logged in one line.
fn briefing_images(file: &ScenarioFile) -> Vec<BriefingImage> {
    let listed = &file.scenario.briefing_pictures;
    let (mut found, mut missing) = (Vec::new(), Vec::new());
    for picture in listed {
        match briefing_image(file, picture) {
            Ok(image) => found.push(image),
            Err(error) => missing.push((picture.file.as_str(), error)),
        }
    }
    if let Some(words) = missing_pictures(&file.scenario.name, listed.len(), &missing) {
        tracing::warn!("{words}");
    }
    found
}

/// Returns the line for the log about the pictures of a briefing that cannot be used; `None` if there are none.
fn missing_pictures(scenario: &str, count: usize, missing: &[(&str, String)]) -> Option<String> {
    let (_, first) = missing.first()?;
    let names: Vec<&str> = missing.iter().map(|(name, _)| *name).collect();
    let reasons = if missing.iter().all(|(_, error)| error == first) {
        format!("{}: {first}", names.join(", "))
    } else {
        missing.iter().map(|(name, error)| format!("{name}: {error}")).collect::<Vec<_>>().join("; ")
    };
    Some(format!("the briefing of {scenario} is shown without {} of its {count} pictures ({reasons})", missing.len()))
}

/// Returns a picture of the briefing. The window loads it when it shows the page.
fn briefing_image(file: &ScenarioFile, picture: &BriefingPicture) -> Result<BriefingImage, String> {
    let (path, info) = file.find_picture(&picture.file)?;
    let path = path.to_str().ok_or("the path is not UTF-8 text")?.to_owned();
    Ok(BriefingImage { path, caption: picture.caption.clone(), size_px: info.size_px() })
}

/// Returns the title with the words that distinguish a form, or a level other than the standard one.
fn job_title(scenario: &Scenario, language: Language) -> String {
    let title = scenario_title(&scenario.name, &scenario.title, language);
    let title = title.as_str();
    if let Some(form) = &scenario.form {
        return text!(language, "window-train-form", title = title, form = form.name.as_str());
    }
    match scenario.difficulty.as_ref().filter(|one| one.level != one.standard) {
        Some(difficulty) => {
            let levels = difficulty.levels().to_string();
            text!(language, "window-train-level", title = title, level = difficulty.level.to_string(), levels = levels)
        }
        None => title.to_owned(),
    }
}

/// Returns a shipped scenario's forms as arguments; the scenario itself if it has no forms.
fn scenarios_by_form(name: &str) -> Vec<String> {
    let text = shipped::SCENARIOS.iter().find(|(shipped, _)| *shipped == name).map_or("", |(_, text)| text);
    let forms = form_names(text);
    if forms.is_empty() {
        vec![name.to_owned()]
    } else {
        forms.iter().map(|form| files::with_variant(name, Some(form), None)).collect()
    }
}

/// Returns how much of the path a trainee sees in practice, from the conformity of the earlier sessions.
pub fn path_aids(sessions: &Path, trainee: &str) -> PathAids {
    let mut own = stored_sessions(sessions);
    own.retain(|session| session.trainee == trainee);
    own.sort_by_key(|session| std::cmp::Reverse(session.started_unix_us));
    // The latest sessions are enough; reading all of them would delay the flight.
    let latest: Vec<f64> = own.iter().filter_map(|session| conformity_pct(&session.folder)).take(PathAids::SESSIONS).collect();
    PathAids::for_conformity(&latest)
}

/// A readable session folder.
struct StoredSessionFolder {
    trainee: String,
    started_unix_us: u64,
    folder: PathBuf,
}

/// Returns the sessions in a folder; none if the folder does not exist yet.
fn stored_sessions(sessions: &Path) -> Vec<StoredSessionFolder> {
    let folders = session_folders(&[sessions.to_path_buf()]).unwrap_or_default();
    let stored = |folder: PathBuf| {
        let (trainee, started_unix_us) = trainee_and_start(&folder).ok()?;
        Some(StoredSessionFolder { trainee, started_unix_us, folder })
    };
    folders.into_iter().filter_map(stored).collect()
}

/// Returns the contents of a JSON file in a session folder; `None` if it is missing or invalid.
fn read_json(session: &Path, name: &str) -> Option<Value> {
    serde_json::from_str(&std::fs::read_to_string(session.join(name)).ok()?).ok()
}

/// The earlier flights of a job that a ghost can repeat.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedGhost {
    /// The best flight; `None` if there is none.
    pub flight: Option<GhostFlight>,
    /// Whether the trainee's flights are of an earlier version of the job, whose paths may be others.
    pub is_outdated: bool,
}

/// Returns the flight that a ghost repeats: the trainee's complete session of this job with the highest score or, without one, the
/// synthetic expert's best one. A form or another seed only moves the defects, so the paths are the same. Flights of a job whose
/// file has changed since don't count.
pub fn recorded_ghost(sessions: &Path, trainee: &str, job: &ScenarioFile, language: Language) -> RecordedGhost {
    let stored = stored_sessions(sessions);
    let own = complete_flights(&stored, trainee, job);
    let flight = |flown: CompleteFlight<'_>, words: String| GhostFlight { telemetry: flown.folder.join(TELEMETRY), words };
    if let Some(flown) = best(&own) {
        let (overall, most) = (format!("{:.0}", flown.overall), format!("{:.0}", flown.overall_max));
        let words = text!(language, "window-flight-ghost-best", overall = overall, most = most);
        return RecordedGhost { flight: Some(flight(flown, words)), is_outdated: false };
    }
    let is_outdated = !own.is_empty();
    let experts = best(&complete_flights(&stored, EXPERT_ID, job));
    RecordedGhost { flight: experts.map(|flown| flight(flown, expert_ghost_words(is_outdated, language))), is_outdated }
}

/// Returns the words for the expert's flight as a ghost, and why it is not one of the trainee's if these are outdated.
pub fn expert_ghost_words(is_outdated: bool, language: Language) -> String {
    if is_outdated {
        text!(language, "window-flight-ghost-of-expert-changed")
    } else {
        text!(language, "window-flight-ghost-of-expert")
    }
}

/// A complete session.
#[derive(Debug, Clone, Copy)]
struct CompleteFlight<'a> {
    folder: &'a Path,
    /// Score and highest possible score.
    overall: f64,
    overall_max: f64,
    /// Whether the job's file is still the same, except for its form.
    is_current: bool,
}

/// Returns the present job's flight with the highest score.
fn best<'a>(flights: &[CompleteFlight<'a>]) -> Option<CompleteFlight<'a>> {
    flights.iter().filter(|flown| flown.is_current).max_by(|a, b| a.overall.total_cmp(&b.overall)).copied()
}

/// Returns a person's complete sessions of a job.
fn complete_flights<'a>(stored: &'a [StoredSessionFolder], who: &str, job: &ScenarioFile) -> Vec<CompleteFlight<'a>> {
    let level = job.scenario.difficulty.as_ref().map(|difficulty| difficulty.level);
    let of = stored.iter().filter(|session| session.trainee == who).map(|session| session.folder.as_path());
    let complete = of.filter_map(|folder| {
        let (overall, overall_max) = complete_score(folder, &job.scenario.name, level)?;
        Some(CompleteFlight { folder, overall, overall_max, is_current: is_current(folder, job) })
    });
    complete.collect()
}

/// Returns whether a session flew the present version of a job, in any of its forms.
fn is_current(session: &Path, job: &ScenarioFile) -> bool {
    let crc = read_json(session, SESSION).and_then(|info| u32::from_str_radix(info["scenario_crc"].as_str()?, 16).ok());
    crc.is_some_and(|crc| crc == job.scenario.crc || job.variant_with_crc(crc).is_some())
}

/// Returns the score of a session and the highest possible one, if it is a complete session of this job.
fn complete_score(session: &Path, scenario: &str, level: Option<u8>) -> Option<(f64, f64)> {
    let info = read_json(session, SESSION)?;
    if info["scenario"] != scenario || info["level"].as_u64() != level.map(u64::from) {
        return None;
    }
    let assessment = read_json(session, ASSESSMENT)?;
    let scores = &assessment["scores"];
    // A rewound flight jumps, and is not compared with others.
    let is_unaided = PracticeAids::deserialize(&assessment["practice_aids"]).unwrap_or_default().count() == 0;
    let is_complete = assessment["completion"]["complete"].as_bool() == Some(true) && is_unaided;
    scores["overall"].as_f64().zip(scores["overall_max"].as_f64()).filter(|_| is_complete)
}

/// Returns the conformity of a complete session, %. Lessons and incomplete sessions say little about how well somebody follows a
/// path.
fn conformity_pct(session: &Path) -> Option<f64> {
    let assessment = read_json(session, ASSESSMENT)?;
    let counts = assessment["completion"]["complete"].as_bool() == Some(true) && LessonSession::read(session).is_none();
    assessment["scores"]["conformity"]["pct"].as_f64().filter(|_| counts)
}

/// Returns what the start page shows of a trainee with these sessions, in the order of their starts.
fn trainee_summary(name: &str, folders: &[PathBuf], language: Language) -> TraineeSummary {
    let latest = folders.last();
    let is_practice = |folder: &&PathBuf| purpose(folder).as_deref() == Some(Purpose::Practice.word());
    let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let advice = latest.and_then(|folder| report::saved_advice(folder)).map(|advice| advice.in_language(language));
    let lesson = latest.and_then(|folder| LessonSession::unfinished(folder));
    TraineeSummary {
        name: name.to_owned(),
        sessions: count(folders.len()),
        practices: count(folders.iter().filter(is_practice).count()),
        last: match &lesson {
            Some(LessonSession { progress, .. }) => {
                Some(text!(language, "window-train-lesson-progress", done = progress.done, steps = progress.steps))
            }
            None => advice.as_ref().and_then(|advice| advice.sentences().next()).map(str::to_owned),
        },
        next: match lesson {
            Some(lesson) => job_named(&lesson.scenario, language),
            None => advice.as_ref().and_then(|advice| next_job(advice, language)),
        },
    }
}

/// A session of an installed lesson.
struct LessonSession {
    scenario: String,
    progress: LessonProgress,
}

impl LessonSession {
    /// Reads a session. `None` if it is not one of an installed lesson.
    fn read(session: &Path) -> Option<Self> {
        let scenario = read_json(session, SESSION)?["scenario"].as_str()?.to_owned();
        let steps = files::scenario(&scenario).ok()?.scenario.lesson.len();
        if steps == 0 {
            return None;
        }
        let events = std::fs::read_to_string(session.join(EVENTS)).unwrap_or_default();
        let steps_done = events.lines().filter_map(|line| {
            let event: Value = serde_json::from_str(line).ok()?;
            event["done"].as_u64().filter(|_| event["event"] == "lesson_step")
        });
        let done = steps_done.max().and_then(|done| usize::try_from(done).ok()).unwrap_or(0);
        Some(Self { scenario, progress: LessonProgress { done, steps } })
    }

    /// Reads a session of a lesson of which not all steps were done.
    fn unfinished(session: &Path) -> Option<Self> {
        Self::read(session).filter(|lesson| !lesson.progress.is_complete())
    }
}

/// Returns a job with its title in a language, if it is installed. The title distinguishes forms and levels.
pub fn job_named(scenario: &str, language: Language) -> Option<NextJob> {
    let title = job_title(&files::scenario(scenario).ok()?.scenario, language);
    Some(NextJob { scenario: scenario.to_owned(), title, due: None, from_last_session: false })
}

/// Returns the job that the advice recommends, if it is installed.
fn next_job(advice: &SessionAdvice, language: Language) -> Option<NextJob> {
    job_named(&advice.next.as_ref()?.scenario, language)
}

/// Each trainee's session folders in the order of their starts.
pub type SessionsByTrainee = BTreeMap<String, Vec<PathBuf>>;

/// Returns the sessions in a folder.
pub fn sessions_by_trainee(sessions: &Path) -> SessionsByTrainee {
    let mut stored = stored_sessions(sessions);
    stored.sort_by_key(|session| session.started_unix_us);
    let mut found = SessionsByTrainee::new();
    for StoredSessionFolder { trainee, folder, .. } in stored {
        found.entry(trainee).or_default().push(folder);
    }
    found
}

/// Returns whether a session is one of a lesson of which not all steps were done.
pub fn has_unfinished_lesson(session: &Path) -> bool {
    LessonSession::unfinished(session).is_some()
}

/// Returns each trainee with the number of sessions and practice sessions.
fn trainee_summaries(folders: &SessionsByTrainee, language: Language) -> Vec<TraineeSummary> {
    let people = folders.iter().filter(|(name, _)| *name != EXPERT_ID);
    people.map(|(name, own)| trainee_summary(name, own, language)).collect()
}

fn contents_summary(scenario: &Scenario, language: Language) -> String {
    let mut parts = vec![text!(language, "window-train-tasks", count = scenario.tasks.len())];
    if !scenario.bridges.is_empty() {
        parts.push(text!(language, "window-train-bridges", count = scenario.bridges.len()));
    }
    if scenario.defects.number() > 0 {
        parts.push(text!(language, "window-train-defects", count = scenario.defects.number()));
    }
    parts.join(", ")
}

/// Returns a session's end page. `trouble` is the reason why scores are missing, if known.
pub fn flight_summary(session: &Path, web: Option<&str>, trouble: Option<String>, language: Language) -> FlightSummary {
    let assessment = read_json(session, ASSESSMENT).unwrap_or_default();
    let advice = report::saved_advice(session).map(|advice| advice.in_language(language));
    let lesson = LessonSession::read(session);
    let scores = &assessment["scores"];
    let one = |name: &str| Some(FinalScore { raw: scores[name]["raw"].as_f64()?, pct: scores[name]["pct"].as_f64()? });
    let page = session.join(REPORT);
    let completion = Completion::deserialize(&assessment["completion"]).ok();
    let complete = completion.is_none_or(|completion| completion.complete);
    let certification = &assessment["certification"];
    let unmet = Vec::<String>::deserialize(&certification["unmet"]).unwrap_or_default();
    FlightSummary {
        scores: SCORE_NAMES.map(one),
        overall: scores["overall"].as_f64().zip(scores["overall_max"].as_f64()).filter(|_| complete),
        completion: completion.map(|completion| completion.headline(language)),
        complete,
        // The reasons follow as a list.
        verdict: certification["passed"].as_bool().map(|passed| verdict(passed, &[], language)),
        unmet: unmet.iter().map(|requirement| translated(requirement, language)).collect(),
        why: match trouble {
            Some(error) => text!(language, "window-result-not-scored-because", error = error),
            None => end_reason_text(&assessment["end"], session, language),
        },
        lesson: lesson.as_ref().map(|lesson| lesson.progress),
        next: match lesson.as_ref().filter(|lesson| !lesson.progress.is_complete()) {
            Some(lesson) => job_named(&lesson.scenario, language),
            None => advice.as_ref().and_then(|advice| next_job(advice, language)),
        },
        standing: standing_when_flown(session, &|job| reliability_beside(session, job))
            .filter(|_| lesson.is_none())
            .map(|standing| standing.words(language)),
        watched: false,
        // The sentence after a lesson is about its scores, which the page does not show.
        advice: advice.iter().filter(|_| lesson.is_none()).flat_map(SessionAdvice::sentences).map(str::to_owned).collect(),
        moments: web.iter().flat_map(|web| moments(session, web, &advice)).collect(),
        report: page.is_file().then(|| report::address(&page)),
        questionnaire: web.map(|web| questionnaire(session, web)).unwrap_or_default(),
    }
}

/// Returns the moments of the advice in the report on the server with this address.
fn moments(session: &Path, web: &str, advice: &Option<SessionAdvice>) -> Vec<FlightMoment> {
    let report = session_page(session, web, "report");
    let moment = |t_s: f64| FlightMoment { time: clock(t_s), address: format!("{report}#t={t_s:.2}") };
    advice.iter().flat_map(|advice| &advice.points).map(|point| moment(point.t_s)).collect()
}

/// Returns the address of a session's questionnaire on the server with this address.
pub fn questionnaire(session: &Path, web: &str) -> String {
    session_page(session, web, "questions")
}

fn session_page(session: &Path, web: &str, page: &str) -> String {
    let id = session.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    format!("{web}/sessions/{id}/{page}")
}

/// Puts the job that the start page offers the trainee on the end page, instead of the one that follows from this session alone.
pub fn offer_planned_job(ended: &mut FlightSummary, trainee: &str, trainees: &[TraineeSummary]) {
    let planned = trainees.iter().find(|summary| summary.name == trainee).and_then(|summary| summary.next.clone());
    ended.next = planned.or_else(|| ended.next.take());
}

/// Returns the end page of a flight that the trainee only watched: the next flight is the trainee's own.
pub fn watched(ended: FlightSummary, scenario: &str, language: Language) -> FlightSummary {
    let next = job_named(scenario, language);
    let (advice, moments) = (Vec::new(), Vec::new());
    FlightSummary { watched: true, standing: None, advice, moments, questionnaire: String::new(), next, ..ended }
}

fn end_reason_text(end: &Value, session: &Path, language: Language) -> String {
    match (end["reason"].as_str(), end["seconds"].as_f64()) {
        (Some(reason), Some(seconds)) => {
            let minutes = format!("{:.0}", (seconds / 60.0).floor());
            let seconds = format!("{:.0}", (seconds % 60.0).floor());
            let reason = capitalized(&end_reason_title(reason, language));
            text!(language, "window-result-after", reason = reason, minutes = minutes, seconds = seconds)
        }
        _ => text!(language, "window-result-not-scored", folder = session.display().to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::png::png;
    use spandrel_model::scenario::edit::with_briefing_picture;
    use spandrel_view::flow::pipe::FlownBy;
    use spandrel_view::picture::Picture;

    fn phantom() -> SelectedAircraft {
        SelectedAircraft::read("phantom2").unwrap()
    }

    #[test]
    fn exact_the_briefing_in_the_window_has_everything_that_the_printed_one_has() {
        let job = job_offer("two-bridges".into(), &phantom(), Language::English).unwrap();
        let scenario = files::scenario("two-bridges").unwrap().scenario;
        let printed = Briefing::new(&scenario, &phantom().vehicle, &Site::without_defects(&scenario), Language::English);
        let JobBriefing { conditions, counts, hazards, tasks, site_check, .. } = job.briefing;
        assert_eq!((hazards, site_check, tasks.len()), (printed.hazards, printed.site_check, printed.tasks.len()));
        assert!(
            conditions[0].starts_with("Aircraft: Phantom 2 class · ")
                && conditions[0].contains(" · Speed: 1.0 m/s for inspection")
        );
        for (_, value) in &printed.conditions {
            assert!(conditions[0].contains(value.as_str()), "{value} is missing in {conditions:?}");
        }
        let counts = counts.join(" ");
        for line in &printed.counts {
            let line = line.trim_start_matches("To be certified: ").trim_end_matches('.');
            assert!(counts.contains(line), "{line} is missing in {counts}");
        }
        assert_eq!(counts.matches("To be certified").count(), 1);
        for part in ["Aircraft: Phantom 2 class", "Wind: ", "Light: ", "Sky: "] {
            assert!(job.conditions.contains(part), "{part} is missing in {}", job.conditions);
        }
    }

    fn choice() -> FlightChoice {
        FlightChoice {
            trainee: "anna".into(),
            scenario: "drill-hover".into(),
            purpose: Purpose::Practice,
            by: FlownBy::Trainee,
            vehicle: "phantom2".into(),
        }
    }

    #[test]
    fn exact_every_shipped_scenario_is_offered_with_its_contents() {
        let folder = tempfile::tempdir().unwrap();
        let offers = flight_options(
            (&folder.path().join("none-yet"), &SessionsByTrainee::new(), &phantom()),
            &choice(),
            None,
            Language::English,
        );
        assert_eq!(offers.trainees, []);
        let kind = |name: &str| offers.scenarios.iter().find(|job| job.name == name).map(|job| job.kind.clone());
        assert_eq!(kind("two-bridges").as_deref(), Some("4 tasks, 2 bridges, 10 defects"));
        assert_eq!(kind("drill-hover").as_deref(), Some("1 task"));
        let harder = FlightChoice { scenario: "drill-hover@7".into(), ..choice() };
        let offers = flight_options(
            (&folder.path().join("none-yet"), &SessionsByTrainee::new(), &phantom()),
            &harder,
            None,
            Language::English,
        );
        assert_eq!(offers.scenarios.last().unwrap().title, "Drill: hover (level 7 of 9)");
    }

    #[test]
    fn regress_another_level_of_a_drill_that_is_recommended_or_assigned_has_a_briefing() {
        let folder = tempfile::tempdir().unwrap();
        let mut offers = flight_options(
            (&folder.path().join("none-yet"), &SessionsByTrainee::new(), &phantom()),
            &choice(),
            None,
            Language::English,
        );
        let offered = offers.scenarios.len();
        let trainee = |name: &str, scenario: &str| {
            let next = job_named(scenario, Language::English);
            TraineeSummary { name: name.into(), sessions: 1, practices: 1, last: None, next }
        };
        offers.trainees = vec![
            trainee("anna", "drill-gap@6"),
            trainee("bert", "drill-gap@6"),
            trainee("cora", "drill-gap"),
            trainee("dan", "none"),
        ];
        add_next_jobs(&mut offers, &phantom(), Language::English);
        assert_eq!(offers.scenarios.len(), offered + 1);
        let added = offers.scenarios.last().unwrap();
        assert_eq!((added.name.as_str(), added.vehicle.as_str()), ("drill-gap@6", "phantom2"));
        assert!(!added.briefing.site_check.is_empty());
    }

    #[test]
    fn exact_briefing_has_the_pictures_that_can_be_loaded() {
        let folder = tempfile::tempdir().unwrap();
        let entry = |file: &str| BriefingPicture { file: file.into(), caption: file.to_uppercase() };
        let add = |text: String, file: &&str| with_briefing_picture(&text, &entry(file)).unwrap();
        let text = ["gate.png", "missing.png", "text.png"].iter().fold(shipped::PRACTICE.to_owned(), add);
        let picture = png(&Picture { width: 3, height: 2, rgba: vec![9; 24] }).unwrap();
        std::fs::write(folder.path().join("gate.png"), picture).unwrap();
        std::fs::write(folder.path().join("text.png"), "text").unwrap();
        let job = folder.path().join("job.toml");
        std::fs::write(&job, text).unwrap();
        let scenario = job.display().to_string();
        let offers = flight_options(
            (folder.path(), &SessionsByTrainee::new(), &phantom()),
            &FlightChoice { scenario, ..choice() },
            None,
            Language::English,
        );
        let path = folder.path().join("gate.png").display().to_string();
        let expected = BriefingImage { path, caption: "GATE.PNG".into(), size_px: (3, 2) };
        assert_eq!(offers.scenarios.last().unwrap().briefing.pictures, [expected]);
    }

    #[test]
    fn exact_all_missing_pictures_of_a_briefing_are_one_line() {
        let line = |missing: &[(&str, &str)]| {
            let missing: Vec<(&str, String)> = missing.iter().map(|(name, why)| (*name, (*why).to_owned())).collect();
            missing_pictures("job", 3, &missing)
        };
        assert_eq!(line(&[]), None);
        let same = line(&[("a.png", "cannot read: no such file"), ("b.png", "cannot read: no such file")]);
        let expected = "the briefing of job is shown without 2 of its 3 pictures (a.png, b.png: cannot read: no such file)";
        assert_eq!(same.as_deref(), Some(expected));
        let different = line(&[("a.png", "damaged"), ("b.png", "too large")]);
        let expected = "the briefing of job is shown without 2 of its 3 pictures (a.png: damaged; b.png: too large)";
        assert_eq!(different.as_deref(), Some(expected));
    }

    #[test]
    fn exact_sessions_are_counted_per_trainee() {
        let sessions = tempfile::tempdir().unwrap();
        for (k, (trainee, purpose)) in
            [("anna", Some("practice")), ("anna", Some("assessment")), ("anna", None), ("bert", Some("assessment"))]
                .into_iter()
                .enumerate()
        {
            let folder = sessions.path().join(k.to_string());
            std::fs::create_dir(&folder).unwrap();
            std::fs::write(folder.join(TELEMETRY), "").unwrap();
            let session = serde_json::json!({ "trainee": trainee, "started_unix_us": 1, "purpose": purpose });
            std::fs::write(folder.join(SESSION), session.to_string()).unwrap();
        }
        let person =
            |name: &str, sessions, practices| TraineeSummary { name: name.into(), sessions, practices, last: None, next: None };
        assert_eq!(
            trainee_summaries(&sessions_by_trainee(sessions.path()), Language::English),
            [person("anna", 3, 1), person("bert", 1, 0)]
        );
    }

    #[test]
    fn exact_an_unfinished_lesson_is_recommended_again() {
        let sessions = tempfile::tempdir().unwrap();
        let folder = sessions.path().join("one");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join(TELEMETRY), "").unwrap();
        let session = serde_json::json!({ "trainee": "anna", "started_unix_us": 1, "scenario": LESSON });
        std::fs::write(folder.join(SESSION), session.to_string()).unwrap();
        let step = |done: u32| serde_json::json!({ "t_s": 1.0, "event": "lesson_step", "done": done, "of": 11 }).to_string();
        std::fs::write(folder.join(EVENTS), format!("{}\n{}\n", step(1), step(2))).unwrap();
        let summary = trainee_summaries(&sessions_by_trainee(sessions.path()), Language::English).remove(0);
        assert_eq!(summary.next.map(|next| next.scenario).as_deref(), Some(LESSON));
        assert_eq!(summary.last.as_deref(), Some("2 of 11 steps of the lesson."));
        let ended = flight_summary(&folder, None, None, Language::English);
        assert_eq!(ended.lesson, Some(LessonProgress { done: 2, steps: 11 }));
        assert_eq!(ended.next.map(|next| next.scenario).as_deref(), Some(LESSON));
        std::fs::write(folder.join(EVENTS), step(11)).unwrap();
        assert!(LessonSession::unfinished(&folder).is_none());
    }

    #[test]
    fn exact_ghost_is_the_best_complete_flight_of_the_same_job_and_level() {
        let sessions = tempfile::tempdir().unwrap();
        let job = files::scenario("drill-hover").unwrap();
        let save = |k: usize, trainee: &str, scenario: &str, level: u8, (complete, overall): (bool, f64)| {
            let folder = sessions.path().join(k.to_string());
            std::fs::create_dir(&folder).unwrap();
            std::fs::write(folder.join(TELEMETRY), "").unwrap();
            let crc = format!("{:08x}", job.scenario.crc);
            let session = serde_json::json!({
                "trainee": trainee, "started_unix_us": k, "scenario": scenario, "level": level, "scenario_crc": crc
            });
            std::fs::write(folder.join(SESSION), session.to_string()).unwrap();
            let scores = serde_json::json!({ "overall": overall, "overall_max": 300.0 });
            let assessment = serde_json::json!({ "completion": { "complete": complete }, "scores": scores });
            std::fs::write(folder.join(ASSESSMENT), assessment.to_string()).unwrap();
        };
        let found = || {
            let ghost = recorded_ghost(sessions.path(), "anna", &job, Language::English);
            assert!(!ghost.is_outdated);
            ghost.flight.map(|ghost| (ghost.telemetry, ghost.words))
        };
        let at = |k: usize| sessions.path().join(k.to_string()).join(TELEMETRY);
        let level = job.scenario.difficulty.as_ref().unwrap().level;
        for (k, trainee, scenario, of_level, result) in [
            (0, "bert", "drill-hover", level, (true, 300.0)),
            (1, "anna", "drill-gap", level, (true, 300.0)),
            (2, "anna", "drill-hover", level + 1, (true, 300.0)),
            (3, "anna", "drill-hover", level, (false, 300.0)),
        ] {
            save(k, trainee, scenario, of_level, result);
        }
        assert_eq!(found(), None);
        save(4, EXPERT_ID, "drill-hover", level, (true, 280.0));
        assert_eq!(found(), Some((at(4), "the expert's flight".to_owned())));
        save(5, "anna", "drill-hover", level, (true, 211.6));
        save(6, "anna", "drill-hover", level, (true, 190.0));
        save(7, "anna", "drill-hover", level, (true, 250.0));
        let path = sessions.path().join("7").join(ASSESSMENT);
        let mut rewound: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        rewound["practice_aids"] = serde_json::json!({ "freezes": 0, "rewinds": 1 });
        std::fs::write(path, rewound.to_string()).unwrap();
        assert_eq!(found(), Some((at(5), "your best flight, 212 of 300".to_owned())));
    }

    #[test]
    fn regress_a_flight_of_a_job_that_has_changed_since_is_no_ghost() {
        let sessions = tempfile::tempdir().unwrap();
        let save = |k: usize, trainee: &str, crc: u32| {
            let folder = sessions.path().join(k.to_string());
            std::fs::create_dir(&folder).unwrap();
            std::fs::write(folder.join(TELEMETRY), "").unwrap();
            let crc = format!("{crc:08x}");
            let session =
                serde_json::json!({ "trainee": trainee, "started_unix_us": k, "scenario": "pilot-study", "scenario_crc": crc });
            std::fs::write(folder.join(SESSION), session.to_string()).unwrap();
            let scores = serde_json::json!({ "overall": 300.0 - k as f64, "overall_max": 400.0 });
            let assessment = serde_json::json!({ "completion": { "complete": true }, "scores": scores });
            std::fs::write(folder.join(ASSESSMENT), assessment.to_string()).unwrap();
        };
        let job = files::scenario("pilot-study").unwrap();
        let found = || recorded_ghost(sessions.path(), "anna", &job, Language::English);
        save(1, "anna", job.scenario.crc ^ 1);
        assert_eq!(found(), RecordedGhost { flight: None, is_outdated: true });
        save(2, EXPERT_ID, job.scenario.crc ^ 1);
        assert_eq!(found(), RecordedGhost { flight: None, is_outdated: true });
        save(3, EXPERT_ID, job.scenario.crc);
        let words = found().flight.map(|ghost| ghost.words);
        assert_eq!(words.as_deref(), Some("the expert's flight, because this job has changed since your own"));
        save(4, "anna", files::scenario("pilot-study@B").unwrap().scenario.crc);
        let telemetry = sessions.path().join("4").join(TELEMETRY);
        let own = found();
        assert_eq!(
            (own.flight.map(|ghost| ghost.telemetry), own.is_outdated),
            (Some(telemetry), false),
            "another form has the same paths"
        );
    }

    #[test]
    fn exact_better_pilots_see_less_of_the_path() {
        let sessions = tempfile::tempdir().unwrap();
        assert_eq!(path_aids(sessions.path(), "anna"), PathAids::Full);
        for (k, (trainee, pct)) in
            [("anna", 60.0), ("bert", 100.0), ("anna", 96.0), ("anna", 78.0), ("bert", 100.0), ("bert", 100.0)]
                .into_iter()
                .enumerate()
        {
            let folder = sessions.path().join(k.to_string());
            std::fs::create_dir(&folder).unwrap();
            std::fs::write(folder.join(TELEMETRY), "").unwrap();
            let session = serde_json::json!({ "trainee": trainee, "started_unix_us": k, "purpose": "practice" });
            std::fs::write(folder.join(SESSION), session.to_string()).unwrap();
            let assessment = serde_json::json!({ "scores": { "conformity": { "raw": 0.0, "pct": pct } },
                "completion": { "complete": true } });
            std::fs::write(folder.join(ASSESSMENT), assessment.to_string()).unwrap();
        }
        assert_eq!(path_aids(sessions.path(), "anna"), PathAids::Gates, "78 % on average");
        assert_eq!(path_aids(sessions.path(), "bert"), PathAids::None, "three sessions with 100 %");
    }

    #[test]
    fn exact_end_page_shows_scores_and_file_locations() {
        let folder = tempfile::tempdir().unwrap();
        let none = flight_summary(folder.path(), None, None, Language::English);
        assert!(none.overall.is_none() && none.report.is_none() && none.why.contains("not scored"), "{none:?}");
        assert_eq!(none.questionnaire, "", "no server, no address");
        let text = r#"{"scores": {"conformity": {"raw": 62.0, "pct": 81.0}, "efficiency": {"raw": 100.0, "pct": 100.0},
            "safety": {"raw": -9.0, "pct": 91.0}, "accuracy": null, "overall": 272.0, "overall_max": 300.0},
            "end": {"reason": "landed", "seconds": 750.9}}"#;
        std::fs::write(folder.path().join(ASSESSMENT), text).unwrap();
        std::fs::write(folder.path().join(REPORT), "page").unwrap();
        let advice =
            r#"{"points": [{"words": "Slow down.", "rule": "speeding", "frame": 9, "t_s": 340.24, "drill": "drill-speed"}]}"#;
        std::fs::write(folder.path().join(spandrel_monitor::folder::ADVICE), advice).unwrap();
        let ended = flight_summary(folder.path(), Some("http://127.0.0.1:9"), None, Language::English);
        let id = folder.path().file_name().unwrap().to_string_lossy().into_owned();
        let address = format!("http://127.0.0.1:9/sessions/{id}/report#t=340.24");
        assert_eq!(ended.moments, [FlightMoment { time: "5:40".into(), address }]);
        assert_eq!(ended.why, "Landed after 12 min 30 s of flight");
        assert_eq!((ended.scores[2].map(|s| s.raw), ended.scores[3], ended.overall), (Some(-9.0), None, Some((272.0, 300.0))));
        assert!(ended.report.is_some_and(|address| address.starts_with("file:///")));
        assert!(ended.questionnaire.starts_with("http://127.0.0.1:9/sessions/") && ended.questionnaire.ends_with("/questions"));
    }

    #[test]
    fn exact_offers_and_results_are_in_the_language_of_the_window() {
        let folder = tempfile::tempdir().unwrap();
        let offers = |language| {
            flight_options((&folder.path().join("none-yet"), &SessionsByTrainee::new(), &phantom()), &choice(), None, language)
        };
        let kind = |language| {
            let offers = offers(language);
            offers.scenarios.into_iter().find(|job| job.name == "drill-hover").map(|job| job.kind).unwrap_or_default()
        };
        assert!(kind(Language::German).starts_with("1 Aufgabe") && kind(Language::Spanish).starts_with("1 tarea"));
        let text = r#"{"end": {"reason": "landed", "seconds": 750.9}}"#;
        std::fs::write(folder.path().join(ASSESSMENT), text).unwrap();
        let why = |language| flight_summary(folder.path(), None, None, language).why;
        assert_eq!(why(Language::German), "Gelandet nach 12 min 30 s Flug");
        assert_eq!(why(Language::Spanish), "Aterrizó tras 12 min 30 s de vuelo");
    }

    #[test]
    fn regress_incomplete_sessions_have_no_total() {
        let folder = tempfile::tempdir().unwrap();
        let text = r#"{"scores": {"conformity": {"raw": 0.0, "pct": 50.0}, "efficiency": {"raw": 100.0, "pct": 100.0},
            "safety": {"raw": 0.0, "pct": 100.0}, "accuracy": null, "overall": 250.0, "overall_max": 300.0},
            "completion": {"complete": false, "tasks_done": 0, "tasks": 4, "path_share": 0.0, "landed_at_home": false, "done_share": 0.8},
            "certification": {"passed": false, "unmet": ["task 1 not attempted", "not landed at home"]},
            "end": {"reason": "abort", "seconds": 23.0}}"#;
        std::fs::write(folder.path().join(ASSESSMENT), text).unwrap();
        let ended = flight_summary(folder.path(), None, None, Language::English);
        assert_eq!((ended.overall, ended.complete), (None, false));
        assert_eq!(ended.completion.as_deref(), Some("Incomplete: 0 of 4 tasks, 0% of the path"));
        assert_eq!(ended.verdict.as_deref(), Some("Not certified"));
        assert_eq!(ended.unmet, ["task 1 not attempted", "not landed at home"]);
        let german = flight_summary(folder.path(), None, None, Language::German);
        assert_eq!(german.unmet, ["Aufgabe 1 nicht begonnen", "nicht am Landeplatz gelandet"]);
    }
}
