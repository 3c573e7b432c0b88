//! Parameter names that clients expect from ArduCopter (docs/src/reference/wire.md, "Parameters"; source code of
//! QGroundControl and MAVProxy), with ArduPilot's units and values. Parameters that correspond to an internal parameter
//! take effect. The others describe the vehicle and are read-only.

use super::derived_rows::{mapped, scaled};
use super::param_value::ParamValue::{self, Int, Real};
use super::row::{ParamSource, Row, row};
use super::table::{CHANNELS, ROWS};
use super::wire_types::{INT8, INT16, INT32, REAL32};
use super::{behavior, copter_behavior, stored};
use spandrel_mavlink::contract::stick_request;
use spandrel_mavlink::dialect::MavParamType;
use std::sync::LazyLock;

/// Timeouts that differ from this software's defaults: overrides time out after 3 s, the ground station after 5 s.
pub const DEFAULTS: &[(&str, ParamValue)] = &[("COM_RC_LOSS_T", Real(3.0)), ("COM_DL_LOSS_T", Int(5))];

const LOSS_VALUES: &[(i32, &str)] = &[(0, "Disabled"), (1, "Return"), (5, "Land"), (7, "Brake")];
/// ArduPilot's link loss actions, and the corresponding internal actions.
const LOSS_ACTIONS: &[(i32, i32)] = &[(0, 0), (1, 2), (5, 3), (7, 1)];
const STICK_LOSS_VALUES: &[(i32, &str)] = &[(1, "Return"), (3, "Land"), (7, "Brake")];
const STICK_LOSS_ACTIONS: &[(i32, i32)] = &[(1, 2), (3, 3), (7, 1)];
const FENCE_VALUES: &[(i32, &str)] = &[(0, "Report only"), (1, "Return"), (2, "Land"), (4, "Brake")];
/// Breach actions. The internal terminate and warn actions have no equivalent here.
const FENCE_ACTIONS: &[(i32, i32)] = &[(0, 1), (1, 3), (2, 5), (4, 2)];
const OFF_ON: &[(i32, &str)] = &[(0, "Disabled"), (1, "Enabled")];
const FIXED_VALUE: &[(i32, &str)] = &[(1, "Fixed")];

/// Returns the rows, sorted by name.
#[must_use]
pub fn rows() -> &'static [Row] {
    static ALL: LazyLock<Vec<Row>> = LazyLock::new(|| {
        let shared = ROWS.iter().chain(behavior::ROWS);
        let shared = shared.filter(|row| matches!(row.group, "Simulation" | "Joystick") || OWN_NAMES.contains(&row.name));
        let mut all: Vec<Row> = [
            active_rows(),
            copter_behavior::rows(),
            read_only_rows(),
            rc_channel_rows(),
            circle_and_follow_rows(),
            mode_switch(),
        ]
        .concat();
        all.extend(shared.copied());
        stored::fill_missing(all, stored::COPTER)
    });
    &ALL
}

/// This software's own parameters, with unchanged names.
const OWN_NAMES: [&str; 5] = ["COM_RC_OVERRIDE", "SPAN_CAMERA", "SPAN_FLAVOUR", stick_request::PARAMETER, "SYS_FAILURE_EN"];

/// Creates a read-only row that describes the vehicle.
fn read_only_row(name: &'static str, value: ParamValue, wire: MavParamType, group: &'static str, short: &'static str) -> Row {
    let number = value.number();
    let mut out = row(name, value, (number.min(0.0), number.max(0.0)), "", group, short).read_only().token();
    out.wire = wire;
    out
}

/// Returns the rows that take effect.
fn active_rows() -> Vec<Row> {
    let of_capacity = |name, other, short| {
        let mut out = row(name, Real(0.0), (0.0, 0.0), "mAh", "BATT", short);
        out.source = ParamSource::Capacity(other);
        out
    };
    let enable = |name, group, short| {
        let mut out = row(name, Int(1), (0.0, 1.0), "", group, short).values(OFF_ON);
        out.wire = INT8;
        out
    };
    vec![
        of_capacity("BATT_CRT_MAH", "BAT_CRIT_THR", "Critical battery level (remaining charge)"),
        of_capacity("BATT_LOW_MAH", "BAT_LOW_THR", "Low battery level (remaining charge)"),
        scaled("DISARM_DELAY", "COM_DISARM_PRFLT", 1.0, REAL32, "s", "ARMING"),
        mapped("FENCE_ACTION", "GF_ACTION", FENCE_ACTIONS, FENCE_VALUES, "FENCE"),
        enable("FENCE_ENABLE", "FENCE", "Enable the geofence"),
        scaled("FENCE_ALT_MAX", "GF_MAX_VER_DIST", 1.0, REAL32, "m", "FENCE"),
        scaled("FENCE_RADIUS", "GF_MAX_HOR_DIST", 1.0, REAL32, "m", "FENCE"),
        mapped("FS_GCS_ENABLE", "NAV_DLL_ACT", LOSS_ACTIONS, LOSS_VALUES, "FS"),
        scaled("FS_GCS_TIMEOUT", "COM_DL_LOSS_T", 1.0, REAL32, "s", "FS"),
        mapped("FS_THR_ENABLE", "NAV_RCL_ACT", STICK_LOSS_ACTIONS, STICK_LOSS_VALUES, "FS"),
        // ArduCopter's other bits (4 to 7) can be set but have no effect: this vehicle flies directly to targets and
        // never turns into the wind.
        row("GUID_OPTIONS", Int(0), (0.0, 255.0), "", "GUID", "GUIDED mode options").wire(INT32).bits(&[
            (0, "Allow arming from the transmitter"),
            (2, "Ignore the yaw stick"),
            (3, "Interpret attitude setpoint thrust as thrust, not climb rate"),
        ]),
        row("GUID_TIMEOUT", Real(3.0), (0.1, 3_600.0), "s", "GUID", "Timeout for setpoints without a position"),
        scaled("LAND_SPEED", "MPC_LAND_SPEED", 100.0, INT16, "cm/s", "LAND"),
        scaled("MAV_SYSID", "MAV_SYS_ID", 1.0, INT16, "", "MAV"),
        scaled("PILOT_TKOFF_ALT", "MIS_TAKEOFF_ALT", 100.0, REAL32, "cm", "PILOT"),
        scaled("RC_OVERRIDE_TIME", "COM_RC_LOSS_T", 1.0, REAL32, "s", "RC"),
        scaled("RTL_ALT", "RTL_RETURN_ALT", 100.0, INT32, "cm", "RTL"),
        scaled("SYSID_THISMAV", "MAV_SYS_ID", 1.0, INT16, "", "SYSID"),
        scaled("WPNAV_RADIUS", "NAV_ACC_RAD", 100.0, REAL32, "cm", "WPNAV"),
        scaled("WPNAV_SPEED", "MPC_XY_CRUISE", 100.0, REAL32, "cm/s", "WPNAV"),
        scaled("WPNAV_SPEED_DN", "MPC_Z_VEL_MAX_DN", 100.0, REAL32, "cm/s", "WPNAV"),
        scaled("WPNAV_SPEED_UP", "MPC_Z_VEL_MAX_UP", 100.0, REAL32, "cm/s", "WPNAV"),
    ]
}

/// Returns the read-only rows.
fn read_only_rows() -> Vec<Row> {
    // Clients interpret zero as an uncalibrated sensor; a simulated sensor needs no calibration.
    let nominal = Real(0.001);
    let offset = |name| read_only_row(name, nominal, REAL32, "INS", "Accelerometer offset (nominal)").unit("m/s^2");
    let none = |name, wire, group| {
        let zero = if wire == REAL32 { Real(0.0) } else { Int(0) };
        let row = read_only_row(name, zero, wire, group, "Not present: the vehicle has only one such sensor");
        if wire == REAL32 {
            row.unit("mGauss")
        } else if wire == INT8 {
            row.values(OFF_ON)
        } else {
            row
        }
    };
    let compass = |name| read_only_row(name, nominal, REAL32, "COMPASS", "Compass offset (nominal)").unit("mGauss");
    vec![
        row("ARMING_CHECK", Int(1), (0.0, 1_048_575.0), "", "ARMING", "Arming checks (this vehicle always performs all of them)")
            .bits(&[(0, "All")])
            .token(),
        read_only_row("ARMING_REQUIRE", Int(1), INT8, "ARMING", "Require arming").values(FIXED_VALUE),
        row("BATT_CAPACITY", Int(0), (0.0, 1e6), "mAh", "BATT", "Battery capacity").read_only(),
        read_only_row("BATT_MONITOR", Int(4), INT8, "BATT", "Battery monitor type").values(&[(4, "Voltage and current")]),
        read_only_row("COMPASS_DEV_ID", Int(97_539), INT32, "COMPASS", "Compass ID"),
        read_only_row("COMPASS_ENABLE", Int(1), INT8, "COMPASS", "Enable the compass").values(FIXED_VALUE),
        read_only_row("COMPASS_EXTERNAL", Int(0), INT8, "COMPASS", "Whether the compass is external"),
        none("COMPASS_DEV_ID2", INT32, "COMPASS"),
        none("COMPASS_DEV_ID3", INT32, "COMPASS"),
        none("COMPASS_OFS2_X", REAL32, "COMPASS"),
        none("COMPASS_OFS2_Y", REAL32, "COMPASS"),
        none("COMPASS_OFS2_Z", REAL32, "COMPASS"),
        none("COMPASS_OFS3_X", REAL32, "COMPASS"),
        none("COMPASS_OFS3_Y", REAL32, "COMPASS"),
        none("COMPASS_OFS3_Z", REAL32, "COMPASS"),
        none("COMPASS_USE2", INT8, "COMPASS"),
        none("COMPASS_USE3", INT8, "COMPASS"),
        none("INS_USE2", INT8, "INS"),
        none("INS_USE3", INT8, "INS"),
        compass("COMPASS_OFS_X"),
        compass("COMPASS_OFS_Y"),
        compass("COMPASS_OFS_Z"),
        read_only_row("COMPASS_PRIO1_ID", Int(97_539), INT32, "COMPASS", "Primary compass ID"),
        read_only_row("COMPASS_USE", Int(1), INT8, "COMPASS", "Use the compass").values(FIXED_VALUE),
        read_only_row("FORMAT_VERSION", Int(120), INT16, "FORMAT", "Parameter format version"),
        read_only_row("FRAME_CLASS", Int(1), INT8, "FRAME", "Frame class").values(&[(1, "Quad")]),
        read_only_row("FRAME_TYPE", Int(1), INT8, "FRAME", "Frame type").values(&[(1, "X")]),
        offset("INS_ACCOFFS_X"),
        offset("INS_ACCOFFS_Y"),
        offset("INS_ACCOFFS_Z"),
        read_only_row("INS_USE", Int(1), INT8, "INS", "Use the inertial sensor").values(FIXED_VALUE),
        read_only_row("RELAY1_FUNCTION", Int(1), INT8, "RELAY", "Relay 1 (lamp) function").values(&[(1, "Relay")]),
    ]
}

/// Modes that a switch position can select, with ArduCopter's numbers.
const FLIGHT_MODES: &[(i32, &str)] = &[
    (0, "Stabilize"),
    (1, "Acro"),
    (2, "Altitude Hold"),
    (3, "Auto"),
    (4, "Guided"),
    (5, "Loiter"),
    (6, "RTL"),
    (7, "Circle"),
    (9, "Land"),
    (16, "Position Hold"),
    (17, "Brake"),
    (21, "Smart RTL"),
    (23, "Follow"),
    (27, "Auto RTL"),
];

/// Channels that can switch modes: those after the four stick channels.
const SWITCH_CHANNELS: [(i32, &str); 13] = {
    const STICKS: usize = 4;
    let mut out = [(0, "Disabled"); 13];
    let mut k = 1;
    while k < out.len() {
        out[k] = CHANNELS[STICKS + k];
        k += 1;
    }
    out
};

/// Returns the mode switch parameters for RC_CHANNELS_OVERRIDE.
fn mode_switch() -> Vec<Row> {
    let small = |mut row: Row| {
        row.wire = INT8;
        row
    };
    let position =
        |name| small(row(name, Int(5), (0.0, 27.0), "", "FLTMODE", "Mode at this switch position").values(FLIGHT_MODES));
    let channel = row("FLTMODE_CH", Int(5), (0.0, 16.0), "", "FLTMODE", "Mode switch channel").values(&SWITCH_CHANNELS);
    let mut out = vec![small(channel)];
    out.extend(["FLTMODE1", "FLTMODE2", "FLTMODE3", "FLTMODE4", "FLTMODE5", "FLTMODE6"].map(position));
    out
}

/// Returns the parameters for the CIRCLE and FOLLOW modes, with ArduCopter's defaults.
fn circle_and_follow_rows() -> Vec<Row> {
    let whole = |name, default, high, wire, short| {
        let mut out = row(name, Int(default), (0.0, high), "", "FOLL", short);
        out.wire = wire;
        out
    };
    let offset = |name, short| row(name, Real(0.0), (-100.0, 100.0), "m", "FOLL", short);
    vec![
        row("CIRCLE_RADIUS", Real(1_000.0), (0.0, 200_000.0), "cm", "CIRCLE", "Circle radius"),
        row("CIRCLE_RATE", Real(20.0), (-90.0, 90.0), "deg/s", "CIRCLE", "Angular rate on the circle; positive: clockwise"),
        whole("FOLL_ENABLE", 0, 1.0, INT8, "Enable FOLLOW mode").values(OFF_ON),
        whole("FOLL_SYSID", 0, 255.0, INT16, "System ID of the target; 0: first system that reports a position"),
        row("FOLL_DIST_MAX", Real(100.0), (1.0, 1_000.0), "m", "FOLL", "Maximum distance to the target"),
        whole("FOLL_OFS_TYPE", 0, 1.0, INT8, "Offset frame")
            .values(&[(0, "North-East-Down"), (1, "Relative to lead vehicle heading")]),
        offset("FOLL_OFS_X", "Offset north or forward; all zero: keep the offset at mode entry"),
        offset("FOLL_OFS_Y", "Offset east or right"),
        offset("FOLL_OFS_Z", "Offset down"),
    ]
}

/// Returns the parameters for RC_CHANNELS_OVERRIDE.
fn rc_channel_rows() -> Vec<Row> {
    const CHANNELS: [[&str; 4]; 4] = [
        ["RC1_MIN", "RC1_MAX", "RC1_TRIM", "RC1_REVERSED"],
        ["RC2_MIN", "RC2_MAX", "RC2_TRIM", "RC2_REVERSED"],
        ["RC3_MIN", "RC3_MAX", "RC3_TRIM", "RC3_REVERSED"],
        ["RC4_MIN", "RC4_MAX", "RC4_TRIM", "RC4_REVERSED"],
    ];
    let map = |name, channel| read_only_row(name, Int(channel), INT8, "RCMAP", "RC channel for this axis");
    let mut out = vec![map("RCMAP_PITCH", 2), map("RCMAP_ROLL", 1), map("RCMAP_THROTTLE", 3), map("RCMAP_YAW", 4)];
    for [low, high, middle, reversed] in CHANNELS {
        out.push(read_only_row(low, Int(1_000), INT16, "RC", "Minimum pulse width").unit("us"));
        out.push(read_only_row(high, Int(2_000), INT16, "RC", "Maximum pulse width").unit("us"));
        out.push(read_only_row(middle, Int(1_500), INT16, "RC", "Center pulse width").unit("us"));
        out.push(read_only_row(reversed, Int(0), INT8, "RC", "Channel direction").values(&[(0, "Normal"), (1, "Reversed")]));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::derived_rows::px4_row;
    use super::*;

    #[test]
    fn exact_names_are_unique_short_enough_and_refer_to_existing_rows() {
        for pair in rows().windows(2) {
            assert!(pair[0].name < pair[1].name, "{} twice", pair[0].name);
        }
        for row in rows() {
            assert!(row.name.len() <= 16, "{}", row.name);
            let other = match row.source {
                ParamSource::Own => continue,
                ParamSource::Scaled(other, _) | ParamSource::Capacity(other) | ParamSource::Mapped(other, _) => other,
            };
            assert_eq!(
                super::super::find(other).map(|row| row.name),
                Some(other),
                "the parameter behind {} must exist",
                row.name
            );
            if let ParamSource::Mapped(_, pairs) = row.source {
                let other = px4_row(other);
                assert!(pairs.iter().all(|(_, theirs)| (other.low..=other.high).contains(&f64::from(*theirs))), "{}", row.name);
            }
        }
    }
}
