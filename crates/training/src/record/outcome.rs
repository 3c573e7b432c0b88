//! Completion and certification texts shared by full records and list entries.

use spandrel_monitor::score::completion::{self, Completion};

/// A session with a completion state and a certification result.
pub trait SessionOutcome {
    /// Returns the job completion; `None` in format 1 records.
    fn completion(&self) -> Option<&Completion>;

    /// Returns whether the session passed certification, and the unmet requirements.
    fn certification(&self) -> (bool, &[String]);

    /// Returns whether the job was done and the drone landed at home.
    fn is_complete(&self) -> bool {
        self.completion().is_some_and(|completion| completion.complete)
    }

    /// Returns the completion as text.
    fn completion_summary(&self) -> String {
        self.completion().map_or_else(|| "Completion unknown: re-import this session".to_owned(), Completion::headline)
    }

    /// Returns the certification verdict as text: certified, or the first unmet requirement.
    fn verdict(&self) -> String {
        let (certified, unmet) = self.certification();
        completion::verdict(certified, unmet)
    }

    /// Returns both headlines, which are always shown together: the completion, and the certification verdict.
    fn headlines(&self) -> String {
        format!("{}. {}", self.completion_summary(), self.verdict())
    }
}
