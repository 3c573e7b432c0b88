//! How to start ArduPilot's copter firmware with the JSON interface.

use super::airframe::parameters;
use super::frame::FrameError;
use crate::backend::launch::{Launch, LaunchFile, LaunchParam, LaunchSettings};
use spandrel_model::vehicle::Vehicle;

/// Name of the file with ArduPilot's parameters.
pub const DEFAULTS_FILE: &str = "spandrel.parm";
/// Simulated seconds per second above which ArduPilot would slow itself down. The simulator sets the pace by the time of its
/// replies.
const MAX_SPEEDUP: u32 = 100;
/// Deletes the parameters that an earlier session saved in the working directory, because they would override the defaults. Only
/// at the first start: parameters that were set in flight survive a crash and a reboot, as on a real aircraft. ArduPilot removes
/// this option, but not `--wipe`, when a reboot command restarts it.
const WIPE: &str = "-w";
/// Number of serial ports besides the first one. All of them stay closed: they would listen on TCP ports.
const OTHER_SERIAL_PORTS: [u8; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

/// Returns the arguments and files that start ArduPilot for an aircraft, in a working directory of its own. Errors if ArduPilot has
/// no frame for the aircraft's rotors.
///
/// ArduPilot listens on no fixed port. Its receiver binds one on all addresses even if the simulator provides the stick positions,
/// but does not read it then; the operating system chooses its number, so that instances cannot collide.
pub fn launch(vehicle: &Vehicle, settings: &LaunchSettings) -> Result<Launch, FrameError> {
    let parameters = parameters(vehicle, settings)?;
    let file = LaunchFile { name: DEFAULTS_FILE.into(), text: defaults_text(&parameters), executable: false };
    Ok(Launch { args: args(settings), first_args: vec![WIPE.into()], environment: Vec::new(), files: vec![file], parameters })
}

fn args(settings: &LaunchSettings) -> Vec<String> {
    let home = settings.home;
    let mut args: Vec<String> = Vec::new();
    let mut option = |name: &str, value: String| args.extend([format!("--{name}"), value]);
    option("model", "JSON:127.0.0.1".into());
    option("sim-port-out", settings.simulator_port.to_string());
    option("instance", settings.instance.to_string());
    let place = format!("{:.8},{:.8},{:.3}", home.latitude_deg, home.longitude_deg, home.altitude_m);
    option("home", format!("{place},{:.1}", settings.home_heading_deg));
    option("defaults", DEFAULTS_FILE.into());
    option("rate", format!("{:.0}", settings.rate_hz));
    option("speedup", MAX_SPEEDUP.to_string());
    option("serial0", format!("udpclient:127.0.0.1:{}", settings.mavlink_port));
    option("rc-in-port", "0".into());
    for port in OTHER_SERIAL_PORTS {
        option(&format!("serial{port}"), "none:".into());
    }
    args
}

/// Writes one parameter a line.
fn defaults_text(parameters: &[LaunchParam]) -> String {
    let mut text =
        String::from("# Written by Spandrel. Lines with names that this version of ArduPilot does not know have no effect.\n");
    for parameter in parameters {
        text.push_str(&format!("{} {}\n", parameter.name, parameter.value));
    }
    text
}
