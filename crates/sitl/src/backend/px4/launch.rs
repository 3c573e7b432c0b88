//! How to start PX4 for an aircraft.

use super::{airframe, scripts};
use crate::backend::launch::{Launch, LaunchFile, LaunchParam, LaunchSettings};
use spandrel_model::vehicle::Vehicle;

/// PX4's airframe without a simulator of its own. The parameters replace its rotor layout.
const AIRFRAME: &str = "10016";
const MODEL: &str = "none_iris";
/// Prefix of environment variables that set a parameter.
const PARAM_PREFIX: &str = "PX4_PARAM_";

/// Returns arguments, environment and files for PX4. The caller adds the path of PX4's `etc` folder to the arguments, starts PX4 in
/// the working directory with the files, and puts that directory first in PATH and PX4's `bin` folder second.
///
/// `PX4_SIM_SPEED_FACTOR` is not set: PX4's startup script needs the program `bc` for it. The timeouts that it would lengthen are
/// among the parameters.
#[must_use]
pub fn launch(vehicle: &Vehicle, settings: &LaunchSettings) -> Launch {
    let parameters = airframe::parameters(vehicle, settings);
    let fixed = [("PX4_SIM_MODEL", MODEL), ("PX4_SYS_AUTOSTART", AIRFRAME)];
    let mut environment: Vec<(String, String)> =
        fixed.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    environment.extend(parameters.iter().map(|param| (format!("{PARAM_PREFIX}{}", param.name), param.value.clone())));
    environment.sort();
    let files = std::iter::once(scripts::mavlink(settings)).chain(scripts::simulator(settings)).collect();
    Launch {
        args: vec!["-i".to_owned(), settings.instance.to_string(), "-d".to_owned()],
        first_args: Vec::new(),
        environment,
        files,
        parameters,
    }
}

/// Component ID of the autopilot in a parameter file.
const AUTOPILOT: u8 = 1;
/// Types of integers and real numbers in a parameter file (MAV_PARAM_TYPE).
const INTEGER_TYPE: u8 = 6;
const REAL_TYPE: u8 = 9;
/// File with the parameters of a flight controller.
const PARAMETER_FILE: &str = "flight-controller.params";
/// Beginnings of names of parameters that belong to PX4 as a process: its simulated battery, its three inertial sensors, which a
/// flight controller's link does not carry, and its log.
const PROCESS_ONLY: [&str; 5] = ["SIM_BAT_ENABLE", "IMU_", "EKF2_MULTI_IMU", "SENS_IMU_MODE", "SDLOG_"];
/// Output functions of a process and of a flight controller in the loop.
const PROCESS_OUTPUT: &str = "PWM_MAIN_FUNC";
const HIL_OUTPUT: &str = "HIL_ACT_FUNC";

/// Returns the file with the parameters with which a flight controller flies the aircraft, in QGroundControl's format. The user
/// loads it: a simulator must not overwrite the parameters of real hardware.
#[must_use]
pub fn hil_launch(vehicle: &Vehicle, settings: &LaunchSettings) -> Launch {
    let system_id = settings.instance + 1;
    let mut text =
        "# PX4 parameters of the simulated aircraft, for hardware in the loop. Save your own parameters first.\n".to_owned();
    let rows = airframe::parameters(vehicle, settings);
    for LaunchParam { name, value } in rows.iter().filter(|row| !PROCESS_ONLY.iter().any(|prefix| row.name.starts_with(prefix))) {
        let name = name.replace(PROCESS_OUTPUT, HIL_OUTPUT);
        let kind = if value.parse::<i32>().is_ok() { INTEGER_TYPE } else { REAL_TYPE };
        text.push_str(&format!("{system_id}\t{AUTOPILOT}\t{name}\t{value}\t{kind}\n"));
    }
    let file = LaunchFile { name: PARAMETER_FILE.to_owned(), text, executable: false };
    Launch { files: vec![file], ..Launch::default() }
}
