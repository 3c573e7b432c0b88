//! Reliability of the measures from the database beside a session, if there is one.

use super::location::RecordsLocation;
use crate::errors::AppError;
use spandrel_training::cohort::{MeasureReliability, job_reliability};
use spandrel_training::record::IncompletePolicy;
use std::path::Path;

/// Returns the reliability of the measures on a job, by name and level, from the records of all trainees in the database beside a
/// session, as `spandrel plan` computes it. Empty without a database, which is not created for this purpose; a database that
/// cannot be read is logged, because a report needs no records.
pub fn reliability_beside(session: &Path, job: &str) -> Vec<MeasureReliability> {
    read(session, job).unwrap_or_else(|error| {
        tracing::warn!("{}: the error of the measures is unknown: {error}", session.display());
        Vec::new()
    })
}

fn read(session: &Path, job: &str) -> Result<Vec<MeasureReliability>, AppError> {
    let absolute = std::path::absolute(session).ok();
    let Some(sessions) = absolute.as_deref().and_then(Path::parent) else { return Ok(Vec::new()) };
    let location = RecordsLocation::beside(sessions);
    if !location.exists() {
        return Ok(Vec::new());
    }
    Ok(job_reliability(&location.open()?.records(None)?, job, IncompletePolicy::Exclude))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_training::cohort::reliability_of;
    use spandrel_training::testing::perfect_record;

    #[test]
    fn exact_reliability_comes_from_the_database_beside_the_session() {
        let sessions = tempfile::tempdir().unwrap();
        let session = sessions.path().join("a-session");
        assert_eq!(reliability_beside(&session, "two-bridges"), []);
        let location = RecordsLocation::beside(sessions.path());
        assert!(!location.exists(), "no database was created");
        let mut records = Vec::new();
        for (trainee, safety) in [("anna", [50.0, 52.0]), ("ben", [70.0, 76.0])] {
            for (number, safety) in (1..).zip(safety) {
                let mut record = perfect_record(trainee, number);
                record.scores.safety = safety;
                records.push(record);
            }
        }
        location.open().unwrap().put(&records).unwrap();
        let found = reliability_beside(&session, "two-bridges");
        assert_eq!(found, job_reliability(&records, "two-bridges", IncompletePolicy::Exclude));
        assert!(reliability_of(&found, "safety").unwrap().reliability.is_some());
    }
}
