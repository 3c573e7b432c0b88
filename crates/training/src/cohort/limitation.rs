//! Limitations to consider when interpreting a cohort's statistics.

use super::sample_sizes::{RECOMMENDED_PAIRS, RECOMMENDED_REPEATERS, RECOMMENDED_RESPONDENTS};
use crate::statistics::StatisticsError;
use crate::terms::{measure_title, score_title};
use serde::{Serialize, Serializer};
use spandrel_text::{Language, text};

/// A limitation of the statistics.
#[derive(Debug, Clone, PartialEq)]
pub enum Limitation {
    /// This many sessions were frozen or rewound and are excluded.
    AidedSessions(usize),
    /// The sessions flew these forms, which may differ in difficulty.
    PooledForms(Vec<String>),
    /// Only this many trainees gave complete answers, too few for the causal model.
    FewAnswers(usize),
    /// The causal model could not be estimated.
    NoCausalModel {
        /// What the failing regression explains: `strain` or `performance`.
        outcome: &'static str,
        /// Reason.
        reason: StatisticsError,
    },
    /// Only this many trainees flew the job often enough, too few for paired tests.
    FewPairs {
        /// Number of trainees.
        trainees: usize,
        /// Number of sessions of each.
        repetitions: usize,
    },
    /// The reliability is based on only this many trainees.
    ImpreciseReliability(usize),
    /// A measure has no reliability, because it does not vary.
    NoReliability(&'static str),
    /// Two repetitions cannot be compared.
    NoComparison {
        /// Key of the score.
        score: &'static str,
        /// Number of the earlier repetition, from 1.
        earlier: usize,
        /// Number of the later repetition.
        later: usize,
        /// Reason.
        reason: StatisticsError,
    },
    /// The group cannot be compared with the other trainees.
    NoHomogeneityTest {
        /// Key of the score.
        score: &'static str,
        /// Reason.
        reason: StatisticsError,
    },
}

impl Limitation {
    /// Returns the limitation as a sentence without a period.
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        match self {
            Self::AidedSessions(count) => text!(language, "cohort-limit-aided", count = *count),
            Self::PooledForms(forms) => text!(language, "cohort-limit-pooled-forms", forms = forms.join(", ")),
            Self::FewAnswers(count) => {
                text!(language, "cohort-limit-few-answers", count = *count, recommended = RECOMMENDED_RESPONDENTS)
            }
            Self::NoCausalModel { outcome, reason } => {
                let outcome = outcome_title(outcome, language);
                text!(language, "cohort-limit-no-causal-model", outcome = outcome, reason = reason_words(reason, language))
            }
            Self::FewPairs { trainees, repetitions } => text!(
                language,
                "cohort-limit-few-pairs",
                count = *trainees,
                repetitions = *repetitions,
                recommended = RECOMMENDED_PAIRS
            ),
            Self::ImpreciseReliability(count) => {
                text!(language, "cohort-limit-imprecise", count = *count, recommended = RECOMMENDED_REPEATERS)
            }
            Self::NoReliability(measure) => {
                text!(language, "cohort-limit-no-reliability", measure = measure_title(measure, language))
            }
            Self::NoComparison { score, earlier, later, reason } => text!(
                language,
                "cohort-limit-no-comparison",
                score = score_title(score, language),
                earlier = *earlier,
                later = *later,
                reason = reason_words(reason, language)
            ),
            Self::NoHomogeneityTest { score, reason } => {
                let score = score_title(score, language);
                text!(language, "cohort-limit-no-homogeneity", score = score, reason = reason_words(reason, language))
            }
        }
    }
}

/// Files for other programs are in English.
impl Serialize for Limitation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.words(Language::English))
    }
}

fn outcome_title(outcome: &str, language: Language) -> String {
    match outcome {
        "performance" => text!(language, "cohort-term-performance"),
        _ => text!(language, "cohort-term-strain"),
    }
}

fn reason_words(reason: &StatisticsError, language: Language) -> String {
    match reason {
        StatisticsError::TooFew { n, needed } => text!(language, "cohort-reason-too-few", count = *n, needed = *needed),
        StatisticsError::Constant(_) => text!(language, "cohort-reason-constant"),
        StatisticsError::Collinear => text!(language, "cohort-reason-collinear"),
        // A cohort's lists have the same length, and records contain only finite numbers.
        StatisticsError::Unpaired { .. } | StatisticsError::NotFinite { .. } => reason.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_limitations_are_translated_and_files_are_in_english() {
        let few = |n| Limitation::NoComparison {
            score: "safety",
            earlier: 1,
            later: 2,
            reason: StatisticsError::TooFew { n, needed: 2 },
        };
        assert_eq!(
            few(1).words(Language::English),
            "safety, repetition 2 vs. 1: no test possible: only 1 value; at least 2 are required"
        );
        assert!(few(0).words(Language::English).contains("only 0 values"));
        let german = few(1).words(Language::German);
        assert!(german.contains("Sicherheit") && !german.contains("value"), "{german}");
        assert_eq!(serde_json::to_value(few(1)).unwrap(), few(1).words(Language::English));
        let twice = Limitation::AidedSessions(2);
        assert!(twice.words(Language::English).starts_with("2 sessions were frozen or rewound"));
    }
}
