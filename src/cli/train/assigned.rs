//! Jobs that an instructor has assigned, for the start page.

use super::offers::job_named;
use crate::errors::AppError;
use crate::io::clock;
use crate::records::Database;
use crate::web::scenario_library::{UPLOAD_FOLDER, upload_path};
use spandrel_model::calendar::day;
use spandrel_text::Language;
use spandrel_training::assignment::{Assignment, assigned_jobs};
use spandrel_view::flow::pipe::{NextJob, TraineeSummary};
use std::path::Path;

/// Offers each trainee the pending assignment that is due first, instead of the recommended job. Titles are in the given
/// language.
pub fn put_first(trainees: &mut [TraineeSummary], database: Option<&Database>, sessions: &Path, language: Language) {
    // Without a database, nothing was assigned.
    let Some(database) = database else { return };
    let result = trainees.iter_mut().try_for_each(|trainee| put_pending_first(trainee, database, sessions, language));
    if let Err(error) = result {
        tracing::warn!("cannot read the assignments: {error}");
    }
}

fn put_pending_first(
    trainee: &mut TraineeSummary,
    database: &Database,
    sessions: &Path,
    language: Language,
) -> Result<(), AppError> {
    let assignments = database.assignments_of_trainee(&trainee.name)?;
    if assignments.is_empty() {
        return Ok(());
    }
    let jobs = assigned_jobs(assignments, &database.records(Some(&trainee.name))?, clock::unix_us());
    let pending = jobs.iter().filter(|job| job.state.is_pending());
    let first = pending.map(|job| &job.assignment).find_map(|assignment| assigned_job(assignment, sessions, language));
    trainee.next = first.or_else(|| trainee.next.take());
    Ok(())
}

/// Returns an assigned job, if its scenario is still there.
fn assigned_job(assignment: &Assignment, sessions: &Path, language: Language) -> Option<NextJob> {
    let own = upload_path(&sessions.join(UPLOAD_FOLDER), &assignment.scenario);
    let name = if own.is_file() { own.display().to_string() } else { assignment.scenario.clone() };
    let name = match &assignment.variant {
        Some(variant) => format!("{name}@{variant}"),
        None => name,
    };
    let job = job_named(&name, language);
    job.map(|job| NextJob { due: Some(day(assignment.due_unix_us)), ..job })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::RecordsLocation;
    use spandrel_training::assignment::AssignmentTarget;

    fn assigned(id: &str, scenario: &str, due_unix_us: u64) -> Assignment {
        Assignment {
            id: id.into(),
            target: AssignmentTarget::Trainee("anna".into()),
            scenario: scenario.into(),
            variant: None,
            assigned_unix_us: 0,
            due_unix_us,
            assigned_by: "ida".into(),
        }
    }

    #[test]
    fn exact_assignment_that_is_due_first_comes_before_the_recommendation() {
        let sessions = tempfile::tempdir().unwrap();
        let recommended = job_named("drill-hover", Language::English);
        let trainee =
            |name: &str| TraineeSummary { name: name.into(), sessions: 1, practices: 1, last: None, next: recommended.clone() };
        let mut trainees = [trainee("anna"), trainee("bert")];
        put_first(&mut trainees, None, sessions.path(), Language::English);
        assert_eq!(trainees[0].next, recommended, "no database");
        let database = RecordsLocation::beside(sessions.path()).open().unwrap();
        database.update_details("anna", None, [None; 3]).unwrap();
        let own = sessions.path().join(UPLOAD_FOLDER);
        std::fs::create_dir(&own).unwrap();
        let text = spandrel_model::shipped::PRACTICE.replace("name = \"practice\"", "name = \"windy\"");
        std::fs::write(own.join("windy.toml"), text).unwrap();
        for (id, scenario, due) in [("a", "drill-gap", 2_000_000), ("b", "windy", 1_000_000), ("c", "removed", 500_000)] {
            assert!(database.assign(&assigned(id, scenario, due)).unwrap());
        }
        put_first(&mut trainees, Some(&database), sessions.path(), Language::English);
        let next = trainees[0].next.clone().unwrap();
        assert_eq!((next.scenario, next.due.as_deref()), (own.join("windy.toml").display().to_string(), Some("1970-01-01")));
        assert_eq!(trainees[1].next, recommended);
    }
}
