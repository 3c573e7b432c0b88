//! Limit on listing trainees individually.

use crate::cohort::Cohort;

/// Maximum number of trainees listed individually.
pub const MAX_LISTED_TRAINEES: usize = 60;

/// Returns whether the page lists trainees individually.
pub(super) fn lists_individuals(cohort: &Cohort) -> bool {
    cohort.trainees <= MAX_LISTED_TRAINEES
}
