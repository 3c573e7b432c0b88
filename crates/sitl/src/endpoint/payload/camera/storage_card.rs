//! The memory card: its contents and free space.

use super::capture_record::CaptureRecord;

/// Capacity of a 32 GB memory card, MiB.
pub const CARD_CAPACITY_MIB: f64 = 30_517.0;

/// Contents of the card.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StorageCard {
    images: Vec<CaptureRecord>,
    pictures_mib: f64,
    videos_mib: f64,
}

impl StorageCard {
    /// Returns the images in the image log, in index order.
    #[must_use]
    pub fn images(&self) -> &[CaptureRecord] {
        &self.images
    }

    /// Returns the storage, in MiB, used by images and finished recordings.
    #[must_use]
    pub fn used_storage_mib(&self) -> f64 {
        self.pictures_mib + self.videos_mib
    }

    /// Stores an image of `size_mib` MiB.
    pub fn add_picture(&mut self, image: CaptureRecord, size_mib: f64) {
        self.images.push(image);
        self.pictures_mib += size_mib;
    }

    /// Stores a finished recording of `size_mib` MiB.
    pub fn add_video(&mut self, size_mib: f64) {
        self.videos_mib += size_mib;
    }

    /// Resets the image counter; the files remain.
    pub fn clear_log(&mut self) {
        self.images.clear();
    }

    /// Deletes all images and recordings.
    pub fn format(&mut self) {
        *self = Self::default();
    }
}
