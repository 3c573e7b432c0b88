//! Configuration of a synthetic pilot.

use super::skill::Skill;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use std::sync::Arc;

/// Configuration of a synthetic pilot.
#[derive(Debug, Clone)]
pub struct PilotConfig {
    /// Scenario of the job to fly.
    pub scenario: Arc<Scenario>,
    /// Parameters of the aircraft.
    pub vehicle: Arc<Vehicle>,
    /// The pilot's skill parameters.
    pub skill: Skill,
    /// Seed of the pilot's random number streams.
    pub seed: u64,
}
