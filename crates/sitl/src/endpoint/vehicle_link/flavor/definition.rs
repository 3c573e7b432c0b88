//! Differences between the autopilot interfaces on the wire.

use super::super::calibration::CalibrationTexts;
use super::super::params::ParamView;
use crate::autopilot::sensor_health::SensorChange;
use crate::autopilot::{Autopilot, AutopilotRequest, AutopilotStatus, Estimate, FlightMode, RequestOutcome, Tuning};
use crate::endpoint::link::LinkKind;
use spandrel_mavlink::dialect::{
    MavAutopilot, MavModeFlag, MavProtocolCapability, MavResult, MavSeverity, MavStandardMode, MavState, MavVtolState,
};
use spandrel_model::time::SimTime;

/// A flight mode as a flavor presents it to clients.
#[derive(Debug, Clone, Copy)]
pub struct ModeRow {
    /// The mode's number in HEARTBEAT.custom_mode.
    pub number: u32,
    /// The internal mode that this mode enters.
    pub mode: FlightMode,
    /// The autopilot request that enters the mode.
    pub request: AutopilotRequest,
    /// Mode used instead while the vehicle is armed without stick input.
    pub mode_without_sticks: Option<FlightMode>,
    /// Whether the mode is shown only after a client has requested it by its number.
    pub only_if_requested: bool,
    /// Other internal modes shown under the same number.
    pub also_shown_for: &'static [FlightMode],
    /// Display name.
    pub name: &'static str,
    /// The corresponding standard mode.
    pub standard: MavStandardMode,
    /// The value of HEARTBEAT.base_mode without the armed bit.
    pub base: MavModeFlag,
    /// Whether the vehicle flies autonomously in this mode.
    pub auto: bool,
    /// Whether ground stations list the mode for selection.
    pub selectable: bool,
    /// Whether the motors may be armed in this mode.
    pub armable: bool,
}

impl ModeRow {
    /// Also shows this row for other internal modes.
    pub(super) const fn also_showing(mut self, modes: &'static [FlightMode]) -> Self {
        self.also_shown_for = modes;
        self
    }

    pub(super) fn shows(&self, mode: FlightMode) -> bool {
        self.mode == mode || self.also_shown_for.contains(&mode)
    }
}

/// Results sent for rejected commands and requests.
#[derive(Debug, Clone, Copy)]
pub struct RefusalResults {
    /// Result for a temporary rejection.
    pub temporary_rejection: MavResult,
    /// Result for a request rejected in the current state.
    pub denied: MavResult,
    /// Result for an unknown mode.
    pub unknown_mode: MavResult,
    /// Result of REQUEST_MESSAGE for an unsupported message.
    pub message: MavResult,
    /// Result of SET_MESSAGE_INTERVAL for an unsupported message.
    pub interval: MavResult,
}

/// How NAV_TAKEOFF is interpreted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TakeOffRule {
    /// Accepted in any mode. Parameter 7 is the altitude above mean sea level or, in COMMAND_INT, in the given frame
    /// (PX4).
    AboveSeaLevel,
    /// Accepted only on the ground, while armed, in the mode that accepts go-to commands. Parameter 7 is the height
    /// above home (ArduPilot).
    AboveHomeInGuided,
}

/// An autopilot interface.
#[derive(Debug)]
pub struct Flavor {
    /// The flavor's name on the command line.
    pub name: &'static str,
    /// The value of HEARTBEAT.autopilot.
    pub autopilot: MavAutopilot,
    /// The value of AUTOPILOT_VERSION.flight_sw_version.
    pub software_version: u32,
    /// The value of AUTOPILOT_VERSION.capabilities.
    pub capabilities: MavProtocolCapability,
    /// All modes, in the order of AVAILABLE_MODES. If several rows show the same internal mode, the first row that
    /// enters the mode is its default.
    pub modes: &'static [ModeRow],
    /// Bits of the custom mode that identify the mode.
    pub mode_bits: u32,
    /// Converts parameters 2 and 3 of DO_SET_MODE to a custom mode.
    pub custom_mode: fn(f64, f64) -> u32,
    /// Whether SET_MODE requires the custom mode flag; without it, the message has another meaning (ArduPilot: the
    /// safety switch).
    pub custom_flag: bool,
    /// Returns the value of HEARTBEAT.system_status.
    pub state: fn(&Estimate, &AutopilotStatus) -> MavState,
    /// Number of the mode that accepts go-to commands and offboard setpoints directly (GUIDED). `None`: offboard
    /// setpoints have their own mode, and go-to commands are accepted in any mode.
    pub goto_mode: Option<u32>,
    /// How NAV_TAKEOFF is interpreted.
    pub take_off: TakeOffRule,
    /// Values in COMPONENT_ARM_DISARM that force arming or disarming.
    pub force: &'static [f64],
    /// Whether the altitude of a region-of-interest command is above mean sea level, regardless of its frame.
    pub roi_altitude_above_sea_level: bool,
    /// Results for rejected requests.
    pub refusals: RefusalResults,
    /// Prefix of the text sent for each failed arming check; `None`: a single text from the autopilot.
    pub arming_check_prefix: Option<&'static str>,
    /// Prefix of each reason reported by RUN_PREARM_CHECKS.
    pub prearm_reason_prefix: &'static str,
    /// Returns the text and severity for a sensor that failed or recovered; `None`: the default text.
    pub sensor_text: fn(SensorChange) -> Option<(MavSeverity, String)>,
    /// Returns the text for a rejected mode change.
    pub mode_rejection_text: fn(&ModeRow, String) -> String,
    /// Identification texts sent with the parameter list and for DO_SEND_BANNER; empty if unsupported.
    pub banner: &'static [&'static str],
    /// Whether ground stations and SDKs receive only heartbeats until they request streams.
    pub streams_on_request_only: bool,
    /// Whether the message requested by REQUEST_MESSAGE follows the acknowledgment; otherwise it precedes it.
    pub sends_message_after_ack: bool,
    /// Message groups of REQUEST_DATA_STREAM.
    pub groups: &'static [(u8, &'static [u32])],
    /// Whether messages from ArduPilot's dialect are sent.
    pub ardupilot_dialect: bool,
    /// Calibration text format.
    pub calibration: CalibrationTexts,
    /// Whether SERIAL_CONTROL opens a shell.
    pub shell: bool,
    /// Whether arming checks and health are reported as events.
    pub events: bool,
    /// Whether the vehicle has terrain heights and reports them (TERRAIN_CHECK).
    pub terrain: bool,
    /// Number of the mode that NAV_LOITER_UNLIM enters, or `None` for Hold mode.
    pub loiter_mode: Option<u32>,
    /// Whether setpoint positions in body and offset frames are relative to the vehicle; otherwise they are ignored.
    pub offsets: bool,
    /// Whether DO_PAUSE_CONTINUE pauses the current operation; if not, it enters Hold mode.
    pub pauses: bool,
    /// The value of EXTENDED_SYS_STATE.vtol_state.
    pub vtol_state: MavVtolState,
    /// Whether missions may contain NAV_SPLINE_WAYPOINT items, which are flown as ordinary waypoints.
    pub splines: bool,
    /// Whether coordinates of 0, 0 in a mission item or in DO_SET_HOME mean the vehicle's position at that time, and an
    /// item altitude of 0 its altitude.
    pub zero_means_current_position: bool,
    /// Whether mission item 0 is home.
    pub home_item: bool,
    /// Whether MISSION_REQUEST is answered with MISSION_ITEM, and uploaded items are requested with MISSION_REQUEST.
    pub uses_float_items: bool,
    /// The parameters presented to clients.
    pub params: &'static ParamView,
    /// Adjusts the autopilot to this flavor's behavior.
    pub tune: fn(&mut Tuning),
}

impl Flavor {
    /// Returns the row shown while `mode` is active; `requested` is the number of the last requested row.
    #[must_use]
    pub fn row_of(&self, mode: FlightMode, requested: u32) -> &'static ModeRow {
        let requested_row = self.modes.iter().find(|row| row.number == requested && row.shows(mode));
        requested_row.unwrap_or_else(|| self.default_mode(mode))
    }

    /// Returns a mode's default row.
    #[must_use]
    pub fn default_mode(&self, mode: FlightMode) -> &'static ModeRow {
        let enters = self.modes.iter().find(|row| row.mode == mode && !row.only_if_requested);
        // Every mode has a row that shows it; a test checks this.
        enters.or_else(|| self.modes.iter().find(|row| row.shows(mode))).unwrap_or(&self.modes[0])
    }

    /// Returns the row for a custom mode number.
    #[must_use]
    pub fn row(&self, custom_mode: u32) -> Option<&'static ModeRow> {
        self.modes.iter().find(|row| row.number == custom_mode & self.mode_bits)
    }

    /// Returns the row for a standard mode.
    #[must_use]
    pub fn standard(&self, number: u32) -> Option<&'static ModeRow> {
        self.modes.iter().find(|row| number != 0 && row.standard as u32 == number)
    }

    /// Enters a mode. Stores the requested number in `requested`, because several numbers may map to the same internal
    /// mode.
    pub fn enter(&self, row: &ModeRow, requested: &mut u32, autopilot: &mut Autopilot, now: SimTime) -> RequestOutcome {
        let before = autopilot.status().mode;
        let from = self.row_of(before, *requested).number;
        let unattended = row.mode_without_sticks.filter(|_| autopilot.is_unattended(now));
        let request = unattended.map_or(row.request, AutopilotRequest::SetMode);
        let outcome = autopilot.request(request, now);
        if outcome != RequestOutcome::Accepted {
            return match outcome {
                RequestOutcome::TemporarilyRejected(why) => {
                    RequestOutcome::TemporarilyRejected((self.mode_rejection_text)(row, why))
                }
                RequestOutcome::Denied(why) => RequestOutcome::Denied((self.mode_rejection_text)(row, why)),
                RequestOutcome::Failed(why) => RequestOutcome::Failed((self.mode_rejection_text)(row, why)),
                unchanged @ (RequestOutcome::Accepted | RequestOutcome::Unsupported) => unchanged,
            };
        }
        *requested = row.number;
        if before == FlightMode::Hold && autopilot.status().mode == FlightMode::Hold && from != row.number {
            // Because the internal mode does not change, the autopilot would otherwise continue to the previous mode's
            // target. On the ground, where the request has no effect, it is rejected.
            autopilot.request(AutopilotRequest::GoTo { north_east_m: None, up_m: None, yaw_rad: None, speed_m_s: None }, now);
        }
        outcome
    }

    /// Checks whether links of this kind must request their streams.
    #[must_use]
    pub fn must_request_streams(&self, kind: LinkKind) -> bool {
        self.streams_on_request_only && kind != LinkKind::Payload
    }
}

/// Capabilities common to all flavors.
pub(super) const COMMON_CAPABILITIES: MavProtocolCapability = {
    use MavProtocolCapability as C;
    C::MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT
        .union(C::MAV_PROTOCOL_CAPABILITY_MISSION_INT)
        .union(C::MAV_PROTOCOL_CAPABILITY_COMMAND_INT)
        .union(C::MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET)
        .union(C::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED)
        .union(C::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT)
        .union(C::MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION)
        .union(C::MAV_PROTOCOL_CAPABILITY_MAVLINK2)
        .union(C::MAV_PROTOCOL_CAPABILITY_FTP)
        .union(C::MAV_PROTOCOL_CAPABILITY_MISSION_FENCE)
        .union(C::MAV_PROTOCOL_CAPABILITY_MISSION_RALLY)
};

/// Returns the autopilot's text unchanged.
pub(super) fn named_mode(_: &ModeRow, why: String) -> String {
    why
}
