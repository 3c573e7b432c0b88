//! Cohort figures, cached until the database changes. Reading ten thousand records takes seconds of CPU time, and every
//! reload of a cohort page needs the same figures. They use a separate database connection so that list pages do not
//! have to wait. The request pipeline processes one such request at a time.

use super::lock::lock;
use crate::errors::AppError;
use crate::records::{Database, RecordsLocation};
use spandrel_training::cohort::{Cohort, MeasureReliability, Selection, cohort};
use spandrel_training::record::{IncompletePolicy, SessionRecord};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

/// Maximum number of cached selections; the oldest is removed first. An instructor is unlikely to compare more
/// (estimate).
const MAX_CACHED_SELECTIONS: usize = 8;

/// Cohort figures for one selection.
#[derive(Debug)]
pub struct CohortFigures {
    /// The cohort, which may contain no sessions.
    pub cohort: Cohort,
    /// Names of all scenarios with at least one session.
    pub flown_scenarios: Vec<String>,
}

impl CohortFigures {
    /// Returns the cohort, or `None` if it contains no sessions.
    pub fn non_empty_cohort(&self) -> Option<&Cohort> {
        (self.cohort.sessions > 0).then_some(&self.cohort)
    }
}

/// Computes figures and caches them until the database changes.
#[derive(Debug)]
pub struct FigureCache {
    database: Database,
    cache: Mutex<VersionedCache<Selection, CohortFigures>>,
}

impl FigureCache {
    /// Opens a separate database connection.
    ///
    /// # Errors
    /// Returns an error if the database cannot be opened.
    pub fn open(records_location: &RecordsLocation) -> Result<Self, AppError> {
        Ok(Self { database: records_location.open()?, cache: Mutex::default() })
    }

    /// Returns the reliability of the measures on a job over the first two sessions of each trainee.
    ///
    /// # Errors
    /// Returns an error if the database fails or contains an invalid record.
    pub fn reliability(&self, scenario: &str, incomplete: IncompletePolicy) -> Result<Vec<MeasureReliability>, AppError> {
        let selection = Selection { scenarios: vec![scenario.to_owned()], repetitions: 2, incomplete };
        Ok(self.get(&selection)?.cohort.all_reliabilities())
    }

    /// Returns the reliability for a report, which does without it if the database cannot be read: that is logged.
    pub fn reliability_if_known(&self, scenario: &str) -> Vec<MeasureReliability> {
        self.reliability(scenario, IncompletePolicy::Exclude).unwrap_or_else(|error| {
            tracing::warn!("the error of the measures is unknown: {error}");
            Vec::new()
        })
    }

    /// Returns the figures for a selection.
    ///
    /// # Errors
    /// Returns an error if the database fails or contains an invalid record.
    pub fn get(&self, selection: &Selection) -> Result<Arc<CohortFigures>, AppError> {
        let mut kept = lock(&self.cache);
        let version = self.database.version()?;
        kept.get(&version, selection, || Ok(compute_figures(&self.database.records(None)?, selection)))
    }
}

fn compute_figures(records: &[SessionRecord], selection: &Selection) -> CohortFigures {
    let flown: BTreeSet<String> = records.iter().map(SessionRecord::scenario_with_level).collect();
    CohortFigures { cohort: cohort(records, selection), flown_scenarios: flown.into_iter().collect() }
}

/// Values cached by key, for one version of their source data.
#[derive(Debug)]
struct VersionedCache<K, V> {
    version: String,
    values: Vec<(K, Arc<V>)>,
}

impl<K, V> Default for VersionedCache<K, V> {
    fn default() -> Self {
        Self { version: String::new(), values: Vec::new() }
    }
}

impl<K: Clone + PartialEq, V> VersionedCache<K, V> {
    fn get(&mut self, version: &str, key: &K, compute: impl FnOnce() -> Result<V, AppError>) -> Result<Arc<V>, AppError> {
        if self.version != version {
            self.values.clear();
            version.clone_into(&mut self.version);
        }
        if let Some((_, value)) = self.values.iter().find(|(kept, _)| kept == key) {
            return Ok(value.clone());
        }
        let value = Arc::new(compute()?);
        if self.values.len() >= MAX_CACHED_SELECTIONS {
            self.values.remove(0);
        }
        self.values.push((key.clone(), value.clone()));
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_figures_are_cached_per_version_and_selection() {
        let mut kept = VersionedCache::<u32, u32>::default();
        let mut computed = 0;
        let mut ask = |version: &str, key: u32| {
            let value = kept.get(version, &key, || {
                computed += 1;
                Ok(computed)
            });
            value.map(|value| *value)
        };
        assert_eq!(ask("1", 7), Ok(1));
        assert_eq!(ask("1", 7), Ok(1), "cached");
        assert_eq!(ask("1", 8), Ok(2), "another selection");
        assert_eq!(ask("1", 7), Ok(1), "both are cached");
        assert_eq!(ask("2", 7), Ok(3), "the database has changed");
        for key in 100..100 + u32::try_from(MAX_CACHED_SELECTIONS).unwrap() {
            ask("2", key).unwrap();
        }
        assert_eq!(ask("2", 7), Ok(4 + u32::try_from(MAX_CACHED_SELECTIONS).unwrap()), "the oldest was removed");
        assert!(kept.values.len() <= MAX_CACHED_SELECTIONS);
    }

    #[test]
    fn regress_failures_are_not_cached() {
        let mut kept = VersionedCache::<u32, u32>::default();
        assert!(kept.get("1", &1, || Err(AppError::failed("no"))).is_err());
        assert_eq!(kept.get("1", &1, || Ok(5)).map(|value| *value), Ok(5));
    }
}
