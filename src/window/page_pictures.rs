//! Reads the picture files that pages of the window show, in the background: decoding a large one takes many frames.

use super::worker::Worker;
use crate::io::picture_file::{PictureFile, PictureFormat};
use spandrel_view::gpu::{PageImage, decode_jpeg};
use spandrel_view::picture::Picture;
use std::collections::BTreeSet;
use std::path::Path;

/// Maximum width of a picture on a page, px; wider ones are scaled down (estimate: the width of a page on most displays).
const MAX_WIDTH_PX: u32 = 1_920;

/// Reads picture files.
#[derive(Debug)]
pub struct PagePictures {
    /// Paths that were requested and have not been returned.
    pending: BTreeSet<String>,
    worker: Worker<Option<PageImage>>,
}

impl Default for PagePictures {
    fn default() -> Self {
        Self { pending: BTreeSet::new(), worker: Worker::new(|path| read(path).map(|picture| PageImage::new(&picture))) }
    }
}

impl PagePictures {
    /// Requests the picture at a path, unless it is being read.
    pub fn request(&mut self, path: String) {
        if self.pending.insert(path.clone()) {
            self.worker.request(path);
        }
    }

    /// Returns the path and the picture of the next file that was read; no picture if the file cannot be read.
    pub fn poll(&mut self) -> Option<(String, Option<PageImage>)> {
        let (path, picture) = self.worker.poll()?;
        self.pending.remove(&path);
        Some((path, picture))
    }
}

/// Reads a PNG or JPEG file. Returns `None` if there is no such file or it cannot be decoded.
fn read(path: &str) -> Option<Picture> {
    load(Path::new(path)).inspect_err(|error| tracing::warn!("{path}: {error}")).ok()
}

fn load(path: &Path) -> Result<Picture, String> {
    let PictureFile { info, bytes } = PictureFile::read(path).map_err(|error| error.to_string())?;
    let picture = match info.format {
        PictureFormat::Png => decode_png(&bytes).map_err(|error| error.to_string())?,
        PictureFormat::Jpeg => decode_jpeg(&bytes).ok_or("cannot decode the JPEG file")?,
    };
    Ok(picture.scaled_to_width(MAX_WIDTH_PX).upright(info.orientation))
}

fn decode_png(bytes: &[u8]) -> Result<Picture, png::DecodingError> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let frame = reader.next_frame(&mut pixels)?;
    let samples = frame.color_type.samples();
    let rgba = pixels[..frame.buffer_size()].chunks_exact(samples).flat_map(on_white).collect();
    Ok(Picture { width: frame.width, height: frame.height, rgba })
}

/// Returns an opaque pixel from the samples of gray or color with or without alpha. Drawings with a transparent background expect
/// white paper.
fn on_white(samples: &[u8]) -> [u8; 4] {
    let (color, alpha) = match *samples {
        [gray] => ([gray; 3], u8::MAX),
        [gray, alpha] => ([gray; 3], alpha),
        [red, green, blue, ref rest @ ..] => ([red, green, blue], rest.first().copied().unwrap_or(u8::MAX)),
        [] => ([0; 3], u8::MAX),
    };
    let mixed = |value: u8| {
        let (value, alpha) = (u32::from(value), u32::from(alpha));
        // Rounded; at most 255.
        ((value * alpha + 255 * (255 - alpha) + 127) / 255) as u8
    };
    let [red, green, blue] = color.map(mixed);
    [red, green, blue, u8::MAX]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    fn saved(folder: &Path, name: &str, bytes: &[u8]) -> String {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path.display().to_string()
    }

    fn encoded(color: image::ExtendedColorType, pixels: &[u8], format: image::ImageFormat) -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image::write_buffer_with_format(&mut bytes, pixels, 2, 1, color, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn exact_every_kind_of_png_is_shown_on_white() {
        use image::ExtendedColorType::{L8, L16, La8, Rgb8, Rgba8};
        let folder = tempfile::tempdir().unwrap();
        let shown = |color, pixels: &[u8]| {
            let picture = read(&saved(folder.path(), "a.png", &encoded(color, pixels, image::ImageFormat::Png))).unwrap();
            assert_eq!((picture.width, picture.height, picture.rgba[3], picture.rgba[7]), (2, 1, 255, 255));
            [picture.at(0, 0), picture.at(1, 0)]
        };
        assert_eq!(shown(L8, &[0, 200]), [[0; 3], [200; 3]]);
        assert_eq!(shown(L16, &[0, 0, 200, 200]), [[0; 3], [200; 3]]);
        assert_eq!(shown(La8, &[0, 255, 0, 0]), [[0; 3], [255; 3]]);
        assert_eq!(shown(Rgb8, &[1, 2, 3, 4, 5, 6]), [[1, 2, 3], [4, 5, 6]]);
        assert_eq!(shown(Rgba8, &[10, 20, 30, 255, 10, 20, 30, 128]), [[10, 20, 30], [132, 137, 142]]);
    }

    #[test]
    fn val_jpeg_files_are_decoded() {
        // Lossy compression of two equal pixels changes each value by a few steps.
        const TOLERANCE: u8 = 4;
        let folder = tempfile::tempdir().unwrap();
        for (color, pixels, expected) in [
            (image::ExtendedColorType::Rgb8, &[200, 60, 20, 200, 60, 20][..], [200, 60, 20]),
            (image::ExtendedColorType::L8, &[90, 90], [90; 3]),
        ] {
            let path = saved(folder.path(), "a.jpg", &encoded(color, pixels, image::ImageFormat::Jpeg));
            let picture = read(&path).unwrap();
            assert_eq!((picture.width, picture.height), (2, 1));
            let near = picture.at(0, 0).into_iter().zip(expected).all(|(a, b): (u8, u8)| a.abs_diff(b) <= TOLERANCE);
            assert!(near, "{:?}", picture.at(0, 0));
        }
    }

    #[test]
    fn exact_missing_and_damaged_files_are_no_pictures() {
        let folder = tempfile::tempdir().unwrap();
        let png = encoded(image::ExtendedColorType::L8, &[0, 200], image::ImageFormat::Png);
        let cut = &png[..png.len() / 2];
        assert_eq!(read("/no/such/file.png"), None);
        for bytes in [&b"text"[..], cut] {
            assert_eq!(read(&saved(folder.path(), "a.png", bytes)), None);
        }
    }

    #[test]
    fn exact_pictures_are_read_in_the_background_and_only_once_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let bytes = encoded(image::ExtendedColorType::L8, &[0, 200], image::ImageFormat::Png);
        let good = saved(folder.path(), "a.png", &bytes);
        let mut pictures = PagePictures::default();
        assert!(pictures.poll().is_none());
        for path in [&good, "/no/such/file.png", &good] {
            pictures.request(path.to_owned());
        }
        // The thread ends when nobody can request another picture.
        let (_, finished) = pictures.worker.thread.take().unwrap();
        let found: Vec<_> = finished.iter().map(|(path, picture)| (path, picture.map(|one| one.size_px()))).collect();
        assert_eq!(found, [(good.clone(), Some((2, 1))), ("/no/such/file.png".to_owned(), None)]);
    }

    #[test]
    fn exact_a_picture_that_was_returned_can_be_requested_again() {
        let mut pictures = PagePictures::default();
        let (sender, finished) = channel();
        let (paths, wanted) = channel();
        pictures.worker.thread = Some((paths, finished));
        for _ in 0..2 {
            pictures.request("a.png".into());
            pictures.request("a.png".into());
            assert_eq!(wanted.try_iter().count(), 1);
            sender.send(("a.png".into(), None)).unwrap();
            assert!(pictures.poll().is_some_and(|(path, picture)| path == "a.png" && picture.is_none()));
        }
    }
}
