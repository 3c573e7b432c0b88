//! `spandrel rc`: runs the sans-IO bridge from stick input to MANUAL_CONTROL with a controller, a clock and a socket.

use crate::errors::{AppError, EXIT_CODES};
use crate::io::addresses;
use crate::io::clock::Stopwatch;
use crate::io::controller::{
    self, CalibratedController, ControllerReading, EventSource, PipedEvents, ProfileFolder, RawTerminal,
};
use crate::io::files;
use crate::io::net::{NetEvent, SocketHub, SocketId};
use crate::io::stop::StopRequest;
#[cfg(feature = "view")]
use crate::io::user_settings::SettingsFile;
use spandrel_clients::rc::controller_link::ControllerLink;
use spandrel_clients::rc::input_recording::InputRecording;
use spandrel_clients::rc::keyboard::{KeyBindings, KeyboardState};
use spandrel_clients::rc::wizard::CalibrationWizard;
use spandrel_clients::rc::{ControllerProfile, StickMode};
use spandrel_model::time::SimTime;
use spandrel_text::Language;
use std::io::BufRead;
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// Maximum time to wait for a datagram: one-quarter of the interval between stick samples.
const MAX_DATAGRAM_WAIT: Duration = Duration::from_millis(5);
/// Wall time without a datagram after which a connected vehicle is considered lost.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(10);
/// Wall time without a first datagram after which the program logs that it is waiting.
const WAITING_MESSAGE_DELAY: Duration = Duration::from_secs(3);
/// Key that quits the program in the terminal.
const QUIT_KEY: &str = "escape";
/// Interval at which the calibration wizard polls the device.
const POLL_INTERVAL: Duration = Duration::from_millis(5);
const STDIN_ENDED_MESSAGE: &str = "nothing was saved: calibration needs the Enter key, but standard input is closed (run this command in a terminal, or calibrate in the `spandrel train` window)";

/// Fly with a gamepad, an RC transmitter or the keyboard
///
/// Sends stick positions to the vehicle as MANUAL_CONTROL at 50 Hz, and button presses as commands. Calibrate each
/// device once (--calibrate); it is recognized from then on. If the device disconnects, the program briefly sends
/// centered sticks and then stops sending, which triggers the vehicle's own failsafe.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel rc --list                       list connected devices and show which are calibrated
  spandrel rc --calibrate                  calibrate a device in the terminal
  spandrel rc                              fly the simulator on this machine
  spandrel rc --keyboard                   W S A D and arrows fly, B lamp, P snapshot, T take off, L land, Escape quit
  spandrel rc --record flight.jsonl        record the device's input; --replay replays it

{EXIT_CODES}"))]
pub struct Args {
    /// Address of the vehicle
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address, default_value = "127.0.0.1:18570")]
    connect: SocketAddr,
    /// Local address to bind
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = addresses::listen)]
    listen: IpAddr,
    /// List the connected devices, one per line, and exit
    #[arg(long)]
    list: bool,
    /// Calibrate a device: assign its axes to the sticks, and save the profile
    #[arg(long, conflicts_with_all = ["list", "keyboard", "replay"])]
    calibrate: bool,
    /// Device ID or part of the device name [default: the only connected device]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Stick mode for the calibration (1 to 4); mode 2 has throttle and yaw on the left stick
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(i64).range(1..=4))]
    stick_mode: i64,
    /// Folder for calibration profiles [default: spandrel/controllers in the user's configuration folder]
    #[arg(long, value_name = "DIR")]
    profiles: Option<PathBuf>,
    /// Profile to use for any device
    #[arg(long, value_name = "FILE")]
    profile: Option<PathBuf>,
    /// Fly with the keyboard in the terminal
    #[arg(long, conflicts_with_all = ["replay", "device", "profile"])]
    keyboard: bool,
    /// Key bindings (TOML: format = 1, push, [sticks], [actions], [window]); the same file as for `spandrel view` [default: the
    /// keys in the window's settings]
    #[arg(long, value_name = "FILE", requires = "keyboard")]
    keys: Option<PathBuf>,
    /// Record the device's input, or the input of --replay, to this file
    #[arg(long, value_name = "FILE", conflicts_with = "keyboard")]
    record: Option<PathBuf>,
    /// Replay recorded input instead of using a device, and exit at the end; - reads the events from standard input, where another
    /// program writes them while it flies
    #[arg(long, value_name = "FILE", conflicts_with = "device")]
    replay: Option<PathBuf>,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if there is no device or terminal, the device is not calibrated, files are invalid, or the vehicle
/// is lost.
pub fn run(args: &Args) -> Result<(), AppError> {
    let profiles = ProfileFolder::at(args.profiles.clone());
    if args.list {
        return list(&profiles);
    }
    let stop = StopRequest::install(false)?;
    if args.calibrate {
        return calibrate(args, &profiles, &stop);
    }
    let mut pilot = pilot(args, &profiles)?;
    let mut hub = SocketHub::new();
    let socket = hub.bind(args.listen, 0, "--listen")?;
    let flown = fly(&mut pilot, &mut hub, socket, args.connect, &stop);
    drop(pilot);
    flown
}

fn list(profiles: &ProfileFolder) -> Result<(), AppError> {
    let devices = controller::connected()?;
    for device in &devices {
        let known = if profiles.find(device)?.is_some() { "calibrated" } else { "not calibrated" };
        println!("{}  {}  {known}", device.id, device.name);
    }
    if devices.is_empty() {
        tracing::info!("no gamepad or transmitter is connected");
    }
    Ok(())
}

/// Where the stick input comes from.
enum StickSource {
    Device(Box<CalibratedController>),
    Keyboard { terminal: RawTerminal, board: KeyboardState },
}

/// Key bindings, and the file that contains them if they are not the defaults.
type KeyFile = (KeyBindings, Option<PathBuf>);

/// Returns the key bindings of a file or, without one, those of the window's settings.
fn key_bindings(file: Option<&Path>) -> Result<KeyFile, AppError> {
    match file {
        Some(path) => Ok((controller::keys(Some(path))?, Some(path.to_path_buf()))),
        None => Ok(window_keys()),
    }
}

#[cfg(feature = "view")]
fn window_keys() -> KeyFile {
    settings_keys(&SettingsFile::of_user())
}

/// Without the window, there are no settings.
#[cfg(not(feature = "view"))]
fn window_keys() -> KeyFile {
    (KeyBindings::default(), None)
}

/// Returns the keys of the window's settings. As in the window, invalid settings are reported and the defaults apply.
#[cfg(feature = "view")]
fn settings_keys(file: &SettingsFile) -> KeyFile {
    match file.load() {
        Ok(settings) => (settings.keys, file.path().filter(|path| path.exists()).map(Path::to_path_buf)),
        Err(error) => {
            tracing::warn!("{error}; using the default keys");
            (KeyBindings::default(), None)
        }
    }
}

fn pilot(args: &Args, profiles: &ProfileFolder) -> Result<StickSource, AppError> {
    if args.keyboard {
        let (keys, file) = key_bindings(args.keys.as_deref())?;
        if let Some(duty) = keys.binding_name(QUIT_KEY) {
            let file = file.map_or(String::new(), |path| format!("{}: ", path.display()));
            return Err(AppError::invalid(format!(
                "{file}{duty} = \"{QUIT_KEY}\": this key quits the program in the terminal; choose another one"
            )));
        }
        let words = keys.help_text();
        let terminal = RawTerminal::enter()?;
        print_line(&format!("{words}\n{QUIT_KEY:10} quit"));
        if !terminal.reports_releases {
            print_line(
                "this terminal does not report key releases: sticks return to center automatically, and you can repeat a key's action only after a 0.7 s pause",
            );
        }
        return Ok(StickSource::Keyboard { terminal, board: KeyboardState::new(keys) });
    }
    let source = match &args.replay {
        Some(path) if path.as_os_str() == "-" => EventSource::Piped(PipedEvents::open()?),
        Some(path) => EventSource::Record(
            InputRecording::read(&path.display().to_string(), &files::read(path)?).map_err(AppError::invalid)?,
        ),
        None => EventSource::device(args.device.as_deref())?,
    };
    Ok(StickSource::Device(Box::new(CalibratedController::open(
        source,
        profiles,
        args.profile.as_deref(),
        args.record.as_deref(),
    )?)))
}

/// Writes a line to standard error, with a carriage return because the terminal may be in raw mode.
fn print_line(text: &str) {
    eprint!("{}\r\n", text.replace('\n', "\r\n"));
}

impl StickSource {
    fn poll(&mut self, link: &mut ControllerLink, flown: SimTime, now: SimTime) -> Result<ControllerReading, AppError> {
        match self {
            Self::Device(hand) => Ok(hand.poll(link, flown, now)),
            Self::Keyboard { terminal, board } => {
                let mut over = false;
                while let Some(key) = terminal.next() {
                    match key {
                        controller::TerminalKey::Down(key) => board
                            .press(&key, terminal.reports_releases, now)
                            .into_iter()
                            .for_each(|action| link.request_action(action, now)),
                        controller::TerminalKey::Up(key) => board.release(&key),
                        controller::TerminalKey::FocusLost => board.release_all(),
                        controller::TerminalKey::Quit => over = true,
                    }
                }
                Ok(ControllerReading { sticks: Some(board.sticks(now)), over })
            }
        }
    }
}

fn fly(
    pilot: &mut StickSource,
    hub: &mut SocketHub,
    socket: SocketId,
    vehicle: SocketAddr,
    stop: &StopRequest,
) -> Result<(), AppError> {
    let (watch, mut link, mut last_received_at) = (Stopwatch::start(), ControllerLink::default(), None);
    // A recording starts at the first contact with the vehicle.
    let (mut begin, mut told) = (None, false);
    if let StickSource::Keyboard { board, .. } = pilot {
        link.set_arm_key(&board.keys().label("arm", Language::English));
    }
    while !stop.is_requested() {
        if let Some(NetEvent::Datagram { from, bytes, .. }) = hub.next(MAX_DATAGRAM_WAIT)
            && from == vehicle
        {
            if last_received_at.is_none() {
                print_line(&format!("connected to the vehicle at {vehicle}"));
            }
            last_received_at = Some(watch.elapsed());
            link.receive(&bytes);
        }
        if last_received_at.is_none() && !told && watch.elapsed() > WAITING_MESSAGE_DELAY {
            print_line(&format!("waiting for a vehicle at {vehicle}"));
            told = true;
        }
        let now = SimTime::from_s(watch.elapsed().as_secs_f64());
        if link.vehicle.system.is_some() {
            begin.get_or_insert(now);
        }
        let flown = begin.map_or(SimTime::ZERO, |begin| now - begin);
        let look = pilot.poll(&mut link, flown, now)?;
        link.set_sticks(look.sticks, now);
        link.handle_timeout(now);
        while let Some(bytes) = link.poll_transmit() {
            hub.send(socket, vehicle, &bytes);
        }
        while let Some(text) = link.poll_message() {
            print_line(&text);
        }
        if look.over {
            return Ok(());
        }
        if last_received_at.is_some_and(|last| watch.elapsed().saturating_sub(last) > SILENCE_TIMEOUT) {
            return Err(AppError::failed(format!("no data from the vehicle for {} s", SILENCE_TIMEOUT.as_secs())));
        }
    }
    Ok(())
}

fn calibrate(args: &Args, profiles: &ProfileFolder, stop: &StopRequest) -> Result<(), AppError> {
    // Fail early if the profile could not be saved.
    profiles.folder()?;
    let mut source = EventSource::device(args.device.as_deref())?;
    let mode = StickMode::from_number(args.stick_mode).unwrap_or(StickMode::Two);
    let profile = run_wizard(&mut source, mode, &enter_key_events(), stop)?;
    println!("{}", profiles.save(&profile)?.display());
    Ok(())
}

fn run_wizard(
    source: &mut EventSource,
    mode: StickMode,
    enters: &Receiver<()>,
    stop: &StopRequest,
) -> Result<ControllerProfile, AppError> {
    let mut wizard = CalibrationWizard::new(source.device_info().clone(), mode);
    let watch = Stopwatch::start();
    let mut told = String::new();
    while !stop.is_requested() {
        let now = SimTime::from_s(watch.elapsed().as_secs_f64());
        while let Some(event) = source.next(now) {
            wizard.handle(event, now);
        }
        match enters.recv_timeout(POLL_INTERVAL) {
            Ok(()) => wizard.confirm(now),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(AppError::failed(STDIN_ENDED_MESSAGE)),
        }
        wizard.handle_timeout(now);
        if let Some(profile) = wizard.profile() {
            return Ok(profile);
        }
        let prompt = wizard.prompt(Language::English);
        if prompt != told {
            print_line(&prompt);
            told = prompt;
        }
    }
    Err(AppError::failed("stopped: nothing was saved"))
}

/// Returns a channel that receives a message each time the user presses Enter.
fn enter_key_events() -> Receiver<()> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for _ in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(()).is_err() {
                break;
            }
        }
    });
    receiver
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct TestArgs {
        #[command(flatten)]
        args: Args,
    }

    #[test]
    fn exact_calibration_requires_profile_folder() {
        let args = TestArgs::parse_from(["rc", "--calibrate"]).args;
        let told = calibrate(&args, &ProfileFolder::default(), &StopRequest::default()).unwrap_err().to_string();
        assert!(told.contains("specify a profile folder with --profiles"), "{told}");
    }

    #[cfg(feature = "view")]
    #[test]
    fn regress_the_keyboard_has_the_keys_of_the_window_settings() {
        use crate::io::user_settings::UserSettings;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        let file = SettingsFile::at(path.clone());
        assert_eq!(settings_keys(&file), (KeyBindings::default(), None));
        let mut settings = UserSettings::default();
        settings.keys.rebind("take_off", "e");
        file.save(&settings).unwrap();
        let (keys, from) = settings_keys(&file);
        assert_eq!((keys.of("take_off"), from), (Some("e"), Some(path.clone())));
        std::fs::write(&path, "format = 9").unwrap();
        assert_eq!(settings_keys(&file), (KeyBindings::default(), None), "invalid settings, as in the window");
    }

    #[test]
    fn exact_calibration_fails_when_standard_input_ends() {
        let record = InputRecording::read("r", "{\"format\":1,\"device\":\"Pad\",\"id\":\"1:2\"}").unwrap();
        let (_, enters) = channel();
        let told = run_wizard(&mut EventSource::Record(record), StickMode::Two, &enters, &StopRequest::default())
            .unwrap_err()
            .to_string();
        assert!(told.starts_with("nothing was saved") && told.contains("standard input is closed"), "{told}");
    }
}
