//! Arming checks.

use super::fence::Fence;
use super::fence_check::FenceCheck;
use super::input::FailsafeInput;
use super::link_status::LinkStatus;
use super::sensor_health::SensorHealth;
use spandrel_model::frames::{Frd, Vec3};

/// Stick deflection that counts as centered for arming.
const CENTERED_STICK_DEFLECTION: f64 = 0.2;
/// Minimum tilt cosine for arming (20 degrees).
const MIN_TILT_COSINE: f64 = 0.94;
/// Minimum clearance above the vehicle for arming, m.
const MIN_OVERHEAD_CLEARANCE_M: f64 = 1.0;
/// Maximum horizontal position error for arming, m (1 sigma).
const MAX_ARMING_POSITION_SIGMA_M: f64 = 5.0;

/// The arming checks.
#[derive(Debug, Clone, Copy)]
pub struct ArmingCheck<'a> {
    /// Inputs to the checks.
    pub input: &'a FailsafeInput<'a>,
    /// Link status.
    pub links: &'a LinkStatus,
    /// Sensor health.
    pub sensors: &'a SensorHealth,
    /// Geofence.
    pub fence: &'a Fence,
    /// Whether any geofence limit is active.
    pub fence_set: bool,
}

impl ArmingCheck<'_> {
    /// Returns the conditions that currently prevent arming.
    #[must_use]
    pub fn reasons(&self) -> Vec<String> {
        let mut out = self.blockers_on_ground();
        out.extend(self.stick_refusal().map(str::to_owned));
        out
    }

    /// Returns the reasons why pre-arm checks failed.
    #[must_use]
    pub fn prearm_blockers(&self) -> Vec<String> {
        if self.input.tuning.arming_depends_on_mode { self.blockers_on_ground() } else { self.reasons() }
    }

    fn has_recent_sticks(&self) -> bool {
        self.links.has_recent_sticks(self.input.tuning.manual_timeout_s(), self.input.now)
    }

    fn stick_refusal(&self) -> Option<&'static str> {
        if !self.has_recent_sticks() {
            return None;
        }
        if !self.input.tuning.arming_depends_on_mode {
            return (self.links.deflection() > CENTERED_STICK_DEFLECTION).then_some("Sticks not centered");
        }
        let climbs = self.input.flight.intended.is_manual() && self.links.sticks.up > 0.0;
        if self.links.deflection_without_throttle() > CENTERED_STICK_DEFLECTION {
            Some("Sticks not centered")
        } else {
            climbs.then_some("Throttle too high")
        }
    }

    /// Returns true if arming requires a position estimate: for the mode, to hold position without a pilot, or for the
    /// geofence.
    fn needs_position(&self) -> bool {
        let intended = self.input.flight.intended;
        !self.input.tuning.arming_depends_on_mode || !self.has_recent_sticks() || intended.needs_position() || self.fence_set
    }

    fn blockers_on_ground(&self) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        let (estimate, tuning, flight) = (self.input.estimate, self.input.tuning, &self.input.flight);
        let rules = &tuning.rules.responses;
        out.extend(self.sensors.arming_refusals());
        if !estimate.attitude_valid {
            out.push("Attitude not aligned".into());
            return out;
        }
        if !self.needs_position() {
            // A position estimate is not required.
        } else if !flight.global_position_known {
            out.push("No GNSS fix".into());
        } else if !estimate.position_valid || estimate.horizontal_m > MAX_ARMING_POSITION_SIGMA_M {
            out.push("Position not accurate enough".into());
        }
        if (estimate.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down() < MIN_TILT_COSINE {
            out.push("Not level".into());
        }
        match flight.battery {
            None => out.push("No battery readings".into()),
            Some(b) if b.remaining_pct < tuning.battery_critical_pct.max(rules.min_arming_charge_pct) => {
                out.push("Battery too low".into());
            }
            Some(b) if b.voltage_v < rules.min_arming_voltage_v => out.push("Battery voltage too low".into()),
            Some(_) => {}
        }
        if rules.arming_requires_mission && flight.mission_is_empty {
            out.push("No mission".into());
        }
        let fence = FenceCheck::new(self.fence, tuning, flight.home_m);
        if estimate.position_valid && fence.breach_at(estimate.position_m).is_some() {
            out.push("Outside the geofence".into());
        }
        if flight.range_up_m.is_some_and(|range| range < MIN_OVERHEAD_CLEARANCE_M) {
            out.push("Obstacle above vehicle".into());
        }
        out
    }
}
