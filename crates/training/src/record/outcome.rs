//! Completion and certification of a session, in words: the same for a whole record and for a line of a list.

use spandrel_monitor::score::completion::{self, Completion};

/// A session whose outcome is known.
pub trait SessionOutcome {
    /// Share of the job that was done; `None` in a record of format 1.
    fn completion(&self) -> Option<&Completion>;

    /// Whether the certification profile is passed, and the requirements that failed.
    fn certification(&self) -> (bool, &[String]);

    /// Returns true if the job was done and the drone landed at home.
    fn is_complete(&self) -> bool {
        self.completion().is_some_and(|completion| completion.complete)
    }

    /// How much of the job was done, in words.
    fn completion_summary(&self) -> String {
        self.completion().map_or_else(|| "Completion unknown: import this session again".to_owned(), Completion::headline)
    }

    /// Certified, or the requirement that failed.
    fn verdict(&self) -> String {
        let (certified, unmet) = self.certification();
        completion::verdict(certified, unmet)
    }
}
