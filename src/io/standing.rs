//! A session's result compared with the trainee's earlier sessions in the same folder.

use serde::Deserialize;
use serde_json::Value;
use spandrel_monitor::folder::{ASSESSMENT, SESSION};
use spandrel_monitor::measures::practice_aids::PracticeAids;
use spandrel_training::standing::SessionStanding;
use std::path::Path;

/// A session, which flies a job at a time.
struct FlownSession {
    started_unix_us: u64,
    /// Trainee, job and level.
    flown: [Value; 3],
}

impl FlownSession {
    fn read(session: &Path) -> Option<Self> {
        let info = read_json(session, SESSION)?;
        let flown = ["trainee", "scenario", "level"].map(|key| info[key].clone());
        Some(Self { started_unix_us: info["started_unix_us"].as_u64()?, flown })
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

/// Compares a session with the trainee's earlier ones of the same job and level. Later sessions don't count, so that the result
/// stays the same. `None` if the session is not complete, was frozen or rewound, or is the first one.
pub fn standing_when_flown(session: &Path) -> Option<SessionStanding> {
    let (own, (overall, most)) = (FlownSession::read(session)?, comparable_score(session)?);
    let folder = std::path::absolute(session).ok()?;
    let entries = std::fs::read_dir(folder.parent()?).ok()?;
    let earlier = entries.filter_map(|entry| {
        let path = entry.ok()?.path();
        let other = FlownSession::read(&path).filter(|other| own.follows(other))?;
        let (score, _) = comparable_score(&path).filter(|(_, other_most)| *other_most == most)?;
        Some((other.started_unix_us, score))
    });
    SessionStanding::new((own.started_unix_us, overall, most), &earlier.collect::<Vec<_>>())
}

fn read_json(session: &Path, name: &str) -> Option<Value> {
    serde_json::from_str(&std::fs::read_to_string(session.join(name)).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

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
        assert_eq!(standing_when_flown(&first), None, "nothing to compare with");
        save(2, ("bert", "drill-gap", 3), (true, 390.0), 0);
        save(3, ("anna", "drill-hover", 3), (true, 390.0), 0);
        save(4, ("anna", "drill-gap", 4), (true, 390.0), 0);
        save(5, job, (false, 390.0), 0);
        save(6, job, (true, 390.0), 1);
        let second = save(7, job, (true, 340.0), 0);
        let third = save(8, job, (true, 310.0), 0);
        std::fs::create_dir(sessions.path().join("video")).unwrap();
        let told = |folder: &Path| {
            let standing = standing_when_flown(folder).unwrap();
            (standing.best, standing.is_best, standing.change)
        };
        assert_eq!(told(&second), (340.0, true, Some(40.0)), "a later session does not change it");
        assert_eq!(told(&third), (340.0, false, Some(-30.0)));
    }
}
