//! How to start PX4 for an aircraft.

use super::{airframe, scripts};
use crate::backend::launch::{Launch, LaunchSettings};
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
    Launch { args: vec!["-i".to_owned(), settings.instance.to_string(), "-d".to_owned()], environment, files, parameters }
}
