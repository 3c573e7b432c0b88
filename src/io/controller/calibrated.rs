//! Converts a calibrated controller's events to stick positions and actions.

use super::{EventSource, ProfileFolder, read_profile};
use crate::errors::AppError;
use spandrel_clients::rc::controller_link::ControllerLink;
use spandrel_clients::rc::input_recording;
use spandrel_clients::rc::{ControllerProfile, Device, DeviceEvent, RawInput, Sticks};
use spandrel_model::time::SimTime;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A calibrated controller with its event source and optional recording.
#[derive(Debug)]
pub struct CalibratedController {
    source: EventSource,
    profile: ControllerProfile,
    raw: RawInput,
    log: Option<InputLog>,
}

#[derive(Debug)]
struct InputLog {
    path: PathBuf,
    file: File,
    /// Length of the complete lines on disk, bytes.
    written_len: u64,
}

impl InputLog {
    fn begin(path: &Path, device: &Device) -> Result<Self, AppError> {
        let failed = |error: std::io::Error| AppError::invalid(format!("{}: {error}", path.display()));
        let mut log = Self { path: path.to_owned(), file: File::create(path).map_err(failed)?, written_len: 0 };
        log.line(input_recording::head(device)).map_err(failed)?;
        Ok(log)
    }

    fn write(&mut self, now: SimTime, event: DeviceEvent) -> std::io::Result<()> {
        self.line(input_recording::line(now, event))
    }

    /// Appends the whole line or nothing.
    fn line(&mut self, mut line: String) -> std::io::Result<()> {
        line.push('\n');
        self.file.write_all(line.as_bytes()).inspect_err(|_| {
            // A partial line would make the entire recording unreadable.
            let _ = self.file.set_len(self.written_len);
        })?;
        self.written_len += line.len() as u64;
        Ok(())
    }
}

/// Result of polling a controller.
#[derive(Debug)]
pub struct ControllerReading {
    /// Stick positions; `None` while the device is disconnected.
    pub sticks: Option<Sticks>,
    /// True at the end of a replayed recording.
    pub over: bool,
}

impl CalibratedController {
    /// Opens a calibrated controller with the specified profile, or with its device's saved profile.
    ///
    /// # Errors
    /// Returns an error if the device is not calibrated, or a file is invalid.
    pub fn open(
        source: EventSource,
        profiles: &ProfileFolder,
        profile: Option<&Path>,
        record: Option<&Path>,
    ) -> Result<Self, AppError> {
        let device = source.device_info().clone();
        let profile = match profile {
            Some(path) => Some(read_profile(path)?),
            None => profiles.find(&device)?,
        };
        let profile = profile.ok_or_else(|| {
            AppError::failed(format!(
                "'{}' is not calibrated: run `spandrel rc --calibrate` ({})",
                device.name,
                profiles.missing_reason(&device)
            ))
        })?;
        let log = record.map(|path| InputLog::begin(path, &device)).transpose()?;
        Ok(Self { log, ..Self::new(source, profile) })
    }

    /// Creates a controller from an event source and a profile.
    pub fn new(source: EventSource, profile: ControllerProfile) -> Self {
        tracing::info!("flying with '{}', stick mode {}", profile.device.name, profile.mode.number());
        Self { source, profile, raw: RawInput::default(), log: None }
    }

    /// Processes the device's events and its button actions. Recordings are replayed by `flown`, the time since the
    /// first contact with the vehicle.
    pub fn poll(&mut self, link: &mut ControllerLink, flown: SimTime, now: SimTime) -> ControllerReading {
        while let Some(event) = self.source.next(flown) {
            self.record_event(flown, event);
            let fresh = matches!(event, DeviceEvent::Button { button, pressed: true } if !self.raw.down.contains(&button));
            self.raw.apply(event);
            match event {
                DeviceEvent::Button { button, .. } if fresh => {
                    self.profile.buttons.get(&button).into_iter().for_each(|action| link.request_action(*action, now));
                }
                DeviceEvent::Lost => {
                    tracing::warn!("'{}' disconnected: stick input centered, then stopped", self.profile.device.name)
                }
                DeviceEvent::Found => tracing::info!("'{}' connected", self.profile.device.name),
                DeviceEvent::Axis { .. } | DeviceEvent::Button { .. } => {}
            }
        }
        ControllerReading { sticks: (!self.raw.lost).then(|| self.profile.sticks(&self.raw)), over: self.source.is_over() }
    }

    /// Records an event. A disk error stops the recording, but not the flight.
    fn record_event(&mut self, flown: SimTime, event: DeviceEvent) {
        let Some(log) = &mut self.log else { return };
        if let Err(error) = log.write(flown, event) {
            tracing::warn!("{}: cannot write: {error}; the recording ends here, the flight continues", log.path.display());
            self.log = None;
        }
    }
}

/// Functions for testing and calibrating the controller in the window.
#[cfg(feature = "view")]
impl CalibratedController {
    /// Returns the calibration profile in use.
    pub fn profile(&self) -> &ControllerProfile {
        &self.profile
    }

    /// Replaces the calibration profile.
    pub fn set_profile(&mut self, profile: ControllerProfile) {
        self.profile = profile;
    }

    /// Returns the raw axis and button values.
    pub fn raw(&self) -> &RawInput {
        &self.raw
    }

    /// Discards the profile and returns the event source.
    pub fn release(self) -> EventSource {
        self.source
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_clients::rc::input_recording::InputRecording;
    use spandrel_clients::rc::profile::StickMode;
    use std::collections::BTreeMap;

    const RECORDING: &str = r#"{"format":1,"device":"Stick","id":"1"}
{"t_s":0.0,"axis":0,"value":0.5}
{"t_s":0.1,"axis":0,"value":0.25}
"#;

    #[test]
    fn regress_disk_error_ends_recording_but_not_flight() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("flown.jsonl");
        let device = InputRecording::read("in", RECORDING).unwrap().device;
        let profile =
            ControllerProfile { device: device.clone(), mode: StickMode::Two, axes: BTreeMap::new(), buttons: BTreeMap::new() };
        let mut log = InputLog::begin(&path, &device).unwrap();
        // A read-only descriptor simulates a full disk.
        log.file = File::open(&path).unwrap();
        let mut hand = CalibratedController {
            log: Some(log),
            ..CalibratedController::new(EventSource::Record(InputRecording::read("in", RECORDING).unwrap()), profile)
        };
        let mut link = ControllerLink::default();
        let late = SimTime::from_ms(200);
        assert!(hand.poll(&mut link, late, late).sticks.is_some());
        assert!(hand.log.is_none(), "the record has ended");
        InputRecording::read("flown", &std::fs::read_to_string(&path).unwrap()).expect("what is there can be played");
    }
}
