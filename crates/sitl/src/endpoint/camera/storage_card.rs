//! The memory card: what is on it and what still fits.

use super::CaptureRecord;

/// A memory card of 32 GB, MiB.
pub const CARD_MIB: f64 = 30_517.0;

/// What has been written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StorageCard {
    shots: Vec<CaptureRecord>,
    pictures_mib: f64,
    videos_mib: f64,
}

impl StorageCard {
    /// Pictures of the image log, in the order of their numbers.
    #[must_use]
    pub fn shots(&self) -> &[CaptureRecord] {
        &self.shots
    }

    /// What pictures and finished recordings take, MiB.
    #[must_use]
    pub fn used_mib(&self) -> f64 {
        self.pictures_mib + self.videos_mib
    }

    /// Keeps a picture.
    pub fn add_picture(&mut self, shot: CaptureRecord, mib: f64) {
        self.shots.push(shot);
        self.pictures_mib += mib;
    }

    /// Keeps a finished recording.
    pub fn add_video(&mut self, mib: f64) {
        self.videos_mib += mib;
    }

    /// Counts pictures from 0 again; the files stay.
    pub fn clear_log(&mut self) {
        self.shots.clear();
    }

    /// Everything is gone.
    pub fn format(&mut self) {
        *self = Self::default();
    }
}
