//! Behavior parameters with ArduPilot names that have no PX4 equivalent. Unless stated otherwise, ranges and defaults
//! are ArduCopter 4.6's.

use super::behavior;
use super::derived_rows::{mapped, scaled};
use super::param_value::ParamValue::{Int, Real};
use super::row::{ParamSource, Row, row};
use super::wire_types::{INT8, INT16, INT32, REAL32};

const BATTERY_ACTIONS: &[(i32, &str)] = &[
    (0, "None"),
    (1, "Land"),
    (2, "Return"),
    (3, "Smart return or return"),
    (4, "Smart return or land"),
    (5, "Terminate"),
    (6, "Mission landing or return"),
    (7, "Brake or land"),
];
const OFF_ON: &[(i32, &str)] = &[(0, "Disabled"), (1, "Enabled")];

/// The parameter rows, in any order.
pub(super) fn rows() -> Vec<Row> {
    [failsafes(), return_rows(), limits(), missions()].concat()
}

fn failsafes() -> Vec<Row> {
    let mut station = row("MAV_GCS_SYSID", Int(0), (0.0, 255.0), "", "MAV", STATION_ID_TEXT).wire(INT16);
    station.source = ParamSource::Scaled("SYSID_MYGCS", 1.0);
    vec![
        row("BATT_ARM_VOLT", Real(0.0), (0.0, 100.0), "V", "BATT", "Minimum voltage for arming; 0: disabled"),
        row("BATT_CRT_VOLT", Real(0.0), (0.0, 100.0), "V", "BATT", "Critical battery voltage; 0: disabled"),
        row("BATT_FS_CRT_ACT", Int(0), (0.0, 7.0), "", "BATT", "Critical battery action").wire(INT8).values(BATTERY_ACTIONS),
        row("BATT_FS_LOW_ACT", Int(0), (0.0, 7.0), "", "BATT", "Low battery action").wire(INT8).values(BATTERY_ACTIONS),
        row("BATT_LOW_TIMER", Int(10), (0.0, 120.0), "s", "BATT", "Time below the low voltage before the failsafe triggers")
            .wire(INT8),
        // ArduPilot's default of 10.5 V assumes three cells; this aircraft may have a different number.
        row("BATT_LOW_VOLT", Real(0.0), (0.0, 100.0), "V", "BATT", "Low battery voltage; 0: disabled"),
        row("FENCE_ALT_MIN", Real(-10.0), (-100.0, 100.0), "m", "FENCE", "Minimum height above home, if enabled in FENCE_TYPE"),
        row("FENCE_TYPE", Int(7), (0.0, 15.0), "", "FENCE", "Enabled fence types").wire(INT8).bits(&[
            (0, "Maximum height"),
            (1, "Circle around home"),
            (2, "Polygons and circles"),
            (3, "Minimum height"),
        ]),
        row("FS_CRASH_CHECK", Int(1), (0.0, 1.0), "", "FS", "Stop the motors after a crash").wire(INT8).values(OFF_ON),
        // The default is 2 instead of ArduPilot's 1, so that a trainee who loses GNSS under a bridge keeps manual
        // control.
        row("FS_EKF_ACTION", Int(2), (1.0, 3.0), "", "FS", "Position loss action in manual flight").wire(INT8).values(&[
            (1, "Land"),
            (2, "Altitude hold"),
            (3, "Land"),
        ]),
        // The default is 21 instead of ArduPilot's 16, because trainees put the controller down during automatic
        // flight.
        row("FS_OPTIONS", Int(21), (0.0, 63.0), "", "FS", "Failsafe exceptions").wire(INT32).bits(&[
            (0, "Continue in AUTO without manual control"),
            (1, "Continue in AUTO without a ground station"),
            (2, "Continue in GUIDED without manual control"),
            (3, "Continue landing"),
            (4, "Continue in manual modes without a ground station"),
            (5, "Open the gripper"),
        ]),
        row("FS_THR_VALUE", Int(975), (910.0, 1100.0), "us", "FS", "Throttle pulse width that signals manual control loss")
            .wire(INT16),
        station,
        row("SYSID_MYGCS", Int(0), (0.0, 255.0), "", "SYSID", STATION_ID_TEXT).wire(INT16),
    ]
}

/// The default is 0 instead of ArduPilot's 255, because the window and the instructor use other IDs.
const STATION_ID_TEXT: &str = "System ID of the ground station that may send stick input; 0: any";

fn return_rows() -> Vec<Row> {
    vec![
        row("RALLY_INCL_HOME", Int(1), (0.0, 1.0), "", "RALLY", "Include home in the rally point selection")
            .wire(INT8)
            .values(OFF_ON),
        row("RTL_ALT_FINAL", Int(0), (0.0, 1_000.0), "cm", "RTL", "Final height of the return; 0: land").wire(INT16),
        row("RTL_CLIMB_MIN", Int(0), (0.0, 3_000.0), "cm", "RTL", "Minimum climb before a return").wire(INT16),
        // Off by default (ArduPilot: 3), because a return near a bridge must climb clear of it first.
        row("RTL_CONE_SLOPE", Real(0.0), (0.0, 10.0), "", "RTL", "Slope of the cone that limits the return climb; 0: off"),
        row("RTL_LOIT_TIME", Int(5_000), (0.0, 60_000.0), "ms", "RTL", "Loiter time above home before descent").wire(INT32),
        row("RTL_SPEED", Int(0), (0.0, 2_000.0), "cm/s", "RTL", "Return speed; 0: WPNAV_SPEED").wire(INT16),
    ]
}

fn limits() -> Vec<Row> {
    vec![
        scaled("ANGLE_MAX", "MPC_MAN_TILT_MAX", 100.0, INT16, "cdeg", "ANGLE"),
        mapped(
            "EK3_SRC1_POSZ",
            "EKF2_HGT_REF",
            &[(1, 0), (2, 2), (3, 1), (6, 3)],
            &[(1, "Barometer"), (2, "Range finder"), (3, "GNSS"), (6, "External navigation")],
            "EK3",
        ),
        scaled("LAND_ALT_LOW", "MPC_LAND_ALT2", 100.0, INT16, "cm", "LAND"),
        row("LAND_SPEED_HIGH", Int(0), (0.0, 500.0), "cm/s", "LAND", "Descent speed above LAND_ALT_LOW; 0: WPNAV_SPEED_DN")
            .wire(INT16),
        scaled("LOIT_SPEED", "MPC_VEL_MANUAL", 100.0, REAL32, "cm/s", "LOIT"),
        row("PILOT_SPEED_DN", Int(0), (0.0, 2_000.0), "cm/s", "PILOT", "Maximum manual descent speed; 0: PILOT_SPEED_UP")
            .wire(INT16),
        row("PILOT_SPEED_UP", Int(250), (50.0, 2_000.0), "cm/s", "PILOT", "Maximum manual climb speed").wire(INT16),
        scaled("PILOT_Y_RATE", "MPC_MAN_Y_MAX", 1.0, REAL32, "deg/s", "PILOT"),
        scaled("WPNAV_ACCEL", "MPC_ACC_HOR", 100.0, REAL32, "cm/s/s", "WPNAV"),
        scaled("WPNAV_ACCEL_Z", "MPC_ACC_UP_MAX", 100.0, REAL32, "cm/s/s", "WPNAV"),
        row("WP_YAW_BEHAVIOR", Int(2), (0.0, 3.0), "", "WP", "Heading in automatic modes").wire(INT8).values(&[
            (0, "Fixed"),
            (1, "Toward the waypoint"),
            (2, "Toward the waypoint, fixed during return"),
            (3, "Along the path"),
        ]),
    ]
}

fn missions() -> Vec<Row> {
    let count =
        |name, group, short| row(name, Int(0), (0.0, 32_766.0), "", group, short).wire(INT16).read_only().volatile().token();
    vec![
        row("AUTO_OPTIONS", Int(0), (0.0, 255.0), "", "AUTO", "AUTO mode options").wire(INT32).bits(&[
            (0, "Allow arming"),
            (1, "Take off without raising the throttle"),
            (2, "Ignore the yaw stick"),
            (7, "Allow weathervaning"),
        ]),
        count("FENCE_TOTAL", "FENCE", "Number of fence items"),
        row("MIS_RESTART", Int(0), (0.0, 1.0), "", "MIS", "Mission behavior on entering AUTO")
            .wire(INT8)
            .values(&[(0, "Resume"), (1, "Restart")]),
        count("MIS_TOTAL", "MIS", "Number of mission items, including home"),
        count("RALLY_TOTAL", "RALLY", "Number of rally points"),
    ]
}

/// Checks whether a row's default depends on the aircraft.
pub(super) fn depends_on_aircraft(row: &Row) -> bool {
    match row.source {
        ParamSource::Capacity(_) => true,
        ParamSource::Scaled(other, _) => behavior::FRAME.contains(&other),
        ParamSource::Own | ParamSource::Mapped(..) => behavior::FRAME.contains(&row.name),
    }
}
