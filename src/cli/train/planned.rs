//! Each trainee's next job by the training plan over all sessions, as `spandrel plan` and the web pages recommend it.

use super::offers::{SessionsByTrainee, has_unfinished_lesson, job_named};
use crate::errors::AppError;
use crate::io::clock;
use crate::io::files;
use crate::records::{Database, RecordsLocation, import_into, session_id};
use crate::web::plan_rules::rules_beside;
use crate::web::scenario_library::UPLOAD_FOLDER;
use spandrel_monitor::folder::ASSESSMENT;
use spandrel_text::Language;
use spandrel_training::plan::{PlanRules, PlanStep, plan_for_policy};
use spandrel_training::record::{IncompletePolicy, SessionRecord};
use spandrel_view::flow::pipe::{NextJob, TraineeSummary};
use std::path::{Path, PathBuf};

/// Opens the records beside the sessions, which one page needs several times. `None` without a database, which is not created for this
/// purpose, or with one that cannot be opened, which is logged.
pub fn open_records(sessions: &Path) -> Option<Database> {
    RecordsLocation::beside(sessions).open_existing().unwrap_or_else(|error| {
        tracing::warn!("cannot open the records: {error}");
        None
    })
}

/// Adds a session that has just ended to the records, so that the plan takes it into account. The web server's importer would do it
/// a few seconds later.
pub fn import(session: &Path, database: Option<&Database>) {
    let Some(database) = database else { return };
    if let Err(error) = import_into(database, &[session.to_path_buf()]) {
        tracing::warn!("{}: not in the records yet: {error}", session.display());
    }
}

/// Offers each trainee the first job of the plan, instead of the one that follows from the latest session alone. Titles are in the
/// given language.
pub fn recommend(
    trainees: &mut [TraineeSummary],
    database: Option<&Database>,
    (sessions, folders): (&Path, &SessionsByTrainee),
    language: Language,
) {
    let Some(database) = database else {
        mark_unplanned(trainees, folders);
        return;
    };
    if let Err(error) = recommend_from(database, trainees, (sessions, folders), language) {
        tracing::warn!("cannot plan the next jobs: {error}");
    }
}

/// Marks the recommendations that follow from the latest of several sessions. An unfinished lesson is recommended in any case.
fn mark_unplanned(trainees: &mut [TraineeSummary], folders: &SessionsByTrainee) {
    for trainee in trainees {
        let own = folders.get(&trainee.name).map_or(&[][..], Vec::as_slice);
        let continues_lesson = own.last().is_some_and(|folder| has_unfinished_lesson(folder));
        if let Some(next) = trainee.next.as_mut() {
            next.from_last_session = own.len() > 1 && !continues_lesson;
        }
    }
}

fn recommend_from(
    database: &Database,
    trainees: &mut [TraineeSummary],
    (sessions, folders): (&Path, &SessionsByTrainee),
    language: Language,
) -> Result<(), AppError> {
    let (rules, _) = rules_beside(&sessions.join(UPLOAD_FOLDER), language)?;
    let known = database.fingerprints()?;
    for trainee in trainees {
        let own = folders.get(&trainee.name).map_or(&[][..], Vec::as_slice);
        let is_recorded = |folder: &PathBuf| session_id(folder).is_ok_and(|id| known.contains_key(&id));
        // A plan from a part of the sessions would contradict the latest flight.
        let is_complete = own.iter().filter(|folder| folder.join(ASSESSMENT).is_file()).all(is_recorded);
        // An unfinished lesson comes first.
        if !is_complete || own.last().is_some_and(|folder| has_unfinished_lesson(folder)) {
            continue;
        }
        let step = first_step(database.records(Some(&trainee.name))?, &rules, language);
        trainee.next = step.and_then(|step| planned_job(&step, language)).or_else(|| trainee.next.take());
    }
    Ok(())
}

/// Returns the first step of the plan from a trainee's records in chronological order.
fn first_step(records: Vec<SessionRecord>, rules: &PlanRules, language: Language) -> Option<PlanStep> {
    plan_for_policy(records, IncompletePolicy::Exclude, rules, clock::unix_us(), language)?.steps.into_iter().next()
}

/// Returns a step's job with its level, if its scenario is installed.
fn planned_job(step: &PlanStep, language: Language) -> Option<NextJob> {
    let level = step.level.as_ref().map(|level| level.level);
    job_named(&files::with_variant(&step.scenario, None, level), language)
}

#[cfg(test)]
mod tests {
    use super::super::offers::{flight_summary, offer_planned_job, sessions_by_trainee};
    use super::*;
    use crate::cli::plan::plan_of;
    use crate::io::plan_rules::rules;
    use crate::web::{ListenConfig, ServerSetup, WebServer};
    use spandrel_monitor::folder::{SESSION, TELEMETRY};
    use spandrel_training::record::SessionLevel;
    use spandrel_training::testing::perfect_record;

    /// Saves a session folder as the start page reads it, without anything to score.
    fn save_folder(sessions: &Path, record: &SessionRecord) {
        let folder = sessions.join(&record.id);
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join(TELEMETRY), "").unwrap();
        let session = serde_json::json!({ "trainee": record.trainee, "started_unix_us": record.started_unix_us,
            "scenario": record.scenario });
        std::fs::write(folder.join(SESSION), session.to_string()).unwrap();
        std::fs::write(folder.join(ASSESSMENT), "{}").unwrap();
    }

    /// Returns the records of three flights. The plan continues the drill of the second one, of which the third one alone shows
    /// nothing.
    fn flown() -> Vec<SessionRecord> {
        let now = clock::unix_us();
        let mut records: Vec<SessionRecord> = (1..=3).map(|number| perfect_record("anna", number)).collect();
        for (record, hours_ago) in records.iter_mut().zip([50, 49, 48]) {
            record.started_unix_us = now - hours_ago * 3_600_000_000;
        }
        (records[1].scenario, records[1].level) = ("drill-gap".into(), Some(SessionLevel { level: 5, levels: 9, standard: 5 }));
        records
    }

    fn summary() -> TraineeSummary {
        let next = job_named("drill-hover", Language::English);
        TraineeSummary { name: "anna".into(), sessions: 3, practices: 3, last: None, next }
    }

    #[test]
    fn exact_start_page_end_page_command_line_and_web_page_recommend_the_same_job() {
        let folder = tempfile::tempdir().unwrap();
        let (sessions, records) = (folder.path(), flown());
        records.iter().for_each(|record| save_folder(sessions, record));
        let location = RecordsLocation::beside(sessions);
        location.open().unwrap().put(&records).unwrap();

        let mut trainees = [summary()];
        let database = open_records(sessions);
        recommend(&mut trainees, database.as_ref(), (sessions, &sessions_by_trainee(sessions)), Language::English);
        let window = trainees[0].next.clone().unwrap();

        let everyone = location.open().unwrap().records(None).unwrap();
        let plan = plan_of("anna", &everyone, IncompletePolicy::Exclude, &rules(None).unwrap()).unwrap();
        let step = &plan.steps[0];
        assert_eq!(window.scenario, files::with_variant(&step.scenario, None, step.level.as_ref().map(|level| level.level)));
        let latest = sessions.join(&records[2].id);
        let mut ended = flight_summary(&latest, None, None, Language::English);
        ended.next = job_named("drill-hover", Language::English);
        offer_planned_job(&mut ended, "anna", &trainees);
        assert_eq!(ended.next.as_ref(), Some(&window), "the end page");
        offer_planned_job(&mut ended, "bert", &trainees);
        assert_eq!(ended.next.as_ref(), Some(&window), "a trainee without a plan keeps the job that the session suggests");
        let alone = plan_of("anna", &records[2..], IncompletePolicy::Exclude, &rules(None).unwrap()).unwrap();
        assert_ne!(alone.steps[0].scenario, step.scenario, "the latest session alone must recommend something else");

        let setup = ServerSetup {
            records_location: location,
            scenarios: None,
            own_job: None,
            watched: Vec::new(),
            wordings: Vec::new(),
            station_key: None,
        };
        let server = WebServer::start(&ListenConfig::local(0), setup).unwrap();
        let mut answer = ureq::get(format!("{}/trainees/anna", server.address())).call().unwrap();
        let page = answer.body_mut().read_to_string().unwrap();
        let first = page.split("class=\"steps\"").nth(1).and_then(|steps| steps.split("/scenarios/").nth(1)).unwrap();
        assert_eq!(first.split('"').next(), Some(step.scenario.as_str()));
    }

    #[test]
    fn exact_sessions_without_records_keep_the_recommendation_of_the_latest_flight() {
        let folder = tempfile::tempdir().unwrap();
        let (sessions, records) = (folder.path(), flown());
        records.iter().for_each(|record| save_folder(sessions, record));
        let recommended = || {
            let mut trainees = [summary()];
            let database = open_records(sessions);
            recommend(&mut trainees, database.as_ref(), (sessions, &sessions_by_trainee(sessions)), Language::English);
            trainees[0].next.clone()
        };
        let alone = recommended().unwrap();
        assert_eq!(Some(&alone.scenario), summary().next.map(|next| next.scenario).as_ref(), "no database");
        assert!(alone.from_last_session, "the pages must say that the recommendation follows from one of three sessions");
        let database = RecordsLocation::beside(sessions).open().unwrap();
        database.put(&records[..2]).unwrap();
        assert_eq!(recommended(), summary().next, "the latest flight is not imported yet");
        database.put(&records[2..]).unwrap();
        assert_ne!(recommended(), summary().next);
    }
}
