//! PX4 behavior parameters: failsafe actions, returns, limits, and missions. Unless stated otherwise, ranges and
//! defaults are PX4's (PX4ParameterFactMetaData.xml of QGroundControl 5.0.1). The autopilot's `OperatorRules` documents
//! the effects.

use super::param_value::ParamValue::{self, Int, Real};
use super::row::{Row, row};

const COMMANDER: &str = "Commander";
const CONTROL: &str = "Multicopter Position Control";
const MISSION: &str = "Mission";
const RETURN: &str = "Return Mode";

/// Modes that a switch position can select, with PX4's numbers.
const FLIGHT_MODES: &[(i32, &str)] = &[
    (-1, "Unassigned"),
    (0, "Manual"),
    (1, "Altitude"),
    (2, "Position"),
    (3, "Mission"),
    (4, "Hold"),
    (5, "Return"),
    (6, "Acro"),
    (7, "Offboard"),
    (8, "Stabilized"),
    (9, "Position slow"),
    (10, "Takeoff"),
    (11, "Land"),
    (12, "Follow me"),
    (13, "Precision land"),
];
const LINK_BITS: &[(i32, &str)] = &[(0, "Mission"), (1, "Hold"), (2, "Offboard")];
const OFF_ON: &[(i32, &str)] = &[(0, "Disabled"), (1, "Enabled")];

/// Parameters that default to the aircraft's own limits, so they restrict no aircraft until an operator sets them.
pub(super) const FRAME: [&str; 7] = [
    "MPC_ACC_DOWN_MAX",
    "MPC_ACC_HOR",
    "MPC_ACC_UP_MAX",
    "MPC_MAN_TILT_MAX",
    "MPC_MAN_Y_MAX",
    "MPC_VEL_MANUAL",
    "PILOT_SPEED_UP",
];

const fn mode_switch_row(name: &'static str, short: &'static str) -> Row {
    // No radio is connected, so the switch never moves.
    row(name, Int(-1), (-1.0, 107.0), "", COMMANDER, short).values(FLIGHT_MODES).token()
}

/// The parameter rows, in any order.
pub(super) const ROWS: &[Row] = &[
    row("BAT_EMERGEN_THR", Real(0.05), (0.0, 0.5), "norm", "Battery", "Emergency battery level"),
    row("COM_ACT_FAIL_ACT", Int(0), (0.0, 4.0), "", COMMANDER, "Motor failure action").values(&[
        (0, "Warning only"),
        (1, "Hold mode"),
        (2, "Land mode"),
        (3, "Return mode"),
        (4, "Terminate"),
    ]),
    row(
        "COM_ARM_BAT_MIN",
        Real(-1.0),
        (-1.0, 0.9),
        "norm",
        COMMANDER,
        "Minimum battery level for arming; negative: critical level",
    ),
    row("COM_ARM_MIS_REQ", Int(0), (0.0, 1.0), "", COMMANDER, "Require a mission for arming").values(OFF_ON),
    row("COM_DLL_EXCEPT", Int(0), (0.0, 7.0), "", COMMANDER, "Modes exempt from the ground station loss failsafe")
        .bits(LINK_BITS),
    row("COM_FAIL_ACT_T", Real(5.0), (0.0, 25.0), "s", COMMANDER, "Hold time before the failsafe action"),
    mode_switch_row("COM_FLTMODE1", "Mode at switch position 1"),
    mode_switch_row("COM_FLTMODE2", "Mode at switch position 2"),
    mode_switch_row("COM_FLTMODE3", "Mode at switch position 3"),
    mode_switch_row("COM_FLTMODE4", "Mode at switch position 4"),
    mode_switch_row("COM_FLTMODE5", "Mode at switch position 5"),
    mode_switch_row("COM_FLTMODE6", "Mode at switch position 6"),
    // Value 1 is unused in PX4. Here it is the default for jobs whose rules return the vehicle when the battery is low.
    row("COM_LOW_BAT_ACT", Int(0), (0.0, 3.0), "", COMMANDER, "Low battery action").values(&[
        (0, "Warning"),
        (1, "Return when low, land when critical"),
        (2, "Land when critical"),
        (3, "Return when critical, land in an emergency"),
    ]),
    row("COM_OBL_RC_ACT", Int(0), (0.0, 7.0), "", COMMANDER, "Offboard setpoint loss action").values(&[
        (0, "Position mode"),
        (1, "Altitude mode"),
        (2, "Stabilized"),
        (3, "Return mode"),
        (4, "Land mode"),
        (5, "Hold mode"),
        (6, "Terminate"),
        (7, "Disarm"),
    ]),
    row("COM_POSCTL_NAVL", Int(0), (0.0, 1.0), "", COMMANDER, "Position loss action in manual flight")
        .values(&[(0, "Altitude mode"), (1, "Land mode")]),
    // The default is 7 instead of PX4's 0, because trainees put the controller down during automatic flight.
    row("COM_RCL_EXCEPT", Int(7), (0.0, 31.0), "", COMMANDER, "Modes exempt from the manual control loss failsafe")
        .bits(LINK_BITS),
    row("COM_RC_OVERRIDE", Int(1), (0.0, 3.0), "", COMMANDER, "Modes that stick movement can interrupt")
        .bits(&[(0, "Automatic modes"), (1, "Offboard")]),
    row("COM_RC_STICK_OV", Real(30.0), (5.0, 80.0), "%", COMMANDER, "Stick deflection that triggers a pilot takeover"),
    row("FD_ACT_EN", Int(1), (0.0, 1.0), "", "Failure Detector", "Trigger COM_ACT_FAIL_ACT on motor failure").values(OFF_ON),
    row("EKF2_HGT_REF", Int(1), (0.0, 3.0), "", "Estimator", "Height reference sensor").values(&[
        (0, "Barometer"),
        (1, "GNSS"),
        (2, "Range sensor"),
        (3, "Vision"),
    ]),
    row(
        "EKF2_NOAID_TOUT",
        Int(60_000_000),
        (500_000.0, 60_000_000.0),
        "us",
        "Estimator",
        "Time without GNSS and optical flow before position loss",
    ),
    row(
        "MIS_DIST_1WP",
        Real(10_000.0),
        (-1.0, 100_000.0),
        "m",
        MISSION,
        "Maximum distance from home to the first waypoint; 0 or less: no limit",
    ),
    row("MIS_TKO_LAND_REQ", Int(0), (0.0, 4.0), "", MISSION, "Required mission items").values(&[
        (0, "Nothing"),
        (1, "Takeoff"),
        (2, "Landing"),
        (3, "Takeoff and landing"),
        (4, "Both or neither"),
    ]),
    row(
        "MPC_ACC_DOWN_MAX",
        Real(3.0),
        (0.5, 15.0),
        "m/s^2",
        CONTROL,
        "Maximum vertical acceleration; the smaller of this and MPC_ACC_UP_MAX applies",
    ),
    row("MPC_ACC_HOR", Real(3.0), (0.5, 15.0), "m/s^2", CONTROL, "Maximum horizontal acceleration in automatic modes"),
    row("MPC_ACC_UP_MAX", Real(4.0), (0.5, 15.0), "m/s^2", CONTROL, "Maximum vertical acceleration in automatic modes"),
    row("MPC_LAND_ALT2", Real(5.0), (0.0, 122.0), "m", CONTROL, "Height below which the landing descent is slower"),
    row("MPC_MAN_TILT_MAX", Real(35.0), (1.0, 70.0), "deg", CONTROL, "Maximum tilt in manual modes"),
    row("MPC_MAN_Y_MAX", Real(150.0), (0.0, 400.0), "deg/s", CONTROL, "Maximum yaw rate in manual modes"),
    row("MPC_VEL_MANUAL", Real(10.0), (0.5, 30.0), "m/s", CONTROL, "Maximum horizontal speed in manual modes"),
    row("MPC_YAW_MODE", Int(0), (0.0, 5.0), "", MISSION, "Heading in automatic modes").values(&[
        (0, "Toward the waypoint"),
        (1, "Toward home"),
        (2, "Away from home"),
        (3, "Along the path"),
        (4, "Toward the waypoint, turning first"),
        (5, "Fixed"),
    ]),
    row("MPC_Z_V_AUTO_DN", Real(1.5), (0.3, 10.0), "m/s", CONTROL, "Descent speed in automatic modes"),
    row("MPC_Z_V_AUTO_UP", Real(3.0), (0.3, 15.0), "m/s", CONTROL, "Climb speed in automatic modes"),
    // Off by default (PX4: 45 degrees), because a return near a bridge must climb clear of it first.
    row("RTL_CONE_ANG", Int(0), (0.0, 90.0), "deg", RETURN, "Half-angle of the cone that limits the return climb; 0: off"),
    row("RTL_DESCEND_ALT", Real(10.0), (0.0, 500.0), "m", RETURN, "Loiter height before a return landing"),
    row("RTL_LAND_DELAY", Real(0.0), (-1.0, 300.0), "s", RETURN, "Delay before a return landing; negative: no landing"),
    row("RTL_MIN_DIST", Real(5.0), (0.5, 1_000.0), "m", RETURN, "Distance from home above which a return climbs first"),
    row("RTL_TYPE", Int(0), (0.0, 5.0), "", RETURN, "Return destination (flown to in a straight line)").values(&[
        (0, "Home or a rally point, whichever is nearest"),
        (1, "Mission landing or rally point, else home"),
        (2, "Mission landing, else home"),
        (3, "Home, mission landing or rally point"),
        (4, "Mission landing, else home (same as 2)"),
        (5, "Rally point, else home"),
    ]),
];

/// Returns the defaults derived from the aircraft, rounded up to the precision of the wire format.
pub(super) fn frame_defaults(frame: &crate::autopilot::operator_rules::FlightEnvelope) -> [(&'static str, ParamValue); 7] {
    let up = |value: f64, low: f64, high: f64| Real((((value * 100.0).ceil() / 100.0) as f32).clamp(low as f32, high as f32));
    let vertical = up(frame.climb_acceleration_m_s2, 0.5, 15.0);
    [
        ("MPC_ACC_DOWN_MAX", vertical),
        ("MPC_ACC_HOR", up(frame.acceleration_m_s2, 0.5, 15.0)),
        ("MPC_ACC_UP_MAX", vertical),
        ("MPC_MAN_TILT_MAX", up(frame.manual_tilt_rad.to_degrees(), 1.0, 70.0)),
        ("MPC_MAN_Y_MAX", up(frame.manual_yaw_rate_rad_s.to_degrees(), 0.0, 400.0)),
        ("MPC_VEL_MANUAL", up(frame.manual_speed_m_s, 0.5, 30.0)),
        ("PILOT_SPEED_UP", Int((100.0 * frame.manual_climb_rate_m_s).ceil().clamp(50.0, 2_000.0) as i32)),
    ]
}
