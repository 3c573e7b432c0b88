//! The parameter table: one row per parameter, with its metadata for ground stations.

use super::param_value::ParamValue::{Int, Real};
use super::row::{Row, row};
use super::{behavior, stored};
use spandrel_mavlink::contract::stick_request;
use std::sync::LazyLock;

const BATTERY: &str = "Battery";
const CALIBRATION: &str = "Sensor Calibration";
const COMMANDER: &str = "Commander";
const FENCE: &str = "Geofence";
const FOLLOWING: &str = "Follow target";
const FLIGHT: &str = "Multicopter Position Control";
const JOYSTICK: &str = "Joystick";
const MAVLINK: &str = "MAVLink";
const MISSION: &str = "Mission";
const RADIO: &str = "Radio Calibration";
const RETURN: &str = "Return Mode";
pub(super) const SIMULATION: &str = "Simulation";
const SYSTEM: &str = "System";

const LOSS_ACTIONS: &[(i32, &str)] =
    &[(0, "Disabled"), (1, "Hold mode"), (2, "Return mode"), (3, "Land mode"), (5, "Terminate"), (6, "Disarm")];
/// Channels for a stick or switch. No radio is connected, so all sticks and switches are unassigned.
pub(super) const CHANNELS: &[(i32, &str)] = &[
    (0, "Unassigned"),
    (1, "Channel 1"),
    (2, "Channel 2"),
    (3, "Channel 3"),
    (4, "Channel 4"),
    (5, "Channel 5"),
    (6, "Channel 6"),
    (7, "Channel 7"),
    (8, "Channel 8"),
    (9, "Channel 9"),
    (10, "Channel 10"),
    (11, "Channel 11"),
    (12, "Channel 12"),
    (13, "Channel 13"),
    (14, "Channel 14"),
    (15, "Channel 15"),
    (16, "Channel 16"),
    (17, "Channel 17"),
    (18, "Channel 18"),
];
const CELL_COUNTS: &[(i32, &str)] = &[(2, "2S"), (3, "3S"), (4, "4S"), (5, "5S"), (6, "6S"), (8, "8S"), (12, "12S"), (14, "14S")];
const ROTATIONS: &[(i32, &str)] = &[
    (-1, "Internal"),
    (0, "None"),
    (1, "Yaw 45°"),
    (2, "Yaw 90°"),
    (3, "Yaw 135°"),
    (4, "Yaw 180°"),
    (5, "Yaw 225°"),
    (6, "Yaw 270°"),
    (7, "Yaw 315°"),
    (8, "Roll 180°"),
    (12, "Pitch 180°"),
    (16, "Roll 90°"),
    (20, "Roll 270°"),
    (24, "Pitch 90°"),
    (25, "Pitch 270°"),
];
/// Button functions, by parameter value.
const BUTTON_FUNCTIONS: &[(i32, &str)] = &[
    (0, "None"),
    (1, "Arm"),
    (2, "Disarm"),
    (3, "Takeoff"),
    (4, "Land"),
    (5, "Return"),
    (6, "Hold"),
    (7, "Position mode"),
    (8, "Altitude mode"),
    (9, "Mission"),
    (10, "Take picture"),
    (11, "Toggle lamp"),
    (12, "Gimbal level"),
    (13, "Gimbal up"),
    (14, "Gimbal down"),
    (15, "Next stick response"),
];
const OFF_ON: &[(i32, &str)] = &[(0, "Disabled"), (1, "Enabled")];

const fn button(name: &'static str) -> Row {
    row(name, Int(0), (0.0, 15.0), "", JOYSTICK, "Button function").values(BUTTON_FUNCTIONS)
}

/// Returns all parameters under PX4's names, sorted by name.
pub(super) fn rows() -> &'static [Row] {
    static ALL: LazyLock<Vec<Row>> = LazyLock::new(|| stored::fill_missing([behavior::ROWS, ROWS].concat(), stored::PX4));
    &ALL
}

/// Names from the source code of QGroundControl and MAVSDK (docs/src/reference/wire.md, "Parameters"), with PX4's
/// defaults where they apply. Sorted by name.
pub const ROWS: &[Row] = &[
    row("BAT1_N_CELLS", Int(3), (1.0, 16.0), "", BATTERY, "Number of cells in series").values(CELL_COUNTS),
    row("BAT1_SOURCE", Int(-1), (-1.0, 2.0), "", BATTERY, "Battery data source")
        .values(&[(-1, "Disabled"), (0, "Power Module")])
        .token(),
    row("BAT1_V_CHARGED", Real(4.2), (3.0, 5.0), "V", BATTERY, "Full cell voltage").token(),
    row("BAT1_V_EMPTY", Real(3.5), (2.5, 4.5), "V", BATTERY, "Empty cell voltage").token(),
    row("BAT_CRIT_THR", Real(0.07), (0.0, 0.5), "norm", BATTERY, "Critical battery level"),
    row("BAT_LOW_THR", Real(0.15), (0.0, 0.9), "norm", BATTERY, "Low battery level"),
    button("BTN0_FUNCTION"),
    button("BTN10_FUNCTION"),
    button("BTN11_FUNCTION"),
    button("BTN12_FUNCTION"),
    button("BTN13_FUNCTION"),
    button("BTN14_FUNCTION"),
    button("BTN15_FUNCTION"),
    button("BTN1_FUNCTION"),
    button("BTN2_FUNCTION"),
    button("BTN3_FUNCTION"),
    button("BTN4_FUNCTION"),
    button("BTN5_FUNCTION"),
    button("BTN6_FUNCTION"),
    button("BTN7_FUNCTION"),
    button("BTN8_FUNCTION"),
    button("BTN9_FUNCTION"),
    row("CAL_ACC0_ID", Int(1_310_988), (0.0, 2e9), "", CALIBRATION, "Calibrated accelerometer ID").token(),
    row("CAL_GYRO0_ID", Int(1_310_988), (0.0, 2e9), "", CALIBRATION, "Calibrated gyroscope ID").token(),
    row("CAL_GYRO0_XOFF", Real(0.0), (-10.0, 10.0), "rad/s", CALIBRATION, "Measured gyroscope offset, forward").token(),
    row("CAL_GYRO0_YOFF", Real(0.0), (-10.0, 10.0), "rad/s", CALIBRATION, "Measured gyroscope offset, right").token(),
    row("CAL_GYRO0_ZOFF", Real(0.0), (-10.0, 10.0), "rad/s", CALIBRATION, "Measured gyroscope offset, down").token(),
    row("CAL_MAG0_ID", Int(197_388), (0.0, 2e9), "", CALIBRATION, "Calibrated magnetometer ID").token(),
    row("CAL_MAG0_ROT", Int(0), (-1.0, 40.0), "", CALIBRATION, "Magnetometer rotation relative to the board")
        .values(ROTATIONS)
        .token(),
    row("COM_DISARM_LAND", Real(2.0), (-1.0, 60.0), "s", COMMANDER, "Delay from landing to disarming; 0 or less: never"),
    row("COM_DISARM_PRFLT", Real(10.0), (-1.0, 600.0), "s", COMMANDER, "Takeoff timeout after arming; 0 or less: none"),
    row("COM_DL_LOSS_T", Int(10), (1.0, 300.0), "s", COMMANDER, "Ground station loss timeout"),
    row("COM_OF_LOSS_T", Real(1.0), (0.1, 60.0), "s", COMMANDER, "Offboard setpoint loss timeout"),
    row("COM_RC_IN_MODE", Int(1), (0.0, 5.0), "", COMMANDER, "Manual control source").values(&[(1, "Joystick only")]).token(),
    row("COM_RC_LOSS_T", Real(0.5), (0.1, 35.0), "s", COMMANDER, "Manual control loss timeout"),
    row("CP_DIST", Real(-1.0), (-1.0, 15.0), "m", FLIGHT, "Collision prevention distance; negative: off").token(),
    row("FLW_TGT_ALT_M", Int(0), (0.0, 2.0), "", FOLLOWING, "Height mode while following")
        .values(&[(0, "2D tracking: height above home"), (2, "3D tracking: height above the target")]),
    row("FLW_TGT_DST", Real(8.0), (1.0, 1e3), "m", FOLLOWING, "Distance from the target"),
    row("FLW_TGT_FA", Real(180.0), (-180.0, 180.0), "deg", FOLLOWING, "Angle from the target's course; 180: behind"),
    row("FLW_TGT_HT", Real(8.0), (8.0, 500.0), "m", FOLLOWING, "Height while following"),
    row("FLW_TGT_MAX_VEL", Real(5.0), (0.0, 20.0), "m/s", FOLLOWING, "Maximum speed while following"),
    row("FLW_TGT_RS", Real(0.1), (0.0, 1.0), "", FOLLOWING, "Target motion smoothing; 0: off"),
    row("GF_ACTION", Int(2), (0.0, 5.0), "", FENCE, "Geofence breach action").values(&[
        (0, "None"),
        (1, "Warning"),
        (2, "Hold mode"),
        (3, "Return mode"),
        (4, "Terminate"),
        (5, "Land mode"),
    ]),
    row("GF_MAX_HOR_DIST", Real(0.0), (0.0, 1e4), "m", FENCE, "Maximum horizontal distance from home; 0: no limit"),
    row("GF_MAX_VER_DIST", Real(0.0), (0.0, 1e4), "m", FENCE, "Maximum height above home; 0: no limit"),
    row("LND_FLIGHT_T_HI", Int(0), (0.0, 2e9), "", SYSTEM, "Total flight time, upper 32 bits").volatile().token(),
    row("LND_FLIGHT_T_LO", Int(0), (-2e9, 2e9), "", SYSTEM, "Total flight time, lower 32 bits").volatile().token(),
    row("MAV_COMP_ID", Int(1), (1.0, 250.0), "", MAVLINK, "Component ID").read_only(),
    row("MAV_SYS_ID", Int(1), (1.0, 250.0), "", MAVLINK, "System ID").read_only(),
    row("MAV_TYPE", Int(2), (0.0, 50.0), "", MAVLINK, "Vehicle type").values(&[(2, "Quadrotor")]).read_only(),
    row("MIS_TAKEOFF_ALT", Real(2.5), (0.5, 500.0), "m", MISSION, "Default takeoff height above home"),
    row("MPC_LAND_SPEED", Real(0.7), (0.3, 3.0), "m/s", FLIGHT, "Landing descent speed near the ground"),
    row("MPC_TKO_SPEED", Real(1.5), (0.5, 5.0), "m/s", FLIGHT, "Takeoff climb speed"),
    row("MPC_XY_CRUISE", Real(5.0), (0.5, 20.0), "m/s", FLIGHT, "Horizontal speed in missions, returns and go-to flights"),
    row("MPC_XY_VEL_MAX", Real(12.0), (0.5, 30.0), "m/s", FLIGHT, "Maximum horizontal speed in automatic modes"),
    row("MPC_Z_VEL_MAX_DN", Real(1.5), (0.3, 10.0), "m/s", FLIGHT, "Maximum descent speed in automatic modes"),
    row("MPC_Z_VEL_MAX_UP", Real(3.0), (0.3, 15.0), "m/s", FLIGHT, "Maximum climb speed in automatic modes"),
    row("NAV_ACC_RAD", Real(2.0), (0.05, 200.0), "m", MISSION, "Waypoint acceptance radius"),
    row("NAV_DLL_ACT", Int(0), (0.0, 6.0), "", COMMANDER, "Ground station loss action").values(LOSS_ACTIONS),
    row("NAV_RCL_ACT", Int(1), (1.0, 6.0), "", COMMANDER, "Manual control loss action").values(LOSS_ACTIONS),
    row("RC_CHAN_CNT", Int(0), (0.0, 18.0), "", RADIO, "Number of radio channels").token(),
    row("RC_MAP_FLTMODE", Int(0), (0.0, 18.0), "", RADIO, "Mode switch channel").values(CHANNELS).token(),
    row("RC_MAP_MODE_SW", Int(0), (0.0, 18.0), "", RADIO, "Legacy mode switch channel").values(CHANNELS).token(),
    row("RC_MAP_PITCH", Int(0), (0.0, 18.0), "", RADIO, "Pitch channel").values(CHANNELS).token(),
    row("RC_MAP_ROLL", Int(0), (0.0, 18.0), "", RADIO, "Roll channel").values(CHANNELS).token(),
    row("RC_MAP_THROTTLE", Int(0), (0.0, 18.0), "", RADIO, "Throttle channel").values(CHANNELS).token(),
    row("RC_MAP_YAW", Int(0), (0.0, 18.0), "", RADIO, "Yaw channel").values(CHANNELS).token(),
    row("RTL_RETURN_ALT", Real(30.0), (2.0, 500.0), "m", RETURN, "Return height above home"),
    row("SENS_BOARD_ROT", Int(0), (0.0, 40.0), "", CALIBRATION, "Board rotation").values(ROTATIONS).token(),
    row("SENS_DPRES_OFF", Real(0.0), (-1e3, 1e3), "", CALIBRATION, "Airspeed sensor offset").token(),
    row("SIM_LINK_DELAY", Int(0), (0.0, 2e3), "ms", SIMULATION, "Link delay for ground stations and SDKs, each way"),
    row("SIM_LINK_LOSS", Real(0.0), (0.0, 90.0), "%", SIMULATION, "Packet loss for ground stations and SDKs, each way"),
    row(
        "SIM_TRAFFIC",
        Int(1),
        (0.0, 1.0),
        "",
        SIMULATION,
        "Bridge traffic. Closing keeps new vehicles off; those on the bridge leave",
    )
    .values(&[(0, "Closed"), (1, "Open")]),
    row(
        "SIM_WIND_DIR",
        Real(0.0),
        (0.0, 360.0),
        "deg",
        SIMULATION,
        "Direction the wind blows from, clockwise from north; used if SIM_WIND_SPD is set",
    ),
    row(
        "SIM_WIND_SPD",
        Real(-1.0),
        (-1.0, 25.0),
        "m/s",
        SIMULATION,
        "Mean wind speed 6 m above the water; negative: use the scenario's wind",
    ),
    row("SPAN_CAMERA", Int(1), (0.0, 1.0), "", SYSTEM, "Send heartbeats from the camera component (100)")
        .values(&[(0, "Off (for clients that mistake them for vehicle heartbeats)"), (1, "On")]),
    row("SPAN_FLAVOUR", Int(0), (0.0, 2.0), "", SYSTEM, "Autopilot protocol")
        .values(&[(0, "PX4"), (1, "ArduPilot"), (2, "Generic MAVLink")])
        .read_only(),
    row(stick_request::PARAMETER, Int(0), (0.0, 2.0), "", JOYSTICK, "Response to the sticks in position mode").values(&[
        (0, "Position: gentle"),
        (1, "Sport: as quick as the airframe allows"),
        (2, "Tripod: slow"),
    ]),
    row("SPAN_STICKS", Int(0), (0.0, 1.0), "", JOYSTICK, "Which sender's sticks take control")
        .values(&[(0, "The first sender, until it times out"), (1, "The last sender to move a stick")]),
    row("SYS_AUTOCONFIG", Int(0), (0.0, 2.0), "", SYSTEM, "Configuration reset at startup")
        .values(&[(0, "Keep"), (1, "Reset to defaults"), (2, "Reset, keeping calibration")])
        .token(),
    row("SYS_AUTOSTART", Int(4001), (0.0, 1e6), "", SYSTEM, "Airframe").token(),
    row("SYS_FAILURE_EN", Int(0), (0.0, 1.0), "", SYSTEM, "Allow failure injection by command").values(OFF_ON),
    row("SYS_HAS_MAG", Int(1), (0.0, 3.0), "", SYSTEM, "Number of magnetometers").token(),
    row("SYS_HAS_NUM_ASPD", Int(0), (0.0, 1.0), "", SYSTEM, "Number of airspeed sensors").token(),
    row("SYS_HITL", Int(0), (0.0, 2.0), "", SYSTEM, "Hardware in the loop").values(OFF_ON).token(),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_table_is_sorted_by_name_and_names_fit_the_wire() {
        for pair in ROWS.windows(2) {
            assert!(pair[0].name < pair[1].name, "{} {}", pair[0].name, pair[1].name);
        }
        for row in ROWS {
            let default = row.default.number();
            assert!(row.name.len() <= 16 && row.low <= default && default <= row.high, "{}", row.name);
            assert!(
                row.values.iter().all(|(value, _)| (row.low..=row.high).contains(&f64::from(*value)) || row.values.len() > 2),
                "{}",
                row.name
            );
        }
    }
}
