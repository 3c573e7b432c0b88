//! A live flight's camera image, which a window saves to a file about once a second.

use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

/// Age beyond which an image is outdated.
const MAX_IMAGE_AGE: Duration = Duration::from_secs(10);
/// Maximum size of an image, bytes; a full HD view takes several hundred thousand bytes.
const MAX_IMAGE_BYTES: u64 = 4 * 1024 * 1024;
/// Returns the current image's version, or `None` if the image is outdated. The version lets browsers request each
/// image only once.
pub fn version(path: &Path) -> Option<u64> {
    let about = path.metadata().ok().filter(|about| about.is_file() && about.len() <= MAX_IMAGE_BYTES)?;
    let kept = about.modified().ok()?;
    // If the clock has been set back, the image counts as current.
    let age = kept.elapsed().unwrap_or_default();
    let since = kept.duration_since(UNIX_EPOCH).ok()?;
    (age < MAX_IMAGE_AGE).then(|| u64::try_from(since.as_millis()).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    const JPEG_SIGNATURE: [u8; 3] = [0xff, 0xd8, 0xff];

    #[test]
    fn exact_only_current_images_have_a_version() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("camera.jpg");
        assert_eq!(version(&path), None);
        std::fs::write(&path, JPEG_SIGNATURE).unwrap();
        let file = std::fs::File::options().write(true).open(&path).unwrap();
        let now = file.metadata().unwrap().modified().unwrap();
        let at = |ago: Duration| file.set_modified(now - ago).unwrap();
        at(Duration::from_secs(1));
        let first = version(&path).unwrap();
        at(Duration::ZERO);
        assert!(version(&path).unwrap() > first, "every image has its own version");
        at(2 * MAX_IMAGE_AGE);
        assert_eq!((version(&path), version(folder.path())), (None, None));
    }
}
