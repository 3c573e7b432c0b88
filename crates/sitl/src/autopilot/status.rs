//! Autopilot status for telemetry.

use super::external_input::OffboardSetpoint;
use super::failsafe::fence::FenceState;
use super::failsafe::sensor_health::SensorStatus;
use super::flight_state::{FlightMode, LandedState};
use super::navigator::orbit::Orbit;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};

/// Autopilot status for telemetry.
#[derive(Debug, Clone, PartialEq)]
pub struct AutopilotStatus {
    /// Whether the motors are armed.
    pub armed: bool,
    /// The active mode.
    pub mode: FlightMode,
    /// The requested mode. A failsafe can override it.
    pub intended: FlightMode,
    /// Low battery level, %.
    pub battery_low_pct: f64,
    /// Critical battery level, %.
    pub battery_critical_pct: f64,
    /// Landed state.
    pub landed: LandedState,
    /// Whether a takeoff climb is in progress, as a mode or a mission item.
    pub climbing_out: bool,
    /// Conditions that currently prevent arming; empty if there are none.
    pub arming_blockers: Vec<String>,
    /// Reason for the active failsafe.
    pub failsafe: Option<String>,
    /// Home relative to the origin, m; `None` before the first fix.
    pub home_m: Option<Vec3<Ned>>,
    /// Current target position, m.
    pub target_m: Option<Vec3<Ned>>,
    /// The active external setpoint.
    pub setpoint: Option<OffboardSetpoint>,
    /// Attitude setpoint.
    pub attitude_target: Rotation<Frd, Ned>,
    /// Collective thrust setpoint, 0 to 1.
    pub thrust: f64,
    /// Current mission item, zero-based.
    pub mission_current: usize,
    /// Mission item reached since the last query, for MISSION_ITEM_REACHED.
    pub mission_reached: Option<usize>,
    /// Whether the mission is complete.
    pub mission_finished: bool,
    /// Whether the mission was interrupted and can be continued.
    pub mission_paused: bool,
    /// Geofence state.
    pub fence: FenceState,
    /// The active circle.
    pub orbit: Option<Orbit>,
    /// Number of position resets to GNSS.
    pub position_resets: u32,
    /// Sensor health.
    pub health: SensorStatus,
}

impl AutopilotStatus {
    /// Returns the status before the first step.
    #[must_use]
    pub fn at_boot() -> Self {
        Self {
            armed: false,
            mode: FlightMode::Position,
            intended: FlightMode::Position,
            battery_low_pct: 0.0,
            battery_critical_pct: 0.0,
            landed: LandedState::OnGround,
            climbing_out: false,
            arming_blockers: vec!["Booting".into()],
            failsafe: None,
            home_m: None,
            target_m: None,
            setpoint: None,
            attitude_target: Rotation::identity(),
            thrust: 0.0,
            mission_current: 0,
            mission_reached: None,
            mission_finished: false,
            mission_paused: false,
            fence: FenceState::default(),
            orbit: None,
            position_resets: 0,
            health: SensorStatus::ALL_GOOD,
        }
    }
}
