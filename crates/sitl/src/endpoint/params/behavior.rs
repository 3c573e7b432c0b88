//! Parameters of behavior under PX4's names: reactions to failures, the way home, limits, missions. Ranges and defaults are PX4's
//! (PX4ParameterFactMetaData.xml of QGroundControl 5.0.1) where no reason is given. The autopilot's `OperatorRules` say what each does.

use super::ParamValue::{self, Int, Real};
use super::table::{Row, row};

const COMMANDER: &str = "Commander";
const CONTROL: &str = "Multicopter Position Control";
const MISSION: &str = "Mission";
const RETURN: &str = "Return Mode";

/// The modes of a switch position, by PX4's numbers.
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

/// Their defaults are the aircraft's own limits, so that no aircraft is held back before an operator says so.
pub(super) const FRAME: [&str; 7] = [
    "MPC_ACC_DOWN_MAX",
    "MPC_ACC_HOR",
    "MPC_ACC_UP_MAX",
    "MPC_MAN_TILT_MAX",
    "MPC_MAN_Y_MAX",
    "MPC_VEL_MANUAL",
    "PILOT_SPEED_UP",
];

const fn slot(name: &'static str, short: &'static str) -> Row {
    // No radio is connected: the switch is never moved.
    row(name, Int(-1), (-1.0, 107.0), "", COMMANDER, short).values(FLIGHT_MODES).token()
}

/// Rows, in any order.
pub(super) const ROWS: &[Row] = &[
    row("BAT_EMERGEN_THR", Real(0.05), (0.0, 0.5), "norm", "Battery", "Charge that counts as an emergency"),
    row("COM_ACT_FAIL_ACT", Int(0), (0.0, 4.0), "", COMMANDER, "Action when a motor has failed").values(&[
        (0, "Warning only"),
        (1, "Hold mode"),
        (2, "Land mode"),
        (3, "Return mode"),
        (4, "Terminate"),
    ]),
    row("COM_ARM_BAT_MIN", Real(-1.0), (-1.0, 0.9), "norm", COMMANDER, "Charge needed for arming; negative: the critical one"),
    row("COM_ARM_MIS_REQ", Int(0), (0.0, 1.0), "", COMMANDER, "Arming needs a mission").values(OFF_ON),
    row("COM_DLL_EXCEPT", Int(0), (0.0, 7.0), "", COMMANDER, "Modes in which a lost ground station changes nothing")
        .bits(LINK_BITS),
    row("COM_FAIL_ACT_T", Real(5.0), (0.0, 25.0), "s", COMMANDER, "Hold between lost manual control and its action"),
    slot("COM_FLTMODE1", "Mode of the first switch position"),
    slot("COM_FLTMODE2", "Mode of the second switch position"),
    slot("COM_FLTMODE3", "Mode of the third switch position"),
    slot("COM_FLTMODE4", "Mode of the fourth switch position"),
    slot("COM_FLTMODE5", "Mode of the fifth switch position"),
    slot("COM_FLTMODE6", "Mode of the sixth switch position"),
    // 1 is free in PX4; it is the rule of a job, and its default.
    row("COM_LOW_BAT_ACT", Int(0), (0.0, 3.0), "", COMMANDER, "Action on a low battery").values(&[
        (0, "Warning"),
        (1, "Return when low, land when critical"),
        (2, "Land when critical"),
        (3, "Return when critical, land in an emergency"),
    ]),
    row("COM_OBL_RC_ACT", Int(0), (0.0, 7.0), "", COMMANDER, "Action when external set-points are lost").values(&[
        (0, "Position mode"),
        (1, "Altitude mode"),
        (2, "Stabilized"),
        (3, "Return mode"),
        (4, "Land mode"),
        (5, "Hold mode"),
        (6, "Terminate"),
        (7, "Disarm"),
    ]),
    row("COM_POSCTL_NAVL", Int(0), (0.0, 1.0), "", COMMANDER, "Action when a pilot loses the position")
        .values(&[(0, "Altitude mode"), (1, "Land mode")]),
    // 7 by default, where PX4 has 0: trainees put the controller down while the vehicle flies by itself.
    row("COM_RCL_EXCEPT", Int(7), (0.0, 31.0), "", COMMANDER, "Modes in which lost manual control changes nothing")
        .bits(LINK_BITS),
    row("COM_RC_OVERRIDE", Int(1), (0.0, 3.0), "", COMMANDER, "Modes in which moved sticks take over")
        .bits(&[(0, "Automatic modes"), (1, "Offboard")]),
    row("COM_RC_STICK_OV", Real(30.0), (5.0, 80.0), "%", COMMANDER, "Travel of a stick that takes over"),
    row("FD_ACT_EN", Int(1), (0.0, 1.0), "", "Failure Detector", "A failed motor leads to COM_ACT_FAIL_ACT").values(OFF_ON),
    row("EKF2_HGT_REF", Int(1), (0.0, 3.0), "", "Estimator", "Sensor whose slow changes the height follows").values(&[
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
        "Time without GNSS and optical flow until the position is lost",
    ),
    row("MIS_DIST_1WP", Real(10_000.0), (-1.0, 100_000.0), "m", MISSION, "Farthest first waypoint from home; not above 0: any"),
    row("MIS_TKO_LAND_REQ", Int(0), (0.0, 4.0), "", MISSION, "What a mission must have").values(&[
        (0, "Nothing"),
        (1, "A take-off"),
        (2, "A landing"),
        (3, "A take-off and a landing"),
        (4, "Both or neither"),
    ]),
    row(
        "MPC_ACC_DOWN_MAX",
        Real(3.0),
        (0.5, 15.0),
        "m/s^2",
        CONTROL,
        "Vertical acceleration; the smaller of this and MPC_ACC_UP_MAX",
    ),
    row("MPC_ACC_HOR", Real(3.0), (0.5, 15.0), "m/s^2", CONTROL, "Horizontal acceleration in automatic modes"),
    row("MPC_ACC_UP_MAX", Real(4.0), (0.5, 15.0), "m/s^2", CONTROL, "Vertical acceleration in automatic modes"),
    row("MPC_LAND_ALT2", Real(5.0), (0.0, 122.0), "m", CONTROL, "Height below which a landing is slow"),
    row("MPC_MAN_TILT_MAX", Real(35.0), (1.0, 70.0), "deg", CONTROL, "Largest tilt by the sticks"),
    row("MPC_MAN_Y_MAX", Real(150.0), (0.0, 400.0), "deg/s", CONTROL, "Largest yaw rate by the stick"),
    row("MPC_VEL_MANUAL", Real(10.0), (0.5, 30.0), "m/s", CONTROL, "Largest horizontal speed by the sticks"),
    row("MPC_YAW_MODE", Int(0), (0.0, 5.0), "", MISSION, "Heading in automatic modes").values(&[
        (0, "To the waypoint"),
        (1, "To home"),
        (2, "Away from home"),
        (3, "Along the path"),
        (4, "To the waypoint, turning first"),
        (5, "Fixed"),
    ]),
    row("MPC_Z_V_AUTO_DN", Real(1.5), (0.3, 10.0), "m/s", CONTROL, "Descent in automatic modes"),
    row("MPC_Z_V_AUTO_UP", Real(3.0), (0.3, 15.0), "m/s", CONTROL, "Climb in automatic modes"),
    // Off by default, where PX4 has 45 degrees: next to a bridge a return first climbs clear of it.
    row("RTL_CONE_ANG", Int(0), (0.0, 90.0), "deg", RETURN, "Half-angle of the cone within which a return climbs less; 0: none"),
    row("RTL_DESCEND_ALT", Real(10.0), (0.0, 500.0), "m", RETURN, "Height at which a return waits before it lands"),
    row("RTL_LAND_DELAY", Real(0.0), (-1.0, 300.0), "s", RETURN, "Wait before a return lands; negative: it stays"),
    row("RTL_MIN_DIST", Real(5.0), (0.5, 1_000.0), "m", RETURN, "A return from nearer than this does not climb"),
    row("RTL_TYPE", Int(0), (0.0, 5.0), "", RETURN, "Where a return goes, on a straight way").values(&[
        (0, "Home or a rally point, whichever is nearest"),
        (1, "Mission landing or rally point, else home"),
        (2, "Mission landing, else home"),
        (3, "Home, mission landing or rally point"),
        (4, "Mission landing, else home, as 2"),
        (5, "Rally point, else home"),
    ]),
];

/// The defaults that follow from the aircraft, rounded up to what the wire carries.
pub(super) fn frame_defaults(frame: &crate::autopilot::operator_rules::FlightEnvelope) -> [(&'static str, ParamValue); 7] {
    let up = |value: f64, low: f64, high: f64| Real((((value * 100.0).ceil() / 100.0) as f32).clamp(low as f32, high as f32));
    let vertical = up(frame.climb_acceleration_m_s2, 0.5, 15.0);
    [
        ("MPC_ACC_DOWN_MAX", vertical),
        ("MPC_ACC_HOR", up(frame.acceleration_m_s2, 0.5, 15.0)),
        ("MPC_ACC_UP_MAX", vertical),
        ("MPC_MAN_TILT_MAX", up(frame.manual_tilt_rad.to_degrees(), 1.0, 70.0)),
        ("MPC_MAN_Y_MAX", up(frame.manual_yaw_rad_s.to_degrees(), 0.0, 400.0)),
        ("MPC_VEL_MANUAL", up(frame.manual_m_s, 0.5, 30.0)),
        ("PILOT_SPEED_UP", Int((100.0 * frame.manual_up_m_s).ceil().clamp(50.0, 2_000.0) as i32)),
    ]
}
