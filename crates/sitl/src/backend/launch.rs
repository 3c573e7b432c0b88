//! Command line, environment and files with which an autopilot is started.

/// A file to write before the autopilot starts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LaunchFile {
    /// Name, relative to the working directory.
    pub name: String,
    /// Contents.
    pub text: String,
    /// Whether the file is a program.
    pub executable: bool,
}

/// A parameter that is set when the autopilot starts.
#[derive(Debug, Clone, PartialEq)]
pub struct LaunchParam {
    /// The autopilot's name for it.
    pub name: String,
    /// Value, formatted as the autopilot reads it: integers without a decimal point.
    pub value: String,
}

/// How to start an autopilot in its working directory.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Launch {
    /// Arguments after the program.
    pub args: Vec<String>,
    /// Arguments after those, for the first start only.
    pub first_args: Vec<String>,
    /// Environment variables, sorted by name.
    pub environment: Vec<(String, String)>,
    /// Files in the working directory.
    pub files: Vec<LaunchFile>,
    /// Parameters that the arguments, the environment or the files set.
    pub parameters: Vec<LaunchParam>,
}

impl Launch {
    /// Returns the arguments of the first or of a later start.
    pub fn args(&self, is_first: bool) -> impl Iterator<Item = &String> {
        self.args.iter().chain(self.first_args.iter().filter(move |_| is_first))
    }

    /// Returns the line that starts `program` from a POSIX shell in the working directory, with more environment variables and
    /// with arguments after those of the launch.
    #[must_use]
    pub fn command_line(
        &self,
        is_first: bool,
        program: &str,
        more_environment: &[(String, String)],
        last_args: &[String],
    ) -> String {
        let variables =
            self.environment.iter().chain(more_environment).map(|(name, value)| format!("{name}={}", shell_quoted(value)));
        let args = self.args(is_first).chain(last_args).map(|arg| shell_quoted(arg));
        let words: Vec<String> = variables.chain([shell_quoted(program)]).chain(args).collect();
        words.join(" ")
    }
}

/// Addresses and settings that do not come from the vehicle file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaunchSettings {
    /// Zero-based vehicle number. The system ID is one higher.
    pub instance: u8,
    /// Port of the simulator interface: TCP for PX4, UDP for ArduPilot.
    pub simulator_port: u16,
    /// UDP port of Spandrel that the autopilot sends its MAVLink messages to, on the loopback interface.
    pub mavlink_port: u16,
    /// Free UDP port for the autopilot's own end of that link.
    pub autopilot_port: u16,
    /// Simulated seconds per second of the clients' clocks, at least 1: lengthens the autopilot's timeouts for lost clients.
    pub client_speed_factor: f64,
    /// Rate at which the simulator sends readings, Hz.
    pub rate_hz: f64,
    /// Geographic position and altitude (m above sea level) of the landing pad, where the aircraft starts.
    pub home: spandrel_model::geodesy::Geo,
    /// Heading of the aircraft on the pad, degrees clockwise from north.
    pub home_heading_deg: f64,
    /// Battery thresholds of the job, %: low and critical.
    pub battery_thresholds_pct: (f64, f64),
}

/// Quotes text for a POSIX shell unless it consists of harmless characters.
#[must_use]
pub fn shell_quoted(text: &str) -> String {
    let harmless = |c: char| c.is_ascii_alphanumeric() || "_-./:=+,@%".contains(c);
    if !text.is_empty() && text.chars().all(harmless) { text.to_owned() } else { format!("'{}'", text.replace('\'', r"'\''")) }
}
