//! A calibrated device in somebody's hand: its events through the profile into sticks and wishes.

use super::{Profiles, Source, read_profile};
use crate::errors::AppError;
use spandrel_clients::rc::link::Link;
use spandrel_clients::rc::record;
use spandrel_clients::rc::{Device, Event, Profile, Raw, Sticks};
use spandrel_model::time::SimTime;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A calibrated device.
#[derive(Debug)]
pub struct Hand {
    source: Source,
    profile: Profile,
    raw: Raw,
    log: Option<Log>,
}

#[derive(Debug)]
struct Log {
    path: PathBuf,
    file: File,
}

impl Log {
    fn begin(path: &Path, device: &Device) -> Result<Self, AppError> {
        let failed = |error: std::io::Error| AppError::wrong(format!("{}: {error}", path.display()));
        let mut file = File::create(path).map_err(failed)?;
        writeln!(file, "{}", record::head(device)).map_err(failed)?;
        Ok(Self { path: path.to_owned(), file })
    }

    fn write(&mut self, now: SimTime, event: Event) -> Result<(), AppError> {
        writeln!(self.file, "{}", record::line(now, event))
            .map_err(|error| AppError::failed(format!("{}: {error}", self.path.display())))
    }
}

/// What a look at the controller gave.
#[derive(Debug)]
pub struct Look {
    /// The sticks; `None` while the device is lost.
    pub sticks: Option<Sticks>,
    /// A record has been played to its end.
    pub over: bool,
}

impl Hand {
    /// Takes a source whose device is calibrated, by the profile in that file or by the one that is kept for it.
    ///
    /// # Errors
    /// When it is not calibrated, or a file is wrong.
    pub fn take(source: Source, profiles: &Profiles, profile: Option<&Path>, record: Option<&Path>) -> Result<Self, AppError> {
        let device = source.of().clone();
        let profile = match profile {
            Some(path) => Some(read_profile(path)?),
            None => profiles.find(&device)?,
        };
        let profile = profile.ok_or_else(|| {
            AppError::failed(format!(
                "'{}' is not calibrated: run `spandrel rc --calibrate` ({})",
                device.name,
                profiles.missing(&device)
            ))
        })?;
        let log = record.map(|path| Log::begin(path, &device)).transpose()?;
        Ok(Self { log, ..Self::with(source, profile) })
    }

    /// Takes a source and what is known of its device.
    pub fn with(source: Source, profile: Profile) -> Self {
        tracing::info!("flying with '{}', stick mode {}", profile.device.name, profile.mode.number());
        Self { source, profile, raw: Raw::default(), log: None }
    }

    /// Takes what the device has reported, and does what its buttons say. A record is played by `flown`, the time since the vehicle was
    /// heard.
    ///
    /// # Errors
    /// When what is reported cannot be written down.
    pub fn look(&mut self, link: &mut Link, flown: SimTime, now: SimTime) -> Result<Look, AppError> {
        while let Some(event) = self.source.next(flown) {
            if let Some(log) = &mut self.log {
                log.write(flown, event)?;
            }
            let fresh = matches!(event, Event::Button { button, pressed: true } if !self.raw.down.contains(&button));
            self.raw.take(event);
            match event {
                Event::Button { button, .. } if fresh => {
                    self.profile.buttons.get(&button).into_iter().for_each(|action| link.act(*action, now));
                }
                Event::Lost => tracing::warn!("'{}' is lost: sticks centred, then silent", self.profile.device.name),
                Event::Found => tracing::info!("'{}' is there", self.profile.device.name),
                _ => {}
            }
        }
        Ok(Look { sticks: (!self.raw.lost).then(|| self.profile.sticks(&self.raw)), over: self.source.is_over() })
    }
}

/// What the window needs besides, where the controller is tried and calibrated.
#[cfg(feature = "view")]
impl Hand {
    /// What is known of the device.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The device is read by another profile from now on.
    pub fn set(&mut self, profile: Profile) {
        self.profile = profile;
    }

    /// Where everything stands.
    pub fn raw(&self) -> &Raw {
        &self.raw
    }

    /// The device, without its meaning.
    pub fn let_go(self) -> Source {
        self.source
    }
}
