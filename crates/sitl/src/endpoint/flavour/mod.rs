//! Whose interface the vehicle speaks: all that differs between autopilots on the wire, one table each. What is not here is the same for
//! all of them.

pub mod ardupilot;
pub mod generic;
pub mod px4;

use super::calibration::CalibrationTexts;
use super::commands::VehicleCommand;
use super::params::ParamView;
use super::snapshot::VehicleSnapshot;
use super::{CommandContext, LinkKind};
use crate::autopilot::sensor_health::SensorChange;
use crate::autopilot::{Autopilot, AutopilotRequest, FlightMode, RequestOutcome, Tuning};
use spandrel_mavlink::dialect::{
    MavAutopilot, MavModeFlag, MavProtocolCapability, MavResult, MavSeverity, MavStandardMode, MavState, MavVtolState,
};
use spandrel_model::time::SimTime;

/// One mode as clients of a flavour know it.
#[derive(Debug, Clone, Copy)]
pub struct ModeRow {
    /// HEARTBEAT.custom_mode.
    pub number: u32,
    /// The mode of ours that is entered by it.
    pub mode: FlightMode,
    /// The request that enters it.
    pub request: AutopilotRequest,
    /// Flown in its place while it is armed and no sticks are there.
    pub unattended: Option<FlightMode>,
    /// It is shown only after it was asked for by its number.
    pub only_chosen: bool,
    /// Other modes of ours that clients see under the same number.
    pub covers: &'static [FlightMode],
    /// Display name.
    pub name: &'static str,
    /// The standard mode that it is.
    pub standard: MavStandardMode,
    /// HEARTBEAT.base_mode without the bit for armed motors.
    pub base: MavModeFlag,
    /// Flies by itself.
    pub auto: bool,
    /// Offered in menus.
    pub selectable: bool,
    /// Motors may be armed in it.
    pub armable: bool,
}

impl ModeRow {
    /// Shown for other modes of ours as well.
    const fn covering(mut self, modes: &'static [FlightMode]) -> Self {
        self.covers = modes;
        self
    }

    fn shows(&self, mode: FlightMode) -> bool {
        self.mode == mode || self.covers.contains(&mode)
    }
}

/// What a command or message that is not obeyed is answered.
#[derive(Debug, Clone, Copy)]
pub struct RefusalResults {
    /// Not now.
    pub for_now: MavResult,
    /// Not in this state.
    pub denied: MavResult,
    /// No such mode.
    pub no_mode: MavResult,
    /// REQUEST_MESSAGE of what is not spoken.
    pub message: MavResult,
    /// SET_MESSAGE_INTERVAL of what is not spoken.
    pub interval: MavResult,
}

/// Height over home at which a NAV_TAKEOFF ends, m (`None`: the parameter's), or its refusal.
pub type TakeOffHeight = fn(&VehicleCommand, &mut CommandContext) -> Result<Option<f64>, MavResult>;

/// One interface.
#[derive(Debug)]
pub struct Flavour {
    /// As on the command line.
    pub name: &'static str,
    /// HEARTBEAT.autopilot.
    pub autopilot: MavAutopilot,
    /// AUTOPILOT_VERSION.flight_sw_version.
    pub software_version: u32,
    /// AUTOPILOT_VERSION.capabilities.
    pub capabilities: MavProtocolCapability,
    /// All modes, in the order of AVAILABLE_MODES. Of several rows that show a mode of ours the first that enters it is its usual one.
    pub modes: &'static [ModeRow],
    /// Bits of a custom mode that name the mode.
    pub mode_bits: u32,
    /// The custom mode in parameters 2 and 3 of DO_SET_MODE.
    pub custom_mode: fn(f64, f64) -> u32,
    /// SET_MODE must say that it means a custom mode; otherwise it means something else (ArduPilot: the safety switch).
    pub custom_flag: bool,
    /// HEARTBEAT.system_status.
    pub state: fn(&VehicleSnapshot) -> MavState,
    /// Number of the mode in which go-to commands and external set-points are flown as they come; `None`: external set-points have a mode
    /// that is entered by itself, and a go-to may come in any.
    pub errands: Option<u32>,
    /// Reads NAV_TAKEOFF.
    pub take_off: TakeOffHeight,
    /// Numbers in COMPONENT_ARM_DISARM that force it.
    pub force: &'static [f64],
    /// The height of a place to look at, in a command, is over the sea whatever frame the command names.
    pub looks_over_sea: bool,
    /// Answers to what is not obeyed.
    pub refusals: RefusalResults,
    /// Begins each reason of a refused arming, one text each; `None`: the autopilot's words, in one.
    pub arm_words: Option<&'static str>,
    /// Begins each reason that RUN_PREARM_CHECKS tells.
    pub check_words: &'static str,
    /// A sensor that has failed or is back, as the autopilot announces it, with its severity; `None`: the event's own words.
    pub sensor_words: fn(SensorChange) -> Option<(MavSeverity, String)>,
    /// A refused change of mode in words.
    pub mode_words: fn(&ModeRow, String) -> String,
    /// Who it is, told with the parameters and by DO_SEND_BANNER; empty: nobody asks.
    pub banner: &'static [&'static str],
    /// Ground stations and SDKs get heartbeats alone until they ask for more.
    pub asks_first: bool,
    /// A message that REQUEST_MESSAGE asks for follows the acknowledgement; otherwise it goes before.
    pub answers_after_acknowledgement: bool,
    /// REQUEST_DATA_STREAM: groups and the messages in them.
    pub groups: &'static [(u8, &'static [u32])],
    /// Messages of ArduPilot's own dialect are spoken.
    pub dialect_of_ardupilot: bool,
    /// Whose texts report a calibration.
    pub calibration: CalibrationTexts,
    /// SERIAL_CONTROL opens a shell.
    pub shell: bool,
    /// Arming checks and health are reported as events.
    pub events: bool,
    /// Number of the mode that NAV_LOITER_UNLIM enters; `None`: the mode that holds.
    pub loiters: Option<u32>,
    /// Positions of set-points in frames that move with the vehicle count from where it is; otherwise they have no meaning.
    pub offsets: bool,
    /// DO_PAUSE_CONTINUE pauses what is flown; otherwise it ends in a hold.
    pub pauses: bool,
    /// EXTENDED_SYS_STATE.vtol_state.
    pub vtol_state: MavVtolState,
    /// NAV_SPLINE_WAYPOINT is taken in missions; it is flown as a waypoint.
    pub splines: bool,
    /// 0, 0 as a place in an item of a mission and in DO_SET_HOME is where the vehicle is then, and 0 as an item's height is its height.
    pub zero_is_here: bool,
    /// Item 0 of a mission is home.
    pub home_item: bool,
    /// MISSION_REQUEST is answered with MISSION_ITEM, and items of an upload are asked for by MISSION_REQUEST.
    pub float_items: bool,
    /// The parameters as clients see them.
    pub params: &'static ParamView,
    /// What the autopilot does otherwise.
    pub tune: fn(&mut Tuning),
}

impl Flavour {
    /// The row that clients see while `mode` is flown; `chosen` is the number of the row that was asked for last.
    #[must_use]
    pub fn row_of(&self, mode: FlightMode, chosen: u32) -> &'static ModeRow {
        let asked = self.modes.iter().find(|row| row.number == chosen && row.shows(mode));
        asked.unwrap_or_else(|| self.default_mode(mode))
    }

    /// The usual row of a mode.
    #[must_use]
    pub fn default_mode(&self, mode: FlightMode) -> &'static ModeRow {
        let enters = self.modes.iter().find(|row| row.mode == mode && !row.only_chosen);
        // Every mode is shown by some row: a test looks.
        enters.or_else(|| self.modes.iter().find(|row| row.shows(mode))).unwrap_or(&self.modes[0])
    }

    /// The row of a custom mode.
    #[must_use]
    pub fn row(&self, custom_mode: u32) -> Option<&'static ModeRow> {
        self.modes.iter().find(|row| row.number == custom_mode & self.mode_bits)
    }

    /// The row of a standard mode.
    #[must_use]
    pub fn standard(&self, number: u32) -> Option<&'static ModeRow> {
        self.modes.iter().find(|row| number != 0 && row.standard as u32 == number)
    }

    /// Enters a mode; `chosen` keeps which of the numbers that mean the same to us was asked for.
    pub fn enter(&self, row: &ModeRow, chosen: &mut u32, autopilot: &mut Autopilot, now: SimTime) -> RequestOutcome {
        let before = autopilot.status().mode;
        let from = self.row_of(before, *chosen).number;
        let unattended = row.unattended.filter(|_| autopilot.is_unattended(now));
        let request = unattended.map_or(row.request, AutopilotRequest::SetMode);
        let outcome = autopilot.request(request, now);
        if outcome != RequestOutcome::Accepted {
            return match outcome {
                RequestOutcome::TemporarilyRejected(why) => RequestOutcome::TemporarilyRejected((self.mode_words)(row, why)),
                RequestOutcome::Denied(why) => RequestOutcome::Denied((self.mode_words)(row, why)),
                RequestOutcome::Failed(why) => RequestOutcome::Failed((self.mode_words)(row, why)),
                other => other,
            };
        }
        *chosen = row.number;
        if before == FlightMode::Hold && autopilot.status().mode == FlightMode::Hold && from != row.number {
            // The same to the autopilot, which would fly on to the place of the mode before; refused on the ground, where nothing flies.
            autopilot.request(AutopilotRequest::GoTo { north_east_m: None, up_m: None, yaw_rad: None, speed_m_s: None }, now);
        }
        outcome
    }

    /// Whether a kind of link must ask for its streams.
    #[must_use]
    pub fn is_silent_until_asked(&self, kind: LinkKind) -> bool {
        self.asks_first && kind != LinkKind::Payload
    }
}

/// The interface of a name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Flavour> {
    [&px4::FLAVOUR, &ardupilot::FLAVOUR, &generic::FLAVOUR].into_iter().find(|flavour| flavour.name == name)
}

/// Capabilities that all flavours have.
const COMMON: MavProtocolCapability = {
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

/// Words as the autopilot has them.
fn named_mode(_: &ModeRow, why: String) -> String {
    why
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [FlightMode; 13] = [
        FlightMode::Stabilized,
        FlightMode::Altitude,
        FlightMode::Position,
        FlightMode::Hold,
        FlightMode::Takeoff,
        FlightMode::Land,
        FlightMode::Return,
        FlightMode::Mission,
        FlightMode::Offboard,
        FlightMode::Orbit,
        FlightMode::Acro,
        FlightMode::SmartReturn,
        FlightMode::Follow,
    ];

    #[test]
    fn exact_every_flavour_shows_every_mode_and_every_number_leads_back_to_its_row() {
        for flavour in ["px4", "ardupilot", "generic"].map(|name| named(name).unwrap()) {
            for mode in ALL {
                assert!(flavour.default_mode(mode).shows(mode), "{}: {mode:?}", flavour.name);
            }
            for row in flavour.modes {
                assert_eq!(flavour.row(row.number).unwrap().name, row.name);
                assert_eq!(flavour.row_of(row.mode, row.number).name, row.name, "as it was asked for");
            }
            assert!(flavour.standard(0).is_none() && flavour.standard(99).is_none());
        }
        assert!(named("PX4").is_none());
    }

    #[test]
    fn exact_guided_stays_guided_from_take_off_to_go_to_and_gives_way_to_the_pilot() {
        let copter = &ardupilot::FLAVOUR;
        for mode in [FlightMode::Hold, FlightMode::Takeoff, FlightMode::Offboard] {
            assert_eq!(copter.row_of(mode, 4).number, 4);
        }
        assert_eq!(copter.row_of(FlightMode::Position, 4).number, 5);
        assert_eq!(copter.row_of(FlightMode::Position, 16).number, 16);
        assert_eq!(copter.row_of(FlightMode::Hold, 3).number, 17, "a hold that nobody asked for is a brake");
        assert_eq!(copter.row_of(FlightMode::Hold, 5).number, 5, "LOITER holds without sticks");
        assert_eq!((copter.default_mode(FlightMode::Mission).number, copter.row_of(FlightMode::Mission, 27).number), (3, 27));
    }
}
