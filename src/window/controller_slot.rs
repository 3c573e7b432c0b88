//! The window's controller: detects, tests and calibrates it, and flies with it.

use crate::errors::AppError;
use crate::io::controller::{CalibratedController, DeviceError, DeviceWatcher, EventSource, ProfileFolder};
use spandrel_clients::rc::action::ControllerAction;
use spandrel_clients::rc::controller_link::ControllerLink;
use spandrel_clients::rc::wizard::CalibrationWizard;
use spandrel_clients::rc::{ControllerProfile, RawInput, StickMode, Sticks};
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};
use spandrel_view::flow::{ControllerStatus, ProfileChange};

/// Controller state.
enum DeviceState {
    /// No controller; the watcher detects a new one.
    NoDevice(DeviceWatcher),
    /// Connected, but not calibrated.
    Uncalibrated(EventSource, RawInput),
    /// Calibrated and used for flying.
    Calibrated(Box<CalibratedController>),
    /// Being calibrated in the wizard.
    Calibrating(EventSource, Box<CalibrationWizard>),
}

/// The window's controller, if any.
pub struct ControllerSlot {
    requested_device: Option<String>,
    profiles: ProfileFolder,
    held: DeviceState,
    /// Watches for another device while the current one is disconnected.
    replacement_watcher: Option<DeviceWatcher>,
    mode: StickMode,
    note: ControllerNote,
    language: Language,
}

/// Message about the controller, shown on the controller page.
#[derive(Debug, Clone, PartialEq, Eq)]
enum ControllerNote {
    None,
    /// Why there is no controller.
    NoDevice(DeviceError),
    /// Where its profile is stored.
    Profile(String),
    NotCalibrated(String),
    /// Why its profile cannot be used.
    InvalidProfile(String),
    Saved(String),
    NotSaved(String),
    Disabled(String),
}

impl ControllerNote {
    fn words(&self, language: Language) -> String {
        match self {
            Self::None => String::new(),
            Self::NoDevice(why) => no_device_words(why, language),
            Self::Profile(file) => text!(language, "window-controls-note-profile", file = file.as_str()),
            Self::NotCalibrated(name) => text!(language, "window-controls-note-not-calibrated", name = name.as_str()),
            Self::InvalidProfile(why) => text!(language, "window-controls-note-invalid-profile", error = why.as_str()),
            Self::Saved(file) => text!(language, "window-controls-note-saved", file = file.as_str()),
            Self::NotSaved(why) => text!(language, "window-controls-note-not-saved", error = why.as_str()),
            Self::Disabled(why) => text!(language, "window-controls-note-disabled", error = why.as_str()),
        }
    }
}

/// Explains why there is no controller, without the hints for the command line.
fn no_device_words(why: &DeviceError, language: Language) -> String {
    match why {
        #[cfg(feature = "gamepad")]
        DeviceError::NotConnected => text!(language, "window-controls-note-none"),
        #[cfg(feature = "gamepad")]
        DeviceError::NoMatch { connected, .. } if connected.is_empty() => text!(language, "window-controls-note-none"),
        #[cfg(feature = "gamepad")]
        DeviceError::NoMatch { wanted, connected } => {
            let connected = connected.join(", ");
            text!(language, "window-controls-note-no-match", wanted = wanted.as_str(), connected = connected)
        }
        #[cfg(feature = "gamepad")]
        DeviceError::Ambiguous { connected } => {
            text!(language, "window-controls-note-ambiguous", connected = connected.join(", "))
        }
        #[cfg(feature = "gamepad")]
        DeviceError::NoAccess(error) => text!(language, "window-controls-note-no-access", error = error.as_str()),
        #[cfg(not(feature = "gamepad"))]
        DeviceError::Unsupported { .. } => text!(language, "window-controls-note-unsupported"),
    }
}

impl ControllerSlot {
    /// Finds the device with this name, or the only device.
    pub fn new(wanted: Option<String>, profiles: ProfileFolder) -> Self {
        let mut desk = Self {
            requested_device: wanted,
            profiles,
            held: DeviceState::NoDevice(DeviceWatcher::default()),
            replacement_watcher: None,
            mode: StickMode::Two,
            note: ControllerNote::None,
            language: Language::default(),
        };
        desk.find_device();
        desk
    }

    /// Searches for the device again.
    pub fn find_device(&mut self) {
        match EventSource::device(self.requested_device.as_deref()) {
            Ok(source) => self.open_controller(source),
            Err(error) => {
                self.held = DeviceState::NoDevice(DeviceWatcher::start());
                self.note = ControllerNote::NoDevice(error);
            }
        }
    }

    /// Opens a newly connected device. Returns true if there is a new device, even if it is not calibrated.
    pub fn open_new_device(&mut self) -> bool {
        let DeviceState::NoDevice(watch) = &mut self.held else { return self.replace_disconnected() };
        if !watch.is_available() {
            return false;
        }
        self.find_device();
        !matches!(self.held, DeviceState::NoDevice(_))
    }

    /// Opens another device if the current device is disconnected, unless only the current device is calibrated.
    fn replace_disconnected(&mut self) -> bool {
        if !self.lost() || matches!(self.held, DeviceState::Calibrating(..)) {
            self.replacement_watcher = None;
            return false;
        }
        if !self.replacement_watcher.get_or_insert_with(DeviceWatcher::start).is_available() {
            return false;
        }
        let Ok(source) = EventSource::device(self.requested_device.as_deref()) else { return false };
        if self.is_calibrated() && !matches!(self.profiles.find(source.device_info()), Ok(Some(_))) {
            return false;
        }
        self.open_controller(source);
        true
    }

    fn open_controller(&mut self, source: EventSource) {
        let device = source.device_info().clone();
        (self.held, self.note) = match self.profiles.find(&device) {
            Ok(Some(profile)) => {
                self.mode = profile.mode;
                let place = self.profiles.path(&device);
                let note = place.map_or(ControllerNote::None, |path| ControllerNote::Profile(path.display().to_string()));
                (DeviceState::Calibrated(Box::new(CalibratedController::new(source, profile))), note)
            }
            Ok(None) => {
                (DeviceState::Uncalibrated(source, RawInput::default()), ControllerNote::NotCalibrated(device.name.clone()))
            }
            Err(error) => {
                (DeviceState::Uncalibrated(source, RawInput::default()), ControllerNote::InvalidProfile(error.to_string()))
            }
        };
    }

    /// Returns true if the controller is calibrated, even if it is disconnected.
    pub fn is_calibrated(&self) -> bool {
        matches!(self.held, DeviceState::Calibrated(_))
    }

    /// Returns true if the device has been disconnected.
    pub fn lost(&self) -> bool {
        match &self.held {
            DeviceState::NoDevice(_) => false,
            DeviceState::Uncalibrated(_, raw) => raw.lost,
            DeviceState::Calibrated(hand) => hand.raw().lost,
            DeviceState::Calibrating(_, wizard) => wizard.lost(),
        }
    }

    /// Returns the controller's name, if there is one.
    pub fn name(&self) -> Option<&str> {
        match &self.held {
            DeviceState::NoDevice(_) => None,
            DeviceState::Uncalibrated(source, _) | DeviceState::Calibrating(source, _) => Some(&source.device_info().name),
            DeviceState::Calibrated(hand) => Some(&hand.profile().device.name),
        }
    }

    /// Returns the reason why only the keyboard can fly the vehicle, or `None` if a controller can be used.
    pub fn keyboard_only_reason(&self) -> Option<String> {
        match self.name() {
            Some(name) if self.lost() => Some(text!(self.language, "window-controls-note-lost", name = name)),
            _ => (!self.is_calibrated()).then(|| self.note()),
        }
    }

    /// Returns the location of the controller's profile, or the reason why there is no controller.
    pub fn note(&self) -> String {
        self.note.words(self.language)
    }

    /// Sets the language of the notes and of the wizard.
    pub fn set_language(&mut self, language: Language) {
        self.language = language;
    }

    /// Starts the calibration wizard. If the device is disconnected, searches for it first.
    pub fn calibrate(&mut self) {
        if self.lost() {
            self.find_device();
        }
        self.held = match self.take_device() {
            DeviceState::NoDevice(watch) => DeviceState::NoDevice(watch),
            DeviceState::Uncalibrated(source, _) | DeviceState::Calibrating(source, _) => self.start_wizard(source),
            DeviceState::Calibrated(hand) => self.start_wizard(hand.release()),
        };
    }

    fn take_device(&mut self) -> DeviceState {
        std::mem::replace(&mut self.held, DeviceState::NoDevice(DeviceWatcher::default()))
    }

    fn start_wizard(&self, source: EventSource) -> DeviceState {
        let wizard = CalibrationWizard::new(source.device_info().clone(), self.mode);
        DeviceState::Calibrating(source, Box::new(wizard))
    }

    /// Handles the Enter key in the wizard.
    pub fn confirm(&mut self, now: SimTime) {
        if let DeviceState::Calibrating(_, wizard) = &mut self.held {
            wizard.confirm(now);
        }
    }

    /// Leaves the wizard without changes. If the device has since been disconnected, searches for it again, so that it
    /// does not appear connected with its sticks at rest.
    pub fn cancel(&mut self) {
        let lost = self.lost();
        match self.take_device() {
            DeviceState::Calibrating(..) if lost => self.find_device(),
            DeviceState::Calibrating(source, _) => self.open_controller(source),
            held @ (DeviceState::NoDevice(_) | DeviceState::Uncalibrated(..) | DeviceState::Calibrated(_)) => self.held = held,
        }
    }

    /// Changes the profile and saves it.
    pub fn adjust_profile(&mut self, tune: ProfileChange) {
        if let ProfileChange::Mode(number) = tune {
            self.mode = StickMode::from_number(number).unwrap_or(self.mode);
        }
        let DeviceState::Calibrated(hand) = &mut self.held else { return };
        let profile = adjusted_profile(hand.profile(), tune);
        hand.set_profile(profile.clone());
        self.save_profile(&profile);
    }

    fn save_profile(&mut self, profile: &ControllerProfile) {
        self.note = match self.profiles.save(profile) {
            Ok(path) => ControllerNote::Saved(path.display().to_string()),
            Err(error) => ControllerNote::NotSaved(error.to_string()),
        };
    }

    /// Returns a calibrated device's current stick positions. The device's buttons trigger actions on the link.
    ///
    /// # Errors
    /// Returns an error if the device can no longer be used.
    pub fn sticks(&mut self, link: &mut ControllerLink, now: SimTime) -> Result<Option<Sticks>, AppError> {
        match &mut self.held {
            DeviceState::NoDevice(_) => Ok(None),
            DeviceState::Uncalibrated(source, raw) => {
                std::iter::from_fn(|| source.next(now)).for_each(|event| raw.apply(event));
                Ok(None)
            }
            DeviceState::Calibrated(hand) => Ok(hand.poll(link, now, now).sticks),
            DeviceState::Calibrating(source, wizard) => {
                std::iter::from_fn(|| source.next(now)).for_each(|event| wizard.handle(event, now));
                wizard.handle_timeout(now);
                if let Some(profile) = wizard.profile() {
                    self.save_profile(&profile);
                    if let DeviceState::Calibrating(source, _) = self.take_device() {
                        self.held = DeviceState::Calibrated(Box::new(CalibratedController::new(source, profile)));
                    }
                }
                Ok(None)
            }
        }
    }

    /// Disables the controller and stores the reason.
    pub fn disable(&mut self, why: &AppError) {
        self.held = DeviceState::NoDevice(DeviceWatcher::start());
        self.note = ControllerNote::Disabled(why.to_string());
    }

    /// Returns the name of the button with this action. Its number would mean nothing to a person.
    fn button_name(&self, action: ControllerAction) -> String {
        text!(self.language, "flight-how-button", function = action.short_title(self.language))
    }

    /// Returns the status for the controller page; `keyboard` contains the stick positions from the keyboard, `keys` the names of
    /// its keys with what they do.
    pub fn controls(&self, keyboard: Sticks, keys: Vec<(String, String)>) -> ControllerStatus {
        let plain = ControllerStatus {
            device: self.name().map(str::to_owned),
            lost: self.lost(),
            mode: self.mode.number(),
            note: self.note(),
            keys,
            ..ControllerStatus::default()
        };
        let from_rest = |(axis, value): (&u32, &f64)| (*axis, *value, (value.min(0.0), value.max(0.0)));
        match &self.held {
            DeviceState::Calibrating(_, wizard) => {
                ControllerStatus { axes: wizard.axes().collect(), wizard: Some(wizard.prompt(self.language)), ..plain }
            }
            _ if plain.device.is_none() || plain.lost => ControllerStatus {
                mode: 2,
                sticks: StickMode::Two.physical_sticks(keyboard),
                calibrated: self.is_calibrated(),
                ..plain
            },
            DeviceState::NoDevice(_) => plain,
            DeviceState::Uncalibrated(_, raw) => ControllerStatus { axes: raw.axes.iter().map(from_rest).collect(), ..plain },
            DeviceState::Calibrated(hand) => {
                let profile = hand.profile();
                let axis = profile.axes.values().next();
                ControllerStatus {
                    calibrated: true,
                    buttons: profile.buttons.values().map(|action| (action.name(), self.button_name(*action))).collect(),
                    dead_band: axis.map_or(0.0, |axis| axis.dead_band),
                    expo: axis.map_or(0.0, |axis| axis.expo),
                    sticks: profile.mode.physical_sticks(profile.sticks(hand.raw())),
                    ..plain
                }
            }
        }
    }
}

/// Returns a profile with one setting changed. All other settings of each axis keep their measured or edited values.
fn adjusted_profile(profile: &ControllerProfile, tune: ProfileChange) -> ControllerProfile {
    let mut profile = profile.clone();
    match tune {
        ProfileChange::Mode(number) => profile.mode = StickMode::from_number(number).unwrap_or(profile.mode),
        ProfileChange::DeadBand(part) => profile.axes.values_mut().for_each(|axis| axis.dead_band = part),
        ProfileChange::Expo(expo) => profile.axes.values_mut().for_each(|axis| axis.expo = expo),
    }
    profile
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_clients::rc::axis::AxisCalibration;
    use spandrel_clients::rc::profile::STICK_AXES;
    use spandrel_clients::rc::{Device, DeviceEvent, input_recording};

    /// Creates a slot with a calibrated device that reports these events.
    fn held(events: &[(f64, DeviceEvent)]) -> ControllerSlot {
        let axis = |n: u32| AxisCalibration { axis: n, low: -1.0, centre: 0.0, high: 1.0, dead_band: 0.0, expo: 0.0 };
        let ways = STICK_AXES.iter().zip(0..).map(|((_, way), n)| (*way, axis(n))).collect();
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let lines = events.iter().map(|(s, event)| input_recording::line(SimTime::from_s(*s), *event));
        let text: Vec<String> = std::iter::once(input_recording::head(&device)).chain(lines).collect();
        let source = EventSource::Record(input_recording::InputRecording::read("pad.jsonl", &text.join("\n")).unwrap());
        let profile = ControllerProfile { device, mode: StickMode::Two, axes: ways, buttons: [].into() };
        ControllerSlot {
            // A name that matches no device on this computer.
            requested_device: Some("no device is called so".into()),
            profiles: ProfileFolder::at(None),
            held: DeviceState::Calibrated(Box::new(CalibratedController::new(source, profile))),
            replacement_watcher: None,
            mode: StickMode::Two,
            note: ControllerNote::None,
            language: Language::default(),
        }
    }

    #[test]
    #[cfg(feature = "gamepad")]
    fn exact_reasons_are_in_the_language_of_the_window() {
        let connected = vec!["'A' (1:2)".to_owned(), "'B' (3:4)".to_owned()];
        let no_match = |connected| DeviceError::NoMatch { wanted: "Pad".into(), connected };
        let words = |why: &DeviceError| no_device_words(why, Language::German);
        let none = "Kein Gamepad und keine Fernsteuerung verbunden.";
        assert_eq!((words(&DeviceError::NotConnected).as_str(), words(&no_match(Vec::new())).as_str()), (none, none));
        assert_eq!(words(&no_match(connected.clone())), "Kein Gerät passt zu 'Pad' (verbunden: 'A' (1:2), 'B' (3:4)).");
        let several = DeviceError::Ambiguous { connected };
        assert_eq!(words(&several), "Mehrere Geräte passen ('A' (1:2), 'B' (3:4)). Lassen Sie nur eines verbunden.");
        assert!(words(&DeviceError::NoAccess("x".into())).ends_with(": x"));
    }

    fn poll_sticks(desk: &mut ControllerSlot, s: f64) -> Option<Sticks> {
        desk.open_new_device();
        desk.sticks(&mut ControllerLink::default(), SimTime::from_s(s)).unwrap()
    }

    #[test]
    fn exact_disconnected_device_sends_no_sticks_until_it_reconnects() {
        let pushed = DeviceEvent::Axis { axis: 0, value: 1.0 };
        let mut desk = held(&[(0.0, pushed), (1.0, DeviceEvent::Lost), (2.0, DeviceEvent::Found)]);
        assert!(poll_sticks(&mut desk, 0.5).is_some() && desk.keyboard_only_reason().is_none());
        assert_eq!(poll_sticks(&mut desk, 1.5), None);
        let keys = Sticks { up: 1.0, ..Sticks::default() };
        let shown = desk.controls(keys, Vec::new());
        assert!(shown.lost && !shown.is_connected() && shown.sticks == StickMode::Two.physical_sticks(keys), "{shown:?}");
        assert_eq!(desk.keyboard_only_reason().as_deref(), Some("'Pad' is not connected."));
        assert_eq!(poll_sticks(&mut desk, 2.5), Some(Sticks::default()));
        assert!(!desk.controls(keys, Vec::new()).lost);
    }

    #[test]
    fn regress_device_disconnected_in_wizard_stays_disconnected() {
        for lost_s in [1.0, 3.0] {
            let mut desk = held(&[(lost_s, DeviceEvent::Lost)]);
            poll_sticks(&mut desk, 2.0);
            desk.calibrate();
            poll_sticks(&mut desk, 4.0);
            desk.cancel();
            assert_eq!(poll_sticks(&mut desk, 5.0), None, "lost at {lost_s} s");
            assert!(!desk.is_calibrated() && !desk.note().is_empty(), "the reason is shown");
        }
        let mut desk = held(&[]);
        desk.cancel();
        assert!(desk.is_calibrated(), "leaving a finished wizard changes nothing");
    }

    #[test]
    fn exact_profile_changes_keep_other_axis_settings() {
        let axis = |n: u32| {
            let own = f64::from(n) / 10.0;
            AxisCalibration { axis: n, low: -1.0, centre: 0.0, high: 1.0, dead_band: own, expo: 2.0 * own }
        };
        let ways = STICK_AXES.iter().zip(0..).map(|((_, way), n)| (*way, axis(n))).collect();
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let before = ControllerProfile { device, mode: StickMode::Two, axes: ways, buttons: [].into() };
        let of = |profile: &ControllerProfile| profile.axes.values().map(|axis| (axis.dead_band, axis.expo)).collect::<Vec<_>>();
        let own = of(&before);
        assert_eq!(
            adjusted_profile(&before, ProfileChange::Mode(4)),
            ControllerProfile { mode: StickMode::Four, ..before.clone() }
        );
        let still = adjusted_profile(&before, ProfileChange::DeadBand(0.07));
        assert_eq!(of(&still), own.iter().map(|(_, expo)| (0.07, *expo)).collect::<Vec<_>>());
        let straight = adjusted_profile(&before, ProfileChange::Expo(0.0));
        assert_eq!(of(&straight), own.iter().map(|(dead_band, _)| (*dead_band, 0.0)).collect::<Vec<_>>());
    }
}
