//! Behavior under ArduPilot's names where PX4 has no parameter that means the same. Ranges and defaults are ArduCopter 4.6's where no reason is given.

use super::ParamValue::{Int, Real};
use super::behavior;
use super::copter::{INT8, INT16, INT32, REAL32, mapped, scaled};
use super::table::{ParamSource, Row, row};

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

/// Rows, in any order.
pub(super) fn rows() -> Vec<Row> {
    [failsafes(), returning(), limits(), missions()].concat()
}

fn failsafes() -> Vec<Row> {
    let mut station = row("MAV_GCS_SYSID", Int(0), (0.0, 255.0), "", "MAV", STATION).wire(INT16);
    station.source = ParamSource::Scaled("SYSID_MYGCS", 1.0);
    vec![
        row("BATT_ARM_VOLT", Real(0.0), (0.0, 100.0), "V", "BATT", "Voltage needed for arming; 0: none"),
        row("BATT_CRT_VOLT", Real(0.0), (0.0, 100.0), "V", "BATT", "Voltage that counts as critical; 0: none"),
        row("BATT_FS_CRT_ACT", Int(0), (0.0, 7.0), "", "BATT", "Action on a critical battery").wire(INT8).values(BATTERY_ACTIONS),
        row("BATT_FS_LOW_ACT", Int(0), (0.0, 7.0), "", "BATT", "Action on a low battery").wire(INT8).values(BATTERY_ACTIONS),
        row("BATT_LOW_TIMER", Int(10), (0.0, 120.0), "s", "BATT", "Time below a voltage until it counts").wire(INT8),
        // ArduPilot's 10.5 V is that of three cells; this aircraft may have another number.
        row("BATT_LOW_VOLT", Real(0.0), (0.0, 100.0), "V", "BATT", "Voltage that counts as low; 0: none"),
        row("FENCE_ALT_MIN", Real(-10.0), (-100.0, 100.0), "m", "FENCE", "Lowest over home, where FENCE_TYPE has it"),
        row("FENCE_TYPE", Int(7), (0.0, 15.0), "", "FENCE", "Parts of the fence that act").wire(INT8).bits(&[
            (0, "Greatest height"),
            (1, "Circle around home"),
            (2, "Areas"),
            (3, "Least height"),
        ]),
        row("FS_CRASH_CHECK", Int(1), (0.0, 1.0), "", "FS", "Motors stop after a crash").wire(INT8).values(OFF_ON),
        // 2 by default, where ArduPilot has 1: a trainee whose GNSS fails under a bridge keeps the sticks.
        row("FS_EKF_ACTION", Int(2), (1.0, 3.0), "", "FS", "Action when a pilot loses the position").wire(INT8).values(&[
            (1, "Land"),
            (2, "Altitude hold"),
            (3, "Land"),
        ]),
        // 21 by default, where ArduPilot has 16: trainees put the controller down while the vehicle flies by itself.
        row("FS_OPTIONS", Int(21), (0.0, 63.0), "", "FS", "Where failsafes change nothing").wire(INT32).bits(&[
            (0, "Auto continues without sticks"),
            (1, "Auto continues without ground station"),
            (2, "Guided continues without sticks"),
            (3, "A landing continues"),
            (4, "Stick modes continue without ground station"),
            (5, "The gripper opens"),
        ]),
        row("FS_THR_VALUE", Int(975), (910.0, 1100.0), "us", "FS", "Throttle pulse below which manual control counts as lost")
            .wire(INT16),
        station,
        row("SYSID_MYGCS", Int(0), (0.0, 255.0), "", "SYSID", STATION).wire(INT16),
    ]
}

/// 0 by default, where ArduPilot has 255: window and instructor fly under other ids.
const STATION: &str = "System that may send sticks and counts as ground station; 0: any";

fn returning() -> Vec<Row> {
    vec![
        row("RALLY_INCL_HOME", Int(1), (0.0, 1.0), "", "RALLY", "A return may go home instead of to a rally point")
            .wire(INT8)
            .values(OFF_ON),
        row("RTL_ALT_FINAL", Int(0), (0.0, 1_000.0), "cm", "RTL", "Height at which a return stays; 0: it lands").wire(INT16),
        row("RTL_CLIMB_MIN", Int(0), (0.0, 3_000.0), "cm", "RTL", "Least climb of a return").wire(INT16),
        // Off by default, where ArduPilot has 3: next to a bridge a return first climbs clear of it.
        row(
            "RTL_CONE_SLOPE",
            Real(0.0),
            (0.0, 10.0),
            "",
            "RTL",
            "Height over distance within which a return climbs less; 0: none",
        ),
        row("RTL_LOIT_TIME", Int(5_000), (0.0, 60_000.0), "ms", "RTL", "Wait over home before the descent").wire(INT32),
        row("RTL_SPEED", Int(0), (0.0, 2_000.0), "cm/s", "RTL", "Speed of a return; 0: WPNAV_SPEED").wire(INT16),
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
        row("LAND_SPEED_HIGH", Int(0), (0.0, 500.0), "cm/s", "LAND", "Descent above LAND_ALT_LOW; 0: WPNAV_SPEED_DN").wire(INT16),
        scaled("LOIT_SPEED", "MPC_VEL_MANUAL", 100.0, REAL32, "cm/s", "LOIT"),
        row("PILOT_SPEED_DN", Int(0), (0.0, 2_000.0), "cm/s", "PILOT", "Largest descent by the stick; 0: as PILOT_SPEED_UP")
            .wire(INT16),
        row("PILOT_SPEED_UP", Int(250), (50.0, 2_000.0), "cm/s", "PILOT", "Largest climb by the stick").wire(INT16),
        scaled("PILOT_Y_RATE", "MPC_MAN_Y_MAX", 1.0, REAL32, "deg/s", "PILOT"),
        scaled("WPNAV_ACCEL", "MPC_ACC_HOR", 100.0, REAL32, "cm/s/s", "WPNAV"),
        scaled("WPNAV_ACCEL_Z", "MPC_ACC_UP_MAX", 100.0, REAL32, "cm/s/s", "WPNAV"),
        row("WP_YAW_BEHAVIOR", Int(2), (0.0, 3.0), "", "WP", "Heading in automatic modes").wire(INT8).values(&[
            (0, "Fixed"),
            (1, "To the waypoint"),
            (2, "To the waypoint, fixed on the way home"),
            (3, "Along the path"),
        ]),
    ]
}

fn missions() -> Vec<Row> {
    let count =
        |name, group, short| row(name, Int(0), (0.0, 32_766.0), "", group, short).wire(INT16).read_only().volatile().token();
    vec![
        row("AUTO_OPTIONS", Int(0), (0.0, 255.0), "", "AUTO", "Options of the mode AUTO").wire(INT32).bits(&[
            (0, "Arming is allowed"),
            (1, "Takes off without raised throttle"),
            (2, "The yaw stick is ignored"),
            (7, "Weathervaning is allowed"),
        ]),
        count("FENCE_TOTAL", "FENCE", "Number of fence items"),
        row("MIS_RESTART", Int(0), (0.0, 1.0), "", "MIS", "What entering AUTO does to the mission")
            .wire(INT8)
            .values(&[(0, "Resume"), (1, "Restart")]),
        count("MIS_TOTAL", "MIS", "Number of mission items, home counted"),
        count("RALLY_TOTAL", "RALLY", "Number of rally points"),
    ]
}

/// Whether a row's default follows from the aircraft.
pub(super) fn depends_on_aircraft(row: &Row) -> bool {
    match row.source {
        ParamSource::Capacity(_) => true,
        ParamSource::Scaled(other, _) => behavior::FRAME.contains(&other),
        ParamSource::Own | ParamSource::Mapped(..) => behavior::FRAME.contains(&row.name),
    }
}
