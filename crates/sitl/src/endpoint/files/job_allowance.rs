//! Limits the file work per tick. Jobs run between ticks, on the simulation thread, so that the same requests are
//! answered in the same tick in every run. Client requests must therefore never delay a tick.

use super::job::FileAction;
use spandrel_model::time::SimTime;

/// Maximum number of jobs in a burst after an idle period.
const MAX_SAVED_JOBS: u32 = 32;

/// Allows one small job per millisecond of simulation time. Unused jobs accumulate up to a maximum.
#[derive(Debug, Clone)]
pub struct JobAllowance {
    remaining: u32,
    updated_at: SimTime,
}

impl Default for JobAllowance {
    fn default() -> Self {
        Self { remaining: MAX_SAVED_JOBS, updated_at: SimTime::ZERO }
    }
}

impl JobAllowance {
    /// Checks whether the allowance covers this action at `now`.
    #[must_use]
    pub fn covers(&self, action: &FileAction, now: SimTime) -> bool {
        self.remaining_at(now) >= action.cost()
    }

    /// Deducts an action's cost.
    pub fn spend(&mut self, action: &FileAction, now: SimTime) {
        (self.remaining, self.updated_at) = (self.remaining_at(now).saturating_sub(action.cost()), now);
    }

    fn remaining_at(&self, now: SimTime) -> u32 {
        let passed_ms = u32::try_from(now.ms() - self.updated_at.ms()).unwrap_or(0);
        self.remaining.saturating_add(passed_ms).min(MAX_SAVED_JOBS)
    }
}

#[cfg(test)]
mod tests {
    use super::super::path::FilePath;
    use super::*;

    #[test]
    fn exact_flood_is_limited_to_one_job_per_ms_and_one_listing_per_8_ms() {
        let path = || FilePath::of(b"a").unwrap();
        for (action, expected) in [(FileAction::Size(path()), 32 + 100), (FileAction::List(path()), (32 + 100) / 8)] {
            let (mut allowance, mut done) = (JobAllowance::default(), 0);
            for ms in 0..=100 {
                let now = SimTime::from_ms(ms);
                while allowance.covers(&action, now) {
                    allowance.spend(&action, now);
                    done += 1;
                }
            }
            assert_eq!(done, expected, "{action:?}");
        }
    }
}
