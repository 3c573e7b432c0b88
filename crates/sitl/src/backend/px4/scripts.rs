//! Shell scripts that replace PX4's own. PX4's startup script looks for them in PATH, in which the working directory comes first.

use crate::backend::launch::{LaunchFile, LaunchSettings};

/// PX4's simulator port for vehicle 0.
const SIMULATOR_PORT: u16 = 4560;
/// Data rate of the MAVLink link, bytes/s. It is not a real radio.
const LINK_RATE: u32 = 4_000_000;

/// Streams with another rate than in PX4's normal mode, Hz.
const STREAMS: [(&str, u32); 26] = [
    ("ATTITUDE", 50),
    ("ATTITUDE_QUATERNION", 50),
    ("ATTITUDE_TARGET", 10),
    ("LOCAL_POSITION_NED", 50),
    ("POSITION_TARGET_LOCAL_NED", 10),
    ("GLOBAL_POSITION_INT", 20),
    ("ODOMETRY", 30),
    ("HIGHRES_IMU", 50),
    ("VFR_HUD", 10),
    ("ALTITUDE", 10),
    ("EXTENDED_SYS_STATE", 5),
    ("SYS_STATUS", 2),
    ("SYSTEM_TIME", 1),
    ("BATTERY_STATUS", 2),
    ("HOME_POSITION", 1),
    ("ESTIMATOR_STATUS", 1),
    ("CURRENT_MODE", 1),
    ("NAV_CONTROLLER_OUTPUT", 5),
    ("RC_CHANNELS", 20),
    ("SERVO_OUTPUT_RAW_0", 10),
    ("DISTANCE_SENSOR", 5),
    ("OPTICAL_FLOW_RAD", 10),
    ("GIMBAL_DEVICE_SET_ATTITUDE", 20),
    ("AUTOPILOT_STATE_FOR_GIMBAL_DEVICE", 20),
    ("GIMBAL_DEVICE_ATTITUDE_STATUS", 10),
    ("GIMBAL_MANAGER_STATUS", 5),
];

/// Returns the script that opens the only MAVLink link. PX4's own script would open Spandrel's default ports.
pub(super) fn mavlink(settings: &LaunchSettings) -> LaunchFile {
    let (own, remote) = (settings.autopilot_port, settings.mavlink_port);
    let mut text = format!(
        "#!/bin/sh\n# MAVLink link to Spandrel, instead of PX4's own links.\nmavlink start -x -u {own} -o {remote} -r {LINK_RATE} -f\n"
    );
    for (name, rate_hz) in STREAMS {
        text.push_str(&format!("mavlink stream -r {rate_hz} -s {name} -u {own}\n"));
    }
    LaunchFile { name: "px4-rc.mavlink".to_owned(), text, executable: false }
}

/// Returns the script that connects to the simulator. Only another port than PX4's default needs it.
pub(super) fn simulator(settings: &LaunchSettings) -> Option<LaunchFile> {
    if settings.simulator_port == SIMULATOR_PORT.saturating_add(u16::from(settings.instance)) {
        return None;
    }
    let text = format!(
        "#!/bin/sh\n# Connection to Spandrel's simulator port.\nsimulator_mavlink start -c {}\n",
        settings.simulator_port
    );
    Some(LaunchFile { name: "px4-rc.mavlinksim".to_owned(), text, executable: false })
}
