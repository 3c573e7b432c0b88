//! The parameters: one row each, with what ground stations show of it.

use super::ParamValue::{self, Int, Real};
use super::{behavior, stored};
use spandrel_mavlink::dialect::MavParamType;
use std::sync::LazyLock;

/// Where a parameter's value is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamSource {
    /// It has one of its own.
    Own,
    /// Another parameter's, times a factor.
    Scaled(&'static str, f64),
    /// Another parameter's, which is a share of the battery's capacity, in mAh.
    Capacity(&'static str),
    /// Another parameter's, whose numbers mean the same as these: (this one's, the other's).
    Mapped(&'static str, &'static [(i32, i32)]),
}

/// One parameter.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Name, at most 16 characters.
    pub name: &'static str,
    /// Default.
    pub default: ParamValue,
    /// Smallest value that is taken.
    pub low: f64,
    /// Largest value that is taken.
    pub high: f64,
    /// Unit, as ground stations write it.
    pub unit: &'static str,
    /// Heading under which it is shown.
    pub group: &'static str,
    /// What it is.
    pub short: &'static str,
    /// Words for its values.
    pub values: &'static [(i32, &'static str)],
    /// Words for its bits, where it is a mask.
    pub bits: &'static [(i32, &'static str)],
    /// It describes the vehicle and cannot be set.
    pub read_only: bool,
    /// It changes by itself.
    pub volatile: bool,
    /// It exists because clients look for it; nothing here depends on it.
    pub token: bool,
    /// Its type on the wire.
    pub wire: MavParamType,
    /// Where its value is.
    pub source: ParamSource,
}

pub(super) const fn row(
    name: &'static str,
    default: ParamValue,
    range: (f64, f64),
    unit: &'static str,
    group: &'static str,
    short: &'static str,
) -> Row {
    Row {
        name,
        default,
        low: range.0,
        high: range.1,
        unit,
        group,
        short,
        values: &[],
        bits: &[],
        read_only: false,
        volatile: false,
        token: false,
        wire: match default {
            Int(_) => MavParamType::MAV_PARAM_TYPE_INT32,
            Real(_) => MavParamType::MAV_PARAM_TYPE_REAL32,
        },
        source: ParamSource::Own,
    }
}

impl Row {
    pub(super) const fn values(mut self, values: &'static [(i32, &'static str)]) -> Self {
        self.values = values;
        self
    }

    pub(super) const fn bits(mut self, bits: &'static [(i32, &'static str)]) -> Self {
        self.bits = bits;
        self
    }

    pub(super) const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    pub(super) const fn wire(mut self, wire: MavParamType) -> Self {
        self.wire = wire;
        self
    }

    pub(super) const fn read_only(mut self) -> Self {
        self.read_only = true;
        self
    }

    pub(super) const fn volatile(mut self) -> Self {
        self.volatile = true;
        self
    }

    pub(super) const fn token(mut self) -> Self {
        self.token = true;
        self
    }
}

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
const SIMULATION: &str = "Simulation";
const SYSTEM: &str = "System";

const LOSS: &[(i32, &str)] =
    &[(0, "Disabled"), (1, "Hold mode"), (2, "Return mode"), (3, "Land mode"), (5, "Terminate"), (6, "Disarm")];
/// The channel of a stick or switch. No radio is connected: all read as unassigned.
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
const CELLS: &[(i32, &str)] = &[(2, "2S"), (3, "3S"), (4, "4S"), (5, "5S"), (6, "6S"), (8, "8S"), (12, "12S"), (14, "14S")];
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
/// What a button can do, by the parameter's value.
const FUNCTIONS: &[(i32, &str)] = &[
    (0, "Nothing"),
    (1, "Arm"),
    (2, "Disarm"),
    (3, "Take-off"),
    (4, "Land"),
    (5, "Return"),
    (6, "Hold"),
    (7, "Position mode"),
    (8, "Altitude mode"),
    (9, "Mission"),
    (10, "Snapshot"),
    (11, "Lamp on or off"),
    (12, "Gimbal level"),
    (13, "Gimbal up"),
    (14, "Gimbal down"),
];
const OFF_ON: &[(i32, &str)] = &[(0, "Disabled"), (1, "Enabled")];

const fn button(name: &'static str) -> Row {
    row(name, Int(0), (0.0, 14.0), "", JOYSTICK, "What a press of the button does").values(FUNCTIONS)
}

/// All parameters under PX4's names, in the order of the names.
pub(super) fn rows() -> &'static [Row] {
    static ALL: LazyLock<Vec<Row>> = LazyLock::new(|| stored::fill_missing([behavior::ROWS, ROWS].concat(), stored::PX4));
    &ALL
}

/// Names from QGroundControl's and MAVSDK's sources (docs/src/reference/wire.md, "Parameters"), with PX4's defaults where they
/// have a meaning here. In the order of their names.
pub const ROWS: &[Row] = &[
    row("BAT1_N_CELLS", Int(3), (1.0, 16.0), "", BATTERY, "Number of cells in series").values(CELLS),
    row("BAT1_SOURCE", Int(-1), (-1.0, 2.0), "", BATTERY, "Where the battery is measured")
        .values(&[(-1, "Disabled"), (0, "Power Module")])
        .token(),
    row("BAT1_V_CHARGED", Real(4.2), (3.0, 5.0), "V", BATTERY, "Voltage of a full cell").token(),
    row("BAT1_V_EMPTY", Real(3.5), (2.5, 4.5), "V", BATTERY, "Voltage of an empty cell").token(),
    row("BAT_CRIT_THR", Real(0.07), (0.0, 0.5), "norm", BATTERY, "Charge that counts as critical"),
    row("BAT_LOW_THR", Real(0.15), (0.0, 0.9), "norm", BATTERY, "Charge that counts as low"),
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
    row("CAL_ACC0_ID", Int(1_310_988), (0.0, 2e9), "", CALIBRATION, "Number of the accelerometer that was calibrated").token(),
    row("CAL_GYRO0_ID", Int(1_310_988), (0.0, 2e9), "", CALIBRATION, "Number of the gyroscope that was calibrated").token(),
    row("CAL_GYRO0_XOFF", Real(0.0), (-10.0, 10.0), "rad/s", CALIBRATION, "Offset of the gyroscope that was measured, forward")
        .token(),
    row("CAL_GYRO0_YOFF", Real(0.0), (-10.0, 10.0), "rad/s", CALIBRATION, "Offset of the gyroscope that was measured, right")
        .token(),
    row("CAL_GYRO0_ZOFF", Real(0.0), (-10.0, 10.0), "rad/s", CALIBRATION, "Offset of the gyroscope that was measured, down")
        .token(),
    row("CAL_MAG0_ID", Int(197_388), (0.0, 2e9), "", CALIBRATION, "Number of the magnetometer that was calibrated").token(),
    row("CAL_MAG0_ROT", Int(0), (-1.0, 40.0), "", CALIBRATION, "How the magnetometer is turned against the board")
        .values(ROTATIONS)
        .token(),
    row("COM_DISARM_LAND", Real(2.0), (-1.0, 60.0), "s", COMMANDER, "Time from touch-down to disarming; not above zero: never"),
    row(
        "COM_DISARM_PRFLT",
        Real(10.0),
        (-1.0, 600.0),
        "s",
        COMMANDER,
        "Time without take-off until disarming; not above zero: never",
    ),
    row("COM_DL_LOSS_T", Int(10), (1.0, 300.0), "s", COMMANDER, "Silence after which the ground station counts as lost"),
    row("COM_OF_LOSS_T", Real(1.0), (0.1, 60.0), "s", COMMANDER, "Silence after which external set-points count as lost"),
    row("COM_RC_IN_MODE", Int(1), (0.0, 5.0), "", COMMANDER, "Where manual control comes from")
        .values(&[(1, "Joystick only")])
        .token(),
    row("COM_RC_LOSS_T", Real(0.5), (0.1, 35.0), "s", COMMANDER, "Silence after which manual control counts as lost"),
    row("CP_DIST", Real(-1.0), (-1.0, 15.0), "m", FLIGHT, "Distance kept by collision prevention; negative: off").token(),
    row("FLW_TGT_ALT_M", Int(0), (0.0, 2.0), "", FOLLOWING, "How the height is kept while following")
        .values(&[(0, "2D tracking: height over home"), (2, "3D tracking: height over the target")]),
    row("FLW_TGT_DST", Real(8.0), (1.0, 1e3), "m", FOLLOWING, "Distance from the target"),
    row("FLW_TGT_FA", Real(180.0), (-180.0, 180.0), "deg", FOLLOWING, "Angle from the target's course; 180: behind"),
    row("FLW_TGT_HT", Real(8.0), (8.0, 500.0), "m", FOLLOWING, "Height while following"),
    row("FLW_TGT_MAX_VEL", Real(5.0), (0.0, 20.0), "m/s", FOLLOWING, "Largest speed while following"),
    row("FLW_TGT_RS", Real(0.1), (0.0, 1.0), "", FOLLOWING, "Smoothing of the target's motion; 0: none"),
    row("GF_ACTION", Int(2), (0.0, 5.0), "", FENCE, "What a breach of the geofence leads to").values(&[
        (0, "None"),
        (1, "Warning"),
        (2, "Hold mode"),
        (3, "Return mode"),
        (4, "Terminate"),
        (5, "Land mode"),
    ]),
    row("GF_MAX_HOR_DIST", Real(0.0), (0.0, 1e4), "m", FENCE, "Farthest from home; 0: no limit"),
    row("GF_MAX_VER_DIST", Real(0.0), (0.0, 1e4), "m", FENCE, "Highest over home; 0: no limit"),
    row("LND_FLIGHT_T_HI", Int(0), (0.0, 2e9), "", SYSTEM, "Total flight time, upper half").volatile().token(),
    row("LND_FLIGHT_T_LO", Int(0), (-2e9, 2e9), "", SYSTEM, "Total flight time, lower half").volatile().token(),
    row("MAV_COMP_ID", Int(1), (1.0, 250.0), "", MAVLINK, "Component id").read_only(),
    row("MAV_SYS_ID", Int(1), (1.0, 250.0), "", MAVLINK, "System id").read_only(),
    row("MAV_TYPE", Int(2), (0.0, 50.0), "", MAVLINK, "Kind of vehicle").values(&[(2, "Quadrotor")]).read_only(),
    row("MIS_TAKEOFF_ALT", Real(2.5), (0.5, 500.0), "m", MISSION, "Take-off height over home where none is given"),
    row("MPC_LAND_SPEED", Real(0.7), (0.3, 3.0), "m/s", FLIGHT, "Descent in the last metres of a landing"),
    row("MPC_TKO_SPEED", Real(1.5), (0.5, 5.0), "m/s", FLIGHT, "Climb at take-off"),
    row("MPC_XY_CRUISE", Real(5.0), (0.5, 20.0), "m/s", FLIGHT, "Horizontal speed in missions, returns and go-to"),
    row("MPC_XY_VEL_MAX", Real(12.0), (0.5, 30.0), "m/s", FLIGHT, "Largest horizontal speed in automatic modes"),
    row("MPC_Z_VEL_MAX_DN", Real(1.5), (0.3, 10.0), "m/s", FLIGHT, "Descent in automatic modes"),
    row("MPC_Z_VEL_MAX_UP", Real(3.0), (0.3, 15.0), "m/s", FLIGHT, "Climb in automatic modes"),
    row("NAV_ACC_RAD", Real(2.0), (0.05, 200.0), "m", MISSION, "A waypoint counts as reached within this"),
    row("NAV_DLL_ACT", Int(0), (0.0, 6.0), "", COMMANDER, "What a lost ground station leads to").values(LOSS),
    row("NAV_RCL_ACT", Int(1), (1.0, 6.0), "", COMMANDER, "What lost manual control leads to").values(LOSS),
    row("RC_CHAN_CNT", Int(0), (0.0, 18.0), "", RADIO, "Channels of the radio").token(),
    row("RC_MAP_FLTMODE", Int(0), (0.0, 18.0), "", RADIO, "Channel of the mode switch").values(CHANNELS).token(),
    row("RC_MAP_MODE_SW", Int(0), (0.0, 18.0), "", RADIO, "Channel of the older mode switch").values(CHANNELS).token(),
    row("RC_MAP_PITCH", Int(0), (0.0, 18.0), "", RADIO, "Channel of pitch").values(CHANNELS).token(),
    row("RC_MAP_ROLL", Int(0), (0.0, 18.0), "", RADIO, "Channel of roll").values(CHANNELS).token(),
    row("RC_MAP_THROTTLE", Int(0), (0.0, 18.0), "", RADIO, "Channel of throttle").values(CHANNELS).token(),
    row("RC_MAP_YAW", Int(0), (0.0, 18.0), "", RADIO, "Channel of yaw").values(CHANNELS).token(),
    row("RTL_RETURN_ALT", Real(30.0), (2.0, 500.0), "m", RETURN, "Height over home at which it returns"),
    row("SENS_BOARD_ROT", Int(0), (0.0, 40.0), "", CALIBRATION, "How the board is turned in the vehicle")
        .values(ROTATIONS)
        .token(),
    row("SENS_DPRES_OFF", Real(0.0), (-1e3, 1e3), "", CALIBRATION, "Offset of the airspeed sensor").token(),
    row("SIM_LINK_DELAY", Int(0), (0.0, 2e3), "ms", SIMULATION, "How late datagrams of ground stations and SDKs are, each way"),
    row(
        "SIM_LINK_LOSS",
        Real(0.0),
        (0.0, 90.0),
        "%",
        SIMULATION,
        "Share of datagrams of ground stations and SDKs that is lost, each way",
    ),
    row(
        "SIM_TRAFFIC",
        Int(1),
        (0.0, 1.0),
        "",
        SIMULATION,
        "Bridges are open to traffic; closed, who is on them goes on, nobody enters",
    )
    .values(&[(0, "Closed"), (1, "Open")]),
    row(
        "SIM_WIND_DIR",
        Real(0.0),
        (0.0, 360.0),
        "deg",
        SIMULATION,
        "Where the wind comes from, clockwise from north, where SIM_WIND_SPD is set",
    ),
    row("SIM_WIND_SPD", Real(-1.0), (-1.0, 25.0), "m/s", SIMULATION, "Mean wind 6 m over the water; negative: the scenario's"),
    row("SPAN_CAMERA", Int(1), (0.0, 1.0), "", SYSTEM, "Heartbeats of the camera component (100)")
        .values(&[(0, "Off, for clients that take them for the vehicle's"), (1, "On")]),
    row("SPAN_FLAVOUR", Int(0), (0.0, 2.0), "", SYSTEM, "Whose interface is spoken")
        .values(&[(0, "PX4"), (1, "ArduPilot"), (2, "None: the standard alone")])
        .read_only(),
    row("SPAN_STICKS", Int(0), (0.0, 1.0), "", JOYSTICK, "Who of several senders has the sticks")
        .values(&[(0, "The first, until he falls silent"), (1, "Whoever moves them last")]),
    row("SYS_AUTOCONFIG", Int(0), (0.0, 2.0), "", SYSTEM, "Reset of the configuration at start")
        .values(&[(0, "Keep"), (1, "Reset to defaults"), (2, "Reset, keeping calibration")])
        .token(),
    row("SYS_AUTOSTART", Int(4001), (0.0, 1e6), "", SYSTEM, "Airframe").token(),
    row("SYS_FAILURE_EN", Int(0), (0.0, 1.0), "", SYSTEM, "Failures may be injected by command").values(OFF_ON),
    row("SYS_HAS_MAG", Int(1), (0.0, 3.0), "", SYSTEM, "Number of magnetometers").token(),
    row("SYS_HAS_NUM_ASPD", Int(0), (0.0, 1.0), "", SYSTEM, "Number of airspeed sensors").token(),
    row("SYS_HITL", Int(0), (0.0, 2.0), "", SYSTEM, "Hardware in the loop").values(OFF_ON).token(),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_table_is_in_the_order_of_its_names_which_fit_the_wire() {
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
