//! Inputs to the navigator: a read-only view of the rest of the autopilot.

use crate::autopilot::control::airframe::Airframe;
use crate::autopilot::control::gains::Gains;
use crate::autopilot::control::landed::FlightPhase;
use crate::autopilot::estimator::estimate::Estimate;
use crate::autopilot::failsafe::fence::Fence;
use crate::autopilot::failsafe::link_status::LinkStatus;
use crate::autopilot::tuning::Tuning;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Inputs for a tick or request.
#[derive(Debug, Clone, Copy)]
pub struct NavigatorInput<'a> {
    /// Operator settings.
    pub tuning: &'a Tuning,
    /// Aircraft properties.
    pub airframe: &'a Airframe,
    /// Control loop gains.
    pub gains: &'a Gains,
    /// Estimated state.
    pub estimate: &'a Estimate,
    /// Sticks and external setpoints.
    pub links: &'a LinkStatus,
    /// Geofence zones.
    pub fence: &'a Fence,
    /// Whether the motors are armed.
    pub armed: bool,
    /// Flight phase.
    pub phase: FlightPhase,
    /// Ground level where the vehicle last stood on the ground, m down.
    pub ground_down_m: f64,
    /// Latest downward range finder reading, m.
    pub range_down_m: Option<f64>,
    /// Time of the tick or request.
    pub now: SimTime,
    /// Time of the last tick.
    pub last_step: SimTime,
    /// Time since the last tick, s; 0 for a request.
    pub dt_s: f64,
}

impl NavigatorInput<'_> {
    /// Returns the estimated position in meters.
    #[must_use]
    pub fn here(&self) -> Vec3<Ned> {
        self.estimate.position_m
    }

    /// Returns true if the vehicle is armed and off the ground.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.armed && self.phase != FlightPhase::OnGround
    }

    /// Returns true if stick input has not timed out.
    #[must_use]
    pub fn has_recent_sticks(&self) -> bool {
        self.links.has_recent_sticks(self.tuning.manual_timeout_s(), self.now)
    }

    /// Returns true if external setpoints have not timed out.
    #[must_use]
    pub fn has_recent_offboard(&self) -> bool {
        self.links.has_recent_offboard(self.tuning.offboard_timeout_s(), self.now)
    }
}
