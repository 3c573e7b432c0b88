//! Saves the camera's view to a file about once a second, for the live page. A separate thread encodes the JPEG and
//! waits for the disk so that the window does not drop frames.

use crate::errors::AppError;
use crate::io::replace::replace;
use spandrel_view::photo;
use spandrel_view::picture::Picture;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Interval between images.
const SAVE_INTERVAL: Duration = Duration::from_secs(1);
/// Maximum file size, bytes; a mobile connection transfers this in one second.
const MAX_FILE_BYTES: usize = 150_000;

/// Passes images to the thread that saves them. The thread deletes the file when it ends.
pub struct PictureWriter {
    sender: Option<SyncSender<Picture>>,
    thread: Option<JoinHandle<()>>,
    next_save: Duration,
}

impl PictureWriter {
    /// Starts a thread that saves images to `path`.
    pub fn start(path: PathBuf) -> Self {
        // The queue holds at most one image; further images are dropped.
        let (sender, receiver) = sync_channel(1);
        let thread = std::thread::spawn(move || save_images(&path, &receiver));
        Self { sender: Some(sender), thread: Some(thread), next_save: Duration::ZERO }
    }

    /// Returns true if an image is due, at most once a second.
    pub fn is_due(&mut self, now: Duration) -> bool {
        if now < self.next_save {
            return false;
        }
        self.next_save = now + SAVE_INTERVAL;
        true
    }

    /// Saves an image, unless the previous one is still waiting.
    pub fn save(&self, picture: Picture) {
        if let Some(sender) = &self.sender {
            let _ = sender.try_send(picture);
        }
    }
}

impl Drop for PictureWriter {
    fn drop(&mut self) {
        self.sender = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn save_images(path: &Path, pictures: &Receiver<Picture>) {
    let mut told = false;
    for picture in pictures {
        if let Err(error) = write(path, &picture) {
            // Log only the first failure, because later failures probably have the same cause.
            if !std::mem::replace(&mut told, true) {
                tracing::warn!("cannot save the camera's view: {error}");
            }
        }
    }
    // Do not leave an outdated image behind.
    let _ = std::fs::remove_file(path);
}

fn write(path: &Path, picture: &Picture) -> Result<(), AppError> {
    let jpeg = photo::plain(picture, MAX_FILE_BYTES).map_err(|error| AppError::failed(error.to_string()))?;
    replace(path, &jpeg)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_images_are_saved_once_a_second_and_deleted_at_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("camera.jpg");
        let mut image_writer = PictureWriter::start(path.clone());
        let next_save: Vec<bool> =
            [0, 400, 999, 1_000, 1_500, 2_600].map(|ms| image_writer.is_due(Duration::from_millis(ms))).to_vec();
        assert_eq!(next_save, [true, false, false, true, false, true]);
        let grey = |value: u8| Picture { width: 64, height: 48, rgba: [value, value, value, 255].repeat(64 * 48) };
        for value in [40, 200] {
            write(&path, &grey(value)).unwrap();
            let bytes = std::fs::read(&path).unwrap();
            assert_eq!(image::load_from_memory(&bytes).unwrap().to_luma8().dimensions(), (64, 48));
            assert!(bytes.len() <= MAX_FILE_BYTES);
        }
        image_writer.save(grey(90));
        image_writer.save(grey(91));
        image_writer.save(grey(92));
        drop(image_writer);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "the file is deleted");
    }
}
