//! A rotor that draws in air that it has pushed away loses thrust, and the loss fluctuates. This holds for the vortex ring state and for
//! closed spaces.

use spandrel_model::math::{self, GRAVITY_M_S2, PI, TAU};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Amplitude of the fluctuation relative to the mean loss (estimate; Shetty and Selig, *Small-Scale Propellers Operating in the Vortex
/// Ring State*, AIAA 2011-1254, measured fluctuations of up to 30% of the thrust).
const FLUCTUATION: f64 = 0.5;
/// Frequency of the fluctuation times the rotor radius divided by the induced velocity (estimate: the ring grows and breaks away about
/// every 20 rotor revolutions).
pub(super) const FREQUENCY_RADIUS_RATIO: f64 = 0.1;
/// Phase between neighboring rotors, turns (the golden ratio, so that no rotors shake together).
const ROTOR_PHASE_TURNS: f64 = 0.618_034;

/// The rotors' disks in a hover.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoverDisk {
    radius_m: f64,
    /// Hover thrust of a rotor divided by twice its disk area, N/m².
    half_disk_loading_n_m2: f64,
}

impl HoverDisk {
    /// Returns the disks of an aircraft.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Self {
        let radius_m = vehicle.rotor.radius_m;
        let thrust_n = vehicle.mass_kg * GRAVITY_M_S2 / vehicle.rotors.len().max(1) as f64;
        Self { radius_m, half_disk_loading_n_m2: thrust_n / (2.0 * PI * radius_m * radius_m) }
    }

    /// Returns the induced velocity in hover, m/s.
    #[must_use]
    pub fn induced_velocity_m_s(&self, density_kg_m3: f64) -> f64 {
        (self.half_disk_loading_n_m2 / density_kg_m3).sqrt()
    }

    /// Returns a rotor's loss at a time, relative to the mean loss: a sine wave with a phase of its own for each rotor.
    #[must_use]
    pub fn fluctuation(&self, rotor: usize, induced_m_s: f64, now: SimTime) -> f64 {
        let frequency_hz = FREQUENCY_RADIUS_RATIO * induced_m_s / self.radius_m;
        let turns = frequency_hz * now.s() + ROTOR_PHASE_TURNS * rotor as f64;
        1.0 + FLUCTUATION * math::sin(TAU * turns)
    }
}
