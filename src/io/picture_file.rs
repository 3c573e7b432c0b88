//! PNG and JPEG files that other people made: their type, their size, and the limits that pages and the window can handle. The
//! pixels are not decoded here.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io::Read;
use std::path::Path;

/// Maximum size of a picture, bytes (estimate: a photograph of a telephone after it was scaled for a web page).
pub const MAX_PICTURE_BYTES: usize = 4 * 1024 * 1024;
/// Maximum width and height, px: the largest texture that every graphics card supports (WebGPU, maxTextureDimension2D).
const MAX_SIDE_PX: u32 = 8_192;
/// Description of the allowed files, for messages.
pub const ALLOWED_PICTURES: &str = "a PNG or JPEG file of at most 4 MiB and 8192 x 8192 px";
/// Bytes that are read first to find the size of a picture: more than a JPEG file's EXIF data, which has at most 64 KiB and comes
/// first. A file with more before its size is read further.
const HEAD_BYTES: u64 = 96 * 1024;
/// First bytes of a PNG file.
const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
/// First bytes of a JPEG file: start of image, and the beginning of the next marker.
const JPEG_MAGIC: &[u8] = b"\xff\xd8\xff";
/// Tag of the orientation in EXIF data (EXIF 2.32, section 4.6.4).
const ORIENTATION_TAG: u16 = 0x0112;

/// Type of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// PNG.
    Png,
    /// JPEG.
    Jpeg,
}

impl PictureFormat {
    /// Returns the media type.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Jpeg => "image/jpeg",
        }
    }

    /// Returns the end of a file's name.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
        }
    }
}

/// Properties of a picture, from the head of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PictureInfo {
    /// Type.
    pub format: PictureFormat,
    /// Width and height of the stored pixels, px.
    stored_px: (u32, u32),
    /// EXIF orientation, 1 (upright) to 8.
    pub orientation: u16,
}

impl PictureInfo {
    /// Returns width and height as the picture is shown, px.
    pub fn size_px(&self) -> (u32, u32) {
        let (width, height) = self.stored_px;
        // The last four orientations are on their side.
        if self.orientation > 4 { (height, width) } else { (width, height) }
    }
}

/// A picture that pages can show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PictureFile {
    /// Type and size.
    pub info: PictureInfo,
    /// Contents of the file.
    pub bytes: Vec<u8>,
}

/// Reason why a file is not a picture that pages can show.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PictureError {
    /// The file cannot be read.
    #[error("cannot read: {0}")]
    Unreadable(String),
    /// The file has more than [`MAX_PICTURE_BYTES`].
    #[error("too large")]
    TooLarge,
    /// The first bytes are those of neither type.
    #[error("neither a PNG nor a JPEG file")]
    WrongType,
    /// The head of the file is incomplete.
    #[error("damaged")]
    Damaged,
    /// Width and height are outside the limits, px.
    #[error("{0} x {1} px")]
    WrongSize(u32, u32),
}

impl PictureFile {
    /// Checks the contents of a file.
    ///
    /// # Errors
    /// Returns an error if it is too large, no PNG or JPEG file, damaged, or too wide or high.
    pub fn new(bytes: Vec<u8>) -> Result<Self, PictureError> {
        if bytes.len() > MAX_PICTURE_BYTES {
            return Err(PictureError::TooLarge);
        }
        Ok(Self { info: inspect(&bytes)?, bytes })
    }

    /// Reads and checks a file.
    ///
    /// # Errors
    /// Returns an error if it cannot be read, and as [`Self::new`].
    pub fn read(path: &Path) -> Result<Self, PictureError> {
        let unreadable = |error: std::io::Error| PictureError::Unreadable(error.to_string());
        let mut bytes = Vec::new();
        // One byte more is enough to see that the file is too large.
        let most = MAX_PICTURE_BYTES as u64 + 1;
        std::fs::File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes)).map_err(unreadable)?;
        Self::new(bytes)
    }

    /// Reads type and size of a picture from the head of its file.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::read`].
    pub fn read_info(path: &Path) -> Result<PictureInfo, PictureError> {
        let unreadable = |error: std::io::Error| PictureError::Unreadable(error.to_string());
        let file = std::fs::File::open(path).map_err(unreadable)?;
        if file.metadata().map_err(unreadable)?.len() > MAX_PICTURE_BYTES as u64 {
            return Err(PictureError::TooLarge);
        }
        read_head(file).map_err(unreadable)?
    }

    /// Returns the picture as an address that needs no file.
    pub fn data_uri(&self) -> String {
        format!("data:{};base64,{}", self.info.format.media_type(), STANDARD.encode(&self.bytes))
    }
}

/// Reads as much of a picture as its head requires, and no more than [`MAX_PICTURE_BYTES`].
fn read_head(mut file: impl Read) -> std::io::Result<Result<PictureInfo, PictureError>> {
    let (mut bytes, mut wanted) = (Vec::new(), HEAD_BYTES);
    loop {
        let read = (&mut file).take(wanted).read_to_end(&mut bytes)? as u64;
        let found = inspect(&bytes);
        let is_complete = read < wanted || bytes.len() >= MAX_PICTURE_BYTES;
        if found != Err(PictureError::Damaged) || is_complete {
            return Ok(found);
        }
        wanted = bytes.len().min(MAX_PICTURE_BYTES - bytes.len()) as u64;
    }
}

/// Reads the head of a picture.
///
/// # Errors
/// Returns an error if it is no PNG or JPEG file, damaged, or too wide or high.
pub fn inspect(bytes: &[u8]) -> Result<PictureInfo, PictureError> {
    let info = if bytes.starts_with(PNG_MAGIC) {
        png_size(bytes).map(|stored_px| PictureInfo { format: PictureFormat::Png, stored_px, orientation: 1 })
    } else if bytes.starts_with(JPEG_MAGIC) {
        jpeg_head(bytes)
    } else {
        return Err(PictureError::WrongType);
    };
    let info = info.ok_or(PictureError::Damaged)?;
    let (width, height) = info.stored_px;
    let fits = |side: u32| (1..=MAX_SIDE_PX).contains(&side);
    if fits(width) && fits(height) { Ok(info) } else { Err(PictureError::WrongSize(width, height)) }
}

/// Returns the size from the first chunk of a PNG file.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let head = bytes.get(12..24)?.strip_prefix(b"IHDR")?;
    let side = |bytes: &[u8]| bytes.iter().fold(0, |sum, byte| sum << 8 | u32::from(*byte));
    Some((side(&head[..4]), side(&head[4..])))
}

/// Reads the segments of a JPEG file up to the one with its size (ITU-T T.81, annex B).
fn jpeg_head(bytes: &[u8]) -> Option<PictureInfo> {
    let (mut at, mut orientation) = (2, 1);
    loop {
        let (marker, content, next) = segment(bytes, at)?;
        match marker {
            // Huffman tables, a reserved marker, and arithmetic coding are between the frame headers.
            0xc0..=0xcf if ![0xc4, 0xc8, 0xcc].contains(&marker) => {
                let stored_px = frame_size(content)?;
                return Some(PictureInfo { format: PictureFormat::Jpeg, stored_px, orientation });
            }
            // The pixels begin, or the file ends.
            0xd9 | 0xda => return None,
            0xe1 => orientation = exif_orientation(content).unwrap_or(orientation),
            _ => {}
        }
        at = next;
    }
}

/// Returns marker and content of the segment at a position, and the position of the next one.
fn segment(bytes: &[u8], at: usize) -> Option<(u8, &[u8], usize)> {
    // Any number of fill bytes may precede a marker.
    let fill = bytes.get(at..)?.iter().take_while(|byte| **byte == 0xff).count();
    let start = at + fill;
    let [marker, high, low] = *bytes.get(start..start + 3)? else { return None };
    let end = start + 1 + usize::from(u16::from_be_bytes([high, low]));
    let content = bytes.get(start + 3..end)?;
    (fill > 0).then_some((marker, content, end))
}

/// Returns width and height from a frame header.
fn frame_size(content: &[u8]) -> Option<(u32, u32)> {
    let [_precision, height_high, height_low, width_high, width_low, ..] = *content else { return None };
    let side = |high: u8, low: u8| u32::from(u16::from_be_bytes([high, low]));
    Some((side(width_high, width_low), side(height_high, height_low)))
}

/// Returns the orientation from EXIF data; `None` if there is none.
fn exif_orientation(content: &[u8]) -> Option<u16> {
    let tiff = content.strip_prefix(b"Exif\0\0")?;
    let is_little_endian = tiff.starts_with(b"II");
    let short = |at: usize| {
        let [a, b] = *tiff.get(at..at.checked_add(2)?)? else { return None };
        Some(if is_little_endian { u16::from_le_bytes([a, b]) } else { u16::from_be_bytes([a, b]) })
    };
    let (first, second) = (usize::from(short(4)?), usize::from(short(6)?));
    let directory = if is_little_endian { second << 16 | first } else { first << 16 | second };
    let count = usize::from(short(directory)?);
    let entry = (0..count).map(|k| directory + 2 + 12 * k).find(|at| short(*at) == Some(ORIENTATION_TAG))?;
    short(entry + 8).filter(|orientation| (1..=8).contains(orientation))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a PNG file of this size with one color.
    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&vec![7; (width * height) as usize]).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn jpeg(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = Vec::new();
        let pixels = vec![90; (3 * width * height) as usize];
        image::codecs::jpeg::JpegEncoder::new(&mut bytes).encode(&pixels, width, height, image::ExtendedColorType::Rgb8).unwrap();
        bytes
    }

    /// Returns a JPEG file with EXIF data that contains this orientation.
    fn turned(orientation: u8, little_endian: bool) -> Vec<u8> {
        let number = |value: u8, bytes: usize| {
            let mut number = vec![0; bytes];
            let at = if little_endian { 0 } else { bytes - 1 };
            number[at] = value;
            number
        };
        let tag = if little_endian { [0x12, 0x01] } else { [0x01, 0x12] };
        let mut exif = b"Exif\0\0".to_vec();
        exif.extend(if little_endian { b"II" } else { b"MM" });
        exif.extend([number(42, 2), number(8, 4), number(1, 2)].concat());
        exif.extend([tag.to_vec(), number(3, 2), number(1, 4), number(orientation, 2), vec![0; 2], vec![0; 4]].concat());
        let mut bytes = jpeg(40, 30);
        let segment = [&[0xff, 0xe1, 0, exif.len() as u8 + 2][..], &exif].concat();
        bytes.splice(2..2, segment);
        bytes
    }

    #[test]
    fn val_type_and_size_are_those_that_other_encoders_wrote() {
        for (bytes, format) in [(png(40, 30), PictureFormat::Png), (jpeg(40, 30), PictureFormat::Jpeg)] {
            let file = PictureFile::new(bytes.clone()).unwrap();
            assert_eq!((file.info.format, file.info.size_px(), file.info.orientation), (format, (40, 30), 1));
            assert_eq!(file.bytes, bytes);
        }
        assert!(PictureFile::new(png(1, 1)).unwrap().data_uri().starts_with("data:image/png;base64,iVBORw0KGgo"));
    }

    #[test]
    fn exact_a_photograph_on_its_side_is_shown_upright() {
        for little_endian in [true, false] {
            for orientation in 1..=8 {
                let info = inspect(&turned(orientation, little_endian)).unwrap();
                let expected = if orientation > 4 { (30, 40) } else { (40, 30) };
                assert_eq!((info.orientation, info.size_px()), (u16::from(orientation), expected));
            }
            assert_eq!(inspect(&turned(9, little_endian)).unwrap().orientation, 1, "an invalid orientation");
        }
    }

    #[test]
    fn exact_other_and_damaged_files_are_refused() {
        let refused = |bytes: &[u8]| PictureFile::new(bytes.to_vec()).unwrap_err();
        for wrong in [&b""[..], b"GIF89a", b"<svg xmlns=\"http://www.w3.org/2000/svg\"/>", b"\x89PN", b"\xff\xd8"] {
            assert_eq!(refused(wrong), PictureError::WrongType);
        }
        let (png, jpeg) = (png(9, 9), jpeg(9, 9));
        assert_eq!((refused(&png[..20]), refused(&jpeg[..30])), (PictureError::Damaged, PictureError::Damaged));
        assert_eq!(refused(b"\xff\xd8\xff\xd9"), PictureError::Damaged);
        let mut wide = png.clone();
        wide[16..20].copy_from_slice(&(MAX_SIDE_PX + 1).to_be_bytes());
        assert_eq!(refused(&wide), PictureError::WrongSize(MAX_SIDE_PX + 1, 9));
        let mut large = png;
        large.resize(MAX_PICTURE_BYTES, 0);
        assert!(PictureFile::new(large.clone()).is_ok(), "bytes after the end are harmless");
        large.push(0);
        assert_eq!(refused(&large), PictureError::TooLarge);
    }

    #[test]
    fn prop_mutated_files_never_panic() {
        let mut random = spandrel_model::random::RandomStream::new(1, "prop.picture-files");
        let files = [png(9, 9), jpeg(40, 30), turned(6, true), turned(6, false)];
        let mut accepted = 0;
        for k in 0..20_000 {
            let mut bytes = files[k % files.len()].clone();
            // The head is at the beginning.
            let at = random.below(bytes.len().min(200));
            bytes[at] = random.below(256) as u8;
            bytes.truncate(1 + random.below(2 * bytes.len()));
            accepted += usize::from(PictureFile::new(bytes).is_ok());
        }
        assert!((2_000..19_000).contains(&accepted), "{accepted}");
    }

    /// Counts the bytes that are read from a file.
    struct Counted<'a>(&'a [u8], &'a mut usize);

    impl Read for Counted<'_> {
        fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
            let count = self.0.read(to)?;
            *self.1 += count;
            Ok(count)
        }
    }

    #[test]
    fn exact_only_the_head_of_a_file_is_read_for_its_size() {
        let head_of = |bytes: &[u8]| {
            let mut read = 0;
            let info = read_head(Counted(bytes, &mut read)).unwrap();
            (info, read)
        };
        let large = |mut bytes: Vec<u8>| {
            bytes.resize(MAX_PICTURE_BYTES, 0);
            bytes
        };
        for bytes in [png(40, 30), jpeg(40, 30), turned(6, true)] {
            assert_eq!(head_of(&large(bytes.clone())), (inspect(&bytes), HEAD_BYTES as usize));
        }
        // Five comments of the largest size come before the picture's size.
        let comment = [&[0xff, 0xfe, 0xff, 0xff][..], &[0; 65_533]].concat();
        let mut late = jpeg(40, 30);
        late.splice(2..2, comment.repeat(5));
        let (info, read) = head_of(&large(late.clone()));
        assert_eq!((info, read), (inspect(&late), 4 * HEAD_BYTES as usize));
        assert_eq!(head_of(&late[..200_000]), (Err(PictureError::Damaged), 200_000));
        assert_eq!(head_of(b"GIF89a").0, Err(PictureError::WrongType));
    }

    #[test]
    fn exact_size_from_the_head_has_the_same_errors_as_the_whole_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let both = || (PictureFile::read_info(&path), PictureFile::read(&path).map(|file| file.info));
        let (head, whole) = both();
        assert!(head == whole && matches!(head, Err(PictureError::Unreadable(_))), "{head:?}");
        for bytes in [png(3, 2), jpeg(40, 30), b"text".to_vec(), png(9, 9)[..20].to_vec(), vec![0x89; MAX_PICTURE_BYTES + 1]] {
            std::fs::write(&path, bytes).unwrap();
            let (head, whole) = both();
            assert_eq!(head, whole);
        }
    }

    #[test]
    fn exact_files_are_read_up_to_the_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        assert!(matches!(PictureFile::read(&path), Err(PictureError::Unreadable(_))));
        std::fs::write(&path, png(3, 2)).unwrap();
        assert_eq!(PictureFile::read(&path).unwrap().info.size_px(), (3, 2));
        std::fs::write(&path, vec![0x89; MAX_PICTURE_BYTES + 2]).unwrap();
        assert_eq!(PictureFile::read(&path), Err(PictureError::TooLarge));
    }
}
