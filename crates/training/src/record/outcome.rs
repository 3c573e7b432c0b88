//! Completion and certification texts shared by full records and list entries.

use spandrel_monitor::score::completion::{self, Completion};
use spandrel_text::{Language, text};

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
    fn completion_summary(&self, language: Language) -> String {
        self.completion().map_or_else(|| text!(language, "completion-unknown"), |completion| completion.headline(language))
    }

    /// Returns the certification verdict as text: certified, or the first unmet requirement.
    fn verdict(&self, language: Language) -> String {
        let (certified, unmet) = self.certification();
        completion::verdict(certified, unmet, language)
    }

    /// Returns both headlines, which are always shown together: the completion, and the certification verdict.
    fn headlines(&self, language: Language) -> String {
        format!("{}. {}", self.completion_summary(language), self.verdict(language))
    }
}
