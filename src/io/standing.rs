//! A session's result compared with the trainee's earlier sessions in the same folder.

use super::session_folder::StoredSession;
use serde::Deserialize;
use serde_json::Value;
use spandrel_model::scenario::Scenario;
use spandrel_monitor::folder::{ASSESSMENT, SESSION};
use spandrel_monitor::measures::practice_aids::PracticeAids;
use spandrel_training::cohort::MeasureReliability;
use spandrel_training::record::{FlownForm, SessionLevel, differing_forms};
use spandrel_training::standing::SessionStanding;
use std::path::Path;

/// Returns the reliability of the measures on the job with this name and level, from all trainees' records; empty if it is unknown.
pub type ReliabilityLookup<'a> = &'a dyn Fn(&str) -> Vec<MeasureReliability>;

/// A session, which flies a job at a time.
struct FlownSession {
    started_unix_us: u64,
    /// Trainee, job and level.
    flown: [Value; 3],
    /// Name of the form; `None` if the job has no forms.
    form: Option<String>,
}

impl FlownSession {
    fn read(session: &Path) -> Option<Self> {
        let info = read_json(session, SESSION)?;
        let flown = ["trainee", "scenario", "level"].map(|key| info[key].clone());
        let form = info["form"].as_str().map(str::to_owned);
        Some(Self { started_unix_us: info["started_unix_us"].as_u64()?, flown, form })
    }

    /// Returns the form with its difficulty, which the session's scenario tells; unknown without the scenario.
    fn flown_form(&self, session: &Path) -> FlownForm {
        let unknown = || FlownForm { name: self.form.clone(), detection_pct: None };
        scenario(session).map_or_else(unknown, |scenario| FlownForm::of(&scenario))
    }

    /// Returns whether another session is an earlier one of the same trainee and job.
    fn follows(&self, other: &Self) -> bool {
        other.started_unix_us < self.started_unix_us && other.flown == self.flown
    }
}

/// Returns the score and the highest possible one of a complete session that was neither frozen nor rewound.
fn comparable_score(session: &Path) -> Option<(f64, f64)> {
    let assessment = read_json(session, ASSESSMENT)?;
    let aids = PracticeAids::deserialize(&assessment["practice_aids"]).unwrap_or_default();
    let is_comparable = assessment["completion"]["complete"].as_bool() == Some(true) && aids.count() == 0;
    let scores = &assessment["scores"];
    scores["overall"].as_f64().zip(scores["overall_max"].as_f64()).filter(|_| is_comparable)
}

fn scenario(session: &Path) -> Option<Scenario> {
    StoredSession::read_scenario(session).ok().map(|file| file.scenario)
}

/// Returns the name and level of the job that a session flew.
fn job_name(session: &Path) -> Option<String> {
    let scenario = scenario(session)?;
    Some(SessionLevel::named(&scenario.name, scenario.difficulty.as_ref().map(SessionLevel::of)))
}

/// Compares a session with the trainee's earlier ones of the same job and level, and on equated forms. The change is labeled if the
/// error of the score is known. Later sessions don't count, so that the result stays the same. `None` if the session is not complete, was frozen or rewound, or is the first one.
pub fn standing_when_flown(session: &Path, reliability: ReliabilityLookup<'_>) -> Option<SessionStanding> {
    let (own, (overall, most)) = (FlownSession::read(session)?, comparable_score(session)?);
    let folder = std::path::absolute(session).ok()?;
    let entries = std::fs::read_dir(folder.parent()?).ok()?;
    let own_form = own.flown_form(session);
    // Reading a scenario takes longer than reading the form's name, so the same form is not read again.
    let is_equated =
        |other: &FlownSession, path: &Path| other.form == own.form || other.flown_form(path).is_equated_with(&own_form);
    let compared = entries.filter_map(|entry| {
        let path = entry.ok()?.path();
        let other = FlownSession::read(&path).filter(|other| own.follows(other))?;
        let (score, _) = comparable_score(&path).filter(|(_, other_most)| *other_most == most)?;
        is_equated(&other, &path).then_some((other, score))
    });
    let compared: Vec<(FlownSession, f64)> = compared.collect();
    let earlier: Vec<(u64, f64)> = compared.iter().map(|(other, score)| (other.started_unix_us, *score)).collect();
    let standing = SessionStanding::new((own.started_unix_us, overall, most), &earlier)?;
    let forms = differing_forms(compared.iter().map(|(other, _)| &other.form).chain([&own.form]));
    let known = job_name(session).map(|job| reliability(&job)).unwrap_or_default();
    Some(SessionStanding { forms, ..standing.labeled(&known) })
}

fn read_json(session: &Path, name: &str) -> Option<Value> {
    serde_json::from_str(&std::fs::read_to_string(session.join(name)).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;
    use serde_json::json;
    use spandrel_monitor::folder::{SCENARIO, TELEMETRY};
    use spandrel_training::cohort::job_reliability;
    use spandrel_training::record::{IncompletePolicy, SessionRecord};
    use spandrel_training::testing::perfect_record;

    #[test]
    fn exact_a_session_is_compared_with_earlier_complete_ones_of_the_same_trainee_and_job() {
        let sessions = tempfile::tempdir().unwrap();
        let save = |k: u64, (trainee, scenario, level): (&str, &str, u8), (complete, overall): (bool, f64), rewinds: u32| {
            let folder = sessions.path().join(k.to_string());
            std::fs::create_dir(&folder).unwrap();
            let info = json!({ "trainee": trainee, "started_unix_us": k, "scenario": scenario, "level": level });
            std::fs::write(folder.join(SESSION), info.to_string()).unwrap();
            let scores = json!({ "overall": overall, "overall_max": 400.0 });
            let aids = json!({ "freezes": 0, "rewinds": rewinds });
            let assessment = json!({ "completion": { "complete": complete }, "scores": scores, "practice_aids": aids });
            std::fs::write(folder.join(ASSESSMENT), assessment.to_string()).unwrap();
            folder
        };
        let job = ("anna", "drill-gap", 3);
        let first = save(1, job, (true, 300.0), 0);
        assert_eq!(standing_when_flown(&first, &|_| Vec::new()), None, "nothing to compare with");
        save(2, ("bert", "drill-gap", 3), (true, 390.0), 0);
        save(3, ("anna", "drill-hover", 3), (true, 390.0), 0);
        save(4, ("anna", "drill-gap", 4), (true, 390.0), 0);
        save(5, job, (false, 390.0), 0);
        save(6, job, (true, 390.0), 1);
        let second = save(7, job, (true, 340.0), 0);
        let third = save(8, job, (true, 310.0), 0);
        std::fs::create_dir(sessions.path().join("video")).unwrap();
        let told = |folder: &Path| {
            let standing = standing_when_flown(folder, &|_| Vec::new()).unwrap();
            (standing.best, standing.is_best, standing.change)
        };
        assert_eq!(told(&second), (340.0, true, Some(40.0)), "a later session does not change it");
        assert_eq!(told(&third), (340.0, false, Some(-30.0)));
    }

    #[test]
    fn exact_equated_forms_are_compared_and_labeled_with_the_error_on_the_job() {
        let sessions = tempfile::tempdir().unwrap();
        let save = |k: u64, form: &str, overall: f64| {
            let folder = sessions.path().join(k.to_string());
            std::fs::create_dir(&folder).unwrap();
            let job = files::scenario(&format!("pilot-study@{form}")).unwrap();
            std::fs::write(folder.join(SCENARIO), job.text).unwrap();
            std::fs::write(folder.join(TELEMETRY), "").unwrap();
            let info = json!({ "trainee": "anna", "started_unix_us": k, "scenario": "pilot-study", "form": form });
            std::fs::write(folder.join(SESSION), info.to_string()).unwrap();
            let scores = json!({ "overall": overall, "overall_max": 400.0 });
            let assessment = json!({ "completion": { "complete": true }, "scores": scores });
            std::fs::write(folder.join(ASSESSMENT), assessment.to_string()).unwrap();
            folder
        };
        save(1, "A", 330.0);
        let harder = save(2, "H", 250.0);
        let last = save(3, "B", 340.0);
        assert_eq!(standing_when_flown(&harder, &|_| Vec::new()), None, "form A is easier than H");
        let mut others: Vec<SessionRecord> = Vec::new();
        for (trainee, overall) in [("ben", [200.0, 260.0]), ("cleo", [380.0, 330.0])] {
            for (number, overall) in (1..).zip(overall) {
                let mut record = perfect_record(trainee, number);
                (record.scenario, record.scores.overall) = ("pilot-study".into(), overall);
                others.push(record);
            }
        }
        let known = |job: &str| job_reliability(&others, job, IncompletePolicy::Exclude);
        let found = standing_when_flown(&last, &known).unwrap();
        assert_eq!((found.best, found.change, found.within_error), (340.0, Some(10.0), Some(true)));
        assert_eq!(found.forms, ["A", "B"]);
    }
}
