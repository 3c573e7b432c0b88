//! Checks whether a session's questionnaire is complete.

use crate::io::answers::{read_saved_answers, task_ids};
use crate::io::session_folder::StoredSession;
use std::path::Path;

/// Returns true if some of a session's questions have no answer.
pub fn has_unanswered(session: &Path) -> bool {
    let Ok(job) = StoredSession::read_scenario(session) else { return false };
    match read_saved_answers(session, &job.scenario) {
        Ok(answers) => !answers.unwrap_or_default().complete(&task_ids(&job.scenario)),
        // If the page cannot read the answers, it cannot accept new ones, either.
        Err(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;
    use spandrel_monitor::export::json_text;
    use spandrel_monitor::folder::{SCENARIO, TELEMETRY};
    use spandrel_training::questionnaire::{ANSWERS, Answers, QuestionnaireItem};

    #[test]
    fn exact_questionnaire_is_open_until_last_answer() {
        let folder = tempfile::tempdir().unwrap();
        let (session, job) = (folder.path(), files::scenario("drill-hover").unwrap());
        assert!(!has_unanswered(session), "there is no session yet");
        std::fs::write(session.join(TELEMETRY), "").unwrap();
        std::fs::write(session.join(SCENARIO), &job.text).unwrap();
        assert!(has_unanswered(session), "nothing is answered");
        let mut answers = Answers { language: "en".into(), ..Answers::default() };
        let items = QuestionnaireItem::all(&task_ids(&job.scenario));
        for (k, item) in items.iter().enumerate() {
            assert!(has_unanswered(session), "{k} of {} are answered", items.len());
            answers.given.insert(*item, 2);
            std::fs::write(session.join(ANSWERS), json_text(&answers)).unwrap();
        }
        assert!(!has_unanswered(session));
        std::fs::write(session.join(ANSWERS), "{}").unwrap();
        assert!(!has_unanswered(session), "an invalid file does not count");
    }
}
