//! Limit up to which the page lists trainees individually.

use crate::cohort::Cohort;

/// Maximum number of trainees listed individually.
pub const PEOPLE_SHOWN: usize = 60;

/// Returns whether the page lists trainees individually.
pub(super) fn people_shown(cohort: &Cohort) -> bool {
    cohort.trainees <= PEOPLE_SHOWN
}
