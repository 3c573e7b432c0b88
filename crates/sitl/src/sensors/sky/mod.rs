//! GNSS under the real sky: satellites of an almanac move, structures hide them, and water and walls reflect their signals. The
//! errors of a fix follow from the errors of its pseudoranges and the geometry of the satellites.

mod antenna;
mod channel;
mod multipath;
mod propagation;
mod receiver;
mod solution;

#[cfg(test)]
mod tests;

pub use receiver::{SkyReceiver, receiver_spec};

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::satellites::{Almanac, GpsTime};
use spandrel_model::scenario::Scenario;
use spandrel_model::scenario::bridges::Member;
use spandrel_model::site::reflectors::Reflectors;
use spandrel_model::time::SimTime;
use std::sync::Arc;

/// Satellites and reflecting surfaces of a job. Immutable.
#[derive(Debug, Clone, PartialEq)]
pub struct Sky {
    almanac: Arc<Almanac>,
    plane: LocalPlane,
    start_unix_s: f64,
    reflectors: Reflectors,
    /// Amplitude of a reflected signal relative to that of the model.
    reflected_factor: f64,
}

impl Sky {
    /// Builds the sky above a job's site at its date and time.
    #[must_use]
    pub fn new(scenario: &Scenario, members: &[Member]) -> Self {
        Self {
            almanac: scenario.hazards.almanac.clone().unwrap_or_else(|| Arc::new(Almanac::nominal())),
            plane: LocalPlane::new(scenario.origin),
            start_unix_s: scenario.light.start_unix_s as f64,
            reflectors: Reflectors::new(members, scenario.terrain.water_level_m),
            reflected_factor: scenario.hazards.severity,
        }
    }

    /// Returns the unit vectors to all satellites at a simulation time.
    #[must_use]
    pub fn directions(&self, now: SimTime) -> Vec<Vec3<Enu>> {
        self.almanac.directions(&self.plane, GpsTime::from_unix_s(self.start_unix_s + now.s()))
    }
}
